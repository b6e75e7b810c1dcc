"""Missing ground: feet that find none step back, the body backs off, and the walk does not go on over the edge."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tarsus.control.contact.footing import Footing, holds
from tarsus.control.limitation import Cause, Limitation, LimitationKind
from tarsus.control.limiter.protocol import TwistGrant, TwistRequest, leads_towards
from tarsus.control.search.edge import FORGETS, Edge, direction
from tarsus.control.search.obstacles import Obstacles
from tarsus.control.search.search import STANDS, Search
from tarsus.control.terrain.ground_map import GroundMap
from tarsus.control.transition.foothold_transfer import FootholdTransfer

__all__ = ["SLOW", "MissingGround"]

# Depth at which the walk begins to slow down, besides how much deeper ground may be [m]; least pace while the foot does
# not go down, at the end of its reach.
_SLOWS, _SLOWEST = 0.005, 0.25
# Time that a foot whose leg may rest on the edge of a step searches [s], besides so many times the age of the contacts:
# it is also held up by ground that its open switch does not report, but by then other feet have told of that.
_HELD, _LATER = 0.3, 5.0
# How far a waiting robot may be raised at a foot that is still lowered: on feet that lose contact in turn it rocks [m].
_RAISED = 0.005
# Pace below which the walk says why it is slow.
SLOW = 0.85
# Missing ground is certain only while ground may be at most this much deeper than expected [m].
_SURE = 0.0125
# How far behind its rest foothold a foot steps back at each try, over the distance from there at which it may stand;
# with the last try, the body backs off as far as it may.
_BACK = (0.4, 1.0, 1.0)
# The body backs off until feet this far from the edge hold it with this margin [m]; greatest way [m], speed [m/s].
_FIRM, _MARGIN, _BACKS, _SPEED = 0.06, 0.03, 0.08, 0.15
# Distance from its place up to which a foot is there; depth up to which a foot without ground is not over a hole [m].
_THERE, _SHALLOW = 0.004, 0.02
# How often the walk goes on where there may be no hole; time until it does, and time then without catching up [s].
_AGAIN, _WAITS, _CAREFUL = 2, 1.0, 1.5


class MissingGround:
    """Decides where feet that find no ground or are stopped step, how the body backs off, and which twist is refused.

    Parameters
    ----------
    names, scale : sequence of str, float
        Names of the legs; factor by which lengths and speeds are reduced on short legs, 0 to 1.

    Attributes
    ----------
    obstacles : Obstacles
        Where feet that are stopped on their way try next.
    places : dict of int to complex
        By leg, where a foot that steps back or tries to get past an obstacle is to stand, in the heading frame [m].
    refuses : bool
        Whether the commanded twist leads over an edge or towards an obstacle: the robot stays where it is.
    pace : float
        Greatest rate of the walk that feet without contact allow, 0 to 1.
    back : complex
        Velocity with which the body backs off over its feet, in the heading frame [m/s].
    tips : complex
        Direction in which the robot tips, towards a foot or the edge, in the heading frame; 0 where it does not.
    edge : float
        Commanded depth of a foot that steps back from where its leg may rest on the edge of a step [m]; 0 without one.
    twist : sequence of float
        Twist with which the robot walks [m/s, m/s, rad/s].
    lost : int or None
        Leg at whose foot the robot tips, as the other feet do not hold it; None without one.
    stranded : list of int
        Legs whose feet have found no ground at any place while the robot is to leave the edge: they step first.
    """

    def __init__(self, names: Sequence[str], *, scale: float = 1.0) -> None:
        self.obstacles, self.places, self.stranded = Obstacles(scale), dict[int, complex](), list[int]()
        self.pace, self.back, self.tips, self.edge, self.refuses = 1.0, 0j, 0j, 0.0, False
        self._names, self._scale, self._tries, self._cause = names, scale, [0] * len(names), Cause("")
        # Whether each foot was only slightly below the others when it last stepped back, so not over a hole.
        self._shallow = [False] * len(names)
        self.lost: int | None = None
        # By leg, how long a foot without contact has been held up by its leg [s].
        self._held = dict[int, float]()
        self._edge, self._backed, self._again, self._slows = Edge(scale), 0.0, 0, ""
        # Whether the robot is to stop; whether a rest foothold is over a hole; velocity commanded away from there
        # [m/s].
        self._stops, self._over, self._leaves = True, False, 0j
        self.twist: Sequence[float] = (0.0, 0.0, 0.0)

    @property
    def limitations(self) -> list[Limitation]:
        """Why the walk slows down, unless the command is refused for that reason."""
        cause = Cause("the foot looks for the ground", self._slows) if self._slows else self._cause
        return [cause.limitation(LimitationKind.GROUND)] if not self.refuses and self.pace < SLOW else []

    def forget(self) -> None:
        """Forget holes and obstacles: the robot is carried elsewhere."""
        self.obstacles, self._tries, self.places = Obstacles(self._scale), [0] * len(self._names), {}
        self._edge.way = self._edge.left = 0j
        self.refuses, self._again = False, 0

    def turn_to(self, yaw: float) -> None:
        """Take the yaw of the heading frame [rad]: edges and obstacles stay where they are as it turns."""
        self.obstacles.found *= self._edge.turn_to(yaw)

    def steps_back(self, leg: int, foot: complex) -> bool:
        """Return whether a foot, now at a place in the heading frame, is on its way to another one."""
        return leg in self.places and abs(self.places[leg] - foot) > self._scale * _THERE

    def tries(self, leg: int, foot: complex) -> bool:
        """Return whether a foot, now at a place in the heading frame, is on its way past an obstacle."""
        return self.obstacles.tries(leg) and self.steps_back(leg, foot)

    def gives_up(self, leg: int) -> bool:
        """Return whether a foot has found no ground at any place."""
        return self._tries[leg] > len(_BACK)

    def is_raised(self, by: float) -> bool:
        """Return whether a robot waiting at a hole is too high at a foot by this [m]: the foot goes no lower."""
        return by > self._scale * _RAISED and self.refuses and not (self.tips or self.places)

    def tipped(self, leg: int, foot: complex) -> None:
        """Take note of an edge on which a leg rests: the robot has tipped at its foot, a place in the heading frame."""
        if not self._edge.way:
            self._edge.way, self._again = foot / abs(foot), max(self._again, _AGAIN - 1)
            self._cause = Cause("the robot tips at the foot", self._names[leg])

    def step(
        self, searches: Sequence[Search], footing: Footing, dt: float, *, footholds: FootholdTransfer, deeper: float
    ) -> None:
        """Decide for a tick.

        Parameters
        ----------
        searches : sequence of Search
            Feet that should stand and feel nothing.
        footing, dt : Footing, float
            The feet, and which of them stand; length of the tick [s].
        footholds, deeper : FootholdTransfer, float
            Rest footholds and their bounds; how much deeper ground may be than expected [m].
        """
        (feet, stands, centre, height), rest = footing, footholds.rest.tolist()
        if not searches:
            self._edge.twist = self.twist
        goes_on = [leg for leg in self.obstacles.goals if not self.steps_back(leg, feet[leg])]
        self.places |= {leg: self.obstacles.goals.pop(leg) for leg in goes_on}
        searching = {search.leg for search in searches} | set(goes_on)
        # Past an obstacle, a foot looks for the ground like any other.
        past = {leg for leg in self.obstacles.stops if not self.steps_back(leg, feet[leg])}
        for leg in [leg for leg in self.places if leg not in searching or leg in past]:
            self.drop(leg)
            self._tries[leg] = 0
        # A robot that has tipped goes back until it is held with a margin; one on none of its feet is being lifted.
        standing = [foot for foot, on in zip(feet, stands, strict=True) if on]
        held = not (searches and standing) or holds(standing, centre + self._scale * _MARGIN * self.tips)
        self.pace, self.back, self.tips, self._slows, self.edge = 1.0 - self.refuses, 0j, 0j, "", 0.0
        if self.lost is not None:
            self._tip(feet[self.lost] / abs(feet[self.lost]))
            self.pace, self._slows = 0.0, self._names[self.lost]
        before, self._held = self._held, {}
        slows, deep = deeper + self._scale * _SLOWS, deeper + self._scale * STANDS
        sure = deeper <= self._scale * _SURE
        for search in searches:
            leg, on_step = search.leg, search.on_step(height, self._scale)
            slowest = 0.0 if search.falls else _SLOWEST
            pace = max(1 - (search.depth - slows) / (deep - slows), slowest)
            self.pace, self._slows = min((self.pace, self._slows), (pace, self._names[leg]))
            self._held[leg] = (before.get(leg, 0.0) + dt) * (on_step and not search.falls)
            held_up, again = self._held[leg] > _HELD + _LATER * search.age, leg in self.places
            missing = search.is_missing(height, deeper, self._scale, held=held, held_up=held_up, again=again)
            way = self._edge.seen_from(feet[leg], rest[leg])
            if search.tips(deep, self._scale, held=held):
                self._tip(way)
            if missing and not (self.steps_back(leg, feet[leg]) or self.gives_up(leg)):
                self.edge = search.depth if on_step else self.edge
                self._step_back(leg, search.depth, way, footholds, sure=sure and not self.edge)
        # Feet only slightly below the others are not over a hole, unless the robot tips.
        shallow = all(self._shallow[leg] and not self.tips for leg in self.places)
        self._go_on(shallow, dt)
        if self.places:
            self.pace, self._slows = _SLOWEST * bool(self.stranded), ""
        self._back_off(footing, shallow, dt)

    def _go_on(self, shallow: bool, dt: float) -> None:
        """Decide whether the walk goes on where it has waited, with no foot far below the others."""
        self._edge.since = (self._edge.since + dt) * (shallow and all(map(self.gives_up, self.places)))
        if self.refuses and not self._stops and self._again < _AGAIN and self._edge.since > _WAITS:
            self._again += 1
            self._edge.leave(self.obstacles.found)
        elif not (self.places or self.refuses) and self._edge.since > FORGETS:
            self._again, self.obstacles.found = 0, 0j

    def _back_off(self, footing: Footing, shallow: bool, dt: float) -> None:
        """Decide the velocity with which the body backs off, or leaves an edge."""
        (feet, stands, centre, _), speed, most = footing, self._scale * _SPEED, self._scale * _BACKS
        if not self.places:
            # A robot that tips goes back at once; so does one that is to stop with a rest foothold over a hole.
            velocity = -speed * (self.tips or self._edge.way * (self._stops and self._over))
            self._backed *= bool(velocity)
        elif self._leaves:
            # The other feet may not hold the robot while one steps: the body moves over them, by as much again at most.
            velocity, most = self._leaves * min(speed / abs(self._leaves), 1.0), 2 * most
        else:
            along = [self._edge.along(feet[leg]) for leg in self.places]
            edge = min(along) - self._scale * _FIRM
            firm = [foot for foot, on in zip(feet, stands, strict=True) if on and self._edge.along(foot) < edge]
            # A robot that turns meets the edge anew with each step, unless it goes back.
            enough = max(self._tries) < len(_BACK) and not self._edge.turns
            enough &= holds(firm, centre + self._scale * _MARGIN * self._edge.way)
            # From feet behind it, the body would back off over the hole; ground that is only slightly lower is none.
            backs = not shallow and max(along) > self._edge.along(centre) and not (self.obstacles.stops or enough)
            velocity = -speed * self._edge.way * backs
        self.back = velocity * (self._backed < most)
        self._backed += abs(self.back) * dt

    def _step_back(self, leg: int, depth: float, way: complex, footholds: FootholdTransfer, *, sure: bool) -> None:
        """Choose a place behind its rest foothold for a foot without ground at a depth [m]; `way` leads to the edge."""
        self._tries[leg] += 1
        if self._tries[leg] == 1 and not self.refuses:
            self._edge.way = way
        back = _BACK[min(self._tries[leg], len(_BACK)) - 1] * footholds.placement_radii[leg]
        self.places[leg] = complex(footholds.rest[leg]) - back * self._edge.way
        # Ground that is only slightly lower, or rough, may be reached with other footholds.
        reached, shallow = f"no ground within {1e3 * depth:.0f} mm below the other feet", depth < self._scale * _SHALLOW
        reached += ", as its leg is held up" if self.edge else ""
        self._shallow[leg] = shallow
        self._cause = Cause("the ground is lower than the leg reaches" if shallow else reached, self._names[leg])
        self._again += _AGAIN if sure and not shallow else 0

    def _tip(self, way: complex) -> None:
        """Take note that the robot tips in this direction: no foot tries to get past an obstacle then."""
        self.tips = way
        for leg in list(self.obstacles.stops):
            self.drop(leg)

    def drop(self, leg: int) -> None:
        """Forget what has stopped a foot, and where it is to stand."""
        self.obstacles.stops.pop(leg, None)
        self.obstacles.goals.pop(leg, None)
        self.places.pop(leg, None)

    def stopped(self, leg: int, foot: complex, goal: complex, bow: complex) -> complex:
        """Decide where a foot that is stopped tries next; return the way by which it is drawn back [m].

        Parameters
        ----------
        leg, foot, goal, bow : int, complex, complex, complex
            As in `Obstacles.stopped`: the leg; places, and how far the foot may swing out, in the heading frame [m].
        """
        start, self.places[leg] = self.obstacles.stopped(leg, foot, goal, bow)
        ends = not self.obstacles.tries(leg)
        higher = " that is higher than the leg steps" if ends else ""
        self._cause = Cause(f"an obstacle stops the foot{higher}", self._names[leg])
        if ends:
            self._edge.way, self._again = self.obstacles.found, max(self._again, _AGAIN - 1)
        return start - foot

    def sees(self, ground: GroundMap, holes: Mapping[int, complex], rest: Sequence[complex], dt: float) -> None:
        """Take note of holes at feet in the air, by leg, and at rest footholds [m].

        Parameters
        ----------
        ground, holes, rest : GroundMap, mapping of int to complex, sequence of complex
            The known ground; by leg, the foothold of a foot in the air that is in a hole; rest footholds; in the
            heading frame [m].
        dt : float
            Time since the last call [s].
        """
        self._over = any(leads_towards(at, self._edge.way) and ground.is_hole(at) for at in rest)
        for leg, place in holes.items():
            self._edge.way, self._edge.hole = direction(place - rest[leg], rest[leg]), place
            self._cause, self._again = Cause("no ground within reach at its next foothold", self._names[leg]), _AGAIN
        if not self.places:
            self._edge.look_again(ground, dt)

    def held(self, shift: complex) -> complex:
        """Return the part of a velocity of all feet that would move the body on towards a refused edge [m/s]."""
        return min(self._edge.along(shift), 0.0) * self._edge.way if self.refuses else 0j

    def limit(self, request: TwistRequest, grant: TwistGrant) -> TwistGrant:
        """Return the grant, with no twist over an edge or towards an obstacle; any other twist ends the refusal."""
        velocity = complex(*request.twist[:2])
        self._stops = not any(request.twist)
        self.refuses = leads_towards(velocity, self._edge.way) or (self._stops and self._over)
        self.stranded = [leg for leg in self.places if self.gives_up(leg) and any(request.twist) and not self.refuses]
        self._leaves = velocity * (bool(self.stranded) and leads_towards(-velocity, self._edge.way or self._edge.left))
        if self.refuses:
            return grant.at_most(0.0, self._cause.limitation(LimitationKind.GROUND))
        for leg in self.obstacles.led_away(velocity):
            self.drop(leg)
        if any(request.twist) and not self.places and self._edge.way:
            self._edge.leave(self.obstacles.found)
        # Where there was an edge, the ground may be missing once more: lost time is not made up for.
        return grant.at_most(1.0) if self._again and self._edge.since < _CAREFUL else grant
