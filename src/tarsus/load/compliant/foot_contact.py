"""Feet as elastic balls that roll on the ground plane z = 0.

The normal force of a ball of radius r with its centre at height z is ``stiffness max(0, r - z)``. Its contact point is
at the bottom. While the tibia turns by a small rotation w, the ball rolls: the material at the contact point is
displaced by ``dp - r w x z``, with the displacement dp of the centre, and friction resists that displacement.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tarsus.errors import InputError
from tarsus.representation import represented

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["POINT_FOOT", "FootContact", "normal_force"]

POINT_FOOT = 0.001
"""Radius that stands for a foot radius of 0 in the robot's file, as in the simulation [m]."""


@represented()
@dataclass(frozen=True, kw_only=True)
class FootContact:
    """Properties of the contact between feet and ground.

    Attributes
    ----------
    friction : float
        Coefficient of friction.
    normal_stiffness, tangential_stiffness : float
        Stiffness of the contact of a foot with the ground [N/m].
    creep_time : float
        Viscosity of friction over the normal stiffness [s]: a foot under a tangential load f creeps at the speed
        ``f / (normal_stiffness creep_time)``. Infinite for dry friction, without creep.
    """

    friction: float = 0.8
    normal_stiffness: float = 3e4
    tangential_stiffness: float = 1e5
    creep_time: float = 0.25

    def __post_init__(self) -> None:
        if not 0 <= self.friction < np.inf:
            raise InputError(f"friction is {self.friction:g}; it must be a finite number, not negative")
        for name, unit in (("normal_stiffness", "N/m"), ("tangential_stiffness", "N/m")):
            value = getattr(self, name)
            if not 0 < value < np.inf:
                raise InputError(f"{name} is {value:g} {unit}; it must be greater than 0 and finite")
        if not self.creep_time > 0:
            raise InputError(f"creep_time is {self.creep_time:g} s; it must be greater than 0; infinite for no creep")

    def relaxation(self, step: float) -> float:
        """Return the fraction of a tangential force that is left after a step of time.

        Parameters
        ----------
        step : float
            Its duration [s]; infinite for the first equilibrium, before which nothing creeps.
        """
        if np.isinf(step):
            return 1.0
        viscosity = self.normal_stiffness * self.creep_time
        return 1.0 / (1.0 + self.tangential_stiffness * step / viscosity)


def normal_force(height: Float[np.ndarray, "legs"], stiffness: float) -> Float[np.ndarray, "legs"]:
    """Return the normal forces of balls, ``(legs,)`` [N].

    Parameters
    ----------
    height : array, shape (legs,)
        Heights of their bottoms [m].
    stiffness : float
        Normal stiffness [N/m].
    """
    force: np.ndarray = -stiffness * np.minimum(height, 0.0)
    return force
