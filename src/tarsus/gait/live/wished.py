"""Where the body and the feet are to be for a manner of walking."""

from __future__ import annotations

from typing import Any

import numpy as np

from tarsus.errors import UnreachableError
from tarsus.gait.live.manner import Manner
from tarsus.gait.live.part_of_way import Posed
from tarsus.gait.live.posture import LIFT
from tarsus.kinematics.stance import default_stance, stance_or_nan
from tarsus.robot.robot import Robot

__all__ = ["swaying", "wished_posed"]

Floats = np.ndarray[Any, Any]

_WITH_BEATS = np.array([1, 0, 1, 0, 1, 0])
# Which parts of the way to a height are tried where no leg has a foothold so high or low.
_TRIED = np.arange(7, 0, -1) / 8


def wished_posed(robot: Robot, manner: Manner, now: Floats | None) -> Posed:
    """Return posture and rest footholds of a manner; where a leg has no foothold so high or low, the nearest that have.

    Parameters
    ----------
    robot : Robot
        A single robot.
    manner : Manner
        What is asked for.
    now : array, shape (7,), or None
        The present posture; None where there is none to start from.

    Raises
    ------
    UnreachableError
        If there is no such foothold on the way there either, or no present posture.
    """
    clearance, lift, stance = _footholds(robot, manner, now)
    posture = np.array([*manner.stance, lift])
    posture[2] += clearance
    rest = _widened(robot, stance[:, 0] + 1j * stance[:, 1], manner.stance_width)
    return Posed(posture, rest, manner.terrain)


def _footholds(robot: Robot, manner: Manner, now: Floats | None) -> tuple[float, float, Floats]:
    """Return the clearance, the lift and the feet in B ``(legs, 3)``."""
    if now is None:
        return manner.clearance, manner.lift, default_stance(robot, manner.clearance, lift=manner.lift)
    was, lifted = float(now[2]) - manner.stance[2], float(now[LIFT])
    for shares in (np.ones(1), _TRIED):
        clearances, lifts = was + shares * (manner.clearance - was), lifted + shares * (manner.lift - lifted)
        feet = stance_or_nan(robot, clearances, lift=lifts)
        works = ~np.isnan(feet).any(axis=(-2, -1))
        if works.any():
            first = int(works.argmax())
            return float(clearances[first]), float(lifts[first]), feet[first]
    raise UnreachableError(f"no leg reaches the ground at clearance {manner.clearance * 1000:.1f} mm")


def swaying(posture: Floats, sway: tuple[float, ...]) -> list[Floats]:
    """Return the postures at the ends of a sway, and the one in the middle last.

    Parameters
    ----------
    posture : array, shape (7,)
        The one in the middle.
    sway : tuple of float
        Amplitudes: x, y, z [m], roll, pitch, yaw [rad].
    """
    if not any(sway):
        return [posture]
    # Half of the axes go with the beats, half with the cycles: they meet in any order.
    often, once = (np.append(np.array(sway) * part, 0.0) for part in (_WITH_BEATS, 1 - _WITH_BEATS))
    return [*(posture + a * often + b * once for a in (1, -1) for b in (1, -1)), posture]


def _widened(robot: Robot, rest: Floats, width: float) -> Floats:
    mount = robot.geometry.mount_x + 1j * robot.geometry.mount_y
    out = rest - mount
    wider: Floats = rest + width * out / np.maximum(np.abs(out), 1e-9)
    return wider
