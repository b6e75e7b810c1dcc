"""Validation of channels with one reading per leg: contacts, and vectors such as forces, torques or joint angles."""

from __future__ import annotations

import math
import sys
from abc import ABC, abstractmethod
from collections.abc import Sequence
from operator import itemgetter, le
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.control.readings import Vector
from tarsus.control.sensing.channel import Channel
from tarsus.control.sensing.plain_values import as_bool, as_items, as_number, as_vector

if TYPE_CHECKING:
    from jaxtyping import Float, Shaped

__all__ = ["ContactChannel", "JointAngleChannel", "VectorChannel"]

# How far beyond their limits joints may be measured, and by how much angles may change at once [rad]; how much faster
# than its servo without load a joint may be turned.
_OUTSIDE, _JUMP, _FASTER = 0.5, 0.5, 2.0

_BOOLEAN, _FLOAT = np.dtype(bool), np.dtype(float)
_NOT_NUMBERS = (math.nan, math.nan, math.nan)
# Bounds that every finite vector meets.
_ANY_FINITE = ((-sys.float_info.max, sys.float_info.max),) * 3


class _LegChannel(Channel, ABC):
    """A channel whose legs are rejected, and accepted again, one by one."""

    def __init__(self, name: str, legs: Sequence[str], *shapes: tuple[int, ...]) -> None:
        super().__init__([f"{name} of {leg}" for leg in legs])
        self._shapes, self._wrong_shape = shapes, f"{name}: expected one reading per leg"
        self._settled = list(self._plausible)

    def read(self, value: Any, rejected: list[str]) -> tuple[Any, ...] | None:
        """Return the accepted readings; None for a leg, or for all, where none is.

        The reasons of rejections are appended to `rejected`.
        """
        if type(value) is np.ndarray and value.shape == self._shapes[0] and self._plausible == self._settled:
            plain = self._plain(value)
            if plain is not None:
                return plain
        items = as_items(value, *self._shapes)
        if items is None:
            rejected.append(self._wrong_shape)
            self.reset()
            return None
        found = [self._accepted(leg, self._read_leg(leg, item), rejected) for leg, item in enumerate(items)]
        return None if found.count(None) == len(found) else tuple(found)

    @abstractmethod
    def _plain(self, value: Shaped[np.ndarray, "..."]) -> tuple[Any, ...] | None:
        """Return the readings of an array that are seen at once to be plausible; None for others."""

    @abstractmethod
    def _read_leg(self, leg: int, value: Any) -> Any:
        """Return the reading of a leg, or what is wrong with it."""


class ContactChannel(_LegChannel):
    """Which feet touch the ground.

    Parameters
    ----------
    legs : sequence of str
        Names of the legs in messages.
    """

    def __init__(self, legs: Sequence[str]) -> None:
        super().__init__("contacts", legs, (len(legs),))

    def _plain(self, value: Shaped[np.ndarray, "legs"]) -> tuple[bool, ...] | None:
        return tuple(value.tolist()) if value.dtype is _BOOLEAN else None

    def _read_leg(self, leg: int, value: Any) -> bool | str:  # noqa: ARG002 - all legs are read alike
        contact = value if type(value) is bool else as_bool(value)
        return "neither a boolean nor 0 or 1" if contact is None else contact


class VectorChannel(_LegChannel):
    """Three numbers per leg: a force, or one value for each joint.

    Parameters
    ----------
    name, legs : str, sequence of str
        Name of the channel in messages; names of the legs in messages.
    bounds : array, shape (legs, 3, 2), optional
        Plausible range of each number; left out, every finite number is plausible.
    beyond : str
        The reason given for numbers outside these ranges.
    accept_z : bool
        Whether one number per leg, the third of three, is accepted too.
    """

    def __init__(
        self,
        name: str,
        legs: Sequence[str],
        *,
        bounds: Float[np.ndarray, "legs 3 2"] | None = None,
        beyond: str = "",
        accept_z: bool = False,
    ) -> None:
        super().__init__(name, legs, (len(legs), 3), *([(len(legs),)] if accept_z else []))
        ranges = np.tile(_ANY_FINITE, (len(legs), 1, 1)) if bounds is None else bounds
        self._bounds = ranges.tolist()
        self._low, self._high = (ranges[..., side].ravel().tolist() for side in (0, 1))
        # A norm up to which all numbers are plausible, and one up to which none is too great.
        self._small, self._below = float(np.abs(ranges).min()), min(self._high)
        self._beyond, self._accept_z = beyond, accept_z
        self._by_leg = itemgetter(*(slice(leg, leg + 3) for leg in range(0, 3 * len(legs), 3)))

    def _plain(self, value: Shaped[np.ndarray, "..."]) -> tuple[Vector, ...] | None:
        if value.dtype is not _FLOAT:
            return None
        numbers: list[float] = value.ravel().tolist()
        plain: tuple[Vector, ...] | None = self._by_leg(tuple(numbers)) if self._contains(numbers) else None
        return plain

    def _contains(self, numbers: list[float]) -> bool:
        """Return whether the numbers of all legs are plausible."""
        norm = math.hypot(*numbers)
        if norm <= self._small:
            return True
        return all(map(le, self._low, numbers)) and (norm <= self._below or all(map(le, numbers, self._high)))

    def _read_leg(self, leg: int, value: Any) -> Vector | str:
        alone = as_number(value) if self._accept_z and type(value) is not list else math.nan
        vector = as_vector(value) or _NOT_NUMBERS if math.isnan(alone) else (0.0, 0.0, alone)
        x, y, z = vector
        (x_low, x_high), (y_low, y_high), (z_low, z_high) = self._bounds[leg]
        if x_low <= x <= x_high and y_low <= y <= y_high and z_low <= z <= z_high:
            return vector
        finite = x - x == 0.0 and y - y == 0.0 and z - z == 0.0
        return self._beyond if finite else "not finite numbers"


class JointAngleChannel(VectorChannel):
    """Joint angles, plausible near the joints' limits and while they change no faster than a leg is turned.

    Parameters
    ----------
    legs : sequence of str
        Names of the legs in messages.
    limits : array, shape (legs, 3, 2)
        Lower and upper limit of each joint [rad].
    speed : float
        Greatest speed of any joint [rad/s].
    """

    def __init__(self, legs: Sequence[str], limits: Float[np.ndarray, "legs 3 2"], speed: float) -> None:
        beyond = f"beyond the joint's limits by more than {math.degrees(_OUTSIDE):.3g} deg"
        super().__init__("joint_angles", legs, bounds=limits + np.array([-_OUTSIDE, _OUTSIDE]), beyond=beyond)
        # The last plausible angles of all legs, NaN before, and when those of each leg were read.
        self._last, self._read, self._speed = [*_NOT_NUMBERS] * len(legs), [0.0] * len(legs), speed

    def _contains(self, numbers: list[float]) -> bool:
        """Return whether the angles of all legs are plausible, which are the last ones then."""
        if not (math.dist(numbers, self._last) <= _JUMP and super()._contains(numbers)):
            return False
        self._last, self._read = numbers, [self.now] * len(self._read)
        return True

    def _read_leg(self, leg: int, value: Any) -> Vector | str:
        angles = super()._read_leg(leg, value)
        if isinstance(angles, str):
            return angles
        most, of_leg = _JUMP + _FASTER * self._speed * (self.now - self._read[leg]), slice(3 * leg, 3 * leg + 3)
        if any(abs(now - before) > most for now, before in zip(angles, self._last[of_leg], strict=True)):
            return "change faster than the servos turn"
        self._last[of_leg], self._read[leg] = angles, self.now
        return angles
