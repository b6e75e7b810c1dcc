"""Legs that fail: found by measured joint angles or told, and what the robot does without them."""

import dataclasses
import math
import re
from pathlib import Path

import numpy as np
import pytest

import leg_failures
import tarsus
from tarsus.control.readings import ValidReadings
from tarsus.control.sensing.servo_monitor import ServoMonitor
from tarsus.control.states.reduced_walking import ReducedWalking
from tarsus.errors import InputError, TarsusError
from tarsus.gait.stance.support_stance import support_stance
from tarsus.incremental import complete
from tarsus.kinematics.mass import centre_of_mass, total_mass
from tarsus.robot.remaining import remaining_robot, turned_robot
from tarsus.simulation import SimulatedPlant, terrain

STRIDER = tarsus.load_robot("strider")
DT = 0.02
# Stall torques that the robot's file does not have.
UNKNOWN = np.full((6, 3), np.nan)


def look(monitor, commanded, measured, **others):
    """Give a servo monitor what is measured in a tick of 10 ms."""
    monitor.step(commanded, ValidReadings(joint_angles=measured, **others), 0.01)


def swung(tick):
    """Joint angles that swing with half a radian."""
    return np.full((6, 3), 0.5 * np.sin(6 * 0.01 * tick))


@pytest.mark.parametrize("lag", [0, 5, 12])
def test_joints_that_lag_and_give_way_have_not_failed(lag):
    monitor = ServoMonitor(UNKNOWN)
    for tick in range(400):
        measured = swung(tick - lag) - 0.1
        look(monitor, swung(tick), measured.tolist())
    assert monitor.failed == {}


@pytest.mark.parametrize(("angle", "joint", "at_most"), [(-0.8, 1, 65), (0.3, 2, 150), (0.3, 1, 201)])
def test_a_joint_that_does_not_follow_is_found(angle, joint, at_most):
    monitor = ServoMonitor(UNKNOWN)
    for tick in range(400):
        measured = swung(tick).tolist()
        measured[2][joint] = angle
        look(monitor, swung(tick), [None, *measured[1:]], contacts=[False] * 6)
        if monitor.failed:
            break
    assert monitor.failed == {2: joint}
    assert tick < at_most
    before = dict(monitor.failed)
    look(monitor, swung(0), None)
    assert monitor.failed == before


def test_a_joint_that_is_stuck_where_its_command_moves_little_is_found_too():
    monitor = ServoMonitor(UNKNOWN)
    for tick in range(250):
        measured = (0.2 * swung(tick - 5)).tolist()
        measured[4][0] = 0.02
        look(monitor, 0.2 * swung(tick), measured)
    assert monitor.failed == {4: 0}


# Nothing is told by the torque of a servo whose stall torque is unknown, here that of leg 5.
@pytest.mark.parametrize(
    ("leg", "torque", "after"), [(2, 0.0, (5, 20)), (2, 2.0, None), (5, 0.0, (20, 40)), (5, 2.0, (20, 40))]
)
def test_measured_torques_tell_an_idle_servo_from_a_leg_that_is_caught(leg, torque, after):
    stall = np.full((6, 3), 2.0)
    stall[5, 1] = np.nan
    monitor, measured, torques = ServoMonitor(stall), np.zeros((6, 3)), [(1.0, 1.0, 1.0)] * 6
    measured[leg, 1], torques[leg] = -0.45, (torque,) * 3
    ticks = 0
    while not monitor.failed and ticks < 600:
        look(monitor, np.zeros((6, 3)), measured.tolist(), torques=torques)
        ticks += 1
    assert monitor.failed == ({leg: 1} if after else {})
    assert after is None or after[0] < ticks < after[1]


@pytest.mark.parametrize(
    ("joint", "error", "at_most"),
    [(1, 0.8, 10), (1, -0.8, 30), (2, 0.8, 30)],
)
def test_a_femur_that_gives_way_under_the_robot_is_found_before_it_tips(joint, error, at_most):
    monitor, measured = ServoMonitor(UNKNOWN), np.zeros((6, 3))
    measured[3, joint] = error
    ticks = 0
    look(monitor, np.zeros((6, 3)), np.zeros((6, 3)).tolist())
    while not monitor.failed and ticks < 600:
        look(monitor, np.zeros((6, 3)), measured.tolist(), contacts=[False] * 6)
        ticks += 1
    assert monitor.failed == {3: joint}
    assert 0.5 * at_most < ticks < at_most + 10


