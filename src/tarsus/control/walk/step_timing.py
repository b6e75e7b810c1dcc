"""Gait and step frequency, and what follows from them alone."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.control.walk.state import ROUNDING, GaitState
from tarsus.gait.gait import Gait
from tarsus.gait.stance.velocity_limits import stance_overhang

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["StepTiming"]

# The twist follows its target within about one stance: if it were faster, standing feet would be left behind.
_TIME_CONSTANTS_PER_STANCE = 4.0
# Number of feet that suffice to hold a robot.
_HELD = 3


class StepTiming(NamedTuple):
    """A gait at a step frequency.

    Attributes
    ----------
    gait : Gait
        Order of the steps.
    frequency : float
        Cycles per second [1/s].
    """

    gait: Gait
    frequency: float

    @property
    def bandwidth(self) -> float:
        """Bandwidth with which the twist follows its target [rad/s]."""
        return _TIME_CONSTANTS_PER_STANCE * self.frequency / self.gait.duty_factor

    @property
    def stance_time(self) -> float:
        """Duration of a stance [s]."""
        return self.gait.duty_factor / self.frequency

    @property
    def swing_time(self) -> float:
        """Duration of a swing [s]."""
        return (1 - self.gait.duty_factor) / self.frequency

    @property
    def redundant(self) -> bool:
        """Whether more than three feet stand at any time."""
        return self.gait.fewest_feet_down > _HELD

    def steps_like(self, gait: Gait) -> bool:
        """Return whether another gait has the same steps and the same kind of body motion."""
        mine = self.gait
        return (gait.duty_factor, gait.offsets, gait.body_shift) == (mine.duty_factor, mine.offsets, mine.body_shift)

    def stands_before(self, gait: Gait) -> bool:
        """Return whether the robot has to stand before it changes to another gait: either of them shifts the body."""
        return (gait.body_shift or self.gait.body_shift) and not self.steps_like(gait)

    def due(self, state: GaitState, dt: float) -> list[bool]:
        """Return which feet on the ground are due to lift off within a time [s]."""
        clock, lifts = state.clock + self.frequency * dt, self.gait.duty_factor - ROUNDING
        steps = zip(state.down.tolist(), self.gait.offsets, state.step_number.tolist(), strict=True)
        return [on and clock > offset + number + lifts for on, offset, number in steps]

    def stance_intervals(self, state: GaitState) -> tuple[Float[np.ndarray, "legs"], Float[np.ndarray, "legs"]]:
        """Return start and end of each foot's stance where it is, or where it will be put down: shape (legs,) [s]."""
        duty_factor, frequency = self.gait.duty_factor, self.frequency
        over = (stance_overhang(duty_factor) - 0.5) * duty_factor / frequency
        touchdown = np.asarray(self.gait.offsets) + state.step_number - state.clock
        # A foot that has landed early needs to be in its polygon only from its planned touchdown on. One that is past
        # its planned lift-off will still fall behind for a while after it lifts: on ground that is felt, where feet
        # often wait for a tick or two until others have landed, the wait is taken from that time.
        waits, least = (touchdown.clip(0.0) / frequency, 0.0) if state.felt else (0.0, over)
        begins = np.where(state.down, waits, self.time_to_touchdown(state))
        lift_off = np.maximum((touchdown + duty_factor) / frequency + over, least)
        return begins, np.where(state.down, lift_off, begins + duty_factor / frequency + over)

    def time_to_touchdown(self, state: GaitState) -> Float[np.ndarray, "legs"]:
        """Return the time until each foot touches down: array, shape (legs,) [s]."""
        return np.where(state.down, 0.0, (1 - state.swing_phase) * (1 - self.gait.duty_factor) / self.frequency)

    def with_first_lift(self, state: GaitState, leg: int) -> GaitState:
        """Return the gait state with the clock set to a leg's lift-off; while the body is shifted, the clock stays.

        Parameters
        ----------
        state, leg : GaitState, int
            All feet are down; the leg that lifts first.
        """
        offsets, duty_factor = np.asarray(self.gait.offsets), self.gait.duty_factor
        shifted = any(state.shift.value.tolist())
        clock = state.clock if shifted else float(offsets[leg]) + duty_factor
        return state._replace(clock=clock, step_number=np.ceil(clock - offsets - duty_factor - ROUNDING))

    def approach(self, frequency: float, dt: float) -> StepTiming:
        """Return the timing after a tick [s] in which the step frequency changes towards another [1/s]."""
        now = self.frequency
        step = dt * now * now / 2
        reached = abs(frequency - now) <= step
        return self._replace(frequency=frequency if reached else now + math.copysign(step, frequency - now))
