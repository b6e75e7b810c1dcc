"""Finds which servo is which joint, and which way it turns: it moves a little, and whoever looks says what moved."""

from __future__ import annotations

import math

import numpy as np

from tarsus.hardware.bringup.bench import Bench
from tarsus.hardware.bringup.dialogue import Topic
from tarsus.hardware.bringup.first_pulse import send_first_pulse
from tarsus.hardware.bringup.progress import Progress
from tarsus.robot.robot import Robot

__all__ = ["identify"]

_TITLE = "Which servo is which joint"


def identify(progress: Progress, bench: Bench, *, number: int) -> None:
    """Move one servo by a little, and ask which joint it is and which way it turns, unless all joints are known.

    Parameters
    ----------
    progress : Progress
        The calibration so far.
    bench : Bench
        The servos.
    number : int
        Id or channel of the servo.
    """
    ask, key = progress.ask, progress.calibration.kind(0, 0).number_key
    if len(progress.assigned) == progress.joints:
        return
    if not send_first_pulse(progress, bench, number=number, topic=Topic(title=_TITLE)):
        return
    while True:
        ask.say(f"{key} {number} moves a little, and back.")
        sign = bench.wiggle(number)
        options = {**progress.leg_options, "a": "move again", "n": "none"}
        answer = ask.choose("Which leg moved?", options, topic=Topic(title=_TITLE))
        if answer == "n":
            return
        if answer == "a":
            continue
        leg = int(answer) - 1
        options = {"c": "coxa", "f": "femur", "t": "tibia", "b": "back"}
        joint = ask.choose("Which joint?", options, topic=Topic(title=_TITLE, leg=leg))
        if joint == "b":
            continue
        j = "cft".index(joint)
        other = progress.calibration.joints[leg][j].number
        if other is not None:
            ask.say(f"that is {key} {other} already; look again, or start anew with another file")
            continue
        first, second, positive = _ways(progress.calibration.robot, leg, j)
        options, topic = {first[0]: first, second[0]: second, "b": "back"}, Topic(title=_TITLE, leg=leg, joint=j)
        way = ask.choose("Which way did it go first?", options, topic=topic)
        if way == "b":
            continue
        direction = sign * (positive if way == first[0] else -positive)
        if progress.keep_joint(leg, j, number=number, direction=direction):
            return


def _ways(robot: Robot, leg: int, j: int) -> tuple[str, str, int]:
    """Return the two ways a foot may go, and the sign of the first one."""
    if j > 0:
        return "up", "down", 1
    yaw = float(np.asarray(robot.mount_yaw)[leg])
    forward, left = -math.sin(yaw), math.cos(yaw)
    if abs(forward) >= abs(left) * 0.5:
        return "forward", "rearward", 1 if forward > 0 else -1
    return "left", "right", 1 if left > 0 else -1
