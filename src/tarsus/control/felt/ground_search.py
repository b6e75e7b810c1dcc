"""Ground search: which feet stand, which look for the ground, and what is done where they find none."""

from __future__ import annotations

import math

from tarsus.control.contact.footing import Footing, off_commanded, sunk_at
from tarsus.control.contact.tipping import Tipping
from tarsus.control.felt.bearing import hovering, not_sunk
from tarsus.control.search.missing_ground import MissingGround
from tarsus.control.search.search import Search
from tarsus.control.sensing.body_condition import BodyCondition
from tarsus.control.terrain.body_motion import BodyMotion
from tarsus.control.terrain.foothold_choice import FootholdChoice
from tarsus.control.transition.foothold_transfer import FootholdTransfer
from tarsus.control.walk.state import GaitState
from tarsus.gait.foot_plane import FootPlane

__all__ = ["GroundSearch"]

# Speed above which a foot that goes down is not at the end of its reach, which itself sinks with the body [m/s].
_FALLS = 0.1
# Time after which a robot that was lifted may be found to tip, where contacts are estimated: until then it is put down,
# and settles [s].
_SETTLES = 8.0


class GroundSearch:
    """Finds which feet stand, and where those step that find no ground.

    Parameters
    ----------
    body, choice : BodyMotion, FootholdChoice
        Contacts, expected ground, roughness and reach; holes at the footholds of feet in the air.
    condition, missing : BodyCondition, MissingGround
        Whether the robot is in the air or carried; where feet that find no ground step.
    """

    def __init__(
        self, body: BodyMotion, choice: FootholdChoice, condition: BodyCondition, missing: MissingGround
    ) -> None:
        self._body, self._choice, self._condition, self._missing = body, choice, condition, missing
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
        contacts.hovering = hovering(state, contacts, depths)
        held = [condition.in_air or contacts.stands(leg) for leg in range(len(depths))]
        stands = [on and not missing.steps_back(leg, footing.places[leg]) for leg, on in enumerate(held)]
        missing.sees(ground, self._choice.holes, footholds.rest.tolist(), dt)
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
