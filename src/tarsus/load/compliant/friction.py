"""Coulomb friction of elastic feet that may creep.

The tangential force of a foot is that of a spring between its contact point and the place on the ground where it holds.
Over a step in which the contact point is displaced by d, the force f becomes, before any sliding,

    f' = (f - stiffness d) / (1 + stiffness step / viscosity)

where the divisor is the creep of the place under load, at the speed of force over viscosity: a spring and a damper in
series (a Maxwell element). In the cone, ``|f'| <= friction normal``, the foot sticks; else it slides, with the force
``friction normal`` in the direction of f'.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["contact_stiffness", "friction_fraction"]

_TINY = 1e-12
# Fraction of the stiffness that is kept along the direction of sliding, so that no direction is without any.
_SLIDING_STIFFNESS = 1e-3


def friction_fraction(
    trial: Float[np.ndarray, "legs 2"], limit: Float[np.ndarray, "legs"]
) -> Float[np.ndarray, "legs"]:
    """Return the ratio of the tangential forces to those without sliding, ``(legs,)``; below 1 for feet that slide.

    Parameters
    ----------
    trial : array, shape (legs, 2)
        Forces without sliding, f' above [N].
    limit : array, shape (legs,)
        Greatest forces: friction times normal force [N].
    """
    fraction: np.ndarray = np.minimum(limit / np.maximum(np.hypot(trial[:, 0], trial[:, 1]), _TINY), 1.0)
    return fraction


def contact_stiffness(
    trial: Float[np.ndarray, "legs 2"],
    fraction: Float[np.ndarray, "legs"],
    tangential: float,
    normal: Float[np.ndarray, "legs"],
    friction: float,
) -> Float[np.ndarray, "legs 3 3"]:
    """Return the decrease of the contact forces per displacement of the contact points, ``(legs, 3, 3)`` [N/m].

    Parameters
    ----------
    trial : array, shape (legs, 2)
        Forces without sliding [N].
    fraction : array, shape (legs,)
        `friction_fraction`.
    tangential : float
        Tangential stiffness, creep included [N/m].
    normal : array, shape (legs,)
        Normal stiffness; 0 for feet in the air [N/m].
    friction : float
        Coefficient with which the limits of friction follow the normal forces. With 0 the limits are frozen (Tresca
        friction), and the matrix is symmetric.
    """
    legs = []
    # For so few numbers plain floats are faster than arrays.
    for (x, y), part, down in zip(trial.tolist(), fraction.tolist(), normal.tolist(), strict=True):
        held = tangential * part
        if part == 1.0:
            legs.append(((held, 0.0, 0.0), (0.0, held, 0.0), (0.0, 0.0, down)))
            continue
        size = max(math.hypot(x, y), _TINY)
        along, aside, lost, slope = x / size, y / size, (1.0 - _SLIDING_STIFFNESS) * held, friction * down
        both = -lost * along * aside
        first = held - lost * along * along, both, slope * along
        legs.append((first, (both, held - lost * aside * aside, slope * aside), (0.0, 0.0, down)))
    return np.array(legs)
