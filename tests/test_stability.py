import array_api_strict
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from sample_robots import hexapod, random_hexapod, standing
from tarsus.errors import InputError
from tarsus.kinematics import polygon
from tarsus.kinematics.convex_hull import origin_margin
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.polygon import hull_margin, margin_and_nearest, support_polygon
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stability import stability_margin
from tarsus.robot.robot import stack_robots

jax.config.update("jax_enable_x64", True)


def distance_to_segment(p, a, b):
    along = b - a
    share = np.clip((p - a) @ along / max(along @ along, 1e-300), 0, 1)
    return np.linalg.norm(a + share * along - p)


def margin_by_walking_round(points, p):
    """The margin from the ordered corners, edge after edge."""
    corners = support_polygon(points, np.ones(len(points), dtype=bool))
    if len(corners) == 0:
        return -np.inf
    nexts = np.roll(corners, -1, axis=0)
    apart = min(distance_to_segment(p, a, b) for a, b in zip(corners, nexts, strict=True))
    along, to_p = nexts - corners, p - corners
    left = along[:, 0] * to_p[:, 1] - along[:, 1] * to_p[:, 0] >= 0
    return apart if len(corners) > 2 and left.all() else -apart


@pytest.mark.parametrize("n", [3, 4, 6, 9])
def test_margin_against_qhull(n):
    rng = np.random.default_rng(n)
    points, queries = rng.normal(size=(60, n, 2)), rng.normal(size=(60, 2))
    margins = hull_margin(points, np.ones((60, n), dtype=bool), queries)
    inside = 0
    for cloud, p, margin in zip(points, queries, margins, strict=True):
        hull = ConvexHull(cloud)
        depth = -np.max(hull.equations[:, :2] @ p + hull.equations[:, 2])
        if depth < 0:
            depth = -min(distance_to_segment(p, *cloud[edge]) for edge in hull.simplices)
        inside += depth > 0
        assert margin == pytest.approx(depth, abs=1e-12)
    assert 0 < inside < 60


@given(st.data())
def test_margin_of_degenerate_points(data):
    """On a coarse grid points coincide, lie on a line, and the point asked about lies on corners and edges."""
    n = data.draw(st.integers(1, 7))
    coordinate = st.integers(-2, 2)
    points = np.array(data.draw(st.lists(st.tuples(coordinate, coordinate), min_size=n, max_size=n)), dtype=float)
    mask = np.array(data.draw(st.lists(st.booleans(), min_size=n, max_size=n)))
    p = np.array(data.draw(st.tuples(coordinate, coordinate)), dtype=float)
    expected = pytest.approx(margin_by_walking_round(points[mask], p), abs=1e-12)
    assert hull_margin(points, mask, p) == expected
    assert hull_margin(points[None], mask, p)[0] == expected


@given(st.integers(0, 2**32 - 1))
def test_the_nearest_point_of_a_single_pose_equals_the_batch(seed):
    rng = np.random.default_rng(seed)
    points, counts = rng.normal(0.3, 1.0, (6, 2)), rng.random(6) < 0.6
    counts[rng.integers(6)] = True
    batch = margin_and_nearest(np, *points.T[:, :, None], counts[:, None])
    np.testing.assert_allclose(origin_margin(points[counts].tolist()), np.array(batch)[:, 0], rtol=0, atol=1e-14)


def test_margin_by_hand():
    square = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
    whole = np.ones(4, dtype=bool)
    assert hull_margin(square, whole, [0.5, 1.0]) == 0.5
    assert hull_margin(square, whole, [1.0, 0.0]) == 0
    assert hull_margin(square, whole, [1.0, -3.0]) == -3
    assert hull_margin(square, whole, [5.0, 6.0]) == -5  # to the corner, not to an edge's line
    assert hull_margin(square, [True, False, True, False], [1.0, 1.0]) == 0
    assert hull_margin(square, [True, False, False, False], [3.0, 4.0]) == -5
    assert hull_margin(square, [False] * 4, [1.0, 1.0]) == -np.inf
    assert hull_margin(np.zeros((3, 0, 2)), np.zeros((3, 0), dtype=bool), [1.0, 1.0]).tolist() == [-np.inf] * 3


def test_margin_in_blocks_equals_loop(monkeypatch):
    monkeypatch.setattr(polygon, "_WORK", 216 * 7)
    rng = np.random.default_rng(5)
    points, mask = rng.normal(size=(3, 1, 6, 2)), rng.random((20, 6)) < 0.6
    p = 0.3 * rng.normal(size=(3, 20, 2))
    together = hull_margin(points, mask, p)
    one_by_one = [[hull_margin(points[i, 0], mask[j], p[i, j]) for j in range(20)] for i in range(3)]
    np.testing.assert_allclose(together, one_by_one, rtol=0, atol=1e-14)
    shared = hull_margin(points[0, 0], mask, p[0, 0])
    np.testing.assert_allclose(shared, [hull_margin(points[0, 0], m, p[0, 0]) for m in mask], rtol=0, atol=1e-14)


