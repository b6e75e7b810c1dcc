"""Commands: what the robot is asked to do, and how a command builds on earlier ones."""

from __future__ import annotations

import math
import operator
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

from tarsus.control.robot_state import requested_state
from tarsus.errors import InputError
from tarsus.gait.gait import Gait
from tarsus.representation import represented
from tarsus.robot.robot import require_leg_number

__all__ = ["BODY_AXES", "Command", "merged", "stopped"]

BODY_AXES = ("x", "y", "z", "roll", "pitch", "yaw")
"""The six axes of a body pose."""

# Greatest magnitude of any value but the twist [m], [rad], [m/s], [s]: beyond any robot, and safe to square.
_MOST = 1e3
_PARAMETERS = ("body", "gait", "body_height", "swing_height", "stance_width", "cycle_time", "sway")


@represented()
@dataclass(frozen=True, kw_only=True)
class Command:
    """What the robot is commanded to do; what is None stays as it is, except foot velocities.

    Attributes
    ----------
    twist : (vx, vy, wz)
        Twist: forward, left [m/s], turning counter-clockwise [rad/s].
    body : (x, y, z, roll, pitch, yaw), optional
        Body pose [m], [rad] against level over the feet at the body height.
    gait : str or Gait, optional
        Order of the steps: the name of a gait, or a `Gait` for the robot's number of legs.
    body_height : float, optional
        Height of the body's origin over the ground [m].
    swing_height : float, optional
        Height of a swinging foot over its foothold [m].
    stance_width : float, optional
        How much farther from its coxa axis each foot rests than by default [m].
    cycle_time : float or "auto", optional
        Duration of a cycle [s]; "auto" for the one with the highest top speed.
    sway : (x, y, z, roll, pitch, yaw), optional
        Amplitudes of a periodic motion of the body in time with the steps [m], [rad].
    foot_targets : mapping of leg to (x, y, z) or None, optional
        Legs to take out of the gait, and the targets of their feet in the heading frame [m]; None for a leg to return
        to the gait.
    foot_velocities : mapping of leg to (x, y, z), optional
        Legs to take out of the gait, and velocities of their feet instead of targets, in the heading frame [m/s]. They
        hold for this command only.
    state : RobotState or str, optional
        The state to go to: standing, lying or folded. Only a `RobotController` uses it.

    Raises
    ------
    InputError
        If a value is not finite, of another type or out of its range.
    """

    twist: Sequence[float] = (0.0, 0.0, 0.0)
    body: Sequence[float] | None = None
    gait: Any = None
    body_height: float | None = None
    swing_height: float | None = None
    stance_width: float | None = None
    cycle_time: float | Literal["auto"] | None = None
    sway: Sequence[float] | None = None
    foot_targets: Mapping[int, Sequence[float] | None] | None = None
    foot_velocities: Mapping[int, Sequence[float]] | None = None
    state: Any = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "twist", _finite("twist", self.twist, ("vx", "vy", "wz"), most=math.inf))
        if self.only_twist:
            return
        for name in ("body", "sway"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, _finite(name, getattr(self, name), BODY_AXES))
        for name in ("body_height", "swing_height", "stance_width", "cycle_time"):
            value = getattr(self, name)
            auto = name == "cycle_time" and isinstance(value, str) and value == "auto"
            if value is not None and not auto:
                object.__setattr__(self, name, _finite(name, (value,), (name,))[0])
        self._require_ranges()
        for name in ("foot_targets", "foot_velocities"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, _by_leg(name, getattr(self, name), back=name == "foot_targets"))

    def _require_ranges(self) -> None:
        if self.gait is not None and not isinstance(self.gait, str | Gait):
            raise InputError(f"the command's gait is {self.gait!r}; it must be a name or a Gait")
        if self.swing_height is not None and self.swing_height < 0:
            raise InputError(f"the command's swing_height is {self.swing_height} m; it must not be negative")
        if isinstance(self.cycle_time, float) and self.cycle_time <= 0:
            raise InputError(f"the command's cycle_time is {self.cycle_time} s; it must be greater than 0")

    @property
    def parameters(self) -> dict[str, Any]:
        """The commanded parameters of walking, by name: those that are not None."""
        return {name: value for name in _PARAMETERS if (value := getattr(self, name)) is not None}

    @property
    def only_twist(self) -> bool:
        """Whether the command changes nothing of the walk but the twist."""
        return self.foot_targets is None and self.foot_velocities is None and not self.parameters


