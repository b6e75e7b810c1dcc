"""Slope limit: refuses twists that lead on to ground too steep to stand on."""

from __future__ import annotations

from collections.abc import Sequence

from tarsus.control.workspace.stance_geometry import LEVEL_TERRAIN, TerrainEstimate

__all__ = ["SlopeLimit"]

# Below this a speed counts as zero [m/s, rad/s].
_NOTHING = 1e-3
# What turning counts beside going, for feet that are some 0.2 m from the middle.
_LIKE_STEPS = (1.0, 1.0, 0.04)


class SlopeLimit:
    """Whether the ground has got too steep to go on: it is no more walked the way that led there."""

    def __init__(self) -> None:
        self._led_here: Sequence[float] | None = None
        self._known = LEVEL_TERRAIN

    def __bool__(self) -> bool:
        return self._led_here is not None

    def record(self, known: TerrainEstimate, twist: Sequence[float]) -> None:
        """Note that the robot can't stand on the ground as it is felt to lie by now.

        Parameters
        ----------
        known : Terrain
            How it was taken to lie when the robot last could.
        twist : (vx, vy, wz)
            How the robot moves [m/s, m/s, rad/s].
        """
        if self._led_here is None and any(abs(speed) > _NOTHING for speed in twist):
            self._led_here, self._known = twist, known

    def forbids(self, twist: Sequence[float], known: TerrainEstimate) -> bool:
        """Return whether a twist leads on to where the robot can't stand.

        Parameters
        ----------
        twist : (vx, vy, wz)
            The twist [m/s, m/s, rad/s].
        known : Terrain
            How the ground is taken to lie: once that is something else, it can stand there.
        """
        if known != self._known:
            self._led_here = None
        if self._led_here is None:
            return False
        return sum(a * b * c for a, b, c in zip(twist, self._led_here, _LIKE_STEPS, strict=True)) > 0
