"""Closed-form kinematics of one robot in plain floats: for a control loop, where array calls cost more."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, sin, sqrt
from typing import TYPE_CHECKING

import numpy as np

from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["ScalarSolver"]

# Pose of the body in its own frame B: rows of the rotation, and position [m].
_IN_BODY = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)), (0.0, 0.0, 0.0)


class ScalarSolver:
    """Inverse kinematics of the legs of one robot, knee up, and forward kinematics of its feet.

    Parameters
    ----------
    robot : Robot
        A single robot.
    """

    def __init__(self, robot: Robot) -> None:
        g = robot.geometry
        columns = (
            *(g.mount_x, g.mount_y, g.mount_z + g.up, g.cos_yaw, g.sin_yaw, g.coxa, g.side, g.side2),
            *(g.farthest2, g.nearest2, g.sum2, g.difference2),
        )
        self._links = _rows((np.asarray(robot.mount_yaw), *columns[:3], g.coxa, g.side, g.femur, g.tibia))
        limits = (g.coxa_lower, g.coxa_upper, g.femur_lower, g.femur_upper, g.tibia_lower, g.tibia_upper)
        self._legs, self._limits = _rows(columns), _rows(limits)

    def angles(
        self, feet: Sequence[Sequence[float]], rotation: Sequence[Sequence[float]], position: Sequence[float]
    ) -> list[tuple[float, float, float]] | None:
        """Return the joint angles; None if a leg is out of reach or beyond a joint limit.

        Parameters
        ----------
        feet : sequence of (x, y, z)
            The feet, in any frame [m].
        rotation : sequence of three rows
            Rotation of the body in that frame.
        position : (x, y, z)
            Position of the body's origin in that frame [m].

        Returns
        -------
        list of (coxa, femur, tibia), or None
            Joint angles of each leg [rad].
        """
        (r00, r01, r02), (r10, r11, r12), (r20, r21, r22) = rotation
        px, py, pz = position
        found = []
        for (fx, fy, fz), leg, limits in zip(feet, self._legs, self._limits, strict=True):
            mx, my, mz, cos_yaw, sin_yaw, coxa, side, side2, farthest2, nearest2, sum2, difference2 = leg
            dx, dy, dz = fx - px, fy - py, fz - pz
            bx, by = dx * r00 + dy * r10 + dz * r20 - mx, dx * r01 + dy * r11 + dz * r21 - my
            z = dx * r02 + dy * r12 + dz * r22 - mz
            x, y = cos_yaw * bx + sin_yaw * by, cos_yaw * by - sin_yaw * bx
            beside = x * x + y * y - side2
            if beside < 0:
                return None
            along = sqrt(beside)
            r = along - coxa
            distance2 = r * r + z * z
            far, near = farthest2 - distance2, distance2 - nearest2
            if far < 0 or near < 0:
                return None
            bend, base = sqrt(far * near), distance2 + difference2
            q0 = atan2(y * along - x * side, x * along + y * side)
            q1 = atan2(z * base + r * bend, r * base - z * bend)
            q2 = -atan2(bend, distance2 - sum2)
            l0, u0, l1, u1, l2, u2 = limits
            if not (l0 <= q0 <= u0 and l1 <= q1 <= u1 and l2 <= q2 <= u2):
                return None
            found.append((q0, q1, q2))
        return found

    def feet(
        self,
        angles: Sequence[Sequence[float]],
        rotation: Sequence[Sequence[float]] = _IN_BODY[0],
        position: Sequence[float] = _IN_BODY[1],
    ) -> list[tuple[float, float, float]]:
        """Return the feet, by forward kinematics.

        Parameters
        ----------
        angles : sequence of (coxa, femur, tibia)
            Joint angles of each leg [rad].
        rotation : sequence of three rows, optional
            Rotation of the body in any frame; left out, that frame is B.
        position : (x, y, z), optional
            Position of the body's origin in that frame [m].

        Returns
        -------
        list of (x, y, z)
            Positions in that frame [m].
        """
        (r00, r01, r02), (r10, r11, r12), (r20, r21, r22) = rotation
        px, py, pz = position
        found = []
        for (q0, q1, q2), (mount_yaw, mx, my, mz, coxa, side, femur, tibia) in zip(angles, self._links, strict=True):
            yaw, inclination = mount_yaw + q0, q1 + q2
            c, s = cos(yaw), sin(yaw)
            out = coxa + femur * cos(q1) + tibia * cos(inclination)
            x, y = mx + c * out - s * side, my + s * out + c * side
            z = mz + femur * sin(q1) + tibia * sin(inclination)
            found.append(
                (
                    px + r00 * x + r01 * y + r02 * z,
                    py + r10 * x + r11 * y + r12 * z,
                    pz + r20 * x + r21 * y + r22 * z,
                )
            )
        return found


def _rows(columns: Sequence[Float[np.ndarray, "legs"]]) -> list[tuple[float, ...]]:
    return list(zip(*(column.tolist() for column in columns), strict=True))
