"""The senses of which each leg has one: what is plausible of each, and since when."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np

from tarsus.gait.live.reading import items, number, vector
from tarsus.gait.live.senses import Vector

__all__ = ["Contacts", "Range", "Vectors"]

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

    def _refuse(self, refused: list[str]) -> None:
        refused.append(self._shape)
        self.distrust()

    def _trusted(self, leg: int, refused: list[str]) -> bool:
        """Count a plausible reading; return whether it is believed."""
        if self._plausible[leg] < self._settle:
            self._plausible[leg] += 1
            refused.append(self._trial[leg])
            return False
        return True


class Contacts(_LegChannel):
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

    def read(self, value: Any, refused: list[str]) -> tuple[bool | None, ...] | None:
        """Return the contacts that are believed; add the reasons to `refused` where they are not.

        Parameters
        ----------
        value : anything
            The reading.
        refused : list of str
            Reasons are added to it.
        """
        if value is None:
            return None
        listed = items(value, (len(self._plausible),))
        if listed is None:
            self._refuse(refused)
            return None
        return _known([self._read_leg(leg, touch, refused) for leg, touch in enumerate(listed)])

    def _read_leg(self, leg: int, touch: Any, refused: list[str]) -> bool | None:
        on = touch if type(touch) is bool else _truth(touch)
        if on is None:
            refused.append(self._wrong[leg])
            self._plausible[leg] = 0
            return None
        return on if self._trusted(leg, refused) else None


class Vectors(_LegChannel):
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

    def read(self, value: Any, refused: list[str]) -> tuple[Vector | None, ...] | None:
        """Return the numbers that are believed; add the reasons to `refused` where they are not.

        Parameters
        ----------
        value : anything
            The reading.
        refused : list of str
            Reasons are added to it.
        """
        if value is None:
            return None
        listed = items(value, *self._shapes)
        if listed is None:
            self._refuse(refused)
            return None
        return _known([self._read_leg(leg, part, refused) for leg, part in enumerate(listed)])

    def _read_leg(self, leg: int, part: Any, refused: list[str]) -> Vector | None:
        alone = number(part) if self._lone and type(part) is not list else math.nan
        found = vector(part) or _NO_NUMBERS if math.isnan(alone) else (0.0, 0.0, alone)
        x, y, z = found
        (x_low, x_high), (y_low, y_high), (z_low, z_high) = self._bounds[leg]
        if x_low <= x <= x_high and y_low <= y <= y_high and z_low <= z <= z_high:
            return found if self._trusted(leg, refused) else None
        finite = x - x == 0.0 and y - y == 0.0 and z - z == 0.0
        refused.append(self._beyond[leg] if finite else self._wrong[leg])
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
