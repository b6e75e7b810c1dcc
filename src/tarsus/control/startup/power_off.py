"""In which order the joints may be released when the robot sits, and what then falls."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tarsus.arrays import Array
from tarsus.control.startup.leg_path import LegFreeSpace
from tarsus.control.startup.planner import lying
from tarsus.robot.robot import JOINTS, Robot

__all__ = ["PowerOffOrder", "power_off_order"]

Floats = np.ndarray[Any, np.dtype[np.float64]]

# How finely a falling joint is followed [rad], and the least fall that is told of [m].
_STEP = np.deg2rad(0.25)
_TOLD = 0.001


@dataclass(frozen=True, eq=False, kw_only=True)
class PowerOffOrder:
    """The order in which joints are released, and how far what each of them held then falls.

    Attributes
    ----------
    order : tuple of (leg, joint)
        Numbers of the legs and joints: all coxae, then all femurs, then all tibiae.
    drop : array, shape (legs, 3)
        How far knee or foot of the leg goes down when the joint is released in that order [m].
    falls : tuple of str
        A line for each joint with a drop of a millimetre or more; empty where nothing falls.
    """

    order: tuple[tuple[int, int], ...]
    drop: Floats
    falls: tuple[str, ...]


def power_off_order(robot: Robot, angles: Array) -> PowerOffOrder:
    """Return in which order to release the joints of a robot that lies on its belly.

    With the belly on the ground the feet bear nothing, and each joint holds no more than the weight of its own leg
    from there outwards. So: first the coxae, whose axes are upright, so that weight has no moment about them. Then the
    femurs: a leg whose tibia is still held leans on its foot as on a strut, and falls only as far as its foot is above
    the ground. The tibiae last: now the knee sinks to the ground, the foot slipping outwards. Nothing falls where the
    foot is on the ground and the knee is as low as it gets.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Joint angles; with them, the robot must rest on its belly [rad].

    Raises
    ------
    InputError
        If the robot is a batch, or the angles have another shape, or are not finite.
    TarsusError
        If the robot does not lie on its belly: it says how far the body would fall.
    """
    draft = lying(robot, angles, "have its joints released without a fall of its body")
    drop = np.zeros((robot.legs, 3))
    for leg in range(robot.legs):
        drop[leg, 1:] = _drops(robot, leg, LegFreeSpace.of(robot, leg, draft.body), draft.angles[leg])
    drop.setflags(write=False)
    return PowerOffOrder(
        order=tuple((leg, joint) for joint in range(3) for leg in range(robot.legs)),
        drop=drop,
        falls=tuple(
            f"{robot.leg_names[leg]}: with the {JOINTS[joint]} released, the {('', 'foot', 'knee')[joint]} falls "
            f"{drop[leg, joint] * 1000:.0f} mm"
            for joint in (1, 2)
            for leg in np.flatnonzero(drop[:, joint] >= _TOLD)
        ),
    )


def _drops(robot: Robot, leg: int, space: LegFreeSpace, angles: Floats) -> tuple[float, float]:
    """Return how far the leg falls with its femur released, and then its knee with the tibia released as well [m]."""
    coxa, femur, tibia = angles
    low = min(float(robot.limits[leg, 1, 0]), femur)
    turned = np.array([[coxa, f, tibia] for f in np.arange(femur, low - _STEP, -_STEP)])
    heights = space.heights(turned)
    # It turns about the femur axis until a point touches the ground, or falls no further.
    stops = np.flatnonzero((heights.min(-1)[1:] < 0) | (np.diff(heights.mean(-1)) > 0))
    last = int(stops[0]) if stops.size else len(turned) - 1
    knee = heights[last, 0]
    lowest = max(float(heights[:, 0].min()), 0.0)
    return max(float((heights[0] - heights[last]).max()), 0.0), max(knee - lowest, 0.0)
