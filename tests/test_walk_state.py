"""The states of walking: which follow each other, and what decides it."""

from types import SimpleNamespace

import numpy as np
import pytest

from sample_gait_states import moment_of, rest_of, setup_of
from tarsus.control.tick.integrate import _walk_state as walk_state
from tarsus.control.walk_state import TickState, WalkState


def after(state, *, follows_twist, at_rest, changes_gait=False, searches=False):
    """The state of a walk after a tick at whose end its feet are on the ground and nothing moves."""
    transitions = SimpleNamespace(at_rest=lambda _: at_rest, changes_gait=changes_gait)
    ground = SimpleNamespace(support=SimpleNamespace(halts=searches))
    gait = moment_of(setup_of("strider"), rest_of("strider"))
    tick = TickState(gait, np.array([0.1, 0.0, 0.0]) * follows_twist, state)
    return walk_state(SimpleNamespace(transitions=transitions, ground=ground), tick, gait)


@pytest.mark.parametrize(
    ("flags", "expected"),
    [
        ({"follows_twist": True, "at_rest": False}, WalkState.WALKING),
        ({"follows_twist": False, "at_rest": False}, WalkState.STOPPING),
        ({"follows_twist": True, "at_rest": False, "changes_gait": True}, WalkState.CHANGING_GAIT),
        ({"follows_twist": True, "at_rest": False, "changes_gait": True, "searches": True}, WalkState.SEARCHING),
    ],
)
def test_the_state_of_a_moving_robot(flags, expected):
    for state in set(WalkState) - {WalkState.STANDING}:
        assert after(state, **flags) is expected


def test_a_robot_stops_before_it_stands():
    at_rest = {"follows_twist": False, "at_rest": True}
    for state in set(WalkState) - {WalkState.STANDING, WalkState.STOPPING}:
        assert after(state, **at_rest) is WalkState.STOPPING
    assert after(WalkState.STOPPING, **at_rest) is WalkState.STANDING
