"""Newton steps of the equilibrium: its tangent, with the joints of each leg condensed out.

The unknowns of a leg's joints couple with those of the body alone. Eliminating them, three at a time, leaves six
equations of the body (static condensation: R. J. Guyan, "Reduction of stiffness and mass matrices", AIAA Journal 3,
1965).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.load.compliant.equilibrium import Balance, Compliant, Configuration, Demand
from tarsus.load.compliant.friction import friction_tangent

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["contact_jacobian", "newton_step"]

# Permutation symbol: row b of `_CROSS` holds, for each k, e_k x e_b.
_EPSILON = np.zeros((3, 3, 3))
_EPSILON[0, 1, 2] = _EPSILON[1, 2, 0] = _EPSILON[2, 0, 1] = 1.0
_EPSILON[0, 2, 1] = _EPSILON[2, 1, 0] = _EPSILON[1, 0, 2] = -1.0
_CROSS = np.einsum("akb->bka", _EPSILON).reshape(3, 9)
_BY_FORCE = _EPSILON.reshape(3, 9)
# Places of the second derivatives cc, cf, ct, ff, ft, tt, after the first ones, in a symmetric matrix.
_SECOND = 3 + np.array([0, 1, 2, 1, 3, 4, 2, 4, 5])
_DIAGONAL = np.arange(3)
# Keeps the body's equations regular where it is free to move [N/m, N m/rad].
_FLOOR = 1e-3


def contact_jacobian(compliant: Compliant, at: Configuration, balance: Balance) -> Float[np.ndarray, "legs 9 3"]:
    """Return the displacements of the contact points in G by body translation, rotation and joint angles.

    Parameters
    ----------
    compliant : Compliant
        The robot.
    at : Configuration
        The configuration.
    balance : Balance
        Its balance.

    Returns
    -------
    array, shape (legs, 9, 3)
        Rows: translation of B along its axes, rotation about them, coxa, femur and tibia [1, m/rad].
    """
    legs = compliant.legs
    within = np.empty((legs, 9, 3))
    within[:, :3] = np.eye(3)
    within[:, 3:6] = ((at.points[:, 0, 6:] - compliant.radius[:, None] * at.rotation[2]) @ _CROSS).reshape(legs, 3, 3)
    within[:, 6:] = at.points[:, 1:4, 6:] - balance.rolling
    in_ground: np.ndarray = within.reshape(-1, 3) @ at.rotation.T
    return in_ground.reshape(legs, 9, 3)


def newton_step(
    compliant: Compliant,
    at: Configuration,
    balance: Balance,
    jacobian: Float[np.ndarray, "legs 9 3"],
    demand: Demand,
    *,
    frozen: bool,
) -> tuple[Float[np.ndarray, "6"], Float[np.ndarray, "legs 3"]]:
    """Return the Newton step of the body, along and about its own axes, and of the joint angles.

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
        What is demanded.
    frozen : bool
        Whether the limits of friction are frozen.
    """
    legs, contact = compliant.legs, compliant.contact
    normal = (at.normal != 0) * contact.normal_stiffness
    stiffness = np.empty((legs, 3, 3))
    stiffness[:, 2, :2], stiffness[:, 2, 2] = 0.0, normal
    stiffness[:, :2] = friction_tangent(
        at.trial,
        balance.slip.fraction,
        contact.relaxation(demand.step) * contact.tangential_stiffness,
        None if frozen else contact.friction * normal,
    )
    # Forces on the leg points do not turn with the body: in its axes they turn back.
    turning = at.points[:, 1:4] @ (balance.points.reshape(-1, 3) @ _BY_FORCE).reshape(legs, 9, 3)
    coupled = (jacobian @ stiffness) @ jacobian.transpose(0, 2, 1)
    coupled[:, 6:, 3:6] += turning
    coupled[:, 3:6, 6:] += turning.transpose(0, 2, 1)
    own = coupled[:, 6:, 6:] - balance.generalised[:, _SECOND].reshape(legs, 3, 3)
    own[:, _DIAGONAL, _DIAGONAL] += balance.slopes
    right = np.empty((legs, 3, 7))
    right[:, :, :6], right[:, :, 6] = coupled[:, 6:, :6], balance.joints
    solved = np.linalg.solve(own, right)
    moments = balance.moments
    condensed = coupled[:, :6, 6:].transpose(1, 0, 2).reshape(6, -1) @ solved.reshape(-1, 7)
    body = coupled[:, :6, :6].sum(axis=0) - condensed[:, :6]
    body[3:, 3:] -= moments.T
    body.flat[21::7] += moments[0, 0] + moments[1, 1] + moments[2, 2]
    body.flat[::7] += _FLOOR
    if demand.gain and compliant.inertia is not None:
        body += demand.gain * compliant.inertia
    moved = np.linalg.solve(body, condensed[:, 6] - balance.body)
    return moved, -solved[:, :, 6] - solved[:, :, :6] @ moved
