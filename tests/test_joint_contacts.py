"""Contacts that are estimated by joint angles: of a simulated robot, and of servos that tell nothing."""

import dataclasses

import numpy as np
import pytest

import tarsus
from tarsus.control.readings import ValidReadings
from tarsus.control.sensing.foot_loads import FootLoads
from tarsus.control.sensing.joint_contacts import JointContacts
from tarsus.simulation import SensorSuite, ServoModel, SimulatedPlant, terrain
from tarsus.simulation.sensors.suite import FootSwitch, Sensor

STRIDER = tarsus.load_robot("strider")
DT = 0.01


@pytest.mark.parametrize("dt", [DT, 0.02])
def test_a_robot_without_sensors_in_its_feet_feels_the_ground_by_its_joints(dt):
    sensors = dataclasses.replace(SensorSuite.named("smart"), attitude=SensorSuite.named("hobby").attitude)
    # On these blocks the front left foot is caught by one, and rises over it.
    ground = terrain.Blocks(rise=0.04, clear=0.35, seed=2)
    plant, controller = SimulatedPlant(STRIDER, terrain=ground, sensors=sensors), tarsus.RobotController(STRIDER)
    plant.start(controller.output)
    right = []
    for tick in range(round(4.5 / dt)):
        readings = plant.step(controller.output, dt)
        assert readings.contacts is None
        controller.step((0.14, 0.0, 0.0), dt, readings)
        if tick * dt > 1.2:
            contacts = controller._activity.controller._walk.ground.contacts
            assert all(contacts.estimator.known)
            right.append(np.array(contacts.estimator.touching) == (plant.state.foot_forces[:, 2] > 0.5))
    assert np.mean(right) > 0.84
    assert plant.state.body.position[0] > 0.85 * 0.14 * 4.5


@pytest.mark.no_cover
def test_uncertain_contacts_do_not_keep_a_foot_in_the_air_over_an_obstacle():
    sensors, ways = dataclasses.replace(SensorSuite.named("ideal"), contacts=None, forces=None), []
    for seed in range(1, 5):
        ground = terrain.Blocks(rise=0.06, clear=0.35, seed=seed)
        plant, controller = SimulatedPlant(STRIDER, terrain=ground, sensors=sensors), tarsus.RobotController(STRIDER)
        plant.start(controller.output)
        for _ in range(400):
            controller.step((0.146, 0.0, 0.0), DT, plant.step(controller.output, DT))
        ways.append(plant.state.body.position[0] / (0.146 * 4))
    # Single walks over blocks as high as these are chance: 0.44 to 0.93.
    assert np.mean(ways) > 0.6
    assert min(ways) > 0.3


@pytest.mark.no_cover
def test_a_foot_whose_switch_stays_open_does_not_hold_up_the_walk_over_obstacles():
    ways = []
    for seed in range(3):
        ground = terrain.Blocks(rise=0.04, clear=0.35, seed=seed)
        plant, controller = SimulatedPlant(STRIDER, terrain=ground), tarsus.RobotController(STRIDER)
        plant.start(controller.output)
        for _ in range(400):
            readings = plant.step(controller.output, DT)
            readings = dataclasses.replace(readings, contacts=[False, *readings.contacts[1:]])
            controller.step((0.146, 0.0, 0.0), DT, readings)
        ways.append(plant.state.body.position[0] / (0.146 * 4))
    # Single walks are chance: 0.64 to 0.89 in eight.
    assert np.mean(ways) > 0.75


@pytest.mark.no_cover
@pytest.mark.parametrize(
    ("name", "leg", "delay", "speed"), [("strider", 4, 0.05, 0.146), ("makeyourpet", 0, 0.05, 0.07)]
)
def test_an_open_switch_holds_up_no_walk_whose_sensors_are_late(name, leg, delay, speed):
    robot, late = tarsus.load_robot(name), Sensor(delay=delay)
    sensors = SensorSuite(contacts=FootSwitch(delay=delay), attitude=late, joint_angles=late)
    plant, controller = SimulatedPlant(robot, sensors=sensors), tarsus.RobotController(robot)
    plant.start(controller.output)
    for _ in range(500):
        readings = plant.step(controller.output, DT)
        contacts = [touches and number != leg for number, touches in enumerate(readings.contacts)]
        controller.step((speed, 0.0, 0.0), DT, dataclasses.replace(readings, contacts=contacts))
    # Without more time for contacts that are late, it takes the foot for one on an edge: 0.1 to 0.3.
    assert plant.state.body.position[0] > 0.85 * speed * 5


def test_servos_that_follow_at_once_tell_no_contacts():
    controller, contacts = tarsus.WalkController(STRIDER), []
    estimator = JointContacts(STRIDER)
    for _ in range(200):
        angles = controller.step((0.1, 0.0, 0.0), DT)
        valid = ValidReadings(joint_angles=angles.tolist())
        found = estimator.contacts(valid, angles, controller._tick.gait, DT)
        contacts.append(found)
    assert not any(contacts)


