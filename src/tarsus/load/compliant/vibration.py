"""Inertia of a robot's deviations from its commanded motion, integrated by Newmark's method.

The loads along a motion include the inertial forces of its commanded accelerations. Beyond them a body on compliant
legs rises and falls, and rolls, where feet take over its weight. For the offset x of body and joints from their
commands, after a step h::

    acceleration  a = (x - ahead) / (beta h^2),  ahead = x0 + h v0 + (1/2 - beta) h^2 a0
    speed         v = v0 + (1 - gamma) h a0 + gamma h a

With gamma above 1/2, motion faster than the steps is damped, as are the impacts of feet (N. M. Newmark, "A method of
computation for structural dynamics", Journal of the Engineering Mechanics Division 85, 1959).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Self

import numpy as np

from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import point_masses
from tarsus.load.payload import Payload
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Vibration", "rigid_inertia"]

_GAMMA = 1.0
_BETA = (_GAMMA + 0.5) ** 2 / 4  # stable for every step


class Vibration(NamedTuple):
    """Offset of body and joints from their commands, its speed and its acceleration.

    Attributes
    ----------
    offset, speed, acceleration : array, shape (6 + 3 legs,)
        Translation of the body in G, its rotation about the axes of G, and joint angles [m, rad, and per s and s^2].
    """

    offset: Float[np.ndarray, "unknowns"]
    speed: Float[np.ndarray, "unknowns"]
    acceleration: Float[np.ndarray, "unknowns"]

    @classmethod
    def still(cls, offset: Float[np.ndarray, "unknowns"]) -> Self:
        """Return an offset that does not change."""
        return cls(offset, np.zeros_like(offset), np.zeros_like(offset))

    @staticmethod
    def gain(step: float) -> float:
        """Return the acceleration per offset beyond `ahead`, after a step of time [1/s^2]."""
        return 1.0 / (_BETA * step * step)

    def ahead(self, step: float) -> Float[np.ndarray, "unknowns"]:
        """Return the offset after a step of time [s] if the acceleration at its end is 0."""
        found: np.ndarray = self.offset + step * self.speed + ((0.5 - _BETA) * step * step) * self.acceleration
        return found

    def after(self, offset: Float[np.ndarray, "unknowns"], step: float) -> Self:
        """Return the vibration after a step of time [s], given the offset that was found at its end."""
        acceleration = (offset - self.ahead(step)) * self.gain(step)
        gained = step * ((1.0 - _GAMMA) * self.acceleration + _GAMMA * acceleration)
        return type(self)(offset, self.speed + gained, acceleration)


def rigid_inertia(robot: Robot, angles: Float[np.ndarray, "legs 3"], payload: Payload) -> Float[np.ndarray, "6 6"]:
    """Return the inertia of a robot with locked joints, for translation along and rotation about B's axes.

    Parameters
    ----------
    robot : Robot
        A single robot with masses; its links count as point masses at their ends.
    angles : array, shape (legs, 3)
        Joint angles [rad].
    payload : Payload
        Payload on the body.

    Returns
    -------
    array, shape (6, 6)
        Inertia about B's origin [kg, kg m, kg m^2].
    """
    points = np.asarray(forward_kinematics(robot, angles)).reshape(-1, 3)
    at = np.vstack([points, np.asarray(robot.body_com)[None], np.asarray(payload.position)[None]])
    masses = np.append(np.ravel(point_masses(np, robot)), [float(np.asarray(robot.body_mass)), payload.mass])
    x, y, z = at.T
    zero = np.zeros_like(x)
    # A rotation w about B's origin moves a point p by w x p = levers @ w.
    levers = np.stack([zero, z, -y, -z, zero, x, y, -x, zero], axis=-1).reshape(-1, 3, 3)
    moved = np.concatenate([np.broadcast_to(np.eye(3), levers.shape), levers], axis=-1)
    inertia: np.ndarray = np.einsum("p,pia,pib->ab", masses, moved, moved)
    if robot.body_size is not None:
        squares = np.asarray(robot.body_size) ** 2
        inertia[3:, 3:] += np.diag(masses[-2] / 12 * (squares.sum() - squares))
    return inertia
