"""The pose in which zeros are set."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["reference_angles"]

# A right angle between a level femur and the tibia can be checked with a set square.
_REFERENCE = (0.0, 0.0, math.radians(-90))


def reference_angles(robot: Robot) -> Float[np.ndarray, "legs 3"]:
    """Return the pose in which zeros are set: femurs level, tibias vertical, as near as the limits allow [rad].

    Parameters
    ----------
    robot : Robot
        A single robot.
    """
    limits = np.asarray(robot.limits)
    return np.asarray(np.clip(np.tile(_REFERENCE, (robot.legs, 1)), limits[..., 0], limits[..., 1]))
