"""Quadrupeds that walk live: a creep gait, whose body shift keeps them stable for every command."""

import dataclasses

import numpy as np
import pytest

from gait_robots import preset, ring
from quadrupeds import hull_margin, random_quadruped
from sample_studio import Asked
from tarsus.control.command import Command
from tarsus.control.limitation import LimitationKind
from tarsus.control.loop.run import run
from tarsus.control.pose.pose_controller import NO_SHIFT
from tarsus.control.robot_controller import RobotController
from tarsus.control.walk_controller import WalkController
from tarsus.control.walk_state import WalkState
from tarsus.errors import UnreachableError
from tarsus.gait.gait import Gait
from tarsus.kinematics.pose import Pose
from tarsus.robot.file import robot_from_dict
from tarsus.scenario.file import scenario_from_text
from tarsus.scenario.runner import run_scenario
from tarsus.scenario.summary import drive_summary
from tarsus.simulation.simulated_plant import SimulatedPlant

CREEP, CLOCKWISE = (Gait.named("creep", legs=4, turning=turning) for turning in (0.0, -1.0))
DT = 0.02
QUADRUPED = {
    "name": "quadruped",
    "body": {"mass_kg": 1.0, "size_mm": [160, 120, 40]},
    "leg": {
        "coxa_mm": 40,
        "femur_mm": 75,
        "tibia_mm": 110,
        "mass_kg": {"coxa": 0.03, "femur": 0.08, "tibia": 0.05},
        "limits_deg": {"coxa": [-60, 60], "femur": [-80, 90], "tibia": [-150, 5]},
    },
    "legs": [
        {"name": name, "position_mm": [x, y, 0], "yaw_deg": yaw}
        for name, x, y, yaw in (
            *(("front left", 80, 60, 45), ("rear left", -80, 60, 135)),
            *(("rear right", -80, -60, -135), ("front right", 80, -60, -45)),
        )
    ],
}


class Walk:
    """A walk controller, and all that it did."""

    def __init__(self, robot, gait=CREEP):
        self.controller = WalkController(robot, gait)
        self.angles, self.rotations, self.positions, self.contacts, self.states = [], [], [], [], []

    def go(self, command, seconds, dt=DT):
        controller = self.controller
        for _ in range(round(seconds / dt)):
            self.angles.append(controller.step(command, dt))
            self.rotations.append(controller.body.rotation)
            self.positions.append(controller.body.position)
            self.contacts.append(controller.contacts)
            self.states.append(controller.walk_state)
        return self

    def margin(self, every=2):
        """Stability margin at every so many ticks."""
        body = Pose(np.array(self.rotations)[::every], np.array(self.positions)[::every])
        return hull_margin(
            self.controller.robot, np.array(self.angles)[::every], body, np.array(self.contacts)[::every]
        )

    @property
    def shift(self):
        """Where the body is relative to the heading frame [m]."""
        x, y, _ = self.controller.place
        return np.hypot(self.controller.body.position[0] - x, self.controller.body.position[1] - y)


@pytest.mark.parametrize("seed", range(5))
def test_random_quadrupeds_are_stable_whatever_is_commanded(seed):
    rng = np.random.default_rng(seed)
    walk = Walk(random_quadruped(seed))
    for _ in range(4):
        walk.go(tuple(rng.uniform(-1, 1, 3) * [0.05, 0.05, 0.3]), 2.5)
    walk.go((0, 0, 0), 2.5)
    assert (~np.array(walk.contacts)).sum(0).min() > 0
    assert walk.margin().min() > 0.004
    controller, speed = walk.controller, np.diff(walk.angles, axis=0) / DT
    assert (np.abs(speed).max(0) <= controller.joint_speed * 1.001).all()
    assert (np.abs(np.diff(speed, axis=0)).max(0) / DT <= controller.joint_acceleration * 1.001).all()


@pytest.mark.parametrize(("twist", "gait"), [((0.02, 0, 0), CREEP), ((0, -0.02, 0), CREEP), ((0, 0, -0.1), CLOCKWISE)])
def test_a_quadruped_goes_where_it_is_told(twist, gait):
    walk = Walk(ring(4), gait).go(twist, 12.0)
    assert walk.controller.limitations == ()
    np.testing.assert_allclose(walk.controller.twist, twist, atol=1e-6)
    before = np.array(walk.controller.place)
    walk.go(twist, 2.0)
    np.testing.assert_allclose(np.array(walk.controller.place) - before, 2.0 * np.array(twist), atol=1e-5)


def test_no_foot_lifts_before_the_body_is_over_the_others_and_it_returns_when_the_robot_stands():
    walk = Walk(ring(4)).go((0.02, 0, 0), 3.0)
    lifted = int(np.argmin(np.array(walk.contacts).all(-1)))
    assert lifted * DT > 0.5
    standing = np.array([state is WalkState.STANDING for state in walk.states])
    assert standing[: lifted - 1].all()
    assert np.hypot(*walk.positions[lifted - 1][:2]) > 0.02
    walk.go((0, 0, 0), 12.0)
    assert walk.controller.walk_state is WalkState.STANDING
    assert walk.shift < 1e-6


def test_a_walk_resumed_while_the_body_returns_goes_on_smoothly():
    walk = Walk(ring(4)).go((0.02, 0, 0), 4.0)
    while walk.controller.walk_state is not WalkState.STANDING:
        walk.go((0, 0, 0), DT)
    walk.go((0, 0, 0), 0.3)
    assert walk.shift > 0.005
    walk.go((0.0, 0.02, 0), 4.0)
    assert walk.controller.walk_state is WalkState.WALKING
    assert walk.margin().min() > 0.01
    speed = np.diff(walk.angles, axis=0) / DT
    assert (np.abs(np.diff(speed, axis=0)).max(0) / DT <= walk.controller.joint_acceleration * 1.001).all()


