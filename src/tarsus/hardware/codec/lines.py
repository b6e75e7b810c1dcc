"""Lines of pulse widths for a microcontroller: ``1500 1500 ... *5A``, as the sketch in examples/ reads them.

Each line ends with ``*``, the exclusive or of all bytes before it in two hexadecimal digits, and a line feed. The
protocol is this project's own.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from operator import xor
from typing import Final

__all__ = ["ASK", "END", "INPUTS", "MOST_INPUTS", "checked", "content", "identity", "levels", "pulses", "watchdog"]

END = b"\n"
_DIGITS = b"0123456789ABCDEF"


def checked(text: str) -> bytes:
    """Return a line with its checksum.

    Parameters
    ----------
    text : str
        ASCII without ``*`` and line feed.
    """
    data = text.encode("ascii")
    return data + f"*{reduce(xor, data, 0):02X}".encode("ascii") + END


ASK = checked("?")
"""The line that asks the board to identify itself."""


MOST_INPUTS: Final = 8
INPUTS: Final = checked("I")
"""The line that asks for the levels of the inputs."""


def content(line: bytes) -> str | None:
    """Return what a line says, or None if it is damaged.

    Parameters
    ----------
    line : bytes
        The line, with or without its end.
    """
    data, star, check = line.rstrip(b"\r\n").partition(b"*")
    if not star or len(check) != 2 or not set(check) <= set(_DIGITS) or not data.isascii():
        return None
    return data.decode("ascii") if int(check, 16) == reduce(xor, data, 0) else None


def pulses(widths: Sequence[int]) -> bytes:
    """Return the line that sets the pulse widths of all channels.

    Parameters
    ----------
    widths : sequence of int
        Pulse widths in the order of the channels [us]; 0 for no pulses.
    """
    return checked(" ".join(str(width) for width in widths))


def watchdog(milliseconds: int) -> bytes:
    """Return the line that sets the time without a line after which the pulses end.

    Parameters
    ----------
    milliseconds : int
        The time [ms]; 0 for never.
    """
    return checked(f"W {milliseconds}")


def identity(text: str) -> int | None:
    """Return how many channels the board has, or None if that is no answer to `ASK`.

    Parameters
    ----------
    text : str
        Content of a line, such as ``"tarsus 18"``.
    """
    name, _, count = text.partition(" ")
    return int(count) if name == "tarsus" and count.isascii() and count.isdigit() else None


def levels(text: str) -> tuple[int, ...] | None:
    """Return the levels of the inputs, or None if that is no answer to `INPUTS`.

    Parameters
    ----------
    text : str
        Content of a line, such as ``"I 011011"``.
    """
    name, _, digits = text.partition(" ")
    return tuple(map(int, digits)) if name == "I" and digits and set(digits) <= set("01") else None
