"""Snapshot: the robot as its activity moves it. ControlOutput: what a robot controller gives out in each tick."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.control.limitation import Limitation
from tarsus.control.robot_state import RobotState
from tarsus.control.safety import Intervention
from tarsus.gait.gait import Gait
from tarsus.kinematics.pose import Pose
from tarsus.representation import represented

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["ControlOutput", "Snapshot"]


class Snapshot(NamedTuple):
    """The robot as its activity moves it; poses and points are in the activity's own ground frame.

    Attributes
    ----------
    angles : array, shape (legs, 3)
        Joint angles [rad].
    body : Pose
        Pose of the body.
    feet : array, shape (legs, 3), or None
        The feet [m]; None where they are to be computed from angles and body.
    contacts : array of bool, shape (legs,)
        Which feet are on the ground.
    belly : bool
        Whether the body rests on the ground.
    state : RobotState
        State of the robot.
    activity : str
        The state in detail: the walk state, the stage of a motion sequence, or the state.
    twist : tuple of float
        Speed of the walk: forward, left [m/s], turning [rad/s].
    limitations : tuple of Limitation
        Why the command is not met in full.
    felt : bool
        Whether the feet follow ground that is felt, which need not be a plane, or slide: the guard does not check them.
    """

    angles: Float[np.ndarray, "legs 3"]
    body: Pose
    feet: Float[np.ndarray, "legs 3"] | None
    contacts: Bool[np.ndarray, "legs"]
    belly: bool
    state: RobotState
    activity: str
    twist: tuple[float, float, float] = (0.0, 0.0, 0.0)
    limitations: tuple[Limitation, ...] = ()
    felt: bool = False


@represented(
    "time", "state", "activity", "angles", "twist", "gait", "contacts", "limitations", "interventions", "guard"
)
@dataclass(frozen=True, kw_only=True, eq=False)
class ControlOutput:
    """The joint angles of a tick, and the state of the robot that they belong to.

    Attributes
    ----------
    time : float
        Sum of the durations of all ticks so far [s].
    angles : array, shape (legs, 3)
        Joint angles to execute, read-only [rad].
    state : RobotState
        State of the robot.
    activity : str
        The state in detail: the walk state, the stage of rising, sitting or folding, or the state.
    limitations : tuple of Limitation
        Why the command is not met in full.
    interventions : tuple of Intervention
        Interventions of the guard that began in this tick.
    guard : str
        State of the guard; empty without a guard.
    body : Pose
        Pose of the body in G, as commanded.
    feet : array, shape (legs, 3)
        The feet in G, as commanded [m].
    contacts : array of bool, shape (legs,)
        Which feet are on the ground.
    belly : bool
        Whether the body rests on the ground.
    twist : tuple of float
        Speed of the walk: forward, left [m/s], turning [rad/s].
    gait : Gait
        Order of the steps.
    cycle_time : float
        Duration of a gait cycle; 0 until the robot has stood or walked for a tick [s].
    at_rest : bool
        Whether the robot is still, and no change of state is about to begin.
    """

    time: float
    angles: Float[np.ndarray, "legs 3"]
    state: RobotState
    activity: str
    limitations: tuple[Limitation, ...]
    interventions: tuple[Intervention, ...]
    guard: str
    body: Pose
    feet: Float[np.ndarray, "legs 3"]
    contacts: Bool[np.ndarray, "legs"]
    belly: bool
    twist: tuple[float, float, float]
    gait: Gait
    cycle_time: float
    at_rest: bool

    @property
    def heading(self) -> float:
        """Yaw of the body in G [rad]."""
        return float(np.asarray(self.body.rpy)[2])
