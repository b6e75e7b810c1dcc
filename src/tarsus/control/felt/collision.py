"""Collision: a swinging foot that meets an obstacle rises again, and tries to get past it."""

from __future__ import annotations

import cmath
from collections.abc import Sequence
from typing import Any

from tarsus.control.contact.foot_contacts import FootContacts
from tarsus.control.search.missing_ground import MissingGround
from tarsus.control.sensing.swing_monitor import USUAL_LAG
from tarsus.control.terrain.body_motion import BodyMotion
from tarsus.control.walk.felt_feet import FeltFoot
from tarsus.control.walk.state import GaitState
from tarsus.control.walk.step_timing import StepTiming

__all__ = ["collides", "collides_again", "rising_again", "stopped_again", "trying_again", "with_foot"]

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


def collides(state: GaitState, leg: int, contacts: FootContacts, *, scale: float, stopped: bool = False) -> bool:
    """Return whether a foot that feels contact in the first half of its swing has met an obstacle."""
    # The contact is that of a moment ago, and the foot lags behind its command: it was lower then. A body that sinks by
    # its tilt sets the foot down.
    then = float(state.ground_height[leg]) - max(state.felt[leg].speed, 0.0) * (contacts.age + USUAL_LAG)
    then -= max(contacts.sunk[leg], 0.0)
    least = scale * (_LIFTED if stopped or contacts.lifted[leg] else _RISEN)
    return state.felt[leg].drawn_back is None and then - float(state.start_height[leg]) > least


def collides_again(state: GaitState, leg: int, *, side: bool, stopped: bool, scale: float) -> bool:
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


def rising_again(state: GaitState, leg: int, body: BodyMotion, timing: StepTiming) -> GaitState:
    """Return the state in which a foot that has met an obstacle is drawn back from where it is, and rises higher."""
    height, foot, foothold = float(state.ground_height[leg]), complex(state.foot[leg]), complex(state.foothold[leg])
    reach = body.reach
    highest = state.elevation + reach.highest_on_way(leg, state.in_heading(foot), state.in_heading(foothold))[0]
    way, phase = foothold - foot, float(state.swing_phase[leg])
    rises = min(_RISING / timing.swing_time, 1.0 - phase)
    back = body.tracking_error(state, leg) - reach.scale * _DRAWN_BACK * way / max(abs(way), 1e-9)
    # The top of a foot that has had none is NaN, which is not greater than its height.
    top = min(max(height, state.felt[leg].top) + reach.scale * _HIGHER, max(highest, height))
    felt = with_foot(state.felt, leg, top=top, top_phase=phase + rises, drawn_back=foot + back)
    velocity, acceleration = state.swing_velocity.copy(), state.swing_acceleration.copy()
    velocity[leg], acceleration[leg] = _AT_ONCE * back / rises, 0j
    return state._replace(felt=felt, swing_velocity=velocity, swing_acceleration=acceleration)


def trying_again(state: GaitState, leg: int, missing: MissingGround, body: BodyMotion, after: GaitState) -> GaitState:
    """Return the state in which a foot that is stopped again is drawn back, and tries again while the walk stands."""
    reach, height, turn = body.reach, float(state.ground_height[leg]), cmath.exp(1j * state.yaw)
    foot, goal = (state.in_heading(complex(places[leg])) for places in (state.foot, state.foothold))
    foot += body.tracking_error(state, leg) / turn
    back = missing.stopped(leg, foot, goal, complex(reach.bows[leg]))
    place = missing.places[leg]
    highest = state.elevation + reach.highest_on_way(leg, place, missing.obstacles.goals.get(leg, place))[0]
    top = min(height + reach.scale * _HIGHER, max(highest, height))
    slide = reach.scale * _DRAWS_BACK * turn * back / max(abs(back), 1e-9)
    return after._replace(felt=with_foot(after.felt, leg, speed=0.0, acceleration=0.0, top=top, slide=slide))


def stopped_again(state: GaitState, leg: int, missing: MissingGround, body: BodyMotion, *, stopped: bool) -> GaitState:
    """Return the state in which a foot meets an obstacle on its way past it, and tries again if its switch works."""
    foot = state.felt[leg]
    pushes = body.contacts.feels(leg) or abs(body.tracking_error(state, leg)) > body.reach.scale * _PUSHES
    if foot.top > float(state.ground_height[leg]) or foot.slide or not pushes:
        return state
    body.contacts.draws_back(leg)
    if body.contacts.is_closed(leg) and not stopped:
        missing.drop(leg)
        return state
    return trying_again(state, leg, missing, body, state)


def with_foot(feet: Sequence[FeltFoot], leg: int, **values: Any) -> list[FeltFoot]:
    """Return the feet with other values for one of them."""
    return [foot._replace(**values) if index == leg else foot for index, foot in enumerate(feet)]
