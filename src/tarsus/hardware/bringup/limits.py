"""Limits of the joints of a leg, from the ends of travel to which they are moved by hand or by small steps."""

from __future__ import annotations

import math
from typing import Literal

from tarsus.hardware.bringup.bench import Bench
from tarsus.hardware.bringup.dialogue import Topic
from tarsus.hardware.bringup.progress import Progress
from tarsus.hardware.bringup.zeros import step_to
from tarsus.robot.robot import JOINTS

__all__ = ["set_limits"]

_TITLE = "Limits"
# How far limits stay away from the ends that were reached [rad].
_MARGIN = math.radians(2)


def set_limits(progress: Progress, bench: Bench, *, leg: int) -> None:
    """Ask for the limits of a leg's joints, unless they are set already or those of the servo are to be kept.

    Parameters
    ----------
    progress : Progress
        The calibration so far.
    bench : Bench
        The servos.
    leg : int
        Number of the leg.
    """
    name = progress.calibration.robot.leg_names[leg]
    todo = [(j, number) for j, number in progress.numbers(leg) if _untouched(progress, leg, j)]
    if not todo:
        return
    options = {"": "those of robot and servos", "h": "set them"}
    if progress.ask.choose(f"Limits of the {name} leg:", options, topic=Topic(title=_TITLE, leg=leg)) != "h":
        return
    for j, number in todo:
        what = f"{name} {JOINTS[j]}"
        margin = _MARGIN * (progress.calibration.joints[leg][j].scale or 0.0)
        while True:
            topics = [Topic(title=_TITLE, leg=leg, joint=j, pose=end) for end in _ENDS]
            low, high = sorted(_end(progress, bench, number, f"{what}: move it", topic) for topic in topics)
            if high - low <= 4 * margin:
                progress.ask.say(f"{what}: from {low:.0f} to {high:.0f} is no range; move it further")
            elif progress.keep_joint(leg, j, limits=(math.ceil(low + margin), math.floor(high - margin))):
                break


_ENDS: tuple[Literal["one end", "the other end"], ...] = ("one end", "the other end")


def _end(progress: Progress, bench: Bench, number: int, what: str, topic: Topic) -> float:
    """Return the position of a servo at an end of its travel."""
    if bench.measures:
        bench.release((number,))
        progress.ask.choose(f"{what} by hand to {topic.pose}.", {"": "it is there"}, topic=topic)
    else:
        step_to(progress, bench, number=number, what=f"{what} to {topic.pose}", topic=topic)
    return bench.position(number)


def _untouched(progress: Progress, leg: int, j: int) -> bool:
    return progress.calibration.joints[leg][j].limits == progress.blank.joints[leg][j].limits
