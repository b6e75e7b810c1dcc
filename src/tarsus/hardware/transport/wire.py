"""How long bytes take on a wire."""

from __future__ import annotations

__all__ = ["BITS_PER_BYTE", "I2C_BITS_PER_BYTE", "i2c_seconds", "serial_seconds"]

BITS_PER_BYTE = 10
"""Bits that a byte takes on a serial line: a start bit, 8 data bits, a stop bit."""

I2C_BITS_PER_BYTE = 9
"""Clock periods that a byte takes on I2C: 8 data bits and the acknowledge bit (NXP UM10204, 3.1.5)."""


def serial_seconds(count: int, baud: int) -> float:
    """Return how long bytes take on a serial line [s].

    Parameters
    ----------
    count : int
        How many bytes.
    baud : int
        Bits per second.
    """
    return count * BITS_PER_BYTE / baud


def i2c_seconds(count: int, frequency: int) -> float:
    """Return how long a transfer takes on I2C [s].

    Parameters
    ----------
    count : int
        How many bytes, the address included; start and stop condition take one clock period each.
    frequency : int
        Clock of the bus [Hz].
    """
    return (count * I2C_BITS_PER_BYTE + 2) / frequency