def ticks_until_failed(error, contacts, joint=1, most=600):
    """Return after how many ticks a joint that is off by this error has failed, the femur; the most if it has not."""
    monitor, measured = ServoMonitor(UNKNOWN), np.zeros((6, 3))
    look(monitor, np.zeros((6, 3)), measured.tolist())
    measured[3, joint] = error
    for tick in range(most):
        # Joints are looked at every fourth tick.
        look(monitor, np.zeros((6, 3)), measured.tolist(), contacts=contacts(tick // 4))
        if monitor.failed:
            return tick
    return most


def test_a_servo_that_the_ground_may_stall_is_given_longer_than_one_whose_foot_does_not_touch():
    on, off, unknown, missing = (
        ticks_until_failed(-0.3, lambda _, contacts=contacts: contacts)
        for contacts in ([True] * 6, [False] * 6, [None] * 6, None)
    )
    assert on > 200 > 50 > off
    assert off == unknown == missing


def test_a_femur_that_is_held_up_by_the_edge_its_leg_lies_on_has_not_failed_unless_it_is_so_again_and_again():
    assert ticks_until_failed(0.3, lambda _: [False] * 6) == 600
    assert ticks_until_failed(0.3, lambda nth: [nth in (15, 30)] * 6) < 200


@pytest.mark.no_cover
@pytest.mark.parametrize(("name", "ground", "seed"), [("ch3r", "smooth100", 1002), ("makeyourpet", "blocks100", 1001)])
def test_no_servo_that_works_is_called_failed_on_rough_ground_where_torques_are_not_measured(name, ground, seed):
    suite = leg_failures.SUITES["switches and joint angles"]
    assert not leg_failures.walk(leg_failures.Walk(name, suite, ground, seed)).others


def test_a_femur_that_is_held_up_is_taken_for_one_that_the_ground_stalls_where_no_contact_is_measured():
    stalled = ticks_until_failed(-0.4, lambda _: [True] * 6)
    assert stalled == ticks_until_failed(0.4, lambda _: None) == ticks_until_failed(0.4, lambda _: [None] * 6) > 100


def test_a_femur_that_bears_load_on_a_foot_that_touches_has_not_failed():
    assert ticks_until_failed(0.5, lambda _: [True] * 6) == 600
    assert ticks_until_failed(0.7, lambda _: [True] * 6) < 200


@pytest.mark.parametrize("joint", [0, 2])
def test_a_coxa_or_tibia_counts_half_where_no_contact_is_measured(joint):
    off, missing = (
        ticks_until_failed(0.3, lambda _, contacts=contacts: contacts, joint) for contacts in ([False] * 6, None)
    )
    assert off == pytest.approx(missing / 2, rel=0.2)


def test_a_femur_that_the_ground_pushes_far_up_with_its_foot_on_it_is_stalled_even_if_touch_is_lost_for_a_moment():
    touches = (lambda _: False, lambda _: True, lambda nth: nth % 5 < 4, lambda nth: nth % 5 < 3)
    never, always, but_for_moments, without = (
        ticks_until_failed(0.8, lambda nth, touch=touch: [touch(nth)] * 6) for touch in touches
    )
    assert always == but_for_moments > 120
    assert never < 50
    assert without < always


@pytest.mark.parametrize(("touches", "torque", "fails"), [(True, 1.9, False), (False, 1.9, False), (True, 0.1, True)])
def test_a_servo_that_pulls_is_overloaded_and_has_not_failed(touches, torque, fails):
    monitor, measured = ServoMonitor(np.full((6, 3), 2.0)), np.zeros((6, 3))
    measured[3, 1] = 0.3
    for _ in range(500):
        torques = [(torque,) * 3] * 6
        look(monitor, np.zeros((6, 3)), measured.tolist(), torques=torques, contacts=[touches] * 6)
    assert bool(monitor.failed) is fails


@pytest.mark.parametrize("sign", [-1, 1])
def test_a_femur_that_presses_its_foot_on_the_ground_is_stuck_only_if_it_is_so_once_that_has_lifted(sign):
    monitor, measured = ServoMonitor(np.full((6, 3), 2.0)), np.zeros((6, 3)).tolist()

    def fails(ticks, *, touches):
        for tick in range(ticks):
            commanded = np.zeros((6, 3))
            commanded[3, 1] = sign * (0.2 + 0.15 * math.cos(8 * 0.01 * tick))
            look(monitor, commanded, measured, torques=[(1.9,) * 3] * 6, contacts=[touches] * 6)
        return monitor.failed == {3: 1}

    assert fails(400, touches=True) is (sign > 0)
    assert fails(400, touches=False)


@pytest.mark.parametrize(("speed", "fails"), [(0.5, True), (2.0, False)])
def test_a_servo_whose_joint_goes_back_to_its_command_is_not_idle(speed, fails):
    monitor, measured, torques = ServoMonitor(np.full((6, 3), 2.0)), np.zeros((6, 3)), [(0.1,) * 3] * 6
    for tick in range(40):
        measured[3, 2] = min(0.01 * speed * tick - 0.7, 0.0)
        look(monitor, np.zeros((6, 3)), measured.tolist(), torques=torques)
    assert bool(monitor.failed) is fails


@pytest.mark.parametrize(("touches", "failed"), [(True, {1: 2}), (False, {1: 2, 3: 1})])
def test_contacts_tell_of_the_legs_that_are_left_too(touches, failed):
    controller = tarsus.RobotController(STRIDER)
    controller.leg_failures.failed[1] = 2
    for tick in range(250):
        angles, contacts = np.array(controller.output.angles), [True] * 3 + [touches] + [True] * 2
        angles[3, 1] -= 0.3 * (tick > 150)
        readings = tarsus.SensorReadings(joint_angles=angles, contacts=contacts)
        controller.step((0.0, 0.0, 0.0), 0.01, readings)
    assert controller.leg_failures.failed == failed


def test_joint_angles_alone_tell_of_legs_that_fail():
    controller = tarsus.RobotController(STRIDER)
    for tick in range(250):
        angles = np.array(controller.output.angles)
        angles[3, 1] += 0.8 * (tick > 150)
        controller.step((0.0, 0.0, 0.0), 0.01, tarsus.SensorReadings(joint_angles=angles))
    assert controller.leg_failures.failed == {3: 1}
    assert not controller._activity.controller.feels_ground


def test_a_leg_that_is_to_be_used_again_has_failed_once_it_does_not_follow_anew():
    monitor = ServoMonitor(UNKNOWN)

    def found_after(ticks, off):
        for tick in range(ticks):
            look(monitor, np.zeros((6, 3)), [(0.0, -0.8 * off, 0.0), *[(0.0, 0.0, 0.0)] * 5])
            if monitor.failed:
                return tick
        return None

    first = found_after(400, off=True)
    assert 0 < first < 100
    for _ in range(200):
        look(monitor, np.zeros((6, 3)), [(0.0, -0.8, 0.0), *[(0.0, 0.0, 0.0)] * 5])
    del monitor.failed[0]
    assert found_after(200, off=False) is None
    assert found_after(400, off=True) >= first - 10


def test_only_legs_and_joints_that_there_are_can_have_failed():
    failed = tarsus.RobotController(STRIDER).leg_failures.failed
    with pytest.raises(tarsus.InputError, match="failed: the robot has no leg 6; its legs are 0 to 5"):
        failed[6] = 0
    with pytest.raises(tarsus.InputError, match=r"joint 'femur' of leg 1 is unknown; joints are 0 \(coxa\), 1"):
        failed.update({1: "femur"})
    assert failed == {}


@pytest.mark.parametrize("missing", [None, (np.nan,) * 3, "?"])
def test_a_leg_that_is_not_measured_is_no_fault_of_the_others_after_one_has_failed(missing):
    controller = tarsus.RobotController(STRIDER)
    controller.leg_failures.failed[1] = 2
    for _ in range(250):
        angles = [*controller.output.angles[:4], missing, controller.output.angles[5]]
        controller.step(
            (0.03, 0.0, 0.0), 0.01, tarsus.SensorReadings(joint_angles=angles, contacts=[True] * 4 + [None, True])
        )
    controller.step((0.03, 0.0, 0.0), 0.01, tarsus.SensorReadings(contacts=[True] * 6))
    assert controller.leg_failures.failed == {1: 2}
    assert controller.output.twist[0] > 0.02


def test_gait_and_cycle_are_those_of_the_legs_that_are_left():
    controller = tarsus.RobotController(STRIDER)
    plant = tarsus.IdealPlant(STRIDER)
    commands = [(0.0, (0.05, 0.0, 0.0))]
    before = tarsus.run(controller, plant, commands, duration=1.0)
    controller.leg_failures.failed[1] = 2
    after = tarsus.run(controller, plant, commands, duration=4.0)
    walk = controller._activity.controller
    assert before.gaits[-1] == "tripod"
    assert after.gaits[-1] == walk.gait.name != "tripod"
    assert controller.output.gait.offsets[2:] == walk.gait.offsets[1:]
    assert after.cycle_times[-1] == walk.cycle_time != before.cycle_times[-1]


def test_joints_of_a_caught_leg_that_are_off_and_then_do_not_move_are_not_taken_for_stuck():
    monitor = ServoMonitor(UNKNOWN)
    for tick in range(200):
        measured = (0.2 * swung(tick - 5)).tolist()
        # For a second it is held.
        measured[4][0] = 0.02 if tick < 100 else measured[4][0]
        measured[4][0] -= 0.4 if 100 < tick < 122 else 0.0
        look(monitor, 0.2 * swung(tick), measured)
    assert monitor.failed == {}


def test_a_robot_without_a_leg_has_its_mass_and_its_other_legs():
    rest = remaining_robot(STRIDER, [0, 2, 3, 4, 5])
    assert rest.leg_codes[1:] == ("LR", "RR", "RM", "RF")
    assert total_mass(rest) == pytest.approx(total_mass(STRIDER))
    angles = tarsus.WalkController(STRIDER).angles
    shift = (centre_of_mass(rest, angles[[0, 2, 3, 4, 5]]) - centre_of_mass(STRIDER, angles))[:2]
    # The leg that is left out hangs at its coxa axis in the model.
    assert np.abs(shift).max() < 0.02
    without_masses = dataclasses.replace(STRIDER, link_mass=None, link_com=None, body_mass=None)
    assert not remaining_robot(without_masses, [0, 2, 3, 5]).has_masses


def test_a_robot_whose_coxa_angles_count_from_elsewhere_is_the_same_robot():
    phantomx = tarsus.load_robot("phantomx")
    coxa = np.linspace(-0.4, 0.4, 6)
    angles = tarsus.WalkController(phantomx).angles.copy()
    same = tarsus.forward_kinematics(turned_robot(phantomx, coxa), angles - np.outer(coxa, [1, 0, 0]))
    np.testing.assert_allclose(same, tarsus.forward_kinematics(phantomx, angles), atol=1e-12)
    np.testing.assert_allclose(turned_robot(phantomx, coxa).limits[:, 0] + coxa[:, None], phantomx.limits[:, 0])


@pytest.mark.parametrize("name", ["strider", "phantomx", "makeyourpet"])
def test_without_any_one_leg_a_stance_supports_a_fast_gait(name):
    robot = tarsus.load_robot(name)
    whole = tarsus.WalkController(robot).top_speed((1, 0, 0))
    for lost in range(6):
        rest = remaining_robot(robot, [leg for leg in range(6) if leg != lost])
        gait = tarsus.Gait.named("ripple", legs=5)
        walk = tarsus.WalkController(turned_robot(rest, complete(support_stance(rest, gait))), gait)
        assert min(walk.top_speed(way) for way in ((1, 0, 0), (-1, 0, 0), (0, 1, 0))) > 0.2 * whole
        least = np.inf
        for _ in range(round(2 * walk.cycle_time / DT)):
            walk.step((0.1, 0.0, 0.0), DT)
            least = min(least, walk.margin)
        assert least > 0.004


def test_the_stance_of_a_whole_robot_turns_no_leg_to_its_limit():
    turned = complete(support_stance(STRIDER, tarsus.Gait.named("tripod"), body_height=0.12, swing_height=0.02))
    assert (np.abs(turned) < 0.2).all()


def test_a_robot_has_four_legs():
    with pytest.raises(InputError, match="3 legs are left; a robot has 4 or more"):
        remaining_robot(STRIDER, [0, 2, 4])


@pytest.mark.parametrize("lost", [(0, 1), (1, 4)])
def test_four_legs_walk_whichever_they_are(lost):
    controller = tarsus.RobotController(STRIDER)
    controller.leg_failures.failed.update(dict.fromkeys(lost, 1))
    for _ in range(500):
        output = controller.step((0.1, 0.0, 0.0), DT)
        assert output.interventions == ()
    assert output.state == "walking"
    assert output.body.position[0] > 0.03


@pytest.mark.no_cover
def test_a_limp_servo_is_found_in_physics_and_the_robot_walks_on():
    plant = SimulatedPlant(STRIDER)
    controller = tarsus.RobotController(STRIDER)
    plant.start(controller.output)
    tilt, joints, start = 0.0, [], 0.0
    for tick in range(600):
        if tick == 50:
            leg_failures.break_servo(plant, 4, limp=True)  # that of the middle left femur
        readings = plant.step(controller.output, DT)
        joints.append(controller.output.angles)
        tilt = max(tilt, *np.abs(np.asarray(plant.state.body.rpy)[:2]))
        assert not plant.state.body_touches
        if tick == 250:
            start = plant.state.body.position[0]
        controller.step((0.12, 0.0, 0.0), DT, readings)
    assert controller.leg_failures.failed == {1: 1}
    assert tilt < np.deg2rad(20)
    assert plant.state.body.position[0] - start > 0.6
    found = [each for each in controller.output.limitations if each.kind == "gait"]
    assert [(each.leg, each.joint) for each in found] == [("middle left", "femur")]
    assert "failed" in found[0].text()
    assert not controller.output.contacts[1]


@pytest.mark.no_cover
def test_the_example_of_the_page_finds_its_limp_servo(capsys):
    page = (Path(__file__).parents[1] / "docs/ground.md").read_text(encoding="utf-8")
    (example,) = (block for block in re.findall(r"```python\n(.*?)```", page, flags=re.DOTALL) if "limp" in block)
    exec(compile(example, "docs/ground.md", "exec"), {})
    assert capsys.readouterr().out == "{1: 1}\n"


@pytest.mark.no_cover
def test_told_of_it_a_robot_walks_stands_and_sits_without_a_leg():
    controller = tarsus.RobotController(STRIDER)
    for _ in range(50):
        controller.step((0.1, 0.0, 0.0), DT)
    controller.leg_failures.failed[1] = 2
    before, steps = controller.output.angles, []
    targets = tarsus.Command(twist=(0.05, 0.0, 0.0), foot_targets={1: (0.0, 0.3, 0.05)})
    for tick in range(600):
        output = controller.step(targets if tick == 0 else (0.05, 0.0, 0.0), DT)
        steps.append(np.abs(output.angles - before).max())
        before = output.angles
        assert output.interventions == ()
    assert output.state == "walking"
    assert output.angles.shape == (6, 3)
    assert max(steps) / DT < controller.guard.bounds.speed.max()
    for _ in range(800):
        output = controller.step(tarsus.Command(state="lying"), DT)
    assert output.state == "lying"
    assert not [each for each in output.limitations if each.kind == "gait"]


@pytest.mark.parametrize(("name", "slope", "share"), [("strider", 0.25 + 0.1j, 1.0), ("strider", 0.9j, 0.25)])
def test_a_walk_begins_on_a_slope_as_far_as_its_legs_reach(name, slope, share):
    walk = tarsus.WalkController(tarsus.load_robot(name))
    flat = walk.feet
    walk.begin_on(slope)
    walk.step((0.0, 0.0, 0.0), DT)
    assert walk.slope == pytest.approx(share * slope)
    assert walk.body.rpy[:2] == pytest.approx(0.0)
    # The balls of the feet roll a little.
    assert np.abs((walk.feet - flat)[:, :2]).max() < 0.005
    rise = share * (flat[:, 0] * slope.real + flat[:, 1] * slope.imag)
    assert walk.feet[:, 2] - flat[:, 2] == pytest.approx(rise, abs=0.002)


def test_a_walk_on_a_slope_that_no_leg_reaches_begins_level():
    walk = tarsus.WalkController(STRIDER)
    before = walk.angles
    walk.begin_on(20.0 + 0j)
    assert np.array_equal(walk.step((0.0, 0.0, 0.0), DT), before)
    assert walk.slope == 0j
    with pytest.raises(InputError, match=r"before its first tick; this one is at 0.02 s"):
        walk.begin_on(0.1 + 0j)


@pytest.mark.no_cover
@pytest.mark.parametrize(("name", "leg"), [("strider", 2), ("phantomx", 0)])
def test_a_leg_taken_out_on_a_slope_leaves_the_body_level(name, leg):
    """The body was along the slope of 15 deg at once."""
    robot = tarsus.load_robot(name)
    plant = SimulatedPlant(robot, terrain=terrain.Ramp(slope=math.radians(15.0), start=-2.0, length=8.0))
    controller, tilts = tarsus.RobotController(robot), []
    plant.start(controller.output)
    for tick in range(500):
        if tick == 250:
            controller.leg_failures.failed[leg] = 1
        controller.step((0.0, 0.0, 0.0), DT, plant.step(controller.output, DT))
        tilts.append(np.abs(plant.state.body.rpy[:2]).max())
    assert max(tilts[245:]) < math.radians(9.0)


def test_a_foot_target_of_a_failed_leg_is_said_not_to_be_met_until_it_is_taken_back():
    controller = tarsus.RobotController(STRIDER)
    controller.leg_failures.failed.update({1: 2, 4: 1})

    def said(ticks, **command):
        for _ in range(ticks):
            output = controller.step(tarsus.Command(**command), DT)
        return [(each.leg, each.joint, each.granted) for each in output.limitations if each.kind == "foot_target"]

    lost = ("middle left", "tibia", 0.0)
    assert said(2, foot_targets={1: (0.0, 0.3, 0.05), 4: None}) == [lost]
    # While the legs move to their new stance, and after that.
    assert said(200) == [lost]
    text = [each.text() for each in controller.output.limitations]
    cause = "middle left tibia: the joint has failed: the robot walks on without this leg"
    assert text.count(f"foot_target: 0 % of the command; {cause}") == text.count(f"gait: {cause}") == 1
    assert said(2, foot_targets={1: None}) == []
    assert said(1, foot_velocities={4: (0.0, 0.0, 0.1)}) == [("middle right", "femur", 0.0)]
    assert said(1) == []
    assert len(controller.output.limitations) == 2


@pytest.mark.parametrize(("failed", "out"), [({1: 2}, {1}), ({1: 2, 3: 1}, {1, 3}), ({3: 1}, {3}), ({}, {1})])
def test_a_robot_that_sat_down_without_a_leg_stands_up_the_same_way_where_no_other_is_found(monkeypatch, failed, out):
    def refuse(*_args, **_more):
        raise TarsusError("no way")

    monkeypatch.setattr("tarsus.control.robot_controller.stand_up", refuse)
    controller = tarsus.RobotController(STRIDER)

    def reaches(command, state):
        for _ in range(500):
            output = controller.step(command, DT)
            assert output.interventions == ()
            if output.state == state:
                return output
        raise AssertionError(f"{controller.state} instead of {state}: {controller.output.limitations}")

    controller.leg_failures.failed[1] = 2
    reaches((0.05, 0.0, 0.0), "walking")
    reaches(tarsus.Command(state="lying"), "lying")
    # Meanwhile another leg fails, or the leg is repaired.
    controller.leg_failures.failed.clear()
    controller.leg_failures.failed.update(failed)
    reaches(tarsus.Command(state="standing"), "standing")
    output = reaches((0.05, 0.0, 0.0), "walking")
    named = {each.leg for each in output.limitations if each.kind == "gait"}
    assert named == {STRIDER.leg_names[leg] for leg in out}
    before = output.body.position[0]
    for _ in range(300):
        output = controller.step((0.05, 0.0, 0.0), DT)
    assert output.body.position[0] - before > 0.04
    assert not output.contacts[list(out)].any()
    reaches(tarsus.Command(state="lying"), "lying")


@pytest.mark.parametrize("lost", [{0: 0, 1: 1, 2: 2}, dict.fromkeys(range(6), 1)])
def test_a_robot_that_cannot_walk_without_its_legs_sits_down_until_told_otherwise(lost):
    controller = tarsus.RobotController(STRIDER)
    controller.step((0.1, 0.0, 0.0), DT)
    controller.leg_failures.failed.update(lost)
    for _ in range(500):
        output = controller.step((0.1, 0.0, 0.0), DT)
    assert output.state == "lying"
    (why,) = [each for each in output.limitations if each.kind == "state"]
    assert why.text().startswith("state: front left and middle left and rear left")
    assert ": the robot sits down" in why.text()
    assert controller.step(tarsus.Command(state="standing"), DT).state == "lying"
    controller.leg_failures.failed.clear()
    for _ in range(500):
        output = controller.step(tarsus.Command(state="standing"), DT)
    assert output.state == "standing"


@pytest.mark.parametrize(("name", "lost"), [("strider", (0, 1, 2)), ("makeyourpet", (0, 1)), ("phoenix", (1, 3))])
def test_legs_that_fail_in_the_middle_of_a_step_let_the_robot_sit_down_smoothly(name, lost):
    controller = tarsus.RobotController(tarsus.load_robot(name))
    top, stands = controller._activity.controller.top_speed((1.0, 0.0, 0.0)), tarsus.Command(state="standing")
    for _ in range(103):
        controller.step((0.8 * top, 0.0, 0.0), 0.01)
    failed = controller.leg_failures.failed
    failed.update(dict.fromkeys(lost, 1))
    states, bounds, found = [], controller.guard.bounds, [controller.output.angles]
    for tick in range(1500):
        if tick == 10:
            # There is no way back into the middle of a step: it lies down first.
            failed.clear()
        output = controller.step(stands if tick >= 10 else (0.8 * top, 0.0, 0.0), 0.01)
        found.append(output.angles)
        assert output.interventions == ()
        if not states or states[-1] != output.state:
            states.append(output.state)
        if states[-1] == "standing":
            break
    assert states == ["walking", "sitting", "lying", "rising", "standing"]
    assert (np.abs(np.diff(found, 2, axis=0)).max(axis=0) / 0.01**2 < bounds.acceleration).all()


def test_the_legs_that_are_left_keep_the_ages_of_their_joints():
    controller, ages = tarsus.RobotController(STRIDER), np.arange(18.0).reshape(6, 3) / 1e3
    controller.leg_failures.failed[1] = 1
    for tick in range(300):
        more = {"age": {"joint_angles": ages, "attitude": 0.01}} if tick % 2 else {"age": 0.0}
        readings = tarsus.SensorReadings(joint_angles=controller.output.angles, attitude=(0.0, 0.0), **more)
        output = controller.step((0.0, 0.0, 0.0), 0.01, readings)
    assert not [each for each in output.limitations if each.kind == "readings"]
    left = controller._activity.controller.measured
    assert left.joint_ages == tuple(tuple(ages[leg].tolist()) for leg in (0, 2, 3, 4, 5))
    assert left.joint_age == 0.017


@pytest.mark.parametrize("room", [0.0, 0.0005, 0.01, 0.5])
def test_joints_that_move_stop_before_their_limits_when_a_leg_is_taken_out(room):
    robot, dt = tarsus.load_robot("phantomx"), 0.005
    controller = tarsus.RobotController(robot)
    now, most = controller._now, 120.0
    angles, speeds = np.array(now.angles), np.zeros((6, 3))
    # As fast as a joint may be that can stop before its limit.
    for leg, joint, side in ((0, 1, 1), (2, 2, 0), (4, 0, 1)):
        sign = 2 * side - 1
        angles[leg, joint] = np.asarray(robot.limits)[leg, joint, side] - sign * room
        speeds[leg, joint] = sign * min(np.sqrt(2 * most * room), 4.0)
    walking = ReducedWalking(robot, {1: 1}, now._replace(angles=angles), speeds)
    found = [angles - speeds * dt, angles]
    for _ in range(round(1 / dt)):
        walking.step(tarsus.Command(), dt, None)
        found.append(walking.snapshot.angles)
    low, high = np.moveaxis(np.asarray(robot.limits), -1, 0)
    assert (np.array(found[1:]) >= low - 1e-12).all()
    assert (np.array(found[1:]) <= high + 1e-12).all()
    assert np.abs(np.diff(found, 2, axis=0)).max() / dt**2 < 1.05 * most
