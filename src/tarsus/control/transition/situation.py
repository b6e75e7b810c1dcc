"""What decides whether a stance transition may begin, and how far the one in progress is."""

from __future__ import annotations

from enum import Enum, auto
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.control.walk.state import GaitState

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["TransitionPhase", "WalkSituation"]


class TransitionPhase(Enum):
    """How far the transition in progress is.

    NONE: there is none, or the body moves to the new posture. TOUCHDOWN: all feet touch down for another gait.
    FOOTHOLDS: the feet step to their new rest footholds.
    """

    NONE = auto()
    TOUCHDOWN = auto()
    FOOTHOLDS = auto()


class WalkSituation(NamedTuple):
    """What decides whether a transition may begin.

    Attributes
    ----------
    state : GaitState
        The gait state.
    target : array, shape (3,)
        The twist that is followed [m/s, m/s, rad/s].
    standing : bool
        Whether the robot stands.
    """

    state: GaitState
    target: Float[np.ndarray, "3"]
    standing: bool
