"""Slope limit: refuses twists that lead on to ground too steep to stand on."""

from __future__ import annotations

from collections.abc import Sequence

from tarsus.control.workspace.stance_geometry import LEVEL_TERRAIN, TerrainEstimate

__all__ = ["SlopeLimit"]

# Below this a speed counts as zero [m/s, rad/s].
_ZERO_SPEED = 1e-3
# Weights of a twist in m/s, with the feet some 0.2 m from the middle.
_WEIGHTS = (1.0, 1.0, 0.04)


class SlopeLimit:
    """Records the twist that led to ground too steep to stand on, and refuses twists in its direction."""

    def __init__(self) -> None:
        self._cause: Sequence[float] | None = None
        self._terrain = LEVEL_TERRAIN

    def __bool__(self) -> bool:
        return self._cause is not None

    def record(self, terrain: TerrainEstimate, twist: Sequence[float]) -> None:
        """Record that no feasible stance exists on the ground as it is estimated now.

        Parameters
        ----------
        terrain : TerrainEstimate
            The terrain of the last feasible stance.
        twist : (vx, vy, wz)
            Current twist of the robot [m/s, m/s, rad/s].
        """
        if self._cause is None and any(abs(speed) > _ZERO_SPEED for speed in twist):
            self._cause, self._terrain = twist, terrain

    def forbids(self, twist: Sequence[float], terrain: TerrainEstimate) -> bool:
        """Return whether a twist leads further in the direction of infeasible ground.

        Parameters
        ----------
        twist : (vx, vy, wz)
            A twist [m/s, m/s, rad/s].
        terrain : TerrainEstimate
            The terrain of the current stance; another one than recorded clears the limit.
        """
        if terrain != self._terrain:
            self._cause = None
        if self._cause is None:
            return False
        return sum(a * b * c for a, b, c in zip(twist, self._cause, _WEIGHTS, strict=True)) > 0
