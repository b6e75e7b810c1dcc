"""Landing: swinging feet are put down on the ground that they meet, and rise again where it is an obstacle."""

from __future__ import annotations

import numpy as np

from tarsus.control.contact.foot_contacts import FootContacts
from tarsus.control.contact.support import HALTING
from tarsus.control.felt.collision import (
    collides,
    collides_again,
    rising_again,
    stopped_again,
    trying_again,
    with_foot,
)
from tarsus.control.search.missing_ground import MissingGround
from tarsus.control.terrain.body_motion import BodyMotion
from tarsus.control.walk.state import ROUNDING, GaitState
from tarsus.control.walk.step_timing import StepTiming
from tarsus.control.walk.stepper import land

__all__ = ["met_ground", "put_down"]

# Swing phases from which on contact is a collision, and from which on it is the ground.
_CLEAR, _LANDING = 0.12, 0.55


def met_ground(
    state: GaitState, body: BodyMotion, missing: MissingGround, *, stopped: list[int], timing: StepTiming, pace: float
) -> GaitState:
    """Return the gait state in which feet that meet ground have landed or rise again.

    Parameters
    ----------
    state, body : GaitState, BodyMotion
        The gait state; contacts, expected ground, reach, and how far feet are from their commands; its roughness
        takes note of footholds and collisions.
    missing, stopped : MissingGround, list of int
        Decides where feet that are stopped again try next; legs that are stopped on their way.
    timing, pace : StepTiming, float
        The gait and its frequency; rate of the steps, 0 to 1.
    """
    contacts, reach, elevation = body.contacts, body.reach, state.elevation
    places = state.in_heading(state.foot).tolist()
    for leg, (down, phase) in enumerate(zip(state.down.tolist(), state.swing_phase.tolist(), strict=True)):
        foot, stops = state.felt[leg], leg in stopped
        meets = contacts.estimator.reads(leg) and contacts.has_opened(leg)
        if down or phase <= _CLEAR:
            if (contacts.feels(leg) or stops) and missing.tries(leg, places[leg]):
                state = stopped_again(state, leg, missing, body, stopped=stops)
            continue
        leaves = missing.obstacles.leaves(state.in_heading(complex(state.foothold[leg])) - places[leg])
        side = contacts.feels(leg) and contacts.lifted[leg]
        if not leaves and collides_again(state, leg, side=side, stopped=stops, scale=reach.scale):
            contacts.draws_back(leg)
            state = trying_again(state, leg, missing, body, _landed(state, leg, timing, pace))
        elif phase > _LANDING or (pace < HALTING and _stands_below(state, leg, contacts, scale=reach.scale)):
            # Contact that has not ceased since lift-off tells nothing: the foot lands where ground is expected. Nor
            # does that of a foot that rises along an obstacle.
            tells = contacts.lifted[leg] and not contacts.is_open(leg)
            rises = foot.drawn_back is not None and phase <= foot.top_phase
            if tells and (rises or not contacts.touches(leg)):
                continue
            # The foot touched the ground a moment ago, when it was higher.
            over = float(state.ground_height[leg]) - elevation - tells * contacts.age * min(foot.speed, 0.0)
            expected = body.ground.at(places[leg])
            if tells or over <= expected + ROUNDING:
                if tells:
                    # Where the body sinks by its tilt, the foot meets the ground sooner: that is no roughness.
                    off, sunk = over - expected, max(contacts.sunk[leg], 0.0)
                    body.roughness.landed(min(off, max(off - sunk, 0.0)))
                state = _landed(state, leg, timing, pace)
        elif (meets or stops) and not leaves and collides(state, leg, contacts, stopped=stops, scale=reach.scale):
            body.roughness.collided()
            state = rising_again(state, leg, body, timing)
    return state


def put_down(state: GaitState, *, timing: StepTiming, pace: float) -> GaitState:
    """Return the state with all feet put down where they are.

    Parameters
    ----------
    state : GaitState
        The gait state.
    timing, pace : StepTiming, float
        The gait and its frequency; rate of the steps, 0 to 1.
    """
    swings = ~state.down
    # Feet in the first part of their swing stay due to lift off.
    state = state._replace(step_number=state.step_number - (swings & (state.swing_phase < _LANDING)))
    for leg in np.flatnonzero(swings).tolist():
        state = _landed(state, leg, timing, pace)
        state = state._replace(felt=with_foot(state.felt, leg, speed=0.0, acceleration=0.0))
    return state


def _landed(state: GaitState, leg: int, timing: StepTiming, pace: float) -> GaitState:
    """Return the state with a foot put down where it is; the speed that it has decays soon."""
    rate = timing.frequency / (1 - timing.gait.duty_factor - float(state.lift_delay[leg]))
    slide = complex(state.swing_velocity[leg]) * rate * pace
    velocity, acceleration = state.swing_velocity.copy(), state.swing_acceleration.copy()
    foothold = state.foothold.copy()
    foothold[leg], velocity[leg], acceleration[leg] = state.foot[leg], 0j, 0j
    felt = with_foot(state.felt, leg, slide=slide)
    state = state._replace(foothold=foothold, swing_velocity=velocity, swing_acceleration=acceleration, felt=felt)
    return land(state, [leg])


def _stands_below(state: GaitState, leg: int, contacts: FootContacts, *, scale: float) -> bool:
    """Return whether a foot on its way down has met ground lower than an obstacle: going on, it would lift the body."""
    meets = contacts.estimator.touching[leg] and contacts.lifted[leg] and state.felt[leg].speed < 0.0
    down = state.swing_phase[leg] >= state.felt[leg].top_phase
    return meets and down and not collides(state, leg, contacts, scale=scale)
