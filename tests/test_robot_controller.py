"""The robot controller: its states, what it gives out, and what holds whatever is commanded."""

import math
import re

import numpy as np
import pytest

from draw_states import TRANSITIONS
from tarsus.control.command import Command
from tarsus.control.limitation import LimitationKind
from tarsus.control.plant import IdealPlant
from tarsus.control.readings import SensorReadings
from tarsus.control.robot_controller import RobotController
from tarsus.control.robot_state import CHANGES, REQUESTABLE, RobotState, requested_state
from tarsus.control.safety import GuardBounds
from tarsus.control.walk_controller import WalkController
from tarsus.errors import InputError, TarsusError, UnknownNameError
from tarsus.gait.gait import Gait
from tarsus.kinematics.leg import forward_kinematics
from tarsus.robot.file import list_robots, load_robot
from tarsus.simulation import SensorSuite, SimulatedPlant
from tarsus.simulation.sensors.suite import Sensor

DT = 0.01
STRIDER = load_robot("strider")
STILL = (0.0, 0.0, 0.0)


def states_of(controller, command, seconds, *, until=None):
    """The states passed through with one command, within a time or until half a second after one is reached."""
    found, ticks = [controller.state], round(seconds / DT)
    while ticks > 0:
        ticks -= 1
        state = controller.step(command, DT).state
        if state is not found[-1]:
            found.append(state)
            ticks = min(ticks, 50) if state is until else ticks
    return found


# States.


def test_every_requestable_state_can_be_reached():
    for start in REQUESTABLE:
        for goal in REQUESTABLE:
            state, steps = start, 0
            while (change := CHANGES.get((state, goal))) is not None:
                state, steps = change.end, steps + 1
                assert steps <= 2
            # Folded legs are not unfolded just to lie.
            assert state is goal or (state, goal) == (RobotState.FOLDED, RobotState.LYING)


@pytest.mark.lengthy
@pytest.mark.parametrize("name", list_robots())
def test_it_goes_through_all_states_and_back(name):
    controller = RobotController(load_robot(name), start="folded")
    assert controller.state is RobotState.FOLDED
    up = states_of(controller, Command(state="standing"), 15.0, until=RobotState.STANDING)
    assert up == [RobotState.FOLDED, RobotState.RISING, RobotState.STANDING]
    down = states_of(controller, Command(state="folded"), 20.0, until=RobotState.FOLDED)
    assert down == [
        RobotState.STANDING,
        RobotState.SITTING,
        RobotState.LYING,
        RobotState.FOLDING,
        RobotState.FOLDED,
    ]
    assert controller.output.interventions == ()
    assert not controller.guard.counts


@pytest.mark.no_cover
def test_a_walking_robot_stops_before_it_sits_down_and_walks_on_once_it_stands():
    controller = RobotController(STRIDER)
    assert states_of(controller, Command(twist=(0.05, 0.0, 0.0)), 2.0) == [RobotState.STANDING, RobotState.WALKING]
    found = states_of(controller, Command(twist=(0.05, 0.0, 0.0), state=RobotState.LYING), 8.0)
    assert found == [RobotState.WALKING, RobotState.STANDING, RobotState.SITTING, RobotState.LYING]
    place = controller.output.body.position[:2]
    (limitation,) = controller.output.limitations
    assert limitation.kind is LimitationKind.TWIST
    assert limitation.granted == 0
    assert "must stand" in limitation.text()
    found = states_of(controller, Command(twist=(0.05, 0.0, 0.0), state="standing"), 8.0)
    assert found == [RobotState.LYING, RobotState.RISING, RobotState.STANDING, RobotState.WALKING]
    assert controller.output.body.position[0] > place[0] + 0.05
    assert controller.output.limitations == ()


@pytest.mark.parametrize(
    ("start", "goal", "other", "moving"),
    [
        ("lying", "standing", "lying", RobotState.RISING),
        ("folded", "standing", "folded", RobotState.RISING),
        ("standing", "lying", "standing", RobotState.SITTING),
        ("lying", "folded", "standing", RobotState.FOLDING),
    ],
)
def test_a_change_of_state_can_be_turned_back_on_the_way(start, goal, other, moving):
    controller = RobotController(STRIDER, start=start)
    before = controller.output.angles
    for _ in range(15):
        controller.step(Command(state=goal), DT)
    assert controller.state is moving
    angles = controller.output.angles
    found = states_of(controller, Command(state=other), 20.0, until=RobotState(other))
    assert found[0] is moving
    assert found[1] is RobotState(start)
    if start == other:
        assert found == [moving, RobotState(start)]
        assert np.abs(controller.output.angles - before).max() < 1e-6
        assert (controller.output.angles != angles).any()
    else:
        assert found[-1] is RobotState(other)
    assert not controller.guard.counts


