"""The stance in which the walk controller starts."""

from __future__ import annotations

import math

from tarsus.control.incremental import complete
from tarsus.control.limitation import Cause
from tarsus.control.transition.planner import TransitionPlanner
from tarsus.control.transition.stance_transition import StanceTransition, WalkParameters
from tarsus.errors import InputError, UnreachableError
from tarsus.gait.walk_setup import WalkSetup, require_number

__all__ = ["initial_stance"]


def initial_stance(
    planner: TransitionPlanner, setup: WalkSetup, *, stance_width: float, cycle_time: float | None
) -> StanceTransition:
    """Return the stance that a setup asks for.

    Parameters
    ----------
    planner : TransitionPlanner
        Plans for the robot of the setup.
    setup : WalkSetup
        Robot, gait and heights.
    stance_width : float
        Distance that the feet rest farther out than by default [m].
    cycle_time : float or None
        Duration of a cycle [s]; None for the one with the highest top speed.

    Raises
    ------
    InputError
        If stance width or cycle time are not finite, or out of their range.
    UnreachableError
        If the robot can't stand and step so.
    """
    if not math.isfinite(stance_width):
        raise InputError(f"stance_width is {stance_width} m; it must be a finite number")
    if cycle_time is not None:
        require_number("cycle_time", cycle_time, zero=False)
    parameters = WalkParameters(
        gait=setup.gait,
        body=(0.0,) * 6,
        body_height=setup.body_height,
        swing_height=setup.swing_height,
        stance_width=stance_width,
        cycle_time=cycle_time,
    )
    found = complete(planner.plan(parameters, None))
    if isinstance(found, Cause):
        raise UnreachableError(f"the robot can't stand and step in this stance: {found.text()}")
    return found
