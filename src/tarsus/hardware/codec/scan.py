"""What is found in bytes that arrive: whole frames, damaged ones, and the beginning of the next."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Frame", "Scanned"]


@dataclass(frozen=True, slots=True)
class Frame:
    """A whole frame with a correct checksum.

    Attributes
    ----------
    id : int
        Id of the servo that sent it.
    code : int
        The byte that tells what it is: an instruction, a command or an error.
    data : bytes
        Parameters.
    raw : bytes
        The frame as it was on the wire.
    """

    id: int
    code: int
    data: bytes
    raw: bytes


@dataclass(frozen=True, slots=True)
class Scanned:
    """Frames in a stream of bytes.

    Attributes
    ----------
    frames : tuple of Frame
        Whole frames, in their order.
    rest : bytes
        The beginning of a frame that is not complete yet.
    damaged : tuple of bytes
        What is no frame: noise, and frames with a wrong checksum.
    """

    frames: tuple[Frame, ...]
    rest: bytes
    damaged: tuple[bytes, ...]
