"""The feet of a walk that feels the ground: their state, and what they are given for a tick."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

__all__ = ["FeltFeet", "FeltInputs"]


class FeltFeet(NamedTuple):
    """What the feet of a walk that feels the ground do besides their step; tuples with a value for each leg.

    Attributes
    ----------
    speed : tuple of float
        Upward speed in G [m/s].
    acceleration : tuple of float
        Upward acceleration of a rising foot [m/s^2].
    top : tuple of float
        Height in G to which a swinging foot rises [m]; NaN on the ground.
    top_phase : tuple of float
        Swing phase at which it is there; from then on it goes down.
    slide : tuple of complex
        Velocity in G of a foot that has landed before the end of its way, which decays [m/s].
    drawn_back : tuple of (complex or None)
        Where in G a foot that has met an obstacle is drawn back to while it rises [m]; None without one.
    """

    speed: tuple[float, ...]
    acceleration: tuple[float, ...]
    top: tuple[float, ...]
    top_phase: tuple[float, ...]
    slide: tuple[complex, ...]
    drawn_back: tuple[complex | None, ...]

    @classmethod
    def still(cls, legs: int) -> FeltFeet:
        """Return the state of feet that stand.

        Parameters
        ----------
        legs : int
            Number of legs.
        """
        none = (0.0,) * legs
        return cls(none, none, (math.nan,) * legs, none, (0j,) * legs, (None,) * legs)

    def replaced(self, leg: int, **values: Any) -> FeltFeet:
        """Return the state with other values for one leg.

        Parameters
        ----------
        leg : int
            Index of the leg.
        **values
            Attributes and the leg's values.
        """
        changed = {}
        for name, value in values.items():
            old = getattr(self, name)
            changed[name] = (*old[:leg], value, *old[leg + 1 :])
        return self._replace(**changed)


class FeltInputs(NamedTuple):
    """What a walk that feels the ground is given for a tick; tuples with a value for each leg.

    Attributes
    ----------
    stands : tuple of bool
        Whether a foot on the ground bears load, as far as is known.
    steps : tuple of bool
        Whether the leg is in the gait.
    ground : tuple of float
        Height in G at which the ground is expected under the foothold [m].
    lowest : tuple of float
        Height in G below which the foot does not go [m].
    highest : tuple of float
        Height in G above which the foot does not go [m].
    depth : float
        How far below the expected ground a foot should be by the end of its swing [m].
    climb : float
        Upward speed of the body over the standing feet [m/s].
    turn : tuple of float
        Angular velocity of the standing feet about the body, along x and y of the heading frame [rad/s].
    drift : complex
        Velocity of the standing feet against the body's, in the heading frame, that makes up for lost way [m/s].
    travel : float
        Fraction of its swing in which a foot travels: in the rest it goes straight down.
    pace : float
        Rate of the steps and of the twist, 0 to 1.
    swing_height : float
        How high a foot rises over the higher of lift-off and expected ground [m].
    """

    stands: tuple[bool, ...]
    steps: tuple[bool, ...]
    ground: tuple[float, ...]
    lowest: tuple[float, ...]
    highest: tuple[float, ...]
    depth: float
    climb: float
    turn: tuple[float, float]
    drift: complex
    travel: float
    pace: float
    swing_height: float
