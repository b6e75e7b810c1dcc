"""Validation of sensor readings: only those that the robot could have measured are used."""

from __future__ import annotations

from operator import attrgetter
from typing import Any

import numpy as np

from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.readings import CHANNELS, SensorReadings, ValidReadings
from tarsus.control.sensing.channel import AngularRateChannel, AttitudeChannel, Channel
from tarsus.control.sensing.leg_channels import ContactChannel, JointAngleChannel, VectorChannel
from tarsus.control.sensing.plain_values import as_number
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

_NO_READINGS = ValidReadings()
_VALUES = attrgetter(*CHANNELS)
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
        problem, ages = _channel_ages(readings, most)
        if problem:
            for channel in self._channels:
                channel.reset()
            return ValidReadings(rejected=(problem,))
        rejected: list[str] = []
        values = _VALUES(readings)
        if ages:
            values = self._fresh(values, ages, most, rejected)
        found = [
            value if value is None else channel.read(value, rejected)
            for channel, value in zip(self._channels, values, strict=True)
        ]
        if not ages:
            # An age that is no number is none.
            age = max(0.0, as_number(readings.age))
            return ValidReadings._make((*found, age, age, tuple(rejected)))
        fresh = [name for name, value in zip(CHANNELS, values, strict=True) if value is not None]
        tells = next((name for name in ("contacts", "forces") if name in fresh), "joint_angles")
        contact_age, ground_age = (max(0.0, as_number(ages.get(name, 0.0))) for name in (tells, "ground"))
        return ValidReadings._make((*found, ground_age, contact_age, tuple(rejected)))

    def _fresh(
        self, values: tuple[Any, ...], ages: dict[str, Any], most: float, rejected: list[str]
    ) -> tuple[Any, ...]:
        """Return the readings, None for those that are too old."""
        fresh = list(values)
        for index, (name, value) in enumerate(zip(CHANNELS, values, strict=True)):
            if value is not None and (stale := _stale(name, ages.get(name, 0.0), most)):
                rejected.append(stale)
                self._channels[index].reset()
                fresh[index] = None
        return tuple(fresh)


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


def _channel_ages(readings: SensorReadings, most: float) -> tuple[str, dict[str, Any]]:
    """Return what is wrong with all readings together, "" if nothing is, and the ages of single channels."""
    if type(readings) is not SensorReadings:
        return "all channels: not of class SensorReadings", {}
    age: Any = readings.age
    if type(age) is float or not hasattr(type(age), "keys"):
        return _stale("all channels", age, most), {}
    try:
        ages = {name: age[name] for name in CHANNELS if name in age}
        unknown = len(age) != len(ages)
    except Exception:  # a foreign mapping may raise anything
        return f"all channels: {_BAD_AGE}", {}
    return ("all channels: age of one that does not exist" if unknown else ""), ages


def _stale(name: str, age: Any, most: float) -> str:
    """Return what is wrong with an age, "" if it is at most the greatest."""
    seconds = as_number(age)
    if 0.0 <= seconds <= most:
        return ""
    return f"{name}: older than {1e3 * most:.3g} ms" if seconds > 0 else f"{name}: {_BAD_AGE}"


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
