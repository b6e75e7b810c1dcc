"""Limit: how much of the commanded twist is followed, and how fast the walk may advance."""

from __future__ import annotations

from collections.abc import Sequence

from tarsus.control.command import Command
from tarsus.control.limiter.lost_time import LostTime
from tarsus.control.limiter.pending_transition import PendingTransitionLimiter
from tarsus.control.limiter.protocol import TwistGrant, TwistLimiter, TwistRequest
from tarsus.control.limiter.reference_governor import GovernorLimiter
from tarsus.control.limiter.workspace import WorkspaceLimiter
from tarsus.control.tick.components import WalkComponents
from tarsus.control.walk_state import TickState, WalkState

__all__ = ["limited", "twist_limiters"]


def twist_limiters(walk: WalkComponents) -> list[TwistLimiter]:
    """Return the twist limiters in their order; the last, the governor, sets the twist from what the others grant."""
    ground, roughness, stance = walk.ground, walk.ground.body.roughness, walk.ground.body.stance

    def rate(twist: Sequence[float]) -> float | None:
        if ground.condition.carried:
            return None
        pace = ground.support.pace * walk.time_scaling.rate * (not ground.missing.refuses)
        velocity = complex(*twist[:2])
        backs = (ground.missing.back * velocity.conjugate()).real / max(abs(velocity) ** 2, 1e-6)
        return min(backs, 0.0) + pace

    return [
        LostTime(roughness.adaptation.catch_up, rate),
        walk.ground.missing,
        walk.ground.body.stopped,
        walk.ground.body.slope,
        WorkspaceLimiter(
            walk.robot.leg_names, walk.transitions, lambda: (roughness.cycle_time(stance.cycle_time), roughness.speed)
        ),
        PendingTransitionLimiter(walk.transitions),
        GovernorLimiter(walk.transitions, lambda: walk.ground.body.looks),
    ]


def limited(
    walk: WalkComponents, tick: TickState, command: Command, dt: float, limiters: Sequence[TwistLimiter]
) -> TickState:
    """Return the state with the twist to follow; a standing robot starts to step if there is a reason to.

    Parameters
    ----------
    walk, tick : WalkComponents, TickState
        The components; the state.
    command, dt, limiters : Command, float, sequence of TwistLimiter
        What is commanded; length of the tick [s]; the limiters in their order.
    """
    transitions, standing = walk.transitions, tick.standing
    state = transitions.timing.with_first_lift(tick.gait, 0) if standing else tick.gait
    request, grant = TwistRequest(tuple(command.twist), dt, state, tick.twist), TwistGrant()
    for limiter in limiters:
        grant = limiter.limit(request, grant)
    steps = not standing or any(grant.scaled(command.twist)) or not transitions.at_rest(tick.gait, stands=True)
    shift = transitions.body_shift if steps else None
    shifted = transitions.pose.set_shift(shift, state.shift.value)
    if not steps or (standing and not shifted):
        # A standing robot keeps every foot on the ground until the body is over those that stay in the first step.
        return tick._replace(gait=state if steps else tick.gait, limitations=grant.limitations)
    assert grant.target is not None  # the governor sets it
    # A robot that no longer stands counts as stopping until the end of the tick, where its walk state is decided.
    following = WalkState.STOPPING if standing else tick.walk_state
    return TickState(state, grant.target, following, grant.limitations)
