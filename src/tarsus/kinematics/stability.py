"""Static stability margin of the robot."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tarsus.arrays import Array, as_array, as_floats, broadcast_shapes, namespace, require_shape
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.polygon import as_mask, hull_margin
from tarsus.kinematics.pose import Pose
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["stability_margin"]


def stability_margin(
    robot: Robot,
    angles: Float[Array, "*#batch legs 3"] | None,
    body: Pose,
    contacts: Bool[Array, "*#batch legs"],
    *,
    points: Float[Array, "*#batch legs 4 3"] | None = None,
) -> Float[Array, "*batch"]:
    """Return the static stability margin on flat ground.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs; without masses, see `centre_of_mass`.
    angles : array, shape (..., legs, 3)
        Joint angles [rad].
    body : Pose
        Pose of B in G, single or in a batch.
    contacts : array of bool, shape (..., legs)
        Which feet are on the ground.
    points : array, shape (..., legs, 4, 3), optional
        Result of `forward_kinematics`, where it is known already; `angles` is then ignored.

    Returns
    -------
    array, shape (...)
        Distance from the projected centre of mass to the nearest edge of the support polygon [m]; minus the distance to
        the polygon where the centre of mass is outside it; minus infinity without contacts.

    Raises
    ------
    InputError
        If a shape is wrong, an angle is not finite, or `contacts` is not of booleans.

    Notes
    -----
    R. B. McGhee and A. A. Frank, "On the stability properties of quadruped creeping gaits", Mathematical
    Biosciences 3 (1968). The result depends on the rotation of the body only, not on its position.
    """
    points = forward_kinematics(robot, angles) if points is None else points
    com = centre_of_mass(robot, angles, points=points)
    xp = namespace(com, points, contacts, body.rotation, body.position)
    contacts = as_mask(xp, contacts, name="contacts")
    require_shape("contacts", contacts, (robot.legs,))
    points = as_floats(xp, points, name="points")
    level = xp.matrix_transpose(as_array(xp, body.rotation)[..., :2, :])
    feet = xp.matmul(points[..., 3, :] - as_array(xp, com)[..., None, :], level)
    batch = broadcast_shapes("angles, body and contacts", feet.shape[:-2], body.batch_shape, contacts.shape[:-1])
    feet = xp.broadcast_to(feet, (*batch, robot.legs, 2))
    return hull_margin(feet, contacts, xp.zeros(2, dtype=feet.dtype))
