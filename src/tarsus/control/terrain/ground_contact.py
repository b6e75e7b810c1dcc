"""Ground contact of swinging feet: they land on ground that they meet, and rise again where it is an obstacle."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from tarsus.control.sensing.swing_monitor import USUAL_LAG
from tarsus.control.terrain.body_motion import BodyMotion
from tarsus.control.terrain.foot_contacts import FootContacts
from tarsus.control.terrain.missing_ground import MissingGround
from tarsus.control.terrain.support import HALTING, Footing, sunk_at
from tarsus.control.walk.felt_feet import ROUNDING, FeltFoot
from tarsus.control.walk.state import GaitState
from tarsus.control.walk.step_timing import StepTiming
from tarsus.control.walk.stepper import land

__all__ = ["hovering", "met_ground", "not_sunk", "put_down", "supporting"]

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
# Depth on even ground from which a foot bears no load that is not felt, whatever its shin rests on [m]; greatest such
# depth, on rough ground too, over the body height.
_HANGS, _HANGS_LOW = 0.042, 0.9
# Height over the expected ground from which a foot without contact bears none either, as before a wall [m].
_HIGH = 0.03
# A foot without contact does not count as support where the body is lower than in its attitude by more than the first,
# or its rest foothold is farther ahead than the second, where no other foot has been [m].
_SINKS, _AHEAD = 0.01, 0.03
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
    contacts, reach, elevation = body.contacts, body.reach, state.elevation
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
        if not leaves and _collides_again(state, leg, side=side, stopped=stops, scale=reach.scale):
            contacts.draws_back(leg)
            state = _trying_again(state, leg, missing, body, _landed(state, leg, timing, pace))
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
        elif (meets or stops) and not leaves and _collides(state, leg, contacts, stopped=stops, scale=reach.scale):
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
        state = _landed(state, leg, timing, pace)
        state = state._replace(felt=_with(state.felt, leg, speed=0.0, acceleration=0.0))
    return state


def _landed(state: GaitState, leg: int, timing: StepTiming, pace: float) -> GaitState:
    """Return the state with a foot put down where it is; the speed that it has decays soon."""
    rate = timing.frequency / (1 - timing.gait.duty_factor - float(state.lift_delay[leg]))
    slide = complex(state.swing_velocity[leg]) * rate * pace
    velocity, acceleration = state.swing_velocity.copy(), state.swing_acceleration.copy()
    foothold = state.foothold.copy()
    foothold[leg], velocity[leg], acceleration[leg] = state.foot[leg], 0j, 0j
    felt = _with(state.felt, leg, slide=slide)
    state = state._replace(foothold=foothold, swing_velocity=velocity, swing_acceleration=acceleration, felt=felt)
    return land(state, [leg])


def _collides(state: GaitState, leg: int, contacts: FootContacts, *, scale: float, stopped: bool = False) -> bool:
    """Return whether a foot that feels contact in the first half of its swing has met an obstacle."""
    # The contact is that of a moment ago, and the foot lags behind its command: it was lower then. A body that sinks by
    # its tilt sets the foot down.
    then = float(state.ground_height[leg]) - max(state.felt[leg].speed, 0.0) * (contacts.age + USUAL_LAG)
    then -= max(contacts.sunk[leg], 0.0)
    least = scale * (_LIFTED if stopped or contacts.lifted[leg] else _RISEN)
    return state.felt[leg].drawn_back is None and then - float(state.start_height[leg]) > least


def _stands_below(state: GaitState, leg: int, contacts: FootContacts, *, scale: float) -> bool:
    """Return whether a foot on its way down has met ground lower than an obstacle: going on, it would lift the body."""
    meets = contacts.estimator.touching[leg] and contacts.lifted[leg] and state.felt[leg].speed < 0.0
    down = state.swing_phase[leg] >= state.felt[leg].top_phase
    return meets and down and not _collides(state, leg, contacts, scale=scale)


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
    felt = _with(state.felt, leg, top=top, top_phase=phase + rises, drawn_back=foot + back)
    velocity, acceleration = state.swing_velocity.copy(), state.swing_acceleration.copy()
    velocity[leg], acceleration[leg] = _AT_ONCE * back / rises, 0j
    return state._replace(felt=felt, swing_velocity=velocity, swing_acceleration=acceleration)


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
    return after._replace(felt=_with(after.felt, leg, speed=0.0, acceleration=0.0, top=top, slide=slide))


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


def _with(feet: Sequence[FeltFoot], leg: int, **values: Any) -> list[FeltFoot]:
    """Return the feet with other values for one of them."""
    return [foot._replace(**values) if index == leg else foot for index, foot in enumerate(feet)]


def not_sunk(state: GaitState, body: BodyMotion, footing: Footing, *, tips: bool) -> list[bool]:
    """Return which of the feet that should stand may bear load that is not felt.

    None may while one of them is deep, or at the end of its reach: its leg may rest on an edge. A foot high over the
    ground does not, as on a robot that leans against a wall.

    Parameters
    ----------
    state, body : GaitState, BodyMotion
        The gait state; contacts, expected ground, roughness and reach.
    footing, tips : Footing, bool
        The feet that should stand; whether the robot tips or feet step back, where none may.
    """
    ground, scale, stands, low = body.ground, body.reach.scale, body.contacts.standing, list[bool]()
    most, deep = min(scale * _HANGS + body.roughness.deeper, _HANGS_LOW * footing.height), tips
    for leg, over in enumerate((state.ground_height - state.elevation).tolist()):
        place, on = footing.places[leg], footing.down[leg]
        off, high = over - ground.at(place), math.inf if stands[leg] else scale * _HIGH
        hangs = ground.is_hole(place) or (body.reach.hangs(leg, over) and not stands[leg])
        # A foot that has lifted the body is less deep than it seems by as much.
        deep |= on and (off + max(-sunk_at(place, body.off), 0.0) <= -most or hangs)
        low.append(on and off < high)
    return [False] * len(low) if deep else low


def hovering(state: GaitState, contacts: FootContacts, depths: Sequence[float]) -> list[int]:
    """Return the legs whose feet have landed above the ground and not stood since, as their switches are stuck closed.

    Parameters
    ----------
    state, contacts : GaitState, FootContacts
        The gait state; the contacts.
    depths : sequence of float
        How far below the expected ground each foot is [m].
    """
    closed = [leg for leg, known in enumerate(contacts.estimator.known) if known and contacts.is_closed(leg)]
    landed = [leg for leg in closed if state.down[leg] and not math.isnan(state.felt[leg].top)]
    return [leg for leg in landed if depths[leg] < -ROUNDING]


def supporting(state: GaitState, body: BodyMotion, footing: Footing, *, walks: bool) -> list[bool]:
    """Return which feet that should stand count as support: on rough ground, also those that will bear load soon.

    There, a foot that steps where others have been most often finds the ground while others swing. It does not count
    where it is deeper than rough ground may be, or where the body sinks at it.

    Parameters
    ----------
    state, body : GaitState, BodyMotion
        The gait state; contacts, expected ground, reach, roughness and tilt.
    footing, walks : Footing, bool
        The feet that should stand; whether the robot walks: one that stands waits until its feet bear load.
    """
    reach, deeper, found = body.reach, body.roughness.deeper * walks, list[bool]()
    velocity = complex(*state.twist.value[:2].tolist())
    for leg, over in enumerate((state.ground_height - state.elevation).tolist()):
        place = footing.places[leg]
        soon = (
            deeper > 0.0
            and (complex(reach.rest[leg]) * velocity.conjugate()).real < reach.scale * _AHEAD * abs(velocity)
            and body.ground.at(place) - over < deeper
            and sunk_at(place, body.off) < reach.scale * _SINKS
        )
        found.append(footing.down[leg] and (soon or body.contacts.supports(leg)))
    return found
