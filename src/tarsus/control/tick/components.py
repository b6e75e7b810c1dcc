"""The stateful components of a walk controller."""

from __future__ import annotations

import numpy as np

from tarsus.control.felt.felt_ground import FeltGround
from tarsus.control.sensing.foot_loads import FootLoads
from tarsus.control.terrain.body_motion import BodyMotion
from tarsus.control.transition.executor import TransitionExecutor
from tarsus.control.transition.planner import TransitionPlanner
from tarsus.control.transition.stance_transition import StanceTransition
from tarsus.control.walk.felt_feet import FeltFoot
from tarsus.control.walk.foot_targets import FootTargets
from tarsus.control.walk.joint_solver import JointSolver
from tarsus.control.walk.state import GaitState
from tarsus.control.walk.time_scaling import TimeScaling
from tarsus.gait.foot_plane import FootPlane
from tarsus.kinematics.inverse import inverse_kinematics

__all__ = ["WalkComponents"]

# Shares of a slope to which feet that do not reach it are put.
_SHARES = (1.0, 0.75, 0.5, 0.25)


class WalkComponents:
    """The components of a walk controller; they hold what lasts from tick to tick besides the `TickState`.

    Parameters
    ----------
    planner, stance : TransitionPlanner, StanceTransition
        Plans stance transitions of the robot; the stance at the start.
    body, loads : BodyMotion, FootLoads
        Body motion on ground that is felt; loads of the feet.

    Attributes
    ----------
    robot : Robot
        The robot.
    planner : TransitionPlanner
        Plans stance transitions.
    transitions : TransitionExecutor
        The stance, the gait, and the transitions to others.
    foot_targets : FootTargets
        The legs taken out of the gait, and the motion of their feet.
    ground : FeltGround
        What readings tell about the ground, and how feet and body respond.
    solver : JointSolver
        Solves gait states for joint angles.
    time_scaling : TimeScaling
        The joint angles, and the rate of the walk's time.
    initial : GaitState
        The gait state at the start.
    """

    def __init__(
        self, planner: TransitionPlanner, stance: StanceTransition, *, body: BodyMotion, loads: FootLoads
    ) -> None:
        self.planner = planner
        self.robot = robot = planner.robot
        self.foot_targets, self.solver = FootTargets(robot), JointSolver(robot)
        self.transitions = TransitionExecutor(stance, self.foot_targets, scale=body.reach.scale)
        self.initial = GaitState.standing(stance.rest, self.transitions.pose.target)
        self.time_scaling = TimeScaling(self.solver.angles(self.initial), planner.joint_limits, robot.limits)
        self.ground = FeltGround(robot, self.time_scaling.angles, body=body, loads=loads)

    def on_slope(self, slope: complex) -> GaitState:
        """Return the gait state at the start of a robot that has felt a slope; as much of it as all legs reach.

        Parameters
        ----------
        slope : complex
            Rise along x and y of the heading frame [m/m].
        """
        foot, legs = self.initial.foot, self.robot.legs
        for plane in (FootPlane(0.0, share * slope.real, share * slope.imag) for share in _SHARES):
            heights = np.array(plane.at(foot))
            feet = self.initial.body.inverse() @ np.stack((foot.real, foot.imag, heights), axis=-1)
            if inverse_kinematics(self.robot, feet).ok:
                self.ground.ground.plane = plane
                state = self.initial._replace(ground_height=heights, felt=[FeltFoot()] * legs)
                self.time_scaling = TimeScaling(self.solver.angles(state), self.planner.joint_limits, self.robot.limits)
                return state
        return self.initial
