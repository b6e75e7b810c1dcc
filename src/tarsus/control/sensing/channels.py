"""Channels of sensor readings: parts of them are rejected, and accepted again once they have settled."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar

import numpy as np

from tarsus.control.readings import RollPitch, Vector
from tarsus.control.sensing.plain_values import as_bool, as_items, as_number, as_vector, between
from tarsus.gait.ground_heights import GroundHeights
from tarsus.kinematics.mass import known_weight
from tarsus.robot.joint_limits import joint_limits
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["channels_of"]

_T = TypeVar("_T")
# Consecutive plausible readings after which a part that was rejected is accepted again, from the next reading on.
_SETTLED = 3
# Greatest magnitude of roll and pitch [rad], and greatest rate of change of each [rad/s].
_MOST_TILT, _MOST_TURN = math.radians(60.0), 6.0
# Allowance for sensor noise in the change between two readings [rad].
_NOISE = 0.03
_BEYOND = f"roll or pitch beyond {math.degrees(_MOST_TILT):.4g} deg"
_TURNS = f"changes faster than {math.degrees(_MOST_TURN):.4g} deg/s"
# Joint angles: how far they may lie beyond their limits, and by how much they may change at once [rad]; how fast they
# may change besides, as a multiple of the no-load speed of the robot's fastest servo.
_OUTSIDE, _JUMP, _FASTER = 0.5, 0.5, 2.0
_Bounds: TypeAlias = "tuple[float | Float[np.ndarray, '...'], float | Float[np.ndarray, '...']]"
# Greatest force on one foot, in weights of the robot, and greatest torque, in stall torques of the joint's servo.
_MOST_WEIGHTS, _MOST_STALLS = 4.0, 1.5
# Weight [N] and stall torque [N m] assumed where masses or servos are unknown, above those of any intended robot.
_ANY_WEIGHT, _ANY_STALL_TORQUE = 1e4, 1e3
# Greatest downward force on a foot, in weights of the robot: a load cell's zero offset and the inertia of a swinging
# leg may cause it. Beyond that, the sign is wrong.
_PULL = 0.25
_TOO_HEAVY = f"beyond {_MOST_WEIGHTS:g} times the robot's weight, or downward beyond {_PULL:g} times"
_TOO_STRONG = f"beyond {_MOST_STALLS:g} times the stall torque"


def channels_of(robot: Robot) -> dict[str, Any]:
    """Return the channels of a single robot's readings, by name."""
    legs, weight = robot.leg_codes, known_weight(robot) or _ANY_WEIGHT
    force, fastest = _MOST_WEIGHTS * weight, float(joint_limits(robot).speed.max())
    stalls = [[servo.stall_torque if servo else _ANY_STALL_TORQUE for servo in row] for row in robot.servos]
    torque = _MOST_STALLS * np.array(stalls)
    pull = np.array([-force, -force, -_PULL * weight])
    return {
        "contacts": _ContactChannel("contacts", legs, bool, (len(legs),)),
        "attitude": _AttitudeChannel(),
        "joint_angles": _JointAngleChannel(legs, np.asarray(robot.limits), fastest),
        "forces": _ForceChannel("forces", legs, (pull, force), beyond=_TOO_HEAVY, accept_z=True),
        "torques": _VectorChannel("torques", legs, (-torque, torque), beyond=_TOO_STRONG),
        "angular_rates": _AngularRateChannel(["angular_rates"]),
        "ground": _GroundChannel(["ground"]),
    }


class _Channel:
    """A channel and its state: one part for the body, or one part for each leg.

    Parameters
    ----------
    names : sequence of str
        Names of the parts in messages.

    Attributes
    ----------
    now : float
        The present time [s].
    """

    def __init__(self, names: Sequence[str]) -> None:
        # How many plausible readings in a row each part still needs until it is accepted.
        self._names, self._unsettled, self.now = names, [0] * len(names), 0.0

    def reset(self) -> None:
        """Reject every part until it has been plausible `_SETTLED` times in a row."""
        self._unsettled = [_SETTLED] * len(self._names)

    def _accepted(self, part: int, reading: _T | str, rejected: list[str]) -> _T | None:
        """Return the reading of a part, or None if it is rejected; a text in its place says what is wrong with it."""
        if isinstance(reading, str):
            self._unsettled[part] = _SETTLED
            rejected.append(f"{self._names[part]}: {reading}")
        elif self._unsettled[part]:
            self._unsettled[part] -= 1
            rejected.append(f"{self._names[part]}: settling after a rejected reading")
        else:
            return reading
        return None


