"""Vertical motion of feet that feel the ground: they rise, go down until contact, and carry the body."""

from __future__ import annotations

import cmath
import math

import numpy as np

from tarsus.control.filters import CriticallyDamped
from tarsus.control.walk.felt_feet import FeltFeet, FeltInputs
from tarsus.control.walk.state import GaitState, StepInputs
from tarsus.control.walk.swing_trajectory import quintic

__all__ = ["moved_vertically"]

# Swing phase at which a foot is at its top.
_TOP_PHASE = 0.45
# Fraction of a swing in which a foot goes down from its top to the expected ground.
_DESCENT = 0.4
# Least and greatest speed of a descending foot, and least one of a foot that should stand and feels nothing [m/s].
_LOWERING, _FASTEST_LOWERING, _SEARCHING = 0.12, 0.4, 0.15
# Time in which a foot that should stand goes down to the expected ground [s].
_SEARCH_TIME = 0.1
# Greatest changes of speed: of feet in the air, of the body, of feet on the ground, and of their slide [m/s^2].
_FOOT_ACCELERATION, _BODY_ACCELERATION, _STANDING_ACCELERATION, _STOPPING = 6.0, 1.0, 15.0, 12.0


def moved_vertically(state: GaitState, inputs: StepInputs, dt: float) -> GaitState:
    """Return the gait state with the heights of feet and body after a time; the same state without readings.

    Parameters
    ----------
    state : GaitState
        The gait state after the time, but for heights.
    inputs : StepInputs
        What is constant for the time.
    dt : float
        The time [s].
    """
    felt, feet = inputs.felt, state.felt
    if felt is None or feet is None:
        return state
    rate = float(state.elevation.rate[0])
    climb = _towards(rate, felt.climb, _BODY_ACCELERATION * dt)
    elevation = float(state.elevation.value[0]) + (rate + climb) / 2 * dt
    swing, delays = 1 - inputs.gait.duty_factor, state.lift_delay.tolist()
    heights, feet_at = state.ground_height.tolist(), state.foot.tolist()
    for leg, down in enumerate(state.down.tolist()):
        if not felt.steps[leg]:
            feet = feet.replaced(leg, speed=0.0, acceleration=0.0)
        elif down:
            feet_at[leg] += _carried(state, feet, felt, leg, dt)
            heights[leg], feet = _standing(state, feet, felt, leg, dt)
        else:
            swing_time = (swing - delays[leg]) / inputs.frequency if inputs.frequency else math.inf
            heights[leg], feet = _swinging(state, feet, felt, leg, dt, swing_time)
    return state._replace(
        foot=np.array(feet_at),
        ground_height=np.array(heights),
        elevation=CriticallyDamped(np.array([elevation]), np.array([climb])),
        felt=feet,
    )


def _carried(state: GaitState, feet: FeltFeet, felt: FeltInputs, leg: int, dt: float) -> complex:
    """Return how far a foot on the ground moves in G: by its slide, its turn about the body and its drift [m]."""
    moved = _slide_way(feet.slide[leg], dt)
    if felt.stands[leg]:
        under = float(state.ground_height[leg] - state.elevation.value[0] - state.posture.value[2])
        turned = complex(felt.turn[1], -felt.turn[0]) * under
        moved += (turned - felt.drift) * dt * cmath.exp(1j * state.yaw)
    return moved


def _standing(state: GaitState, feet: FeltFeet, felt: FeltInputs, leg: int, dt: float) -> tuple[float, FeltFeet]:
    """Return the height of a foot on the ground, and the state of the feet."""
    height, speed = float(state.ground_height[leg]), feet.speed[leg]
    place = (complex(state.foot[leg]) - state.origin) * cmath.exp(-1j * state.yaw)
    wanted = felt.turn[0] * place.imag - felt.turn[1] * place.real
    if not felt.stands[leg]:
        wanted -= min(max(_SEARCHING, (height - felt.ground[leg]) / _SEARCH_TIME), _FASTEST_LOWERING)
    after = _towards(speed, wanted, (_STANDING_ACCELERATION if felt.stands[leg] else _FOOT_ACCELERATION) * dt)
    found = height + (speed + after) / 2 * dt
    if not felt.stands[leg]:
        found, after = _no_lower(found, after, height, felt.lowest[leg])
    slide = feet.slide[leg] * _slide_left(feet.slide[leg], dt)
    return found, feet.replaced(leg, speed=after, acceleration=0.0, top=math.nan, slide=slide, drawn_back=None)


def _swinging(
    state: GaitState, feet: FeltFeet, felt: FeltInputs, leg: int, dt: float, swing_time: float
) -> tuple[float, FeltFeet]:
    """Return the height of a foot in the air, and the state of the feet: it rises to its top, then goes down."""
    height, phase = float(state.ground_height[leg]), float(state.swing_phase[leg])
    if math.isnan(feet.top[leg]) or (phase < feet.top_phase[leg] and feet.drawn_back[leg] is None):
        # No higher than the foot can be down again from by the end of its swing.
        fits = felt.ground[leg] - felt.depth + _FASTEST_LOWERING * _DESCENT * swing_time
        over = max(float(state.start_height[leg]), felt.ground[leg]) + felt.swing_height
        feet = feet.replaced(leg, top=max(min(over, felt.highest[leg], fits), height), top_phase=_TOP_PHASE)
    top, speed = feet.top[leg], feet.speed[leg]
    if phase < feet.top_phase[leg]:
        time = dt * felt.pace
        whole = (feet.top_phase[leg] - phase) * swing_time + time
        found, after, acceleration = quintic((height, speed, feet.acceleration[leg]), top, whole, time / whole)
        return found, feet.replaced(leg, speed=after, acceleration=acceleration)
    descent = (top - felt.ground[leg] + felt.depth) / (_DESCENT * swing_time) * felt.pace
    after = _towards(speed, -min(max(_LOWERING, descent), _FASTEST_LOWERING), _FOOT_ACCELERATION * dt)
    found, after = _no_lower(height + (speed + after) / 2 * dt, after, height, felt.lowest[leg])
    return found, feet.replaced(leg, speed=after, acceleration=0.0)


def _no_lower(height: float, speed: float, before: float, lowest: float) -> tuple[float, float]:
    """Return height and speed of a foot that stops at a least height; below it, it stays where it was before."""
    return (height, speed) if height >= lowest else (min(lowest, max(before, height)), 0.0)


def _slide_left(slide: complex, dt: float) -> float:
    """Return which share of the speed of a slide is left after a time."""
    return max(1 - _STOPPING * dt / abs(slide), 0.0) if slide else 0.0


def _slide_way(slide: complex, dt: float) -> complex:
    """Return the way that a foot slides in a time [m]."""
    return slide * (1 + _slide_left(slide, dt)) / 2 * dt


def _towards(value: float, target: float, step: float) -> float:
    """Return a value moved towards a target by a step at most."""
    return value + min(max(target - value, -step), step)
