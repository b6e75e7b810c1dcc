"""Lynxmotion SSC-32 and SSC-32U: lines of ASCII that end with a carriage return.

Sources: Lynxmotion SSC-32U user guide, "Commands"; ``P0``, which ends the pulses, is Lynxmotion's own answer in
community.robotshop.com/forum/t/servo-release-with-ssc-32u.
"""

from __future__ import annotations

from collections.abc import Mapping

__all__ = ["END", "INPUTS", "MOVING", "VERSION", "move", "query_inputs", "query_pulses", "read_inputs", "read_pulses"]

END = b"\r"
VERSION = b"VER\r"
MOVING = b"Q\r"
INPUTS = "ABCDEF"
"""Names of the digital inputs; they have a pull-up, and are debounced for 15 ms."""


def move(pulses: Mapping[int, int], *, speeds: Mapping[int, int] | None = None) -> bytes:
    """Return the group move that sets pulse widths at the same time.

    Parameters
    ----------
    pulses : mapping of int to int
        Pulse widths by channel [us]; 0 ends the pulses.
    speeds : mapping of int to int, optional
        Highest speeds by channel [us/s].
    """
    limits = speeds or {}
    parts = (
        f"#{channel}P{pulse}" + (f"S{limits[channel]}" if channel in limits and pulse else "")
        for channel, pulse in pulses.items()
    )
    return "".join(parts).encode("ascii") + END


def query_pulses(*channels: int) -> bytes:
    """Return the query for the pulse widths that channels send; the answer has one byte for each.

    Parameters
    ----------
    *channels : int
        The channels.
    """
    return "".join(f"QP{channel}" for channel in channels).encode("ascii") + END


def query_inputs(*inputs: int) -> bytes:
    """Return the query for the levels of digital inputs; the answer has one character for each.

    Parameters
    ----------
    *inputs : int
        Numbers of the inputs, 0 for A.
    """
    return " ".join(INPUTS[number] for number in inputs).encode("ascii") + END


def read_inputs(answer: bytes) -> tuple[int, ...] | None:
    """Return levels, 0 or 1; None if the bytes are no answer to `query_inputs`.

    Parameters
    ----------
    answer : bytes
        The answer.
    """
    return tuple(byte - ord("0") for byte in answer) if set(answer) <= set(b"01") else None


def read_pulses(answer: bytes) -> tuple[int, ...]:
    """Return pulse widths [us], which the board tells in steps of 10 us.

    Parameters
    ----------
    answer : bytes
        The answer to `query_pulses`.
    """
    return tuple(10 * byte for byte in answer)
