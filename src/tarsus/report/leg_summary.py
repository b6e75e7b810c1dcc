"""Numbers of forward and inverse kinematics of the legs, as printed by `tarsus fk` and `tarsus ik`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from tarsus.kinematics.body import coxa_frames
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.reach import Reach
from tarsus.report.standing_summary import knee_lines, limit_lines, lines_by_text
from tarsus.report.tables import table_of
from tarsus.robot.robot import JOINTS, Robot

if TYPE_CHECKING:
    from jaxtyping import Float
    from rich.table import Table

__all__ = ["FRAMES", "POINTS", "fk_summary", "ik_summary", "point_table", "target_table"]

POINTS = ("coxa axis", "femur axis", "knee", "foot")
"""Names of the points of a leg."""

FRAMES = (
    "body frame B: origin of the body, x forward, y left, z up",
    "coxa frame C of each leg: origin on its coxa axis, x outward along its mounting yaw, z up",
)
"""Legend of the frames."""

_COXA_FRAME = "the coxa frame C of the leg"


def fk_summary(robot: Robot, angles: Float[np.ndarray, "legs 3"], legs: Sequence[int]) -> dict[str, Any]:
    """Return the points of legs for joint angles, in both frames, with units in the keys.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Joint angles [rad].
    legs : sequence of int
        Indices of the legs.
    """
    points = np.asarray(forward_kinematics(robot, angles))
    frames = coxa_frames(robot).inverse()
    in_coxa = np.stack([np.asarray(frames[leg] @ points[leg]) for leg in range(robot.legs)])
    problems = limit_lines(robot, np.degrees(angles), legs)
    return {
        "robot": robot.name,
        "legs": [robot.leg_codes[leg] for leg in legs],
        "joints": list(JOINTS),
        "points": list(POINTS),
        "angles_deg": np.degrees(angles)[list(legs)].tolist(),
        "feet_mm": (points[list(legs), 3] * 1000).tolist(),
        "body_frame_mm": (points[list(legs)] * 1000).tolist(),
        "coxa_frame_mm": (in_coxa[list(legs)] * 1000).tolist(),
        "possible": not problems,
        "problems": problems,
    }


def ik_summary(
    robot: Robot,
    targets: Float[np.ndarray, "legs 3"],
    legs: Sequence[int],
    *,
    frame: Literal["body", "coxa"],
    knee: Literal["up", "down"],
) -> dict[str, Any]:
    """Return the joint angles for targets of the feet, and why a leg can't reach its target.

    Parameters
    ----------
    robot : Robot
        A single robot.
    targets : array, shape (legs, 3)
        Targets of the feet [m].
    legs : sequence of int
        Indices of the legs.
    frame : {"body", "coxa"}
        Frame of the targets: B, or the coxa frame C of each leg.
    knee : {"up", "down"}
        Knee branch.
    """
    # In the robot with all coxa axes at the origin of B, B is the coxa frame.
    placed = robot
    if frame == "coxa":
        placed = robot.replace(mount_position=np.zeros((robot.legs, 3)), mount_yaw=np.zeros(robot.legs))
    chosen = list(legs)
    solution, other = (
        inverse_kinematics(placed, targets, knee=branch) for branch in (knee, "down" if knee == "up" else "up")
    )
    reach, angles = np.asarray(solution.reach), np.degrees(np.asarray(solution.angles))
    failing = [leg for leg in chosen if reach[leg] != Reach.OK]
    name = _COXA_FRAME if frame == "coxa" else None
    if len(failing) == robot.legs:
        problems = solution.explain(frame=name).splitlines()
    else:
        problems = [solution.explain_leg((leg,), frame=name) for leg in failing]
    works = [leg for leg in failing if np.asarray(other.reach)[leg] == Reach.OK and not knee_lines(other, [leg])]
    problems += lines_by_text(robot, ((leg, f"reachable with the knee {other.knee}") for leg in works))
    problems += knee_lines(solution, chosen) if knee == "down" else []
    return {
        "robot": robot.name,
        "frame": frame,
        "knee": knee,
        "legs": [robot.leg_codes[leg] for leg in chosen],
        "joints": list(JOINTS),
        "feet_mm": (targets[chosen] * 1000).tolist(),
        "angles_deg": angles[chosen].tolist(),
        "reach": [Reach(int(reach[leg])).name for leg in chosen],
        "possible": not problems,
        "problems": problems,
        "assumed": knee_lines(solution, chosen) if knee == "up" else [],
    }


def point_table(summary: dict[str, Any]) -> Table:
    """Return a table of the foot of each leg, or of all points of a single leg, in both frames.

    Parameters
    ----------
    summary : dict
        Summary from `fk_summary`.
    """
    one = len(summary["legs"]) == 1
    columns = [f"{frame}: {axis} mm" for frame in "BC" for axis in "xyz"]
    table = table_of(summary["legs"][0] if one else "foot", *columns, right=columns)
    body, coxa = (np.array(summary[f"{frame}_frame_mm"]) for frame in ("body", "coxa"))
    rows = zip(
        summary["points" if one else "legs"], *((body[0], coxa[0]) if one else (body[:, 3], coxa[:, 3])), strict=True
    )
    for name, in_body, in_coxa in rows:
        table.add_row(name, *(f"{round(value, 2) + 0.0:.2f}" for value in (*in_body, *in_coxa)))
    return table


def target_table(summary: dict[str, Any]) -> Table:
    """Return a table of the targets and joint angles of legs.

    Parameters
    ----------
    summary : dict
        Summary from `ik_summary`.
    """
    numbers = ["x mm", "y mm", "z mm", *(f"{joint} deg" for joint in summary["joints"])]
    table = table_of("leg", *numbers, "reach", right=numbers)
    for leg, foot, angles, code in zip(
        summary["legs"], summary["feet_mm"], summary["angles_deg"], summary["reach"], strict=True
    ):
        texts = (f"{round(value, 2) + 0.0:.2f}" for value in (*foot, *angles))
        table.add_row(leg, *texts, Reach[code].text)
    return table
