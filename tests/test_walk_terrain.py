"""Walks that feel the ground: on ideal ground of any shape, and in physics."""

import numpy as np
import pytest

from gait_robots import PRESETS, preset
from tarsus.control.command import Command
from tarsus.control.limitation import LimitationKind
from tarsus.control.loop.run import run
from tarsus.control.readings import SensorReadings
from tarsus.control.robot_controller import RobotController
from tarsus.control.terrain.roughness import GroundAdaptation
from tarsus.control.walk_controller import WalkController
from tarsus.gait.gait import Gait
from tarsus.simulation import SimulatedPlant, terrain
from tarsus.simulation.sensors.suite import FootSwitch, Sensor, SensorSuite
from walk_trace import GAITS, Trace

DT = 0.02


def touching(controller, height):
    """Contacts of feet on a ground whose height at x is given; the controller's G is the world."""
    feet = controller.feet
    return tuple(feet[:, 2] <= height(feet[:, 0]) + 1e-4)


def walked(controller, height, twist, seconds, *, attitude=(0.0, 0.0), dt=DT):
    trace = Trace(controller)
    for _ in range(round(seconds / dt)):
        trace.step(twist, dt, readings=SensorReadings(contacts=touching(controller, height), attitude=attitude))
    return trace


def flat(x):
    return 0.0 * x


@pytest.mark.no_cover
@pytest.mark.parametrize("gait", GAITS)
def test_on_flat_ground_it_walks_as_far_as_without_readings(gait):
    felt, blind = (WalkController(preset("strider"), Gait.named(gait)) for _ in range(2))
    twist = (0.95 * blind.top_speed((1, 0, 0)), 0.0, 0.0)
    assert not felt.feels_ground
    trace = walked(felt, flat, twist, 12)
    assert felt.feels_ground
    Trace(blind).run(twist, 12, DT)
    assert felt.place[0] > 0.97 * blind.place[0]
    assert not [found for found in trace.broken(flat=False) if "joint" in found]
    assert felt.limitations == ()


@pytest.mark.no_cover
@pytest.mark.parametrize("name", ["phantomx", "makeyourpet"])
def test_in_physics_the_top_speed_is_that_without_readings(name):
    robot, ways, dt = preset(name), [], 0.01
    speed = WalkController(robot).top_speed((1, 0, 0))
    for sensors in ("blind", "ideal"):
        plant = SimulatedPlant(robot, servos="catalogue", sensors=sensors)
        controller = RobotController(robot)
        output = controller.output
        plant.start(output)
        for tick in range(500):
            output = controller.step((speed, 0.0, 0.0), dt, plant.step(output, dt))
            if tick == 100:
                start = plant.state.body.position[0]
        ways.append(plant.state.body.position[0] - start)
    # Feet that waited for a tick or two stopped the twist: phantomx made 0.94 of the way.
    assert ways[1] > 0.97 * ways[0]


@pytest.mark.parametrize("name", PRESETS)
def test_all_robots_walk_and_stop_on_ground_that_they_feel(name):
    controller = WalkController(preset(name), Gait.named("tripod"))
    twist = (0.5 * controller.top_speed((1, 0, 0)), 0.0, 0.0)
    trace = walked(controller, flat, twist, 6)
    assert controller.place[0] > 5 * twist[0] * 0.9
    walked(controller, flat, (0.0, 0.0, 0.0), 6)
    assert controller.walk_state == "standing"
    assert controller.contacts.all()
    assert not [found for found in trace.broken(flat=False) if "joint" in found]


@pytest.mark.no_cover
@pytest.mark.parametrize("slope", [0.12, -0.12])
def test_the_body_keeps_its_height_over_a_slope(slope):
    controller = WalkController(preset("strider"), Gait.named("tripod"))
    height = controller.body.position[2]
    walked(controller, lambda x: slope * np.maximum(x - 0.35, 0), (0.1, 0.0, 0.0), 20)
    x, _, z = controller.body.position
    assert x > 1.2
    assert z - slope * (x - 0.35) == pytest.approx(height, abs=0.02)


@pytest.mark.parametrize("step", [0.015, -0.015])
def test_feet_stand_on_a_step_where_it_is(step):
    controller = WalkController(preset("strider"), Gait.named("ripple"))

    def ground(x):
        return np.where(x > 0.35, step, 0.0)

    walked(controller, ground, (0.05, 0.0, 0.0), 16)
    feet = controller.feet[controller.contacts]
    np.testing.assert_allclose(feet[:, 2], ground(feet[:, 0]), atol=0.012)


def test_an_edge_is_where_the_robot_waits_and_says_so_and_it_turns_back_from_it():
    controller = WalkController(preset("strider"), Gait.named("tripod"))

    def edge(x):
        return np.where(x > 0.42, -1.0, 0.0)

    walked(controller, edge, (0.08, 0.0, 0.0), 14)
    assert controller.place[0] < 0.3
    assert controller.walk_state == "searching"
    assert [found.kind for found in controller.limitations if found.kind is LimitationKind.GROUND]


def test_a_tilted_body_levels_itself_and_one_that_does_not_use_its_attitude_stays():
    found = []
    for levelling in ("level", None):
        controller = WalkController(preset("strider"), levelling=levelling)
        walked(controller, flat, (0.0, 0.0, 0.0), 1, attitude=(0.05, -0.04))
        feet = controller.feet
        plane = np.linalg.lstsq(np.c_[feet[:, :2], np.ones(6)], feet[:, 2], rcond=None)[0]
        found.append(plane)
    # The left side is up and the front: feet there rise, the others push that side up.
    assert found[0][1] > 0.03
    assert found[0][0] > 0.03
    np.testing.assert_allclose(found[1][:2], 0.0, atol=0.01)


