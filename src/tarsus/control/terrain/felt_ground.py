"""Felt ground: what a walk does with readings, tick by tick, all of it relative to the body."""

from __future__ import annotations

import cmath
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.pose.admittance import Admittance
from tarsus.control.readings import SensorReadings, ValidReadings
from tarsus.control.sensing.body_condition import BodyCondition
from tarsus.control.sensing.foot_loads import FootLoads
from tarsus.control.sensing.leg_odometry import LegOdometry
from tarsus.control.sensing.validation import ReadingsValidator
from tarsus.control.terrain.foot_contacts import FootContacts
from tarsus.control.terrain.ground_contact import met_ground
from tarsus.control.terrain.ground_map import GroundMap
from tarsus.control.terrain.missing_ground import MissingGround, searching_feet
from tarsus.control.terrain.posture_feedback import Levelling, PostureFeedback, PostureRates
from tarsus.control.terrain.reach import Reach, reachable_share
from tarsus.control.terrain.roughness import GroundAdaptation, Roughness
from tarsus.control.terrain.slope_limit import SlopeLimit
from tarsus.control.terrain.slope_stance import SlopeStance
from tarsus.control.terrain.support import Support
from tarsus.control.transition.foothold_transfer import FootholdTransfer
from tarsus.control.walk.felt_feet import FeltFoot, FeltInputs, GroundUnder
from tarsus.control.walk.ground_pose import body_posture
from tarsus.control.walk.state import PHASE_TOLERANCE, GaitState
from tarsus.control.walk.step_timing import StepTiming
from tarsus.control.workspace.stance_geometry import SWING_HEIGHT
from tarsus.kinematics.mass import centre_of_mass
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Complex, Float

__all__ = ["FeltGround"]

# How far below the expected ground feet go by the end of their swing, over the roughness.
_DEPTH_SHARE = 0.6
# Fraction of the swing in which a foot travels, up to half the longest stroke and with the longest one.
_SLOW_TRAVEL, _FAST_TRAVEL = 0.75, 0.92
# How often height, tilt and lost way are looked at [s].
_SLOW_PERIOD = 0.03 - PHASE_TOLERANCE


