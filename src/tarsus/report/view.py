"""Axonometric (parallel) projection."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

__all__ = ["View"]

Floats = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True, kw_only=True)
class View:
    """Direction of view.

    Attributes
    ----------
    azimuth : float
        Azimuth of the eye, counter-clockwise from forward [deg]; -60 is in front of the robot's right side.
    elevation : float
        Elevation of the eye [deg].
    """

    azimuth: float = -62.0
    elevation: float = 28.0

    @property
    def axes(self) -> Floats:
        """Unit vectors of the view in G as rows: right, up, towards the eye."""
        a, e = math.radians(self.azimuth), math.radians(self.elevation)
        right = (-math.sin(a), math.cos(a), 0.0)
        up = (-math.sin(e) * math.cos(a), -math.sin(e) * math.sin(a), math.cos(e))
        eye = (math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e))
        return np.array([right, up, eye])

    def project(self, points: Floats) -> Floats:
        """Project points ``(..., 3)`` onto the picture plane ``(..., 2)``, in the same unit.

        Parameters
        ----------
        points : array, shape (..., 3)
            Points in G.
        """
        projected: Floats = np.asarray(points) @ self.axes[:2].T
        return projected

    def depth(self, points: Floats) -> Floats:
        """Return the depth of points ``(..., 3)`` towards the eye ``(...)``; points with a larger depth are in front.

        Parameters
        ----------
        points : array, shape (..., 3)
            Points in G.
        """
        nearness: Floats = np.asarray(points) @ self.axes[2]
        return nearness

    def ground_under(self, picture: Floats) -> Floats:
        """Return the ground points ``(..., 3)`` at points of the picture plane ``(..., 2)``.

        Parameters
        ----------
        picture : array, shape (..., 2)
            Points of the picture plane.
        """
        on_ground: Floats = np.asarray(picture) @ np.linalg.inv(self.axes[:2, :2]).T
        return np.concatenate([on_ground, np.zeros((*on_ground.shape[:-1], 1))], axis=-1)
