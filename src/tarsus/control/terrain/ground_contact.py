"""Ground contact of swinging feet: they land on ground that they meet, and rise again where it is an obstacle."""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING, Any

from tarsus.control.readings import RollPitch
from tarsus.control.sensing.swing_monitor import USUAL_LAG
from tarsus.control.terrain.body_motion import BodyMotion
from tarsus.control.terrain.foot_contacts import FootContacts, Search, sunk_at
from tarsus.control.terrain.ground_map import GroundMap
from tarsus.control.terrain.missing_ground import MissingGround
from tarsus.control.terrain.reach import Reach
from tarsus.control.terrain.support import HALTING
from tarsus.control.walk.felt_feet import FeltFoot
from tarsus.control.walk.state import GaitState
from tarsus.control.walk.step_timing import StepTiming
from tarsus.control.walk.stepper import land

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

__all__ = ["met_ground", "not_sunk", "searching_feet"]

# Swing phases from which on contact is a collision, and from which on it is the ground.
_CLEAR, _LANDING = 0.12, 0.55
# Rounding of a height [m].
_ROUNDING = 1e-9
# How far a foot has risen that meets an obstacle [m].
_LIFTED = 0.01
# After a collision: how much higher the foot rises [m], in which time [s], and how far it is drawn back [m].
_HIGHER, _RISING, _DRAWN_BACK = 0.025, 0.12, 0.008
# Of a foot that collides again: how far it is from its foothold at least, and past its collision at most, where it does
# not touch the obstacle's top [m]; the speed with which it is drawn back [m/s].
_SHORT, _PAST, _DRAWS_BACK = 0.02, 0.01, 1.0
# A foot that is deeper, on even ground, bears no load that is not felt, whatever its shin rests on [m]; nor does one on
# rough ground that is this deep, over the body height.
_HANGS, _HANGS_LOW = 0.05, 0.9
# Nor does one without contact that is this far over the expected ground, as before a wall: it is still to go down [m].
_HIGH = 0.03
# A foot that goes down faster has not come to the end of its reach, which sinks with the body [m/s].
_FALLS = 0.1


def met_ground(
    state: GaitState,
    contacts: FootContacts,
    ground: GroundMap,
    body: BodyMotion,
    missing: MissingGround,
    *,
    stopped: Sequence[int],
    timing: StepTiming,
    pace: float,
    in_air: bool,
) -> tuple[GaitState, list[int]]:
    """Return the gait state in which feet that meet ground have landed or rise again, and which have landed.

    Parameters
    ----------
    state, contacts : GaitState, FootContacts
        The gait state; the contacts.
    ground, body : GroundMap, BodyMotion
        Where ground is expected; its roughness takes note of footholds and collisions.
    missing, stopped : MissingGround, sequence of int
        Decides where feet that are stopped again try next; legs that are stopped on their way.
    timing : StepTiming
        The gait and its frequency.
    pace, in_air : float, bool
        Rate of the steps, 0 to 1; whether the robot is in the air.
    """
    reach, landed, elevation = body.reach, list[int](), state.elevation
    turn = cmath.exp(-1j * state.yaw)
    places = ((state.foot - state.origin) * turn).tolist()
    for leg, (down, phase) in enumerate(zip(state.down.tolist(), state.swing_phase.tolist(), strict=True)):
        foot, touches = state.felt[leg], contacts.estimator.touching[leg]
        if down or phase <= _CLEAR:
            rises = foot.top > float(state.ground_height[leg]) or foot.slide
            if (contacts.feels(leg) or leg in stopped) and missing.tries(leg, places[leg]) and not rises:
                state = _trying_again(state, leg, missing, reach, state)
            continue
        leaves = missing.obstacles.leaves((complex(state.foothold[leg]) - state.origin) * turn - places[leg])
        if not leaves and _collides_again(
            state, leg, side=contacts.feels(leg) and contacts.lifted[leg], stopped=leg in stopped
        ):
            state = _trying_again(state, leg, missing, reach, _landed(state, leg, timing, pace))
            landed.append(leg)
        elif phase > _LANDING or (pace < HALTING and _stands_below(state, leg, contacts)):
            # Contact that has not ceased since lift-off tells nothing: the foot lands where ground is expected.
            tells = contacts.lifted[leg] and not contacts.is_open(leg)
            if tells and not contacts.touches(leg):
                continue
            # It touched the ground a moment ago, when it was higher.
            over = float(state.ground_height[leg]) - elevation - tells * contacts.age * min(foot.speed, 0.0)
            expected = ground.at(places[leg])
            if tells or over <= expected + _ROUNDING:
                if tells:
                    # A body that sinks at the foot by its tilt meets the ground sooner.
                    off, sunk = over - expected, max(contacts.sunk[leg], 0.0)
                    body.roughness.landed(min(off, max(off - sunk, 0.0)))
                state = _landed(state, leg, timing, pace)
                landed.append(leg)
        elif ((touches and contacts.lifted[leg]) or leg in stopped) and not leaves and _collides(state, leg, contacts):
            body.roughness.collided()
            state = _rising_again(state, leg, _highest(state, leg, reach), timing, scale=reach.scale)
    return _put_down(state, landed, timing, pace) if missing.tips or in_air else (state, landed)


