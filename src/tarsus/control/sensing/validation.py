"""Validation of sensor readings: only those that the robot could have measured are used."""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import chain
from operator import attrgetter
from typing import Any, TypeAlias

import numpy as np

from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.readings import CHANNELS, SensorReadings, ValidReadings, Vector
from tarsus.control.sensing.channel import AngularRateChannel, AttitudeChannel, Channel
from tarsus.control.sensing.leg_channels import ContactChannel, JointAngleChannel, VectorChannel
from tarsus.control.sensing.plain_values import as_items, as_number, as_vector
from tarsus.gait.ground_heights import GroundHeights
from tarsus.kinematics.mass import known_weight
from tarsus.robot.joint_limits import joint_limits
from tarsus.robot.robot import Robot

__all__ = ["ReadingsValidator", "rejections"]

# Greatest age of a reading [s], or in ticks where these are long.
_MOST_AGE, _MOST_TICKS = 0.1, 4.0
# Greatest force on one foot, in weights of the robot, and greatest torque, in stall torques of the joint's servo.
_MOST_WEIGHTS, _MOST_STALLS = 4.0, 1.5
# Bounds where the robot's masses or servos are unknown, above those of any robot this is made for.
_ANY_WEIGHT = 1e4  # [N]
_ANY_STALL_TORQUE = 1e3  # [N m]
# Greatest downward force on a foot, in weights: from a load cell's zero offset and the inertia of a swinging leg.
# Beyond that the sign is wrong.
_PULL = 0.25
# Channels that are plausible wherever they are finite.
_FINITE_CHANNELS = ("joint_speeds", "currents", "temperatures", "voltages")

# Ages of the joints of each leg, where they are given one by one.
_Ages: TypeAlias = tuple[Vector, ...] | None

_NO_READINGS, _NO_AGES, _NONE = ValidReadings(), (math.nan, math.nan, math.nan), frozenset[int]()
_VALUES, _JOINT_ANGLES = attrgetter(*CHANNELS), CHANNELS.index("joint_angles")
_BAD_AGE = "age is not a number >= 0 s"


class ReadingsValidator:
    """Passes plausible readings on, tick by tick, and names the others.

    A reading is rejected if it does not consist of finite numbers in the right shape, is too old, or lies outside
    the range the robot can measure: for one leg if only that leg's reading is wrong, otherwise the whole channel.
    After a rejection a channel is accepted again once it has been plausible three times in a row. No content of the
    fields raises an error.

    Parameters
    ----------
    robot : Robot
        A single robot; forces and torques are bounded by its weight and its servos' stall torques where known.
    """

    def __init__(self, robot: Robot) -> None:
        legs, fastest = robot.leg_codes, float(joint_limits(robot).speed.max())
        self._legs = legs
        channels: dict[str, Any] = {
            "contacts": ContactChannel(legs),
            "attitude": AttitudeChannel(),
            "joint_angles": JointAngleChannel(legs, np.asarray(robot.limits), fastest),
            "forces": _forces_channel(robot),
            "torques": _torques_channel(robot),
            **{name: VectorChannel(name, legs) for name in _FINITE_CHANNELS},
            "angular_rates": AngularRateChannel(["angular_rates"]),
            "ground": _GroundChannel(["ground"]),
        }
        self._channels: list[Any] = [channels[name] for name in CHANNELS]
        self._timed: list[Channel] = [channels["attitude"], channels["joint_angles"]]

    def validate(self, readings: SensorReadings | None, dt: float) -> ValidReadings:
        """Return the readings that pass, and the reasons of all rejections.

        Parameters
        ----------
        readings : SensorReadings or None
            The readings; an object of any other class is rejected as a whole.
        dt : float
            Time since the last call [s].
        """
        for channel in self._timed:
            channel.now += dt
        if readings is None:
            return _NO_READINGS
        most = max(_MOST_AGE, _MOST_TICKS * dt)
        problem, ages, of_joints = _channel_ages(readings, most, legs=len(self._legs))
        if problem:
            for channel in self._channels:
                channel.reset()
            return ValidReadings(rejected=(problem,))
        rejected: list[str] = []
        values = _VALUES(readings)
        if ages:
            values = self._fresh(values, ages, most, rejected)
        found: list[Any] = [
            value if value is None else channel.read(value, rejected)
            for channel, value in zip(self._channels, values, strict=True)
        ]
        if not ages:
            # An age that is no number is none.
            age = max(0.0, as_number(readings.age))
            return ValidReadings._make((*found, age, None, age, age, _NONE, tuple(rejected)))
        given = [name for name, value in zip(CHANNELS, values, strict=True) if value is not None]
        if of_joints and found[_JOINT_ANGLES]:
            young = self._young(of_joints, most, rejected)
            kept = tuple(each if leg in young else None for leg, each in enumerate(found[_JOINT_ANGLES]))
            found[_JOINT_ANGLES] = kept if any(kept) else None
            ages["joint_angles"] = max((max(of_joints[leg]) for leg in young), default=0.0)
        tells = next((name for name in ("contacts", "forces") if name in given), "joint_angles")
        joint, ground, contact = (max(0.0, ages.get(name, 0.0)) for name in ("joint_angles", "ground", tells))
        return ValidReadings._make((*found, joint, of_joints, ground, contact, _NONE, tuple(rejected)))

    def _fresh(
        self, values: tuple[Any, ...], ages: dict[str, float], most: float, rejected: list[str]
    ) -> tuple[Any, ...]:
        """Return the readings, None for those that are too old."""
        fresh = list(values)
        for index, (name, value) in enumerate(zip(CHANNELS, values, strict=True)):
            if value is not None and (stale := _stale(name, ages.get(name, 0.0), most)):
                rejected.append(stale)
                self._channels[index].reset()
                fresh[index] = None
        return tuple(fresh)

    def _young(self, ages: tuple[Vector, ...], most: float, rejected: list[str]) -> list[int]:
        """Return the legs of which no joint angle is too old."""
        pairs = zip(self._legs, ages, strict=True)
        stale = [_stale(f"joint_angles of {leg}", _oldest(of_leg), most) for leg, of_leg in pairs]
        rejected += filter(None, stale)
        return [leg for leg, problem in enumerate(stale) if not problem]


