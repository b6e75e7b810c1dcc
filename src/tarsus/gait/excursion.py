"""Largest excursions of the feet from their rest footholds in a walk of any length, start and stop included."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.arrays import Array
from tarsus.gait.gait import Gait
from tarsus.gait.path import exponential_map, heading_to_ground
from tarsus.gait.swing import horizontal_profile, vertical_profile
from tarsus.gait.timing import BodyClock, Steps, least_step_fraction, plan_steps

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["SWING_SAMPLES", "Excursions", "extreme_excursions", "walk_excursions", "walk_phases"]

# Number of leg offsets sampled; swing phases sampled.
_OFFSETS = 24
_PHASES = np.linspace(0.0, 1.0, 49)
# Cruising time between start and stop [cycles] beyond which no step belongs to both. In shorter walks the excursions
# are at most 0.001 of a stroke larger (measured).
_CRUISE = 2.0
# Cruising times of the walks of `walk_excursions` [cycles].
_CRUISES_OF_WALKS = (0.0, 0.75, 1.5, 2.0, 2.25)
# Positions in stance, in strokes; weights of the length of a swing in the search for extreme positions: on a curved
# walk, longer swings cut farther across the arc.
_STANCE = np.linspace(-0.5, 0.5, 9)
_INWARD = (0.0, 0.1, 0.3, 1.0)

SWING_SAMPLES = 24
"""Samples per swing at which the distance between feet is checked."""


class Excursions(NamedTuple):
    """Foot positions within a walk, relative to the body, in units of stroke and swing height.

    Attributes
    ----------
    last, following : array, shape (k, legs) or (k, 1)
        Displacement of the previous and of the next foothold from the rest foothold, in strokes along the path;
        ``(k, 1)`` if valid for every leg.
    along : array, shape (k, legs) or (k, 1)
        Fraction of the horizontal distance from the previous to the next foothold.
    up : array, shape (k, legs) or (k, 1)
        Height as a fraction of the swing height.
    """

    last: Float[np.ndarray, "k #legs"]
    following: Float[np.ndarray, "k #legs"]
    along: Float[np.ndarray, "k #legs"]
    up: Float[np.ndarray, "k #legs"]

    @classmethod
    def joined(cls, *parts: Excursions) -> Excursions:
        """Concatenate several sets of positions."""
        return cls(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))

    @property
    def offset(self) -> Float[np.ndarray, "k legs"]:
        """Displacement from the rest foothold along a straight path ``(k, legs)``, in strokes."""
        return np.asarray(self.last + (self.following - self.last) * self.along)

    def feet(
        self, rest: Float[Array, "legs 3"], twist: Float[Array, "*#batch 3"], swing_height: float
    ) -> Float[np.ndarray, "*batch k legs 3"]:
        """Return the feet in the body's heading frame on the ground.

        Parameters
        ----------
        rest : array, shape (legs, 3)
            Rest footholds [m].
        twist : array, shape (..., 3)
            Displacement of the body in one stance time: forward [m], left [m], yaw [rad].
        swing_height : float
            Swing height [m].

        Returns
        -------
        array, shape (..., k, legs, 3)
            Feet [m].
        """
        displacement = [np.asarray(twist)[..., i, None, None] for i in range(3)]
        each = np.asarray(rest)[:, None, :]
        start = heading_to_ground(exponential_map(displacement, self.last), each)[..., 0, :]
        end = heading_to_ground(exponential_map(displacement, self.following), each)[..., 0, :]
        feet = start + (end - start) * self.along[..., None]
        feet[..., 2] += self.up * swing_height
        return np.asarray(feet)


@functools.lru_cache(maxsize=64)
def extreme_excursions(duty_factor: float, *, curved: bool) -> Excursions:
    """Return the extreme foot positions ``(k, 1)`` of all walks with a duty factor.

    While the body accelerates, a step is shorter than at cruising speed and the foot exceeds the excursion of a steady
    step before it lands; by how much depends on the offset of the leg and on the length of the walk. The result holds,
    for every height of the foot, the positions farthest ahead and behind in all steps of all such walks, and one steady
    cycle. On a curved walk the swings cut across the arc, so positions farthest inwards are included too.

    Parameters
    ----------
    duty_factor : float
        Duty factor.
    curved : bool
        Whether the walk turns.
    """
    every = _swings(duty_factor)
    ahead = every.offset.reshape(-1, len(_PHASES))
    length = (every.following - every.last).reshape(ahead.shape)
    picked = np.unique(
        [
            (side * ahead + inward * length)[:, sample].argmax() * len(_PHASES) + sample
            for sample, phase in enumerate(_PHASES)
            for side in (-1, 1)
            # A rising foot is behind the middle of its step, a sinking one ahead.
            if (phase - 0.5) * side >= 0
            for inward in (_INWARD if curved else _INWARD[:1])
        ]
    )
    still = _STANCE[:, None]
    extreme = Excursions(*(column[picked] for column in every))
    return Excursions.joined(Excursions(still, still, 0 * still, 0 * still), _steady_swing(duty_factor), extreme)


@functools.lru_cache(maxsize=64)
def walk_excursions(gait: Gait) -> Excursions:
    """Return the foot positions ``(k, legs)`` of whole short walks, with all legs at common times.

    Parameters
    ----------
    gait : Gait
        The gait.
    """
    return Excursions.joined(*(_walk(gait, cruise)[0] for cruise in _CRUISES_OF_WALKS))


@functools.lru_cache(maxsize=64)
def walk_phases(gait: Gait) -> tuple[Float[np.ndarray, "k"], Bool[np.ndarray, "k legs"]]:
    """Return the phases of the gait and the contacts of the positions of `walk_excursions`.

    Parameters
    ----------
    gait : Gait
        The gait.

    Returns
    -------
    phases : array, shape (k,)
        Phases [cycles].
    contacts : array of bool, shape (k, legs)
        Whether each foot is on the ground.
    """
    walks = [_walk(gait, cruise)[1:] for cruise in _CRUISES_OF_WALKS]
    return np.concatenate([phases for phases, _ in walks]), np.concatenate([contacts for _, contacts in walks])


def _steady_swing(duty_factor: float) -> Excursions:
    """Return one swing at cruising speed."""
    phase = _PHASES[::2, None]
    since_mid_stance = 0.5 + phase * (1 - duty_factor) / duty_factor
    along, up = horizontal_profile(phase), vertical_profile(phase)
    return Excursions(-since_mid_stance, 1 / duty_factor - since_mid_stance, along, up)


def _swings(duty_factor: float) -> Excursions:
    """Return all swings of a walk, for legs with any offset."""
    gait = Gait(duty_factor, tuple(np.arange(_OFFSETS) / _OFFSETS))
    steps, strokes = _walk_steps(gait, _CRUISE)
    number = np.arange(-2, int(_CRUISE) + 3)[:, None]
    last, following = steps.foothold_fraction(number), steps.foothold_fraction(number + 1)
    lift_off = number + np.asarray(gait.offsets) + duty_factor
    moves = last != following
    body = steps.clock.fraction(lift_off[moves][:, None] + _PHASES * (1 - duty_factor))
    start, end = ((foothold[moves][:, None] - body) * strokes for foothold in (last, following))
    along, up = horizontal_profile(_PHASES) + 0 * body, vertical_profile(_PHASES) + 0 * body
    return Excursions(*(column.reshape(-1, 1) for column in (start, end, along, up)))


def _walk(gait: Gait, cruise: float) -> tuple[Excursions, Float[np.ndarray, "k"], Bool[np.ndarray, "k legs"]]:
    """Return the foot positions, phases and contacts of a walk that cruises for a number of cycles."""
    steps, strokes = _walk_steps(gait, cruise)
    time = np.arange(steps.start, steps.end, (1 - gait.duty_factor) / SWING_SAMPLES)
    last, following, swing_phase, contacts = steps.at(time)
    body = steps.clock.fraction(time)[:, None]
    along, up = horizontal_profile(swing_phase), vertical_profile(swing_phase)
    return Excursions((last - body) * strokes, (following - body) * strokes, along, up), time, contacts


def _walk_steps(gait: Gait, cruise: float) -> tuple[Steps, float]:
    """Return the steps of a walk that cruises for a number of cycles of 1 s, and its length in strokes."""
    clock = BodyClock(rate=1 / (1 + cruise), ramp=1.0, cruise=cruise)
    strokes = (1 + cruise) / gait.duty_factor
    return plan_steps(gait, clock, cycle_time=1.0, least_step=least_step_fraction(strokes)), strokes
