"""Foot workspaces against the public kinematics and against brute force."""

import itertools

import numpy as np
import pytest
from scipy.spatial import HalfspaceIntersection

from gait_robots import PRESETS, ring
from sample_stances import POSTURES, feet_at, polygon_radii, polygons, pose_of, setup_of, standing
from tarsus.control.workspace.foot_workspace import foot_workspace
from tarsus.gait.foot_polygons import NORMALS, polygon_ends, polygon_margin
from tarsus.gait.stance.stance_geometry import joint_margin
from tarsus.incremental import complete
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.leg import forward_kinematics

every_stand = pytest.mark.parametrize(("name", "body"), list(itertools.product(PRESETS, POSTURES)))


def corners_of(bounds, inside):
    """Corners of each polygon by Qhull's half-space intersection."""
    planes = np.stack([NORMALS.real, NORMALS.imag], axis=-1)
    found = []
    for sides, point in zip(bounds, inside, strict=True):
        crossing = HalfspaceIntersection(np.column_stack([planes, -sides]), np.array([point.real, point.imag]))
        found.append(crossing.intersections @ [1, 1j])
    return found


def random_points(rng, corners, count):
    """Random points in triangles of corners, most of them near the edge ``(count, legs)``."""
    weights = rng.dirichlet(np.full(3, 0.3), size=(count, len(corners)))
    picked = np.stack([own[rng.integers(0, len(own), (count, 3))] for own in corners], axis=1)
    return (weights * picked).sum(axis=-1)


@every_stand
def test_every_point_of_a_polygon_is_reachable(name, body):
    setup, bounds = setup_of(name), polygons(name, body)
    stand = standing(setup, body)
    points = random_points(np.random.default_rng(7), corners_of(bounds, stand.rest), 1500)
    assert (polygon_margin(bounds, stand.rest) > 0).all()
    # On the ground anywhere; at half the lift and the whole, in a part of the polygon.
    for height, part in ((0.0, 1.0), (0.5, 0.9), (1.0, 0.4)):
        feet = feet_at(stand.rest + part * (points - stand.rest), height * stand.swing_height)
        found = inverse_kinematics(setup.robot, feet, pose_of(stand))
        assert found.ok.all(), found.explain()


@every_stand
def test_feet_in_neighbouring_polygons_keep_their_distance(name, body):
    setup = setup_of(name)
    corners = corners_of(polygons(name, body), standing(setup, body).rest)
    for one, other in itertools.combinations(corners, 2):
        # The nearest points of two convex sets that don't meet: a corner of one and an edge of the other.
        for points, edges in ((one, other), (other, one)):
            hull = edges[np.argsort(np.angle(edges - edges.mean()))]
            start, way = hull, np.roll(hull, -1) - hull
            along = ((points[:, None] - start) * way.conj()).real / np.maximum(np.abs(way) ** 2, 1e-30)
            nearest = start + np.clip(along, 0, 1) * way
            assert np.abs(points[:, None] - nearest).min() >= setup.foot_distance - 1e-9


@pytest.mark.parametrize("name", PRESETS)
def test_polygons_cover_most_of_the_reach_inwards_and_outwards(name):
    setup, bounds = setup_of(name), polygons(name)
    stand = standing(setup)
    mount = setup.robot.geometry.mount_x + 1j * setup.robot.geometry.mount_y
    out = np.exp(1j * np.angle(stand.rest - mount))
    tried = np.linspace(0, 0.4, 401)[:, None]
    for leg, sign in itertools.product(range(6), (1, -1)):
        found = inverse_kinematics(setup.robot, feet_at(stand.rest + sign * tried * out), pose_of(stand))
        reached = tried[np.argmin(found.reach == 0, axis=0)[leg], 0]
        allowed = polygon_radii(bounds, stand.rest, sign * out[leg : leg + 1])[leg, 0]
        # Inwards the leg folds, and its joints turn ever faster for the same speed of the foot.
        assert (0.75 if sign > 0 else 0.25) * reached <= allowed <= reached


def test_ends_of_the_sides_are_the_corners_that_qhull_finds():
    rng = np.random.default_rng(3)
    inside = rng.normal(size=20) + 1j * rng.normal(size=20)
    bounds = rng.uniform(0.02, 0.1, (20, 16)) + (NORMALS.conj() * inside[:, None]).real
    starts, ends = polygon_ends(bounds, inside)
    for leg, expected in enumerate(corners_of(bounds, inside)):
        for reached in (starts[leg], ends[leg]):
            found = reached[reached != 0] + inside[leg]
            away = np.abs(found[:, None] - expected)
            assert away.min(axis=0).max() < 1e-9
            assert away.min(axis=1).max() < 1e-9


