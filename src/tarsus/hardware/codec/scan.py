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
        In order of arrival: whole frames, and as bytes what is no frame, noise and frames with a wrong checksum.
    rest : bytes
        The beginning of a frame that is not complete yet.
    suspect : tuple of Frame
        Frames followed by bytes that belong to no frame and do not begin with a header. What is left of a frame that
        gained or lost a byte may have the right checksum by chance, but then such bytes are left over behind it.
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
        """Bytes that are no frame: noise, and frames with a wrong checksum."""
        return tuple(part for part in self.parts if isinstance(part, bytes))


class Scanner(Protocol):
    """A codec's function that finds frames in bytes."""

    def __call__(self, received: bytes, *, ended: bool = False) -> Scanned:
        """Return what is in the bytes that have arrived.

        Parameters
        ----------
        received : bytes
            Bytes to search: what the last scan left over, and what has arrived since.
        ended : bool
            Whether nothing more comes, so that an incomplete frame is a damaged one.
        """


@dataclass(frozen=True, slots=True)
class Framing:
    """The layout of a protocol's frames.

    Attributes
    ----------
    header : bytes
        Bytes with which each frame begins.
    known : int
        How many bytes of a frame must have arrived for its size to be known.
    size : callable
        Returns the size of the frame that begins with some bytes, or 0 if no frame begins with them.
    decode : callable
        Returns the frame that some bytes hold, or None if they are damaged.
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
        Bytes to search: what the last scan left over, and what has arrived since.
    framing : Framing
        Layout of the frames.
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
            # Where a header or the end follows, the length is right: bytes inside the damaged frame are no frames.
            follows = at < end and received[end:].startswith(framing.header)
            at = end if follows or end == len(received) > at else at + 1
    parts += [received[noise:at]] if at > noise else []
    return Scanned(tuple(parts), received[at:], _suspect(parts, framing.header))


def _suspect(parts: Sequence[Frame | bytes], header: bytes) -> tuple[Frame, ...]:
    """Return the frames followed by bytes that do not begin with the header; a damaged frame would."""
    return tuple(
        one
        for one, after in itertools.pairwise(parts)
        if isinstance(one, Frame) and isinstance(after, bytes) and not after.startswith(header)
    )


def _size(begin: bytes, framing: Framing) -> int:
    """Return the size of the frame that begins with these bytes, its least size if that is unknown; 0 if none can."""
    if not framing.header.startswith(begin[: len(framing.header)]):
        return 0
    return framing.size(begin) if len(begin) == framing.known else framing.known
