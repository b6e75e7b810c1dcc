"""Numbers of a walk, as printed by `tarsus walk`."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.gait.motion import Motion
from tarsus.load.loads import joint_loads
from tarsus.load.verdict import BURNOUT_FACTOR, joint_verdicts
from tarsus.robot.joint_limits import joint_limits, servo_speeds
from tarsus.robot.robot import JOINTS

__all__ = ["walk_summary"]


def walk_summary(motion: Motion) -> dict[str, Any]:
    """Return the numbers of a motion, with units in the keys.

    Parameters
    ----------
    motion : Motion
        The motion.

    Returns
    -------
    dict
        Strings, numbers, lists and dicts; None if unknown. `speed_mm_s` and `stroke_mm` are those of the foot that
        moves farthest relative to the body; on a straight walk those of the body.
    """
    worst = int(np.argmin(motion.margin))
    return {
        "robot": motion.robot.name,
        "gait": motion.gait.name,
        "duty_factor": motion.gait.duty_factor,
        "duration_s": motion.duration,
        "cycle_time_s": motion.cycle_time,
        "steps": motion.steps,
        "stroke_mm": motion.stroke * 1000,
        "speed_mm_s": motion.speed * 1000,
        "body_height_mm": motion.body_height * 1000,
        "swing_height_mm": motion.swing_height * 1000,
        "end": _end(motion),
        "joint_speed": {joint: _joint_speed(motion, number) for number, joint in enumerate(JOINTS)},
        "least_margin": {"mm": motion.margin[worst] * 1000, "at_s": motion.time[worst]},
        "nearest_feet": _nearest_feet(motion),
        "possible": motion.ok,
        "problems": list(motion.problems),
        "servos": _servos(motion),
        "assumed": list(motion.assumed),
    }


def _servos(motion: Motion) -> dict[str, Any]:
    """Return whether the servos carry the robot through the motion, with vertical contact forces; None if unknown."""
    robot = motion.robot
    if not robot.has_masses:
        return {"carried": None, "text": "unknown, as the robot's file has no masses"}
    if not motion.contacts.any(axis=1).all():
        return {"carried": None, "text": "unknown, as at times no foot is on the ground"}
    verdicts = joint_verdicts(joint_loads(robot, motion))
    if any(verdict.servo is None for verdict in verdicts):
        return {"carried": None, "text": "unknown, as the robot's file does not name them all"}
    worst = min(verdicts, key=lambda verdict: verdict.factor)
    carried = worst.factor >= BURNOUT_FACTOR
    text = f"{worst.class_name}: {worst.leg} {worst.joint}, safety factor {worst.factor:.2f}"
    return {"carried": carried, "text": f"{text}; `tarsus loads` shows every joint, and friction between the feet"}


def _end(motion: Motion) -> dict[str, float]:
    """Return the final position of the body, and its total yaw, full turns included."""
    x, y = motion.body.position[-1, :2] * 1000
    yaw = np.unwrap(motion.body.rpy[:, 2])
    return {"x_mm": x, "y_mm": y, "turned_deg": math.degrees(yaw[-1] - yaw[0])}


def _nearest_feet(motion: Motion) -> dict[str, Any]:
    """Return the smallest distance between two feet, with its time and legs."""
    sample = int(np.argmin(motion.least_foot_distance))
    feet, codes = motion.feet[sample], motion.robot.leg_codes
    distance = np.linalg.norm(feet[:, None] - feet, axis=-1) + np.diag(np.full(len(feet), np.inf))
    pair = np.unravel_index(int(np.argmin(distance)), distance.shape)
    return {
        "mm": motion.least_foot_distance[sample] * 1000,
        "at_s": motion.time[sample],
        "legs": [codes[int(leg)] for leg in pair],
        "least_allowed_mm": motion.foot_distance * 1000,
    }


def _joint_speed(motion: Motion, joint: int) -> dict[str, Any]:
    """Return the peak speed of coxa, femur or tibia, and its ratio to the joint's speed limit."""
    fastest = np.abs(motion.joint_speed[:, :, joint]).max(0)
    leg = int(np.argmax(fastest))
    ratio = motion.speed_ratio[:, joint]
    # Where servos differ, the leg with the largest ratio is not always the fastest.
    critical = int(np.argmax(ratio))
    servo = motion.robot.servos[critical][joint]
    limit = math.degrees(joint_limits(motion.robot).speed[critical, joint])
    known = servo_speeds(motion.robot)[critical][joint] is not None
    return {
        "deg_s": math.degrees(fastest[leg]),
        "leg": motion.robot.leg_codes[leg],
        "servo": None if servo is None else servo.name,
        "limit_deg_s": limit,
        "limit_fraction": ratio[critical],
        "no_load_deg_s": limit if known else None,
    }
