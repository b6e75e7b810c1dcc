"""What goes wrong on emulated lines."""

from __future__ import annotations

import random
from dataclasses import dataclass, field

from tarsus.representation import represented

__all__ = ["Faults"]

# Greatest length of a frame's header [bytes].
_HEADER = 4


@represented()
@dataclass(kw_only=True)
class Faults:
    """Faults of an emulated line; they can be changed while it runs.

    Attributes
    ----------
    missing : set of int
        Servos that do not answer and do not move.
    duplicate : set of int
        Ids that two servos have: both answer at the same time.
    corrupt : dict of int to float
        Probability with which an answer of a servo is damaged.
    late : dict of int to float
        By how much the answers of a servo come too late [s].
    echo : bool
        Whether the adapter returns what is sent.
    unplugged : bool
        Whether the cable to the computer is pulled out.
    seed : int
        Of what is random.
    """

    missing: set[int] = field(default_factory=set)
    duplicate: set[int] = field(default_factory=set)
    corrupt: dict[int, float] = field(default_factory=dict)
    late: dict[int, float] = field(default_factory=dict)
    echo: bool = False
    unplugged: bool = False
    seed: int = 0

    def __post_init__(self) -> None:
        self._random = random.Random(self.seed)

    def delivered(self, id: int, answer: bytes) -> bytes:
        """Return an answer as it arrives, perhaps damaged.

        Parameters
        ----------
        id : int
            Who sent it.
        answer : bytes
            The answer.
        """
        if not answer or self._random.random() >= self.corrupt.get(id, 0.0):
            return answer
        damaged, at = bytearray(answer), self._random.randrange(len(answer))
        kind = self._random.randrange(3)
        if kind == 0:
            damaged[at] ^= 1 << self._random.randrange(8)
        elif kind == 1:
            del damaged[at]
        else:
            # Inserted before or within the header, a byte can leave the frame whole, so it goes behind the header.
            damaged.insert(max(at, min(_HEADER, len(answer) - 1)), self._random.randrange(256))
        return bytes(damaged)
