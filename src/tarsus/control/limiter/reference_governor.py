"""Changes the twist only as far as keeps every standing foot inside its workspace until its next lift-off."""

from __future__ import annotations

import numpy as np

from tarsus.control.limiter.protocol import TwistGrant, TwistRequest
from tarsus.control.terrain.adaptation import TerrainAdaptation
from tarsus.control.transition.executor import TransitionExecutor
from tarsus.control.walk.reference_governor import governed_twist

__all__ = ["GovernorLimiter"]

# Relative difference at which a twist counts as steady.
_STEADY = 1e-3


class GovernorLimiter:
    """Sets the twist to follow; the last of the twist limiters.

    Parameters
    ----------
    transitions : TransitionExecutor
        The stance and its transitions.
    terrain : TerrainAdaptation
        Decides how much longer than planned feet may have to stand.
    """

    def __init__(self, transitions: TransitionExecutor, terrain: TerrainAdaptation) -> None:
        self._transitions, self._terrain = transitions, terrain

    def limit(self, request: TwistRequest, grant: TwistGrant) -> TwistGrant:
        """Return the grant with the twist to follow."""
        if grant.target is not None:
            return grant
        transitions, command = self._transitions, grant.scaled(request.twist)
        # In steady walking nothing changes; before, feet may be put down where the target leaves them no margin.
        if command == request.target.tolist() and self._is_steady(request, command):
            return TwistGrant(grant.fraction, request.target, grant.limitations)
        begins, ends = transitions.stance_intervals(request.state, self._terrain.hold_time)
        target = governed_twist(
            request.state,
            request.target,
            np.array(command),
            begins=begins,
            ends=ends,
            bounds=transitions.bounds,
            bandwidth=transitions.bandwidth,
        )
        return TwistGrant(grant.fraction, target, grant.limitations)

    def _is_steady(self, request: TwistRequest, twist: list[float]) -> bool:
        """Return whether the robot walks at the twist and at its cycle time."""
        value = request.state.twist.value.tolist()
        difference = max(abs(a - b) for a, b in zip(value, twist, strict=True))
        return self._transitions.timing_is_steady and difference <= _STEADY * max(map(abs, twist))
