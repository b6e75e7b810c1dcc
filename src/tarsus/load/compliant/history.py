"""Equilibria along a motion, one after the other: where each foot holds depends on where it touched down."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.gait.motion import Motion
from tarsus.load.compliant.applied_loads import AppliedLoads
from tarsus.load.compliant.equilibrium import Compliant, Configuration, Demand, Past
from tarsus.load.compliant.newton import Equilibrium, solve_equilibrium
from tarsus.load.compliant.vibration import Vibration

if TYPE_CHECKING:
    from jaxtyping import Bool, Float, Int

__all__ = ["TOLERANCE", "History", "equilibria"]

TOLERANCE = 1e-4
"""Greatest residual of an equilibrium: moments over weight times 1 m, forces over weight times 5."""

# Feet that share the weight when the robot is set down.
_FIRST_FEET = 3
# How often the time between two samples is halved where the search fails.
_HALVINGS = 2
_TINY = 1e-12


class Start(NamedTuple):
    """Where a search starts: pose of B in G, joint angles."""

    rotation: Float[np.ndarray, "3 3"]
    position: Float[np.ndarray, "3"]
    angles: Float[np.ndarray, "legs 3"]


class History(NamedTuple):
    """Equilibria at the samples that were solved.

    Attributes
    ----------
    torques, forces, angles : array, shape (k, legs, 3)
        Joint torques [N m], ground on feet in G [N], achieved joint angles [rad].
    rotation, position : array, shapes (k, 3, 3) and (k, 3)
        Achieved poses of B in G.
    slip : array, shape (k, legs)
        Distance that each foot has slid and crept since the start [m].
    residual : array, shape (k,)
        Size of the residual [N m].
    converged : array of bool, shape (k,)
        Whether an equilibrium was found.
    """

    torques: Float[np.ndarray, "k legs 3"]
    forces: Float[np.ndarray, "k legs 3"]
    angles: Float[np.ndarray, "k legs 3"]
    rotation: Float[np.ndarray, "k 3 3"]
    position: Float[np.ndarray, "k 3"]
    slip: Float[np.ndarray, "k legs"]
    residual: Float[np.ndarray, "k"]
    converged: Bool[np.ndarray, "k"]


def equilibria(
    compliant: Compliant,
    motion: Motion,
    targets: Float[np.ndarray, "n legs 3"],
    loads: AppliedLoads,
    samples: Int[np.ndarray, "k"],
    weight: float,
) -> History:
    """Return the equilibria at some samples of a motion.

    The robot is set down in the first commanded pose, with its lowest foot on the ground. Each search starts from
    deviations from the commands that continue those of the last two equilibria. Where none is found, the next starts
    from the commanded pose.

    Parameters
    ----------
    compliant : Compliant
        The robot.
    motion : Motion
        The commands.
    targets : array, shape (n, legs, 3)
        Joint angles that the servos aim at [rad].
    loads : AppliedLoads
        Loads at all samples of the motion.
    samples : array of int, shape (k,)
        Samples to solve, ascending, the first of them 0.
    weight : float
        Weight of the robot [N].
    """
    count, legs = len(samples), compliant.legs
    history = History(
        torques=np.empty((count, legs, 3)),
        forces=np.empty((count, legs, 3)),
        angles=np.empty((count, legs, 3)),
        rotation=np.empty((count, 3, 3)),
        position=np.empty((count, 3)),
        slip=np.zeros((count, legs)),
        residual=np.empty(count),
        converged=np.empty(count, dtype=bool),
    )
    rotations = np.ascontiguousarray(np.broadcast_to(motion.body.rotation, (len(motion.time), 3, 3)))
    positions = np.ascontiguousarray(np.broadcast_to(motion.body.position, (len(motion.time), 3)))
    tolerance, before = TOLERANCE * weight, 0
    start, past = _set_down(compliant, rotations[0], positions[0], motion.angles[0], weight)
    demand_before, still = None, np.zeros(6 + 3 * legs)
    last: tuple[np.ndarray, np.ndarray, np.ndarray] | None = None
    for row, sample in enumerate(samples.tolist()):
        step = float(motion.time[sample] - motion.time[before]) if row else np.inf
        demand = Demand(
            targets[sample],
            loads.points[sample],
            loads.force[sample],
            loads.moment[sample],
            loads.rotors[sample],
            motion.angles[sample],
            rotations[sample],
            positions[sample],
            step,
            still,
        )
        found, slid = _reach(compliant, start, (past, demand_before), demand, tolerance)
        _record(history, row, found, tolerance)
        history.slip[row] = history.slip[row - 1] + slid if row else 0.0
        after = int(samples[min(row + 1, count - 1)])
        if history.converged[row]:
            at = found.at
            past, demand_before = _past(compliant, found, past, demand), demand
            off = (
                rotations[sample].T @ history.rotation[row],
                at.position - positions[sample],
                at.angles - motion.angles[sample],
            )
            was, last = last or off, off
            pose = rotations[after] @ off[0] @ was[0].T @ off[0], positions[after] + 2 * off[1] - was[1]
            start = Start(*pose, motion.angles[after] + 2 * off[2] - was[2])
        else:
            last, demand_before = None, None
            start, past = _set_down(compliant, rotations[after], positions[after], motion.angles[after], weight)
        before = sample
    return history


def _reach(
    compliant: Compliant,
    start: Start,
    before: tuple[Past, Demand | None],
    demand: Demand,
    tolerance: float,
    depth: int = 0,
) -> tuple[Equilibrium, Float[np.ndarray, "legs"]]:
    """Return the equilibrium at a sample, and how far each foot slid and crept up to it ``(legs,)`` [m].

    Where the search fails, the time since the last equilibrium is halved, with the means of commands and loads between.
    """
    past, demand_before = before
    at = compliant.configuration((start.rotation, start.position), start.angles, past, demand.step)
    past, at = _touched_down(compliant, at, past, demand.step)
    if past.vibration is not None:
        demand = demand._replace(ahead=past.vibration.ahead(demand.step), gain=past.vibration.gain(demand.step))
    found = solve_equilibrium(compliant, at, past, demand, tolerance=tolerance)
    if found.balance.size <= tolerance or demand_before is None or depth == _HALVINGS:
        return found, _slid(compliant, found, past)
    means = ((early + late) / 2 for early, late in zip(demand_before[:8], demand[:8], strict=True))
    middle = Demand._make((*means, demand.step / 2, demand.ahead, demand.gain))
    second = demand._replace(step=demand.step / 2)
    again = Start(past.rotation, past.position, past.angles)
    half, slid = _reach(compliant, again, before, middle, tolerance, depth + 1)
    again = Start(half.at.rotation, half.at.position, half.at.angles)
    found, slid_after = _reach(
        compliant, again, (_past(compliant, half, past, middle), middle), second, tolerance, depth + 1
    )
    return found, slid + slid_after


def _touched_down(
    compliant: Compliant, predicted: Configuration, past: Past, step: float
) -> tuple[Past, Configuration]:
    """Return the last equilibrium with the feet in the air where they will first meet the ground, and the prediction.

    A foot that was in the air would else be dragged over the ground all the way since the last sample. When it meets
    the ground follows from its heights then and in the configuration where the search starts, which continues its
    motion as if there were no ground.
    """
    before, after = past.feet[:, 2] - compliant.radius, predicted.feet[:, 2] - compliant.radius
    if (before <= 0).all():
        return past, predicted
    share = np.where(before > 0, before / np.maximum(before - after, np.maximum(before, _TINY)), 0.0)
    along = share[:, None] * predicted.displacement
    feet = past.feet.copy()
    feet[:, :2] += along
    trial = predicted.trial + compliant.contact.relaxation(step) * compliant.contact.tangential_stiffness * along
    return past._replace(feet=feet), predicted._replace(displacement=predicted.displacement - along, trial=trial)


def _past(compliant: Compliant, found: Equilibrium, past: Past, demand: Demand) -> Past:
    at, vibration = found.at, None
    if compliant.inertia is not None:
        offset = compliant.offset(at, demand)
        before = past.vibration
        vibration = Vibration.still(offset) if before is None else before.after(offset, demand.step)
    return Past(_orthonormal(at.rotation), at.position, at.angles, at.feet, found.balance.slip.force, vibration)


def _set_down(
    compliant: Compliant,
    rotation: Float[np.ndarray, "3 3"],
    position: Float[np.ndarray, "3"],
    angles: Float[np.ndarray, "legs 3"],
    weight: float,
) -> tuple[Start, Past]:
    """Return a commanded pose with its lowest foot on the ground, pressed in as under its part of the weight."""
    feet = compliant.feet(rotation, position, angles)
    raised = float((compliant.radius - feet[:, 2]).max()) - weight / (_FIRST_FEET * compliant.contact.normal_stiffness)
    start = Start(rotation, position + np.array([0.0, 0.0, raised]), angles)
    return start, Past(*start, feet, np.zeros((compliant.legs, 2)))


def _record(history: History, row: int, found: Equilibrium, tolerance: float) -> None:
    at, balance = found.at, found.balance
    history.torques[row], history.forces[row], history.angles[row] = balance.torques, balance.contact, at.angles
    history.rotation[row], history.position[row] = _orthonormal(at.rotation), at.position
    history.residual[row], history.converged[row] = balance.size, balance.size <= tolerance


def _slid(compliant: Compliant, found: Equilibrium, past: Past) -> Float[np.ndarray, "legs"]:
    """Return how far the places where the feet hold have moved since the last equilibrium, ``(legs,)`` [m]."""
    elastic = (past.friction - found.balance.slip.force) / compliant.contact.tangential_stiffness
    moved = found.at.displacement - elastic
    return np.where(found.at.normal > 0, np.sqrt((moved * moved).sum(axis=1)), 0.0)


def _orthonormal(rotation: Float[np.ndarray, "3 3"]) -> Float[np.ndarray, "3 3"]:
    """Return a rotation without the rounding of many products (one step of Newton's iteration for the polar factor)."""
    nearest: np.ndarray = rotation @ (1.5 * np.eye(3) - 0.5 * (rotation.T @ rotation))
    return nearest
