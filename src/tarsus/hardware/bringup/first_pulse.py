"""The first pulse of a servo that does not tell where it is: the servo jumps to it, so the user is asked before."""

from __future__ import annotations

from tarsus.hardware.bringup.bench import Bench
from tarsus.hardware.bringup.dialogue import Topic
from tarsus.hardware.bringup.progress import Progress
from tarsus.hardware.bringup.reference_pose import reference_angles

__all__ = ["send_first_pulse"]


def send_first_pulse(progress: Progress, bench: Bench, *, number: int, topic: Topic, skippable: bool = True) -> bool:
    """Ask before a servo gets its first pulse, and return whether it may have it.

    The pulse is where the servo probably is: in the reference pose where its joint was set before, else in mid-travel.
    Servos that measure their position hold where they are, and need no question; neither do those that had a pulse.

    Parameters
    ----------
    progress : Progress
        The calibration so far.
    bench : Bench
        The servos.
    number : int
        Id or channel of the servo.
    topic : Topic
        What the question is about.
    skippable : bool
        Whether the answer may be to skip it.
    """
    if bench.measures or bench.knows(number):
        return True
    likely = _likely(progress, number)
    where = "in the middle of its travel" if likely is None else "in the reference pose, which was set before"
    pulse = bench.position(number) if likely is None else likely
    key, unit = progress.calibration.kind(0, 0).number_key, progress.calibration.kind(0, 0).unit
    question = (
        f"{key} {number} gets its first pulse, {pulse:.0f} {unit}, {where}. Its servo goes there at once and at full "
        "speed, wherever it is now. Is its leg free in the air, and are all hands away?"
    )
    options = {"": "send it", **({"s": "skip it for now"} if skippable else {})}
    if progress.ask.choose(question, options, topic=topic) == "s":
        return False
    bench.expect(number, pulse)
    return True


def _likely(progress: Progress, number: int) -> float | None:
    """Return the pulse of a joint in the reference pose; None where it is not known."""
    reference = reference_angles(progress.calibration.robot)
    for leg, row in enumerate(progress.calibration.joints):
        for j, joint in enumerate(row):
            if joint.number == number and not joint.missing:
                return joint.command(float(reference[leg, j]))
    return None
