"""The live walker: wishes in, joint angles out, tick by tick, without a jump."""

from __future__ import annotations

import cmath
import dataclasses
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from tarsus.errors import InputError, UnreachableError
from tarsus.gait.gait import Gait
from tarsus.gait.live.change import Change, Manner, work_out
from tarsus.gait.live.envelope import Envelope, overhang
from tarsus.gait.live.governor import allowed_target, excess
from tarsus.gait.live.lag import Lag
from tarsus.gait.live.moment import THERE, TIE, Course, Moment, final_rest, go_on
from tarsus.gait.live.posture import LIFT, stand_of
from tarsus.gait.live.tempo import joint_limits
from tarsus.gait.live.wish import Wish
from tarsus.gait.live.workspace import Parts, all_parts
from tarsus.gait.setup import Setup
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stability import stability_margin
from tarsus.kinematics.verdict import all_within
from tarsus.robot.robot import Robot

__all__ = ["Walker"]

Floats = np.ndarray[Any, Any]

# The twist follows its target within about a stance: faster, and feet that are down would be left behind.
_LAGS_PER_STANCE = 4.0
# The same for the posture [rad/s], and how fast it may move the body at the most [m/s], turn it [rad/s].
_POSTURE_BANDWIDTH = 4.0
_BODY_SPEED, _BODY_TURN = 0.08, 0.5
# Ticks longer than this are walked as if they took no longer [s]: a late tick must not become a jump.
_LONGEST_TICK = 0.05
# How fast the walker's own time may run down and up again [1/s].
_TIME_CHANGE = 3.0
_PATIENCE = 1.0
# From which share of the joints' acceleration on the walker looks ahead, what share it then aims at, and how far [s].
_STRAINED, _CALM, _AHEAD = 0.5, 0.75, 0.02
_AT_POSTURE, _SAME = 2e-4, 1e-9
# How often a tick is tried, ever slower, and what of the joints' speed and acceleration it may come to.
_TRIES, _KEPT = 5, 0.98