def test_a_walk_says_that_joint_angles_tell_no_contacts():
    controller, said = tarsus.WalkController(STRIDER), list[str]()
    for tick in range(520):
        contacts = controller.contacts if tick >= 500 else None
        readings = tarsus.SensorReadings(joint_angles=controller.angles, contacts=contacts, attitude=(0.0, 0.0))
        controller.step((0.1, 0.0, 0.0) if tick > 50 else (0.0, 0.0, 0.0), 0.02, readings)
        said.append("; ".join(limitation.text() for limitation in controller.limitations))
    first = said.index(
        "readings: joint_angles: they tell no contacts, as the servos do not yield to loads as those of "
        "the robot file do"
    )
    assert 8.0 < (first - 50) * 0.02 < 8.6
    assert set(said[:first]) == {""}
    assert said[499] == said[first]
    assert said[-1] == ""


@pytest.mark.parametrize("dt", [DT, 0.002])
def test_servos_that_are_slower_than_those_of_the_file_stop_no_swing(dt):
    # A servo of its own kind: 50 ms late, and it gives way by 0.02 rad under load.
    controller, estimator = tarsus.WalkController(STRIDER), JointContacts(STRIDER)
    late, stopped, told, ticks = [controller.angles] * round(5 * DT / dt), 0, 0, round(600 * DT / dt)
    for tick in range(ticks):
        angles = controller.step((0.1, 0.0, 0.0), dt)
        state = controller._tick.gait
        late.append(angles)
        measured = late.pop(0) + 0.02 * np.outer(state.down, (0.0, 1.0, 0.0))
        found = estimator.contacts(ValidReadings(joint_angles=measured.tolist()), angles, state, dt)
        # By then its lag is learnt.
        if tick > ticks / 2 and found is not None:
            told += 1
            free = ~state.down & (state.swing_phase > 0.2) & (state.swing_phase < 0.5)
            stopped += np.count_nonzero(np.array(found) & free)
    assert told > ticks / 3
    assert not stopped
    assert 0.01 < estimator.lag < 0.06


def estimated(measure, *, seconds=6.0, estimator=None):
    """The estimator, and contacts and feet that should stand in each tick, of angles that are measured like this."""
    controller, estimator, found = tarsus.WalkController(STRIDER), estimator or JointContacts(STRIDER), []
    for tick in range(round(seconds / DT)):
        angles = controller.step((0.1, 0.0, 0.0), DT)
        state = controller._tick.gait
        measured = angles + np.outer(measure(tick * DT, state), (0.0, 1.0, 0.0))
        valid = ValidReadings(joint_angles=measured.tolist())
        found.append((estimator.contacts(valid, angles, state, DT), state.down.tolist(), state.swing_phase.tolist()))
    return estimator, found


def sagging(_, state):
    # Behind their commands by no time, and raised by the ground where they stand.
    return 0.02 * state.down


def test_servos_that_are_sooner_than_those_of_the_file_tell_contacts():
    estimator, found = estimated(sagging)
    assert -0.01 <= estimator.lag < -0.005
    # Nothing is told before legs have swung freely.
    assert not any(contacts for contacts, _, _ in found[:40])
    for contacts, down, phases in found[300:]:
        clear = [on or 0.2 < phase < 0.5 for on, phase in zip(down, phases, strict=True)]
        told = zip(contacts, down, clear, strict=True)
        assert np.mean([touches == on for touches, on, known in told if known]) > 0.6


def test_a_robot_that_its_legs_do_not_bear_any_more_has_unknown_contacts_until_they_do():
    _, found = estimated(lambda time, state: sagging(time, state) * (not 3.0 <= time < 4.0))
    assert all(contacts is not None for contacts, _, _ in found[250:300])
    # It may be between two steps for half a second, and in the air after that: but nothing tells so for certain.
    assert all(contacts is not None for contacts, _, _ in found[300:340])
    assert all(contacts is None for contacts, _, _ in found[370:400])
    assert all(contacts is not None for contacts, _, _ in found[550:])


def test_legs_that_cease_to_bear_the_robot_tell_so_once():
    joints, told = JointContacts(STRIDER), list[float]()

    def lifted(time, state):
        told.extend([time] * joints.unborne)
        return sagging(time, state) * (time < 3.0)

    estimated(lifted, estimator=joints)
    assert told == [pytest.approx(3.5, abs=0.1)]


def test_contacts_are_unknown_and_a_hole_is_forgotten_once_the_legs_cease_to_bear_the_robot(monkeypatch):
    controller = tarsus.WalkController(STRIDER)
    walks = [tarsus.SensorReadings(contacts=[True] * 6, attitude=(0.0, 0.0))] * 3
    for readings in walks:
        controller.step((0.1, 0.0, 0.0), DT, readings)
    ground, loads = controller._walk.ground, controller._walk.ground._loads
    ground.missing.tipped(0, 0.2 + 0.1j)

    def lifted(*_):
        loads.unborne = True

    monkeypatch.setattr(loads, "contacts", lifted)
    controller.step((0.1, 0.0, 0.0), DT, walks[0])
    monkeypatch.undo()
    assert not any(ground.contacts.estimator.known)
    assert ground.condition.carried
    for _ in range(60):
        controller.step((0.1, 0.0, 0.0), DT, tarsus.SensorReadings(attitude=(0.0, 0.0)))
    assert not ground.missing.refuses
    assert not ground.condition.carried


