"""The senses of which each leg has one: what is plausible of each, and since when."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np

from tarsus.control.readings import Vector

__all__ = ["ContactChannel", "Range", "VectorChannel", "items", "number", "vector"]


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


Range: TypeAlias = tuple[float, float]

_NO_NUMBERS = (math.nan, math.nan, math.nan)


class _LegChannel:
    """A sense with a reading for each leg, of which each is trusted or not."""

    def __init__(self, what: str, legs: Sequence[str], *, settle: int) -> None:
        self._settle = settle
        self._shape = f"{what}: not one for each leg"
        self._trial = tuple(f"{what} of {leg}: on trial" for leg in legs)
        self._plausible = [settle] * len(legs)  # readings in a row, of each leg

    def distrust(self) -> None:
        """Believe no leg before it has been plausible for a while."""
        self._plausible = [0] * len(self._plausible)

    def _refuse(self, rejected: list[str]) -> None:
        rejected.append(self._shape)
        self.distrust()

    def _trusted(self, leg: int, rejected: list[str]) -> bool:
        """Count a plausible reading; return whether it is believed."""
        if self._plausible[leg] < self._settle:
            self._plausible[leg] += 1
            rejected.append(self._trial[leg])
            return False
        return True


class ContactChannel(_LegChannel):
    """Which feet touch the ground.

    Parameters
    ----------
    legs : sequence of str
        What to call the legs.
    settle : int
        Plausible readings in a row after which a leg is believed again.
    """

    def __init__(self, legs: Sequence[str], *, settle: int) -> None:
        super().__init__("contacts", legs, settle=settle)
        self._wrong = tuple(f"contacts of {leg}: neither true nor false" for leg in legs)

    def read(self, value: Any, rejected: list[str]) -> tuple[bool | None, ...] | None:
        """Return the contacts that are believed; add the reasons to `refused` where they are not.

        Parameters
        ----------
        value : anything
            The reading.
        rejected : list of str
            Reasons are added to it.
        """
        if value is None:
            return None
        listed = items(value, (len(self._plausible),))
        if listed is None:
            self._refuse(rejected)
            return None
        return _known([self._read_leg(leg, touch, rejected) for leg, touch in enumerate(listed)])

    def _read_leg(self, leg: int, touch: Any, rejected: list[str]) -> bool | None:
        on = touch if type(touch) is bool else _truth(touch)
        if on is None:
            rejected.append(self._wrong[leg])
            self._plausible[leg] = 0
            return None
        return on if self._trusted(leg, rejected) else None


class VectorChannel(_LegChannel):
    """Three numbers for each leg: forces, or torques.

    Parameters
    ----------
    what : str
        What to call them.
    legs : sequence of str
        What to call the legs.
    bounds : sequence of ((low, high), (low, high), (low, high))
        Between which a leg's numbers are plausible.
    beyond : str
        What to call numbers that are not.
    lone : bool
        Whether one number for each leg will do: the third of three.
    settle : int
        Plausible readings in a row after which a leg is believed again.
    """

    def __init__(
        self,
        what: str,
        legs: Sequence[str],
        *,
        bounds: Sequence[tuple[Range, Range, Range]],
        beyond: str,
        lone: bool,
        settle: int,
    ) -> None:
        super().__init__(what, legs, settle=settle)
        self._bounds, self._lone = bounds, lone
        self._shapes = ((len(legs), 3), (len(legs),)) if lone else ((len(legs), 3),)
        self._wrong = tuple(f"{what} of {leg}: not finite numbers" for leg in legs)
        self._beyond = tuple(f"{what} of {leg}: {beyond}" for leg in legs)

    def read(self, value: Any, rejected: list[str]) -> tuple[Vector | None, ...] | None:
        """Return the numbers that are believed; add the reasons to `refused` where they are not.

        Parameters
        ----------
        value : anything
            The reading.
        rejected : list of str
            Reasons are added to it.
        """
        if value is None:
            return None
        listed = items(value, *self._shapes)
        if listed is None:
            self._refuse(rejected)
            return None
        return _known([self._read_leg(leg, part, rejected) for leg, part in enumerate(listed)])

    def _read_leg(self, leg: int, part: Any, rejected: list[str]) -> Vector | None:
        alone = number(part) if self._lone and type(part) is not list else math.nan
        found = vector(part) or _NO_NUMBERS if math.isnan(alone) else (0.0, 0.0, alone)
        x, y, z = found
        (x_low, x_high), (y_low, y_high), (z_low, z_high) = self._bounds[leg]
        if x_low <= x <= x_high and y_low <= y <= y_high and z_low <= z <= z_high:
            return found if self._trusted(leg, rejected) else None
        finite = x - x == 0.0 and y - y == 0.0 and z - z == 0.0
        rejected.append(self._beyond[leg] if finite else self._wrong[leg])
        self._plausible[leg] = 0
        return None


def _truth(value: Any) -> bool | None:
    """Return 0 and 1 of any number's class as a bool, anything else as None."""
    if issubclass(type(value), np.bool_):
        return bool(value)
    found = number(value)
    return found == 1.0 if found in {0.0, 1.0} else None


def _known(values: list[Any]) -> tuple[Any, ...] | None:
    """Return the values of the legs; None where all are."""
    for value in values:
        if value is not None:
            return tuple(values)
    return None
