"""No silence: what of a command is not met is a limitation for as long as it is not met."""

import math

import numpy as np
import pytest

from tarsus import Gait, load_robot
from tarsus.control.command import Command
from tarsus.control.limitation import LimitationKind
from tarsus.control.readings import SensorReadings
from tarsus.control.walk_controller import WalkController
from tarsus.errors import UnreachableError

DT = 0.02


def controller_of(gait="tripod", **options):
    return WalkController(load_robot("strider"), Gait.named(gait), **options)


def run(controller, command, seconds, readings=None):
    """The limitations of every tick."""
    found = []
    for _ in range(round(seconds / DT)):
        controller.step(command, DT, readings)
        found.append(controller.limitations)
    return found


def test_a_body_height_out_of_reach_is_reported_while_the_body_rises_and_after():
    controller = controller_of()
    ticks = run(controller, Command(body_height=0.4), 25)
    # Planning takes less than a second; from then on it is reported in every tick.
    reported = [bool(found) for found in ticks]
    assert all(reported[reported.index(True) :])
    assert reported.index(True) * DT < 1.0
    for found in ticks[reported.index(True) :]:
        (limitation,) = found
        assert limitation.kind is LimitationKind.BODY_HEIGHT
        assert limitation.asked == 0.4
        assert 0.2 < limitation.granted < 0.3
    assert ticks[-1][0].granted == pytest.approx(controller.body.position[2], abs=1e-3)
    assert ticks[-1][0].text().startswith("body_height: 2")
    assert "mm instead of 400 mm" in ticks[-1][0].text()


def test_a_transition_that_will_be_met_is_no_limitation():
    controller = controller_of()
    command = Command(twist=(0.05, 0, 0), body_height=0.14, swing_height=0.04, stance_width=0.01, gait="wave")
    assert not any(run(controller, command, 15))
    np.testing.assert_allclose(controller.body.position[2], 0.14, atol=1e-3)


@pytest.mark.parametrize("change", [{"body_height": 0.143}, {"stance_width": 0.06}])
def test_a_change_that_is_taken_back_under_way_is_undone(change):
    controller = controller_of()
    height, feet = controller.body.position[2], np.abs(controller.feet @ (1, 1j, 0))
    run(controller, Command(**change), 1.5)
    # The first of the increments, which ends elsewhere, has begun.
    assert not run(controller, Command(body_height=height, stance_width=0.0), 12)[-1]
    np.testing.assert_allclose(controller.body.position[2], height, atol=1e-6)
    np.testing.assert_allclose(np.abs(controller.feet @ (1, 1j, 0)), feet, atol=1e-5)


@pytest.mark.no_cover
def test_each_infeasible_quantity_has_its_own_limitation():
    controller = controller_of()
    run(controller, Command(stance_width=0.3), 20)
    (limitation,) = controller.limitations
    assert limitation.kind is LimitationKind.STANCE_WIDTH
    assert 0 < limitation.granted < limitation.asked == 0.3
    controller = controller_of()
    run(controller, Command(swing_height=0.3), 20)
    (limitation,) = controller.limitations
    assert limitation.kind is LimitationKind.SWING_HEIGHT
    assert 0.03 <= limitation.granted < limitation.asked == 0.3
    controller = controller_of()
    run(controller, Command(body=(0.2, 0, 0, 0, 0, 0)), 20)
    (limitation,) = controller.limitations
    assert limitation.kind is LimitationKind.BODY
    assert limitation.granted == pytest.approx(controller.body.position[0] / 0.2, abs=1e-2)
    assert limitation.leg


def test_a_limitation_of_the_stance_outlasts_a_change_of_the_gait_and_ends_with_its_command():
    controller = controller_of()
    run(controller, Command(body=(0.2, 0, 0, 0, 0, 0)), 20)
    before = controller.limitations
    ticks = run(controller, Command(gait="wave", cycle_time=0.1), 10)
    assert controller.gait.name == "wave"
    assert all(before[0] in found for found in ticks)
    assert [found.kind for found in ticks[-1]] == [LimitationKind.BODY, LimitationKind.CYCLE_TIME]
    run(controller, Command(body=(0.0,) * 6, cycle_time="auto"), 10)
    assert controller.limitations == ()


def test_a_rejected_sway_is_reported():
    controller = controller_of()
    # Planning tries smaller sways first.
    run(controller, Command(sway=(0, 0, 0.2, 0, 0, 0)), 14)
    (limitation,) = controller.limitations
    assert limitation.kind is LimitationKind.SWAY
    assert limitation.granted == 0
    run(controller, Command(sway=(0.0,) * 6), 1)
    assert controller.limitations == ()


