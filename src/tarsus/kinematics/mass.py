"""Mass and centre of mass of the robot: body and links."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np

from tarsus.arrays import Array, Namespace, as_array, as_floats, broadcast_shapes, namespace, require_shape, stack_last
from tarsus.kinematics.leg import forward_kinematics
from tarsus.robot.robot import Robot, require_robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["STANDARD_GRAVITY", "MassWeights", "centre_of_mass", "known_weight", "point_masses", "total_mass"]

STANDARD_GRAVITY = 9.80665
"""Standard gravity (ISO 80000-3) [m/s^2]."""


def total_mass(robot: Robot) -> Float[Array, "*batch"]:
    """Return the mass of the robot: its body and all its links.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs.

    Returns
    -------
    array, shape (...)
        Mass [kg].

    Raises
    ------
    MissingDataError
        If the mass of the body or of a link is unknown.
    """
    require_robot(robot)
    robot.require_masses()
    xp = namespace(robot.body_mass, robot.link_mass)
    links = xp.sum(as_array(xp, robot.link_mass), axis=(-2, -1))
    return xp.asarray(as_array(xp, robot.body_mass) + links)


def known_weight(robot: Robot) -> float:
    """Return the weight of a robot; 0 where its masses are unknown [N].

    Parameters
    ----------
    robot : Robot
        A single robot.
    """
    return float(total_mass(robot)) * STANDARD_GRAVITY if robot.has_masses else 0.0


def centre_of_mass(
    robot: Robot,
    angles: Float[Array, "*#batch legs 3"] | None,
    *,
    points: Float[Array, "*#batch legs 4 3"] | None = None,
) -> Float[Array, "*batch 3"]:
    """Return the centre of mass of body and links.

    The mass of each link is at the distance ``link_com`` from its inner joint, on the line to the next leg point; where
    coxa axis and femur axis coincide, the mass of the coxa is there.

    Without masses in the robot file, the links count as massless and the result is the centre of mass of the body: an
    assumption to be stated with the result (see ``robot.has_masses``).

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs.
    angles : array, shape (..., legs, 3)
        Joint angles [rad].
    points : array, shape (..., legs, 4, 3), optional
        Result of `forward_kinematics`, where it is known already; `angles` is then ignored.

    Returns
    -------
    array, shape (..., 3)
        Centre of mass in B [m].

    Raises
    ------
    InputError
        If the angles have the wrong shape or are not finite.

    Notes
    -----
    The mean of the positions weighted by the masses. A mass at the fraction s of the length of a link is equivalent to
    (1 - s) of it at the inner end and s of it at the outer end, so that the result is one weighted sum of leg points.
    """
    points = forward_kinematics(robot, angles) if points is None else points
    xp = namespace(points, robot.body_com, robot.body_mass, robot.link_mass, robot.link_com)
    points = as_floats(xp, points, name="points")
    require_shape("points", points, (robot.legs, 4, 3))
    body_com = as_array(xp, robot.body_com)
    if not robot.has_masses:
        shape = broadcast_shapes("robot and angles", points.shape[:-3], body_com.shape[:-1])
        return body_com + xp.zeros((*shape, 3), dtype=points.dtype)
    masses = point_masses(xp, robot)
    weights = xp.reshape(masses, (*masses.shape[:-2], 1, 4 * robot.legs))
    moment = xp.matmul(weights, xp.reshape(points, (*points.shape[:-3], 4 * robot.legs, 3)))[..., 0, :]
    moment = moment + as_array(xp, robot.body_mass)[..., None] * body_com
    return moment / as_array(xp, total_mass(robot))[..., None]


def point_masses(xp: Namespace, robot: Robot) -> Float[Array, "*batch legs 4"]:
    """Return point masses at the leg points that are equivalent to the links: same mass, same centre of mass.

    Parameters
    ----------
    xp : namespace
        The array library.
    robot : Robot
        The robot, or a batch of designs, with known masses.

    Returns
    -------
    array, shape (..., legs, 4)
        Masses at coxa axis, femur axis, knee and foot [kg]; negative for a centre of mass beyond its link.
    """
    legs = robot.geometry.to(xp)
    coxa2 = legs.coxa * legs.coxa + legs.side2 + legs.up * legs.up
    # The square root has no derivative at 0: it is taken of 1 there, and the fraction is set to 0.
    has_coxa = coxa2 > 0
    coxa = xp.where(has_coxa, xp.sqrt(xp.where(has_coxa, coxa2, xp.ones_like(coxa2))), xp.asarray(xp.inf))
    fraction = as_array(xp, robot.link_com) / stack_last(xp, (coxa, legs.femur, legs.tibia))
    mass = as_array(xp, robot.link_mass)
    outer = mass * fraction
    inner = mass - outer
    none = xp.zeros_like(outer[..., :1])
    return xp.concat((inner, none), axis=-1) + xp.concat((none, outer), axis=-1)


@dataclass(frozen=True, eq=False)
class MassWeights:
    """The weights of the leg points in the centre of mass of a single robot, computed once for many configurations.

    Attributes
    ----------
    weights : array, shape (4 legs,)
        Fractions of the total mass at the leg points; 0 for a robot without masses, as in `centre_of_mass`.
    offset : array, shape (3,)
        Contribution of the body, in B [m].
    """

    weights: Float[np.ndarray, "points"]
    offset: Float[np.ndarray, "3"]

    @classmethod
    def of(cls, robot: Robot) -> Self:
        """Compute the weights.

        Parameters
        ----------
        robot : Robot
            A single robot.
        """
        body_com = np.asarray(robot.body_com)
        if not robot.has_masses:
            return cls(np.zeros(4 * robot.legs), body_com)
        total = np.asarray(total_mass(robot))
        weights = np.asarray(point_masses(np, robot)).reshape(-1) / total
        return cls(weights, np.asarray(robot.body_mass) / total * body_com)

    def centre_of_mass(self, points: Float[np.ndarray, "legs 4 3"]) -> Float[np.ndarray, "3"]:
        """Return the centre of mass in B [m].

        Parameters
        ----------
        points : array, shape (legs, 4, 3)
            Result of `forward_kinematics` [m].
        """
        com: np.ndarray = self.weights @ points.reshape(-1, 3) + self.offset
        return com
