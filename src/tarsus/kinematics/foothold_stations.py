"""Body heights at which footholds must change during a vertical motion of the body.

At each body height, each leg reaches the ground in a band of distances straight out from its coxa axis. Footholds that
are in all bands from one height to another can be kept over that motion. Where none are, the legs change their
footholds in between, as seldom as possible: the plan goes backwards from the end, and keeps each set of footholds for
as long as the legs reach it.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, Self

import numpy as np

from tarsus.errors import UnreachableError
from tarsus.kinematics.stance import foothold_distances, reachable_band
from tarsus.kinematics.underside import belly_depth
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["FootholdStation", "foothold_stations"]

# Spacing of the body heights that are evaluated [m].
_HEIGHT_STEP = 0.0025
# Distance of footholds from the ends of a band [m].
_INSET = 0.001
# Least distance of a foot from the femur axis beside a lying body, as a fraction of femur and tibia.
_MIN_DISTANCE_LYING = 0.1
# Tolerance of distances [m].
_TOLERANCE = 1e-9


class FootholdStation(NamedTuple):
    """A body height and the footholds from there on.

    Attributes
    ----------
    height : float
        Body height [m].
    distances : array, shape (legs,)
        Distance of each foothold from its coxa axis along the plane of the leg [m].
    """

    height: float
    distances: Float[np.ndarray, "legs"]


class _Bands(NamedTuple):
    """Ends of the bands at some body heights: reachable on the ground, and both there and at swing height [m]."""

    heights: Float[np.ndarray, "n"]
    near: Float[np.ndarray, "n legs"]
    far: Float[np.ndarray, "n legs"]
    near_lifted: Float[np.ndarray, "n legs"]
    far_lifted: Float[np.ndarray, "n legs"]

    @classmethod
    def of(cls, robot: Robot, heights: Float[np.ndarray, "n"], swing_height: float) -> Self:
        near, far = _inset_band(robot, -heights)
        if heights[0] <= belly_depth(robot) + _TOLERANCE:
            # A foothold right under the folded leg of a lying robot is not accessible through the air.
            least = robot.coxa + _MIN_DISTANCE_LYING * (robot.femur + robot.tibia)
            near[0] = np.where(least <= far[0], np.maximum(near[0], least), near[0])
        near_lifted, far_lifted = _inset_band(robot, swing_height - heights)
        return cls(heights, near, far, np.fmax(near, near_lifted), np.fmin(far, far_lifted))

    def lowest_index(self, distances: Float[np.ndarray, "legs"], start: int) -> int:
        """Return the lowest index down to which footholds can be kept from `start`; `start` + 1 if not even there."""
        near, far = self.near[: start + 1], self.far[: start + 1]
        within = (distances >= near - _TOLERANCE) & (distances <= far + _TOLERANCE)
        failing = np.flatnonzero(~within.all(-1))
        return int(failing[-1]) + 1 if failing.size else 0

    def change_at(
        self, index: int, distances: Float[np.ndarray, "legs"]
    ) -> tuple[int, Float[np.ndarray, "legs"]] | None:
        """Return the lowest index down to which footholds changed to at `index` can be kept, and these; else None."""
        low, high = self.near_lifted[index], self.far_lifted[index]
        if not ((distances >= low - _TOLERANCE) & (distances <= high + _TOLERANCE)).all():
            return None
        for lower in range(index, -1, -1):
            next_low, next_high = np.maximum(low, self.near[lower]), np.minimum(high, self.far[lower])
            if not (next_low <= next_high).all():
                return lower + 1, (low + high) / 2
            low, high = next_low, next_high
        return 0, (low + high) / 2


def _inset_band(
    robot: Robot, height: Float[np.ndarray, "batch"]
) -> tuple[Float[np.ndarray, "batch legs"], Float[np.ndarray, "batch legs"]]:
    """Return the bands, reduced at both ends; empty (inf, -inf) where the ground is out of reach."""
    near, far = (np.asarray(ends) for ends in reachable_band(robot, height))
    inset = np.minimum(_INSET, (far - near) / 10)
    return np.nan_to_num(near + inset, nan=np.inf), np.nan_to_num(far - inset, nan=-np.inf)


def foothold_stations(
    robot: Robot, start: float, end: float, feet: Float[np.ndarray, "legs 3"], *, swing_height: float
) -> tuple[FootholdStation, ...]:
    """Return the body heights at which the footholds change on a vertical motion, with the new footholds.

    Parameters
    ----------
    robot : Robot
        A single robot.
    start, end : float
        Body heights at the start and at the end [m].
    feet : array, shape (legs, 3)
        Footholds in B at the end [m].
    swing_height : float
        Swing height of feet that change their foothold [m].

    Returns
    -------
    tuple of FootholdStation
        The first is at the start height; the last has the footholds of the end. The body moves from the height of each
        station to that of the next one, and from the last one to the end.

    Raises
    ------
    UnreachableError
        If there are no such stations: which leg fails, at what height and by how much.
    """
    count = 2 + math.ceil(abs(end - start) / _HEIGHT_STEP)
    bands = _Bands.of(robot, np.linspace(start, end, count), swing_height)
    distances, index, stations = foothold_distances(robot, feet), count - 1, []
    while True:
        lowest = bands.lowest_index(distances, index)
        if not lowest:
            stations.append(FootholdStation(start, distances))
            return tuple(stations[::-1])
        candidates = range(min(lowest, index), index + 1)
        changes = [(change, at) for at in candidates if (change := bands.change_at(at, distances))]
        (reached, other), at = min(changes, key=lambda c: (c[0][0], c[1]), default=((lowest, distances), index))
        if reached >= lowest:
            raise UnreachableError(_reason(robot, bands, distances, max(lowest - 1, 0)))
        stations.append(FootholdStation(float(bands.heights[at]), distances))
        distances, index = other, at


def _reason(robot: Robot, bands: _Bands, distances: Float[np.ndarray, "legs"], index: int) -> str:
    """Return which leg cannot reach its foothold at a height, and by how much."""
    excess = np.maximum(bands.near[index] - distances, distances - bands.far[index])
    leg = int(np.argmax(excess))
    text = f"at body height {bands.heights[index] * 1000:.1f} mm, leg {robot.leg_names[leg]} cannot reach the ground"
    if not math.isfinite(excess[leg]):
        return f"{text} at any distance, and no other footholds avoid this height"
    near, far = bands.near[index, leg] * 1000, bands.far[index, leg] * 1000
    side = "near" if distances[leg] < bands.near[index, leg] else "far"
    return (
        f"{text} {distances[leg] * 1000:.1f} mm from its coxa axis: {excess[leg] * 1000:.1f} mm too {side}, it reaches "
        f"from {near:.1f} to {far:.1f} mm; no intermediate footholds lead past this height"
    )
