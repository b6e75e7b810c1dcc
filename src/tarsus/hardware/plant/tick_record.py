"""What a servo plant did in one tick."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.representation import represented

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["TickRecord"]


@represented("time", "asked", "sent", "measured", "voltage", "fault")
class TickRecord(NamedTuple):
    """What a servo plant did in one tick.

    Attributes
    ----------
    time : float
        On the plant's clock [s].
    asked, sent, measured : array, shape (legs, 3)
        Joint angles that the controller gave, those of the commands that were sent, and those last measured; NaN where
        nothing was [rad].
    temperatures : array, shape (legs, 3)
        Temperatures of the servos, the last that were measured [deg C].
    voltage : float or None
        Lowest voltage of the supply among the last that were measured [V].
    loads : array, shape (legs, 3)
        Drives of the motors, -1 to 1, the last that were measured.
    fault : str
        What was noticed; empty without a fault.
    """

    time: float
    asked: Float[np.ndarray, "legs 3"]
    sent: Float[np.ndarray, "legs 3"]
    measured: Float[np.ndarray, "legs 3"]
    temperatures: Float[np.ndarray, "legs 3"]
    voltage: float | None
    loads: Float[np.ndarray, "legs 3"]
    fault: str
