"""Integrate, solve and scale: the gait state and the joint angles after the tick, as far as the joints can follow."""

from __future__ import annotations

from tarsus.control.tick.components import WalkComponents
from tarsus.control.walk.state import GaitState, StepInputs
from tarsus.control.walk.stepper import advance
from tarsus.control.walk.vertical_motion import moved_vertically
from tarsus.control.walk_state import TickState, next_walk_state

__all__ = ["integrated"]

_NO_MOTION = (0.0,) * 6


def integrated(walk: WalkComponents, tick: TickState, dt: float) -> TickState:
    """Return the state after the tick; its joint angles are in the time scaling.

    Parameters
    ----------
    walk, tick, dt : WalkComponents, TickState, float
        The components; the state; length of the tick [s].
    """
    timing, targets = walk.transitions.timing, walk.foot_targets
    inputs = _step_inputs(walk, tick, dt)

    def integrate(time: float) -> GaitState:
        moved = moved_vertically(advance(tick.gait, inputs, time), inputs, time)
        return targets.apply(moved, time, swing_time=timing.swing_time)

    scaling = walk.time_scaling
    if inputs.felt is None:
        after = scaling.advance(integrate, walk.solver.angles, dt)
    else:
        after = scaling.follow(integrate, walk.solver.angles, dt, exact=bool(walk.ground.body.choice.crossing))
    targets.step(dt * scaling.rate, after.down)
    return _finished(walk, tick, after, dt)


def _step_inputs(walk: WalkComponents, tick: TickState, dt: float) -> StepInputs:
    """Return the inputs of the stepper for a tick."""
    state, standing = tick.gait, tick.standing
    transitions = walk.transitions
    timing, pose, parameters = transitions.timing, transitions.pose, transitions.current.parameters
    footholds, excluded = transitions.footholds, walk.foot_targets.legs
    sway = _NO_MOTION if standing or timing.gait.body_shift else parameters.sway
    pose.set_sway(sway, frequency=timing.frequency, beats=timing.gait.beats)
    felt, offsets = None, state.admittance_offset.value
    if state.felt:
        footholds.shift(walk.ground.body.stance.shift)
        felt = walk.ground.inputs(tick, transitions, excluded, dt)
        if walk.ground.offsets is not None:
            offsets = walk.ground.offsets * state.down
    walk.solver.rolling.step(footholds.rest, excluded, dt, down=state.down)
    return StepInputs(
        gait=timing.gait,
        frequency=0.0 if standing else timing.frequency,
        twist=tick.twist,
        posture=pose.target,
        bandwidth=transitions.bandwidth,
        posture_bandwidth=pose.bandwidth(state.posture.value),
        rest=footholds.rest,
        placement_bounds=footholds.placement_bounds,
        placement_radii=footholds.placement_radii,
        admittance_offset=offsets,
        hold_feet=transitions.changes_gait or walk.ground.support.waits,
        excluded=(*parameters.excluded, *walk.ground.support.stay),
        unstepped=transitions.unstepped,
        shift=pose.shift,
        felt=felt,
    )


def _finished(walk: WalkComponents, tick: TickState, state: GaitState, dt: float) -> TickState:
    """Return the state after completing the steps, transitions and searches that end with the tick."""
    walk.transitions.footholds.feet_landed(tick.gait.down, state.down)
    state = walk.transitions.finish(state, dt)
    if tick.standing:
        return tick._replace(gait=state)
    follows_twist = any(tick.twist.tolist())
    still = not (follows_twist or any(state.twist.value.tolist())) and bool(state.down.all())
    following = next_walk_state(
        tick.walk_state,
        follows_twist=follows_twist,
        at_rest=still and walk.transitions.at_rest(state),
        changes_gait=walk.transitions.changes_gait,
        searches=walk.ground.support.halts,
    )
    return tick._replace(gait=state, walk_state=following)
