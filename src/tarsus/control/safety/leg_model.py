"""Feet and centre of mass from joint angles, in scalar arithmetic for one robot.

Independent of the array code in `tarsus.kinematics`: fast for a single pose, and the guard does not share errors with
what it monitors.
"""

from __future__ import annotations

from math import cos, sin
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.safety.support_geometry import Point
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["LegModel"]


class LegModel:
    """Forward kinematics and centre of mass of one robot.

    Parameters
    ----------
    robot : Robot
        A single robot. Without masses the legs count as massless.
    """

    def __init__(self, robot: Robot) -> None:
        masses = np.asarray(robot.link_mass) if robot.has_masses else np.zeros((robot.legs, 3))
        body_mass = np.asarray(robot.body_mass if robot.has_masses else 1.0)
        total = body_mass + masses.sum()
        self._legs = _constants(robot, masses / total)
        self._body_com: list[float] = (np.asarray(robot.body_com) * body_mass / total).tolist()

    def points(self, angles: list[float]) -> tuple[list[Point], Point]:
        """Return the feet and the centre of mass in B [m].

        Parameters
        ----------
        angles : list of float
            Joint angles of all legs in one flat list [rad].
        """
        feet = []
        com_x, com_y, com_z = self._body_com
        i = 0
        for yaw, x, y, z, coxa, femur, tibia, side, mass, m_out, m_side, m_up, m_femur, m_tibia in self._legs:
            heading, femur_angle = yaw + angles[i], angles[i + 1]
            tibia_angle = femur_angle + angles[i + 2]
            c, s, cf, sf = cos(heading), sin(heading), cos(femur_angle), sin(femur_angle)
            ct, st = cos(tibia_angle), sin(tibia_angle)
            i += 3
            r = coxa + femur * cf + tibia * ct
            feet.append((x + r * c - side * s, y + r * s + side * c, z + femur * sf + tibia * st))
            r = m_out + m_femur * cf + m_tibia * ct
            com_x += mass * x + r * c - m_side * s
            com_y += mass * y + r * s + m_side * c
            com_z += m_up + m_femur * sf + m_tibia * st
        return feet, (com_x, com_y, com_z)


def _constants(robot: Robot, masses: Float[np.ndarray, "legs 3"]) -> list[tuple[float, ...]]:
    """Return the constants of each leg; `masses` are those of its links over that of the robot.

    With the femur angle q1 and the tibia angle q2, the foot is ``coxa + femur cos(q1) + tibia cos(q1 + q2)`` outward
    of the coxa axis, and its height is that of the femur axis plus the same sum of sines. The first moment of the leg's
    masses, divided by the mass of the robot, is ``out + femur cos(q1) + tibia cos(q1 + q2)`` outward with its own
    constants, the last five, and `up` plus the same sum of sines upward.
    """
    coxa, femur, tibia, (side, up) = robot.coxa, robot.femur, robot.tibia, robot.femur_axis_offset.T
    (x, y, z), (coxa_mass, femur_mass, tibia_mass) = robot.mount_position.T, masses.T
    coxa_com, femur_com, tibia_com = robot.link_com.T
    mass, outer_mass = masses.sum(axis=1), femur_mass + tibia_mass
    # The coxa link runs straight from the coxa axis to the femur axis; if these coincide, its mass is there.
    length = np.sqrt(coxa * coxa + side * side + up * up)
    moment = coxa_mass * np.where(length > 0, coxa_com / np.where(length > 0, length, 1.0), 0.0) + outer_mass
    moments = (moment * coxa, moment * side, mass * z + moment * up)
    outer_moments = (femur_mass * femur_com + tibia_mass * femur, tibia_mass * tibia_com)
    columns = (robot.mount_yaw, x, y, z + up, coxa, femur, tibia, side, mass, *moments, *outer_moments)
    return list(zip(*(column.tolist() for column in columns), strict=True))
