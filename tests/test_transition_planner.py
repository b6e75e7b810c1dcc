"""Planning of stance transitions: what of a command is feasible, and which limitations are reported."""

import functools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gait_robots import HEXAPOD_GAITS, PRESETS, ring
from sample_stances import feet_at, pose_of, posture_of, setup_of
from sample_walks import WAVE_OF_FOUR
from tarsus.control.limitation import Cause, Limitation, LimitationKind
from tarsus.control.transition.planner import TIPPING, TransitionPlanner
from tarsus.control.transition.stance_transition import StanceTarget, StanceTransition, WalkParameters, target_stance
from tarsus.gait.gait import Gait
from tarsus.gait.stance.stance_geometry import SWING_HEIGHT, rotation_rows, stance_geometry_of
from tarsus.incremental import complete
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stance import default_stance
from tarsus.robot.joint_limits import joint_limits


def parameters_of(setup, **changes):
    values = {
        "gait": setup.gait,
        "body": (0.0,) * 6,
        "body_height": setup.body_height,
        "swing_height": setup.swing_height,
        "stance_width": 0.0,
        "cycle_time": None,
    }
    return WalkParameters(**{**values, **changes})


def planned(setup, parameters, now, rest, **options):
    planner = TransitionPlanner(setup.robot, joint_limits(setup.robot), foot_distance=setup.foot_distance)
    return complete(planner.plan(parameters, StanceTarget(now, rest), **options))


def planned_there(setup, **changes):
    """What is planned for a robot that is in the stance already."""
    parameters = parameters_of(setup, **changes)
    return planned(setup, parameters, *StanceTarget.of(setup.robot, parameters, setup.rest), stay=True)


@functools.cache
def start(name, gait="tripod"):
    setup = setup_of(name, gait)
    return planned_there(setup)


def from_start(name, **changes):
    setup, first = setup_of(name), start(name)
    return planned(setup, parameters_of(setup, **changes), first.posture, first.rest)


def reached(setup, posture, rest):
    """Whether all feet are reached at their rest footholds, on the ground and lifted."""
    stand = stance_geometry_of(posture, rest)
    feet = np.stack([feet_at(rest), feet_at(rest, posture[SWING_HEIGHT])])
    return bool(inverse_kinematics(setup.robot, feet, pose_of(stand)).ok.all())


@pytest.mark.parametrize("name", PRESETS)
def test_every_preset_stands_and_walks_in_every_gait_as_it_is(name):
    for gait in HEXAPOD_GAITS:
        setup, found = setup_of(name, gait), start(name, gait)
        assert isinstance(found, StanceTransition)
        assert found.complete
        assert found.limitations == ()
        np.testing.assert_allclose(found.posture, posture_of(setup))
        stance = default_stance(setup.robot, setup.body_height, swing_height=setup.swing_height)
        np.testing.assert_allclose(found.rest, stance[:, 0] + 1j * stance[:, 1])
        assert found.final_limits is found.path_limits is found.stepping_limits
        assert found.final_limits.feasible
        assert min(found.final_limits.stroke, found.final_limits.turning) > 0


@pytest.mark.parametrize("name", PRESETS)
def test_small_changes_are_feasible_in_full_and_along_the_whole_path(name):
    found = from_start(name, body=(0.002, -0.002, 0.003, 0.01, -0.01, 0.01))
    assert isinstance(found, StanceTransition)
    assert found.complete
    assert found.limitations == ()
    setup, first = setup_of(name), start(name)
    np.testing.assert_allclose(found.posture[:2], (0.002, -0.002))
    assert found.posture[2] == pytest.approx(setup.body_height + 0.003)
    for part in np.linspace(0, 1, 5):
        assert reached(setup, first.posture + part * (found.posture - first.posture), found.rest)
    for limits in (found.final_limits, found.path_limits, found.stepping_limits):
        assert limits.feasible
    assert (found.path_limits.bounds <= np.minimum(found.final_limits.bounds, found.stepping_limits.bounds)).all()


