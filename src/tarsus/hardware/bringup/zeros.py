"""Zeros of the joints of a leg that is held in the reference pose, or moved there by small steps."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.hardware.bringup.bench import Bench
from tarsus.hardware.bringup.dialogue import Topic
from tarsus.hardware.bringup.first_pulse import send_first_pulse
from tarsus.hardware.bringup.progress import Progress
from tarsus.hardware.bringup.reference_pose import reference_angles
from tarsus.robot.robot import JOINTS

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["set_zeros", "step_to"]

_COARSE, _FINE = math.radians(3), math.radians(0.5)


def set_zeros(progress: Progress, bench: Bench, *, leg: int) -> None:
    """Ask for the reference pose of a leg until its zeros are known.

    Parameters
    ----------
    progress : Progress
        The calibration so far.
    bench : Bench
        The servos.
    leg : int
        Number of the leg.
    """
    robot = progress.calibration.robot
    reference = reference_angles(robot)[leg]
    degrees = ", ".join(f"{joint} {math.degrees(a):.0f}" for joint, a in zip(JOINTS, reference, strict=True))
    progress.ask.say(f"{robot.leg_names[leg]}: the reference pose is {degrees} deg: as in the drawing.")
    while not _held(progress, bench, leg, reference):
        pass


def step_to(progress: Progress, bench: Bench, *, number: int, what: str, topic: Topic) -> None:
    """Move a servo by small steps until whoever looks says that it is there.

    Parameters
    ----------
    progress : Progress
        The calibration so far.
    bench : Bench
        The servos.
    number : int
        Id or channel of the servo.
    what : str
        What is to be reached.
    topic : Topic
        What the question is about.
    """
    send_first_pulse(progress, bench, number=number, topic=topic, skippable=False)
    bench.hold(number)
    scale = progress.calibration.joints[0][0].scale or 0.0
    steps = {"+": _FINE, "-": -_FINE, "++": _COARSE, "--": -_COARSE}
    words = {key: f"{math.degrees(step):+.1f} deg" for key, step in steps.items()}
    while answer := progress.ask.choose(f"{what}.", {"": "it is there", **words}, topic=topic):
        bench.move(number, bench.position(number) + steps[answer] * scale)


def _held(progress: Progress, bench: Bench, leg: int, reference: Float[np.ndarray, "3"]) -> bool:
    """Ask for the reference pose of a leg, and return whether all its zeros are plausible and kept."""
    ask, name = progress.ask, progress.calibration.robot.leg_names[leg]
    at: dict[str, Any] = {"title": "Zeros", "leg": leg, "pose": "reference"}
    if bench.measures:
        bench.release([number for _, number in progress.numbers(leg)])
        ask.choose(f"The {name} leg is limp: hold it in the reference pose.", {"": "it is"}, topic=Topic(**at))
    for j, number in progress.numbers(leg):
        if not bench.measures:
            what, topic = f"{name} {JOINTS[j]}: move it to the reference pose", Topic(**at, joint=j)
            step_to(progress, bench, number=number, what=what, topic=topic)
        if not _zero(progress, leg, j, bench.position(number), float(reference[j])):
            options = {"": "hold the leg again", "d": "its direction is wrong"}
            wrong = ask.choose("That can't be.", options, topic=Topic(title="Zeros", leg=leg, joint=j))
            if wrong == "d":
                joint = progress.calibration.joints[leg][j]
                progress.keep_joint(leg, j, zero=None, direction=-(joint.direction or 1))
            return False
    return True


def _zero(progress: Progress, leg: int, j: int, position: float, angle: float) -> bool:
    """Set the zero of a joint that is at an angle, unless it contradicts what is known; return whether it was set."""
    slope = progress.calibration.joints[leg][j].slope
    return progress.keep_joint(leg, j, zero=round(position - slope * angle, 1))
