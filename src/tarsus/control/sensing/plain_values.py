"""Conversion of sensor values to plain Python numbers, without ever raising an error.

Readings come from drivers, network messages and users' own code. A faulty value must not stop a walking robot, so
every conversion returns NaN or None where it fails.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from operator import le
from typing import Any

import numpy as np

__all__ = ["as_bool", "as_items", "as_number", "as_vector", "between"]


def as_number(value: Any) -> float:
    """Return a Python or NumPy number as a float; NaN for anything else, bools included."""
    kind = type(value)
    if kind is float:
        return float(value)
    if not issubclass(kind, int | float | np.integer | np.floating) or kind is bool:
        return math.nan
    try:
        return float(value)
    except Exception:  # a foreign subclass may raise anything; an integer may be too large
        return math.nan


def as_bool(value: Any) -> bool | None:
    """Return a Python or NumPy bool, or a number that is 0 or 1, as a bool; None for anything else."""
    if issubclass(type(value), bool | np.bool_):
        return bool(value)
    number = as_number(value)
    return number == 1.0 if number in {0.0, 1.0} else None


def as_items(value: Any, *shapes: tuple[int, ...]) -> Sequence[Any] | None:
    """Return the items along the first axis of a list, tuple or array; None for another type or shape.

    Parameters
    ----------
    value : anything
        Expected: a list, tuple or array.
    *shapes : tuple of int
        Shapes that an array may have; a list or tuple needs the length of the first one, whatever its items are.
    """
    try:
        if issubclass(type(value), list | tuple):
            # Indexing bounds the work for a subclass whose iterator disagrees with its length.
            return [value[i] for i in range(shapes[0][0])] if len(value) == shapes[0][0] else None
        array = np.asarray(value) if value.shape in shapes else None
        return array.tolist() if array is not None and array.shape in shapes else None
    except Exception:  # a foreign class may raise anything
        return None


def as_vector(value: Any) -> tuple[float, float, float]:
    """Return three numbers, each NaN if it is not a real number, or if there are not three items."""
    parts = value if type(value) is list and len(value) == 3 else as_items(value, (3,))
    x, y, z = map(as_number, parts or (None, None, None))
    return x, y, z


def between(low: Sequence[float], numbers: Sequence[float], high: Sequence[float]) -> bool:
    """Return whether each number is within its bounds; NaN is not."""
    return all(map(le, low, numbers)) and all(map(le, numbers, high))
