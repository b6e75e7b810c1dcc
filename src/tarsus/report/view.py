"""Axonometric (parallel) projection."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import Array

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["View"]


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
    def axes(self) -> Float[np.ndarray, "3 3"]:
        """Unit vectors of the view in G as rows: right, up, towards the eye."""
        a, e = math.radians(self.azimuth), math.radians(self.elevation)
        right = (-math.sin(a), math.cos(a), 0.0)
        up = (-math.sin(e) * math.cos(a), -math.sin(e) * math.sin(a), math.cos(e))
        eye = (math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e))
        return np.array([right, up, eye])

    def project(self, points: Float[np.ndarray, "*#batch 3"]) -> Float[np.ndarray, "*batch 2"]:
        """Project points ``(..., 3)`` onto the picture plane ``(..., 2)``, in the same unit.

        Parameters
        ----------
        points : array, shape (..., 3)
            Points in G.
        """
        projected: np.ndarray = np.asarray(points) @ self.axes[:2].T
        return projected

    def depth(self, points: Float[np.ndarray, "*#batch 3"]) -> Float[Array, "*batch"]:
        """Return the depth ``(...)`` of points ``(..., 3)``, measured towards the eye: a larger depth is in front.

        Parameters
        ----------
        points : array, shape (..., 3)
            Points in G.
        """
        nearness: np.ndarray = np.asarray(points) @ self.axes[2]
        return nearness

    def ground_under(self, picture: Float[np.ndarray, "*#batch 2"]) -> Float[np.ndarray, "n 3"]:
        """Return the ground points ``(..., 3)`` at points of the picture plane ``(..., 2)``.

        Parameters
        ----------
        picture : array, shape (..., 2)
            Points of the picture plane.
        """
        on_ground: np.ndarray = np.asarray(picture) @ np.linalg.inv(self.axes[:2, :2]).T
        return np.concatenate([on_ground, np.zeros((*on_ground.shape[:-1], 1))], axis=-1)
