"""The state of walking that passes from stage to stage of a tick."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.control.limitation import Limitation
from tarsus.control.walk.state import GaitState
from tarsus.control.walk_state import WalkState

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["TickState"]


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
