"""What the ground pushes on the feet with, so that the robot is in equilibrium."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

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
from tarsus.kinematics.mass import centre_of_mass, total_mass
from tarsus.kinematics.pairs import columns_of
from tarsus.kinematics.polygon import as_mask, margin_and_nearest
from tarsus.kinematics.pose import Pose
from tarsus.load.load_distribution import shared_load
from tarsus.load.payload import Payload, as_payload
from tarsus.robot.robot import Robot

__all__ = ["GRAVITY", "ContactForces", "contact_forces"]

GRAVITY = (0.0, 0.0, -9.80665)
"""Standard gravity in the ground frame [m/s^2]."""

_ROUNDING = 1e-12  # how far outside the polygon rounding may put a load that acts on its very edge [m]
_BLOCK = 1024  # samples in a block: the pairs of their feet stay in a core's second-level cache


@dataclass(frozen=True, eq=False, kw_only=True)
class ContactForces:
    """The ground's forces on the feet.

    Attributes
    ----------
    forces : array, shape (..., legs, 3)
        Ground on foot, in G [N]. Where there is no equilibrium, those with which the robot begins to tip.
    margin : array, shape (...)
        How far inside the polygon of the feet the load acts, seen along gravity [m]. Negative: the robot tips, and
        the load is this far outside.
    weight : array, shape (...)
        Weight of robot and payload [N].
    """

    forces: Array
    margin: Array
    weight: Array

    @cached_property
    def balanced(self) -> Array:
        """Whether there is an equilibrium ``(...)``; a load on the very edge of the polygon still has one."""
        return self.margin >= -_ROUNDING

    @property
    def tipping_moment(self) -> Array:
        """Moment that is missing for an equilibrium ``(...)`` [N m]; 0 where there is one."""
        xp = namespace(self.margin)
        return self.weight * xp.maximum(-self.margin, xp.zeros_like(self.margin))


def contact_forces(
    robot: Robot,
    angles: Array,
    body: Pose,
    contacts: Array,
    *,
    payload: Payload | float = 0.0,
    gravity: Sequence[float] = GRAVITY,
    points: Array | None = None,
) -> ContactForces:
    """Return the forces along gravity that hold the robot up: not negative, least squares over more than three feet.

    A foot that would have to pull gets none, and the rest balance. A settled rigid robot leaves friction undetermined;
    forces along gravity alone are the conservative case for the joints.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs; its masses must be known.
    angles : array, shape (..., legs, 3)
        Joint angles [rad].
    body : Pose
        Places of B in G.
    contacts : array of bool, shape (..., legs)
        Which feet are on the ground.
    payload : Payload or float
        What the body carries; a number is a mass at its origin [kg].
    gravity : sequence of float
        Gravity in G [m/s^2]: tilted, it is that of a slope.
    points : array, shape (..., legs, 4, 3), optional
        Leg points in B, where they are known already.

    Raises
    ------
    MissingDataError
        If the robot's masses are unknown.
    InputError
        If a shape is wrong, a value is not finite, no foot is down, or there is no gravity.
    """
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
    # Seen along gravity, with the load at the origin, only the feet's two coordinates across it count.
    across = xp.matmul(as_array(xp, axes[1:]), as_array(xp, body.rotation))
    feet = xp.matmul(points[..., 3, :] - load[..., None, :], xp.matrix_transpose(across))
    batch = broadcast_shapes("robot, angles, body and contacts", feet.shape[:-2], contacts.shape[:-1])
    shares, margin, _ = shared(xp, feet, contacts, batch)
    weight = (mass + carried.mass) * strength + xp.zeros(batch, dtype=feet.dtype)
    forces = (shares * weight[..., None])[..., None] * as_array(xp, axes[0])
    return ContactForces(forces=forces, margin=margin, weight=weight)


def checked_contacts(xp: Namespace, robot: Robot, contacts: Array) -> Array:
    """Return which feet are down, refusing samples in which none is.

    Parameters
    ----------
    xp : namespace
        The array library.
    robot : Robot
        Whose feet.
    contacts : array of bool, shape (..., legs)
        Which feet are on the ground.

    Raises
    ------
    InputError
        If the shape is wrong, they are not booleans, or no foot is down in some sample; the message says in which.
    """
    contacts = as_mask(xp, contacts, name="contacts")
    require_shape("contacts", contacts, (robot.legs,))
    if not is_traced(contacts) and not bool(xp.all(xp.any(contacts, axis=-1))):
        hanging = np.argwhere(~np.asarray(contacts).any(-1))
        where = f" in sample {', '.join(map(str, hanging[0]))}" if contacts.ndim > 1 else ""
        more = f" (and {len(hanging) - 1} more)" if len(hanging) > 1 else ""
        raise InputError(f"no foot is on the ground{where}{more}: nothing carries the robot")
    return contacts


def upward(gravity: Sequence[float]) -> tuple[float, np.ndarray[Any, Any]]:
    """Return the strength of gravity, and unit vectors in G: against it, and two across it and each other.

    Parameters
    ----------
    gravity : sequence of float
        Gravity in G [m/s^2].

    Raises
    ------
    InputError
        If it is not three finite numbers, or 0.
    """
    vector = as_floats(np, gravity, name="gravity")
    require_finite("gravity", vector)
    if vector.shape != (3,) or not vector.any():
        raise InputError(f"gravity is {gravity!r}; it must be three numbers, not all of them 0")
    strength = float(np.linalg.norm(vector))
    up = -vector / strength
    # Of x and y the one that is more across; on level ground the first is x itself.
    aside = np.eye(3)[int(abs(up[0]) > abs(up[1]))]
    first = aside - up * (aside @ up)
    first /= np.linalg.norm(first)
    return strength, np.stack([up, first, np.cross(up, first)])


def shared(xp: Namespace, feet: Array, contacts: Array, batch: tuple[int, ...]) -> tuple[Array, Array, Array]:
    """Return how feet share a load that acts at the origin of a plane, or the nearest point where it can act.

    Parameters
    ----------
    xp : namespace
        The array library.
    feet : array, shape (..., legs, 2)
        The feet in that plane [m].
    contacts : array of bool, shape (..., legs)
        Which of them are down.
    batch : tuple of int
        The batch axes that these have together.

    Returns
    -------
    shares : array, shape (..., legs)
        Shares of the load, not negative.
    margin : array, shape (...)
        How far inside the polygon of the feet the load acts [m]; negative outside.
    nearest : array, shape (..., 2)
        The nearest point of the polygon: the origin where that is inside [m].
    """
    legs = feet.shape[-2]
    if xp is not np:
        rows = _share_block(xp, feet, contacts, batch, ())
    else:
        rows = np.empty((legs + 3, *batch))
        for index in batch_blocks(batch, _BLOCK):
            part = (slice(None), *index)
            rows[part] = _share_block(np, feet, contacts, batch, index).reshape(rows[part].shape)
    by_sample = xp.reshape(xp.permute_dims(xp.reshape(rows, (legs + 3, -1)), (1, 0)), (*batch, legs + 3))
    return by_sample[..., :legs], by_sample[..., legs], by_sample[..., legs + 1 :]


def _share_block(xp: Namespace, feet: Array, contacts: Array, batch: tuple[int, ...], index: Index) -> Array:
    both = columns_of(xp, feet, batch, index, tail=2)
    x, y = both[0, ...], both[1, ...]
    down = columns_of(xp, contacts, batch, index, tail=1)
    x, y, down = (xp.broadcast_to(part, np.broadcast_shapes(x.shape, down.shape)) for part in (x, y, down))
    margin, near_x, near_y = margin_and_nearest(xp, x, y, down)
    shares = shared_load(xp, x - near_x, y - near_y, down)
    return xp.concat((shares, xp.stack((margin, near_x, near_y))), axis=0)
