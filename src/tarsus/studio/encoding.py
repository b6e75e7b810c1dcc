"""Conversion of arrays in SI units to the flat, rounded lists of messages."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["degrees", "flags", "millimetres", "or_null", "plain", "rows_of_flags"]

# Finer than the 3D view can show; exported files have the exact values.
_MM_DECIMALS, _DEG_DECIMALS, _DECIMALS = 2, 3, 4


def millimetres(metres: Any) -> list[float]:
    """Return lengths in mm.

    Parameters
    ----------
    metres : array
        Any shape [m].
    """
    return _flat(np.asarray(metres) * 1000, _MM_DECIMALS)


def degrees(radians: Any) -> list[float]:
    """Return angles in deg.

    Parameters
    ----------
    radians : array
        Any shape [rad].
    """
    return _flat(np.degrees(np.asarray(radians)), _DEG_DECIMALS)


def plain(values: Any) -> list[float]:
    """Return numbers rounded to four decimals.

    Parameters
    ----------
    values : array
        Any shape.
    """
    return _flat(np.asarray(values), _DECIMALS)


def _flat(values: Float[np.ndarray, "..."], decimals: int) -> list[float]:
    # Adding zero turns -0.0 into 0.0.
    flat: list[float] = (np.round(values.astype(np.float64, copy=False), decimals) + 0.0).ravel().tolist()
    return flat


def or_null(value: float, *, decimals: int = _DECIMALS) -> float | None:
    """Return a rounded number, or None for infinities and NaN, which JSON lacks.

    Parameters
    ----------
    value : float
        Any number.
    decimals : int
        Number of decimals.
    """
    return round(float(value), decimals) + 0.0 if math.isfinite(value) else None


def flags(values: Any) -> str:
    """Return one character for each digit or truth value: ``"101010"``.

    Parameters
    ----------
    values : array of bool or int
        Any shape; integers from 0 to 9.
    """
    return (np.asarray(values).astype(np.uint8) + ord("0")).tobytes().decode("ascii")


def rows_of_flags(values: Any) -> list[str]:
    """Return the text of `flags` for each row.

    Parameters
    ----------
    values : array of bool or int, shape (n, k)
        Integers from 0 to 9.
    """
    text, width = flags(values), np.shape(values)[1]
    return [text[start : start + width] for start in range(0, len(text), width)]
