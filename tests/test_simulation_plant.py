"""Simulated plants: standing agrees with statics, walking with the ideal plant; runs repeat; failures are named."""

import dataclasses
import re

import mujoco
import numpy as np
import pytest

from tarsus.control.command import Command
from tarsus.control.loop.run import run
from tarsus.control.plant import Plant
from tarsus.control.robot_controller import RobotController
from tarsus.errors import InputError, SimulationError
from tarsus.gait.gait import Gait
from tarsus.gait.path import straight_path
from tarsus.gait.plan import plan_walk
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import total_mass
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stance import default_stance
from tarsus.load.acceleration import differences
from tarsus.load.inverse_dynamics import motion_torques
from tarsus.load.torque import joint_torques
from tarsus.robot.file import load_robot
from tarsus.simulation import SensorSuite, ServoModel, SimulatedPlant
from tarsus.simulation.sensors import suite
from tarsus.simulation.terrain import Blocks, Flat, HeightField, Ramp, Smooth, Step
from tarsus.simulation.truth.traced_plant import play

STRIDER = load_robot("strider")
GRAVITY = 9.80665
TRIPOD = np.array([True, False, True, False, True, False])


def started(robot=STRIDER, *, state="standing", **options):
    controller = RobotController(robot, start=state)
    plant = SimulatedPlant(robot, **options)
    plant.start(controller.output)
    return controller, plant


def on_three_feet():
    """The strider's output on the feet LF, LR and RM, 185 mm from the coxa axes and 102 mm below the body."""
    yaw = STRIDER.mount_yaw
    feet = STRIDER.mount_position + 0.185 * np.stack([np.cos(yaw), np.sin(yaw), 0 * yaw], axis=-1)
    feet[:, 2] = np.where(TRIPOD, -0.102, -0.062)
    angles = inverse_kinematics(STRIDER, feet).require().angles
    body = Pose.from_rpy(0, 0, 0, (0, 0, 0.102))
    return dataclasses.replace(RobotController(STRIDER).output, angles=angles, body=body)


def test_a_robot_on_three_feet_settles_at_the_torques_of_statics():
    plant, output = SimulatedPlant(STRIDER, servos="ideal", sensors="blind"), on_three_feet()
    plant.start(output)
    # Friction relaxes with about 2.3 s.
    for _ in range(120):
        plant.step(output, 0.1)
    state = plant.state
    weight = float(total_mass(STRIDER)) * GRAVITY
    assert state.foot_forces[TRIPOD, 2] == pytest.approx(weight / 3, rel=1e-4)
    assert (state.foot_forces[~TRIPOD] == 0).all()
    assert np.abs(state.torques[TRIPOD]) == pytest.approx(np.tile([0.0, 1.07, 0.51], (3, 1)), abs=0.005)
    statics, _ = joint_torques(STRIDER, state.joint_angles, state.body, TRIPOD, forces=state.foot_forces)
    # Friction acts at the bottom of the ball, one radius below the foot.
    lever = 1.05 * np.abs(state.foot_forces[:, :2]).max() * 0.008
    assert state.torques == pytest.approx(statics, abs=lever + 1e-4)
    vertical, _ = joint_torques(STRIDER, state.joint_angles, state.body, TRIPOD)
    assert state.torques == pytest.approx(vertical, abs=0.03)


def test_readings_are_those_of_the_state():
    controller, plant = started()
    assert isinstance(plant, Plant)
    readings = plant.step(controller.output, 0.01)
    state = plant.state
    assert (readings.joint_angles == state.joint_angles).all()
    assert (readings.joint_speeds == state.joint_speeds).all()
    assert (readings.torques == state.torques).all()
    assert readings.contacts.all()
    assert readings.forces == pytest.approx(state.foot_forces @ state.body.rotation)
    assert readings.forces[:, 2].sum() == pytest.approx(float(total_mass(STRIDER)) * GRAVITY, rel=1e-3)
    assert readings.currents is None
    assert readings.age == 0.0
    assert state.time == pytest.approx(0.01)
    plant.stop()


