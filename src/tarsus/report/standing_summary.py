"""A standing or a resting robot in numbers: what `tarsus pose` and `tarsus rest` print and `--json` returns."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from tarsus.kinematics.body import reachable_share
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.reach import IKSolution, Reach
from tarsus.kinematics.rest import CORNERS, RestingPose
from tarsus.kinematics.stability import stability_margin
from tarsus.robot.robot import JOINTS, Robot

__all__ = ["Standing", "rest_summary"]

_MASSLESS = "the robot file gives no masses: the centre of mass is that of the body alone"
# What rounding may add to an angle at its limit [deg].
_SLACK = 1e-6


@dataclass(frozen=True, eq=False, kw_only=True)
class Standing:
    """A robot that stands on given footholds with its body moved: which legs reach, and whether they hold it.

    A leg that doesn't reach its foothold is in the air; whether the others hold the robot is for the centre of mass
    and their support polygon to say.

    Attributes
    ----------
    solution : IKSolution
        Of one configuration, with the body's place.
    start : Pose
        Where the body was before it was moved.
    """

    solution: IKSolution
    start: Pose

    @property
    def body(self) -> Pose:
        """Where the body is moved to."""
        return self.solution.body or Pose()

    @property
    def contacts(self) -> np.ndarray[Any, Any]:
        """Which feet stand ``(legs,)``."""
        reaches: np.ndarray[Any, Any] = np.asarray(self.solution.reach) == Reach.OK
        return reaches

    @property
    def margin(self) -> float:
        """Stability margin of the legs that reach [m]; minus infinity where none does."""
        return float(stability_margin(self.solution.robot, self.solution.angles, self.body, self.contacts))

    @property
    def problems(self) -> list[str]:
        """What is not possible, a line each; empty where all of it is."""
        problems = [] if bool(self.solution.ok) else self.solution.explain().splitlines()
        depth = self._body_depth()
        if depth > 1e-9:
            problems.append(f"the body's box is {depth * 1000:.1f} mm below the ground: raise the body by as much")
        if not self.contacts.any():
            problems.append("no leg reaches its foothold: nothing holds the robot")
        elif self.margin < 0:
            problems.append(
                f"the robot tips over: its centre of mass is {-self.margin * 1000:.1f} mm outside the feet that stand"
            )
        return problems

    def _body_depth(self) -> float:
        """Return how far the lowest corner of the body's box is below the ground [m]."""
        size = self.solution.robot.body_size
        if size is None:
            return -math.inf
        return -float(np.asarray(self.body @ (CORNERS * np.asarray(size)))[:, 2].min())

    @property
    def share(self) -> float | None:
        """How much of the way from the start works; None with the knees down, for which it isn't worked out."""
        if self.solution.knee != "up":
            return None
        return reachable_share(self.solution.robot, self.solution.feet, self.start, self.body)

    def summary(self) -> dict[str, Any]:
        """Return it in numbers, in the units that the keys name."""
        robot, problems = self.solution.robot, self.problems
        reach = np.asarray(self.solution.reach)
        return {
            "robot": robot.name,
            "knee": self.solution.knee,
            "body": _place(self.body),
            "legs": list(robot.leg_codes),
            "joints": list(JOINTS),
            "angles_deg": np.degrees(np.asarray(self.solution.angles)).tolist(),
            "reach": [Reach(int(code)).name for code in reach],
            "stands": self.margin >= 0,
            "margin_mm": self.margin * 1000,
            "share_that_works": self.share,
            "possible": not problems,
            "problems": problems,
            "assumed": [] if robot.has_masses else [_MASSLESS],
        }


def rest_summary(robot: Robot, angles: np.ndarray[Any, Any], rest: RestingPose) -> dict[str, Any]:
    """Return in numbers how a robot rests, in the units that the keys name.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Joint angles [rad].
    rest : Rest
        What `resting_pose` says of them.
    """
    problems = _out_of_limits(robot, np.degrees(angles))
    if not bool(rest.stable):
        problems.append("the robot does not come to rest with these angles")
    return {
        "robot": robot.name,
        "description": rest.describe(),
        "body": _place(rest.body),
        "contacts": [code for code, down in zip(robot.leg_codes, np.asarray(rest.contacts), strict=True) if down],
        "margin_mm": float(rest.margin) * 1000,
        "stable": bool(rest.stable),
        "rolls": int(rest.rolls),
        "legs": list(robot.leg_codes),
        "joints": list(JOINTS),
        "angles_deg": np.degrees(angles).tolist(),
        "possible": not problems,
        "problems": problems,
        "assumed": [] if robot.has_masses else [_MASSLESS],
    }


def _place(body: Pose) -> dict[str, float]:
    values = [*(np.asarray(body.position) * 1000), *np.degrees(np.asarray(body.rpy))]
    return dict(zip(("x_mm", "y_mm", "z_mm", "roll_deg", "pitch_deg", "yaw_deg"), map(float, values), strict=True))


def _out_of_limits(robot: Robot, degrees: np.ndarray[Any, Any]) -> list[str]:
    problems = []
    limits = np.degrees(np.asarray(robot.limits))
    for leg, name in enumerate(robot.leg_names):
        for joint, joint_name in enumerate(JOINTS):
            angle, (low, high) = degrees[leg, joint], limits[leg, joint]
            if not low - _SLACK <= angle <= high + _SLACK:
                problems.append(f"{name}: the {joint_name} at {angle:g} deg is out of its limits, {low:g} to {high:g}")
    return problems
