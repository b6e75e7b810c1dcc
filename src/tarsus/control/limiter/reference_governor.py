"""Changes the twist only as far as keeps every standing foot inside its workspace until its next lift-off."""

from __future__ import annotations

from collections.abc import Callable
from operator import is_
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.control.limitation import Cause, LimitationKind
from tarsus.control.limiter.protocol import TwistGrant, TwistRequest
from tarsus.control.transition.executor import TransitionExecutor
from tarsus.control.walk.reference_governor import FootPrediction
from tarsus.control.walk.state import GaitState
from tarsus.gait.foot_polygons import polygon_margin

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["GovernorLimiter"]

# Relative difference from the commanded twist up to which the twist counts as steady.
_STEADY = 1e-3
_STOPS = Cause("standing feet would leave their workspaces").limitation(LimitationKind.TWIST, asked=1.0, granted=0.0)


class GovernorLimiter:
    """Sets the twist to follow; the last of the twist limiters.

    Parameters
    ----------
    transitions, looks : TransitionExecutor, callable
        The stance and its transitions; returns whether a walk that feels the ground takes a look in this tick.
    """

    def __init__(self, transitions: TransitionExecutor, looks: Callable[[], bool]) -> None:
        self._transitions, self._looks = transitions, looks
        # The target that was found last; the command and the stance for which it was found.
        self._target: Float[np.ndarray, "3"] = np.zeros(3)
        self._command, self._stance = list[float](), tuple[Any, ...]()

    def limit(self, request: TwistRequest, grant: TwistGrant) -> TwistGrant:
        """Return the grant with the twist to follow."""
        state, transitions, command = request.state, self._transitions, grant.scaled(request.twist)
        stance = (state.down, transitions.timing, transitions.changes_gait, transitions.footholds.bounds)
        # While the same feet stand, a feasible target stays feasible. Feet that follow the ground deviate from the
        # prediction: for these, the target is examined again at each look.
        stays = not self._looks() if state.felt else self._target.tolist() == self._command
        if not stays or command != self._command or not all(map(is_, stance, self._stance)):
            self._command, self._stance, self._target = command, stance, self._governed(request, command)
        stops = [_STOPS] if any(command) and not self._target.any() else []
        return TwistGrant(grant.fraction, self._target, (*grant.limitations, *stops))

    def _governed(self, request: TwistRequest, command: list[float]) -> Float[np.ndarray, "3"]:
        """Return the twist to follow."""
        # In steady walking nothing changes; before that, feet may be put down where the target leaves them no margin.
        if command == request.target.tolist() and self._is_steady(request, command):
            return request.target
        transitions, state = self._transitions, request.state
        prediction = FootPrediction.of(state, *transitions.stance_intervals(state), transitions.bandwidth)
        return prediction.governed_twist(request.target, np.array(command), transitions.bounds)

    def _is_steady(self, request: TwistRequest, twist: list[float]) -> bool:
        """Return whether the robot walks steadily: at the twist, and at the cycle time to reach."""
        value, transitions = request.state.twist.value.tolist(), self._transitions
        difference = max(abs(a - b) for a, b in zip(value, twist, strict=True))
        steady = not transitions.changes_gait and transitions.timing.frequency == transitions.frequency
        steady = steady and difference <= _STEADY * max(map(abs, twist))
        return steady and not (request.state.felt and self._is_behind(request.state))

    def _is_behind(self, state: GaitState) -> bool:
        """Return whether a standing foot is outside its polygon, as after landing short of its foothold."""
        margins = polygon_margin(self._transitions.bounds, state.in_heading(state.foot))
        return bool((margins < 0)[state.down].any())
