"""Constants of the legs' kinematics, computed once for a robot."""

from __future__ import annotations

from typing import NamedTuple, Self

import numpy as np

from tarsus.arrays import Array, Namespace, as_array
from tarsus.blocks import Index, columns

__all__ = ["LegGeometry"]


class LegGeometry(NamedTuple):
    """Lengths, mounts and limits of the legs, and quantities derived from them, of shape ``(..., legs)`` [m, rad].

    `side` and `up` are the sideways and vertical offsets of the femur axis from the coxa axis (the outward one is
    `coxa`). `farthest2` and `nearest2` are the squares of the greatest and least distance from femur axis to foot,
    `sum2` and `difference2` are ``femur^2 +- tibia^2``. `knee_span` is the greatest distance of a knee from B's z axis,
    `axis_depth` the greatest depth of coxa or femur axis below B's origin.
    """

    cos_yaw: Array
    sin_yaw: Array
    mount_x: Array
    mount_y: Array
    mount_z: Array
    coxa: Array
    femur: Array
    tibia: Array
    side: Array
    up: Array
    side2: Array
    farthest2: Array
    nearest2: Array
    sum2: Array
    difference2: Array
    knee_span: Array
    axis_depth: Array
    coxa_lower: Array
    coxa_upper: Array
    femur_lower: Array
    femur_upper: Array
    tibia_lower: Array
    tibia_upper: Array

    @classmethod
    def of(
        cls,
        xp: Namespace,
        *,
        mount_position: Array,
        mount_yaw: Array,
        coxa: Array,
        femur: Array,
        tibia: Array,
        femur_axis_offset: Array,
        limits: Array,
    ) -> Self:
        """Compute the constants from the arrays of a robot (shapes as in `Robot`)."""
        side, up = femur_axis_offset[..., 0], femur_axis_offset[..., 1]
        x, y, z = mount_position[..., 0], mount_position[..., 1], mount_position[..., 2]
        return cls(
            cos_yaw=xp.cos(mount_yaw),
            sin_yaw=xp.sin(mount_yaw),
            mount_x=x,
            mount_y=y,
            mount_z=z,
            coxa=coxa,
            femur=femur,
            tibia=tibia,
            side=side,
            up=up,
            side2=side * side,
            farthest2=(femur + tibia) ** 2,
            nearest2=(femur - tibia) ** 2,
            sum2=femur * femur + tibia * tibia,
            difference2=(femur - tibia) * (femur + tibia),
            knee_span=xp.sqrt(x * x + y * y) + coxa + xp.abs(side) + femur,
            axis_depth=xp.abs(up) - z,
            coxa_lower=limits[..., 0, 0],
            coxa_upper=limits[..., 0, 1],
            femur_lower=limits[..., 1, 0],
            femur_upper=limits[..., 1, 1],
            tibia_lower=limits[..., 2, 0],
            tibia_upper=limits[..., 2, 1],
        )

    def to(self, xp: Namespace) -> LegGeometry:
        """Return the constants as arrays of the namespace `xp`."""
        if xp is np:
            return self
        return LegGeometry(*(as_array(xp, values) for values in self))

    def take(self, index: Index, block: tuple[int, ...]) -> LegGeometry:
        """Return the constants of a block of the batch, as columns (see `tarsus.blocks.columns`)."""
        return LegGeometry(*(columns(values, index, block, tail=1) for values in self))

    def pick(self, where: tuple[Array, ...], shape: tuple[int, ...]) -> LegGeometry:
        """Return the constants of single NumPy legs ``(k,)`` at indices `where` along the axes of `shape`."""
        return LegGeometry(
            *(values[where[-1]] if values.ndim == 1 else np.broadcast_to(values, shape)[where] for values in self)
        )
