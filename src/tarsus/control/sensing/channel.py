"""A channel of sensor readings: its parts are rejected, and accepted again once they have settled."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

__all__ = ["SETTLED", "Channel"]

SETTLED = 3
"""Consecutive plausible readings after which what was rejected is accepted again."""

_T = TypeVar("_T")


class Channel:
    """The state of a channel: that of one part for the body, or of one for each leg.

    Parameters
    ----------
    names : sequence of str
        Names of the parts in messages.
    """

    def __init__(self, names: Sequence[str]) -> None:
        # Consecutive plausible readings of each part, at most `SETTLED`; the time [s].
        self._names, self._plausible, self._now = names, [SETTLED] * len(names), 0.0

    def elapse(self, dt: float) -> None:
        """Count the time.

        Parameters
        ----------
        dt : float
            Time since the last call [s].
        """
        self._now += dt

    def reset(self) -> None:
        """Reject every part until it has been plausible `SETTLED` times in a row."""
        self._plausible = [0] * len(self._plausible)

    def _accepted(self, part: int, reading: _T | str, rejected: list[str]) -> _T | None:
        """Return the reading of a part; None if it is rejected: a text is what is wrong with it."""
        if isinstance(reading, str):
            self._plausible[part] = 0
            rejected.append(f"{self._names[part]}: {reading}")
        elif self._plausible[part] < SETTLED:
            self._plausible[part] += 1
            rejected.append(f"{self._names[part]}: settling after a rejected reading")
        else:
            return reading
        return None
