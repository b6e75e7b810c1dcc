"""Timing of steps: which feet are due to lift off, as the stepper decides it."""

import numpy as np
import pytest

from tarsus.control.walk.step_timing import StepTiming
from tarsus.control.walk.stepper import advance
from tarsus.control.walk_controller import WalkController
from tarsus.gait.gait import Gait
from tarsus.robot.file import load_robot


@pytest.mark.parametrize("gait", ["tripod", "ripple", "wave"])
def test_feet_are_due_in_the_tick_in_which_they_lift_off(gait, monkeypatch):
    ticks = []

    def stepped(state, inputs, dt):
        timing, after = StepTiming(inputs.gait, inputs.frequency), advance(state, inputs, dt)
        if inputs.frequency and not after.down.all():
            ticks.append((timing.due(state, dt), state.down & ~after.down))
        return after

    monkeypatch.setattr("tarsus.control.tick.integrate.advance", stepped)
    controller = WalkController(load_robot("strider"), Gait.named(gait))
    for _ in range(300):
        controller.step((0.05, 0.0, 0.0), 0.01)
    assert sum(lifts.any() for _, lifts in ticks) > 5
    for due, lifts in ticks:
        np.testing.assert_array_equal(due, lifts)


@pytest.mark.parametrize(
    ("gait", "redundant"),
    [
        (Gait.named("tripod"), False),
        (Gait.named("tetrapod"), True),
        (Gait.named("wave"), True),
        # Four feet stand on the average, and two for a moment.
        (Gait(2 / 3, (0.0, 0.0, 0.0, 0.05, 0.5, 0.5)), False),
    ],
)
def test_feet_are_redundant_where_more_than_three_stand_at_any_time(gait, redundant):
    assert StepTiming(gait, 1.0).redundant is redundant
