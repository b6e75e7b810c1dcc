"""The live walker: wishes in, joint angles out, tick by tick, without a jump."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from tarsus.errors import InputError, UnreachableError
from tarsus.gait.gait import Gait
from tarsus.gait.live.admittance import Admittance
from tarsus.gait.live.agenda import Agenda
from tarsus.gait.live.carriage import Carriage
from tarsus.gait.live.change import Change, work_out
from tarsus.gait.live.envelope import Envelope
from tarsus.gait.live.foothold import final_rest
from tarsus.gait.live.footing import Footing
from tarsus.gait.live.governor import allowed_target, excess
from tarsus.gait.live.hands import best_lean, reachable_part
from tarsus.gait.live.lag import Lag
from tarsus.gait.live.levelling import LevellingMode
from tarsus.gait.live.manipulation import Manipulation, legs_out
from tarsus.gait.live.manner import Manner
from tarsus.gait.live.moment import THERE, TIE, Course, Moment
from tarsus.gait.live.own_time import OwnTime
from tarsus.gait.live.parts import Parts, all_parts
from tarsus.gait.live.posture import LIFT, calm_sway
from tarsus.gait.live.retreat import Steepness
from tarsus.gait.live.senses import Senses
from tarsus.gait.live.solver import Solver
from tarsus.gait.live.stances import lift_delays, stances, until_down
from tarsus.gait.live.stand import LEVEL
from tarsus.gait.live.stepping import go_on
from tarsus.gait.live.support import support_sets
from tarsus.gait.live.tempo import joint_limits
from tarsus.gait.live.tilt import Commanded
from tarsus.gait.live.touchdown import meet_ground, unhurried
from tarsus.gait.live.underfoot import Underfoot
from tarsus.gait.live.walker_view import WalkerView
from tarsus.gait.live.wish import Wish
from tarsus.gait.live.wished import swaying
from tarsus.gait.setup import Setup, require_number
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.stability import stability_margin
from tarsus.robot.robot import Robot

__all__ = ["Walker"]

Floats = np.ndarray[Any, Any]

# The twist follows its target within about a stance: faster, and feet that are down would be left behind.
_LAGS_PER_STANCE = 4.0
# Ticks longer than this are walked as if they took no longer [s]: a late tick must not become a jump.
_LONGEST_TICK = 0.05
# In which time a change that waits for room slows the walk down by a factor of e [s].
_PATIENCE = 1.0
_NO_MOTION = (0.0,) * 6
# How far inside their support the feet left must hold the robot when a leg is taken out of the gait [m].
_LEAST_MARGIN = 0.01
# How near to its target a twist counts as steady [m/s, rad/s].
_STEADY = 1e-3


class Walker(WalkerView):
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
    levelling : "level", "follow" or None
        Whether the body stays level on ground that is not, or follows its slope.
    admittance : Admittance, optional
        How the feet give way to the forces on them; left out, they don't.

    Raises
    ------
    InputError
        If an argument is not finite or out of its range, the robot is a batch, or the gait is for another number of
        legs.
    UnreachableError
        If the robot can't stand and step so.
    """

    def __init__(  # noqa: PLR0913 - all that a walk is set up with, all of it optional
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
        levelling: LevellingMode | None = None,
        admittance: Admittance | None = None,
    ) -> None:
        gait = Gait.named(robot.gait.name, legs=robot.legs) if gait is None else gait
        if not math.isfinite(stance_width):
            raise InputError(f"stance_width is {stance_width} m; it must be a finite number")
        for name, value in (
            ("cycle_time", cycle_time),
            ("joint_speed", joint_speed),
            ("joint_acceleration", joint_acceleration),
        ):
            if value is not None:
                require_number(name, value, zero=False)
        setup = Setup.of(robot, gait, clearance=clearance, lift=lift, body_tilt=(0.0, 0.0), foot_distance=foot_distance)
        self.robot = setup.robot
        self.joint_speed, self.joint_acceleration = joint_limits(self.robot, joint_speed, joint_acceleration)
        self._foot_distance = setup.foot_distance
        self._solver = Solver(self.robot)
        manner = Manner(
            gait=gait,
            body=(0.0,) * 6,
            clearance=setup.clearance,
            lift=setup.lift,
            stance_width=stance_width,
            cycle_time=cycle_time,
        )
        change = all_parts(self._work_out(manner, stay=False, at_once=True))
        if isinstance(change, str):
            raise UnreachableError(f"the robot can't walk so: {change}")
        self._begin_standing(change)
        self._underfoot = Underfoot(
            self.robot,
            self.angles,
            self.feet,
            acceleration=self.joint_acceleration,
            levelling=levelling,
            admittance=admittance,
        )

    def _begin_standing(self, change: Change) -> None:
        """Stand in the rest stance, the heading frame over G's origin."""
        legs = self.robot.legs
        self._agenda, self._footing = Agenda(change), Footing(change)
        self._stepping: Change | None = None
        self._settling: tuple[Change, int] | None = None
        self._carriage = Carriage(change.posture)
        self._frequency = 1 / change.tempo.cycle_time
        self._target = np.zeros(3)
        self._patience = 1.0
        self._steep = False
        self._share_of: tuple[Any, ...] = ()
        self._share = (1.0, 0)
        self._hands = Manipulation(self.robot.leg_names)
        self._asked: Wish | None = None
        self._steepness = Steepness()
        self._leaning_for: tuple[int, ...] = ()
        self._lean = 0j
        self._walking = False
        self.time = 0.0
        self._set_gait(change.manner.gait)
        self._all, self._none = np.ones(legs, dtype=bool), np.zeros(legs, dtype=bool)
        self._blind = {"give_way": np.zeros(legs)}
        self._now = Moment.standing(change.rest, self._carriage.goal)
        self._own = OwnTime(self._solver.angles(self._now), self.joint_speed, self.joint_acceleration)

    def _set_gait(self, gait: Gait) -> None:
        self._offsets = np.asarray(gait.offsets)
        self._beats = len(set(gait.offsets))

    def step(self, wish: Wish | Sequence[float], dt: float, *, senses: Senses | None = None) -> Floats:
        """Go on by one tick.

        Parameters
        ----------
        wish : Wish or (vx, vy, wz)
            What is asked for: a twist [m/s, m/s, rad/s] leaves everything else as it is.
        dt : float
            The time since the last tick [s]. Of a tick later than 0.05 s no more than that is walked.
        senses : Senses, optional
            What is measured. Implausible readings are refused and named in `limited`; the walk goes on without them.

        Returns
        -------
        array, shape (legs, 3)
            The next joint angles [rad].

        Raises
        ------
        InputError
            If the wish or the time is not finite, or out of its range. Nothing has changed then.
        UnknownNameError
            If there is no such gait. Nothing has changed then.
        """
        wish = wish if isinstance(wish, Wish) else Wish(twist=wish)
        require_number("dt", dt, zero=False)
        dt = min(float(dt), _LONGEST_TICK)
        self._ask(wish)
        self._sense(senses, dt)
        self._change(dt)
        if self._underfoot.searches:
            self._draw_back(wish)
        self._hands.tell(wish, dt, self._reachable)
        self._aim(wish.twist)
        self._advance(dt)
        self.time += dt
        return self.angles

    def _ask(self, wish: Wish) -> None:
        """Note what is asked for besides the twist, where it isn't what was asked for before."""
        wanted = self._agenda.wanted
        gone = legs_out(wish, wanted.gone, self.robot.legs)
        correction, terrain = self._correction(gone), self._underfoot.terrain
        known = wish.only_twist or wish is self._asked
        if not known or (gone, correction, terrain) != (wanted.gone, wanted.correction, wanted.terrain):
            self._agenda.ask(wish, gone, correction, terrain)
            self._asked = wish

    def _correction(self, gone: tuple[int, ...]) -> tuple[float, ...]:
        """Return what the ground, and legs that don't bear, ask of the body."""
        felt = self._underfoot.felt.correction if self._underfoot.felt else _NO_MOTION
        if not gone:
            return felt
        if gone != self._leaning_for:
            com = centre_of_mass(self.robot, self.angles)
            rest = self._footing.new_rest
            sets = support_sets(self._agenda.wanted.gait, gone)
            self._leaning_for, self._lean = gone, best_lean(rest, complex(com[0], com[1]), sets)
        return (felt[0] + self._lean.real, felt[1] + self._lean.imag, *felt[2:])

    def _sense(self, senses: Senses | None, dt: float) -> None:
        """Take in what is measured, and let feet come to rest that have met the ground early."""
        if senses is None and self._underfoot.numb:
            return
        now, body = self._now, self._agenda.wanted.body
        height = float(now.posture.value[2]) - self._agenda.doing.manner.correction[2]
        self._underfoot.sense(
            senses,
            dt,
            now,
            feet=self.feet,
            contacts=self.contacts,
            angles=self.angles,
            commanded=Commanded(body[3], body[4], now.yaw + body[5], height),
        )
        met = self._underfoot.met(now)
        if met.any():
            swing_rate = self._frequency / now.swings(self.gait.duty)
            self._now = meet_ground(self.robot, now, met, acceleration=self.joint_acceleration, swing_rate=swing_rate)

    def _draw_back(self, wish: Wish) -> None:
        """Let feet that hang over a hole swing once more as soon as something else is asked for."""
        standing = self._own.rate == 0 or self._underfoot.retreats
        if not (standing and self._underfoot.searches.all_in_vain):
            return
        wanted = dataclasses.replace(self._agenda.wanted, correction=_NO_MOTION, terrain=LEVEL)
        again = self._underfoot.draw_back(self._now, (tuple(wish.twist), wanted), self.gait)
        if again is not None:
            # It stands still, whatever it was about to do.
            self._target, self._now = np.zeros(3), again._replace(twist=Lag.still(np.zeros(3)))

    # Changes of how it stands and steps.

    def _work_out(self, manner: Manner, stay: bool, *, at_once: bool = False) -> Parts[Change | str]:
        if manner.gone:
            yield
            sets = support_sets(manner.gait, manner.gone)
            margin = float(stability_margin(self.robot, self.angles, self.body, sets).min())
            if margin < _LEAST_MARGIN:
                names = " and ".join(self.robot.leg_names[leg] for leg in manner.gone)
                return (
                    f"hand: without {names} the {manner.gait.name} would stand {1000 * margin:.0f} mm inside its "
                    f"support; {1000 * _LEAST_MARGIN:.0f} mm is the least. A gait with more feet down may do"
                )
        return (yield from self._posed(manner, stay, at_once=at_once))

    def _posed(self, manner: Manner, stay: bool, *, at_once: bool) -> Parts[Change | str]:
        return work_out(
            self.robot,
            manner,
            None if at_once else self._carriage.posture,
            None if at_once else self._footing.new_rest,
            stay=stay,
            speed=self.joint_speed,
            acceleration=self.joint_acceleration,
            foot_distance=self._foot_distance,
        )

    def _change(self, dt: float) -> None:
        """Work on the next change, and go over to it once the walk allows."""
        agenda, stepping = self._agenda, self._stepping
        agenda.think(self._work_out, free=self._arrived())
        if agenda.ready is not None:
            self._try_change(agenda.ready)
        elif stepping is not None:
            self._try_body(stepping)
        # A change that the walk has no room for slows it down until it has.
        waits = agenda.ready is not None or (self._stepping is not None and bool(self._footing.stepped.all()))
        self._patience = self._patience * math.exp(-dt / _PATIENCE) if waits else 1.0

    def _arrived(self) -> bool:
        """Return whether the last change is over: posture reached, and every leg that came back on the ground."""
        if self._settling is not None or self._stepping is not None:
            return False
        return not self._hands.returning and self._carriage.reached(self._now.posture.value)

    def _try_change(self, change: Change) -> None:
        """Go over to a change as soon as the feet on the ground allow it."""
        old, new = self.gait, change.manner.gait
        # It steps faster only once the change is over.
        frequency = min(self._frequency, 1 / change.tempo.cycle_time)
        leaving = list(set(change.manner.gone) - set(self._agenda.doing.manner.gone))
        share, _ = change.stepping.largest_share(
            self._now.twist.value, stance_time=new.duty / frequency, duty=new.duty, hold=self._underfoot.hold
        )
        if new.duty == old.duty and new.offsets == old.offsets:
            begins, ends = self._stances(frequency)
            bounds = self._hands.without(self._footing.begun(change))
            if leaving:
                bounds = np.minimum(bounds, change.there.bounds)
            if (
                share >= 1
                and self._now.down[leaving].all()
                and self._works(begins, ends, bounds, _bandwidth(new, frequency))
            ):
                self._adopt(change)
        elif not self._walking:
            self._switch(change, 0)
        elif share >= 1:
            self._try_gait(change)

    def _try_gait(self, change: Change) -> None:
        """Let all feet come down, if they may wait so long; then the new order begins with the leg that suits best."""
        frequency = 1 / change.tempo.cycle_time
        delays = lift_delays(change.manner.gait, change.tempo.cycle_time)
        ends = until_down(self._now, self.gait, self._frequency).max() + delays + self._underfoot.hold
        bounds = np.minimum(self._hands.without(self._footing.begun(change)), change.there.bounds)
        bandwidth = _bandwidth(change.manner.gait, frequency)
        over = self._excess(np.zeros(delays.shape), ends, bounds, bandwidth).max(axis=(1, 2, 3, 4))
        first = int(over.argmin())
        if over[first] <= THERE:
            self._settling, self._agenda.ready = (change, first), None
            self._footing.tighten(change.there)

    def _try_body(self, change: Change) -> None:
        """Move the body once every foot has stepped to where it is to rest."""
        gone = list(self._agenda.doing.manner.gone)
        stepped = self._footing.stepped.copy()
        stepped[gone] = True
        begins, ends = self._stances(self._frequency)
        slow = self._frequency <= 1 / change.tempo.cycle_time
        bounds = self._hands.without(change.way.bounds)
        if slow and stepped.all() and self._works(begins, ends, bounds, self._bandwidth()):
            self._footing.tighten(change.way)
            self._carriage.go_to(change.posture)
            self._stepping = None

    def _adopt(self, change: Change) -> None:
        """Send the feet to where they are to rest; the body follows. Legs that leave the gait become hands."""
        self._footing.begin(change, self._now.down)
        self._agenda.adopt(change)
        self._stepping = change
        gone = change.manner.gone
        if gone:
            self._footing.tighten(change.there)
        self._hands.take(gone, self._now)

    def _switch(self, change: Change, first: int) -> None:
        """Begin the new order of steps; every foot is down."""
        self._adopt(change)
        self._settling = None
        self._frequency = 1 / change.tempo.cycle_time
        self._set_gait(change.manner.gait)
        self._begin(first)

    def _begin(self, first: int) -> None:
        """Set the clock to the moment when a leg lifts."""
        clock = float(self._offsets[first]) + self.gait.duty
        self._now = self._now._replace(clock=clock, number=np.ceil(clock - self._offsets - self.gait.duty - TIE))

    def _reachable(self, leg: int, start: Floats, wished: Floats) -> float:
        # Wherever the body sways.
        postures = swaying(self._now.posture.value[: LIFT + 1], self._agenda.doing.manner.sway)
        return reachable_part(self.robot, postures, leg, start, wished)

    # Where to.

    def _bandwidth(self) -> float:
        """Return how fast the twist follows its target; as in the order of steps to come from when it is decided."""
        if self._settling is None:
            return _bandwidth(self.gait, self._frequency)
        change, _ = self._settling
        return _bandwidth(change.manner.gait, 1 / change.tempo.cycle_time)

    def _stances(self, frequency: float) -> tuple[Floats, Floats]:
        """Return from when until when each foot is where it stands, or where it is about to [s]."""
        if self._settling is None:
            return stances(self._now, self.gait, frequency, self._underfoot.hold)
        change, first = self._settling
        begins = until_down(self._now, self.gait, self._frequency)
        delays = lift_delays(change.manner.gait, change.tempo.cycle_time)[first]
        return begins, begins.max() + delays + self._underfoot.hold

    def _excess(self, begins: Floats, ends: Floats, bounds: Floats, bandwidth: float) -> Floats:
        return excess(self._now, self._target[None], begins=begins, ends=ends, bounds=bounds, bandwidth=bandwidth)

    def _bounds(self) -> Floats:
        return self._hands.without(self._footing.bounds)

    def _works(self, begins: Floats, ends: Floats, bounds: Floats, bandwidth: float) -> bool:
        return bool(self._excess(begins, ends, bounds, bandwidth).max() <= THERE)

    def _aim(self, twist: Sequence[float]) -> None:
        """Set the target of the twist: as much of the wish as the legs allow, for good and right now."""
        share, _ = self._largest_share(tuple(twist))
        self._steep = bool(self._agenda.refusals or self._steepness) and self._too_steep(twist)
        if self._underfoot.retreats:
            return
        part = 0.0 if self._steep else min(share, self._patience)
        wish = [part * speed for speed in twist]
        if not self._walking:
            if not any(wish) and self._at_rest():
                return
            self._begin(0)
            self._walking = True
        # In steady walking nothing changes. Before that, feet may be put down where the target leaves them no room.
        if wish == self._target.tolist() and self._steady(wish):
            return
        begins, ends = self._stances(self._frequency)
        self._target = allowed_target(
            self._now,
            self._target,
            np.array(wish),
            begins=begins,
            ends=ends,
            bounds=self._bounds(),
            bandwidth=self._bandwidth(),
        )

    def _too_steep(self, twist: Sequence[float]) -> bool:
        """Return whether a twist leads on to ground that the robot was refused to stand on."""
        agenda, known = self._agenda, self._agenda.doing.terrain
        if any(manner.terrain != known for manner in agenda.refusals):
            self._steepness.refused(known, self._now.twist.value.tolist())
        return self._steepness.forbids(twist, known)

    def _steady(self, twist: Sequence[float]) -> bool:
        """Return whether the robot walks at a twist, and at its pace."""
        settled = self._settling is None and self._frequency == 1 / self._agenda.doing.tempo.cycle_time
        value = self._now.twist.value.tolist()
        return settled and max(abs(a - b) for a, b in zip(value, twist, strict=True)) <= _STEADY * max(map(abs, twist))

    def _largest_share(self, twist: tuple[float, ...]) -> tuple[float, int]:
        """Return how much of a twist works for good in all that is gone over to, and which leg stops it."""
        doing, settling = self._agenda.doing, self._settling[0] if self._settling else None
        hold = self._underfoot.hold
        frequency = min(self._frequency, 1 / doing.tempo.cycle_time)
        key = (twist, frequency, hold, self._footing.way, self._agenda.ready, self._stepping, settling)
        if key == self._share_of:
            return self._share
        asked: list[tuple[Change, Envelope]] = [(doing, self._footing.way)]
        for change in (self._agenda.ready, self._stepping, settling):
            if change is not None:
                asked.append((change, change.way))
        share, leg = 1.0, 0
        for change, way in asked:
            duty = change.manner.gait.duty
            stance_time = duty * max(1 / frequency, change.tempo.cycle_time)
            allowed, which = way.largest_share(np.array(twist), stance_time=stance_time, duty=duty, hold=hold)
            if allowed < share:
                share, leg = allowed, which
        self._share_of, self._share = key, (share, leg)
        return share, leg

    @property
    def limited(self) -> tuple[str, ...]:
        """Why the wish is not met in full."""
        share, leg = self._share
        reasons = [
            *self._agenda.doing.limited,
            *self._agenda.refusals.values(),
            *self._hands.limited,
        ]
        if share < 1:
            cycle = self._agenda.doing.tempo.cycle_time
            name = self.robot.leg_names[leg]
            reasons.append(f"twist: {100 * share:.0f} % of it; {name} gets no farther at {cycle:.2f} s a cycle")
        if self._steep:
            reasons.append("twist: the ground gets too steep that way for the robot as it stands")
        sway = self._agenda.doing.manner.sway
        calm = calm_sway(np.array(sway), self._frequency, self._beats) if any(sway) else 1.0
        if calm < 1:
            reasons.append(
                f"sway: {100 * calm:.0f} % of it; the joints allow no more at {self.cycle_time:.2f} s a cycle"
            )
        if self._underfoot.felt is not None:
            reasons += self._underfoot.felt.refused
        for missing in self._underfoot.searches.in_vain:
            reasons.append(f"no ground under {self.robot.leg_names[missing]}: the robot holds still")
        return tuple(reasons)

    def _at_rest(self) -> bool:
        """Return whether every foot that steps is at its rest foothold."""
        rest = final_rest(self._now, self._course())
        assert rest is not None  # nobody asks while it is fast
        off = np.abs(self._now.foot - rest)
        off[list(self._agenda.doing.manner.gone)] = 0.0
        return bool(off.max() <= THERE)

    # The next moment.

    def _course(self, dt: float = 0.0) -> Course:
        now = self._now
        steps, lands, holds = self._all, self._all, self._settling is not None
        if self._hands:
            steps = steps.copy()
            steps[list(self._agenda.doing.manner.gone)] = False
        felt = self._underfoot.felt is not None
        if felt:
            soon = now.share + dt * self._frequency / now.swings(self.gait.duty) >= 1.0 - TIE
            lands, waits = self._underfoot.lands(now, soon)
            holds = holds or waits
        return Course(
            gait=self.gait,
            frequency=self._frequency if self._walking else 0.0,
            twist=self._target,
            posture=self._carriage.goal,
            bandwidth=self._bandwidth(),
            posture_bandwidth=self._carriage.bandwidth(now.posture.value),
            steps=steps,
            lands=lands,
            rest=self._footing.rest,
            room=self._footing.room,
            holds=holds,
            beats=self._beats,
            sways=self._carriage.sways(now.posture.value),
            **(self._underfoot.course(now, self._agenda.doing.terrain) if felt else self._blind),
        )

    def _advance(self, dt: float) -> None:
        """Go on by one tick, or less of it where the joints need longer."""
        sway = self._agenda.doing.manner.sway if self._walking else _NO_MOTION
        self._carriage.sway(sway, frequency=self._frequency, beats=self._beats)
        before, course, underfoot = self._now, self._course(dt), self._underfoot
        self._now = underfoot.search(
            before,
            dt,
            terrain=self._agenda.doing.terrain,
            stance_time=self.gait.duty / self._frequency,
        )
        swing_time = (1 - self.gait.duty) / self._frequency

        def move(time: float) -> Moment:
            return self._hands.carry(go_on(self._now, course, time), time, swing_time=swing_time)

        fastest = 1.0 if underfoot.felt is None else unhurried(self._now, self.gait.duty)
        self._now = self._own.advance(move, self._solver.angles, dt, stop=underfoot.stops, fastest=fastest)
        self._hands.step(dt * self._own.rate, self._now.down)
        self._finish(before, dt)

    def _finish(self, before: Moment, dt: float) -> None:
        """See what has come to its end with this tick."""
        now, doing = self._now, self._agenda.doing
        landed = now.down & ~before.down if now.down is not before.down else self._none
        if landed.any():
            self._footing.land(landed)
            self._underfoot.land(landed)
        arrived = self._arrived()
        if self._settling is not None and now.down.all():
            self._switch(*self._settling)
        elif self._settling is None:
            self._change_pace(dt, faster=arrived)
        if arrived and self._footing.way is not doing.there:
            self._footing.arrive(doing.there)
        moves = any(self._target.tolist()) or any(now.twist.value.tolist())
        if self._walking and not moves and now.down.all():
            self._walking = not (self._at_rest() and self._settling is None)

    def _change_pace(self, dt: float, *, faster: bool) -> None:
        """Step a little faster or slower, until the cycle takes as long as it is to."""
        goal, now = 1 / self._agenda.doing.tempo.cycle_time, self._frequency
        goal = goal if faster else min(goal, now)
        step = dt * now * now / 2
        self._frequency = goal if abs(goal - now) <= step else now + math.copysign(step, goal - now)


def _bandwidth(gait: Gait, frequency: float) -> float:
    """Return how fast the twist may follow its target [rad/s]."""
    return _LAGS_PER_STANCE * frequency / gait.duty