@pytest.mark.no_cover
def test_a_change_of_state_that_is_turned_back_twice_goes_on():
    controller = RobotController(STRIDER, start="lying")
    for _ in range(60):
        controller.step(Command(state="standing"), DT)
    for _ in range(3):
        controller.step(Command(state="lying"), DT)
    assert states_of(controller, Command(state="standing"), 15.0) == [RobotState.RISING, RobotState.STANDING]
    assert not controller.guard.counts


@pytest.mark.lengthy
@pytest.mark.parametrize("seed", range(3))
def test_whatever_is_commanded_only_allowed_transitions_happen_and_the_guard_does_nothing(seed):
    rng = np.random.default_rng(seed)
    controller = RobotController(
        load_robot(list_robots()[seed % len(list_robots())]), start=str(rng.choice(REQUESTABLE))
    )
    state = controller.state
    for _ in range(12):
        twist = tuple(rng.normal(size=3) * rng.choice([0.0, 0.05, 1.0]))
        wanted = rng.choice([None, *REQUESTABLE])
        command = Command(twist=twist, state=wanted)
        for _ in range(int(rng.choice([5, 50, 300]))):
            output = controller.step(command, float(rng.uniform(0.005, 0.03)))
            assert output.state is state or output.state in TRANSITIONS[state], (state, output.state)
            state = output.state
            assert output.angles.shape == (6, 3)
            reached = output.body @ forward_kinematics(controller.robot, output.angles)[..., 3, :]
            assert np.abs(reached - output.feet).max() < 1e-9
    assert not controller.guard.counts


def test_a_state_that_can_not_be_reached_is_said_until_another_is_wanted(monkeypatch):
    def refuse(*_args, **_more):
        raise TarsusError("no way up")

    monkeypatch.setattr("tarsus.control.robot_controller.stand_up", refuse)
    controller = RobotController(STRIDER, start="lying")
    for _ in range(3):
        output = controller.step(Command(state="standing"), DT)
        assert output.state is RobotState.LYING
        (limitation,) = output.limitations
        assert limitation.kind is LimitationKind.STATE
        assert limitation.cause == "rising is not possible: no way up"
    assert controller.step(Command(state="lying"), DT).limitations == ()


def test_a_robot_that_sat_down_stands_up_the_same_way_where_no_other_is_found(monkeypatch):
    def refuse(*_args, **_more):
        raise TarsusError("no way")

    for name in ("stand_up", "fold"):
        monkeypatch.setattr(f"tarsus.control.robot_controller.{name}", refuse)
    controller = RobotController(STRIDER)
    states_of(controller, Command(twist=(0.05, 0.0, 0.1), body_height=0.12), 3.0)
    states_of(controller, STILL, 5.0, until=RobotState.STANDING)
    stood = controller.output
    down = states_of(controller, Command(state="lying"), 8.0, until=RobotState.LYING)
    assert down == [RobotState.STANDING, RobotState.SITTING, RobotState.LYING]
    # Turned back on the way up, it lies again; folding is another motion, which is refused.
    assert states_of(controller, Command(state="standing"), 0.5) == [RobotState.LYING, RobotState.RISING]
    assert states_of(controller, Command(state="folded"), 8.0) == [RobotState.RISING, RobotState.LYING]
    assert controller.output.limitations[0].cause == "folding is not possible: no way"
    up = states_of(controller, Command(state="standing"), 8.0, until=RobotState.STANDING)
    assert up == [RobotState.LYING, RobotState.RISING, RobotState.STANDING]
    assert controller.output.limitations == ()
    for found, expected in (
        (controller.output.angles, stood.angles),
        (controller.output.body.position, stood.body.position),
        (controller.output.feet, stood.feet),
    ):
        np.testing.assert_allclose(found, expected, atol=1e-6)
    assert states_of(controller, (0.05, 0.0, 0.0), 2.0) == [RobotState.STANDING, RobotState.WALKING]
    assert not controller.guard.counts


