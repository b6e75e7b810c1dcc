"""Leg points with their first and second derivatives by the joint angles, for many evaluations of one robot.

The points are linear in the products of ``(1, cos h, sin h)``, of the heading h of the leg's plane, and
``(1, cos a, sin a, cos b, sin b)``, of the slopes a of the femur and b of the tibia. A derivative by a joint angle maps
these products to each other, so that the points and all their derivatives are one matrix times 15 numbers for each leg.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["LegDerivatives"]

# How the cosine and the sine of an angle change with it.
_ROTATE = np.array([[0.0, -1.0], [1.0, 0.0]])


class LegDerivatives:
    """Femur axis, knee and foot of each leg in B, and their derivatives.

    Parameters
    ----------
    robot : Robot
        A single robot.
    """

    def __init__(self, robot: Robot) -> None:
        self._yaw = np.asarray(robot.mount_yaw)
        points = _coefficients(robot)
        by_heading, by_femur, by_tibia = np.zeros((3, 3)), np.zeros((5, 5)), np.zeros((5, 5))
        by_heading[1:, 1:] = by_femur[1:3, 1:3] = by_femur[3:, 3:] = by_tibia[3:, 3:] = _ROTATE
        operators = (("labpx,ac->lcbpx", by_heading), ("labpx,bc->lacpx", by_femur), ("labpx,bc->lacpx", by_tibia))
        first = [np.einsum(how, points, operator) for how, operator in operators]
        second = [np.einsum(*operators[i][:1], first[j], operators[i][1]) for i in range(3) for j in range(i, 3)]
        table = np.stack([points, *first, *second], axis=3)
        self._table = np.ascontiguousarray(table.reshape(robot.legs, 15, 90))
        self._heading = np.ones((robot.legs, 3, 1))
        self._slopes = np.ones((robot.legs, 1, 5))

    def at(
        self, angles: Float[np.ndarray, "legs 3"]
    ) -> tuple[Float[np.ndarray, "legs 10 9"], Float[np.ndarray, "legs 3 3"]]:
        """Return points and derivatives, and the axes of the joints, in B.

        Parameters
        ----------
        angles : array, shape (legs, 3)
            Joint angles [rad].

        Returns
        -------
        points : array, shape (legs, 10, 9)
            Coordinates of femur axis, knee and foot, one after the other [m]; in the second axis the values, their
            derivatives by coxa (c), femur (f) and tibia (t), and the second ones by cc, cf, ct, ff, ft and tt.
        axes : array, shape (legs, 3, 3)
            Direction of each joint's axis: a positive angle turns about it, to the right.
        """
        argument = np.empty((3, len(angles)))
        argument[0], argument[1] = self._yaw + angles[:, 0], angles[:, 1]
        argument[2] = argument[1] + angles[:, 2]
        cos, sin = np.cos(argument), np.sin(argument)
        heading, slopes = self._heading.copy(), self._slopes.copy()
        heading[:, 1, 0], heading[:, 2, 0] = cos[0], sin[0]
        slopes[:, 0, 1:4:2], slopes[:, 0, 2:5:2] = cos[1:].T, sin[1:].T
        products = (heading * slopes).reshape(-1, 1, 15)
        axes = np.zeros((len(angles), 3, 3))
        axes[:, 0, 2] = 1.0
        axes[:, 1:, 0], axes[:, 1:, 1] = sin[0][:, None], -cos[0][:, None]
        return (products @ self._table).reshape(-1, 10, 9), axes


def _coefficients(robot: Robot) -> Float[np.ndarray, "legs 3 5 3 3"]:
    """Return the factors of the products, ``[leg, heading, slope, point, coordinate]`` [m]."""
    side, up = np.asarray(robot.femur_axis_offset).T
    coxa, femur, tibia = (np.broadcast_to(v, robot.legs) for v in (robot.coxa, robot.femur, robot.tibia))
    table = np.zeros((robot.legs, 3, 5, 3, 3))
    table[:, 0, 0] += np.asarray(robot.mount_position)[:, None, :]
    table[:, 0, 0, :, 2] += up[:, None]
    outward = {0: (coxa, (0, 1, 2)), 1: (femur, (1, 2)), 3: (tibia, (2,))}
    for slope, (length, points) in outward.items():
        for point in points:
            table[:, 1, slope, point, 0] += length
            table[:, 2, slope, point, 1] += length
            if slope:
                table[:, 0, slope + 1, point, 2] += length
    table[:, 2, 0, :, 0] -= side[:, None]
    table[:, 1, 0, :, 1] += side[:, None]
    return table