@pytest.mark.parametrize("gait", ["tripod", "ripple"])
def test_a_foot_target_without_support_is_reported_with_the_margin(gait):
    controller = controller_of(gait)
    run(controller, Command(foot_targets={0: (0.25, 0.2, 0.08), 1: (0.0, 0.3, 0.08)}), 8)
    (limitation,) = controller.limitations
    assert (limitation.kind, limitation.leg) == (LimitationKind.FOOT_TARGET, "front left and middle left")
    assert limitation.margin < limitation.least_margin == 0.01
    side = "outside" if limitation.margin < 0 else "inside"
    assert f"{1000 * abs(limitation.margin):.0f} mm {side} its support polygon" in limitation.text()
    run(controller, Command(foot_targets={0: None, 1: None}), 3)
    assert controller.limitations == ()


def test_a_leg_towards_which_the_body_leans_stays_in_the_gait():
    controller = controller_of()
    run(controller, Command(body=(0.06, 0.08, 0, 0, 0, 0)), 5)
    run(controller, Command(foot_targets={0: (0.25, 0.2, 0.08)}), 10)
    (found,) = controller.limitations
    assert (found.kind, found.leg) == (LimitationKind.FOOT_TARGET, "front left")
    assert controller.gait.name == "tripod"
    assert controller.contacts[0]


def test_a_body_pose_waits_for_the_legs_out_of_the_gait_and_that_is_reported():
    controller = controller_of("wave")
    run(controller, Command(foot_targets={0: (0.2, 0.22, 0.1)}), 16)
    assert controller.limitations == ()
    run(controller, Command(body=(0, 0, 0.02, 0, 0, 0)), 2)
    (limitation,) = controller.limitations
    assert limitation.kind is LimitationKind.BODY
    assert limitation.cause == "not while a leg is taken out of the gait"
    run(controller, Command(foot_targets={0: None}), 20)
    assert controller.limitations == ()
    assert controller.body.position[2] == pytest.approx(0.13, abs=1e-3)


def test_a_commanded_tilt_is_no_limitation():
    controller = controller_of()
    run(controller, Command(body=(0, 0, 0, 0, math.radians(12), 0)), 4)
    run(controller, (0, 0, 0), 1, SensorReadings(attitude=(0.0, math.radians(30))))
    assert controller.limitations == ()


def test_rejected_readings_are_reported():
    controller = controller_of()
    run(controller, (0.05, 0.0, 0.0), 0.1, SensorReadings(attitude=(math.nan, 0.0)))
    assert {found.kind for found in controller.limitations} == {LimitationKind.READINGS}


def test_a_gait_that_tips_the_robot_over_is_reported():
    controller = controller_of()
    run(controller, Command(gait=Gait(duty_factor=0.5, offsets=(0.0, 0.0, 0.0, 0.5, 0.5, 0.5)), cycle_time=1.5), 4)
    assert [found.kind for found in controller.limitations] == [LimitationKind.GAIT, LimitationKind.CYCLE_TIME]
    assert {found.cause for found in controller.limitations} == {"the robot would tip over"}
    assert controller.gait.name == "tripod"


def test_a_walk_that_its_joints_slow_down_says_so():
    controller = controller_of()
    for _ in range(100):
        controller.step((0.1, 0.0, 0.0), 0.01)
    assert controller.limitations == ()
    full, controller._walk.time_scaling.rate = controller.twist[0], 0.5
    (found,) = controller.limitations
    assert found.text() == "twist: 50 % of the command; joint speed and acceleration"
    assert controller.twist[0] == pytest.approx(full / 2)


def test_ticks_that_are_walked_in_part_are_reported_while_the_robot_walks():
    controller = controller_of()
    controller.step((0.0, 0.0, 0.0), 0.1)
    assert controller.limitations == ()
    for _ in range(40):
        controller.step((0.05, 0.0, 0.0), 0.05)
    assert controller.limitations == ()
    controller.step((0.05, 0.0, 0.0), 0.1)
    (found,) = controller.limitations
    assert found.text() == "twist: 50 % of the command; of a tick longer than 50 ms, only 50 ms are walked"
    controller.step((0.05, 0.0, 0.0), 0.05)
    assert controller.limitations == ()


def test_a_body_goes_no_lower_than_the_ground_and_starts_no_lower():
    controller = controller_of()
    run(controller, Command(body_height=0.005), 16)
    (limitation,) = controller.limitations
    assert (limitation.kind, limitation.cause) == (LimitationKind.BODY_HEIGHT, "the body would be below the ground")
    assert controller.body.position[2] == pytest.approx(0.017, abs=5e-4)
    with pytest.raises(
        UnreachableError, match=r"12.0 mm below the ground; a body height of at least 17.0 mm is needed"
    ):
        WalkController(controller.robot, body_height=0.005)
