"""Felt ground: what a walk does with readings, tick by tick, all of it relative to the body."""

from __future__ import annotations

import cmath
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.contact.footing import Footing, along_gravity, sunk_at
from tarsus.control.contact.support import Support
from tarsus.control.felt.ground_search import GroundSearch, supporting
from tarsus.control.felt.landing import met_ground, put_down
from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.readings import SensorReadings, Vector
from tarsus.control.search.missing_ground import SLOW, MissingGround
from tarsus.control.sensing.body_condition import BodyCondition
from tarsus.control.sensing.continued_readings import ContinuedReadings
from tarsus.control.sensing.foot_loads import FootLoads
from tarsus.control.sensing.swing_monitor import USUAL_LAG, SwingMonitor
from tarsus.control.sensing.validation import rejections
from tarsus.control.terrain.body_motion import BodyMotion
from tarsus.control.transition.executor import TransitionExecutor
from tarsus.control.walk.felt_feet import FeltFoot, FeltInputs, GroundUnder, travel_share
from tarsus.control.walk.state import GaitState
from tarsus.control.walk.step_timing import StepTiming
from tarsus.control.walk_state import TickState
from tarsus.gait.stance.stance_geometry import SWING_HEIGHT
from tarsus.kinematics.mass import centre_of_mass
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["FeltGround"]

# How far below the expected ground swings aim, over the roughness; such a depth from which ground is fully rough [m].
_DEPTH_SHARE, _ROUGH = 0.6, 0.006
# Feet that have stood are no longer lowered this long before they lift off [s].
_LEAVING = 0.1
# How surely a robot is put down on feet that hold it with those that are due to lift off, but not without them.
_ALL_HOLD = 0.3
# Greatest speed of feet that go down; the same where contacts are estimated, as feet then press on the ground before
# they are known to touch it [m/s].
_DESCENT, _ESTIMATED_DESCENT = 0.4, 0.25
# Feet that search while others hold a standing robot: greatest speed [m/s], depth below the expected ground [m].
_GENTLE, _NEAR = 0.02, 0.004


