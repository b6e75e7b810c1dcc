"""Contact forces in static equilibrium."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import (
    Array,
    Namespace,
    as_array,
    as_floats,
    broadcast_shapes,
    is_traced,
    namespace,
    require_finite,
    require_shape,
)
from tarsus.blocks import Index, batch_blocks
from tarsus.errors import InputError
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import STANDARD_GRAVITY, centre_of_mass, total_mass
from tarsus.kinematics.pairs import columns_of
from tarsus.kinematics.polygon import as_mask, margin_and_nearest
from tarsus.kinematics.pose import Pose
from tarsus.load.load_distribution import load_fractions, single_pose_fractions
from tarsus.load.payload import Payload, as_payload
from tarsus.representation import represented
from tarsus.robot.robot import Robot, require_robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["GRAVITY", "ContactForces", "contact_forces"]

GRAVITY = (0.0, 0.0, -STANDARD_GRAVITY)
"""Standard gravity in the ground frame [m/s^2]."""

# Axes that `upward` returns for `GRAVITY`: up, forward, left.
_STANDARD_AXES = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
_STANDARD_AXES.setflags(write=False)

_ROUNDING = 1e-12  # of the margin of a load on the edge of the support polygon [m]
_BLOCK = 1024  # samples in a block, so that the pairs of their feet fit in the second-level cache


@represented()
@dataclass(frozen=True, eq=False, kw_only=True)
class ContactForces:
    """Contact forces on the feet.

    Attributes
    ----------
    forces : array, shape (..., legs, 3)
        Ground on foot, in G [N]. Without an equilibrium, the forces at the onset of tipping.
    margin : array, shape (...)
        Distance of the centre of mass from the nearest edge of the support polygon, projected along gravity [m];
        negative outside: the robot tips.
    weight : array, shape (...)
        Weight of robot and payload [N].
    """

    forces: Float[Array, "*#batch legs 3"]
    margin: Float[Array, "*#batch"]
    weight: Float[Array, "*#batch"]

    @cached_property
    def balanced(self) -> Bool[Array, "*batch"]:
        """Whether there is an equilibrium, array of bool ``(...)``; a load on the edge of the polygon has one."""
        return self.margin >= -_ROUNDING

    @property
    def tipping_moment(self) -> Float[Array, "*batch"]:
        """Unbalanced moment ``(...)`` [N m]; 0 in equilibrium."""
        xp = namespace(self.margin)
        return self.weight * xp.maximum(-self.margin, xp.zeros_like(self.margin))


def contact_forces(
    robot: Robot,
    angles: Float[Array, "*#batch legs 3"],
    body: Pose,
    contacts: Bool[Array, "*#batch legs"],
    *,
    payload: Payload | float = 0.0,
    gravity: Sequence[float] = GRAVITY,
    points: Float[Array, "*#batch legs 4 3"] | None = None,
) -> ContactForces:
    """Return contact forces along gravity in equilibrium: non-negative, with the least sum of squares.

    A foot that would have to pull carries nothing. For a rigid robot at rest the friction forces are statically
    indeterminate; forces along gravity alone are the conservative case for the joints.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs; its masses must be known.
    angles : array, shape (..., legs, 3)
        Joint angles [rad].
    body : Pose
        Pose of B in G.
    contacts : array of bool, shape (..., legs)
        Which feet are on the ground.
    payload : Payload or float
        Payload on the body; a number is a mass at the body's origin [kg].
    gravity : sequence of float
        Gravity in G [m/s^2]; tilted, it represents a slope.
    points : array, shape (..., legs, 4, 3), optional
        Leg points in B [m], if already computed.

    Raises
    ------
    MissingDataError
        If the robot's masses are unknown.
    InputError
        If a shape is wrong, a value is not finite, no foot is on the ground, or gravity is 0.
    """
    require_robot(robot)
    robot.require_masses()
    carried = as_payload(payload)
    strength, axes = upward(gravity)
    points = forward_kinematics(robot, angles) if points is None else points
    mass, com = total_mass(robot), centre_of_mass(robot, angles, points=points)
    xp = namespace(points, contacts, body.rotation, mass, com)
    contacts = checked_contacts(xp, robot, contacts)
    points, mass, com = as_array(xp, points), as_array(xp, mass), as_array(xp, com)
    load = (com * mass[..., None] + carried.mass * as_array(xp, np.array(carried.position))) / (
        mass[..., None] + carried.mass
    )
    # With the load at the origin, only the foot coordinates perpendicular to gravity matter.
    projection = xp.matmul(as_array(xp, axes[1:]), as_array(xp, body.rotation))
    feet = xp.matmul(points[..., 3, :] - load[..., None, :], xp.matrix_transpose(projection))
    batch = broadcast_shapes("robot, angles, body and contacts", feet.shape[:-2], contacts.shape[:-1])
    fractions, margin, _ = distribute_load(xp, feet, contacts, batch)
    weight = (mass + carried.mass) * strength + xp.zeros(batch, dtype=feet.dtype)
    forces = (fractions * weight[..., None])[..., None] * as_array(xp, axes[0])
    return ContactForces(forces=forces, margin=margin, weight=weight)


def checked_contacts(xp: Namespace, robot: Robot, contacts: Bool[Array, "*#batch legs"]) -> Bool[Array, "*batch legs"]:
    """Validate contacts; every sample needs a foot on the ground.

    Parameters
    ----------
    xp : namespace
        The array library.
    robot : Robot
        The robot.
    contacts : array of bool, shape (..., legs)
        Which feet are on the ground.

    Returns
    -------
    array of bool, shape (..., legs)
        The same.

    Raises
    ------
    InputError
        If the shape is wrong, the contacts are not boolean, or a sample has no foot on the ground; the message names
        the sample.
    """
    contacts = as_mask(xp, contacts, name="contacts")
    require_shape("contacts", contacts, (robot.legs,))
    if not is_traced(contacts) and not bool(xp.all(xp.any(contacts, axis=-1))):
        airborne = np.argwhere(~np.asarray(contacts).any(-1))
        where = f" in sample {', '.join(map(str, airborne[0]))}" if contacts.ndim > 1 else ""
        more = f" (and {len(airborne) - 1} more)" if len(airborne) > 1 else ""
        raise InputError(f"no foot is on the ground{where}{more}; at least one must be")
    return contacts


def upward(gravity: Sequence[float]) -> tuple[float, Float[np.ndarray, "3 3"]]:
    """Return the magnitude of gravity and an orthonormal basis in G whose first axis points against gravity.

    Parameters
    ----------
    gravity : sequence of float
        Gravity in G [m/s^2].

    Returns
    -------
    magnitude : float
        Magnitude of gravity [m/s^2].
    basis : array, shape (3, 3)
        Unit vectors as rows: up, and two perpendicular to it.

    Raises
    ------
    InputError
        If gravity is not three finite numbers, or is 0.
    """
    if gravity is GRAVITY:
        return STANDARD_GRAVITY, _STANDARD_AXES
    vector = as_floats(np, gravity, name="gravity")
    require_finite("gravity", vector)
    if vector.shape != (3,) or not vector.any():
        raise InputError(f"gravity is {gravity!r}; it must be three finite numbers, not all 0")
    strength = float(np.linalg.norm(vector))
    up = -vector / strength
    # Start from the axis, x or y, with the smaller component along gravity; on level ground that is x.
    start = np.eye(3)[int(abs(up[0]) > abs(up[1]))]
    first = start - up * (start @ up)
    first /= np.linalg.norm(first)
    return strength, np.stack([up, first, np.cross(up, first)])


def distribute_load(
    xp: Namespace, feet: Float[Array, "*#batch legs 2"], contacts: Bool[Array, "*#batch legs"], batch: tuple[int, ...]
) -> tuple[Float[Array, "*batch legs"], Float[Array, "*batch"], Float[Array, "*batch 2"]]:
    """Return the load fractions of feet for a load at the origin, or at the nearest point of the support polygon.

    Parameters
    ----------
    xp : namespace
        The array library.
    feet : array, shape (..., legs, 2)
        Feet in the plane perpendicular to gravity [m].
    contacts : array of bool, shape (..., legs)
        Which feet are on the ground.
    batch : tuple of int
        Common batch shape.

    Returns
    -------
    fractions : array, shape (..., legs)
        Fraction of the load on each foot, at least 0.
    margin : array, shape (...)
        Distance of the load from the nearest edge of the support polygon [m]; negative outside.
    nearest : array, shape (..., 2)
        Point of the support polygon nearest to the load [m]; the origin if the load is inside.
    """
    legs = feet.shape[-2]
    if xp is np and not batch and (single := single_pose_fractions(feet.tolist(), contacts.tolist())) is not None:
        return np.array(single[0]), np.float64(single[1]), np.zeros(2)
    if xp is not np:
        rows = _distribute_block(xp, feet, contacts, batch, ())
    else:
        rows = np.empty((legs + 3, *batch))
        for index in batch_blocks(batch, _BLOCK):
            selection = (slice(None), *index)
            rows[selection] = _distribute_block(np, feet, contacts, batch, index).reshape(rows[selection].shape)
    by_sample = xp.reshape(xp.permute_dims(xp.reshape(rows, (legs + 3, -1)), (1, 0)), (*batch, legs + 3))
    return by_sample[..., :legs], by_sample[..., legs], by_sample[..., legs + 1 :]


def _distribute_block(
    xp: Namespace,
    feet: Float[Array, "*#batch legs 2"],
    contacts: Bool[Array, "*#batch legs"],
    batch: tuple[int, ...],
    index: Index,
) -> Float[Array, "..."]:
    coordinates = columns_of(xp, feet, batch, index, tail=2)
    x, y = coordinates[0, ...], coordinates[1, ...]
    down = columns_of(xp, contacts, batch, index, tail=1)
    x, y, down = (xp.broadcast_to(selection, np.broadcast_shapes(x.shape, down.shape)) for selection in (x, y, down))
    margin, near_x, near_y = margin_and_nearest(xp, x, y, down)
    fractions = load_fractions(xp, x - near_x, y - near_y, down)
    return xp.concat((fractions, xp.stack((margin, near_x, near_y))), axis=0)
