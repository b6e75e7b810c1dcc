"""Roughness: how uneven the ground is that the feet have met, and what follows for swing height and body height."""

from __future__ import annotations

import math
from dataclasses import dataclass

from tarsus.errors import InputError
from tarsus.representation import represented

__all__ = ["GroundAdaptation", "Roughness"]

# Roughness that a collision stands for [m].
_COLLISION = 0.02
# Footholds this close to the expected ground are even [m].
_EVEN = 0.008
# Cycles after which the roughness has fallen to 1/e.
_MEMORY = 4.0
# Swing height and body height over roughness.
_SWING_SHARE, _BODY_SHARE = 1.0, 1.0


@represented()
@dataclass(frozen=True, kw_only=True)
class GroundAdaptation:
    """How far a walk may adapt to rough ground, and how slippery the ground may be.

    Attributes
    ----------
    swing_height : float
        Greatest addition to the swing height [m].
    body_height : float
        Greatest addition to the body height [m].
    friction : float
        Coefficient of friction that feet are sure of: slopes on which they would slip with it are refused.

    Raises
    ------
    InputError
        If one is negative or not finite.
    """

    swing_height: float = 0.05
    body_height: float = 0.06
    friction: float = 0.8

    def __post_init__(self) -> None:
        for name in ("swing_height", "body_height", "friction"):
            value = getattr(self, name)
            if not 0 <= value < math.inf:
                raise InputError(f"ground adaptation: {name} is {value}; it must be a finite number, not negative")


class Roughness:
    """Rises at once with every foothold off the expected ground and every collision, and falls slowly.

    Parameters
    ----------
    adaptation : GroundAdaptation
        How far heights may adapt.

    Attributes
    ----------
    value : float
        Distance of footholds from the plane of the feet that is expected [m].
    """

    def __init__(self, adaptation: GroundAdaptation) -> None:
        self.value = 0.0
        self._adaptation = adaptation

    def landed(self, off: float) -> None:
        """Take note of a foothold.

        Parameters
        ----------
        off : float
            Its height over the expected ground [m].
        """
        self.value = max(self.value, abs(off) - _EVEN)

    def collided(self) -> None:
        """Take note of a collision."""
        self.value = max(self.value, _COLLISION)

    def decay(self, cycles: float) -> None:
        """Forget.

        Parameters
        ----------
        cycles : float
            Cycles that have passed.
        """
        self.value *= math.exp(-cycles / _MEMORY)

    @property
    def swing_rise(self) -> float:
        """Addition to the swing height [m]."""
        return min(_SWING_SHARE * self.value, self._adaptation.swing_height)

    @property
    def body_rise(self) -> float:
        """Addition to the body height [m]."""
        return min(_BODY_SHARE * self.value, self._adaptation.body_height)