def _put_down(state: GaitState, landed: list[int], timing: StepTiming, pace: float) -> tuple[GaitState, list[int]]:
    """Return the state, and which feet have landed, with all feet put down: the robot tips, or is in the air."""
    swings, number = [leg for leg, on in enumerate(state.down.tolist()) if not on], state.step_number.copy()
    # Feet that are far from their footholds are still due to lift off.
    number[(state.swing_phase < _LANDING) & ~state.down] -= 1
    state = state._replace(step_number=number)
    for leg in swings:
        state = _landed(state, leg, timing, pace)
        state = state._replace(felt=_with(state.felt, leg, speed=0.0, acceleration=0.0))
    return state, landed + swings


def _landed(state: GaitState, leg: int, timing: StepTiming, pace: float) -> GaitState:
    """Return the state with a foot put down where it is; what speed it has, it loses soon."""
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
    # A contact is that of a moment ago, and the foot lags behind its command: it was lower.
    then = float(state.ground_height[leg]) - max(state.felt[leg].speed, 0.0) * (contacts.age + USUAL_LAG)
    return state.felt[leg].drawn_back is None and then - float(state.start_height[leg]) > _LIFTED


def _stands_below(state: GaitState, leg: int, contacts: FootContacts) -> bool:
    """Return whether a foot on its way down has met ground no higher than it came from: it would lift the body."""
    meets = contacts.estimator.touching[leg] and contacts.lifted[leg] and state.felt[leg].speed < 0.0
    return meets and state.swing_phase[leg] >= state.felt[leg].top_phase and not _collides(state, leg, contacts)


def _collides_again(state: GaitState, leg: int, *, side: bool, stopped: bool) -> bool:
    """Return whether a foot that has risen after a collision has not got past the obstacle."""
    start, foot = state.felt[leg].drawn_back, complex(state.foot[leg])
    if start is None or state.swing_phase[leg] <= state.felt[leg].top_phase or abs(state.foothold[leg] - foot) < _SHORT:
        return False
    return stopped if abs(foot - start) > _DRAWN_BACK + _PAST else side


def _rising_again(state: GaitState, leg: int, highest: float, timing: StepTiming, *, scale: float) -> GaitState:
    """Return the state with a foot that draws back from an obstacle and rises higher."""
    height, foot = float(state.ground_height[leg]), complex(state.foot[leg])
    top = state.felt[leg].top
    way = complex(state.foothold[leg]) - foot
    felt = _with(
        state.felt,
        leg,
        top=min((height if math.isnan(top) else max(top, height)) + scale * _HIGHER, max(highest, height)),
        top_phase=min(float(state.swing_phase[leg]) + _RISING / timing.swing_time, 1.0),
        drawn_back=foot - scale * _DRAWN_BACK * way / max(abs(way), 1e-9),
    )
    return state._replace(felt=felt)


