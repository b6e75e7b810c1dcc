"""What is commanded besides the twist, and the planning of stance transitions that meet it, one stage per tick."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from itertools import chain
from typing import TypeAlias

from tarsus.control.command import Command
from tarsus.control.limitation import Cause, Limitation, LimitationKind
from tarsus.control.transition.stance_transition import StanceTransition, WalkParameters
from tarsus.gait.gait import Gait
from tarsus.incremental import Incremental
from tarsus.robot.robot import require_leg_number

__all__ = ["PlanTransition", "TransitionScheduler"]

PlanTransition: TypeAlias = Callable[[WalkParameters, bool], Incremental[StanceTransition | Cause]]
"""Plans a transition to parameters; the second argument is whether the posture stays."""

_DEFERRED = Cause("not while a leg is taken out of the gait")


class TransitionScheduler:
    """Holds the commanded parameters, and plans transitions until they are met.

    Parameters
    ----------
    initial : StanceTransition
        The stance at the start.

    Attributes
    ----------
    requested : WalkParameters
        What is commanded.
    current : StanceTransition
        The transition that was begun last.
    planned : StanceTransition or None
        A transition that is planned and has not begun.
    """

    def __init__(self, initial: StanceTransition) -> None:
        self.current = initial
        self.requested = initial.parameters
        self.planned: StanceTransition | None = None
        # The last command that was not for the twist alone: mostly the same object is given for many ticks.
        self._last: Command | None = None
        # Parameters that are not feasible at all, and the limitations to report for each.
        self._rejections: dict[WalkParameters, list[Limitation]] = {}
        self._job: Incremental[None] | None = None
        # Parameters for which nothing is left to plan.
        self._done: WalkParameters | None = None
        # Whether the robot's stance is, or will be, partway from the current parameters to others.
        self._between = False
        # The parameters to which the limitations of the current transition refer.
        self._planned_for = initial.parameters
        # Limitations besides those of the current transition; kept until planning has come to a new result.
        self._shortfalls: tuple[Limitation, ...] = ()

    @property
    def limitations(self) -> tuple[Limitation, ...]:
        """What of the commanded parameters is not met, and will not be."""
        now, then = self.requested, self._planned_for
        newer = {found.kind for found in self._shortfalls}
        # Each kind of limitation of a stance has the name of the parameter that it is about.
        valid = (each for each in self.current.limitations if getattr(now, each.kind) == getattr(then, each.kind))
        return (*(found for found in valid if found.kind not in newer), *self._shortfalls)

    def request(self, command: Command) -> None:
        """Take note of a command.

        Parameters
        ----------
        command : Command
            The command; what is None in it stays as it is.

        Raises
        ------
        InputError
            If the gait is for another number of legs, or the command names a leg that the robot does not have.
        UnknownNameError
            If no gait has the name.
        """
        if command.only_twist or command is self._last:
            return
        before, changes = self.requested, command.parameters
        legs = set(before.excluded)
        for leg, point in {**(command.foot_targets or {}), **(command.foot_velocities or {})}.items():
            require_leg_number("foot_targets", leg, before.gait.legs)
            (legs.discard if point is None else legs.add)(leg)
        excluded = tuple(sorted(legs))
        gait = changes.get("gait", before.gait)
        if isinstance(gait, str):
            gait = before.gait if gait == before.gait.name else Gait.named(gait, legs=before.gait.legs)
        gait.require_legs(before.gait.legs)
        changes["gait"] = gait
        if changes.get("cycle_time") == "auto":
            changes["cycle_time"] = None
        asked = dataclasses.replace(before, unloaded=excluded, excluded=excluded, **changes)
        self._last = command
        if asked != before:
            self.requested, self._rejections = asked, {}
            self._shortfalls = ()

    def advance_planning(self, plan: PlanTransition, *, idle: bool) -> None:
        """Do one stage of planning.

        Parameters
        ----------
        plan : callable
            Plans a transition to parameters in stages; its second argument is whether the posture stays.
        idle : bool
            Whether the last transition is over, so that another one may be planned.
        """
        if self._job is not None:
            if next(self._job, True) is None:
                return
            self._job = None
        if idle and self.planned is None and self.requested is not self._done:
            asked, stay = self._next_parameters()
            if self._is_open(asked, stay):
                self._job = self._planning(plan, asked, stay)
            else:
                self._finish_request()

    def _planning(self, plan: PlanTransition, asked: WalkParameters, stay: bool) -> Incremental[None]:
        """Plan the transition to parameters, and take note of it, or of why the parameters are rejected."""
        found = yield from plan(asked, stay)
        if isinstance(found, StanceTransition):
            self.planned = found
        # Parameters that are no longer commanded by now are not rejected.
        elif asked == self._next_parameters()[0]:
            posture = None if stay else self.current.posture
            self._rejections[asked] = asked.rejected(self.current.parameters, posture, found)
            self._shortfalls = tuple(chain.from_iterable(self._rejections.values()))

    def adopt(self, transition: StanceTransition) -> None:
        """Take note that a transition begins."""
        planned_for, limitations = transition.parameters, transition.limitations
        parameters = planned_for if transition.complete else self.current.parameters
        if transition.keeps_posture:
            kept = (found for found in self.current.limitations if found.kind is not LimitationKind.CYCLE_TIME)
            limitations = (*kept, *limitations)
            planned_for = dataclasses.replace(self._planned_for, cycle_time=planned_for.cycle_time)
        else:
            self._between = not transition.complete
        self.current = dataclasses.replace(transition, parameters=parameters, limitations=limitations)
        self._planned_for = planned_for
        # What was rejected may be feasible from the new stance.
        self.planned, self._rejections, self._done = None, {}, None

    def _finish_request(self) -> None:
        """Take note that everything feasible of the commanded parameters is met."""
        self._done, current = self.requested, self.current.parameters
        self._shortfalls = tuple(chain.from_iterable(self._rejections.values()))
        # Any change of how the robot stands has to wait until all legs are back in the gait.
        deferred = dataclasses.replace(self.requested.stepping_like(current), unloaded=current.unloaded)
        if current.excluded and self._is_open(deferred, False):
            self._shortfalls += tuple(deferred.rejected(current, self.current.posture, _DEFERRED))

    def _next_parameters(self) -> tuple[WalkParameters, bool]:
        """Return parameters with what to change first, how the robot steps or stands; and whether its posture stays."""
        current, requested = self.current.parameters, self.requested
        order = [(current.stepping_like(requested), True), (requested.stepping_like(current), False)]
        if set(current.excluded) - set(requested.excluded):
            # Legs return to the same gait that they left; others may leave it only once these are down.
            staying = tuple(leg for leg in current.excluded if leg in requested.excluded)
            order = [(dataclasses.replace(current, excluded=staying), True)]
        elif current.excluded:
            # In another posture, the feet of these legs might be out of reach where they are.
            order = order[:1]
        elif requested.excluded:
            # Before a leg leaves the gait, the feet of the others step to where they support the robot.
            order.reverse()
        return next((each for each in order if self._is_open(*each)), (current, True))

    def _is_open(self, parameters: WalkParameters, stay: bool) -> bool:
        """Return whether parameters are neither met nor rejected; where the posture stays, it need not be met."""
        # With the stance partway to others, the current parameters have to be met anew.
        met = parameters == self.current.parameters and (stay or not self._between)
        return not met and parameters not in self._rejections
