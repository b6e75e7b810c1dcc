"""The hand method beside the statics: the torques of a planned walk against the lines of the hand calculation."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from tarsus.arrays import Array
from tarsus.gait.gait import Gait
from tarsus.gait.path import straight_path
from tarsus.gait.plan import plan_walk
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.load.contact import contact_forces
from tarsus.load.handbook.comparison import SPEEDING, STANDING, SWINGING, WALKING, Comparison, ComparisonRow
from tarsus.load.handbook.method import Handbook, handbook
from tarsus.load.torque import joint_torques
from tarsus.robot.robot import JOINTS, Robot

__all__ = ["compare_with_statics", "fewest_down"]

Floats = np.ndarray[Any, np.dtype[np.float64]]
Bools = np.ndarray[Any, np.dtype[np.bool_]]


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

    Standing: in the stance of the walk, with only those feet down that the gait leaves down, the worst of its
    patterns. Walking: the feet that are down, level, at an even pace. Speeding up: the same with the ground's forces
    leaning forward or back, for an acceleration of the whole robot; the links' own motion against it is left out.
    In the air: the swinging legs, held against gravity.

    Parameters
    ----------
    robot : Robot
        A single robot with masses.
    gait : Gait or str
        The gait, or its name; with it the number of feet down.
    distance, heading : float
        How far it walks [m], and in which direction from its front [rad].
    stroke, body_height : float, optional
        As in `plan_walk` [m].
    gravity : float
        Strength of gravity [m/s^2]: in both methods the source's 9.8 where left out.
    acceleration : float
        With what the body speeds up and brakes [m/s^2].
    safety_factor : float
        The hand method's factor.

    Raises
    ------
    MissingDataError
        If the robot's masses are unknown.
    InputError
        If an argument is out of its range, or the gait leaves less than three feet down.
    UnreachableError
        If the walk can't be walked.
    """
    gait = Gait.named(gait, legs=robot.legs) if isinstance(gait, str) else gait
    hand = handbook(
        robot,
        feet_down=gait.fewest_feet_down,
        gravity=gravity,
        acceleration=acceleration,
        safety_factor=safety_factor,
    )
    motion = plan_walk(robot, gait, straight_path(distance, heading), stroke=stroke, body_height=body_height)
    down, push = np.array([0.0, 0.0, -gravity]), acceleration * np.array([math.cos(heading), math.sin(heading), 0.0])
    stance = _Statics.of(robot, motion.angles[0], motion.body[0], fewest_down(gait), [down])
    walk = _Statics.of(robot, motion.angles, motion.body, motion.contacts, [down])
    speed = _Statics.of(robot, motion.angles, motion.body, motion.contacts, [down - push, down + push])
    statics = {STANDING: (stance, None), WALKING: (walk, motion.time), SPEEDING: (speed, np.tile(motion.time, 2))}
    return Comparison(
        hand=hand,
        motion=motion,
        rows=tuple(_torque_rows(hand, statics)),
        reasons=tuple(_reason_rows(hand, statics)),
        acceleration=acceleration,
        margin={case: float(each.margin.min()) for case, (each, _) in statics.items()},
    )


def fewest_down(gait: Gait) -> Bools:
    """Return every pattern of the gait's feet on the ground that has the fewest of them ``(patterns, legs)``.

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
class _Statics:
    """What the joints bear, without signs, and what that comes from; under each gravity in turn."""

    torques: Floats  # (n, legs, 3)
    contacts: Bools  # (n, legs)
    load: Floats  # (n, legs), along gravity
    femur_arm: Floats  # (n, legs), from the femur axis to the foot, seen from above
    knee_arm: Floats
    margin: Floats  # (n,)

    @classmethod
    def of(cls, robot: Robot, angles: Array, body: Pose, contacts: Bools, gravities: list[Floats]) -> _Statics:
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


def _torque_rows(hand: Handbook, statics: Mapping[str, tuple[_Statics, Floats | None]]) -> Iterator[ComparisonRow]:
    for case, (each, time) in statics.items():
        for i, joint in enumerate(JOINTS):
            if (case, joint) != (STANDING, "coxa"):
                peak = (each.torques[..., i], each.contacts, time)
                yield _row(hand, case, joint, "N m", hand.torque(joint), peak, factor=hand.safety_factor)
    walk, time = statics[WALKING]
    for joint in ("femur", "tibia"):
        peak = (walk.torques[..., JOINTS.index(joint)], ~walk.contacts, time)
        yield _row(hand, SWINGING, joint, "N m", hand.value(f"swing.{joint}"), peak, factor=hand.safety_factor)


def _reason_rows(hand: Handbook, statics: Mapping[str, tuple[_Statics, Floats | None]]) -> Iterator[ComparisonRow]:
    arm = hand.value("given.L_coxa") + hand.value("given.R_b")
    for case in (STANDING, WALKING):
        each, time = statics[case]
        for quantity, unit, value, found in (
            ("load of a foot", "N", hand.value("stance.load"), each.load),
            ("arm about the femur axis", "m", arm, each.femur_arm),
            ("arm about the knee", "m", arm + hand.value("given.L_femur_out"), each.knee_arm),
        ):
            yield _row(hand, case, quantity, unit, value, (found, each.contacts, time), factor=1.0)


def _row(
    hand: Handbook,
    case: str,
    quantity: str,
    unit: str,
    value: float,
    peak: tuple[Floats, Bools, Floats | None],
    *,
    factor: float,
) -> ComparisonRow:
    """Return the row with the greatest of what is found, among the legs that count."""
    found, counts, time = peak
    found = np.where(counts, found, -1.0)
    # Of equal ones the first, whatever the rounding.
    sample, leg = np.unravel_index(int(np.argmax(found >= found.max() * (1 - 1e-6))), found.shape)
    return ComparisonRow(
        case=case,
        quantity=quantity,
        unit=unit,
        hand=value,
        statics=float(found[sample, leg]),
        factor=factor,
        leg=hand.robot.leg_codes[int(leg)],
        time=None if time is None else float(time[sample]),
    )
