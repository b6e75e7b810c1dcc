"""Plan: stance transitions, and the targets of legs that are taken out of the gait."""

from __future__ import annotations

from functools import partial

from tarsus.control.command import Command
from tarsus.control.incremental import Incremental
from tarsus.control.limitation import Cause
from tarsus.control.tick.components import WalkComponents
from tarsus.control.transition.stance_transition import StanceTarget, StanceTransition, WalkParameters
from tarsus.control.walk.state import GaitState
from tarsus.control.walk_state import TickState
from tarsus.gait.stance.stability import support_sets
from tarsus.kinematics.stability import stability_margin

__all__ = ["planned"]

# Least static stability margin on the remaining feet when a leg is taken out of the gait [m].
_LEAST_MARGIN = 0.01


def planned(walk: WalkComponents, tick: TickState, command: Command, dt: float) -> TickState:
    """Return the state after one stage of planning; what may begin, begins.

    Parameters
    ----------
    walk : WalkComponents
        The components; the transition executor plans and begins transitions.
    tick, command, dt : TickState, Command, float
        The state; what is commanded; length of the tick [s].
    """
    state = walk.transitions.advance(partial(_plan_transition, walk, tick.gait), tick)
    walk.foot_targets.set_targets(command, state.posture.value, walk.transitions.current.parameters.sway, dt)
    return tick if state is tick.gait else tick._replace(gait=state)


def _plan_transition(
    walk: WalkComponents, state: GaitState, parameters: WalkParameters, stay: bool
) -> Incremental[StanceTransition | Cause]:
    """Plan the transition from the present stance; where legs leave the gait, check the support of the others first."""
    excluded = parameters.excluded
    if excluded:
        yield
        sets = support_sets(parameters.gait, excluded)
        margin = float(stability_margin(walk.robot, walk.time_scaling.angles, state.body, sets).min())
        if margin < _LEAST_MARGIN:
            reason = f"not enough support in the {parameters.gait.name} gait without this leg"
            names = " and ".join(walk.robot.leg_names[leg] for leg in excluded)
            return Cause(reason, names, margin, _LEAST_MARGIN)
    present = StanceTarget(walk.transitions.pose.posture, walk.transitions.footholds.new_rest)
    return (yield from walk.planner.plan(parameters, present, stay=stay))
