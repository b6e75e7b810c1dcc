"""Plan: the stance that a command asks for, transitions to it, and the targets of legs taken out of the gait."""

from __future__ import annotations

import cmath
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.command import Command
from tarsus.control.incremental import Incremental
from tarsus.control.limitation import Cause, Limitation, LimitationKind
from tarsus.control.tick.components import WalkComponents
from tarsus.control.transition.executor import TransitionExecutor
from tarsus.control.transition.stance_transition import StanceTarget, StanceTransition, WalkParameters
from tarsus.control.walk.foot_targets import excluded_legs
from tarsus.control.walk.state import GaitState
from tarsus.control.walk_state import TickState
from tarsus.gait.stance.stability import support_sets
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.polygon import hull_margin
from tarsus.kinematics.stability import stability_margin
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Complex, Float

__all__ = ["CommandIntake", "planned"]

_NO_MOTION = (0.0,) * 6
# Shifts of the body that are tried when legs leave the gait: along each axis, and all of them as x + iy [m].
_STEPS = np.arange(-4, 5) * 0.01
_SHIFTS = (_STEPS[:, None] + 1j * _STEPS).ravel()
_SHIFTED = "x and y are those over the feet that stay while a leg is out of the gait"
# Least static stability margin on the remaining feet when a leg is taken out of the gait [m].
_LEAST_MARGIN = 0.01


class CommandIntake:
    """Passes commands to the transition scheduler, with the correction of the body pose.

    Parameters
    ----------
    robot, transitions : Robot, TransitionExecutor
        A single robot; the stance transitions.
    """

    def __init__(self, robot: Robot, transitions: TransitionExecutor) -> None:
        self._robot, self._transitions = robot, transitions
        self._last: Command | None = None
        # Excluded legs, gait and body pose for which the shift was found.
        self._shifted_for: tuple[object, ...] = ()
        self._shift = 0j

    @property
    def limitations(self) -> tuple[Limitation, ...]:
        """The limitation of a body pose whose x and y are not followed while a leg is out of the gait."""
        moved = self._shifted_for and any(self._transitions.scheduler.requested.body[:2])
        return (Limitation(kind=LimitationKind.BODY, cause=_SHIFTED),) if moved else ()

    def accept(self, command: Command, angles: Float[np.ndarray, "legs 3"]) -> None:
        """Request what is commanded besides the twist, where it differs from what was requested before.

        Parameters
        ----------
        command : Command
            The command.
        angles : array, shape (legs, 3)
            The joint angles [rad].

        Raises
        ------
        InputError
            If a value is out of its range.
        UnknownNameError
            If no gait has the name.
        """
        scheduler = self._transitions.scheduler
        requested = scheduler.requested
        excluded = excluded_legs(command, requested.excluded, self._robot.legs)
        correction = self._correction(excluded, angles)
        known = command.only_twist or command is self._last
        if not known or (excluded, correction) != (requested.excluded, requested.correction):
            scheduler.request(command, excluded, correction)
            self._last = command

    def _correction(self, excluded: tuple[int, ...], angles: Float[np.ndarray, "legs 3"]) -> tuple[float, ...]:
        """Return the correction of the body pose that makes up for legs that bear no load."""
        if not excluded:
            self._shifted_for = ()
            return _NO_MOTION
        requested = self._transitions.scheduler.requested
        shifts_for = excluded, requested.gait, requested.body
        if shifts_for != self._shifted_for:
            (x, y, _), sets = centre_of_mass(self._robot, angles).tolist(), support_sets(requested.gait, excluded)
            centre = cmath.exp(1j * requested.body[5]) * complex(x, y)
            # The centre of mass with the body in the middle of its feet, from where all directions cost the same reach.
            best = _best_shift(self._transitions.footholds.new_rest, centre, sets)
            self._shifted_for, self._shift = shifts_for, best - complex(*requested.body[:2])
        return (self._shift.real, self._shift.imag, 0.0, 0.0, 0.0, 0.0)


def planned(walk: WalkComponents, tick: TickState, command: Command, dt: float) -> TickState:
    """Return the state after one stage of planning; a planned transition begins as soon as it may.

    Parameters
    ----------
    walk : WalkComponents
        The components; the transition executor plans and begins transitions.
    tick, command, dt : TickState, Command, float
        The state; what is commanded; length of the tick [s].
    """
    state = walk.transitions.advance(partial(_plan_transition, walk, tick.gait), tick)
    walk.foot_targets.set_targets(command, state.posture.value, walk.transitions.current.parameters.sway, dt)
    return tick if state is tick.gait else tick._replace(gait=state)


def _plan_transition(
    walk: WalkComponents, state: GaitState, parameters: WalkParameters, stay: bool
) -> Incremental[StanceTransition | Cause]:
    """Plan the transition from the present stance; for legs out of the gait, first check the support of the others."""
    excluded = parameters.excluded
    if excluded:
        yield
        sets = support_sets(parameters.gait, excluded)
        margin = float(stability_margin(walk.robot, walk.time_scaling.angles, state.body, sets).min())
        if margin < _LEAST_MARGIN:
            reason = f"not enough support in the {parameters.gait.name} gait without this leg"
            names = " and ".join(walk.robot.leg_names[leg] for leg in excluded)
            return Cause(reason, names, margin, _LEAST_MARGIN)
    present = StanceTarget(walk.transitions.pose.posture, walk.transitions.footholds.new_rest)
    return (yield from walk.planner.plan(parameters, present, stay=stay))


def _best_shift(rest: Complex[np.ndarray, "legs"], centre: complex, sets: Bool[np.ndarray, "n legs"]) -> complex:
    """Return the shift of the centre of mass with the greatest stability margin; among similar ones the smallest [m].

    `rest` are the rest footholds [m], `sets` the sets of feet that are in stance together.
    """
    feet = np.stack([rest.real, rest.imag], axis=-1)
    centres = np.array([[(centre + shift).real, (centre + shift).imag] for shift in _SHIFTS])
    margins = hull_margin(feet, sets, centres[:, None, :]).min(axis=-1)
    # A shift costs reach, which is weighed against the margin.
    return complex(_SHIFTS[int(np.argmax(margins - np.abs(_SHIFTS) / 4))])
