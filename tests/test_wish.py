"""What a wish may be, and what is said where it is something else."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tarsus.errors import InputError
from tarsus.gait.live.wish import BODY_AXES, Wish, numbers

finite = st.floats(-1e3, 1e3)


def test_a_wish_for_nothing_leaves_all_as_it_is():
    wish = Wish()
    assert wish.twist == (0.0, 0.0, 0.0)
    others = (wish.body, wish.gait, wish.clearance, wish.lift, wish.stance_width, wish.cycle_time, wish.sway)
    assert others == (None,) * 7
    assert wish.hands is None
    assert wish.hand_speeds is None


@given(st.lists(finite, min_size=6, max_size=6))
def test_numbers_of_any_kind_become_plain_floats(values):
    for given_as in (values, tuple(values), np.array(values), map(float, values)):
        body = Wish(body=given_as).body
        assert body == tuple(values)
        assert {type(value) for value in body} == {float}


def test_speeds_beyond_all_measure_are_a_wish_for_the_walker_to_cut():
    assert Wish(twist=(1e300, -1e300, 5)).twist == (1e300, -1e300, 5.0)


def test_legs_as_hands_are_taken_out_and_put_back():
    wish = Wish(hands={0: [0.1, 0, np.float64(0.05)], 3: None}, hand_speeds={1: (0, 0, 1)})
    assert wish.hands == {0: (0.1, 0.0, 0.05), 3: None}
    assert wish.hand_speeds == {1: (0.0, 0.0, 1.0)}


@pytest.mark.parametrize(
    ("given_as", "message"),
    [
        ({"twist": (1, 2)}, "the wish's twist has 2 numbers; it must have 3: vx, vy, wz"),
        ({"twist": (1, 2, float("nan"))}, "the wish's twist has wz = nan; it must be finite"),
        ({"twist": (1, float("-inf"), 0)}, "the wish's twist has vy = -inf; it must be finite"),
        ({"twist": 5}, "the wish's twist is 5; it must be 3 numbers: vx, vy, wz"),
        ({"twist": "123"}, "the wish's twist is '123'; it must be 3 numbers: vx, vy, wz"),
        ({"twist": ("1", "2", "3")}, "it must be 3 numbers: vx, vy, wz"),
        ({"twist": (1, 2j, 3)}, "it must be 3 numbers: vx, vy, wz"),
        ({"twist": (10**400, 0, 0)}, "it must be 3 numbers: vx, vy, wz"),
        ({"twist": None}, "the wish's twist is None; it must be 3 numbers: vx, vy, wz"),
        ({"body": (0,) * 5}, "the wish's body has 5 numbers; it must have 6: x, y, z, roll, pitch, yaw"),
        ({"sway": (0, 0, 0, 0, float("inf"), 0)}, "the wish's sway has pitch = inf; it must be finite"),
        ({"body": (0, 0, 2000, 0, 0, 0)}, "the wish's body has z = 2000.0; it must be between -1000 and 1000"),
        ({"clearance": "high"}, "the wish's clearance is 'high'; it must be a number"),
        ({"lift": (1, 2)}, r"the wish's lift is \(1, 2\); it must be a number"),
        ({"cycle_time": float("nan")}, "the wish's cycle_time is nan; it must be finite"),
        ({"stance_width": -1e4}, "the wish's stance_width is -10000.0; it must be between -1000 and 1000"),
        ({"hands": {1: (0, 0)}}, r"the wish's hands\[1\] has 2 numbers; it must have 3: x, y, z"),
        ({"hands": [1, 2]}, r"the wish's hands is \[1, 2\]; it must be a mapping of legs to x, y, z"),
        ({"hand_speeds": {1: (0, 0, 1e4)}}, r"the wish's hand_speeds\[1\] has z = 10000.0; it must be between"),
    ],
)
def test_anything_else_is_refused_with_its_name(given_as, message):
    with pytest.raises(InputError, match=message):
        Wish(**given_as)


def test_the_numbers_are_as_many_as_there_are_axes():
    assert numbers("sway", range(6), BODY_AXES) == (0.0, 1.0, 2.0, 3.0, 4.0, 5.0)
