"""What the supply must give: current from the torque, and the moments at which the legs' peaks coincide."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from tarsus.errors import InputError
from tarsus.load.loads import JointLoads

__all__ = ["SupplyLoad", "supply_load"]

# A leg is at its peak while its torque is at least this share of the most that it bears.
_NEAR_PEAK = 0.9
_LEGS_AT_ONCE = 3


@dataclass(frozen=True, eq=False, kw_only=True)
class SupplyLoad:
    """Currents of a robot's servos over a motion.

    Attributes
    ----------
    current : array, shape (n,) or None
        Current of all servos together [A]; None where the stall current of one is unknown.
    time : array, shape (n,)
        Moments [s].
    unknown : tuple of str
        Servos whose stall current is unknown.
    capacity : float or None
        Of the battery [A h].
    together : tuple of str
        Legs that are near their own peak load at once, at the moment at which most are.
    moment : float
        That moment [s].
    """

    current: np.ndarray[Any, np.dtype[np.float64]] | None
    time: np.ndarray[Any, np.dtype[np.float64]]
    unknown: tuple[str, ...]
    capacity: float | None
    together: tuple[str, ...]
    moment: float

    @property
    def peak_current(self) -> float | None:
        """Greatest current [A]; None where unknown."""
        return None if self.current is None else float(self.current.max())

    @property
    def mean_current(self) -> float | None:
        """Mean current over the motion [A]; None where unknown."""
        if self.current is None:
            return None
        return float(np.trapezoid(self.current, self.time) / (self.time[-1] - self.time[0]))

    @property
    def battery_time(self) -> float | None:
        """How long the battery lasts at the mean current [s]; None where either is unknown."""
        mean = self.mean_current
        if mean is None or self.capacity is None:
            return None
        return self.capacity * 3600 / mean if mean > 0 else math.inf

    @property
    def warning(self) -> str | None:
        """What to look out for: several legs at their peaks at once make the voltage drop."""
        if len(self.together) < _LEGS_AT_ONCE:
            return None
        now = None if self.current is None else float(np.interp(self.moment, self.time, self.current))
        amount = "" if now is None else f", {now:.1f} A in all"
        return (
            f"at {self.moment:.2f} s {len(self.together)} legs ({' '.join(self.together)}) bear their peaks at once"
            f"{amount}: a supply that can't give that drops its voltage, and the controller restarts"
        )


def supply_load(loads: JointLoads, *, capacity: float | None = None) -> SupplyLoad:
    """Return the currents that a motion draws.

    A servo draws its stall current when it exerts its stall torque, and in proportion less: the direct current motor
    without friction; one that can't bear its load draws its stall current. What a servo draws to move itself without
    load, and what gears rub, comes on top.

    Parameters
    ----------
    loads : Loads
        What the joints bear.
    capacity : float, optional
        Of the battery [A h].

    Raises
    ------
    InputError
        If the capacity is not positive and finite.
    """
    if capacity is not None and not 0 < capacity < math.inf:
        raise InputError(f"capacity is {capacity} A h; it must be greater than 0 and finite")
    servos = {servo for leg in loads.robot.servos for servo in leg}
    unknown = {"a joint without a servo" if s is None else s.name for s in servos if s is None or not s.stall_current}
    by_leg = np.abs(loads.torques).sum(2)
    near = (by_leg >= _NEAR_PEAK * by_leg.max(0)) & (by_leg > 0)
    # The moment at which most legs are near their peaks, and of those the one with the greatest sum.
    worst = int(np.lexsort((by_leg.sum(1), near.sum(1)))[-1])
    return SupplyLoad(
        current=None if unknown else _total_current(loads),
        time=loads.motion.time,
        unknown=tuple(sorted(unknown)),
        capacity=capacity,
        together=tuple(code for code, at in zip(loads.robot.leg_codes, near[worst], strict=True) if at),
        moment=float(loads.motion.time[worst]),
    )


def _total_current(loads: JointLoads) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Return the current of all servos together ``(n,)`` [A]; one that can't bear its load draws its stall current."""
    robot = loads.robot
    own = np.array([[(s.stall_current, s.stall_torque) for s in leg if s is not None] for leg in robot.servos])
    # Torque and current scale alike with the voltage: their ratio is the motor's own.
    per_torque = own[..., 0] / own[..., 1]
    total = np.minimum(np.abs(loads.torques), loads.stall_torque) * per_torque
    return np.asarray(total.sum((1, 2)))
