"""Velocity commands, drawn at random within what the robot can walk."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.walk_controller import WalkController
from tarsus.errors import InputError
from tarsus.gait.walk_setup import require_number
from tarsus.representation import represented

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["CommandSampler", "top_speeds"]

Range = tuple[float, float]

# Greatest command, as a fraction of the speed that the robot can sustain in that direction.
_SUSTAINED = 0.95


@represented()
@dataclass(frozen=True, kw_only=True)
class CommandSampler:
    """Draws twists uniformly along each axis; one that is too fast for the robot to sustain is scaled down as a whole.

    Attributes
    ----------
    forward, left, turning : (float, float)
        Ranges as fractions of the robot's top speed along each axis.
    standing : float
        Probability of a command to stand.
    every : float
        Time from one command to the next within an episode [s].
    """

    forward: Range = (-0.8, 0.8)
    left: Range = (-0.8, 0.8)
    turning: Range = (-0.8, 0.8)
    standing: float = 0.1
    every: float = 5.0

    def __post_init__(self) -> None:
        for name in ("forward", "left", "turning"):
            low, high = getattr(self, name)
            if not -1 <= low <= high <= 1:
                raise InputError(f"{name} is ({low:g}, {high:g}); it must be two fractions in [-1, 1], ascending")
        if not 0 <= self.standing <= 1:
            raise InputError(f"standing is {self.standing:g}; it must be in [0, 1]")
        require_number("every", self.every, zero=False)

    def sample(
        self, walk: WalkController, top: Float[np.ndarray, "3"], random: np.random.Generator
    ) -> Float[np.ndarray, "3"]:
        """Return a twist ``(3,)``: forward, left [m/s], turning [rad/s].

        Parameters
        ----------
        walk : WalkController
            Walk controller of the robot that is commanded.
        top : array, shape (3,)
            Its top speed along each axis, from `top_speeds`.
        random : numpy.random.Generator
            The random number generator.
        """
        low, high = np.array([self.forward, self.left, self.turning]).T
        twist: np.ndarray = random.uniform(low, high) * top
        if random.random() < self.standing or not twist.any():
            return np.zeros(3)
        return twist * min(1.0, _SUSTAINED * walk.top_speed(twist.tolist()))


def top_speeds(walk: WalkController) -> Float[np.ndarray, "3"]:
    """Return the top speeds forward, left [m/s] and turning [rad/s] of a robot ``(3,)``.

    Parameters
    ----------
    walk : WalkController
        Walk controller of the robot.
    """
    return np.array([walk.top_speed(axis) for axis in np.eye(3).tolist()])
