"""Execution of stance transitions: when a planned one begins, and how feet and body carry it out."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.limitation import Cause, Limitation, LimitationKind
from tarsus.control.pose.pose_controller import PoseController
from tarsus.control.transition.foothold_transfer import FootholdTransfer
from tarsus.control.transition.scheduler import PlanTransition, TransitionScheduler
from tarsus.control.transition.stance_transition import StanceTransition
from tarsus.control.walk.foot_targets import FootTargets
from tarsus.control.walk.foothold import final_footholds
from tarsus.control.walk.reference_governor import FootPrediction
from tarsus.control.walk.state import POSITION_TOLERANCE, ROUNDING, GaitState
from tarsus.control.walk.step_timing import StepTiming
from tarsus.control.walk.stepper import stance_tolerance
from tarsus.control.walk_state import TickState
from tarsus.gait.stance.stance_geometry import sway_fraction
from tarsus.gait.stance.velocity_limits import VelocityLimits

if TYPE_CHECKING:
    from jaxtyping import Complex, Float

__all__ = ["TransitionExecutor"]

_SWAY = Cause("joint speed and acceleration at this cycle time")
_SHIFTS = Cause("the body shift of this gait takes its place")


class TransitionExecutor:
    """Begins stance transitions as soon as no foot leaves its workspace because of them, and completes them.

    Parameters
    ----------
    initial, foot_targets : StanceTransition, FootTargets
        The stance at the start; the legs that are taken out of the gait.
    scale : float
        Factor by which lengths are reduced on short legs, 0 to 1.

    Attributes
    ----------
    scheduler : TransitionScheduler
        What is commanded besides the twist, and the transition that is planned for it.
    footholds : FootholdTransfer
        Workspace and rest foothold of each foot.
    pose : PoseController
        The posture to reach.
    timing : StepTiming
        The gait and its frequency.
    current : StanceTransition
        The transition that was begun last.
    lengthened : float
        Cycle time to reach, over the planned one.
    """

    def __init__(self, initial: StanceTransition, foot_targets: FootTargets, *, scale: float = 1.0) -> None:
        self.scheduler, self.footholds = TransitionScheduler(initial), FootholdTransfer(initial)
        self.pose = PoseController(initial.posture)
        self.timing = initial.timing
        self.current, self.lengthened = initial, 1.0
        self._foot_targets, self._scale = foot_targets, scale
        # The transition to another gait, before which all feet touch down, and the leg that lifts first in it; the
        # transition for which feet are stepping to new rest footholds.
        self._next: StanceTransition | None = None
        self._first_leg = 0
        self._active: StanceTransition | None = None

    @property
    def stances(self) -> list[tuple[StanceTransition, VelocityLimits]]:
        """Transitions whose limits apply: the present one, and one that is planned or for which feet land or step."""
        pending = self.scheduler.planned or self._next or self._active
        return [(self.current, self.footholds.limits), *([(pending, pending.path_limits)] if pending else [])]

    @property
    def limitations(self) -> tuple[Limitation, ...]:
        """What of the commanded parameters is not met, and will not be."""
        sway, found = self.current.parameters.sway, self.scheduler.limitations
        fraction = sway_fraction(np.array(sway), self.timing.frequency, self.timing.gait.beats) if any(sway) else 1.0
        fraction, cause = (0.0, _SHIFTS) if self.timing.gait.body_shift and any(sway) else (fraction, _SWAY)
        return found if fraction == 1 else (*found, cause.limitation(LimitationKind.SWAY, asked=1.0, granted=fraction))

    @property
    def waiting(self) -> bool:
        """Whether a transition waits until it may begin, or until its body motion may."""
        return self.scheduler.planned is not None or (self._active is not None and not self.unstepped)

    @property
    def unstepped(self) -> tuple[int, ...]:
        """Legs of the gait whose feet have yet to step to new rest footholds; the body waits for them."""
        if self._active is None:
            return ()
        excluded, transferred = self.current.parameters.excluded, self.footholds.transferred.tolist()
        return tuple(leg for leg, done in enumerate(transferred) if not done and leg not in excluded)

    @property
    def body_shift(self) -> Complex[np.ndarray, "7"] | None:
        """Coefficients of the body shift, array, shape (7,) [m]; None for a gait without one."""
        # While the feet step to new rest footholds, the body keeps its posture.
        steps = self._active is not None
        return (self.current.stepping_limits if steps else self.current.final_limits).shift

    @property
    def changes_gait(self) -> bool:
        """Whether all feet are touching down before another gait starts."""
        return self._next is not None

    @property
    def frequency(self) -> float:
        """The step frequency to reach [1/s]."""
        return 1 / (self.lengthened * self.current.cycle_timing.cycle_time)

    @property
    def bandwidth(self) -> float:
        """Bandwidth with which the twist follows its target; that of the next gait once feet land for it [rad/s]."""
        return (self.timing if self._next is None else self._next.timing).bandwidth

    @property
    def bounds(self) -> Float[np.ndarray, "legs 16"]:
        """Sides of the polygons in which the feet that bear load have to stay: array, shape (legs, 16) [m]."""
        return self._foot_targets.without_bounds(self.footholds.shifted(self.footholds.bounds))

    def stance_intervals(self, state: GaitState) -> tuple[Float[np.ndarray, "legs"], Float[np.ndarray, "legs"]]:
        """Return start and end of each foot's stance where it is, or where it will touch down: shape (legs,) [s]."""
        if self._next is None:
            return self.timing.stance_intervals(state)
        begins = self.timing.time_to_touchdown(state)
        return begins, begins.max() + self._next.lift_delays[self._first_leg]

    def _is_settled(self, state: GaitState) -> bool:
        """Return whether the last transition is over: posture reached, returning legs on the ground."""
        if self._active is not None or self._next is not None or self._foot_targets.returning:
            return False
        return self.pose.reached(state.posture.value)

    def at_rest(self, state: GaitState, *, stands: bool = False) -> bool:
        """Return whether every foot of the gait is at its rest foothold, and none has yet to step to a new one.

        Parameters
        ----------
        state, stands : GaitState, bool
            The gait state of a robot that hardly moves; whether it stands: more is tolerated then, as feet would step
            for this alone.
        """
        rest = final_footholds(state, rest=self.footholds.rest, bandwidth=self.bandwidth)
        assert rest is not None  # None only for a robot that is fast
        off = np.abs(state.foot - rest)
        off[list(self.current.parameters.excluded)] = 0.0
        near = bool(off.max() <= stance_tolerance(state, scale=self._scale, stands=stands))
        return near and not self._foot_targets.returning and not self.unstepped

    # Beginning a transition.

    def advance(self, plan: PlanTransition, now: TickState) -> GaitState:
        """Do one stage of planning, and begin what may begin.

        Parameters
        ----------
        plan, now : callable, TickState
            Plans a transition, as for `TransitionScheduler.advance_planning`; the state of walking.

        Returns
        -------
        GaitState
            The gait state; its clock is set where another gait begins.
        """
        self.scheduler.advance_planning(plan, idle=self._is_settled(now.gait))
        if self.scheduler.planned is not None:
            return self._try_to_begin(self.scheduler.planned, now)
        if self._active is not None:
            self._try_to_move_body(self._active, now)
        return now.gait

    def _try_to_begin(self, planned: StanceTransition, now: TickState) -> GaitState:
        """Begin a planned transition as soon as the standing feet allow it."""
        state, gait = now.gait, planned.parameters.gait
        # The steps get faster only after the transition.
        frequency = min(self.timing.frequency, planned.timing.frequency)
        # At the present twist, the feet have to be able to step to their new rest footholds.
        fraction, _ = planned.stepping_limits.feasible_fraction(
            state.twist.value, stance_time=gait.duty_factor / frequency, duty_factor=gait.duty_factor
        )
        feasible = fraction >= 1
        if not self.timing.steps_like(gait):
            if now.standing:
                return self._start_gait(planned, 0, state)
            if feasible and not self.timing.stands_before(gait):
                self._try_to_change_gait(planned, now)
            return state
        leaving = list(set(planned.parameters.excluded) - set(self.current.parameters.excluded))
        if feasible and state.down[leaving].all():
            bounds = self._foot_targets.without_bounds(self.footholds.bounds_with(planned))
            if leaving:
                bounds = np.minimum(bounds, planned.final_limits.bounds)
            if self._stays_within(bounds, now, self.timing._replace(frequency=frequency)):
                self._begin(planned, state)
        return state

    def _try_to_change_gait(self, planned: StanceTransition, now: TickState) -> None:
        """Let all feet touch down if they may stand until the new gait lifts them; the leg best suited lifts first."""
        ends = self.timing.time_to_touchdown(now.gait).max() + planned.lift_delays
        bounds = self._foot_targets.without_bounds(self.footholds.bounds_with(planned))
        bounds = self.footholds.shifted(np.minimum(bounds, planned.final_limits.bounds))
        prediction = FootPrediction.of(now.gait, np.zeros_like(ends), ends, planned.timing.bandwidth)
        over = prediction.excess(now.twist[None], bounds).max(axis=(1, 2, 3, 4))
        # Symmetric legs differ only by rounding: the first of them is taken, so that all machines choose the same one.
        first = int((over <= over.min() + ROUNDING).argmax())
        if over[first] <= POSITION_TOLERANCE:
            self._next, self._first_leg, self.scheduler.planned = planned, first, None
            self.footholds.restrict(planned.final_limits)

    def _try_to_move_body(self, active: StanceTransition, now: TickState) -> None:
        """Move the body once every foot is at its new rest foothold."""
        if self.unstepped or self.timing.frequency > active.timing.frequency:
            return
        bounds = self._foot_targets.without_bounds(active.path_limits.bounds)
        if self._stays_within(bounds, now, self.timing):
            self.footholds.restrict(active.path_limits)
            self.pose.set_posture(active.posture)
            self._active = None

    def _stays_within(self, bounds: Float[np.ndarray, "legs 16"], now: TickState, timing: StepTiming) -> bool:
        prediction = FootPrediction.of(now.gait, *timing.stance_intervals(now.gait), timing.bandwidth)
        excess = prediction.excess(now.twist[None], self.footholds.shifted(bounds))
        return bool(excess.max() <= stance_tolerance(now.gait, scale=self._scale))

    def _begin(self, planned: StanceTransition, state: GaitState) -> None:
        """Transfer the feet to their new rest footholds; legs that leave the gait get foot targets."""
        self.footholds.begin(planned, state.down)
        self.scheduler.adopt(planned)
        self.current = self.scheduler.current
        self._next, self._active = None, planned
        excluded = planned.parameters.excluded
        if excluded:
            self.footholds.restrict(planned.final_limits)
        self._foot_targets.set_legs(excluded, state)

    def _start_gait(self, planned: StanceTransition, first: int, state: GaitState) -> GaitState:
        """Start a gait while every foot is down."""
        self._begin(planned, state)
        self.timing = planned.timing
        return self.timing.with_first_lift(state, first)

    # After a tick.

    def finish(self, state: GaitState, dt: float) -> GaitState:
        """Complete what has come to its end with a tick.

        Parameters
        ----------
        state, dt : GaitState, float
            The gait state after the tick; length of the tick [s].

        Returns
        -------
        GaitState
            The gait state; its clock is set where another gait begins.
        """
        settled = self._is_settled(state)
        if self._next is None:
            goal = self.frequency if settled else min(self.frequency, self.timing.frequency)
            if goal != self.timing.frequency:
                self.timing = self.timing.approach(goal, dt)
        elif state.down.all():
            state = self._start_gait(self._next, self._first_leg, state)
        if settled and self.footholds.limits is not self.current.final_limits:
            self.footholds.complete(self.current.final_limits)
        return state
