"""Emulated servos that follow the pulses of boards; where their shafts are is not measured."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType

from tarsus.hardware.emulation.line import EmulatedLine
from tarsus.hardware.emulation.servo import EmulatedServo, ServoTraits
from tarsus.hardware.emulation.servos import EmulatedServos

__all__ = ["BOARD", "PULSE_TRAITS", "EmulatedBoard", "follow", "pulse_servos"]

BOARD = -1
"""Stands for a board in `Faults.corrupt` and `Faults.late`, where servos have their ids."""

# A servo of 60 g: 0.16 s for 60 degrees at 6 V, 2000 us over 180 degrees, 0.7 degrees of play.
PULSE_TRAITS = ServoTraits(per_turn=4000, lowest=500, highest=2500, speed=4167, play=8)


def pulse_servos(channels: Iterable[int], traits: ServoTraits | None = None) -> dict[int, EmulatedServo]:
    """Return servos that follow pulses, by their channels.

    Parameters
    ----------
    channels : iterable of int
        The channels.
    traits : ServoTraits, optional
        What they are like.
    """
    return {channel: EmulatedServo(traits or PULSE_TRAITS) for channel in channels}


def follow(line: EmulatedServos, channel: int, microseconds: float) -> None:
    """Let a servo follow a pulse width; it lets go if there are no pulses.

    Parameters
    ----------
    line : EmulatedServos
        All servos.
    channel : int
        The channel.
    microseconds : float
        The pulse width [us]; 0 for no pulses.
    """
    servo = line.servos.get(channel)
    if servo is None or channel in line.faults.missing:
        return
    servo.torque = microseconds > 0
    if servo.torque:
        servo.goal = float(microseconds)


class EmulatedBoard(EmulatedLine):
    """A board that sends pulses to servos, and is itself fed by the computer's port.

    Attributes
    ----------
    pulses : dict of int to float
        Pulse widths by channel [us]; 0 for none.
    levels : mapping of int to float
        Levels of the inputs by their numbers, 0 to 1; for inputs left out, 1 on boards with pull-ups and 0 on a
        Servo2040, while on a Maestro they are outputs.
    """

    _fed_by_port = True
    levels: Mapping[int, float] = MappingProxyType({})

    def _follow(self) -> None:
        # Servos follow again after a failure of their supply, as the pulses go on.
        for channel, width in self.pulses.items():
            follow(self, channel, width)

    @property
    def pulses(self) -> dict[int, float]:
        """Pulse widths by channel [us]; 0 for none."""
        if not hasattr(self, "_pulses"):
            self._pulses: dict[int, float] = dict.fromkeys(self.servos, 0.0)
        return self._pulses
