import math
import sys

import array_api_strict
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from tarsus import arrays
from tarsus.errors import InputError


def test_values_without_a_namespace_use_numpy():
    assert arrays.namespace() is np
    assert arrays.namespace(1.0, [1, 2], np.float64(3), np.zeros(2)) is np


def test_the_namespace_is_that_of_the_other_library():
    assert arrays.namespace(np.zeros(2), jnp.zeros(2)) is jnp
    assert arrays.namespace(array_api_strict.zeros(2), np.zeros(2)).__name__ == "array_api_strict"


def test_other_objects_with_a_shape_use_numpy():
    class Table:
        shape = (2,)

        def __array__(self, dtype=None, copy=None):
            return np.array([1, 2], dtype=dtype)

    assert arrays.namespace(Table()) is np
    assert arrays.as_floats(np, Table(), name="v").tolist() == [1.0, 2.0]


@pytest.mark.parametrize("xp", [np, jnp, array_api_strict])
def test_as_array_copies_only_where_necessary(xp):
    own = xp.asarray([1.0, 2.0])
    assert arrays.as_array(xp, own) is own
    other = arrays.as_array(xp, [1.0, 2.0])
    assert type(other) is type(own)
    assert bool(xp.all(arrays.as_array(xp, np.array([1.0, 2.0])) == own))


@pytest.mark.parametrize("xp", [np, jnp, array_api_strict])
@pytest.mark.parametrize("values", [[1, 2], [True, False], [1.5, -2.0]])
def test_as_floats_accepts_every_kind_of_real_number(xp, values):
    found = arrays.as_floats(xp, xp.asarray(values), name="v")
    assert found.dtype == xp.float64
    assert [float(v) for v in found] == [float(v) for v in values]


@pytest.mark.parametrize("kind", [np.float16, np.float32, np.int8, np.uint64])
def test_as_floats_widens_numpy_numbers(kind):
    assert arrays.as_floats(np, np.array([1, 2], dtype=kind), name="v").dtype == np.float64


def test_as_floats_keeps_the_width_of_other_libraries():
    assert arrays.as_floats(jnp, jnp.zeros(2, dtype=jnp.float32), name="v").dtype == jnp.float32


def test_as_floats_does_not_copy_floats():
    values = np.zeros(3)
    assert arrays.as_floats(np, values, name="v") is values


@pytest.mark.parametrize(
    "wrong",
    ["text", ["1.0", "2.0"], np.array(["1.0"]), [1j], np.array([1 + 0j]), None, [None], [[1.0], [1.0, 2.0]], object()],
)
def test_as_floats_refuses_other_values(wrong):
    with pytest.raises(InputError, match=r"^heights: expected an array of real numbers, got "):
        arrays.as_floats(np, wrong, name="heights")


@pytest.mark.parametrize("xp", [jnp, array_api_strict])
def test_as_floats_refuses_complex_numbers_of_any_library(xp):
    with pytest.raises(InputError, match=r"heights: expected an array of real numbers, got .*complex128"):
        arrays.as_floats(xp, xp.asarray([1j]), name="heights")


def test_traced_and_concrete_values_are_distinguished(monkeypatch):
    seen = []
    jax.jit(lambda x: seen.append(arrays.is_traced(x)) or x)(1.0)
    assert seen == [True]
    assert not arrays.is_traced(jnp.zeros(1))
    assert not arrays.is_traced(np.zeros(1))
    monkeypatch.delitem(sys.modules, "jax")
    assert not arrays.is_traced(np.zeros(1))


@pytest.mark.parametrize("xp", [np, jnp, array_api_strict])
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_require_finite_names_index_and_count(xp, bad):
    values = np.zeros((2, 3))
    values[1, 2] = bad
    with pytest.raises(InputError) as caught:
        arrays.require_finite("feet", xp.asarray(values))
    assert str(caught.value) == f"feet[1, 2] is {bad}; 1 of 6 values are not finite numbers"


def test_require_finite_of_a_single_number():
    arrays.require_finite("height", np.asarray(1.0))
    with pytest.raises(InputError, match=r"^height is nan; it must be a finite number$"):
        arrays.require_finite("height", np.asarray(math.nan))


def test_require_finite_accepts_traced_values():
    def f(x):
        arrays.require_finite("x", x)
        return x

    assert math.isnan(jax.jit(f)(math.nan))


def test_require_shape():
    arrays.require_shape("feet", np.zeros((9, 6, 3)), (6, 3))
    for shape in ((6, 4), (3,), (), (3, 6)):
        with pytest.raises(InputError) as caught:
            arrays.require_shape("feet", np.zeros(shape), (6, 3))
        assert str(caught.value) == f"feet has shape {shape}; expected (..., 6, 3)"


def test_only_where_needed_computes_only_where_needed():
    calls = []

    def compute():
        calls.append(1)
        return (1,)

    assert arrays.only_where_needed(np.bool_(False), compute, (2,)) == (2,)
    assert not calls
    assert arrays.only_where_needed(np.bool_(True), compute, (2,)) == (1,)


def test_only_where_needed_is_decided_at_run_time_under_jit():
    f = jax.jit(lambda x: arrays.only_where_needed(x > 0, lambda: (x * 2,), (x * 3,))[0])
    assert float(f(1.0)) == 2.0
    assert float(f(-1.0)) == -3.0


def test_improve_gives_the_same_result_traced_or_not():
    def halve(x):
        return arrays.improve(lambda state: (state[0] / 2, state[1] + 1), (x, 0 * x), times=4, enough=0.0)

    assert [float(v) for v in halve(np.asarray(8.0))] == [0.5, 4.0]
    assert [float(v) for v in jax.jit(halve)(8.0)] == [0.5, 4.0]


def test_improve_ends_for_each_element_separately():
    steps = []

    def step(state):
        steps.append(1)
        return (state[0] / np.array([1, 2, 2]),)

    found = arrays.improve(step, (np.array([5.0, 8.0, 64.0]),), times=100, enough=1.0)
    assert found[0].tolist() == [5.0, 1.0, 1.0]
    assert len(steps) == 6


@pytest.mark.parametrize("xp", [np, jnp, array_api_strict])
def test_stack_last_is_stack_of_the_broadcast_parts(xp):
    a, b = np.arange(6.0).reshape(2, 3), np.arange(3.0)
    found = np.asarray(arrays.stack_last(xp, (xp.asarray(a), xp.asarray(b))))
    assert np.array_equal(found, np.stack(np.broadcast_arrays(a, b), axis=-1))


def test_broadcast_shapes():
    assert arrays.broadcast_shapes("a and b", (4, 1), (3,)) == (4, 3)
    with pytest.raises(InputError) as caught:
        arrays.broadcast_shapes("the robot and the feet", (4,), (3,))
    assert str(caught.value) == "the batch axes of the robot and the feet don't broadcast: (4,) and (3,)"
