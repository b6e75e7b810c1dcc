"""Shapes and ranges of the arrays of a robot."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import Array
from tarsus.errors import InputError

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["JOINTS", "OPTIONAL", "TAILS", "locked"]

JOINTS = ("coxa", "femur", "tibia")
"""The joints of a leg, in the order of the last axis of an array of joint angles."""

# Axes of each array after its batch axes; "legs" stands for the number of legs.
TAILS: dict[str, tuple[str | int, ...]] = {
    "mount_position": ("legs", 3),
    "mount_yaw": ("legs",),
    "coxa": ("legs",),
    "femur": ("legs",),
    "tibia": ("legs",),
    "femur_axis_offset": ("legs", 2),
    "limits": ("legs", 3, 2),
    "foot_radius": ("legs",),
    "link_com": ("legs", 3),
    "link_mass": ("legs", 3),
    "body_mass": (),
    "body_com": (3,),
    "body_size": (3,),
}
OPTIONAL = ("link_mass", "body_mass", "body_size")
_POSITIVE = ("femur", "tibia", "body_mass", "body_size")
# Tolerance of the bounds of joint limits, +-180 deg [rad].
_ROUNDING = 1e-9
_NOT_NEGATIVE = ("coxa", "foot_radius", "link_mass")


def locked(name: str, value: Float[Array, "..."], *, legs: int, robot: str) -> Float[Array, "..."]:
    """Check a value; return NumPy arrays as a locked copy, and arrays of other libraries as they are.

    Parameters
    ----------
    name : str
        One of `TAILS`.
    value : array
        The value.
    legs : int
        Number of legs.
    robot : str
        Name of the robot in messages.

    Raises
    ------
    InputError
        If its shape is wrong, or a number is not finite or out of range.
    """
    if isinstance(value, np.ndarray | np.generic) or not hasattr(value, "shape"):
        try:
            value = np.array(value, dtype=np.float64)
        except (TypeError, ValueError) as error:
            raise InputError(f"{robot}: {name}: expected an array of numbers: {error}") from None
        value.setflags(write=False)
    tail = tuple(legs if n == "legs" else n for n in TAILS[name])
    if tail and tuple(value.shape[-len(tail) :]) != tail:
        expected = ", ".join(["...", *map(str, tail)])
        raise InputError(f"{robot}: {name} has shape {tuple(value.shape)}; expected ({expected})")
    if isinstance(value, np.ndarray):
        _check_range(name, value, robot=robot)
    return value


def _check_range(name: str, value: Float[np.ndarray, "..."], *, robot: str) -> None:
    if not np.isfinite(value).all():
        raise InputError(f"{robot}: {name} contains a value that is not a finite number")
    lowest = float(value.min()) if value.size else np.inf
    if name in _POSITIVE and lowest <= 0:
        raise InputError(f"{robot}: {name} is {lowest:g}; it must be greater than 0")
    if name in _NOT_NEGATIVE and lowest < 0:
        raise InputError(f"{robot}: {name} is {lowest:g}; it must not be negative")
    if name == "limits" and (value[..., 0] > value[..., 1]).any():
        raise InputError(f"{robot}: limits: a lower limit is greater than its upper limit")
    if name == "limits" and value.size and np.abs(value).max() > np.pi + _ROUNDING:
        raise InputError(
            f"{robot}: limits reach {np.degrees(np.abs(value).max()):.1f} deg; they must be from -180 to 180 deg"
        )
