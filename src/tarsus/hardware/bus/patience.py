"""How long answers are waited for, on lines where servos are asked one at a time."""

from __future__ import annotations

from collections.abc import Collection

__all__ = ["Patience"]

# A servo that has answered this often is known; it is waited for this many times as long as it took at most.
_KNOWN, _FACTOR = 8, 4.0
# By how much the bound is raised with each failure: servos that have become slower are found again.
_RAISE = 1.5
# Programs are kept from running for a few milliseconds on computers that do other things as well [s].
_LEAST = 0.004
# How slowly it is forgotten how long an answer took, per answer.
_FADING = 0.99


class Patience:
    """Waits as long as a servo needs, as far as that is known, and longer after each answer that is missed.

    The retransmission timeout of RFC 6298 is the model: a bound from measured times, raised with each failure. Without
    it a missing servo takes as much time as a dozen that answer.

    Parameters
    ----------
    longest : float
        How long a servo is waited for of which nothing is known, and any servo at most [s].
    """

    def __init__(self, longest: float) -> None:
        self.longest = longest
        self._slowest: dict[int, float] = {}
        self._answers: dict[int, int] = {}
        self._missed: dict[int, int] = {}

    def usual(self, ids: Collection[int]) -> float:
        """Return how late answers may be as far as is known, whatever was missed since [s].

        Parameters
        ----------
        ids : collection of int
            The servos.
        """
        return max((self._bound(id, 0) for id in ids), default=self.longest)

    def now(self, ids: Collection[int]) -> float:
        """Return how long the next answers are waited for [s].

        Parameters
        ----------
        ids : collection of int
            The servos.
        """
        return max((self._bound(id, self._missed.get(id, 0)) for id in ids), default=self.longest)

    def answered(self, id: int, seconds: float) -> None:
        """Take note of how long a servo took.

        Parameters
        ----------
        id : int
            The servo.
        seconds : float
            From the end of the request to the answer, without the answer's own time on the wire [s].
        """
        self._slowest[id] = max(seconds, self._slowest.get(id, 0.0) * _FADING)
        self._answers[id] = self._answers.get(id, 0) + 1
        self._missed[id] = 0

    def missed(self, id: int) -> None:
        """Take note that a servo was waited for in vain.

        Parameters
        ----------
        id : int
            The servo.
        """
        self._missed[id] = self._missed.get(id, 0) + 1

    def _bound(self, id: int, missed: int) -> float:
        if self._answers.get(id, 0) < _KNOWN:
            return self.longest
        # After a few failures it is the longest in any case.
        return min(self.longest, max(_LEAST, _FACTOR * self._slowest[id]) * _RAISE ** min(missed, 10))
