"""Recovery from holes: a foot that found no ground swings again once the command changes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from tarsus.control.sensing.ground_plane import GroundPlane
from tarsus.control.walk.state import GaitState
from tarsus.control.walk.stepper import LATEST_LIFT_OFF
from tarsus.gait.gait import Gait

if TYPE_CHECKING:
    from jaxtyping import Bool

__all__ = ["HoleRecovery", "Request", "repeated_swing"]


# Least distance travelled after which a request is tried again [m].
_NEW_PLACE = 1e-5
# Twists within this of each other count as equal: relative to their size, and absolute [m/s, rad/s].
_RELATIVE, _ABSOLUTE = 0.2, 1e-3

Request: TypeAlias = tuple[Sequence[float], Any]
"""The commanded twist [m/s, m/s, rad/s] and walk parameters."""


class HoleRecovery:
    """Decides when feet over a hole swing again: after a change of the command.

    Attributes
    ----------
    active : bool
        Whether they swing again as soon as all other feet are down.
    """

    def __init__(self) -> None:
        self.active = False
        self._cause: Request | None = None
        self._tried: tuple[Request, complex] | None = None
        self._legs: set[int] = set()

    def consider(self, request: Request, position: complex) -> bool:
        """Return whether a recovery begins.

        The request that led to the hole is not tried again. Any other is tried once at each place.

        Parameters
        ----------
        request : (twist, parameters)
            What is commanded.
        position : complex
            Position of the robot in G [m].
        """
        if self._cause is None:
            self._cause = request
        if self.active or _equal(request, self._cause):
            return False
        if self._tried is not None and _equal(request, self._tried[0]) and abs(position - self._tried[1]) < _NEW_PLACE:
            return False
        self.active, self._tried = True, (request, position)
        return True

    def begun(self, legs: Sequence[int]) -> None:
        """Set the feet that swing again.

        Parameters
        ----------
        legs : sequence of int
            Their leg indices.
        """
        self.active, self._legs = False, set(legs)

    def landed(self, landed: Bool[np.ndarray, "legs"]) -> None:
        """End the recovery once all feet over the hole have been put down.

        Parameters
        ----------
        landed : array of bool, shape (legs,)
            Feet put down in this tick.
        """
        self._legs -= set(np.flatnonzero(landed).tolist())
        if not self._legs:
            self.active, self._cause, self._tried = False, None, None


def _equal(request: Request, other: Request) -> bool:
    """Return whether two requests are equal within operator input noise."""
    bound = max(_RELATIVE * math.hypot(*other[0]), _ABSOLUTE)
    return request[1] == other[1] and math.dist(request[0], other[0]) < bound


def repeated_swing(state: GaitState, legs: Sequence[int], gait: Gait, ground: GroundPlane) -> GaitState:
    """Return the state in which feet at the end of their swing begin it again from where they are.

    The gait's clock is set back to their lift-off.

    Parameters
    ----------
    state : GaitState
        The state of the walk; every other foot is down.
    legs : sequence of int
        Legs whose feet are at the end of their swing, at rest.
    gait : Gait
        Order of the steps.
    ground : GroundPlane
        Expected ground.
    """
    restarted = np.zeros(len(state.down), dtype=bool)
    restarted[list(legs)] = True
    elapsed = state.clock - (np.asarray(gait.offsets) + gait.duty_factor + state.step_number)
    back = float(elapsed[restarted].min())
    return state._replace(
        clock=state.clock - back,
        swing_phase=np.where(restarted, 0.0, state.swing_phase),
        lift_delay=np.where(
            restarted, np.clip(elapsed - back, 0.0, LATEST_LIFT_OFF * (1 - gait.duty_factor)), state.lift_delay
        ),
        start_height=np.where(restarted, state.ground_height, state.start_height),
        ground_height=np.where(restarted, ground.height(state.foot.real, state.foot.imag), state.ground_height),
        contact_phase=np.where(restarted, np.inf, state.contact_phase),
    )
