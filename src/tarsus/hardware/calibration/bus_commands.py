"""Kinds of servo buses, as far as a calibration depends on them: units, ranges of commands and of numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from tarsus.errors import UnknownNameError
from tarsus.representation import represented
from tarsus.robot.servo import Servo

__all__ = ["BUS_COMMANDS", "BusCommands", "bus_commands", "usual_bus"]


@represented()
@dataclass(frozen=True, kw_only=True)
class BusCommands:
    """A kind of servo bus.

    Attributes
    ----------
    name : str
        Name, as in calibration files.
    text : str
        What it is.
    unit : str
        Unit of its commands: ``"us"`` (pulse width) or ``"ticks"``.
    commands : (float, float)
        Least and greatest command that it can carry.
    numbers : (int, int)
        First and last number of a servo: its id, or the channel of the board.
    inputs : int
        How many inputs its board has, for foot switches.
    analogue : (int, float)
        How many of them, from the first on, measure a voltage, and the highest that they measure [V]; the others tell
        high or low.
    steps : (int, float) or None
        Positions of its usual servos, and the angle over which they are [deg]; None for pulse widths.
    """

    name: str
    text: str
    unit: str
    commands: tuple[float, float]
    numbers: tuple[int, int]
    inputs: int = 0
    analogue: tuple[int, float] = (0, 0.0)
    steps: tuple[int, float] | None = None

    @property
    def number_key(self) -> str:
        """Key of a servo's number in calibration files: ``"id"``, or ``"channel"`` where the board has channels."""
        return "channel" if self.unit == "us" else "id"

    @property
    def feedback(self) -> bool:
        """Whether the servos report their positions."""
        return self.unit == "ticks"


def _pulses(
    name: str, text: str, channels: int, commands: tuple[float, float] = (400.0, 2600.0), **inputs: Any
) -> BusCommands:
    return BusCommands(name=name, text=text, unit="us", commands=commands, numbers=(0, channels - 1), **inputs)


def _ticks(name: str, text: str, steps: tuple[int, float], last: int, *, greatest: int | None = None) -> BusCommands:
    commands = (0.0, float(steps[0] - 1 if greatest is None else greatest))
    return BusCommands(name=name, text=text, unit="ticks", commands=commands, numbers=(0, last), steps=steps)


BUS_COMMANDS: Mapping[str, BusCommands] = MappingProxyType(
    {
        kind.name: kind
        for kind in (
            _pulses("pca9685", "PCA9685 boards on I2C", 32),
            _pulses("maestro", "Pololu Mini Maestro", 24, inputs=24, analogue=(12, 5.0)),
            _pulses("ssc32", "Lynxmotion SSC-32 and SSC-32U", 32, (500.0, 2500.0), inputs=6),
            _pulses("servo2040", "Pimoroni Servo 2040", 18, inputs=6, analogue=(6, 3.3)),
            _pulses("lines", "an Arduino that reads lines of pulse widths", 32, (500.0, 2500.0), inputs=8),
            _ticks("dynamixel-ax", "Dynamixel AX", (1024, 300.0), 253),
            _ticks("dynamixel-mx", "Dynamixel MX with protocol 1.0", (4096, 360.0), 253),
            _ticks("dynamixel-x", "Dynamixel X, and MX with protocol 2.0", (4096, 360.0), 252),
            _ticks("feetech-sts", "Feetech STS and SMS", (4096, 360.0), 253),
            _ticks("feetech-scs", "Feetech SCS", (1024, 300.0), 253),
            # 0 to 1000 over 240 deg.
            _ticks("lx16a", "Hiwonder LX-16A and HTS", (1000, 240.0), 253, greatest=1000),
        )
    }
)
"""Kinds of servo buses, by name."""

# Kinds by the beginnings of a servo's name and of its bus's name; the first that fits counts.
_OF_SERVOS = {
    ("AX-", "Dynamixel"): "dynamixel-ax",
    ("", "Dynamixel 2.0"): "dynamixel-x",
    ("", "Dynamixel"): "dynamixel-mx",
    ("", "Feetech STS"): "feetech-sts",
    ("", "Feetech SCS"): "feetech-scs",
    ("", "LewanSoul"): "lx16a",
}


def bus_commands(name: str) -> BusCommands:
    """Return a kind of bus.

    Parameters
    ----------
    name : str
        One of `BUS_COMMANDS`.

    Raises
    ------
    UnknownNameError
        If there is none of that name.
    """
    if name not in BUS_COMMANDS:
        raise UnknownNameError.of("kind of bus", name, BUS_COMMANDS)
    return BUS_COMMANDS[name]


def usual_bus(servo: Servo | None) -> BusCommands:
    """Return the kind of bus on which a servo runs; boards of pulse widths where it is unknown.

    Parameters
    ----------
    servo : Servo or None
        The servo.
    """
    name, buses = ("", frozenset[str]()) if servo is None else (servo.name, servo.buses)
    for (model, start), kind in _OF_SERVOS.items():
        if name.startswith(model) and any(bus.startswith(start) for bus in buses):
            return BUS_COMMANDS[kind]
    return BUS_COMMANDS["servo2040"]
