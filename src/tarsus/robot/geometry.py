"""Constants of the legs' kinematics, computed once for a robot."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Self

import numpy as np

from tarsus.arrays import Array, Namespace, as_array
from tarsus.blocks import Index, columns

if TYPE_CHECKING:
    from jaxtyping import Float, Int

__all__ = ["LegGeometry"]


class LegGeometry(NamedTuple):
    """Lengths, mounts and limits of the legs, and quantities derived from them, of shape ``(..., legs)`` [m, rad].

    `side` and `up` are the sideways and vertical offsets of the femur axis from the coxa axis (the outward one is
    `coxa`). `farthest2` and `nearest2` are the squares of the greatest and least distance from femur axis to foot,
    `sum2` and `difference2` are ``femur^2 +- tibia^2``. `knee_span` is the greatest distance of a knee from B's z axis,
    `axis_depth` the greatest depth of coxa or femur axis below B's origin.
    """

    cos_yaw: Float[Array, "..."]
    sin_yaw: Float[Array, "..."]
    mount_x: Float[Array, "..."]
    mount_y: Float[Array, "..."]
    mount_z: Float[Array, "..."]
    coxa: Float[Array, "..."]
    femur: Float[Array, "..."]
    tibia: Float[Array, "..."]
    side: Float[Array, "..."]
    up: Float[Array, "..."]
    side2: Float[Array, "..."]
    farthest2: Float[Array, "..."]
    nearest2: Float[Array, "..."]
    sum2: Float[Array, "..."]
    difference2: Float[Array, "..."]
    knee_span: Float[Array, "..."]
    axis_depth: Float[Array, "..."]
    coxa_lower: Float[Array, "..."]
    coxa_upper: Float[Array, "..."]
    femur_lower: Float[Array, "..."]
    femur_upper: Float[Array, "..."]
    tibia_lower: Float[Array, "..."]
    tibia_upper: Float[Array, "..."]

    @classmethod
    def of(
        cls,
        xp: Namespace,
        *,
        mount_position: Float[Array, "*#batch legs 3"],
        mount_yaw: Float[Array, "*#batch legs"],
        coxa: Float[Array, "*#batch legs"],
        femur: Float[Array, "*#batch legs"],
        tibia: Float[Array, "*#batch legs"],
        femur_axis_offset: Float[Array, "*#batch legs 2"],
        limits: Float[Array, "*#batch legs 3 2"],
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

    def with_axes(self, count: int) -> LegGeometry:
        """Return NumPy constants with axes of length 1 after that of the legs.

        With the positions of a foot on these last axes, arithmetic with the constants takes half the time.
        """
        return LegGeometry(*(values.reshape(*values.shape, *(1,) * count) for values in self))

    def take(self, index: Index, block: tuple[int, ...]) -> LegGeometry:
        """Return the constants of a block of the batch, as columns (see `tarsus.blocks.columns`)."""
        return LegGeometry(*(columns(values, index, block, tail=1) for values in self))

    def pick(self, where: tuple[Int[Array, "..."], ...], shape: tuple[int, ...]) -> LegGeometry:
        """Return the constants of single NumPy legs ``(k,)`` at indices `where` along the axes of `shape`."""
        return LegGeometry(
            *(values[where[-1]] if values.ndim == 1 else np.broadcast_to(values, shape)[where] for values in self)
        )
