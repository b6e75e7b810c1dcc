"""What the live walker is asked for."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tarsus.errors import InputError

__all__ = ["BODY_AXES", "Wish", "numbers"]

BODY_AXES = ("x", "y", "z", "roll", "pitch", "yaw")
"""The six ways in which the body can be moved over its feet."""


@dataclass(frozen=True, kw_only=True)
class Wish:
    """What the robot should do; what is None stays as it is.

    Attributes
    ----------
    twist : (vx, vy, wz)
        Speed forward and to the left [m/s], turning speed counter-clockwise [rad/s].
    body : (x, y, z, roll, pitch, yaw), optional
        How the body is moved [m] and turned [rad] against standing level over its feet at its clearance.
    gait : str or Gait, optional
        The order of steps.
    clearance : float, optional
        Height of the body's origin over the ground [m].
    lift : float, optional
        How high a swinging foot rises [m].
    stance_width : float, optional
        How much farther out than usual the feet rest, away from each coxa axis [m].
    cycle_time : float, optional
        Duration of a cycle [s].
    sway : (x, y, z, roll, pitch, yaw), optional
        Amplitude of a rhythmic motion of the body with the steps [m], [rad].
    hands : mapping of leg to (x, y, z) or None, optional
        Legs that leave the gait, and where their feet go, in the heading frame [m]; None for a leg that comes back.
    hand_speeds : mapping of leg to (x, y, z), optional
        How fast the feet of such legs go from where they are instead, in the heading frame [m/s].
    """

    twist: Sequence[float] = (0.0, 0.0, 0.0)
    body: Sequence[float] | None = None
    gait: Any = None
    clearance: float | None = None
    lift: float | None = None
    stance_width: float | None = None
    cycle_time: float | None = None
    sway: Sequence[float] | None = None
    hands: Mapping[int, Sequence[float] | None] | None = None
    hand_speeds: Mapping[int, Sequence[float]] | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "twist", numbers("twist", self.twist, ("vx", "vy", "wz")))
        for name in ("body", "sway"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, numbers(name, getattr(self, name), BODY_AXES))
        for name in ("clearance", "lift", "stance_width", "cycle_time"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, numbers(name, (getattr(self, name),), (name,))[0])
        for name in ("hands", "hand_speeds"):
            given = getattr(self, name)
            if given is not None:
                checked = {leg: None if v is None else numbers(name, v, ("x", "y", "z")) for leg, v in given.items()}
                object.__setattr__(self, name, checked)


def numbers(name: str, values: Sequence[float], axes: Sequence[str]) -> tuple[float, ...]:
    """Return so many finite numbers.

    Parameters
    ----------
    name : str
        What they are, for the message.
    values : sequence of float
        The numbers.
    axes : sequence of str
        What each is called.

    Raises
    ------
    InputError
        If they are something else.
    """
    try:
        found = tuple(float(value) for value in values)
    except (TypeError, ValueError):
        raise InputError(
            f"the wish's {name} is {values!r}; it must be {len(axes)} numbers: {', '.join(axes)}"
        ) from None
    if len(found) != len(axes):
        raise InputError(f"the wish's {name} has {len(found)} numbers; it must have {len(axes)}: {', '.join(axes)}")
    for axis, value in zip(axes, found, strict=True):
        if not math.isfinite(value):
            raise InputError(f"the wish's {name} has {axis} = {value}; it must be finite")
    return found
