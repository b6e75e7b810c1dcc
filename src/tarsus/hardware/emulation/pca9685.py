"""Emulated boards with a PCA9685 on an I2C bus."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from tarsus.hardware.codec import pca9685 as codec
from tarsus.hardware.codec.registers import load_registers
from tarsus.hardware.emulation.pulses import follow, pulse_servos
from tarsus.hardware.emulation.servo import ServoTraits
from tarsus.hardware.emulation.servos import EmulatedServos

__all__ = ["EmulatedPca9685"]

_SIZE = 256
_PER_CHANNEL = 4
# Registers after power-up: both modes, prescale, last byte of each channel; data sheet, tables 5, 6, 7, section 7.3.5.
_MODE1, _MODE2, _PRESCALE = 0x11, 0x04, 0x1E
_FULL_OFF_HIGH = 0x10


class EmulatedPca9685(EmulatedServos):
    """Boards with a PCA9685; channels 0 to 15 are those of the first address, 16 to 31 those of the second.

    Parameters
    ----------
    channels : iterable of int
        Channels with servos.
    addresses : sequence of int
        Addresses of the boards.
    traits : ServoTraits, optional
        What the servos are like.
    **shared
        ``supply`` and ``faults``, passed on to `EmulatedServos`.
    """

    def __init__(
        self,
        channels: Iterable[int],
        *,
        addresses: Sequence[int] = (0x40, 0x41),
        traits: ServoTraits | None = None,
        **shared: Any,
    ) -> None:
        super().__init__(pulse_servos(channels, traits), **shared)
        self._table = load_registers("pca9685")
        self._boards = {address: self._fresh() for address in addresses}

    def answers(self, address: int) -> bool:
        """Return whether a device acknowledges an address.

        Parameters
        ----------
        address : int
            The address, 7 bits.
        """
        return address in self._boards

    def write(self, address: int, data: bytes, now: float) -> None:
        """Take bytes in.

        Parameters
        ----------
        address : int
            The device's address, 7 bits.
        data : bytes
            What the computer sent.
        now : float
            When [s].
        """
        memory = self._boards[address]
        register = data[0]
        counting = memory[0] & codec.AUTO_INCREMENT
        self.advance(now)
        for at, byte in enumerate(data[1:]):
            self._put(memory, register + (at if counting else 0), byte)

    def read(self, address: int, register: int, count: int, now: float) -> bytes:
        """Return the content of consecutive registers.

        Parameters
        ----------
        address : int
            The device's address, 7 bits.
        register : int
            The first register.
        count : int
            How many bytes.
        now : float
            When [s].
        """
        self.advance(now)
        return bytes(self._boards[address][register : register + count])

    def _follow(self) -> None:
        for channel, width in self.pulses.items():
            follow(self, channel, width)

    @property
    def pulses(self) -> dict[int, float]:
        """Pulse widths by channel [us]; 0 for none."""
        widths = {}
        for board, memory in enumerate(self._boards.values()):
            rate = codec.frequency(memory[self._table["prescale"].address])
            for channel in range(codec.CHANNELS):
                at = self._table["pulse"].address + _PER_CHANNEL * channel
                steps = 0 if memory[0] & codec.SLEEP else codec.read_pulse(bytes(memory[at : at + _PER_CHANNEL]))
                widths[codec.CHANNELS * board + channel] = codec.pulse_width(steps, rate)
        return widths

    def _fresh(self) -> bytearray:
        memory = bytearray(_SIZE)
        memory[0], memory[1], memory[self._table["prescale"].address] = _MODE1, _MODE2, _PRESCALE
        for channel in range(codec.CHANNELS):
            memory[self._table["pulse"].address + _PER_CHANNEL * channel + 3] = _FULL_OFF_HIGH
        return memory

    def _put(self, memory: bytearray, register: int, byte: int) -> None:
        all_pulses, prescale = self._table["all_pulses"].address, self._table["prescale"].address
        if all_pulses <= register < all_pulses + _PER_CHANNEL:
            for channel in range(codec.CHANNELS):
                memory[self._table["pulse"].address + _PER_CHANNEL * channel + register - all_pulses] = byte
        elif register < _SIZE and (register != prescale or memory[0] & codec.SLEEP):
            memory[register] = byte
