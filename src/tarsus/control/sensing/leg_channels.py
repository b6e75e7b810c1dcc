"""Validation of channels with one reading per leg: contacts, and vectors such as forces, torques or joint angles."""

from __future__ import annotations

import math
import sys
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.control.readings import Vector
from tarsus.control.sensing.channel import Channel
from tarsus.control.sensing.plain_values import as_bool, as_items, as_number, as_vector

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["ContactChannel", "JointAngleChannel", "VectorChannel"]

# How far beyond their limits joints may be measured, and by how much angles may change at once [rad]; how much faster
# than its servo without load a joint may be turned.
_OUTSIDE, _JUMP, _FASTER = 0.5, 0.5, 2.0

_BOOLEAN = {bool}
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

        Parameters
        ----------
        value : anything
            The reading.
        rejected : list of str
            The reasons of rejections are appended to it.
        """
        items = as_items(value, *self._shapes)
        if items is None:
            rejected.append(self._wrong_shape)
            self.reset()
            return None
        if self._plausible == self._settled and (plain := self._plain(value, items)) is not None:
            return plain
        found = [self._accepted(leg, self._read_leg(leg, item), rejected) for leg, item in enumerate(items)]
        return None if found.count(None) == len(found) else tuple(found)

    @abstractmethod
    def _plain(self, value: Any, items: Sequence[Any]) -> tuple[Any, ...] | None:
        """Return readings that are seen at once to be plausible, as drivers give them; None for others."""

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

    def _plain(self, value: Any, items: Sequence[Any]) -> tuple[bool, ...] | None:  # noqa: ARG002 - the items tell
        return tuple(items) if set(map(type, items)) == _BOOLEAN else None

    def _read_leg(self, leg: int, value: Any) -> bool | str:  # noqa: ARG002 - all legs are read alike
        contact = value if type(value) is bool else as_bool(value)
        return "neither a boolean nor 0 or 1" if contact is None else contact


class VectorChannel(_LegChannel):
    """Three numbers per leg: a force, or one value for each joint.

    Parameters
    ----------
    name : str
        Name of the channel in messages.
    legs : sequence of str
        Names of the legs in messages.
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
        self._bounds, self._low, self._high = ranges.tolist(), ranges[..., 0], ranges[..., 1]
        self._unbounded, self._beyond, self._accept_z = bounds is None, beyond, accept_z

    def _plain(self, value: Any, items: Sequence[Any]) -> tuple[Vector, ...] | None:
        if type(value) is not np.ndarray or value.dtype != float or value.ndim != 2:
            return None
        if self._unbounded:
            # Of a finite sum all parts are finite.
            plain = math.isfinite(sum(map(sum, items)))
        else:
            plain = np.count_nonzero((self._low <= value) & (value <= self._high)) == value.size
        return tuple(map(tuple, items)) if plain else None

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
        # The last plausible angles of each leg, NaN before, and when they were read.
        self._last, self._read, self._speed = [_NOT_NUMBERS] * len(legs), [0.0] * len(legs), speed

    def _plain(self, value: Any, items: Sequence[Any]) -> tuple[Vector, ...] | None:
        if type(value) is not np.ndarray or value.dtype != float:
            return None
        angles = tuple(map(tuple, items))
        if not math.hypot(*map(math.dist, angles, self._last)) <= _JUMP:
            return None
        self._last, self._read = list(angles), [self._now] * len(items)
        return angles

    def _read_leg(self, leg: int, value: Any) -> Vector | str:
        angles = super()._read_leg(leg, value)
        if isinstance(angles, str):
            return angles
        most = _JUMP + _FASTER * self._speed * (self._now - self._read[leg])
        if any(abs(now - before) > most for now, before in zip(angles, self._last[leg], strict=True)):
            return "change faster than the servos turn"
        self._last[leg], self._read[leg] = angles, self._now
        return angles
