"""The feasible fraction of a path between stances, against the full workspace there and shortly after."""

import numpy as np
import pytest

from gait_robots import PRESETS
from sample_stances import feet_at, pose_of, posture_of, setup_of
from tarsus.control.transition.feasible_fraction import balanced_fraction, first_increment, reachable_fraction
from tarsus.control.transition.stance_transition import StanceTarget
from tarsus.control.workspace.foot_workspace import foot_workspace, reach_cause, rest_margin
from tarsus.gait.foot_polygons import NORMALS
from tarsus.gait.gait import Gait
from tarsus.gait.stance.stability import StabilityCheck, support_sets
from tarsus.incremental import complete
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stability import stability_margin
from tarsus.kinematics.underside import FLOOR_TOLERANCE, floor_depth

BODIES = [
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
    """The least margin of each leg, from its whole polygon."""
    bounds = complete(foot_workspace(setup.robot, posed.stand, foot_distance=setup.foot_distance))
    return (bounds - (NORMALS.conj() * posed.rest[:, None]).real).min(axis=-1)


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("name", PRESETS)
def test_every_leg_has_room_at_the_fraction_and_the_named_one_has_none_a_thousandth_farther(name, body):
    setup, now, target = ends(name, body)
    share, cause = complete(reachable_fraction(setup.robot, now, target))
    assert 0 < share < 1
    assert (room(setup, now.towards(target, share)) >= 0).all()
    farther = now.towards(target, share + 1e-3)
    if cause.leg:
        assert room(setup, farther)[[name == cause.leg for name in setup.robot.leg_names]].max() < 0
    else:
        assert cause.reason == "the body would be below the ground"
        assert depth(setup.robot, now.towards(target, share)) <= FLOOR_TOLERANCE < depth(setup.robot, farther)


def depth(robot, stance):
    """The depth of the body below the floor."""
    return float(floor_depth(robot, Pose.from_rpy(*stance.posture[3:6], stance.posture[:3])))


def test_a_body_goes_down_to_the_ground_and_no_farther_level_or_tilted():
    setup, now, target = ends("strider", (0.0, 0.0, -0.105, 0.0, 0.0, 0.0))
    down, tilt = 0.085 * np.eye(7)[2], 0.3 * np.eye(7)[4]
    low, tilted = (now._replace(posture=now.posture - down + more) for more in (0.0, tilt))
    for start, end in ((now, target), (low, tilted)):
        share, cause = complete(reachable_fraction(setup.robot, start, end))
        assert cause.reason == "the body would be below the ground"
        assert 0 <= -depth(setup.robot, start.towards(end, share)) < 2e-4


def test_a_body_that_is_too_low_already_may_rise_but_not_sink():
    setup, now, _ = ends("strider", (0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    low, lower = (now._replace(posture=now.posture - [0, 0, down, 0, 0, 0, 0]) for down in (0.095, 0.099))
    assert depth(setup.robot, low) > 0
    assert complete(reachable_fraction(setup.robot, low, now)) == (1.0, None)
    share, cause = complete(reachable_fraction(setup.robot, low, lower))
    assert (share, cause.reason) == (0.0, "the body would be below the ground")


def test_a_path_that_is_feasible_as_a_whole_has_no_cause():
    setup, now, target = ends("strider", (0.01, -0.01, 0.01, 0.02, 0.02, 0.05))
    assert complete(reachable_fraction(setup.robot, now, target)) == (1.0, None)


def test_nothing_of_a_path_out_of_reach_is_feasible():
    setup, now, target = ends("strider", (0.0, 0.0, 0.3, 0.0, 0.0, 0.0))
    farther = now.towards(target, 1.5)
    share, cause = complete(reachable_fraction(setup.robot, target, farther))
    assert share == 0
    assert cause.reason == "end of the leg's reach"


def test_the_cause_tells_a_knee_on_the_ground_from_the_end_of_reach():
    # Leaning far to one side, the legs there are bent enough, but their knees are low.
    setup, now, target = ends("freenove", BODIES[4])
    stops = [complete(reachable_fraction(setup_of(name).robot, *ends(name, BODIES[4])[1:]))[1] for name in PRESETS]
    assert {cause.reason for cause in stops} == {"the knee touches the ground", "end of the leg's reach"}
    share, _ = complete(reachable_fraction(setup.robot, now, target))
    there = now.towards(target, share + 1e-3).stand
    assert (rest_margin(setup.robot, there, knees=False) >= rest_margin(setup.robot, there)).all()
    assert reach_cause(setup.robot, there).leg in setup.robot.leg_names


@pytest.mark.parametrize("gait", ["tripod", "wave"])
@pytest.mark.parametrize("name", PRESETS)
def test_at_the_balanced_fraction_the_body_has_stability_margin_to_spare(name, gait):
    setup, now, target = ends(name, (0.4, 0.1, 0.0, 0.0, 0.0, 0.0))
    sets = support_sets(Gait.named(gait))
    balance = StabilityCheck(setup.robot, sets)
    share = complete(balanced_fraction(balance, now, target, 1.0))
    assert 0 < share < 1
    margins = [balance.margin_at_rest(now.towards(target, share + more).stand) for more in (0.0, 1e-3)]
    assert margins[0] >= balance.least_margin
    assert margins[1] < margins[0]


@pytest.mark.parametrize("name", PRESETS)
def test_the_margin_at_rest_is_that_of_the_body_on_its_feet(name):
    setup, now, target = ends(name, (0.02, -0.01, 0.005, 0.05, -0.03, 0.1))
    for gait in ("tripod", "wave"):
        sets = support_sets(Gait.named(gait))
        stand = now.towards(target, 1.0).stand
        feet = feet_at(stand.rest)
        angles = inverse_kinematics(setup.robot, feet, pose_of(stand)).angles
        expected = min(stability_margin(setup.robot, angles, pose_of(stand), down) for down in sets)
        assert StabilityCheck(setup.robot, sets).margin_at_rest(stand) == pytest.approx(float(expected), abs=1e-12)


def test_the_first_increment_is_as_long_as_one_step_and_in_reach():
    setup, now, target = ends("strider", (0.01, 0.0, 0.0, 0.0, 0.0, 0.0))
    assert first_increment(setup.robot, now, target, 0.7) == 0.7
    for far in (0.02, 0.05, 0.2):
        goal = StanceTarget(target.posture, now.rest * (1 + far / np.abs(now.rest)))
        part = first_increment(setup.robot, now, goal, 1.0)
        assert part * far <= 0.03 + 1e-12
        # A sixteenth more would be too far.
        assert part == 1.0 or (part + 1 / 16) * far > 0.03
