"""Load of the power supply: current from torque, and coinciding peaks of several legs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tarsus.errors import InputError
from tarsus.load.loads import JointLoads
from tarsus.representation import represented

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["SupplyLoad", "supply_load"]

# A leg counts as near its peak while its torque is at least this fraction of its maximum.
_NEAR_PEAK = 0.9
_COINCIDING_LEGS = 3


@represented()
@dataclass(frozen=True, eq=False, kw_only=True)
class SupplyLoad:
    """Supply current of a robot's servos over a motion.

    Attributes
    ----------
    current : array, shape (n,) or None
        Total current of all servos [A]; None if a stall current is unknown.
    time : array, shape (n,)
        Sample times [s].
    unknown : tuple of str
        Servos whose stall current is unknown.
    capacity : float or None
        Battery capacity [A h].
    peak_legs : tuple of str
        Legs near their own peak load at `peak_time`.
    peak_time : float
        Time at which most legs are near their peak load [s].
    """

    current: Float[np.ndarray, "n"] | None
    time: Float[np.ndarray, "n"]
    unknown: tuple[str, ...]
    capacity: float | None
    peak_legs: tuple[str, ...]
    peak_time: float

    @property
    def peak_current(self) -> float | None:
        """Largest current [A]; None if unknown."""
        return None if self.current is None else float(self.current.max())

    @property
    def mean_current(self) -> float | None:
        """Mean current over the motion [A]; None if unknown."""
        if self.current is None:
            return None
        return float(np.trapezoid(self.current, self.time) / (self.time[-1] - self.time[0]))

    @property
    def battery_time(self) -> float | None:
        """Battery life at the mean current [s]; None if current or capacity is unknown."""
        mean = self.mean_current
        if mean is None or self.capacity is None:
            return None
        return self.capacity * 3600 / mean if mean > 0 else math.inf

    @property
    def warning(self) -> str | None:
        """Warning if several legs have their peaks at the same time, which makes the voltage drop; else None."""
        if len(self.peak_legs) < _COINCIDING_LEGS:
            return None
        current = None if self.current is None else float(np.interp(self.peak_time, self.time, self.current))
        amount = "" if current is None else f", {current:.1f} A in total"
        legs = f"{len(self.peak_legs)} legs ({' '.join(self.peak_legs)})"
        return (
            f"at {self.peak_time:.2f} s the peak loads of {legs} coincide{amount}: "
            "if the supply cannot deliver it, its voltage drops and the controller resets"
        )


def supply_load(loads: JointLoads, *, capacity: float | None = None) -> SupplyLoad:
    """Return the supply current of a motion.

    The current of a servo is proportional to its torque, up to the stall current at the stall torque: a DC motor
    without friction. No-load current and gear friction are not included.

    Parameters
    ----------
    loads : JointLoads
        Joint loads.
    capacity : float, optional
        Battery capacity [A h].

    Raises
    ------
    InputError
        If the capacity is not positive and finite.
    """
    if capacity is not None and not 0 < capacity < math.inf:
        raise InputError(f"capacity is {capacity} A h; it must be greater than 0 and finite")
    servos = {servo for leg in loads.robot.servos for servo in leg}
    unknown = {"a joint without a servo" if s is None else s.name for s in servos if s is None or not s.stall_current}
    leg_load = np.abs(loads.torques).sum(2)
    near = (leg_load >= _NEAR_PEAK * leg_load.max(0)) & (leg_load > 0)
    # The sample with most legs near their peaks; of several, the one with the largest total.
    worst = int(np.lexsort((leg_load.sum(1), near.sum(1)))[-1])
    return SupplyLoad(
        current=None if unknown else _total_current(loads),
        time=loads.motion.time,
        unknown=tuple(sorted(unknown)),
        capacity=capacity,
        peak_legs=tuple(code for code, at in zip(loads.robot.leg_codes, near[worst], strict=True) if at),
        peak_time=float(loads.motion.time[worst]),
    )


def _total_current(loads: JointLoads) -> Float[np.ndarray, "n"]:
    """Return the total current of all servos ``(n,)`` [A]; an overloaded servo draws its stall current."""
    robot = loads.robot
    stall = np.array([[(s.stall_current, s.stall_torque) for s in leg if s is not None] for leg in robot.servos])
    # Torque and current scale alike with the voltage, so their ratio is constant.
    per_torque = stall[..., 0] / stall[..., 1]
    # Where the supply is too high for a rating, no stall current limits it.
    total = np.fmin(np.abs(loads.torques), loads.stall_torque) * per_torque
    return np.asarray(total.sum((1, 2)))
