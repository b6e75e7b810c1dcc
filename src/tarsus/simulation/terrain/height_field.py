"""A height field: ground from an array or a picture."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from tarsus.errors import InputError, TarsusError
from tarsus.gait.walk_setup import require_number
from tarsus.representation import represented
from tarsus.simulation.engine import mujoco_module
from tarsus.simulation.settings import FRICTION
from tarsus.simulation.terrain.surface import FAR, surface

if TYPE_CHECKING:
    from jaxtyping import Float, Shaped

__all__ = ["HeightField"]

# Thickness of the ground below its lowest point [m].
_THICKNESS = 0.5


@represented()
@dataclass(frozen=True, kw_only=True, eq=False)
class HeightField:
    """Heights on a grid around the origin, joined by triangles; around it, level ground at height 0.

    Attributes
    ----------
    heights : array, shape (rows, columns)
        Heights: rows along y, columns along x, both ascending [m].
    size : (float, float)
        Extent along x and y, less than 100 m [m].
    friction : float
        Coefficient of friction.
    """

    heights: Float[np.ndarray, "rows columns"]
    size: tuple[float, float]
    friction: float = FRICTION

    def __post_init__(self) -> None:
        require_number("friction", self.friction, zero=False)
        for extent in self.size:
            require_number("size", extent, zero=False)
            if extent >= 2 * FAR:
                raise InputError(f"size is {extent:g} m; it must be less than {2 * FAR:g} m")
        heights = np.array(self.heights, dtype=np.float64)
        if heights.ndim != 2 or min(heights.shape) < 2:
            raise InputError(f"heights has shape {heights.shape}; expected (rows, columns), at least 2 of each")
        if not np.isfinite(heights).all():
            raise InputError("heights holds a value that is not a finite number")
        heights.setflags(write=False)
        object.__setattr__(self, "heights", heights)
        object.__setattr__(self, "size", (float(self.size[0]), float(self.size[1])))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, HeightField):
            return NotImplemented
        same = self.size == other.size and self.friction == other.friction
        return same and np.array_equal(self.heights, other.heights)

    def __hash__(self) -> int:
        return hash((self.heights.tobytes(), self.size, self.friction))

    @classmethod
    def from_png(
        cls, path: str | os.PathLike[str], *, size: tuple[float, float], rise: float, friction: float = FRICTION
    ) -> Self:
        """Read a height field from a grey picture: black is 0, white is `rise`; y points up in the picture.

        Parameters
        ----------
        path : path
            The picture, of 8 or 16 bits.
        size : (float, float)
            Extent along x and y [m].
        rise : float
            Height of white [m].
        friction : float
            Coefficient of friction.

        Raises
        ------
        InputError
            If it can't be read.
        TarsusError
            If Pillow is not installed.
        """
        require_number("rise", rise, zero=False)
        try:
            from PIL import Image
        except ImportError:
            raise TarsusError("pictures need Pillow; install it with: pip install 'tarsus[plots]'") from None
        try:
            with Image.open(path) as picture:
                deep = picture.mode.startswith("I")
                grey = np.asarray(picture if deep else picture.convert("L"), dtype=np.float64)
        except OSError as error:
            reason = error.strerror or "it has no known format"
            raise InputError(f"{os.fspath(path)} can't be read as a picture: {reason}") from None
        return cls(heights=grey[::-1] / (65535 if deep else 255) * rise, size=size, friction=friction)

    def height(self, x: Any, y: Any) -> Shaped[np.ndarray, "..."]:
        """Return the height of the ground [m]; see `Terrain`."""
        x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        rows, columns = self.heights.shape
        along = (x / self.size[0] + 0.5) * (columns - 1)
        across = (y / self.size[1] + 0.5) * (rows - 1)
        inside = (along >= 0) & (along <= columns - 1) & (across >= 0) & (across <= rows - 1)
        column = np.clip(np.floor(along), 0, columns - 2).astype(int)
        row = np.clip(np.floor(across), 0, rows - 2).astype(int)
        u, v = along - column, across - row
        # Each cell is two triangles, which share the edge from its corner (0, 0) to its corner (1, 1).
        origin, right = self.heights[row, column], self.heights[row, column + 1]
        left, far = self.heights[row + 1, column], self.heights[row + 1, column + 1]
        below = origin + u * (right - origin) + v * (far - right)
        above = origin + v * (left - origin) + u * (far - left)
        return np.where(inside, np.where(u >= v, below, above), 0.0)

    def add_to(self, spec: Any) -> None:
        """Add the ground to a model; see `Terrain`."""
        geom, attributes = mujoco_module().mjtGeom, surface(self.friction)
        low, high = float(self.heights.min()), float(self.heights.max())
        # The engine's heights are fractions of a range that must not be 0, not even where all heights are equal.
        span = (high - low) or 1.0
        rows, columns = self.heights.shape
        half_x, half_y = self.size[0] / 2, self.size[1] / 2
        field = spec.add_hfield(name="ground", nrow=rows, ncol=columns, size=(half_x, half_y, span, _THICKNESS))
        field.userdata = ((self.heights - low) / span).ravel().astype(np.float32)
        spec.worldbody.add_geom(
            name="ground", type=geom.mjGEOM_HFIELD, hfieldname="ground", pos=(0, 0, low), **attributes
        )
        for name, axis, sign in (("left", 1, 1), ("right", 1, -1), ("front", 0, 1), ("back", 0, -1)):
            size, pos = [half_x, half_y, FAR], [0.0, 0.0, -FAR]
            inner = size[axis]
            size[axis], pos[axis] = (FAR - inner) / 2, math.copysign((FAR + inner) / 2, sign)
            size[1 - axis] = FAR if axis == 0 else size[1 - axis]
            spec.worldbody.add_geom(name=f"ground {name}", type=geom.mjGEOM_BOX, size=size, pos=pos, **attributes)
