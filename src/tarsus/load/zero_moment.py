"""Contact forces on an accelerating robot on flat ground: all six equations of motion are satisfied.

The normal forces have their resultant at the zero-moment point, and are distributed as a weight that acts there
(M. Vukobratovic and B. Borovac, "Zero-moment point - thirty-five years of its life", International Journal of Humanoid
Robotics 1, 2004). The tangential force on each foot is proportional to its normal force, and the moment about the
vertical is distributed by least squares weighted with the normal force. This keeps the required friction coefficient
low.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tarsus.arrays import Array, Namespace
from tarsus.load.contact import distribute_load

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["ground_forces"]

_REGULARISATION = 1e-9  # of a matrix of trace 1: enough to invert it where the bearing feet are collinear
_REFINEMENTS = 3


def ground_forces(
    xp: Namespace,
    feet: Float[Array, "*#batch legs 3"],
    contacts: Bool[Array, "*#batch legs"],
    force: Float[Array, "*#batch 3"],
    moment: Float[Array, "*#batch 3"],
    batch: tuple[int, ...],
) -> tuple[Float[Array, "*batch legs 3"], Float[Array, "*batch"]]:
    """Return the contact forces for a given resultant, and the margin of the zero-moment point.

    Parameters
    ----------
    xp : namespace
        The array library.
    feet : array, shape (..., legs, 3)
        Feet, in G's axes [m].
    contacts : array of bool, shape (..., legs)
        Which feet are on the ground; these should be level.
    force : array, shape (..., 3)
        Resultant force of the ground, in G's axes [N].
    moment : array, shape (..., 3)
        Resultant moment of the ground about the origin of `feet`, in G's axes [N m].
    batch : tuple of int
        Common batch shape.

    Returns
    -------
    forces : array, shape (..., legs, 3)
        Ground on foot [N]. If the zero-moment point is outside the support polygon, the normal forces act at its
        nearest point; if the ground would have to pull, they are 0.
    margin : array, shape (...)
        Distance from the zero-moment point to the nearest edge of the support polygon [m], negative outside; minus
        infinity if the ground would have to pull.
    """
    down = xp.astype(contacts, feet.dtype)
    height = xp.sum(down * feet[..., 2], axis=-1) / xp.maximum(xp.sum(down, axis=-1), xp.asarray(1.0))
    pushing = force[..., 2] > 0
    up = xp.where(pushing, force[..., 2], 1.0)
    zero_moment = xp.stack((height * force[..., 0] - moment[..., 1], height * force[..., 1] + moment[..., 0]), axis=-1)
    zero_moment = xp.where(pushing[..., None], zero_moment / up[..., None], 0.0)
    fractions, margin, nearest = distribute_load(xp, feet[..., :2] - zero_moment[..., None, :], contacts, batch)
    centre = xp.sum(fractions[..., None] * feet, axis=-2)
    remaining = moment - xp.linalg.cross(centre, force)
    # The tipping moment can't be balanced; it follows from the distance of the load from the support polygon.
    tipping = up[..., None] * xp.stack((-nearest[..., 1], nearest[..., 0]), axis=-1)
    remaining = xp.concat((remaining[..., :2] - tipping, remaining[..., 2:]), axis=-1)
    forces = fractions[..., None] * (
        force[..., None, :] + _moment_forces(xp, feet - centre[..., None, :], fractions, remaining)
    )
    return xp.where(pushing[..., None, None], forces, 0.0), xp.where(pushing, margin, -xp.inf)


def _moment_forces(
    xp: Namespace,
    arms: Float[Array, "... legs 3"],
    fractions: Float[Array, "... legs"],
    moment: Float[Array, "*batch 3"],
) -> Float[Array, "... legs 3"]:
    """Return forces per load fraction with zero resultant and a given moment: weighted least squares.

    They are ``mu x arm``, like the velocities of a rotating body, with mu from the inertia tensor of the fractions.
    """
    weighted = fractions[..., None] * arms
    second = xp.matmul(xp.matrix_transpose(weighted), arms)
    trace = second[..., 0, 0] + second[..., 1, 1] + second[..., 2, 2]
    spread = xp.where(trace > 0, trace, 1.0)[..., None, None]
    eye = xp.eye(3, dtype=arms.dtype)
    inertia = (trace[..., None, None] * eye - second) / spread
    inverse = _inverse(xp, inertia + _REGULARISATION * eye)
    target = moment[..., None] / spread
    axis = xp.zeros_like(target)
    for _ in range(_REFINEMENTS):
        axis = axis + xp.matmul(inverse, target - xp.matmul(inertia, axis))
    axis = xp.where(trace[..., None, None] > 0, axis, 0.0)
    return xp.linalg.cross(xp.broadcast_to(axis[..., 0][..., None, :], arms.shape), arms)


def _inverse(xp: Namespace, matrix: Float[Array, "... 3 3"]) -> Float[Array, "*batch 3 3"]:
    """Return the inverses of symmetric matrices ``(..., 3, 3)`` by their adjugates."""
    first, second, third = (matrix[..., i, :] for i in range(3))
    rows = (xp.linalg.cross(second, third), xp.linalg.cross(third, first), xp.linalg.cross(first, second))
    adjugate = xp.stack(rows, axis=-1)
    determinant = xp.sum(first * rows[0], axis=-1)
    return adjugate / determinant[..., None, None]
