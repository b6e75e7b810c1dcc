import math

import array_api_strict
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm

from tarsus.errors import InputError
from tarsus.gait.path import (
    BodyPath,
    curved_path,
    exponential_map,
    ground_to_heading,
    heading_to_ground,
    straight_path,
    twist_path,
)

numbers = st.floats(-20, 20)
small = st.floats(-1e-6, 1e-6)
angles = st.one_of(st.floats(-15, 15), small, st.sampled_from([0.0, math.pi, -math.pi, 1e-12, 2 * math.pi]))


def se2(x, y, yaw):
    """The matrix of a twist of the plane."""
    return np.array([[0.0, -yaw, x], [yaw, 0.0, y], [0.0, 0.0, 0.0]])


def matrix(place):
    x, y, yaw = place
    return np.array([[math.cos(yaw), -math.sin(yaw), x], [math.sin(yaw), math.cos(yaw), y], [0, 0, 1]])


@given(numbers, numbers, angles, st.floats(-2, 3))
def test_exponential_map_is_the_matrix_exponential_of_the_twist(x, y, yaw, share):
    place = exponential_map((x, y, yaw), np.array(share))
    np.testing.assert_allclose(matrix(place), expm(share * se2(x, y, yaw)), atol=3e-12)
    assert place[2] == yaw * share


@given(numbers, numbers, angles)
def test_the_velocity_of_a_path_is_its_twist_in_the_heading_frame(x, y, yaw):
    path = BodyPath((x + 1, y, yaw))
    step = 1e-6
    before, here, after = path.planar_pose(np.array([0.4 - step, 0.4, 0.4 + step]))
    seen = np.linalg.inv(matrix(here)) @ ((matrix(after) - matrix(before)) / (2 * step))
    np.testing.assert_allclose(seen, se2(x + 1, y, yaw), atol=1e-4)


@given(numbers, numbers, angles, st.integers(0, 2**32 - 1))
def test_heading_to_ground_is_a_rigid_transform_and_ground_to_heading_its_inverse(x, y, yaw, seed):
    points = np.random.default_rng(seed).uniform(-1, 1, (4, 3))
    carried = heading_to_ground(np.array([x, y, yaw]), points)
    flat = np.column_stack([points[:, :2], np.ones(4)]) @ matrix((x, y, yaw)).T
    np.testing.assert_allclose(carried[:, :2], flat[:, :2], atol=1e-13)
    np.testing.assert_array_equal(carried[:, 2], points[:, 2])
    np.testing.assert_allclose(ground_to_heading(np.array([x, y, yaw]), carried), points, atol=1e-13)


def test_heading_to_ground_broadcasts_poses_and_points():
    rng = np.random.default_rng(1)
    places, points = rng.normal(size=(5, 1, 3)), rng.normal(size=(2, 6, 3))
    whole = heading_to_ground(places, points)
    assert whole.shape == (5, 2, 6, 3)
    for i in range(5):
        for j in range(2):
            np.testing.assert_array_equal(whole[i, j], heading_to_ground(places[i, 0], points[j]))
            np.testing.assert_array_equal(
                ground_to_heading(places, whole)[i, j],
                ground_to_heading(places[i, 0], heading_to_ground(places[i, 0], points[j])),
            )


@pytest.mark.parametrize("library", [jnp, array_api_strict], ids=["jax", "strict"])
def test_every_array_library_gives_the_same(library):
    rng = np.random.default_rng(2)
    shares, points = rng.uniform(-1, 1, 7), rng.normal(size=(7, 4, 3))
    for displacement in ((1.0, -2.0, 0.7), (1.0, -2.0, 0.0), (0.1, 0.2, 1e-9)):
        place = exponential_map(displacement, shares)
        other = exponential_map(displacement, library.asarray(shares))
        np.testing.assert_allclose(np.asarray(other), place, atol=1e-14)
        np.testing.assert_allclose(
            np.asarray(heading_to_ground(other, points)), heading_to_ground(place, points), atol=1e-14
        )
        np.testing.assert_allclose(
            np.asarray(ground_to_heading(other, points)), ground_to_heading(place, points), atol=1e-14
        )
        np.testing.assert_allclose(
            np.asarray(BodyPath(displacement).travel(library.asarray(points))),
            BodyPath(displacement).travel(points),
            atol=1e-13,
        )


@pytest.mark.parametrize("yaw", [0.0, 1e-9, 0.5, -3.0])
def test_derivatives_of_the_exponential_map_are_correct_at_any_angle(yaw):
    def place(twist):
        return exponential_map(twist, jnp.asarray(0.6))

    twist = jnp.asarray([0.3, -0.2, yaw])
    step = 1e-6
    differences = [(place(twist + step * e) - place(twist - step * e)) / (2 * step) for e in jnp.eye(3)]
    np.testing.assert_allclose(jax.jacobian(place)(twist).T, np.array(differences), atol=1e-9)