def merged(command: Command, before: Command, legs: int) -> Command:
    """Return a command completed from the one before: what is None stays as it was, except foot velocities.

    Parameters
    ----------
    command, before, legs : Command, Command, int
        The command; the one before, itself already merged; the robot's number of legs.

    Raises
    ------
    InputError
        If the gait or a leg does not fit the robot, or the state is not one that a command may ask for.
    UnknownNameError
        If there is no such gait.
    """
    changes = command.parameters
    if isinstance(changes.get("gait"), str):
        changes["gait"] = Gait.named(changes["gait"], legs=legs)
    if "gait" in changes:
        changes["gait"].require_legs(legs)
    if command.state is not None:
        changes["state"] = requested_state(command.state)
    velocities = command.foot_velocities
    targets = {**(before.foot_targets or {}), **(command.foot_targets or {})}
    targets = {leg: point for leg, point in targets.items() if leg not in (velocities or {})}
    for leg in (*targets, *(velocities or {})):
        require_leg_number("foot_targets", leg, legs)
    return replace(before, twist=command.twist, foot_targets=targets or None, foot_velocities=velocities, **changes)


def stopped(command: Command, legs: int) -> Command:
    """Return a command with no twist and every foot back in the gait: a robot stops like this before it sits down."""
    targets = dict.fromkeys(range(legs)) if command.foot_targets or command.foot_velocities else None
    return replace(command, twist=(0.0, 0.0, 0.0), foot_targets=targets, foot_velocities=None)


def _by_leg(name: str, given: Any, *, back: bool) -> dict[int, tuple[float, ...] | None]:
    """Return the checked values by leg; with `back`, a value may be None, to return the leg to the gait."""
    if not isinstance(given, Mapping):
        raise InputError(f"the command's {name} is {given!r}; it must be a mapping of legs to x, y, z")
    found: dict[int, tuple[float, ...] | None] = {}
    for leg, value in given.items():
        try:
            number = operator.index(leg)
        except TypeError:
            raise InputError(f"the command's {name} names the leg {leg!r}; it must be a whole number") from None
        found[number] = None if value is None and back else _finite(f"{name}[{number}]", value, ("x", "y", "z"))
    return found


def _finite(name: str, values: Sequence[float], axes: Sequence[str], *, most: float = _MOST) -> tuple[float, ...]:
    """Return values as finite floats, one for each axis, none greater in magnitude than `most`."""
    single = len(axes) == 1
    try:
        found = tuple(_number(value) for value in values)
    except (TypeError, ValueError, OverflowError):
        needed = "a number" if single else f"{len(axes)} numbers: {', '.join(axes)}"
        raise InputError(f"the command's {name} is {values[0] if single else values!r}; it must be {needed}") from None
    if len(found) != len(axes):
        raise InputError(f"the command's {name} has {len(found)} numbers; it must have {len(axes)}: {', '.join(axes)}")
    for axis, value in zip(axes, found, strict=True):
        if math.isfinite(value) and abs(value) <= most:
            continue
        what = f"{name} is {value}" if axis == name else f"{name} has {axis} = {value}"
        bound = f"between {-most:g} and {most:g}" if math.isfinite(value) else "finite"
        raise InputError(f"the command's {what}; it must be {bound}")
    return found


def _number(value: Any) -> float:
    if isinstance(value, str):
        raise TypeError
    return float(value)
