"""Inertias of body and links: uniform boxes, as robot files give masses and centres of mass only."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.robot.robot import JOINTS, Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["BODY_HEIGHT", "SECTION", "RigidBody", "body_inertia", "link_inertia", "link_step"]

SECTION = 0.025
"""Width and height of the box that stands for a link in its inertia: those of a servo and its bracket [m]."""

BODY_HEIGHT = 0.05
"""Height of a body whose size is unknown, for its inertia [m]."""


class RigidBody(NamedTuple):
    """Mass and inertia of a body or link, in its frame.

    Attributes
    ----------
    mass : float
        Mass [kg].
    centre : array, shape (3,)
        Centre of mass [m].
    moments : tuple of float
        Principal moments of inertia about it, the first along `axis` [kg m^2].
    axis : array, shape (3,)
        Direction of the first principal axis; zero where all moments are equal, or the principal axes are those of the
        frame.
    """

    mass: float
    centre: Float[np.ndarray, "3"]
    moments: tuple[float, float, float]
    axis: Float[np.ndarray, "3"]

    @property
    def matrix(self) -> Float[np.ndarray, "3 3"]:
        """Inertia about the centre of mass, along the axes of the frame ``(3, 3)`` [kg m^2]."""
        if not self.axis.any():
            return np.diag(self.moments)
        along, across, _ = self.moments
        return across * np.eye(3) + (along - across) * np.outer(self.axis, self.axis)


def link_step(robot: Robot, leg: int, joint: int) -> Float[np.ndarray, "3"]:
    """Return the end of a link in its frame, shape (3,) [m]: the next joint axis, or the foot point.

    Parameters
    ----------
    robot : Robot
        A single robot.
    leg, joint : int
        Which link: the one that the joint moves.
    """
    side, up = np.asarray(robot.femur_axis_offset[leg]).tolist() if joint == 0 else (0.0, 0.0)
    return np.array([float(getattr(robot, JOINTS[joint])[leg]), side, up])


def body_inertia(robot: Robot) -> RigidBody:
    """Return mass and inertia of the body: a uniform box of its size, or around the coxa axes where that is unknown.

    Parameters
    ----------
    robot : Robot
        A single robot with masses.
    """
    size = robot.body_size
    if size is None:
        size = np.append(np.ptp(np.asarray(robot.mount_position)[:, :2], axis=0), BODY_HEIGHT)
    mass = float(np.asarray(robot.body_mass))
    return RigidBody(mass, np.array(robot.body_com, dtype=float), _box(mass, np.asarray(size)), np.zeros(3))


def link_inertia(robot: Robot, leg: int, joint: int) -> RigidBody:
    """Return mass and inertia of a link: a uniform box as long as the link, its centre of mass as in the file.

    Parameters
    ----------
    robot : Robot
        A single robot with masses.
    leg, joint : int
        Which link: the one that the joint moves.
    """
    step = link_step(robot, leg, joint)
    length = float(np.linalg.norm(step))
    along = step / length if length else np.zeros(3)
    mass = float(np.asarray(robot.link_mass)[leg, joint])
    moments = _box(mass, np.array([max(length, SECTION), SECTION, SECTION]))
    return RigidBody(mass, float(robot.link_com[leg, joint]) * along, moments, along)


def _box(mass: float, size: Float[np.ndarray, "3"]) -> tuple[float, float, float]:
    """Return the principal moments of inertia of a uniform box about its centre [kg m^2]."""
    x, y, z = (float(edge) ** 2 for edge in size)
    return mass * (y + z) / 12, mass * (x + z) / 12, mass * (x + y) / 12
