"""How the robot is asked to walk, apart from where to."""

from __future__ import annotations

from dataclasses import dataclass

from tarsus.control.workspace.stance_geometry import LEVEL_TERRAIN, TerrainEstimate
from tarsus.gait.gait import Gait

__all__ = ["WalkParameters"]


@dataclass(frozen=True, kw_only=True)
class WalkParameters:
    """How the robot is asked to walk, apart from where to.

    Attributes
    ----------
    gait : Gait
        Order of the steps.
    body : tuple of float
        x, y, z [m], roll, pitch, yaw [rad] against standing level at the body height.
    body_height, swing_height : float
        Height of the body's origin, lift of the swinging feet [m].
    stance_width : float
        How much farther out than usual the feet rest [m].
    cycle_time : float or None
        Duration of a cycle [s]; None for the one that gets the robot farthest.
    sway : tuple of float
        Amplitudes of the body's sway, as `body`.
    correction : tuple of float
        What is added to `body`, for the ground's sake.
    excluded : tuple of int
        Legs that don't step.
    terrain : Terrain
        How the ground lies.
    """

    gait: Gait
    body: tuple[float, ...]
    body_height: float
    swing_height: float
    stance_width: float
    cycle_time: float | None
    sway: tuple[float, ...] = (0.0,) * 6
    correction: tuple[float, ...] = (0.0,) * 6
    excluded: tuple[int, ...] = ()
    terrain: TerrainEstimate = LEVEL_TERRAIN

    @property
    def stance(self) -> tuple[float, ...]:
        """How the body is to stand, for the ground's sake too."""
        return tuple(a + b for a, b in zip(self.body, self.correction, strict=True))
