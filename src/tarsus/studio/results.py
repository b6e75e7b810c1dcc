"""Results that follow from a state, each computed once: robot, poses, walk, loads."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from tarsus.gait.motion import Motion
from tarsus.kinematics.mass import MassWeights
from tarsus.kinematics.pose import Pose
from tarsus.load.loads import JointLoads
from tarsus.robot.robot import Robot
from tarsus.simulation.terrain.protocol import Terrain
from tarsus.simulation.truth.comparison import Truth, compare
from tarsus.studio.loads import loads_of
from tarsus.studio.messages.state import StudioState
from tarsus.studio.physics.terrains import chosen_terrain
from tarsus.studio.physics.walk import COMMAND_RATE, check_length
from tarsus.studio.poses import resting, standing
from tarsus.studio.robots import robot_of
from tarsus.studio.standing import OnFootholds, Resting
from tarsus.studio.walks import longest, plan

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Results"]

_T = TypeVar("_T")


class Results:
    """Computes results from a state, and keeps the latest of each kind."""

    def __init__(self) -> None:
        self._kept: dict[str, tuple[tuple[Any, ...], Any]] = {}

    def _once(self, kind: str, given: tuple[Any, ...], make: Callable[[], _T]) -> _T:
        """Return the stored result for the same inputs, or compute it."""
        known = self._kept.get(kind)
        if known is not None and known[0] == given:
            kept: _T = known[1]
            return kept
        made = make()
        self._kept[kind] = (given, made)
        return made

    def robot(self, state: StudioState) -> Robot:
        """Return the robot; the same object for the same state."""
        return self._once("robot", (state.robot,), lambda: robot_of(state.robot))

    def resting(self, state: StudioState) -> Resting:
        """Return the resting pose of the view Joints."""
        robot = self.robot(state)
        masses = self._once("masses", (robot,), lambda: MassWeights.of(robot))
        return self._once("resting", (robot, state.joints), lambda: resting(robot, state.joints, masses=masses))

    def standing(self, state: StudioState) -> OnFootholds:
        """Return the standing robot of the view Body."""
        robot = self.robot(state)
        return self._once("standing", (robot, state.body), lambda: standing(robot, state.body))

    def walk(self, state: StudioState) -> Motion:
        """Return the planned walk."""
        robot = self.robot(state)
        return self._once("walk", (robot, state.walk), lambda: plan(robot, state.walk))

    def longest(self, state: StudioState) -> float:
        """Return the longest possible stroke along the path [m]; it does not depend on stroke, speed and cycle time."""
        robot = self.robot(state)
        slow = {"stroke_mm": None, "speed_mm_s": None, "cycle_time_s": None, "rate_hz": 100.0, "strict": True}
        options = state.walk.model_copy(update=slow)
        return self._once("longest", (robot, options), lambda: longest(robot, options))

    def loads(self, state: StudioState) -> JointLoads:
        """Return the joint loads of the walk."""
        motion = self.walk(state)
        return self._once("loads", (motion, state.loads), lambda: loads_of(motion, state.loads))

    def terrain(self, state: StudioState) -> Terrain:
        """Return the chosen terrain."""
        choice = state.physics.terrain
        return self._once("terrain", (choice,), lambda: chosen_terrain(choice))

    def simulated(self, state: StudioState) -> Truth:
        """Return the walk in physics, planned and commanded at `COMMAND_RATE`."""
        options = state.walk.model_copy(update={"rate_hz": COMMAND_RATE})
        robot, servos, terrain = self.robot(state), state.physics.servos, self.terrain(state)
        if options == state.walk:
            motion = self.walk(state)
        else:
            motion = self._once("commanded", (robot, options), lambda: plan(robot, options))
        check_length(motion)
        return self._once(
            "simulated", (motion, servos, terrain), lambda: compare(motion, terrain=terrain, servos=servos)
        )

    def shown(self, state: StudioState) -> tuple[Pose, Float[np.ndarray, "..."]]:
        """Return body pose and joint angles that the view shows; for a walk, those at its start."""
        if state.view == "joints":
            pose = self.resting(state)
            return pose.rest.body, pose.angles
        if state.view in ("walk", "loads"):
            motion = self.walk(state)
            return motion.body[0], motion.angles[0]
        found = self.standing(state)
        return found.body, np.asarray(found.solution.angles)
