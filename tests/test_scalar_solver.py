"""Scalar inverse kinematics against the array version."""

import numpy as np
import pytest

from tarsus import Pose, default_stance, forward_kinematics, inverse_kinematics, list_robots, load_robot
from tarsus.kinematics.scalar_solver import ScalarSolver

UP = np.array([0, 0, 1.0])


@pytest.mark.parametrize("name", list_robots()[::2])
def test_it_agrees_with_the_array_version(name):
    robot = load_robot(name)
    quick, rng = ScalarSolver(robot), np.random.default_rng(1)
    stance = default_stance(robot)
    solved = rejected = 0
    for _ in range(400):
        feet = stance + rng.normal(size=stance.shape) * 0.04
        body = Pose.from_rpy(*rng.normal(size=3) * 0.1, rng.normal(size=3) * 0.02)
        feet_up = feet + UP
        expected = inverse_kinematics(robot, body.inverse() @ feet)
        found = quick.angles(feet_up.tolist(), body.rotation.tolist(), (body.position + UP).tolist())
        if found is not None:
            solved += 1
            assert expected.ok.all()
            np.testing.assert_allclose(found, expected.angles, atol=1e-9)
        else:
            rejected += 1
            # Cases at the bounds are left to the array version.
            plain = np.isclose(expected.angles, robot.limits[..., 0]) | np.isclose(
                expected.angles, robot.limits[..., 1]
            )
            assert not expected.ok.all() or plain.any() or not _plain(robot, body, feet)
    assert solved > 20
    assert rejected > 20


def _plain(robot, body, feet):
    """Whether every foot is in front of its coxa axis."""
    seen = body.inverse() @ feet
    out = (seen - robot.mount_position)[:, :2]
    heading = np.stack([np.cos(robot.mount_yaw), np.sin(robot.mount_yaw)], -1)
    return bool(((out * heading).sum(-1) > 0).all())


def test_a_foot_within_the_sideways_offset_has_no_solution():
    robot = load_robot("strider").replace(femur_axis_offset=np.tile([0.05, 0.0], (6, 1)))
    axis = np.asarray(robot.mount_position) + np.array([0.01, 0, -0.1])
    assert ScalarSolver(robot).angles(axis.tolist(), np.eye(3).tolist(), (0.0, 0.0, 0.0)) is None


def test_feet_too_near_or_too_far_have_no_solution():
    robot = load_robot("strider")
    feet = default_stance(robot)
    for scale in (3.0, 0.4):
        assert ScalarSolver(robot).angles((feet * scale).tolist(), np.eye(3).tolist(), (0.0, 0.0, 0.0)) is None


@pytest.mark.parametrize("name", ["strider", "phantomx"])
def test_feet_are_those_of_the_forward_kinematics(name):
    robot, rng = load_robot(name), np.random.default_rng(2)
    angles = rng.uniform(robot.limits[..., 0], robot.limits[..., 1])
    body = Pose.from_rpy(0.1, -0.2, 0.7, (0.3, -0.2, 0.1))
    found = ScalarSolver(robot).feet(angles.tolist(), body.rotation.tolist(), body.position.tolist())
    np.testing.assert_allclose(found, body @ forward_kinematics(robot, angles)[..., 3, :], atol=1e-12)
