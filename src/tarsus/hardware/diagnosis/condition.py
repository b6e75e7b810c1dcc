"""The condition of servos that answer: supply, alarms, temperature, positions."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence

from tarsus.hardware.bus.answers import Telemetry
from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.diagnosis.finding import Finding
from tarsus.hardware.diagnosis.subject import Subject
from tarsus.hardware.plant.monitor.telemetry_monitor import least_voltage
from tarsus.hardware.plant.settings import PlantSettings

__all__ = ["check_condition"]

# How far beyond its limits a joint may be [rad].
_BEYOND = math.radians(4)


def check_condition(subject: Subject, bus: Bus, alive: Sequence[int]) -> Iterator[Finding]:
    """Yield whether supply, servos and positions are as they must be.

    Parameters
    ----------
    subject : Subject
        The bus of a calibration.
    bus : Bus
        The open bus.
    alive : sequence of int
        The servos that answer.
    """
    telemetry = bus.read_telemetry(alive).values
    yield _supply(subject, telemetry.values())
    yield _state(subject, telemetry)
    yield _positions(subject, bus, alive)


def _supply(subject: Subject, telemetry: Collection[Telemetry]) -> Finding:
    question = "Is the supply strong enough?"
    volts = [each.voltage for each in telemetry if each.voltage is not None]
    if not volts:
        return Finding(question=question, ok=None, measured="the servos do not tell")
    least = least_voltage(subject.calibration) or 0.0
    ok = min(volts) >= least
    return Finding(
        question=question,
        ok=ok,
        measured=f"{min(volts):.1f} V at the servos, at least {least:.1f} V needed",
        remedy="" if ok else "Charge the battery; check its cable and plug for the current (tarsus loads).",
    )


def _state(subject: Subject, telemetry: Mapping[int, Telemetry]) -> Finding:
    hot = PlantSettings().hot
    wrong = [
        f"{subject.describe(number)}: "
        + ", ".join([*each.alarms, *([f"{each.temperature:.0f} deg C"] if (each.temperature or 0) >= hot else [])])
        for number, each in telemetry.items()
        if each.alarms or (each.temperature or 0.0) >= hot
    ]
    hottest = max((each.temperature for each in telemetry.values() if each.temperature is not None), default=None)
    return Finding(
        question="Do the servos report errors?",
        ok=not wrong,
        measured="; ".join(wrong) or f"none{'' if hottest is None else f', hottest {hottest:.0f} deg C'}",
        remedy="Let them cool and switch the supply off and on: servos let go until then." if wrong else "",
    )


def _positions(subject: Subject, bus: Bus, alive: Sequence[int]) -> Finding:
    wrong = []
    for number, value in bus.read_positions(alive).values.items():
        place = subject.joints.joint(subject.settings.name, number)
        angle = (value - subject.calibration.zeros[place]) / subject.calibration.slopes[place]
        low, high = subject.calibration.limits[place]
        if not low - _BEYOND <= angle <= high + _BEYOND:
            at, ends = math.degrees(angle), f"{math.degrees(low):.0f} to {math.degrees(high):.0f}"
            wrong.append(f"{subject.calibration.joint_name(*place)} at {at:.0f} deg, limits {ends} deg")
    return Finding(
        question="Are the joints within their limits?",
        ok=not wrong,
        measured="; ".join(wrong) or f"all {len(alive)}",
        remedy="Move them there by hand, or correct zero and direction (tarsus bring-up)." if wrong else "",
    )