@pytest.mark.parametrize("name", ["strider", "phantomx", "phoenix"])
@pytest.mark.parametrize("axis", range(6))
def test_an_infeasible_move_is_approached_stepwise_as_far_as_feasible(name, axis):
    setup, first = setup_of(name), start(name)
    body = tuple((0.3 if axis < 3 else 1.2) * (i == axis) for i in range(6))
    posture, rest, said = first.posture, first.rest, None
    for _ in range(24):
        found = planned(setup, parameters_of(setup, body=body), posture, rest)
        if isinstance(found, Cause):
            said = found.text()
            break
        assert reached(setup, found.posture, found.rest)
        excluded = (found.posture - posture)[axis]
        assert excluded >= 0
        posture, rest = found.posture, found.rest
        if found.complete:
            said = " ".join(map(Limitation.text, found.limitations))
            break
    assert said is not None
    assert any(leg in said for leg in setup.robot.leg_names)
    # Some of the way, not all of it.
    assert 0.01 < posture[axis] - first.posture[axis] < body[axis]


def test_feet_are_not_moved_far_at_once():
    found = from_start("strider", stance_width=0.05)
    assert isinstance(found, StanceTransition)
    assert not found.complete
    assert 0 < np.abs(found.rest - start("strider").rest).max() <= 0.03 + 1e-12
    # As the body still is, the feet reach their new places.
    assert reached(setup_of("strider"), start("strider").posture, found.rest)


def test_a_wider_stance_puts_each_foot_farther_from_its_coxa_axis():
    setup = setup_of("strider")
    found = from_start("strider", stance_width=0.02)
    mount = setup.robot.geometry.mount_x + 1j * setup.robot.geometry.mount_y
    np.testing.assert_allclose(np.abs(found.rest - mount), np.abs(start("strider").rest - mount) + 0.02)


def test_an_unreachable_height_is_approached_as_far_as_the_legs_reach():
    setup, first = setup_of("strider"), start("strider")
    found = from_start("strider", body_height=0.5)
    assert isinstance(found, StanceTransition)
    assert setup.body_height < found.posture[2] < 0.5
    assert reached(setup, found.posture, found.rest)
    nowhere = planned(setup, parameters_of(setup, body_height=500.0), first.posture, first.rest)
    assert nowhere == Cause("no leg reaches the ground at this height")


def test_a_short_cycle_is_made_longer_and_that_is_said():
    found = from_start("strider", cycle_time=0.1)
    assert found.cycle_timing.cycle_time > 0.1
    (limitation,) = found.limitations
    assert limitation.kind is LimitationKind.CYCLE_TIME
    assert (limitation.asked, limitation.granted) == (0.1, found.cycle_timing.cycle_time)


def test_another_order_of_steps_leaves_the_robot_standing_as_it_is():
    setup, first = setup_of("strider"), start("strider")
    moved = first.posture + np.array([0.01, 0, 0, 0, 0, 0.05, 0])
    parameters = parameters_of(setup, gait=Gait.named("wave"))
    found = planned(setup, parameters, moved, first.rest, stay=True)
    np.testing.assert_array_equal(found.posture, moved)
    np.testing.assert_array_equal(found.rest, first.rest)
    assert found.parameters is parameters
    assert found.final_limits is found.path_limits


def test_legs_that_are_gone_bound_nothing():
    setup, first = setup_of("strider"), start("strider")
    # The body leans already to the side that has three legs left.
    lean = (0.0, -0.06, 0.0, 0.0, 0.0, 0.0)
    parameters = parameters_of(setup, gait=Gait.named("wave"), excluded=(1,), body=lean)
    found = planned(setup, parameters, posture_of(setup, lean), first.rest)
    assert isinstance(found, StanceTransition)
    assert np.isinf(found.final_limits.bounds[1]).all()
    assert np.isfinite(np.delete(found.final_limits.bounds, 1, axis=0)).all()


def test_a_robot_that_would_tip_over_is_refused():
    setup, first = setup_of("strider"), start("strider")
    # Two legs in the air at a time, and two more that don't step.
    parameters = parameters_of(setup, gait=Gait.named("ripple"), excluded=(0, 1))
    found = planned(setup, parameters, first.posture, first.rest)
    assert found == TIPPING


def followed(name, *poses):
    """What is planned last on the way through poses, each as far as it is feasible."""
    setup, now = setup_of(name), start(name)
    for body in poses:
        for _ in range(8):
            found = planned(setup, parameters_of(setup, body=body), now.posture, now.rest)
            assert isinstance(found, StanceTransition)
            assert reached(setup, found.posture, found.rest)
            now = found
            if now.complete:
                break
        assert now.complete
    return now


