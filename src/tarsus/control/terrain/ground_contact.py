"""Ground contact of swinging feet: they land on ground that they meet, and rise again where it is an obstacle."""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING, Any

from tarsus.control.terrain.foot_contacts import FootContacts
from tarsus.control.terrain.ground_map import GroundMap
from tarsus.control.terrain.roughness import Roughness
from tarsus.control.walk.felt_feet import FeltFoot
from tarsus.control.walk.state import GaitState
from tarsus.control.walk.step_timing import StepTiming
from tarsus.control.walk.stepper import land

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["met_ground"]

# Swing phases from which on contact is a collision, and from which on it is the ground.
_CLEAR, _LANDING = 0.12, 0.55
# Rounding of a height [m].
_ROUNDING = 1e-9
# How far a foot has risen that meets an obstacle, after contact has ceased or without that [m].
_LIFTED, _RISEN = 0.01, 0.03
# Time in which a leg gives up its load, and its joints follow their commands [s].
_UNLOADING = 0.05
# After a collision: how much higher the foot rises [m], in which time [s], and how far it is drawn back [m].
_HIGHER, _RISING, _DRAWN_BACK = 0.025, 0.12, 0.008


def met_ground(
    state: GaitState,
    contacts: FootContacts,
    ground: GroundMap,
    roughness: Roughness,
    *,
    highest: Sequence[float],
    timing: StepTiming,
    pace: float,
) -> tuple[GaitState, list[int]]:
    """Return the gait state in which feet that meet ground have landed or rise again, and which have landed.

    Parameters
    ----------
    state : GaitState
        The gait state.
    contacts : FootContacts
        The contacts.
    ground : GroundMap
        Where ground is expected.
    roughness : Roughness
        Takes note of footholds and collisions.
    highest : sequence of float
        Greatest height that each foot reaches, in the heading frame [m].
    timing : StepTiming
        The gait and its frequency.
    pace : float
        Rate of the steps, 0 to 1.
    """
    landed: list[int] = []
    elevation = float(state.elevation.value[0])
    for leg, (down, phase) in enumerate(zip(state.down.tolist(), state.swing_phase.tolist(), strict=True)):
        if down or phase <= _CLEAR:
            continue
        if phase > _LANDING:
            # Contact that has not ceased since lift-off tells nothing: the foot lands where ground is expected.
            tells = contacts.lifted[leg] and not contacts.is_open(leg)
            if tells and not contacts.touches(leg):
                continue
            over = float(state.ground_height[leg]) - elevation
            expected = ground.at((complex(state.foot[leg]) - state.origin) * cmath.exp(-1j * state.yaw))
            if tells or over <= expected + _ROUNDING:
                if tells:
                    roughness.landed(over - expected)
                state = _landed(state, leg, timing, pace)
                landed.append(leg)
        elif contacts.estimator.touching[leg] and _collides(state, leg, contacts):
            roughness.collided()
            state = _rising_again(state, leg, elevation + highest[leg], timing)
    return state, landed


def _landed(state: GaitState, leg: int, timing: StepTiming, pace: float) -> GaitState:
    """Return the state with a foot put down where it is; what speed it has, it loses soon."""
    assert state.felt is not None  # a walk that feels the ground
    rate = timing.frequency / (1 - timing.gait.duty_factor - float(state.lift_delay[leg]))
    slide = complex(state.swing_velocity[leg]) * rate * pace
    foothold, velocity, acceleration = (
        part.copy() for part in (state.foothold, state.swing_velocity, state.swing_acceleration)
    )
    foothold[leg], velocity[leg], acceleration[leg] = state.foot[leg], 0j, 0j
    felt = _with(state.felt, leg, slide=slide)
    state = state._replace(foothold=foothold, swing_velocity=velocity, swing_acceleration=acceleration, felt=felt)
    return land(state, [leg])


def _collides(state: GaitState, leg: int, contacts: FootContacts) -> bool:
    """Return whether a foot that feels contact in the first half of its swing has met an obstacle."""
    assert state.felt is not None  # a walk that feels the ground
    least, delay = (_LIFTED, 0.0) if contacts.lifted[leg] else (_RISEN, _UNLOADING)
    # A contact is that of a moment ago, when the foot was lower.
    then = float(state.ground_height[leg]) - max(state.felt[leg].speed, 0.0) * (contacts.age + delay)
    risen = then - float(state.start_height[leg])
    return state.felt[leg].drawn_back is None and risen > least and not contacts.is_stuck(leg)


def _rising_again(state: GaitState, leg: int, highest: float, timing: StepTiming) -> GaitState:
    """Return the state with a foot that draws back from an obstacle and rises higher."""
    assert state.felt is not None  # a walk that feels the ground
    height, foot = float(state.ground_height[leg]), complex(state.foot[leg])
    top = state.felt[leg].top
    way = complex(state.foothold[leg]) - foot
    felt = _with(
        state.felt,
        leg,
        top=min((height if math.isnan(top) else max(top, height)) + _HIGHER, max(highest, height)),
        top_phase=min(float(state.swing_phase[leg]) + _RISING / timing.swing_time, 1.0),
        drawn_back=foot - _DRAWN_BACK * way / max(abs(way), 1e-9),
    )
    return state._replace(felt=felt)


def _with(feet: Sequence[FeltFoot], leg: int, **values: Any) -> list[FeltFoot]:
    """Return the feet with other values for one of them."""
    return [foot._replace(**values) if index == leg else foot for index, foot in enumerate(feet)]
