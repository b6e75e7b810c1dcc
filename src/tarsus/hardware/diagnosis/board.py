"""Boards for pulses: whether they answer, and what their inputs measure."""

from __future__ import annotations

from collections.abc import Iterator

from tarsus.errors import BusError, PortError
from tarsus.hardware.bus.inputs import InputBoard
from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.diagnosis.finding import Finding
from tarsus.hardware.diagnosis.subject import Subject
from tarsus.hardware.plant.reading.foot_contacts import thresholds_of

__all__ = ["check_board"]


def check_board(subject: Subject, bus: Bus) -> Iterator[Finding]:
    """Yield the findings about a board that only sends pulses.

    Parameters
    ----------
    subject : Subject
        The bus of a calibration.
    bus : Bus
        The open bus.
    """
    question = "Does the board answer?"
    if bus.capabilities.ping == "none":
        yield Finding(question=question, ok=None, measured="it never does")
    else:
        answer = bus.ping(subject.numbers[0] if subject.numbers else bus.capabilities.ids.start)
        remedy = "Check the supply of the board, its cable, and its mode: it must take commands from this port."
        if answer is None:
            yield Finding(question=question, ok=False, measured="nothing", remedy=remedy)
            return
        yield Finding(question=question, ok=True, measured=answer.name or "yes")
    yield from _switches(subject, bus)
    if not subject.numbers:
        return
    yield Finding(
        question="Do the servos have supply, and get pulses?",
        ok=None,
        measured="a board for pulses can't tell",
        remedy=(
            "Measure the voltage between + and - of a servo's plug; the board's own supply does not feed servos. "
            "Connect the grounds of board and supply. Try the servo on another channel."
        ),
    )


def _switches(subject: Subject, bus: Bus) -> Iterator[Finding]:
    """Yield the levels of the foot switches."""
    switches = subject.calibration.foot_switches
    if switches is None or switches.bus != subject.settings.name or not isinstance(bus, InputBoard):
        return
    question = "Do the foot switches answer?"
    legs = [(leg, number) for leg, number in enumerate(switches.inputs) if number is not None]
    try:
        levels = bus.read_inputs([number for _, number in legs])
    except PortError:
        raise
    except BusError as error:
        yield Finding(question=question, ok=False, measured=error.received, remedy=error.remedy)
        return
    names = subject.calibration.robot.leg_names
    kind = subject.settings.properties
    bounds, (count, highest) = thresholds_of(switches, kind), kind.analogue
    side = "above" if switches.closed else "below"
    felt = []
    for (leg, number), level in zip(legs, levels, strict=True):
        volts = f" ({level * highest:.2f} V)" if number < count else ""
        own = f", threshold {sum(bounds[number]) / 2 * highest:.2f} V" if switches.thresholds else ""
        felt.append(f"{names[leg]} {level:.1f}{volts}{own}")
    bound = "its threshold" if switches.thresholds else "0.5"
    yield Finding(
        question=question,
        ok=None,
        measured=f"levels: {', '.join(felt)}; a foot is on the ground {side} {bound}",
        remedy="Press one foot after the other, and look whether its level changes.",
    )
