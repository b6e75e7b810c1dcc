"""Legs that are taken out of the gait follow foot targets, and return to the gait."""

import numpy as np
import pytest

from tarsus import Gait, load_robot
from tarsus.control.command import Command
from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.plant import IdealPlant
from tarsus.control.pose.admittance import Admittance
from tarsus.control.robot_controller import RobotController
from tarsus.control.walk_controller import WalkController
from tarsus.errors import InputError
from walk_trace import Trace

DT = 0.01


def walk(controller, command, seconds):
    """Walk, and return the worst joint speed, acceleration and margin."""
    angles, rate, worst = controller.angles, None, [0.0, 0.0, 1.0]
    for _ in range(round(seconds / DT)):
        after = controller.step(command, DT)
        now = (after - angles) / DT
        worst[0] = max(worst[0], (abs(now) / controller.joint_speed).max())
        if rate is not None:
            worst[1] = max(worst[1], (abs(now - rate) / DT / controller.joint_acceleration).max())
        worst[2] = min(worst[2], controller.margin)
        angles, rate = after, now
    assert worst[0] <= 1.001
    assert worst[1] <= 1.001
    assert worst[2] > 0


def in_heading_frame(controller, leg):
    x, y, yaw = controller.place
    off = controller.feet[leg] - [x, y, 0]
    return np.array([np.cos(yaw) * off[0] + np.sin(yaw) * off[1], np.cos(yaw) * off[1] - np.sin(yaw) * off[0], off[2]])


@pytest.mark.parametrize(
    ("name", "least"), [("strider", 0.12), ("phantomx", 0.05), ("makeyourpet", 0.05), ("ch3r", 0.14)]
)
def test_on_five_legs_the_robot_walks_in_another_gait_where_its_own_does_not_support_it(name, least):
    controller = WalkController(load_robot(name))
    top, (x, y, _) = controller.top_speed((1, 0, 0)), in_heading_frame(controller, 0)
    walk(controller, Command(foot_targets={0: (x, y, 0.05)}), 8)
    assert controller.gait.name == "wave"
    (found,) = controller.limitations
    assert (found.kind, found.leg) == (LimitationKind.GAIT, "front left")
    assert found.cause == "not enough support in the tripod gait without this leg"
    walk(controller, Command(twist=(top, 0, 0)), 12)
    assert controller.twist[0] > least * top
    assert not controller.contacts[0]
    walk(controller, Command(foot_targets={0: None}), 16)
    assert controller.gait.name == "tripod"
    np.testing.assert_allclose(in_heading_frame(controller, 0), (x, y, 0), atol=1e-5)
    assert controller.limitations == ()


@pytest.mark.no_cover
def test_a_foot_follows_its_target_while_the_other_legs_walk():
    controller = WalkController(load_robot("strider"), Gait.named("wave"))
    point = (0.25, 0.2, 0.08)
    walk(controller, Command(twist=(0.03, 0, 0.05)), 3)
    walk(controller, Command(twist=(0.03, 0, 0.05), foot_targets={0: point}), 14)
    np.testing.assert_allclose(in_heading_frame(controller, 0), point, atol=1e-3)
    assert not controller.contacts[0]
    assert controller.twist[0] > 0.003
    # By speed, from there.
    walk(controller, Command(twist=(0, 0, 0), foot_velocities={0: (0, -0.05, 0)}), 1)
    walk(controller, Command(), 2)
    np.testing.assert_allclose(in_heading_frame(controller, 0), (0.25, 0.15, 0.08), atol=2e-3)
    # And back: it steps to its rest foothold, and bears load again.
    walk(controller, Command(foot_targets={0: None}), 20)
    assert controller.contacts.all()
    assert controller.walk_state == "standing"
    fresh = WalkController(controller.robot, Gait.named("wave"))
    np.testing.assert_allclose(in_heading_frame(controller, 0), in_heading_frame(fresh, 0), atol=1e-5)


@pytest.mark.no_cover
def test_a_point_holds_until_there_is_another():
    controller = WalkController(load_robot("strider"), Gait.named("wave"))
    walk(controller, Command(foot_targets={0: (0.25, 0.2, 0.08)}), 14)
    # Said once; what follows only walks.
    walk(controller, Command(foot_targets={0: (0.2, 0.22, 0.1)}), DT)
    walk(controller, Command(twist=(0.01, 0, 0)), 4)
    np.testing.assert_allclose(in_heading_frame(controller, 0), (0.2, 0.22, 0.1), atol=1e-3)


@pytest.mark.parametrize("aside", [0.0, 0.01])
def test_a_leg_that_is_released_above_its_rest_foothold_goes_down_without_sensors_too(aside):
    controller = WalkController(load_robot("strider"), Gait.named("wave"))
    x, y, _ = in_heading_frame(controller, 0)
    walk(controller, Command(foot_targets={0: (x + aside, y, 0.06)}), 14)
    assert in_heading_frame(controller, 0)[2] > 0.055
    walk(controller, Command(foot_targets={0: None}), 14)
    assert abs(in_heading_frame(controller, 0)[2]) < 1e-6
    assert controller.contacts.all()
    walk(controller, Command(body_height=0.12), 5)
    assert controller.body.position[2] == pytest.approx(0.12, abs=1e-3)