def test_margin_refuses_invalid_arguments():
    points, mask = np.zeros((6, 2)), np.ones(6, dtype=bool)
    with pytest.raises(InputError, match=r"points has shape \(2,\); expected \(..., n, 2\)"):
        hull_margin(np.zeros(2), mask, [0, 0])
    with pytest.raises(InputError, match="points has shape"):
        hull_margin(np.zeros((6, 3)), mask, [0, 0])
    with pytest.raises(InputError, match="mask has shape"):
        hull_margin(points, mask[:5], [0, 0])
    with pytest.raises(InputError, match="point has shape"):
        hull_margin(points, mask, [0, 0, 0])
    with pytest.raises(InputError, match="expected booleans"):
        hull_margin(points, np.ones(6), [0, 0])
    with pytest.raises(InputError, match=r"points\[1, 0\] is nan"):
        hull_margin(np.where(np.arange(12).reshape(6, 2) == 2, np.nan, points), mask, [0, 0])
    with pytest.raises(InputError, match=r"point\[1\] is inf"):
        hull_margin(points, mask, [0, np.inf])
    with pytest.raises(InputError, match="batch axes"):
        hull_margin(np.zeros((3, 6, 2)), mask, np.zeros((2, 2)))


@pytest.mark.parametrize("seed", range(20))
def test_support_polygon_against_qhull(seed):
    rng = np.random.default_rng(seed)
    feet, down = rng.normal(size=(9, 3)), rng.random(9) < 0.8
    hull = ConvexHull(feet[down, :2])
    corners = support_polygon(feet, down)
    first = np.argmin(feet[down][hull.vertices, 0])
    np.testing.assert_array_equal(corners, feet[down][np.roll(hull.vertices, -first), :2])


def test_support_polygon_without_area():
    feet = np.array([[0.0, 0.0], [1.0, 1.0], [3.0, 3.0], [1.0, 1.0]])
    assert support_polygon(feet, np.ones(4, dtype=bool)).tolist() == [[0, 0], [3, 3]]
    assert support_polygon(feet, [False, True, False, True]).tolist() == [[1, 1]]
    assert support_polygon(feet, [False] * 4).shape == (0, 2)
    with pytest.raises(InputError, match="without batch axes"):
        support_polygon(feet[None], [True] * 4)
    with pytest.raises(InputError, match=r"expected \(n, 2\) or \(n, 3\)"):
        support_polygon(np.zeros((4, 4)), [True] * 4)
    with pytest.raises(InputError, match="contacts has shape"):
        support_polygon(feet, [True] * 3)
    with pytest.raises(InputError, match="expected booleans"):
        support_polygon(feet, [1, 1, 0, 1])
    with pytest.raises(InputError, match="not finite"):
        support_polygon(feet * np.nan, [True] * 4)


def test_a_symmetric_stance():
    robot = hexapod()
    points = forward_kinematics(robot, standing())
    radius = np.hypot(*points[0, 3, :2])
    everything = np.ones(6, dtype=bool)
    tripod = everything.copy()
    tripod[1::2] = False
    assert stability_margin(robot, standing(), Pose(), everything) == pytest.approx(radius * np.cos(np.pi / 6))
    assert stability_margin(robot, standing(), Pose(), tripod) == pytest.approx(radius / 2)
    two = np.array([True, True, False, False, False, False])
    assert stability_margin(robot, standing(), Pose(), two) == pytest.approx(-radius * np.cos(np.pi / 6))
    assert stability_margin(robot, standing(), Pose(), ~everything) == -np.inf


def test_feet_of_a_tilted_body_are_projected_vertically():
    rng = np.random.default_rng(6)
    robot = random_hexapod(rng)
    angles = rng.uniform(-0.8, 0.8, (30, 6, 3))
    body = Pose.from_rpy(*rng.uniform(-0.6, 0.6, (2, 30)), rng.uniform(-3, 3, 30), rng.normal(size=(30, 3)))
    contacts = rng.random((30, 6)) < 0.7
    margins = stability_margin(robot, angles, body, contacts)
    for i in range(30):
        feet = body[i] @ forward_kinematics(robot, angles[i])[:, 3]
        com = body[i] @ centre_of_mass(robot, angles[i])
        want = margin_by_walking_round(feet[contacts[i], :2], com[:2])
        assert margins[i] == pytest.approx(want, abs=1e-12)
    assert margins.min() < 0 < margins.max()


