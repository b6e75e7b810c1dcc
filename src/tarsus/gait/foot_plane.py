"""The plane through the standing feet, in the heading frame."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

__all__ = ["FootPlane", "fitted_plane"]

# Least determinant of the feet's second moments over the square of their trace: feet nearly in a line define no plane.
_LEAST_SPREAD = 0.02


class FootPlane(NamedTuple):
    """A plane ``z = height + x slope_x + y slope_y`` in the heading frame.

    Attributes
    ----------
    height : float
        Height at the origin [m].
    slope_x, slope_y : float
        Rise along x and y [m/m].
    """

    height: float = 0.0
    slope_x: float = 0.0
    slope_y: float = 0.0

    def at(self, point: Any) -> Any:
        """Return the heights at points x + iy, complex numbers or arrays of them [m]."""
        return self.height + self.slope_x * point.real + self.slope_y * point.imag

    def levelled(self, tilt: tuple[float, float] | None) -> FootPlane:
        """Return the plane through the origin with its slopes relative to the horizontal.

        Parameters
        ----------
        tilt : (roll, pitch) or None
            By how much the heading frame is tilted [rad]; None for not at all.
        """
        roll, pitch = tilt or (0.0, 0.0)
        return FootPlane(0.0, math.tan(math.atan(self.slope_x) - pitch), math.tan(math.atan(self.slope_y) + roll))


def fitted_plane(points: Sequence[complex], heights: Sequence[float], before: FootPlane, share: float) -> FootPlane:
    """Return the plane through feet: it has their mean height, and its slope follows the fitted one.

    Parameters
    ----------
    points : sequence of complex
        Where the feet stand, x + iy [m].
    heights : sequence of float
        Their heights [m].
    before : FootPlane
        The previous plane; its slope is kept where fewer than three feet stand, or all are nearly in a line.
    share : float
        Share of the fitted slope in the new one, 0 to 1.
    """
    count = len(points)
    if not count:
        return before
    middle, mean = sum(points) / count, sum(heights) / count
    slope_x, slope_y = before.slope_x, before.slope_y
    xx = xy = yy = xz = yz = 0.0
    for point, height in zip(points, heights, strict=True):
        x, y, z = point.real - middle.real, point.imag - middle.imag, height - mean
        xx, xy, yy, xz, yz = xx + x * x, xy + x * y, yy + y * y, xz + x * z, yz + y * z
    spread = xx * yy - xy * xy
    if count >= 3 and spread > _LEAST_SPREAD * (xx + yy) ** 2:
        slope_x += share * ((yy * xz - xy * yz) / spread - slope_x)
        slope_y += share * ((xx * yz - xy * xz) / spread - slope_y)
    return FootPlane(mean - slope_x * middle.real - slope_y * middle.imag, slope_x, slope_y)
