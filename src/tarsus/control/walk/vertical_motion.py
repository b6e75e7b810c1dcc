"""Vertical motion of feet that feel the ground: they rise, go down until contact, and carry the body."""

from __future__ import annotations

import cmath
import math
from typing import TypeAlias

import numpy as np

from tarsus.control.walk.felt_feet import FeltFoot, FeltInputs, GroundUnder
from tarsus.control.walk.state import ROUNDING, GaitState, StepInputs
from tarsus.gait.swing_trajectory import quintic

__all__ = ["moved_vertically"]

_STILL = FeltFoot()

# Of a foot in the air: swing phase, duration of the swing [s], height at lift-off and place in G [m].
_Swing: TypeAlias = tuple[float, float, float, complex]

# Swing phase at which a foot is at its top, on even and on rough ground.
_TOP_PHASE, _ROUGH_TOP_PHASE = 0.42, 0.45
# Greatest mean speed up to a top that changes during the rise [m/s]: without it, a foot shortly before its top would be
# thrown up.
_FASTEST_RISE = 0.5
# Least rise above lift-off, over the swing height: with less, the foot drags on the ground as the body sinks.
_LEAST_RISE = 0.5
# Where the ground rises soon: swing phase up to which a foot may begin to rise before it travels; phase of its top.
_RISING_FIRST, _STEEP_TOP_PHASE = 0.15, 0.35
# Fraction of a swing in which a foot goes down from its top to the expected ground: on even ground, on rough ground,
# and the least where contact is known late.
_DESCENT, _ROUGH_DESCENT, _SHORTEST_DESCENT = 0.5, 0.4, 0.2
# The same fraction for a foot that slows down before contact, and its speed then [m/s].
_SLOW_DESCENT, _SLOW_CONTACT = 0.52, 0.09
# Fraction of its way down a slope that a foot has covered at its top.
_BEHIND = 0.5
# Height over the expected ground from which a foot moves to the place it steps back to, over the height it rises to.
_CLEAR = 0.9
# Least downward speed of a swinging foot, and of a foot that should stand but has no contact [m/s].
_LOWERING, _SEARCHING = 0.12, 0.15
# Least downward speed, on even ground, of a foot that has lost its contact [m/s], while this many others stand and it
# is this far below the expected ground [m]: a faster one would push the others off the ground.
_LOSING, _OTHERS, _NEAR = 0.04, 3, 0.004
# The same in gaits in which more than three feet always stand [m/s], while the rate of the walk is above the second:
# feet that are pushed off search in turn.
_LOSING_ONE_OF_MANY, _GOES_ON = 0.02, 0.5
# Time in which a foot that should stand goes down to the expected ground [s].
_SEARCH_TIME = 0.1
# Height over the expected ground below which a foot slows down [m]; how far one whose contact is known late may press
# into the ground until then [m], plus this fraction of the depth that it should reach below the expected ground.
_NEARS, _PRESSED, _PRESSED_DEEP = 0.007, 0.004, 0.4
# Clearance of a descending foot over known ground on its way [m].
_OVER = 0.015
# Distance from the place it was drawn back to from which a foot goes down again [m].
_PAST = 0.05
# Upward and horizontal speed of a foot that steps back [m/s].
_RISING, _BACK = 0.3, 0.4
# Greatest changes of speed: of feet in the air, of the body, of feet on the ground, and of their slide [m/s^2].
_FOOT_ACCELERATION, _BODY_ACCELERATION, _STANDING_ACCELERATION, _STOPPING = 6.0, 1.0, 15.0, 12.0


