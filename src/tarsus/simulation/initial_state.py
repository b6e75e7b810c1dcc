"""Where a simulated robot starts, and whether its servos can be simulated."""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.control.control_output import ControlOutput
from tarsus.errors import InputError
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.rest import CORNERS
from tarsus.kinematics.underside import too_low_text
from tarsus.robot.robot import Robot
from tarsus.simulation.engine import mujoco_module
from tarsus.simulation.servos.servo_table import ServoTable
from tarsus.simulation.settings import TIMESTEP
from tarsus.simulation.terrain.protocol import Terrain

if TYPE_CHECKING:
    from jaxtyping import Shaped

__all__ = ["check_stability", "place"]


# Penetration beyond which a robot counts as inside the terrain at the start [m].
_INSIDE = 0.003
# Terrain counts as level under the robot if its heights differ by less than this [m].
_LEVEL = 0.001
# Greatest (timestep * angular frequency)^2 of servo springs; explicit integration becomes unstable at 4.
_STIFFEST = 1.0


def place(robot: Robot, terrain: Terrain, output: ControlOutput, model: Any, data: Any) -> None:
    """Set the state to the controller's pose, with the lowest foot on the ground.

    Parameters
    ----------
    robot : Robot
        The robot.
    terrain : Terrain
        The ground.
    output : ControlOutput
        What the controller starts with.
    model, data : mujoco.MjModel, mujoco.MjData
        The model, and the state, which is changed.

    Raises
    ------
    InputError
        If the robot is inside the terrain.
    """
    mujoco = mujoco_module()
    points, radii = _lowest_points(robot, output, model)
    data.qpos[:3] = output.body.position
    data.qpos[2] += _lift(terrain, points, radii)
    mujoco.mju_mat2Quat(data.qpos[3:7], np.asarray(output.body.rotation).ravel())
    data.qpos[7:] = np.asarray(output.angles).ravel()
    mujoco.mj_forward(model, data)
    contact = data.contact
    if data.ncon and contact.dist.min() < -_INSIDE:
        deepest = int(np.argmin(contact.dist))
        names = [model.geom(int(geom)).name for geom in contact.geom[deepest]]
        depth, (x, y, z) = -float(contact.dist[deepest]), contact.pos[deepest].tolist()
        around = np.append(points[:, :2], [[x, y]], axis=0)
        if names[1] == "body" and np.ptp(terrain.height(*around.T)) < _LEVEL:
            low = too_low_text(depth, float(output.body.position[2]))
            raise InputError(f"the robot starts inside the terrain: the underside of its body is {low}")
        raise InputError(
            f"the robot starts inside the terrain: {names[1]!r} is {1000 * depth:.1f} mm deep in "
            f"{names[0]!r} at ({x:.3f}, {y:.3f}, {z:.3f}) m; lower the terrain there or clear the start"
        )


def _lowest_points(
    robot: Robot, output: ControlOutput, model: Any
) -> tuple[Shaped[np.ndarray, "..."], Shaped[np.ndarray, "..."]]:
    """Return points in G that may touch the ground ``(n, 3)``, and their radii ``(n,)``: feet; on the belly, all."""
    legs = np.asarray(output.body @ forward_kinematics(robot, output.angles))
    names = [f"{name} foot" for name in robot.leg_names]
    radii = np.array([model.geom(name).size[0] for name in names])
    if not output.belly:
        return legs[:, 3], radii
    body = legs[:, 0] if robot.body_size is None else output.body @ (CORNERS * np.asarray(robot.body_size))
    points = np.concatenate([legs[:, 3], legs[:, 1:3].reshape(-1, 3), np.asarray(body)])
    return points, np.concatenate([radii, np.repeat(radii, 2), np.zeros(len(body))])


def _lift(terrain: Terrain, points: Shaped[np.ndarray, "..."], radii: Shaped[np.ndarray, "..."]) -> float:
    """Return how far to raise the robot so that no ball around its points is below the ground [m]."""
    around = np.linspace(0, 2 * math.pi, 8, endpoint=False)
    ring = np.concatenate([np.zeros((1, 2)), np.stack([np.cos(around), np.sin(around)], axis=-1)])
    places = points[:, None, :2] + radii[:, None, None] * ring
    ground = terrain.height(places[..., 0], places[..., 1]).max(axis=1)
    return float((ground + radii - points[:, 2]).max())


def check_stability(table: ServoTable, model: Any, data: Any) -> None:
    """Check that the springs of the servos can be integrated in physics steps.

    Parameters
    ----------
    table : ServoTable
        The servos.
    model, data : mujoco.MjModel, mujoco.MjData
        The model, and its state.

    Raises
    ------
    InputError
        If a servo is too stiff for the inertia it moves.

    Notes
    -----
    The greatest eigenvalue of ``M^-1 K`` is the square of the highest angular frequency at which the robot's inertias
    vibrate on the springs of the servos.
    """
    inverse = np.empty((model.nv, model.nv))
    mujoco_module().mj_solveM(model, data, inverse, np.eye(model.nv))
    root, compliance = np.sqrt(table.stiffness), inverse[6:, 6:]
    highest = float(np.linalg.eigvalsh(root[:, None] * compliance * root).max()) * TIMESTEP**2
    if highest > _STIFFEST:
        joint = int(np.argmax(table.stiffness * np.diag(compliance)))
        servo = list(itertools.chain(*table.servos))[joint]
        raise InputError(
            f"{servo.name}: a stiffness of {servo.stiffness:g} N m/rad at joint {model.joint(joint + 1).name!r} is too "
            f"much for steps of {1000 * TIMESTEP:g} ms; at most {servo.stiffness * _STIFFEST / highest:.3g} N m/rad "
            "would work, or more rotor inertia"
        )
