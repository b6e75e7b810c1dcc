"""Whether servos answer, and if not, why."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Sequence

from tarsus.errors import BusError, NoAnswerError
from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.bus.registry import bus_kind
from tarsus.hardware.diagnosis.finding import Finding
from tarsus.hardware.diagnosis.subject import Subject

__all__ = ["check_presence", "why_nobody_answers"]

# Baud rates that are tried where no servo answers at the rate of the calibration [bit/s].
_RATES = (1_000_000, 57_600, 115_200, 500_000, 9_600, 38_400)


def why_nobody_answers(subject: Subject, bus: Bus) -> Finding:
    """Return why no servo answers at all; the bus may be closed afterwards.

    Parameters
    ----------
    subject : Subject
        The bus of a calibration.
    bus : Bus
        The open bus.
    """
    question = "Does any servo answer?"
    echo = _echoes(subject, bus)
    if echo:
        return Finding(
            question=question,
            ok=False,
            measured="only the echo of what is sent",
            remedy="The adapter sends but hears no servo: check the supply of the servos and the data line.",
        )
    rate = _other_rate(subject, bus)
    if rate is not None:
        return Finding(
            question=question,
            ok=False,
            measured=f"not at this rate, but at {rate}",
            remedy=f"Write baud = {rate} for the bus {subject.settings.name!r} in the calibration.",
        )
    return Finding(
        question=question,
        ok=False,
        measured=f"none of {len(subject.numbers)} at any common rate",
        remedy=(
            "Switch the supply of the servos on and measure it at a servo; then check data line and ground, and "
            "that the adapter is of the kind for these servos."
        ),
    )


def _echoes(subject: Subject, bus: Bus) -> bool:
    errors = bus.read_positions(subject.numbers[:1]).errors
    return any(isinstance(error, NoAnswerError) and "echo" in error.received for error in errors)


def _other_rate(subject: Subject, bus: Bus) -> int | None:
    """Close the bus, and return a common rate at which a servo answers; None where there is none."""
    bus.close()
    if bus_kind(subject.settings.kind).transport != "serial":
        return None
    for rate in _RATES:
        try:
            other = subject.open_port(dataclasses.replace(subject.settings, baud=rate), rate)
        except BusError:
            continue
        try:
            if other.scan(subject.numbers[:3]).values:
                return rate
        except BusError:
            continue
        finally:
            other.close()
    return None


def check_presence(subject: Subject, bus: Bus, alive: Sequence[int], errors: tuple[BusError, ...]) -> Iterator[Finding]:
    """Yield whether all servos answer, each by an id of its own.

    Parameters
    ----------
    subject : Subject
        The bus of a calibration.
    bus : Bus
        The open bus.
    alive : sequence of int
        The servos that do.
    errors : tuple of BusError
        Why the others do not.
    """
    question = "Do all servos answer?"
    corrupt = [error.id for error in errors if not isinstance(error, NoAnswerError) and error.id in subject.numbers]
    if corrupt:
        listed = ", ".join(subject.describe(number) for number in corrupt)
        yield Finding(
            question="Has each servo an id of its own?",
            ok=False,
            measured=f"damaged answers of {listed}",
            remedy="Two servos have this id: connect them one at a time, and give one another id.",
        )
    missing = [number for number in subject.numbers if number not in alive and number not in corrupt]
    if not missing:
        yield Finding(question=question, ok=not corrupt, measured=f"{len(alive)} of {len(subject.numbers)}")
        return
    known = set(subject.numbers)
    strangers = sorted(number for number in bus.scan(range(1, 31)).values if number not in known)
    listed = ", ".join(subject.describe(number) for number in missing)
    others = f"; ids that belong to no joint: {', '.join(map(str, strangers))}" if strangers else ""
    yield Finding(
        question=question,
        ok=False,
        measured=f"{len(alive)} of {len(subject.numbers)}; missing: {listed}{others}",
        remedy=(
            "Set the ids of the strangers to the missing ones."
            if strangers
            else "Check the cable to the first that is missing: those behind it in the chain go with it."
        ),
    )
