"""Convex hull of a few points in the plane: margin of a point in it, and its corners."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import (
    Array,
    Namespace,
    as_array,
    as_floats,
    broadcast_shapes,
    namespace,
    require_finite,
    require_shape,
    root,
)
from tarsus.blocks import Index, batch_blocks
from tarsus.errors import InputError
from tarsus.kinematics.convex_hull import hull_corners, origin_margin
from tarsus.kinematics.pairs import Pairs, columns_of

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["as_mask", "hull_margin", "margin_and_nearest", "support_polygon"]

_WORK = 1 << 17  # numbers in the largest array of a block, to fit in the second-level cache


def hull_margin(
    points: Float[Array, "*#batch n 2"], mask: Bool[Array, "*#batch n"], point: Float[Array, "*#batch 2"]
) -> Float[Array, "*batch"]:
    """Return the margin of a point in the convex hull of some points.

    Parameters
    ----------
    points : array, shape (..., n, 2)
        Points in the plane [m].
    mask : array of bool, shape (..., n)
        Which of them are used.
    point : array, shape (..., 2)
        The point whose margin is returned [m].

    Returns
    -------
    array, shape (...)
        Distance to the nearest edge where the point is inside the hull; minus the distance to the hull where it is
        outside [m]. The hull of collinear points has no interior: the margin is 0 or negative. Minus infinity without
        points.

    Raises
    ------
    InputError
        If a shape is wrong, a value is not finite, or the mask is not of booleans.

    Notes
    -----
    Inside, ``min_u max_i u . (p_i - p)`` over the normals u of all pairs; outside, the least distance to the segments
    of all pairs, which are within the hull and include its edges.
    """
    xp = namespace(points, mask, point)
    points = as_floats(xp, points, name="points")
    point = as_floats(xp, point, name="point")
    mask = as_mask(xp, mask, name="mask")
    if points.ndim < 2:
        raise InputError(f"points has shape {tuple(points.shape)}; expected (..., n, 2)")
    n = points.shape[-2]
    require_shape("points", points, (n, 2))
    require_shape("mask", mask, (n,))
    require_shape("point", point, (2,))
    require_finite("points", points)
    require_finite("point", point)
    shapes = (points.shape[:-2], mask.shape[:-1], point.shape[:-1])
    batch = broadcast_shapes("points, mask and point", *shapes)
    if n == 0:
        return xp.full(batch, -xp.inf, dtype=points.dtype)
    if xp is np and not batch:
        return np.float64(origin_margin((points[mask] - point).tolist())[0])
    if xp is not np:
        return xp.reshape(_margin(xp, points, mask, point, batch, ()), batch)
    margin = np.empty(batch)
    for index in batch_blocks(batch, max(1, _WORK // n**3)):
        margin[index] = _margin(np, points, mask, point, batch, index).reshape(margin[index].shape)
    return margin[()]


def as_mask(xp: Namespace, mask: Bool[Array, "..."], *, name: str) -> Bool[Array, "..."]:
    """Return `mask` as an array of booleans.

    Parameters
    ----------
    xp : namespace
        The array library.
    mask : array of bool
        Any shape.
    name : str
        Its name in messages.

    Raises
    ------
    InputError
        If it is not of booleans.
    """
    mask = as_array(xp, mask)
    if not xp.isdtype(mask.dtype, "bool"):
        raise InputError(f"{name} holds {mask.dtype} values; expected booleans")
    return mask


def _margin(
    xp: Namespace,
    points: Float[Array, "*#batch n 2"],
    mask: Bool[Array, "*#batch n"],
    point: Float[Array, "*#batch 2"],
    batch: tuple[int, ...],
    index: Index,
) -> Float[Array, "..."]:
    x, y = _split(columns_of(xp, points, batch, index, tail=2))
    origin_x, origin_y = _split(columns_of(xp, point, batch, index, tail=1))
    counts = columns_of(xp, mask, batch, index, tail=1)
    return margin_and_nearest(xp, x - origin_x, y - origin_y, counts)[0]


def margin_and_nearest(
    xp: Namespace, x: Float[Array, "n #batch"], y: Float[Array, "n #batch"], counts: Bool[Array, "n #batch"]
) -> tuple[Float[Array, "batch"], Float[Array, "batch"], Float[Array, "batch"]]:
    """Return the margin of the origin in the convex hull of points, and the point of the hull nearest to it.

    Parameters
    ----------
    xp : namespace
        The array library.
    x, y : array, shape (n, batch) or (n, 1)
        The points [m].
    counts : array of bool, shape (n, batch)
        Which of them are used.

    Returns
    -------
    margin, nearest_x, nearest_y : array, shape (batch,)
        Margin as in `hull_margin` [m]; nearest point, which is the origin where that is inside [m].
    """
    x, y = _gathered(xp, x, counts), _gathered(xp, y, counts)
    pairs = Pairs.of(xp, x, y)
    depth, _ = pairs.depth_and_width(xp)
    near_x, near_y, _ = pairs.nearest(xp)
    gap2 = near_x * near_x + near_y * near_y
    closest = xp.argmin(gap2, axis=0)[None, ...]
    gap = root(xp, xp.min(gap2, axis=0))
    margin = xp.where(xp.any(counts, axis=0), xp.where(depth > 0, depth, -gap), -xp.inf)
    inside = depth > 0
    on_hull = [xp.take_along_axis(near, closest, axis=0)[0, ...] for near in (near_x, near_y)]
    return margin, *(xp.where(inside, xp.zeros_like(near), near) for near in on_hull)


def _split(coordinates: Float[Array, "..."]) -> tuple[Float[Array, "..."], Float[Array, "..."]]:
    return coordinates[0, ...], coordinates[1, ...]


def _gathered(xp: Namespace, values: Float[Array, "..."], counts: Bool[Array, "n #batch"]) -> Float[Array, "..."]:
    """Replace unused points by a used one, so that the hull needs no mask."""
    first = xp.argmax(xp.astype(counts, xp.int8), axis=0)[None, ...]
    return xp.where(counts, values, xp.take_along_axis(values, first, axis=0))


def support_polygon(
    feet_xy: Float[Array, "n 2"] | Float[Array, "n 3"], contacts: Bool[Array, "n"]
) -> Float[Array, "corners 2"]:
    """Return the corners of the support polygon: the convex hull of the feet in contact.

    Parameters
    ----------
    feet_xy : array, shape (n, 2) or (n, 3)
        Feet [m]; heights are ignored.
    contacts : array of bool, shape (n,)
        Which of them are on the ground.

    Returns
    -------
    array, shape (corners, 2)
        Corners counter-clockwise, starting at the least x (then y) [m], without corners between two others on a line.
        Two, one or none where the feet span no area.

    Raises
    ------
    InputError
        If a shape is wrong, a value is not finite, or `contacts` is not of booleans.
    """
    feet = as_floats(np, feet_xy, name="feet_xy")
    down = as_mask(np, contacts, name="contacts")
    if feet.ndim != 2 or feet.shape[1] not in (2, 3):
        raise InputError(f"feet_xy has shape {feet.shape}; expected (n, 2) or (n, 3), without batch axes")
    require_shape("contacts", down, feet.shape[:1])
    require_finite("feet_xy", feet)
    return np.asarray(hull_corners(feet[down, :2].tolist()), dtype=np.float64).reshape(-1, 2)
