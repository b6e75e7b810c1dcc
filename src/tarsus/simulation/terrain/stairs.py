"""Stairs: equal steps, one after the other, up or down."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.walk_setup import require_number
from tarsus.simulation.settings import FRICTION
from tarsus.simulation.terrain.profile import Profile, require_count, require_on_ground
from tarsus.simulation.terrain.surface import FAR

if TYPE_CHECKING:
    from jaxtyping import Shaped

__all__ = ["Stairs"]


@dataclass(frozen=True, kw_only=True)
class Stairs:
    """Equal steps along x.

    Attributes
    ----------
    rise : float
        Height of each step, negative downstairs [m].
    tread : float
        Depth of each step [m].
    steps : int
        Number of steps.
    start : float
        Where the first face is, along x [m].
    friction : float
        Coefficient of friction.
    """

    rise: float
    tread: float = 0.25
    steps: int = 5
    start: float = 0.5
    friction: float = FRICTION

    def __post_init__(self) -> None:
        require_number("friction", self.friction, zero=False)
        require_number("tread", self.tread, zero=False)
        if not 0 < abs(self.rise) < FAR:
            raise InputError(f"rise is {self.rise:g} m; it must be between -{FAR:g} and {FAR:g} m, and not 0")
        steps = require_count("steps", self.steps)
        require_on_ground("stairs go", *(self.start, self.start + (steps - 1) * self.tread)[:steps])

    @cached_property
    def profile(self) -> Profile:
        """Its cross-section."""
        steps = int(self.steps)
        edges = tuple(self.start + number * self.tread for number in range(steps))
        return Profile(edges, tuple((number * self.rise, number * self.rise) for number in range(steps + 1)))

    def height(self, x: Any, y: Any) -> Shaped[np.ndarray, "..."]:
        """Return the height of the ground [m]; see `Terrain`."""
        return self.profile.height(x, y)

    def add_to(self, spec: Any) -> None:
        """Add the ground to a model; see `Terrain`."""
        self.profile.add_to(spec, self.friction)
