"""The depth of the body below the floor under the feet."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from gait_robots import preset, ring
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.rest import CORNERS
from tarsus.kinematics.underside import floor_depth, too_low_text
from tarsus.robot.robot import stack_robots


def poses(n):
    rng = np.random.default_rng(1)
    roll, pitch, yaw = rng.uniform(-0.8, 0.8, (3, n))
    return Pose.from_rpy(roll, pitch, yaw, rng.uniform(-0.1, 0.1, (n, 3)))


def test_a_level_body_reaches_half_its_height_below_its_origin_and_the_floor_is_a_foot_radius_lower():
    strider = preset("strider")
    for height, depth in ((0.11, -0.093), (0.017, 0.0), (0.005, 0.012)):
        assert floor_depth(strider, Pose(position=(0.3, 0.1, height))) == pytest.approx(depth, abs=1e-15)


@pytest.mark.parametrize("box", [True, False])
def test_of_a_tilted_body_the_lowest_corner_or_coxa_axis_counts(box):
    robot = preset("strider")
    robot = robot if box else robot.replace(body_size=None)
    body = poses(20)
    corners = CORNERS * np.asarray(robot.body_size) if box else robot.mount_position
    lowest = (body @ np.broadcast_to(corners, (20, *corners.shape)))[..., 2].min(-1)
    np.testing.assert_allclose(floor_depth(robot, body), -0.008 - lowest, atol=1e-15)


def test_of_different_feet_the_smallest_ball_counts():
    robot = ring(6).replace(foot_radius=np.array([0.0, 0.01, 0.01, 0.002, 0.01, 0.01]))
    for radii in (robot.foot_radius, robot.foot_radius + 0.003):
        assert floor_depth(robot.replace(foot_radius=radii), Pose()) == pytest.approx(-radii.min())


def test_designs_and_poses_broadcast():
    strider, phantomx = preset("strider"), preset("phantomx")
    both, body = stack_robots([strider, phantomx]), poses(3)
    found = floor_depth(both, Pose(body.rotation[:, None], body.position[:, None]))
    np.testing.assert_allclose(found, np.stack([floor_depth(strider, body), floor_depth(phantomx, body)], axis=-1))


def test_the_gradient_is_that_of_a_lower_body():
    def depth(height):
        return floor_depth(preset("strider"), Pose(position=jnp.stack([0.0, 0.0, height])))

    value, slope = jax.jit(jax.value_and_grad(depth))(0.005)
    assert (float(value), float(slope)) == (pytest.approx(0.012, abs=1e-9), -1.0)


def test_the_body_height_needed_is_rounded_up():
    assert too_low_text(0.012, 0.005) == "12.0 mm below the ground; a body height of at least 17.0 mm is needed"
    assert too_low_text(0.01204, 0.005).endswith("at least 17.1 mm is needed")
