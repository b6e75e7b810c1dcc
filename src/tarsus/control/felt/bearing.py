"""Bearing: which feet may bear load, or soon will, where their contacts do not tell."""

from __future__ import annotations

import math
from collections.abc import Sequence

from tarsus.control.contact.foot_contacts import FootContacts
from tarsus.control.contact.footing import Footing, sunk_at
from tarsus.control.terrain.body_motion import BodyMotion
from tarsus.control.walk.state import ROUNDING, GaitState

__all__ = ["hovering", "not_sunk", "supporting"]

# Depth on even ground from which a foot bears no load that is not felt, whatever its shin rests on [m]; greatest such
# depth, on rough ground too, over the body height.
_HANGS, _HANGS_LOW = 0.042, 0.9
# Height over the expected ground from which a foot without contact bears none either, as before a wall [m].
_HIGH = 0.03
# A foot without contact does not count as support where the body is lower than in its attitude by more than the first,
# or its rest foothold is farther ahead than the second, where no other foot has been [m].
_SINKS, _AHEAD = 0.01, 0.03


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
