"""Smooth random ground."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.walk_setup import require_number
from tarsus.simulation.seed import require_seed
from tarsus.simulation.settings import FRICTION
from tarsus.simulation.terrain.height_field import HeightField
from tarsus.simulation.terrain.surface import FAR

if TYPE_CHECKING:
    from jaxtyping import Shaped

__all__ = ["Smooth"]

_WAVES = 64
# Grid points in the length of the shortest wave, which is half the mean.
_POINTS = 8
_MOST_POINTS = 1000


@dataclass(frozen=True, kw_only=True)
class Smooth:
    """Hills and hollows: a sum of waves of random direction, length and phase.

    Attributes
    ----------
    amplitude : float
        Greatest height above or depth below level ground [m].
    wavelength : float
        Mean length of the waves; that of each is between half and one and a half times the mean [m].
    extent : float
        Half the edge of the square field, less than 50 m; around it, level ground [m].
    clear : float
        Within this distance of the origin the ground is level [m]; over the same distance again it gradually becomes
        uneven.
    seed : int
        Seed of the waves.
    friction : float
        Coefficient of friction.
    """

    amplitude: float = 0.03
    wavelength: float = 0.4
    extent: float = 2.0
    clear: float = 0.0
    seed: int = 0
    friction: float = FRICTION

    def __post_init__(self) -> None:
        for name in ("friction", "amplitude", "wavelength", "extent"):
            require_number(name, getattr(self, name), zero=False)
        require_number("clear", self.clear, zero=True)
        require_seed(self.seed)
        if self.extent >= FAR:
            raise InputError(f"extent is {self.extent:g} m; it must be less than {FAR:g} m")
        if self.points > _MOST_POINTS:
            raise InputError(
                f"wavelength is {self.wavelength:g} m; on an extent of {self.extent:g} m it must be at least "
                f"{self.wavelength * self.points / _MOST_POINTS:.3g} m"
            )

    @property
    def points(self) -> int:
        """Number of grid points along an edge of the field."""
        return max(2, round(2 * self.extent / self.wavelength * 2 * _POINTS) + 1)

    @cached_property
    def field(self) -> HeightField:
        """The terrain as a height field."""
        random = np.random.default_rng(self.seed)
        length = self.wavelength * random.uniform(0.5, 1.5, _WAVES)
        direction, phase = random.uniform(0, 2 * np.pi, (2, _WAVES))
        x, y = np.meshgrid(*[np.linspace(-self.extent, self.extent, self.points)] * 2)
        heights = np.zeros(x.shape)
        for number, heading, shift in zip(2 * np.pi / length, direction, phase, strict=True):
            heights += np.cos(number * (x * np.cos(heading) + y * np.sin(heading)) + shift)
        if self.clear:
            part = np.clip(np.hypot(x, y) / self.clear - 1, 0, 1)
            heights *= part * part * (3 - 2 * part)
        heights *= self.amplitude / np.abs(heights).max()
        return HeightField(heights=heights, size=(2 * self.extent, 2 * self.extent), friction=self.friction)

    def height(self, x: Any, y: Any) -> Shaped[np.ndarray, "..."]:
        """Return the height of the ground [m]; see `Terrain`."""
        return self.field.height(x, y)

    def add_to(self, spec: Any) -> None:
        """Add the ground to a model; see `Terrain`."""
        self.field.add_to(spec)
