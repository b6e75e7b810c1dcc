"""Parsing of the guard's inputs: each function returns plain numbers or a violation and never raises."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.control.safety.interventions import InterventionKind, Violation
from tarsus.control.safety.support_geometry import Point
from tarsus.kinematics.pose import Pose

__all__ = ["read_angles", "read_contacts", "read_time_step", "read_up"]

_NUMERIC_KINDS = "fiu"


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


def read_time_step(dt: Any) -> float:
    """Return the time step as a float, NaN if it is not a number.

    Parameters
    ----------
    dt : any
        Time step as given [s].
    """
    if type(dt) is float:
        return dt
    try:
        return math.nan if isinstance(dt, str | bytes | bytearray) else float(dt)
    except Exception:
        return math.nan


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
