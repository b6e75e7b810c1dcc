"""Pose controller: the target posture of the body, its sway, and the bandwidth with which it is followed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.filters import CriticallyDamped
from tarsus.gait.body_shift import COEFFICIENTS
from tarsus.gait.stance.stance_geometry import SWING_HEIGHT, sway_fraction

if TYPE_CHECKING:
    from jaxtyping import Complex, Float

__all__ = ["NO_SHIFT", "PoseController"]

NO_SHIFT = CriticallyDamped.still(np.zeros(2 * COEFFICIENTS))
"""No body shift: coefficients, real and imaginary parts, shape (14,) [m]."""

# Greatest bandwidth of the posture [rad/s], and the greatest speed and turning rate of the body [m/s, rad/s].
_BANDWIDTH = 4.0
_BODY_SPEED, _BODY_TURN = 0.08, 0.5

# Tolerances within which a posture and a sway count as reached [m, rad].
_POSTURE_TOLERANCE, _SWAY_TOLERANCE = 2e-4, 1e-3
# Tolerance of the body shift, less than the least stability margin [m].
_SHIFT_TOLERANCE = 2e-3


class PoseController:
    """Target posture and sway of the body.

    Parameters
    ----------
    posture : array, shape (7,)
        The initial posture.

    Attributes
    ----------
    posture : array, shape (7,)
        The target posture.
    target : array, shape (13,)
        The target posture and the sway's amplitudes; the same array object until either changes.
    shift : array, shape (14,)
        Target of the body shift's coefficients [m].
    """

    def __init__(self, posture: Float[np.ndarray, "7"]) -> None:
        self.posture = posture
        self.target = np.append(posture, np.zeros(SWING_HEIGHT))
        self.shift: Float[np.ndarray, "14"] = NO_SHIFT.value

    def set_shift(self, coefficients: Complex[np.ndarray, "7"] | None, value: Float[np.ndarray, "14"]) -> bool:
        """Set the body shift, and return whether it is reached.

        Parameters
        ----------
        coefficients : complex array, shape (7,), or None
            Its coefficients [m]; None for no shift.
        value : array, shape (14,)
            Its present coefficients, real and imaginary parts [m].
        """
        if coefficients is None:
            self.shift = NO_SHIFT.value
        elif self.shift.base is not coefficients:
            self.shift = coefficients.view(float)
        return value is self.shift or float(np.abs(value - self.shift).sum()) <= _SHIFT_TOLERANCE

    def set_posture(self, posture: Float[np.ndarray, "7"]) -> None:
        """Set the target posture."""
        self.posture = posture
        self.target = np.append(posture, self.target[SWING_HEIGHT + 1 :])

    def set_sway(self, sway: tuple[float, ...], *, frequency: float, beats: int) -> None:
        """Set the sway, reduced to what the joints can follow.

        Parameters
        ----------
        sway : tuple of float
            Commanded amplitudes: x, y, z [m], roll, pitch, yaw [rad].
        frequency, beats : float, int
            Gait cycles per second [1/s]; number of lift-offs per cycle, where legs that lift together count once.
        """
        before = self.target[SWING_HEIGHT + 1 :]
        if any(sway) or any(before.tolist()):
            amplitude = np.array(sway)
            amplitude *= sway_fraction(amplitude, frequency, beats)
            if (before != amplitude).any():
                self.target = np.append(self.posture, amplitude)

    def reached(self, value: Float[np.ndarray, "13"]) -> bool:
        """Return whether the present posture and its sway have reached their target."""
        if value is self.target:
            return True
        off: list[float] = np.abs(value - self.target).tolist()
        return max(off[: SWING_HEIGHT + 1]) < _POSTURE_TOLERANCE and max(off[SWING_HEIGHT + 1 :]) < _SWAY_TOLERANCE

    def bandwidth(self, value: Float[np.ndarray, "13"]) -> float:
        """Return the bandwidth at which the body, from its present posture, keeps to its greatest speeds [rad/s]."""
        if value is self.target:
            return _BANDWIDTH
        distance: list[float] = np.abs(value - self.target).tolist()
        lengths, turns = (*distance[:3], distance[SWING_HEIGHT]), distance[3:SWING_HEIGHT]
        time = max(max(lengths) / _BODY_SPEED, max(turns) / _BODY_TURN)
        # A critically damped filter with bandwidth 2 v / distance, renewed every tick, reaches speed v and keeps it.
        return min(_BANDWIDTH, 2 / max(time, 1e-9))