def _highest(state: GaitState, leg: int, reach: Reach) -> float:
    """Return the greatest height in G of a foot on its way to its foothold [m]."""
    turn = cmath.exp(-1j * state.yaw)
    start, end = ((complex(place) - state.origin) * turn for place in (state.foot[leg], state.foothold[leg]))
    return state.elevation + reach.highest_on_way(leg, start, end)


def _trying_again(state: GaitState, leg: int, missing: MissingGround, reach: Reach, after: GaitState) -> GaitState:
    """Return the state with a foot that is stopped again: it is drawn back, and tries again while the walk stands."""
    height, turn = float(state.ground_height[leg]), cmath.exp(1j * state.yaw)
    foot, goal = ((complex(places[leg]) - state.origin) / turn for places in (state.foot, state.foothold))
    top = min(height + reach.scale * _HIGHER, max(_highest(state, leg, reach), height))
    back = missing.stopped(leg, foot, goal)
    slide = _DRAWS_BACK * turn * back / max(abs(back), 1e-9)
    return after._replace(felt=_with(after.felt, leg, speed=0.0, acceleration=0.0, top=top, slide=slide))


def _with(feet: Sequence[FeltFoot], leg: int, **values: Any) -> list[FeltFoot]:
    """Return the feet with other values for one of them."""
    return [foot._replace(**values) if index == leg else foot for index, foot in enumerate(feet)]


def searching_feet(
    state: GaitState,
    contacts: FootContacts,
    ground: GroundMap,
    places: Sequence[complex],
    off: RollPitch,
    raised: Callable[[list[int]], Mapping[int, float]],
    *,
    down: Sequence[bool],
    stands: Sequence[bool],
) -> list[Search]:
    """Return the feet that should stand and feel nothing.

    Parameters
    ----------
    state, contacts : GaitState, FootContacts
        The gait state; the contacts.
    ground, places : GroundMap, sequence of complex
        Where ground is expected; where the feet are, in the heading frame [m].
    off, raised : (roll, pitch), callable
        By how much the body is off the attitude to keep [rad]; returns by how much the feet of some legs are higher
        than commanded, of those that are measured [m].
    down, stands : sequence of bool
        Which feet should stand, and which do.
    """
    legs = [leg for leg, on in enumerate(down) if on and not stands[leg] and contacts.is_known(leg)]
    found, higher = list[Search](), raised(legs)
    for leg in legs:
        place, foot = places[leg], state.felt[leg]
        depth = ground.lowest_near(place) + state.elevation - float(state.ground_height[leg])
        known = foot.speed < -_FALLS, contacts.seeks(leg), contacts.sunk[leg], higher.get(leg, 0.0)
        found.append(Search(leg, depth, *known, sunk_at(place, off)))
    return found


def not_sunk(
    state: GaitState,
    ground: GroundMap,
    places: Sequence[complex],
    down: Sequence[bool],
    stands: Sequence[bool],
    *,
    reach: Reach,
    deeper: float,
    tips: bool,
) -> list[bool]:
    """Return which feet should stand and may bear load that is not felt.

    None may while one of them is not close to the ground, or at the end of its reach: its leg may rest on an edge, or
    lean against a wall.

    Parameters
    ----------
    state, ground : GaitState, GroundMap
        The gait state; where ground is expected.
    places, down, stands : sequence of complex, sequence of bool
        Where the feet are, in the heading frame [m]; which should stand, and which do.
    reach : Reach
        How low each leg reaches.
    deeper, tips : float, bool
        How much deeper ground may be than expected [m]; whether the robot tips or feet step back: then, none may.
    """
    scale, height = reach.scale, float(state.posture.value[2])
    most = min(scale * _HANGS + deeper, _HANGS_LOW * height)
    near = list[bool]()
    for leg, over in enumerate((state.ground_height - state.elevation).tolist()):
        place, high = places[leg], math.inf if stands[leg] else scale * _HIGH
        hangs = ground.is_hole(place) or (reach.hangs(leg, over) and not stands[leg])
        near.append(down[leg] and -most < over - ground.at(place) < high and not hangs)
    return near if near == list(down) and not tips else [False] * len(near)