@given(st.floats(0.001, 30), st.floats(-7, 7))
def test_a_straight_path_has_its_distance_and_heading_without_turning(distance, heading):
    path = straight_path(distance, heading)
    x, y, yaw = path.planar_pose(np.array(1.0))
    assert math.hypot(x, y) == pytest.approx(distance, rel=1e-14)
    assert math.remainder(math.atan2(y, x) - heading, math.tau) == pytest.approx(0, abs=1e-12)
    assert yaw == 0
    np.testing.assert_allclose(path.travel(np.ones((3, 2))), distance, rtol=1e-14)


@given(st.floats(0.01, 12), st.sampled_from([-1, 1]), numbers, numbers, st.floats(0, 1))
def test_a_curved_path_keeps_its_distance_to_the_centre_and_turns_by_its_angle(angle, sign, x, y, share):
    path = curved_path(sign * angle, (x, y))
    place = path.planar_pose(np.array(share))
    assert math.dist(place[:2], (x, y)) == pytest.approx(math.hypot(x, y), abs=1e-11)
    assert place[2] == pytest.approx(sign * angle * share)
    assert path.angle == sign * angle
    seen = ground_to_heading(place, np.array([[x, y, 0.0]]))
    np.testing.assert_allclose(seen[0, :2], (x, y), atol=1e-11)


def test_turning_on_the_spot_is_a_curve_about_the_origin():
    np.testing.assert_array_equal(
        curved_path(1.2).planar_pose(np.array([0.0, 0.5, 1.0])), [[0, 0, 0], [0, 0, 0.6], [0, 0, 1.2]]
    )


def test_a_twist_path_has_its_twist_for_its_duration():
    path = twist_path(0.1, -0.05, 0.3, 4.0)
    assert path.displacement == pytest.approx((0.4, -0.2, 1.2))
    assert path.duration == 4.0
    # Euler's way along the twist, in many small steps
    place, n = np.eye(3), 40_000
    for _ in range(n):
        place = place @ (np.eye(3) + se2(0.1, -0.05, 0.3) * (4.0 / n))
    np.testing.assert_allclose(matrix(path.planar_pose(np.array(1.0))), place, atol=2e-5)


@given(numbers, numbers, angles, st.integers(0, 2**32 - 1))
def test_travel_is_the_length_of_the_foot_track_relative_to_the_body(x, y, yaw, seed):
    path = BodyPath((x + 0.5, y, yaw))
    feet = np.random.default_rng(seed).uniform(-0.3, 0.3, (6, 3))
    n = 2000
    track = ground_to_heading(path.planar_pose(np.linspace(0, 1, n + 1)), feet)
    length = np.linalg.norm(np.diff(track, axis=0), axis=-1).sum(0)
    np.testing.assert_allclose(path.travel(feet), length, rtol=1e-4, atol=1e-9)


@pytest.mark.parametrize(
    "values", [(math.nan, 0, 0), (0, math.inf, 0), (0, 0, -math.inf), (1.0, 2.0), (1.0, 2.0, 3.0, 4.0)]
)
def test_a_displacement_must_be_three_finite_numbers(values):
    with pytest.raises(InputError, match="must be three finite numbers"):
        BodyPath(values)


@pytest.mark.parametrize(
    "make", [lambda: straight_path(0.0), lambda: curved_path(0.0, (1, 2)), lambda: BodyPath((0, 0, 0))]
)
def test_a_path_without_length_is_refused(make):
    with pytest.raises(InputError, match="has no length"):
        make()


def test_arguments_that_are_not_finite_are_refused():
    for make in (
        lambda: straight_path(math.nan),
        lambda: straight_path(1.0, math.nan),
        lambda: straight_path(1.0, math.inf),
        lambda: straight_path(math.inf),
        lambda: curved_path(math.nan),
        lambda: curved_path(1.0, (math.inf, 0.0)),
    ):
        with pytest.raises(InputError, match="finite"):
            make()
    with pytest.raises(InputError, match="the twist is"):
        twist_path(math.nan, 0, 0, 1.0)
    for duration in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(InputError, match="duration is"):
            twist_path(1.0, 0, 0, duration)
        with pytest.raises(InputError, match="duration is"):
            BodyPath((1.0, 0.0, 0.0), duration=duration)
    with pytest.raises(InputError, match="has no length"):
        twist_path(0, 0, 0, 1.0)
