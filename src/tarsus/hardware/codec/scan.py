"""What is found in bytes that arrive: whole frames, damaged ones, and the beginning of the next."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

__all__ = ["Frame", "Framing", "Scanned", "Scanner", "scan_frames"]


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
    parts : tuple of Frame or bytes
        In their order, whole frames and what is no frame: noise, and frames with a wrong checksum.
    rest : bytes
        The beginning of a frame that is not complete yet.
    suspect : tuple of Frame
        Frames that bytes follow which belong to no frame. Where a byte was inserted into a frame or lost from it, what
        is left may have the right checksum by chance, but then something is left over behind it.
    """

    parts: tuple[Frame | bytes, ...]
    rest: bytes
    suspect: tuple[Frame, ...] = ()

    @property
    def frames(self) -> tuple[Frame, ...]:
        """Whole frames."""
        return tuple(part for part in self.parts if isinstance(part, Frame))

    @property
    def damaged(self) -> tuple[bytes, ...]:
        """What is no frame."""
        return tuple(part for part in self.parts if isinstance(part, bytes))


class Scanner(Protocol):
    """A codec's function that finds frames in bytes."""

    def __call__(self, received: bytes, *, ended: bool = False) -> Scanned:
        """Return what is in the bytes that have arrived.

        Parameters
        ----------
        received : bytes
            What has arrived and was not part of a frame before.
        ended : bool
            Whether nothing more comes, so that an incomplete frame is a damaged one.
        """


@dataclass(frozen=True, slots=True)
class Framing:
    """How the frames of a protocol look.

    Attributes
    ----------
    header : bytes
        With which each frame begins.
    known : int
        How many bytes must be there until the length of a frame is known.
    size : callable
        Size of the frame that begins with these bytes, or 0 if none begins with them.
    decode : callable
        The frame in whole bytes, or None if they are damaged.
    """

    header: bytes
    known: int
    size: Callable[[bytes], int]
    decode: Callable[[bytes], Frame | None]


def scan_frames(received: bytes, framing: Framing, *, ended: bool) -> Scanned:
    """Return the frames in a stream of bytes.

    Parameters
    ----------
    received : bytes
        What has arrived and was not part of a frame before.
    framing : Framing
        How frames look.
    ended : bool
        Whether nothing more comes, so that an incomplete frame is a damaged one.
    """
    parts: list[Frame | bytes] = []
    at = noise = 0
    while at < len(received):
        end = at + _size(received[at : at + framing.known], framing)
        if end > len(received) and not ended:
            break
        frame = framing.decode(received[at:end]) if at < end <= len(received) else None
        if frame is not None:
            parts += [received[noise:at]] if at > noise else []
            parts.append(frame)
            at = noise = end
        else:
            # Where another frame follows, the length is right: bytes inside a damaged frame are no frames.
            follows = at < end and received[end:].startswith(framing.header)
            at = end if follows or end == len(received) > at else at + 1
    parts += [received[noise:at]] if at > noise else []
    return Scanned(tuple(parts), received[at:], _suspect(parts, framing.header))


def _suspect(parts: Sequence[Frame | bytes], header: bytes) -> tuple[Frame, ...]:
    """Return frames behind which something is left over that is not a damaged frame with its header."""
    return tuple(
        one
        for one, after in itertools.pairwise(parts)
        if isinstance(one, Frame) and isinstance(after, bytes) and not after.startswith(header)
    )


def _size(begin: bytes, framing: Framing) -> int:
    """Return the size of a frame that begins with these bytes, at least that; 0 if none can."""
    if not framing.header.startswith(begin[: len(framing.header)]):
        return 0
    return framing.size(begin) if len(begin) == framing.known else framing.known