class _AttitudeChannel(_Channel):
    """Roll and pitch, plausible while they change no faster than a robot can turn."""

    def __init__(self) -> None:
        super().__init__(["attitude"])
        # Angle against gravity by the last reading, accepted or not; None for what no body can have [rad].
        self.tilt: float | None = None
        # The last reading within the greatest tilt, accepted or not, and when it was read.
        self._last: RollPitch | None = None
        self._read = 0.0

    def read(self, value: Any, rejected: list[str]) -> RollPitch | None:
        """Return the reading if it is accepted; the reason for a rejection is appended to `rejected`."""
        return self._accepted(0, self._checked(value), rejected)

    def _checked(self, value: Any) -> RollPitch | str:
        """Return a reading, or what is wrong with it; remember it if it is within the greatest tilt."""
        parts, self.tilt = as_items(value, (2,)), None
        if parts is None:
            return "expected roll and pitch"
        roll, pitch = as_number(parts[0]), as_number(parts[1])
        if abs(roll) <= math.pi >= abs(pitch):
            self.tilt = math.acos(math.cos(roll) * math.cos(pitch))
        if not (-_MOST_TILT <= roll <= _MOST_TILT and -_MOST_TILT <= pitch <= _MOST_TILT):
            return _BEYOND if roll - roll == 0.0 == pitch - pitch else "not finite numbers"
        before, change = self._last, _MOST_TURN * (self.now - self._read) + _NOISE
        self._last, self._read = (roll, pitch), self.now
        if before is not None and not (abs(roll - before[0]) <= change and abs(pitch - before[1]) <= change):
            return _TURNS
        return self._last


class _AngularRateChannel(_Channel):
    """Angular velocity of the body, plausible where it is finite."""

    def read(self, value: Any, rejected: list[str]) -> Vector | None:
        """Return the reading if it is accepted; the reason for a rejection is appended to `rejected`."""
        items = as_items(value, (3,))
        reading, wrong = as_vector(items), "not finite numbers" if items else "expected three numbers"
        return self._accepted(0, reading if all(map(math.isfinite, reading)) else wrong, rejected)


class _GroundChannel(_Channel):
    """Heights of the ground, which are checked when they are made, so that nothing has to settle."""

    def read(self, value: Any, rejected: list[str]) -> GroundHeights | None:
        """Return the heights; for anything else, append the reason to `rejected` and return None."""
        if type(value) is GroundHeights:
            return value
        rejected.append("ground: not of class GroundHeights")
        return None


class _LegChannel(_Channel, ABC):
    """A channel whose legs are rejected, and accepted again, one by one.

    Parameters
    ----------
    name, legs : str, sequence of str
        Name of the channel in messages; names of the legs in messages.
    kind, *shapes : type, tuple of int
        Data type of usual arrays, which are read fast; accepted shapes of arrays, the usual one first.
    """

    def __init__(self, name: str, legs: Sequence[str], kind: type, *shapes: tuple[int, ...]) -> None:
        super().__init__([f"{name} of {leg}" for leg in legs])
        self._shapes, self._wrong_shape = shapes, f"{name}: expected one reading per leg"
        self._usual = np.dtype(kind)

    def read(self, value: Any, rejected: list[str]) -> tuple[Any, ...] | None:
        """Return the accepted readings, None for a rejected leg; None as a whole where no leg's reading is accepted.

        The reasons for rejections are appended to `rejected`.
        """
        usual = type(value) is np.ndarray and value.dtype == self._usual and value.shape == self._shapes[0]
        if usual and not any(self._unsettled) and (found := self._read_usual(value.ravel().tolist())):
            return found
        items = as_items(value, *self._shapes)
        if items is None:
            rejected.append(self._wrong_shape)
            self.reset()
            return None
        found = tuple(self._accepted(leg, self._read_leg(leg, item), rejected) for leg, item in enumerate(items))
        return None if found.count(None) == len(found) else found

    @abstractmethod
    def _read_usual(self, numbers: list[Any]) -> tuple[Any, ...] | None:
        """Return the readings of all legs from the numbers of a usual array; None unless all are surely plausible."""

    @abstractmethod
    def _read_leg(self, leg: int, value: Any) -> Any:
        """Return the reading of a leg, or what is wrong with it."""


