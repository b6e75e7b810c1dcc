"""Landing: swinging feet are put down on the ground that they meet; at an obstacle they rise again and pass it."""

from __future__ import annotations

import cmath
from typing import Any

import numpy as np

from tarsus.control.contact.support import HALTING
from tarsus.control.search.missing_ground import MissingGround
from tarsus.control.sensing.swing_monitor import USUAL_LAG
from tarsus.control.terrain.body_motion import BodyMotion
from tarsus.control.walk.state import ROUNDING, GaitState
from tarsus.control.walk.step_timing import StepTiming
from tarsus.control.walk.stepper import land

__all__ = ["met_ground", "put_down"]

# Swing phases from which on contact is a collision, and from which on it is the ground.
_CLEAR, _LANDING = 0.12, 0.55
# Rise since lift-off from which a contact is an obstacle; the same while the switch has not opened since then [m].
_LIFTED, _RISEN = 0.01, 0.02
# After a collision: how much higher the foot rises [m], in what time [s], how far it is drawn back [m], and its initial
# speed over the mean one: a stiff leg would drag on the obstacle as it rises, and pull the body down.
_HIGHER, _RISING, _DRAWN_BACK, _AT_ONCE = 0.04, 0.12, 0.008, 3.0
# A descending foot that touches something again has met the ground if it is closer to its foothold than the first, or
# farther past its collision than the second [m]; speed at which a foot that is stopped again is drawn back [m/s].
_SHORT, _PAST, _DRAWS_BACK = 0.02, 0.03, 1.0
# How far behind its command a foot is when an obstacle stops it again by its coxa, on its way past it [m].
_PUSHES = 0.03


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
    contacts, elevation = body.contacts, state.elevation
    places = state.in_heading(state.foot).tolist()
    for leg, (down, phase) in enumerate(zip(state.down.tolist(), state.swing_phase.tolist(), strict=True)):
        foot, stops = state.felt[leg], leg in stopped
        meets = contacts.estimator.reads(leg) and contacts.has_opened(leg)
        if down or phase <= _CLEAR:
            if (contacts.feels(leg) or stops) and missing.tries(leg, places[leg]):
                state = _stopped_again(state, leg, missing, body, stopped=stops)
            continue
        leaves = missing.obstacles.leaves(state.in_heading(complex(state.foothold[leg])) - places[leg])
        side = contacts.feels(leg) and contacts.lifted[leg]
        if not leaves and _collides_again(state, leg, side=side, stopped=stops, scale=body.reach.scale):
            contacts.draws_back(leg)
            state = _trying_again(state, leg, missing, body, _landed(state, leg, timing, pace))
        elif phase > _LANDING or (pace < HALTING and _stands_below(state, leg, body)):
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
        elif (meets or stops) and not leaves and _collides(state, leg, body, stopped=stops):
            body.roughness.collided()
            state = _rising_again(state, leg, body, timing)
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
        state = _with_foot(_landed(state, leg, timing, pace), leg, speed=0.0, acceleration=0.0)
    return state


def _landed(state: GaitState, leg: int, timing: StepTiming, pace: float) -> GaitState:
    """Return the state with a foot put down where it is; the speed that it has decays soon."""
    rate = timing.frequency / (1 - timing.gait.duty_factor - float(state.lift_delay[leg]))
    slide = complex(state.swing_velocity[leg]) * rate * pace
    velocity, acceleration = state.swing_velocity.copy(), state.swing_acceleration.copy()
    foothold = state.foothold.copy()
    foothold[leg], velocity[leg], acceleration[leg] = state.foot[leg], 0j, 0j
    state = state._replace(foothold=foothold, swing_velocity=velocity, swing_acceleration=acceleration)
    return land(_with_foot(state, leg, slide=slide), [leg])


def _stands_below(state: GaitState, leg: int, body: BodyMotion) -> bool:
    """Return whether a foot on its way down has met ground lower than an obstacle: going on, it would lift the body."""
    meets = body.contacts.estimator.touching[leg] and body.contacts.lifted[leg] and state.felt[leg].speed < 0.0
    down = state.swing_phase[leg] >= state.felt[leg].top_phase
    return meets and down and not _collides(state, leg, body)


