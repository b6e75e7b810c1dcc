"""The states of walking: which follow each other, and what decides it."""

import pytest

from tarsus.control.walk_state import WalkState, next_walk_state


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
        assert next_walk_state(state, **flags) is expected


def test_a_robot_stops_before_it_stands():
    at_rest = {"follows_twist": False, "at_rest": True}
    for state in set(WalkState) - {WalkState.STANDING, WalkState.STOPPING}:
        assert next_walk_state(state, **at_rest) is WalkState.STOPPING
    assert next_walk_state(WalkState.STOPPING, **at_rest) is WalkState.STANDING


@pytest.mark.parametrize(("follows_twist", "expected"), [(True, WalkState.WALKING), (False, WalkState.STOPPING)])
def test_a_standing_robot_that_starts_to_step_walks_or_stops(follows_twist, expected):
    assert next_walk_state(WalkState.STANDING, follows_twist=follows_twist, at_rest=False) is expected
