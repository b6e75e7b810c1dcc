"""Joint angles of a gait state, computed in plain numbers: the inverse kinematics of every tick."""

from __future__ import annotations

import cmath
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.filters import CriticallyDamped
from tarsus.control.walk.ground_pose import body_posture
from tarsus.control.walk.state import GaitState
from tarsus.control.workspace.body_shift import NO_SHIFT
from tarsus.control.workspace.stance_geometry import SWING_HEIGHT, Rows, rotation_rows
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.scalar_solver import ScalarSolver
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["JointSolver"]


class JointSolver:
    """Computes the joint angles of one robot for the states of its walk.

    Parameters
    ----------
    robot : Robot
        A single robot.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._scalar_solver = ScalarSolver(robot)
        # Rotation, position and swing height are kept for as long as the posture stays the same object.
        self._posture: CriticallyDamped | None = None
        self._body: tuple[Rows, list[float], float] = (((),), [], 0.0)

    def angles(self, state: GaitState) -> Float[np.ndarray, "legs 3"]:
        """Return the joint angles of a state; for feet out of reach, those of the nearest reachable points.

        Parameters
        ----------
        state : GaitState
            The state of the walk.

        Returns
        -------
        array, shape (legs, 3)
            Joint angles, read-only [rad].
        """
        rotation, position, swing_height = self._body_at(state)
        turn, origin = cmath.exp(-1j * state.yaw), state.origin
        elevation = float(state.elevation.value[0])
        feet = []
        for foot, height, offset in zip(
            state.foot.tolist(), state.heights(swing_height), state.admittance_offset.value.tolist(), strict=True
        ):
            in_heading = (foot - origin) * turn
            feet.append((in_heading.real, in_heading.imag, height + offset - elevation))
        found = self._scalar_solver.angles(feet, rotation, position)
        if found is None:
            in_body = (np.array(feet) - position) @ np.array(rotation)
            angles = np.array(inverse_kinematics(self._robot, in_body).angles)
        else:
            angles = np.array(found)
        angles.setflags(write=False)
        return angles

    def _body_at(self, state: GaitState) -> tuple[Rows, list[float], float]:
        if state.posture is not self._posture or state.shift is not NO_SHIFT:
            row = state.posture.value
            x, y, z, roll, pitch, yaw, swing_height = body_posture(state).tolist()
            self._body = rotation_rows(roll, pitch, yaw), [x, y, z], swing_height
            self._posture = None if row[SWING_HEIGHT + 1 :].any() else state.posture
        return self._body
