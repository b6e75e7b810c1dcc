"""Body shift: the periodic displacement of the body that keeps it over the feet on the ground.

With four legs, the centre of mass leaves the triangle of three feet unless the body moves over it before the fourth
foot lifts. The shift is a Fourier series of the gait's phase, and thus smooth. Among the coefficients that keep a
stability margin at every phase with a foot in the air, those with the least acceleration are used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from jaxtyping import Bool, Complex, Float, Int

__all__ = ["COEFFICIENTS", "edge_constraints", "fitted_shift", "shift_at"]

_HARMONICS = 3
COEFFICIENTS = 2 * _HARMONICS + 1
"""Number of complex coefficients of a body shift: its mean, then a cosine and a sine of each harmonic."""

# Cost weights: of the squares of the mean and of the harmonics, the latter by the square of their acceleration; of the
# squared violations of the margin.
_WEIGHTS = np.array([0.1, *(0.1 + h**4 for h in range(1, _HARMONICS + 1) for _ in range(2))])
_PENALTY = 1e4
# Newton's method: most iterations, step sizes tried, and least relative decrease of the cost in a step.
_ITERATIONS, _STEPS, _PROGRESS = 40, 0.5 ** np.arange(8), 1e-9


def shift_at(
    coefficients: Complex[np.ndarray, "*#batch 7"], phases: Float[np.ndarray, "*#batch"] | float
) -> Complex[np.ndarray, "*batch"]:
    """Return the displacement of the body in the heading frame, x + iy [m].

    Parameters
    ----------
    coefficients : complex array, shape (..., 7)
        Coefficients of the shift [m].
    phases : array, shape (...)
        Phases of the gait [cycles].
    """
    return np.asarray((_basis(np.asarray(phases)) * coefficients).sum(-1))


def _basis(phases: Float[np.ndarray, "*batch"]) -> Float[np.ndarray, "*batch 7"]:
    angle = 2 * np.pi * phases
    parts = [f(h * angle) for h in range(1, _HARMONICS + 1) for f in (np.cos, np.sin)]
    return np.stack([np.ones_like(angle), *parts], axis=-1)


def edge_constraints(
    feet: Complex[np.ndarray, "n legs"], contacts: Bool[np.ndarray, "n legs"], centre: Complex[np.ndarray, "n"]
) -> tuple[Int[np.ndarray, "k"], Complex[np.ndarray, "k"], Float[np.ndarray, "k"]]:
    """Return the edges of the support polygons: sample, inward normal, and distance of the centre of mass inside.

    Parameters
    ----------
    feet : complex array, shape (n, legs)
        Feet in the order of the legs, counter-clockwise around the body [m].
    contacts : array of bool, shape (n, legs)
        Which of them are on the ground.
    centre : complex array, shape (n,)
        Projection of the centre of mass [m].

    Returns
    -------
    sample : array of int, shape (k,)
        Index of the sample to which each edge belongs.
    inward : complex array, shape (k,)
        Unit normals.
    distance : array, shape (k,)
        Distance of the centre of mass inside each edge [m].
    """
    legs = feet.shape[-1]
    following = np.zeros(feet.shape, dtype=int)
    for leg in range(legs):
        # The next foot on the ground, counter-clockwise around the body.
        order = [(leg + i) % legs for i in range(1, legs + 1)]
        following[:, leg] = np.asarray(order)[np.argmax(contacts[:, order], axis=-1)]
    sample, first = np.nonzero(contacts)
    start = feet[sample, first]
    along = feet[sample, following[sample, first]] - start
    inward = 1j * along / np.maximum(np.abs(along), 1e-12)
    return sample, inward, (inward.conj() * (centre[sample] - start)).real


def fitted_shift(
    phases: Float[np.ndarray, "k"],
    inward: Complex[np.ndarray, "k"],
    distance: Float[np.ndarray, "k"],
    *,
    margin: float,
    share: float = 1.0,
) -> Complex[np.ndarray, "7"]:
    """Return the shift of least acceleration that keeps a margin to edges; where none does, a compromise.

    Parameters
    ----------
    phases : array, shape (k,)
        Phase at which each edge belongs to the support polygon [cycles].
    inward : complex array, shape (k,)
        Inward unit normal of each edge.
    distance : array, shape (k,)
        Distance of the centre of mass inside each edge without a shift [m].
    margin : float
        Stability margin [m].
    share : float
        Displacement of the centre of mass over that of the body.

    Returns
    -------
    complex array, shape (7,)
        The coefficients [m].
    """
    basis = share * _basis(phases)
    rows = np.concatenate([basis * inward.real[:, None], basis * inward.imag[:, None]], axis=-1)
    weights, missing = np.tile(_WEIGHTS, 2), margin - distance

    def cost(tried: np.ndarray) -> float:
        violated = np.maximum(missing - rows @ tried, 0.0)
        return float(weights @ (tried * tried) + _PENALTY * violated @ violated)

    # Newton's method with bisected steps: the cost is convex and piecewise quadratic.
    found = np.zeros(2 * COEFFICIENTS)
    for _ in range(_ITERATIONS):
        active = rows @ found < missing
        normal = rows[active].T * _PENALTY
        goal = np.linalg.solve(np.diag(weights) + normal @ rows[active], normal @ missing[active])
        step, now = goal - found, cost(found)
        size = next((size for size in _STEPS if cost(found + size * step) < now * (1 - _PROGRESS)), 0.0)
        if size == 0:
            break
        found = found + size * step
    return np.asarray(found[:COEFFICIENTS] + 1j * found[COEFFICIENTS:])
