"""The ground's forces on a robot that accelerates, on flat ground: all six equations of its motion balance.

Across the ground the forces act together at the zero-moment point, where nothing is left that could tip the robot; the
feet share them as they share a weight that acts there (M. Vukobratovic and B. Borovac, "Zero-moment point - thirty-five
years of its life", International Journal of Humanoid Robotics 1, 2004). Along the ground each foot takes the same part
of the whole, and what turns the robot about the vertical is shared in least squares, weighted with the load: the feet
that are pressed most hold most, and none needs more friction than it must.
"""

from __future__ import annotations

from tarsus.arrays import Array, Namespace
from tarsus.load.contact import shared

__all__ = ["ground_forces"]

_SOFTENING = 1e-9  # relative to a matrix of trace 1: enough to solve it where the feet that bear lie on a line
_ROUNDS = 3


def ground_forces(
    xp: Namespace, feet: Array, contacts: Array, force: Array, moment: Array, batch: tuple[int, ...]
) -> tuple[Array, Array]:
    """Return the forces on the feet that make up a force and a moment, and the margin of the zero-moment point.

    Parameters
    ----------
    xp : namespace
        The array library.
    feet : array, shape (..., legs, 3)
        The feet, in G's axes [m].
    contacts : array of bool, shape (..., legs)
        Which of them are down; those should be level.
    force, moment : array, shape (..., 3)
        What the ground has to exert, the moment about the feet's origin, in G's axes [N, N m].
    batch : tuple of int
        The batch axes that these have together.

    Returns
    -------
    forces : array, shape (..., legs, 3)
        Ground on foot [N]. Where the zero-moment point is outside the polygon of the feet, they balance what
        they can from the nearest point of it; where the ground would have to pull, they are 0.
    margin : array, shape (...)
        Distance from the zero-moment point to the polygon's nearest edge [m], negative outside; minus infinity
        where the ground would have to pull.
    """
    down = xp.astype(contacts, feet.dtype)
    height = xp.sum(down * feet[..., 2], axis=-1) / xp.maximum(xp.sum(down, axis=-1), xp.asarray(1.0))
    pushed = force[..., 2] > 0
    up = xp.where(pushed, force[..., 2], 1.0)
    zero_moment = xp.stack((height * force[..., 0] - moment[..., 1], height * force[..., 1] + moment[..., 0]), axis=-1)
    zero_moment = xp.where(pushed[..., None], zero_moment / up[..., None], 0.0)
    shares, margin, nearest = shared(xp, feet[..., :2] - zero_moment[..., None, :], contacts, batch)
    centre = xp.sum(shares[..., None] * feet, axis=-2)
    rest = moment - xp.linalg.cross(centre, force)
    # What tips the robot is not to be balanced, where it can't be: it is known from how far outside the load is.
    tipping = up[..., None] * xp.stack((-nearest[..., 1], nearest[..., 0]), axis=-1)
    rest = xp.concat((rest[..., :2] - tipping, rest[..., 2:]), axis=-1)
    forces = shares[..., None] * (force[..., None, :] + _turning(xp, feet - centre[..., None, :], shares, rest))
    return xp.where(pushed[..., None, None], forces, 0.0), xp.where(pushed, margin, -xp.inf)


def _turning(xp: Namespace, arms: Array, shares: Array, moment: Array) -> Array:
    """Return forces per share, without a sum, that make up a moment: those of least squares over the shares.

    They are ``mu x arm``, as the speeds of a turning body are, with mu from the inertia of the shares.
    """
    weighted = shares[..., None] * arms
    second = xp.matmul(xp.matrix_transpose(weighted), arms)
    trace = second[..., 0, 0] + second[..., 1, 1] + second[..., 2, 2]
    spread = xp.where(trace > 0, trace, 1.0)[..., None, None]
    eye = xp.eye(3, dtype=arms.dtype)
    inertia = (trace[..., None, None] * eye - second) / spread
    inverse = _inverse(xp, inertia + _SOFTENING * eye)
    goal = moment[..., None] / spread
    axis = xp.zeros_like(goal)
    for _ in range(_ROUNDS):
        axis = axis + xp.matmul(inverse, goal - xp.matmul(inertia, axis))
    axis = xp.where(trace[..., None, None] > 0, axis, 0.0)
    return xp.linalg.cross(xp.broadcast_to(axis[..., 0][..., None, :], arms.shape), arms)


def _inverse(xp: Namespace, matrix: Array) -> Array:
    """Return the inverses of symmetric matrices ``(..., 3, 3)`` by their adjugates."""
    first, second, third = (matrix[..., i, :] for i in range(3))
    rows = (xp.linalg.cross(second, third), xp.linalg.cross(third, first), xp.linalg.cross(first, second))
    adjugate = xp.stack(rows, axis=-1)
    determinant = xp.sum(first * rows[0], axis=-1)
    return adjugate / determinant[..., None, None]
