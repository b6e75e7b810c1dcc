"""How far from their rest footholds feet get in a walk, start and stop included, whatever its length."""

from __future__ import annotations

import functools
from typing import Any, NamedTuple

import numpy as np

from tarsus.arrays import Array
from tarsus.gait.gait import Gait
from tarsus.gait.path import carry, exponential
from tarsus.gait.swing import ground_share, height_share
from tarsus.gait.timing import BodyClock, Steps, least_step_share, plan_steps

__all__ = ["MOMENTS_OF_SWING", "Excursions", "extreme_excursions", "walk_excursions"]

_OFFSETS = 24
_SHARES = np.linspace(0.0, 1.0, 49)
# Cruising time between start and stop [cycles] with which no step both starts and stops; shorter walks, and those of
# another number of cycles, get no farther from rest (measured: by 0.001 of a stroke).
_CRUISE = 2.0
_CRUISES_OF_WALKS = (0.0, 0.75, 1.5, 2.0, 2.25)
_STANCE = np.linspace(-0.5, 0.5, 9)
_INWARD = (0.0, 0.1, 0.3, 1.0)

MOMENTS_OF_SWING = 24
"""Moments of every swing at which feet are looked at for how near they come to each other."""


class Excursions(NamedTuple):
    """Moments of feet: arrays ``(k, legs)``, or ``(k, 1)`` where any leg may come by them.

    Attributes
    ----------
    last, following : array
        Where the body has the last and the next foothold at rest, less where it is, in strokes along the path.
    along : array
        Share of the way over the ground from the one to the other.
    up : array
        Height over the lift.
    """

    last: np.ndarray[Any, Any]
    following: np.ndarray[Any, Any]
    along: np.ndarray[Any, Any]
    up: np.ndarray[Any, Any]

    @classmethod
    def joined(cls, *parts: Excursions) -> Excursions:
        """Join the moments of several."""
        return cls(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))

    @property
    def offset(self) -> np.ndarray[Any, Any]:
        """Place along a straight path, from the rest foothold, in strokes."""
        return np.asarray(self.last + (self.following - self.last) * self.along)

    def feet(self, rest: Array, twist: Array, swing_height: float) -> np.ndarray[Any, Any]:
        """Return the feet in the body's heading frame on the ground.

        Parameters
        ----------
        rest : array, shape (legs, 3)
            Rest footholds [m].
        twist : array, shape (..., 3)
            What the body moves in one stance time: forward [m], left [m], yaw [rad].
        swing_height : float
            Lift [m].

        Returns
        -------
        array, shape (..., k, legs, 3)
            Feet [m].
        """
        displacement = [np.asarray(twist)[..., i, None, None] for i in range(3)]
        each = np.asarray(rest)[:, None, :]
        start = carry(exponential(displacement, self.last), each)[..., 0, :]
        end = carry(exponential(displacement, self.following), each)[..., 0, :]
        feet = start + (end - start) * self.along[..., None]
        feet[..., 2] += self.up * swing_height
        return np.asarray(feet)


@functools.lru_cache(maxsize=64)
def extreme_excursions(duty_factor: float, *, curved: bool) -> Excursions:
    """Return the moments ``(k, 1)`` at which a foot is farthest from its track, of all walks with a duty factor.

    A step while the body gathers speed is shorter than one in cruise, so that the foot hangs over farther before it
    lands; how far depends on when in the cycle the leg starts, and on how long the walk is. Of all steps of all
    such walks these are, at every height of the foot, the farthest ahead or behind; with them one steady cycle.
    Round a centre the swings cut across the arc, the deeper the longer the step: of a curved walk these are also the
    farthest in directions between ahead or behind and inwards.

    Parameters
    ----------
    duty_factor : float
        Duty factor.
    curved : bool
        Whether the walk turns.
    """
    every = _swings(duty_factor)
    ahead = every.offset.reshape(-1, len(_SHARES))
    length = (every.following - every.last).reshape(ahead.shape)
    picked = np.unique(
        [
            (side * ahead + inward * length)[:, moment].argmax() * len(_SHARES) + moment
            for moment, share in enumerate(_SHARES)
            for side in (-1, 1)
            # A foot that rises hangs behind, one that sinks ahead.
            if (share - 0.5) * side >= 0
            for inward in (_INWARD if curved else _INWARD[:1])
        ]
    )
    still = _STANCE[:, None]
    extreme = Excursions(*(column[picked] for column in every))
    return Excursions.joined(Excursions(still, still, 0 * still, 0 * still), _steady_swing(duty_factor), extreme)


@functools.lru_cache(maxsize=64)
def walk_excursions(gait: Gait) -> Excursions:
    """Return the moments ``(k, legs)`` of whole short walks, every leg at the same moment.

    Parameters
    ----------
    gait : Gait
        The gait.
    """
    return Excursions.joined(*(_walk(gait, cruise) for cruise in _CRUISES_OF_WALKS))


def _steady_swing(duty_factor: float) -> Excursions:
    """Return one swing in cruise."""
    share = _SHARES[::2, None]
    since = 0.5 + share * (1 - duty_factor) / duty_factor
    return Excursions(-since, 1 / duty_factor - since, ground_share(share), height_share(share))


def _swings(duty_factor: float) -> Excursions:
    """Return all swings of a walk, of legs that start anywhere in the cycle."""
    gait = Gait(duty_factor, tuple(np.arange(_OFFSETS) / _OFFSETS))
    steps, strokes = _walk_steps(gait, _CRUISE)
    number = np.arange(-2, int(_CRUISE) + 3)[:, None]
    last, following = steps.foothold_share(number), steps.foothold_share(number + 1)
    lift_off = number + np.asarray(gait.offsets) + duty_factor
    moves = last != following
    body = steps.clock.share(lift_off[moves][:, None] + _SHARES * (1 - duty_factor))
    start, end = ((share[moves][:, None] - body) * strokes for share in (last, following))
    along, up = ground_share(_SHARES) + 0 * body, height_share(_SHARES) + 0 * body
    return Excursions(*(column.reshape(-1, 1) for column in (start, end, along, up)))


def _walk(gait: Gait, cruise: float) -> Excursions:
    """Return a walk with so many cycles of cruise."""
    steps, strokes = _walk_steps(gait, cruise)
    time = np.arange(steps.start, steps.end, (1 - gait.duty_factor) / MOMENTS_OF_SWING)
    last, following, swung, _ = steps.at(time)
    body = steps.clock.share(time)[:, None]
    return Excursions((last - body) * strokes, (following - body) * strokes, ground_share(swung), height_share(swung))


def _walk_steps(gait: Gait, cruise: float) -> tuple[Steps, float]:
    """Return the steps of a walk with so many cycles of cruise, a second each, and its length in strokes."""
    clock = BodyClock(rate=1 / (1 + cruise), ramp=1.0, cruise=cruise)
    strokes = (1 + cruise) / gait.duty_factor
    return plan_steps(gait, clock, cycle_time=1.0, least_step=least_step_share(strokes)), strokes
