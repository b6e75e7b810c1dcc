"""Contact forces with friction.

Each contact force lies in its friction cone, ``|tangential| <= mu normal``, with G's z as the ground normal. The forces
satisfy all six equations of static equilibrium and minimise a sum of squares, of the forces or of the joint torques.
That is a quadratic program over second-order cones, solved by Clarabel (P. J. Goulart and Y. Chen, "Clarabel: An
interior-point solver for conic programs with quadratic objectives", 2024) for all samples of a batch in one problem.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from tarsus.arrays import Array, as_floats, broadcast_shapes, require_finite
from tarsus.errors import InputError, UnknownNameError
from tarsus.kinematics.leg import forward_kinematics, leg_jacobian
from tarsus.kinematics.mass import centre_of_mass, total_mass
from tarsus.kinematics.pose import Pose
from tarsus.load.cone_program import ConeProgram
from tarsus.load.contact import GRAVITY, checked_contacts, upward
from tarsus.load.payload import Payload, as_payload
from tarsus.load.torque import joint_torques
from tarsus.representation import represented
from tarsus.robot.robot import Robot, require_robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["FrictionForces", "contact_forces_with_friction"]

_BALANCED = 1e-7  # tolerated residual over the weight; with an equilibrium the solver leaves a thousandth of it
_LISTED = 8  # samples named in a message
_REGULARISATION = 1e-6  # weight of the forces' squares beside the torques', so that straight legs have a solution


@represented()
@dataclass(frozen=True, eq=False, kw_only=True)
class FrictionForces:
    """Contact forces in friction cones.

    Attributes
    ----------
    forces : array, shape (..., legs, 3)
        Ground on foot, in G [N]. Without an equilibrium, the forces with the least residual.
    residual_force : array, shape (..., 3)
        Unbalanced force, in G [N].
    residual_moment : array, shape (..., 3)
        Unbalanced moment about the centre of mass of robot and payload, in G [N m].
    balanced : array of bool, shape (...)
        Whether forces in the friction cones balance the weight.
    """

    forces: Float[np.ndarray, "*#batch legs 3"]
    residual_force: Float[np.ndarray, "*#batch 3"]
    residual_moment: Float[np.ndarray, "*#batch 3"]
    balanced: Bool[Array, "*#batch"]

    @cached_property
    def friction_used(self) -> Float[np.ndarray, "*batch legs"]:
        """Tangential over normal force of each foot ``(..., legs)``; 0 for a foot without load."""
        tangential = np.linalg.norm(self.forces[..., :2], axis=-1)
        normal = self.forces[..., 2]
        used: np.ndarray = np.where(normal > 0, tangential / np.where(normal > 0, normal, 1.0), 0.0)
        return used

    def require(self) -> FrictionForces:
        """Return itself if every sample is in equilibrium.

        Raises
        ------
        InputError
            If a sample has no equilibrium within the friction cones; the message names the samples and the largest
            residual.
        """
        if self.balanced.all():
            return self
        moment, force = (np.linalg.norm(v, axis=-1) for v in (self.residual_moment, self.residual_force))
        worst = np.unravel_index(int(np.argmax(np.where(self.balanced, -1.0, moment))), moment.shape)
        where = which_worst = ""
        if moment.ndim:
            failed = [", ".join(map(str, at)) for at in np.argwhere(~self.balanced)]
            listed = "; ".join(failed[:_LISTED]) + ("; ..." if len(failed) > _LISTED else "")
            where = f" in {len(failed)} of {moment.size} samples ({listed})"
            which_worst = f" in sample {', '.join(map(str, worst))}, the worst"
        raise InputError(
            f"no contact forces within the friction cones balance the weight{where}: the residual is "
            f"{moment[worst]:.3g} N m and {force[worst]:.3g} N{which_worst}; increase the friction or place the feet "
            "farther apart"
        )


def contact_forces_with_friction(
    robot: Robot,
    angles: Float[np.ndarray, "*#batch legs 3"],
    body: Pose,
    contacts: Bool[np.ndarray, "*#batch legs"],
    *,
    friction: float,
    payload: Payload | float = 0.0,
    gravity: Sequence[float] = GRAVITY,
    minimise: Literal["force", "torque"] = "force",
) -> FrictionForces:
    """Return contact forces within friction cones, in equilibrium, with the least sum of squares.

    On level ground, if no foot would have to pull, the forces of least squares are the vertical ones of
    `contact_forces`. The least torques press the feet outward or inward: a lower bound on the joint torques, which a
    robot with position-controlled servos does not reach in general.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs; its masses must be known.
    angles : array, shape (..., legs, 3)
        Joint angles [rad].
    body : Pose
        Pose of B in G.
    contacts : array of bool, shape (..., legs)
        Which feet are on the ground.
    friction : float
        Coefficient of friction, greater than 0.
    payload : Payload or float
        Payload on the body; a number is a mass at the body's origin [kg].
    gravity : sequence of float
        Gravity in G [m/s^2]; tilted, it represents a slope with G's z as its normal.
    minimise : {"force", "torque"}
        Objective: the sum of squares of the forces, or of the joint torques (plus a millionth of the forces', in units
        of the weight and of the robot's size).

    Returns
    -------
    FrictionForces
        NumPy arrays; `FrictionForces.balanced` tells which samples have an equilibrium.

    Raises
    ------
    MissingDataError
        If the robot's masses are unknown, or Clarabel is not installed (the extra ``qp``).
    InputError
        If a shape is wrong, a value is not finite or out of range, no foot is on the ground, or gravity is 0.
    UnknownNameError
        If `minimise` is neither of the two.
    TarsusError
        If the solver does not converge.
    """
    require_robot(robot)
    robot.require_masses()
    carried = as_payload(payload)
    strength, axes = upward(gravity)
    coefficient = as_floats(np, friction, name="friction")
    require_finite("friction", coefficient)
    if coefficient.ndim or coefficient <= 0:
        raise InputError(f"friction is {friction!r}; it must be a number greater than 0")
    if minimise not in ("force", "torque"):
        raise UnknownNameError.of("objective", minimise, ("force", "torque"))
    down = checked_contacts(np, robot, contacts)
    points = np.asarray(forward_kinematics(robot, angles))
    mass = np.asarray(total_mass(robot)) + carried.mass
    com = np.asarray(centre_of_mass(robot, angles, points=points)) * (mass - carried.mass)[..., None]
    load = (com + carried.mass * np.array(carried.position)) / mass[..., None]
    to_ground = np.swapaxes(body.rotation, -1, -2)
    feet = (points[..., 3, :] - load[..., None, :]) @ to_ground
    batch = broadcast_shapes("robot, angles, body and contacts", feet.shape[:-2], down.shape[:-1])
    down = np.broadcast_to(down, (*batch, robot.legs))
    weight = np.broadcast_to(mass * strength, batch)
    on_ground = np.nonzero(down.reshape(-1, robot.legs))
    arms = np.broadcast_to(feet, (*batch, robot.legs, 3)).reshape(-1, robot.legs, 3)[on_ground]
    size = float(np.abs(arms).max(initial=0.0)) or 1.0
    square, linear = np.broadcast_to(np.eye(3), (len(arms), 3, 3)), np.zeros((len(arms), 3))
    if minimise == "torque":
        unloaded, _ = joint_torques(robot, angles, body, down, gravity=gravity, forces=np.zeros((robot.legs, 3)))
        unit = (weight * size)[..., None, None]
        lever = np.asarray(body.rotation)[..., None, :, :] @ np.asarray(leg_jacobian(robot, angles)) / size
        square, linear = _torque_objective(
            np.broadcast_to(lever, (*batch, robot.legs, 3, 3)).reshape(-1, robot.legs, 3, 3)[on_ground],
            np.broadcast_to(unloaded / unit, (*batch, robot.legs, 3)).reshape(-1, robot.legs, 3)[on_ground],
        )
    program = ConeProgram(on_ground[0], weight.size, arms / size, float(coefficient), axes[0], square, linear)
    contact, residual = program.solve()
    forces = np.zeros((weight.size, robot.legs, 3))
    forces[on_ground] = contact
    residuals = residual.reshape(*batch, 6) * weight[..., None]
    return FrictionForces(
        forces=forces.reshape(*batch, robot.legs, 3) * weight[..., None, None],
        residual_force=residuals[..., :3],
        residual_moment=residuals[..., 3:] * size,
        balanced=np.linalg.norm(residual, axis=-1).reshape(batch) <= _BALANCED,
    )


def _torque_objective(
    lever: Float[np.ndarray, "... 3 3"], unloaded: Float[np.ndarray, "... 3"]
) -> tuple[Float[np.ndarray, "... 3 3"], Float[np.ndarray, "... 3"]]:
    """Return quadratic and linear terms, in the forces, of half the squared torques ``unloaded - lever^T force``."""
    square = lever @ np.swapaxes(lever, -1, -2) + _REGULARISATION * np.eye(3)
    return square, -(lever @ unloaded[..., None])[..., 0]
