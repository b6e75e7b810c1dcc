"""Continued readings: earlier measurements stand in for missing ones, for a short time."""

from __future__ import annotations

import math
from collections import deque
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.control.readings import SensorReadings, ValidReadings, Vector
from tarsus.control.sensing.validation import ReadingsValidator
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["ContinuedReadings"]

# How long the last reading stands in for missing ones [s].
_HELD = 0.1
# Channels that are continued, of the legs and of the body. Contacts are not: their estimator copes with missing ones.
_OF_LEGS, _OF_BODY = ("joint_angles", "forces", "torques"), ("attitude", "angular_rates", "tilt")
# How long commands are kept [s]: for as long as readings are held, plus the longest lag of joints.
_KEPT = 0.35
# Joint angles count as new up to so many ticks above the usual age of new ones; how fast that age may rise [s/s].
_SAME, _SLOWER = 0.5, 0.02


class ContinuedReadings:
    """Continues readings that are missing or repeated: where replies are lost, or servos are polled in turn.

    A missing or rejected reading is replaced by the last measured one, for up to 0.1 s. Joint angles that date from an
    earlier tick, by their ages, are taken to have moved as commanded since, with the same tracking error.

    Parameters
    ----------
    robot : Robot
        A single robot.

    Attributes
    ----------
    valid : ValidReadings
        The last given readings, as far as they passed validation.
    """

    def __init__(self, robot: Robot) -> None:
        self.valid, self._validator = ValidReadings(), ReadingsValidator(robot)
        # The readings returned last, with joint angles as they were measured.
        self._last = self.valid
        # How long a reading has been missing, by channel and leg; leg -1 is the body [s].
        self._missing = dict[tuple[str, int], float]()
        self._now = 0.0
        self._commands: deque[tuple[float, list[Vector]]] = deque()
        # Age of the joint angles, one for all joints or one for each, and the usual age of new ones [s].
        self._ages: float | Float[np.ndarray, "legs 3"] = _KEPT
        self._usual = math.inf

    def step(self, readings: SensorReadings | None, commanded: list[Vector], dt: float, *, lag: float) -> ValidReadings:
        """Return the present readings, with all joint angles brought to the usual age of new ones.

        Parameters
        ----------
        readings : SensorReadings or None
            The readings given in this tick.
        commanded : list of (coxa, femur, tibia)
            Joint angles that were commanded in the last tick [rad].
        dt, lag : float
            Time since the last tick; lag from a command to its reading [s].
        """
        self._now += dt
        self._commands.append((self._now, commanded))
        while self._now - self._commands[0][0] > _KEPT:
            self._commands.popleft()
        valid = self.valid = self._validator.validate(readings, dt)
        values = zip(valid, self._last, strict=True)
        if valid.rejected or any((now is None) is not (last is None) for now, last in values):
            valid = self._held(valid, dt)
        else:
            self._missing.clear()
        self._last = valid
        return valid if valid.joint_angles is None else self._predicted(valid, dt, lag)

    def _held(self, valid: ValidReadings, dt: float) -> ValidReadings:
        """Return the readings, with the last ones in place of those that have been missing for a short time."""
        held, legs = dict[str, Any](), len(self._commands[-1][1])
        for name in _OF_LEGS:
            now, last = (getattr(readings, name) or (None,) * legs for readings in (valid, self._last))
            feet = enumerate(zip(now, last, strict=True))
            items = tuple(self._newest((name, leg), given, before, dt) for leg, (given, before) in feet)
            held[name] = None if items.count(None) == legs else items
        for name in _OF_BODY:
            held[name] = self._newest((name, -1), getattr(valid, name), getattr(self._last, name), dt)
        return valid._replace(**held)

    def _newest(self, key: tuple[str, int], given: Any, last: Any, dt: float) -> Any:
        """Return the given reading or, while it has been missing for a short time, the last one."""
        missing = self._missing.pop(key, 0.0) + dt
        if given is not None or last is None or missing > _HELD:
            return given
        self._missing[key] = missing
        return last

    def _predicted(self, valid: ValidReadings, dt: float, lag: float) -> ValidReadings:
        """Return the readings with joint angles brought to the usual age of new ones."""
        ages: float | Float[np.ndarray, "legs 3"] = np.array(valid.joint_ages) if valid.joint_ages else valid.joint_age
        shape = len(self._commands[-1][1]), 3
        given = self.valid.joint_angles or (None,) * shape[0]
        old = [leg for leg, angles in enumerate(given) if angles is None]
        if old:
            before, ages = np.broadcast_to(self._ages, shape), np.broadcast_to(ages, shape).copy()
            ages[old] = before[old] + dt
        self._ages = ages
        youngest = ages if isinstance(ages, float) else float(ages.min())
        self._usual = usual = min(youngest, self._usual + _SLOWER * dt)
        if ages is youngest and ages <= usual + _SAME * dt:
            return valid
        held = np.broadcast_to(ages, shape) - usual
        moved, predicted = self._moved(held, lag), np.flatnonzero(held[:, 0] > _SAME * dt)
        legs = zip(valid.joint_angles or (), moved.tolist(), strict=True)
        angles = tuple(leg and (leg[0] + by[0], leg[1] + by[1], leg[2] + by[2]) for leg, by in legs)
        return valid._replace(joint_angles=angles, joint_age=usual, predicted=frozenset(predicted.tolist()))

    def _moved(self, held: Float[np.ndarray, "legs 3"], lag: float) -> Float[np.ndarray, "legs 3"]:
        """Return how far joints were commanded to turn during the time `held`, up to a lag ago [rad]."""
        times, commands = (np.array(column) for column in zip(*self._commands, strict=True))
        if len(times) < 2:
            return np.zeros_like(held)
        then = self._now - lag - np.stack([np.zeros_like(held), held])
        after = np.clip(np.searchsorted(times, then), 1, len(times) - 1)
        share = np.clip((then - times[after - 1]) / (times[after] - times[after - 1]), 0.0, 1.0)
        older, newer = (np.take_along_axis(commands, index, axis=0) for index in (after - 1, after))
        now, before = older + share * (newer - older)
        return np.asarray(now - before)
