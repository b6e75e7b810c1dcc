"""How much of the straight way from one posture to another works, and what stops it there."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from tarsus.control.incremental import Incremental
from tarsus.control.workspace.foot_workspace import rest_margin
from tarsus.control.workspace.stability import StabilityCheck
from tarsus.control.workspace.stance_geometry import (
    LEVEL_TERRAIN,
    SWING_HEIGHT,
    StanceGeometry,
    TerrainEstimate,
    ground_rise,
    joint_margin,
    rotation_rows,
    stance_geometry_of,
)
from tarsus.robot.robot import Robot

__all__ = ["StanceTarget", "balanced_fraction", "first_increment", "largest_fraction", "limiting_cause"]

Floats = np.ndarray[Any, Any]

# All of the way is looked at in so many parts, then the one that fails is halved so often: to 1/2048 of the way.
_PARTS_OF_WAY, _HALVINGS = 16, 7
# How many postures are looked at closely in one tick.
_AT_ONCE = 2
# How far the rest footholds move at once at the most [m], and which parts of a step are tried.
_LONGEST_STEP, _SHORTER = 0.03, np.append(np.arange(16, 0, -1) / 16, (1 / 32, 1 / 64))
# What is no step [m].
_SAME = 1e-9
# How much more than it must be the centre of mass is inside its support, so that steps are left to the feet: a share of
# how far these are from each other.
_TO_STEP = 0.03


class StanceTarget(NamedTuple):
    """A posture and the rest footholds under it.

    Attributes
    ----------
    posture : array, shape (7,)
        The posture.
    rest : complex array, shape (legs,)
        The rest footholds in the heading frame [m].
    terrain : Terrain
        How the ground lies.
    """

    posture: Floats
    rest: Floats
    terrain: TerrainEstimate = LEVEL_TERRAIN

    def towards(self, other: StanceTarget, share: float) -> StanceTarget:
        """Return what is a share of the way to another.

        Parameters
        ----------
        other : Posed
            The other.
        share : float
            0 for here, 1 for there.
        """
        return self._replace(
            posture=self.posture + share * (other.posture - self.posture),
            rest=self.rest + share * (other.rest - self.rest),
        )

    @property
    def stand(self) -> StanceGeometry:
        """The body and the feet at rest."""
        return stance_geometry_of(self.posture, self.rest, self.terrain)


def largest_fraction(robot: Robot, now: StanceTarget, wished: StanceTarget) -> Incremental[tuple[float, str]]:
    """Return how much of the way all legs have room about their rest footholds, and what stops it there.

    Parameters
    ----------
    robot : Robot
        A single robot.
    now, wished : Posed
        Both ends of the way.

    Returns
    -------
    share : float
        To a thousandth of the way; 1 where nothing stops it.
    why : str
        What stops it.
    """
    shares = np.arange(1, _PARTS_OF_WAY + 1) / _PARTS_OF_WAY
    fails = (reach_margin(robot, [now.towards(wished, share) for share in shares.tolist()]) < 0).any(axis=-1)
    end = float(shares[fails.argmax()]) if fails.any() else 1.0
    yield

    def works(share: float) -> bool:
        return bool((rest_margin(robot, now.towards(wished, share).stand) >= 0).all())

    if not fails.any():
        if works(1.0):
            return 1.0, ""
        yield
    share, end = yield from _bracketed(works, end)
    yield
    return share, limiting_cause(robot, now.towards(wished, end).stand)


def _bracketed(works: Callable[[float], bool], end: float) -> Incremental[tuple[float, float]]:
    """Return a share that works, or 0, and one shortly after it that doesn't, from a share that doesn't."""
    begin = max(0.0, end - 1 / _PARTS_OF_WAY)
    while begin > 0 and not works(begin):
        begin, end = max(0.0, 2 * begin - end), begin
        yield
    yield
    for count in range(_HALVINGS):
        middle = (begin + end) / 2
        begin, end = (middle, end) if works(middle) else (begin, middle)
        if count % _AT_ONCE:
            yield
    return begin, end


def balanced_fraction(
    balance: StabilityCheck, now: StanceTarget, wished: StanceTarget, share: float
) -> Incremental[float]:
    """Return how much of the way the robot stands well inside its supports, at most some share; 0 for none of it.

    Parameters
    ----------
    balance : Balance
        What keeps the robot from tipping over.
    now, wished : Posed
        Both ends of the way.
    share : float
        A share at which it tips over.
    """
    margin = balance.least_margin + _TO_STEP * float(np.abs(now.rest - np.roll(now.rest, 1)).max())

    def works(share: float) -> bool:
        return balance.margin_at_rest(now.towards(wished, share).stand) >= margin

    return (yield from _bracketed(works, share))[0]


def first_increment(robot: Robot, now: StanceTarget, wished: StanceTarget, share: float) -> float:
    """Return how much of the way can be gone at once: as the body still is, the feet must reach their new places.

    Parameters
    ----------
    robot : Robot
        A single robot.
    now, wished : Posed
        Both ends of the way.
    share : float
        How much of it works.
    """
    parts = share * _SHORTER
    moved = np.abs(wished.rest - now.rest).max()
    if moved < _SAME:
        return share
    slack = reach_margin(robot, [now._replace(rest=now.towards(wished, part).rest) for part in parts.tolist()])
    works = (moved * parts <= _LONGEST_STEP) & (slack >= 0).all(axis=-1)
    return float(parts[works.argmax()] if works.any() else parts[-1])


def reach_margin(robot: Robot, posed: list[StanceTarget]) -> Floats:
    """Return how much is left to each leg ``(n, legs)`` at its rest foothold, on the ground, as low as may be, lifted.

    Parameters
    ----------
    robot : Robot
        A single robot.
    posed : list of Posed
        Postures and footholds, on the same terrain.
    """
    rows, rest = np.array([p.posture for p in posed]), np.array([p.rest for p in posed])
    rotation = np.array([rotation_rows(*row) for row in rows[:, 3:SWING_HEIGHT].tolist()])
    (slope, depth), position, swing_height = posed[0].terrain, rows[:, :3].T[..., None], rows[:, SWING_HEIGHT:]
    above = position[2] - ground_rise(slope, position[0], position[1])
    stand = StanceGeometry(rest, rotation[:, None], np.stack([position[0], position[1], above]), 0.0, slope)
    height = np.stack([-depth * swing_height, 0 * swing_height, swing_height][0 if depth else 1 :])
    return np.asarray(joint_margin(robot.geometry, stand.solve(robot, rest.real, rest.imag, height)).min(axis=0))


def limiting_cause(robot: Robot, stand: StanceGeometry) -> str:
    """Say which leg has no room about its rest foothold, and why.

    Parameters
    ----------
    robot : Robot
        A single robot.
    stand : Stand
        The body and the rest footholds.
    """
    room = rest_margin(robot, stand)
    name = robot.leg_names[int(room.argmin())]
    if rest_margin(robot, stand, knees=False)[room.argmin()] >= 0:
        return f"the knee of {name} comes to the ground"
    return f"{name} comes to the end of its reach"
