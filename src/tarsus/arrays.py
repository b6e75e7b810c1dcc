"""Array functions for NumPy, JAX and other libraries that follow the array API standard.

NumPy arrays bypass `array_api_compat`: the inverse kinematics of one robot is a few dozen calls of about a microsecond
each, and a search for the namespace in each of them would double that.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from tarsus.errors import InputError

if TYPE_CHECKING:
    from jaxtyping import Bool, Float, Num, Shaped

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
    "read_only",
    "require_finite",
    "require_float",
    "require_shape",
    "root",
    "stack_last",
]

Array: TypeAlias = Any
Namespace: TypeAlias = Any

_NUMPY = (np.ndarray, np.generic)


def namespace(*arrays: Any) -> Namespace:
    """Return the namespace of `arrays`: NumPy, unless one of them belongs to another library.

    Parameters
    ----------
    *arrays : array
        Arrays, numbers or nested sequences.
    """
    others = [a for a in arrays if not isinstance(a, _NUMPY) and hasattr(a, "shape")]
    if not others:
        return np
    import array_api_compat

    # Other objects with a shape (pandas, xarray) are converted by NumPy.
    others = [a for a in others if array_api_compat.is_array_api_obj(a)]
    return array_api_compat.array_namespace(*others) if others else np


def as_array(xp: Namespace, values: Any) -> Shaped[Array, "..."]:
    """Return `values` as an array of the namespace `xp`, without a copy if it is one already.

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


