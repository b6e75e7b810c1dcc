"""Roughness: how uneven the ground is that feet have met, and how heights, stance and cycle adapt to it."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from tarsus.errors import InputError
from tarsus.gait.walk_setup import require_number
from tarsus.representation import represented

__all__ = ["GroundAdaptation", "Roughness"]

# Roughness that a collision counts as [m].
_COLLISION = 0.04
# Deviation from the expected ground up to which a foothold counts as even [m].
_EVEN = 0.008
# Cycles after which the roughness has fallen to 1/e.
_MEMORY = 4.0
# Roughness up to which feet are drawn in ever farther; from there to the second, cycle time and speed change [m].
_ROUGH, _ROUGHEST = 0.02, 0.04
# Roughness at which the cycle time is that on even ground again: legs reach less high and low in long strokes [m].
_HIGH = 0.05
# How much deeper than expected rough ground may be, over the roughness, and at most [m]; time constant of lasting
# roughness [cycles], and the greatest depth for it [m]: at a single edge on even ground, roughness has not lasted.
_DEEPER, _DEEPEST, _LASTS, _LASTING_DEEPEST = 2.5, 0.03, 3.0, 0.05
# Number of steps in which stance, cycle time and speed change: for each step, limits are computed again.
_STEPS = 4


@represented()
@dataclass(frozen=True, kw_only=True)
class GroundAdaptation:
    """How far a walk may adapt to rough ground, and how slippery the ground may be.

    Lengths are for legs whose femur and tibia measure 190 mm or more together; shorter legs adapt less, in proportion.

    Attributes
    ----------
    swing_height, body_height : float
        Greatest additions to the swing height and to the body height [m].
    drawn_in : float
        How far feet may be drawn in, so that legs reach higher and lower, by 0.4 of their distance from the coxa axes
        at most [m].
    cycle_time : float
        Greatest cycle time on rough ground and slopes, over that on even ground: fewer and longer steps slip less,
        but legs reach less high and low in them.
    speed : float
        Greatest speed on rough ground, over the top speed on even ground.
    catch_up : float
        Greatest speed, over the commanded one, at which the walk makes up for time lost on the ground; 1 for none.
    friction : float
        Coefficient of friction to rely on: slopes on which feet would slip with it are refused.

    Raises
    ------
    InputError
        If a value is negative or not finite, `cycle_time` or `catch_up` is below 1, `speed` or `friction` is 0, or
        `speed` is above 1.
    """

    swing_height: float = 0.05
    body_height: float = 0.06
    drawn_in: float = 0.02
    cycle_time: float = 1.25
    speed: float = 0.7
    catch_up: float = 1.5
    friction: float = 0.8

    def __post_init__(self) -> None:
        for name in (field.name for field in fields(self)):
            what, most = f"ground adaptation: {name}", 1.0 if name == "speed" else math.inf
            number = require_number(what, getattr(self, name), zero=name not in {"speed", "friction"}, most=most)
            object.__setattr__(self, name, number)
        for name in ("cycle_time", "catch_up"):
            if getattr(self, name) < 1:
                raise InputError(f"ground adaptation: {name} is {getattr(self, name)}; it must be finite, at least 1")


class Roughness:
    """Rises at once with every foothold off the expected ground and every collision, and falls slowly.

    Parameters
    ----------
    adaptation, scale : GroundAdaptation, float
        How far the walk may adapt; factor by which lengths are reduced on short legs, 0 to 1.

    Attributes
    ----------
    adaptation : GroundAdaptation
        How far the walk may adapt.
    value : float
        Deviation of footholds from the expected ground, beyond that on even ground; it decays with the cycles [m].
    """

    def __init__(self, adaptation: GroundAdaptation, *, scale: float = 1.0) -> None:
        self.value = self._lasting = self._edge = 0.0
        self.adaptation, self._scale = adaptation, scale

    def landed(self, off: float) -> None:
        """Take note of a foothold at this height over the expected ground, negative below it [m]."""
        self.value = max(self.value, abs(off) - self._scale * _EVEN)

    def at_edge(self, depth: float) -> None:
        """Take note of a foot this far below the expected ground whose leg may rest on the edge of a step [m].

        With the body higher and the feet drawn in, legs are steeper beside the edge. The ground does not count as
        rough: feet that went down faster and pressed on it would tip the robot over the edge.
        """
        self._edge = max(self._edge, depth - self._scale * _EVEN)

    def collided(self) -> None:
        """Take note of a collision."""
        self.value = max(self.value, self._scale * _COLLISION)

    def decay(self, cycles: float) -> None:
        """Let the roughness decay over this many cycles."""
        kept = math.exp(-cycles / _MEMORY)
        self.value, self._edge = self.value * kept, self._edge * kept
        rising = self._lasting + (self.value - self._lasting) * -math.expm1(-cycles / _LASTS)
        self._lasting = min(rising, self.value)

    @property
    def _or_edge(self) -> float:
        """The roughness, or what replaces it beside an edge: heights and stance alone adapt to that [m]."""
        return max(self.value, self._edge)

    @property
    def swing_rise(self) -> float:
        """Addition to the swing height [m]."""
        return min(self._or_edge, self._scale * self.adaptation.swing_height)

    @property
    def body_rise(self) -> float:
        """Addition to the body height [m]."""
        return min(self._or_edge, self._scale * self.adaptation.body_height)

    @property
    def drawn_in(self) -> float:
        """How far feet are drawn in [m]."""
        return self._share(self._or_edge, 0.0, _ROUGH) * self._scale * self.adaptation.drawn_in

    @property
    def deeper(self) -> float:
        """How much deeper ground may be than expected [m]."""
        once = min(_DEEPER * self.value, self._scale * _DEEPEST)
        return max(once, min(_DEEPER * self._lasting, self._scale * _LASTING_DEEPEST))

    def cycle_time(self, on_slope: float = 1.0) -> float:
        """Return the cycle time over that on even ground; on slopes at least `on_slope`, as far as it may change."""
        most = self.adaptation.cycle_time
        longer = max(self._share(self.value, _ROUGH, _ROUGHEST) * (most - 1), min(on_slope, most) - 1)
        return 1 + longer * (1 - self._share(self.value, _ROUGHEST, _HIGH))

    @property
    def speed(self) -> float:
        """Greatest speed over the top speed on even ground."""
        return 1 - self._share(self.value, _ROUGH, _ROUGHEST) * (1 - self.adaptation.speed)

    def _share(self, value: float, least: float, most: float) -> float:
        """Return where a roughness is between two values, 0 to 1, rounded to steps."""
        share = (value / self._scale - least) / (most - least)
        return min(max(round(_STEPS * share) / _STEPS, 0.0), 1.0)