@pytest.mark.parametrize("name", ["strider", "phantomx", "makeyourpet"])
def test_a_pose_is_met_as_far_from_another_one_at_the_end_of_reach_as_from_a_level_body(name):
    ahead = (0.3, 0.0, 0.0, 0.0, 0.0, 0.0)
    directly = followed(name, ahead)
    found = followed(name, (0, 0, 0, 1.0, 0, 0), (0, 0, 0, 0, 0.8, 0), ahead)
    np.testing.assert_allclose(found.posture, directly.posture, atol=1e-3)
    (limitation,) = found.limitations
    assert limitation.kind is LimitationKind.BODY
    assert limitation.granted == pytest.approx(directly.limitations[0].granted, abs=0.01)


def test_a_body_that_cannot_go_straight_to_a_pose_goes_level_first():
    setup, tilted = setup_of("strider"), followed("strider", (0, 0, 0, 0, 0.8, 0))
    ahead = parameters_of(setup, body=(0.3, 0.0, 0.0, 0.0, 0.0, 0.0))
    found = planned(setup, ahead, tilted.posture, tilted.rest)
    np.testing.assert_allclose(found.posture, start("strider").posture, atol=1e-9)
    assert not found.complete
    # What is not feasible is reported with the transition to it.
    assert found.limitations == ()


def test_a_body_at_the_end_of_reach_stays_there_for_a_little_more():
    setup, now = setup_of("strider"), followed("strider", (0, 0, 0, 1.0, 0, 0))
    found = planned(setup, parameters_of(setup, body=(0, 0, 0, 1.1, 0, 0)), now.posture, now.rest)
    assert isinstance(found, Cause) or found.posture == pytest.approx(now.posture, abs=1e-3)


def test_a_command_limited_by_balance_is_met_in_part_and_reported():
    setup, first = setup_of("mithi"), start("mithi")
    forward = parameters_of(setup, body=(0.3, 0.0, 0.0, 0.0, 0.0, 0.0))
    found = planned(setup, forward, first.posture, first.rest)
    assert found.complete
    assert [limitation.key for limitation in found.limitations] == [("body", "the robot would tip over", "", "")]
    assert found.final_limits.balanced
    # A little farther it would: from there, nothing of the command works.
    beyond = found.posture + np.array([0.01, 0, 0, 0, 0, 0, 0])
    assert planned(setup, forward, beyond, first.rest) == TIPPING


def test_a_robot_that_cannot_stand_and_step_at_all_is_refused_at_once():
    setup = setup_of(ring(4), WAVE_OF_FOUR)
    # On three of four feet the middle of the body is on an edge.
    assert planned_there(setup) == TIPPING
    low = setup_of("strider")
    assert planned_there(low, stance_width=0.3).reason == "end of the leg's reach"


def test_a_command_with_too_large_a_sway_is_met_in_part_or_the_sway_is_reported():
    found = from_start("phantomx", body=(0.03, 0.0, 0.0, 0.0, 0.0, 0.0), sway=(0.0, 0.03, 0.0, 0.0, 0.0, 0.0))
    assert isinstance(found, StanceTransition)
    assert 0 < found.posture[0] <= 0.03
    found = from_start("phantomx", sway=(0.0, 0.0, 0.2, 0.0, 0.0, 0.0))
    assert found.reason == "end of the leg's reach as the body sways"


def test_from_a_posture_out_of_reach_nothing_works():
    setup, first = setup_of("strider"), start("strider")
    away = first.posture + np.array([0, 0, 0.3, 0, 0, 0, 0])
    parameters = parameters_of(setup, body=(0, 0, 0.4, 0, 0, 0))
    found = planned(setup, parameters, away, first.rest)
    assert isinstance(found, Cause)
    assert found.reason == "end of the leg's reach"


def test_a_body_that_sways_has_less_room():
    still, swaying = start("strider"), from_start("strider", sway=(0.0, 0.02, 0.0, 0.05, 0.0, 0.0))
    assert swaying.final_limits.feasible
    assert (swaying.final_limits.bounds <= still.final_limits.bounds + 1e-9).mean() > 0.8
    assert swaying.final_limits.margins.sum() < still.final_limits.margins.sum()


