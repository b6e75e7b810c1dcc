"""When servos take over a command: update rate, delay and dead band."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.simulation.servos.servo_table import ServoTable

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["CommandTiming"]


class _Group:
    """Servos with the same timing; `dead_band` is half of their dead bands, times are in physics steps."""

    def __init__(self, joints: Any, dead_band: Float[np.ndarray, "group"], period: int, delay: int) -> None:
        self.joints, self.period, self.delay = joints, period, delay
        self.dead_band = dead_band
        self.pending: dict[int, np.ndarray] = {}

    def take_over(self, target: Float[np.ndarray, "joints"], angles: Float[np.ndarray, "joints"]) -> None:
        """Move the targets of its joints towards a command, until the command is within their dead bands."""
        joints, band = self.joints, self.dead_band
        new = angles[joints]
        target[joints] = np.minimum(np.maximum(target[joints], new - band), new + band)


class CommandTiming:
    """The targets of all servos from one physics step to the next.

    A servo takes over the newest command at every multiple of its update period; the command acts after the delay.
    Within the dead band around its target a command changes nothing, so that the target lags by half the dead band:
    hysteresis.

    Parameters
    ----------
    table : ServoTable
        The servos.
    timestep : float
        Duration of a physics step [s].
    angles : array, shape (joints,)
        Targets at the start [rad].
    """

    def __init__(self, table: ServoTable, timestep: float, angles: Float[np.ndarray, "joints"]) -> None:
        each = [servo for row in table.servos for servo in row]
        dead_band = np.array([servo.dead_band / 2 for servo in each])
        timings = [(max(1, round(1 / (s.update_rate * timestep))), round(s.delay / timestep)) for s in each]
        self._groups = []
        for timing in sorted(set(timings)):
            joints = np.array([each == timing for each in timings])
            # For all joints a slice takes less time than a mask.
            self._groups.append(_Group(slice(None) if joints.all() else joints, dead_band[joints], *timing))
        self.target = np.array(angles, dtype=float)

    def command(self, step: int, angles: Float[np.ndarray, "joints"]) -> None:
        """Give a command at a physics step.

        Parameters
        ----------
        step : int
            Number of the step.
        angles : array, shape (joints,)
            Joint angles [rad].
        """
        for group in self._groups:
            taken = -(-step // group.period) * group.period
            group.pending[taken + group.delay] = angles

    def advance(self, step: int) -> Float[np.ndarray, "joints"]:
        """Return the targets in a physics step, ``(joints,)`` [rad].

        Parameters
        ----------
        step : int
            Its number; each is asked for once, in ascending order.
        """
        for group in self._groups:
            new = group.pending.pop(step, None)
            if new is not None:
                group.take_over(self.target, new)
        return self.target

    def next_change(self, step: int, end: int) -> int:
        """Return the first physics step between two in which a target may change; the later one if there is none.

        Parameters
        ----------
        step, end : int
            Numbers of the two steps; neither is between them.
        """
        for group in self._groups:
            for each in group.pending:
                if step < each < end:
                    end = each
        return end
