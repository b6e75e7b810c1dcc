"""Validation of channels with one reading per leg: contacts, and vectors such as forces, torques or joint angles."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from typing import Any, TypeAlias

from tarsus.control.readings import Vector
from tarsus.control.sensing.plain_values import as_bool, as_items, as_number, as_vector

__all__ = ["ANY_FINITE", "ContactChannel", "Range", "VectorChannel"]

Range: TypeAlias = tuple[float, float]

ANY_FINITE: tuple[Range, Range, Range] = ((-sys.float_info.max, sys.float_info.max),) * 3
"""Bounds that every finite vector meets."""

_NOT_NUMBERS = (math.nan, math.nan, math.nan)


class _LegChannel:
    """A channel whose legs are rejected, and accepted again, one by one."""

    def __init__(self, name: str, legs: Sequence[str], *, settle: int) -> None:
        self._settle = settle
        self._wrong_shape = f"{name}: expected one reading per leg"
        self._settling = tuple(f"{name} of {leg}: settling after a rejected reading" for leg in legs)
        self._plausible = [settle] * len(legs)  # consecutive plausible readings of each leg, at most `settle`

    def reset(self) -> None:
        """Reject every leg until it has been plausible `settle` times in a row."""
        self._plausible = [0] * len(self._plausible)

    def _reject_all(self, rejected: list[str]) -> None:
        rejected.append(self._wrong_shape)
        self.reset()

    def _reject(self, leg: int, reason: str, rejected: list[str]) -> None:
        rejected.append(reason)
        self._plausible[leg] = 0

    def _settled(self, leg: int, rejected: list[str]) -> bool:
        """Count a plausible reading; return whether it is accepted."""
        if self._plausible[leg] < self._settle:
            self._plausible[leg] += 1
            rejected.append(self._settling[leg])
            return False
        return True


class ContactChannel(_LegChannel):
    """Which feet touch the ground.

    Parameters
    ----------
    legs : sequence of str
        Names of the legs in messages.
    settle : int
        Consecutive plausible readings after which a leg is accepted again.
    """

    def __init__(self, legs: Sequence[str], *, settle: int) -> None:
        super().__init__("contacts", legs, settle=settle)
        self._not_boolean = tuple(f"contacts of {leg}: neither a boolean nor 0 or 1" for leg in legs)

    def read(self, value: Any, rejected: list[str]) -> tuple[bool | None, ...] | None:
        """Return the accepted contacts; None for a leg, or for all, where none is.

        Parameters
        ----------
        value : anything
            The reading.
        rejected : list of str
            The reasons of rejections are appended to it.
        """
        items = as_items(value, (len(self._plausible),))
        if items is None:
            self._reject_all(rejected)
            return None
        return _none_if_empty([self._read_leg(leg, item, rejected) for leg, item in enumerate(items)])

    def _read_leg(self, leg: int, value: Any, rejected: list[str]) -> bool | None:
        contact = value if type(value) is bool else as_bool(value)
        if contact is None:
            self._reject(leg, self._not_boolean[leg], rejected)
            return None
        return contact if self._settled(leg, rejected) else None


class VectorChannel(_LegChannel):
    """Three numbers per leg: a force, or one value for each joint.

    Parameters
    ----------
    name : str
        Name of the channel in messages.
    legs : sequence of str
        Names of the legs in messages.
    bounds : sequence of ((low, high), (low, high), (low, high)), optional
        For each leg, the plausible range of each number; left out, every finite number is plausible.
    beyond : str
        The reason given for numbers outside these ranges.
    accept_z : bool
        Whether one number per leg, the third of three, is accepted too.
    settle : int
        Consecutive plausible readings after which a leg is accepted again.
    """

    def __init__(
        self,
        name: str,
        legs: Sequence[str],
        *,
        bounds: Sequence[tuple[Range, Range, Range]] | None = None,
        beyond: str = "",
        accept_z: bool = False,
        settle: int,
    ) -> None:
        super().__init__(name, legs, settle=settle)
        self._bounds, self._accept_z = bounds or [ANY_FINITE] * len(legs), accept_z
        self._shapes = ((len(legs), 3), (len(legs),)) if accept_z else ((len(legs), 3),)
        self._not_finite = tuple(f"{name} of {leg}: not finite numbers" for leg in legs)
        self._beyond = tuple(f"{name} of {leg}: {beyond}" for leg in legs)

    def read(self, value: Any, rejected: list[str]) -> tuple[Vector | None, ...] | None:
        """Return the accepted vectors; None for a leg, or for all, where none is.

        Parameters
        ----------
        value : anything
            The reading.
        rejected : list of str
            The reasons of rejections are appended to it.
        """
        items = as_items(value, *self._shapes)
        if items is None:
            self._reject_all(rejected)
            return None
        return _none_if_empty([self._read_leg(leg, item, rejected) for leg, item in enumerate(items)])

    def _read_leg(self, leg: int, value: Any, rejected: list[str]) -> Vector | None:
        alone = as_number(value) if self._accept_z and type(value) is not list else math.nan
        vector = as_vector(value) or _NOT_NUMBERS if math.isnan(alone) else (0.0, 0.0, alone)
        x, y, z = vector
        (x_low, x_high), (y_low, y_high), (z_low, z_high) = self._bounds[leg]
        if x_low <= x <= x_high and y_low <= y <= y_high and z_low <= z <= z_high:
            return vector if self._settled(leg, rejected) else None
        finite = x - x == 0.0 and y - y == 0.0 and z - z == 0.0
        self._reject(leg, self._beyond[leg] if finite else self._not_finite[leg], rejected)
        return None


def _none_if_empty(values: list[Any]) -> tuple[Any, ...] | None:
    """Return the values of the legs; None if all are None."""
    for value in values:
        if value is not None:
            return tuple(values)
    return None
