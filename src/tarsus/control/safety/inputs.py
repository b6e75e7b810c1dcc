"""Parsing of the guard's inputs: each returns plain numbers or violations and never raises."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.control.safety.bounds import GuardBounds
from tarsus.control.safety.interventions import InterventionKind, Violation
from tarsus.control.safety.scalar_geometry import Point
from tarsus.kinematics.pose import Pose

__all__ = ["GuardClock", "read_angles", "read_contacts", "read_up"]

_NUMERIC_KINDS = "fiu"
# A longer time step is invalid rather than a gap [s].
_LONGEST_GAP = 3600.0


def read_angles(angles: Any, legs: int) -> list[float] | Violation:
    """Return the joint angles in one flat list, or the violation.

    Parameters
    ----------
    angles : any
        Joint angles as given; valid are real numbers of shape (legs, 3) [rad].
    legs : int
        Number of legs.
    """
    # The conversion of an arbitrary object can raise anything, and the guard must still return angles.
    try:
        array = np.asarray(angles)
        if array.dtype.kind not in _NUMERIC_KINDS or array.shape != (legs, 3):
            return Violation(InterventionKind.SHAPE, -1, -1, float(array.size), 3.0 * legs)
        listed = array.ravel().tolist()
        values = listed if array.dtype == np.float64 else [float(value) for value in listed]
    except Exception:
        return Violation(InterventionKind.SHAPE, -1, -1, math.nan, 3.0 * legs)
    if math.isfinite(sum(values)):
        return values
    # The sum of finite values can overflow.
    index = next((i for i, value in enumerate(values) if not math.isfinite(value)), None)
    if index is None:
        return values
    return Violation(InterventionKind.NOT_FINITE, index // 3, index % 3, values[index], math.nan)


def read_contacts(contacts: Any, legs: int) -> list[bool] | Violation:
    """Return the feet in stance, or the violation.

    Parameters
    ----------
    contacts : any
        Contacts as given; valid is an array of bool, shape (legs,).
    legs : int
        Number of legs.
    """
    try:
        array = np.asarray(contacts)
        if array.dtype.kind == "b" and array.shape == (legs,):
            stance: list[bool] = array.tolist()
            return stance
        return Violation(InterventionKind.CONTACTS, -1, -1, float(array.size), float(legs))
    except Exception:
        return Violation(InterventionKind.CONTACTS, -1, -1, math.nan, float(legs))


def read_up(body: Any) -> Point | Violation:
    """Return the upward direction in B at a single pose, or the violation.

    Parameters
    ----------
    body : any
        Pose of B in G as given; valid is a single `Pose`.
    """
    if isinstance(body, Pose) and body.rotation.shape == (3, 3):
        x, y, z = body.rotation[2].tolist()
        return x, y, z
    size = float(body.rotation.size) if isinstance(body, Pose) else math.nan
    return Violation(InterventionKind.BODY_POSE, -1, -1, size, 9.0)


class GuardClock:
    """Sums the valid time steps; steps that are too short accumulate until they are long enough.

    Attributes
    ----------
    time : float
        Sum of all valid time steps [s].

    Parameters
    ----------
    bounds : GuardBounds
        Bounds of the time step.
    """

    def __init__(self, bounds: GuardBounds) -> None:
        self._shortest, self._longest = bounds.min_time_step, bounds.max_time_step
        self._pending = self.time = 0.0

    def advance(self, dt: Any) -> tuple[float, list[Violation]]:
        """Advance the clock; return the time step to use, 0 for none, and the violations.

        Parameters
        ----------
        dt : any
            Time step as given [s].
        """
        dt = _number(dt)
        if 0 < dt <= _LONGEST_GAP:
            self._pending += dt
        step = self._pending if self._pending >= self._shortest else 0.0
        if step > 0:
            self.time, self._pending = self.time + step, 0.0
        if self._shortest <= dt <= self._longest:
            return step, []
        if self._longest < dt <= _LONGEST_GAP:
            return step, [Violation(InterventionKind.TIME_GAP, -1, -1, dt, self._longest)]
        return step, [Violation(InterventionKind.TIME_STEP, -1, -1, dt, self._shortest)]


def _number(dt: Any) -> float:
    """Return a time step as a float, NaN if it is not a number."""
    if type(dt) is float:
        return dt
    try:
        return math.nan if isinstance(dt, str | bytes | bytearray) else float(dt)
    except Exception:
        return math.nan
