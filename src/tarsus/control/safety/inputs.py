"""Parsing of the guard's inputs: each returns plain numbers, or None and adds a violation, and never raises."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.control.safety.bounds import GuardBounds
from tarsus.control.safety.interventions import Intervention, InterventionKind
from tarsus.control.safety.scalar_geometry import Point
from tarsus.kinematics.pose import Pose

__all__ = ["read_angles", "read_contacts", "read_time_step", "read_up"]

# A longer time step is invalid rather than a gap [s].
_LONGEST_GAP = 3600.0


def read_angles(angles: Any, names: list[tuple[str, str]], violations: list[Intervention]) -> list[float] | None:
    """Return the joint angles in one flat list.

    Parameters
    ----------
    angles : any
        Joint angles as given; valid are real numbers of shape (legs, 3) [rad].
    names, violations : list of (str, str), list of Intervention
        Names of leg and joint, for all joints; the list that takes the violation.
    """
    listed = _listed(angles, "fiu", (len(names) // 3, 3), InterventionKind.SHAPE, violations)
    if listed is None:
        return None
    values = list(map(float, listed))
    # A finite sum means that all values are finite; one that is not may also come from very great values.
    if math.isfinite(sum(values)):
        return values
    for name, value in zip(names, values, strict=True):
        if not math.isfinite(value):
            violations.append(Intervention(InterventionKind.NOT_FINITE, *name, value, math.nan))
            return None
    return values


def read_contacts(contacts: Any, legs: int, violations: list[Intervention]) -> list[bool] | None:
    """Return the feet in stance.

    Parameters
    ----------
    contacts : any
        Contacts as given; valid is an array of bool, shape (legs,).
    legs, violations : int, list of Intervention
        Number of legs; the list that takes the violation.
    """
    return _listed(contacts, "b", (legs,), InterventionKind.CONTACTS, violations)


def read_up(body: Any, violations: list[Intervention]) -> Point | None:
    """Return the upward direction in B at a single pose.

    Parameters
    ----------
    body : any
        Pose of B in G as given; valid is a single `Pose`.
    violations : list of Intervention
        The list that takes the violation.
    """
    if isinstance(body, Pose) and body.rotation.shape == (3, 3):
        x, y, z = body.rotation[2].tolist()
        return x, y, z
    size = float(body.rotation.size) if isinstance(body, Pose) else math.nan
    violations.append(Intervention(InterventionKind.BODY_POSE, "", "", size, 9.0))
    return None


def read_time_step(dt: Any, bounds: GuardBounds, violations: list[Intervention]) -> float:
    """Return the time that has passed: the time step, or 0 if it is not a number above 0 and up to an hour [s].

    Parameters
    ----------
    dt : any
        Time step as given [s].
    bounds, violations : GuardBounds, list of Intervention
        Bounds of the time step; the list that takes the violation.
    """
    try:
        step = math.nan if isinstance(dt, str | bytes | bytearray) else float(dt)
    except Exception:
        step = math.nan
    if bounds.max_time_step < step <= _LONGEST_GAP:
        violations.append(Intervention(InterventionKind.TIME_GAP, "", "", step, bounds.max_time_step))
    elif not bounds.min_time_step <= step <= bounds.max_time_step:
        violations.append(Intervention(InterventionKind.TIME_STEP, "", "", step, bounds.min_time_step))
    return step if 0 < step <= _LONGEST_GAP else 0.0


def _listed(
    given: Any, kinds: str, shape: tuple[int, ...], wrong: InterventionKind, violations: list[Intervention]
) -> list[Any] | None:
    """Return the values of an array of the given shape and kinds of data type in one flat list."""
    # The conversion of an arbitrary object can raise anything, and the guard must still return angles.
    try:
        array = np.asarray(given)
        if array.dtype.kind in kinds and array.shape == shape:
            return array.ravel().tolist()
        size = float(array.size)
    except Exception:
        size = math.nan
    violations.append(Intervention(wrong, "", "", size, float(math.prod(shape))))
    return None
