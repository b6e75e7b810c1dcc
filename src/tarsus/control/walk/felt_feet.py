"""The feet of a walk that feels the ground: their state, and what they are given for a tick."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from tarsus.control.pose.posture_feedback import PostureRates

__all__ = ["ROUNDING", "FeltFoot", "FeltInputs", "GroundUnder", "travel_share"]

ROUNDING = 1e-9
"""Differences of heights below this are rounding [m]."""

# Fraction of the swing in which a foot travels, up to half the longest stroke and with the longest one; at least.
_SLOW_TRAVEL, _FAST_TRAVEL, _LEAST_TRAVEL = 0.75, 0.92, 0.5


class FeltFoot(NamedTuple):
    """What a foot of a walk that feels the ground does besides its step; by default it stands still.

    Attributes
    ----------
    speed, acceleration : float
        Upward speed in G [m/s]; upward acceleration of a rising foot [m/s^2].
    top, top_phase : float
        Height in G to which a swinging foot rises [m], NaN on the ground; swing phase from which on it goes down.
    slide : complex
        Velocity in G of a foot that has landed before the end of its way, which decays [m/s].
    drawn_back : complex or None
        Where in G a foot that has met an obstacle is drawn back to while it rises [m]; None without one.
    bow : complex
        How far a swinging foot swings out on its way, so that its leg reaches the top, in G [m].
    """

    speed: float = 0.0
    acceleration: float = 0.0
    top: float = math.nan
    top_phase: float = 0.0
    slide: complex = 0j
    drawn_back: complex | None = None
    bow: complex = 0j


class GroundUnder(NamedTuple):
    """The ground under a foot in the air or without contact, and how far down and up the foot goes: heights in G [m].

    Attributes
    ----------
    expected : float
        Where the ground is expected under the foothold.
    lowest, highest : float
        Below and above which the foot does not go on a straight way.
    way : float
        How high the ground is at most on the way there.
    steep : bool
        Whether it rises so soon on the way that the foot has to rise before it travels.
    place : complex or None
        Where in G a foot steps that has found no ground, or tries to get past an obstacle [m].
    clears : bool
        Whether a foot that has met an obstacle stays up until it is past that.
    bow, bowed : complex, float
        How far the foot may swing out on its way, in G [m], and above which height it does not go then.
    """

    expected: float
    lowest: float
    highest: float
    way: float = -math.inf
    steep: bool = False
    place: complex | None = None
    clears: bool = False
    bow: complex = 0j
    bowed: float = -math.inf


class FeltInputs(NamedTuple):
    """What a walk that feels the ground is given for a tick.

    Attributes
    ----------
    under : list of (GroundUnder or None)
        For each foot that swings, lifts off, or should stand and does not; None for the others.
    stands : list of bool
        Whether each foot on the ground bears load, as far as is known.
    steps : list of bool
        Whether each leg is in the gait.
    depth : float
        How far below the expected ground a foot should be by the end of its swing [m].
    rates : PostureRates
        How the body is to move over the standing feet.
    drift : complex
        Velocity of the standing feet against the body's, in the heading frame, that makes up for lost way [m/s].
    yaw_rate : float
        How fast the body turns over the standing feet, to make up for lost heading [rad/s].
    back : complex
        Velocity of the body over all feet, in the heading frame, by which it backs off an edge [m/s].
    travel : float
        Fraction of its swing in which a foot travels: in the rest it goes straight down.
    pace : float
        Rate of the steps and of the twist, 0 to 1.
    swing_height : float
        How high a foot rises over the higher of lift-off and expected ground [m].
    lowering : float
        Greatest speed of a foot that goes down [m/s].
    late : float
        Time from a foot's contact until that is known [s].
    beside : mapping of int to complex
        How far from the foothold of its step a foot is put down, by leg, in the heading frame [m].
    in_air : bool
        Whether the robot is in the air: all feet go to one height, to be put down together.
    scale : float
        By how much speeds are smaller than given, on short legs, 0 to 1.
    redundant : bool
        Whether more than three feet stand at any time of the gait.
    rough, slow_contact : float, float
        How rough the ground is for feet that go down; how far they slow down just over the expected ground; 0 to 1.
    """

    under: list[GroundUnder | None]
    stands: list[bool]
    steps: list[bool]
    depth: float
    rates: PostureRates
    drift: complex
    yaw_rate: float
    back: complex
    travel: float
    pace: float
    swing_height: float
    lowering: float
    late: float
    beside: Mapping[int, complex]
    in_air: bool = False
    scale: float = 1.0
    redundant: bool = False
    rough: float = 0.0
    slow_contact: float = 0.0


def travel_share(far: float, late: float) -> float:
    """Return the fraction of its swing in which a foot travels.

    A foot whose contact is known late goes down sooner: it is not to move over the ground until then.

    Parameters
    ----------
    far : float
        Half the longest stroke, over the greatest distance from its rest foothold at which a foot may be put down.
    late : float
        Time from a foot's contact until that is known, over the duration of a swing.
    """
    share = _SLOW_TRAVEL + (_FAST_TRAVEL - _SLOW_TRAVEL) * max(2 * far - 1, 0.0)
    return max(share - late, _LEAST_TRAVEL)
