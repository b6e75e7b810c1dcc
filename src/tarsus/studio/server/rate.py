"""Rate limit of messages."""

from __future__ import annotations

__all__ = ["Rate"]


class Rate:
    """A token bucket.

    Parameters
    ----------
    per_s : float
        Sustained messages per second.
    now : float
        Present time [s].
    """

    def __init__(self, per_s: float, now: float) -> None:
        self._per_s = per_s
        self._most = 2 * per_s
        self._left = self._most
        self._at = now

    def take(self, now: float) -> bool:
        """Return whether another message is allowed.

        Parameters
        ----------
        now : float
            Present time [s].
        """
        self._left = min(self._most, self._left + (now - self._at) * self._per_s)
        self._at = now
        if self._left < 1:
            return False
        self._left -= 1
        return True
