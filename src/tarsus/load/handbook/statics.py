"""Comparison of the hand calculation with the static joint torques of a planned walk."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import Array
from tarsus.gait.gait import Gait
from tarsus.gait.path import straight_path
from tarsus.gait.plan import plan_walk
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.load.contact import contact_forces
from tarsus.load.handbook.comparison import ACCELERATING, STANDING, SWINGING, WALKING, Comparison, ComparisonRow
from tarsus.load.handbook.method import Handbook, handbook
from tarsus.load.torque import joint_torques
from tarsus.robot.robot import JOINTS, Robot, require_robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["compare_with_statics", "minimal_contacts"]


def compare_with_statics(
    robot: Robot,
    *,
    gait: Gait | str = "tripod",
    distance: float = 1.0,
    heading: float = 0.0,
    stroke: float | None = None,
    body_height: float | None = None,
    gravity: float = 9.8,
    acceleration: float = 1.0,
    safety_factor: float = 3.0,
) -> Comparison:
    """Compare the hand method with the torques of `joint_torques`, standing and over a planned straight walk.

    Standing: in the stance of the walk, on the feet of the gait's worst contact pattern. Walking: the stance legs on
    level ground at constant speed. Accelerating: the same with tangential contact forces that accelerate or decelerate
    the whole robot; the motion of the links relative to the body is ignored. Leg in swing: the swing legs, held against
    gravity.

    Parameters
    ----------
    robot : Robot
        A single robot with masses.
    gait : Gait or str
        Gait or its name; it determines the number of feet on the ground.
    distance : float
        Walking distance [m].
    heading : float
        Direction of walking, from the robot's front [rad].
    stroke, body_height : float, optional
        As in `plan_walk` [m].
    gravity : float
        Magnitude of gravity in both methods [m/s^2]; 9.8 in the source.
    acceleration : float
        Acceleration and deceleration of the body [m/s^2].
    safety_factor : float
        Safety factor of the hand method.

    Raises
    ------
    MissingDataError
        If the robot's masses are unknown.
    InputError
        If an argument is out of range, or the gait has fewer than three feet on the ground.
    UnreachableError
        If a foot of the walk is out of reach.
    """
    require_robot(robot)
    gait = Gait.named(gait, legs=robot.legs) if isinstance(gait, str) else gait
    hand = handbook(
        robot,
        feet_down=gait.fewest_feet_down,
        gravity=gravity,
        acceleration=acceleration,
        safety_factor=safety_factor,
    )
    motion = plan_walk(robot, gait, straight_path(distance, heading), stroke=stroke, body_height=body_height)
    gravity_vector, acceleration_vector = (
        np.array([0.0, 0.0, -gravity]),
        acceleration * np.array([math.cos(heading), math.sin(heading), 0.0]),
    )
    stance = _LoadCase.of(robot, motion.angles[0], motion.body[0], minimal_contacts(gait), [gravity_vector])
    walk = _LoadCase.of(robot, motion.angles, motion.body, motion.contacts, [gravity_vector])
    accelerated = _LoadCase.of(
        robot,
        motion.angles,
        motion.body,
        motion.contacts,
        [gravity_vector - acceleration_vector, gravity_vector + acceleration_vector],
    )
    statics = {
        STANDING: (stance, None),
        WALKING: (walk, motion.time),
        ACCELERATING: (accelerated, np.tile(motion.time, 2)),
    }
    return Comparison(
        hand=hand,
        motion=motion,
        rows=tuple(_torque_rows(hand, statics)),
        reasons=tuple(_reason_rows(hand, statics)),
        acceleration=acceleration,
        margin={case: float(case_loads.margin.min()) for case, (case_loads, _) in statics.items()},
    )


def minimal_contacts(gait: Gait) -> Bool[np.ndarray, "patterns legs"]:
    """Return the contact patterns of a gait with the fewest feet on the ground, ``(patterns, legs)``.

    Parameters
    ----------
    gait : Gait
        The gait.
    """
    events = np.unique(np.array([[offset, offset + gait.duty_factor] for offset in gait.offsets]) % 1.0)
    ends = np.append(events, events[0] + 1)
    contacts = np.asarray(gait.phase((ends[1:] + ends[:-1])[np.diff(ends) > 1e-6] / 2)[2])
    return np.unique(contacts[contacts.sum(-1) == contacts.sum(-1).min()], axis=0)


@dataclass(frozen=True, kw_only=True)
class _LoadCase:
    """Absolute torques, foot loads and lever arms, for each gravity vector in turn."""

    torques: Float[np.ndarray, "*batch phases legs 3"]  # (n, legs, 3) [N m]
    contacts: Bool[np.ndarray, "... legs"]  # (n, legs)
    load: Float[np.ndarray, "... phases legs"]  # (n, legs), along gravity [N]
    femur_arm: Float[np.ndarray, "... phases legs"]  # (n, legs), horizontal, from the femur axis to the foot [m]
    knee_arm: Float[np.ndarray, "... phases legs"]  # (n, legs), horizontal, from the knee to the foot [m]
    margin: Float[np.ndarray, "..."]  # (n,), of the load in the support polygon [m]

    @classmethod
    def of(
        cls,
        robot: Robot,
        angles: Float[Array, "*#batch legs 3"],
        body: Pose,
        contacts: Bool[np.ndarray, "*#batch legs"],
        gravities: list[Float[np.ndarray, "... 3"]],
    ) -> _LoadCase:
        points = forward_kinematics(robot, angles)
        flat = points[..., :2] - points[..., 3:, :2]
        arms = np.broadcast_to(np.hypot(flat[..., 0], flat[..., 1]), (*contacts.shape, 4))
        torques, loads, margins = [], [], []
        for gravity in gravities:
            solved = contact_forces(robot, angles, body, contacts, gravity=tuple(gravity), points=points)
            torque, _ = joint_torques(robot, angles, body, contacts, gravity=tuple(gravity), forces=solved.forces)
            torques.append(np.abs(torque))
            loads.append(np.linalg.norm(solved.forces, axis=-1))
            margins.append(solved.margin)
        repeats = len(gravities)
        return cls(
            torques=np.concatenate(torques),
            contacts=np.tile(contacts, (repeats, 1)),
            load=np.concatenate(loads),
            femur_arm=np.tile(arms[..., 1], (repeats, 1)),
            knee_arm=np.tile(arms[..., 2], (repeats, 1)),
            margin=np.concatenate(margins),
        )


def _torque_rows(
    hand: Handbook, statics: Mapping[str, tuple[_LoadCase, Float[np.ndarray, "..."] | None]]
) -> Iterator[ComparisonRow]:
    for case, (case_loads, time) in statics.items():
        for i, joint in enumerate(JOINTS):
            if (case, joint) != (STANDING, "coxa"):
                peak = (case_loads.torques[..., i], case_loads.contacts, time)
                yield _row(hand, case, joint, "N m", hand.torque(joint), peak, factor=hand.safety_factor)
    walk, time = statics[WALKING]
    for joint in ("femur", "tibia"):
        peak = (walk.torques[..., JOINTS.index(joint)], ~walk.contacts, time)
        yield _row(hand, SWINGING, joint, "N m", hand.value(f"swing.{joint}"), peak, factor=hand.safety_factor)


def _reason_rows(
    hand: Handbook, statics: Mapping[str, tuple[_LoadCase, Float[np.ndarray, "..."] | None]]
) -> Iterator[ComparisonRow]:
    arm = hand.value("given.L_coxa") + hand.value("given.R_b")
    for case in (STANDING, WALKING):
        case_loads, time = statics[case]
        for quantity, unit, value, values in (
            ("foot load", "N", hand.value("stance.load"), case_loads.load),
            ("lever arm about the femur axis", "m", arm, case_loads.femur_arm),
            ("lever arm about the knee", "m", arm + hand.value("given.L_femur_out"), case_loads.knee_arm),
        ):
            yield _row(hand, case, quantity, unit, value, (values, case_loads.contacts, time), factor=1.0)


def _row(
    hand: Handbook,
    case: str,
    quantity: str,
    unit: str,
    value: float,
    peak: tuple[Float[np.ndarray, "... legs"], Bool[np.ndarray, "... legs"], Float[np.ndarray, "..."] | None],
    *,
    factor: float,
) -> ComparisonRow:
    """Return the row of the largest value among the selected legs."""
    values, selected, time = peak
    values = np.where(selected, values, -1.0)
    # The first of equal values, regardless of rounding.
    sample, leg = np.unravel_index(int(np.argmax(values >= values.max() * (1 - 1e-6))), values.shape)
    return ComparisonRow(
        case=case,
        quantity=quantity,
        unit=unit,
        hand=value,
        statics=float(values[sample, leg]),
        factor=factor,
        leg=hand.robot.leg_codes[int(leg)],
        time=None if time is None else float(time[sample]),
    )
