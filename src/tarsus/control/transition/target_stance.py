"""Where the body and the feet are to be for a manner of walking."""

from __future__ import annotations

from typing import Any

import numpy as np

from tarsus.control.transition.feasible_fraction import StanceTarget
from tarsus.control.transition.parameters import WalkParameters
from tarsus.control.workspace.stance_geometry import SWING_HEIGHT
from tarsus.errors import UnreachableError
from tarsus.kinematics.stance import default_stance, stance_or_nan
from tarsus.robot.robot import Robot

__all__ = ["sway_extremes", "target_stance"]

Floats = np.ndarray[Any, Any]

_WITH_BEATS = np.array([1, 0, 1, 0, 1, 0])
# Which parts of the way to a height are tried where no leg has a foothold so high or low.
_TRIED = np.arange(7, 0, -1) / 8


def target_stance(robot: Robot, parameters: WalkParameters, now: Floats | None) -> StanceTarget:
    """Return posture and rest footholds of a manner; where a leg has no foothold so high or low, the nearest that have.

    Parameters
    ----------
    robot : Robot
        A single robot.
    parameters : WalkParameters
        What is asked for.
    now : array, shape (7,), or None
        The present posture; None where there is none to start from.

    Raises
    ------
    UnreachableError
        If there is no such foothold on the way there either, or no present posture.
    """
    body_height, swing_height, stance = _footholds(robot, parameters, now)
    posture = np.array([*parameters.stance, swing_height])
    posture[2] += body_height
    rest = _widened(robot, stance[:, 0] + 1j * stance[:, 1], parameters.stance_width)
    return StanceTarget(posture, rest, parameters.terrain)


def _footholds(robot: Robot, parameters: WalkParameters, now: Floats | None) -> tuple[float, float, Floats]:
    """Return the body height, the lift and the feet in B ``(legs, 3)``."""
    if now is None:
        return (
            parameters.body_height,
            parameters.swing_height,
            default_stance(robot, parameters.body_height, swing_height=parameters.swing_height),
        )
    was, lifted = float(now[2]) - parameters.stance[2], float(now[SWING_HEIGHT])
    for shares in (np.ones(1), _TRIED):
        body_heights, swing_heights = (
            was + shares * (parameters.body_height - was),
            lifted + shares * (parameters.swing_height - lifted),
        )
        feet = stance_or_nan(robot, body_heights, swing_height=swing_heights)
        works = ~np.isnan(feet).any(axis=(-2, -1))
        if works.any():
            first = int(works.argmax())
            return float(body_heights[first]), float(swing_heights[first]), feet[first]
    raise UnreachableError(f"no leg reaches the ground at body height {parameters.body_height * 1000:.1f} mm")


def sway_extremes(posture: Floats, sway: tuple[float, ...]) -> list[Floats]:
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
