"""The shapes of a terrain as the physics engine has them, for drawing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tarsus.errors import InputError
from tarsus.simulation.engine import mujoco_module
from tarsus.simulation.terrain.protocol import Terrain

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["GroundField", "TerrainSolids", "terrain_solids"]


class GroundField(NamedTuple):
    """Heights on a grid. Each cell is two triangles, which share the diagonal from least to greatest x and y.

    Attributes
    ----------
    corners : array, shape (2, 2)
        Least and greatest x and y [m].
    heights : array, shape (rows, columns)
        Rows along y, columns along x, both ascending [m].
    """

    corners: Float[np.ndarray, "2 2"]
    heights: Float[np.ndarray, "rows columns"]


class TerrainSolids(NamedTuple):
    """The shapes that a terrain consists of.

    Attributes
    ----------
    level : bool
        Whether there is level ground without end at height 0.
    boxes : array, shape (n, 2, 3)
        Least and greatest corner of each box [m].
    triangles : array, shape (n, 3, 3)
        Corners of the triangles that make up the meshes, counter-clockwise seen from outside [m].
    field : GroundField or None
        The terrain's height field; None where it has none.
    """

    level: bool
    boxes: Float[np.ndarray, "boxes 2 3"]
    triangles: Float[np.ndarray, "triangles 3 3"]
    field: GroundField | None


def terrain_solids(terrain: Terrain) -> TerrainSolids:
    """Return the shapes that the physics engine has for a terrain.

    Parameters
    ----------
    terrain : Terrain
        A terrain of planes at height 0, upright boxes, convex meshes and a height field.

    Raises
    ------
    InputError
        If the physics engine refuses the terrain.
    TarsusError
        If MuJoCo is not installed.
    """
    mujoco = mujoco_module()
    spec = mujoco.MjSpec()
    terrain.add_to(spec)
    try:
        model = spec.compile()
    except ValueError as error:
        raise InputError(f"the physics engine refuses {terrain!r}: {error}") from None
    geom = mujoco.mjtGeom
    boxes = model.geom_type == geom.mjGEOM_BOX
    middle, half = model.geom_pos[boxes], model.geom_size[boxes]
    meshes = np.flatnonzero(model.geom_type == geom.mjGEOM_MESH).tolist()
    return TerrainSolids(
        level=bool((model.geom_type == geom.mjGEOM_PLANE).any()),
        boxes=np.stack([middle - half, middle + half], axis=1),
        triangles=np.concatenate([np.empty((0, 3, 3)), *(_triangles(mujoco, model, number) for number in meshes)]),
        field=_field(model, geom.mjGEOM_HFIELD) if model.nhfield else None,
    )


def _triangles(mujoco: Any, model: Any, geom: int) -> Float[np.ndarray, "triangles 3 3"]:
    """Return the faces of a mesh in G."""
    mesh, rotation = int(model.geom_dataid[geom]), np.empty(9)
    mujoco.mju_quat2Mat(rotation, model.geom_quat[geom])
    first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    corners = model.mesh_vert[first : first + count] @ rotation.reshape(3, 3).T + model.geom_pos[geom]
    start, faces = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
    found: np.ndarray = corners[model.mesh_face[start : start + faces]]
    return found


def _field(model: Any, kind: Any) -> GroundField:
    """Return the height field of a model."""
    half_x, half_y, rise, _ = model.hfield_size[0].tolist()
    rows, columns = int(model.hfield_nrow[0]), int(model.hfield_ncol[0])
    x, y, z = model.geom_pos[model.geom_type == kind][0].tolist()
    heights = z + rise * model.hfield_data.reshape(rows, columns).astype(float)
    return GroundField(np.array([[x - half_x, y - half_y], [x + half_x, y + half_y]]), heights)
