"""Motion of a foot that is taken out of the gait: it follows its target with bounded bandwidth and speed."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.control.filters import CriticallyDamped
from tarsus.control.walk.state import GaitState

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["GREATEST_SPEED", "FootTargetMotion", "begin_foot_target"]

GREATEST_SPEED = 0.12
"""Greatest speed with which a foot follows its target [m/s]."""

# Greatest bandwidth with which it does [rad/s].
_BANDWIDTH = 5.0


class FootTargetMotion(NamedTuple):
    """State of a foot that is taken out of the gait.

    Attributes
    ----------
    position : CriticallyDamped
        Its position in the heading frame ``(3,)`` [m].
    target : array, shape (3,)
        Its target in the heading frame [m].
    """

    position: CriticallyDamped
    target: Float[np.ndarray, "3"]

    def step(self, dt: float) -> FootTargetMotion:
        """Return the motion after a time [s]."""
        distance = float(np.abs(self.target - self.position.value).max())
        # A critically damped filter with bandwidth 2 v / distance, renewed every tick, reaches speed v and keeps it.
        bandwidth = min(_BANDWIDTH, 2 * GREATEST_SPEED / max(distance, 1e-9))
        return self._replace(position=self.position.step(self.target, dt, bandwidth=bandwidth))

    def stopped(self) -> FootTargetMotion:
        """Return the motion with a target at which it can stop."""
        return self._replace(target=self.position.value + 2 * self.position.rate / _BANDWIDTH)


def begin_foot_target(state: GaitState, leg: int) -> FootTargetMotion:
    """Return the motion of a foot that leaves the gait, from its position and velocity in stance.

    Parameters
    ----------
    state : GaitState
        The state of the walk.
    leg : int
        Index of the leg; its foot is in stance.
    """
    in_heading = state.in_heading(complex(state.foot[leg]))
    vx, vy, wz = state.twist.value.tolist()
    # A stance foot is at rest in G.
    relative = -(complex(vx, vy) + 1j * wz * in_heading)
    here = np.array([in_heading.real, in_heading.imag, float(state.ground_height[leg]) - state.elevation])
    return FootTargetMotion(CriticallyDamped(here, np.array([relative.real, relative.imag, -state.climb])), here)
