import dataclasses
import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from gait_robots import HEXAPOD_GAITS, in_heading_frame, point_feet, preset, ring
from tarsus.gait.gait import Gait
from tarsus.gait.path import BodyPath, curved_path, straight_path
from tarsus.gait.plan import plan_walk
from tarsus.gait.stroke import max_stroke, unit_twist
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.rolling import rolling_displacements, tibia_rotations
from tarsus.kinematics.stance import default_stance, default_swing_height
from tarsus.simulation.truth.comparison import compare

BALLS = ("strider", "makeyourpet")
PATHS = {"ahead": straight_path(0.25), "aside": straight_path(0.2, 1.9), "turn": curved_path(-0.7)}


def tibiae(robot, motion):
    """Rotations of the tibiae in G, from the points of the legs alone."""
    points = motion.body.rotation[:, None, None] @ forward_kinematics(robot, motion.angles)[..., None]
    coxa, femur, knee, foot = np.moveaxis(points[..., 0], -2, 0)
    along = foot - knee
    # The femur axis is horizontal in B and across the leg's plane; a leg without offsets shows that plane.
    across = np.cross(femur - coxa, knee - femur)
    frame = np.stack([v / np.linalg.norm(v, axis=-1, keepdims=True) for v in (along, across)], axis=-1)
    return np.concatenate([frame, np.cross(frame[..., 0], frame[..., 1])[..., None]], axis=-1)


@pytest.mark.parametrize("path", PATHS)
@pytest.mark.parametrize("name", BALLS)
def test_the_point_of_the_ball_on_the_ground_is_at_rest(name, path):
    """The way of the material points that touch the ground, over whole stances, by SciPy's rotation vectors."""
    robot = preset(name)
    motion = plan_walk(robot, Gait.named("ripple"), PATHS[path], rate=200, body_tilt=(0.05, -0.04))
    rotation = tibiae(robot, motion)
    change = (rotation[1:] @ np.swapaxes(rotation[:-1], -1, -2)).reshape(-1, 3, 3)
    turns = Rotation.from_matrix(change).as_rotvec().reshape(-1, robot.legs, 3)
    centre = np.diff(motion.feet, axis=0)
    slide = (centre - np.cross(turns, [0.0, 0.0, 1.0]) * robot.foot_radius[:, None])[..., :2]
    standing = motion.contacts[1:] & motion.contacts[:-1]
    assert np.abs(np.where(standing[..., None], centre, 0)).max() > 1e-6
    assert np.abs(np.where(standing[..., None], slide, 0)).sum(0).max() < 5e-6


@pytest.mark.parametrize("name", BALLS)
def test_a_walk_on_balls_begins_and_ends_in_the_rest_stance_and_rolls_about_its_footholds(name):
    path = straight_path(0.5)
    on_balls, on_points = (plan_walk(r(name), Gait.named("tripod"), path, cycle_time=1.2) for r in (preset, point_feet))
    for moment in (0, -1):
        np.testing.assert_allclose(on_balls.feet[moment], on_points.feet[moment], atol=1e-9)
    apart = np.linalg.norm(on_balls.feet - on_points.feet, axis=-1)
    assert 0.0005 < apart.max() < 0.2 * float(np.max(preset(name).foot_radius)) + 0.001
    np.testing.assert_array_equal(on_balls.contacts, on_points.contacts)
    np.testing.assert_array_equal(on_balls.feet[..., 2], on_points.feet[..., 2])
    # Relative to the body the feet travel less: the balls roll on with it.
    ways = [np.ptp(in_heading_frame(motion)[..., 0], axis=0).mean() for motion in (on_balls, on_points)]
    assert 0.9 < ways[0] / ways[1] < 0.999


@pytest.mark.parametrize(("name", "gait"), list(zip([*BALLS, *BALLS], HEXAPOD_GAITS, strict=True)))
def test_default_walks_on_balls_are_possible(name, gait):
    for path in PATHS.values():
        assert plan_walk(preset(name), Gait.named(gait), path).ok


def test_a_stroke_at_the_border_of_the_workspace_is_walked_by_points():
    """As long as points can: the slip of the few millimetres that are missing is less than a shorter walk."""
    robot, tripod, turn = preset("makeyourpet"), Gait.named("tripod"), (0.0, 0.0, 1.0)
    longest = max_stroke(robot, tripod, turn)
    rest = default_stance(robot, swing_height=default_swing_height(robot))
    path = BodyPath(tuple(6 * longest * unit_twist(rest, turn)))
    motion = plan_walk(robot, tripod, path, stroke=0.999 * longest, cycle_time=1.0, rate=60)
    assert motion.reach.max() == 0
    both = motion.contacts[1:] & motion.contacts[:-1]
    way = np.linalg.norm(np.diff(motion.feet, axis=0), axis=-1)
    assert (np.where(both, way, 0).max(0) < 1e-12).any()


def test_a_ball_rolls_by_its_radius_times_the_tilt_and_does_not_move_by_its_spin():
    robot = ring(6, foot_radius=np.full(6, 0.01))
    angles = np.zeros((3, 6, 3))
    angles[1:, :, 2] = -0.01
    angles[2, :, 0] = 0.3
    moved = rolling_displacements(robot, angles, Pose.from_rpy([0, 0, 0], [0, 0, 0], [0, 0, 0], np.zeros((3, 3))))
    yaw = robot.mount_yaw
    np.testing.assert_allclose(
        moved[0], 1e-4 * np.stack([np.cos(yaw), np.sin(yaw), 0 * yaw], axis=-1), rtol=1e-4, atol=1e-15
    )
    np.testing.assert_allclose(moved[1], 0, atol=1e-15)


def test_orientations_of_tibiae_are_those_of_their_points():
    motion = plan_walk(preset("strider"), Gait.named("wave"), PATHS["turn"], body_tilt=(0.1, 0.07))
    found = tibia_rotations(motion.robot, motion.angles, motion.body)
    expected = tibiae(motion.robot, motion)
    np.testing.assert_allclose(found[..., 0], expected[..., 0], atol=1e-9)
    np.testing.assert_allclose(np.abs((found[..., 1] * expected[..., 1]).sum(-1)), 1, atol=1e-9)
    np.testing.assert_allclose(np.linalg.det(found), 1, atol=1e-12)


@pytest.mark.no_cover
@pytest.mark.parametrize(("name", "gait", "heading"), [("makeyourpet", "wave", math.pi / 2), ("strider", "wave", 0.0)])
def test_in_physics_the_way_is_that_of_the_plan(name, gait, heading):
    robot = preset(name)
    plan = plan_walk(robot, Gait.named(gait), straight_path(0.2, heading), rate=100.0)
    assert compare(plan, servos="ideal").outcome.way_ratio == pytest.approx(1.0, abs=0.01)
    # With footholds that stay in place the ball carries the body beyond its way.
    points = dataclasses.replace(
        plan_walk(point_feet(name), Gait.named(gait), straight_path(0.2, heading)), robot=robot
    )
    assert compare(points, servos="ideal").outcome.way_ratio > 1.01
