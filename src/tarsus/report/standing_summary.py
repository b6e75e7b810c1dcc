"""Numbers of a standing or resting robot, as printed by `tarsus pose` and `tarsus rest`."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.kinematics.body import reachable_fraction
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.reach import Reach
from tarsus.kinematics.rest import RestingPose
from tarsus.kinematics.solution import IKSolution
from tarsus.kinematics.stability import stability_margin
from tarsus.kinematics.underside import FLOOR_TOLERANCE, floor_depth
from tarsus.robot.estimates import MASS_KEYS, estimate_text
from tarsus.robot.robot import JOINTS, Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["NOT_STABLE", "Standing", "knee_lines", "limit_lines", "lines_by_text", "rest_summary"]

NOT_STABLE = "the robot has no stable resting pose with these angles"
"""Problem of a robot that does not come to rest."""

_NO_MASSES = "the robot file gives no masses: the centre of mass is that of the body"
# Tolerance for rounding errors of an angle at its limit [deg].
_ROUNDING = 1e-6


@dataclass(frozen=True, eq=False, kw_only=True)
class Standing:
    """A robot on given footholds with a displaced body pose: reach of the legs, and stability.

    A leg that doesn't reach its foothold is in the air; the centre of mass and the support polygon of the others
    determine the stability.

    Attributes
    ----------
    solution : IKSolution
        Solution of one configuration, with the body pose.
    start : Pose
        Body pose before the displacement.
    """

    solution: IKSolution
    start: Pose

    @property
    def body(self) -> Pose:
        """Displaced body pose."""
        return self.solution.body or Pose()

    @property
    def grounded(self) -> Bool[np.ndarray, "legs"]:
        """Which footholds are on the ground ``(legs,)``: all."""
        return np.ones(self.solution.robot.legs, dtype=bool)

    @property
    def contacts(self) -> Bool[np.ndarray, "legs"]:
        """Which feet are on the ground ``(legs,)``: those that reach their foothold, if it is."""
        return np.asarray((np.asarray(self.solution.reach) == Reach.OK) & self.grounded)

    @cached_property
    def margin(self) -> float:
        """Stability margin on the legs that reach [m]; minus infinity if none does."""
        return float(stability_margin(self.solution.robot, self.solution.angles, self.body, self.contacts))

    @property
    def problems(self) -> list[str]:
        """Reasons why the pose is not possible; empty if it is."""
        problems = [] if bool(self.solution.ok) else self.solution.explain().splitlines()
        if self.solution.knee == "down":
            problems += knee_lines(self.solution)
        depth = float(floor_depth(self.solution.robot, self.body))
        if depth > FLOOR_TOLERANCE:
            problems.append(f"the body is {depth * 1000:.1f} mm below the ground; raise the body by that distance")
        if not self.contacts.any():
            problems.append("no foot is on the ground")
        elif self.margin < 0:
            problems.append(
                f"the robot tips: its centre of mass is {-self.margin * 1000:.1f} mm outside its support polygon"
            )
        return problems

    @property
    def feasible_fraction(self) -> float | None:
        """Fraction of the displacement up to which the pose is possible; None with the knees down: not computed."""
        if self.solution.knee != "up":
            return None

        def stands(solution: IKSolution) -> Bool[np.ndarray, "n"]:
            robot, body = solution.robot, solution.body or Pose()
            margin = stability_margin(robot, solution.angles, body, self.grounded)
            return np.asarray((floor_depth(robot, body) <= FLOOR_TOLERANCE) & (margin >= 0))

        return reachable_fraction(self.solution.robot, self.solution.feet, self.start, self.body, also=stands)

    def summary(self) -> dict[str, Any]:
        """Return the numbers of the pose, with units in the keys."""
        robot, problems = self.solution.robot, self.problems
        reach = np.asarray(self.solution.reach)
        return {
            "robot": robot.name,
            "knee": self.solution.knee,
            "body": _pose_numbers(self.body),
            "legs": list(robot.leg_codes),
            "joints": list(JOINTS),
            "angles_deg": np.degrees(np.asarray(self.solution.angles)).tolist(),
            "reach": [Reach(int(code)).name for code in reach],
            "stands": self.margin >= 0,
            "margin_mm": self.margin * 1000,
            "feasible_fraction": self.feasible_fraction,
            "possible": not problems,
            "problems": problems,
            "assumed": [
                *_assumed(robot),
                *(knee_lines(self.solution) if self.solution.knee == "up" else []),
            ],
        }


def knee_lines(solution: IKSolution, legs: Sequence[int] | None = None) -> list[str]:
    """Return a line on each range of tibia limits that excludes the knee branch of a solution.

    The angles of these legs are those of the other branch.

    Parameters
    ----------
    solution : IKSolution
        Solution of one configuration.
    legs : sequence of int, optional
        Indices of the legs to check. Default: all.
    """
    robot, other = solution.robot, "up" if solution.knee == "down" else "down"
    limits = np.degrees(np.asarray(robot.limits)[:, 2])
    excluded = limits[:, 1] < 0 if solution.knee == "down" else limits[:, 0] > 0
    lines = (
        (
            leg,
            (
                f"the knee can't be {solution.knee}, as the tibia's limits are {limits[leg, 0]:.1f} and "
                f"{limits[leg, 1]:.1f} deg; the angles are those with the knee {other}"
            ),
        )
        for leg in (range(robot.legs) if legs is None else legs)
        if excluded[leg]
    )
    return lines_by_text(robot, lines)


def lines_by_text(robot: Robot, lines: Iterable[tuple[int, str]]) -> list[str]:
    """Return lines on legs; legs with the same text share a line.

    Parameters
    ----------
    robot : Robot
        A single robot.
    lines : iterable of (int, str)
        Index of a leg, and a text on this leg.
    """
    groups: dict[str, list[str]] = {}
    for leg, text in lines:
        groups.setdefault(text, []).append(robot.leg_names[leg])
    return [f"{'all legs' if len(legs) == robot.legs else ', '.join(legs)}: {text}" for text, legs in groups.items()]


def rest_summary(robot: Robot, angles: Float[np.ndarray, "legs 3"], rest: RestingPose) -> dict[str, Any]:
    """Return the numbers of a resting pose, with units in the keys.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Joint angles [rad].
    rest : RestingPose
        Resting pose of these angles.
    """
    problems = limit_lines(robot, np.degrees(angles), range(robot.legs))
    if not bool(rest.stable):
        problems.append(NOT_STABLE)
    return {
        "robot": robot.name,
        "description": rest.describe(),
        "body": _pose_numbers(rest.body),
        "contacts": [
            code for code, in_contact in zip(robot.leg_codes, np.asarray(rest.contacts), strict=True) if in_contact
        ],
        "margin_mm": float(rest.margin) * 1000,
        "stable": bool(rest.stable),
        "rolls": int(rest.rolls),
        "legs": list(robot.leg_codes),
        "joints": list(JOINTS),
        "angles_deg": np.degrees(angles).tolist(),
        "possible": not problems,
        "problems": problems,
        "assumed": _assumed(robot),
    }


def _assumed(robot: Robot) -> list[str]:
    """Return the assumptions behind stability and resting pose, a line for each."""
    if not robot.has_masses:
        return [_NO_MASSES]
    estimated = estimate_text(robot, MASS_KEYS)
    return [estimated] if estimated else []


def _pose_numbers(body: Pose) -> dict[str, float]:
    values = [*(np.asarray(body.position) * 1000), *np.degrees(np.asarray(body.rpy))]
    return dict(zip(("x_mm", "y_mm", "z_mm", "roll_deg", "pitch_deg", "yaw_deg"), map(float, values), strict=True))


def limit_lines(robot: Robot, degrees: Float[np.ndarray, "legs 3"], legs: Sequence[int]) -> list[str]:
    """Return a line on each joint angle outside its limits.

    Parameters
    ----------
    robot : Robot
        A single robot.
    degrees : array, shape (legs, 3)
        Joint angles [deg].
    legs : sequence of int
        Indices of the legs to check.
    """
    limits = np.degrees(np.asarray(robot.limits))
    outside = (degrees < limits[..., 0] - _ROUNDING) | (degrees > limits[..., 1] + _ROUNDING)
    lines = (
        (
            leg,
            (
                f"{JOINTS[joint]} angle {degrees[leg, joint]:g} deg is outside its limits, "
                f"{limits[leg, joint, 0]:g} to {limits[leg, joint, 1]:g} deg"
            ),
        )
        for leg in legs
        for joint in np.flatnonzero(outside[leg]).tolist()
    )
    return lines_by_text(robot, lines)
