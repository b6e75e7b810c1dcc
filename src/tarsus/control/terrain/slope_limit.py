"""Slope limit: no further up or down slopes that are too slippery, or on which legs do not keep the body level."""

from __future__ import annotations

import math

from tarsus.gait.foot_plane import FootPlane

__all__ = ["SlopeLimit"]

# Friction that legs use up which press against each other, over their load: they give way outwards under it.
_PRELOAD = 0.32
# How much less steep a slope is that is walked again [rad].
_HYSTERESIS = math.radians(2.0)
# Slope from which on a body waits that is so far off its attitude, until it is less so [rad].
_SLOPES, _OFF, _LEVELLED = math.radians(8.0), math.radians(12.0), math.radians(8.0)


class SlopeLimit:
    """Refuses motion further up or down a slope on which feet would slip, or the robot would tip over.

    Feet slip where the slope's tangent and the friction that legs use up against each other exceed the coefficient of
    friction. A body that legs at the end of their reach no longer keep level shifts its weight downhill, which tilts it
    further: it waits until it is level again.

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
        # Whether the body is too far off its attitude, and how far it is [rad].
        self._tilts, self._off, self._refused = False, 0.0, 0.0

    def step(self, level: FootPlane, velocity: complex, off: float = 0.0) -> None:
        """Decide on a motion.

        Parameters
        ----------
        level, velocity : FootPlane, complex
            The plane of the feet as a level body sees it; the velocity that is asked for [m/s].
        off : float
            By how much the body is off the attitude to keep [rad].
        """
        slope = math.atan(math.hypot(level.slope_x, level.slope_y))
        rises = velocity.real * level.slope_x + velocity.imag * level.slope_y
        self._off, self._tilts = off, slope > _SLOPES and off > (_LEVELLED if self._tilts else _OFF)
        if slope < self.steepest - _HYSTERESIS and not self._tilts:
            self._refused = 0.0
        elif (slope > self.steepest or self._tilts) and not self._refused:
            self._refused = rises
        self.slope = max(self.slope, slope) if self._refused else slope
        # The way back stays open.
        self.refuses = self._refused * rises > 0

    @property
    def reason(self) -> str:
        """Why motion is refused."""
        if self._tilts:
            # One that has waited goes on once it is less.
            off, most = math.degrees(self._off), math.degrees(_OFF if self._off > _OFF else _LEVELLED)
            return f"a slope on which legs do not keep the body level: off by {off:.0f} deg, at most {most:.0f} deg"
        steepest = f"the steepest one for their friction is {math.degrees(self.steepest):.0f} deg"
        return f"a slope of {math.degrees(self.slope):.0f} deg, on which feet slip; {steepest}"
