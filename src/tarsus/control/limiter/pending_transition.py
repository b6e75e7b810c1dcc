"""Slows the walk down while a planned stance transition cannot begin at the present speed."""

from __future__ import annotations

import math

from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.limiter.protocol import TwistGrant, TwistRequest
from tarsus.control.transition.executor import TransitionExecutor

__all__ = ["PendingTransitionLimiter"]

# Time constant of the slow-down [s].
_TIME_CONSTANT = 1.0
# A fraction below this is reported: by then the transition has waited for longer than it does in regular walking.
_REPORTED = 0.05
_CAUSE = "the pending stance transition cannot begin at a higher speed"


class PendingTransitionLimiter:
    """Reduces the twist while a transition waits: exponentially, or to 0 at once where the robot has to stand for it.

    Parameters
    ----------
    transitions : TransitionExecutor
        The stance transitions.
    """

    def __init__(self, transitions: TransitionExecutor) -> None:
        self._transitions = transitions
        self._fraction = 1.0

    def limit(self, request: TwistRequest, grant: TwistGrant) -> TwistGrant:
        """Return the grant, reduced according to how long the transition has been waiting."""
        if not self._transitions.waiting:
            self._fraction = 1.0
            return grant
        planned = self._transitions.scheduler.planned
        stands = planned is not None and self._transitions.timing.stands_before(planned.parameters.gait)
        self._fraction *= 0.0 if stands else math.exp(-request.dt / _TIME_CONSTANT)
        # The twist approaches what the stances allow from above; the transition begins only below that.
        fraction = self._fraction * grant.fraction
        if self._fraction < _REPORTED and any(request.twist):
            slow = Limitation(kind=LimitationKind.TWIST, cause=_CAUSE, asked=1.0, granted=fraction)
            return grant.at_most(fraction, slow)
        return grant.at_most(fraction)
