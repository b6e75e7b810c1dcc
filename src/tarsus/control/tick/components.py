"""The stateful components of a walk controller."""

from __future__ import annotations

from tarsus.control.sensing.foot_loads import FootLoads
from tarsus.control.terrain.body_motion import BodyMotion
from tarsus.control.terrain.felt_ground import FeltGround
from tarsus.control.transition.executor import TransitionExecutor
from tarsus.control.transition.planner import TransitionPlanner
from tarsus.control.transition.stance_transition import StanceTransition
from tarsus.control.walk.foot_targets import FootTargets
from tarsus.control.walk.joint_solver import JointSolver
from tarsus.control.walk.state import GaitState
from tarsus.control.walk.time_scaling import TimeScaling

__all__ = ["WalkComponents"]


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
