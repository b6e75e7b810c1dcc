"""Forces on the feet with friction: what else than vertical forces could hold the robot.

Each foot pushes within its friction cone, ``|along the ground| <= mu up``, the ground's normal being G's z. All feet
together are in equilibrium with the weight, in all six equations, and a sum of squares is least: of the forces, or of
the torques with which the joints hold them. That is a quadratic program over second-order cones; Clarabel solves it
(P. J. Goulart and Y. Chen, "Clarabel: An interior-point solver for conic programs with quadratic objectives", 2024),
for all samples of a batch in one problem of as many blocks.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np

from tarsus.arrays import as_floats, broadcast_shapes, require_finite
from tarsus.errors import InputError, UnknownNameError
from tarsus.kinematics.leg import forward_kinematics, leg_jacobian
from tarsus.kinematics.mass import centre_of_mass, total_mass
from tarsus.kinematics.pose import Pose
from tarsus.load.cone_program import ConeProgram, Floats
from tarsus.load.contact import GRAVITY, checked_contacts, upward
from tarsus.load.payload import Payload, as_payload
from tarsus.load.torque import joint_torques
from tarsus.robot.robot import Robot

__all__ = ["FrictionForces", "contact_forces_with_friction"]

_BALANCED = 1e-7  # what may be missing, as a share of the weight; where balance is possible it is a thousandth of that
_LISTED = 8  # samples named in a message
_REGULAR = 1e-6  # weight of the forces' squares beside the torques', so that straight legs have a solution


@dataclass(frozen=True, eq=False, kw_only=True)
class FrictionForces:
    """Forces on the feet in their friction cones.

    Attributes
    ----------
    forces : array, shape (..., legs, 3)
        Ground on foot, in G [N]. Where nothing balances, those that come nearest to it.
    missing_force : array, shape (..., 3)
        What is missing for an equilibrium, in G [N].
    missing_moment : array, shape (..., 3)
        The same about the centre of mass of all that is carried, in G [N m].
    balanced : array of bool, shape (...)
        Whether forces in the cones balance the weight.
    """

    forces: Floats
    missing_force: Floats
    missing_moment: Floats
    balanced: np.ndarray[Any, np.dtype[np.bool_]]

    @cached_property
    def friction_used(self) -> Floats:
        """Share of the weight on each foot that it exerts along the ground ``(..., legs)``; 0 without load."""
        along = np.linalg.norm(self.forces[..., :2], axis=-1)
        up = self.forces[..., 2]
        used: Floats = np.where(up > 0, along / np.where(up > 0, up, 1.0), 0.0)
        return used

    def require(self) -> FrictionForces:
        """Return itself, refusing samples without an equilibrium.

        Raises
        ------
        InputError
            If in some sample no forces in the cones balance; the message says in which, and by how much.
        """
        if self.balanced.all():
            return self
        moment, force = (np.linalg.norm(v, axis=-1) for v in (self.missing_moment, self.missing_force))
        worst = np.unravel_index(int(np.argmax(np.where(self.balanced, -1.0, moment))), moment.shape)
        where = who = ""
        if moment.ndim:
            failed = [", ".join(map(str, at)) for at in np.argwhere(~self.balanced)]
            listed = "; ".join(failed[:_LISTED]) + ("; ..." if len(failed) > _LISTED else "")
            where = f" in {len(failed)} of {moment.size} samples ({listed})"
            who = f", in sample {', '.join(map(str, worst))}, the worst"
        raise InputError(
            f"no forces within the friction cones hold the robot{where}: {moment[worst]:.3g} N m and "
            f"{force[worst]:.3g} N are missing{who}; more friction, or feet farther apart, would help"
        )


def contact_forces_with_friction(
    robot: Robot,
    angles: Floats,
    body: Pose,
    contacts: np.ndarray[Any, np.dtype[np.bool_]],
    *,
    friction: float,
    payload: Payload | float = 0.0,
    gravity: Sequence[float] = GRAVITY,
    least: Literal["force", "torque"] = "force",
) -> FrictionForces:
    """Return forces on the feet, in their friction cones and in equilibrium, with the least sum of squares.

    On level ground, and as long as no foot would have to pull, the least forces are the vertical ones of
    `contact_forces`. The least torques press the feet outward or inward: they show how much the ground could relieve
    the joints at best, which a robot whose servos only hold positions can't count on.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs; its masses must be known.
    angles : array, shape (..., legs, 3)
        Joint angles [rad].
    body : Pose
        Places of B in G.
    contacts : array of bool, shape (..., legs)
        Which feet are on the ground.
    friction : float
        Coefficient of friction; greater than 0.
    payload : Payload or float
        What the body carries; a number is a mass at its origin [kg].
    gravity : sequence of float
        Gravity in G [m/s^2]: tilted, it is that of a slope, whose normal stays G's z.
    least : {"force", "torque"}
        Of what the sum of squares is least: of the forces, or of the joint torques (with a millionth of the forces',
        in units of the weight and of the robot's size).

    Returns
    -------
    FrictionForces
        NumPy arrays; `FrictionForces.balanced` says where there is an equilibrium.

    Raises
    ------
    MissingDataError
        If the robot's masses are unknown, or Clarabel is not installed (the extra ``qp``).
    InputError
        If a shape is wrong, a value is not finite or out of its range, no foot is down, or there is no gravity.
    UnknownNameError
        If `least` is neither.
    TarsusError
        If the solver gives up.
    """
    robot.require_masses()
    carried = as_payload(payload)
    strength, axes = upward(gravity)
    slip = as_floats(np, friction, name="friction")
    require_finite("friction", slip)
    if slip.ndim or slip <= 0:
        raise InputError(f"friction is {friction!r}; it must be one number greater than 0")
    if least not in ("force", "torque"):
        raise UnknownNameError.of("least sum of squares", least, ("force", "torque"))
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
    which = np.nonzero(down.reshape(-1, robot.legs))
    arms = np.broadcast_to(feet, (*batch, robot.legs, 3)).reshape(-1, robot.legs, 3)[which]
    size = float(np.abs(arms).max()) or 1.0
    square, linear = np.broadcast_to(np.eye(3), (len(arms), 3, 3)), np.zeros((len(arms), 3))
    if least == "torque":
        held, _ = joint_torques(robot, angles, body, down, gravity=gravity, forces=np.zeros((robot.legs, 3)))
        unit = (weight * size)[..., None, None]
        lever = np.asarray(body.rotation)[..., None, :, :] @ np.asarray(leg_jacobian(robot, angles)) / size
        square, linear = _torque_squares(
            np.broadcast_to(lever, (*batch, robot.legs, 3, 3)).reshape(-1, robot.legs, 3, 3)[which],
            np.broadcast_to(held / unit, (*batch, robot.legs, 3)).reshape(-1, robot.legs, 3)[which],
        )
    program = ConeProgram(which[0], weight.size, arms / size, float(slip), axes[0], square, linear)
    pushes, missing = program.solve()
    forces = np.zeros((weight.size, robot.legs, 3))
    forces[which] = pushes
    lacking = missing.reshape(*batch, 6) * weight[..., None]
    return FrictionForces(
        forces=forces.reshape(*batch, robot.legs, 3) * weight[..., None, None],
        missing_force=lacking[..., :3],
        missing_moment=lacking[..., 3:] * size,
        balanced=np.linalg.norm(missing, axis=-1).reshape(batch) <= _BALANCED,
    )


def _torque_squares(lever: Floats, held: Floats) -> tuple[Floats, Floats]:
    """Return square and linear terms, in the forces, of half the squares of the torques ``held - lever^T force``."""
    square = lever @ np.swapaxes(lever, -1, -2) + _REGULAR * np.eye(3)
    return square, -(lever @ held[..., None])[..., 0]
