"""A robot that has lost some of its legs, and a robot whose coxa angles have other zeros."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.errors import InputError
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["remaining_robot", "turned_robot"]

_FEWEST_LEGS = 4
# Attributes of a robot with one value for each leg.
_OF_LEGS = (
    *("mount_position", "mount_yaw", "coxa", "femur", "tibia", "limits"),
    *("femur_axis_offset", "foot_radius", "link_com"),
)


def remaining_robot(robot: Robot, legs: list[int]) -> Robot:
    """Return the robot with some of its legs; the masses of the lost legs are added to its body, at their mounts.

    Parameters
    ----------
    robot : Robot
        A single robot.
    legs : list of int
        The legs that are left, four or more.

    Raises
    ------
    InputError
        If fewer than four legs are left.
    """
    if len(legs) < _FEWEST_LEGS:
        raise InputError(f"{len(legs)} legs are left; a robot has {_FEWEST_LEGS} or more")
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


def turned_robot(robot: Robot, coxa: Float[np.ndarray, "legs"]) -> Robot:
    """Return the same robot with other zeros of its coxa angles: `mount_yaw` and limits are shifted.

    Parameters
    ----------
    robot : Robot
        A single robot.
    coxa : array, shape (legs,)
        Coxa angles of `robot` that are 0 in the robot returned [rad].
    """
    limits = np.array(robot.limits)
    limits[:, 0] -= coxa[:, None]
    return dataclasses.replace(robot, mount_yaw=np.asarray(robot.mount_yaw) + coxa, limits=limits)
