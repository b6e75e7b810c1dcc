"""Walks with a body shift: the shift for a stroke, and whether reach and stability allow that stroke."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.arrays import Array
from tarsus.gait.body_shift import edge_constraints, fitted_shift, shift_at
from tarsus.gait.branch import branches
from tarsus.gait.cycle import tilted_body
from tarsus.gait.excursion import Excursions, walk_excursions, walk_phases
from tarsus.gait.path import heading_to_ground
from tarsus.gait.walk_setup import WalkSetup
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.solution import IKSolution
from tarsus.kinematics.stability import stability_margin

if TYPE_CHECKING:
    from jaxtyping import Bool, Complex, Float

__all__ = ["shifted_feasibility", "shifted_pose", "walk_shift"]

# Stability margins for which a shift is planned, relative to the mean distance of the rest footholds from their centre:
# the first one that is feasible counts. Least share of that margin that must be left at every sample.
_MARGINS, _LEAST_SHARE = (0.1, 0.05, 0.025), 0.5
# Displacement of the body with which the resulting displacement of the centre of mass is found [m].
_DISPLACED = 0.01
# One in `_SAMPLED` samples of the walks is used; of those with a foot in the air, one in `_FITTED` for the fit.
_SAMPLED, _FITTED = 2, 2


def shifted_pose(
    planar_pose: Float[Array, "*#batch 3"], displacement: Complex[np.ndarray, "*#batch"]
) -> Float[Array, "*batch 3"]:
    """Return planar poses of the body displaced in their heading frame.

    Parameters
    ----------
    planar_pose : array, shape (..., 3)
        x [m], y [m] and yaw [rad] of the heading frame.
    displacement : complex array, shape (...)
        Displacement x + iy in the heading frame [m].
    """
    point = np.stack([displacement.real, displacement.imag, 0 * displacement.real], axis=-1)
    moved = heading_to_ground(planar_pose, point[..., None, :])[..., 0, :2]
    yaw = np.broadcast_to(np.asarray(planar_pose)[..., 2], moved.shape[:-1])
    return np.concatenate([moved, yaw[..., None]], axis=-1)


class _Trial(NamedTuple):
    """All short walks with one stroke and one body shift.

    Attributes
    ----------
    coefficients : complex array, shape (7,)
        Coefficients of the shift [m].
    solution : IKSolution
        Inverse kinematics.
    feasible : array of bool, shape (legs,)
        Which legs reach their feet without a jump; none where too little of the stability margin is left.
    """

    coefficients: Complex[np.ndarray, "7"]
    solution: IKSolution
    feasible: Bool[np.ndarray, "legs"]


def walk_shift(setup: WalkSetup, twist: Float[Array, "3"]) -> Complex[np.ndarray, "7"]:
    """Return the body shift of all walks with a stroke, start and stop included.

    Parameters
    ----------
    setup : WalkSetup
        Robot and gait.
    twist : array, shape (3,)
        Displacement of the body in one stance time: forward [m], left [m], yaw [rad].

    Returns
    -------
    complex array, shape (7,)
        Coefficients of `shift_at` [m].
    """
    return _best_trial(setup, np.asarray(twist)).coefficients


def _best_trial(setup: WalkSetup, twist: Float[np.ndarray, "3"]) -> _Trial:
    """Return the feasible trial with the largest planned margin; if none is feasible, that with the smallest."""
    phases, contacts = (values[::_SAMPLED] for values in walk_phases(setup.gait))
    sampled = Excursions(*(values[::_SAMPLED] for values in walk_excursions(setup.gait)))
    feet = sampled.feet(setup.rest, twist, setup.swing_height)
    swings = np.flatnonzero(~contacts.all(-1))[::_FITTED]
    centre = _centre_of_mass(setup, feet[swings], 0.0)
    share = float((_centre_of_mass(setup, feet[swings[:1]], _DISPLACED) - centre[:1]).real[0]) / _DISPLACED
    sample, inward, distance = edge_constraints(feet[swings, :, 0] + 1j * feet[swings, :, 1], contacts[swings], centre)
    size = float(np.linalg.norm((setup.rest - setup.rest.mean(0))[:, :2], axis=-1).mean())
    at_rest = branches(setup.robot, setup.solve(setup.rest).angles)

    def tried(margin: float) -> _Trial:
        found = fitted_shift(phases[swings][sample], inward, distance, margin=margin, share=share)
        pose = shifted_pose(np.zeros(3), shift_at(found, phases))
        solution = setup.solve(feet, pose)
        same = (branches(setup.robot, solution.angles) == at_rest).all(-1)
        body = tilted_body(pose, body_height=np.asarray(setup.body_height), body_tilt=setup.body_tilt)
        left = np.asarray(stability_margin(setup.robot, solution.angles, body, contacts)).min()
        legs = ((np.asarray(solution.reach) == 0) & same).all(0)
        return _Trial(found, solution, legs & (left >= _LEAST_SHARE * margin))

    *wide, narrow = (margin * size for margin in _MARGINS)
    feasible = (trial for trial in map(tried, wide) if trial.feasible.all())
    return next(feasible, None) or tried(narrow)


def _centre_of_mass(setup: WalkSetup, feet: Float[np.ndarray, "k legs 3"], forward: float) -> Complex[np.ndarray, "k"]:
    """Return the projection of the centre of mass in the heading frame, with the body displaced forward [m]."""
    pose = np.array([forward, 0.0, 0.0])
    body = tilted_body(pose, body_height=np.asarray(setup.body_height), body_tilt=setup.body_tilt)
    centre = body @ centre_of_mass(setup.robot, setup.solve(feet, pose).angles)
    return np.asarray(centre[..., 0] + 1j * centre[..., 1])


def shifted_feasibility(
    setup: WalkSetup, twist: Float[Array, "*#batch 3"]
) -> tuple[Bool[np.ndarray, "*batch legs"], IKSolution]:
    """Return which legs reach their feet without a jump in walks with that stroke and a body shift.

    Parameters
    ----------
    setup : WalkSetup
        Robot and gait.
    twist : array, shape (..., 3)
        Displacement of the body in one stance time: forward [m], left [m], yaw [rad].

    Returns
    -------
    feasible : array of bool, shape (..., legs)
        Whether each leg does; False for all legs where too little of the stability margin is left.
    solution : IKSolution
        Inverse kinematics of the feet of `walk_excursions`, with the last twist.
    """
    twist = np.asarray(twist)
    trials = [_best_trial(setup, row) for row in twist.reshape(-1, 3)]
    feasible = np.array([trial.feasible for trial in trials])
    return feasible.reshape(*twist.shape[:-1], setup.robot.legs), trials[-1].solution
