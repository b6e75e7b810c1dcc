"""How much of the straight path from one stance to another is feasible, and what limits it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.control.limitation import Cause
from tarsus.control.workspace.foot_workspace import rest_margin
from tarsus.control.workspace.stability import StabilityCheck
from tarsus.control.workspace.stance_geometry import (
    SWING_HEIGHT,
    StanceGeometry,
    joint_margin,
    rotation_rows,
    stance_geometry_of,
)
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Complex, Float

__all__ = [
    "HALVINGS",
    "TIPPING",
    "Bracket",
    "StanceTarget",
    "first_increment",
    "first_unreachable",
    "is_balanced",
    "is_reachable",
    "reach_cause",
    "reach_margin",
]

TIPPING = Cause("the robot would tip over")
# The whole path is sampled at so many points; the interval that fails is then halved: to 1/2048 of the path.
_SAMPLES = 16
HALVINGS = 7
"""Number of halvings of the interval in which a path ceases to be feasible."""

# How far the rest footholds move in one transition at most [m], and the fractions of a step that are tried.
_LONGEST_STEP, _SHORTER = 0.03, np.append(np.arange(16, 0, -1) / 16, (1 / 32, 1 / 64))
# Rest footholds closer than this are the same [m].
_SAME = 1e-9
# Additional stability margin, as a fraction of the distance between feet, which leaves the feet room to step.
_STEP_MARGIN = 0.03


class StanceTarget(NamedTuple):
    """A posture and the rest footholds under it.

    Attributes
    ----------
    posture : array, shape (7,)
        The posture.
    rest : complex array, shape (legs,)
        The rest footholds in the heading frame [m].
    """

    posture: Float[np.ndarray, "7"]
    rest: Complex[np.ndarray, "legs"]

    def towards(self, other: StanceTarget, fraction: float) -> StanceTarget:
        """Return the stance at a fraction of the straight path to another.

        Parameters
        ----------
        other : StanceTarget
            The end of the path.
        fraction : float
            0 for this stance, 1 for the other.
        """
        return self._replace(
            posture=self.posture + fraction * (other.posture - self.posture),
            rest=self.rest + fraction * (other.rest - self.rest),
        )

    @property
    def stand(self) -> StanceGeometry:
        """The body and the feet at rest."""
        return stance_geometry_of(self.posture, self.rest)


class Bracket(NamedTuple):
    """Two fractions of a path: one that is feasible, or 0, and a greater one that is not."""

    feasible: float
    infeasible: float

    @classmethod
    def before(cls, infeasible: float) -> Bracket:
        """Return a sample's bracket below a fraction that is not feasible."""
        return cls(max(0.0, infeasible - 1 / _SAMPLES), infeasible)

    def widened(self) -> Bracket:
        """Return the bracket below, for a lower end that turned out not to be feasible; twice as wide."""
        return Bracket(max(0.0, 2 * self.feasible - self.infeasible), self.feasible)

    def halved(self, works: Callable[[float], bool]) -> Bracket:
        """Return the half of the bracket in which feasibility ends.

        Parameters
        ----------
        works : callable
            Whether a fraction is feasible.
        """
        middle = (self.feasible + self.infeasible) / 2
        return Bracket(middle, self.infeasible) if works(middle) else Bracket(self.feasible, middle)


def first_unreachable(robot: Robot, start: StanceTarget, end: StanceTarget) -> float | None:
    """Return the first sample of a path at which a leg does not reach its rest foothold; None where all do.

    Parameters
    ----------
    robot : Robot
        A single robot.
    start, end : StanceTarget
        Both ends of the path.
    """
    fractions = np.arange(1, _SAMPLES + 1) / _SAMPLES
    stances = [start.towards(end, fraction) for fraction in fractions.tolist()]
    fails = (reach_margin(robot, stances) < 0).any(axis=-1)
    return float(fractions[fails.argmax()]) if fails.any() else None


def is_reachable(robot: Robot, stance: StanceTarget) -> bool:
    """Return whether all legs have room about their rest footholds.

    Parameters
    ----------
    robot : Robot
        A single robot.
    stance : StanceTarget
        The stance.
    """
    return bool((rest_margin(robot, stance.stand) >= 0).all())


def is_balanced(check: StabilityCheck, stance: StanceTarget, footholds: Complex[np.ndarray, "legs"]) -> bool:
    """Return whether a stance has stability margin to spare for steps.

    Parameters
    ----------
    check : StabilityCheck
        The check against tipping over.
    stance : StanceTarget
        The stance.
    footholds : complex array, shape (legs,)
        The present rest footholds, whose distances scale the additional margin [m].
    """
    margin = check.least_margin + _STEP_MARGIN * float(np.abs(footholds - np.roll(footholds, 1)).max())
    return check.margin_at_rest(stance.stand) >= margin


def first_increment(robot: Robot, start: StanceTarget, end: StanceTarget, fraction: float) -> float:
    """Return how much of a path one transition can cover: in the present posture the feet must reach their new places.

    Parameters
    ----------
    robot : Robot
        A single robot.
    start, end : StanceTarget
        Both ends of the path.
    fraction : float
        The fraction that is feasible.
    """
    parts = fraction * _SHORTER
    moved = np.abs(end.rest - start.rest).max()
    if moved < _SAME:
        return fraction
    margin = reach_margin(robot, [start._replace(rest=start.towards(end, part).rest) for part in parts.tolist()])
    works = (moved * parts <= _LONGEST_STEP) & (margin >= 0).all(axis=-1)
    return float(parts[works.argmax()] if works.any() else parts[-1])


def reach_margin(robot: Robot, stances: list[StanceTarget]) -> Float[np.ndarray, "n legs"]:
    """Return the margin of each leg at its rest foothold: on the ground, and lifted.

    Parameters
    ----------
    robot : Robot
        A single robot.
    stances : list of StanceTarget
        The stances.

    Returns
    -------
    array, shape (n, legs)
        Negative out of reach.
    """
    rows, rest = np.array([p.posture for p in stances]), np.array([p.rest for p in stances])
    rotation = np.array([rotation_rows(*row) for row in rows[:, 3:SWING_HEIGHT].tolist()])
    swing_height = rows[:, SWING_HEIGHT:]
    stand = StanceGeometry(rest, rotation[:, None], rows[:, :3].T[..., None], 0.0)
    height = np.stack([0 * swing_height, swing_height])
    return np.asarray(joint_margin(robot.geometry, stand.solve(robot, rest.real, rest.imag, height)).min(axis=0))


def reach_cause(robot: Robot, stand: StanceGeometry) -> Cause:
    """Return which leg has no room about its rest foothold, and why.

    Parameters
    ----------
    robot : Robot
        A single robot.
    stand : StanceGeometry
        The body and the rest footholds.
    """
    margin = rest_margin(robot, stand)
    leg = int(margin.argmin())
    knee = bool(rest_margin(robot, stand, knees=False)[leg] >= 0)
    return Cause("the knee touches the ground" if knee else "end of the leg's reach", robot.leg_names[leg])
