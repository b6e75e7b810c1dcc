"""Solution of the equilibrium at one sample.

Each step is a Newton step with the limits of friction following the normal forces. If it does not reduce the residual,
it is repeated with frozen limits (Tresca friction): then the equations are those of a potential, and a line search
along the step finds where it is nearly lowest. The limits are renewed after each such step.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.load.compliant.equilibrium import Balance, Compliant, Configuration, Demand, Past
from tarsus.load.compliant.foot_contact import normal_force
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
# Fraction of the limit of friction from which on a foot counts as sliding.
_SLID = 0.999
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
    if balance.size > tolerance:
        at, balance = _first_step(compliant, at, balance, past, demand, tolerance)
    frozen, steps = 0, 0
    while balance.size > tolerance and steps < _MOST_STEPS:
        steps += 1
        jacobian = contact_jacobian(compliant, at, balance)
        if not frozen:
            step = newton_step(compliant, at, balance, jacobian, demand, frozen=False)
            moved = compliant.configuration(*_moved(at, step, _scale(step)), past, demand.step)
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


def _first_step(
    compliant: Compliant, at: Configuration, balance: Balance, past: Past, demand: Demand, tolerance: float
) -> tuple[Configuration, Balance]:
    """Return where a search begins that would start with feet that lift or begin to slide; else its start.

    A start that continues the last motion is often wrong about which feet hold. The search rather begins after a step
    in which the feet that were on the ground stay on it, in tension if need be, and hold; or after one in which those
    that slid before slide, if that is closer to the equilibrium.
    """
    held = _held(compliant, at, past)
    if held is None:
        return at, balance
    start, found = at, []
    for limit in _first_limits(compliant, held, past):
        guess = compliant.balance(held, demand, limit)
        step = newton_step(compliant, held, guess, contact_jacobian(compliant, held, guess), demand, frozen=False)
        moved = compliant.configuration(*_moved(start, step, _scale(step)), past, demand.step)
        found.append(Equilibrium(moved, compliant.balance(moved, demand)))
        if found[-1].balance.size <= tolerance:
            break
    return min(found, key=lambda each: each.balance.size)


def _held(compliant: Compliant, at: Configuration, past: Past) -> Configuration | None:
    """Return a configuration with all feet on the ground that were on it before; None if no foot lifts or slides."""
    depth = compliant.radius - at.feet[:, 2]
    lifting = (depth <= 0) & (past.feet[:, 2] < compliant.radius)
    sliding = (at.normal > 0) & (_size(at.trial) > compliant.contact.friction * at.normal)
    if not (lifting | sliding).any():
        return None
    return at._replace(normal=np.where(lifting, compliant.contact.normal_stiffness * depth, at.normal))


def _first_limits(compliant: Compliant, held: Configuration, past: Past) -> Iterator[Float[np.ndarray, "legs"]]:
    """Yield limits of friction: without any, and with those of the feet that slid before."""
    contact, unlimited = compliant.contact, np.full(compliant.legs, np.inf)
    yield unlimited
    before = normal_force(past.feet[:, 2], compliant.radius, contact.normal_stiffness)
    slid = _size(past.friction) > _SLID * contact.friction * before
    if slid.any():
        yield np.where(slid, contact.friction * np.maximum(held.normal, 0.0), unlimited)


def _size(force: Float[np.ndarray, "legs 2"]) -> Float[np.ndarray, "legs"]:
    size: np.ndarray = np.sqrt((force * force).sum(axis=1))
    return size


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
