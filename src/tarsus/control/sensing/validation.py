"""Validation of sensor readings: only those that the robot could have measured are used."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.control.readings import CHANNELS, SensorReadings, ValidReadings
from tarsus.control.sensing.body_channels import AngularRateChannel, AttitudeChannel
from tarsus.control.sensing.leg_channels import ContactChannel, JointAngleChannel, Range, VectorChannel
from tarsus.control.sensing.plain_values import as_number
from tarsus.errors import InputError
from tarsus.gait.ground_heights import GroundHeights
from tarsus.kinematics.mass import STANDARD_GRAVITY, total_mass
from tarsus.robot.joint_limits import joint_limits
from tarsus.robot.robot import Robot

__all__ = ["ReadingsValidator"]

# Bounds where the robot's masses or servos are unknown, above those of any robot this is made for.
_ANY_WEIGHT = 1e4  # [N]
_ANY_STALL_TORQUE = 1e3  # [N m]
# Greatest downward force on a foot, in weights: from a load cell's zero offset and the inertia of a swinging leg.
# Beyond that the sign is wrong.
_PULL = 0.25
# Channels that are plausible wherever they are finite.
_FINITE_CHANNELS = ("joint_speeds", "currents", "temperatures", "voltages")

_NO_READINGS = ValidReadings()
_BAD_AGE = "age is not a number >= 0 s"


class ReadingsValidator:
    """Passes plausible readings on, tick by tick, and names the others.

    A reading is rejected if it does not consist of finite numbers in the right shape, is too old, or lies outside
    the range the robot can measure: for one leg if only that leg's reading is wrong, otherwise the whole channel.
    After a rejection a channel is accepted again once it has been plausible `settle` times in a row. No content of
    the fields raises an error.

    Parameters
    ----------
    robot : Robot
        One robot; forces and torques are bounded by its weight and its servos' stall torques where these are known.
    max_age : float
        Greatest age of a reading [s].
    max_tilt : float
        Greatest magnitude of roll and pitch [rad].
    max_turn : float
        Greatest rate of change of roll and pitch [rad/s].
    max_weights : float
        Greatest force on one foot, in weights of the robot.
    max_stalls : float
        Greatest torque, in stall torques of the joint's servo.
    settle : int
        Consecutive plausible readings after which a rejected channel is accepted again.

    Attributes
    ----------
    counts : dict of str to int
        How often each reason of rejection has been given.

    Raises
    ------
    InputError
        If the robot is a batch of designs, or a bound is not a positive number.
    """

    def __init__(
        self,
        robot: Robot,
        *,
        max_age: float = 0.1,
        max_tilt: float = math.radians(60.0),
        max_turn: float = 6.0,
        max_weights: float = 4.0,
        max_stalls: float = 1.5,
        settle: int = 3,
    ) -> None:
        if robot.batch_shape:
            raise InputError(f"robot {robot.name!r} is a batch of designs {robot.batch_shape}; expected one robot")
        for name, bound in (
            ("max_age", max_age),
            ("max_tilt", max_tilt),
            ("max_turn", max_turn),
            ("max_weights", max_weights),
            ("max_stalls", max_stalls),
            ("settle", settle),
        ):
            if not 0 < bound < math.inf:
                raise InputError(f"{name} is {bound}; it must be a positive number")
        self._max_age = max_age
        legs = robot.leg_codes
        self._attitude = AttitudeChannel(max_tilt=max_tilt, max_turn=max_turn, settle=settle)
        fastest = float(joint_limits(robot).speed.max())
        self._joint_angles = JointAngleChannel(legs, limits=np.asarray(robot.limits), speed=fastest, settle=settle)
        self._channels: dict[str, Any] = {
            "contacts": ContactChannel(legs, settle=settle),
            "attitude": self._attitude,
            "joint_angles": self._joint_angles,
            "forces": _forces_channel(robot, max_weights, settle=settle),
            "torques": _torques_channel(robot, max_stalls, settle=settle),
            **{name: VectorChannel(name, legs, settle=settle) for name in _FINITE_CHANNELS},
            "angular_rates": AngularRateChannel(settle=settle),
            "ground": _GroundChannel(),
        }
        old = f"older than {max_age * 1e3:g} ms"
        self._old = {name: f"{name}: {old}" for name in ("readings", *CHANNELS)}
        self.counts: dict[str, int] = {}

    def validate(self, readings: SensorReadings | None, dt: float) -> ValidReadings:
        """Return the readings that pass, and the reasons of all rejections.

        Parameters
        ----------
        readings : SensorReadings or None
            The readings; an object of any other class is rejected as a whole.
        dt : float
            Time since the last call [s].
        """
        self._attitude.elapse(dt)
        self._joint_angles.elapse(dt)
        if readings is None:
            return _NO_READINGS
        rejected: list[str] = []
        problem, ages = self._ages(readings)
        if problem:
            rejected.append(problem)
            for channel in self._channels.values():
                channel.reset()
            valid = ValidReadings(rejected=(problem,))
        else:
            accepted: dict[str, Any] = {}
            for name, channel in self._channels.items():
                value = getattr(readings, name)
                if value is None:
                    continue
                if ages and (stale := self._stale(name, ages.get(name, 0.0))):
                    rejected.append(stale)
                    channel.reset()
                else:
                    accepted[name] = channel.read(value, rejected)
            if ages:
                given = (name for name in ("contacts", "forces") if getattr(readings, name) is not None)
                times = ages.get(next(given, "joint_angles"), 0.0), ages.get("ground", 0.0)
                # An age that is no number is none.
                accepted["contact_age"], accepted["ground_age"] = [max(0.0, as_number(time)) for time in times]
            else:
                accepted["contact_age"] = accepted["ground_age"] = max(0.0, as_number(readings.age))
            valid = ValidReadings(**accepted, rejected=tuple(rejected))
        for reason in rejected:
            self.counts[reason] = self.counts.get(reason, 0) + 1
        return valid

    def _ages(self, readings: SensorReadings) -> tuple[str, dict[str, Any]]:
        """Return what is wrong with all readings together, "" if nothing is, and the ages of single channels."""
        if type(readings) is not SensorReadings:
            return "readings: not of class SensorReadings", {}
        age: Any = readings.age
        if type(age) is float or not hasattr(type(age), "keys"):
            return self._stale("readings", age), {}
        try:
            ages = {name: age[name] for name in CHANNELS if name in age}
            unknown = len(age) != len(ages)
        except Exception:  # a foreign mapping may raise anything
            return f"readings: {_BAD_AGE}", {}
        return ("readings: age of a channel that does not exist" if unknown else ""), ages

    def _stale(self, name: str, age: Any) -> str:
        """Return what is wrong with an age, "" if it is at most the greatest."""
        seconds = as_number(age)
        if 0.0 <= seconds <= self._max_age:
            return ""
        return self._old[name] if seconds > 0 else f"{name}: {_BAD_AGE}"


class _GroundChannel:
    """Heights of the ground, which have been checked as they were made."""

    def reset(self) -> None:
        """Do nothing: there is nothing to settle."""

    def read(self, value: Any, rejected: list[str]) -> GroundHeights | None:
        if type(value) is GroundHeights:
            return value
        rejected.append("ground: not of class GroundHeights")
        return None


def _forces_channel(robot: Robot, max_weights: float, *, settle: int) -> VectorChannel:
    weight = float(total_mass(robot)) * STANDARD_GRAVITY if robot.has_masses else _ANY_WEIGHT
    most = max_weights * weight
    return VectorChannel(
        "forces",
        robot.leg_codes,
        bounds=[((-most, most), (-most, most), (-_PULL * weight, most))] * robot.legs,
        beyond=f"beyond {max_weights:g} times the robot's weight, or downward beyond {_PULL:g} times",
        accept_z=True,
        settle=settle,
    )


def _torques_channel(robot: Robot, max_stalls: float, *, settle: int) -> VectorChannel:
    bounds = [[max_stalls * (s.stall_torque if s else _ANY_STALL_TORQUE) for s in row] for row in robot.servos]
    return VectorChannel(
        "torques",
        robot.leg_codes,
        bounds=[(_symmetric(coxa), _symmetric(femur), _symmetric(tibia)) for coxa, femur, tibia in bounds],
        beyond=f"beyond {max_stalls:g} times the stall torque",
        settle=settle,
    )


def _symmetric(most: float) -> Range:
    return (-most, most)
