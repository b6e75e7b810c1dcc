"""Where the body goes: straight, round a centre, or along a constant twist, from over the ground's origin.

Every path here is a screw of the plane: the exponential of a displacement ``(x, y, yaw)``, taken at a share from 0 to
1. A straight walk has no yaw; a walk round a centre `c` by an angle `a` is ``a (c_y, -c_x, 1)``.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tarsus.arrays import Array, Namespace, as_array, namespace, stack_last
from tarsus.errors import InputError

__all__ = ["BodyPath", "carry", "carry_back", "curved_path", "straight_path", "twist_path"]


@dataclass(frozen=True)
class BodyPath:
    """A path of the body over the ground.

    Attributes
    ----------
    displacement : tuple of float
        Exponential coordinates of the whole path: forward [m], left [m], yaw [rad]; all are of the start's frame.
    duration : float or None
        How long it takes at cruising speed [s]; None to leave that to the plan.
    """

    displacement: tuple[float, float, float]
    duration: float | None = None

    def __post_init__(self) -> None:
        values = tuple(float(v) for v in self.displacement)
        if len(values) != 3 or not all(map(math.isfinite, values)):
            raise InputError(f"a path's displacement is {self.displacement}; it must be three finite numbers")
        if not any(values):
            raise InputError("the path goes nowhere: distance, angle or speed must not be 0")
        object.__setattr__(self, "displacement", values)
        if self.duration is not None and not 0 < self.duration < math.inf:
            raise InputError(f"a path's duration is {self.duration} s; it must be greater than 0 and finite")

    @property
    def angle(self) -> float:
        """How far the body turns [rad]."""
        return self.displacement[2]

    def place(self, share: Array) -> Array:
        """Return where the body is after a share of the path.

        Parameters
        ----------
        share : array, shape (...)
            Shares of the path, 0 at its start, 1 at its end.

        Returns
        -------
        array, shape (..., 3)
            x [m], y [m] and yaw [rad] of the body's heading frame in G.
        """
        return exponential(self.displacement, share)

    def travel(self, feet: Array) -> Array:
        """Return how far each foot goes past the body over the whole path: what strokes are shares of.

        Parameters
        ----------
        feet : array, shape (..., legs, 2 or 3)
            Rest footholds in the heading frame [m].

        Returns
        -------
        array, shape (..., legs)
            Lengths of the straight lines or arcs [m].
        """
        x, y, yaw = self.displacement
        xp = namespace(feet)
        feet = as_array(xp, feet)
        across, along = x - yaw * feet[..., 1], y + yaw * feet[..., 0]
        return xp.hypot(across, along)


def exponential(displacement: Sequence[float] | Array, share: Array) -> Array:
    """Return the place ``(..., 3)`` reached after a share ``(...)`` of a constant twist."""
    parts = [displacement[i] for i in range(3)]
    xp = namespace(share, *parts)
    share = as_array(xp, share)
    x, y, yaw = (as_array(xp, part) * share for part in parts)
    half = yaw / 2
    # sin(yaw)/yaw and (1 - cos(yaw))/yaw, both exact to rounding at small angles
    straight = _sinc(xp, yaw)
    aside = xp.sin(half) * _sinc(xp, half)
    return stack_last(xp, (x * straight - y * aside, x * aside + y * straight, yaw))


def _sinc(xp: Namespace, angle: Array) -> Array:
    # The series is exact to rounding where it is taken, and so is its derivative; that of the quotient is not.
    small = xp.abs(angle) < 1e-2
    safe = xp.where(small, xp.ones_like(angle), angle)
    square = angle * angle
    return xp.where(small, 1 - square / 6 * (1 - square / 20 * (1 - square / 42)), xp.sin(safe) / safe)


def carry(place: Array, points: Array) -> Array:
    """Carry points ``(..., k, 3)`` from the heading frame at places ``(..., 3)`` into G; heights stay."""
    xp = namespace(place, points)
    place, points = as_array(xp, place), as_array(xp, points)
    cos, sin = xp.cos(place[..., None, 2]), xp.sin(place[..., None, 2])
    x, y = points[..., 0], points[..., 1]
    moved = (place[..., None, 0] + cos * x - sin * y, place[..., None, 1] + sin * x + cos * y)
    return stack_last(xp, (*moved, points[..., 2] + xp.zeros_like(moved[0])))


def carry_back(place: Array, points: Array) -> Array:
    """Carry points ``(..., k, 3)`` from G into the heading frame at places ``(..., 3)``."""
    xp = namespace(place, points)
    place, points = as_array(xp, place), as_array(xp, points)
    cos, sin = xp.cos(place[..., None, 2]), xp.sin(place[..., None, 2])
    x, y = points[..., 0] - place[..., None, 0], points[..., 1] - place[..., None, 1]
    moved = (cos * x + sin * y, cos * y - sin * x)
    return stack_last(xp, (*moved, points[..., 2] + xp.zeros_like(moved[0])))


def straight_path(distance: float, heading: float = 0.0) -> BodyPath:
    """Return a straight path; the body keeps facing forward (source 001's L and A).

    Parameters
    ----------
    distance : float
        How far [m].
    heading : float
        Direction from the body's front, counter-clockwise [rad]: pi/2 walks to the left.

    Raises
    ------
    InputError
        If the distance is 0, or a value is not finite.
    """
    if not (math.isfinite(distance) and math.isfinite(heading)):
        raise InputError(f"the path's distance is {distance} m, its heading {heading} rad; both must be finite numbers")
    return BodyPath((distance * math.cos(heading), distance * math.sin(heading), 0.0))


def curved_path(angle: float, centre: tuple[float, float] = (0.0, 0.0)) -> BodyPath:
    """Return a path round a centre (source 001's A and C); round the body's own origin it turns on the spot.

    Parameters
    ----------
    angle : float
        How far round, counter-clockwise [rad].
    centre : tuple of float
        The centre in the body frame at the start [m].

    Raises
    ------
    InputError
        If the angle is 0, or a value is not finite.
    """
    return BodyPath((angle * centre[1], -angle * centre[0], angle))


def twist_path(vx: float, vy: float, wz: float, duration: float) -> BodyPath:
    """Return the path of a constant twist of the body.

    Parameters
    ----------
    vx, vy : float
        Speed forward and to the left, in the body's own frame [m/s].
    wz : float
        Turning speed, counter-clockwise [rad/s].
    duration : float
        For how long at that speed [s]; starting and stopping comes on top, the distance stays.

    Raises
    ------
    InputError
        If there is no motion, or a value is not finite or the duration not positive.
    """
    if not np.isfinite([vx, vy, wz]).all():
        raise InputError(f"the twist is ({vx}, {vy}, {wz}); it must be three finite numbers")
    if not 0 < duration < math.inf:
        raise InputError(f"the duration is {duration} s; it must be greater than 0 and finite")
    return BodyPath((vx * duration, vy * duration, wz * duration), duration=duration)
