"""Paths of several legs through the air."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.startup.leg_path.free_space import LegFreeSpace, Path
from tarsus.errors import UnreachableError
from tarsus.kinematics.pose import Pose
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["leg_paths"]


def leg_paths(
    name: str,
    robot: Robot,
    body: Pose,
    *,
    legs: Bool[np.ndarray, "legs"],
    start: Float[np.ndarray, "legs 3"],
    end: Float[np.ndarray, "legs 3"],
) -> dict[int, Path]:
    """Return a free path for each of some legs, with the body stationary.

    Parameters
    ----------
    name : str
        Name of the motion, for the error message.
    robot : Robot
        A single robot.
    body : Pose
        Pose of B in G.
    legs : array of bool, shape (legs,)
        Legs to move.
    start, end : array, shape (legs, 3)
        Joint angles [rad].

    Raises
    ------
    UnreachableError
        If a leg has no free path.
    """
    paths: dict[int, Path] = {}
    for leg in np.flatnonzero(legs).tolist():
        path = LegFreeSpace.of(robot, leg, body).find_path(start[leg], end[leg])
        if path is None:
            raise UnreachableError(
                f"{name}: at body height {float(body.position[2]) * 1000:.1f} mm, leg {robot.leg_names[leg]} has no "
                f"path through the air from {_degrees(start[leg])} to {_degrees(end[leg])} deg; place the robot on its "
                "belly, or support it higher"
            )
        paths[leg] = path
    return paths


def _degrees(angles: Float[np.ndarray, "*batch 3"]) -> str:
    return "(" + ", ".join(f"{a:.0f}" for a in np.degrees(angles)) + ")"
