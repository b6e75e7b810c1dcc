"""Slope limit: slopes that are too slippery for position-controlled legs are not walked further up or down."""

from __future__ import annotations

import math

from tarsus.gait.foot_plane import FootPlane

__all__ = ["SlopeLimit"]

# Friction that legs use up which press against each other, over their load: they give way outwards under it.
_PRELOAD = 0.32
# How much less steep a slope is that is walked again [rad].
_HYSTERESIS = math.radians(2.0)


class SlopeLimit:
    """Refuses motion further up or down a slope on which feet would slip.

    Feet slip where the slope's tangent and the friction that legs use up against each other exceed the coefficient of
    friction.

    Parameters
    ----------
    friction : float
        Coefficient of friction of the feet.

    Attributes
    ----------
    steepest : float
        Steepest slope that is walked [rad].
    slope : float
        The slope under the feet; where motion is refused, the steepest one since then [rad].
    refuses : bool
        Whether the motion is refused.
    """

    def __init__(self, friction: float) -> None:
        self.steepest = math.atan(max(friction - _PRELOAD, 0.0))
        self.slope, self.refuses = 0.0, False
        self._refused = 0.0

    def step(self, level: FootPlane, velocity: complex) -> None:
        """Decide on a motion.

        Parameters
        ----------
        level : FootPlane
            The plane of the feet as a level body sees it.
        velocity : complex
            The velocity that is asked for [m/s].
        """
        slope = math.atan(math.hypot(level.slope_x, level.slope_y))
        rises = velocity.real * level.slope_x + velocity.imag * level.slope_y
        if slope < self.steepest - _HYSTERESIS:
            self._refused = 0.0
        elif slope > self.steepest and not self._refused:
            self._refused = rises
        self.slope = max(self.slope, slope) if self._refused else slope
        # The way back stays open.
        self.refuses = self._refused * rises > 0

    @property
    def reason(self) -> str:
        """Why motion is refused."""
        steepest = f"the steepest one for their friction is {math.degrees(self.steepest):.0f} deg"
        return f"a slope of {math.degrees(self.slope):.0f} deg, on which feet slip; {steepest}"
