"""Contact estimator: which feet probably bear load, from readings that are occasionally wrong."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TypeAlias

from tarsus.control.walk.state import GaitState

__all__ = ["TIMEOUT", "ContactEstimator", "Contacts"]

Contacts: TypeAlias = Sequence[bool | None] | None
"""Which feet touch the ground, as measured: None for a foot that is not measured, None as a whole where no foot is."""

TIMEOUT = 0.15
"""Time without a measurement after which a contact is unknown, and estimated from joint angles instead [s]."""

# Bound on the magnitude of the log odds: evidence of this size outweighs all earlier readings of a foot.
_BOUND = 6.0
# Fraction of wrong readings: first guess, number of readings that this guess counts for, and upper bound.
_ERROR, _WEIGHT, _GREATEST_ERROR = 0.001, 600.0, 0.2
# Number of readings above which the counts of all and of wrong readings are halved, to forget old ones.
_MEMORY = 3000.0
# Swing phase up to which contact that has lasted since lift-off is still as planned.
_RISING = 0.3


class ContactEstimator:
    """Estimates contacts by Bayes' rule in log odds; how often readings are wrong is estimated as well.

    A reading that differs from the ones before and after it counts as wrong. The greater the fraction of wrong
    readings, the more of them must agree to change an estimate: one where fewer than 0.25 % are wrong, two up to 4.7 %,
    three up to 12 %.

    Parameters
    ----------
    legs : int
        Number of legs.

    Attributes
    ----------
    touching, known, certain : list of bool
        Whether each foot bears load, more probably than not; whether its contact is known; whether its estimate has
        reached its bound, where more readings like the last ones do not change it.
    error : float
        Estimated fraction of wrong readings.
    """

    def __init__(self, legs: int) -> None:
        self.touching, self.known = [True] * legs, [False] * legs
        self.error, self.certain = _ERROR, [False] * legs
        self._odds = [_BOUND] * legs
        self._ages = [math.inf] * legs
        self._last: list[tuple[bool, bool]] = [(True, True)] * legs
        self._wrong, self._read = _ERROR * _WEIGHT, _WEIGHT

    def step(self, readings: Contacts, dt: float, *, count: int = 1) -> None:
        """Take in the contacts of one tick.

        Parameters
        ----------
        readings : Contacts
            Which feet touch the ground, as measured.
        dt, count : float, int
            Time since the last call [s]; how many ticks the readings stand for, this one included.
        """
        evidence = math.log((1 - self.error) / self.error)
        for leg, reading in enumerate(readings or (None,) * len(self.touching)):
            if reading is None:
                self._ages[leg] += dt
                self.known[leg] = self._ages[leg] <= TIMEOUT
                continue
            self._ages[leg], self.known[leg] = 0.0, True
            odds = self._odds[leg] + (evidence if reading else -evidence)
            self._odds[leg] = odds = min(max(odds, -_BOUND), _BOUND)
            self.touching[leg] = odds > 0
            before, last = self._last[leg]
            self._wrong += before == reading != last
            self._read += count
            self._last[leg] = (last, reading)
        if self._read > _MEMORY:
            self._wrong, self._read = self._wrong / 2, self._read / 2
        self.certain = [abs(odds) >= _BOUND for odds in self._odds]
        self.error = min(self._wrong / self._read, _GREATEST_ERROR)

    def forget(self) -> None:
        """Forget the readings so far: contacts are unknown until the next ones."""
        self._ages, self.known = [math.inf] * len(self._ages), [False] * len(self._ages)

    def reads(self, leg: int) -> bool:
        """Return whether a foot probably bears load, and its last reading agrees."""
        return self.touching[leg] and self._last[leg][1]

    def as_planned(self, readings: Contacts, state: GaitState, lifted: Sequence[bool]) -> bool:
        """Return whether it is certain that exactly the feet that should touch the ground do so.

        Parameters
        ----------
        readings : Contacts
            Which feet touch the ground, as measured.
        state : GaitState
            Which feet should stand; those that have just lifted off may still touch the ground, or no longer.
        lifted : sequence of bool
            Which of the others have lost contact since they lifted off.
        """
        if readings is None:
            return False
        down = state.down.tolist()
        if list(readings) == down == self.touching and all(self.certain):
            return True
        feet = zip(readings, down, self.touching, self.certain, state.swing_phase.tolist(), lifted, strict=True)
        return all(
            (certain and reading is on is touches)
            or not (on or phase > _RISING or reading is None or (reading and off))
            for reading, on, touches, certain, phase, off in feet
        )
