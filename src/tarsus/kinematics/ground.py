"""The ground below the body: the frame on it, and legs that are below it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, Self

import numpy as np

from tarsus.arrays import Array, Namespace
from tarsus.blocks import Index, columns
from tarsus.kinematics.leg import point_parts
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.reach import LENGTH_TOLERANCE, Reach, mark
from tarsus.robot.geometry import LegGeometry

if TYPE_CHECKING:
    from jaxtyping import Float, Int

__all__ = ["PoseComponents", "certainly_above_ground", "ground_frame", "mark_below_ground", "points_in_body"]


class PoseComponents(NamedTuple):
    """A pose as its components ``rotation[row][column]`` and ``position[axis]``, in the layout of the leg geometry."""

    rotation: tuple[tuple[Float[Array, "..."], ...], ...]
    position: tuple[Float[Array, "..."], ...]

    @classmethod
    def of_block(cls, body: Pose, index: Index, block: tuple[int, ...]) -> Self:
        """Return the components of a block of the batch, as columns (see `tarsus.blocks.columns`)."""
        rotation, position = (
            columns(body.rotation, index, block, tail=2),
            columns(body.position, index, block, tail=1),
        )
        return cls(tuple(tuple(rotation[j, i] for j in range(3)) for i in range(3)), tuple(position))

    @classmethod
    def of_picked(cls, body: Pose, where: tuple[Int[Array, "..."], ...], batch: tuple[int, ...]) -> Self:
        """Return the components of the NumPy poses at indices `where` along the batch axes."""
        rotation = np.broadcast_to(body.rotation, (*batch, 3, 3))[where]
        position = np.broadcast_to(body.position, (*batch, 3))[where]
        rows = tuple(tuple(rotation[..., i, j] for j in range(3)) for i in range(3))
        return cls(rows, tuple(position[..., i] for i in range(3)))

    @classmethod
    def of(cls, xp: Namespace, body: Pose) -> Self:
        """Return the components as ``(..., 1)``; the last axis broadcasts with the legs."""
        rotation, position = xp.asarray(body.rotation), xp.asarray(body.position)
        elements = tuple(tuple(rotation[..., i, j, None] for j in range(3)) for i in range(3))
        return cls(elements, tuple(position[..., i, None] for i in range(3)))

    def into_body(
        self, x: Float[Array, "..."], y: Float[Array, "..."], z: Float[Array, "..."]
    ) -> tuple[Float[Array, "..."], ...]:
        """Transform points from G to B."""
        (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = self.rotation
        x, y, z = x - self.position[0], y - self.position[1], z - self.position[2]
        return xx * x + yx * y + zx * z, xy * x + yy * y + zy * z, xz * x + yz * y + zz * z

    def height(self, x: Float[Array, "..."], y: Float[Array, "..."], z: Float[Array, "..."]) -> Float[Array, "..."]:
        """Return the height above the ground of points in B."""
        zx, zy, zz = self.rotation[2]
        return zx * x + zy * y + zz * z + self.position[2]


def ground_frame(body: Pose) -> Pose:
    """Return the frame on the ground below a body that has the body's heading.

    Parameters
    ----------
    body : Pose
        A single pose of B in G.
    """
    yaw = float(np.asarray(body.rpy)[2])
    return Pose.from_rpy(0.0, 0.0, yaw, (float(body.position[0]), float(body.position[1]), 0.0))


def points_in_body(body: Pose, points: Float[Array, "*#batch 3"]) -> Float[Array, "... k 3"]:
    """Transform NumPy points ``(..., k, 3)`` from G to B: as `PoseComponents.into_body` does, to the bit."""
    rotation, offset = body.rotation, points - body.position[..., None, :]
    in_body = offset[..., 0:1] * rotation[..., None, 0, :] + offset[..., 1:2] * rotation[..., None, 1, :]
    return in_body + offset[..., 2:3] * rotation[..., None, 2, :]


def mark_below_ground(
    xp: Namespace,
    geometry: LegGeometry,
    joints: tuple[Float[Array, "..."], ...],
    codes: Int[Array, "..."],
    body: PoseComponents,
) -> Int[Array, "..."]:
    """Mark legs whose coxa axis is below the ground, and legs within reach whose femur axis or knee is."""
    parts = point_parts(xp, geometry, *joints)
    attachment, axis, knee = (body.height(*parts[i : i + 3]) < -LENGTH_TOLERANCE for i in (0, 3, 6))
    return mark(xp, codes, attachment | ((codes == 0) & (axis | knee)), Reach.BELOW_GROUND)


def certainly_above_ground(geometry: LegGeometry, femur: Float[Array, "..."], body: PoseComponents) -> bool:
    """Return whether all bodies are so high that no point of a NumPy leg except the foot can be below the ground."""
    g = geometry
    zx, zy, zz = body.rotation[2]
    if not femur.size:
        return True
    if zz.min() < 0:
        return False
    lean = math.sqrt(float((zx * zx + zy * zy).max()))
    # Between -pi/2 and pi the sine has its minimum at the least angle, or is positive.
    low = max(-float(femur.min()), 0.0)
    drop = math.sin(low) if low < math.pi / 2 and float(femur.max()) < math.pi else 1.0
    # A point above B's origin counts as level with it: tilting the body lowers it by an unknown amount.
    lowest = lean * g.knee_span + np.maximum(drop * g.femur + g.axis_depth, 0.0)
    return bool(body.position[2].min() > lowest.max())