@settings(max_examples=12)
@given(st.tuples(*[st.floats(-0.1, 0.1)] * 3, *[st.floats(-0.5, 0.5)] * 3), st.floats(0.02, 0.3), st.floats(0, 0.1))
def test_whatever_is_commanded_the_result_is_reached(body, body_height, swing_height):
    setup = setup_of("phantomx")
    found = from_start("phantomx", body=body, body_height=body_height, swing_height=swing_height)
    if isinstance(found, Cause):
        unreachable = found.reason.startswith("no leg reaches the ground")
        assert found.leg in setup.robot.leg_names or found.reason.startswith(TIPPING.reason) or unreachable
        return
    assert reached(setup, found.posture, found.rest)
    assert reached(setup, start("phantomx").posture, found.rest)


@given(st.floats(-3, 3), st.floats(-1.5, 1.5), st.floats(-3, 3))
def test_the_rotation_of_a_posture_is_that_of_a_pose(roll, pitch, yaw):
    expected = Pose.from_rpy(roll, pitch, yaw, (0, 0, 0)).rotation
    np.testing.assert_allclose(rotation_rows(roll, pitch, yaw), expected, atol=1e-15)
    stand = stance_geometry_of(np.array([0.1, 0.2, 0.3, roll, pitch, yaw, 0.04]), np.zeros(6, dtype=complex))
    np.testing.assert_allclose(stand.rotation, expected, atol=1e-15)
    assert (*stand.position, stand.swing_height) == (0.1, 0.2, 0.3, 0.04)


def test_a_step_that_could_not_be_taken_on_the_way_is_refused():
    setup, first = setup_of("strider"), start("strider")
    # Where the body is to go the robot may lift what it has left; where it is now, it would tip over.
    lean = (0.0, -0.06, 0.0, 0.0, 0.0, 0.0)
    parameters = parameters_of(setup, gait=Gait.named("wave"), excluded=(1,), body=lean)
    found = planned(setup, parameters, first.posture, first.rest)
    assert found.reason == "the robot would tip over on the way"


def test_from_a_posture_just_out_of_reach_the_feet_cannot_step_on():
    setup, first = setup_of("strider"), start("strider")
    # All of the path is in reach but its very begin, where the body has no stance to move from.
    away = first.posture + np.array([0, 0, 0.12, 0, 0, 0, 0])
    found = planned(setup, parameters_of(setup), away, first.rest)
    assert found.reason == "could not stand and step on the way"
    assert found.leg in setup.robot.leg_names


def test_where_feet_cannot_step_in_the_present_posture_the_body_moves_first():
    setup, now = setup_of("makeyourpet"), start("makeyourpet")
    corner = parameters_of(setup, body_height=0.088, body=(-0.044, 0.081, 0.0, 0.0, 0.0, 0.0))
    while not now.complete or now.parameters is not corner:
        now = planned(setup, corner, now.posture, now.rest)
    found = planned(setup, parameters_of(setup), now.posture, now.rest)
    assert not found.complete
    np.testing.assert_array_equal(found.rest, now.rest)
    away = [np.abs(each.posture - start("makeyourpet").posture) for each in (found, now)]
    assert (away[0][:3] < away[1][:3]).all()
    # The feet have room again, to step back as well.
    assert found.final_limits.margins.min() > 10 * now.final_limits.margins.min()
    following = planned(setup, parameters_of(setup), found.posture, found.rest)
    assert isinstance(following, StanceTransition)


def test_where_neither_feet_nor_body_can_go_first_a_shorter_way_is_taken():
    setup, first = setup_of("phantomx"), start("phantomx")
    height, level = setup.body_height, StanceTarget(first.posture, first.rest)
    high = parameters_of(setup, body_height=1.3 * height, body=(0.05, 0.0, 0.0, 0.0, 0.0, 0.0))
    now = target_stance(setup.robot, high, level, np.ones(6, dtype=complex))
    found = planned(setup, parameters_of(setup, body_height=0.5 * height, stance_width=0.02), *now)
    assert not found.complete
    assert 0 < np.abs(found.rest - now.rest).max() < 0.03
    assert 0.5 * height < found.posture[2] < now.posture[2]
    assert found.path_limits.feasible


def test_of_rest_footholds_far_out_of_reach_a_first_step_is_taken():
    setup, first = setup_of("strider"), start("strider")
    found = planned(setup, parameters_of(setup, stance_width=0.8), first.posture, first.rest)
    assert isinstance(found, StanceTransition)
    assert not found.complete
    assert 0 < np.abs(found.rest - first.rest).max() <= 0.03 + 1e-12
