"""A single step, up or down."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.walk_setup import require_number
from tarsus.simulation.settings import FRICTION
from tarsus.simulation.terrain.profile import Profile, require_on_ground
from tarsus.simulation.terrain.surface import FAR

if TYPE_CHECKING:
    from jaxtyping import Shaped

__all__ = ["Step"]


@dataclass(frozen=True, kw_only=True)
class Step:
    """Two levels with a vertical face between them.

    Attributes
    ----------
    rise : float
        Height of the farther level, negative for a step down [m].
    start : float
        Where the face is, along x [m].
    friction : float
        Coefficient of friction.
    """

    rise: float
    start: float = 0.5
    friction: float = FRICTION

    def __post_init__(self) -> None:
        require_number("friction", self.friction, zero=False)
        if not 0 < abs(self.rise) < FAR:
            raise InputError(f"rise is {self.rise:g} m; it must be between -{FAR:g} and {FAR:g} m, and not 0")
        require_on_ground("step goes", self.start)

    @cached_property
    def profile(self) -> Profile:
        """Its cross-section."""
        return Profile((self.start,), ((0.0, 0.0), (self.rise, self.rise)))

    def height(self, x: Any, y: Any) -> Shaped[np.ndarray, "..."]:
        """Return the height of the ground [m]; see `Terrain`."""
        return self.profile.height(x, y)

    def add_to(self, spec: Any) -> None:
        """Add the ground to a model; see `Terrain`."""
        self.profile.add_to(spec, self.friction)
