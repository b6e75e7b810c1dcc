"""Load fractions against an exhaustive search over all sets of feet, and optimality conditions."""

import itertools

import array_api_strict
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from tarsus.kinematics.polygon import margin_and_nearest
from tarsus.load.load_distribution import load_fractions, single_pose_fractions


def exhaustive(x, y, down):
    """Least sum of squares over the equilibria of every set of feet, one sample."""
    best = None
    for count in range(1, down.sum() + 1):
        for feet in itertools.combinations(np.flatnonzero(down), count):
            some = list(feet)
            conditions = np.stack([np.ones(count), x[some], y[some]])
            shares = np.linalg.pinv(conditions) @ [1, 0, 0]
            if np.abs(conditions @ shares - [1, 0, 0]).max() < 1e-10 and shares.min() > -1e-13:
                whole = np.zeros(len(x))
                whole[some] = shares
                if best is None or (shares**2).sum() < (best**2).sum() - 1e-15:
                    best = whole
    return best


def feet_around_the_load(rng, n, kind, legs=6):
    """Feet relative to a load inside their polygon, on its edge (or between two feet), or on a foot."""
    x, y = rng.uniform(-0.3, 0.3, (2, legs, n))
    down = rng.random((legs, n)) < 0.7
    down[0] |= ~down.any(0)
    if kind == "line":
        y = 0.5 * x + 0.1
    elif kind == "across":
        x = np.full_like(x, 0.1)
    elif kind == "thin":
        y = 1e-4 * y + 0.3 * x
    elif kind == "grid":
        x, y = np.round(10 * x) / 10, np.round(10 * y) / 10
    elif kind == "pairs":
        x[3:], y[3:] = x[:3] + 1e-4 * y[3:], y[:3]
    weights = rng.dirichlet(np.full(legs, 0.3), n).T * down
    for j, where in enumerate(rng.integers(0, 3, n)):
        chosen = rng.choice(np.flatnonzero(down[:, j]), 2)
        if where:
            weights[:, j] = 0
            weights[chosen[0], j] += 0.3
            weights[chosen[where - 1], j] += 0.7
    weights /= weights.sum(0)
    return x - (weights * x).sum(0), y - (weights * y).sum(0), down


KINDS = ["plain", "line", "across", "thin", "grid", "pairs"]


