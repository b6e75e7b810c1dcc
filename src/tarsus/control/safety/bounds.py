"""Bounds of the guard, with defaults from the robot."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from tarsus.arrays import as_floats, read_only, require_finite, require_float
from tarsus.errors import InputError
from tarsus.representation import represented
from tarsus.robot.joint_limits import STOPPING_TIME, UNKNOWN_SPEED, joint_limits, per_joint, servo_speeds
from tarsus.robot.robot import Robot, require_robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["GuardBounds"]


def _bounded(default: float, high: float = math.inf, *, zero: bool = False) -> Any:
    """Return a field for a number that is greater than 0, or with `zero` at least 0, and at most `high`."""
    return field(default=default, metadata={"high": high, "zero": zero})


@represented()
@dataclass(frozen=True, eq=False, kw_only=True)
class GuardBounds:
    """Bounds that a `Guard` enforces.

    Attributes
    ----------
    limits : array, shape (legs, 3, 2)
        Lower and upper limit of each joint angle [rad].
    speed : array, shape (legs, 3)
        Greatest speed of each joint [rad/s]; a single number applies to all.
    acceleration : array, shape (legs, 3)
        Greatest acceleration of each joint [rad/s^2]; a single number applies to all.
    margin : float
        Least stability margin [m]; minus infinity disables the check.
    foot_drag : float
        Greatest change of the distance between two feet while both are in stance, beyond that by rolling of spherical
        feet [m]; infinity disables the check.
    foot_height : float
        Greatest distance of a stance foot above or below the ground plane [m]; infinity disables the check.
    ground_slope : float
        Steepest ground that is expected where the attitude of the body is given [rad].
    min_time_step, max_time_step : float
        Shortest and longest valid time step [s].
    recovery_distance : float
        Greatest distance of a commanded joint angle from the held one at which the guard recovers [rad].
    recovery_speed : float
        Greatest joint speed while recovering and while sitting down, as a fraction of `speed`.
    sit_delay : float
        Time at rest before the robot sits down [s].
    sit_speed : float
        Speed at which the body is lowered [m/s].
    sit_height : float
        Final height over the ground of the lowest point of body and legs, feet excluded [m].
    assumptions : tuple of str
        Defaults that replace unknown values.
    """

    limits: Float[np.ndarray, "legs 3 2"]
    speed: Float[np.ndarray, "legs 3"]
    acceleration: Float[np.ndarray, "legs 3"]
    margin: float = 0.0
    foot_drag: float = _bounded(1e-3)
    foot_height: float = _bounded(0.01)
    ground_slope: float = _bounded(0.0, math.pi / 2, zero=True)
    min_time_step: float = _bounded(1e-4, 1.0)
    max_time_step: float = _bounded(0.1, 60.0)
    recovery_distance: float = _bounded(0.1)
    recovery_speed: float = _bounded(0.25, 1.0)
    sit_delay: float = _bounded(1.0, zero=True)
    sit_speed: float = _bounded(0.03)
    sit_height: float = _bounded(0.005, zero=True)
    assumptions: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "limits", _checked_limits(self.limits))
        for name in ("speed", "acceleration"):
            object.__setattr__(self, name, per_joint(f"guard bound {name}", getattr(self, name), len(self.limits)))
        for name, high, zero in ((each.name, *each.metadata.values()) for each in fields(self) if each.metadata):
            value = require_float(f"guard bound {name}", getattr(self, name))
            object.__setattr__(self, name, value)
            if not (value > 0 or (zero and value == 0)) or not value <= high:
                at_least = "at least" if zero else "greater than"
                raise InputError(f"guard bound {name} is {value:g}; it must be {at_least} 0 and at most {high:g}")
        object.__setattr__(self, "margin", require_float("guard bound margin", self.margin))
        if math.isnan(self.margin):
            raise InputError("guard bound margin is nan; it must be a number [m], minus infinity to disable the check")
        if self.max_time_step < self.min_time_step:
            raise InputError(
                f"guard bound max_time_step is {self.max_time_step:g} s; it must be at least min_time_step, "
                f"{self.min_time_step:g} s"
            )

    @classmethod
    def of(cls, robot: Robot, **changes: Any) -> Self:
        """Return the default bounds of a robot, with changes.

        By default, `limits` are those of the robot, `speed` is the servos' no-load speed (5 rad/s where unknown), and
        `acceleration` reaches `speed` within 0.05 s.

        Parameters
        ----------
        robot : Robot
            A single robot.
        **changes
            Attributes and their values. A changed `speed` also changes the default `acceleration`.

        Raises
        ------
        InputError
            If the robot is a batch of designs, or a value has the wrong shape or is out of range.
        """
        require_robot(robot)
        if robot.batch_shape:
            raise InputError(f"a guard needs a single robot; {robot.name!r} is a batch of {robot.batch_shape} designs")
        unknown = 0 if "speed" in changes else sum(not speed for leg in servo_speeds(robot) for speed in leg)
        assumed = f"joint speed {UNKNOWN_SPEED:g} rad/s for {unknown} joints: servo speed unknown"
        speed = per_joint("guard bound speed", changes.get("speed", joint_limits(robot).speed), robot.legs)
        defaults = {"limits": robot.limits, "speed": speed, "acceleration": speed / STOPPING_TIME}
        bounds = cls(**{**defaults, "assumptions": (assumed,) if unknown else (), **changes})
        if len(bounds.limits) != robot.legs:
            raise InputError(f"guard bound limits is for {len(bounds.limits)} legs; {robot.name!r} has {robot.legs}")
        return bounds


def _checked_limits(value: Any) -> Float[np.ndarray, "n 3 2"]:
    limits: np.ndarray = read_only(np.array(as_floats(np, value, name="guard bound limits")))
    require_finite("guard bound limits", limits)
    if limits.ndim != 3 or limits.shape[1:] != (3, 2):
        raise InputError(f"guard bound limits has shape {limits.shape}; expected (legs, 3, 2)")
    if (limits[..., 0] > limits[..., 1]).any():
        raise InputError("guard bound limits: a lower limit is greater than its upper limit")
    return limits
