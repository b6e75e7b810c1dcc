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

__all__ = ["drive_torque"]

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
