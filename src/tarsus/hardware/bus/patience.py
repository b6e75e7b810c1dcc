"""How long answers are waited for, on lines where servos are asked one at a time."""

from __future__ import annotations

from collections.abc import Collection

__all__ = ["Patience"]

# Answers after which a servo's times count as known; the wait for it is this multiple of its slowest answer.
_KNOWN, _FACTOR = 8, 4.0
# Factor on the wait for each missed answer, so that servos that have become slower are found again.
_RAISE = 1.5
# Least wait before that factor: on a busy computer, a program may be suspended for a few milliseconds [s].
_LEAST = 0.004
# Factor by which a servo's slowest time fades with each further answer.
_FADING = 0.99


class Patience:
    """Adapts the wait for a servo to the times that it has taken, and extends it after each missed answer.

    The retransmission timeout of RFC 6298 is the model: a bound from measured times, raised with each failure. With a
    fixed timeout, a missing servo would take as much time as a dozen that answer.

    Parameters
    ----------
    longest : float
        Wait for a servo whose times are not known yet, and longest wait for any servo [s].
    """

    def __init__(self, longest: float) -> None:
        self.longest = longest
        self._slowest: dict[int, float] = {}
        self._answers: dict[int, int] = {}
        self._missed: dict[int, int] = {}

    def usual(self, ids: Collection[int]) -> float:
        """Return how late answers may be by their known times, without the increase for missed answers [s].

        Parameters
        ----------
        ids : collection of int
            The servos.
        """
        return max((self._bound(id, 0) for id in ids), default=self.longest)

    def now(self, ids: Collection[int]) -> float:
        """Return how long to wait for the next answers [s].

        Parameters
        ----------
        ids : collection of int
            The servos.
        """
        return max((self._bound(id, self._missed.get(id, 0)) for id in ids), default=self.longest)

    def answered(self, id: int, seconds: float) -> None:
        """Record how long a servo took to answer.

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
        """Record that a servo was waited for in vain.

        Parameters
        ----------
        id : int
            The servo.
        """
        self._missed[id] = self._missed.get(id, 0) + 1

    def _bound(self, id: int, missed: int) -> float:
        if self._answers.get(id, 0) < _KNOWN:
            return self.longest
        # The exponent is limited, as the longest wait applies after a few failures in any case.
        return min(self.longest, max(_LEAST, _FACTOR * self._slowest[id]) * _RAISE ** min(missed, 10))
