"""Parameters of walking: everything that is commanded except the twist."""

from __future__ import annotations

from dataclasses import dataclass

from tarsus.gait.gait import Gait

__all__ = ["WalkParameters"]


@dataclass(frozen=True, kw_only=True)
class WalkParameters:
    """How the robot stands and steps.

    Attributes
    ----------
    gait : Gait
        Order of the steps.
    body : tuple of float
        Body pose against level at the body height: x, y, z [m], roll, pitch, yaw [rad].
    body_height, swing_height : float
        Height of the body's origin over the ground, and of a swinging foot over its foothold [m].
    stance_width : float
        Distance that the feet rest farther out than by default [m].
    cycle_time : float or None
        Duration of a cycle [s]; None for the one with the highest top speed.
    sway : tuple of float
        Amplitudes of the body's sway, axes as in `body`.
    correction : tuple of float
        Shift over the feet that bear load, added to `body`.
    excluded : tuple of int
        Legs that are taken out of the gait.
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

    @property
    def corrected_body(self) -> tuple[float, ...]:
        """The body pose with its correction."""
        return tuple(a + b for a, b in zip(self.body, self.correction, strict=True))
