"""The readings of a sensor suite, tick by tick."""

from __future__ import annotations

import itertools
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

import numpy as np

from tarsus.control.readings import SensorReadings
from tarsus.gait.ground_heights import GroundHeights
from tarsus.simulation.sensors.suite import CHANNELS, FootSwitch, Sampling, Sensor, SensorSuite

__all__ = ["Sampler"]

# Tolerance for the rounding errors of sums of tick times [s].
_SAME_TIME = 1e-9
# How many measurements' random numbers of a kind are drawn at a time.
_BLOCK = 256


class Sampler:
    """Turns exact values into readings.

    Parameters
    ----------
    suite : SensorSuite
        The sensors.
    exact : mapping of str to array
        Exact values at the start, by channel, or functions that return them when they are measured; a channel that
        is not in it is not measured.
    seed : int
        Seed of noise, bias, drop-outs and flips.
    """

    def __init__(self, suite: SensorSuite, exact: Mapping[str, Any], *, seed: int) -> None:
        randoms = np.random.default_rng(seed).spawn(len(CHANNELS))
        present = [(name, getattr(suite, name), random) for name, random in zip(CHANNELS, randoms, strict=True)]
        self._channels = [
            _Channel(name, sensor, exact[name], random)
            for name, sensor, random in present
            if sensor is not None and name in exact
        ]

    @property
    def first(self) -> SensorReadings:
        """The readings at the start."""
        return SensorReadings(**{channel.name: channel.first for channel in self._channels})

    def read(self, time: float, exact: Mapping[str, Any]) -> SensorReadings:
        """Return the readings at a time.

        Parameters
        ----------
        time : float
            The time [s]; ascending from call to call.
        exact : mapping of str to array
            Exact values, or functions that return them, by channel.
        """
        values, ages = {}, {}
        for channel in self._channels:
            values[channel.name], age = channel.read(time, exact[channel.name])
            if age > _SAME_TIME:
                ages[channel.name] = age
        return SensorReadings(**values, age=ages or 0.0)


class _Channel:
    """One channel: its random errors, and the measurements that are taken but still delayed."""

    def __init__(self, name: str, sensor: Sensor | FootSwitch, exact: Any, random: np.random.Generator) -> None:
        self.name = name
        self._delay, self._period = sensor.delay - _SAME_TIME, 1 / sensor.rate
        self._threshold = sensor.threshold if isinstance(sensor, FootSwitch) else None
        self._resolution = sensor.resolution if isinstance(sensor, Sensor) else 0.0
        shape = np.shape(exact() if callable(exact) else exact)
        self._errors, self._lost = _errors(sensor, shape, random), _losses(sensor, random)
        self._taken = 0.0
        self.first = self._disturbed(exact)
        self._waiting = deque([(0.0, self.first)])

    def read(self, time: float, exact: Any) -> tuple[Any, float]:
        """Take a measurement, unless it is not due yet or is lost; return the newest that has arrived, and its age."""
        waiting = self._waiting
        if time - self._taken >= self._period - _SAME_TIME:
            # Measurements keep to their period: that a tick comes late does not delay those after it.
            self._taken = max(self._taken + self._period, time - self._period)
            if self._lost is None or not next(self._lost):
                waiting.append((time, self._disturbed(exact)))
        newest = time - self._delay
        while len(waiting) > 1 and waiting[1][0] <= newest:
            waiting.popleft()
        taken, value = waiting[0]
        return value, time - taken

    def _disturbed(self, exact: Any) -> Any:
        errors, resolution = self._errors, self._resolution
        if callable(exact):
            exact = exact()
        if self._threshold is not None:
            closed = exact > self._threshold
            return closed if errors is None else closed ^ next(errors)
        value = np.array(exact) if errors is None else exact + next(errors)
        value = np.rint(value / resolution) * resolution if resolution else value
        return GroundHeights(heights=value) if self.name == "ground" else value


def _errors(sensor: Sensor | FootSwitch, shape: tuple[int, ...], random: np.random.Generator) -> Iterator[Any] | None:
    """Return an iterator over the errors of successive measurements, drawn many at a time; None if there are none."""
    if isinstance(sensor, FootSwitch):
        return _one_by_one(lambda: random.random((_BLOCK, *shape)) < sensor.flips) if sensor.flips else None
    bias = random.normal(0.0, sensor.bias, shape) if sensor.bias else np.zeros(shape)
    if sensor.noise:
        return _one_by_one(lambda: random.normal(bias, sensor.noise, (_BLOCK, *shape)))
    return itertools.repeat(bias) if sensor.bias else None


def _losses(sensor: Sampling, random: np.random.Generator) -> Iterator[bool] | None:
    """Return an iterator that tells of successive measurements whether they are lost; None if none ever is."""
    return _one_by_one(lambda: random.random(_BLOCK) < sensor.dropout) if sensor.dropout else None


def _one_by_one(draw: Callable[[], Iterable[Any]]) -> Iterator[Any]:
    while True:
        yield from draw()
