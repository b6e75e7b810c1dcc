"""One moment of a robot, with all that a picture shows of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stability import stability_margin
from tarsus.robot.robot import Robot

__all__ = ["Sample", "sample_of"]

Floats = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True, eq=False, kw_only=True)
class Sample:
    """One moment to be drawn.

    Attributes
    ----------
    points : array, shape (legs, 4, 3)
        Leg points in G [m].
    body : Pose
        The body's place in G.
    contacts : array of bool, shape (legs,)
        Which feet are on the ground.
    com : array, shape (3,)
        Centre of mass in G [m].
    margin : float
        Stability margin [m].
    """

    points: Floats
    body: Pose
    contacts: np.ndarray[Any, Any]
    com: Floats
    margin: float

    @property
    def centre(self) -> Floats:
        """The ground under the body's origin ``(3,)`` [m]."""
        position = np.array(self.body.position)
        position[2] = 0.0
        return position


def sample_of(
    robot: Robot,
    angles: Floats,
    *,
    body: Pose | None = None,
    contacts: Sequence[bool] | np.ndarray[Any, Any] | None = None,
) -> Sample:
    """Return what is to be drawn of one configuration.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Joint angles [rad].
    body : Pose, optional
        The body's place in G; left out, level and so high that the lowest foot touches the ground.
    contacts : sequence of bool, optional
        Which feet bear load; left out, those within a millimetre of the ground.

    Raises
    ------
    InputError
        If the angles have the wrong shape, or are not finite.
    """
    points = np.asarray(forward_kinematics(robot, angles))
    if body is None:
        body = Pose.from_rpy(position=(0.0, 0.0, -float(points[:, 3, 2].min())))
    in_ground = np.asarray(body @ points)
    down = in_ground[:, 3, 2] < 0.001 if contacts is None else np.asarray(contacts, dtype=bool)
    return Sample(
        points=in_ground,
        body=body,
        contacts=down,
        com=np.asarray(body @ centre_of_mass(robot, angles, points=points)),
        margin=float(stability_margin(robot, angles, body, down, points=points)),
    )
