"""Exact values of what can be measured, from the state of the physics engine."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.robot.robot import Robot
from tarsus.simulation.engine import mujoco_module
from tarsus.simulation.robot_model import foot_geom_name
from tarsus.simulation.terrain.protocol import Terrain

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Measurement"]

_ONES = np.ones(3)
# Points around the body at which the ground is measured [m]: along each axis; the grid, as x + iy.
_REACH = np.linspace(-0.6, 0.6, 61)
_AROUND = _REACH[:, None] + 1j * _REACH


class Measurement:
    """Reads a robot's state from the physics engine.

    Parameters
    ----------
    robot : Robot
        The robot.
    model : mujoco.MjModel
        Its model.
    data : mujoco.MjData
        The state; all methods read its present content.
    """

    def __init__(self, robot: Robot, model: Any, data: Any) -> None:
        self._mujoco, self._model, self._data = mujoco_module(), model, data
        self._legs = robot.legs
        self._leg_of = {model.geom(foot_geom_name(robot, leg)).id: leg for leg in range(robot.legs)}
        # Views are kept, as looking an array up in the engine's data takes longer than reading it.
        self._orientation, self._before, self._rates = data.qpos[3:7], np.zeros(4), np.zeros(3)
        found = data.sensordata[: 3 * robot.legs + 1]
        self._foot_forces, self._body_contact = found[:-1].reshape(robot.legs, 3), found[-1:]

    def rotation(self) -> Float[np.ndarray, "3 3"]:
        """Return the rotation from B to G, ``(3, 3)``."""
        matrix = np.empty(9)
        self._mujoco.mju_quat2Mat(matrix, self._orientation)
        return matrix.reshape(3, 3)

    def attitude(self) -> Float[np.ndarray, "2"]:
        """Return roll and pitch of B, ``(2,)`` [rad]."""
        w, x, y, z = self._orientation.tolist()
        roll = math.atan2(2 * (y * z + w * x), 1 - 2 * (x * x + y * y))
        return np.array([roll, math.asin(max(-1.0, min(1.0, 2 * (w * y - x * z))))])

    def foot_forces(self) -> Float[np.ndarray, "legs 3"]:
        """Return the forces of the ground on the feet in G, ``(legs, 3)`` [N]."""
        # The sensor gives the force of the foot on the ground.
        forces: np.ndarray = np.negative(self._foot_forces)
        return forces

    def contact_forces(self) -> Float[np.ndarray, "legs"]:
        """Return the magnitudes of the forces of the ground on the feet, ``(legs,)`` [N]."""
        magnitudes: np.ndarray = np.sqrt(np.square(self._foot_forces) @ _ONES)
        return magnitudes

    def slip_speeds(self) -> Float[np.ndarray, "legs"]:
        """Return how fast the contact point of each foot slides over the ground, ``(legs,)`` [m/s]; 0 in the air.

        A ball that rolls does not slide: the speed is that of the ball's material at the contact point, along the
        ground.
        """
        speeds, contact, velocity = np.zeros(self._legs), self._data.contact, np.empty(6)
        kind = self._mujoco.mjtObj.mjOBJ_XBODY
        for number, pair in enumerate(contact.geom.tolist()):
            geom = pair[1] if pair[1] in self._leg_of else pair[0]
            leg = self._leg_of.get(geom)
            if leg is None:
                continue
            link = self._model.geom_bodyid[geom]
            self._mujoco.mj_objectVelocity(self._model, self._data, kind, link, velocity, 0)
            # In plain numbers: NumPy's cross product of two vectors takes ten times as long.
            (wx, wy, wz, vx, vy, vz), (nx, ny, nz) = velocity.tolist(), contact.frame[number, :3].tolist()
            x, y, z = (contact.pos[number] - self._data.xpos[link]).tolist()
            moved = (vx + wy * z - wz * y, vy + wz * x - wx * z, vz + wx * y - wy * x)
            into = moved[0] * nx + moved[1] * ny + moved[2] * nz
            speeds[leg] = max(speeds[leg], math.hypot(moved[0] - into * nx, moved[1] - into * ny, moved[2] - into * nz))
        return speeds

    def body_touches(self) -> bool:
        """Return whether the body is in contact with the ground."""
        return bool(self._body_contact[0])

    def turned(self, time: float = 0.0) -> None:
        """Take note of how B has turned since the last call.

        Commands change in steps, and stiff servos turn the body in jerks: its angular velocity at the end of a tick is
        systematically less than the mean over the tick, which a sensor of angular rates measures.

        Parameters
        ----------
        time : float
            Time since the last call [s]; 0 at the start, for a body at rest.
        """
        if time:
            self._mujoco.mju_subQuat(self._rates, self._orientation, self._before)
        self._rates *= 1 / time if time else 0.0
        self._before[:] = self._orientation

    def angular_rates(self) -> Float[np.ndarray, "3"]:
        """Return the mean angular velocity of B between the last calls of `turned`, in its axes, ``(3,)`` [rad/s]."""
        return self._rates.copy()

    def ground_heights(self, terrain: Terrain) -> Float[np.ndarray, "rows columns"]:
        """Return the heights of the ground on a level grid around the body, as in `GroundHeights` [m].

        Parameters
        ----------
        terrain : Terrain
            The ground.
        """
        x, y = self._data.qpos[:2].tolist()
        ahead = self.rotation()[:2, 0]
        places = complex(x, y) + complex(*ahead.tolist()) / math.hypot(*ahead.tolist()) * _AROUND
        return np.asarray(terrain.height(places.real, places.imag), dtype=float)
