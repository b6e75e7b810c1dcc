"""How many messages a visitor may send: a bucket that fills steadily, and each message takes from."""

from __future__ import annotations

__all__ = ["Rate"]


class Rate:
    """A token bucket.

    Parameters
    ----------
    per_s : float
        Messages a second, lasting.
    now : float
        The time [s].
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
            The time [s].
        """
        self._left = min(self._most, self._left + (now - self._at) * self._per_s)
        self._at = now
        if self._left < 1:
            return False
        self._left -= 1
        return True