def moved_vertically(state: GaitState, inputs: StepInputs, dt: float) -> GaitState:
    """Return the gait state with the heights of feet and body after a time; the same state without readings.

    Parameters
    ----------
    state, inputs, dt : GaitState, StepInputs, float
        The gait state after the time, except for heights; what is constant for the time; the time [s].
    """
    felt = inputs.felt
    if felt is None:
        return state
    climb = _towards(state.climb, felt.rates.climb, _BODY_ACCELERATION * dt)
    body, heading = state.elevation + float(state.posture.value[2]), cmath.exp(1j * state.yaw)
    # Both in G.
    turning, drift = complex(felt.rates.turn[1], -felt.rates.turn[0]) * heading, felt.drift * heading
    yaw_rate = 1j * felt.yaw_rate
    swing, origin, across = 1 - inputs.gait.duty_factor, state.origin, turning.conjugate()
    places, heights, feet, stop = state.foot.tolist(), state.ground_height.tolist(), list(state.felt), _STOPPING * dt
    delays, phases, starts = state.lift_delay.tolist(), state.swing_phase.tolist(), state.start_height.tolist()
    step, legs = _STANDING_ACCELERATION * dt, zip(state.down.tolist(), felt.steps, felt.stands, felt.under, strict=True)
    for leg, (down, steps, stands, under) in enumerate(legs):
        foot, height = feet[leg], heights[leg]
        if not steps:
            feet[leg] = foot._replace(speed=0.0, acceleration=0.0)
        elif down:
            # A foot on the ground moves by the turn about the body, the drift and its slide.
            before, top, slide = foot.speed, foot.top, foot.slide
            place = places[leg]
            arm = place - origin
            wanted = -(arm * across).real
            if felt.in_air:
                wanted = min(max((state.elevation - height) / _SEARCH_TIME, -_SEARCHING), _SEARCHING)
            if stands:
                place += (turning * (height - body) - drift - yaw_rate * arm) * dt
                speed = _towards(before, wanted, step)
                heights[leg], top = height + (before + speed) / 2 * dt, math.nan
            else:
                assert under is not None  # given for each foot that has lost its contact
                heights[leg], place, speed = _searching(height, foot, place, wanted, under, felt, dt)
            if slide:
                left = max(1 - stop / abs(slide), 0.0)
                place += slide * (1 + left) / 2 * dt
                slide *= left
            places[leg] = place
            feet[leg] = FeltFoot(speed, 0.0, top, 0.0, slide) if speed or slide or top > -math.inf else _STILL
        else:
            assert under is not None  # given for each foot in the air
            swing_time = (swing - delays[leg]) / inputs.frequency if inputs.frequency else math.inf
            now = (phases[leg], swing_time, starts[leg], places[leg])
            heights[leg], feet[leg] = _swinging(height, foot, under, felt, dt, now)
    steps_back = [leg for leg, under in enumerate(felt.under) if under is not None and under.place is not None]
    foothold = state.foothold
    if steps_back:
        foothold = foothold.copy()
        foothold[steps_back] = [places[leg] for leg in steps_back]
    return state._replace(
        foot=np.array(places),
        ground_height=np.array(heights),
        felt=feet,
        foothold=foothold,
        origin=origin + felt.back * heading * dt,
        elevation=state.elevation + (state.climb + climb) / 2 * dt,
        climb=climb,
    )


def _searching(
    height: float, foot: FeltFoot, place: complex, wanted: float, under: GroundUnder, felt: FeltInputs, dt: float
) -> tuple[float, complex, float]:
    """Return height, place and speed of a foot that should stand and has no contact: it goes down, or steps back."""
    over, speed = height - under.expected, foot.speed
    if under.place is None or abs(under.place - place) <= _BACK * dt:
        # The place to step to moves while the body backs off.
        place = place if under.place is None else under.place
        least = felt.scale * _SEARCHING
        fastest = felt.lowering if under.place is None else max(felt.lowering, least)
        slowest = _losing(over, felt) if math.isnan(foot.top) and sum(felt.stands) >= _OTHERS else least
        wanted -= min(max(slowest, over / _SEARCH_TIME), fastest, _fastest_contact(over, felt))
        after = _towards(speed, wanted, _FOOT_ACCELERATION * dt)
        height, after = _no_lower(height + (speed + after) / 2 * dt, after, height, under.lowest)
        return height, place, after
    # The foot rises over the edge or the obstacle, then goes to its place.
    clear = felt.swing_height if math.isnan(foot.top) else foot.top - under.expected
    way, rising = under.place - place, _RISING if over < clear else 0.0
    after = _towards(speed, rising, _FOOT_ACCELERATION * dt)
    if over > _CLEAR * clear:
        place = under.place if abs(way) <= _BACK * dt else place + _BACK * dt * way / abs(way)
    return height + (speed + after) / 2 * dt, place, after


