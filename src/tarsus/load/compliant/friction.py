"""Coulomb friction of elastic feet that may creep.

The tangential force of a foot is that of a spring between its contact point and the place on the ground where it holds.
Over a step in which the contact point is displaced by d, the force that was f becomes at first

    f' = (f - stiffness d) / (1 + stiffness step / viscosity)

where the divisor is the creep of the place under load, at the speed of force over viscosity: a spring and a damper in
series (a Maxwell element). In the cone, ``|f'| <= friction normal``, the foot sticks; else it slides, with the force
``friction normal`` in the direction of f'.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Slip", "friction_force", "friction_tangent"]

_TINY = 1e-12
# Fraction of the stiffness that stays along the direction of sliding, so that no direction is free.
_SLIDING_STIFFNESS = 1e-3


class Slip(NamedTuple):
    """Tangential forces of feet.

    Attributes
    ----------
    force : array, shape (legs, 2)
        Force in the ground plane [N].
    fraction : array, shape (legs,)
        Force over the force without sliding; below 1 for a foot that slides.
    """

    force: Float[np.ndarray, "legs 2"]
    fraction: Float[np.ndarray, "legs"]


def friction_force(trial: Float[np.ndarray, "legs 2"], limit: Float[np.ndarray, "legs"]) -> Slip:
    """Return the tangential forces for the forces without sliding.

    Parameters
    ----------
    trial : array, shape (legs, 2)
        Forces without sliding, f' above [N].
    limit : array, shape (legs,)
        Greatest forces: friction times normal force [N].
    """
    size = np.sqrt((trial * trial).sum(axis=1))
    fraction = np.minimum(limit / np.maximum(size, _TINY), 1.0)
    return Slip(trial * fraction[:, None], fraction)


def friction_tangent(
    trial: Float[np.ndarray, "legs 2"],
    fraction: Float[np.ndarray, "legs"],
    stiffness: float,
    normal_slope: Float[np.ndarray, "legs"] | None,
) -> Float[np.ndarray, "legs 2 3"]:
    """Return how the tangential forces fall with the displacement of the contact points, ``(legs, 2, 3)`` [N/m].

    Parameters
    ----------
    trial : array, shape (legs, 2)
        Forces without sliding [N].
    fraction : array, shape (legs,)
        `Slip.fraction`.
    stiffness : float
        Tangential stiffness, creep included [N/m].
    normal_slope : array, shape (legs,), optional
        Friction times the normal stiffness of feet in contact [N/m]: how the limit changes with the height. Left out,
        the limits are frozen (Tresca friction), and the matrix is symmetric.
    """
    tangent = np.zeros((len(trial), 2, 3))
    tangent[:, 0, 0] = tangent[:, 1, 1] = stiffness * fraction
    (sliding,) = np.nonzero(fraction < 1.0)
    if sliding.size:
        force = trial[sliding]
        direction = force / np.maximum(np.sqrt((force * force).sum(axis=1)), _TINY)[:, None]
        lost = ((1.0 - _SLIDING_STIFFNESS) * stiffness * fraction[sliding])[:, None] * direction
        tangent[sliding, :, :2] -= lost[:, :, None] * direction[:, None, :]
        if normal_slope is not None:
            tangent[sliding, :, 2] = normal_slope[sliding][:, None] * direction
    return tangent
