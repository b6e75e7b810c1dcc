"""Newton steps towards the equilibrium, from the tangent of its equations."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.load.compliant.balance import Balance, Configuration, Demand
from tarsus.load.compliant.equilibrium import ROLL, Compliant
from tarsus.load.compliant.friction import contact_stiffness

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["contact_jacobian", "newton_step"]

# Permutation symbol: row b of `_CROSS` holds, for each k, e_k x e_b.
_EPSILON = np.zeros((3, 3, 3))
_EPSILON[0, 1, 2] = _EPSILON[1, 2, 0] = _EPSILON[2, 0, 1] = 1.0
_EPSILON[0, 2, 1] = _EPSILON[2, 1, 0] = _EPSILON[1, 0, 2] = -1.0
_CROSS = np.einsum("akb->bka", _EPSILON).reshape(3, 9)
_BY_FORCE = _EPSILON.reshape(3, 9)
# Indices into `Balance.generalised` of the second derivatives cc to tt, for the elements of a symmetric 3 x 3 matrix.
_SECOND = 3 + np.array([0, 1, 2, 1, 3, 4, 2, 4, 5])
_UNIT = np.eye(3)


def contact_jacobian(compliant: Compliant, at: Configuration) -> Float[np.ndarray, "legs 9 3"]:
    """Return the derivatives of the contact points in G by body translation, body rotation and joint angles.

    Parameters
    ----------
    compliant : Compliant
        The robot.
    at : Configuration
        The configuration.

    Returns
    -------
    array, shape (legs, 9, 3)
        Rows: translation of B along G's axes, rotation about them, coxa, femur and tibia [1, m/rad].
    """
    jacobian = np.empty((compliant.legs, 9, 3))
    jacobian[:, :3] = _UNIT
    jacobian[:, 3:6] = at.points[:, 0, 6:9].dot(_CROSS).reshape(-1, 3, 3)
    rolling = at.points[:, 1:4, 9:].reshape(-1, 3).dot(ROLL)
    jacobian[:, 6:] = (at.points[:, 1:4, 6:9].reshape(-1, 3) - rolling).reshape(-1, 3, 3)
    return jacobian


def newton_step(
    compliant: Compliant,
    at: Configuration,
    balance: Balance,
    jacobian: Float[np.ndarray, "legs 9 3"],
    demand: Demand,
    *,
    frozen: bool,
) -> Float[np.ndarray, "unknowns"]:
    """Return the Newton step of the body, along and about G's axes, and of the joint angles, ``(6 + 3 legs,)``.

    Parameters
    ----------
    compliant : Compliant
        The robot.
    at : Configuration
        The configuration.
    balance : Balance
        Its balance.
    jacobian : array, shape (legs, 9, 3)
        `contact_jacobian`.
    demand : Demand
        Commands and loads.
    frozen : bool
        Whether the limits of friction are frozen.
    """
    legs, contact = compliant.legs, compliant.contact
    stiffness = contact_stiffness(
        at.trial,
        balance.fraction,
        contact.relaxation(demand.step) * contact.tangential_stiffness,
        at.normal.astype(bool) * contact.normal_stiffness,
        0.0 if frozen else contact.friction,
    )
    each = (jacobian @ stiffness) @ jacobian.transpose(0, 2, 1)
    # The points turn with the body; the forces on them keep their directions in G.
    crossed = balance.forces[:, :9].reshape(-1, 3).dot(_BY_FORCE).reshape(legs, 9, 3)
    turning = (at.points[:, 1:4, :9] @ crossed).reshape(-1, 3)
    joints = each[:, 6:, 6:] - balance.generalised.take(_SECOND, axis=1).reshape(legs, 3, 3)
    body = compliant.every.dot(each.reshape(legs, 81)).reshape(9, 9)
    body[3:6, 3:6] -= balance.moments - balance.moments.trace() * _UNIT
    # The solver is faster with a column-major matrix; the resistance is symmetric.
    tangent = demand.resistance.copy().T
    tangent.T.reshape(-1)[6 * (7 + 3 * legs) :: 7 + 3 * legs] += balance.slopes.reshape(-1)
    tangent[:6, :6] += body[:6, :6]
    tangent[:6, 6:] = each[:, :6, 6:].transpose(1, 0, 2).reshape(6, -1)
    tangent[6:, :6] = each[:, 6:, :6].reshape(-1, 6)
    tangent[3:6, 6:] += turning.T
    tangent[6:, 3:6] += turning
    blocks = np.einsum("ijik->ijk", tangent[6:, 6:].reshape(legs, 3, legs, 3))
    blocks += joints
    step: np.ndarray = np.linalg.solve(tangent, -balance.residual)
    return step
