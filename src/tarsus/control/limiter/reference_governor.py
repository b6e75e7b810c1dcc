"""Changes the twist only as far as keeps every standing foot inside its workspace until its next lift-off."""

from __future__ import annotations

import cmath

import numpy as np

from tarsus.control.limiter.protocol import TwistGrant, TwistRequest
from tarsus.control.transition.executor import TransitionExecutor
from tarsus.control.walk.reference_governor import governed_twist
from tarsus.control.walk.state import GaitState
from tarsus.gait.foot_polygons import NORMALS_CONJUGATE

__all__ = ["GovernorLimiter"]

# Relative difference at which a twist counts as steady.
_STEADY = 1e-3


class GovernorLimiter:
    """Sets the twist to follow; the last of the twist limiters.

    Parameters
    ----------
    transitions : TransitionExecutor
        The stance and its transitions.
    """

    def __init__(self, transitions: TransitionExecutor) -> None:
        self._transitions = transitions

    def limit(self, request: TwistRequest, grant: TwistGrant) -> TwistGrant:
        """Return the grant with the twist to follow."""
        if grant.target is not None:
            return grant
        transitions, command = self._transitions, grant.scaled(request.twist)
        # In steady walking nothing changes; before, feet may be put down where the target leaves them no margin.
        if command == request.target.tolist() and self._is_steady(request, command):
            return TwistGrant(grant.fraction, request.target, grant.limitations)
        begins, ends = transitions.stance_intervals(request.state)
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
        steady = self._transitions.timing_is_steady and difference <= _STEADY * max(map(abs, twist))
        return steady and not (request.state.felt is not None and self._is_behind(request.state))

    def _is_behind(self, state: GaitState) -> bool:
        """Return whether a foot that stands is outside its polygon: one that has landed short of its foothold."""
        footholds, turn = self._transitions.footholds, cmath.exp(-1j * state.yaw)
        places = [(foot - state.origin) * turn for foot in state.foot.tolist()]
        feet = zip(state.down.tolist(), places, footholds.rest.tolist(), footholds.standing_radii, strict=True)
        far = [leg for leg, (down, at, rest, radius) in enumerate(feet) if down and abs(at - rest) > radius]
        if not far:
            return False
        along = (NORMALS_CONJUGATE * np.array(places)[far, None]).real
        return bool((along > self._transitions.bounds[far]).any())
