"""State of a robot to draw."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.polygon import hull_margin
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.rest import CORNERS, RestingPose
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["Sample", "sample_of", "touching_points"]


@dataclass(frozen=True, eq=False, kw_only=True)
class Sample:
    """State of a robot to draw.

    Attributes
    ----------
    points : array, shape (legs, 4, 3)
        Leg points in G [m].
    body : Pose
        Pose of B in G.
    contacts : array of bool, shape (legs,)
        Which feet are on the ground.
    com : array, shape (3,)
        Centre of mass in G [m].
    support : array, shape (k, 3)
        Points that touch the ground, in G [m]; usually the feet in contact.
    margin : float
        Distance of the centre of mass from the nearest edge of the polygon of the support points [m]; minus infinity
        without a point.
    """

    points: Float[np.ndarray, "legs 4 3"]
    body: Pose
    contacts: Bool[np.ndarray, "legs"]
    com: Float[np.ndarray, "3"]
    support: Float[np.ndarray, "k 3"]
    margin: float

    @property
    def centre(self) -> Float[np.ndarray, "3"]:
        """Ground point below the body's origin ``(3,)`` [m]."""
        position = np.array(self.body.position)
        position[2] = 0.0
        return position


def sample_of(
    robot: Robot,
    angles: Float[np.ndarray, "legs 3"],
    *,
    body: Pose | None = None,
    contacts: Sequence[bool] | Bool[np.ndarray, "legs"] | None = None,
    support: Float[np.ndarray, "k 3"] | None = None,
) -> Sample:
    """Return the state to draw for one configuration.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Joint angles [rad].
    body : Pose, optional
        Pose of B in G. Default: level, with the lowest foot on the ground.
    contacts : sequence of bool, optional
        Which feet bear load. Default: those within 1 mm of the ground.
    support : array, shape (k, 3), optional
        Points that support the robot, in G [m]. Default: the feet that bear load.

    Raises
    ------
    InputError
        If the angles have the wrong shape, or are not finite.
    """
    points = np.asarray(forward_kinematics(robot, angles))
    if body is None:
        body = Pose.from_rpy(position=(0.0, 0.0, -float(points[:, 3, 2].min())))
    in_ground = np.asarray(body @ points)
    in_contact = in_ground[:, 3, 2] < 0.001 if contacts is None else np.asarray(contacts, dtype=bool)
    com = np.asarray(body @ centre_of_mass(robot, angles, points=points))
    support_points = in_ground[in_contact, 3] if support is None else np.asarray(support)
    return Sample(
        points=in_ground,
        body=body,
        contacts=in_contact,
        com=com,
        support=support_points,
        margin=float(hull_margin(support_points[:, :2], np.ones(len(support_points), dtype=bool), com[:2])),
    )


def touching_points(rest: RestingPose, angles: Float[np.ndarray, "legs 3"]) -> Float[np.ndarray, "k 3"]:
    """Return the points of a robot at rest that touch the ground.

    Parameters
    ----------
    rest : RestingPose
        Resting pose of one configuration.
    angles : array, shape (legs, 3)
        Joint angles [rad].

    Returns
    -------
    array, shape (k, 3)
        Points in G [m].
    """
    points = [np.asarray(forward_kinematics(rest.robot, angles))[np.asarray(rest.leg_points_down)]]
    if rest.robot.body_size is not None:
        points.append((CORNERS * np.asarray(rest.robot.body_size))[np.asarray(rest.corners_down)])
    touching: np.ndarray = np.asarray(rest.body @ np.concatenate(points))
    return touching
