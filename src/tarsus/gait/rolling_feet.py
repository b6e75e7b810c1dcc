"""Feet of a planned walk as balls that roll on the ground in stance."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from tarsus.gait.cycle import tilted_body
from tarsus.gait.swing import horizontal_profile
from tarsus.gait.walk_setup import WalkSetup
from tarsus.kinematics.reach import Reach
from tarsus.kinematics.rolling import rolling_displacements
from tarsus.kinematics.solution import IKSolution

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["roll_feet"]

# Each pass multiplies the error by the foot radius over the length of the leg; three leave less than 1 um.
_PASSES = 3


def roll_feet(
    setup: WalkSetup,
    feet: Float[np.ndarray, "n legs 3"],
    contacts: Bool[np.ndarray, "n legs"],
    planar_pose: Float[np.ndarray, "n 3"],
) -> tuple[Float[np.ndarray, "n legs 3"], IKSolution]:
    """Return the feet and joint angles of a walk with feet that roll without slip.

    A foot is the centre of its ball. The ball turns with the tibia and rolls, so that the foot moves a little in the
    direction of the walk while it stands; if footholds stayed in place, the ball would drag the body along. In the
    middle of a stance the foot is where it would be as a point; in the first stance it is there at the beginning, and
    in the last one at the end.

    Parameters
    ----------
    setup : WalkSetup
        Robot and body.
    feet : array, shape (n, legs, 3)
        Feet as points, in G [m].
    contacts : array of bool, shape (n, legs)
        Whether each foot is on the ground.
    planar_pose : array, shape (n, 3)
        Poses of the body in the ground plane: x [m], y [m], yaw [rad].

    Returns
    -------
    feet : array, shape (n, legs, 3)
        Feet in G [m].
    solution : IKSolution
        Their inverse kinematics.
    """
    solution = setup.solve(feet, planar_pose)
    if not np.any(setup.robot.foot_radius):
        return feet, solution
    body = tilted_body(planar_pose, body_height=np.asarray(setup.body_height), body_tilt=setup.body_tilt)
    rolled = feet
    for _ in range(_PASSES):
        steps = rolling_displacements(setup.robot, np.asarray(solution.angles), body)
        offsets = np.zeros_like(feet)
        for leg in range(setup.robot.legs):
            offsets[:, leg] = _offsets(steps[:, leg], contacts[:, leg])
        rolled = feet + offsets
        solution = setup.solve(rolled, planar_pose)
    # At the border of the workspace a leg may not reach these few millimetres: its foot slips by them.
    short = (np.asarray(solution.reach) != Reach.OK).any(0)
    if short.any():
        rolled = np.where(short[:, None], feet, rolled)
        solution = setup.solve(rolled, planar_pose)
    return rolled, solution


def _offsets(steps: Float[np.ndarray, "_ 3"], contacts: Bool[np.ndarray, "n"]) -> Float[np.ndarray, "n 3"]:
    """Return the displacement of one foot from where it would be as a point, at every sample."""
    offsets = np.zeros((len(contacts), 3))
    stances = list(_runs(contacts))
    for start, end in stances:
        rolled = np.concatenate([np.zeros((1, 3)), np.cumsum(steps[start : end - 1], axis=0)])
        # The sample without an offset: a walk begins and ends in the rest stance.
        middle = 0 if start == 0 else end - 1 - start if end == len(contacts) else (end - start) // 2
        offsets[start:end] = rolled - rolled[middle]
    for (_, lift_off), (touchdown, _) in itertools.pairwise(stances):
        before, after = lift_off - 1, touchdown
        span = after - before
        s = np.arange(1, span)[:, None] / span
        offsets[lift_off:touchdown] = offsets[before] + (offsets[after] - offsets[before]) * horizontal_profile(s)
    return offsets


def _runs(contacts: Bool[np.ndarray, "n"]) -> Iterator[tuple[int, int]]:
    """Yield the first sample of each stance, and the one after its last."""
    edges = np.flatnonzero(np.diff(contacts.astype(int))) + 1
    bounds = [0, *edges.tolist(), len(contacts)]
    for start, end in itertools.pairwise(bounds):
        if contacts[start]:
            yield start, end