def _losing(over: float, felt: FeltInputs) -> float:
    """Return the least downward speed of a foot that has lost its contact, at a height over the expected ground."""
    if felt.redundant and felt.pace > _GOES_ON:
        return felt.scale * _LOSING_ONE_OF_MANY
    rough = felt.rough if over < -felt.scale * _NEAR else 1.0
    return felt.scale * (_LOSING + rough * (_SEARCHING - _LOSING))


def _swinging(
    height: float, foot: FeltFoot, under: GroundUnder, felt: FeltInputs, dt: float, swing: _Swing
) -> tuple[float, FeltFoot]:
    """Return the height of a foot in the air, and its state: it rises to its top, then goes down."""
    phase, swing_time, lifted_at, place = swing
    speed, acceleration, top, top_phase, slide, drawn_back, bow = foot
    part = _DESCENT + felt.rough * (_ROUGH_DESCENT - _DESCENT)
    part = max(part + felt.slow_contact * (_SLOW_DESCENT - part) - felt.late / swing_time, _SHORTEST_DESCENT)
    if math.isnan(top) or (phase < top_phase and drawn_back is None):
        # No higher than the foot can rise in time, and come down from by the end of its swing.
        top_phase = _TOP_PHASE + felt.rough * (_ROUGH_TOP_PHASE - _TOP_PHASE)
        rises = height + _FASTEST_RISE * (top_phase - phase) * swing_time
        falls = under.expected - felt.depth + felt.lowering * part * swing_time
        fits = max(falls, lifted_at + _LEAST_RISE * felt.swing_height)
        start = lifted_at - _BEHIND * max(lifted_at - under.expected, 0.0)
        over = max(start, under.expected, under.way) + felt.swing_height
        highest = max(under.highest, under.bowed)
        top = max(min(over, highest, fits, rises), height)
        bow = under.bow * max(min(top, highest) - under.highest, 0.0) / max(highest - under.highest, ROUNDING)
        if under.steep and 0.0 < phase < _RISING_FIRST:
            drawn_back, top_phase = place, _STEEP_TOP_PHASE
    if phase < top_phase:
        time = dt * felt.pace
        whole = (top_phase - phase) * swing_time + time
        height, speed, acceleration = quintic((height, speed, acceleration), top, whole, time / whole)
        return height, FeltFoot(speed, acceleration, top, top_phase, slide, drawn_back, bow)
    descent = (top - under.expected + felt.depth) / (part * swing_time) * felt.pace
    over, travels = height - under.expected, (felt.travel - phase) * swing_time
    slowest = felt.scale * _LOWERING
    if travels > 0.0:
        # A low swing does not end before the foot has travelled: it would slide over the ground.
        slowest = min(slowest, max(over, 0.0) / travels * felt.pace)
    fastest = max(slowest, descent)
    if over < felt.scale * _NEARS:
        fastest += felt.slow_contact * (felt.scale * _SLOW_CONTACT - fastest)
    fastest = min(fastest, felt.lowering, _fastest_contact(over, felt))
    after = _towards(speed, -fastest, _FOOT_ACCELERATION * dt)
    # Over higher ground on its way the foot stays up.
    lowest = under.lowest
    room = felt.scale * _OVER
    if under.way > under.expected + room:
        lowest = max(lowest, min(under.way + room, under.highest))
    if drawn_back is not None and under.clears and abs(place - drawn_back) < felt.scale * _PAST:
        lowest = max(lowest, height)
    height, after = _no_lower(height + (speed + after) / 2 * dt, after, height, lowest)
    return height, FeltFoot(after, 0.0, top, top_phase, slide, drawn_back, bow)


def _fastest_contact(over: float, felt: FeltInputs) -> float:
    """Return the greatest downward speed of a foot just over the expected ground: it goes on until contact is known."""
    nears = felt.late > 0.0 and over < felt.scale * _NEARS
    return (felt.scale * _PRESSED + _PRESSED_DEEP * felt.depth) / felt.late if nears else math.inf


def _no_lower(height: float, speed: float, before: float, lowest: float) -> tuple[float, float]:
    """Return height and speed of a foot that stops at a least height; a foot already below stays where it was."""
    return (height, speed) if height >= lowest else (min(lowest, max(before, height)), 0.0)


def _towards(value: float, target: float, step: float) -> float:
    """Return a value moved towards a target by a step at most."""
    change = target - value
    if -step <= change <= step:
        return target
    return value + (step if change > 0.0 else -step)
