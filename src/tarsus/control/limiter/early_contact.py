"""Slows the walk down for swings that are shorter than planned, or end higher or lower."""

from __future__ import annotations

from tarsus.control.limiter.protocol import RateGrant
from tarsus.control.terrain.adaptation import TerrainAdaptation
from tarsus.control.terrain.early_contact import relaxed_rate
from tarsus.control.transition.executor import TransitionExecutor
from tarsus.control.walk.state import GaitState

__all__ = ["EarlyContactLimiter"]


class EarlyContactLimiter:
    """Leaves the joints the time for swings that are harder than planned.

    Parameters
    ----------
    transitions : TransitionExecutor
        The gait.
    terrain : TerrainAdaptation
        Whether there is any feedback from the ground.
    """

    def __init__(self, transitions: TransitionExecutor, terrain: TerrainAdaptation) -> None:
        self._transitions, self._terrain = transitions, terrain

    def limit(self, state: GaitState, grant: RateGrant) -> RateGrant:
        """Return the grant for at most the relaxed rate."""
        if self._terrain.estimate is None:
            return grant
        rate = relaxed_rate(state, self._transitions.timing.gait.duty_factor)
        return grant._replace(rate=min(grant.rate, rate))