class FeltGround:
    """Estimates contacts and tilt from readings, and decides what the feet and the body do about them.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Joint angles in the initial stance [rad].
    body, loads : BodyMotion, FootLoads
        How the body moves over its standing feet; contacts and loads of the feet, and how they yield.

    Attributes
    ----------
    contacts, ground : FootContacts, GroundMap
        Which feet bear load; where the ground is.
    body, missing : BodyMotion, MissingGround
        How the body moves over its standing feet; what is done where feet find no ground.
    condition, support : BodyCondition, Support
        Whether the robot is in the air or has fallen; whether feet may lift off, and at which pace the walk goes on.
    readings : ContinuedReadings
        The readings that were given last.
    offsets : array, shape (legs,), or None
        Upward offsets of compliant feet [m]; None for stiff ones.
    """

    def __init__(
        self, robot: Robot, angles: Float[np.ndarray, "legs 3"], *, body: BodyMotion, loads: FootLoads
    ) -> None:
        self.body, self.contacts, self.ground = body, body.contacts, body.ground
        self.missing = MissingGround(robot.leg_names, scale=body.reach.scale)
        self.support, self.condition, self._swings = Support(), BodyCondition(), SwingMonitor()
        self.offsets: Float[np.ndarray, "legs"] | None = None
        self.readings, self._loads = ContinuedReadings(robot), loads
        self._search = GroundSearch(body, self.condition, self.missing)
        self._held = 0.0
        self._centre = complex(*centre_of_mass(robot, angles)[:2].tolist())
        # Inputs kept while all is as planned, and what for; ticks and times since contacts and support were looked at.
        self._inputs: FeltInputs | None = None
        self._given: tuple[list[int], bool] = [], True
        self._still, self._rests, self._ticks, self._unread, self._idle = True, True, 0, 0.0, 0.0

    def sense(
        self, readings: SensorReadings | None, dt: float, state: GaitState, *, timing: StepTiming, angles: list[Vector]
    ) -> GaitState:
        """Return the gait state after the readings of a tick.

        Parameters
        ----------
        readings : SensorReadings or None
            The readings.
        dt, state, timing : float, GaitState, StepTiming
            Time since the last tick [s]; the gait state; the gait and its frequency.
        angles : list of (coxa, femur, tibia)
            Joint angles that were commanded in the last tick [rad].
        """
        valid = self.body.measured = self.readings.step(readings, angles, dt, lag=self._swings.lag)
        down, self.body.commanded = state.down.tolist(), angles
        # Without torques, coxae of feet on their way past an obstacle are watched for stops as well: a servo that
        # pushes on would look like one that has failed.
        lands = [on and not self.missing.obstacles.tries(leg) for leg, on in enumerate(down)]
        stopped = self._swings.step([coxa for coxa, _, _ in angles], valid, dt, down if valid.torques else lands)
        measured = self._loads.contacts(valid, angles, state, dt)
        if not state.felt:
            self.condition.step(True, valid.tilt, dt, held=True)
            if measured is None and valid.attitude is None and not self.condition.fallen:
                return state
            heights = np.array(state.heights(float(state.posture.value[SWING_HEIGHT])))
            state = state._replace(ground_height=heights, felt=[FeltFoot()] * len(heights))
        self.body.since, self._unread, self._ticks = self.body.since + dt, self._unread + dt, self._ticks + 1
        self.body.level(state)
        kept = self._inputs is not None and not (stopped or self.body.looks)
        if kept and self.contacts.estimator.as_planned(measured, state, self.contacts.lifted):
            return state
        dt, ticks, self._unread, self._ticks, self._inputs = self._unread, self._ticks, 0.0, 0, None
        self.body.see(state, dt)
        self.ground.see(valid, state)
        # A greater lag of the joints than usual makes contacts late.
        self.contacts.age = max(valid.contact_age, self._swings.lag - USUAL_LAG)
        self.contacts.estimated = self._loads.estimated
        leaving, rests = timing.due(state, _LEAVING), self._rests and self.support.held
        # Feet of a robot that is carried wait, and do not search for ground. Those that step back search anew.
        places, waits = state.in_heading(state.foot).tolist(), self.condition.carried
        lands = [on and not (waits or self.missing.steps_back(leg, places[leg])) for leg, on in enumerate(lands)]
        self.contacts.step(measured, down, dt, count=ticks, lands=lands, leaving=leaving, rests=rests)
        touches = any(map(self.contacts.is_in_contact, range(len(down))))
        if self._loads.unborne:
            self.contacts.estimator.forget()
        self.condition.step(touches, valid.tilt, dt, held=self._held, lifted=self._loads.unborne)
        centre = self._middle(state) if self._loads.compliance else 0j
        self.offsets = self._loads.offsets(valid, angles, state, dt, out=self._given[0], centre=centre)
        if self.missing.stranded and all(down):
            state = timing.with_first_lift(state, self.missing.stranded[0])
        pace = self.support.pace
        state = met_ground(state, self.body, self.missing, stopped=stopped, timing=timing, pace=pace)
        if self.missing.tips or self.condition.carried or self.support.puts_down(refuses=self.missing.refuses):
            state = put_down(state, timing=timing, pace=pace)
        return state

    def inputs(self, tick: TickState, transitions: TransitionExecutor, excluded: list[int], dt: float) -> FeltInputs:
        """Return what the feet and the body do in a tick.

        Parameters
        ----------
        tick, transitions : TickState, TransitionExecutor
            The state of the walk; its timing, rest footholds, and how far from them feet may be put down.
        excluded, dt : list of int, float
            Legs that bear no load; length of the tick [s].
        """
        state, standing, timing, footholds = tick.gait, tick.standing, transitions.timing, transitions.footholds
        kept, before, self._idle = self._inputs, self._given, self._idle + dt
        self._still = not any(tick.twist.tolist()) or (self.body.slope.refuses and self.support.halts)
        self._given = excluded, standing
        self._rests = self._still and not (self.missing.refuses or self.missing.places)
        due = None if standing else timing.due(state, dt)
        if kept and self._given == before and not (due and True in due):
            if self.body.rates is not kept.rates:
                self._inputs = kept = kept._replace(rates=self.body.rates)
            return kept
        dt, self._idle = self._idle, 0.0
        steps = [leg not in excluded for leg in range(len(state.foot))]
        down = [on and step for on, step in zip(state.down.tolist(), steps, strict=True)]
        places, centre = state.in_heading(state.foot).tolist(), self._middle(state)
        footing = Footing(places, down, centre, float(state.posture.value[2]))
        if self.body.looks:
            free = [on and leg not in self.missing.obstacles.stops for leg, on in enumerate(footing.down)]
            self.body.step(tick, footing._replace(down=free), transitions, pace=self.support.pace)
            self.body.choice.step(state, self.body.reach, footholds)
        stands = self._search.step(state, footing, footholds, dt, rests=self._rests and self.support.held)
        bearing = footing._replace(down=supporting(state, self.body, footing, walks=not standing))
        self._decide_on_support(bearing, due, dt, timing.swing_time)
        self.body.roughness.decay(0.0 if standing else dt * timing.frequency)
        under: list[GroundUnder | None] = [None] * len(steps)
        for leg, (place, on) in enumerate(zip(footing.places, footing.down, strict=True)):
            if steps[leg] and not (on and stands[leg] and not (due and due[leg])):
                under[leg] = self._under(state, leg, place, down=on)
        far = self.body.reach.stroke / max(*footholds.placement_radii, 1e-6)
        travel = travel_share(far, self.contacts.age / timing.swing_time)
        inputs = self._feet_inputs(state, (under, stands, steps), travel)._replace(redundant=timing.redundant)
        # Inputs stay while all is as planned; with compliant feet or a walk that slows down, each tick has new ones.
        self._inputs = None if self.offsets is not None or self.support.pace < 1.0 else inputs
        return inputs

    def _middle(self, state: GaitState) -> complex:
        """Return where the centre of mass is above the feet, along gravity, in the heading frame [m]."""
        return along_gravity(self._centre, state.moved_posture.tolist(), self.body.tilt or (0.0, 0.0))

    def _feet_inputs(
        self, state: GaitState, feet: tuple[list[GroundUnder | None], list[bool], list[bool]], travel: float
    ) -> FeltInputs:
        """Return the inputs of the feet, which travel in this fraction of their swings."""
        body, gently = self.body, self._still and self.support.held and bool(state.down.all())
        # As the body levels about its middle, the feet below it move horizontally with this velocity.
        passing = complex(-body.rates.turn[1], body.rates.turn[0]) * float(state.posture.value[2])
        scale, depth = body.reach.scale, _DEPTH_SHARE * body.roughness.value
        descent = _ESTIMATED_DESCENT if self._loads.estimated else _DESCENT
        return FeltInputs(
            *feet,
            depth=depth,
            rates=body.rates,
            drift=body.drift + self.missing.held(passing),
            yaw_rate=body.heading.rate,
            back=self.missing.back or self.support.shift,
            travel=travel,
            pace=self.support.pace,
            swing_height=float(state.posture.value[SWING_HEIGHT]) + body.roughness.swing_rise,
            lowering=scale * (_GENTLE if gently else descent),
            scale=scale,
            late=self.contacts.age,
            beside=body.choice.beside,
            in_air=self.condition.in_air,
            rough=min(depth / (scale * _ROUGH), 1.0),
            slow_contact=body.stance.lasting,
        )

    def _under(self, state: GaitState, leg: int, place: complex, *, down: bool) -> GroundUnder:
        """Return the ground under a foot in the air or without contact, at a place in the heading frame."""
        heading, elevation, lifted = cmath.exp(1j * state.yaw), state.elevation, self.contacts.lifted[leg]
        known = not self.condition.in_air and self.contacts.is_known(leg) and (down or lifted)
        stays = self.missing.gives_up(leg) or (down and self.missing.is_raised(-sunk_at(place, self.body.off)))
        goal = place if down else state.in_heading(complex(state.foothold[leg]))
        reach, expected = self.body.reach, self.ground.at(goal)
        lowest = max(reach.lowest[leg], expected - _NEAR) if self._rests and self.support.held else reach.lowest[leg]
        lowest = lowest if known and not stays else expected
        straight, bowed = reach.highest_on_way(leg, place, goal)
        way, steep = self.ground.on_way(place, goal)
        # A foot that has met an obstacle stays up until it is past that, where the ground is not known.
        clears = lifted and not (self.ground.given or self._loads.estimated)
        back = state.origin + self.missing.places[leg] * heading if leg in self.missing.places else None
        under = GroundUnder(elevation + expected, elevation + lowest, elevation + straight, elevation + way, steep)
        return under._replace(place=back, clears=clears, bow=heading * reach.bows[leg], bowed=elevation + bowed)

    def _decide_on_support(self, footing: Footing, due: list[bool] | None, dt: float, swing_time: float) -> None:
        """Decide whether feet may lift off, and the pace of the walk; `due` is None while the robot stands."""
        missing, lifts, condition = self.missing, any(due or ()), self.condition
        waits = any((self.body.slope.holds, condition.carried, missing.refuses, missing.tips))
        bearing = [leg for leg, on in enumerate(footing.down) if on]
        legs = [leg for leg in bearing if not (leg in missing.places or (due and due[leg]))]
        stays = (self.support.holds(legs, footing, anew=not self.body.since) and not (lifts and waits)) or due is None
        rests = all(on or leg in self._given[0] for leg, on in enumerate(footing.down))
        unheld = lifts and rests and not (stays or waits or missing.places)
        self.support.shift_over(legs if unheld else [], footing, dt, scale=self.body.reach.scale)
        self.support.step(stays=stays, lifts=lifts, dt=dt, swing_time=swing_time, most=missing.pace)
        # Feet that are due stay on the ground while the robot is carried: all of them tell, if less surely.
        alone = condition.carried and not self.support.held and footing.held_by(bearing)
        self._held = _ALL_HOLD if alone else float(self.support.held)
        leaving = [leg for leg, lift in enumerate(due or ()) if lift and leg not in self._given[0]] if unheld else []
        self.support.lift_fewer(bearing, leaving, footing)

    @property
    def limitations(self) -> tuple[Limitation, ...]:
        """Readings that are rejected or tell no contacts, and what the ground does not allow."""
        missing, readings = self.missing.limitations, rejections(self.body.measured) + self._loads.limitations
        found = readings + self.condition.limitations + self.body.limitations + missing
        explained = self.condition.in_air or self.missing.refuses or missing
        if self.support.pace < SLOW and not explained:
            slope, unheld = self.body.slope, "the feet on the ground do not hold the robot"
            found.append(Limitation(kind=LimitationKind.GROUND, cause=slope.reason if slope.refuses else unheld))
        return tuple(found)
