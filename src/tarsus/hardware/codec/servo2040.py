"""Pimoroni Servo2040 with the firmware for Chica: ``D3 first count values`` sets pins, ``C7 first count`` asks.

Values are pairs of bytes of 7 bits, the low one first. Source: github.com/EddieCarrera/chica-servo2040-simpleDriver
(chica-servo2040/main.h, chica-servo2040.cpp), after the protocol of MakeYourPet's Chica server.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tarsus.hardware.codec.scan import Frame, Framing, Scanned, scan_frames

__all__ = [
    "CHANNELS",
    "CURRENT",
    "GET",
    "RELAY",
    "SET",
    "TOUCH",
    "VOLTAGE",
    "current",
    "get",
    "scan",
    "set_pins",
    "values_in",
    "voltage",
]

SET: Final = 0xD3
GET: Final = 0xC7

CHANNELS: Final = 18
TOUCH: Final = 18
"""Pin of the first of six touch sensors."""
CURRENT: Final = 24
VOLTAGE: Final = 25
RELAY: Final = 26
"""Pin that switches all pulses on or off, and a relay."""

# Number of pins; current of a step [A], and value at no current; steps per volt.
_PINS = 29
_CURRENT_STEP, _CURRENT_ZERO = 0.0814, 512
_VOLTAGE_STEPS = 310.3


def _encoded(values: Sequence[int]) -> bytes:
    return b"".join(bytes((value & 0x7F, value >> 7 & 0x7F)) for value in values)


def set_pins(first: int, values: Sequence[int]) -> bytes:
    """Return the command that sets consecutive pins: pulse widths [us] of servos, 0 or 1 of the relay.

    Parameters
    ----------
    first : int
        The first pin.
    values : sequence of int
        Their values.
    """
    return bytes((SET, first, len(values))) + _encoded(values)


def get(first: int, count: int) -> bytes:
    """Return the command that asks for consecutive pins.

    Parameters
    ----------
    first : int
        The first pin.
    count : int
        How many.
    """
    return bytes((GET, first, count))


def values_in(frame: Frame) -> tuple[int, ...]:
    """Return the values in an answer.

    Parameters
    ----------
    frame : Frame
        The answer; its id is the first pin.
    """
    pairs = zip(frame.data[::2], frame.data[1::2], strict=True)
    return tuple(low | high << 7 for low, high in pairs)


def voltage(value: int) -> float:
    """Return a voltage [V].

    Parameters
    ----------
    value : int
        Value in the answer.
    """
    return value / _VOLTAGE_STEPS


def current(value: int) -> float:
    """Return the current of all servos [A].

    Parameters
    ----------
    value : int
        Value in the answer.
    """
    return (value - _CURRENT_ZERO) * _CURRENT_STEP


def scan(received: bytes, *, ended: bool = False) -> Scanned:
    """Return the answers in a stream of bytes; their id is the first pin, their code how many values follow.

    Parameters
    ----------
    received : bytes
        Bytes to search: what the last scan left over, and what has arrived since.
    ended : bool
        Whether nothing more comes, so that an incomplete answer is a damaged one.
    """
    return scan_frames(received, _FRAMING, ended=ended)


def _size(begin: bytes) -> int:
    first, count = begin[1], begin[2]
    return 3 + 2 * count if count > 0 and first + count <= _PINS else 0


def _decode(raw: bytes) -> Frame | None:
    # Only the first byte has its highest bit set.
    return Frame(raw[1], raw[2], raw[3:], raw) if max(raw[1:]) < 0x80 else None


_FRAMING = Framing(bytes((GET,)), 3, _size, _decode)
