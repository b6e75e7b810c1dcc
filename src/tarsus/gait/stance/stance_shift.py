"""Body shift of a stance, fitted to the feet at rest, and the phases at which stability is checked with it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.gait.body_shift import edge_constraints, fitted_shift
from tarsus.gait.gait import Gait
from tarsus.gait.stance.stance_geometry import StanceGeometry

if TYPE_CHECKING:
    from jaxtyping import Bool, Complex, Float

__all__ = ["stance_shift", "support_phases"]

# Phases of the cycle to which the shift is fitted.
_SAMPLES = 96
# Phases of a swing at which the stability is examined.
_SWING = np.array([0.0, 0.5, 1.0])
# Stability margin that the shift is to keep, as a share of the room of the legs; about as much is left for steps.
_SHARE_OF_ROOM = 0.4


def stance_shift(gait: Gait, stance: StanceGeometry, centre: complex, room: float) -> Complex[np.ndarray, "7"]:
    """Return the coefficients of the shift, fitted to the feet at rest [m].

    Parameters
    ----------
    gait, stance, centre : Gait, StanceGeometry, complex
        A gait with a body shift; the body and the rest footholds; projection of the centre of mass [m].
    room : float
        Least distance of a rest foothold from the sides of its polygon [m].
    """
    phases = (np.arange(_SAMPLES) + 0.5) / _SAMPLES
    contacts = gait.phase(phases)[2]
    swings = ~contacts.all(-1)
    feet = np.broadcast_to(stance.rest, contacts.shape)[swings]
    sample, inward, distance = edge_constraints(feet, contacts[swings], np.full(len(feet), centre))
    return fitted_shift(phases[swings][sample], inward, distance, margin=_SHARE_OF_ROOM * room)


def support_phases(gait: Gait) -> tuple[Float[np.ndarray, "n"], Bool[np.ndarray, "n legs"]]:
    """Return the phases at the beginning, middle and end of each swing, and the feet on the ground at these.

    Parameters
    ----------
    gait : Gait
        The gait.

    Returns
    -------
    phases : array, shape (n,)
        Phases [cycles].
    contacts : array of bool, shape (n, legs)
        Whether each foot is on the ground; the first and last phase are just inside the swing.
    """
    lift = np.asarray(gait.offsets)[:, None] + gait.duty_factor
    inside = 1e-6 + _SWING * (1 - gait.duty_factor - 2e-6)
    phases = (lift + inside).ravel()
    return phases, gait.phase(phases)[2]
