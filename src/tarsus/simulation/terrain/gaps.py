"""Gaps: trenches across level ground."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.walk_setup import require_number
from tarsus.simulation.settings import FRICTION
from tarsus.simulation.terrain.profile import Profile, require_count, require_on_ground

if TYPE_CHECKING:
    from jaxtyping import Shaped

__all__ = ["Gaps"]


@dataclass(frozen=True, kw_only=True)
class Gaps:
    """Equal trenches across x in level ground.

    Attributes
    ----------
    width : float
        Width of each trench along x [m].
    spacing : float
        Distance from the start of one trench to the start of the next [m].
    count : int
        Number of trenches.
    depth : float
        Depth of the trenches [m].
    start : float
        Where the first trench begins, along x [m].
    friction : float
        Coefficient of friction.
    """

    width: float = 0.05
    spacing: float = 0.4
    count: int = 3
    depth: float = 0.3
    start: float = 0.5
    friction: float = FRICTION

    def __post_init__(self) -> None:
        for name in ("friction", "width", "spacing", "depth"):
            require_number(name, getattr(self, name), zero=False)
        count = require_count("count", self.count)
        if self.width >= self.spacing:
            raise InputError(f"width is {self.width:g} m; it must be less than the spacing, {self.spacing:g} m")
        last = self.start + (count - 1) * self.spacing
        require_on_ground("gaps go", *(self.start, last)[:count], last + self.width)

    @cached_property
    def profile(self) -> Profile:
        """Its cross-section."""
        count = int(self.count)
        starts = [self.start + number * self.spacing for number in range(count)]
        edges = tuple(edge for start in starts for edge in (start, start + self.width))
        floor = (-self.depth, -self.depth)
        return Profile(edges, ((0.0, 0.0), *((floor, (0.0, 0.0)) * count)))

    def height(self, x: Any, y: Any) -> Shaped[np.ndarray, "..."]:
        """Return the height of the ground [m]; see `Terrain`."""
        return self.profile.height(x, y)

    def add_to(self, spec: Any) -> None:
        """Add the ground to a model; see `Terrain`."""
        self.profile.add_to(spec, self.friction)
