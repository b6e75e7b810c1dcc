"""The constants that every leg's kinematics starts from, worked out once for a robot."""

from __future__ import annotations

from typing import NamedTuple, Self

from tarsus.arrays import Array, Index, Namespace, as_array, take_block

__all__ = ["LegGeometry"]


class LegGeometry(NamedTuple):
    """Lengths, mounts and limits of the legs, each ``(..., legs)`` [m, rad], and what follows from them.

    `side` and `up` are the femur axis' offsets from the coxa axis, sideways and vertical (the first is `coxa`).
    `farthest2` and `nearest2` are the squares of the longest and shortest distance from femur axis to foot,
    `sum2` and `difference2` those of ``femur^2 +- tibia^2``. `lower` and `upper` are ``(..., legs, 3)``.
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
    lower: Array
    upper: Array

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
        """Work the constants out from a robot's arrays (shapes as in `Robot`)."""
        side = femur_axis_offset[..., 0]
        return cls(
            cos_yaw=xp.cos(mount_yaw),
            sin_yaw=xp.sin(mount_yaw),
            mount_x=mount_position[..., 0],
            mount_y=mount_position[..., 1],
            mount_z=mount_position[..., 2],
            coxa=coxa,
            femur=femur,
            tibia=tibia,
            side=side,
            up=femur_axis_offset[..., 1],
            side2=side * side,
            farthest2=(femur + tibia) ** 2,
            nearest2=(femur - tibia) ** 2,
            sum2=femur * femur + tibia * tibia,
            difference2=(femur - tibia) * (femur + tibia),
            lower=limits[..., 0],
            upper=limits[..., 1],
        )

    def to(self, xp: Namespace) -> LegGeometry:
        """Return the same numbers as arrays of the namespace `xp`."""
        return LegGeometry(*(as_array(xp, values) for values in self))

    def take(self, index: Index) -> LegGeometry:
        """Return the part that belongs to a block of the batch (see `tarsus.arrays.batch_blocks`)."""
        tails = (1,) * 15 + (2, 2)
        return LegGeometry(*(take_block(v, index, tail=t) for v, t in zip(self, tails, strict=True)))
