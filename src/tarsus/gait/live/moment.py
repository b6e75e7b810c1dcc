"""The walking robot at one moment, and how it goes on from there: a function of the moment, without memory.

Points of the ground plane are complex numbers here, x + iy; a turn by an angle is a product with ``exp(i angle)``.
"""

from __future__ import annotations

import cmath
import math
from typing import Any, NamedTuple

import numpy as np

from tarsus.gait.gait import Gait
from tarsus.gait.live.lag import Lag
from tarsus.gait.swing import ground_share, height_share

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
    late: Any = 0.0
    cycles: float = 0.0
    beats: float = 0.0

    def height(self, lift: float) -> Floats:
        """Return the feet's heights in G [m].

        Parameters
        ----------
        lift : float
            How high a swinging foot rises [m].
        """
        along = ground_share(self.share)
        swinging = self.start_height + (self.ground - self.start_height) * along + lift * height_share(self.share)
        if np.isfinite(self.met).any():
            swinging = np.where(np.isfinite(self.met), self._settling_height(), swinging)
        return np.where(self.down, self.ground, swinging)

    def _settling_height(self) -> Floats:
        """Return how a foot that has met the ground comes to rest on it: the quintic from there."""
        since = np.where(np.isfinite(self.met), self.met, 0.0)
        left = np.minimum(1 - since, _GIVE)
        x = np.clip((self.share - since) / left, 0.0, 1.0)
        slope = self.met_speed * left
        rest = self.ground - self.met_height - slope
        return np.asarray(
            self.met_height
            + slope * x
            + x * x * x * ((10 * rest + 4 * slope) - x * ((15 * rest + 7 * slope) - x * (6 * rest + 3 * slope)))
        )


class Course(NamedTuple):
    """What the robot is doing: constant for a tick.

    Attributes
    ----------
    gait : Gait
        Order of the steps.
    offsets : array, shape (legs,)
        The gait's.
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
    level : array, shape (legs,)
        Height at which the ground is expected [m].
    holds : bool
        Whether all feet that are down wait, and lift later than they were to.
    beats : int
        How often in a cycle feet are lifted.
    """

    gait: Gait
    offsets: Floats
    frequency: float
    twist: Floats
    posture: Floats
    bandwidth: float
    posture_bandwidth: float
    steps: Floats
    lands: Floats
    rest: Floats
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


def carried(origin: complex, yaw: float, travel: Floats) -> tuple[complex, float]:
    """Return where the heading frame is after a travel ``(3,)``, the exponential of its displacement."""
    x, y, angle = travel.tolist()
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
    twist = now.twist.step(course.twist, dt, bandwidth=course.bandwidth)
    origin, yaw = carried(now.origin, now.yaw, now.twist.travel(course.twist, dt, bandwidth=course.bandwidth))
    stopping = not course.twist.any()
    if stopping and np.abs(twist.value).max() < _NO_SPEED:
        twist = Lag.still(np.zeros(3))
    posture = now.posture.step(course.posture, dt, bandwidth=course.posture_bandwidth)
    clock = now.clock + course.frequency * dt
    gone = course.frequency * dt
    after = now._replace(
        clock=clock,
        origin=origin,
        yaw=yaw,
        twist=twist,
        posture=posture,
        cycles=now.cycles + gone,
        beats=now.beats + course.beats * gone,
    )
    duty, swing = course.gait.duty, 1 - course.gait.duty
    since_lift = clock - (course.offsets + duty + now.number)
    due = now.down & (since_lift > TIE) & (not course.holds)
    if not due.any() and now.down.all():
        return after
    if due.any():
        # Feet that were held back go a shorter swing; what the clock has gone in this tick is not late.
        late = np.where(due, np.clip(since_lift - course.frequency * dt, 0.0, _LATEST * swing), after.late)
        after = _lift(after._replace(late=late), course, due, final_rest(after, course) if stopping else None)
    up = ~after.down
    if not up.any():
        return after
    share = np.where(up, np.clip((since_lift - after.late) / (swing - after.late), 0.0, 1.0), 0.0)
    target = after.target
    free = up & (after.share <= FREEZE) & np.isinf(after.met)
    if free.any():
        target = np.where(free, _foothold(after, course, swing - since_lift), target)
    after = _swing(after, share, target)
    landed = up & course.lands & (since_lift >= swing - TIE)
    return _land(after, landed) if landed.any() else after


