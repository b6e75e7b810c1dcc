"""Leg points with their first and second derivatives by the joint angles, for many evaluations of one robot.

The points are linear in the products of ``(1, cos h, sin h)``, of the heading h of the leg's plane, and
``(cos a, sin a, cos b, sin b, 1)``, of the slopes a of the femur and b of the tibia. A derivative by a joint angle maps
these products to each other, so that the points and all their derivatives are one matrix times 15 numbers for each leg.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["LegDerivatives"]

# Derivatives of the cosine and the sine of an angle, in terms of these two.
_ROTATE = np.array([[0.0, -1.0], [1.0, 0.0]])
# Heading, less the mount yaw, and slopes of femur and tibia are joint angles times this.
_SUMS = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 1.0], [0.0, 0.0, 1.0]])


class LegDerivatives:
    """Positions of femur axis, knee and foot of each leg from B's origin, and their derivatives by the joint angles.

    Parameters
    ----------
    robot : Robot
        A single robot.
    radius : array, shape (legs,)
        Radii of the feet [m].
    """

    def __init__(self, robot: Robot, radius: Float[np.ndarray, "legs"]) -> None:
        points = _coefficients(robot)
        by_heading, by_femur, by_tibia = np.zeros((3, 3)), np.zeros((5, 5)), np.zeros((5, 5))
        by_heading[1:, 1:] = by_femur[:2, :2] = by_femur[2:4, 2:4] = by_tibia[2:4, 2:4] = _ROTATE
        operators = (("labpx,ac->lcbpx", by_heading), ("labpx,bc->lacpx", by_femur), ("labpx,bc->lacpx", by_tibia))
        first = [np.einsum(how, points, operator) for how, operator in operators]
        second = [np.einsum(*operators[i][:1], first[j], operators[i][1]) for i in range(3) for j in range(i, 3)]
        table = np.zeros((robot.legs, 3, 5, 10, 4, 3))
        table[:, :, :, :, :3] = np.stack([points, *first, *second], axis=3)
        levers = table[:, :, 4, 1:4, 3]
        levers[:, 0, 0, 2] = levers[:, 2, 1, 0] = levers[:, 2, 2, 0] = radius
        levers[:, 1, 1, 1] = levers[:, 1, 2, 1] = -radius
        self._table = np.ascontiguousarray(table.reshape(robot.legs, 15, 120))
        self._zero = np.zeros((robot.legs, 3))
        self._zero[:, 0] = robot.mount_yaw
        factors = np.ones((robot.legs, 8))
        self._cos, self._sin = factors[:, 1:7:2], factors[:, 2:7:2]
        self._heading, self._slopes = factors[:, :3, None], factors[:, None, 3:]

    def at(
        self, angles: Float[np.ndarray, "legs 3"], rotation: Float[np.ndarray, "3 3"]
    ) -> Float[np.ndarray, "legs 10 12"]:
        """Return points and derivatives in G.

        Parameters
        ----------
        angles : array, shape (legs, 3)
            Joint angles [rad].
        rotation : array, shape (3, 3)
            Rotation of B in G.

        Returns
        -------
        array, shape (legs, 10, 12)
            Second axis: the values, their first derivatives by coxa (c), femur (f) and tibia (t), and their second ones
            by cc, cf, ct, ff, ft and tt. Last axis: the coordinates of femur axis, knee and foot from B's origin, one
            after the other; then, in the rows of the first derivatives, the joint axis times the foot's radius [m].
        """
        argument = angles @ _SUMS + self._zero
        np.cos(argument, out=self._cos)
        np.sin(argument, out=self._sin)
        products = (self._heading * self._slopes).reshape(-1, 1, 15)
        in_ground: np.ndarray = (products @ self._table).reshape(-1, 3) @ rotation.T
        return in_ground.reshape(-1, 10, 12)


def _coefficients(robot: Robot) -> Float[np.ndarray, "legs 3 5 3 3"]:
    """Return the factors of the products, ``[leg, heading, slope, point, coordinate]`` [m]."""
    side, up = np.asarray(robot.femur_axis_offset).T
    coxa, femur, tibia = (np.broadcast_to(v, robot.legs) for v in (robot.coxa, robot.femur, robot.tibia))
    table = np.zeros((robot.legs, 3, 5, 3, 3))
    table[:, 0, 4] += np.asarray(robot.mount_position)[:, None, :]
    table[:, 0, 4, :, 2] += up[:, None]
    outward = {4: (coxa, (0, 1, 2)), 0: (femur, (1, 2)), 2: (tibia, (2,))}
    for slope, (length, points) in outward.items():
        for point in points:
            table[:, 1, slope, point, 0] += length
            table[:, 2, slope, point, 1] += length
            if slope < 4:
                table[:, 0, slope + 1, point, 2] += length
    table[:, 2, 4, :, 0] -= side[:, None]
    table[:, 1, 4, :, 1] += side[:, None]
    return table
