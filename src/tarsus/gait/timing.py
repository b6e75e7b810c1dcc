"""When what happens in a walk: the body's smooth start and stop, and each leg's steps."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from tarsus.arrays import Array
from tarsus.gait.gait import Gait

__all__ = ["BodyClock", "Steps", "least_step_share", "plan_steps"]

# Steps shorter than this share of a stroke are not worth lifting a foot for; nor is more than this of a path left out.
_LEAST_STEP = 0.05
_MOST_LEFT_OUT = 0.25


def least_step_share(strokes: float) -> float:
    """Return the share of a path of so many strokes that is not worth a step."""
    return min(_LEAST_STEP / strokes, _MOST_LEFT_OUT)


@dataclass(frozen=True)
class BodyClock:
    """How far along its path the body is at a time: a smooth ramp, cruising, a smooth ramp.

    Attributes
    ----------
    rate : float
        Share of the path per second while cruising [1/s].
    ramp : float
        Duration of each ramp [s].
    cruise : float
        Time between the ramps [s].
    """

    rate: float
    ramp: float
    cruise: float

    @classmethod
    def of(cls, *, rate: float, ramp: float) -> BodyClock:
        """Fit the ramps into the path; a path shorter than two ramps is walked more slowly.

        Parameters
        ----------
        rate : float
            Wanted share of the path per second [1/s].
        ramp : float
            Duration of each ramp [s].
        """
        cruise = 1 / rate - ramp
        return cls(rate=rate, ramp=ramp, cruise=cruise) if cruise >= 0 else cls(rate=1 / ramp, ramp=ramp, cruise=0.0)

    @property
    def duration(self) -> float:
        """From the body's start to its stop [s]."""
        return 2 * self.ramp + self.cruise

    def share(self, time: Array) -> np.ndarray[Any, Any]:
        """Return the share of the path at times: 0 before the start, 1 after the stop.

        In a ramp the speed follows the quintic ``10 s^3 - 15 s^4 + 6 s^5``, whose integral never exceeds half the
        way at cruising speed: so no stance of a starting or stopping walk exceeds half a stroke on either side.

        Parameters
        ----------
        time : array, shape (...)
            Times since the body's start [s].
        """
        time = np.asarray(time, dtype=float)
        early = self._ramped(np.clip(time, 0, self.ramp))
        late = self._ramped(np.clip(self.duration - time, 0, self.ramp))
        cruising = np.clip(time - self.ramp, 0, self.cruise) * self.rate
        half = self.rate * self.ramp / 2
        share = np.where(time < self.ramp, early, np.where(time < self.ramp + self.cruise, half + cruising, 1 - late))
        return np.asarray(np.where(time <= 0, 0.0, np.where(time >= self.duration, 1.0, share)))

    def _ramped(self, time: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
        s = time / self.ramp
        return np.asarray(self.rate * self.ramp * s**4 * (2.5 - 3 * s + s * s))


@dataclass(frozen=True)
class Steps:
    """When each leg steps, and where along the path its footholds are.

    Every foothold is where the body's middle stance has the leg's rest foothold. Before the first step and after
    the last a leg stands.

    Attributes
    ----------
    gait : Gait
        Duty factor and offsets.
    clock : BodyClock
        How the body moves; time 0 is the body's start.
    cycle_time : float
        Duration of a cycle [s].
    least_step : float
        Footholds nearer than this share of the path to its start or end are there.
    start, end : float
        First lift-off (or the body's start), and last touchdown (or its stop) [s].
    """

    gait: Gait
    clock: BodyClock
    cycle_time: float
    least_step: float
    start: float
    end: float

    def foothold_share(self, step: Array) -> np.ndarray[Any, Any]:
        """Return where along the path the footholds of steps ``(..., legs)`` are, as shares."""
        middle = (np.asarray(step) + np.asarray(self.gait.offsets) + self.gait.duty_factor / 2) * self.cycle_time
        share = self.clock.share(middle)
        return np.where(share < self.least_step, 0.0, np.where(share > 1 - self.least_step, 1.0, share))

    def at(self, time: Array) -> tuple[np.ndarray[Any, Any], ...]:
        """Return where each leg is in its steps.

        Parameters
        ----------
        time : array, shape (n,)
            Times since the body's start [s].

        Returns
        -------
        last, following : array, shape (n, legs)
            The last foothold and the next, as shares of the path.
        swung : array, shape (n, legs)
            How far the foot has swung from one to the other, 0 to 1; 0 in stance.
        stance : array of bool, shape (n, legs)
            Whether the foot is on the ground; it stays there where the next foothold is the last.
        """
        step, phase, stance = self.gait.phase(np.asarray(time) / self.cycle_time)
        last, following = self.foothold_share(step), self.foothold_share(step + 1)
        stance = stance | (last == following)
        swung = np.where(stance, 0.0, (phase - self.gait.duty_factor) / (1 - self.gait.duty_factor))
        return last, following, swung, stance


def plan_steps(gait: Gait, clock: BodyClock, *, cycle_time: float, least_step: float) -> Steps:
    """Return the steps of a walk, from the first lift-off to the last touchdown.

    Parameters
    ----------
    gait : Gait
        Duty factor and offsets.
    clock : BodyClock
        How the body moves.
    cycle_time : float
        Duration of a cycle [s].
    least_step : float
        Share of the path that is no step: footholds nearer than that to its start or end are there.
    """
    steps = Steps(gait, clock, cycle_time, least_step, start=0.0, end=clock.duration)
    numbers = np.arange(-3, math.ceil(clock.duration / cycle_time) + 3)[:, None]
    moves = steps.foothold_share(numbers) != steps.foothold_share(numbers + 1)
    lift_off = (numbers + np.asarray(gait.offsets) + gait.duty_factor) * cycle_time
    touchdown = (numbers + 1 + np.asarray(gait.offsets)) * cycle_time
    start = min(0.0, float(lift_off[moves].min()))
    end = max(clock.duration, float(touchdown[moves].max()))
    return Steps(gait, clock, cycle_time, least_step, start=start, end=end)
