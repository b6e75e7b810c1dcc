"""Joint monitor: finds servos that do not follow their commands, by the measured joint angles."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from tarsus.control.readings import Vector

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["JointMonitor"]

_Measured: TypeAlias = "Sequence[Vector | None] | None"
# A joint may lag behind its command for so long [s].
_LAG = 0.15
# Error beyond which a servo gives more than its stall torque, if it works [rad]. Hobby servos give it at 0.1 rad.
_ERROR = 0.15
# The same of a servo that gives less than this share of its stall torque, where that is measured [rad].
_IDLE_ERROR, _IDLE = 0.07, 0.3
# How long a joint has to be off by this error until it has failed, and the time in which half of it is forgotten [s]. A
# greater error counts for more, by its square and up to these factors: where the torque is not measured, of an idle
# servo, and of one that pulls, as that of a leg does that is caught.
_FAILED_AFTER, _MEMORY = 1.5, 2.0
_MOST_WEIGHT, _MOST_IDLE, _MOST_PULLING = 6.0, 15.0, 1.0
# Where the torque is not measured, a femur that the ground has pushed up by so much [rad], more than any that holds on,
# and the greatest factor then.
_GIVES_WAY, _MOST_GIVING_WAY = 0.6, 30.0
# A joint whose command moves by so much within a time [rad], [s], and that moves by less than this share of it, is
# stuck; it has failed once that is so twice in a row.
_COMMANDED, _WITHIN, _SHARE, _ONCE = 0.15, 1.0, 0.4, 1.0


class JointMonitor:
    """Compares measured joint angles with those that were commanded a moment ago.

    A servo that is loaded gives way, and one that is slow lags behind. One that is dead, limp or stuck is off by more
    than its stall torque explains, for longer than any lag; the more it is off, the sooner it is found, and sooner yet
    where its torque is measured as well: a servo that works pulls.

    Parameters
    ----------
    stall_torque : array, shape (legs, 3), optional
        Stall torques of the servos [N m]; NaN where unknown. Left out, all are.

    Attributes
    ----------
    failed : dict of int to int
        Legs with a joint that has failed, and the joint.
    """

    def __init__(self, stall_torque: Float[np.ndarray, "legs 3"] | None = None) -> None:
        self._stall_torque = np.nan if stall_torque is None else stall_torque
        self.failed: dict[int, int] = {}
        self._commands: deque[tuple[float, Float[np.ndarray, "legs 3"]]] = deque()
        self._evidence: Float[np.ndarray, "2 legs 3"] | None = None
        self._compared: list[Float[np.ndarray, "2 legs 3"]] = []
        self._time = 0.0

    def step(
        self, commanded: Float[np.ndarray, "legs 3"], measured: _Measured, dt: float, *, torques: _Measured = None
    ) -> None:
        """Take in the joint angles and torques of a tick.

        Parameters
        ----------
        commanded : array, shape (legs, 3)
            Commanded until now [rad].
        measured : sequence of ((coxa, femur, tibia) or None), or None
            As measured [rad]; legs without a measurement are not monitored.
        dt : float
            Time since the last tick [s].
        torques : sequence of ((coxa, femur, tibia) or None), or None
            Of the servos, as measured [N m].
        """
        commands = self._commands
        commands.append((dt, commanded))
        if sum(time for time, _ in commands) > _LAG + dt:
            commands.popleft()
        if measured is None:
            return
        found = _array(measured)
        stuck = self._stuck(found, commanded, dt)
        with np.errstate(invalid="ignore"):
            off = np.abs(found - commanded) > _ERROR
        if not (off.any() or stuck is not None) and self._evidence is None:
            return
        if self._evidence is None:
            self._evidence = np.zeros((2, *commanded.shape))
        recent = [angles for _, angles in commands]
        error = np.fmax(np.fmax(found - np.max(recent, axis=0), np.min(recent, axis=0) - found), 0.0)
        bound, most = np.full_like(commanded, _ERROR), np.full_like(commanded, _MOST_WEIGHT)
        if torques is None:
            most[(found - np.max(recent, axis=0))[:, 1] > _GIVES_WAY, 1] = _MOST_GIVING_WAY
        else:
            share = np.abs(_array(torques)) / self._stall_torque
            bound[share < _IDLE], most[share < _IDLE], most[share >= _IDLE] = _IDLE_ERROR, _MOST_IDLE, _MOST_PULLING
        weight = np.where(error > bound, np.fmin((error / bound) ** 2, most), 0.0)
        once = np.zeros_like(commanded) if stuck is None else _ONCE * stuck
        self._evidence = self._evidence * 0.5 ** (dt / _MEMORY) + np.stack([dt * weight, once])
        for _, leg, joint in np.argwhere(self._evidence > _FAILED_AFTER).tolist():
            self.failed.setdefault(leg, joint)

    def _stuck(
        self, found: Float[np.ndarray, "legs 3"], commanded: Float[np.ndarray, "legs 3"], dt: float
    ) -> Bool[np.ndarray, "legs 3"] | None:
        """Return which joints have not moved with their commands, at the end of a time in which any is so."""
        self._compared.append(np.stack([found, commanded]))
        self._time += dt
        if self._time < _WITHIN:
            return None
        moved, wanted = np.ptp(self._compared, axis=0)
        self._compared, self._time = [], 0.0
        with np.errstate(invalid="ignore"):
            stuck: np.ndarray = (wanted > _COMMANDED) & (moved < _SHARE * wanted)
        return stuck if stuck.any() else None


def _array(values: Sequence[Vector | None]) -> Float[np.ndarray, "legs 3"]:
    """Return what is measured of each leg; NaN where nothing is."""
    return np.array([(np.nan,) * 3 if leg is None else leg for leg in values])
