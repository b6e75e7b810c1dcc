"""The states of walking and the transitions between them; what passes from stage to stage of a tick."""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.control.limitation import Limitation
from tarsus.control.walk.state import GaitState

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["WALK_STATE_TRANSITIONS", "TickState", "WalkState", "next_walk_state"]


class WalkState(StrEnum):
    """State of the walk controller; the value is the name in records and messages.

    STANDING: every foot at its rest foothold, no step under way. WALKING: the robot steps and follows a twist.
    STOPPING: no twist is left to follow; the feet step to their rest footholds. CHANGING_GAIT: the feet in the air
    touch down and none lifts, until the new gait starts. SEARCHING: a foot searches for ground below its foothold.
    """

    STANDING = "standing"
    WALKING = "walking"
    STOPPING = "stopping"
    CHANGING_GAIT = "changing gait"
    SEARCHING = "searching"


_MOVING = frozenset(WalkState) - {WalkState.STANDING}
WALK_STATE_TRANSITIONS: Mapping[WalkState, frozenset[WalkState]] = {
    WalkState.STANDING: frozenset({WalkState.WALKING, WalkState.STOPPING}),
    WalkState.WALKING: _MOVING,
    WalkState.STOPPING: _MOVING | {WalkState.STANDING},
    WalkState.CHANGING_GAIT: _MOVING,
    WalkState.SEARCHING: _MOVING,
}
"""The states that may follow each state; only a robot that stops comes to stand."""


def next_walk_state(
    state: WalkState, *, follows_twist: bool, at_rest: bool, changes_gait: bool = False, searches: bool = False
) -> WalkState:
    """Return the state after the present one.

    Parameters
    ----------
    state : WalkState
        The present state; a standing robot is asked only once it starts to step.
    follows_twist : bool
        Whether the twist to follow is not zero.
    at_rest : bool
        Whether all feet are down at their rest footholds and nothing moves.
    changes_gait, searches : bool, bool
        Whether all feet touch down for another gait; whether a foot searches for ground.
    """
    if searches:
        following = WalkState.SEARCHING
    elif changes_gait:
        following = WalkState.CHANGING_GAIT
    elif follows_twist:
        following = WalkState.WALKING
    else:
        following = WalkState.STANDING if at_rest else WalkState.STOPPING
    allowed = following is state or following in WALK_STATE_TRANSITIONS[state]
    # From any other state, a robot at rest passes through STOPPING.
    return following if allowed else WalkState.STOPPING


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
