"""Clock of the guard: valid time steps, time gaps, and steps too short to use."""

from __future__ import annotations

from tarsus.control.safety.bounds import GuardBounds
from tarsus.control.safety.interventions import InterventionKind, Violation

__all__ = ["GuardClock"]

# A longer time step is invalid rather than a gap [s].
_LONGEST_GAP = 3600.0


class GuardClock:
    """Sums the valid time steps; steps that are too short accumulate until they are long enough.

    Attributes
    ----------
    time : float
        Sum of all valid time steps [s].

    Parameters
    ----------
    bounds : GuardBounds
        Bounds of the time step.
    """

    def __init__(self, bounds: GuardBounds) -> None:
        self._shortest, self._longest = bounds.min_time_step, bounds.max_time_step
        self._pending = self.time = 0.0

    def advance(self, dt: float) -> tuple[float, list[Violation]]:
        """Advance the clock; return the time step to use, 0 for none, and the violations.

        Parameters
        ----------
        dt : float
            Time step as given, possibly NaN, infinite or negative [s].
        """
        if 0 < dt <= _LONGEST_GAP:
            self._pending += dt
        step = self._pending if self._pending >= self._shortest else 0.0
        if step > 0:
            self.time, self._pending = self.time + step, 0.0
        if self._shortest <= dt <= self._longest:
            return step, []
        if self._longest < dt <= _LONGEST_GAP:
            return step, [Violation(InterventionKind.TIME_GAP, -1, -1, dt, self._longest)]
        return step, [Violation(InterventionKind.TIME_STEP, -1, -1, dt, self._shortest)]
