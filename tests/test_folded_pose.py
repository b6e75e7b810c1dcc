"""The folded pose, paths of legs through the air, and the order of switching the joints off."""

import numpy as np
import pytest

from gait_robots import PRESETS, preset, ring
from tarsus.control.startup import fold, sit_down
from tarsus.control.startup.power_off import power_off_order
from tarsus.errors import InputError, TarsusError
from tarsus.kinematics.folded_pose import folded_pose, leg_clearance
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.leg_path import LegFreeSpace
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.rest import resting_pose
from tarsus.kinematics.stance import default_stance, default_swing_height
from tarsus.kinematics.underside import belly_depth
from tarsus.robot.robot import stack_robots


@pytest.mark.parametrize("name", PRESETS)
def test_in_the_folded_pose_the_belly_is_on_the_ground(name):
    robot = preset(name)
    angles = folded_pose(robot)
    low, high = robot.limits[..., 0], robot.limits[..., 1]
    assert ((angles >= low) & (angles <= high)).all()
    rest = resting_pose(robot, angles)
    assert rest.stable
    assert not rest.contacts.any()
    assert not rest.leg_points_down[:, 2].any()
    np.testing.assert_allclose(rest.body.rotation, np.eye(3), atol=1e-12)
    assert rest.body.position[2] == pytest.approx(belly_depth(robot), abs=1e-12)
    assert leg_clearance(robot, angles) > 2 * robot.foot_radius.max() + 0.005
    points = forward_kinematics(robot, angles)
    standing = default_stance(robot, swing_height=default_swing_height(robot))
    out, stance_out = (np.linalg.norm((p - robot.mount_position)[:, :2], axis=-1) for p in (points[:, 3], standing))
    assert (out <= stance_out).all()
    assert not angles.flags.writeable


def test_feet_that_cannot_be_raised_to_the_belly_are_as_high_as_possible():
    robot = ring(6, limits=np.broadcast_to([[-1.0, 1.0], [-1.2, -0.6], [-0.4, 0.0]], (6, 3, 2)))
    angles = folded_pose(robot)
    feet = forward_kinematics(robot, angles)[:, 3, 2]
    # Femur and tibia at their upper limits, without the inset.
    highest = 0.08 * np.sin(-0.6) + 0.12 * np.sin(-0.6)
    assert (feet <= highest).all()
    assert (feet > highest - 0.02).all()


def converging_legs(**changes):
    """A ring of six with two legs that would cross in the usual folded pose."""
    robot = ring(6)
    return robot.replace(mount_yaw=robot.mount_yaw + np.array([0, 1.1, -1.1, 0, 0, 0]), **changes)


def test_legs_that_would_collide_are_folded_differently():
    robot = converging_legs()
    assert leg_clearance(robot, folded_pose(ring(6))) < 0.001
    assert leg_clearance(robot, folded_pose(robot)) >= 0.005


def test_legs_that_cannot_be_clear_have_the_greatest_clearance():
    thick = converging_legs(foot_radius=np.full(6, 0.1))
    assert 0.005 < leg_clearance(thick, folded_pose(thick)) < 0.2


def test_no_tibia_is_inside_the_body():
    robot = preset("strider").replace(body_size=np.array([0.5, 0.5, 0.05]))
    points = forward_kinematics(robot, folded_pose(robot))
    fractions = np.linspace(0, 1, 50)[:, None, None]
    tibia = points[:, 2] + fractions * (points[:, 3] - points[:, 2])
    assert not (np.abs(tibia) < robot.body_size / 2).all(-1).any()


def test_a_body_that_no_pose_avoids_is_folded_over():
    robot = preset("strider").replace(body_size=np.array([2.0, 2.0, 1.0]))
    assert np.isfinite(folded_pose(robot)).all()


def test_a_batch_is_rejected():
    with pytest.raises(InputError, match=r"single robot, not a batch \(2,\)"):
        folded_pose(stack_robots([preset("strider"), preset("strider")]))


def test_a_path_has_no_point_below_the_ground():
    rng = np.random.default_rng(0)
    robot = preset("phoenix")
    low, high = robot.limits[2, :, 0], robot.limits[2, :, 1]
    direct = around = 0
    for _ in range(40):
        body = Pose.from_rpy(*rng.uniform(-0.15, 0.15, 2), 0.0, (0.0, 0.0, 0.06))
        space = LegFreeSpace.of(robot, 2, body)
        ends = rng.uniform(low, high, (400, 3))
        start, end = ends[space.heights(ends).min(-1) > 0][:2]
        path = space.find_path(start, end)
        if path is None:
            continue
        direct, around = direct + (len(path) == 1), around + (len(path) > 1)
        np.testing.assert_array_equal(path[-1], end)
        for a, b in zip((start, *path[:-1]), path, strict=True):
            angles = np.zeros((200, 6, 3))
            angles[:, 2] = a + np.linspace(0, 1, 200)[:, None] * (b - a)
            heights = (body @ forward_kinematics(robot, angles)[:, 2])[:, 2:, 2]
            assert heights.min() > -1e-4  # between two evaluated points
            assert (angles[:, 2] >= low - 1e-12).all()
            assert (angles[:, 2] <= high + 1e-12).all()
    assert min(direct, around) >= 5


def test_without_a_free_path_it_returns_none():
    """The leg is under a low body, without enough height to move it to the other side."""
    robot = preset("strider")
    space = LegFreeSpace.of(robot, 0, Pose(position=np.array([0, 0, 0.06])))
    start, end = np.deg2rad([0.0, 30.0, -159.0]), np.deg2rad([0.0, 60.0, -60.0])
    assert space.heights(end).min() > 0
    assert space.find_path(np.array([0.0, -0.9, -2.2]), end) is None
    assert LegFreeSpace.of(robot, 0, Pose(position=np.array([0, 0, -0.5]))).find_path(start, end) is None


def test_with_the_joints_off_only_the_knees_drop():
    robot = preset("strider")
    sitting = sit_down(robot).angles_end
    off = power_off_order(robot, sitting)
    assert off.order == tuple((leg, joint) for joint in range(3) for leg in range(6))
    np.testing.assert_array_equal(off.drop[:, 0], 0)
    np.testing.assert_allclose(off.drop[:, 1], 0, atol=2e-3)
    points = resting_pose(robot, sitting).body @ forward_kinematics(robot, sitting)
    # The knee is a point that sinks to the plane of the feet's centres.
    np.testing.assert_allclose(off.drop[:, 2], points[:, 2, 2] - robot.foot_radius, atol=3e-3)
    assert off.falls[0] == f"front left: with the tibia off, the knee drops by {off.drop[0, 2] * 1000:.0f} mm"
    assert len(off.falls) == 6


def test_in_the_folded_pose_the_feet_drop_first():
    robot = preset("strider")
    off = power_off_order(robot, folded_pose(robot))
    points = resting_pose(robot, folded_pose(robot)).body @ forward_kinematics(robot, folded_pose(robot))
    np.testing.assert_allclose(off.drop[:, 1], points[:, 3, 2] - robot.foot_radius, atol=2e-3)
    assert "with the femur off, the foot drops by" in off.falls[0]


def test_a_standing_robot_is_not_switched_off():
    robot = preset("strider")
    stance = inverse_kinematics(robot, default_stance(robot, swing_height=0.03)).angles
    with pytest.raises(TarsusError, match=r"93.0 mm higher .* switching its joints off requires"):
        power_off_order(robot, stance)


def test_a_folded_robot_needs_no_motion():
    robot = preset("mithi")
    assert fold(robot, folded_pose(robot)).duration == 0
