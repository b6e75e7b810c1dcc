"""Arrays of any kind: one code for NumPy, JAX and whatever else follows the array API standard.

NumPy arrays take the short way, without a detour through `array_api_compat`: one robot's inverse kinematics
is a few dozen calls of about a microsecond each, and finding the namespace anew in each would double that.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np

from tarsus.errors import InputError

__all__ = [
    "Array",
    "Namespace",
    "as_array",
    "as_floats",
    "broadcast_shapes",
    "improve",
    "is_traced",
    "namespace",
    "only_where_needed",
    "require_finite",
    "require_shape",
    "root",
    "stack_last",
]

Array: TypeAlias = Any
Namespace: TypeAlias = Any


def namespace(*arrays: Array) -> Namespace:
    """Return the namespace in which `arrays` are computed: NumPy, unless one of them is of another library.

    Parameters
    ----------
    *arrays : array
        Arrays, numbers or nested sequences.
    """
    others = [a for a in arrays if not isinstance(a, np.ndarray | np.generic) and hasattr(a, "shape")]
    if not others:
        return np
    import array_api_compat

    # What else has a shape (a table of pandas, an array of xarray) is taken as NumPy takes it.
    others = [a for a in others if array_api_compat.is_array_api_obj(a)]
    return array_api_compat.array_namespace(*others) if others else np


def as_array(xp: Namespace, values: Array) -> Array:
    """Return `values` as an array of the namespace `xp`, without a copy where it is one already.

    Parameters
    ----------
    xp : namespace
        The array library.
    values : array
        Any shape.
    """
    if xp is np:
        return np.asarray(values)
    return xp.asarray(values) if isinstance(values, np.ndarray) or not hasattr(values, "shape") else values


def as_floats(xp: Namespace, values: Array, *, name: str) -> Array:
    """Return `values` as a floating-point array of `xp`.

    Parameters
    ----------
    xp : namespace
        The array library.
    values : array
        Any shape, real numbers.
    name : str
        What the values are, for the message.

    Raises
    ------
    InputError
        If the values are not real numbers.
    """
    if xp is np:
        if type(values) is np.ndarray and values.dtype == np.float64:
            return values
        try:
            array = np.asarray(values)
        except (TypeError, ValueError) as error:
            raise InputError(f"{name}: expected an array of real numbers, got {values!r:.80}: {error}") from None
        if array.dtype.kind not in "fiub":
            raise InputError(f"{name}: expected an array of real numbers, got {array.dtype}: {values!r:.80}")
        return array.astype(np.float64)
    array = as_array(xp, values)
    if xp.isdtype(array.dtype, "real floating"):
        return array
    if xp.isdtype(array.dtype, "complex floating"):
        raise InputError(f"{name}: expected an array of real numbers, got {array.dtype}")
    return xp.astype(array, xp.float64)


def is_traced(array: Array) -> bool:
    """Return whether `array` is an abstract value inside `jax.jit`, `jax.vmap` or `jax.grad`.

    Parameters
    ----------
    array : array
        Any array.
    """
    jax = sys.modules.get("jax")
    return jax is not None and isinstance(array, jax.core.Tracer)


def require_finite(name: str, array: Array) -> None:
    """Refuse NaN and infinities; values that are being traced can't be looked at and pass.

    Parameters
    ----------
    name : str
        What the array is, for the message.
    array : array
        Any shape.

    Raises
    ------
    InputError
        If an element is NaN or infinite; the message says which.
    """
    if is_traced(array):
        return
    xp = namespace(array)
    if bool(xp.all(xp.isfinite(array))):
        return
    values = np.asarray(array)
    wrong = np.argwhere(~np.isfinite(values))
    if not values.ndim:
        raise InputError(f"{name} is {values}; it must be a finite number")
    where = ", ".join(str(int(i)) for i in wrong[0])
    raise InputError(
        f"{name}[{where}] is {values[tuple(wrong[0])]}; {len(wrong)} of {values.size} values are not finite numbers"
    )


def require_shape(name: str, array: Array, tail: tuple[int, ...]) -> None:
    """Refuse an array whose last axes are not `tail`.

    Parameters
    ----------
    name : str
        What the array is, for the message.
    array : array
        Any shape.
    tail : tuple of int
        The lengths that the last axes must have.

    Raises
    ------
    InputError
        If they differ.
    """
    if array.shape[-len(tail) :] != tail:
        expected = ", ".join(["...", *map(str, tail)])
        raise InputError(f"{name} has shape {tuple(array.shape)}; expected ({expected})")


def only_where_needed(
    needed: Array, compute: Callable[[], tuple[Array, ...]], otherwise: tuple[Array, ...]
) -> tuple[Array, ...]:
    """Return what `compute` returns where it is needed, else `otherwise`; under `jax.jit`, decided as the code runs.

    Parameters
    ----------
    needed : array, shape ()
        Whether to compute.
    compute : callable
        Takes nothing; returns arrays shaped as those of `otherwise`.
    otherwise : tuple of array
        What to return without computing.
    """
    if is_traced(needed):
        chosen: tuple[Array, ...] = sys.modules["jax"].lax.cond(needed, compute, lambda: otherwise)
        return chosen
    return compute() if bool(needed) else otherwise


def improve(
    step: Callable[[tuple[Array, ...]], tuple[Array, ...]], state: tuple[Array, ...], *, times: int, enough: float
) -> tuple[Array, ...]:
    """Return the state after some steps, each of which lowers its first array or leaves it as it is.

    An element stays as it is once a step has lowered it by too little, whatever becomes of its neighbours. Under
    `jax.jit` the steps are compiled as a loop.

    Parameters
    ----------
    step : callable
        Takes a state; returns the next, shaped as the last.
    state : tuple of array
        The state at the beginning; all of one shape.
    times : int
        Most steps.
    enough : float
        An element is done when a step lowers it by no more than this.
    """
    xp = namespace(*state)

    def move(going: Array, state: tuple[Array, ...]) -> tuple[Array, tuple[Array, ...]]:
        moved = step(state)
        more = going & (state[0] - moved[0] > enough)
        return more, tuple(xp.where(going, new, old) for new, old in zip(moved, state, strict=True))

    going = xp.ones(state[0].shape, dtype=xp.bool)
    if any(is_traced(part) for part in state):
        lax = sys.modules["jax"].lax
        final: tuple[Array, ...] = lax.scan(lambda s, _: (move(*s), None), (going, state), length=times)[0][1]
        return final
    for _ in range(times):
        going, state = move(going, state)
        if not bool(xp.any(going)):
            break
    return state


def root(xp: Namespace, square: Array) -> Array:
    """Return the square root: 0 for negative numbers, and with a gradient that stays finite at 0, where it has none.

    Parameters
    ----------
    xp : namespace
        The array library.
    square : array
        Any shape.
    """
    if xp is np:
        return np.sqrt(np.maximum(square, 0.0))
    positive = square > 0
    return xp.where(positive, xp.sqrt(xp.where(positive, square, xp.ones_like(square))), xp.zeros_like(square))


def stack_last(xp: Namespace, parts: tuple[Array, ...]) -> Array:
    """Join equally shaped arrays along a new last axis (what `stack(parts, axis=-1)` does, faster for NumPy).

    Parameters
    ----------
    xp : namespace
        The array library.
    parts : tuple of array
        Arrays that broadcast against each other.
    """
    if xp is not np:
        return xp.stack(xp.broadcast_arrays(*parts), axis=-1)
    shape = np.broadcast_shapes(*(part.shape for part in parts))
    joined = np.empty((*shape, len(parts)), dtype=np.result_type(*parts))
    for i, part in enumerate(parts):
        joined[..., i] = part
    return joined


def broadcast_shapes(what: str, *shapes: tuple[int, ...]) -> tuple[int, ...]:
    """Return the shape that batch shapes have together.

    Parameters
    ----------
    what : str
        Whose batch axes these are, for the message.
    *shapes : tuple of int
        Batch shapes.

    Raises
    ------
    InputError
        If they don't broadcast.
    """
    different = set(shapes) - {()}
    if len(different) < 2:  # the common case, without NumPy's microseconds
        return different.pop() if different else ()
    try:
        return np.broadcast_shapes(*shapes)
    except ValueError:
        listed = " and ".join(str(tuple(shape)) for shape in shapes)
        raise InputError(f"the batch axes of {what} don't fit together: {listed}") from None
