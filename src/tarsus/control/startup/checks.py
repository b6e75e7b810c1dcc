"""What every stage must keep to: reach, limits, the ground, balance."""

from __future__ import annotations

from typing import Any

import numpy as np

from tarsus.control.sequence.stage import GRID, Stage
from tarsus.control.startup.folded_pose import rest_points
from tarsus.control.startup.leg_path import swing_heights
from tarsus.errors import TarsusError, UnreachableError
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.polygon import hull_margin
from tarsus.robot.robot import JOINTS, Robot

__all__ = ["check_ground", "check_lift", "check_limits", "check_margin", "check_reach", "excess"]

Floats = np.ndarray[Any, np.dtype[np.float64]]

# What rounding may add to an angle beyond its limit, and to a depth in the ground [rad, m].
_ANGLE = 1e-8
_DEPTH = 1e-6
# What rounding may make of an angle that inverse kinematics finds again [rad].
_JUMP = 1e-6
# Every so many of the shares of `GRID`, balance is looked at.
_EVERY = 4


def excess(robot: Robot, angles: Floats) -> Floats:
    """Return by how much joints are beyond their limits, in the shape of the angles [rad]; 0 within them."""
    low, high = robot.limits[..., 0], robot.limits[..., 1]
    beyond: Floats = np.maximum(np.maximum(low - angles, angles - high), 0.0)
    return beyond


def check_reach(stage: Stage) -> None:
    """Refuse a stage in which a foot can't be where it is led."""
    lost = np.argwhere(np.isnan(stage.table.angles).any(-1))
    if not len(lost):
        # At the ends of the range of angles, a leg may have started by a solution that is not that of its branch.
        jump = np.abs(stage.table.angles[0] - stage.angles).max(-1)
        lost = np.argwhere([jump > _JUMP])
    if not len(lost):
        return
    moment, leg = (int(i) for i in lost[0])
    share = GRID[moment : moment + 1]
    body, feet = stage.body_at(share)[0], np.where(stage.by_foot[:, None], stage.feet_at(share)[0], stage.feet)
    solution = inverse_kinematics(stage.robot, feet, body)
    lines = [line for line in solution.explain().splitlines() if line.startswith(stage.robot.leg_names[leg] + ":")]
    why = lines[0] if lines else f"{stage.robot.leg_names[leg]}: it would be straight, or folded back on itself"
    raise UnreachableError(f"{stage.name}: with the body's origin {body.position[2] * 1000:.1f} mm up, {why}")


def check_limits(stage: Stage) -> None:
    """Refuse a stage in which a joint leaves its limits, or goes further out where it began beyond them."""
    beyond = excess(stage.robot, stage.table.angles)
    worse = np.diff(beyond, axis=0) > _ANGLE
    if not worse.any():
        return
    _, leg, joint = (int(i) for i in np.argwhere(worse)[0])
    furthest = int(np.argmax(beyond[:, leg, joint]))
    height = float(stage.body_at(GRID[furthest : furthest + 1]).position[0, 2])
    low, high = np.degrees(stage.robot.limits[leg, joint])
    raise UnreachableError(
        f"{stage.name}: with the body's origin {height * 1000:.1f} mm up, the {JOINTS[joint]} of leg "
        f"{stage.robot.leg_names[leg]} would have to be at {np.degrees(stage.table.angles[furthest, leg, joint]):.1f} "
        f"deg, {np.degrees(beyond[furthest, leg, joint]):.1f} deg beyond its limits of {low:.1f} to {high:.1f}"
    )


def check_ground(stage: Stage) -> None:
    """Refuse a stage in which a point of the legs or the body goes through the ground."""
    body, robot = stage.body_at(GRID), stage.robot
    heights = (body @ forward_kinematics(robot, stage.table.angles))[..., 1:, 2]
    moment, leg, point = np.unravel_index(int(np.argmin(heights)), heights.shape)
    depth, what = -float(heights[moment, leg, point]), f"{('femur axis', 'knee', 'foot')[point]} of leg"
    name = robot.leg_names[leg]
    under = (body @ rest_points(robot)[None])[..., 2]
    if -float(under.min()) > depth:
        depth, what, name = -float(under.min()), "underside of the body,", robot.name
    if depth > _DEPTH:
        raise UnreachableError(f"{stage.name}: the {what} {name} would be {depth * 1000:.1f} mm in the ground")


def check_lift(stage: Stage) -> None:
    """Refuse a stage in which a foot comes off the ground so slowly, with its body, that it is dragged."""
    feet = (stage.body_at(GRID) @ forward_kinematics(stage.robot, stage.table.angles))[..., 3, :]
    for leg in np.flatnonzero(~stage.contacts & ~stage.by_foot).tolist():
        if not swing_heights(feet[:, leg], feet[:, leg, 2]):
            raise UnreachableError(
                f"{stage.name}: the foot of leg {stage.robot.leg_names[leg]} would be dragged over the ground: it goes "
                f"up {1000 * float(np.ptp(feet[:, leg, 2])):.1f} mm, and aside before that"
            )


def check_margin(stage: Stage, supports: Floats, least: float) -> None:
    """Refuse a stage in which the centre of mass comes too near to the edge of what bears it."""
    shares = GRID[::_EVERY]
    com = stage.body_at(shares) @ centre_of_mass(stage.robot, stage.table.angles[::_EVERY])
    points = np.broadcast_to(supports[:, :2], (shares.size, *supports[:, :2].shape))
    margins = hull_margin(points, np.ones(points.shape[:2], dtype=bool), com[:, :2])
    worst = float(margins.min())
    if worst < least - 1e-9:
        held = [stage.robot.leg_codes[leg] for leg in np.flatnonzero(stage.contacts)]
        if not len(supports):
            raise TarsusError(f"{stage.name}: no leg can hold the body: 0 of {stage.robot.legs} feet can stay down")
        raise TarsusError(
            f"{stage.name}: held by {' '.join(held) or 'no foot'}, the stability margin would be "
            f"{worst * 1000:.1f} mm; at least {least * 1000:.1f} mm is asked for"
        )
