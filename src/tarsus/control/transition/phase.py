"""How far the stance transition in progress is."""

from __future__ import annotations

from enum import Enum, auto

__all__ = ["TransitionPhase"]


class TransitionPhase(Enum):
    """How far the transition in progress is.

    NONE: there is none, or the body moves to the new posture. TOUCHDOWN: all feet touch down for another gait.
    FOOTHOLDS: the feet step to their new rest footholds.
    """

    NONE = auto()
    TOUCHDOWN = auto()
    FOOTHOLDS = auto()