def test_a_body_whose_attitude_is_no_longer_measured_does_not_turn_on_and_on():
    controller = WalkController(preset("strider"))

    def inclined_after(seconds, attitude):
        walked(controller, flat, (0.05, 0.0, 0.0), seconds, attitude=attitude)
        down, feet = controller.contacts, controller.feet - controller.body.position
        return np.linalg.lstsq(np.c_[feet[down, :2], np.ones(down.sum())], feet[down, 2], rcond=None)[0][0]

    assert inclined_after(0.5, (0.0, -0.1)) > 0.02
    assert abs(inclined_after(1.5, None)) < 0.01
    assert abs(inclined_after(2.0, None)) < 0.01


def test_a_robot_on_a_slope_that_is_too_steep_walks_back_without_its_attitude_too():
    controller = WalkController(preset("strider"), adaptation=GroundAdaptation(friction=0.42))

    def place_after(seconds, speed, attitude):
        walked(controller, lambda x: 0.15 * np.maximum(x - 0.2, 0.0), (speed, 0.0, 0.0), seconds, attitude=attitude)
        return controller.body.position[0]

    stopped = place_after(6.0, 0.1, (0.0, 0.0))
    assert place_after(3.0, 0.1, None) == pytest.approx(stopped, abs=0.01)
    assert place_after(3.0, -0.1, None) < stopped - 0.15


def test_turns_and_sideways_walks_feel_the_ground_too():
    controller = WalkController(preset("phantomx"), Gait.named("tetrapod"))
    twist = 0.6 * controller.top_speed((0.05, 0.05, 0.5)) * np.array([0.05, 0.05, 0.5])
    trace = walked(controller, lambda x: 0.004 * np.sin(20 * x), tuple(twist), 8)
    assert controller.place[2] == pytest.approx(8 * twist[2], rel=0.2)
    assert not [found for found in trace.broken(flat=False) if "joint" in found]


def test_a_leg_that_leaves_the_gait_moves_to_its_target_on_felt_ground():
    controller = WalkController(preset("strider"), Gait.named("wave"))
    walked(controller, flat, Command(foot_targets={0: (0.25, 0.2, 0.06)}), 14)
    np.testing.assert_allclose(controller.feet[0], (0.25, 0.2, 0.06), atol=0.01)
    walked(controller, flat, Command(twist=(0.03, 0, 0)), 4)
    walked(controller, flat, Command(foot_targets={0: None}), 16)
    assert controller.contacts.all()


# In physics.


def in_physics(ground, *, sensors="ideal", seconds=6.0, speed=0.12, name="strider", **options):
    """Return way over the commanded one, and RMS of the tilt in degrees."""
    robot = preset(name)
    plant = SimulatedPlant(robot, terrain=ground, sensors=sensors)
    controller, tilts = RobotController(robot, **options), []

    class Watched:
        """The plant, and how its body is tilted."""

        def __init__(self):
            self.robot, self.start, self.stop = robot, plant.start, plant.stop

        def step(self, output, dt):
            readings = plant.step(output, dt)
            tilts.append(float(np.hypot(*np.asarray(plant.state.body.rpy)[:2])))
            return readings

    recording = run(controller, Watched(), [(0.0, (speed, 0.0, 0.0))], duration=seconds)
    assert not plant.state.body_touches
    assert not recording.interventions
    return plant.state.body.position[0] / (speed * seconds), np.degrees(np.sqrt(np.mean(np.square(tilts))))


@pytest.mark.no_cover
def test_over_blocks_it_is_faster_and_calmer_than_a_walk_that_feels_nothing():
    ground = terrain.Blocks(rise=0.04, clear=0.35, seed=4)
    way, tilt = in_physics(ground)
    blind_way, blind_tilt = in_physics(ground, sensors="blind")
    assert way > max(0.85, blind_way)
    assert tilt < 0.8 * blind_tilt


def test_cheap_sensors_are_enough():
    ground = terrain.Smooth(amplitude=0.04, clear=0.35, seed=3)
    way, tilt = in_physics(ground, sensors="hobby")
    assert way > 0.85
    assert tilt < 2.0


def test_late_and_wrong_contacts_cost_little():
    noisy = SensorSuite(contacts=FootSwitch(delay=0.05, flips=0.02), attitude=Sensor(noise=np.radians(1.0), delay=0.05))
    way, _ = in_physics(terrain.Flat(), sensors=noisy)
    assert way > 0.9


@pytest.mark.parametrize(("since", "attitude"), [(0.0, True), (1.0, False)])
def test_a_robot_that_stands_rests_whatever_a_switch_tells(since, attitude):
    robot, places, dt = preset("strider"), [], 0.01
    plant, controller = SimulatedPlant(robot, servos="catalogue"), RobotController(robot)
    output = controller.output
    plant.start(output)
    for tick in range(400):
        read = plant.step(output, dt)
        contacts = np.array(read.contacts)
        contacts[4] &= tick * dt < since
        told = SensorReadings(contacts=contacts, attitude=read.attitude if attitude else None)
        output = controller.step((0.0, 0.0, 0.0), dt, told)
        places.append(np.append(plant.state.body.position[:2], plant.state.body.rpy[:2]))
    moved = np.abs(places[-1] - places[50])
    # The foot was pushed down: the robot moved by 6 mm, without an attitude by 0.05 to 0.14 m.
    assert moved[:2].max() < 0.003
    assert moved[2:].max() < np.radians(0.5)
