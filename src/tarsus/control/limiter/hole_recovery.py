"""Keeps the twist while feet over a hole are drawn back."""

from __future__ import annotations

from tarsus.control.limiter.protocol import TwistGrant, TwistRequest
from tarsus.control.terrain.adaptation import TerrainAdaptation

__all__ = ["HoleRecoveryLimiter"]


class HoleRecoveryLimiter:
    """Follows no other twist until the feet over a hole swing again.

    Parameters
    ----------
    terrain : TerrainAdaptation
        The feet that search for ground.
    """

    def __init__(self, terrain: TerrainAdaptation) -> None:
        self._terrain = terrain

    def limit(self, request: TwistRequest, grant: TwistGrant) -> TwistGrant:
        """Return the grant, with the present target during a recovery."""
        return grant._replace(target=request.target) if self._terrain.recovering else grant