def test_a_foot_that_is_caught_leaves_contacts_known():
    def caught(time, state):
        behind = sagging(time, state)
        behind[0] -= 0.3 * (3.0 < time < 3.6 and not state.down[0])
        return behind

    _, found = estimated(caught)
    assert all(contacts is not None for contacts, _, _ in found[250:])


def test_a_leg_without_a_measured_angle_leaves_contacts_unknown():
    estimator, controller = JointContacts(STRIDER), tarsus.WalkController(STRIDER)
    angles, state = controller.angles, controller._tick.gait
    for measured in ([None, *angles.tolist()[1:]], angles.tolist()):
        for _ in range(9):
            assert estimator.contacts(ValidReadings(joint_angles=measured), angles, state, DT) is None


@pytest.mark.parametrize("servos", ["known", "unknown"])
def test_joint_angles_are_the_last_choice(servos):
    robot = STRIDER
    if servos == "unknown":
        robot = robot.replace(servos=tuple((None,) * 3 for _ in range(6)))
    loads, controller = FootLoads(robot, None), tarsus.WalkController(STRIDER)
    angles, state = controller.angles, controller._tick.gait
    valid = ValidReadings(joint_angles=tuple(angles.tolist()))
    assert loads.contacts(valid, angles, state, DT) is None
    switched = valid._replace(contacts=(True,) * 6)
    assert loads.contacts(switched, angles, state, DT) == (True,) * 6
    assert not loads.estimated


def test_expected_angles_are_those_of_their_times_whatever_the_ticks():
    found = []
    for ticks in ([DT] * 5, [0.0071, 0.0024, 0.0131, 0.0201, 0.0073], [0.05], [0.002] * 25):
        joints = JointContacts(STRIDER)
        for command in (0.1, 0.3, -0.2, 0.4):
            for tick in ticks:
                joints._follow([command] * 6, tick)
        found.append([angle for angle, _ in joints._expected[-1]])
        assert joints._since == pytest.approx(0.0, abs=1e-9)
    assert abs(found[0][0]) > 0.01
    np.testing.assert_allclose(found, np.broadcast_to(found[0], (4, 6)), atol=1e-12)


@pytest.mark.no_cover
def test_friction_of_the_servos_is_no_contact_of_a_swinging_foot():
    # Dry friction of 8 % of the stall torque, targets every 20 ms: feet landed in the air and cost 0.15 of the way.
    robot = tarsus.load_robot("phantomx")
    models = [[dataclasses.replace(ServoModel.of(servo), update_rate=50.0) for servo in leg] for leg in robot.servos]
    sensors = SensorSuite(attitude=Sensor(), joint_angles=Sensor(bias=0.0035, resolution=0.0015, delay=DT))
    plant, controller = SimulatedPlant(robot, servos=models, sensors=sensors), tarsus.RobotController(robot)
    plant.mj_model.dof_frictionloss[6:] = [0.08 * model.stall_torque for leg in models for model in leg]
    plant.start(controller.output)
    speed, tilts = 0.5 * tarsus.WalkController(robot).top_speed((1.0, 0.0, 0.0)), list[float]()
    for _ in range(600):
        controller.step((speed, 0.0, 0.0), DT, plant.step(controller.output, DT))
        tilts.append(float(np.hypot(*plant.state.body.rpy[:2])))
    assert plant.state.body.position[0] > 0.92 * speed * 6
    assert max(tilts) < np.radians(3)


@pytest.mark.no_cover
def test_ticks_that_jitter_cause_no_collisions_where_contacts_are_estimated():
    """With steps of the length of each tick, feet collided with level ground: it turned by 0.76 of its command."""
    ahead, turning = (0.55 * tarsus.WalkController(STRIDER).top_speed(way) for way in ((1, 0, 0), (0, 0, 1)))
    sensors = dataclasses.replace(SensorSuite.named("ideal"), contacts=None, forces=None)
    plant, controller, rng = (
        SimulatedPlant(STRIDER, sensors=sensors),
        tarsus.RobotController(STRIDER),
        np.random.default_rng(1),
    )
    plant.start(controller.output)
    time = turned = before = 0.0
    while time < 11.0:
        dt = float(0.012 * rng.uniform(0.3, 1.7))
        twist = (ahead, 0.0, 0.0) if time < 4.0 else (0.0, 0.0, turning)
        controller.step(twist, dt, plant.step(controller.output, dt))
        yaw, time = plant.state.body.rpy[2], time + dt
        turned, before = turned + (yaw - before + np.pi) % (2 * np.pi) - np.pi, yaw
    assert turned > 0.85 * turning * 7.0
