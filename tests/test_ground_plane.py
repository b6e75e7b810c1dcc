"""Ground plane fit against NumPy's least squares."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tarsus.control.sensing.ground_plane import FLAT, GroundPlane, ground_plane
from tarsus.errors import InputError

BEFORE = GroundPlane(1.0, 2.0, 3.0, 0.5, -0.25)


def random_feet(rng, batch=()):
    return rng.normal(size=(*batch, 6, 3)) * [0.2, 0.15, 0.02] + rng.normal(size=3) * [10, 10, 1]


def values(plane):
    return np.stack(
        np.broadcast_arrays(*(getattr(plane, name) for name in ("x", "y", "z", "slope_x", "slope_y"))), axis=-1
    )


@given(st.integers(0, 2**32 - 1), st.integers(3, 6))
def test_plane_agrees_with_lstsq(seed, count):
    rng = np.random.default_rng(seed)
    feet, contacts = random_feet(rng), rng.permutation(np.arange(6) < count)
    down = feet[contacts]
    matrix = np.column_stack([down[:, :2] - feet[0, :2], np.ones(count)])
    singular = np.linalg.svd(matrix[:, :2] - matrix[:, :2].mean(0), compute_uv=False)
    plane = ground_plane(feet, contacts, BEFORE)
    ratio = (singular[1] / singular[0]) ** 2
    want = np.linalg.lstsq(matrix, down[:, 2], rcond=None)[0]
    if ratio / (1 + ratio) ** 2 <= 0.05**2:  # as good as in a line
        want = [BEFORE.slope_x, BEFORE.slope_y, plane.height(*feet[0, :2])]
    np.testing.assert_allclose([plane.slope_x, plane.slope_y], want[:2], rtol=0, atol=1e-11)
    assert plane.height(*feet[0, :2]) == pytest.approx(want[2], abs=1e-11)
    assert plane.height(plane.x, plane.y) == plane.z


@given(st.integers(0, 2**32 - 1))
def test_exact_planes_are_recovered_anywhere(seed):
    rng = np.random.default_rng(seed)
    feet, (a, b, c) = random_feet(rng), rng.normal(size=3)
    feet[:, 2] = a * feet[:, 0] + b * feet[:, 1] + c
    plane = ground_plane(feet, np.ones(6, dtype=bool))
    np.testing.assert_allclose([plane.slope_x, plane.slope_y, plane.height(0.0, 0.0)], [a, b, c], rtol=0, atol=1e-10)


@given(st.integers(0, 2**32 - 1))
def test_batch_equals_loop(seed):
    rng = np.random.default_rng(seed)
    feet, contacts = random_feet(rng, (5, 4)), rng.random((5, 4, 6)) < 0.5
    feet[0] *= [0.0, 1.0, 1.0]  # in a line
    before = GroundPlane(*rng.normal(size=(5, 5, 4)))
    planes = ground_plane(feet, contacts, before)
    singles = [
        ground_plane(feet[at], contacts[at], GroundPlane(*values(before)[at].tolist())) for at in np.ndindex(5, 4)
    ]
    np.testing.assert_allclose(values(planes).reshape(20, 5), [values(s) for s in singles], rtol=0, atol=1e-11)
    np.testing.assert_array_equal(planes.height(np.zeros((5, 4)), 1.0).shape, (5, 4))
    # One robot's contacts for a batch of feet, and the other way.
    one = ground_plane(feet, contacts[0, 0])
    np.testing.assert_allclose(values(one)[2, 3], values(ground_plane(feet[2, 3], contacts[0, 0])), rtol=0, atol=1e-11)
    one = ground_plane(feet[2, 3], contacts)
    np.testing.assert_allclose(values(one)[1, 1], values(ground_plane(feet[2, 3], contacts[1, 1])), rtol=0, atol=1e-11)


def test_few_or_collinear_feet_keep_the_slope():
    feet = np.array([[0, 0, 0.1], [1, 0, 0.2], [2, 0, 0.6], [3, 0.01, 0.0], [1, 1, 0], [np.nan] * 3])
    for contacts, height in (([1, 0, 0, 0, 0, 0], 0.1), ([1, 1, 0, 0, 0, 0], 0.15), ([1, 1, 1, 0, 0, 0], 0.3)):
        down = np.array(contacts, dtype=bool)
        plane = ground_plane(feet, down, BEFORE)
        mean = feet[down].mean(0)
        np.testing.assert_allclose(values(plane), [*mean, BEFORE.slope_x, BEFORE.slope_y], rtol=0, atol=1e-15)
        assert plane.z == pytest.approx(height)
    nearly = ground_plane(feet, np.array([1, 1, 1, 1, 0, 0], dtype=bool), BEFORE)
    assert (nearly.slope_x, nearly.slope_y) == (0.5, -0.25)
    assert ground_plane(feet, np.zeros(6, dtype=bool), BEFORE) is BEFORE
    assert ground_plane(feet, np.zeros(6, dtype=bool)) == FLAT == GroundPlane(0, 0, 0, 0, 0)
    same = np.array([[0.1, 0.2, 0.3]] * 6)
    assert values(ground_plane(same, np.ones(6, dtype=bool)))[3:] == pytest.approx([0, 0])


def test_invalid_feet_raise():
    feet, down = np.zeros((6, 3)), np.ones(6, dtype=bool)
    with pytest.raises(InputError, match=r"feet has shape \(5, 3\)"):
        ground_plane(feet[:5], down)
    with pytest.raises(InputError, match="contacts"):
        ground_plane(feet, [0.1] * 6)
    with pytest.raises(InputError, match="feet has shape"):
        ground_plane(feet, np.bool_(True))
    with pytest.raises(InputError, match="feet and contacts"):
        ground_plane(np.zeros((2, 6, 3)), np.ones((3, 6), dtype=bool))
    for batch in ((), (2,)):
        for wrong in (np.nan, np.inf, -1e9):
            with pytest.raises(InputError, match="a stance foot is NaN, infinite or more"):
                ground_plane(np.full((*batch, 6, 3), wrong), down)
