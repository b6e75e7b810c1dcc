"""The torque of servos at a physics step.

With position error e, joint speed w, and the slope s of the torque-speed line (stall torque over no-load speed)::

    spring = stiffness * dead_zone(e, play)   within  -stall and stall
    motor  = spring - s * w                   within  -stall and stall
    torque = motor - damping * w

The second line is the torque of a brushed motor at a given voltage: while it drives, at most the stall torque times
``1 - |w| / no-load speed``; while it is driven by its load, at most the stall torque, as in
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
    """Return the torque of servos before damping; all arrays broadcast against each other.

    Parameters
    ----------
    error : array, shape (...)
        Target less joint angle [rad].
    speed : array, shape (...)
        Joint speed [rad/s].
    stiffness : array, shape (...)
        Torque per position error [N m/rad].
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
    spring = np.clip(stiffness * (error - np.clip(error, -play, play)), -stall_torque, stall_torque)
    loss = slope * speed
    return np.asarray(np.clip(spring - loss, -stall_torque, stall_torque) + loss)
