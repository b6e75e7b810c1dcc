"""Where feet are to be put down: so that the body has their rest footholds in the middle of their stance."""

from __future__ import annotations

import cmath
import math
from typing import Any, NamedTuple

import numpy as np

from tarsus.control.walk.state import GaitState, StepInputs, chord_factor, integrate_twist
from tarsus.control.workspace.polygon import NORMALS_CONJUGATE

__all__ = ["FootholdPredictor", "final_footholds"]

Floats = np.ndarray[Any, Any]

# Below this speed [m/s] of the feet past the body, a robot told to stand is taken to be stopping: it steps to rest.
_CREEPING = 0.01
# What a share of 1 may be missed by from rounding.
_ROUNDING = 1e-9


def final_footholds(now: GaitState, *, rest: Floats, bandwidth: float) -> Floats | None:
    """Return where the feet rest once a robot that stops stands.

    Parameters
    ----------
    now : GaitState
        The gait state.
    rest : complex array, shape (legs,)
        Rest footholds in the heading frame [m].
    bandwidth : float
        Bandwidth with which the twist dies down [rad/s].

    Returns
    -------
    complex array, shape (legs,), or None
        In G [m]; None while the robot is still fast.
    """
    if max(map(abs, now.twist.value.tolist())) >= _CREEPING:
        return None
    w = bandwidth
    origin, yaw = integrate_twist(now.origin, now.yaw, ((2 * now.twist.value + now.twist.rate / w) / w).tolist())
    final: Floats = origin + cmath.exp(1j * yaw) * rest
    return final


class FootholdPredictor(NamedTuple):
    """What the footholds of a moment depend on, in plain numbers.

    Attributes
    ----------
    origin, turn : complex
        The heading frame's origin in G [m]; its turn, ``exp(i yaw)``.
    value, rate : list of float
        Its twist [m/s, m/s, rad/s], and how fast that changes.
    bandwidth : float
        How fast the change dies down [rad/s].
    """

    origin: complex
    turn: complex
    value: list[float]
    rate: list[float]
    bandwidth: float

    @classmethod
    def of(cls, now: GaitState, inputs: StepInputs) -> FootholdPredictor:
        """Return that of a moment.

        Parameters
        ----------
        now : Moment
            The moment.
        inputs : Course
            What the robot is doing.
        """
        turn = cmath.exp(1j * now.yaw)
        return cls(now.origin, turn, now.twist.value.tolist(), now.twist.rate.tolist(), inputs.bandwidth)

    def foothold(self, rest: complex, room: Floats, until: float, middle: float) -> complex:
        """Return where a foot is to be put down in G [m].

        Parameters
        ----------
        rest : complex
            Its rest foothold in the heading frame [m].
        room : array, shape (16,)
            How far from that it may be put down, along each side's normal [m].
        until, middle : float
            How long it is until it touches down, and until the middle of its stance [s].
        """
        way, facing = self._body(middle)
        place = way + facing * rest
        # Where the body turns or slows down, that may be farther out than the foot may be put down.
        way, facing = self._body(until)
        out = (place - way) * facing.conjugate() - rest
        along = (NORMALS_CONJUGATE * out).real
        share = float((room / np.maximum(along, 1e-12)).min())
        if share < 1 - _ROUNDING:
            place = way + facing * (rest + share * out)
        return self.origin + self.turn * place

    def _body(self, ahead: float) -> tuple[complex, complex]:
        """Return where the body will be, and where it will face, seen from where it is."""
        w = self.bandwidth
        slowing = (1 - math.exp(-w * ahead) * (1 + w * ahead)) / (w * w)
        (x, y, angle), (ax, ay, turn) = self.value, self.rate
        angle = angle * ahead + turn * slowing
        return complex(x * ahead + ax * slowing, y * ahead + ay * slowing) * chord_factor(angle), cmath.exp(1j * angle)
