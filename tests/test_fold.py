"""The folded pose, ways through the air, and what falls when joints are released."""

import numpy as np
import pytest

from gait_robots import PRESETS, preset, ring
from tarsus.control.startup.folded_pose import belly_depth, folded_pose, legs_apart
from tarsus.control.startup.leg_path import LegFreeSpace
from tarsus.control.startup.planner import fold, sit_down
from tarsus.control.startup.power_off import power_off_order
from tarsus.errors import InputError, TarsusError
from tarsus.gait.setup import default_swing_height
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.rest import resting_pose
from tarsus.kinematics.stance import default_stance
from tarsus.robot.robot import stack_robots


@pytest.mark.parametrize("name", PRESETS)
def test_folded_it_lies_on_its_belly_with_its_legs_drawn_in(name):
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
    assert legs_apart(robot, angles) > 2 * robot.foot_radius.max() + 0.005
    points = forward_kinematics(robot, angles)
    standing = default_stance(robot, swing_height=default_swing_height(robot))
    out, stance_out = (np.linalg.norm((p - robot.mount_position)[:, :2], axis=-1) for p in (points[:, 3], standing))
    assert (out <= stance_out).all()
    assert not angles.flags.writeable


def test_feet_that_cannot_rise_to_the_belly_stay_as_little_below_it_as_they_can():
    robot = ring(6, limits=np.broadcast_to([[-1.0, 1.0], [-1.2, -0.6], [-0.4, 0.0]], (6, 3, 2)))
    angles = folded_pose(robot)
    feet = forward_kinematics(robot, angles)[:, 3, 2]
    # Femur and tibia at their highest, but for what they keep from their limits.
    highest = 0.08 * np.sin(-0.6) + 0.12 * np.sin(-0.6)
    assert (feet <= highest).all()
    assert (feet > highest - 0.02).all()


def towards_each_other(**changes):
    """A ring of six, two of whose legs point at each other so that drawn in as usual they would cross."""
    robot = ring(6)
    return robot.replace(mount_yaw=robot.mount_yaw + np.array([0, 1.1, -1.1, 0, 0, 0]), **changes)


def test_legs_that_would_touch_are_folded_another_way():
    robot = towards_each_other()
    assert legs_apart(robot, folded_pose(ring(6))) < 0.001
    assert legs_apart(robot, folded_pose(robot)) >= 0.005


def test_legs_that_cannot_be_clear_of_each_other_are_as_clear_as_they_get():
    thick = towards_each_other(foot_radius=np.full(6, 0.1))
    assert 0.005 < legs_apart(thick, folded_pose(thick)) < 0.2


def test_a_tibia_does_not_fold_into_the_box():
    robot = preset("strider").replace(body_size=np.array([0.5, 0.5, 0.05]))
    points = forward_kinematics(robot, folded_pose(robot))
    share = np.linspace(0, 1, 50)[:, None, None]
    tibia = points[:, 2] + share * (points[:, 3] - points[:, 2])
    assert not (np.abs(tibia) < robot.body_size / 2).all(-1).any()


def test_a_box_that_takes_all_the_room_is_folded_over():
    """Where no pose keeps clear of the body, folding does what it can."""
    robot = preset("strider").replace(body_size=np.array([2.0, 2.0, 1.0]))
    assert np.isfinite(folded_pose(robot)).all()


def test_a_batch_has_no_folded_pose():
    with pytest.raises(InputError, match=r"single robot, not a batch \(2,\)"):
        folded_pose(stack_robots([preset("strider"), preset("strider")]))


def test_a_way_through_the_air_has_no_point_in_the_ground():
    rng = np.random.default_rng(0)
    robot = preset("phoenix")
    low, high = robot.limits[2, :, 0], robot.limits[2, :, 1]
    direct = around = 0
    for _ in range(40):
        body = Pose.from_rpy(*rng.uniform(-0.15, 0.15, 2), 0.0, (0.0, 0.0, 0.06))
        space = LegFreeSpace.of(robot, 2, body)
        ends = rng.uniform(low, high, (400, 3))
        start, end = ends[space.lowest(ends) > 0][:2]
        way = space.route(start, end)
        if way is None:
            continue
        direct, around = direct + (len(way) == 1), around + (len(way) > 1)
        np.testing.assert_array_equal(way[-1], end)
        for a, b in zip((start, *way[:-1]), way, strict=True):
            angles = np.zeros((200, 6, 3))
            angles[:, 2] = a + np.linspace(0, 1, 200)[:, None] * (b - a)
            heights = (body @ forward_kinematics(robot, angles)[:, 2])[:, 2:, 2]
            assert heights.min() > -1e-4  # a tenth of a millimetre, between two looks
            assert (angles[:, 2] >= low - 1e-12).all()
            assert (angles[:, 2] <= high + 1e-12).all()
    assert min(direct, around) >= 5


def test_where_there_is_no_way_through_the_air_it_says_so():
    """The leg under a low body: knee down on one side, there is no room to bring it to the other."""
    robot = preset("strider")
    space = LegFreeSpace.of(robot, 0, Pose(position=np.array([0, 0, 0.06])))
    start, end = np.deg2rad([0.0, 30.0, -159.0]), np.deg2rad([0.0, 60.0, -60.0])
    assert space.lowest(end) > 0
    assert space.route(np.array([0.0, -0.9, -2.2]), end) is None
    assert LegFreeSpace.of(robot, 0, Pose(position=np.array([0, 0, -0.5]))).route(start, end) is None


def test_released_in_order_nothing_falls_but_the_knees():
    robot = preset("strider")
    sitting = sit_down(robot).angles_end
    off = power_off_order(robot, sitting)
    assert off.order == tuple((leg, joint) for joint in range(3) for leg in range(6))
    np.testing.assert_array_equal(off.drop[:, 0], 0)
    np.testing.assert_allclose(off.drop[:, 1], 0, atol=2e-3)
    points = resting_pose(robot, sitting).body @ forward_kinematics(robot, sitting)
    np.testing.assert_allclose(off.drop[:, 2], points[:, 2, 2], atol=3e-3)
    assert off.falls[0] == f"front left: with the tibia released, the knee falls {off.drop[0, 2] * 1000:.0f} mm"
    assert len(off.falls) == 6


def test_folded_the_feet_fall_to_the_ground_first():
    robot = preset("strider")
    off = power_off_order(robot, folded_pose(robot))
    points = resting_pose(robot, folded_pose(robot)).body @ forward_kinematics(robot, folded_pose(robot))
    np.testing.assert_allclose(off.drop[:, 1], points[:, 3, 2], atol=2e-3)
    assert "with the femur released, the foot falls" in off.falls[0]


def test_what_stands_must_not_be_released():
    robot = preset("strider")
    stance = inverse_kinematics(robot, default_stance(robot, swing_height=0.03)).angles
    with pytest.raises(TarsusError, match=r"85.0 mm higher .* only so can it have its joints released"):
        power_off_order(robot, stance)


def test_folding_what_is_folded_takes_no_time():
    robot = preset("mithi")
    assert fold(robot, folded_pose(robot)).duration == 0
