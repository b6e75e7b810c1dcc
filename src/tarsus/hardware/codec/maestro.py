"""Pololu Maestro: commands of the compact protocol, and of the Pololu protocol for several boards on one line.

A command byte has its highest bit set, data bytes have not. Pulse widths are counted in quarters of a microsecond.
Source: Pololu Maestro Servo Controller User's Guide, sections 5.c to 5.f.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tarsus.errors import InputError

__all__ = [
    "ERRORS",
    "FULL_LEVEL",
    "GET_ERRORS",
    "GET_MOVING",
    "GET_POSITION",
    "GO_HOME",
    "MOST_CHANNELS",
    "SET_ACCELERATION",
    "SET_SPEED",
    "SET_TARGET",
    "SET_TARGETS",
    "command",
    "crc",
    "errors_in",
    "get_errors",
    "get_position",
    "levels_in",
    "quarters",
    "set_speed",
    "set_targets",
    "words",
]

SET_TARGET: Final = 0x84
SET_SPEED: Final = 0x87
SET_ACCELERATION: Final = 0x89
GET_POSITION: Final = 0x90
GET_MOVING: Final = 0x93
SET_TARGETS: Final = 0x9F
GET_ERRORS: Final = 0xA1
GO_HOME: Final = 0xA2

MOST_CHANNELS: Final = 24
FULL_LEVEL: Final = 1023
"""Level that an input reports at its highest voltage; digital inputs, from channel 12 on, report only 0 or this."""
# First byte of a command of the Pololu protocol; greatest number of 14 bits.
_POLOLU = 0xAA
_MOST_WORD = 0x3FFF

ERRORS = {
    0: "serial signal",
    1: "serial overrun",
    2: "serial buffer full",
    3: "serial CRC",
    4: "serial protocol",
    5: "serial timeout",
    6: "script stack",
    7: "script call stack",
    8: "script program counter",
}
"""What the bits of the board's errors mean."""


def errors_in(code: int) -> tuple[str, ...]:
    """Return the errors that the board reports.

    Parameters
    ----------
    code : int
        The board's error bits.
    """
    return tuple(text for bit, text in ERRORS.items() if code >> bit & 1)


def quarters(microseconds: float) -> int:
    """Return a pulse width in quarters of a microsecond.

    Parameters
    ----------
    microseconds : float
        The pulse width [us].
    """
    return round(microseconds * 4)


def words(*values: int) -> bytes:
    """Return numbers as pairs of bytes of 7 bits, the low one first.

    Parameters
    ----------
    *values : int
        Numbers, 0 to 16383.

    Raises
    ------
    InputError
        If a number has more than 14 bits.
    """
    for value in values:
        if not 0 <= value <= _MOST_WORD:
            raise InputError(f"a Maestro takes numbers of 14 bits, 0 to {_MOST_WORD}, not {value}")
    return b"".join(bytes((value & 0x7F, value >> 7)) for value in values)


def crc(data: bytes) -> int:
    """Return the CRC-7 of a command: polynomial 91, least significant bit first.

    Parameters
    ----------
    data : bytes
        The command.
    """
    value = 0
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = (value ^ 0x91 if value & 1 else value) >> 1
    return value


def command(code: int, data: bytes = b"", *, device: int | None = None, checked: bool = False) -> bytes:
    """Return a command.

    Parameters
    ----------
    code : int
        The command byte.
    data : bytes
        Its data.
    device : int, optional
        Number of the board, for several boards on a line; 12 as delivered.
    checked : bool
        Whether a CRC is appended, which must be enabled on the board.
    """
    frame = bytes((code,)) if device is None else bytes((_POLOLU, device, code & 0x7F))
    frame += data
    return frame + bytes((crc(frame),)) if checked else frame


def set_targets(first: int, targets: Sequence[int], *, device: int | None = None, checked: bool = False) -> bytes:
    """Return the command that sets the targets of consecutive channels; 0 ends the pulses.

    Parameters
    ----------
    first : int
        The first channel.
    targets : sequence of int
        Pulse widths in quarters of a microsecond.
    device : int, optional
        Number of the board.
    checked : bool
        Whether a CRC is appended.
    """
    if len(targets) == 1:
        return command(SET_TARGET, bytes((first,)) + words(*targets), device=device, checked=checked)
    return command(SET_TARGETS, bytes((len(targets), first)) + words(*targets), device=device, checked=checked)


def set_speed(channel: int, speed: int, *, device: int | None = None, checked: bool = False) -> bytes:
    """Return the command that limits the speed of a channel.

    Parameters
    ----------
    channel : int
        The channel.
    speed : int
        Speed in units of 0.25 us per 10 ms; 0 for no limit.
    device : int, optional
        Number of the board.
    checked : bool
        Whether a CRC is appended.
    """
    return command(SET_SPEED, bytes((channel,)) + words(speed), device=device, checked=checked)


def get_position(channel: int, *, device: int | None = None, checked: bool = False) -> bytes:
    """Return the command that asks for the pulse width that a channel sends, or its level; it answers two bytes.

    Parameters
    ----------
    channel : int
        The channel.
    device : int, optional
        Number of the board.
    checked : bool
        Whether a CRC is appended.
    """
    return command(GET_POSITION, bytes((channel,)), device=device, checked=checked)


def levels_in(answer: bytes) -> tuple[int, ...]:
    """Return the numbers that channels answer to `get_position`; those of inputs are 0 to 1023.

    Parameters
    ----------
    answer : bytes
        The answers of all channels.
    """
    return tuple(int.from_bytes(answer[at : at + 2], "little") for at in range(0, len(answer), 2))


def get_errors(*, device: int | None = None, checked: bool = False) -> bytes:
    """Return the command that asks for the board's errors, and clears them; it answers two bytes.

    Parameters
    ----------
    device : int, optional
        Number of the board.
    checked : bool
        Whether a CRC is appended.
    """
    return command(GET_ERRORS, device=device, checked=checked)
