"""The walking robot at one moment, and how it goes on from there: a function of the moment, without memory.

Points of the ground plane are complex numbers here, x + iy; a turn by an angle is a product with ``exp(i angle)``.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from tarsus.gait.gait import Gait
from tarsus.gait.live.lag import Lag
from tarsus.gait.live.polygon import NORMALS

__all__ = ["FREEZE", "THERE", "TIE", "Course", "Moment", "carried", "final_rest", "go_on", "meet_ground", "turned"]

Floats = np.ndarray[Any, Any]

FREEZE = 0.6
"""Share of the swing after which the foot's target stays: what is left is enough to come to it gently."""

TIE = 1e-9
"""What counts as the same moment [cycles]."""

# Of how much of its swing a foot that was held back may be deprived at most.
_LATEST = 0.5
# Within which share of the swing a foot that has met the ground comes to rest on it.
_GIVE = 0.1
# Below this speed [m/s] of the feet past the body, a robot told to stand is taken to be stopping: it steps to rest.
_CREEPING = 0.01
# A foot this near to its rest foothold is there [m]; a speed this low is none [m/s].
THERE, _NO_SPEED = 1e-6, 3e-7
_SIDES = NORMALS.conj()
# What a share of 1 may be missed by from rounding.
_ROUNDING = 1e-9
# A posture this near to its target, and as slow, is there [m, m/s, rad, rad/s].
_NO_WAY = 1e-11


class Moment(NamedTuple):
    """Everything that the future of the walk depends on; each array ``(legs,)`` unless said otherwise.

    Attributes
    ----------
    clock : float
        Time in cycles.
    number : array
        The step that each leg is in, or swings out of: touchdown at ``offset + number``.
    down : array of bool
        Whether the foot is on the ground.
    share : array
        Share of the swing that is over.
    foot, target : complex array
        Where the feet are, and where they are or will be put down, in G [m].
    pace, bend : complex array
        First and second derivative of a swinging foot's way by its share [m].
    ground, start_height : array
        Height of the ground that each foot is on or bound for, and where its swing began [m].
    met : array
        Share of the swing at which the foot met ground that was not expected yet; infinite where it did not.
    met_height, met_speed : array
        Where that was [m], and how the height changed with the swing's share [m].
    origin : complex
        The heading frame's origin in G [m].
    yaw : float
        Where it faces [rad].
    twist : Lag
        Its speed ``(3,)``: forward, left [m/s], turning [rad/s].
    posture : Lag
        The body over the heading frame: see `tarsus.gait.live.posture`.
    late : array
        How much later than it was to each foot was lifted [cycles]; its swing is shorter by that.
    cycles, beats : float
        How many cycles and how many beats of the gait have been walked: what the body sways by.
    """

    clock: float
    number: Floats
    down: Floats
    share: Floats
    foot: Floats
    target: Floats
    pace: Floats
    bend: Floats
    ground: Floats
    start_height: Floats
    met: Floats
    met_height: Floats
    met_speed: Floats
    origin: complex
    yaw: float
    twist: Lag
    posture: Lag
    late: Floats
    cycles: float = 0.0
    beats: float = 0.0

    def height(self, lift: float) -> Floats:
        """Return the feet's heights in G [m].

        Parameters
        ----------
        lift : float
            How high a swinging foot rises [m].
        """
        heights = self.ground.tolist()
        for leg in np.flatnonzero(~self.down).tolist():
            heights[leg] = self._height(leg, lift)
        return np.array(heights)

    def _height(self, leg: int, lift: float) -> float:
        """Return the height of a foot in the air."""
        share, ground, met = float(self.share[leg]), float(self.ground[leg]), float(self.met[leg])
        if met == math.inf:
            start = float(self.start_height[leg])
            rise = 4 * share * (1 - share)
            along = share * share * share * (10 - share * (15 - 6 * share))
            return start + (ground - start) * along + lift * (rise * rise * rise)
        # A foot that has met the ground comes to rest on it: the quintic from there.
        left = min(1 - met, _GIVE)
        x = min(max((share - met) / left, 0.0), 1.0)
        start, slope = float(self.met_height[leg]), float(self.met_speed[leg]) * left
        rest = ground - start - slope
        bend = (10 * rest + 4 * slope) - x * ((15 * rest + 7 * slope) - x * (6 * rest + 3 * slope))
        return start + slope * x + x * x * x * bend


class Course(NamedTuple):
    """What the robot is doing: constant for a tick.

    Attributes
    ----------
    gait : Gait
        Order of the steps.
    frequency : float
        Cycles a second [1/s].
    twist, posture : array
        What twist and posture follow.
    bandwidth, posture_bandwidth : float
        How fast they follow [rad/s].
    steps, lands : array of bool, shape (legs,)
        Which legs may lift, and which put their feet down at the end of their swing.
    rest : complex array, shape (legs,)
        Rest footholds in the heading frame [m].
    room : array, shape (legs, 16)
        How far from these the feet may be put down, along each of `NORMALS` [m].
    level : array, shape (legs,)
        Height at which the ground is expected [m].
    holds : bool
        Whether all feet that are down wait, and lift later than they were to.
    beats : int
        How often in a cycle feet are lifted.
    """

    gait: Gait
    frequency: float
    twist: Floats
    posture: Floats
    bandwidth: float
    posture_bandwidth: float
    steps: Floats
    lands: Floats
    rest: Floats
    room: Floats
    level: Floats
    holds: bool = False
    beats: int = 2


