"""How the robot is asked to walk, apart from where to."""

from __future__ import annotations

from dataclasses import dataclass

from tarsus.gait.gait import Gait
from tarsus.gait.live.stand import LEVEL, Terrain

__all__ = ["Manner"]


@dataclass(frozen=True, kw_only=True)
class Manner:
    """How the robot is asked to walk, apart from where to.

    Attributes
    ----------
    gait : Gait
        Order of the steps.
    body : tuple of float
        x, y, z [m], roll, pitch, yaw [rad] against standing level at the clearance.
    clearance, lift : float
        Height of the body's origin, lift of the swinging feet [m].
    stance_width : float
        How much farther out than usual the feet rest [m].
    cycle_time : float or None
        Duration of a cycle [s]; None for the one that gets the robot farthest.
    sway : tuple of float
        Amplitudes of the body's sway, as `body`.
    correction : tuple of float
        What is added to `body`, for the ground's sake.
    gone : tuple of int
        Legs that don't step.
    terrain : Terrain
        How the ground lies.
    """

    gait: Gait
    body: tuple[float, ...]
    clearance: float
    lift: float
    stance_width: float
    cycle_time: float | None
    sway: tuple[float, ...] = (0.0,) * 6
    correction: tuple[float, ...] = (0.0,) * 6
    gone: tuple[int, ...] = ()
    terrain: Terrain = LEVEL

    @property
    def stance(self) -> tuple[float, ...]:
        """How the body is to stand, for the ground's sake too."""
        return tuple(a + b for a, b in zip(self.body, self.correction, strict=True))
