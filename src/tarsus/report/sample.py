"""One moment of a robot, with all that a picture shows of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.polygon import hull_margin
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.rest import CORNERS, RestingPose
from tarsus.robot.robot import Robot

__all__ = ["Sample", "sample_of", "touching_points"]

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
    support : array, shape (k, 3)
        The points on the ground that hold it, in G [m]: mostly the feet that are down.
    margin : float
        How far inside their polygon the centre of mass is [m]; minus infinity where nothing holds it.
    """

    points: Floats
    body: Pose
    contacts: np.ndarray[Any, Any]
    com: Floats
    support: Floats
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
    support: Floats | None = None,
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
    support : array, shape (k, 3), optional
        The points of G that hold the robot [m]; left out, the feet that bear load.

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
    com = np.asarray(body @ centre_of_mass(robot, angles, points=points))
    held = in_ground[down, 3] if support is None else np.asarray(support)
    return Sample(
        points=in_ground,
        body=body,
        contacts=down,
        com=com,
        support=held,
        margin=float(hull_margin(held[:, :2], np.ones(len(held), dtype=bool), com[:2])),
    )


def touching_points(rest: RestingPose, angles: Floats) -> Floats:
    """Return the points of a resting robot that touch the ground.

    Parameters
    ----------
    rest : Rest
        How it rests; one configuration.
    angles : array, shape (legs, 3)
        Its joint angles [rad].

    Returns
    -------
    array, shape (k, 3)
        In G [m].
    """
    parts = [np.asarray(forward_kinematics(rest.robot, angles))[np.asarray(rest.leg_points_down)]]
    if rest.robot.body_size is not None:
        parts.append((CORNERS * np.asarray(rest.robot.body_size))[np.asarray(rest.corners_down)])
    touching: Floats = np.asarray(rest.body @ np.concatenate(parts))
    return touching
