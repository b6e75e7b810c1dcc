"""The robot that is left without some of its legs."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from tarsus.robot.robot import Robot

__all__ = ["remaining_robot"]

# Values of a robot that it has for each leg.
_OF_LEGS = (
    *("mount_position", "mount_yaw", "coxa", "femur", "tibia", "limits"),
    *("femur_axis_offset", "foot_radius", "link_com"),
)


def remaining_robot(robot: Robot, legs: list[int]) -> Robot:
    """Return the robot with some of its legs; the masses of the others are part of its body.

    Parameters
    ----------
    robot : Robot
        A single robot.
    legs : list of int
        The legs that are left, four or more.
    """
    lost = [leg for leg in range(robot.legs) if leg not in legs]
    values: dict[str, Any] = {name: np.asarray(getattr(robot, name))[legs] for name in _OF_LEGS}
    if robot.link_mass is not None:
        values["link_mass"] = np.asarray(robot.link_mass)[legs]
    if robot.has_masses:
        masses, mass = np.asarray(robot.link_mass)[lost].sum(axis=-1), np.asarray(robot.body_mass)
        moment = mass * np.asarray(robot.body_com) + masses @ np.asarray(robot.mount_position)[lost]
        values |= {"body_mass": mass + masses.sum(), "body_com": moment / (mass + masses.sum())}
    return dataclasses.replace(
        robot,
        leg_names=tuple(robot.leg_names[leg] for leg in legs),
        servos=tuple(robot.servos[leg] for leg in legs),
        **values,
    )
