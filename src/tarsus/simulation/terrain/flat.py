"""Flat, level ground."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.gait.walk_setup import require_number
from tarsus.simulation.engine import mujoco_module
from tarsus.simulation.settings import FRICTION
from tarsus.simulation.terrain.surface import surface

if TYPE_CHECKING:
    from jaxtyping import Shaped

__all__ = ["Flat"]


@dataclass(frozen=True, kw_only=True)
class Flat:
    """Flat, level ground without end.

    Attributes
    ----------
    friction : float
        Coefficient of friction.
    """

    friction: float = FRICTION

    def __post_init__(self) -> None:
        require_number("friction", self.friction, zero=False)

    def height(self, x: Any, y: Any) -> Shaped[np.ndarray, "..."]:
        """Return the height of the ground, 0 [m]; see `Terrain`."""
        return np.zeros(np.broadcast_shapes(np.shape(x), np.shape(y)))

    def add_to(self, spec: Any) -> None:
        """Add the ground to a model; see `Terrain`."""
        plane = mujoco_module().mjtGeom.mjGEOM_PLANE
        spec.worldbody.add_geom(name="ground", type=plane, size=(0, 0, 1), **surface(self.friction))
