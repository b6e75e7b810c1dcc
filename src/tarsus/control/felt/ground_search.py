"""Ground search: which feet stand or may bear load, which look for the ground, and what is done without it."""

from __future__ import annotations

import math

from tarsus.control.contact.foot_contacts import FootContacts
from tarsus.control.contact.footing import Footing, off_commanded, sunk_at
from tarsus.control.contact.tipping import Tipping
from tarsus.control.search.missing_ground import MissingGround
from tarsus.control.search.search import Search, hole_depth, is_level
from tarsus.control.sensing.body_condition import BodyCondition
from tarsus.control.terrain.body_motion import BodyMotion
from tarsus.control.transition.foothold_transfer import FootholdTransfer
from tarsus.control.walk.state import ROUNDING, GaitState
from tarsus.gait.foot_plane import FootPlane

__all__ = ["GroundSearch", "not_sunk", "supporting"]

# Speed above which a foot that goes down is not at the end of its reach, which itself sinks with the body [m/s].
_FALLS = 0.1
# Time after which the ground is known to a robot that was lifted, and it may be found to tip where contacts are
# estimated: until then it is put down, and settles [s].
_SETTLES = 8.0
# Depth on even ground from which a foot bears no load that is not felt, whatever its shin rests on [m]; greatest such
# depth, on rough ground too, over the body height.
_HANGS, _HANGS_LOW = 0.042, 0.9
# Height over the expected ground from which a foot without contact bears none either, as before a wall [m].
_HIGH = 0.03
# A foot without contact does not count as support where the body is lower than in its attitude by more than the first,
# or its rest foothold is farther ahead than the second, where no other foot has been [m].
_SINKS, _AHEAD = 0.01, 0.03


class GroundSearch:
    """Finds which feet stand, and where those step that find no ground.

    Parameters
    ----------
    body : BodyMotion
        Contacts, expected ground, roughness and reach; holes at the footholds of feet in the air.
    condition, missing : BodyCondition, MissingGround
        Whether the robot is in the air or carried; where feet that find no ground step.
    """

    def __init__(self, body: BodyMotion, condition: BodyCondition, missing: MissingGround) -> None:
        self._body, self._condition, self._missing = body, condition, missing
        # Time since the robot was lifted, as far as known [s].
        self._tipping, self._lifted = Tipping(body.reach.scale), math.inf

    def step(
        self, state: GaitState, footing: Footing, footholds: FootholdTransfer, dt: float, *, rests: bool
    ) -> list[bool]:
        """Decide where feet that find no ground step; return which feet stand, or count as standing in the air.

        Parameters
        ----------
        state, footing, footholds : GaitState, Footing, FootholdTransfer
            The gait state; the feet that should stand; rest footholds, and how far from them feet may be put down.
        dt, rests : float, bool
            Time since the last call [s]; whether the robot rests on feet that hold it: it then searches nothing.
        """
        body, condition, missing = self._body, self._condition, self._missing
        contacts, ground, deeper = body.contacts, body.ground, body.roughness.deeper
        low = not_sunk(state, body, footing, tips=bool(missing.tips or missing.places))
        tilt = body.measured.attitude and off_commanded(body.measured.attitude, state)
        feet = zip(footing.places, state.ground_height.tolist(), strict=True)
        depths = [ground.at(place) + state.elevation - height for place, height in feet]
        contacts.find_open(footing, tilt, dt, low=low, depths=depths)
        missing.twist = state.twist.value.tolist()
        missing.turn_to(state.yaw)
        if condition.carried:
            missing.forget()
            contacts.forget_open()
            ground.plane = FootPlane()
        contacts.hovering = _hovering(state, contacts, depths)
        held = [condition.in_air or contacts.stands(leg) for leg in range(len(depths))]
        deepest = hole_depth(footing.height, deeper)
        if max(depths) > deepest and self._lifted > _SETTLES and not condition.in_air:
            level = [is_level(sunk_at(place, body.off), deeper, body.reach.scale) for place in footing.places]
            # Where the body is level, a foot as deep as a hole touches the wall of a trench.
            held = [on and not (deep > deepest and flat) for on, deep, flat in zip(held, depths, level, strict=True)]
        stands = [on and not missing.steps_back(leg, footing.places[leg]) for leg, on in enumerate(held)]
        missing.sees(ground, body.choice.holes, footholds.rest.tolist(), dt)
        waits = condition.carried or (rests and low == footing.down)
        searches = [] if waits else self._searches(state, footing, stands)
        missing.lost = contacts.tips(footing, deeper)
        self._lifted = 0.0 if condition.carried else self._lifted + dt
        if contacts.estimated and self._lifted > _SETTLES:
            self._tipping.step(footing, depths, tilt, dt)
            missing.lost = self._tipping.leg if missing.lost is None else missing.lost
            if missing.lost is not None and self._tipping.at_edge:
                missing.tipped(missing.lost, footing.places[missing.lost])
        elif missing.lost is None and not contacts.estimated:
            missing.lost = body.sinks_at(state, footing, dt)
        footing = footing._replace(down=[on and stand for on, stand in zip(footing.down, stands, strict=True)])
        for search in searches:
            if search.on_step(footing.height, body.reach.scale):
                contacts.held_up(search.leg, dt)
        missing.step(searches, footing, dt, footholds=footholds, deeper=deeper)
        body.roughness.at_edge(missing.edge)
        return stands

    def _searches(self, state: GaitState, footing: Footing, stands: list[bool]) -> list[Search]:
        """Return the feet that should stand and feel no ground."""
        body, contacts, found = self._body, self._body.contacts, list[Search]()
        legs = [leg for leg, on in enumerate(footing.down) if on and not stands[leg] and contacts.is_known(leg)]
        off = body.odometry.feet_off_commanded(legs, body.measured, body.commanded)
        for leg in legs:
            place, foot = footing.places[leg], state.felt[leg]
            depth = body.ground.lowest_near(place) + state.elevation - float(state.ground_height[leg])
            known = foot.speed < -_FALLS, contacts.seeks(leg), contacts.sunk[leg], off[leg][2] if leg in off else 0.0
            found.append(Search(leg, depth, *known, sunk_at(place, body.off), contacts.age))
        return found


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


def _hovering(state: GaitState, contacts: FootContacts, depths: list[float]) -> list[int]:
    """Return the legs whose feet have landed above the ground and not stood since, as their switches are stuck closed.

    Parameters
    ----------
    state, contacts : GaitState, FootContacts
        The gait state; the contacts.
    depths : list of float
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
    ahead = reach.scale * _AHEAD * abs(velocity)
    for leg, over in enumerate((state.ground_height - state.elevation).tolist()):
        place = footing.places[leg]
        soon = deeper > 0.0 and (complex(reach.rest[leg]) * velocity.conjugate()).real < ahead
        soon = soon and body.ground.at(place) - over < deeper and sunk_at(place, body.off) < reach.scale * _SINKS
        found.append(footing.down[leg] and (soon or body.contacts.supports(leg)))
    return found