class _ContactChannel(_LegChannel):
    """Which feet touch the ground."""

    def _read_usual(self, numbers: list[bool]) -> tuple[bool, ...]:
        return tuple(numbers)

    def _read_leg(self, leg: int, value: Any) -> bool | str:  # noqa: ARG002 - all legs are read alike
        contact = value if type(value) is bool else as_bool(value)
        return "neither a boolean nor 0 or 1" if contact is None else contact


class _VectorChannel(_LegChannel):
    """Three numbers per leg: a force, or one value for each joint.

    Parameters
    ----------
    name, legs : str, sequence of str
        Name of the channel in messages; names of the legs in messages.
    bounds : tuple of (float or array, shape (3,) or (legs, 3))
        Least and greatest plausible value of each number.
    beyond : str
        The reason given for numbers outside the bounds.
    accept_z : bool
        Whether one number per leg, the last of the three, is accepted too.
    """

    def __init__(self, name: str, legs: Sequence[str], bounds: _Bounds, *, beyond: str, accept_z: bool = False) -> None:
        shape = (len(legs), 3)
        super().__init__(name, legs, float, shape, *([shape[:1]] if accept_z else []))
        self._low, self._high = (np.broadcast_to(bound, shape).ravel().tolist() for bound in bounds)
        self._beyond, self._accept_z = beyond, accept_z

    def _read_usual(self, numbers: list[float]) -> tuple[Vector, ...] | None:
        plausible = between(self._low, numbers, self._high)
        return tuple(zip(numbers[::3], numbers[1::3], numbers[2::3], strict=True)) if plausible else None

    def _read_leg(self, leg: int, value: Any) -> Vector | str:
        alone = as_number(value) if self._accept_z and type(value) is not list else math.nan
        vector = as_vector(value) if math.isnan(alone) else (0.0, 0.0, alone)
        if self._is_plausible(leg, vector):
            return vector
        return self._beyond if all(map(math.isfinite, vector)) else "not finite numbers"

    def _is_plausible(self, leg: int, vector: Vector) -> bool:
        of_leg = slice(3 * leg, 3 * leg + 3)
        return between(self._low[of_leg], vector, self._high[of_leg])


class _ForceChannel(_VectorChannel):
    """Forces on feet; friction on the side of an obstacle may add a downward force as great as the horizontal one."""

    def _is_plausible(self, leg: int, vector: Vector) -> bool:
        x, y, z = vector
        return super()._is_plausible(leg, (x, y, max(z, min(z + math.hypot(x, y), 0.0))))


class _JointAngleChannel(_VectorChannel):
    """Joint angles, plausible within or near the joints' limits, while they change no faster than a leg can be turned.

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
        bounds = limits[..., 0] - _OUTSIDE, limits[..., 1] + _OUTSIDE
        super().__init__("joint_angles", legs, bounds, beyond=beyond)
        # The last plausible angles of all legs, NaN before the first, and when those of each leg were read.
        self._last, self._read, self._speed = [math.nan] * 3 * len(legs), [0.0] * len(legs), speed

    def _read_usual(self, numbers: list[float]) -> tuple[Vector, ...] | None:
        found = super()._read_usual(numbers) if math.dist(numbers, self._last) <= _JUMP else None
        if found:
            self._last, self._read = numbers, [self.now] * len(self._read)
        return found

    def _read_leg(self, leg: int, value: Any) -> Vector | str:
        angles = super()._read_leg(leg, value)
        if isinstance(angles, str):
            return angles
        most, of_leg = _JUMP + _FASTER * self._speed * (self.now - self._read[leg]), slice(3 * leg, 3 * leg + 3)
        if any(abs(now - before) > most for now, before in zip(angles, self._last[of_leg], strict=True)):
            return "change faster than the servos turn"
        self._last[of_leg], self._read[leg] = angles, self.now
        return angles
