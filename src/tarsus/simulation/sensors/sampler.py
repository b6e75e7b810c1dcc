"""The readings of a sensor suite, tick by tick."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from typing import Any

import numpy as np

from tarsus.control.readings import SensorReadings
from tarsus.simulation.sensors.suite import CHANNELS, FootSwitch, Sensor, SensorSuite

__all__ = ["Sampler"]

# Rounding of sums of tick times [s].
_SAME_TIME = 1e-9


class Sampler:
    """Turns exact values into readings.

    Parameters
    ----------
    suite : SensorSuite
        The sensors.
    exact : mapping of str to array
        Exact values at the start, by channel; what is not in it is not measured.
    seed : int
        Seed of noise, bias, drop-outs and flips.
    """

    def __init__(self, suite: SensorSuite, exact: Mapping[str, Any], *, seed: int) -> None:
        present = [(name, getattr(suite, name)) for name in CHANNELS]
        random = np.random.default_rng(seed)
        self._channels = [
            _Channel(name, sensor, exact[name], random)
            for name, sensor in present
            if sensor is not None and name in exact
        ]

    def read(self, time: float, exact: Mapping[str, Any]) -> SensorReadings:
        """Return the readings at a time.

        Parameters
        ----------
        time : float
            The time [s]; ascending from call to call.
        exact : mapping of str to array
            Exact values, by channel.
        """
        values, ages = {}, {}
        for channel in self._channels:
            channel.measure(time, exact[channel.name])
            values[channel.name], age = channel.reading(time)
            if age > _SAME_TIME:
                ages[channel.name] = age
        return SensorReadings(**values, age=ages or 0.0)


class _Channel:
    """One channel: its random errors, and the measurements on their way."""

    def __init__(self, name: str, sensor: Sensor | FootSwitch, exact: Any, random: np.random.Generator) -> None:
        self.name, self._sensor, self._random = name, sensor, random
        shape = np.shape(exact)
        bias = sensor.bias if isinstance(sensor, Sensor) else 0.0
        self._bias = random.normal(0.0, bias, shape) if bias else 0.0
        self._taken = 0.0
        self._waiting = deque([(0.0, self._disturbed(exact))])

    def measure(self, time: float, exact: Any) -> None:
        """Take a measurement, unless it is not due yet or is lost."""
        sensor = self._sensor
        if time - self._taken < 1 / sensor.rate - _SAME_TIME:
            return
        self._taken = time
        if not sensor.dropout or self._random.random() >= sensor.dropout:
            self._waiting.append((time, self._disturbed(exact)))

    def reading(self, time: float) -> tuple[Any, float]:
        """Return the newest measurement that has arrived, and its age."""
        waiting, newest = self._waiting, time - self._sensor.delay + _SAME_TIME
        while len(waiting) > 1 and waiting[1][0] <= newest:
            waiting.popleft()
        taken, value = waiting[0]
        return value, time - taken

    def _disturbed(self, exact: Any) -> Any:
        sensor = self._sensor
        if isinstance(sensor, FootSwitch):
            closed = exact > sensor.threshold
            return closed ^ (self._random.random(closed.shape) < sensor.flips) if sensor.flips else closed
        value = exact + self._bias
        if sensor.noise:
            value = value + self._random.normal(0.0, sensor.noise, value.shape)
        return np.round(value / sensor.resolution) * sensor.resolution if sensor.resolution else value