def rejections(valid: ValidReadings) -> list[Limitation]:
    """Return the limitations that name rejected readings."""
    return [Limitation(kind=LimitationKind.READINGS, cause=reason) for reason in valid.rejected]


class _GroundChannel(Channel):
    """Heights of the ground, which have been checked as they were made: nothing has to settle."""

    def read(self, value: Any, rejected: list[str]) -> GroundHeights | None:
        if type(value) is GroundHeights:
            return value
        rejected.append("ground: not of class GroundHeights")
        return None


def _channel_ages(readings: SensorReadings, most: float, *, legs: int) -> tuple[str, dict[str, float], _Ages]:
    """Return what is wrong with all readings together, "" if nothing is; the ages of single channels; those of joints.

    Where joints have an age each, that of joint angles is 0, as they are rejected leg by leg, and that of another
    channel the greatest one.
    """
    if type(readings) is not SensorReadings:
        return "all channels: not of class SensorReadings", {}, None
    age: Any = readings.age
    if type(age) is float or not hasattr(type(age), "keys"):
        return _stale("all channels", as_number(age), most), {}, None
    try:
        given = {name: age[name] for name in CHANNELS if name in age}
        unknown = len(age) != len(given)
    except Exception:  # a foreign mapping may raise anything
        return f"all channels: {_BAD_AGE}", {}, None
    ages, of_joints = dict[str, float](), None
    for name, value in given.items():
        ages[name] = as_number(value)
        if math.isnan(ages[name]) and (rows := as_items(value, (legs, 3))):
            vectors = tuple(as_vector(row) or _NO_AGES for row in rows)
            ages[name] = _oldest(chain(*vectors))
            if name == "joint_angles":
                of_joints, ages[name] = vectors, 0.0
    return ("all channels: age of one that does not exist" if unknown else ""), ages, of_joints


def _oldest(ages: Iterable[float]) -> float:
    """Return the greatest age; NaN if one is no number >= 0."""
    known = list(ages)
    return max(known) if all(age >= 0.0 for age in known) else math.nan


def _stale(name: str, age: float, most: float) -> str:
    """Return what is wrong with an age, "" if it is at most the greatest."""
    if 0.0 <= age <= most:
        return ""
    return f"{name}: older than {1e3 * most:.3g} ms" if age > 0 else f"{name}: {_BAD_AGE}"


def _forces_channel(robot: Robot) -> VectorChannel:
    weight = known_weight(robot) or _ANY_WEIGHT
    most = _MOST_WEIGHTS * weight
    bounds = np.tile([[-most, most], [-most, most], [-_PULL * weight, most]], (robot.legs, 1, 1))
    beyond = f"beyond {_MOST_WEIGHTS:g} times the robot's weight, or downward beyond {_PULL:g} times"
    return VectorChannel("forces", robot.leg_codes, bounds=bounds, beyond=beyond, accept_z=True)


def _torques_channel(robot: Robot) -> VectorChannel:
    most = np.array(
        [[_MOST_STALLS * (s.stall_torque if s else _ANY_STALL_TORQUE) for s in row] for row in robot.servos]
    )
    beyond = f"beyond {_MOST_STALLS:g} times the stall torque"
    return VectorChannel("torques", robot.leg_codes, bounds=np.stack([-most, most], axis=-1), beyond=beyond)
