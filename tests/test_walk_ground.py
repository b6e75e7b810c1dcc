"""The live walker on ground that is not where it was expected, and with what its sensors say."""

import numpy as np
import pytest

from tarsus import Gait, forward_kinematics, list_robots, load_robot
from tarsus.control.command import Command
from tarsus.control.limitation import Limitation
from tarsus.control.pose.admittance import Admittance
from tarsus.control.readings import SensorReadings
from tarsus.control.walk_controller import WalkController

DT = 0.01


class World:
    """Ground of any shape that tells which feet touch it."""

    def __init__(self, height, **setup):
        self.height = height
        self.controller = WalkController(load_robot("strider"), Gait.named("tripod"), **setup)
        self.angles, self.rate = self.controller.angles, 0.0
        self.worst_speed = self.worst_acceleration = 0.0
        self.least_down = 6
        self.modes = set()

    def touching(self):
        return [bool(foot[2] <= self.height(foot) + 1e-4) for foot in self.controller.feet]

    def walk(self, command, seconds, **readings):
        for _ in range(round(seconds / DT)):
            given = {"contacts": self.touching(), **readings}
            angles = self.controller.step(command, DT, readings=SensorReadings(**given))
            rate = (angles - self.angles) / DT
            self.worst_speed = max(self.worst_speed, (abs(rate) / self.controller.joint_speed).max())
            change = abs(rate - self.rate) / DT / self.controller.joint_acceleration
            self.worst_acceleration = max(self.worst_acceleration, change.max())
            self.angles, self.rate = angles, rate
            self.modes.add(self.controller.walk_state)
            self.least_down = min(self.least_down, self.controller.contacts.sum())
        return self


def test_flat_ground_changes_nothing():
    world = World(lambda _: 0.0, cycle_time=1.0)
    blind = WalkController(load_robot("strider"), Gait.named("tripod"), cycle_time=1.0)
    for _ in range(300):
        world.walk((0.1, 0, 0.1), DT, attitude=(0.0, 0.0))
        np.testing.assert_allclose(world.controller.angles, blind.step((0.1, 0, 0.1), DT), atol=2e-4)


def test_feet_stop_on_a_step_up():
    world = World(lambda foot: 0.010 if foot[0] > 0.3 else 0.0).walk((0.1, 0, 0), 7).walk((0, 0, 0), 3)
    on_it = world.controller.feet[:, 0] > 0.32
    assert on_it.any()
    # A foot is stopped within 3 mm, and later steps start from where the ground was found.
    assert (abs(world.controller.feet[on_it, 2] - 0.010) < 0.003).all()
    assert world.worst_speed <= 1.001
    assert world.worst_acceleration <= 1.001


def test_feet_look_for_ground_below():
    world = World(lambda foot: -0.010 if foot[0] > 0.3 else 0.0).walk((0.1, 0, 0), 7)
    assert "searching" in world.modes
    lower = world.controller.contacts & (world.controller.feet[:, 0] > 0.32)
    assert lower.any()
    assert (abs(world.controller.feet[lower, 2] + 0.010) < 0.004).all()
    assert world.least_down >= 3
    assert world.worst_speed <= 1.001
    assert world.worst_acceleration <= 1.001


def test_without_ground_the_robot_holds_still_and_says_so():
    world = World(lambda foot: -0.5 if foot[0] > 0.4 else 0.0).walk((0.1, 0, 0), 8)
    assert world.controller.walk_state == "searching"
    assert any("no ground under" in reason for reason in map(Limitation.text, world.controller.limitations))
    before = world.controller.angles
    world.walk((0.1, 0, 0), 0.5)
    np.testing.assert_allclose(world.controller.angles, before, atol=1e-3)
    # Blind again, it takes the ground to be where the foot is.
    for _ in range(200):
        world.controller.step((0.0, 0, 0), DT)
    assert world.controller.walk_state != "searching"