def turned(angle: Any) -> Any:
    """Return ``(exp(i angle) - 1) / (i angle)``: how a way bends that turns by an angle.

    Parameters
    ----------
    angle : float or array
        The angle [rad].
    """
    if isinstance(angle, float):
        half = angle / 2
        return cmath.exp(1j * half) * (math.sin(half) / half if abs(half) > 1e-6 else 1 - half * half / 6)
    half = angle / 2
    return np.exp(1j * half) * np.sinc(half / np.pi)


def carried(origin: complex, yaw: float, travel: Sequence[float]) -> tuple[complex, float]:
    """Return where the heading frame is after a travel (x, y, angle), the exponential of its displacement."""
    x, y, angle = travel
    return origin + cmath.exp(1j * yaw) * complex(x, y) * turned(angle), yaw + angle


def go_on(now: Moment, course: Course, dt: float) -> Moment:
    """Return the moment after a time.

    Parameters
    ----------
    now : Moment
        The moment.
    course : Course
        What the robot is doing.
    dt : float
        The time [s].
    """
    twist, travel = now.twist.go(course.twist, dt, bandwidth=course.bandwidth)
    origin, yaw = carried(now.origin, now.yaw, travel)
    stopping = not any(course.twist.tolist())
    if stopping and max(map(abs, twist.value.tolist())) < _NO_SPEED:
        twist = Lag.still(np.zeros(3))
    gone = course.frequency * dt
    clock = now.clock + gone
    after = now._replace(
        clock=clock,
        origin=origin,
        yaw=yaw,
        twist=twist,
        posture=_settled(now.posture, course.posture, dt, course.posture_bandwidth),
        cycles=now.cycles + gone,
        beats=now.beats + course.beats * gone,
    )
    duty = course.gait.duty
    since_lift = [clock - (o + duty + n) for o, n in zip(course.gait.offsets, now.number.tolist(), strict=True)]
    down = now.down.tolist()
    due = [on and since > TIE and not course.holds for on, since in zip(down, since_lift, strict=True)]
    if any(due):
        after = _lift(after, course, np.array(due), np.array(since_lift) - gone, stopping=stopping)
        down = after.down.tolist()
    return after if all(down) else _swing(after, course, down, since_lift, stopping=stopping)


def _settled(posture: Lag, target: Floats, dt: float, bandwidth: float) -> Lag:
    """Return the posture after a time; once it is there, it is the same one from then on."""
    if posture.value is target:
        return posture
    after = posture.step(target, dt, bandwidth=bandwidth)
    off = max(float(np.abs(after.value - target).max()), float(np.abs(after.rate).max()))
    return after if off > _NO_WAY else Lag.still(target)


def final_rest(now: Moment, course: Course) -> Floats | None:
    """Return where the feet rest once the robot stands, where it is about to; None while it is still fast."""
    if max(map(abs, now.twist.value.tolist())) >= _CREEPING:
        return None
    w = course.bandwidth
    origin, yaw = carried(now.origin, now.yaw, ((2 * now.twist.value + now.twist.rate / w) / w).tolist())
    final: Floats = origin + cmath.exp(1j * yaw) * course.rest
    return final


def _lift(now: Moment, course: Course, due: Floats, late: Floats, *, stopping: bool) -> Moment:
    """Lift the feet whose time has come; those that may not, or needn't, miss this step.

    `late` is how long ago their time was [cycles]: what the clock has gone in this tick doesn't count.
    """
    wanted = due & course.steps
    final = final_rest(now, course) if stopping else None
    if final is not None:
        wanted = wanted & (np.abs(now.foot - final) > THERE)
    missed = due & ~wanted
    return now._replace(
        number=now.number + missed,
        down=now.down & ~wanted,
        share=np.where(wanted, 0.0, now.share),
        start_height=np.where(wanted, now.ground, now.start_height),
        ground=np.where(wanted, course.level, now.ground),
        # Feet that were held back go a shorter swing.
        late=np.where(due, np.clip(late, 0.0, _LATEST * (1 - course.gait.duty)), now.late),
    )


