"""Slope limit: refuses to go further up or down slopes that are too slippery or on which the body is not kept level."""

from __future__ import annotations

import math

from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.limiter.protocol import TwistGrant, TwistRequest
from tarsus.gait.foot_plane import FootPlane

__all__ = ["SlopeLimit"]

# Friction used up by legs that press against each other, over their load, under which they give way outwards; they use
# up all but the second share of low friction.
_PRELOAD, _LEFT = 0.32, 1 / 3
# How far a slope must be below the steepest one to be walked again [rad]; half of the steepest one where that is less.
_HYSTERESIS = math.radians(2.0)
# Climbs and descents up to this height tell on which way a slope was met [m]. Motion at less than a share of its speed,
# or than a speed [m/s], is neither up nor down.
_CLIMBED, _ALONG, _STILL = 0.15, 0.2, 0.002
# On slopes above the first angle, a body this far off its attitude stops, until it is off by less than the third [rad].
_SLOPES, _OFF, _LEVELLED = math.radians(8.0), math.radians(12.0), math.radians(8.0)
# A body tips while it is farther off its attitude than in the mean by the first [rad], the mean over the second [s].
_TIPS, _MEAN = math.radians(0.5), 0.6


class SlopeLimit:
    """Refuses motion further up or down a slope on which feet would slip, or the robot would tip over.

    Feet slip where the tangent of the slope plus the friction used up by legs that press against each other exceeds the
    coefficient of friction. The motion on which the robot has met such a slope is refused; the way back stays open.
    Where legs at the end of their reach no longer keep the body level, its weight shifts downhill, which tilts it
    further: it stops, and the feet step to where legs reach, until it is level again.

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
        self.steepest = math.atan(max(friction - _PRELOAD, _LEFT * friction))
        self._walkable = max(self.steepest - _HYSTERESIS, self.steepest / 2)
        self.slope, self.refuses = 0.0, False
        # Whether the body is too far off its attitude; how far off it is now, and in the mean [rad].
        self._tilts, self._off, self._mean, self.refused = False, 0.0, 0.0, 0.0
        # The uphill direction times the slope; how far the robot has climbed on this slope [m], negative downhill.
        self._uphill, self._climbed, self._stops, self._tips = 0j, 0.0, False, False
        # Whether the command leads where motion is refused; what is followed may do so for longer.
        self._leads = True

    def step(self, level: FootPlane, velocity: complex, dt: float, *, off: float = 0.0) -> None:
        """Decide on a motion.

        Parameters
        ----------
        level, velocity : FootPlane, complex
            The plane of the feet as a level body sees it; the velocity that is followed, in the heading frame [m/s].
        dt, off : float
            Time since the last call [s]; by how much the body is off the attitude to keep [rad].
        """
        before, self._uphill = self._uphill, complex(level.slope_x, level.slope_y)
        slope, rises = math.atan(abs(self._uphill)), self._rises(velocity)
        # Beyond a ridge or a valley there is another slope.
        climbed = self._climbed * ((before * self._uphill.conjugate()).real >= 0.0)
        self._climbed = min(max(climbed + rises * dt, -_CLIMBED), _CLIMBED)
        self._mean += min(dt / _MEAN, 1.0) * (off - self._mean)
        self._off, self._tilts = off, slope > _SLOPES and off > (_LEVELLED if self._tilts else _OFF)
        if slope < self._walkable and not self._tilts:
            self.refused = 0.0
        elif (slope > self.steepest or self._tilts) and not self.refused:
            self.refused = self._climbed
        self.slope = max(self.slope, slope) if self.refused else slope
        self._tips = off > self._mean + _TIPS or slope > self._walkable
        self.refuses = self._leads and self.refused * rises > 0 and not self._stops

    def limit(self, request: TwistRequest, grant: TwistGrant) -> TwistGrant:
        """Return the grant, with no twist further up or down while the body is off level: feet step on the spot."""
        # Before a slope is refused, its steepness decides with the next motion.
        self._leads = not self.refused or self.refused * self._rises(complex(*request.twist[:2])) > 0
        # While the body tips, the walk waits: stepping on the spot begins once it no longer does.
        tilts = self._tilts and bool(self.refused)
        self._stops = tilts and self._leads and (self._stops or not self._tips)
        return grant.at_most(0.0, Limitation(kind=LimitationKind.GROUND, cause=self.reason)) if self._stops else grant

    def _rises(self, velocity: complex) -> float:
        """Return how fast the ground rises [m/s]; 0 for motion along the slope."""
        rises = (velocity * self._uphill.conjugate()).real
        return rises if abs(rises) > max(_ALONG * abs(velocity), _STILL) * abs(self._uphill) else 0.0

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
