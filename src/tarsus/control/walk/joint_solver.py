"""Joint angles and feet of a gait state, computed in plain numbers: the kinematics of every tick."""

from __future__ import annotations

import cmath
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.control.filters import CriticallyDamped
from tarsus.control.pose.deflection_compensation import DeflectionCompensation
from tarsus.control.pose.foot_rolling import FootRolling
from tarsus.control.pose.pose_controller import NO_SHIFT
from tarsus.control.walk.state import GaitState
from tarsus.gait.stance.stance_geometry import SWING_HEIGHT, Rows, rotation_rows
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.scalar_solver import ScalarSolver
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["JointSolver"]


class JointSolver:
    """Computes the joint angles and the feet of one robot for the states of its walk.

    Parameters
    ----------
    robot : Robot
        A single robot.

    Attributes
    ----------
    rolling : FootRolling
        Rolling of the balls of the feet; none at first.
    deflection : DeflectionCompensation
        Offsets of the joint angles that make up for the yielding of loaded joints.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot, self.rolling = robot, FootRolling(robot)
        self.deflection = DeflectionCompensation(robot)
        self._scalar_solver = ScalarSolver(robot)
        # Rotation, position and swing height are kept for as long as the posture stays the same object.
        self._posture: CriticallyDamped | None = None
        self._body: tuple[Rows, list[float], float] = (((),), [], 0.0)

    def angles(self, state: GaitState) -> Float[np.ndarray, "legs 3"]:
        """Return the joint angles of a state, read-only [rad].

        For feet out of reach, they are those of the nearest reachable points.
        """
        rotation, position, swing_height = self._body_at(state)
        turn, origin = cmath.exp(-1j * state.yaw), state.origin
        offsets = state.admittance_offset.value.tolist()
        feet = []
        for foot, height, offset in zip(state.foot.tolist(), state.heights(swing_height), offsets, strict=True):
            in_heading = (foot - origin) * turn
            feet.append((in_heading.real, in_heading.imag, height + offset - state.elevation))
        if self.rolling.started:
            bottoms = zip(state.ground_height.tolist(), offsets, strict=True)
            standing = [height + offset - state.elevation for height, offset in bottoms]
            # Rolling is relative to rest in the posture that is solved: with an earlier one, the next tick would have
            # to catch up at once.
            feet = self.rolling.rolled(feet, standing, (rotation, position), posture=state.posture.value)
        found: Any = self._scalar_solver.angles(feet, rotation, position)
        if found is None:
            found = inverse_kinematics(self._robot, (np.array(feet) - position) @ np.array(rotation)).angles
        angles = np.array(found)
        if self.deflection.offsets is not None:
            angles += self.deflection.offsets
        angles.setflags(write=False)
        return angles

    def feet(self, state: GaitState, angles: Float[np.ndarray, "legs 3"]) -> Float[np.ndarray, "legs 3"]:
        """Return the feet in G, as the centres of their balls, for a state and its joint angles [m].

        They are found by forward kinematics without the deflection's offsets: where the feet are under load.
        """
        rotation, position, _ = self._body_at(state)
        turn, origin = cmath.exp(1j * state.yaw), state.origin
        feet = []
        if self.deflection.offsets is not None:
            angles = angles - self.deflection.offsets
        for x, y, z in self._scalar_solver.feet(angles.tolist(), rotation, position):
            place = origin + turn * complex(x, y)
            feet.append((place.real, place.imag, z + state.elevation))
        return np.array(feet)

    def _body_at(self, state: GaitState) -> tuple[Rows, list[float], float]:
        if state.posture is not self._posture or state.shift is not NO_SHIFT:
            x, y, z, roll, pitch, yaw, swing_height = state.moved_posture.tolist()
            self._body = rotation_rows(roll, pitch, yaw), [x, y, z], swing_height
            sways = any(state.posture.value[SWING_HEIGHT + 1 :].tolist())
            self._posture = None if sways else state.posture
        return self._body
