"""Parsing of the guard's inputs: each returns plain numbers or violations and never raises."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.control.safety.bounds import GuardBounds
from tarsus.control.safety.interventions import Intervention, InterventionKind
from tarsus.control.safety.scalar_geometry import Point
from tarsus.kinematics.pose import Pose

__all__ = ["read_angles", "read_contacts", "read_time_step", "read_up"]

_NUMERIC_KINDS = "fiu"
# A longer time step is invalid rather than a gap [s].
_LONGEST_GAP = 3600.0


def read_angles(angles: Any, names: list[tuple[str, str]]) -> list[float] | Intervention:
    """Return the joint angles in one flat list, or the violation.

    Parameters
    ----------
    angles : any
        Joint angles as given; valid are real numbers of shape (legs, 3) [rad].
    names : list of (str, str)
        Names of leg and joint, for all joints.
    """
    # The conversion of an arbitrary object can raise anything, and the guard must still return angles.
    try:
        array = np.asarray(angles)
        if array.dtype.kind not in _NUMERIC_KINDS or array.shape != (len(names) // 3, 3):
            return Intervention(InterventionKind.SHAPE, "", "", float(array.size), float(len(names)))
        listed = array.ravel().tolist()
        values = listed if array.dtype == np.float64 else [float(value) for value in listed]
    except Exception:
        return Intervention(InterventionKind.SHAPE, "", "", math.nan, float(len(names)))
    # Only the sum of values that are not finite, or of very great ones, is not finite.
    wrong = (
        None if math.isfinite(sum(values)) else next((i for i, v in enumerate(values) if not math.isfinite(v)), None)
    )
    return (
        values if wrong is None else Intervention(InterventionKind.NOT_FINITE, *names[wrong], values[wrong], math.nan)
    )


def read_contacts(contacts: Any, legs: int) -> list[bool] | Intervention:
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
        return Intervention(InterventionKind.CONTACTS, "", "", float(array.size), float(legs))
    except Exception:
        return Intervention(InterventionKind.CONTACTS, "", "", math.nan, float(legs))


def read_up(body: Any) -> Point | Intervention:
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
    return Intervention(InterventionKind.BODY_POSE, "", "", size, 9.0)


def read_time_step(dt: Any, bounds: GuardBounds) -> tuple[float, list[Intervention]]:
    """Return the time that has passed, 0 for an invalid time step, and the violations.

    Parameters
    ----------
    dt : any
        Time step as given [s].
    bounds : GuardBounds
        Bounds of the time step.
    """
    dt = _number(dt)
    passed = dt if 0 < dt <= _LONGEST_GAP else 0.0
    if bounds.min_time_step <= dt <= bounds.max_time_step:
        return passed, []
    if bounds.max_time_step < dt <= _LONGEST_GAP:
        return passed, [Intervention(InterventionKind.TIME_GAP, "", "", dt, bounds.max_time_step)]
    return passed, [Intervention(InterventionKind.TIME_STEP, "", "", dt, bounds.min_time_step)]


def _number(dt: Any) -> float:
    """Return a time step as a float, NaN if it is not a number."""
    if type(dt) is float:
        return dt
    try:
        return math.nan if isinstance(dt, str | bytes | bytearray) else float(dt)
    except Exception:
        return math.nan
