"""Checks of a stage of a motion sequence: reach, joint limits, ground clearance, lift-off and stability margin."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.sequence.stage import GRID, Stage
from tarsus.errors import TarsusError, UnreachableError
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.leg_path import lifts_off
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.polygon import hull_margin
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.underside import underside_points
from tarsus.robot.robot import JOINTS

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["check_stage", "limit_excess"]

# Tolerances of an increase of an angle beyond its limit [rad], of a depth below the ground and of the margin [m].
_ANGLE_TOLERANCE = 1e-8
_DEPTH_TOLERANCE = 1e-6
_MARGIN_TOLERANCE = 1e-9
# Tolerance with which inverse kinematics has to reproduce the initial angles [rad].
_BRANCH_TOLERANCE = 1e-6
# The stability margin is evaluated at every n-th point of `GRID`.
_MARGIN_INTERVAL = 4


def limit_excess(stage: Stage) -> Float[np.ndarray, "257 legs 3"]:
    """Return how far the joint angles of `Stage.table` are beyond their limits [rad].

    Parameters
    ----------
    stage : Stage
        The stage.

    Returns
    -------
    array, shape (257, legs, 3)
        Excess, 0 within the limits, NaN where a foot is out of reach [rad].
    """
    low, high = np.moveaxis(stage.robot.limits, -1, 0)
    return np.asarray(np.maximum(np.maximum(low - stage.table, stage.table - high), 0.0))


def check_stage(stage: Stage, margin: float) -> None:
    """Check that a stage is possible.

    Parameters
    ----------
    stage, margin : Stage, float
        The stage; least stability margin [m].

    Raises
    ------
    UnreachableError
        If a foot is out of reach, a joint exceeds its limits, a point goes below the ground, or a foot drags.
    TarsusError
        If the stability margin is too small.
    """
    body = stage.body_at(GRID)
    _check_reach(stage, body)
    _check_limits(stage, body)
    points = body @ forward_kinematics(stage.robot, stage.table)
    _check_ground(stage, points, (body @ underside_points(stage.robot)[None])[..., 2])
    _check_lift_off(stage, points[..., 3, :])
    _check_margin(stage, body, margin)


def _check_reach(stage: Stage, body: Pose) -> None:
    """Refuse a stage in which a foot cannot follow its Cartesian path."""
    fails = np.isnan(stage.table).any(-1)
    # Near the ends of the range of angles, the solution of a leg's branch may differ from the angles it starts with.
    fails[0] |= np.abs(stage.table[0] - stage.angles).max(-1) > _BRANCH_TOLERANCE
    if not fails.any():
        return
    index, leg = (int(i) for i in np.argwhere(fails)[0])
    feet = np.where(stage.cartesian[:, None], stage.feet_at(GRID)[index], stage.feet)
    solution = inverse_kinematics(stage.robot, feet, body[index])
    straight = f"{stage.robot.leg_names[leg]} would be straight, or folded back on itself"
    reason = solution.explain_leg((leg,)) if solution.reach[leg] else straight
    raise UnreachableError(f"{stage.name}: at body height {body.position[index, 2] * 1000:.1f} mm, {reason}")


def _check_limits(stage: Stage, body: Pose) -> None:
    """Refuse a stage in which a joint leaves its limits, or moves further beyond a limit."""
    excess = limit_excess(stage)
    increases = np.diff(excess, axis=0) > _ANGLE_TOLERANCE
    if not increases.any():
        return
    _, leg, joint = (int(i) for i in np.argwhere(increases)[0])
    worst = int(np.argmax(excess[:, leg, joint]))
    low, high = np.degrees(stage.robot.limits[leg, joint])
    raise UnreachableError(
        f"{stage.name}: at body height {body.position[worst, 2] * 1000:.1f} mm, the {JOINTS[joint]} of leg "
        f"{stage.robot.leg_names[leg]} would be at {np.degrees(stage.table[worst, leg, joint]):.1f} deg, "
        f"{np.degrees(excess[worst, leg, joint]):.1f} deg beyond its limits of {low:.1f} to {high:.1f} deg"
    )


def _check_ground(stage: Stage, points: Float[np.ndarray, "n legs 4 3"], underside: Float[np.ndarray, "n m"]) -> None:
    """Refuse a stage in which a point of the legs or of the body goes below the ground."""
    heights = points[..., 1:, 2]
    _, leg, point = np.unravel_index(int(np.argmin(heights)), heights.shape)
    depth = -float(heights.min())
    what = f"{('femur axis', 'knee', 'foot')[point]} of leg {stage.robot.leg_names[leg]}"
    if -float(underside.min()) > depth:
        depth, what = -float(underside.min()), "underside of the body"
    if depth > _DEPTH_TOLERANCE:
        raise UnreachableError(f"{stage.name}: the {what} would be {depth * 1000:.1f} mm below the ground")


def _check_lift_off(stage: Stage, feet: Float[np.ndarray, "n legs 3"]) -> None:
    """Refuse a stage in which a foot drags along the ground before it lifts off."""
    for leg in np.flatnonzero(~stage.contacts & ~stage.cartesian).tolist():
        if not lifts_off(feet[:, leg], feet[:, leg, 2]):
            raise UnreachableError(
                f"{stage.name}: the foot of leg {stage.robot.leg_names[leg]} would drag along the ground before it "
                f"rises by {1000 * float(np.ptp(feet[:, leg, 2])):.1f} mm"
            )


def _check_margin(stage: Stage, body: Pose, margin: float) -> None:
    """Refuse a stage in which the centre of mass comes too near the edge of the support polygon."""
    supports = np.concatenate([stage.feet[stage.contacts], stage.supports])
    com = body[::_MARGIN_INTERVAL] @ centre_of_mass(stage.robot, stage.table[::_MARGIN_INTERVAL])
    least = float(hull_margin(supports[:, :2], np.ones(len(supports), dtype=bool), com[:, :2]).min())
    if least >= margin - _MARGIN_TOLERANCE:
        return
    if not len(supports):
        raise TarsusError(
            f"{stage.name}: no leg can support the body: 0 of {stage.robot.legs} feet can stay on the ground"
        )
    codes = [stage.robot.leg_codes[leg] for leg in np.flatnonzero(stage.contacts)]
    raise TarsusError(
        f"{stage.name}: supported by {' '.join(codes) or 'no foot'}, the stability margin would be "
        f"{least * 1000:.1f} mm; at least {margin * 1000:.1f} mm is required"
    )