def test_another_gait_with_a_body_shift_begins_once_the_robot_stands():
    walk = Walk(ring(4)).go((0.02, 0, 0), 4.0)
    walk.go(Command(twist=(0.02, 0, 0), gait=CLOCKWISE), 12.0)
    assert walk.controller.gait == CLOCKWISE
    assert WalkState.STANDING in walk.states[200:]
    assert walk.controller.walk_state is WalkState.WALKING
    assert walk.margin().min() > 0.01


def test_the_body_height_changes_while_walking():
    walk = Walk(ring(4)).go((0.02, 0, 0), 3.0)
    walk.go(Command(twist=(0.02, 0, 0), body_height=0.09), 12.0)
    assert walk.positions[-1][2] == pytest.approx(0.09, abs=1e-4)
    assert walk.margin().min() > 0.004


@pytest.mark.parametrize("place", [(-0.03, 0.02), (0.02, 0.02)])
def test_the_body_shift_is_for_where_the_body_is_as_feet_step_to_another_stance(place):
    """The body moves only once all feet have stepped; until then, its shift is for where it was."""
    walk = Walk(robot_from_dict(QUADRUPED))
    walk.go(Command(twist=(0.03, 0, 0), body=(*place, 0, 0, 0, 0)), 14.0)
    assert walk.margin(every=1).min() > 0.004


def test_a_hexapod_takes_up_a_gait_with_a_body_shift_and_leaves_it():
    """The shift ends while the robot stands, before the other gait steps."""
    around = Gait(1 - 1 / 9, tuple(np.arange(6) / 6), name="around", body_shift=True)
    walk = Walk(preset("strider"), Gait.named("wave"))
    assert walk.go((0.02, 0, 0), 1.0).controller._tick.gait.shift is NO_SHIFT
    walk.go(Command(twist=(0.02, 0, 0), gait=around), 14.0)
    assert walk.controller.gait == around
    walk.go(Command(twist=(0.02, 0, 0), gait="wave"), 14.0)
    assert walk.controller.gait.name == "wave"
    assert walk.shift < 1e-6


def test_a_commanded_sway_gives_way_to_the_body_shift():
    walk = Walk(ring(4)).go(Command(twist=(0.02, 0, 0), sway=(0, 0.01, 0, 0, 0, 0)), 4.0)
    (found,) = [found for found in walk.controller.limitations if found.kind is LimitationKind.SWAY]
    assert found.granted == 0
    assert found.cause == "the body shift of this gait takes its place"


def test_a_quadruped_that_tips_over_all_the_same_is_refused():
    with pytest.raises(UnreachableError, match="can't stand and step in this stance"):
        WalkController(ring(4, body_com=np.array([0.3, 0, 0])), CREEP)
    with pytest.raises(UnreachableError, match="tip over"):
        WalkController(ring(4), dataclasses.replace(CREEP, body_shift=False))


def test_a_quadruped_stands_up_walks_and_sits_down_without_interventions():
    text = "at 0 s: stand_up; at 2 s: walk 20 mm/s; at 8 s: sit"
    found = run_scenario(
        scenario_from_text(text, start="sitting", rate=50, gait="creep"), robot=ring(4, body_size=[0.1, 0.1, 0.04])
    )
    assert not found.interventions
    assert found.states[-1] == "lying"
    walked = np.array([state == "walking" for state in found.states])
    assert found.motion.margin[walked].min() > 0.01
    assert found.motion.body.position[-1, 0] > 0.05
    # The way is that of the walk, without the body's loops.
    assert drive_summary(found)["distance_mm"] == pytest.approx(1000 * found.motion.body.position[-1, 0], rel=0.02)


def test_in_physics_a_quadruped_keeps_level_and_goes_where_it_is_told():
    robot = robot_from_dict(QUADRUPED)
    plant, tilts = SimulatedPlant(robot, servos="ideal", sensors="blind"), []

    class Watched:
        """The plant, with the attitude that the body really has."""

        start, stop, robot = plant.start, plant.stop, plant.robot

        def step(self, output, dt):
            readings = plant.step(output, dt)
            tilts.append(np.abs(np.asarray(plant.state.body.rpy)[:2]).max())
            return readings

    commands = [(0.0, Command(twist=(0.03, 0.0, 0.0))), (5.0, Command(twist=(0.0, 0.0, 0.0)))]
    found = run(RobotController(robot), Watched(), commands, rate=50, duration=8.0)
    assert max(tilts) < np.radians(0.5)
    planned = found.motion.body.position[-1, 0]
    assert planned > 0.05
    np.testing.assert_allclose(plant.state.body.position[0], planned, rtol=0.04)


@pytest.mark.no_cover
def test_the_studio_drives_a_quadruped_in_its_own_gait():
    asked = Asked()
    assert asked("document", "robot", document=QUADRUPED)["gaits"] == ["creep"]
    assert asked("walk", "walk", walk={"stroke_mm": 40})["possible"]
    asked.all("view", view="drive")
    assert asked.types("drive", on=True) == ["done"]
    assert asked.types("command", velocity_mm_s=[20, 0], turn_deg_s=0) == ["done"]
    frames = [asked.session.frame(1 / 50) for _ in range(300)]
    assert {frame.gait for frame in frames} == {"creep"}
    assert min(frame.margin_mm for frame in frames) > 4
    assert frames[-1].position_mm[0] > 40