def test_foot_forces_are_the_sums_of_the_contacts_forces():
    controller, plant = started(sensors="ideal", terrain=Blocks(rise=0.02, clear=0.0))
    model, data, wrench = plant.mj_model, plant.mj_data, np.empty(6)
    for _ in range(20):
        readings = plant.step(controller.output, 0.01)
        expected = np.zeros((6, 3))
        for number, contact in enumerate(data.contact):
            mujoco.mj_contactForce(model, data, number, wrench)
            names = [model.geom(geom).name for geom in contact.geom]
            for leg, name in enumerate(STRIDER.leg_names):
                if f"{name} foot" in names:
                    sign = 1 if names[1] == f"{name} foot" else -1
                    expected[leg] += sign * (wrench[:3] @ contact.frame.reshape(3, 3))
        assert plant.state.foot_forces == pytest.approx(expected, abs=1e-9)
        assert (readings.contacts == (np.linalg.norm(expected, axis=1) > 0.5)).all()
        assert not plant.state.body_touches


def test_attitude_and_rates_are_those_of_the_body():
    controller, plant = started(servos="ideal", terrain=Flat(friction=0.01))
    tilted = Pose.from_rpy(0.2, -0.1, 0.4, (0, 0, 0))
    height = -float((tilted @ forward_kinematics(STRIDER, controller.output.angles)[:, 3])[:, 2].min())
    tilted = Pose(tilted.rotation, np.array([0, 0, height]))
    plant.start(dataclasses.replace(controller.output, body=tilted))
    plant.mj_data.qvel[3:6] = (0.3, -0.2, 0.5)
    first = plant.state.body
    readings = plant.step(controller.output, 0.002)
    assert readings.attitude == pytest.approx(np.array(plant.state.body.rpy)[:2], abs=1e-12)
    turn = np.asarray(first.rotation).T @ plant.state.body.rotation
    measured = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]) / 2 / 0.002
    assert readings.angular_rates == pytest.approx(measured, abs=1e-3)


def test_currents_are_measured_where_all_stall_currents_are_known():
    robot = load_robot("makeyourpet")
    controller, plant = started(robot)
    readings = plant.step(controller.output, 0.01)
    assert readings.currents == pytest.approx(np.abs(readings.torques) * 2.5 / 1.079)


@pytest.mark.parametrize("gait", ["tripod", "wave"])
@pytest.mark.parametrize("name", ["strider", "phantomx"])
def test_on_flat_ground_with_ideal_servos_the_walk_is_that_of_the_ideal_plant(name, gait):
    robot = load_robot(name)
    commands = [(0.0, Command(twist=(0.05, 0.0, 0.0), gait=gait)), (2.5, Command())]
    _, plant = started(robot, servos="ideal", sensors="blind")
    before = plant.state.body.position
    # Without sensors the controller does what it does with an ideal plant.
    planned = run(RobotController(robot), plant, commands, duration=4.5).motion.body.position
    expected, state = planned[-1] - planned[0], plant.state
    assert (state.body.position - before)[:2] == pytest.approx(expected[:2], rel=0.02, abs=0.001)
    assert np.abs(state.body.rpy) == pytest.approx(0, abs=0.01)
    assert state.body.position[2] == pytest.approx(expected[2] + before[2], abs=0.002)


def test_torques_of_a_swinging_leg_are_those_of_inverse_dynamics():
    motion = plan_walk(STRIDER, Gait.named("tripod"), straight_path(0.2), rate=100.0)
    plant = SimulatedPlant(STRIDER, servos="ideal", sensors="blind")
    trace = play(motion, plant)
    acceleration = differences(motion.time, motion.angles)[1]
    expected = motion_torques(STRIDER, motion).torques + plant.servos[0][0].rotor_inertia * acceleration
    air, settled = ~motion.contacts, 12  # the servos lag by 10 ms, and vibrate after lift-off
    inside = np.all([np.roll(air, shift, axis=0) for shift in range(-5, settled)], axis=0)[: len(motion.time) - 5]
    assert inside.any(axis=0).all()
    error = (trace.torques[: len(expected)] - expected)[:-5][inside]
    assert np.sqrt((error**2).mean(axis=0)) == pytest.approx([0, 0, 0], abs=0.1)


