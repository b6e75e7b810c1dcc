"""Order of switching the joints off while the robot lies on its belly, and what falls."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import Array, read_only
from tarsus.control.startup.builder import SequenceBuilder
from tarsus.control.startup.initial_state import lying_state, measured_state
from tarsus.kinematics.leg_path import LegFreeSpace
from tarsus.representation import represented
from tarsus.robot.robot import JOINTS, Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["PowerOffOrder", "power_off_order"]

# Step of the femur angle while a leg that is switched off falls [rad].
_ANGLE_STEP = np.deg2rad(0.25)
# Least drop that is reported [m].
_MIN_DROP = 0.001


@represented()
@dataclass(frozen=True, eq=False, kw_only=True)
class PowerOffOrder:
    """Order in which joints are switched off, and how far legs drop.

    Attributes
    ----------
    order : tuple of (leg, joint)
        Indices of legs and joints: all coxae, then all femurs, then all tibiae.
    drop : array, shape (legs, 3)
        Drop when the joint is switched off in that order: for femurs that of foot or knee, whichever is greater, for
        tibiae that of the knee, for coxae 0 [m].
    falls : tuple of str
        One line for each drop of at least a millimetre.
    """

    order: tuple[tuple[int, int], ...]
    drop: Float[np.ndarray, "legs 3"]
    falls: tuple[str, ...]


def power_off_order(robot: Robot, angles: Float[Array, "legs 3"]) -> PowerOffOrder:
    """Return the order in which to switch off the joints of a robot that lies on its belly.

    The feet bear no load, so each joint holds at most the weight of its own leg from there outward. The coxae come
    first: their axes are vertical, so weight causes no torque about them. Then the femurs: a leg with its tibia held
    turns about the femur axis only until its foot or knee is on the ground. The tibiae come last: the knee sinks to the
    ground while the foot slides outward. Nothing falls if the foot is on the ground and the knee at its lowest.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Joint angles with which the robot rests on its belly [rad].

    Raises
    ------
    InputError
        If the robot is a batch, or the angles have the wrong shape or are not finite.
    TarsusError
        If the robot does not lie on its belly.
    """
    state = lying_state(measured_state(robot, angles), purpose="switching its joints off")
    drop = np.array([(0.0, *_drops(state, leg)) for leg in range(robot.legs)])
    return PowerOffOrder(
        order=tuple((leg, joint) for joint in range(3) for leg in range(robot.legs)),
        drop=read_only(drop),
        falls=tuple(
            f"{robot.leg_names[leg]}: with the {JOINTS[joint]} off, the {('', 'foot', 'knee')[joint]} drops by "
            f"{drop[leg, joint] * 1000:.0f} mm"
            for joint in (1, 2)
            for leg in np.flatnonzero(drop[:, joint] >= _MIN_DROP)
        ),
    )


def _drops(state: SequenceBuilder, leg: int) -> tuple[float, float]:
    """Return the drop of the leg once its femur is off, and then that of its knee once the tibia is off too [m]."""
    coxa, femur, tibia = state.angles[leg]
    low = min(float(state.robot.limits[leg, 1, 0]), femur)
    turned = np.array([[coxa, angle, tibia] for angle in np.arange(femur, low - _ANGLE_STEP, -_ANGLE_STEP)])
    heights = LegFreeSpace.of(state.robot, leg, state.body).heights(turned)
    # The leg turns about the femur axis until knee or foot touches the ground, or until it is at its lowest.
    stops = np.flatnonzero((heights.min(-1)[1:] < 0) | (np.diff(heights.mean(-1)) > 0))
    last = int(stops[0]) if stops.size else len(turned) - 1
    knee = heights[last, 0]
    lowest = max(float(heights[:, 0].min()), 0.0)
    return max(float((heights[0] - heights[last]).max()), 0.0), max(knee - lowest, 0.0)
