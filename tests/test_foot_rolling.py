"""Feet of live walks roll: their balls do not slip, and a simulated robot walks the commanded way."""

import numpy as np
import pytest
from hypothesis import given, settings

from gait_robots import point_feet, preset
from robots import FULL_TURN, plain_hexapod, seeds
from sample_gait_states import moment_of, rest_of, setup_of
from tarsus import Pose, forward_kinematics, inverse_kinematics
from tarsus.control.command import Command
from tarsus.control.pose.foot_rolling import FootRolling
from tarsus.control.readings import ValidReadings
from tarsus.control.robot_controller import RobotController
from tarsus.control.sensing.leg_odometry import CommandedMotion, LegOdometry
from tarsus.control.walk.joint_solver import JointSolver
from tarsus.control.walk_controller import WalkController
from tarsus.gait.gait import Gait
from tarsus.kinematics.rolling import rolling_displacements
from tarsus.simulation.simulated_plant import SimulatedPlant
from walk_trace import Trace

ON_BALLS = ("strider", "makeyourpet")
TWISTS = {"straight": (1, 0, 0), "sideways": (0, 1, 0), "curve": (1, 0, 2.5), "turn": (0, 0, 1)}
# What the map of posture and foothold leaves out of the rolling: the turn of the leg [m].
SLIP = 0.4e-3


def walking(robot, gait, direction, share=0.9):
    w = WalkController(robot, Gait.named(gait))
    return w, share * w.top_speed(direction) * np.array(direction, dtype=float)


@pytest.mark.parametrize(("name", "gait"), [("strider", "wave"), ("makeyourpet", "tripod")])
@pytest.mark.parametrize("kind", TWISTS)
def test_a_standing_foot_rolls_without_slip(name, gait, kind):
    w, twist = walking(preset(name), gait, TWISTS[kind])
    trace = Trace(w).run(twist, 2.2 * w.cycle_time, 0.02)
    assert trace.slip().max() < SLIP
    # Rolling moves the centres by more than that where the legs lean over.
    rolled = np.linalg.norm(rolling_displacements(w.robot, trace.angles, trace.body), axis=-1).sum(0)
    assert kind == "turn" or rolled.max() > 4 * SLIP
    np.testing.assert_allclose(trace.feet[-1], w.feet, atol=1e-12)


@pytest.mark.parametrize("name", ON_BALLS)
def test_a_robot_that_stops_stands_as_before(name):
    w, twist = walking(preset(name), "tripod", (1, 0.3, 1))
    angles = w.angles
    trace = Trace(w).run(twist, 2 * w.cycle_time).run((0, 0, 0), 4 * w.cycle_time)
    assert w.walk_state == "standing"
    np.testing.assert_allclose(w.angles, angles, atol=1e-5)
    trace.assert_sound()


def test_the_displacement_is_continuous_in_speed_from_swing_to_stance():
    dt = 0.005
    w, twist = walking(preset("strider"), "tripod", (0, 1, 0), 0.5)
    rolled = []
    for _ in range(round(2.5 * w.cycle_time / dt)):
        w.step(twist, dt)
        rolled.append(w.feet[:, 0] + 1j * w.feet[:, 1] - w._tick.gait.foot)
    speed = np.diff(rolled, axis=0) / dt
    assert np.abs(speed).max() > 0.01
    # From one tick to the next by less than 1 m/s^2: a jump at touchdown would be several times that.
    assert np.abs(np.diff(speed, axis=0)).max() / dt < 1.0


def test_a_tilted_and_swaying_body_keeps_the_feet_on_the_ground():
    w = WalkController(preset("strider"))
    trace = Trace(w).run(Command(body=(0.01, 0.005, 0.0, 0.06, -0.05, 0.1), sway=(0.005,) * 3 + (0.02,) * 3), 3)
    trace.run((0.04, 0.02, 0.1), 3).assert_sound()


def test_a_leg_out_of_the_gait_has_its_foot_where_it_is_commanded():
    w = WalkController(preset("strider"), Gait.named("wave"))
    point = w.feet[0] + [0.02, 0.03, 0.05]
    trace = Trace(w).run(Command(foot_targets={0: tuple(point)}), 18)
    np.testing.assert_allclose(w.feet[0], point, atol=1e-6)
    trace.run(Command(foot_targets={0: None}), 14).assert_sound()


def test_a_lower_body_has_its_feet_at_rest_again():
    w, points = (WalkController(robot("strider")) for robot in (preset, point_feet))
    for _ in range(400):
        for each in (w, points):
            each.step(Command(body_height=0.08), 0.02)
    np.testing.assert_allclose(w.feet, points.feet, atol=1e-9)


