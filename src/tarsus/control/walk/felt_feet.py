"""The feet of a walk that feels the ground: their state, and their inputs for a tick."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from tarsus.control.pose.posture_feedback import PostureRates

__all__ = ["FeltFoot", "FeltInputs", "GroundUnder", "travel_share"]

# Fraction of the swing in which a foot travels: for strokes up to half the longest, for the longest, and the least.
_SLOW_TRAVEL, _FAST_TRAVEL, _LEAST_TRAVEL = 0.75, 0.92, 0.5


class FeltFoot(NamedTuple):
    """Motion, besides its step, of a foot that feels the ground; by default it stands still.

    Attributes
    ----------
    speed, acceleration : float
        Upward speed in G [m/s]; upward acceleration of a rising foot [m/s^2].
    top, top_phase : float
        Height in G to which a swinging foot rises [m], NaN once it stands; swing phase from which it goes down.
    slide : complex
        Decaying velocity in G of a foot that has landed before the end of its way [m/s].
    drawn_back : complex or None
        Place in G to which a foot is drawn back from an obstacle, or where it stays before steep ground, while it
        rises [m]; None without either.
    bow : complex
        Sideways offset of a swinging foot halfway on its way, so that its leg reaches the top, in G [m].
    """

    speed: float = 0.0
    acceleration: float = 0.0
    top: float = math.nan
    top_phase: float = 0.0
    slide: complex = 0j
    drawn_back: complex | None = None
    bow: complex = 0j


class GroundUnder(NamedTuple):
    """The ground under a foot in the air or without contact, and how far down and up the foot may go; heights in G [m].

    Attributes
    ----------
    expected : float
        Height at which the ground is expected under the foothold.
    lowest, highest : float
        Least and greatest height of the foot on a straight way.
    way : float
        Greatest height of the known ground on the way to the foothold; minus infinity where none is known.
    steep : bool
        Whether the ground rises so soon on the way that the foot has to rise before it travels.
    place : complex or None
        Place in G to which a foot steps that has found no ground or tries to get past an obstacle [m]; None without.
    clears : bool
        Whether a foot that has met an obstacle stays up until it is past the obstacle.
    bow, bowed : complex, float
        Sideways offset by which the foot may swing out on its way, in G [m]; its greatest height when it does.
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
    """Inputs of a walk that feels the ground, for one tick.

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
        Velocity of the body relative to the standing feet, in the heading frame, that makes up for lost way, and keeps
        a body that levels from moving on towards an edge [m/s]; the feet move by its negative.
    yaw_rate : float
        Turning rate of the body over the standing feet that makes up for lost heading [rad/s].
    back : complex
        Velocity of the body over all feet, in the heading frame, by which it backs off an edge, or shifts over feet
        that do not hold it yet [m/s].
    travel : float
        Fraction of its swing in which a foot travels; for the rest it goes straight down.
    pace : float
        Rate of the steps and of the twist, 0 to 1.
    swing_height : float
        How high a foot rises over the higher of its lift-off height and the expected ground [m].
    lowering : float
        Greatest downward speed of a foot [m/s].
    late : float
        Time from a foot's contact until the contact is known [s].
    beside : mapping of int to complex
        Offset from the foothold of its step at which a foot is put down, by leg, in the heading frame [m].
    in_air : bool
        Whether the robot is in the air: all feet go to one height, to be put down together.
    scale : float
        Factor by which lengths and speeds are reduced on short legs, 0 to 1.
    redundant : bool
        Whether more than three feet stand at any time of the gait.
    rough, slow_contact : float, float
        How rough the ground is for feet that go down; how much they slow down just over the expected ground; 0 to 1.
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

    A foot whose contact is known late ends its travel sooner, so as not to slide over the ground until then.

    Parameters
    ----------
    far : float
        Half the longest stroke, over the greatest distance from its rest foothold at which a foot may be put down.
    late : float
        Time from a foot's contact until the contact is known, over the duration of a swing.
    """
    share = _SLOW_TRAVEL + (_FAST_TRAVEL - _SLOW_TRAVEL) * max(2 * far - 1, 0.0)
    return max(share - late, _LEAST_TRAVEL)
