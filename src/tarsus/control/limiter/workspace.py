"""Limits the twist to strokes that fit the feet's workspaces and that the joints are fast enough for."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from tarsus.control.limitation import Cause, Limitation, LimitationKind
from tarsus.control.limiter.protocol import TwistGrant, TwistRequest
from tarsus.control.transition.executor import TransitionExecutor
from tarsus.errors import InputError
from tarsus.gait.stance.velocity_limits import VelocityLimits

__all__ = ["WorkspaceLimiter", "top_speed"]

_CAUSE, _ROUGH = "workspace and joint speed at this cycle time", "the ground is rough"
# Fraction of the longest stroke that lengthened cycles may use.
_SPARE = 0.95


class WorkspaceLimiter:
    """Scales the twist, straight and turning together, to what steady walking can sustain.

    Every stance that is in force counts: the present one, and that of a transition that is planned or in progress.

    Parameters
    ----------
    names, transitions : sequence of str, TransitionExecutor
        The names of the legs; the stance and its transitions, whose cycles get longer on rough ground.
    adapted : callable
        Returns the greatest cycle time and the greatest speed on the present ground, over those on even ground.
    """

    def __init__(
        self, names: Sequence[str], transitions: TransitionExecutor, adapted: Callable[[], tuple[float, float]]
    ) -> None:
        self._names, self._transitions, self._adapted = names, transitions, adapted
        self._key: tuple[Any, ...] = ()
        self._fraction, self._short = 1.0, list[Limitation]()

    def limit(self, request: TwistRequest, grant: TwistGrant) -> TwistGrant:
        """Return the grant, limited to the sustainable fraction."""
        transitions = self._transitions
        frequency = min(transitions.timing.frequency, transitions.current.timing.frequency)
        longest, speed = self._adapted()
        most = max(grant.fraction, 1.0)
        key = (request.twist, most, frequency, transitions.stances, longest, speed)
        if key != self._key:
            self._key, (fraction, cause) = key, self._largest(request.twist, frequency, most)
            walks = any(request.twist)
            fastest, longest = (top_speed(transitions, request.twist), longest) if walks else (math.inf, 1.0)
            # Cycles get no longer than the strokes at this speed allow.
            transitions.lengthened = min(max(_SPARE * max(fastest, 1 / speed), 1.0), longest)
            if speed < 1 and speed * fastest < fraction:
                fraction, cause = speed * fastest, Cause(_ROUGH)
            short = cause.limitation(LimitationKind.TWIST, asked=1.0, granted=fraction)
            self._fraction, self._short = fraction, [short] if fraction < 1 else []
        return grant.at_most(self._fraction, *self._short)

    def _largest(self, twist: tuple[float, ...], frequency: float, most: float) -> tuple[float, Cause]:
        """Return the largest sustainable fraction, `most` at most, and what limits it."""
        fraction, leg = most, 0
        for transition, limits in self._transitions.stances:
            duty_factor = transition.parameters.gait.duty_factor
            stance_time = duty_factor * max(1 / frequency, transition.cycle_timing.cycle_time)
            longest, which = _longest_stance(limits, twist, duty_factor)
            if longest < fraction * stance_time:
                fraction, leg = longest / stance_time, which
        return fraction, Cause(_CAUSE, self._names[leg])


def top_speed(transitions: TransitionExecutor, direction: Sequence[float]) -> float:
    """Return what `WalkController.top_speed` does: the largest multiple of a twist that this stance sustains."""
    try:
        twist = tuple(float(speed) for speed in direction)
    except (TypeError, ValueError):
        twist = ()
    if len(twist) != 3 or not all(map(math.isfinite, twist)) or not any(twist):
        raise InputError(f"direction is {direction!r}; it must be three finite numbers, not all 0: vx, vy, wz")
    current = transitions.current
    duty_factor = transitions.timing.gait.duty_factor
    stance_time = duty_factor * current.cycle_timing.cycle_time
    longest, _ = _longest_stance(current.final_limits, twist, duty_factor)
    return longest / stance_time


@functools.lru_cache(maxsize=64)
def _longest_stance(limits: VelocityLimits, twist: tuple[float, ...], duty_factor: float) -> tuple[float, int]:
    """Return how long the stances of a steady walk may last [s], and the leg that limits this.

    This duration over the actual one is the sustainable multiple of the twist: it is found once for all cycle times.
    """
    return limits.feasible_fraction(np.array(twist), stance_time=1.0, duty_factor=duty_factor)
