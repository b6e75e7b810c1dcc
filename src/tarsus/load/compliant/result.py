"""Result of compliant statics."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from tarsus.kinematics.pose import Pose
from tarsus.load.compliant.foot_contact import FootContact
from tarsus.load.compliant.joint_springs import JointSprings
from tarsus.load.loads import JointLoads
from tarsus.representation import represented
from tarsus.robot.robot import JOINTS

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["CompliantLoads"]

# Fraction of the stall torque from which on a servo counts as saturated.
_ALL = 0.99


@represented("loads", "ok", "slip", "contact")
@dataclass(frozen=True, eq=False, kw_only=True)
class CompliantLoads:
    """Loads and deformation of a robot with elastic joints along a motion.

    Attributes
    ----------
    loads : JointLoads
        Joint torques and contact forces, with all that follows from them.
    springs : JointSprings
        The joints.
    contact : FootContact
        The feet on the ground.
    body : Pose
        Achieved poses of B in G, with batch axes ``(n,)``.
    angles : array, shape (n, legs, 3)
        Achieved joint angles [rad].
    slip : array, shape (n, legs)
        Distance that each foot has slid and crept since the start; rolling is not part of it [m].
    residual : array, shape (n,)
        What is left of the equations of equilibrium [N m].
    converged : array of bool, shape (n,)
        Whether an equilibrium was found; there is none where the servos do not carry the robot.
    """

    loads: JointLoads
    springs: JointSprings
    contact: FootContact
    body: Pose
    angles: Float[np.ndarray, "n legs 3"]
    slip: Float[np.ndarray, "n legs"]
    residual: Float[np.ndarray, "n"]
    converged: Bool[np.ndarray, "n"]

    @property
    def torques(self) -> Float[np.ndarray, "n legs 3"]:
        """Joint torques ``(n, legs, 3)`` [N m]."""
        return self.loads.torques

    @property
    def forces(self) -> Float[np.ndarray, "n legs 3"]:
        """Ground on foot, in G ``(n, legs, 3)`` [N]."""
        return self.loads.forces

    @property
    def assumed(self) -> tuple[str, ...]:
        """Assumptions made."""
        return self.loads.assumed

    @cached_property
    def saturated(self) -> Bool[np.ndarray, "n legs 3"]:
        """Whether each servo gives all the torque that it can at its speed ``(n, legs, 3)``."""
        speed = np.gradient(self.angles, self.loads.motion.time, axis=0)
        stall = self.springs.stall_torque
        losing = self.springs.damping * np.maximum(np.sign(self.torques) * speed, 0.0)
        return np.asarray((np.abs(self.torques) + losing >= _ALL * stall) & np.isfinite(stall))

    @property
    def problems(self) -> tuple[str, ...]:
        """Why the servos do not carry the robot, a line each; empty if they do."""
        lines = []
        if not self.converged.all():
            first = float(self.loads.motion.time[int(np.argmin(self.converged))])
            lines.append(f"at {first:.2f} s the servos find no equilibrium: the robot sags")
        if self.saturated.any():
            share = self.saturated.mean(axis=0)
            leg, joint = np.unravel_index(int(np.argmax(share)), share.shape)
            time = float(self.loads.motion.time[int(np.argmax(self.saturated[:, leg, joint]))])
            lines.append(
                f"the {JOINTS[joint]} servo of {self.loads.robot.leg_codes[leg]} gives all of its "
                f"{self.springs.stall_torque[leg, joint]:.2f} N m in {100 * share[leg, joint]:.0f} % of the walk, "
                f"first at {time:.2f} s"
            )
        return tuple(lines)

    @property
    def ok(self) -> bool:
        """Whether the servos carry the robot: an equilibrium in every sample, and no servo at its stall torque."""
        return not self.problems
