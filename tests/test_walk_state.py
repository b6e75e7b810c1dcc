"""The states of walking: which follow each other, and what decides it."""

import itertools

import pytest

from tarsus.control.walk_state import WALK_STATE_TRANSITIONS, WalkState, next_walk_state

FLAGS = ("follows_twist", "at_rest", "changes_gait", "searches")


@pytest.mark.parametrize("state", WalkState)
@pytest.mark.parametrize("values", list(itertools.product([False, True], repeat=4)))
def test_only_transitions_of_the_table_occur(state, values):
    following = next_walk_state(state, **dict(zip(FLAGS, values, strict=True)))
    assert following is state or following in WALK_STATE_TRANSITIONS[state]


def test_every_state_can_be_left_and_reached():
    assert set(WALK_STATE_TRANSITIONS) == set(WalkState)
    assert all(WALK_STATE_TRANSITIONS.values())
    assert set().union(*WALK_STATE_TRANSITIONS.values()) == set(WalkState)


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
    assert next_walk_state(WalkState.WALKING, **at_rest) is WalkState.STOPPING
    assert next_walk_state(WalkState.STOPPING, **at_rest) is WalkState.STANDING
