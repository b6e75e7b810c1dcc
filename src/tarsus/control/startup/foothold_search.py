"""Where legs can put their feet down, or leave them, while the body goes from one pose to another."""

from __future__ import annotations

import contextlib
from typing import Any

import numpy as np

from tarsus.control.startup.body_targets import BodyTarget, path_to
from tarsus.control.startup.builder import SequenceBuilder
from tarsus.control.startup.folded_pose import folded_pose
from tarsus.errors import TarsusError
from tarsus.kinematics.inverse import inverse_kinematics

__all__ = ["place_feet"]

Floats = np.ndarray[Any, np.dtype[np.float64]]
Flags = np.ndarray[Any, np.dtype[np.bool_]]

# Of the way to the goal, at how many poses a foothold must be within reach.
_POSES = 9
# Where footholds are looked for: shares of the leg's length out, and turns of the coxa [rad].
_OUT = np.linspace(0.3, 0.95, 14)
_TURNS = np.deg2rad(np.linspace(-45, 45, 13))
# Of the footholds that would do, how many are tried, near ones and far ones.
_CHOICES = 6


def place_feet(
    draft: SequenceBuilder, goal: BodyTarget, stance: Floats, *, free: Flags, lift_first: Flags, least: float
) -> None:
    """Put the free legs down where they can stay on the body's way; then those that can't stay where they are.

    Parameters
    ----------
    draft : Draft
        The robot as found; takes the stages.
    goal : Goal
        Where the body goes.
    stance : array, shape (legs, 3)
        Footholds in B that are wanted in the end [m].
    free, lift_first : array of bool, shape (legs,)
        The legs in the air, and those on the ground that must not stay as they are.
    least : float
        The least stability margin while one of the latter is lifted [m].
    """
    choices = _places(draft, goal, stance)
    folded = folded_pose(draft.robot)
    for leg in np.flatnonzero(free).tolist():
        # A leg for which there is no place is drawn in, or stays in the air as it is.
        if not _place(draft, leg, choices[leg]):
            with contextlib.suppress(TarsusError):
                _fly(draft, leg, folded[leg], "draw in", landed=False)
    left = np.flatnonzero(lift_first).tolist()
    while (placed := next((leg for leg in left if _place(draft, leg, choices[leg], least)), None)) is not None:
        left.remove(placed)
    for leg in left:
        # What can't be lifted by itself comes off the ground with the body, held by the others, or the body can't move.
        draft.let_go(leg)


def _place(draft: SequenceBuilder, leg: int, choices: Floats, least: float = 0.0) -> bool:
    """Put a foot down at the first of its footholds ``(n, 3)`` [rad] that it gets to; return whether there is one."""
    for angles in choices:
        with contextlib.suppress(TarsusError):
            _fly(draft, leg, angles, "place", landed=True, least=least)
            return True
    return False


def _fly(draft: SequenceBuilder, leg: int, angles: Floats, what: str, *, landed: bool, least: float = 0.0) -> None:
    """Take one leg through the air to joint angles; where that can't be, leave the draft as it was."""
    trial = draft.copy()
    one = np.arange(draft.robot.legs) == leg
    trial.let_go(leg)
    target = np.where(one[:, None], angles, draft.angles)
    trial.fly(f"{what} {draft.robot.leg_codes[leg]}", one, target, landed=landed, least=least)
    draft.take(trial)


def _places(draft: SequenceBuilder, goal: BodyTarget, stance: Floats) -> list[Floats]:
    """Return for every leg the angles of some footholds it can keep, ``(n, 3)`` [rad], near the wanted one first."""
    robot, g = draft.robot, draft.robot.geometry
    reach = (g.coxa + g.femur + g.tibia) * _OUT[:, None, None]
    yaw = robot.mount_yaw + _TURNS[:, None]
    x, y = (robot.mount_position[:, axis] + reach * fn(yaw) for axis, fn in ((0, np.cos), (1, np.sin)))
    spots = np.stack([x, y, np.full_like(x, -goal.body.position[2])], axis=-1).reshape(-1, robot.legs, 3)
    spots = np.concatenate([(stance * [1, 1, 0] - [0, 0, goal.body.position[2]])[None], spots])
    on_ground = goal.body @ spots
    way = path_to(draft, goal, np.zeros(robot.legs, dtype=bool)).body_at(np.linspace(0, 1, _POSES))
    feet = np.broadcast_to(on_ground[:, None], (len(spots), _POSES, robot.legs, 3))
    solution = inverse_kinematics(robot, feet, way)
    works = (np.asarray(solution.reach) == 0).all(1)
    away = np.where(works, np.linalg.norm(spots - spots[0], axis=-1), np.inf)
    order = np.argsort(away, axis=0)
    chosen = []
    for leg in range(robot.legs):
        good = order[: int(works[:, leg].sum()), leg]
        chosen.append(np.asarray(solution.angles)[good[:: max(len(good) // _CHOICES, 1)][:_CHOICES], 0, leg])
    return chosen