def _creeping(now: Moment) -> bool:
    return bool(np.abs(now.twist.value).max() < _CREEPING)


def final_rest(now: Moment, course: Course) -> Floats | None:
    """Return where the feet rest once the robot stands, where it is about to; None while it is still fast."""
    if not _creeping(now):
        return None
    w = course.bandwidth
    origin, yaw = carried(now.origin, now.yaw, (2 * now.twist.value + now.twist.rate / w) / w)
    final: Floats = origin + cmath.exp(1j * yaw) * course.rest
    return final


def _lift(now: Moment, course: Course, due: Floats, final: Floats | None) -> Moment:
    """Lift the feet whose time has come; those that may not, or needn't, miss this step."""
    wanted = due & course.steps
    if final is not None:
        wanted = wanted & (np.abs(now.foot - final) > THERE)
    missed = due & ~wanted
    return now._replace(
        number=now.number + missed,
        down=now.down & ~wanted,
        share=np.where(wanted, 0.0, now.share),
        start_height=np.where(wanted, now.ground, now.start_height),
        ground=np.where(wanted, course.level, now.ground),
    )


def _foothold(now: Moment, course: Course, left: Floats) -> Floats:
    """Return where feet should land: where the body has their rest footholds in the middle of the stance.

    `left` is how long it is until then [cycles], negative where the foot should be down already.
    """
    if not course.twist.any() and (final := final_rest(now, course)) is not None:
        return final
    duty = course.gait.duty
    ahead = (left + duty / 2) / course.frequency
    w = course.bandwidth
    slowing = (1 - np.exp(-w * ahead) * (1 + w * ahead)) / (w * w)
    (x, y, angle), (ax, ay, turn) = now.twist.value.tolist(), now.twist.rate.tolist()
    way, angles = complex(x, y) * ahead + complex(ax, ay) * slowing, angle * ahead + turn * slowing
    place: Floats = now.origin + cmath.exp(1j * now.yaw) * (way * turned(angles) + np.exp(1j * angles) * course.rest)
    return place


def _swing(now: Moment, share: Floats, target: Floats) -> Moment:
    """Move the swinging feet on: the quintic from here to the target, there at rest."""
    foot, pace, bend = now.foot.copy(), now.pace.copy(), now.bend.copy()
    for leg in np.flatnonzero(~now.down).tolist():
        left = 1.0 - float(now.share[leg])
        if left <= 0:
            foot[leg], pace[leg], bend[leg] = target[leg], 0.0, 0.0
            continue
        x = (float(share[leg]) - float(now.share[leg])) / left
        here, speed, half = complex(foot[leg]), complex(pace[leg]) * left, complex(bend[leg]) * (left * left / 2)
        gap, missing, bent = complex(target[leg]) - (here + speed + half), -(speed + 2 * half), -2 * half
        a3 = 10 * gap - 4 * missing + bent / 2
        a4 = -15 * gap + 7 * missing - bent
        a5 = 6 * gap - 3 * missing + bent / 2
        foot[leg] = here + x * (speed + x * (half + x * (a3 + x * (a4 + x * a5))))
        pace[leg] = (speed + x * (2 * half + x * (3 * a3 + x * (4 * a4 + x * 5 * a5)))) / left
        bend[leg] = (2 * half + x * (6 * a3 + x * (12 * a4 + x * 20 * a5))) / (left * left)
    return now._replace(share=share, target=target, foot=foot, pace=pace, bend=bend)


def _land(now: Moment, landed: Floats) -> Moment:
    """Put feet down that have come to the end of their swing."""
    return now._replace(
        number=now.number + landed,
        down=now.down | landed,
        share=np.where(landed, 0.0, now.share),
        foot=np.where(landed, now.target, now.foot),
        pace=np.where(landed, 0.0, now.pace),
        bend=np.where(landed, 0.0, now.bend),
        met=np.where(landed, np.inf, now.met),
    )


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