def test_batch_axes_broadcast_and_equal_a_loop():
    rng = np.random.default_rng(7)
    robots = [random_hexapod(rng) for _ in range(2)]
    angles = rng.uniform(-0.8, 0.8, (3, 1, 1, 6, 3))
    contacts = rng.random((4, 1, 6)) < 0.8
    together = stability_margin(stack_robots(robots), angles, Pose(), contacts)
    one_by_one = [[[stability_margin(r, a[0, 0], Pose(), c[0]) for r in robots] for c in contacts] for a in angles]
    np.testing.assert_allclose(together, one_by_one, rtol=0, atol=1e-14)
    bodies = Pose.from_rpy(rng.uniform(-0.3, 0.3, 5), 0, 0)
    by_body = stability_margin(robots[0], angles[0, 0, 0], bodies, contacts[0, 0])
    np.testing.assert_allclose(
        by_body,
        [stability_margin(robots[0], angles[0, 0, 0], bodies[i], contacts[0, 0]) for i in range(5)],
        rtol=0,
        atol=1e-14,
    )
    moved = stability_margin(robots[0], angles[0, 0, 0], Pose(np.eye(3), rng.normal(size=(5, 3))), contacts[0, 0])
    still = stability_margin(robots[0], angles[0, 0, 0], Pose(), contacts[0, 0])
    np.testing.assert_allclose(moved, np.full(5, still), rtol=0, atol=1e-14)


def test_known_points_are_used_and_invalid_ones_refused():
    robot = hexapod()
    points = forward_kinematics(robot, standing())
    down = np.ones(6, dtype=bool)
    assert stability_margin(robot, None, Pose(), down, points=points) == stability_margin(
        robot, standing(), Pose(), down
    )
    with pytest.raises(InputError, match="contacts has shape"):
        stability_margin(robot, standing(), Pose(), down[:4])
    with pytest.raises(InputError, match="contacts holds float64 values; expected booleans"):
        stability_margin(robot, standing(), Pose(), np.ones(6))
    with pytest.raises(InputError, match="not finite"):
        stability_margin(robot, standing() + np.inf, Pose(), down)
    with pytest.raises(InputError, match="angles, body and contacts"):
        stability_margin(robot, np.zeros((3, 6, 3)), Pose(), np.ones((2, 6), dtype=bool))


@pytest.fixture
def tilted():
    rng = np.random.default_rng(8)
    robot = random_hexapod(rng)
    angles = standing() + rng.uniform(-0.4, 0.4, (40, 6, 3))
    return robot, angles, Pose.from_rpy(0.1, -0.05, 0.3), rng.random((40, 6)) < 0.6


def test_the_array_api_standard_suffices(tilted):
    xp, (robot, angles, body, contacts) = array_api_strict, tilted
    want = stability_margin(robot, angles, body, contacts)
    margin = stability_margin(robot, xp.asarray(angles), body, xp.asarray(contacts))
    np.testing.assert_allclose(np.asarray(margin), want, rtol=0, atol=1e-14)
    empty = hull_margin(xp.zeros((2, 0, 2)), xp.zeros((2, 0), dtype=xp.bool), xp.zeros(2))
    assert np.asarray(empty).tolist() == [-np.inf, -np.inf]


def test_jax_transforms(tilted):
    robot, angles, body, contacts = tilted

    def margin(q, down):
        return stability_margin(robot, q, body, down)

    want = stability_margin(robot, angles, body, contacts)
    np.testing.assert_allclose(jax.jit(margin)(angles, contacts), want, rtol=0, atol=1e-14)
    np.testing.assert_allclose(jax.jit(jax.vmap(margin))(angles, contacts), want, rtol=0, atol=1e-14)
    slopes = jax.jit(jax.vmap(jax.grad(margin)))(angles, contacts)
    direction = np.random.default_rng(9).normal(size=angles.shape)
    step = 1e-7
    ahead, behind = (stability_margin(robot, angles + s * direction, body, contacts) for s in (step, -step))
    finite = np.isfinite(want)
    along = np.sum(slopes * direction, axis=(1, 2))
    np.testing.assert_allclose(along[finite], ((ahead - behind) / (2 * step))[finite], rtol=0, atol=1e-6)


def test_the_gradient_exists_where_the_centre_is_on_a_diagonal_and_on_a_corner():
    """The distance to that diagonal is zero and its root has no slope there: it must not spoil the answer."""
    square = jnp.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0], [1.0, 1.0]])
    slope = jax.jit(jax.grad(hull_margin, argnums=2))
    np.testing.assert_allclose(slope(square, np.ones(5, dtype=bool), jnp.array([0.25, 0.25])), [-0.5, -0.5])
    np.testing.assert_allclose(slope(square, np.ones(5, dtype=bool), jnp.array([0.5, 0.25])), [-1, 0])
    assert np.isfinite(slope(square, np.ones(5, dtype=bool), jnp.array([1.0, 1.0]))).all()