def test_servos_of_the_catalogue_walk_within_their_torque_and_shorter():
    commands = [(0.0, Command(twist=(0.05, 0.0, 0.0)))]
    _, plant = started(sensors=SensorSuite(joint_angles=suite.Sensor()))
    recording = run(RobotController(STRIDER), plant, commands, duration=4.0)
    way, planned = plant.state.body.position[0], recording.motion.body.position[-1, 0]
    assert 0.8 * planned < way < planned
    assert np.abs(plant.state.torques).max() < 2.452
    assert not np.isnan(recording.measured_angles[:-1]).any()


def test_a_robot_stands_up_from_its_belly():
    controller, plant = started(state="lying", servos="ideal", sensors="blind")
    lying = plant.state.body.position[2]
    recording = run(controller, plant, [(0.0, Command(state="standing"))], duration=4.0)
    assert recording.states[-1] == "standing"
    assert plant.state.body.position[2] > lying + 0.05
    assert np.abs(plant.state.body.rpy) == pytest.approx(0, abs=0.02)


def test_without_a_box_the_robot_lies_on_its_coxa_axes():
    robot = STRIDER.replace(body_size=None)
    _, plant = started(robot, state="lying", servos="ideal")
    assert plant.state.body.position[2] == pytest.approx(0, abs=0.02)


@pytest.mark.parametrize("terrain", [Step(rise=0.03, start=0.1), Ramp(slope=0.1, start=-1.0), Smooth(seed=4)])
def test_the_lowest_foot_starts_on_the_ground(terrain):
    controller, plant = started(terrain=terrain, servos="ideal")
    state = plant.state
    feet = np.asarray(state.body @ forward_kinematics(STRIDER, state.joint_angles)[:, 3])
    clearance = feet[:, 2] - terrain.height(feet[:, 0], feet[:, 1])
    assert clearance.min() == pytest.approx(0.008, abs=0.002)
    assert state.foot_forces[:, 2].sum() == pytest.approx(float(total_mass(STRIDER)) * GRAVITY, rel=0.02)
    assert (plant.step(controller.output, 0.01).contacts == (state.foot_forces[:, 2] > 0.5)).all()


def test_a_robot_that_starts_inside_the_terrain_is_refused():
    heights = np.zeros((41, 41))
    heights[19:22, 19:22] = 0.2
    with pytest.raises(InputError, match=r"starts inside the terrain: 'body' is \d+\.\d mm deep in 'ground' at \("):
        started(terrain=HeightField(heights=heights, size=(1.0, 1.0)))


def test_a_body_inside_level_ground_is_told_the_body_height_that_it_needs():
    plant = SimulatedPlant(STRIDER)

    def start_at(height):
        angles = inverse_kinematics(STRIDER, default_stance(STRIDER, height)).require().angles
        body = Pose(position=(0.0, 0.0, height))
        plant.start(dataclasses.replace(RobotController(STRIDER).output, angles=angles, body=body))

    needed = "starts inside the terrain: the underside of its body is 12.0 mm below the ground; a body height of at "
    with pytest.raises(InputError, match=f"{needed}least 17.0 mm is needed"):
        start_at(0.005)
    start_at(0.017)


