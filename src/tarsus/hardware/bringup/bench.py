"""The servos under bring-up: small, slow motions of one servo at a time, with little torque."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from tarsus.errors import BusError, NoAnswerError
from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.transport.clock import Clock

__all__ = ["Bench"]

# How far a servo moves to be seen [rad], how fast it moves in any case [rad/s], and with which share of its torque.
_WIGGLE, _SPEED, _TORQUE = math.radians(8), math.radians(30), 0.35
_TICK = 0.02


class Bench:
    """Moves single servos of a bus whose joints are not known yet.

    Parameters
    ----------
    bus : Bus
        The bus.
    calibration, blank : Calibration
        The calibration as far as it is known, and a new one, whose limits are those of the servos.
    clock : Clock
        The clock.
    """

    def __init__(self, bus: Bus, calibration: Calibration, clock: Clock, *, blank: Calibration) -> None:
        self.bus, self._clock = bus, clock
        joint = calibration.joints[0][0]
        limits = blank.joints[0][0].limits or joint.limits
        if joint.scale is None or limits is None:
            raise NoAnswerError(
                bus.name, bus.port, expected="scale and limits of the servos", received="none", remedy="Add them."
            )
        self._scale, self._limits = joint.scale, limits
        # Last command of each servo, and range of each that was held: it includes its start, so that it never jumps to
        # the limits.
        self._goals: dict[int, float] = {}
        self._ranges: dict[int, tuple[float, float]] = {}

    @property
    def measures(self) -> bool:
        """Whether the servos tell where they are."""
        return self.bus.capabilities.positions

    def position(self, number: int) -> float:
        """Return the position of a servo: measured, or else its last command, or mid-travel without one [us or ticks].

        Parameters
        ----------
        number : int
            Id or channel.

        Raises
        ------
        BusError
            If it does not answer.
        """
        if self.measures:
            return self.bus.read_positions((number,)).require()[number]
        return self._goals.get(number, sum(self._limits) / 2)

    def knows(self, number: int) -> bool:
        """Return whether the last pulse of a servo is known, with which it holds where it is.

        Parameters
        ----------
        number : int
            Id or channel.
        """
        return number in self._goals

    def expect(self, number: int, pulse: float) -> None:
        """Assume that a servo is where a pulse would bring it.

        Parameters
        ----------
        number : int
            Id or channel.
        pulse : float
            The pulse [us or ticks].
        """
        self._goals[number] = min(max(pulse, self._limits[0]), self._limits[1])

    def hold(self, number: int) -> None:
        """Let a servo hold where it is, with little torque; without measured positions at the last goal.

        Parameters
        ----------
        number : int
            Id or channel.
        """
        start = self.position(number)
        self._ranges[number] = min(start, self._limits[0]), max(start, self._limits[1])
        self.bus.set_torque_limit((number,), _TORQUE)
        self._write(number, start)
        self.bus.set_torque((number,), True)
        self._write(number, start)

    def move(self, number: int, goal: float, *, each: Callable[[], None] | None = None) -> None:
        """Move a servo slowly to a command within the limits.

        Parameters
        ----------
        number : int
            Id or channel.
        goal : float
            Where to [us or ticks].
        each : callable, optional
            Called in every tick.
        """
        low, high = self._ranges.get(number, self._limits)
        goal = min(max(goal, low), high)
        at = self._goals[number]
        step = _SPEED * self._scale * _TICK
        while abs(goal - at) > 0.5:
            at += min(max(goal - at, -step), step)
            self._write(number, at)
            self._clock.sleep(_TICK)
            if each is not None:
                each()

    def wiggle(self, number: int) -> int:
        """Move a servo by 8 deg and back, then release it; return the sign of the first motion.

        The first motion is to a greater command, except near the upper end of the servo's travel.

        Parameters
        ----------
        number : int
            Id or channel.
        """
        self.hold(number)
        start = self._goals[number]
        way = _WIGGLE * self._scale
        sign = 1 if self._limits[1] - start > way / 2 else -1
        self.move(number, start + sign * way)
        self._clock.sleep(0.3)
        self.move(number, start)
        self.release((number,))
        return sign

    def release(self, numbers: Sequence[int] | None) -> None:
        """Release servos, as far as the bus can, and give them back their full torque.

        Parameters
        ----------
        numbers : sequence of int, or None
            Ids or channels; None for all.
        """
        self.bus.set_torque(numbers, False)
        self.bus.set_torque_limit(tuple(self._ranges) if numbers is None else numbers, 1.0)

    def close(self) -> None:
        """Release all, and close the port; never raises a bus's error."""
        try:
            self.release(None)
        except BusError:
            pass
        finally:
            self.bus.close()

    def _write(self, number: int, command: float) -> None:
        low, high = self._ranges.get(number, self._limits)
        whole = round(min(max(command, low), high))
        self.bus.write_goals({number: float(whole)})
        self._goals[number] = command
