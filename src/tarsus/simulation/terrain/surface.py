"""What the geoms of all terrains have in common."""

from __future__ import annotations

from typing import Any

from tarsus.simulation.settings import SOLREF

__all__ = ["FAR", "surface"]

FAR = 50.0
"""How far terrains that have no end of their own extend from the origin [m]."""

_TORSIONAL, _ROLLING = 0.005, 1e-4


def surface(friction: float) -> dict[str, Any]:
    """Return the contact attributes of a terrain's geom, which prevail over those of the robot.

    Parameters
    ----------
    friction : float
        Coefficient of friction.
    """
    return {
        "friction": (friction, _TORSIONAL, _ROLLING),
        "condim": 3,
        "priority": 1,
        "solref": SOLREF,
        "contype": 1,
        "conaffinity": 0,
        "rgba": (0.55, 0.58, 0.55, 1.0),
    }