def test_garbage_is_refused_and_named():
    controller = WalkController(load_robot("strider"), Gait.named("tripod"))
    blind = WalkController(load_robot("strider"), Gait.named("tripod"))
    garbage = SensorReadings(contacts="yes", attitude=(np.nan, 9.0), forces=[1e30] * 6, torques=None, age=0.0)
    for _ in range(200):
        np.testing.assert_array_equal(controller.step((0.1, 0, 0), DT, readings=garbage), blind.step((0.1, 0, 0), DT))
    assert any("attitude" in reason for reason in map(Limitation.text, controller.limitations))
    assert any("contacts" in reason for reason in map(Limitation.text, controller.limitations))


@pytest.mark.parametrize("axis", [0, 1])
def test_the_body_levels_itself(axis):
    tilt = [0.0, 0.0]
    tilt[axis] = 0.12
    world = World(lambda _: 0.0, levelling="level")
    for _ in range(1200):
        # The world leans under the robot: what the body is tilted by in G adds to it.
        roll, pitch, _ = world.controller.body.rpy
        world.walk((0, 0, 0), DT, attitude=(roll + tilt[0], pitch + tilt[1]))
    measured = (roll + tilt[0], pitch + tilt[1])
    assert abs(measured[axis]) < 0.03
    assert world.worst_acceleration <= 1.001
    assert world.controller.margin > 0.05


def test_loaded_feet_give_way():
    soft = Admittance(mass=1.0, damping=60.0, stiffness=400.0)
    world = World(lambda _: 0.0, admittance=soft)
    weight = 3.066 * 9.80665
    even = [weight / 6] * 6
    world.walk((0, 0, 0), 1, forces=[(0, 0, f) for f in even])
    level = world.controller.feet[:, 2].copy()
    even[0] += 4.0
    world.walk((0, 0, 0), 2, forces=[(0, 0, f) for f in even])
    risen = world.controller.feet[:, 2] - level
    assert risen[0] > 0.003
    assert risen[0] == pytest.approx(risen.max())
    feet = world.controller.body @ forward_kinematics(world.controller.robot, world.controller.angles)[:, 3]
    np.testing.assert_allclose(feet, world.controller.feet, atol=1e-9)
    # From torques alone, as well; and without either, feet come back.
    world.walk((0, 0, 0), 0.2, torques=np.zeros((6, 3)))
    world.walk((0, 0, 0), 3)
    np.testing.assert_allclose(world.controller.feet[:, 2], 0.0, atol=2e-3)


def test_without_masses_nothing_is_known_of_forces():
    controller = WalkController(
        load_robot("mithi"), Gait.named("tripod"), admittance=Admittance(mass=1.0, damping=60.0, stiffness=400.0)
    )
    for _ in range(20):
        controller.step(Command(), DT, readings=SensorReadings(forces=[5.0] * 6))
    np.testing.assert_allclose(controller.feet[:, 2], 0.0, atol=1e-12)


@pytest.mark.lengthy
@pytest.mark.parametrize("name", list_robots())
def test_feet_that_meet_steps_early_keep_every_joint_within_its_acceleration(name):
    controller = WalkController(load_robot(name), Gait.named("tripod"))
    twist, dt = 0.8 * controller.top_speed((1, 0, 0)) * np.array([1, 0, 0]), 0.01
    worst = highest = 0.0
    angles, rate = controller.angles, np.zeros_like(controller.angles)
    for _ in range(1000):
        height = 0.006 * ((controller.feet[:, 0] // 0.1) % 2)
        after = controller.step(
            twist, dt, readings=SensorReadings(contacts=tuple(controller.feet[:, 2] <= height + 1e-4))
        )
        now = (after - angles) / dt
        worst = max(worst, float((np.abs(now - rate) / dt / controller.joint_acceleration).max()))
        angles, rate = after, now
        highest = max(highest, controller.feet[controller.contacts, 2].max())
    assert worst <= 1.001
    # On top of the steps, but for what they sink in while they stop.
    assert 0.001 < highest <= 0.0061