def _collides(state: GaitState, leg: int, body: BodyMotion, *, stopped: bool = False) -> bool:
    """Return whether a foot that feels contact in the first half of its swing has met an obstacle."""
    # The contact is that of a moment ago, and the foot lags behind its command: it was lower then. A body that sinks by
    # its tilt sets the foot down.
    then = float(state.ground_height[leg]) - max(state.felt[leg].speed, 0.0) * (body.contacts.age + USUAL_LAG)
    then -= max(body.contacts.sunk[leg], 0.0)
    least = body.reach.scale * (_LIFTED if stopped or body.contacts.lifted[leg] else _RISEN)
    return state.felt[leg].drawn_back is None and then - float(state.start_height[leg]) > least


def _collides_again(state: GaitState, leg: int, *, side: bool, stopped: bool, scale: float) -> bool:
    """Return whether a foot that has risen after a collision meets the obstacle again."""
    start, foot, goal = state.felt[leg].drawn_back, complex(state.foot[leg]), complex(state.foothold[leg])
    rises = state.swing_phase[leg] <= state.felt[leg].top_phase
    # A foot that steps in place meets no obstacle on its way.
    if start is None or rises or abs(goal - start) < scale * _SHORT:
        return False
    # A foot that does not go down meets no ground.
    falls = state.felt[leg].speed < 0.0
    short = abs(goal - foot) < scale * _SHORT
    past = abs(foot - start) > scale * (_DRAWN_BACK + _PAST)
    return not (falls and short) and ((past and stopped) or (side and not (past and falls)))


def _rising_again(state: GaitState, leg: int, body: BodyMotion, timing: StepTiming) -> GaitState:
    """Return the state in which a foot that has met an obstacle is drawn back from where it is, and rises higher."""
    height, foot, foothold = float(state.ground_height[leg]), complex(state.foot[leg]), complex(state.foothold[leg])
    reach = body.reach
    highest = state.elevation + reach.highest_on_way(leg, state.in_heading(foot), state.in_heading(foothold))[0]
    way, phase = foothold - foot, float(state.swing_phase[leg])
    rises = min(_RISING / timing.swing_time, 1.0 - phase)
    back = body.tracking_error(state, leg) - reach.scale * _DRAWN_BACK * way / max(abs(way), 1e-9)
    # The top of a foot that has had none is NaN, which is not greater than its height.
    top = min(max(height, state.felt[leg].top) + reach.scale * _HIGHER, max(highest, height))
    velocity, acceleration = state.swing_velocity.copy(), state.swing_acceleration.copy()
    velocity[leg], acceleration[leg] = _AT_ONCE * back / rises, 0j
    state = state._replace(swing_velocity=velocity, swing_acceleration=acceleration)
    return _with_foot(state, leg, top=top, top_phase=phase + rises, drawn_back=foot + back)


def _trying_again(state: GaitState, leg: int, missing: MissingGround, body: BodyMotion, after: GaitState) -> GaitState:
    """Return the state in which a foot that is stopped again is drawn back, and tries again while the walk stands."""
    reach, height, turn = body.reach, float(state.ground_height[leg]), cmath.exp(1j * state.yaw)
    foot, goal = (state.in_heading(complex(places[leg])) for places in (state.foot, state.foothold))
    foot += body.tracking_error(state, leg) / turn
    back = missing.stopped(leg, foot, goal, complex(reach.bows[leg]))
    place = missing.places[leg]
    highest = state.elevation + reach.highest_on_way(leg, place, missing.obstacles.goals.get(leg, place))[0]
    top = min(height + reach.scale * _HIGHER, max(highest, height))
    slide = reach.scale * _DRAWS_BACK * turn * back / max(abs(back), 1e-9)
    return _with_foot(after, leg, speed=0.0, acceleration=0.0, top=top, slide=slide)


def _stopped_again(state: GaitState, leg: int, missing: MissingGround, body: BodyMotion, *, stopped: bool) -> GaitState:
    """Return the state in which a foot meets an obstacle on its way past it, and tries again if its switch works."""
    foot = state.felt[leg]
    pushes = body.contacts.feels(leg) or abs(body.tracking_error(state, leg)) > body.reach.scale * _PUSHES
    if foot.top > float(state.ground_height[leg]) or foot.slide or not pushes:
        return state
    body.contacts.draws_back(leg)
    if body.contacts.is_closed(leg) and not stopped:
        missing.drop(leg)
        return state
    return _trying_again(state, leg, missing, body, state)


def _with_foot(state: GaitState, leg: int, **values: Any) -> GaitState:
    """Return the state with other values for one of the feet."""
    felt = [foot._replace(**values) if index == leg else foot for index, foot in enumerate(state.felt)]
    return state._replace(felt=felt)