def as_floats(xp: Namespace, values: Any, *, name: str) -> Float[Array, "*batch"]:
    """Return `values` as a floating-point array of `xp`.

    Parameters
    ----------
    xp : namespace
        The array library.
    values : array
        Any shape, real numbers.
    name : str
        Name of the values in messages.

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


def read_only(array: Shaped[np.ndarray, "*shape"]) -> Shaped[np.ndarray, "*shape"]:
    """Make a NumPy array read-only, and return it.

    Parameters
    ----------
    array : array
        Any shape.
    """
    array.setflags(write=False)
    return array


def is_traced(array: Any) -> bool:
    """Return whether `array` is an abstract value inside `jax.jit`, `jax.vmap` or `jax.grad`.

    Parameters
    ----------
    array : array
        Any array.
    """
    jax = sys.modules.get("jax")
    return jax is not None and isinstance(array, jax.core.Tracer)


def require_float(name: str, value: float, *, finite: bool = False) -> float:
    """Return a number as a float.

    Parameters
    ----------
    name, value : str, float
        Its name in messages; the number.
    finite : bool
        Whether it must be finite.

    Raises
    ------
    InputError
        If it is not a number, or not finite where it must be.
    """
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise InputError(f"{name} is {value!r}; it must be a number") from None
    if finite:
        require_finite(name, np.array(number))
    return number


def require_finite(name: str, array: Num[Array, "..."]) -> None:
    """Refuse NaN and infinities; traced values can't be checked.

    Parameters
    ----------
    name : str
        Name of the array in messages.
    array : array
        Any shape.

    Raises
    ------
    InputError
        If an element is not finite; the message gives its index.
    """
    if is_traced(array):
        return
    xp = namespace(array)
    finite = xp.isfinite(array)
    if bool(finite.all() if xp is np else xp.all(finite)):
        return
    values = np.asarray(array)
    wrong = np.argwhere(~np.isfinite(values))
    if not values.ndim:
        raise InputError(f"{name} is {values}; it must be a finite number")
    where = ", ".join(str(int(i)) for i in wrong[0])
    raise InputError(
        f"{name}[{where}] is {values[tuple(wrong[0])]}; {len(wrong)} of {values.size} values are not finite numbers"
    )


def require_shape(name: str, array: Shaped[Array, "..."], tail: tuple[int, ...]) -> None:
    """Refuse an array whose last axes are not `tail`.

    Parameters
    ----------
    name : str
        Name of the array in messages.
    array : array
        Any shape.
    tail : tuple of int
        Required lengths of the last axes.

    Raises
    ------
    InputError
        If they differ.
    """
    if array.shape[-len(tail) :] != tail:
        expected = ", ".join(["...", *map(str, tail)])
        raise InputError(f"{name} has shape {tuple(array.shape)}; expected ({expected})")


def only_where_needed(
    needed: Bool[Array, ""] | bool, compute: Callable[[], tuple[Array, ...]], otherwise: tuple[Any, ...]
) -> tuple[Any, ...]:
    """Return the result of `compute` if it is needed, else `otherwise`; under `jax.jit`, decided at run time.

    Parameters
    ----------
    needed : array of bool, shape ()
        Whether to compute.
    compute : callable
        Takes no arguments; returns arrays of the shapes of those in `otherwise`.
    otherwise : tuple of array
        Result where it is not needed.
    """
    if is_traced(needed):
        chosen: tuple[Array, ...] = sys.modules["jax"].lax.cond(needed, compute, lambda: otherwise)
        return chosen
    return compute() if bool(needed) else otherwise


def improve(
    step: Callable[[tuple[Array, ...]], tuple[Array, ...]],
    state: tuple[Float[Array, "*batch"], ...],
    *,
    times: int,
    enough: float,
) -> tuple[Float[Array, "*batch"], ...]:
    """Return the state after several steps, each of which does not increase its first array.

    An element is final once a step has decreased it by too little, independently of the other elements. Under `jax.jit`
    the steps are compiled as a loop.

    Parameters
    ----------
    step : callable
        Takes a state and returns the next one, of the same shapes.
    state : tuple of array
        Initial state; arrays of one shape.
    times : int
        Greatest number of steps.
    enough : float
        An element is final when a step decreases it by no more than this.
    """
    xp = namespace(*state)

    def advance(active: Array, state: tuple[Array, ...]) -> tuple[Array, tuple[Array, ...]]:
        following = step(state)
        still_active = active & (state[0] - following[0] > enough)
        return still_active, tuple(xp.where(active, new, old) for new, old in zip(following, state, strict=True))

    active = xp.ones(state[0].shape, dtype=xp.bool)
    if any(is_traced(part) for part in state):
        lax = sys.modules["jax"].lax
        final: tuple[Array, ...] = lax.scan(lambda s, _: (advance(*s), None), (active, state), length=times)[0][1]
        return final
    for _ in range(times):
        active, state = advance(active, state)
        if not bool(xp.any(active)):
            break
    return state


def root(xp: Namespace, square: Float[Array, "*batch"]) -> Float[Array, "*batch"]:
    """Return the square root, 0 for negative numbers, with a finite gradient at 0.

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


def stack_last(xp: Namespace, parts: tuple[Float[Array, "..."], ...]) -> Float[Array, "..."]:
    """Stack arrays along a new last axis, as `stack(parts, axis=-1)` does, but faster for NumPy.

    Parameters
    ----------
    xp : namespace
        The array library.
    parts : tuple of array
        Arrays that broadcast against each other.
    """
    if xp is not np:
        return xp.stack(xp.broadcast_arrays(*parts), axis=-1)
    shape = broadcast_shapes("the parts", *(part.shape for part in parts))
    joined = np.empty((*shape, len(parts)), dtype=np.result_type(*parts))
    for i, part in enumerate(parts):
        joined[..., i] = part
    return joined


def broadcast_shapes(what: str, *shapes: tuple[int, ...]) -> tuple[int, ...]:
    """Return the broadcast shape of batch shapes.

    Parameters
    ----------
    what : str
        Whose batch axes these are, for messages.
    *shapes : tuple of int
        Batch shapes.

    Raises
    ------
    InputError
        If they don't broadcast.
    """
    different = set(shapes) - {()}
    if len(different) < 2:  # the common case, without the overhead of NumPy
        return different.pop() if different else ()
    try:
        return np.broadcast_shapes(*shapes)
    except ValueError:
        listed = " and ".join(str(tuple(shape)) for shape in shapes)
        raise InputError(f"the batch axes of {what} don't broadcast: {listed}") from None
