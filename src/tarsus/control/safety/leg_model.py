"""Feet and centre of mass from joint angles, in scalar arithmetic for one robot.

Independent of the array code in `tarsus.kinematics`: fast for a single pose, and the guard does not share errors with
what it monitors.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tarsus.control.safety.support_geometry import Point
from tarsus.robot.robot import Robot

__all__ = ["LegModel"]


class _LegConstants(NamedTuple):
    """Constants of one leg.

    With the femur angle q1 and the tibia angle q2, the foot is ``coxa + femur cos(q1) + tibia cos(q1 + q2)`` outward
    of the coxa axis, and `z` plus the same sum of sines high. The first moment of the leg's masses, divided by the mass
    of the robot, is ``moment_out + moment_femur cos(q1) + moment_tibia cos(q1 + q2)`` outward, and `moment_up` plus the
    same sum of sines upward.
    """

    yaw: float
    x: float
    y: float
    z: float
    coxa: float
    femur: float
    tibia: float
    side: float
    mass: float
    moment_out: float
    moment_side: float
    moment_up: float
    moment_femur: float
    moment_tibia: float


class LegModel:
    """Forward kinematics and centre of mass of one robot.

    Parameters
    ----------
    robot : Robot
        A single robot. Without masses the legs count as massless.
    """

    def __init__(self, robot: Robot) -> None:
        total = float(np.asarray(robot.body_mass) + np.asarray(robot.link_mass).sum()) if robot.has_masses else 1.0
        self._legs = tuple(_constants(robot, leg, total) for leg in range(robot.legs))
        body_fraction = float(np.asarray(robot.body_mass) / total) if robot.has_masses else 1.0
        self._body_com = tuple(float(body_fraction * c) for c in np.asarray(robot.body_com))

    def points(self, angles: list[float]) -> tuple[list[Point], Point]:
        """Return the feet and the centre of mass in B [m].

        Parameters
        ----------
        angles : list of float
            Joint angles of all legs in one flat list [rad].
        """
        feet = []
        com_x, com_y, com_z = self._body_com
        cos, sin = math.cos, math.sin
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


def _constants(robot: Robot, leg: int, total: float) -> _LegConstants:
    """Return the constants of a leg; `total` is the mass of the robot [kg]."""
    coxa, femur, tibia = (float(lengths[leg]) for lengths in (robot.coxa, robot.femur, robot.tibia))
    side, up = map(float, robot.femur_axis_offset[leg])
    x, y, z = map(float, robot.mount_position[leg])
    masses = np.asarray(robot.link_mass)[leg] / total if robot.has_masses else np.zeros(3)
    coxa_mass, femur_mass, tibia_mass = map(float, masses)
    coxa_com, femur_com, tibia_com = map(float, robot.link_com[leg])
    outer_mass = femur_mass + tibia_mass
    # The coxa link runs straight from the coxa axis to the femur axis; if these coincide, its mass is there.
    length = math.sqrt(coxa * coxa + side * side + up * up)
    moment = coxa_mass * coxa_com / length + outer_mass if length > 0 else outer_mass
    return _LegConstants(
        yaw=float(robot.mount_yaw[leg]),
        x=x,
        y=y,
        z=z + up,
        coxa=coxa,
        femur=femur,
        tibia=tibia,
        side=side,
        mass=coxa_mass + outer_mass,
        moment_out=moment * coxa,
        moment_side=moment * side,
        moment_up=(coxa_mass + outer_mass) * z + moment * up,
        moment_femur=femur_mass * femur_com + tibia_mass * femur,
        moment_tibia=tibia_mass * tibia_com,
    )