@pytest.mark.parametrize("state", ["rising", "walking", "sitting", 3, "fault"])
def test_other_states_can_not_be_asked_for(state):
    with pytest.raises(InputError, match=r"state is .*; it must be one of 'standing', 'lying', 'folded'"):
        requested_state(state)
    controller = RobotController(STRIDER)
    with pytest.raises(InputError, match="the command's state"):
        controller.step(Command(state=state), DT)


# What it gives out.


def test_it_walks_as_the_walk_controller_does():
    controller, walk = RobotController(STRIDER, Gait.named("ripple")), WalkController(STRIDER, Gait.named("ripple"))
    commands = [Command(twist=(0.04, 0.0, 0.1), swing_height=0.02), (0.02, 0.01, 0.0), Command(gait="wave"), STILL]
    for command in commands:
        for _ in range(150):
            output = controller.step(command, DT)
            angles = walk.step(command, DT)
            assert (output.angles == angles).all()
            assert (output.feet == walk.feet).all()
            assert (output.contacts == walk.contacts).all()
            assert output.gait.name == walk.gait.name
            assert output.activity == walk.walk_state
            assert output.limitations == walk.limitations
    assert output.time == pytest.approx(6.0)
    assert output.heading == pytest.approx(walk.place[2])


@pytest.mark.no_cover
def test_what_a_command_leaves_out_holds_also_through_lying_down():
    controller = RobotController(STRIDER)
    controller.step(Command(gait="wave", swing_height=0.02, state="lying"), DT)
    states_of(controller, STILL, 8.0)
    assert controller.state is RobotState.LYING
    states_of(controller, Command(state="standing"), 8.0)
    states_of(controller, (0.02, 0.0, 0.0), 4.0)
    assert controller.output.gait.name == "wave"
    assert controller.state is RobotState.WALKING


@pytest.mark.no_cover
def test_a_foot_target_is_put_back_before_the_robot_sits_down_and_does_not_come_again():
    controller = RobotController(STRIDER, Gait.named("wave"))
    point = tuple(controller.output.feet[5] + [0.02, 0.0, 0.04])
    states_of(controller, Command(foot_targets={5: point}), 14.0)
    assert not controller.output.contacts[5]
    found = states_of(controller, Command(foot_targets={5: None}, state="lying"), 25.0)
    assert found[-1] is RobotState.LYING
    assert not controller.guard.counts
    states_of(controller, Command(state="standing"), 8.0)
    states_of(controller, STILL, 2.0)
    assert controller.output.contacts.all()


def test_a_foot_target_of_a_robot_that_lies_is_said_not_to_be_met():
    controller = RobotController(STRIDER, start="lying")
    output = controller.step(Command(foot_targets={5: (0.25, -0.2, 0.06)}), DT)
    assert [each.kind for each in output.limitations] == [LimitationKind.FOOT_TARGET]


def test_it_starts_from_measured_angles():
    lying = RobotController(STRIDER, start="lying").output
    rng = np.random.default_rng(1)
    angles = lying.angles + rng.uniform(-0.02, 0.02, size=lying.angles.shape)
    controller = RobotController(STRIDER, angles=angles)
    assert controller.state is RobotState.LYING
    assert (controller.output.angles == angles).all()
    assert states_of(controller, Command(state="standing"), 10.0)[-1] is RobotState.STANDING
    assert not controller.guard.counts


@pytest.mark.parametrize("angles", [np.zeros((5, 3)), np.full((6, 3), math.nan)])
def test_measured_angles_must_be_finite_and_for_every_joint(angles):
    with pytest.raises(InputError, match="angles must be 6 x 3 finite numbers"):
        RobotController(STRIDER, angles=angles)


# What is wrong changes nothing.


@pytest.mark.parametrize(
    ("command", "error", "words"),
    [
        (lambda: Command(gait="tripd"), UnknownNameError, "tripd"),
        (lambda: Command(gait=Gait.named("wave", legs=8)), InputError, "8 legs"),
        (lambda: Command(foot_targets={7: (0, 0, 0)}), InputError, "legs are 0 to 5"),
        (lambda: Command(foot_velocities={-1: (0, 0, 0)}), InputError, "legs are 0 to 5"),
        (lambda: (math.nan, 0.0, 0.0), InputError, "twist"),
    ],
)
@pytest.mark.parametrize("start", ["standing", "folded"])
def test_a_wrong_command_is_refused_in_every_state_and_changes_nothing(command, error, words, start):
    controller, other = RobotController(STRIDER, start=start), RobotController(STRIDER, start=start)
    with pytest.raises(error, match=words):
        controller.step(command(), DT)
    for _ in range(20):
        one, two = controller.step((0.03, 0.0, 0.0), DT), other.step((0.03, 0.0, 0.0), DT)
        assert (one.angles == two.angles).all()
        assert one.time == two.time


