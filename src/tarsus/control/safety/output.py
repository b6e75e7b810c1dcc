"""Output of the guard for one tick."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.control.safety.interventions import Intervention
from tarsus.representation import represented

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["GuardOutput", "GuardState"]


class GuardState(StrEnum):
    """What the guard does with the commands."""

    PASSING = "passing"
    """The command is sent."""
    HOLDING = "holding"
    """The joints brake, then hold their position."""
    SITTING = "sitting"
    """The body is lowered to the ground."""
    RECOVERING = "recovering"
    """The joints approach the command."""


@represented()
class GuardOutput(NamedTuple):
    """Output of the guard for one tick.

    Attributes
    ----------
    angles : array, shape (legs, 3)
        Joint angles that are safe to send [rad], read-only.
    ok : bool
        Whether `angles` are the commanded angles.
    state : GuardState
        What the guard does.
    time : float
        Time of the guard, to which the angles belong: the sum of all valid time steps [s].
    interventions : tuple of Intervention
        Violations of the command: the worst one of each kind.
    """

    angles: Float[np.ndarray, "legs 3"]
    ok: bool
    state: GuardState
    time: float
    interventions: tuple[Intervention, ...]
