"""Equilibria along a motion, one after the other: where each foot holds depends on where it touched down."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.gait.motion import Motion
from tarsus.load.compliant.applied_loads import AppliedLoads
from tarsus.load.compliant.balance import Configuration, Demand, Past
from tarsus.load.compliant.equilibrium import Compliant
from tarsus.load.compliant.newton import Equilibrium, solve_equilibrium
from tarsus.load.compliant.vibration import Vibration

if TYPE_CHECKING:
    from jaxtyping import Bool, Float, Int

__all__ = ["TOLERANCE", "History", "equilibria"]

TOLERANCE = 3e-4
"""Greatest residual of an equilibrium: moments over the weight times 1 m, forces over 5 times the weight. Torques of 8
walks then differ from those at 1e-9 by 0.2 mN m (RMS, median of the walks), and their peaks by 2 mN m at most."""

# Number of feet that are taken to share the weight when the robot is set down.
_FIRST_FEET = 3
_TINY = 1e-12


class History(NamedTuple):
    """Equilibria at the samples that were solved.

    Attributes
    ----------
    torques, forces, angles : array, shape (k, legs, 3)
        Joint torques [N m], forces of the ground on the feet in G [N], achieved joint angles [rad].
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

    The robot is set down in the first commanded pose, with its lowest foot on the ground. Each search starts from an
    offset from the commands that is extrapolated from the last two equilibria. Where no equilibrium is found, the robot
    is set down anew in the next commanded pose.

    Parameters
    ----------
    compliant : Compliant
        The robot.
    motion : Motion
        The commands.
    targets : array, shape (n, legs, 3)
        Joint angles that the servos aim at [rad].
    loads : AppliedLoads
        Loads at those samples.
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
    demands = _demands(compliant, motion, targets, loads, samples)
    tolerance = TOLERANCE * weight
    start, past = _set_down(compliant, demands[0], weight)
    last: Float[np.ndarray, "unknowns"] | None = None
    for row, demand in enumerate(demands):
        found, slid = _reach(compliant, start, past, demand, tolerance)
        at, balance = found
        history.torques[row], history.forces[row], history.angles[row] = balance.torques, balance.contact, at.angles
        past = _past(compliant, found, past, demand)
        history.rotation[row], history.position[row] = past.rotation, at.position
        history.residual[row], history.converged[row] = balance.size, balance.size <= tolerance
        history.slip[row] = history.slip[row - 1] + slid if row else 0.0
        after = demands[min(row + 1, count - 1)]
        if history.converged[row]:
            start = at.offset if last is None else 2.0 * at.offset - last
            last = at.offset
        else:
            last = None
            start, past = _set_down(compliant, after, weight)
    return history


def _demands(
    compliant: Compliant,
    motion: Motion,
    targets: Float[np.ndarray, "n legs 3"],
    loads: AppliedLoads,
    samples: Int[np.ndarray, "k"],
) -> list[Demand]:
    """Return the demand at each sample, without the inertial terms that follow from the last equilibrium."""
    count, legs = len(samples), compliant.legs
    forces, turn = np.zeros((count, legs, 12)), np.zeros((count, 6, 6))
    forces[:, :, :9] = loads.points.reshape(count, legs, 9)
    rotations = np.broadcast_to(motion.body.rotation, (len(motion.time), 3, 3))[samples]
    positions = np.broadcast_to(motion.body.position, (len(motion.time), 3))[samples]
    turn[:, :3, :3] = turn[:, 3:, 3:] = rotations
    arrays = (
        targets[samples],
        forces,
        np.hstack([loads.force, loads.moment, -loads.rotors.reshape(count, -1)]),
        motion.angles[samples],
        rotations,
        positions,
        turn @ (np.zeros((6, 6)) if compliant.inertia is None else compliant.inertia) @ turn.swapaxes(1, 2),
    )
    steps = np.diff(motion.time[samples], prepend=-np.inf)
    ahead, resistance = np.zeros(6 + 3 * legs), compliant.resistance(np.zeros((6, 6)), 0.0)
    return [Demand._make((*each, ahead, resistance)) for each in zip(*arrays, steps.tolist(), strict=True)]


def _reach(
    compliant: Compliant, start: Float[np.ndarray, "unknowns"], past: Past, demand: Demand, tolerance: float
) -> tuple[Equilibrium, Float[np.ndarray, "legs"]]:
    """Return the equilibrium at a sample, and how far each foot slid and crept up to it ``(legs,)`` [m]."""
    past, at = _touched_down(compliant, compliant.configuration(start, past, demand), past, demand.step)
    if past.vibration is not None:
        resistance = compliant.resistance(demand.inertia, past.vibration.gain(demand.step))
        demand = demand._replace(ahead=past.vibration.ahead(demand.step), resistance=resistance)
    found = solve_equilibrium(compliant, at, past, demand, tolerance=tolerance)
    return found, _slid(compliant, found, past)


def _touched_down(
    compliant: Compliant, predicted: Configuration, past: Past, step: float
) -> tuple[Past, Configuration]:
    """Return the last equilibrium, with the feet in the air moved to where they touch down, and the prediction.

    Otherwise a foot that was in the air would be dragged over the ground along its whole way since the last sample. The
    time of its touchdown follows from its height at the last sample and that in the configuration where the search
    starts, which continues its motion as if there were no ground.
    """
    before, after = past.bottoms[:, 2], predicted.bottoms[:, 2]
    if max(before.tolist()) <= 0:
        return past, predicted
    raised = np.maximum(before, 0.0)
    share = raised / np.maximum(raised - after, np.maximum(raised, _TINY))
    along = share[:, None] * predicted.displacement
    bottoms = past.bottoms.copy()
    bottoms[:, :2] += along
    trial = predicted.trial + compliant.contact.relaxation(step) * compliant.contact.tangential_stiffness * along
    return past._replace(bottoms=bottoms), predicted._replace(displacement=predicted.displacement - along, trial=trial)


def _past(compliant: Compliant, found: Equilibrium, past: Past, demand: Demand) -> Past:
    (at, balance), before, vibration = found, past.vibration, None
    if compliant.inertia is not None:
        vibration = Vibration.still(at.offset) if before is None else before.after(at.offset, demand.step)
    held = (balance.fraction == 1.0) & (at.normal > 0)
    return Past(at.rotation, at.position, at.angles, at.bottoms, balance.contact[:, :2].copy(), held, vibration)


def _set_down(compliant: Compliant, demand: Demand, weight: float) -> tuple[Float[np.ndarray, "unknowns"], Past]:
    """Return an offset that presses the lowest foot into the ground by its part of the weight, and the past there."""
    legs = compliant.legs
    bottoms = compliant.bottoms(demand.rotation, demand.position, demand.angles)
    start = np.zeros(6 + 3 * legs)
    start[2] = -bottoms[:, 2].min() - weight / (_FIRST_FEET * compliant.contact.normal_stiffness)
    position, still = demand.position + start[:3], np.zeros((legs, 2))
    return start, Past(demand.rotation, position, demand.angles, bottoms, still, np.zeros(legs, dtype=bool))


def _slid(compliant: Compliant, found: Equilibrium, past: Past) -> Float[np.ndarray, "legs"]:
    """Return how far the places where the feet hold have moved since the last equilibrium, ``(legs,)`` [m]."""
    elastic = (past.friction - found.balance.contact[:, :2]) / compliant.contact.tangential_stiffness
    moved = found.at.displacement - elastic
    slid: np.ndarray = np.hypot(moved[:, 0], moved[:, 1]) * (found.at.normal > 0)
    return slid