@pytest.mark.parametrize("dt", [0.0, -0.01, math.nan])
def test_a_tick_must_take_time(dt):
    controller = RobotController(STRIDER)
    with pytest.raises(InputError, match="dt"):
        controller.step(STILL, dt)


# The guard.


def test_while_the_guard_holds_the_state_is_fault_and_then_it_goes_on():
    # Bounds on speed that the walk breaks.
    bounds = GuardBounds.of(STRIDER, speed=0.3, acceleration=1000.0)
    controller = RobotController(STRIDER, guard=bounds)
    outputs = [controller.step((0.1, 0.0, 0.0), DT) for _ in range(200)]
    faults = [output for output in outputs if output.state is RobotState.FAULT]
    assert faults
    assert faults[0].interventions[0].kind == "joint_speed"
    assert faults[0].guard == "holding"
    speeds = np.abs(np.diff([output.angles for output in outputs], axis=0)) / DT
    assert speeds.max() <= 0.3 + 1e-9
    assert sum(controller.guard.counts.values()) == sum(len(output.interventions) for output in outputs)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"gait": "tripod"}, "gait is 'tripod'; it must be a Gait, like Gait.named('tripod')"),
        ({"levelling": "flat"}, "levelling is 'flat'; it must be None or one of level, between, follow"),
        ({"levelling": True}, "levelling is True"),
    ],
)
def test_options_that_are_none_of_the_choices_are_refused(options, message):
    with pytest.raises(InputError, match=re.escape(message)):
        RobotController(STRIDER, **options)


@pytest.mark.parametrize("start", ["standing", "lying"])
def test_once_the_guard_lets_it_the_robot_goes_on_from_rest(start):
    # In ticks as short as these, joints that went on at the speed that they had would be held again and again.
    robot, dt = load_robot("mithi"), 0.0025
    controller = RobotController(robot, start=start)
    command = Command(twist=(0.05, 0.0, 0.0), state="standing")
    for _ in range(600):
        controller.step(command, dt)
    assert not controller.guard.counts
    check = controller.guard.check
    controller.guard.check = lambda angles, *rest: check(angles + 0.2, *rest)
    controller.step(command, dt)
    controller.guard.check = check
    for _ in range(600):
        last = controller.step(command, dt)
    assert sum(controller.guard.counts.values()) <= 6
    assert last.state is not RobotState.FAULT


def test_a_robot_that_lies_stays_as_it_is_while_the_guard_holds():
    controller = RobotController(STRIDER, start="lying")
    before, check = controller.output.angles, controller.guard.check
    controller.guard.check = lambda angles, *rest: check(angles + 0.2, *rest)
    controller.step((0.0, 0.0, 0.0), DT)
    controller.guard.check = check
    for _ in range(200):
        last = controller.step((0.0, 0.0, 0.0), DT)
    assert controller.guard.counts
    assert last.state is RobotState.LYING
    np.testing.assert_allclose(last.angles, before, atol=1e-9)


def test_the_first_readings_of_a_tilted_robot_do_not_trip_the_guard():
    for name, dt in (("mithi", 0.0025), ("phoenix", 0.005)):
        controller = RobotController(load_robot(name))
        for tick in range(100):
            readings = SensorReadings(contacts=[True] * 6, attitude=(0.2 * np.exp(-3 * tick * dt), 0.0))
            controller.step((0.0, 0.0, 0.0), dt, readings)
        assert not controller.guard.counts


def test_joint_angles_and_torques_alone_move_no_foot_before_contacts_are_known():
    robot = load_robot("phantomx")
    sensors = SensorSuite(joint_angles=Sensor(), torques=Sensor())
    plant, controller = SimulatedPlant(robot, sensors=sensors, servos="catalogue"), RobotController(robot)
    plant.start(controller.output)
    for _ in range(150):
        controller.step((0.07, 0.0, 0.0), 0.01, plant.step(controller.output, 0.01))
    assert not controller.guard.counts