class FeltGround:
    """Estimates contacts and tilt from readings, and decides what the feet and the body do about them.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Joint angles in the initial stance [rad].
    levelling : "level", "between", "follow" or None
        The attitude to keep on slopes; None for no use of the measured attitude.
    adaptation : GroundAdaptation
        How far swing height and body height may adapt.
    admittance : Admittance, optional
        Compliance of the feet; left out, they are stiff.

    Attributes
    ----------
    contacts, missing : FootContacts, MissingGround
        Which feet bear load; what is done where feet find no ground.
    posture, roughness : PostureFeedback, Roughness
        Height and tilt of the body; how uneven the ground is.
    condition, support : BodyCondition, Support
        Whether the robot is in the air or has fallen; whether feet may lift off, and at which pace the walk goes on.
    slope, ground : SlopeLimit, GroundMap
        Whether the slope is too slippery; what is known of the ground around the robot.
    lowered : float
        How much lower loaded feet are commanded than they stand [m].
    offsets : array, shape (legs,), or None
        Upward offsets of compliant feet [m]; None of stiff ones.
    """

    def __init__(
        self,
        robot: Robot,
        angles: Float[np.ndarray, "legs 3"],
        *,
        levelling: Levelling | None,
        adaptation: GroundAdaptation,
        admittance: Admittance | None,
    ) -> None:
        self.contacts, self.support, self.condition = FootContacts(robot.legs), Support(), BodyCondition()
        self.posture, self.roughness = PostureFeedback(levelling), Roughness(adaptation)
        self.slope, self.ground = SlopeLimit(adaptation.friction), GroundMap()
        self.offsets: Float[np.ndarray, "legs"] | None = None
        self._reach, self.stance, self.missing = Reach(robot), SlopeStance(robot), MissingGround(robot.leg_names)
        self._validator, self._loads = ReadingsValidator(robot), FootLoads(robot, admittance)
        self._centre, self.lowered = complex(*centre_of_mass(robot, angles)[:2].tolist()), 0.0
        self.odometry, self.measured = LegOdometry(robot), ValidReadings()
        self._tilt: tuple[float, float] | None = None
        # What feet are given while all is as planned; ticks and times since contacts and support were looked at.
        self._inputs: FeltInputs | None = None
        self._given, self._ticks, self._unread, self._idle = (list[int](), True), 0, 0.0, 0.0
        self._since, self._drift, self._rates = _SLOW_PERIOD, 0j, PostureRates(0.0, (0.0, 0.0))

    def sense(
        self,
        readings: SensorReadings | None,
        dt: float,
        state: GaitState,
        *,
        timing: StepTiming,
        angles: Float[np.ndarray, "legs 3"],
    ) -> tuple[GaitState, list[int]]:
        """Return the gait state after the readings of a tick, and the legs whose feet have landed by them.

        Parameters
        ----------
        readings : SensorReadings or None
            The readings.
        dt : float
            Time since the last tick [s].
        state : GaitState
            The gait state.
        timing : StepTiming
            The gait and its frequency.
        angles : array, shape (legs, 3)
            Joint angles [rad].
        """
        valid = self.measured = self._validator.validate(readings, dt)
        down = state.down.tolist()
        doubted = [leg for leg in range(len(down)) if self.contacts.is_open(leg)]
        measured = self._loads.contacts(valid, angles, dt, down=state.down, phase=state.swing_phase, doubted=doubted)
        if state.felt is None:
            if measured is None and valid.attitude is None:
                return state, []
            heights = np.array(state.heights(float(state.posture.value[SWING_HEIGHT])))
            state = state._replace(ground_height=heights, felt=[FeltFoot()] * len(heights))
        self._since, self._unread, self._ticks = self._since + dt, self._unread + dt, self._ticks + 1
        if self._inputs is not None and self._since < _SLOW_PERIOD and self.contacts.as_planned(measured, down):
            return state, []
        if valid.attitude is not None:
            roll, pitch = state.posture.value[3:5].tolist()
            self._tilt = (valid.attitude[0] - roll, valid.attitude[1] - pitch)
        dt, ticks, self._unread, self._ticks, self._inputs = self._unread, self._ticks, 0.0, 0, None
        self.ground.see(valid, state)
        self.contacts.step(measured, down, dt, age=valid.contact_age, count=ticks)
        self.condition.step([self.contacts.touches(leg) for leg in range(len(down))], valid.attitude, dt)
        if self._loads.compliant:
            forces, feet = self._loads.forces(valid, angles), [(foot.real, foot.imag) for foot in state.foot.tolist()]
            self.offsets = self._loads.offsets(forces, dt, feet=feet, stands=down)
        highest, pace = self._reach.highest, self.support.pace
        return met_ground(state, self.contacts, self.ground, self.roughness, highest=highest, timing=timing, pace=pace)

    def inputs(
        self,
        state: GaitState,
        dt: float,
        *,
        timing: StepTiming,
        twist: Float[np.ndarray, "3"],
        footholds: FootholdTransfer,
        excluded: list[int],
        standing: bool,
    ) -> FeltInputs:
        """Return what the feet and the body do in a tick.

        Parameters
        ----------
        state : GaitState
            The gait state.
        dt : float
            Length of the tick [s].
        timing : StepTiming
            The gait and its frequency.
        twist : array, shape (3,)
            The twist that is followed.
        footholds : FootholdTransfer
            Rest footholds, and how far from them feet may be put down.
        excluded : list of int
            Legs that bear no load.
        standing : bool
            Whether the robot stands.
        """
        due = None if standing else timing.due(state, dt)
        kept, before, self._idle = self._inputs, self._given, self._idle + dt
        self._given = excluded, standing
        if kept is not None and not (due and any(due)) and self._given == before:
            return kept
        steps = [leg not in excluded for leg in range(len(state.foot))]
        dt, elevation, self._idle = self._idle, float(state.elevation.value[0]), 0.0
        turn, contacts, missing = cmath.exp(-1j * state.yaw), self.contacts, self.missing
        places = [(foot - state.origin) * turn for foot in state.foot.tolist()]
        down = [on and step for on, step in zip(state.down.tolist(), steps, strict=True)]
        if self._since >= _SLOW_PERIOD:
            self._update_posture(state, places, down, timing=timing, twist=twist, rest=footholds.rest)
            self.ground.choose(state, self._reach, footholds)
        in_air, under = self.condition.in_air, list[GroundUnder | None]()
        centre = self._centre + complex(*body_posture(state)[:2].tolist())
        contacts.find_open(down, places, centre, self.measured.attitude, dt)
        stands = [
            (in_air or on) and not missing.steps_back(leg, places[leg]) for leg, on in enumerate(contacts.standing)
        ]
        seeking = searching_feet(state, contacts, self.ground, places, down=down, stands=stands)
        rest, radii, bears = footholds.rest.tolist(), footholds.placement_radii, np.logical_and(down, stands).tolist()
        sizes = {"height": float(state.posture.value[2]), "roughness": self.roughness.value}
        missing.step(seeking, places, bears, dt, centre=centre, rest=rest, radii=radii, **sizes)
        self._decide_on_support(places, down, due, centre, dt=dt, swing_time=timing.swing_time)
        self.roughness.decay(0.0 if standing else dt * timing.frequency)
        for leg, foothold in enumerate(state.foothold.tolist()):
            if not steps[leg] or (down[leg] and stands[leg] and not (due and due[leg])):
                under.append(None)
                continue
            known = contacts.is_known(leg) and (down[leg] or contacts.lifted[leg])
            searches = known and not (in_air or missing.gives_up(leg))
            room = (self._reach.lowest[leg] if searches else None, self._reach.highest[leg])
            goal = places[leg] if down[leg] else (foothold - state.origin) * turn
            found = self.ground.under(places[leg], goal, elevation, room)
            back = leg in missing.places
            under.append(found._replace(place=state.origin + missing.places[leg] / turn) if back else found)
        far = 2 * self._reach.stroke / max(*footholds.placement_radii, 1e-6) - 1
        inputs = FeltInputs(
            under,
            stands,
            steps,
            depth=_DEPTH_SHARE * self.roughness.value,
            climb=self._rates.climb,
            turn=self._rates.turn,
            drift=self._drift,
            back=missing.back,
            travel=_SLOW_TRAVEL + (_FAST_TRAVEL - _SLOW_TRAVEL) * max(far, 0.0),
            pace=self.support.pace,
            swing_height=float(state.posture.value[SWING_HEIGHT]) + self.roughness.swing_rise,
            lowering=self._loads.fastest_descent,
            beside=self.ground.beside,
        )
        # As long as all is as planned, it stays: yielding feet and a walk that slows down are looked at in each tick.
        self._inputs = None if self._loads.compliant or self.support.pace < 1.0 else inputs
        return inputs

    def _update_posture(
        self,
        state: GaitState,
        places: list[complex],
        down: list[bool],
        *,
        timing: StepTiming,
        twist: Float[np.ndarray, "3"],
        rest: Complex[np.ndarray, "legs"],
    ) -> None:
        """Update plane, reach, and how the body is to move over the standing feet: not needed in each tick."""
        legs, contacts, reach, dt, self._since = range(len(rest)), self.contacts, self._reach, self._since, 0.0
        over = (state.ground_height - state.elevation.value).tolist()
        bears = [leg for leg in legs if down[leg] and contacts.touches(leg)]
        self.ground.step([(places[leg], over[leg]) for leg in bears], self._tilt, state, dt, drift=self._drift)
        plane, velocity = self.ground.plane, complex(*state.twist.value[:2].tolist()) * self.support.pace
        reach.update(state.posture.value, rest, twist, timing.stance_time)
        seeking = [down[leg] and contacts.seeks(leg) for leg in legs]
        stands = [on or not should for on, should in zip(contacts.standing, down, strict=True)]
        rises = self.ground.rises(
            reach.rises(plane, rest, over, bears=bears, seeking=seeking), rest, reach.strokes, looks=all(stands)
        )
        level = plane.levelled(self._tilt)
        _, _, height, _, _, yaw, swing_height = state.posture.value[: SWING_HEIGHT + 1].tolist()
        if self._tilt is not None:
            self.slope.step(level, complex(*twist[:2].tolist()))
            self.stance.step(level, rest - self.stance.shift)
        lowest, highest = [low + self.lowered for low in reach.lowest], reach.highest_stand(swing_height)
        share = reachable_share([level.at(foot) for foot in rest.tolist()], reach.lowest, highest)
        wanted = max(self.roughness.body_rise, self.ground.body_rise(self.stance.half, height))
        raises = (self.stance.least_raise(plane, height), wanted)
        self.posture.fit_to_reach(rises, raises, dt, reach=(lowest, highest), height=height, share=share)
        measured, tilt = self.measured.joint_angles, self.measured.attitude or (0.0, 0.0)
        drift = self.odometry.step(measured, bears, velocity, dt, tilt=tilt, yaw=yaw)
        self._drift = self.stance.not_downhill(drift)
        margins = [(places[leg], over[leg] - lowest[leg]) for leg in bears]
        self._rates = self.posture.rates(plane, self._tilt, velocity, feet=margins)

    def _decide_on_support(
        self, places: list[complex], down: list[bool], due: list[bool] | None, centre: complex, **time: float
    ) -> None:
        """Decide whether feet may lift off, and at which pace the walk goes on; None is due while the robot stands."""
        bears = [self.contacts.supports(leg) and leg not in self.missing.places for leg in range(len(down))]
        legs = [leg for leg, on in enumerate(down) if on and not (due and due[leg]) and bears[leg]]
        stays = self.support.holds(legs, places, centre, anew=not self._since)
        lifts, fallen = any(due or ()), self.condition.fallen
        held = due is None or (stays and not (lifts and (self.slope.refuses or self.missing.refuses)))
        self.support.step(stays=held and not fallen, lifts=lifts and not fallen, most=self.missing.pace, **time)

    @property
    def limitations(self) -> tuple[Limitation, ...]:
        """Readings that are rejected, and what the ground does not allow."""
        found = [Limitation(kind=LimitationKind.READINGS, cause=reason) for reason in self.measured.rejected]
        if self.posture.given_way > 0.0:
            found.append(Limitation(kind=LimitationKind.ATTITUDE, cause="end of the legs' reach on this slope"))
        found += self.condition.limitations + self.odometry.limitations
        if self.support.halts and not (self.condition.in_air or self.missing.refuses):
            reason = self.slope.reason if self.slope.refuses else "the feet on the ground do not hold the robot"
            found.append(Limitation(kind=LimitationKind.GROUND, cause=reason))
        return tuple(found)
