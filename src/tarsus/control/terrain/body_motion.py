"""Body motion over felt ground: height, tilt, slope and lost way, all looked at less often than in each tick."""

from __future__ import annotations

import cmath
import math

from tarsus.control.contact.foot_contacts import FootContacts
from tarsus.control.contact.footing import Footing, off_commanded, sunk_at
from tarsus.control.contact.tipping import Sinking
from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.limiter.slope_limit import SlopeLimit
from tarsus.control.limiter.stopped_body import StoppedBody
from tarsus.control.pose.heading_feedback import HeadingFeedback
from tarsus.control.pose.posture_feedback import BodyMove, Levelling, PostureFeedback, PostureRates
from tarsus.control.pose.slope_stance import SlopeStance
from tarsus.control.readings import RollPitch, ValidReadings, Vector
from tarsus.control.sensing.leg_odometry import CommandedMotion, LegOdometry
from tarsus.control.terrain.foothold_choice import FootholdChoice
from tarsus.control.terrain.ground_map import GroundMap
from tarsus.control.terrain.reach import Reach
from tarsus.control.terrain.roughness import GroundAdaptation, Roughness
from tarsus.control.transition.executor import TransitionExecutor
from tarsus.control.walk.state import ROUNDING, GaitState
from tarsus.control.walk_state import TickState
from tarsus.gait.stance.reachable_heights import reachable_share
from tarsus.gait.stance.stance_geometry import SWING_HEIGHT
from tarsus.robot.robot import Robot

__all__ = ["BodyMotion"]

# Period of the looks at height, tilt and lost way [s].
_PERIOD = 0.04 - ROUNDING
# Time without a measured attitude after which the body counts as level, and after which its tilt is unknown [s].
_HOLDS, _TIMEOUT = 0.15, 2.0
# Change of the tilt above which the body's rates are decided again between two looks [rad].
_TURNED = math.radians(0.1)
# How much lower the next footholds may be than the felt ground, over the roughness.
_LOWER = 0.5
# More loaded feet than this hold the robot without any one of them.
_FEW = 4


