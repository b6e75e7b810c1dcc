"""Blocks: a field of square columns of random height."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.walk_setup import require_number
from tarsus.simulation.engine import mujoco_module
from tarsus.simulation.seed import require_seed
from tarsus.simulation.settings import FRICTION
from tarsus.simulation.terrain.flat import Flat
from tarsus.simulation.terrain.surface import surface

if TYPE_CHECKING:
    from jaxtyping import Float, Shaped

__all__ = ["Blocks"]

_MOST_BLOCKS = 4096
# How far the blocks reach into the ground [m], so that a foot that sinks into a low block is pushed out at its top.
_UNDERGROUND = 0.1


@dataclass(frozen=True, kw_only=True)
class Blocks:
    """Square blocks on level ground, in a field around the start.

    Attributes
    ----------
    rise : float
        Greatest height of a block; heights are distributed uniformly from 0 to this [m].
    size : float
        Edge of a block [m].
    extent : float
        Half the edge of the square field [m].
    clear : float
        No block stands nearer to the origin than this [m].
    seed : int
        Seed of the heights.
    friction : float
        Coefficient of friction.
    """

    rise: float = 0.04
    size: float = 0.15
    extent: float = 2.0
    clear: float = 0.4
    seed: int = 0
    friction: float = FRICTION

    def __post_init__(self) -> None:
        for name in ("friction", "rise", "size", "extent"):
            require_number(name, getattr(self, name), zero=False)
        require_number("clear", self.clear, zero=True)
        require_seed(self.seed)
        if self.side**2 > _MOST_BLOCKS or self.side < 1:
            raise InputError(
                f"an extent of {self.extent:g} m takes {self.side**2} blocks of {self.size:g} m; "
                f"there may be 1 to {_MOST_BLOCKS}"
            )

    @property
    def side(self) -> int:
        """Number of blocks along an edge of the field."""
        return round(2 * self.extent / self.size)

    @cached_property
    def heights(self) -> Float[np.ndarray, "side side"]:
        """Heights of the blocks by x and y, ``(side, side)`` [m]."""
        heights = self.rise * np.random.default_rng(self.seed).random((self.side, self.side))
        centres = (np.arange(self.side) + 0.5) * self.size - self.side * self.size / 2
        nearest = np.maximum(np.abs(centres) - self.size / 2, 0.0)
        heights[np.hypot(*np.meshgrid(nearest, nearest)) < self.clear] = 0.0
        heights.setflags(write=False)
        return heights

    def height(self, x: Any, y: Any) -> Shaped[np.ndarray, "..."]:
        """Return the height of the ground [m]; see `Terrain`."""
        along, across = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        cells = [np.floor(at / self.size + self.side / 2).astype(int) for at in (along, across)]
        inside = np.logical_and.reduce([(cell >= 0) & (cell < self.side) for cell in cells])
        column, row = (np.clip(cell, 0, self.side - 1) for cell in cells)
        return np.where(inside, self.heights[column, row], 0.0)

    def add_to(self, spec: Any) -> None:
        """Add the ground to a model; see `Terrain`."""
        Flat(friction=self.friction).add_to(spec)
        box, attributes = mujoco_module().mjtGeom.mjGEOM_BOX, surface(self.friction)
        for (column, row), height in np.ndenumerate(self.heights):
            if height > 0:
                x, y = ((np.array([column, row]) + 0.5) * self.size - self.side * self.size / 2).tolist()
                top, depth = height / 2, _UNDERGROUND / 2
                size, pos = (self.size / 2, self.size / 2, top + depth), (x, y, top - depth)
                spec.worldbody.add_geom(name=f"block {column} {row}", type=box, size=size, pos=pos, **attributes)
