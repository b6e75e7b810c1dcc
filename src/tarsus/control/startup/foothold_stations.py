"""How high the body can be pushed straight up from given footholds, and where to change them on the way.

At every height, each leg reaches the ground in a band of distances straight out from its coxa axis. Footholds that are
in all bands from one height to another carry the body all that way; where none are, the legs change footholds in
between, as seldom as possible: from the end of the way backwards, each time as far as footholds reach.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple, Self

import numpy as np

from tarsus.control.startup.folded_pose import belly_depth
from tarsus.errors import UnreachableError
from tarsus.kinematics.stance import reachable_band
from tarsus.kinematics.triangle import to_leg_frame
from tarsus.robot.robot import Robot

__all__ = ["FootholdStation", "foothold_distances", "footholds", "stations"]

Floats = np.ndarray[Any, np.dtype[np.float64]]

# Spacing of the heights that are looked at, and how far from the ends of a band a foothold keeps [m].
_STEP = 0.0025
_INSET = 0.001
# How far from the femur axis feet are put down beside a lying body, as a share of femur and tibia.
_BESIDE = 0.1
# What rounding may add to a distance [m].
_ROUNDING = 1e-9


class FootholdStation(NamedTuple):
    """A height of the body's origin [m], and the footholds from there on, as `foothold_distances` ``(legs,)`` [m]."""

    height: float
    out: Floats


@dataclass(frozen=True, eq=False)
class _Bands:
    """The bands of distances ``(n, legs)`` [m] at heights ``(n,)`` [m], on the ground and for lifted feet alike."""

    heights: Floats
    near: Floats
    far: Floats
    near_lifted: Floats
    far_lifted: Floats

    @classmethod
    def of(cls, robot: Robot, heights: Floats, swing_height: float) -> Self:
        near, far = _band(robot, -heights)
        if heights[0] <= belly_depth(robot) + _ROUNDING:
            # Beside the lying body: a foot right under its folded leg would have no way there through the air.
            beside = robot.coxa + _BESIDE * (robot.femur + robot.tibia)
            near[0] = np.where(beside <= far[0], np.maximum(near[0], beside), near[0])
        near_lifted, far_lifted = _band(robot, swing_height - heights)
        return cls(heights, near, far, np.fmax(near, near_lifted), np.fmin(far, far_lifted))

    def reach_down(self, out: Floats, start: int) -> int:
        """Return how far down the way, to which index, the footholds carry from `start`; `start` + 1 for not at all."""
        within = (out >= self.near[: start + 1] - _ROUNDING) & (out <= self.far[: start + 1] + _ROUNDING)
        failing = np.flatnonzero(~within.all(-1))
        return int(failing[-1]) + 1 if failing.size else 0

    def change_at(self, index: int, out: Floats) -> tuple[int, Floats] | None:
        """Return how far down other footholds carry from a change at `index`, and which; None if feet can't change."""
        low, high = self.near_lifted[index], self.far_lifted[index]
        if not ((out >= low - _ROUNDING) & (out <= high + _ROUNDING)).all():
            return None
        for down in range(index, -1, -1):
            lower, higher = np.maximum(low, self.near[down]), np.minimum(high, self.far[down])
            if not (lower <= higher).all():
                return down + 1, (low + high) / 2
            low, high = lower, higher
        return 0, (low + high) / 2


def _band(robot: Robot, height: Floats) -> tuple[Floats, Floats]:
    """Return the bands, a little within their ends; empty where there is none."""
    near, far = (np.asarray(ends) for ends in reachable_band(robot, height))
    inset = np.minimum(_INSET, (far - near) / 10)
    return np.nan_to_num(near + inset, nan=np.inf), np.nan_to_num(far - inset, nan=-np.inf)


def stations(
    robot: Robot, start: float, end: float, feet: Floats, *, swing_height: float
) -> tuple[FootholdStation, ...]:
    """Return where the body is pushed straight up (or let down), and where the legs change their footholds.

    Parameters
    ----------
    robot : Robot
        A single robot.
    start, end : float
        Heights of the body's origin over the ground [m].
    feet : array, shape (legs, 3)
        The footholds in B that it is to end on [m].
    swing_height : float
        How high a foot is lifted that changes its foothold [m].

    Returns
    -------
    tuple of Station
        The first has the start's height; the last holds the footholds to end on. The body goes from each
        station's height to that of the next, and from the last one's to the end.

    Raises
    ------
    UnreachableError
        If there is no such way; the message says which leg ends it, at what height and by how much.
    """
    count = 2 + math.ceil(abs(end - start) / _STEP)
    bands = _Bands.of(robot, np.linspace(start, end, count), swing_height)
    out, index, way = foothold_distances(robot, feet), count - 1, []
    while True:
        down = bands.reach_down(out, index)
        if not down:
            way.append(FootholdStation(start, out))
            return tuple(way[::-1])
        changes = [(change, at) for at in range(min(down, index), index + 1) if (change := bands.change_at(at, out))]
        (reached, other), at = min(changes, key=lambda c: (c[0][0], c[1]), default=((down, out), index))
        if reached >= down:
            raise UnreachableError(_why(robot, bands, out, max(down - 1, 0)))
        way.append(FootholdStation(float(bands.heights[at]), out))
        out, index = other, at


def _why(robot: Robot, bands: _Bands, out: Floats, index: int) -> str:
    """Say which leg can't be on its foothold at a height, and by how much."""
    short = np.maximum(bands.near[index] - out, out - bands.far[index])
    leg = int(np.argmax(short))
    at = f"leg {robot.leg_names[leg]} can't stand {out[leg] * 1000:.1f} mm from its coxa axis"
    height = f"with the body's origin {bands.heights[index] * 1000:.1f} mm up"
    near, far = bands.near[index, leg] * 1000, bands.far[index, leg] * 1000
    if not math.isfinite(short[leg]):
        return f"{at} {height}: there it reaches the ground nowhere; and there is no other foothold on the way"
    return (
        f"{at} {height}: {short[leg] * 1000:.1f} mm too {'near' if out[leg] < bands.near[index, leg] else 'far'}, it "
        f"reaches from {near:.1f} to {far:.1f} mm there; and no foothold between leads past that height"
    )


def foothold_distances(robot: Robot, feet: Floats) -> Floats:
    """Return how far from its coxa axis each foot in B is along the plane of its leg, ``(legs,)`` [m]."""
    g = robot.geometry
    x, y, _ = to_leg_frame(g, feet[:, 0], feet[:, 1], feet[:, 2])
    found: Floats = np.sqrt(np.maximum(x * x + y * y - g.side2, 0.0))
    return found


def footholds(robot: Robot, out: Floats, height: float) -> Floats:
    """Return the feet in B, straight out at given `foothold_distances`, for a body height ``(legs, 3)`` [m]."""
    g = robot.geometry
    coxa = np.clip(0.0, g.coxa_lower, g.coxa_upper)
    x, y = out * np.cos(coxa) - g.side * np.sin(coxa), out * np.sin(coxa) + g.side * np.cos(coxa)
    across = (g.mount_x + g.cos_yaw * x - g.sin_yaw * y, g.mount_y + g.sin_yaw * x + g.cos_yaw * y)
    return np.stack([*across, np.full_like(x, -height)], axis=-1)
