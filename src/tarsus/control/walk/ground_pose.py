"""Body pose in G that follows from a gait state."""

from __future__ import annotations

import cmath
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.walk.state import GaitState
from tarsus.control.workspace.body_shift import NO_SHIFT
from tarsus.gait.body_shift import shift_at
from tarsus.gait.stance.stance_geometry import rotation_rows, with_sway
from tarsus.kinematics.pose import Pose

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["body_pose", "body_posture", "ground_frame"]


def body_posture(state: GaitState) -> Float[np.ndarray, "7"]:
    """Return the posture with the displacements by sway and body shift.

    Parameters
    ----------
    state : GaitState
        The gait state.
    """
    posture = with_sway(state.posture.value, state.cycles, state.beats)
    if state.shift is NO_SHIFT:
        return posture
    shift = complex(shift_at(state.shift.value.view(complex), state.clock))
    return np.asarray(posture + np.array([shift.real, shift.imag, 0.0, 0.0, 0.0, 0.0, 0.0]))


def body_pose(state: GaitState) -> Pose:
    """Return the pose of B in G.

    Parameters
    ----------
    state : GaitState
        The gait state.
    """
    x, y, z, roll, pitch, yaw, _ = body_posture(state).tolist()
    origin = state.origin + cmath.exp(1j * state.yaw) * complex(x, y)
    rotation = np.array(rotation_rows(roll, pitch, state.yaw + yaw))
    return Pose.unchecked(rotation, np.array([origin.real, origin.imag, state.elevation + z]))


def ground_frame(body: Pose) -> Pose:
    """Return the frame on the ground below a body that has the body's heading.

    Parameters
    ----------
    body : Pose
        Pose of B in G.
    """
    yaw = float(np.asarray(body.rpy)[2])
    return Pose.from_rpy(0.0, 0.0, yaw, (float(body.position[0]), float(body.position[1]), 0.0))