@pytest.mark.parametrize("sensors", ["hobby", "smart"])
def test_the_same_seed_gives_the_same_run_to_the_bit(sensors):
    def walked(seed):
        _, plant = started(sensors=sensors, seed=seed, terrain=Blocks(rise=0.01, clear=0.0))
        recording = run(RobotController(STRIDER), plant, [(0.0, (0.05, 0.0, 0.1))], duration=1.0)
        return plant.state.body.position, recording.motion.angles, plant.mj_data.qpos.copy()

    first, second = walked(3), walked(3)
    assert all(np.array_equal(a, b) for a, b in zip(first, second, strict=True))


def test_a_plant_can_be_started_again():
    controller, plant = started(sensors="hobby")
    first = [plant.step(controller.output, 0.01).attitude for _ in range(5)]
    plant.start(controller.output)
    assert np.array_equal(first, [plant.step(controller.output, 0.01).attitude for _ in range(5)])


def test_ticks_of_any_duration_add_up():
    controller, plant = started(sensors="blind")
    start = plant.mj_data.time
    for dt in (0.0031, 0.0005, 0.0124, 0.004):
        plant.step(controller.output, dt)
    assert plant.mj_data.time - start == pytest.approx(0.02)
    assert plant.state.time == pytest.approx(0.02)


def test_the_assumptions_are_listed():
    plant = SimulatedPlant(STRIDER, sensors=SensorSuite(name="none"))
    assert plant.assumed[0].startswith("inertia of a link")
    assert any(line.startswith("DS3225: control stiffness") for line in plant.assumed)
    assert plant.servos[0][0].name == "DS3225"
    assert plant.sensors.name == "none"


def test_what_cannot_be_executed_is_refused():
    controller, plant = started()
    angles = np.array(controller.output.angles)
    angles[2, 1] = np.nan
    with pytest.raises(InputError, match="commanded angle of leg 2, joint 1 is nan; it must be finite"):
        plant.step(dataclasses.replace(controller.output, angles=angles), 0.01)
    for dt in (0.0, -1.0, np.nan, np.inf, 1e9):
        with pytest.raises(InputError, match="it must be greater than 0 and at most 60 s"):
            plant.step(controller.output, dt)
    with pytest.raises(InputError, match="has not been started"):
        SimulatedPlant(STRIDER).step(controller.output, 0.01)


def test_servos_that_are_too_stiff_are_refused():
    message = "ideal: a stiffness of 1e+06 N m/rad at joint "
    with pytest.raises(InputError, match=re.escape(message) + r".*at most 1[.\de+]+ N m/rad would work"):
        started(servos=ServoModel.ideal(stiffness=1e6))


def test_a_simulation_that_becomes_unstable_is_an_error():
    controller, plant = started()
    plant.mj_data.qvel[0] = 5e3
    with pytest.raises(SimulationError, match=r"became unstable by 0\.010 s: a speed of \d+"):
        plant.step(controller.output, 0.01)


@pytest.mark.parametrize("ground", [Blocks(rise=0.001, clear=0.0, seed=3), Smooth(seed=2)])
def test_uneven_ground_holds_no_foot_that_is_pressed_into_it(ground):
    controller = RobotController(load_robot("phantomx"))
    plant = SimulatedPlant(controller.robot, terrain=ground)
    plant.start(controller.output)
    plant.mj_data.qvel[2] = -0.6
    for _ in range(30):
        plant.step(controller.output, 0.01)
        assert plant.state.foot_forces[:, 2].min() > -0.1


def test_a_seed_that_is_no_whole_number_is_refused():
    with pytest.raises(InputError, match=r"seed is 1.5; it must be a whole number, not negative"):
        SimulatedPlant(load_robot("strider"), seed=1.5)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"terrain": "blocks"}, r"terrain must be a terrain such as Flat\(\) or Blocks\(\), got 'blocks'"),
        ({"terrain": 3}, "terrain must be a terrain"),
        ({"sensors": 3}, "sensors must be a SensorSuite or the name of one, got 3"),
    ],
)
def test_terrain_and_sensors_of_another_type_are_refused(options, message):
    with pytest.raises(InputError, match=message):
        SimulatedPlant(STRIDER, **options)
