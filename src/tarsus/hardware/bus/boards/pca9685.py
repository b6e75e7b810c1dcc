"""Boards with a PCA9685 on an I2C bus, one or several."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tarsus.errors import InputError
from tarsus.hardware.bus.boards.board_bus import LONGEST_PULSE, SHORTEST_PULSE, BoardBus, runs
from tarsus.hardware.bus.capabilities import Capabilities
from tarsus.hardware.codec import pca9685 as codec
from tarsus.hardware.transport.protocol import I2cTransport
from tarsus.hardware.transport.wire import i2c_seconds

__all__ = ["Pca9685Bus"]

# Time that the oscillator takes to start after its sleep [s]; data sheet, 7.3.1.1.
_WAKING = 500e-6
_ADDRESSES = range(0x40, 0x80)


class Pca9685Bus(BoardBus):
    """Boards with 16 channels each: channels 0 to 15 are those of the first board, 16 to 31 those of the second.

    Parameters
    ----------
    transport : I2cTransport
        The I2C bus.
    addresses : sequence of int
        Addresses of the boards.
    rate : float
        Pulses per second [Hz]; analogue servos tolerate 50.
    oscillator : float
        Frequency of the boards' oscillators, if it was measured [Hz].

    Raises
    ------
    InputError
        If no address is given, one is repeated, one is impossible for a board, or the rate is impossible.
    """

    def __init__(
        self,
        transport: I2cTransport,
        *,
        addresses: Sequence[int] = (0x40, 0x41),
        rate: float = 50.0,
        oscillator: float = codec.OSCILLATOR,
    ) -> None:
        if not addresses or len(set(addresses)) < len(addresses) or not set(addresses) <= set(_ADDRESSES):
            wrong = ", ".join(f"{address:#04x}" for address in addresses) or "none"
            raise InputError(f"boards with a PCA9685 have addresses from 0x40 to 0x7f, each another one, not {wrong}")
        self._prescale = codec.prescale(rate, oscillator)
        self._rate = codec.frequency(self._prescale, oscillator)
        capabilities = Capabilities(
            unit="us",
            lowest=SHORTEST_PULSE,
            highest=min(LONGEST_PULSE, 1e6 / self._rate),
            ids=range(codec.CHANNELS * len(addresses)),
            ping="board",
            torque_off="pulses",
            # The channels of a board change together, the boards one after the other.
            synchronous=len(addresses) == 1,
        )
        super().__init__("pca9685", transport, capabilities)
        self._transport, self._addresses = transport, tuple(addresses)
        self._ready: set[int] = set()

    def _goal_seconds(self, ids: Sequence[int]) -> float:
        sizes = [1 + len(data) for _, data in self._transfers(dict.fromkeys(ids, 0.0))]
        return sum(i2c_seconds(size, self._transport.frequency) for size in sizes)

    def _transfers(self, goals: Mapping[int, float]) -> list[tuple[int, bytes]]:
        """Return addresses and data of the transfers that send goals."""
        transfers = []
        for board, address in enumerate(self._addresses):
            first = codec.CHANNELS * board
            own = {channel - first: goal for channel, goal in goals.items() if 0 <= channel - first < codec.CHANNELS}
            for run in runs(own, codec.CHANNELS):
                steps = [codec.counts(own[channel], self._rate) for channel in run]
                transfers.append((address, codec.pulses(run[0], steps)))
        return transfers

    def _send(self, goals: Mapping[int, float]) -> None:
        for address, data in self._transfers(goals):
            self._prepare(address)
            self._transport.write(address, data)

    def _switch(self, ids: Sequence[int] | None, on: bool) -> None:
        if on:
            return
        if ids is not None:
            self._send(dict.fromkeys(ids, 0.0))
            return
        for address in self._addresses:
            self._transport.write(address, codec.end_all())

    def _board(self, id: int) -> str:
        self._prepare(self._addresses[id // codec.CHANNELS], always=True)
        return "PCA9685"

    def _prepare(self, address: int, *, always: bool = False) -> None:
        """Set rate and mode of a board at its first use, ending its pulses; `always` does so again where it sleeps."""
        # A board sleeps after its own supply was off. That is not looked for with each goal, which would take longer.
        if address in self._ready and not (always and self._transport.read(address, 0, 1)[0] & codec.SLEEP):
            return
        self._transport.write(address, codec.end_all())
        for data in (*codec.mode(sleep=True), codec.set_prescale(self._prescale), *codec.mode(sleep=False)):
            self._transport.write(address, data)
        self._transport.sleep(_WAKING)
        self._ready.add(address)
