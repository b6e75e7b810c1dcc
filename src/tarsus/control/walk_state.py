"""The states of walking, the transitions between them, and the state that the stages of a tick pass on."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.control.limitation import Limitation
from tarsus.control.walk.state import GaitState

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["TickState", "WalkState", "next_walk_state"]


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


def next_walk_state(
    state: WalkState, *, follows_twist: bool, at_rest: bool, changes_gait: bool = False, searches: bool = False
) -> WalkState:
    """Return the state that follows the present one; STANDING is entered only from STOPPING.

    Parameters
    ----------
    state : WalkState
        The present state. A standing robot that starts to step is in STOPPING here.
    follows_twist : bool
        Whether the twist to follow is not zero.
    at_rest : bool
        Whether all feet are down at their rest footholds and nothing moves.
    changes_gait, searches : bool, bool
        Whether all feet touch down and stay for another gait; whether the walk waits until its feet hold the robot.
    """
    if searches:
        return WalkState.SEARCHING
    if changes_gait:
        return WalkState.CHANGING_GAIT
    if follows_twist:
        return WalkState.WALKING
    # A walk that has just ended passes through STOPPING, even if its feet are at rest already.
    return WalkState.STANDING if at_rest and state is WalkState.STOPPING else WalkState.STOPPING


class TickState(NamedTuple):
    """The values that the stages of a tick pass on; all else that lasts from tick to tick is in the `WalkComponents`.

    Attributes
    ----------
    gait : GaitState
        Body and feet.
    twist : array, shape (3,)
        Twist to follow: forward, left [m/s], turning [rad/s].
    walk_state : WalkState
        The state of the walk.
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
