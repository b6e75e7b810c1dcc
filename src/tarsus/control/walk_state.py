"""The states of walking; what passes from stage to stage of a tick."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.control.limitation import Limitation
from tarsus.control.walk.state import GaitState

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["TickState", "WalkState"]


class WalkState(StrEnum):
    """State of the walk controller; the value is the name in records and messages.

    STANDING: every foot at its rest foothold, no step under way. WALKING: the robot steps and follows a twist.
    STOPPING: no twist is left to follow; the feet step to their rest footholds. CHANGING_GAIT: the feet in the air
    touch down and none lifts, until the new gait starts. SEARCHING: the walk waits until its feet hold the robot.
    """

    STANDING = "standing"
    WALKING = "walking"
    STOPPING = "stopping"
    CHANGING_GAIT = "changing gait"
    SEARCHING = "searching"


class TickState(NamedTuple):
    """Gait state, twist and walk state; what else lasts from tick to tick is in the `WalkComponents`.

    Attributes
    ----------
    gait : GaitState
        Body and feet.
    twist : array, shape (3,)
        The twist to follow: forward, left [m/s], turning [rad/s].
    walk_state : WalkState
        What the controller does.
    limitations : tuple of Limitation
        Why the commanded twist is not followed in full.
    """

    gait: GaitState
    twist: Float[np.ndarray, "3"]
    walk_state: WalkState = WalkState.STANDING
    limitations: tuple[Limitation, ...] = ()

    @property
    def standing(self) -> bool:
        """Whether the robot stands."""
        return self.walk_state is WalkState.STANDING
