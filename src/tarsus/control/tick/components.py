"""The stateful components of a walk controller, built from its arguments."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.pose.admittance import Admittance
from tarsus.control.terrain.felt_ground import FeltGround
from tarsus.control.terrain.posture_feedback import Levelling
from tarsus.control.terrain.roughness import GroundAdaptation
from tarsus.control.transition.executor import TransitionExecutor
from tarsus.control.transition.initial_stance import initial_stance
from tarsus.control.transition.planner import TransitionPlanner
from tarsus.control.walk.foot_targets import FootTargets
from tarsus.control.walk.joint_solver import JointSolver
from tarsus.control.walk.state import GaitState
from tarsus.control.walk.time_scaling import TimeScaling
from tarsus.gait.gait import Gait
from tarsus.gait.walk_setup import WalkSetup
from tarsus.robot.joint_limits import joint_limits
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["WalkComponents"]


@dataclass(frozen=True, eq=False, kw_only=True)
class WalkComponents:
    """The components of a walk controller; all its state besides the gait state and the twist is in them.

    Attributes
    ----------
    robot : Robot
        The robot.
    joint_speed, joint_acceleration : array, shape (legs, 3)
        Greatest of each joint [rad/s], [rad/s^2].
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
    every_leg : array of bool, shape (legs,)
        True for each leg.
    no_offset : array, shape (legs,)
        Zero for each leg [m].
    """

    robot: Robot
    joint_speed: Float[np.ndarray, "legs 3"]
    joint_acceleration: Float[np.ndarray, "legs 3"]
    planner: TransitionPlanner
    transitions: TransitionExecutor
    foot_targets: FootTargets
    ground: FeltGround
    solver: JointSolver
    time_scaling: TimeScaling
    every_leg: Bool[np.ndarray, "legs"]
    no_offset: Float[np.ndarray, "legs"]

    def standing_feet(self, state: GaitState) -> Bool[np.ndarray, "legs"]:
        """Return which feet are on the ground: array of bool, shape (legs,).

        Parameters
        ----------
        state : GaitState
            The gait state.
        """
        down = state.down.copy()
        down[self.foot_targets.legs] = False
        return down

    @classmethod
    def standing(  # noqa: PLR0913 - all that a walk is set up with
        cls,
        robot: Robot,
        gait: Gait | None,
        *,
        body_height: float | None,
        swing_height: float | None,
        stance_width: float,
        cycle_time: float | None,
        joint_speed: float | None,
        joint_acceleration: float | None,
        foot_distance: float | None,
        levelling: Levelling | None,
        adaptation: GroundAdaptation,
        admittance: Admittance | None,
    ) -> tuple[WalkComponents, GaitState]:
        """Return the components of a robot that stands, and its gait state; arguments as of `WalkController`.

        Raises
        ------
        InputError
            If an argument is not finite or out of its range, the robot is a batch, or the gait is for another number
            of legs.
        UnreachableError
            If the robot can't stand and step so.
        """
        setup = WalkSetup.of(
            robot,
            Gait.named(robot.gait.name, legs=robot.legs) if gait is None else gait,
            body_height=body_height,
            swing_height=swing_height,
            body_tilt=(0.0, 0.0),
            foot_distance=foot_distance,
        )
        robot = setup.robot
        speed, acceleration = joint_limits(robot, joint_speed, joint_acceleration)
        planner = TransitionPlanner(robot, speed=speed, acceleration=acceleration, foot_distance=setup.foot_distance)
        stance = initial_stance(planner, setup, stance_width=stance_width, cycle_time=cycle_time)
        foot_targets, solver = FootTargets(robot.leg_names), JointSolver(robot)
        transitions = TransitionExecutor(stance, foot_targets)
        state = GaitState.standing(stance.rest, transitions.pose.target)
        time_scaling = TimeScaling(solver.angles(state), speed, acceleration, robot.limits)
        ground = FeltGround(
            robot, time_scaling.angles, levelling=levelling, adaptation=adaptation, admittance=admittance
        )
        components = cls(
            robot=robot,
            joint_speed=speed,
            joint_acceleration=acceleration,
            planner=planner,
            transitions=transitions,
            foot_targets=foot_targets,
            ground=ground,
            solver=solver,
            time_scaling=time_scaling,
            every_leg=np.ones(robot.legs, dtype=bool),
            no_offset=np.zeros(robot.legs),
        )
        return components, state
