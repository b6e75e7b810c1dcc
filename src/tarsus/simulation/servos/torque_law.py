"""The torque of servos at a physics step.

With position error e, joint speed w, and the slope s of the torque-speed line (stall torque over no-load speed)::

    drive  = stiffness * dead_zone(e, play)   within   max(s w, 0) - stall  and  min(s w, 0) + stall
    torque = drive - (s + damping) * w

Without further damping, ``drive - s w`` is what a brushed motor gives on a voltage: while it drives, at most the stall
torque times ``1 - |w| / no-load speed``; while it is driven by its load, at most the stall torque, as in
`tarsus.load.servo_limits.utilisation`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["TorqueLaw", "drive_torque"]

Numbers: TypeAlias = np.ndarray | float


def drive_torque(
    error: Float[np.ndarray, "*#batch"],
    speed: Float[np.ndarray, "*#batch"],
    *,
    stiffness: Numbers,
    play: Numbers,
    stall_torque: Numbers,
    slope: Numbers,
) -> Float[np.ndarray, "*batch"]:
    """Return the torque of servos without what damps them; all arrays broadcast against each other.

    Parameters
    ----------
    error : array, shape (...)
        Target less joint angle [rad].
    speed : array, shape (...)
        Joint speed [rad/s].
    stiffness : array, shape (...)
        Torque per error [N m/rad].
    play : array, shape (...)
        Half the backlash [rad].
    stall_torque : array, shape (...)
        Greatest torque [N m].
    slope : array, shape (...)
        Stall torque over no-load speed [N m s/rad].

    Returns
    -------
    array, shape (...)
        Torque to which the damping, ``-(slope + damping) * speed``, is to be added [N m].
    """
    # np.minimum and np.maximum take half the time of np.clip on arrays of this size.
    torque = stiffness * (error - np.minimum(np.maximum(error, -play), play))
    loss = slope * speed
    lowest, highest = np.maximum(loss, 0.0) - stall_torque, np.minimum(loss, 0.0) + stall_torque
    return np.asarray(np.minimum(np.maximum(torque, lowest), highest))


class TorqueLaw:
    """`drive_torque` for a fixed set of servos, computed in place: allocating its arrays would take half of its time.

    Parameters
    ----------
    stiffness, play, stall_torque, slope : array, shape (joints,)
        As for `drive_torque`.
    """

    def __init__(
        self,
        *,
        stiffness: Float[np.ndarray, "joints"],
        play: Float[np.ndarray, "joints"],
        stall_torque: Float[np.ndarray, "joints"],
        slope: Float[np.ndarray, "joints"],
    ) -> None:
        self._stiffness, self._play, self._back = stiffness, play, -play
        self._stall, self._slope, self._zero = stall_torque, slope, np.zeros_like(slope)
        self._torque, self._loss, self._bound = np.empty_like(slope), np.empty_like(slope), np.empty_like(slope)

    def apply(
        self,
        target: Float[np.ndarray, "joints"],
        angle: Float[np.ndarray, "joints"],
        speed: Float[np.ndarray, "joints"],
        out: Float[np.ndarray, "joints"],
    ) -> None:
        """Write the torques without what damps them.

        Parameters
        ----------
        target, angle : array, shape (joints,)
            Targets and joint angles [rad].
        speed : array, shape (joints,)
            Joint speeds [rad/s].
        out : array, shape (joints,)
            Takes the torques [N m].
        """
        torque, loss, bound = self._torque, self._loss, self._bound
        np.subtract(target, angle, out=torque)
        np.maximum(torque, self._back, out=bound)
        np.minimum(bound, self._play, out=bound)
        np.subtract(torque, bound, out=torque)
        np.multiply(torque, self._stiffness, out=torque)
        np.multiply(self._slope, speed, out=loss)
        np.maximum(loss, self._zero, out=bound)
        np.subtract(bound, self._stall, out=bound)
        np.maximum(torque, bound, out=torque)
        np.minimum(loss, self._zero, out=loss)
        np.add(loss, self._stall, out=loss)
        np.minimum(torque, loss, out=out)
