"""Timing of a walk: start and stop of the body, and the steps of each leg."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import Array
from tarsus.gait.gait import Gait

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["BodyClock", "Steps", "least_step_fraction", "plan_steps"]

# Shortest step, as a fraction of a stroke; its upper bound, as a fraction of the path.
_LEAST_STEP = 0.05
_MOST_OMITTED = 0.25


def least_step_fraction(strokes: float) -> float:
    """Return the shortest step on a path of a number of strokes, as a fraction of the path."""
    return min(_LEAST_STEP / strokes, _MOST_OMITTED)


@dataclass(frozen=True)
class BodyClock:
    """Progress of the body along its path over time: a smooth ramp, cruising, a smooth ramp.

    Attributes
    ----------
    rate : float
        Fraction of the path per second while cruising [1/s].
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
        """Fit the ramps into the path; where it is too short for both, the rate is reduced.

        Parameters
        ----------
        rate : float
            Fraction of the path per second while cruising [1/s].
        ramp : float
            Duration of each ramp [s].
        """
        cruise = 1 / rate - ramp
        return cls(rate=rate, ramp=ramp, cruise=cruise) if cruise >= 0 else cls(rate=1 / ramp, ramp=ramp, cruise=0.0)

    @property
    def duration(self) -> float:
        """Time from the start of the body to its stop [s]."""
        return 2 * self.ramp + self.cruise

    def fraction(self, time: Float[Array, "*#batch"]) -> Float[np.ndarray, "*batch"]:
        """Return the fraction of the path ``(...)`` at times: 0 before the start, 1 after the stop.

        In a ramp the speed follows the quintic ``10 s^3 - 15 s^4 + 6 s^5``. Its integral is at most half the distance
        covered at cruising speed, so that no stance during start or stop exceeds half a stroke on either side.

        Parameters
        ----------
        time : array, shape (...)
            Times since the start of the body [s].
        """
        time = np.asarray(time, dtype=float)
        early = self._ramped(np.clip(time, 0, self.ramp))
        late = self._ramped(np.clip(self.duration - time, 0, self.ramp))
        cruising = np.clip(time - self.ramp, 0, self.cruise) * self.rate
        half = self.rate * self.ramp / 2
        fraction = np.where(
            time < self.ramp, early, np.where(time < self.ramp + self.cruise, half + cruising, 1 - late)
        )
        return np.asarray(np.where(time <= 0, 0.0, np.where(time >= self.duration, 1.0, fraction)))

    def _ramped(self, time: Float[np.ndarray, "*#batch"]) -> Float[np.ndarray, "..."]:
        s = time / self.ramp
        return np.asarray(self.rate * self.ramp * s**4 * (2.5 - 3 * s + s * s))


@dataclass(frozen=True)
class Steps:
    """Times of the steps of each leg, and its footholds as fractions of the path.

    Every foothold is the leg's rest foothold at the body's pose at mid-stance. Before its first step and after its last
    one a leg stands.

    Attributes
    ----------
    gait : Gait
        Duty factor and offsets.
    clock : BodyClock
        Progress of the body; time 0 is its start.
    cycle_time : float
        Duration of a cycle [s].
    least_step : float
        Footholds closer than this fraction of the path to its start or end are placed there.
    start, end : float
        First lift-off or start of the body, whichever is earlier; last touchdown or stop, whichever is later [s].
    """

    gait: Gait
    clock: BodyClock
    cycle_time: float
    least_step: float
    start: float
    end: float

    def foothold_fraction(self, step: Float[Array, "..."]) -> Float[np.ndarray, "..."]:
        """Return the footholds of steps ``(..., legs)`` as fractions of the path ``(..., legs)``."""
        middle = (np.asarray(step) + np.asarray(self.gait.offsets) + self.gait.duty_factor / 2) * self.cycle_time
        fraction = self.clock.fraction(middle)
        return np.where(fraction < self.least_step, 0.0, np.where(fraction > 1 - self.least_step, 1.0, fraction))

    def at(self, time: Float[Array, "n"]) -> tuple[Bool[np.ndarray, "..."] | Float[np.ndarray, "..."], ...]:
        """Return the state of each leg's step.

        Parameters
        ----------
        time : array, shape (n,)
            Times since the start of the body [s].

        Returns
        -------
        last, following : array, shape (n, legs)
            The previous foothold and the next one, as fractions of the path.
        swing_phase : array, shape (n, legs)
            Phase of the swing from one to the other, 0 to 1; 0 in stance.
        stance : array of bool, shape (n, legs)
            Whether the foot is on the ground; it stays there where the next foothold is the previous one.
        """
        step, phase, stance = self.gait.phase(np.asarray(time) / self.cycle_time)
        last, following = self.foothold_fraction(step), self.foothold_fraction(step + 1)
        stance = stance | (last == following)
        swing_phase = np.where(stance, 0.0, (phase - self.gait.duty_factor) / (1 - self.gait.duty_factor))
        return last, following, swing_phase, stance


def plan_steps(gait: Gait, clock: BodyClock, *, cycle_time: float, least_step: float) -> Steps:
    """Return the steps of a walk, from the first lift-off to the last touchdown.

    Parameters
    ----------
    gait : Gait
        Duty factor and offsets.
    clock : BodyClock
        Progress of the body.
    cycle_time : float
        Duration of a cycle [s].
    least_step : float
        Shortest step as a fraction of the path: footholds closer than this to its start or end are placed there.
    """
    steps = Steps(gait, clock, cycle_time, least_step, start=0.0, end=clock.duration)
    numbers = np.arange(-3, math.ceil(clock.duration / cycle_time) + 3)[:, None]
    moves = steps.foothold_fraction(numbers) != steps.foothold_fraction(numbers + 1)
    lift_off = (numbers + np.asarray(gait.offsets) + gait.duty_factor) * cycle_time
    touchdown = (numbers + 1 + np.asarray(gait.offsets)) * cycle_time
    start = min(0.0, float(lift_off[moves].min()))
    end = max(clock.duration, float(touchdown[moves].max()))
    return Steps(gait, clock, cycle_time, least_step, start=start, end=end)