@pytest.mark.parametrize("guard", [1, "yes", None])
def test_a_guard_is_chosen_clearly(guard):
    with pytest.raises(InputError, match=re.escape(f"guard is {guard!r}; it must be True, False or GuardBounds")):
        RobotController(STRIDER, guard=guard)
    assert RobotController(STRIDER, guard=np.True_).guard is not None


def test_without_a_guard_angles_are_given_out_as_they_are():
    controller = RobotController(STRIDER, guard=False)
    assert controller.guard is None
    output = controller.step((0.1, 0.0, 0.0), DT)
    assert output.guard == ""
    assert output.interventions == ()


# Readings.


def test_readings_of_joints_alone_do_not_change_the_walk():
    felt, blind = RobotController(STRIDER), RobotController(STRIDER)
    plant = IdealPlant(STRIDER)
    plant.start(felt.output)
    for _ in range(200):
        readings = plant.step(felt.output, DT)
        assert readings.has_ground_feedback is False
        one, two = felt.step((0.05, 0.0, 0.0), DT, readings), blind.step((0.05, 0.0, 0.0), DT)
        assert (one.angles == two.angles).all()


def test_readings_of_the_ground_reach_the_walk_controller():
    controller = RobotController(STRIDER, levelling="level")
    for _ in range(20):
        output = controller.step(STILL, DT, SensorReadings(attitude=(0.0, 0.1)))
    # The front is down: the feet there push it up.
    assert output.feet[0, 2] < output.feet[2, 2] - 0.01


def test_readings_that_tell_nothing_of_the_ground_are_named_where_they_are_rejected():
    controller = RobotController(STRIDER)
    output = controller.step(STILL, DT, SensorReadings(joint_angles=np.full((6, 3), math.nan)))
    assert {each.kind for each in output.limitations} == {LimitationKind.READINGS}
    assert output.limitations[0].cause == "joint_angles of LF: not finite numbers"
    output = controller.step(STILL, DT, SensorReadings(joint_angles=np.full((6, 3), math.nan), attitude=(0.0, 0.0)))
    assert len(output.limitations) == 6
    # Where the controller gets them, it tells once.
    controller = RobotController(STRIDER)
    output = controller.step(STILL, DT, SensorReadings(attitude=(math.nan, 0.0)))
    assert [each.cause for each in output.limitations] == ["attitude: not finite numbers"]
    # Also those that it does not get any more, once it has felt the ground.
    controller.step(STILL, DT, SensorReadings(contacts=[True] * 6))
    output = controller.step(STILL, DT, SensorReadings(joint_angles=np.full((6, 3), math.nan)))
    assert output.limitations[0].cause == "joint_angles of LF: not finite numbers"
    output = controller.step(STILL, DT, {"contacts": [True] * 6})
    assert [each.text() for each in output.limitations] == ["readings: all channels: not of class SensorReadings"]


def test_a_foot_stays_where_velocities_have_moved_it_whatever_was_its_target_before():
    controller = RobotController(STRIDER, Gait.named("wave"))

    def height(command, seconds):
        for _ in range(round(seconds / DT)):
            controller.step(command, DT)
        return controller.output.feet[0, 2]

    height(Command(foot_targets={0: (0.25, 0.2, 0.06)}), 14)
    moved = height(Command(foot_velocities={0: (0.0, 0.0, 0.03)}), 2)
    assert moved > 0.1
    assert height(Command(), 3) == pytest.approx(moved, abs=0.015)
    height(Command(foot_targets={0: None}), 16)
    moved = height(Command(foot_velocities={0: (0.0, 0.0, 0.03)}), 14)
    assert moved > 0.03
    assert height(Command(), 3) > 0.9 * moved


@pytest.mark.no_cover
def test_a_robot_that_feels_uneven_ground_sits_down_over_all_feet_that_stand():
    controller, plant, states = RobotController(STRIDER), IdealPlant(STRIDER), []
    for leg, height in enumerate((0.01, 0.0, -0.01, 0.01, 0.0, -0.01)):
        plant.environment.set_ground(leg, height)
    plant.environment.set_tilt(0.0, 0.0)
    plant.start(controller.output)
    for tick in range(700):
        command = Command(twist=(0.1, 0.0, 0.0) if tick < 300 else STILL, state="standing" if tick < 400 else "lying")
        output = controller.step(command, DT, plant.step(controller.output, DT))
        if output.state is RobotState.SITTING and RobotState.SITTING not in states:
            assert output.contacts.all()
        states.append(output.state)
    assert states[-1] is RobotState.LYING
    assert RobotState.FAULT not in states
