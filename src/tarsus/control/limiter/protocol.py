"""What a twist limiter is: the protocol, and the values that limiters take and return.

Twist limiters decide, one after the other, how much of the commanded twist is followed. A new one is a class with the
one method of the protocol, and one line in the list of `tarsus.control.tick.limit`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from tarsus.control.limitation import Limitation
from tarsus.control.walk.state import GaitState

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["TwistGrant", "TwistLimiter", "TwistRequest", "leads_towards"]

# A velocity leads along a way if the cosine of the angle between them is greater than this.
_TOWARDS = 0.3


class TwistRequest(NamedTuple):
    """The commanded twist, and the state on which a twist limiter bases its decision.

    Attributes
    ----------
    twist : tuple of float
        The commanded twist: forward, left [m/s], turning [rad/s].
    dt : float
        Length of the tick [s].
    state : GaitState
        The gait state at the start of the tick.
    target : array, shape (3,)
        The twist to follow as of the last tick.
    """

    twist: tuple[float, ...]
    dt: float
    state: GaitState
    target: Float[np.ndarray, "3"]


class TwistGrant(NamedTuple):
    """What is left of the commanded twist.

    Attributes
    ----------
    fraction : float
        Fraction of the commanded twist, 0 to 1, or more where lost time is made up for.
    target : array, shape (3,), or None
        The twist to follow; None until the last limiter sets it.
    limitations : tuple of Limitation
        Why the commanded twist is not followed in full.
    """

    fraction: float = 1.0
    target: Float[np.ndarray, "3"] | None = None
    limitations: tuple[Limitation, ...] = ()

    def at_most(self, fraction: float, *limitations: Limitation) -> TwistGrant:
        """Return the grant with its fraction capped at another one, and with further limitations to report, if any."""
        return TwistGrant(min(self.fraction, fraction), self.target, (*self.limitations, *limitations))

    def scaled(self, twist: Sequence[float]) -> list[float]:
        """Return a twist times the fraction."""
        return [self.fraction * speed for speed in twist]


class TwistLimiter(Protocol):
    """Limits the commanded twist."""

    def limit(self, request: TwistRequest, grant: TwistGrant, /) -> TwistGrant:
        """Return what is left of the twist after this limiter.

        Parameters
        ----------
        request, grant : TwistRequest, TwistGrant
            The commanded twist and the state to judge it by; what the limiters before this one have granted.
        """
        ...


def leads_towards(velocity: complex, way: complex) -> bool:
    """Return whether a velocity leads to the end of a way, both in the same frame; false where either is 0."""
    return (velocity * way.conjugate()).real > _TOWARDS * abs(velocity * way)
