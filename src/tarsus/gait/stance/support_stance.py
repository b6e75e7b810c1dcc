"""A stance in which a gait supports the robot: legs turned about their coxa axes towards the places of missing ones."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.gait.gait import Gait
from tarsus.gait.spacing import default_foot_distance
from tarsus.incremental import Incremental
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.polygon import hull_margin
from tarsus.kinematics.stance import default_stance
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["support_stance"]

# Step sizes of the search: the first, and the one at which it ends [rad].
_FIRST_STEP, _LAST_STEP = 0.2, 0.02
# Trials in a stage of the search.
_IN_STAGE = 4
# Width of the smooth minimum, over the mean length of the legs: the search would get stuck at kinks of a true minimum.
_SMOOTH = 0.05


def support_stance(
    robot: Robot, gait: Gait, *, body_height: float | None = None, swing_height: float | None = None
) -> Incremental[Float[np.ndarray, "legs"]]:
    """Find the coxa angles of a stance in which the feet that a gait leaves on the ground support the robot.

    Where a robot lacks a leg, the others move towards its place. A pattern search maximises the smooth minimum of
    three kinds of length: the distance of the centre of mass from the edges of the support polygons, half the excess
    of the distance between neighbouring feet over the least one, and the distance of each foot from where its coxa is
    at its limit.

    Parameters
    ----------
    robot : Robot
        A single robot.
    gait : Gait
        A gait for the robot's number of legs.
    body_height, swing_height : float, optional
        Body height and swing height of the stance [m]. Default: the robot's.

    Returns
    -------
    array, shape (legs,)
        Coxa angles [rad].

    Raises
    ------
    UnreachableError
        If a leg does not reach the ground at that body height.
    """
    feet = np.asarray(default_stance(robot, body_height, swing_height=swing_height))
    angles = np.asarray(inverse_kinematics(robot, feet).angles)
    centre = np.asarray(centre_of_mass(robot, angles))
    mount = np.asarray(robot.mount_position)
    # As complex numbers, x + iy: a rotation about a coxa axis is a product.
    axes, arms = (mount - centre)[:, 0] + 1j * (mount - centre)[:, 1], (feet - mount)[:, 0] + 1j * (feet - mount)[:, 1]
    lower, upper = np.asarray(robot.limits)[:, 0].T - angles[:, 0]
    after = np.asarray(gait.offsets) + gait.duty_factor + 1e-6
    contacts, apart = gait.phase(after)[2], default_foot_distance(robot)
    width = _SMOOTH * float(np.abs(arms).mean())

    def quality(turned: Float[np.ndarray, "legs"]) -> float:
        at = axes + arms * np.exp(1j * turned)
        points = np.broadcast_to(np.stack([at.real, at.imag], axis=-1), (*contacts.shape, 2))
        support = np.asarray(hull_margin(points, contacts, np.zeros(2)))
        spacing = (np.abs(at - np.roll(at, 1)) - apart) / 2
        room = np.abs(arms) * np.sin(np.minimum(upper - turned, turned - lower))
        values = np.concatenate([support, spacing, room])
        return float(values.min() - width * np.log(np.exp((values.min() - values) / width).sum()))

    best = np.zeros(robot.legs)
    found, step = quality(best), _FIRST_STEP
    while step > _LAST_STEP:
        before = found
        for index, trial in enumerate(np.concatenate([np.eye(robot.legs), -np.eye(robot.legs)])):
            turned = np.clip(best + step * trial, lower, upper)
            if (value := quality(turned)) > found:
                best, found = turned, value
            if index % _IN_STAGE == 0:
                yield
        step = step if found > before else step / 2
    return np.asarray(angles[:, 0] + best)