class Walker:
    """Walks a robot live: each tick takes a wish and gives the next joint angles.

    Parameters
    ----------
    robot : Robot
        A single robot.
    gait : Gait, optional
        Order of the steps; the robot's own where left out.
    clearance, lift : float, optional
        Height of the body's origin, lift of the swinging feet [m]; the robot's own where left out.
    stance_width : float
        How much farther out than usual the feet rest [m].
    cycle_time : float, optional
        Duration of a cycle [s]; left out, the one that gets the robot farthest.
    joint_speed, joint_acceleration : float, optional
        Greatest of every joint [rad/s], [rad/s^2]; left out, each servo's no-load speed, reached in 0.05 s.
    foot_distance : float, optional
        Least distance between two feet [m]; two foot radii and 10 mm where left out.

    Raises
    ------
    InputError
        If an argument is not finite or out of its range, the robot is a batch, or the gait is for another number of
        legs.
    UnreachableError
        If the robot can't stand and step so.
    """

    def __init__(
        self,
        robot: Robot,
        gait: Gait | None = None,
        *,
        clearance: float | None = None,
        lift: float | None = None,
        stance_width: float = 0.0,
        cycle_time: float | None = None,
        joint_speed: float | None = None,
        joint_acceleration: float | None = None,
        foot_distance: float | None = None,
    ) -> None:
        gait = Gait.named(robot.gait.name, legs=robot.legs) if gait is None else gait
        setup = Setup.of(robot, gait, clearance=clearance, lift=lift, body_tilt=(0.0, 0.0), foot_distance=foot_distance)
        self.robot = setup.robot
        self._foot_distance = setup.foot_distance
        self.joint_speed, self.joint_acceleration = joint_limits(self.robot, joint_speed, joint_acceleration)
        manner = Manner(
            gait=gait,
            body=(0.0,) * 6,
            clearance=setup.clearance,
            lift=setup.lift,
            stance_width=stance_width,
            cycle_time=cycle_time,
        )
        change = all_parts(self._work_out(manner, None, None))
        if isinstance(change, str):
            raise UnreachableError(f"the robot can't walk so: {change}")
        self._wanted = manner
        self._doing = change
        self._way: Envelope = change.there
        self._bounds = change.there.bounds
        self._landing_bounds = self._bounds
        self._rest, self._posture = change.rest, change.posture
        self._leg_rest = change.rest
        self._old_step = np.zeros(self.robot.legs, dtype=bool)
        self._stepping: Change | None = None
        self._patience = 1.0
        self._job: Parts[Change | str] | None = None
        self._next: Change | None = None
        self._settling: tuple[Change, int] | None = None
        self._refusals: dict[Manner, str] = {}
        self._asked = manner
        self._stepped = np.ones(self.robot.legs, dtype=bool)
        self._frequency = 1 / change.tempo.cycle_time
        self._rate = 1.0
        self._strain = 0.0
        self._target = np.zeros(3)
        self._limited: tuple[str, ...] = ()
        self.time = 0.0
        self._last_dt = 0.01
        legs = self.robot.legs
        rest = change.rest
        none, zero = np.zeros(legs), np.zeros(legs, dtype=complex)
        self._now = Moment(
            clock=0.0,
            number=none,
            down=np.ones(legs, dtype=bool),
            share=none,
            foot=rest,
            target=rest,
            pace=zero,
            bend=zero,
            ground=none,
            start_height=none,
            origin=0j,
            yaw=0.0,
            twist=Lag.still(np.zeros(3)),
            posture=Lag.still(change.posture),
        )
        self._offsets = np.asarray(gait.offsets)
        self._walking = False
        self._angles = self._solve(self._now)
        self._joint_rate = np.zeros((legs, 3))
        self._free: dict[int, Any] = {}

    def _work_out(
        self, manner: Manner, now: Floats | None, rest: Floats | None, *, stay: bool = False
    ) -> Parts[Change | str]:
        return work_out(
            self.robot,
            manner,
            now,
            rest,
            stay=stay,
            speed=self.joint_speed,
            acceleration=self.joint_acceleration,
            foot_distance=self._foot_distance,
        )

    def step(self, wish: Wish | Sequence[float], dt: float) -> Floats:
        """Go on by one tick.

        Parameters
        ----------
        wish : Wish or (vx, vy, wz)
            What is asked for: a twist [m/s, m/s, rad/s] leaves everything else as it is.
        dt : float
            The time since the last tick [s]. Of a tick later than 0.05 s no more than that is walked.

        Returns
        -------
        array, shape (legs, 3)
            The next joint angles [rad].

        Raises
        ------
        InputError
            If the wish or the time is not finite, or out of its range. Nothing has changed then.
        """
        wish = wish if isinstance(wish, Wish) else Wish(twist=wish)
        if not 0 < dt < math.inf:
            raise InputError(f"dt is {dt} s; it must be greater than 0 and finite")
        dt = min(float(dt), _LONGEST_TICK)
        self._take(wish)
        self._think()
        # A change that the walk has no room for slows it down until it has.
        waits = self._next is not None or (self._stepping is not None and bool(self._stepped.all()))
        self._patience = self._patience * math.exp(-dt / _PATIENCE) if waits else 1.0
        self._aim(np.array(wish.twist))
        was_down = self._now.down
        self._advance(dt)
        self.time += dt
        self._finish(was_down)
        return self._angles

    # What was asked for.

    def _take(self, wish: Wish) -> None:
        """Note what is asked for besides the twist; a change is worked out in the ticks that follow."""
        m = self._wanted
        gait = m.gait if wish.gait is None else wish.gait
        if isinstance(gait, str):
            gait = m.gait if gait == m.gait.name else Gait.named(gait, legs=self.robot.legs)
        gait.require_legs(self.robot.legs)
        asked = Manner(
            gait=gait,
            body=m.body if wish.body is None else tuple(wish.body),
            clearance=m.clearance if wish.clearance is None else wish.clearance,
            lift=m.lift if wish.lift is None else wish.lift,
            stance_width=m.stance_width if wish.stance_width is None else wish.stance_width,
            cycle_time=m.cycle_time if wish.cycle_time is None else wish.cycle_time,
            gone=m.gone,
        )
        if asked.lift < 0 or (asked.cycle_time is not None and asked.cycle_time <= 0):
            raise InputError("the wish's lift must not be negative, its cycle_time must be greater than 0")
        if asked != self._wanted:
            self._wanted, self._refusals = asked, {}

    def _think(self) -> None:
        """Do one part of working out a change, and go over to it once the walk allows."""
        if self._job is not None:
            try:
                next(self._job)
            except StopIteration as done:
                self._job = None
                self._note(done.value)
            except UnreachableError as error:
                self._job = None
                self._note(str(error))
        elif self._next is None and self._settling is None and self._stepping is None:
            asked, stay = self._step_towards(self._wanted)
            if asked not in (self._doing.manner, *self._refusals) and self._arrived():
                self._asked = asked
                self._job = self._work_out(asked, self._posture, self._rest, stay=stay)
        if self._next is not None:
            self._try_change(self._next)
        elif self._stepping is not None:
            self._try_body(self._stepping)

    def _step_towards(self, wanted: Manner) -> tuple[Manner, bool]:
        """Return what to change first, how the robot stands or then how it steps; and whether it is the latter."""
        doing = self._doing.manner
        standing = dataclasses.replace(wanted, gait=doing.gait, cycle_time=doing.cycle_time, gone=doing.gone)
        if standing not in (doing, *self._refusals):
            return standing, False
        return dataclasses.replace(doing, gait=wanted.gait, cycle_time=wanted.cycle_time, gone=wanted.gone), True

    def _note(self, found: Change | str) -> None:
        if isinstance(found, str):
            self._refusals[self._asked] = found
        else:
            self._next = found

    def _try_change(self, change: Change) -> None:
        """Go over to a change as soon as the feet on the ground allow it."""
        old, new = self._doing.manner.gait, change.manner.gait
        if new.duty == old.duty and new.offsets == old.offsets:
            twist = self._now.twist.value
            stance_time = new.duty * change.tempo.cycle_time
            share, _ = change.stepping.largest_share(twist, stance_time=stance_time, duty=new.duty)
            begins, ends = self._stances(1 / change.tempo.cycle_time)
            if share >= 1 and self._works(begins, ends, self._bounds, 1 / change.tempo.cycle_time):
                self._adopt(change)
        elif not self._walking:
            self._switch(change, 0)
        else:
            self._try_gait(change)

    def _try_gait(self, change: Change) -> None:
        """Let all feet come down, if they may wait so long; then the new order begins with the leg that suits best."""
        new, frequency = change.manner.gait, 1 / change.tempo.cycle_time
        offsets = np.asarray(new.offsets)
        delays = ((offsets - offsets[:, None]) % 1) / frequency
        ends = self._until_down() + delays + (overhang(new.duty) - 0.5) * new.duty / frequency
        bounds = np.minimum(self._bounds, change.there.bounds)
        over = self._excess(np.zeros(delays.shape), ends, bounds, frequency).max(axis=(1, 2, 3, 4))
        first = int(over.argmin())
        if over[first] <= THERE:
            self._settling, self._next = (change, first), None
            self._bounds = bounds
            self._way = self._way.meet(change.there)

    def _try_body(self, change: Change) -> None:
        """Move the body once every foot has stepped to where it is to rest."""
        begins, ends = self._stances(self._frequency)
        slow = self._frequency <= 1 / change.tempo.cycle_time
        if slow and self._stepped.all() and self._works(begins, ends, change.way.bounds, self._frequency):
            self._bounds = np.minimum(self._bounds, change.way.bounds)
            self._landing_bounds = self._bounds
            self._way = self._way.meet(change.way)
            self._posture, self._stepping = change.posture, None

    def _until_down(self) -> float:
        now = self._now
        left = np.where(now.down, 0.0, 1 - now.share).max()
        return float(left * (1 - self._doing.manner.gait.duty) / self._frequency)

    def _works(self, begins: Floats, ends: Floats, bounds: Floats, frequency: float) -> bool:
        return bool(self._excess(begins, ends, bounds, frequency).max() <= THERE)

    def _excess(self, begins: Floats, ends: Floats, bounds: Floats, frequency: float) -> Floats:
        return excess(
            self._now, self._target[None], begins=begins, ends=ends, bounds=bounds, bandwidth=self._bandwidth(frequency)
        )

    def _adopt(self, change: Change) -> None:
        """Send the feet to where they are to rest; the body follows."""
        self._way = self._way.meet(change.stepping)
        self._landing_bounds = change.stepping.bounds
        moved = np.abs(change.rest - self._rest) > _SAME
        self._stepped = ~moved
        # A foot in the air lands where it is bound for; its next step is the one that counts.
        self._old_step = moved & ~self._now.down
        self._leg_rest = np.where(self._old_step, self._leg_rest, change.rest)
        self._bounds = np.where(moved[:, None], self._bounds, np.minimum(self._bounds, self._landing_bounds))
        self._rest, self._stepping, self._next = change.rest, change, None
        manner = change.manner if change.whole else self._doing.manner
        self._doing = dataclasses.replace(change, manner=manner)

    def _switch(self, change: Change, first: int) -> None:
        """Begin the new order of steps; every foot is down."""
        self._adopt(change)
        self._settling = None
        self._frequency = 1 / change.tempo.cycle_time
        self._offsets = np.asarray(change.manner.gait.offsets)
        self._begin(first)

    def _begin(self, first: int) -> None:
        """Set the clock to the moment when a leg lifts."""
        duty = self._doing.manner.gait.duty
        clock = float(self._offsets[first]) + duty
        self._now = self._now._replace(clock=clock, number=np.ceil(clock - self._offsets - duty - TIE))

    # Where to.

    def _bandwidth(self, frequency: float) -> float:
        return _LAGS_PER_STANCE * frequency / self._doing.manner.gait.duty

    def _stances(self, frequency: float) -> tuple[Floats, Floats]:
        """Return from when until when each foot is where it stands, or where it is about to [s]."""
        now, duty = self._now, self._doing.manner.gait.duty
        over = (overhang(duty) - 0.5) * duty / frequency
        begins = np.where(now.down, 0.0, (1 - now.share) * (1 - duty) / frequency)
        if self._settling is not None:
            change, first = self._settling
            new = change.manner.gait
            offsets = np.asarray(new.offsets)
            delay = ((offsets - offsets[first]) % 1 + (overhang(new.duty) - 0.5) * new.duty) * change.tempo.cycle_time
            return begins, self._until_down() + delay
        lift = (self._offsets + duty + now.number - now.clock) / frequency
        return begins, np.where(now.down, lift, begins + duty / frequency) + over

    def _aim(self, twist: Floats) -> None:
        """Set the target of the twist: as much of the wish as the legs allow, for good and right now."""
        frequency = min(self._frequency, 1 / self._doing.tempo.cycle_time)
        asked = [(self._doing, self._way)] + [
            (change, change.way.meet(change.stepping))
            for change in (self._next, self._stepping, self._settling and self._settling[0])
            if change
        ]
        share, leg = 1.0, -1
        if twist.any():
            for change, way in asked:
                slowest = min(frequency, 1 / change.tempo.cycle_time)
                duty = change.manner.gait.duty
                allowed, which = way.largest_share(twist, stance_time=duty / slowest, duty=duty)
                if allowed < share:
                    share, leg = allowed, which
        wish = self._limited_wish = twist * min(share, self._patience)
        self._limited = self._reasons(share, leg)
        if not self._walking:
            if not wish.any() and self._at_rest():
                return
            self._begin(0)
            self._walking = True
        if self._settled() and (wish == self._target).all():
            return
        begins, ends = self._stances(self._frequency)
        self._target = allowed_target(
            self._now,
            self._target,
            wish,
            begins=begins,
            ends=ends,
            bounds=self._bounds,
            bandwidth=self._bandwidth(self._frequency),
        )

    def _settled(self) -> bool:
        return self._settling is None and self._frequency * self._doing.tempo.cycle_time == 1.0

    def _reasons(self, share: float, leg: int) -> tuple[str, ...]:
        reasons = list(self._doing.limited)
        if share < 1:
            reasons.append(
                f"twist: {100 * share:.0f} % of it; {self.robot.leg_names[leg]} reaches no farther at "
                f"{self._doing.tempo.cycle_time:.2f} s a cycle"
            )
        reasons += self._refusals.values()
        return tuple(reasons)

    def _at_rest(self) -> bool:
        rest = final_rest(self._now, self._course())
        return rest is not None and bool(np.abs(self._now.foot - rest).max() <= THERE)

    # The next moment.

    def _course(self) -> Course:
        steps = np.full(self.robot.legs, self._settling is None)
        return Course(
            gait=self._doing.manner.gait,
            offsets=self._offsets,
            frequency=self._frequency if self._walking else 0.0,
            twist=self._target,
            posture=self._posture,
            bandwidth=self._bandwidth(self._frequency),
            posture_bandwidth=self._posture_bandwidth(),
            steps=steps,
            rest=self._leg_rest,
        )

    def _posture_bandwidth(self) -> float:
        way = np.abs(self._doing.posture - self._now.posture.value)
        far = max(
            float(way[:3].max()) / _BODY_SPEED,
            float(way[3:6].max()) / _BODY_TURN,
            float(way[LIFT:].max()) / _BODY_SPEED,
        )
        return min(_POSTURE_BANDWIDTH, math.e / max(far, 1e-9))

    def _advance(self, dt: float) -> None:
        """Go on by as much of the tick as the joints' speed and acceleration allow."""
        course = self._course()
        rate = min(1.0, self._rate + _TIME_CHANGE * dt)
        if self._strain > _STRAINED:
            rate = min(rate, self._rate_ahead(course))
        between = (dt + self._last_dt) / 2
        for _ in range(_TRIES):
            tried = rate
            after = go_on(self._now, course, dt * rate)
            angles = self._solve(after)
            turned = (angles - self._angles) / dt
            rate = self._slower(turned, rate, between)
            if rate >= tried:
                break
        self._strain = float((np.abs(turned - self._joint_rate) / self.joint_acceleration).max()) / between
        self._now, self._angles, self._joint_rate = after, angles, turned
        self._rate, self._last_dt = tried, dt

    def _rate_ahead(self, course: Course) -> float:
        """Return at which rate of time the joints keep within their acceleration on the next bit of the way."""
        first = go_on(self._now, course, _AHEAD)
        second = go_on(first, course, _AHEAD)
        bend = np.abs(self._solve(second) - 2 * self._solve(first) + self._angles) / (_AHEAD * _AHEAD)
        return math.sqrt(_CALM / max(float((bend / self.joint_acceleration).max()), _CALM))

    def _slower(self, turned: Floats, rate: float, dt: float) -> float:
        """Return at which rate of time the joints keep within speed and acceleration; `rate` where they do already."""
        change = turned - self._joint_rate
        fastest, reach = _KEPT * self.joint_speed, _KEPT * self.joint_acceleration * dt
        if (np.abs(turned) <= fastest).all() and (np.abs(change) <= reach).all():
            return rate
        size = np.maximum(np.abs(turned), 1e-12)
        was = self._joint_rate * np.sign(turned)
        highest = float((np.minimum(fastest, was + reach) / size).min())
        lowest = float(((was - reach) / size).max())
        share = highest if highest >= lowest else (max(highest, 0.0) + lowest) / 2
        return rate * min(max(share, 0.0) * 0.999, 1.0)

    def _solve(self, now: Moment) -> Floats:
        row = now.posture.value
        stand = stand_of(row, self._rest)
        seen = (now.foot - now.origin) * cmath.exp(-1j * now.yaw)
        height = now.height(stand.lift)
        solution = stand.solve(self.robot, seen.real, seen.imag, height)
        if all_within(self.robot.geometry, solution):
            angles = np.stack(solution[:3], axis=-1)
        else:
            feet = np.stack([seen.real, seen.imag, height], axis=-1)
            found = inverse_kinematics(self.robot, (feet - stand.position) @ stand.rotation)
            angles = np.array(found.angles)
        angles.setflags(write=False)
        return angles

    def _finish(self, was_down: Floats) -> None:
        """See what has come to its end with this tick."""
        if self._settling is not None and self._now.down.all():
            self._switch(*self._settling)
        elif self._settling is None:
            goal = 1 / self._doing.tempo.cycle_time
            if not (self._stepping is None and self._arrived()):
                goal = min(goal, self._frequency)
            if self._frequency != goal:
                step = self._last_dt * self._frequency * self._frequency / 2
                change = min(max(goal - self._frequency, -step), step)
                self._frequency = goal if abs(goal - self._frequency) <= step else self._frequency + change
        landed = self._now.down & ~was_down
        if landed.any():
            self._leg_rest = np.where(landed, self._rest, self._leg_rest)
            landed, self._old_step = landed & ~self._old_step, self._old_step & ~landed
            self._stepped = self._stepped | landed
            self._bounds = np.where(landed[:, None], self._landing_bounds, self._bounds)
        if self._way is not self._doing.there and self._stepping is None and self._arrived():
            self._way = self._doing.there
            self._bounds = self._landing_bounds = self._way.bounds
        if self._walking and self._now.down.all() and not self._target.any() and not self._now.twist.value.any():
            self._walking = not (self._at_rest() and self._settling is None)

    def _arrived(self) -> bool:
        return (
            bool(np.abs(self._now.posture.value - self._doing.posture).max() < _AT_POSTURE) and self._settling is None
        )

    # What there is to see.

    @property
    def mode(self) -> str:
        """``"standing"``, ``"walking"``, or ``"stopping"``: on the way to standing."""
        if not self._walking:
            return "standing"
        return "walking" if self._target.any() else "stopping"

    @property
    def gait(self) -> Gait:
        """Order of the steps."""
        return self._doing.manner.gait

    @property
    def cycle_time(self) -> float:
        """Duration of a cycle [s]."""
        return 1 / self._frequency

    @property
    def place(self) -> tuple[float, float, float]:
        """Where the heading frame is in G: x, y [m], yaw [rad]."""
        return self._now.origin.real, self._now.origin.imag, self._now.yaw

    @property
    def body(self) -> Pose:
        """The body's pose in G."""
        stand = stand_of(self._now.posture.value, self._rest)
        heading = Pose.from_rpy(0.0, 0.0, self._now.yaw, (self._now.origin.real, self._now.origin.imag, 0.0))
        return heading @ Pose(stand.rotation, stand.position)

    @property
    def feet(self) -> Floats:
        """The feet in G ``(legs, 3)`` [m]."""
        now = self._now
        height = now.height(float(now.posture.value[LIFT]))
        return np.stack([now.foot.real, now.foot.imag, height], axis=-1)

    @property
    def contacts(self) -> Floats:
        """Which feet are on the ground ``(legs,)``."""
        return self._now.down.copy()

    @property
    def angles(self) -> Floats:
        """The joint angles ``(legs, 3)`` [rad]."""
        return self._angles

    @property
    def twist(self) -> Floats:
        """The speed now: forward, left [m/s], turning [rad/s]."""
        return self._now.twist.value * self._rate

    @property
    def limited(self) -> tuple[str, ...]:
        """Why the wish is not met in full."""
        return self._limited

    @property
    def margin(self) -> float:
        """Static stability margin [m]."""
        return float(stability_margin(self.robot, self._angles, self.body, self._now.down))

    def top_speed(self, direction: Sequence[float]) -> float:
        """Return the largest multiple of a twist that the robot can walk at for good.

        Parameters
        ----------
        direction : (vx, vy, wz)
            The twist [m/s, m/s, rad/s].
        """
        duty = self.gait.duty
        share, _ = self._doing.there.largest_share(
            np.array(direction, dtype=float), stance_time=duty * self._doing.tempo.cycle_time, duty=duty
        )
        return share
