"""Slope limit: refuses to go further up or down slopes that are too slippery or on which the body is not kept level."""

from __future__ import annotations

import math

from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.limiter.protocol import TwistGrant, TwistRequest
from tarsus.gait.foot_plane import FootPlane

__all__ = ["SlopeLimit"]

# Friction used up by legs that press against each other, over their load, under which they give way outwards.
_PRELOAD = 0.32
# How far a slope must be below the steepest one to be walked again [rad].
_HYSTERESIS = math.radians(2.0)
# On slopes above the first angle, a body this far off its attitude stops, until it is off by less than the third [rad].
_SLOPES, _OFF, _LEVELLED = math.radians(8.0), math.radians(12.0), math.radians(8.0)
# A body tips while it is farther off its attitude than in the mean by the first [rad], the mean over the second [s].
_TIPS, _MEAN = math.radians(0.5), 0.6


class SlopeLimit:
    """Refuses motion further up or down a slope on which feet would slip, or the robot would tip over.

    Feet slip where the tangent of the slope plus the friction used up by legs that press against each other exceeds the
    coefficient of friction. Where legs at the end of their reach no longer keep the body level, its weight shifts
    downhill, which tilts it further: it stops, and the feet step to where legs reach, until it is level again.

    Parameters
    ----------
    friction : float
        Coefficient of friction of the feet.

    Attributes
    ----------
    steepest : float
        Steepest slope that is walked [rad].
    slope : float
        The slope under the feet; while motion is refused, the steepest one since that began [rad].
    refused, refuses : float, bool
        Which motion is refused: positive for uphill, negative for downhill, 0 for none; whether the motion that is
        followed is refused, as feet would slip or the body tips.
    """

    def __init__(self, friction: float) -> None:
        self.steepest = math.atan(max(friction - _PRELOAD, 0.0))
        self.slope, self.refuses = 0.0, False
        # Whether the body is too far off its attitude; how far off it is now, and in the mean [rad].
        self._tilts, self._off, self._mean, self.refused = False, 0.0, 0.0, 0.0
        self._uphill, self._stops, self._tips = 0j, False, False

    def step(self, level: FootPlane, velocity: complex, dt: float, *, off: float = 0.0) -> None:
        """Decide on a motion.

        Parameters
        ----------
        level, velocity : FootPlane, complex
            The plane of the feet as a level body sees it; the velocity that is followed, in the heading frame [m/s].
        dt, off : float
            Time since the last call [s]; by how much the body is off the attitude to keep [rad].
        """
        self._uphill = complex(level.slope_x, level.slope_y)
        slope, rises = math.atan(abs(self._uphill)), self._rises(velocity)
        self._mean += min(dt / _MEAN, 1.0) * (off - self._mean)
        self._off, self._tilts = off, slope > _SLOPES and off > (_LEVELLED if self._tilts else _OFF)
        if slope < self.steepest - _HYSTERESIS and not self._tilts:
            self.refused = 0.0
        elif (slope > self.steepest or self._tilts) and not self.refused:
            self.refused = rises
        self.slope = max(self.slope, slope) if self.refused else slope
        self._tips = off > self._mean + _TIPS or slope > self.steepest - _HYSTERESIS
        # The way back stays open.
        self.refuses = self.refused * rises > 0 and not self._stops

    def limit(self, request: TwistRequest, grant: TwistGrant) -> TwistGrant:
        """Return the grant, with no twist further up or down while the body is off level: feet step on the spot."""
        leads = self._tilts and self.refused * self._rises(complex(*request.twist[:2])) > 0
        # While the body tips, the walk waits: stepping on the spot begins once it no longer does.
        self._stops = leads and (self._stops or not self._tips)
        if self._stops:
            return grant.at_most(0.0, Limitation(kind=LimitationKind.GROUND, cause=self.reason))
        return grant

    def _rises(self, velocity: complex) -> float:
        return (velocity * self._uphill.conjugate()).real

    @property
    def holds(self) -> bool:
        """Whether no foot is to lift off: feet would slip, or the body tips."""
        return self.refuses or (self._stops and self._tips)

    @property
    def reason(self) -> str:
        """Why motion is refused."""
        if self._tilts:
            # Once stopped, the robot goes on below the lower bound.
            off, most = math.degrees(self._off), math.degrees(_OFF if self._off > _OFF else _LEVELLED)
            return f"the legs do not keep the body level: off by {off:.0f} deg, at most {most:.0f} deg"
        steepest = f"the steepest one for their friction is {math.degrees(self.steepest):.0f} deg"
        return f"a slope of {math.degrees(self.slope):.0f} deg, on which feet slip; {steepest}"
