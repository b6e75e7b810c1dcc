"""Validation of sensor readings: only those that the robot could have measured are used."""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import chain
from operator import attrgetter
from typing import Any, TypeAlias

from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.readings import CHANNELS, SensorReadings, ValidReadings, Vector
from tarsus.control.sensing.channels import channels_of
from tarsus.control.sensing.plain_values import as_items, as_number, as_vector
from tarsus.robot.robot import Robot

__all__ = ["ReadingsValidator", "rejections"]

# Greatest age of a reading [s]; in ticks instead, where these are long.
_MOST_AGE, _MOST_TICKS = 0.1, 4.0
# Ages of each leg's joints [s]; None unless they are given one by one.
_Ages: TypeAlias = tuple[Vector, ...] | None

_NO_READINGS, _NONE = ValidReadings(), frozenset[int]()
# Channels that the control uses, in the order of `ValidReadings`.
_USED = tuple(name for name in CHANNELS if name in ValidReadings._fields)
_VALUES, _JOINT_ANGLES, _ATTITUDE = attrgetter(*_USED), _USED.index("joint_angles"), _USED.index("attitude")
# What is wrong with an age that is no number; the rest for a channel whose joints may have an age each.
_BAD_AGE, _NOR_EACH = "age is not a number >= 0 s", ", nor one for each joint"


class ReadingsValidator:
    """Passes plausible readings on, tick by tick, and names the others.

    A reading is rejected if it does not consist of finite numbers in the right shape, is too old, or lies outside
    the range the robot can measure: for one leg if only that leg's reading is wrong, otherwise the whole channel.
    After a rejection a channel is accepted again once it has been plausible three times in a row. Whatever the
    fields contain, no error is raised.

    Parameters
    ----------
    robot : Robot
        A single robot; forces and torques are bounded by its weight and its servos' stall torques where known.
    """

    def __init__(self, robot: Robot) -> None:
        channels, self._legs = channels_of(robot), robot.leg_codes
        self._channels = [channels[name] for name in _USED]
        self._timed = channels["attitude"], channels["joint_angles"]

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
        rejected, values = list[str](), list(_VALUES(readings))
        for index, name in enumerate(_USED if ages else ()):
            if values[index] is not None and (stale := _stale(name, ages.get(name, 0.0), most, _NOR_EACH)):
                rejected.append(stale)
                self._channels[index].reset()
                values[index] = None
        given = zip(self._channels, values, strict=True)
        found: list[Any] = [None if value is None else channel.read(value, rejected) for channel, value in given]
        attitude, _ = self._timed
        found.append(None if values[_ATTITUDE] is None else attitude.tilt)
        if not ages:
            # An empty mapping, which is not a number, means age 0.
            age = max(0.0, as_number(readings.age))
            return ValidReadings._make((*found, age, None, age, age, _NONE, tuple(rejected)))
        names = [name for name, value in zip(_USED, values, strict=True) if value is not None]
        if of_joints and found[_JOINT_ANGLES]:
            young = self._young(of_joints, most, rejected)
            kept = tuple(each if leg in young else None for leg, each in enumerate(found[_JOINT_ANGLES]))
            found[_JOINT_ANGLES] = kept if any(kept) else None
            ages["joint_angles"] = max((max(of_joints[leg]) for leg in young), default=0.0)
        tells = next((name for name in ("contacts", "forces") if name in names), "joint_angles")
        joint, ground, contact = (max(0.0, ages.get(name, 0.0)) for name in ("joint_angles", "ground", tells))
        return ValidReadings._make((*found, joint, of_joints, ground, contact, _NONE, tuple(rejected)))

    def _young(self, ages: tuple[Vector, ...], most: float, rejected: list[str]) -> list[int]:
        """Return the legs none of whose joint angles is too old; reject the others."""
        pairs = zip(self._legs, ages, strict=True)
        stale = [_stale(f"joint_angles of {leg}", _oldest(of_leg), most) for leg, of_leg in pairs]
        rejected += filter(None, stale)
        return [leg for leg, problem in enumerate(stale) if not problem]


def rejections(valid: ValidReadings) -> list[Limitation]:
    """Return the limitations that name rejected readings."""
    return [Limitation(kind=LimitationKind.READINGS, cause=reason) for reason in valid.rejected]


def _channel_ages(readings: SensorReadings, most: float, *, legs: int) -> tuple[str, dict[str, float], _Ages]:
    """Return what is wrong with the readings as a whole, or ""; the ages of single channels; those of joints.

    Where each joint has an age, the channel's age is the greatest of them; but that of joint angles is 0, as these are
    rejected leg by leg.
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
            vectors = tuple(map(as_vector, rows))
            ages[name] = _oldest(chain(*vectors))
            if name == "joint_angles":
                of_joints, ages[name] = vectors, 0.0
    return ("all channels: age of one that does not exist" if unknown else ""), ages, of_joints


def _oldest(ages: Iterable[float]) -> float:
    """Return the greatest age; NaN unless all are numbers >= 0."""
    known = list(ages)
    return max(known) if all(age >= 0.0 for age in known) else math.nan


def _stale(name: str, age: float, most: float, ending: str = "") -> str:
    """Return what is wrong with an age, where `ending` goes with one that is no number; "" if it is at most `most`."""
    if 0.0 <= age <= most:
        return ""
    return f"{name}: older than {1e3 * most:.3g} ms" if age > 0 else f"{name}: {_BAD_AGE}{ending}"
