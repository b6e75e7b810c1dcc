"""Limits of a servo: its ratings at a supply voltage, and its torque-speed line."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tarsus.robot.servo import Servo

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["MOST_OVERVOLTAGE", "at_supply", "utilisation", "why_not_rated"]

MOST_OVERVOLTAGE = 1.5
"""Supply voltage over the highest rated one up to which torque and speed are extrapolated."""


def at_supply(servo: Servo | None, supply: float | None) -> tuple[float, float]:
    """Return a servo's stall torque [N m] and no-load speed [rad/s] at a supply voltage; NaN where unknown.

    They are unknown at more than `MOST_OVERVOLTAGE` times the highest voltage for which the servo is rated.

    Parameters
    ----------
    servo : Servo or None
        The servo.
    supply : float or None
        Supply voltage [V]; None for the rated values. Both values scale with the voltage, as for a brushed motor, if
        the voltage of the rating is known.

    Returns
    -------
    stall_torque, no_load_speed : float
        Stall torque [N m] and no-load speed [rad/s].
    """

    def scaled(value: float | None, rated_voltage: float | None) -> float:
        if value is None:
            return math.nan
        return value * supply / rated_voltage if supply and rated_voltage else value

    if servo is None or why_not_rated(servo, supply):
        return math.nan, math.nan
    return scaled(servo.stall_torque, servo.torque_at), scaled(servo.no_load_speed, servo.speed_at)


def why_not_rated(servo: Servo, supply: float | None) -> str:
    """Return why torque and speed of a servo are unknown at a supply voltage; an empty string where they are known.

    Parameters
    ----------
    servo : Servo
        The servo.
    supply : float or None
        Supply voltage [V]; None for that of its ratings.
    """
    if servo.supply is None or supply is None or supply <= MOST_OVERVOLTAGE * servo.supply[1]:
        return ""
    return (
        f"{servo.name} is rated for {servo.supply[0]:g} to {servo.supply[1]:g} V; torque and speed are unknown at the "
        f"supply of {supply:g} V, more than {MOST_OVERVOLTAGE:g} times that"
    )


def utilisation(
    torque: Float[np.ndarray, "*#batch"],
    speed: Float[np.ndarray, "*#batch"],
    stall_torque: Float[np.ndarray, "*#batch"],
    no_load_speed: Float[np.ndarray, "*#batch"],
) -> Float[np.ndarray, "*batch"]:
    """Return the utilisation of a servo's torque-speed line; above 1 the servo can't give that torque at that speed.

    A driving servo gives at most ``stall (1 - speed / no-load speed)``, so the relative torque and the relative speed
    add up. A servo driven by its load gives its full stall torque.

    Parameters
    ----------
    torque : array, shape (...)
        Joint torque, with its sign [N m].
    speed : array, shape (...)
        Joint velocity, with its sign [rad/s].
    stall_torque, no_load_speed : array, shape (...)
        Ratings of the servo [N m, rad/s].

    Returns
    -------
    array, shape (...)
        Utilisation.
    """
    driving = np.maximum(np.sign(torque) * speed, 0.0)
    return np.asarray(np.abs(torque) / stall_torque + driving / no_load_speed, dtype=np.float64)
