"""Reading what a guard is given: numbers or a fault come of it, whatever it is, and never an exception."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.control.safety.interventions import Violation
from tarsus.kinematics.pose import Pose

__all__ = ["Rows", "read_angles", "read_body", "read_contacts", "read_step"]

Rows = list[list[float]]

_NUMBERS = "fiu"


def read_angles(angles: Any, legs: int) -> list[float] | Violation:
    """Return the joint angles one after the other, or what is wrong with them."""
    shape = (legs, 3)
    # Anything can be wrong with an object that claims to be an array; whatever it raises, the robot needs angles.
    try:
        array = np.asarray(angles)
        if array.dtype.kind not in _NUMBERS or array.shape != shape:
            return Violation("shape", -1, -1, float(array.size), 3.0 * legs)
        listed = array.ravel().tolist()
        values = listed if array.dtype == np.float64 else [float(value) for value in listed]
    except Exception:
        return Violation("shape", -1, -1, math.nan, 3.0 * legs)
    if math.isfinite(sum(values)):
        return values
    # The sum of huge numbers may be infinite without any of them being so.
    wrong = next((i for i, value in enumerate(values) if not math.isfinite(value)), None)
    return values if wrong is None else Violation("finite", wrong // 3, wrong % 3, values[wrong], math.nan)


def read_step(dt: Any) -> float:
    """Return the time step, NaN where it is no number."""
    if type(dt) is float:
        return dt
    try:
        return math.nan if isinstance(dt, str | bytes | bytearray) else float(dt)
    except Exception:
        return math.nan


def read_contacts(contacts: Any, legs: int) -> list[bool] | Violation:
    """Return which feet are said to be down, or what is wrong with it."""
    try:
        array = np.asarray(contacts)
        if array.dtype.kind == "b" and array.shape == (legs,):
            down: list[bool] = array.tolist()
            return down
        return Violation("contacts", -1, -1, float(array.size), float(legs))
    except Exception:
        return Violation("contacts", -1, -1, math.nan, float(legs))


def read_body(body: Any) -> Rows | Violation:
    """Return the rotation of a single pose as three rows, or what is wrong with it."""
    if isinstance(body, Pose) and body.rotation.shape == (3, 3):
        rows: Rows = body.rotation.tolist()
        return rows
    return Violation("body", -1, -1, float(body.rotation.size) if isinstance(body, Pose) else math.nan, 9.0)
