"""The angles of real robots come back from the positions of their feet, up to the straight and the folded leg."""

import numpy as np
import pytest

import tarsus

SAMPLES = 2000


def preset_without_limits(name):
    """The singular legs are beyond the limits of most joints: here every joint turns all the way."""
    robot = tarsus.load_robot(name)
    limits = np.array(robot.limits)
    limits[:, 1:] = [-np.pi, np.pi]
    return robot.replace(limits=limits)


def off_and_ahead(robot, q):
    """How far the angles that come back are off, and how far the foot is in front of the coxa axis."""
    solution = tarsus.inverse_kinematics(robot, tarsus.forward_kinematics(robot, q)[..., 3, :])
    assert (solution.reach == 0).all()
    off = np.abs((solution.angles - q + np.pi) % (2 * np.pi) - np.pi).max(-1)
    g = robot.geometry
    return off, g.coxa + g.femur * np.cos(q[..., 1]) + g.tibia * np.cos(q[..., 1] + q[..., 2])


def random_angles(robot, rng, tibia):
    q = np.empty((SAMPLES, robot.legs, 3))
    low, high = robot.limits[:, 0, 0], robot.limits[:, 0, 1]
    q[..., 0] = rng.uniform(low, high, q.shape[:-1])
    q[..., 1] = rng.uniform(-1.0, 1.0, q.shape[:-1])
    q[..., 2] = tibia
    return q


@pytest.mark.parametrize("name", tarsus.list_robots())
def test_angles_of_a_bent_leg_are_reproduced_to_1e_10(name):
    rng = np.random.default_rng(1)
    robot = preset_without_limits(name)
    off, ahead = off_and_ahead(robot, random_angles(robot, rng, -rng.uniform(1e-3, 2.0, (SAMPLES, robot.legs))))
    assert (ahead > 1e-3).mean() > 0.9
    assert off[ahead > 1e-3].max() <= 1e-10


@pytest.mark.parametrize("name", tarsus.list_robots())
def test_angles_near_the_straight_leg_are_reproduced_to_1e_7(name):
    rng = np.random.default_rng(2)
    robot = preset_without_limits(name)
    bend = 10.0 ** rng.uniform(-9, -3, (SAMPLES, robot.legs))
    off, ahead = off_and_ahead(robot, random_angles(robot, rng, -bend))
    assert (ahead > 1e-3).all()
    assert off.max() <= 1e-7


@pytest.mark.parametrize("name", sorted(set(tarsus.list_robots()) - {"ch3r", "mithi"}))
def test_angles_near_the_folded_leg_are_reproduced_to_1e_7(name):
    """Folded, ch3r's foot is behind the coxa axis and mithi's on the femur axis: there no position tells the angles."""
    rng = np.random.default_rng(3)
    robot = preset_without_limits(name)
    bend = 10.0 ** rng.uniform(-9, -3, (SAMPLES, robot.legs))
    q = random_angles(robot, rng, bend - np.pi)
    g = robot.geometry
    ahead = g.coxa + g.femur * np.cos(q[..., 1]) + g.tibia * np.cos(q[..., 1] + q[..., 2]) > 5e-3
    assert ahead.mean() > 0.1
    q[..., 1] = np.where(ahead, q[..., 1], np.pi / 2)
    off, _ = off_and_ahead(robot, q)
    assert off[ahead].max() <= 1e-7
