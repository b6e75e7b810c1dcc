"""An axonometric view: three dimensions drawn in two, without perspective, so that lengths stay comparable."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

__all__ = ["View"]

Floats = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True, kw_only=True)
class View:
    """From where the robot is looked at.

    Attributes
    ----------
    azimuth : float
        Where the eye is, counter-clockwise from forward [deg]: -60 is before the robot's right side.
    elevation : float
        How high above the horizon the eye is [deg].
    """

    azimuth: float = -62.0
    elevation: float = 28.0

    @property
    def axes(self) -> Floats:
        """Rows: the picture's right, its up, and towards the eye, as unit vectors of G."""
        a, e = math.radians(self.azimuth), math.radians(self.elevation)
        right = (-math.sin(a), math.cos(a), 0.0)
        up = (-math.sin(e) * math.cos(a), -math.sin(e) * math.sin(a), math.cos(e))
        eye = (math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e))
        return np.array([right, up, eye])

    def project(self, points: Floats) -> Floats:
        """Return where points ``(..., 3)`` are in the picture ``(..., 2)``, in their own unit.

        Parameters
        ----------
        points : array, shape (..., 3)
            Points of G.
        """
        projected: Floats = np.asarray(points) @ self.axes[:2].T
        return projected

    def depth(self, points: Floats) -> Floats:
        """Return how near the eye points ``(..., 3)`` are ``(...)``, in their own unit: the greater hides the less.

        Parameters
        ----------
        points : array, shape (..., 3)
            Points of G.
        """
        nearness: Floats = np.asarray(points) @ self.axes[2]
        return nearness

    def ground_under(self, picture: Floats) -> Floats:
        """Return the points of the ground ``(..., 3)`` that are seen at points of the picture ``(..., 2)``.

        Parameters
        ----------
        picture : array, shape (..., 2)
            Points of the picture.
        """
        on_ground: Floats = np.asarray(picture) @ np.linalg.inv(self.axes[:2, :2]).T
        return np.concatenate([on_ground, np.zeros((*on_ground.shape[:-1], 1))], axis=-1)
