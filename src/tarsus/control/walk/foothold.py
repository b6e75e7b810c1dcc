"""Foothold prediction: a foot is placed where its rest foothold will be in the middle of its next stance."""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.walk.state import ROUNDING, GaitState, StepInputs, integrate_twist
from tarsus.gait.foot_polygons import NORMALS_CONJUGATE

if TYPE_CHECKING:
    from jaxtyping import Complex

__all__ = ["FootholdPredictor", "final_footholds"]

# Below this twist [m/s, rad/s] a stopping robot steps to its final rest footholds.
_FINAL_SPEED = 0.01


def final_footholds(
    now: GaitState, *, rest: Complex[np.ndarray, "legs"], bandwidth: float
) -> Complex[np.ndarray, "legs"] | None:
    """Return the rest footholds in G at which a stopping robot will stand.

    Parameters
    ----------
    now, bandwidth : GaitState, float
        The gait state; bandwidth with which the twist decays [rad/s].
    rest : complex array, shape (legs,)
        Rest footholds in the heading frame [m].

    Returns
    -------
    complex array, shape (legs,), or None
        Footholds in G [m]; None while the robot is too fast.
    """
    if max(map(abs, now.twist.value.tolist())) >= _FINAL_SPEED:
        return None
    w = bandwidth
    origin, yaw = integrate_twist(now.origin, now.yaw, ((2 * now.twist.value + now.twist.rate / w) / w).tolist())
    return np.asarray(origin + cmath.exp(1j * yaw) * rest)


class FootholdPredictor:
    """Predicts footholds from the motion of the heading frame, in plain numbers.

    Parameters
    ----------
    now, inputs : GaitState, StepInputs
        The gait state, after which the twist is taken to settle at its present value while its rate decays; the inputs.
    """

    def __init__(self, now: GaitState, inputs: StepInputs) -> None:
        self._now, self._turn, self._inputs = now, cmath.exp(1j * now.yaw), inputs
        # Position and rotation of the heading frame, by time ahead: kept, as legs that swing together ask for the same.
        self._known: dict[float, tuple[complex, complex]] = {}

    def foothold(self, leg: int, touchdown: float, mid_stance: float) -> complex:
        """Return the foothold of a foot in G [m].

        Parameters
        ----------
        leg : int
            The leg.
        touchdown, mid_stance : float
            Time until touchdown, and until the middle of the stance [s].
        """
        inputs, rest = self._inputs, complex(self._inputs.rest[leg])
        position, rotation = self._body(mid_stance)
        beside = 0j if inputs.felt is None else inputs.felt.beside.get(leg, 0j)
        foothold = position + rotation * (rest + beside)
        # While the body turns or slows down, this foothold may be outside the bounds at touchdown.
        position, rotation = self._body(touchdown)
        out = (foothold - position) * rotation.conjugate() - rest
        if abs(out) > inputs.placement_radii[leg]:
            along = (NORMALS_CONJUGATE * out).real
            fraction = float((inputs.placement_bounds[leg] / np.maximum(along, 1e-12)).min())
            if fraction < 1 - ROUNDING:
                foothold = position + rotation * (rest + fraction * out)
        return self._now.origin + self._turn * foothold

    def _body(self, ahead: float) -> tuple[complex, complex]:
        """Return position and rotation of the heading frame after a time, relative to the present ones."""
        if ahead not in self._known:
            w, twist = self._inputs.bandwidth, self._now.twist
            decayed = (1 - math.exp(-w * ahead) * (1 + w * ahead)) / (w * w)
            (vx, vy, wz), (ax, ay, az) = twist.value.tolist(), twist.rate.tolist()
            travel = (vx * ahead + ax * decayed, vy * ahead + ay * decayed, wz * ahead + az * decayed)
            position, angle = integrate_twist(0j, 0.0, travel)
            self._known[ahead] = position, cmath.exp(1j * angle)
        return self._known[ahead]
