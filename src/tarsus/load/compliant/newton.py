"""Solution of the equilibrium at one sample.

In Newton steps, the limits of friction follow the normal forces. A sliding foot has hardly any stiffness along its
direction of sliding, so steps may reverse this direction again and again; a foot whose sliding a step would reverse is
made to hold in that step. The start of the search extrapolates the motion: it lifts many feet that in fact stay, and
lets others slide that in fact hold. In the first step, feet that stood in the last equilibrium and are lifted at the
start are therefore kept on the ground, and they and the feet that held do not slide.

If a number of steps does not reach the equilibrium, the search begins again, and each Newton step must then reduce the
residual. Where one does not, steps with frozen limits of friction (Tresca friction) follow. With these, the equations
are those of a potential, and a line search along the step finds where it is nearly lowest.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.load.compliant.balance import Balance, Configuration, Demand, Past
from tarsus.load.compliant.equilibrium import Compliant
from tarsus.load.compliant.offset import moved
from tarsus.load.compliant.tangent import contact_jacobian, newton_step

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["Equilibrium", "solve_equilibrium"]

_MOST_STEPS = 40
_MOST_TRIALS = 8
# A Newton step is accepted where it reduces the residual to less than this fraction.
_ENOUGH = 0.7
# A step length is accepted where the slope of the potential at its end is at most this fraction of that at its start.
_FLAT = 0.5
# Longest step: translation of the body, its rotation, joint angles [m, rad, rad].
_LONGEST = 0.03, 0.2, 0.2
# Newton steps before the search begins again with steps that must reduce the residual.
_DIRECT = 12
# Steps with frozen limits of friction before the next Newton step is tried.
_FROZEN = 3


class Equilibrium(NamedTuple):
    """Where the search ended.

    Attributes
    ----------
    at : Configuration
        The configuration.
    balance : Balance
        Its balance.
    """

    at: Configuration
    balance: Balance


def solve_equilibrium(
    compliant: Compliant, at: Configuration, past: Past, demand: Demand, *, tolerance: float
) -> Equilibrium:
    """Return the equilibrium near a configuration.

    Parameters
    ----------
    compliant : Compliant
        The robot.
    at : Configuration
        Where to start.
    past : Past
        The last equilibrium.
    demand : Demand
        Commands and loads.
    tolerance : float
        Size of the residual that is small enough [N m].
    """
    first = at
    stood = (past.bottoms[:, 2] <= 0) & (at.normal == 0)
    tied = -compliant.contact.normal_stiffness * at.bottoms[:, 2] * stood
    at = at._replace(normal=at.normal + tied)
    balance = compliant.balance(at, demand, _limit(compliant, at, past.held | stood))
    for _ in range(_DIRECT):
        at = _newton(compliant, at, balance, past, demand)
        balance = compliant.balance(at, demand)
        if balance.size <= tolerance:
            return Equilibrium(at, balance)
    return _descent(compliant, Equilibrium(first, compliant.balance(first, demand)), past, demand, tolerance)


def _limit(compliant: Compliant, at: Configuration, held: Bool[np.ndarray, "legs"]) -> Float[np.ndarray, "legs"]:
    """Return limits of friction ``(legs,)`` [N], infinite for the feet that are made to hold."""
    return np.where(held, np.inf, compliant.contact.friction * at.normal)


def _descent(compliant: Compliant, start: Equilibrium, past: Past, demand: Demand, tolerance: float) -> Equilibrium:
    """Search by steps that reduce the residual, or that reduce the potential with frozen limits of friction."""
    at, balance = start
    frozen, steps = 0, 0
    while balance.size > tolerance and steps < _MOST_STEPS:
        steps += 1
        if not frozen:
            further = _newton(compliant, at, balance, past, demand)
            reached = compliant.balance(further, demand)
            if reached.size < _ENOUGH * balance.size:
                at, balance = further, reached
                continue
            frozen = _FROZEN
        jacobian = contact_jacobian(compliant, at)
        step = newton_step(compliant, at, balance, jacobian, demand, frozen=True)
        if _slope(balance, step) >= 0:
            # Legs with joints in their play are so soft that, under load, the step may not lower the potential.
            springs = compliant.springs
            loose = np.abs(demand.targets - at.angles) <= springs.play
            stiff = balance._replace(slopes=np.where(loose, springs.stiffness, balance.slopes))
            step = newton_step(compliant, at, stiff, jacobian, demand, frozen=True)
        at = _line_search(compliant, at, balance, step, past, demand)
        balance = compliant.balance(at, demand)
        frozen -= 1
    return Equilibrium(at, balance)


def _newton(compliant: Compliant, at: Configuration, balance: Balance, past: Past, demand: Demand) -> Configuration:
    """Return the configuration after a Newton step of limited length; feet whose sliding it would reverse hold."""
    jacobian = contact_jacobian(compliant, at)
    step = newton_step(compliant, at, balance, jacobian, demand, frozen=False)
    sliding = (balance.fraction < 1.0) & (at.normal > 0)
    if True in sliding.tolist():
        by_leg = np.empty((compliant.legs, 1, 9))
        by_leg[:, 0, :6], by_leg[:, 0, 6:] = step[:6], step[6:].reshape(-1, 3)
        displaced, (x, y) = (by_leg @ jacobian)[:, 0], at.trial.T
        stiffness = compliant.contact.relaxation(demand.step) * compliant.contact.tangential_stiffness
        reversing = sliding & (stiffness * (x * displaced[:, 0] + y * displaced[:, 1]) > x * x + y * y)
        if True in reversing.tolist():
            balance = compliant.balance(at, demand, _limit(compliant, at, reversing | (balance.fraction == 1.0)))
            step = newton_step(compliant, at, balance, jacobian, demand, frozen=False)
    return compliant.configuration(moved(at.offset, _scale(step) * step), past, demand)


def _line_search(
    compliant: Compliant,
    at: Configuration,
    balance: Balance,
    step: Float[np.ndarray, "unknowns"],
    past: Past,
    demand: Demand,
) -> Configuration:
    """Return where along a step the potential, with the limits of friction frozen, is nearly lowest."""
    limit = compliant.contact.friction * at.normal
    slope = _slope(balance, step)
    enough = _FLAT * abs(slope)
    low, high, length = 0.0, 0.0, _scale(step)
    below, above, further = slope, 0.0, at
    for _ in range(_MOST_TRIALS):
        further = compliant.configuration(moved(at.offset, length * step), past, demand)
        reached = compliant.balance(further, demand, limit)
        rise = _slope(reached, step)
        if abs(rise) <= enough or (rise < 0 and not high):
            break
        if rise > 0:
            high, above = length, rise
        else:
            low, below = length, rise
        length = low + (high - low) * min(max(below / (below - above), 0.1), 0.9)
    return further


def _slope(balance: Balance, step: Float[np.ndarray, "unknowns"]) -> float:
    """Return the slope of the potential along a step."""
    return float(balance.residual @ step)


def _scale(step: Float[np.ndarray, "unknowns"]) -> float:
    each = np.abs(step).tolist()
    longest = max(max(each[:3]) / _LONGEST[0], max(each[3:6]) / _LONGEST[1], max(each[6:]) / _LONGEST[2])
    return min(1.0, 1.0 / longest) if longest > 0 else 1.0
