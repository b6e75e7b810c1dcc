"""A ramp: level ground, a slope, level ground again."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.walk_setup import require_number
from tarsus.simulation.settings import FRICTION
from tarsus.simulation.terrain.profile import Profile, require_on_ground

if TYPE_CHECKING:
    from jaxtyping import Shaped

__all__ = ["Ramp"]


@dataclass(frozen=True, kw_only=True)
class Ramp:
    """A slope along x between two levels.

    Attributes
    ----------
    slope : float
        Angle of the slope, positive uphill [rad].
    start : float
        Where the slope begins, along x [m].
    length : float
        Its length along x [m].
    friction : float
        Coefficient of friction.
    """

    slope: float
    start: float = 0.5
    length: float = 2.0
    friction: float = FRICTION

    def __post_init__(self) -> None:
        require_number("friction", self.friction, zero=False)
        require_number("length", self.length, zero=False)
        require_on_ground("ramp goes", self.start, self.start + self.length)
        if not 0 < abs(self.slope) < math.pi / 3:
            raise InputError(f"slope is {math.degrees(self.slope):g} deg; it must be between -60 and 60 deg, and not 0")

    @cached_property
    def profile(self) -> Profile:
        """Its cross-section."""
        top = self.length * math.tan(self.slope)
        return Profile((self.start, self.start + self.length), ((0.0, 0.0), (0.0, top), (top, top)))

    def height(self, x: Any, y: Any) -> Shaped[np.ndarray, "..."]:
        """Return the height of the ground [m]; see `Terrain`."""
        return self.profile.height(x, y)

    def add_to(self, spec: Any) -> None:
        """Add the ground to a model; see `Terrain`."""
        self.profile.add_to(spec, self.friction)
