"""Ground whose height depends on x alone: boxes and wedges side by side."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tarsus.errors import InputError
from tarsus.simulation.engine import mujoco_module
from tarsus.simulation.terrain.surface import FAR, surface

if TYPE_CHECKING:
    from jaxtyping import Shaped

__all__ = ["Profile", "require_count", "require_on_ground"]

# Thickness of the ground below its lowest point [m].
_THICKNESS = 1.0


class Profile(NamedTuple):
    """Straight segments of ground along x, of unlimited width.

    Attributes
    ----------
    edges : tuple of float
        Where one segment ends and the next begins, ascending [m].
    ends : tuple of (float, float)
        Heights of each segment at its two ends [m]; one more segment than edges.
    """

    edges: tuple[float, ...]
    ends: tuple[tuple[float, float], ...]

    @property
    def bounds(self) -> Shaped[np.ndarray, "..."]:
        """All edges, the outermost included, ``(segments + 1,)`` [m]."""
        return np.array([-FAR, *self.edges, FAR])

    def height(self, x: Any, y: Any) -> Shaped[np.ndarray, "..."]:
        """Return the height of the ground; at a vertical face, that of the farther segment."""
        at = np.broadcast_to(np.asarray(x, dtype=float), np.broadcast_shapes(np.shape(x), np.shape(y)))
        bounds, ends = self.bounds, np.array(self.ends)
        segment = np.searchsorted(np.array(self.edges), at, side="right")
        part = (at - bounds[segment]) / (bounds[segment + 1] - bounds[segment])
        return np.asarray(ends[segment, 0] + np.clip(part, 0.0, 1.0) * (ends[segment, 1] - ends[segment, 0]))

    def add_to(self, spec: Any, friction: float) -> None:
        """Add a box for each level segment and a wedge for each sloping one."""
        bottom = min(map(min, self.ends)) - _THICKNESS
        bounds = self.bounds
        for number, (left, right) in enumerate(self.ends):
            middle, half = (bounds[number + 1] + bounds[number]) / 2, (bounds[number + 1] - bounds[number]) / 2
            self._add_segment(spec, f"ground {number}", friction, (middle, half), (left, right, bottom))

    @staticmethod
    def _add_segment(
        spec: Any, name: str, friction: float, span: tuple[float, float], heights: tuple[float, float, float]
    ) -> None:
        geom = mujoco_module().mjtGeom
        (middle, half), (left, right, bottom) = span, heights
        if left == right:
            size, pos = (half, FAR, (left - bottom) / 2), (middle, 0.0, (left + bottom) / 2)
            spec.worldbody.add_geom(name=name, type=geom.mjGEOM_BOX, size=size, pos=pos, **surface(friction))
            return
        corners = [
            (middle + sign * half, y, z)
            for sign, top in ((-1, left), (1, right))
            for y in (-FAR, FAR)
            for z in (bottom, top)
        ]
        spec.add_mesh(name=name, uservert=np.array(corners).ravel())
        spec.worldbody.add_geom(name=name, type=geom.mjGEOM_MESH, meshname=name, **surface(friction))


def require_count(name: str, count: float) -> int:
    """Return a whole number of at least 1.

    Parameters
    ----------
    name, count : str, float
        Its name in messages; the number.

    Raises
    ------
    InputError
        If it is less than 1, or not a whole number.
    """
    if count < 1 or count % 1:
        raise InputError(f"{name} is {count}; there must be at least 1, and a whole number of them")
    return int(count)


def require_on_ground(name: str, *edges: float) -> None:
    """Refuse edges that do not ascend within the ground: segments between them would have no width.

    Parameters
    ----------
    name : str
        What has the edges, in messages.
    *edges : float
        The outermost edges, or all of them [m].

    Raises
    ------
    InputError
        If one is not a number, they do not ascend, or they leave the ground.
    """
    if not all(left < right for left, right in pairwise((-FAR, *edges, FAR))):
        raise InputError(f"the {name} from {edges[0]:g} to {edges[-1]:g} m; the ground goes from -{FAR:g} to {FAR:g} m")