@pytest.mark.parametrize(("name", "gait", "width"), [("strider", "wave", 0.03), ("makeyourpet", "tripod", -0.02)])
def test_standing_feet_do_not_slip_while_the_walk_changes_to_other_rest_footholds(name, gait, width):
    """What a foot rolls about follows its rest foothold in the air only: the body's pose stays the same."""
    w, twist = walking(preset(name), gait, (1, 0, 0), 0.5)
    trace = Trace(w).run(twist, 1.0, 0.02).run(Command(twist=tuple(twist), stance_width=width), 3 * w.cycle_time, 0.02)
    assert not w.limitations
    assert trace.slip().max() < SLIP


@pytest.mark.parametrize("height", [0.077, 0.125])
def test_the_guard_lets_a_robot_on_balls_walk_on_at_another_height(height):
    controller, dt = RobotController(preset("strider")), 0.01
    for tick in range(300):
        command = Command(twist=(0.05, 0, 0), body_height=height if tick >= 100 else None)
        assert not controller.step(command, dt).interventions


@pytest.mark.parametrize("name", ON_BALLS)
def test_uneven_ticks_accelerate_joints_no_harder_than_even_ones(name):
    """The balls roll about where they rest at the posture that is solved, not at that of the tick before."""
    hardest = {}
    for ticks in ((0.05, 0.001), (0.0255, 0.0255)):
        trace = Trace(WalkController(preset(name))).run(Command(body=(0, 0, -0.02, 0, 0.1, 0)), 0.02)
        for _ in range(30):
            for dt in ticks:
                trace.step((0, 0, 0), dt)
        hardest[ticks] = trace.joint_shares()[1].max()
    uneven, even = hardest.values()
    assert 0 < uneven < 1.5 * even


def solver_of(setup, rest, out=()):
    solver = JointSolver(setup.robot)
    now = moment_of(setup, rest)
    solver.rolling.step(rest, list(out), 0.02, down=now.down)
    return solver, now


def test_out_of_reach_the_other_legs_roll_as_before():
    setup, rest = setup_of("strider"), rest_of("strider")
    solver, now = solver_of(setup, rest)
    near = now._replace(foot=now.foot + 0.03)
    foot = near.foot.copy()
    foot[2] = now.origin + 3 * (foot[2] - now.origin)
    expected, found = solver.angles(near), solver.angles(near._replace(foot=foot))
    others = [0, 1, 3, 4, 5]
    np.testing.assert_allclose(found[others], expected[others], atol=1e-9)
    assert np.abs(found[2] - expected[2]).max() > 0.1
    # Without rolling it is another foot.
    still = JointSolver(setup.robot)
    assert np.abs(still.angles(near) - expected).max() > 1e-3


def test_the_feet_are_those_of_the_forward_kinematics():
    setup, rest = setup_of("strider"), rest_of("strider")
    solver, now = solver_of(setup, rest, out=[1])
    now = now._replace(foot=now.foot + 0.02)
    angles = solver.angles(now)
    x, y, z, roll, pitch, yaw, _ = now.posture.value[:7]
    heading = Pose.from_rpy(0, 0, now.yaw, (now.origin.real, now.origin.imag, 0.0))
    body = heading @ Pose.from_rpy(roll, pitch, yaw, (x, y, z))
    feet = solver.feet(now, angles)
    np.testing.assert_allclose(feet, body @ forward_kinematics(setup.robot, angles)[..., 3, :], atol=1e-12)
    moved = np.abs(feet[:, 0] + 1j * feet[:, 1] - now.foot)
    assert moved[1] < 1e-12
    assert (np.delete(moved, 1) > 1e-4).all()


def test_a_stance_is_solved_once():
    setup, rest = setup_of("strider"), rest_of("strider")
    posture, down = moment_of(setup, rest).posture.value, np.ones(6, dtype=bool)
    rolling = FootRolling(setup.robot)
    rolling.step(rest, [], 0.02, down=down)
    balls = rolling.balls(posture)
    for same in (rest, rest.copy()):
        rolling.step(same, [], 0.02, down=down)
        assert rolling.balls(posture) is balls
    again = rolling.balls(posture.copy())
    assert again is not balls
    assert again == balls
    for _ in range(400):
        rolling.step(1.05 * rest, [], 0.02, down=~down)
    fresh = FootRolling(setup.robot)
    fresh.step(1.05 * rest, [], 0.02, down=down)
    np.testing.assert_array_equal(rolling.balls(posture), fresh.balls(posture))
    assert np.abs(np.array(rolling.balls(posture)) - balls).max() > 1e-4
    points = FootRolling(point_feet("strider"))
    points.step(rest, [], 0.02, down=down)
    assert not points.started


