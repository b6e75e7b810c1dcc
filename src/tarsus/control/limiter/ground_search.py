"""Stops the walk while feet search for ground."""

from __future__ import annotations

from tarsus.control.limiter.protocol import RateGrant
from tarsus.control.terrain.adaptation import TerrainAdaptation
from tarsus.control.walk.state import GaitState

__all__ = ["GroundSearchLimiter"]


class GroundSearchLimiter:
    """Stops the walk's time for as long as a foot searches for ground.

    Parameters
    ----------
    terrain : TerrainAdaptation
        The feet that search for ground.
    """

    def __init__(self, terrain: TerrainAdaptation) -> None:
        self._terrain = terrain

    def limit(self, _state: GaitState, grant: RateGrant) -> RateGrant:
        """Return the grant, stopped during a search."""
        return grant._replace(stop=True) if self._terrain.stops_walk else grant
