"""What was sent, and when: hence where a joint should be by now, given the delay with which servos follow."""

from __future__ import annotations

import math
from collections import deque
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["CommandHistory"]

_SAME = 1e-6
_KEPT = 100
# Delays that are tried [s], time constant with which their errors fade [s], and the most that one error counts [rad].
_DELAYS, _MEMORY, _LARGEST = np.arange(0.0, 0.061, 0.01), 4.0, math.radians(5)
# Error of a delay before any is measured, per second that it differs from the delay of the settings [rad/s].
_PRIOR = 20.0


class CommandHistory:
    """Keeps commands with their times.

    Where readings are farther apart than servos take to follow, a small error of their delay is worth the motion of a
    whole tick. There the delay is measured: it is the one at which motions are most like those commanded.

    Parameters
    ----------
    delay : float
        Time after which a servo begins to follow, as long as nothing is known [s].
    """

    def __init__(self, delay: float) -> None:
        self._times: deque[float] = deque(maxlen=_KEPT)
        self._sent: deque[Float[np.ndarray, "legs 3"]] = deque(maxlen=_KEPT)
        self._default = delay
        self._errors = _PRIOR * np.abs(_DELAYS - delay)
        self._measured = False

    @property
    def delay(self) -> float:
        """Time after which a servo begins to follow [s]."""
        return float(_DELAYS[int(np.argmin(self._errors))]) if self._measured else self._default

    def add(self, time: float, sent: Float[np.ndarray, "legs 3"]) -> tuple[float, float]:
        """Add what was sent, and return the time since the last commands and the greatest change of angle [s, rad].

        Parameters
        ----------
        time : float
            When it had been transmitted [s].
        sent : array, shape (legs, 3)
            Joint angles [rad].
        """
        passed = time - self._times[-1] if self._times else 0.0
        way = float(np.abs(sent - self._sent[-1]).max()) if self._sent else 0.0
        if not self._times or passed > 0:
            self._times.append(time)
            self._sent.append(sent)
        return passed, way

    def expected(
        self, times: Float[np.ndarray, "legs 3"], delay: float | None = None
    ) -> Float[np.ndarray, "legs 3"] | None:
        """Return the commands that joints should have followed by some times; None where the history is too short.

        Parameters
        ----------
        times : array, shape (legs, 3)
            When each was measured [s].
        delay : float, optional
            Time after which they follow; `delay` where left out [s].
        """
        after = self.delay if delay is None else delay
        index = np.searchsorted(np.array(self._times), times - after + _SAME, side="right") - 1
        if (index < 0).any():
            return None
        first = int(index.min())
        chosen = np.array([self._sent[i] for i in range(first, int(index.max()) + 1)])
        return np.asarray(np.take_along_axis(chosen, (index - first)[None], axis=0)[0])

    def moved(
        self,
        before: Float[np.ndarray, "legs 3"],
        now: Float[np.ndarray, "legs 3"],
        *,
        times: Float[np.ndarray, "2 legs 3"],
        which: Bool[np.ndarray, "legs 3"],
    ) -> None:
        """Compare motions between two readings that are far apart with those commanded, to measure the delay.

        Parameters
        ----------
        before, now : array, shape (legs, 3)
            Joint angles [rad].
        times : array, shape (2, legs, 3)
            When they were measured [s].
        which : array of bool, shape (legs, 3)
            Which joints count.
        """
        errors = np.zeros(len(_DELAYS))
        for i, delay in enumerate(_DELAYS):
            old, new = (self.expected(np.where(which, each, times[1].max()), delay) for each in times)
            if old is None or new is None:
                return
            short = np.minimum(np.abs((now - before) - (new - old)), _LARGEST)
            errors[i] = short[which].sum()
        self._errors = self._errors * math.exp(-float((times[1] - times[0])[which].mean()) / _MEMORY) + errors
        self._measured = True