def test_odometry_knows_that_balls_roll():
    robot, speed, dt = preset("makeyourpet"), 0.02, 0.02
    rolling, sliding = LegOdometry(robot), LegOdometry(point_feet("makeyourpet"))
    w = WalkController(robot)
    feet, angles, position = w.feet, w.angles, w.body.position
    commanded = CommandedMotion(velocity=1j * speed, moved=1j * speed * dt, turned=0.0, yaw=0.0)
    for _ in range(40):
        for odometry in (rolling, sliding):
            odometry.step(ValidReadings(joint_angles=angles.tolist()), range(6), commanded, dt)
        # The body moves sideways over feet that roll.
        position = position + np.array([0, speed * dt, 0])
        before, step = angles, np.zeros((6, 3))
        for _pass in range(4):
            angles = np.asarray(inverse_kinematics(robot, feet + step - position).angles)
            both = Pose(np.stack([np.eye(3)] * 2), np.stack([position] * 2))
            step = rolling_displacements(robot, np.stack([before, angles]), both)[0]
        feet = feet + step
    assert abs(rolling.behind) < 3e-5
    assert sliding.behind.imag > 3e-4


@pytest.mark.parametrize("kind", ["straight", "sideways"])
def test_a_simulated_robot_walks_the_commanded_way(kind):
    robot, dt = preset("makeyourpet"), 0.01
    _, twist = walking(robot, "tripod", TWISTS[kind], 0.6)
    controller = RobotController(robot, Gait.named("tripod"))
    plant, out = SimulatedPlant(robot, servos="ideal", sensors="blind"), controller.output
    plant.start(out)
    for tick in range(500):
        if tick == 50:
            start, asked = plant.state.body.position, out.body.position
        out = controller.step(Command(twist=tuple(twist) if 50 <= tick < 350 else (0, 0, 0)), dt, plant.step(out, dt))
    way = np.linalg.norm((plant.state.body.position - start)[:2])
    assert way / np.linalg.norm((out.body.position - asked)[:2]) == pytest.approx(1.0, abs=0.01)


@settings(deadline=None, max_examples=50)
@given(seeds())
def test_balls_roll_from_the_inclination_of_the_tibia_at_rest(seed):
    rng = np.random.default_rng(seed)
    sizes = {
        name: size * rng.uniform(0.9, 1.1, 6) for name, size in {"coxa": 0.07, "femur": 0.1, "tibia": 0.18}.items()
    }
    offset, radius = rng.uniform(-0.01, 0.01, (6, 2)), rng.uniform(0.0, 0.03, 6)
    limits = np.tile(FULL_TURN, (6, 1, 1))
    robot = plain_hexapod(**sizes, femur_axis_offset=offset, foot_radius=radius, limits=limits)
    x, y, z, roll, pitch, yaw = rng.uniform(-1, 1, 6) * (0.02, 0.02, 0.02, 0.1, 0.1, 0.1) + (0, 0, 0.14, 0, 0, 0)
    rest = rng.uniform(0.22, 0.28, 6) * np.exp(1j * (robot.mount_yaw + rng.uniform(-0.3, 0.3, 6)))
    rolling, pose = FootRolling(robot), Pose.from_rpy(roll, pitch, yaw, (x, y, z))
    posture = np.array([x, y, z, roll, pitch, yaw, 0.03])
    rolling.step(rest, [], 0.02, down=np.ones(6, dtype=bool))
    feet = np.stack([rest.real, rest.imag, np.zeros(6)], axis=-1)
    coxa, femur, tibia = np.moveaxis(inverse_kinematics(robot, feet, pose).require().angles, -1, 0)
    legs = np.stack([np.cos(robot.mount_yaw + coxa), np.sin(robot.mount_yaw + coxa), np.zeros(6)], axis=-1)
    at_rest = radius * (femur + tibia + legs @ pose.rotation[2])
    np.testing.assert_allclose(rolling.balls(posture), np.stack([radius, at_rest], axis=-1), atol=1e-12)
    rows = [tuple(row) for row in pose.rotation.tolist()]
    feet_at = [tuple(foot) for foot in feet.tolist()]
    found = rolling.rolled(feet_at, [0.0] * 6, (tuple(rows), (x, y, z)), posture=posture)
    np.testing.assert_allclose(found, feet, atol=1e-14)