class BodyMotion:
    """Decides how the body moves over its standing feet, to its height and attitude and to where it should be.

    Parameters
    ----------
    robot : Robot
        A single robot.
    levelling : "level", "between", "follow" or None
        The attitude to keep on slopes; None for no use of the measured attitude.
    adaptation : GroundAdaptation
        How far the walk may adapt.

    Attributes
    ----------
    contacts, ground, choice : FootContacts, GroundMap, FootholdChoice
        Which feet bear load; where the ground is; where feet are put down on ground that is known.
    rates, drift : PostureRates, complex
        How the body is to move; velocity of the feet that makes up for lost way, in the heading frame [m/s].
    heading : HeadingFeedback
        How the body turns back to its heading.
    reach, roughness : Reach, Roughness
        The heights between which legs reach their strokes; how uneven the ground is.
    slope, stance : SlopeLimit, SlopeStance
        Whether the slope is too steep; rest footholds on it.
    stopped : StoppedBody
        Whether an obstacle stops the body.
    tilt : (roll, pitch) or None
        By how much the body is tilted more than commanded [rad]; None where its attitude is unknown.
    lowered : float
        How much lower loaded feet are commanded than they stand [m].
    since : float
        Time since the last look at height, tilt and lost way [s].
    measured, commanded : ValidReadings, list of (coxa, femur, tibia)
        What is measured in this tick; the joint angles of each leg commanded in the last one [rad].
    """

    def __init__(self, robot: Robot, *, levelling: Levelling | None, adaptation: GroundAdaptation) -> None:
        self.reach, self.odometry = Reach(robot), LegOdometry(robot)
        scale = self.reach.scale
        self.contacts, self.ground = FootContacts(robot.legs, scale=scale), GroundMap(scale=scale)
        self.choice = FootholdChoice(self.ground)
        self._posture, self.roughness = PostureFeedback(levelling, scale=scale), Roughness(adaptation, scale=scale)
        self.slope, self.stance = SlopeLimit(adaptation.friction), SlopeStance(robot, scale=scale)
        self.stopped = StoppedBody(robot)
        self.rates, self.drift, self.lowered = PostureRates(), 0j, 0.0
        self.tilt: RollPitch | None = None
        self.measured, self.commanded = ValidReadings(), list[Vector]()
        self.heading, self._sinking = HeadingFeedback(), Sinking(scale)
        # What the body did at the last look, until a newer attitude is used.
        self._move: BodyMove | None = None
        self.since, self._unmeasured = _PERIOD, 0.0
        # Of the last look: place of the body in G, heading, and yaw of the body in the heading frame.
        self._before: tuple[complex, float, float] | None = None

    def see(self, state: GaitState, dt: float) -> None:
        """Take the measured attitude.

        Where there is none, the last one holds for a moment; then the body counts as level, as stepping feet would turn
        it on and on by an old tilt.

        Parameters
        ----------
        state, dt : GaitState, float
            The gait state; time since the last call [s].
        """
        self._unmeasured += dt
        if self.measured.attitude is not None:
            self.tilt, self._unmeasured = off_commanded(self.measured.attitude, state), 0.0
        elif self.tilt is not None and self._unmeasured > _HOLDS:
            self.tilt = (0.0, 0.0) if self._unmeasured <= _TIMEOUT else None

    def level(self, state: GaitState) -> None:
        """Turn by the newest attitude once between two looks: feet that take over load tilt the body within that time.

        Parameters
        ----------
        state : GaitState
            The gait state.
        """
        if self.measured.attitude is not None and self._move is not None and _PERIOD / 2 <= self.since < _PERIOD:
            before = self.tilt or (math.inf, math.inf)
            self.see(state, 0.0)
            if math.dist(before, self.tilt or before) > _TURNED:
                self.rates = self._posture.rates(self.ground.plane, self.tilt, self._move)
            self._move = None

    @property
    def off(self) -> RollPitch:
        """By how much the body is off the attitude to keep, roll and pitch [rad]; 0 where that follows the feet."""
        roll, pitch = self.tilt or (0.0, 0.0)
        return self._posture.kept * roll, self._posture.kept * pitch

    @property
    def looks(self) -> bool:
        """Whether height, tilt and lost way are looked at in this tick."""
        return self.since >= _PERIOD

    @property
    def limitations(self) -> list[Limitation]:
        """What the ground does not allow."""
        short = [Limitation(kind=LimitationKind.ATTITUDE, cause="end of the legs' reach on this ground")]
        return (short if self._posture.given_way > 1 - self._posture.kept else []) + self.odometry.limitations

    def step(self, tick: TickState, footing: Footing, transitions: TransitionExecutor, *, pace: float) -> None:
        """Look at plane, reach and lost way, and decide how the body is to move.

        Parameters
        ----------
        tick, footing : TickState, Footing
            The gait state and the twist that is followed; the feet that should stand.
        transitions, pace : TransitionExecutor, float
            Timing and rest footholds; rate of the steps and the twist, 0 to 1.
        """
        state, places, dt, self.since = tick.gait, footing.places, self.since, 0.0
        rest, rests = transitions.footholds.rest, not tick.twist.any()
        over = (state.ground_height - state.elevation).tolist()
        bears = [leg for leg, on in enumerate(footing.down) if on and self.contacts.touches(leg)]
        self.reach.update(tick, rest, transitions.timing.stance_time)
        velocity = complex(*state.twist.value[:2].tolist()) * pace
        commanded, turning = self._commanded(state, velocity, dt)
        if not bears:
            self.rates, self.drift, self._move = PostureRates(), 0j, None
            self.heading.forget()
            self.odometry.forget()
            return
        feet, back = [(places[leg], over[leg]) for leg in bears], self.heading.rate
        self.ground.step(feet, self.tilt, state, dt, drift=self.drift, turning=back)
        level = self.ground.plane.levelled(self.tilt)
        # Without an attitude, the way back from a refused motion stays open, too.
        if self.tilt is not None or self.slope.refused:
            self.slope.step(level, complex(*tick.twist[:2].tolist()), dt, off=math.hypot(*self.off))
        if self.tilt is not None:
            self.stance.step(level, rest - self.stance.shift, self.roughness.drawn_in, dt, walks=not rests)
        self._fit_height(state, over, footing.down, bears, dt)
        still = tick.standing and not (state.shift.rate.any() or state.posture.rate.any() or state.twist.value.any())
        self.heading.step(self.measured, turning, dt, rests=rests, still=still)
        self.drift = self.stance.not_downhill(self.odometry.step(self.measured, bears, commanded, dt))
        self.stopped.step(self.measured, bears, velocity, dt, yaw=commanded.yaw)
        margins = [(places[leg], over[leg] - (self.reach.lowest[leg] + self.lowered)) for leg in bears]
        self._move = BodyMove(velocity, margins, self.slope.refuses or rests, pace)
        self.rates = self._posture.rates(self.ground.plane, self.tilt, self._move)

    def tracking_error(self, state: GaitState, leg: int) -> complex:
        """Return how far a foot is from where it is commanded, horizontally in G; 0 where that is not measured [m].

        Parameters
        ----------
        state, leg : GaitState, int
            The gait state; the leg.
        """
        off = self.odometry.feet_off_commanded([leg], self.measured, self.commanded)
        yaw = state.yaw + float(state.moved_posture[5])
        return complex(*off[leg][:2]) * cmath.exp(1j * yaw) if off else 0j

    def sinks_at(self, state: GaitState, footing: Footing, dt: float) -> int | None:
        """Return the leg of a foot that bears load and sinks, where the heights of all such feet are measured; or None.

        Parameters
        ----------
        state, footing, dt : GaitState, Footing, float
            The gait state; the feet; time since the last call [s].
        """
        heights, valid = dict[int, float](), self.measured
        bears = [leg for leg, on in enumerate(footing.down) if on and self.contacts.touches(leg)]
        off = self.odometry.feet_off_commanded(bears if len(bears) <= _FEW else [], valid, self.commanded)
        if valid.attitude is not None and len(off) == len(bears) and valid.predicted.isdisjoint(bears):
            tilt, over = off_commanded(valid.attitude, state), state.ground_height.tolist()
            for leg, (x, y, z) in off.items():
                heights[leg] = over[leg] + z - sunk_at(footing.places[leg] + complex(x, y), tilt)
        return self._sinking.step(heights, footing, dt, deeper=self.roughness.deeper)

    def _commanded(self, state: GaitState, velocity: complex, dt: float) -> tuple[CommandedMotion, float]:
        """Return how the body was to move since the last look, and how fast it was to turn [rad/s]."""
        x, y, _, _, _, yaw, _ = state.moved_posture.tolist()
        at, heading = complex(x, y), cmath.exp(1j * state.yaw)
        now = state.origin + heading * at, state.yaw, yaw
        (body, direction, yaw_before), self._before = self._before or now, now
        turned, back = state.yaw - direction, self.heading.rate * dt
        # The way in the heading frame at half of its turn; that of a body beside the point about which it turns back.
        moved = (now[0] - body) / heading * cmath.exp(0.5j * turned) + 1j * back * at
        return CommandedMotion(velocity, moved, turned + back, yaw), (turned + yaw - yaw_before) / dt

    def _fit_height(self, state: GaitState, over: list[float], down: list[bool], bears: list[int], dt: float) -> None:
        """Change the height of the body towards one at which all legs reach the ground."""
        contacts, reach, plane = self.contacts, self.reach, self.ground.plane
        hanging = [leg for leg, on in enumerate(down) if on and contacts.seeks(leg) and reach.hangs(leg, over[leg])]
        looks_ahead = self.ground.given and all(contacts.stands(leg) for leg, on in enumerate(down) if on)
        now = reach.rises(plane, over, bears=bears, hanging=hanging)
        lower = 0.0 if self.ground.given else _LOWER * self.roughness.value
        here = [rise - lower for rise in now], now
        rises = [self.ground.rises_ahead(reach), here] if looks_ahead else [here]
        height, swing_height = state.posture.value[[2, SWING_HEIGHT]].tolist()
        level = plane.levelled(self.tilt)
        highest = reach.highest_stand(swing_height, hangs=bool(hanging))
        # The underside of the body limits the slope like a foot that may be at any depth.
        rise, clearance = self.stance.underside(level, height)
        slope = [*map(level.at, reach.rest.tolist()), rise]
        share = reachable_share(slope, [*reach.lowest, -math.inf], [*highest, clearance])
        wanted = max(self.roughness.body_rise, self.ground.body_rise(self.stance.half, height))
        rise, clearance = self.stance.underside(plane, height)
        raises = (rise - clearance, wanted)
        reached = [low + self.lowered for low in reach.lowest], highest
        self._posture.fit_to_reach(rises, raises, dt, reach=reached, height=height, share=share)
