"""Plan: the stance that a command asks for, transitions to it, and the targets of legs taken out of the gait."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from tarsus.control.command import Command
from tarsus.control.limitation import Cause
from tarsus.control.tick.components import WalkComponents
from tarsus.control.transition.stance_transition import StanceTarget, StanceTransition, WalkParameters
from tarsus.control.walk.state import GaitState
from tarsus.control.walk_state import TickState
from tarsus.gait.stance.stability import support_sets
from tarsus.gait.stance.supporting_feet import one_at_a_time
from tarsus.incremental import Incremental
from tarsus.kinematics.stability import stability_margin

__all__ = ["planned"]

# Least static stability margin on the remaining feet when a leg is taken out of the gait [m].
_LEAST_MARGIN = 0.01


def planned(walk: WalkComponents, tick: TickState, command: Command, dt: float) -> TickState:
    """Return the state after one stage of planning; a planned transition begins as soon as it may.

    Parameters
    ----------
    walk : WalkComponents
        The components; the transition executor plans and begins transitions.
    tick, command, dt : TickState, Command, float
        The state; what is commanded; length of the tick [s].
    """
    state = walk.transitions.advance(partial(_plan_transition, walk, tick.gait), tick)
    walk.foot_targets.set_targets(command, state, walk.transitions.current.parameters.sway, dt)
    return tick if state is tick.gait else tick._replace(gait=state)


def _plan_transition(
    walk: WalkComponents, state: GaitState, parameters: WalkParameters, stay: bool
) -> Incremental[StanceTransition | Cause]:
    """Plan the transition from the present stance; for legs out of the gait, first check the support of the others."""
    excluded, asked = parameters.excluded, parameters.gait
    if excluded:
        yield
        margin = _support(walk, state, parameters)
        if margin < _LEAST_MARGIN:
            reason = f"not enough support in the {asked.name} gait without this leg"
            names = " and ".join(walk.robot.leg_names[leg] for leg in excluded)
            cause = Cause(reason, names, margin, _LEAST_MARGIN)
            gait = one_at_a_time(asked.legs, excluded)
            if gait is None or excluded == walk.transitions.current.parameters.excluded:
                return cause
            parameters = replace(parameters, gait=gait)
            if _support(walk, state, parameters) < _LEAST_MARGIN:
                return cause
    present = StanceTarget(walk.transitions.pose.posture, walk.transitions.footholds.new_rest)
    return (yield from walk.planner.plan(parameters, present, stay=stay))


def _support(walk: WalkComponents, state: GaitState, parameters: WalkParameters) -> float:
    """Return the least static stability margin over a cycle, without the legs taken out of the gait [m]."""
    sets = support_sets(parameters.gait, parameters.excluded)
    return float(stability_margin(walk.robot, walk.time_scaling.angles, state.body, sets).min())
