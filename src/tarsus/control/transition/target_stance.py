"""Posture and rest footholds that parameters of walking ask for."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.transition.feasible_fraction import StanceTarget
from tarsus.control.transition.stance_transition import WalkParameters
from tarsus.errors import UnreachableError
from tarsus.gait.stance.stance_geometry import SWING_HEIGHT
from tarsus.kinematics.stance import default_stance, stance_or_nan
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["target_stance"]

# Fractions of a change of height that are tried where the whole of it has no foothold.
_FRACTIONS = np.arange(7, 0, -1) / 8


def target_stance(robot: Robot, parameters: WalkParameters, present: StanceTarget | None) -> StanceTarget:
    """Return posture and rest footholds; for a height without a foothold, of the nearest height that has them.

    Parameters
    ----------
    robot, parameters : Robot, WalkParameters
        A single robot; what is commanded.
    present : StanceTarget or None
        The present stance; None without one.

    Raises
    ------
    UnreachableError
        If no height between the present and the commanded one has footholds.
    """
    body_height, swing_height, feet = _footholds(robot, parameters, present)
    posture = np.array([*parameters.corrected_body, swing_height])
    posture[2] += body_height
    mount, rest = robot.geometry.mount_x + 1j * robot.geometry.mount_y, feet[:, 0] + 1j * feet[:, 1]
    outward = (rest - mount) / np.maximum(np.abs(rest - mount), 1e-9)
    return StanceTarget(posture, rest + parameters.stance_width * outward)


def _footholds(
    robot: Robot, parameters: WalkParameters, present: StanceTarget | None
) -> tuple[float, float, Float[np.ndarray, "legs 3"]]:
    """Return body height, swing height and the feet in B, shape (legs, 3)."""
    if present is None:
        stance = default_stance(robot, parameters.body_height, swing_height=parameters.swing_height)
        return parameters.body_height, parameters.swing_height, stance
    body_height = float(present.posture[2]) - parameters.corrected_body[2]
    swing_height = float(present.posture[SWING_HEIGHT])
    for fractions in (np.ones(1), _FRACTIONS):
        body_heights = body_height + fractions * (parameters.body_height - body_height)
        swing_heights = swing_height + fractions * (parameters.swing_height - swing_height)
        feet = stance_or_nan(robot, body_heights, swing_height=swing_heights)
        works = ~np.isnan(feet).any(axis=(-2, -1))
        if works.any():
            first = int(works.argmax())
            return float(body_heights[first]), float(swing_heights[first]), feet[first]
    raise UnreachableError(f"no leg reaches the ground at body height {parameters.body_height * 1000:.1f} mm")
