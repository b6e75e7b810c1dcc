"""How much of the way to a posture works, against what is worked out in full there and shortly after."""

import numpy as np
import pytest

from gait_robots import PRESETS
from sample_stances import feet_at, pose_of, posture_of, setup_of
from tarsus.control.incremental import complete
from tarsus.control.transition.feasible_fraction import (
    StanceTarget,
    balanced_fraction,
    first_increment,
    largest_fraction,
    limiting_cause,
)
from tarsus.control.workspace.foot_workspace import foot_workspace, rest_margin
from tarsus.control.workspace.polygon import NORMALS
from tarsus.control.workspace.stability import StabilityCheck, support_sets
from tarsus.gait.gait import Gait
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.stability import stability_margin

WISHES = [
    (0.3, 0.0, 0.0, 0.0, 0.0, 0.0),
    (0.0, -0.2, 0.0, 0.0, 0.0, 0.3),
    (0.0, 0.0, 0.25, 0.0, 0.0, 0.0),
    (0.0, 0.0, -0.2, 0.0, 0.0, 0.0),
    (0.0, 0.0, 0.0, 1.0, 0.0, 0.0),
    (0.05, 0.0, -0.02, 0.0, -0.9, 0.0),
]


def ends(name, body):
    setup = setup_of(name)
    rest = setup.rest[:, 0] + 1j * setup.rest[:, 1]
    return setup, StanceTarget(posture_of(setup), rest), StanceTarget(posture_of(setup, body), rest)


def room(setup, posed):
    """The least room of each leg, from its whole polygon."""
    bounds = complete(foot_workspace(setup.robot, posed.stand, foot_distance=setup.foot_distance))
    return (bounds - (NORMALS.conj() * posed.rest[:, None]).real).min(axis=-1)


@pytest.mark.parametrize("body", WISHES)
@pytest.mark.parametrize("name", PRESETS)
def test_there_every_leg_has_room_and_a_thousandth_of_the_way_farther_the_named_one_has_none(name, body):
    setup, now, wished = ends(name, body)
    share, why = complete(largest_fraction(setup.robot, now, wished))
    assert 0 < share < 1
    assert (room(setup, now.towards(wished, share)) >= 0).all()
    farther = room(setup, now.towards(wished, share + 1e-3))
    assert farther[[name in why for name in setup.robot.leg_names]].max() < 0


def test_what_works_whole_is_stopped_by_nothing():
    setup, now, wished = ends("strider", (0.01, -0.01, 0.01, 0.02, 0.02, 0.05))
    assert complete(largest_fraction(setup.robot, now, wished)) == (1.0, "")


def test_from_out_of_reach_farther_out_nothing_works():
    setup, now, wished = ends("strider", (0.0, 0.0, 0.3, 0.0, 0.0, 0.0))
    farther = now.towards(wished, 1.5)
    share, why = complete(largest_fraction(setup.robot, wished, farther))
    assert share == 0
    assert "comes to the end of its reach" in why


def test_a_knee_that_comes_to_the_ground_is_called_that():
    # Leaning far to one side, the legs there are bent enough, but their knees are low.
    setup, now, wished = ends("freenove", WISHES[4])
    stops = [complete(largest_fraction(setup_of(name).robot, *ends(name, WISHES[4])[1:]))[1] for name in PRESETS]
    assert any(why.startswith("the knee of") and why.endswith("comes to the ground") for why in stops)
    assert any(why.endswith("comes to the end of its reach") for why in stops)
    share, _ = complete(largest_fraction(setup.robot, now, wished))
    there = now.towards(wished, share + 1e-3).stand
    assert (rest_margin(setup.robot, there, knees=False) >= rest_margin(setup.robot, there)).all()
    assert any(leg in limiting_cause(setup.robot, there) for leg in setup.robot.leg_names)


@pytest.mark.parametrize("gait", ["tripod", "wave"])
@pytest.mark.parametrize("name", PRESETS)
def test_as_far_as_the_balance_lets_it_the_body_stands_well_inside_its_supports(name, gait):
    setup, now, wished = ends(name, (0.4, 0.1, 0.0, 0.0, 0.0, 0.0))
    sets = support_sets(Gait.named(gait))
    balance = StabilityCheck(setup.robot, sets)
    share = complete(balanced_fraction(balance, now, wished, 1.0))
    assert 0 < share < 1
    margins = [balance.margin_at_rest(now.towards(wished, share + more).stand) for more in (0.0, 1e-3)]
    assert margins[0] >= balance.least_margin
    assert margins[1] < margins[0]


@pytest.mark.parametrize("name", PRESETS)
def test_the_margin_at_rest_is_that_of_the_body_on_its_feet(name):
    setup, now, wished = ends(name, (0.02, -0.01, 0.005, 0.05, -0.03, 0.1))
    for gait in ("tripod", "wave"):
        sets = support_sets(Gait.named(gait))
        stand = now.towards(wished, 1.0).stand
        feet = feet_at(stand.rest)
        angles = inverse_kinematics(setup.robot, feet, pose_of(stand)).angles
        expected = min(stability_margin(setup.robot, angles, pose_of(stand), down) for down in sets)
        assert StabilityCheck(setup.robot, sets).margin_at_rest(stand) == pytest.approx(float(expected), abs=1e-12)


def test_a_step_is_as_long_as_the_feet_may_go_and_reach_at_once():
    setup, now, wished = ends("strider", (0.01, 0.0, 0.0, 0.0, 0.0, 0.0))
    assert first_increment(setup.robot, now, wished, 0.7) == 0.7
    for far in (0.02, 0.05, 0.2):
        goal = StanceTarget(wished.posture, now.rest * (1 + far / np.abs(now.rest)))
        part = first_increment(setup.robot, now, goal, 1.0)
        assert part * far <= 0.03 + 1e-12
        # A sixteenth more would be too far.
        assert part == 1.0 or (part + 1 / 16) * far > 0.03
