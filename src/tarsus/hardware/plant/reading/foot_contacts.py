"""Contacts of the feet, from switches on the inputs of a board."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.errors import BusError, InputError, PortError
from tarsus.hardware.bus.inputs import InputBoard
from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.calibration.bus_commands import BusCommands, bus_commands
from tarsus.hardware.calibration.parts import FootSwitches
from tarsus.hardware.transport.clock import Clock

if TYPE_CHECKING:
    from jaxtyping import Bool

__all__ = ["FootContacts", "thresholds_of"]

# After so many failures in a row a board is asked again only after a pause [s], as each request takes most of a tick.
_SEVERAL, _PAUSE = 3, 0.2


def thresholds_of(switches: FootSwitches, kind: BusCommands) -> dict[int, tuple[float, float]]:
    """Return the levels below which an input goes low and above which it goes high, as shares, by its number.

    Parameters
    ----------
    switches : FootSwitches
        The inputs of the legs.
    kind : BusCommands
        Kind of the board.
    """
    known = {number: (0.5, 0.5) for number in switches.inputs if number is not None}
    margin, (_, highest) = switches.hysteresis / 2, kind.analogue
    for number, volts in zip(switches.inputs, switches.thresholds, strict=False):
        if number is not None:
            known[number] = (volts - margin) / highest, (volts + margin) / highest
    return known


class FootContacts:
    """Reads foot switches, and keeps what was read last.

    Parameters
    ----------
    switches : FootSwitches
        The inputs of the legs.
    bus : Bus
        The bus whose board has them.
    clock : Clock
        The clock.

    Raises
    ------
    InputError
        If the bus has no inputs.
    """

    def __init__(self, switches: FootSwitches, bus: Bus, clock: Clock) -> None:
        if not isinstance(bus, InputBoard):
            raise InputError(f"the bus {switches.bus!r} of the foot switches has no inputs: {bus.name}")
        self._switches, self._board, self._clock = switches, bus, clock
        self._numbers = tuple(number for number in switches.inputs if number is not None)
        self._thresholds = thresholds_of(switches, bus_commands(bus.name))
        self._closed: dict[int, bool] = {}
        self._read: float | None = None
        self._resume, self._failures = -np.inf, 0

    @property
    def seconds(self) -> float:
        """How long reading them takes on the wire [s]."""
        return self._board.input_seconds(self._numbers)

    @property
    def age(self) -> float | None:
        """Time since they were read [s]; None if they never were."""
        return None if self._read is None else max(0.0, self._clock.now() - self._read)

    def read(self) -> str:
        """Read the switches, and return why several reads in a row have failed; empty otherwise.

        Raises
        ------
        PortError
            If the port is gone.
        """
        if self._clock.now() < self._resume:
            return ""
        try:
            levels = self._board.read_inputs(self._numbers)
        except PortError:
            raise
        except BusError as error:
            self._failures += 1
            if self._failures < _SEVERAL:
                return ""
            self._resume = self._clock.now() + _PAUSE
            return str(error)
        self._read, self._failures = self._clock.now(), 0
        for number, level in zip(self._numbers, levels, strict=True):
            low, high = self._thresholds[number]
            was_high = self._closed.get(number) == self._switches.closed
            self._closed[number] = (level > (low if was_high else high)) == self._switches.closed
        return ""

    def contacts(self, planned: Bool[np.ndarray, "legs"]) -> Bool[np.ndarray, "legs"]:
        """Return which feet touch the ground; as planned where a leg has no switch, or it was never read.

        Parameters
        ----------
        planned : array of bool, shape (legs,)
            Which feet should be on the ground.
        """
        inputs = self._switches.inputs
        return np.array(
            [
                bool(plan) if number is None else self._closed.get(number, bool(plan))
                for number, plan in zip(inputs, planned, strict=True)
            ]
        )