@pytest.mark.parametrize("kind", KINDS)
def test_equilibrium_with_least_squares(kind):
    x, y, down = feet_around_the_load(np.random.default_rng(KINDS.index(kind)), 150, kind)
    shares = load_fractions(np, x, y, down)
    assert shares.min() >= 0
    assert (shares[~down] == 0).all()
    np.testing.assert_allclose(shares.sum(0), 1, rtol=0, atol=1e-12)
    np.testing.assert_allclose([(shares * x).sum(0), (shares * y).sum(0)], 0, rtol=0, atol=1e-12)
    best = np.stack([exhaustive(x[:, j], y[:, j], down[:, j]) for j in range(150)], axis=-1)
    np.testing.assert_allclose(shares, best, rtol=0, atol=1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_a_single_pose_equals_the_batch(kind):
    x, y, down = feet_around_the_load(np.random.default_rng(10 + KINDS.index(kind)), 300, kind)
    fractions, margins = load_fractions(np, x, y, down), margin_and_nearest(np, x, y, down)[0]
    direct = 0
    for j in range(300):
        found = single_pose_fractions(list(zip(x[:, j].tolist(), y[:, j].tolist(), strict=True)), down[:, j].tolist())
        if found is not None:
            direct += 1
            np.testing.assert_allclose(found[0], fractions[:, j], rtol=0, atol=1e-12)
            assert found[1] == pytest.approx(margins[j], rel=0, abs=1e-15)
    assert (direct > 0) == (kind in ("plain", "grid", "pairs"))


@pytest.mark.parametrize("seed", range(4))
def test_first_order_conditions(seed):
    """The fractions of bearing feet are linear in position, and that plane is not positive at the other feet."""
    x, y, down = feet_around_the_load(np.random.default_rng(seed), 300, "plain", legs=8)
    shares = load_fractions(np, x, y, down)
    pulling = 0
    for j in range(300):
        bears = shares[:, j] > 1e-9
        if bears.sum() < 3:  # on an edge or a foot the plane is not determined
            continue
        over = np.stack([np.ones(8), x[:, j], y[:, j]], axis=-1)
        plane = np.linalg.lstsq(over[bears], shares[bears, j])[0]
        np.testing.assert_allclose(over[bears] @ plane, shares[bears, j], rtol=0, atol=1e-10)
        assert (over[down[:, j] & ~bears] @ plane < 1e-8).all()
        pulling += (down[:, j] & ~bears).any()
    assert pulling > 10


def test_known_cases():
    one = np.ones((1, 1), dtype=bool)
    np.testing.assert_array_equal(load_fractions(np, 0.0 * one, 0.0 * one, one), [[1]])
    # Two feet: the lever rule; the third foot can't contribute.
    x, y = np.array([[-0.1], [0.3], [0.0]]), np.array([[0.0], [0.0], [0.2]])
    np.testing.assert_allclose(load_fractions(np, x, y, np.ones((3, 1), bool)), [[0.75], [0.25], [0]], atol=1e-15)
    # A square: equal fractions; with the load on the middle of an edge, only its two corners.
    x, y = np.array([[1.0], [-1], [-1], [1]]), np.array([[1.0], [1], [-1], [-1]])
    down = np.ones((4, 1), bool)
    np.testing.assert_allclose(load_fractions(np, x, y, down), np.full((4, 1), 0.25), atol=1e-15)
    np.testing.assert_allclose(load_fractions(np, x - 1, y, down), [[0.5], [0], [0], [0.5]], atol=1e-15)
    # Two feet at the same position bear equal fractions.
    x, y = np.array([[1.0], [1.0], [-1.0]]), np.zeros((3, 1))
    np.testing.assert_allclose(load_fractions(np, x, y, np.ones((3, 1), bool)), [[0.25], [0.25], [0.5]], atol=1e-15)


def test_three_feet_are_statically_determinate():
    rng = np.random.default_rng(5)
    x, y, down = feet_around_the_load(rng, 200, "plain", legs=3)
    down[:] = True
    weights = rng.dirichlet(np.ones(3), 200).T
    x, y = x - (weights * x).sum(0), y - (weights * y).sum(0)
    np.testing.assert_allclose(load_fractions(np, x, y, down), weights, rtol=0, atol=1e-11)


def test_no_foot_down():
    x = np.ones((6, 2))
    np.testing.assert_array_equal(load_fractions(np, x, x, np.zeros((6, 2), bool)), np.zeros((6, 2)))


def test_invariance_under_scale_and_rotation():
    x, y, down = feet_around_the_load(np.random.default_rng(6), 50, "plain")
    shares = load_fractions(np, x, y, down)
    for scale in (1e-6, 1e6):
        np.testing.assert_allclose(load_fractions(np, -scale * y, scale * x, down), shares, rtol=0, atol=1e-10)


def test_batch_equals_loop():
    x, y, down = feet_around_the_load(np.random.default_rng(7), 100, "plain")
    together = load_fractions(np, x, y, down)
    single = [load_fractions(np, x[:, j : j + 1], y[:, j : j + 1], down[:, j : j + 1]) for j in range(100)]
    np.testing.assert_allclose(together, np.concatenate(single, axis=1), rtol=0, atol=1e-14)


@pytest.mark.parametrize("xp", [jnp, array_api_strict], ids=["jax", "strict"])
def test_other_libraries_agree(xp):
    x, y, down = feet_around_the_load(np.random.default_rng(8), 60, "plain")
    want = load_fractions(np, x, y, down)
    got = load_fractions(xp, *(xp.asarray(v) for v in (x, y, down)))
    np.testing.assert_allclose(np.asarray(got), want, rtol=0, atol=1e-13)
    # Without a foot that would have to pull, the iteration is skipped.
    around = np.arange(6) * np.pi / 3
    x, y = (np.repeat(v[:, None], 60, axis=1) for v in (np.cos(around), np.sin(around)))
    got = load_fractions(xp, xp.asarray(x), xp.asarray(y), xp.asarray(np.ones_like(down)))
    np.testing.assert_allclose(np.asarray(got), 1 / 6, rtol=0, atol=1e-15)


@pytest.mark.no_cover
def test_jit_and_derivative():
    # Well inside the polygon, so that the load can be moved.
    x, y = np.array([[1.0, 1], [-1, 1], [-1, -1], [1, -1], [0.2, 0.1]]).T[..., None]
    at, all_down, change = np.array([0.9, 0.55]), np.ones((5, 1), bool), 1e-6

    def share(load, xp):
        return load_fractions(xp, xp.asarray(x) - load[0], xp.asarray(y) - load[1], xp.asarray(all_down))[:, 0]

    def share_and_slope(load):
        return share(load, jnp), jax.jacfwd(lambda where: share(where, jnp))(load)

    assert (share(at, np) == 0).any()
    shares, slope = jax.jit(share_and_slope)(jnp.asarray(at))
    np.testing.assert_allclose(shares, share(at, np), rtol=0, atol=1e-14)
    for axis in range(2):
        step = change * np.eye(2)[axis]
        difference = (share(at + step, np) - share(at - step, np)) / (2 * change)
        np.testing.assert_allclose(slope[:, axis], difference, rtol=0, atol=1e-8)