class _Landing(NamedTuple):
    """Where feet should land: where the body has their rest footholds in the middle of the stance."""

    origin: complex
    turn: complex
    value: list[float]
    rate: list[float]
    bandwidth: float

    @classmethod
    def of(cls, now: Moment, course: Course) -> _Landing:
        turn = cmath.exp(1j * now.yaw)
        return cls(now.origin, turn, now.twist.value.tolist(), now.twist.rate.tolist(), course.bandwidth)

    def foothold(self, rest: complex, room: Floats, until: float, middle: float) -> complex:
        """Return the foothold for a touchdown and a middle of the stance that are so far ahead [s]."""
        way, facing = self._body(middle)
        place = way + facing * rest
        # Where the body turns or slows down, that may be farther out than the foot may be put down.
        way, facing = self._body(until)
        out = (place - way) * facing.conjugate() - rest
        along = (_SIDES * out).real
        share = float((room / np.maximum(along, 1e-12)).min())
        if share < 1 - _ROUNDING:
            place = way + facing * (rest + share * out)
        return self.origin + self.turn * place

    def _body(self, ahead: float) -> tuple[complex, complex]:
        """Return where the body will be, and where it will face, seen from where it is."""
        w = self.bandwidth
        slowing = (1 - math.exp(-w * ahead) * (1 + w * ahead)) / (w * w)
        (x, y, angle), (ax, ay, turn) = self.value, self.rate
        angle = angle * ahead + turn * slowing
        return complex(x * ahead + ax * slowing, y * ahead + ay * slowing) * turned(angle), cmath.exp(1j * angle)


def _swing(now: Moment, course: Course, down: list[bool], since_lift: list[float], *, stopping: bool) -> Moment:
    """Move the swinging feet on, and put those down that have come to the end of their swing."""
    duty = course.gait.duty
    swing, stance = 1 - duty, duty / course.frequency
    landing = _Landing.of(now, course)
    final = final_rest(now, course) if stopping else None
    share, foot, target = now.share.tolist(), now.foot.tolist(), now.target.tolist()
    pace, bend = now.pace.tolist(), now.bend.tolist()
    lands, landed = course.lands.tolist(), []
    for leg in [leg for leg, on in enumerate(down) if not on]:
        late, since = float(now.late[leg]), since_lift[leg]
        part = min(max((since - late) / (swing - late), 0.0), 1.0)
        if share[leg] <= FREEZE and now.met[leg] == math.inf:
            until = (swing - since) / course.frequency
            target[leg] = (
                landing.foothold(complex(course.rest[leg]), course.room[leg], until, until + stance / 2)
                if final is None
                else complex(final[leg])
            )
        way = (foot[leg], pace[leg], bend[leg])
        foot[leg], pace[leg], bend[leg] = _quintic(way, target[leg], share[leg], part)
        share[leg] = part
        if lands[leg] and since >= swing - TIE:
            landed.append(leg)
            share[leg], foot[leg], pace[leg], bend[leg] = 0.0, target[leg], 0j, 0j
    after = now._replace(
        share=np.array(share), foot=np.array(foot), target=np.array(target), pace=np.array(pace), bend=np.array(bend)
    )
    return _land(after, landed) if landed else after


def _quintic(
    way: tuple[complex, complex, complex], target: complex, share: float, part: float
) -> tuple[complex, complex, complex]:
    """Go on from a share of the swing to another, on the quintic that ends at the target at rest.

    `way` is where the foot is, and the first and second derivative of its way by the share.
    """
    left = 1.0 - share
    if left <= 0:
        return target, 0j, 0j
    x = (part - share) / left
    here, speed, half = way[0], way[1] * left, way[2] * (left * left / 2)
    gap, missing, bent = target - (here + speed + half), -(speed + 2 * half), -2 * half
    a3 = 10 * gap - 4 * missing + bent / 2
    a4 = -15 * gap + 7 * missing - bent
    a5 = 6 * gap - 3 * missing + bent / 2
    return (
        here + x * (speed + x * (half + x * (a3 + x * (a4 + x * a5)))),
        (speed + x * (2 * half + x * (3 * a3 + x * (4 * a4 + x * 5 * a5)))) / left,
        (2 * half + x * (6 * a3 + x * (12 * a4 + x * 20 * a5))) / (left * left),
    )


def _land(now: Moment, landed: list[int]) -> Moment:
    """Put feet down that are where they are to land."""
    number, down, met = now.number.copy(), now.down.copy(), now.met.copy()
    number[landed] += 1
    down[landed], met[landed] = True, np.inf
    return now._replace(number=number, down=down, met=met)


def meet_ground(now: Moment, met: Floats, lift: float) -> Moment:
    """Return the moment in which feet have met the ground before they were to: they come to rest where they are.

    Parameters
    ----------
    now : Moment
        The moment.
    met : array of bool, shape (legs,)
        Which feet; in the air, and not met already.
    lift : float
        How high a swinging foot rises [m].
    """
    height = now.height(lift)
    step = 1e-4
    speed = (now._replace(share=np.minimum(now.share + step, 1.0)).height(lift) - height) / step
    left = 1 - now.share
    give = np.minimum(left, _GIVE)
    # What a foot still goes while it comes to rest, with its speed falling evenly.
    return now._replace(
        target=np.where(met, now.foot + now.pace * left / 3, now.target),
        met=np.where(met, now.share, now.met),
        met_height=np.where(met, height, now.met_height),
        met_speed=np.where(met, speed, now.met_speed),
        ground=np.where(met, height + speed * give / 3, now.ground),
    )