def test_a_foot_that_is_to_move_too_fast_says_so_and_stops_where_it_is_held():
    controller = WalkController(load_robot("strider"), Gait.named("wave"))
    walk(controller, Command(foot_velocities={0: (0.0, 0.0, 0.0)}), 12)
    walk(controller, Command(foot_velocities={0: (0.0, 0.0, 0.05)}), 1)
    walk(controller, Command(foot_velocities={0: (0.0, 0.0, 0.0)}), 2)
    before = in_heading_frame(controller, 0)
    walk(controller, Command(foot_velocities={0: (-0.4, 0.0, 0.0)}), 0.3)
    (found,) = controller.limitations
    assert found.granted == pytest.approx(0.3)
    assert "feet out of the gait move at 120 mm/s at most" in found.text()
    walk(controller, Command(foot_velocities={0: (0.0, 0.0, 0.0)}), 2)
    assert not controller.limitations
    assert before[0] - in_heading_frame(controller, 0)[0] == pytest.approx(0.036, abs=2e-3)
    # Out of its reach; what is said of it ends with the command.
    walk(controller, Command(foot_velocities={0: (0.1, 0.0, 0.0)}), 6)
    assert [each.cause for each in controller.limitations] == ["out of reach"]
    walk(controller, Command(), 1)
    assert not controller.limitations


def test_a_foot_that_stands_beyond_what_its_leg_should_reach_comes_back():
    controller = WalkController(load_robot("phantomx"), Gait.named("wave"))
    walk(controller, Command(), 0.1)
    lower = controller._tick.gait.ground_height.copy()
    lower[0] = -0.03
    controller._tick = controller._tick._replace(gait=controller._tick.gait._replace(ground_height=lower))
    x, y, _ = in_heading_frame(controller, 0)
    for _ in range(1600):
        controller.step(Command(foot_targets={0: (x, y, 0.03)}), DT)
    assert in_heading_frame(controller, 0)[2] == pytest.approx(0.03, abs=1e-3)
    assert not controller.limitations


def test_a_compliant_robot_expects_no_load_on_a_leg_out_of_the_gait():
    robot = load_robot("strider")
    compliance = Admittance(mass=1.0, damping=120.0, stiffness=800.0, travel=0.02)
    controller, plant = RobotController(robot, Gait.named("wave"), admittance=compliance), IdealPlant(robot)
    plant.environment.set_force(0, 0.0)
    plant.start(controller.output)
    for _ in range(1600):
        controller.step(Command(foot_targets={0: (0.28, 0.17, 0.06)}), DT, plant.step(controller.output, DT))
    walk = controller._activity.controller
    np.testing.assert_allclose(walk._walk.ground.offsets, np.zeros(6), atol=2e-3)
    assert in_heading_frame(walk, 0)[2] == pytest.approx(0.06, abs=1e-3)


def test_two_legs_at_once():
    controller = WalkController(load_robot("strider"), Gait.named("wave"))
    walk(controller, Command(foot_targets={1: (0.0, 0.3, 0.1), 4: (0.0, -0.3, 0.1)}), 8)
    assert controller.contacts.sum() == 4 or controller.limitations
    assert controller.contacts.sum() >= 3


def test_a_leg_that_bears_the_robot_is_refused_with_the_margin():
    controller = WalkController(load_robot("strider"), Gait.named("tripod"))
    walk(controller, Command(twist=(0.05, 0, 0), foot_targets={0: (0.25, 0.2, 0.08), 1: (0.0, 0.3, 0.08)}), 8)
    (reason,) = (text for text in map(Limitation.text, controller.limitations) if "foot_target" in text)
    assert "front left and middle left" in reason
    assert "mm" in reason
    assert controller.gait.name == "tripod"
    assert controller.twist[0] > 0.03


@pytest.mark.no_cover
def test_out_of_reach_it_goes_as_far_as_it_reaches():
    controller = WalkController(load_robot("strider"), Gait.named("wave"))
    walk(controller, Command(foot_targets={0: (0.25, 0.2, 0.08)}), 14)
    walk(controller, Command(foot_targets={0: (0.9, 0.7, 0.08)}), 3)
    assert any("front left: out of reach" in reason for reason in map(Limitation.text, controller.limitations))
    reached = in_heading_frame(controller, 0)
    assert np.hypot(*reached[:2]) > 0.33


@pytest.mark.parametrize("leg", [6, -1, "front left", 1.5])
def test_there_is_no_such_leg(leg):
    controller = WalkController(load_robot("strider"), Gait.named("wave"))
    with pytest.raises(InputError, match="foot_target"):
        controller.step(Command(foot_targets={leg: (0.2, 0.2, 0.1)}), DT)


