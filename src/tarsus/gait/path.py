"""Paths of the body over the ground: straight, around a centre, or along a constant twist, from the origin of G.

Every path is a one-parameter subgroup of SE(2): the exponential map of a fraction from 0 to 1 of a displacement
``(x, y, yaw)``. A straight path has no yaw; a path around a centre `c` by an angle `a` is ``a (c_y, -c_x, 1)``.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from tarsus.arrays import Array, Namespace, as_array, namespace, require_float, stack_last
from tarsus.errors import InputError

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["BodyPath", "curved_path", "ground_to_heading", "heading_to_ground", "straight_path", "twist_path"]


@dataclass(frozen=True)
class BodyPath:
    """A path of the body over the ground.

    Attributes
    ----------
    displacement : tuple of float
        Exponential coordinates of the whole path in the heading frame at its start: forward [m], left [m], yaw [rad].
    duration : float or None
        Duration at cruising speed [s]; None where the plan decides.
    """

    displacement: tuple[float, float, float]
    duration: float | None = None

    def __post_init__(self) -> None:
        values = tuple(require_float("a path's displacement", value) for value in self.displacement)
        if len(values) != 3 or not all(map(math.isfinite, values)):
            raise InputError(f"a path's displacement is {self.displacement}; it must be three finite numbers")
        if not any(values):
            raise InputError("the path has no length; distance, angle or speed must not be 0")
        object.__setattr__(self, "displacement", values)
        if self.duration is not None:
            object.__setattr__(self, "duration", require_float("a path's duration", self.duration))
            if not 0 < self.duration < math.inf:
                raise InputError(f"a path's duration is {self.duration} s; it must be greater than 0 and finite")

    @property
    def angle(self) -> float:
        """Angle by which the body turns [rad]."""
        return self.displacement[2]

    def planar_pose(self, fraction: Float[Array, "*#batch"]) -> Float[Array, "*batch 3"]:
        """Return the planar pose of the body after a fraction of the path.

        Parameters
        ----------
        fraction : array, shape (...)
            Fractions of the path, 0 at its start, 1 at its end.

        Returns
        -------
        array, shape (..., 3)
            x [m], y [m] and yaw [rad] of the body's heading frame in G.
        """
        return exponential_map(self.displacement, fraction)

    def travel(
        self, feet: Float[Array, "*#batch legs 2"] | Float[Array, "*#batch legs 3"]
    ) -> Float[Array, "*batch legs"]:
        """Return the distance that each foot in stance would move relative to the body over the whole path.

        Parameters
        ----------
        feet : array, shape (..., legs, 2 or 3)
            Rest footholds in the heading frame [m].

        Returns
        -------
        array, shape (..., legs)
            Lengths of the lines or arcs [m]; the stroke times the number of strokes.
        """
        x, y, yaw = self.displacement
        xp = namespace(feet)
        feet = as_array(xp, feet)
        across, along = x - yaw * feet[..., 1], y + yaw * feet[..., 0]
        return xp.hypot(across, along)


def exponential_map(
    displacement: Sequence[float | Float[Array, "..."]] | Float[Array, "..."], fraction: Float[Array, "*batch"]
) -> Float[Array, "..."]:
    """Return the planar pose ``(..., 3)`` reached after a fraction ``(...)`` of a constant twist."""
    parts = [displacement[i] for i in range(3)]
    xp = namespace(fraction, *parts)
    fraction = as_array(xp, fraction)
    x, y, yaw = (as_array(xp, part) * fraction for part in parts)
    half = yaw / 2
    # sin(yaw)/yaw and (1 - cos(yaw))/yaw, accurate to rounding at small angles too
    straight = _sinc(xp, yaw)
    aside = xp.sin(half) * _sinc(xp, half)
    return stack_last(xp, (x * straight - y * aside, x * aside + y * straight, yaw))


def _sinc(xp: Namespace, angle: Float[Array, "..."]) -> Float[Array, "..."]:
    # In this range the series and its derivative are accurate to rounding; the derivative of the quotient is not.
    small = xp.abs(angle) < 1e-2
    safe = xp.where(small, xp.ones_like(angle), angle)
    square = angle * angle
    return xp.where(small, 1 - square / 6 * (1 - square / 20 * (1 - square / 42)), xp.sin(safe) / safe)


def heading_to_ground(planar_pose: Float[Array, "..."], points: Float[Array, "..."]) -> Float[Array, "..."]:
    """Transform points ``(..., k, 3)`` from the heading frame at planar poses ``(..., 3)`` to G; heights are kept."""
    xp = namespace(planar_pose, points)
    pose, points = as_array(xp, planar_pose), as_array(xp, points)
    cos, sin = xp.cos(pose[..., None, 2]), xp.sin(pose[..., None, 2])
    x, y = points[..., 0], points[..., 1]
    moved = (pose[..., None, 0] + cos * x - sin * y, pose[..., None, 1] + sin * x + cos * y)
    return stack_last(xp, (*moved, points[..., 2] + xp.zeros_like(moved[0])))


def ground_to_heading(planar_pose: Float[Array, "..."], points: Float[Array, "..."]) -> Float[Array, "..."]:
    """Transform points ``(..., k, 3)`` from G to the heading frame at planar poses ``(..., 3)``; heights are kept."""
    xp = namespace(planar_pose, points)
    pose, points = as_array(xp, planar_pose), as_array(xp, points)
    cos, sin = xp.cos(pose[..., None, 2]), xp.sin(pose[..., None, 2])
    x, y = points[..., 0] - pose[..., None, 0], points[..., 1] - pose[..., None, 1]
    moved = (cos * x + sin * y, cos * y - sin * x)
    return stack_last(xp, (*moved, points[..., 2] + xp.zeros_like(moved[0])))


def straight_path(distance: float, heading: float = 0.0) -> BodyPath:
    """Return a straight path along which the body keeps its yaw (source 001's L and A).

    Parameters
    ----------
    distance : float
        Length [m].
    heading : float
        Direction relative to the body's front, counter-clockwise [rad]: pi/2 is to the left.

    Raises
    ------
    InputError
        If the distance is 0, or a value is not finite.
    """
    distance, heading = require_float("distance", distance), require_float("heading", heading)
    if not (math.isfinite(distance) and math.isfinite(heading)):
        raise InputError(f"the path's distance is {distance} m, its heading {heading} rad; both must be finite numbers")
    return BodyPath((distance * math.cos(heading), distance * math.sin(heading), 0.0))


def curved_path(angle: float, centre: tuple[float, float] = (0.0, 0.0)) -> BodyPath:
    """Return a path around a centre (source 001's A and C); around the body's origin the body turns on the spot.

    Parameters
    ----------
    angle : float
        Angle by which the body turns, counter-clockwise [rad].
    centre : tuple of float
        The centre in the heading frame at the start [m].

    Raises
    ------
    InputError
        If the angle is 0, or a value is not finite.
    """
    angle, (x, y) = require_float("angle", angle), (require_float("centre", value) for value in centre)
    return BodyPath((angle * y, -angle * x, angle))


def twist_path(vx: float, vy: float, wz: float, duration: float) -> BodyPath:
    """Return the path of a constant twist of the body.

    Parameters
    ----------
    vx, vy : float
        Velocity forward and to the left, in the heading frame [m/s].
    wz : float
        Yaw rate, counter-clockwise [rad/s].
    duration : float
        Duration at that speed [s]; start and stop add to it without changing the distance.

    Raises
    ------
    InputError
        If the twist is 0, a value is not finite, or the duration is not positive.
    """
    vx, vy, wz = (require_float("twist", value) for value in (vx, vy, wz))
    if not all(map(math.isfinite, (vx, vy, wz))):
        raise InputError(f"the twist is ({vx}, {vy}, {wz}); it must be three finite numbers")
    duration = require_float("duration", duration)
    if not 0 < duration < math.inf:
        raise InputError(f"the duration is {duration} s; it must be greater than 0 and finite")
    return BodyPath((vx * duration, vy * duration, wz * duration), duration=duration)
