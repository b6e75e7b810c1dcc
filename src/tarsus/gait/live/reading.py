"""Making numbers of whatever a sensor's driver hands over, without ever raising."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

__all__ = ["items", "number", "vector"]


def number(value: Any) -> float:
    """Return a value as a float; NaN where it is no real number.

    Parameters
    ----------
    value : anything
        A number of Python or NumPy, it is hoped.
    """
    kind = type(value)
    if kind is float:
        return float(value)
    if not issubclass(kind, int | float | np.integer | np.floating) or kind is bool:
        return math.nan
    try:
        return float(value)
    except Exception:  # a class of somebody else's may raise anything, an integer may be too long
        return math.nan


def items(value: Any, *shapes: tuple[int, ...]) -> Sequence[Any] | None:
    """Return the items along the first axis of a list, tuple or array; None for anything else, or another shape.

    Parameters
    ----------
    value : anything
        The sequence, it is hoped.
    *shapes : tuple of int
        Shapes that an array may have; a list or tuple needs the first one's length, whatever is in it.
    """
    try:
        if issubclass(type(value), list | tuple):
            # Of what claims to be longer or shorter than it is, no more is ever read than belongs there.
            return [value[i] for i in range(shapes[0][0])] if len(value) == shapes[0][0] else None
        array = np.asarray(value) if value.shape in shapes else None
        return array.tolist() if array is not None and array.shape in shapes else None
    except Exception:  # whatever a class of somebody else's raises, it is no reading
        return None


def vector(value: Any) -> tuple[float, float, float] | None:
    """Return three numbers, NaN for each that is none; None for what is not three of anything.

    Parameters
    ----------
    value : anything
        A list, tuple or array of three numbers, it is hoped.
    """
    if type(value) is list and len(value) == 3:  # the common case, without a copy
        x, y, z = value
        return number(x), number(y), number(z)
    parts = items(value, (3,))
    return None if parts is None else (number(parts[0]), number(parts[1]), number(parts[2]))
