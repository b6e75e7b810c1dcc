"""What a command may contain, and how malformed commands are refused."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tarsus.control.command import Command
from tarsus.errors import InputError

finite = st.floats(-1e3, 1e3)


def test_an_empty_command_changes_nothing():
    command = Command()
    assert command.twist == (0.0, 0.0, 0.0)
    others = (
        command.body,
        command.gait,
        command.body_height,
        command.swing_height,
        command.stance_width,
        command.cycle_time,
        command.sway,
    )
    assert others == (None,) * 7
    assert command.foot_targets is None
    assert command.foot_velocities is None


@given(st.lists(finite, min_size=6, max_size=6))
def test_numbers_of_any_kind_become_plain_floats(values):
    for given_as in (values, tuple(values), np.array(values), map(float, values)):
        body = Command(body=given_as).body
        assert body == tuple(values)
        assert {type(value) for value in body} == {float}


def test_excessive_speeds_are_limited_by_the_controller():
    assert Command(twist=(1e300, -1e300, 5)).twist == (1e300, -1e300, 5.0)


def test_legs_with_foot_targets_leave_the_gait_and_return():
    command = Command(foot_targets={0: [0.1, 0, np.float64(0.05)], 3: None}, foot_velocities={1: (0, 0, 1)})
    assert command.foot_targets == {0: (0.1, 0.0, 0.05), 3: None}
    assert command.foot_velocities == {1: (0.0, 0.0, 1.0)}


@pytest.mark.parametrize(
    ("given_as", "message"),
    [
        ({"twist": (1, 2)}, "the command's twist has 2 numbers; it must have 3: vx, vy, wz"),
        ({"twist": (1, 2, float("nan"))}, "the command's twist has wz = nan; it must be finite"),
        ({"twist": (1, float("-inf"), 0)}, "the command's twist has vy = -inf; it must be finite"),
        ({"twist": 5}, "the command's twist is 5; it must be 3 numbers: vx, vy, wz"),
        ({"twist": "123"}, "the command's twist is '123'; it must be 3 numbers: vx, vy, wz"),
        ({"twist": ("1", "2", "3")}, "it must be 3 numbers: vx, vy, wz"),
        ({"twist": (1, 2j, 3)}, "it must be 3 numbers: vx, vy, wz"),
        ({"twist": (10**400, 0, 0)}, "it must be 3 numbers: vx, vy, wz"),
        ({"twist": None}, "the command's twist is None; it must be 3 numbers: vx, vy, wz"),
        ({"body": (0,) * 5}, "the command's body has 5 numbers; it must have 6: x, y, z, roll, pitch, yaw"),
        ({"sway": (0, 0, 0, 0, float("inf"), 0)}, "the command's sway has pitch = inf; it must be finite"),
        ({"body": (0, 0, 2000, 0, 0, 0)}, "the command's body has z = 2000.0; it must be between -1000 and 1000"),
        ({"body_height": "high"}, "the command's body_height is 'high'; it must be a number"),
        ({"swing_height": (1, 2)}, r"the command's swing_height is \(1, 2\); it must be a number"),
        ({"cycle_time": float("nan")}, "the command's cycle_time is nan; it must be finite"),
        ({"cycle_time": 0}, "the command's cycle_time is 0.0 s; it must be greater than 0"),
        ({"cycle_time": -1.0, "state": "lying"}, "the command's cycle_time is -1.0 s; it must be greater than 0"),
        ({"swing_height": -0.01}, "the command's swing_height is -0.01 m; it must not be negative"),
        ({"gait": 5}, "the command's gait is 5; it must be a name or a Gait"),
        ({"stance_width": -1e4}, "the command's stance_width is -10000.0; it must be between -1000 and 1000"),
        ({"foot_targets": {1: (0, 0)}}, r"the command's foot_targets\[1\] has 2 numbers; it must have 3: x, y, z"),
        ({"foot_targets": [1, 2]}, r"the command's foot_targets is \[1, 2\]; it must be a mapping of legs to x, y, z"),
        (
            {"foot_velocities": {1: (0, 0, 1e4)}},
            r"the command's foot_velocities\[1\] has z = 10000.0; it must be between",
        ),
    ],
)
def test_anything_else_is_refused_with_its_name(given_as, message):
    with pytest.raises(InputError, match=message):
        Command(**given_as)


def test_the_numbers_are_as_many_as_there_are_axes():
    assert Command(sway=range(6)).sway == (0.0, 1.0, 2.0, 3.0, 4.0, 5.0)
