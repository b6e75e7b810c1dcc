"""Stops the robot from walking on in a direction in which the ground is too steep to stand on."""

from __future__ import annotations

from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.limiter.protocol import TwistGrant, TwistRequest
from tarsus.control.terrain.slope_limit import SlopeLimit
from tarsus.control.transition.executor import TransitionExecutor

__all__ = ["SlopeLimiter"]

_LIMITATION = Limitation(
    kind=LimitationKind.TWIST, cause="the ground is too steep in this direction", asked=1.0, granted=0.0
)


class SlopeLimiter:
    """Allows no twist that leads further onto ground for which a stance was rejected.

    Parameters
    ----------
    transitions : TransitionExecutor
        The stance transitions; those to steeper ground may be rejected.
    """

    def __init__(self, transitions: TransitionExecutor) -> None:
        self._transitions, self._slope = transitions, SlopeLimit()

    def limit(self, request: TwistRequest, grant: TwistGrant) -> TwistGrant:
        """Return the grant, with a fraction of 0 where the twist leads further onto steep ground."""
        rejections, known = self._transitions.scheduler.rejections, self._transitions.current.terrain
        if not (rejections or self._slope):
            return grant
        if any(parameters.terrain != known for parameters in rejections):
            self._slope.record(known, request.state.twist.value.tolist())
        return grant.at_most(0.0, _LIMITATION) if self._slope.forbids(request.twist, known) else grant
