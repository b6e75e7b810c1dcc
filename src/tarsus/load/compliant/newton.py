"""Solution of the equilibrium at one sample.

Newton steps have the limits of friction follow the normal forces. Along the direction in which a foot slides there is
hardly any stiffness, so that a step may reverse the direction, back and forth: it ends where such a foot is nearest to
sticking. If a number of steps does not reach the equilibrium, the search begins again with steps that reduce the
residual, and where one does not, with frozen limits (Tresca friction): then the equations are those of a potential, and
a line search along the step finds where it is nearly lowest.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.load.compliant.equilibrium import Balance, Compliant, Configuration, Demand, Past
from tarsus.load.compliant.tangent import contact_jacobian, newton_step

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Equilibrium", "solve_equilibrium"]

_MOST_STEPS = 40
_MOST_TRIALS = 8
# Residual over the last one up to which a step is taken as it is.
_ENOUGH = 0.7
# Slope of the potential at the end of a step over that at its start, up to which the step is taken.
_FLAT = 0.5
# Longest step [m, rad, rad].
_LONGEST = np.array([0.03, 0.2, 0.2])
# Newton steps before the search that reduces the residual, and the least part of one that is taken.
_DIRECT, _LEAST = 12, 0.05
# Steps with frozen limits before another is tried first.
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
        Commanded angles and loads.
    tolerance : float
        Size of the residual that is small enough [N m].
    """
    balance = compliant.balance(at, demand)
    start = Equilibrium(at, balance)
    for _ in range(_DIRECT):
        if balance.size <= tolerance:
            return Equilibrium(at, balance)
        at = _newton(compliant, at, balance, contact_jacobian(compliant, at, balance), past, demand)
        balance = compliant.balance(at, demand)
    return _descent(compliant, start, past, demand, tolerance)


def _descent(compliant: Compliant, start: Equilibrium, past: Past, demand: Demand, tolerance: float) -> Equilibrium:
    """Return the equilibrium by steps that reduce the residual, or the potential with frozen limits of friction."""
    at, balance = start
    frozen, steps = 0, 0
    while balance.size > tolerance and steps < _MOST_STEPS:
        steps += 1
        jacobian = contact_jacobian(compliant, at, balance)
        if not frozen:
            moved = _newton(compliant, at, balance, jacobian, past, demand)
            reached = compliant.balance(moved, demand)
            if reached.size < _ENOUGH * balance.size:
                at, balance = moved, reached
                continue
            frozen = _FROZEN
        step = newton_step(compliant, at, balance, jacobian, demand, frozen=True)
        if _slope(balance, step) >= 0:
            # Joints in their play leave legs so soft that the loads on them tip the potential over.
            springs = compliant.springs
            loose = np.abs(demand.targets - at.angles) <= springs.play
            stiff = balance._replace(slopes=np.where(loose, springs.stiffness, balance.slopes))
            step = newton_step(compliant, at, stiff, jacobian, demand, frozen=True)
        at = _line_search(compliant, at, balance, step, past, demand)
        balance = compliant.balance(at, demand)
        frozen -= 1
    return Equilibrium(at, balance)


def _newton(
    compliant: Compliant,
    at: Configuration,
    balance: Balance,
    jacobian: Float[np.ndarray, "legs 9 3"],
    past: Past,
    demand: Demand,
) -> Configuration:
    """Return the configuration after a Newton step that is not too long and reverses no sliding."""
    step = newton_step(compliant, at, balance, jacobian, demand, frozen=False)
    length = _scale(step)
    sliding = (balance.slip.fraction < 1.0) & (at.normal > 0)
    if sliding.any():
        moved = step[0] @ jacobian[:, :6, :2] + (step[1][:, None] @ jacobian[:, 6:, :2])[:, 0]
        change = -compliant.contact.relaxation(demand.step) * compliant.contact.tangential_stiffness * moved
        against, square = -(at.trial * change).sum(axis=1), (change * change).sum(axis=1)
        reversing = sliding & (against > (at.trial * at.trial).sum(axis=1))
        if reversing.any():
            length = min(length, max(float((against[reversing] / square[reversing]).min()), _LEAST))
    return compliant.configuration(*_moved(at, step, length), past, demand.step)


def _line_search(
    compliant: Compliant,
    at: Configuration,
    balance: Balance,
    step: tuple[Float[np.ndarray, "6"], Float[np.ndarray, "legs 3"]],
    past: Past,
    demand: Demand,
) -> Configuration:
    """Return where along a step the potential, with the limits of friction as they are, is nearly lowest."""
    limit = compliant.contact.friction * at.normal
    slope = _slope(balance, step)
    enough = _FLAT * abs(slope)
    low, high, length = 0.0, 0.0, _scale(step)
    below, above, moved = slope, 0.0, at
    for _ in range(_MOST_TRIALS):
        moved = compliant.configuration(*_moved(at, step, length), past, demand.step)
        reached = compliant.balance(moved, demand, limit)
        rise = _slope(reached, step)
        if abs(rise) <= enough or (rise < 0 and not high):
            break
        if rise > 0:
            high, above = length, rise
        else:
            low, below = length, rise
        length = low + (high - low) * min(max(below / (below - above), 0.1), 0.9)
    return moved


def _slope(balance: Balance, step: tuple[Float[np.ndarray, "6"], Float[np.ndarray, "legs 3"]]) -> float:
    """Return the slope of the potential along a step."""
    return float(balance.body @ step[0] + np.vdot(balance.joints, step[1]))


def _scale(step: tuple[Float[np.ndarray, "6"], Float[np.ndarray, "legs 3"]]) -> float:
    body, joints = np.abs(step[0]), np.abs(step[1])
    longest = max(body[:3].max() / _LONGEST[0], body[3:].max() / _LONGEST[1], joints.max() / _LONGEST[2])
    return float(min(1.0, 1.0 / longest)) if longest > 0 else 1.0


def _moved(
    at: Configuration, step: tuple[Float[np.ndarray, "6"], Float[np.ndarray, "legs 3"]], length: float
) -> tuple[tuple[Float[np.ndarray, "3 3"], Float[np.ndarray, "3"]], Float[np.ndarray, "legs 3"]]:
    x, y, z = (length * step[0][3:]).tolist()
    square = x * x + y * y + z * z
    # Series of the exponential map; the steps are short. The second coefficient is that of turn @ turn.
    a, b = 1.0 - square / 6.0, 0.5 - square / 24.0
    xy, yz, zx = b * x * y, b * y * z, b * z * x
    rotation = np.array(
        [
            [1.0 - b * (y * y + z * z), xy - a * z, zx + a * y],
            [xy + a * z, 1.0 - b * (z * z + x * x), yz - a * x],
            [zx - a * y, yz + a * x, 1.0 - b * (x * x + y * y)],
        ]
    )
    position = at.position + at.rotation @ (length * step[0][:3])
    return (at.rotation @ rotation, position), at.angles + length * step[1]
