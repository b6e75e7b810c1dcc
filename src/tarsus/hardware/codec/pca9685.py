"""PCA9685: 16 channels of pulses with 12 bits, over I2C. Source: NXP PCA9685 data sheet, revision 4."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tarsus.errors import InputError
from tarsus.hardware.codec.registers import load_registers

__all__ = [
    "AUTO_INCREMENT",
    "CHANNELS",
    "OSCILLATOR",
    "SLEEP",
    "counts",
    "end_all",
    "frequency",
    "mode",
    "prescale",
    "pulse_width",
    "pulses",
    "read_pulse",
    "set_prescale",
]

CHANNELS: Final = 16
OSCILLATOR: Final = 25e6
"""Nominal frequency of the internal oscillator [Hz]; real ones differ by up to 10 %."""

SLEEP: Final = 0x10
AUTO_INCREMENT: Final = 0x20
_TOTEM_POLE = 0x04
_STEPS = 4096
_FULL_OFF = 0x1000


def prescale(rate: float, oscillator: float = OSCILLATOR) -> int:
    """Return the prescale for a rate of pulses.

    Parameters
    ----------
    rate : float
        Pulses per second [Hz].
    oscillator : float
        Frequency of the oscillator [Hz].

    Raises
    ------
    InputError
        If the chip can't send that many.
    """
    value = round(oscillator / (_STEPS * rate)) - 1
    if not 3 <= value <= 255:
        most, least = (frequency(bound, oscillator) for bound in (3, 255))
        raise InputError(f"a PCA9685 sends {least:.0f} to {most:.0f} pulses a second, not {rate:g}")
    return value


def frequency(value: int, oscillator: float = OSCILLATOR) -> float:
    """Return the pulse rate that a prescale makes [Hz].

    Parameters
    ----------
    value : int
        The prescale.
    oscillator : float
        Frequency of the oscillator [Hz].
    """
    return oscillator / (_STEPS * (value + 1))


def counts(microseconds: float, rate: float) -> int:
    """Return a pulse width in steps of the chip, 4096 to a period.

    Parameters
    ----------
    microseconds : float
        The pulse width [us].
    rate : float
        Pulses per second [Hz].
    """
    return min(round(microseconds * 1e-6 * rate * _STEPS), _STEPS - 1)


def pulse_width(steps: int, rate: float) -> float:
    """Return a pulse width [us].

    Parameters
    ----------
    steps : int
        Pulse width in steps of the chip.
    rate : float
        Pulses per second [Hz].
    """
    return steps / (rate * _STEPS) * 1e6


def _pulse(steps: int) -> bytes:
    # The output goes on at step 0, and off after this many steps; for 0 steps it stays off.
    return b"\x00\x00" + (steps or _FULL_OFF).to_bytes(2, "little")


def pulses(first: int, steps: Sequence[int]) -> bytes:
    """Return the transfer that sets the pulses of consecutive channels, which change together at its end.

    Parameters
    ----------
    first : int
        The first channel.
    steps : sequence of int
        Pulse widths in steps of the chip; 0 ends the pulses.
    """
    address = load_registers("pca9685")["pulse"].address + 4 * first
    return bytes((address,)) + b"".join(_pulse(one) for one in steps)


def read_pulse(content: bytes) -> int:
    """Return a pulse width in steps of the chip; 0 if there are no pulses.

    Parameters
    ----------
    content : bytes
        The four registers of a channel.
    """
    on, off = (int.from_bytes(content[at : at + 2], "little") for at in (0, 2))
    return 0 if off & _FULL_OFF else (off - on) % _STEPS


def end_all() -> bytes:
    """Return the transfer that ends all pulses."""
    return bytes((load_registers("pca9685")["all_pulses"].address,)) + _pulse(0)


def mode(*, sleep: bool) -> tuple[bytes, bytes]:
    """Return the transfers that set the chip's mode, with auto-increment of addresses and totem-pole outputs.

    Parameters
    ----------
    sleep : bool
        Whether the oscillator sleeps.
    """
    table = load_registers("pca9685")
    first = AUTO_INCREMENT | (SLEEP if sleep else 0)
    return bytes((table["mode1"].address, first)), bytes((table["mode2"].address, _TOTEM_POLE))


def set_prescale(value: int) -> bytes:
    """Return the transfer that sets the prescale, which the chip accepts only while the oscillator sleeps.

    Parameters
    ----------
    value : int
        The prescale.
    """
    return bytes((load_registers("pca9685")["prescale"].address, value))
