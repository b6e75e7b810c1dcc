"""Whether joints move when they are told to."""

from __future__ import annotations

import math
from collections.abc import Sequence

from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.diagnosis.finding import Finding
from tarsus.hardware.diagnosis.subject import Subject

__all__ = ["check_motion"]

# A small motion: its angle [rad], the share of it that must be measured, and its duration [s].
_STEP, _SEEN, _LASTS = math.radians(4), 0.5, 0.6
_TORQUE = 0.4
# An answer may be lost.
_TRIES = 3


def check_motion(subject: Subject, bus: Bus, alive: Sequence[int]) -> Finding:
    """Move one joint after the other by a little, and back; return which of them do not move.

    Parameters
    ----------
    subject : Subject
        The bus of a calibration.
    bus : Bus
        The open bus.
    alive : sequence of int
        The servos that answer.
    """
    still = []
    for number in alive:
        moved = _moved(subject, bus, number)
        name = subject.describe(number)
        if moved is None:
            still.append(f"{name}: no answer")
        elif moved < _SEEN * _STEP:
            still.append(f"{name}: {math.degrees(moved):.1f} of {math.degrees(_STEP):.0f} deg")
    return Finding(
        question="Does each joint move when it is told to?",
        ok=not still,
        measured="; ".join(still) or f"all {len(alive)}",
        remedy="Free these joints and check their gears; a servo that hums and does not move is jammed or broken."
        if still
        else "",
    )


def _moved(subject: Subject, bus: Bus, number: int) -> float | None:
    """Return how far a joint moves when it is told to move by a small step [rad]; None if it does not answer."""
    place = subject.joints.joint(subject.settings.name, number)
    slope = float(subject.calibration.slopes[place])
    low, high = subject.calibration.command_limits[place]
    start = _position(bus, number)
    if start is None:
        return None
    step = _STEP * abs(slope)
    goal = start + step if start + step <= high else start - step
    try:
        bus.set_torque_limit((number,), _TORQUE)
        bus.write_goals({number: round(min(max(start, low), high))})
        bus.set_torque((number,), True)
        bus.set_speed_limit((number,), step / _LASTS * 2)
        bus.write_goals({number: round(min(max(goal, low), high))})
        subject.clock.sleep(_LASTS)
        end = _position(bus, number)
        bus.write_goals({number: round(min(max(start, low), high))})
        subject.clock.sleep(_LASTS)
    finally:
        bus.set_torque((number,), False)
        bus.set_torque_limit((number,), 1.0)
        bus.set_speed_limit((number,), None)
    return None if end is None else abs(end - start) / abs(slope)


def _position(bus: Bus, number: int) -> float | None:
    """Return where a servo is; None if it does not answer, even when asked again."""
    for _ in range(_TRIES):
        found = bus.read_positions((number,)).values
        if found:
            return found[number]
    return None