@pytest.mark.no_cover
def test_sway_moves_the_body_with_the_steps_and_fades():
    controller = WalkController(load_robot("strider"), Gait.named("tripod"))
    command = Command(twist=(0.05, 0, 0), sway=(0.001, 0.004, 0.003, 0.01, 0.005, 0.01))
    walk(controller, command, 4)
    heights = []
    for _ in range(round(controller.cycle_time / DT)):
        controller.step(command, DT)
        heights.append(controller.body.position[2])
    assert np.ptp(heights) == pytest.approx(0.006, abs=0.0015)
    # More of it than the joints can follow is cut, and said to be.
    walk(controller, Command(twist=(0.05, 0, 0), sway=(0.004, 0.02, 0.02, 0.05, 0.05, 0.05)), 4)
    assert any(reason.startswith("sway: ") for reason in map(Limitation.text, controller.limitations))
    walk(controller, Command(sway=(0.0,) * 6), 8)
    assert controller.walk_state == "standing"
    np.testing.assert_allclose(controller.body.position[2], 0.110, atol=5e-4)


def test_a_sway_that_the_joints_do_not_allow_is_cut_and_that_is_said():
    controller = WalkController(load_robot("strider"), Gait.named("tripod"), cycle_time=1.0)
    walk(controller, Command(twist=(0.05, 0, 0), sway=(0, 0, 0.014, 0, 0, 0)), 3)
    (reason,) = (reason for reason in map(Limitation.text, controller.limitations) if reason.startswith("sway"))
    share = float(reason.split()[1]) / 100
    assert 0 < share < 1
    # As much sway less is not cut.
    walk(controller, Command(twist=(0.05, 0, 0), sway=(0, 0, 0.014 * (share - 0.01), 0, 0, 0)), 3)
    assert not any(reason.startswith("sway") for reason in map(Limitation.text, controller.limitations))


@pytest.mark.parametrize("name", ["freenove", "strider", "phoenix"])
def test_a_foot_target_reaches_the_edge_of_the_workspace_wherever_the_body_sways(name):
    controller = WalkController(load_robot(name), Gait.named("wave"), cycle_time=6.0)
    trace, twist = Trace(controller), (0.005, 0, 0)
    trace.run(Command(twist=twist, sway=(0, 0.015, 0.01, 0.06, 0.05, 0.08)), 3, 0.02)
    out = controller.feet[1] * [1, 1, 0] / np.hypot(*controller.feet[1, :2])
    trace.run(Command(twist=twist, foot_velocities={1: 0.05 * out + [0, 0, 0.01]}), 9, 0.02)
    trace.run(Command(twist=twist), 8, 0.02).assert_sound()


@pytest.mark.no_cover
def test_a_sway_stops_and_changes_its_pace_without_a_jump():
    controller = WalkController(load_robot("phantomx-mk2"), Gait.named("tripod"))
    trace, twist = Trace(controller), 0.5 * controller.top_speed((1, 0, 0)) * np.array([1, 0, 0])
    trace.run(Command(twist=twist, sway=(0, 0.005, 0.005, 0.03, 0, 0)), 2.5, 0.002)
    trace.run(Command(), 2.5, 0.002)
    trace.run(Command(twist=0.5 * twist), 1.5, 0.002)
    trace.run(Command(twist=0.5 * twist, gait="wave"), 4, 0.002).assert_sound()


@pytest.mark.no_cover
def test_one_foot_target_replaces_another():
    controller = WalkController(load_robot("strider"), Gait.named("wave"))
    walk(controller, Command(twist=(0.005, 0, 0), foot_targets={0: (0.2, 0.15, 0.06)}), 14)
    assert not controller.contacts[0]
    walk(controller, Command(twist=(0.005, 0, 0), foot_targets={0: None, 5: (0.2, -0.15, 0.06)}), 30)
    walk(controller, Command(), 12)
    assert controller.contacts.tolist() == [True] * 5 + [False]


def test_a_withdrawn_command_is_no_longer_reported():
    controller = WalkController(load_robot("strider"))
    controller.step(Command(sway=(0, 0, 0.2, 0, 0, 0)), DT)
    walk(controller, Command(sway=(0,) * 6), 5)
    assert controller.limitations == ()


def test_a_point_below_the_ground_is_reported_and_the_foot_stays_on_it():
    controller = WalkController(load_robot("strider"), Gait.named("wave"))
    x, y, _ = controller.feet[0]
    walk(controller, Command(foot_targets={0: (x, y, -0.01)}), 14)
    assert [each.text() for each in controller.limitations] == [
        "foot_target: front left: the point is below the ground; the foot stays on it"
    ]
    assert controller.feet[0, 2] > -1e-9
    walk(controller, Command(foot_targets={0: (x, y, 0.02)}), 3)
    assert controller.limitations == ()
