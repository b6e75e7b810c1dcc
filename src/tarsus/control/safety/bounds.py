"""What a guard lets through: the bounds, with defaults from the robot."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from tarsus.errors import InputError
from tarsus.robot.joint_limits import STOPPING_TIME, UNKNOWN_SPEED, servo_speeds
from tarsus.robot.robot import Robot

__all__ = ["GuardBounds"]

Floats = np.ndarray[Any, np.dtype[np.float64]]

# What each number must be above (or at, where True), and what it must be below.
_RANGES: dict[str, tuple[float, bool, float]] = {
    "drag": (0.0, False, math.inf),
    "ground": (0.0, False, math.inf),
    "slope": (0.0, True, math.pi / 2),
    "shortest": (0.0, False, 1.0),
    "longest": (0.0, False, 60.0),
    "near": (0.0, False, math.inf),
    "recovery": (0.0, False, 1.0),
    "sit_after": (0.0, True, math.inf),
    "sit_speed": (0.0, False, math.inf),
    "sit_height": (0.0, True, math.inf),
}


@dataclass(frozen=True, eq=False, kw_only=True)
class GuardBounds:
    """The bounds that a `Guard` keeps.

    Attributes
    ----------
    limits : array, shape (legs, 3, 2)
        Lowest and highest angle of each joint [rad].
    speed : array, shape (legs, 3)
        Highest speed of each joint [rad/s]; a number stands for all.
    acceleration : array, shape (legs, 3)
        Highest acceleration of each joint [rad/s^2]; a number stands for all.
    margin : float
        Least stability margin [m]; minus infinity for no check.
    drag : float
        How much the distance between two feet may change while both are said to be down [m]; infinity for no check.
    ground : float
        How far a foot that is said to be down may be above or below the ground's plane [m]; infinity for no check.
    slope : float
        Steepest ground where the body's attitude is given [rad].
    shortest, longest : float
        Shortest and longest time step that is taken for one [s].
    near : float
        How near the commanded angles must come to the held ones for the guard to recover [rad].
    recovery : float
        Share of each joint's bound on speed at which it catches up while recovering, and at most moves while sitting
        down.
    sit_after : float
        How long the robot is held at rest before it sits down [s].
    sit_speed : float
        How fast the body is lowered [m/s].
    sit_height : float
        How high the lowest point of body and legs but the feet then stays over the ground [m].
    assumed : tuple of str
        What was not known and had to be assumed.
    """

    limits: Floats
    speed: Floats
    acceleration: Floats
    margin: float = 0.0
    drag: float = 1e-3
    ground: float = 0.01
    slope: float = 0.0
    shortest: float = 1e-4
    longest: float = 0.1
    near: float = 0.1
    recovery: float = 0.25
    sit_after: float = 1.0
    sit_speed: float = 0.03
    sit_height: float = 0.005
    assumed: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        limits = _numbers("limits", self.limits)
        if limits.ndim != 3 or limits.shape[1:] != (3, 2):
            raise InputError(f"limits of a guard have shape {limits.shape}; expected (legs, 3, 2)")
        if (limits[..., 0] > limits[..., 1]).any():
            raise InputError("limits of a guard: a lowest angle is greater than its highest")
        self._lock("limits", limits)
        for name in ("speed", "acceleration"):
            self._lock(name, _each_joint(name, getattr(self, name), len(limits)))
        for name, (low, included, high) in _RANGES.items():
            object.__setattr__(self, name, _number(name, getattr(self, name)))
            value = getattr(self, name)
            if not (low < value or (included and value == low)) or not value <= high:
                at_least = "at least" if included else "more than"
                raise InputError(f"{name} of a guard is {value:g}; it must be {at_least} {low:g}, at most {high:g}")
        object.__setattr__(self, "margin", _number("margin", self.margin))
        if math.isnan(self.margin):
            raise InputError("margin of a guard is nan; it must be a number of metres, or minus infinity for no check")
        if self.longest < self.shortest:
            raise InputError(f"longest of a guard is {self.longest:g} s, less than shortest, {self.shortest:g} s")

    def _lock(self, name: str, array: Floats) -> None:
        array.setflags(write=False)
        object.__setattr__(self, name, array)

    @classmethod
    def of(cls, robot: Robot, **changes: Any) -> Self:
        """Return the bounds of a robot, some of them changed.

        Limits are the robot's; speeds its servos' without load, `UNKNOWN_SPEED` where that is unknown; accelerations
        the speed over `STOPPING_TIME`.

        Parameters
        ----------
        robot : Robot
            A single robot.
        **changes
            Attributes and their values; where speeds are given and accelerations are not, these follow from those.

        Raises
        ------
        InputError
            If the robot is a batch of designs, or a value has the wrong shape or range.
        """
        if robot.batch_shape:
            raise InputError(f"a guard is for a single robot; {robot.name!r} is a batch of {robot.batch_shape} designs")
        assumed: tuple[str, ...] = ()
        if "speed" not in changes:
            known = servo_speeds(robot)
            changes["speed"] = np.array([[speed or UNKNOWN_SPEED for speed in leg] for leg in known])
            unknown = sum(not speed for leg in known for speed in leg)
            if unknown:
                assumed = (f"{unknown} joints turn at up to {UNKNOWN_SPEED:g} rad/s: their servos' speed is unknown",)
        speed = _each_joint("speed", changes["speed"], robot.legs)
        values = {"limits": robot.limits, "acceleration": speed / STOPPING_TIME, "assumed": assumed, **changes}
        bounds = cls(**values)
        if len(bounds.limits) != robot.legs:
            raise InputError(f"limits of a guard are for {len(bounds.limits)} legs; {robot.name!r} has {robot.legs}")
        return bounds


def _number(name: str, value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        raise InputError(f"{name} of a guard is {value!r:.80}; it must be a number") from None


def _numbers(name: str, value: Any) -> Floats:
    try:
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError(f"{name} of a guard: expected an array of numbers: {error}") from None
    if not np.isfinite(array).all():
        raise InputError(f"{name} of a guard holds a value that is not a finite number")
    return array


def _each_joint(name: str, value: Any, legs: int) -> Floats:
    """Return a positive number for each joint."""
    array = _numbers(name, value)
    try:
        array = np.broadcast_to(array, (legs, 3)).copy()
    except ValueError:
        raise InputError(f"{name} of a guard has shape {array.shape}; expected a number or ({legs}, 3)") from None
    if not (array > 0).all():
        raise InputError(f"{name} of a guard is {array.min():g}; it must be greater than 0")
    return array
