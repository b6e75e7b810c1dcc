"""A box on level ground: a post in the way of a leg, or a wall."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.walk_setup import require_number
from tarsus.simulation.engine import mujoco_module
from tarsus.simulation.settings import FRICTION
from tarsus.simulation.terrain.flat import Flat
from tarsus.simulation.terrain.profile import require_on_ground
from tarsus.simulation.terrain.surface import surface

if TYPE_CHECKING:
    from jaxtyping import Shaped

__all__ = ["Box"]


@dataclass(frozen=True, kw_only=True)
class Box:
    """An upright box on level ground.

    Attributes
    ----------
    rise : float
        Its height [m].
    length, width : float
        Its size along `yaw` and across it [m].
    start, aside : float
        Position of the middle of its near face: ahead of the origin, and to its left [m].
    yaw : float
        Its direction; at 0, the near face is perpendicular to x [rad].
    friction : float
        Coefficient of friction.
    """

    rise: float = 0.1
    length: float = 0.06
    width: float = 0.06
    start: float = 0.5
    aside: float = 0.0
    yaw: float = 0.0
    friction: float = FRICTION

    def __post_init__(self) -> None:
        for name in ("friction", "rise", "length", "width"):
            require_number(name, getattr(self, name), zero=False)
        if not math.isfinite(self.yaw):
            raise InputError(f"yaw is {math.degrees(self.yaw):g} deg; it must be a finite number")
        corners = self.corners
        require_on_ground("box goes", float(corners.real.min()), float(corners.real.max()))
        require_on_ground("box goes sideways", float(corners.imag.min()), float(corners.imag.max()))

    @property
    def corners(self) -> Shaped[np.ndarray, "4"]:
        """Where its corners are, as x + iy, counter-clockwise [m]."""
        sides = np.array([0, self.length, self.length, 0]) + 1j * self.width / 2 * np.array([-1, -1, 1, 1])
        corners: np.ndarray = complex(self.start, self.aside) + sides * cmath.exp(1j * self.yaw)
        return corners

    def ahead(self, x: Any, y: Any) -> Shaped[np.ndarray, "..."]:
        """Return how far places are ahead of the middle of the near face, and to its left, as complex numbers [m].

        Parameters
        ----------
        x, y : array, shape (...)
            Where, in G [m].
        """
        places: np.ndarray = np.asarray(x) - self.start + 1j * (np.asarray(y) - self.aside)
        return np.asarray(places * cmath.exp(-1j * self.yaw))

    def height(self, x: Any, y: Any) -> Shaped[np.ndarray, "..."]:
        """Return the height of the ground [m]; see `Terrain`."""
        place = self.ahead(x, y)
        within = (place.real >= 0) & (place.real <= self.length) & (np.abs(place.imag) <= self.width / 2)
        return np.where(within, self.rise, 0.0)

    def add_to(self, spec: Any) -> None:
        """Add the ground to a model; see `Terrain`."""
        Flat(friction=self.friction).add_to(spec)
        geom, attributes = mujoco_module().mjtGeom, {"name": "box", **surface(self.friction)}
        corners = [(place.real, place.imag, z) for place in self.corners.tolist() for z in (0.0, self.rise)]
        # A turned box is a mesh, as code that draws terrains takes the engine's boxes to be along x and y.
        if self.yaw:
            spec.add_mesh(name="box", uservert=np.array(corners).ravel())
            spec.worldbody.add_geom(type=geom.mjGEOM_MESH, meshname="box", **attributes)
            return
        size, middle = (self.length / 2, self.width / 2, self.rise / 2), np.mean(corners, axis=0)
        spec.worldbody.add_geom(type=geom.mjGEOM_BOX, size=size, pos=middle, **attributes)