def test_radii_end_on_the_nearest_side():
    bounds, inside = polygons("strider"), standing(setup_of("strider")).rest
    directions = np.exp(1j * np.linspace(0, 7, 50))
    edge = inside[:, None] + polygon_radii(bounds, inside, directions) * directions
    over = (edge[..., None] * NORMALS.conj()).real - bounds[:, None]
    np.testing.assert_allclose(over.max(axis=-1), 0, atol=1e-12)


def test_the_margin_of_a_point_outside_is_negative():
    bounds = np.full((1, 16), 0.1)
    np.testing.assert_allclose(polygon_margin(bounds, np.array([0.3 + 0j])).min(), -0.2)
    assert polygon_radii(bounds, np.array([0.3 + 0j]), NORMALS).min() == 0


def test_an_unreachable_rest_foothold_is_outside_its_polygon():
    setup = setup_of("strider")
    stand = standing(setup)
    away = stand._replace(rest=stand.rest * np.array([1, 1, 2.5, 1, 1, 1]))
    bounds = complete(foot_workspace(setup.robot, away, foot_distance=setup.foot_distance))
    room = polygon_margin(bounds, away.rest).min(axis=-1)
    assert room[2] < 0
    assert (np.delete(room, 2) > 0).all()


def test_feet_that_are_too_close_may_not_approach_further():
    setup = setup_of("strider")
    stand = standing(setup)
    between = np.abs(stand.rest[0] - stand.rest[1])
    bounds = complete(foot_workspace(setup.robot, stand, foot_distance=2 * between))
    way = (stand.rest[1] - stand.rest[0]) / between
    towards = polygon_radii(bounds, stand.rest, np.array([way, -way]))
    assert towards[0, 0] < 1e-9
    assert towards[1, 1] < 1e-9


def test_knees_stay_out_of_the_ground():
    setup = setup_of("mithi")
    stand = standing(setup, POSTURES[2])
    bounds = polygons("mithi", POSTURES[2])
    points = random_points(np.random.default_rng(1), corners_of(bounds, stand.rest), 500)
    angles = np.stack(stand.solve(setup.robot.geometry, points.real, points.imag, np.zeros(points.shape))[:3], axis=-1)
    knees = knee_heights(setup.robot, angles, stand)
    assert knees.min() > 0
    # Without looking at them, they would be.
    level = stand.position[2]
    assert level < 0.11


def knee_heights(robot, angles, stand):
    return (pose_of(stand) @ forward_kinematics(robot, angles)[..., 2, :])[..., 2]


@pytest.mark.parametrize("name", ["strider", "phantomx"])
def test_the_leg_margin_is_negative_where_inverse_kinematics_fails(name):
    setup = setup_of(name)
    stand, rng = standing(setup), np.random.default_rng(5)
    points = stand.rest + rng.uniform(-0.3, 0.3, (4000, 6)) + 1j * rng.uniform(-0.3, 0.3, (4000, 6))
    slack = joint_margin(
        setup.robot.geometry, stand.solve(setup.robot.geometry, points.real, points.imag, np.zeros(points.shape))
    )
    found = inverse_kinematics(setup.robot, (feet_at(points) - stand.position) @ stand.rotation)
    rejected = found.reach != 0
    assert rejected.any()
    assert (slack[rejected] < 0).all()
    # Positive slack keeps 0.01 rad from every limit.
    low, high = setup.robot.limits[..., 0], setup.robot.limits[..., 1]
    inside = np.minimum(found.angles - low, high - found.angles).min(axis=-1)
    assert (inside[slack >= 0] >= 0.01 - 1e-9).all()


def test_it_is_computed_incrementally():
    setup = setup_of("strider")
    assert sum(1 for _ in foot_workspace(setup.robot, standing(setup), foot_distance=0.02)) >= 6


def test_robots_of_any_number_of_legs_have_polygons():
    for legs, gait in ((4, "creep"), (5, "wave"), (8, "wave")):
        setup = setup_of(ring(legs), gait)
        stand = standing(setup)
        bounds = complete(foot_workspace(setup.robot, stand, foot_distance=setup.foot_distance))
        assert bounds.shape == (legs, 16)
        room = polygon_margin(bounds, stand.rest)
        assert (room > 0).all()
        # As like as the ring's legs are.
        np.testing.assert_allclose(room.sum(axis=-1), room.sum() / legs, rtol=0.1)
