"""Integrate, solve and scale: the gait state and the joint angles after the tick, as far as the joints can follow."""

from __future__ import annotations

from collections.abc import Sequence

from tarsus.control.limiter.protocol import RateLimiter, granted_rate
from tarsus.control.tick.components import WalkComponents
from tarsus.control.tick.state import TickState
from tarsus.control.walk.state import PHASE_TOLERANCE, GaitState, StepInputs
from tarsus.control.walk.stepper import advance
from tarsus.control.walk_state import next_walk_state

__all__ = ["integrated"]

_NO_MOTION = (0.0,) * 6


def integrated(walk: WalkComponents, tick: TickState, dt: float, limiters: Sequence[RateLimiter]) -> TickState:
    """Return the state after the tick; the time scaling has its joint angles.

    Parameters
    ----------
    walk : WalkComponents
        The components.
    tick : TickState
        The state.
    dt : float
        Length of the tick [s].
    limiters : sequence of RateLimiter
        The limiters of the walk's time rate.
    """
    timing, targets, terrain = walk.transitions.timing, walk.foot_targets, walk.transitions.current.terrain
    inputs = _step_inputs(walk, tick, dt)
    state = walk.terrain.search(tick.gait, dt, terrain=terrain, stance_time=timing.stance_time)
    grant = granted_rate(limiters, state)

    def integrate(time: float) -> GaitState:
        return targets.apply(advance(state, inputs, time), time, swing_time=timing.swing_time)

    after = walk.time_scaling.advance(integrate, walk.solver.angles, dt, stop=grant.stop, fastest=grant.rate)
    targets.step(dt * walk.time_scaling.rate, after.down)
    return _finished(walk, tick, after, dt)


def _step_inputs(walk: WalkComponents, tick: TickState, dt: float) -> StepInputs:
    """Return what the stepper is given for a tick."""
    state, standing = tick.gait, tick.standing
    transitions, terrain = walk.transitions, walk.terrain
    timing, pose, current = transitions.timing, transitions.pose, transitions.current
    sway = _NO_MOTION if standing or timing.gait.body_shift else current.parameters.sway
    pose.set_sway(sway, frequency=timing.frequency, beats=timing.beats)
    every = walk.every_leg
    may_lift, may_land, hold_feet = every, every, transitions.changes_gait
    if walk.foot_targets:
        may_lift = every.copy()
        may_lift[list(current.parameters.excluded)] = False
    if terrain.estimate is not None:
        phase = state.swing_phase + dt * timing.frequency / state.swings(timing.gait.duty_factor)
        may_land, waits = terrain.may_land(state, phase >= 1.0 - PHASE_TOLERANCE)
        hold_feet = hold_feet or waits
    inputs = StepInputs(
        gait=timing.gait,
        frequency=0.0 if standing else timing.frequency,
        twist=tick.twist,
        posture=pose.target,
        bandwidth=transitions.bandwidth,
        posture_bandwidth=pose.bandwidth(state.posture.value),
        may_lift=may_lift,
        may_land=may_land,
        rest=transitions.footholds.rest,
        placement_bounds=transitions.footholds.placement_bounds,
        placement_radii=transitions.footholds.placement_radii,
        admittance_offset=walk.no_offset,
        hold_feet=hold_feet,
        beats=timing.beats,
        swaying=pose.is_swaying(state.posture.value),
        shift=pose.shift,
    )
    return inputs if terrain.estimate is None else inputs._replace(**terrain.step_inputs(state, current.terrain))


def _finished(walk: WalkComponents, tick: TickState, state: GaitState, dt: float) -> TickState:
    """Return the state, once steps, transitions and searches that end with the tick have ended."""
    landed = None if state.down is tick.gait.down else state.down & ~tick.gait.down
    if landed is not None and landed.any():
        walk.terrain.feet_landed(landed)
        walk.transitions.footholds.feet_landed(landed)
    state = walk.transitions.finish(state, dt)
    if tick.standing:
        return TickState(state, tick.twist, tick.walk_state, tick.limitations)
    follows_twist = any(tick.twist.tolist())
    still = not (follows_twist or any(state.twist.value.tolist())) and bool(state.down.all())
    following = next_walk_state(
        tick.walk_state,
        follows_twist=follows_twist,
        at_rest=still and walk.transitions.at_rest(state),
        changes_gait=walk.transitions.changes_gait,
        searches=bool(walk.terrain.searches),
    )
    return TickState(state, tick.twist, following, tick.limitations)
