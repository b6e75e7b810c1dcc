import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings

from robots import plain_hexapod, random_angles, random_robot, seeds
from tarsus.errors import InputError
from tarsus.kinematics.body import coxa_frames, reachable_fraction
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.robot.robot import stack_robots


@given(seed=seeds())
def test_coxa_frames_stand_on_the_coxa_axes_with_x_outward(seed):
    rng = np.random.default_rng(seed)
    robot = random_robot(rng)
    frames = coxa_frames(robot)
    assert frames.batch_shape == (6,)
    level = np.zeros((6, 3))
    points = forward_kinematics(robot, level)
    assert np.array_equal(frames.position, points[:, 0])
    own = np.zeros((6, 3))
    own[:, 0] = robot.coxa + robot.femur + robot.tibia
    own[:, 1:] = robot.femur_axis_offset
    assert np.abs(frames @ own - points[:, 3]).max() <= 1e-15
    assert np.abs(frames.inverse() @ points[:, 3] - own).max() <= 1e-15
    assert np.array_equal(frames.rotation[:, 2], np.tile([0, 0, 1.0], (6, 1)))


def test_coxa_frames_of_many_designs_and_of_other_libraries():
    rng = np.random.default_rng(1)
    designs = [random_robot(rng) for _ in range(3)]
    frames = coxa_frames(stack_robots(designs))
    assert frames.batch_shape == (3, 6)
    for i, design in enumerate(designs):
        assert np.array_equal(frames[i].rotation, coxa_frames(design).rotation)
    traced = coxa_frames(designs[0].replace(mount_yaw=jnp.asarray(designs[0].mount_yaw)))
    assert np.abs(np.asarray(traced.rotation) - frames[0].rotation).max() <= 1e-15


STANDING = np.tile([0.0, 0.5, -1.5], (6, 1))


def standing(robot, height=0.1):
    """Feet on the ground under a level body, and that body."""
    feet = forward_kinematics(robot, STANDING)[:, 3]
    body = Pose(np.eye(3), [0, 0, -feet[0, 2]])
    return body @ feet, body


@settings(max_examples=25)
@given(seed=seeds())
def test_the_fraction_is_where_a_foot_first_becomes_unreachable(seed):
    rng = np.random.default_rng(seed)
    robot = plain_hexapod()
    feet, start = standing(robot)
    goal = Pose.from_rpy(*rng.uniform(-0.5, 0.5, 3), start.position + rng.uniform(-0.15, 0.15, 3))
    share = reachable_fraction(robot, feet, start, goal)

    def between(shares):
        shares = np.asarray(shares)
        rpy = np.outer(shares, goal.rpy)
        position = start.position + np.outer(shares, goal.position - start.position)
        return inverse_kinematics(robot, feet, Pose.from_rpy(*rpy.T, position)).ok

    assert 0 < share <= 1
    assert between(np.linspace(0, share, 1000)).all()
    if share < 1:
        assert not between([min(share + 1e-9, 1.0)]).any()


def test_the_fraction_is_0_or_1_at_the_extremes():
    robot = plain_hexapod()
    feet, start = standing(robot)
    higher = Pose(np.eye(3), start.position + np.array([0, 0, 0.01]))
    far = Pose(np.eye(3), [5, 0, 0.1])
    assert reachable_fraction(robot, feet, start, higher) == 1.0
    assert reachable_fraction(robot, feet, start, start) == 1.0
    assert reachable_fraction(robot, feet, far, start) == 0.0
    assert 0 < reachable_fraction(robot, feet, start, far) < 0.1


def test_upwards_the_fraction_is_that_of_the_straight_leg():
    robot = plain_hexapod(limits=np.tile([[-2, 2], [-1.5, 1.5], [-3, 0]], (6, 1, 1)))
    feet, start = standing(robot)
    out = np.hypot(*feet[0, :2]) - 0.086 - 0.068
    highest = np.sqrt((0.098 + 0.181) ** 2 - out**2)
    goal = Pose(np.eye(3), [0, 0, 1.0])
    share = reachable_fraction(robot, feet, start, goal)
    assert abs(start.position[2] + share * (1 - start.position[2]) - highest) <= 1e-12


def test_angles_change_in_the_shorter_direction():
    robot = plain_hexapod()
    feet, level = standing(robot)
    start, goal = Pose.from_rpy(yaw=3.1, position=level.position), Pose.from_rpy(yaw=-3.1, position=level.position)
    feet = Pose.from_rpy(yaw=3.1) @ feet
    assert reachable_fraction(robot, feet, start, goal) == 1.0


def test_a_start_on_the_edge_of_the_workspace():
    """The start's own matrix and the one from its angles differ by rounding; neither gives more than the way allows."""
    robot = plain_hexapod()
    q = random_angles(np.random.default_rng(2), robot)
    q[:, 1] = robot.limits[:, 1, 1]
    start = Pose.from_rpy(0.1, 0.2, 0.3, [0, 0, 1])
    goal = Pose.from_rpy(0.1, 0.2, 0.3, [0, 0, 0.5])
    assert reachable_fraction(robot, start @ forward_kinematics(robot, q)[:, 3], start, goal) <= 1e-6


@pytest.mark.parametrize("wrong", ["robot", "feet", "start", "goal"])
def test_batches_are_refused(wrong):
    robot = plain_hexapod()
    feet, start = standing(robot)
    poses = Pose(np.eye(3), np.zeros((2, 3)))
    given_ = {"robot": robot, "feet": feet, "start": start, "goal": start}
    given_ |= {wrong: {"robot": stack_robots([robot] * 2), "feet": feet[None], "start": poses, "goal": poses}[wrong]}
    with pytest.raises(InputError, match="a single robot, feet of shape \\(legs, 3\\) and single poses"):
        reachable_fraction(**given_)


def test_invalid_feet_are_refused():
    robot = plain_hexapod()
    with pytest.raises(InputError, match=r"feet has shape \(5, 3\)"):
        reachable_fraction(robot, np.zeros((5, 3)), Pose(), Pose())
