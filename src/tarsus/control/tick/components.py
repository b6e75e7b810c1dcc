"""The stateful components of a walk controller."""

from __future__ import annotations

from dataclasses import dataclass

from tarsus.control.terrain.felt_ground import FeltGround
from tarsus.control.transition.executor import TransitionExecutor
from tarsus.control.transition.planner import TransitionPlanner
from tarsus.control.walk.foot_targets import FootTargets
from tarsus.control.walk.joint_solver import JointSolver
from tarsus.control.walk.time_scaling import TimeScaling
from tarsus.robot.robot import Robot

__all__ = ["WalkComponents"]


@dataclass(frozen=True, eq=False, kw_only=True)
class WalkComponents:
    """The components of a walk controller; all its state besides the gait state and the twist is in them.

    Attributes
    ----------
    robot : Robot
        The robot.
    planner : TransitionPlanner
        Plans stance transitions.
    transitions : TransitionExecutor
        The stance, the gait, and the transitions to others.
    foot_targets : FootTargets
        The legs that are taken out of the gait.
    ground : FeltGround
        What is felt of the ground.
    solver : JointSolver
        Solves gait states for joint angles.
    time_scaling : TimeScaling
        The joint angles, and the rate of the walk's time.
    """

    robot: Robot
    planner: TransitionPlanner
    transitions: TransitionExecutor
    foot_targets: FootTargets
    ground: FeltGround
    solver: JointSolver
    time_scaling: TimeScaling
