"""The exact motion of the body in a simulation, from which rewards and falls are computed."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tarsus.representation import represented
from tarsus.simulation.simulated_plant import SimulatedPlant

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["BodyMotion"]

# Time constant of the velocity's low-pass filter, as the body sways with every step [s].
_FILTER = 0.25
# Tilt at which a robot counts as fallen [rad].
_FALLEN = math.radians(45)


@represented("velocity", "tilt", "rocking", "travelled")
class BodyMotion:
    """The motion of the body from one step of an environment to the next.

    Parameters
    ----------
    plant : SimulatedPlant
        A started plant.

    Attributes
    ----------
    velocity : array, shape (3,)
        Forward, left [m/s] and turning [rad/s] in the heading frame, low-pass filtered with 0.25 s.
    travelled : array, shape (3,)
        Motion in the last step, in the heading frame at its middle: forward, left [m], turned [rad].
    tilt : float
        Angle between B's z axis and the vertical [rad].
    rocking : float
        Angular speed of the body about its x and y axes [rad/s].
    """

    def __init__(self, plant: SimulatedPlant) -> None:
        self._plant = plant
        self.velocity, self.travelled = np.zeros(3), np.zeros(3)
        self.tilt = self.rocking = 0.0
        self._place = self._read()

    def update(self, dt: float) -> None:
        """Update the motion after a step of the environment.

        Parameters
        ----------
        dt : float
            Duration of the step [s].
        """
        before_x, before_y, before_yaw = self._place
        self._place = x, y, yaw = self._read()
        turned = math.remainder(yaw - before_yaw, math.tau)
        cosine, sine = math.cos(before_yaw + turned / 2), math.sin(before_yaw + turned / 2)
        moved_x, moved_y = x - before_x, y - before_y
        self.travelled = np.array([cosine * moved_x + sine * moved_y, cosine * moved_y - sine * moved_x, turned])
        self.velocity = self.velocity + (self.travelled / dt - self.velocity) * (1 - math.exp(-dt / _FILTER))

    @property
    def fallen(self) -> bool:
        """Whether the body touches the ground, or is tilted by 45 deg and more."""
        return self._plant.body_touches or self.tilt >= _FALLEN

    def _read(self) -> tuple[float, float, float]:
        """Read tilt and rocking; return x, y [m] and yaw [rad] of the body."""
        x, y, _, w, i, j, k = self._plant.mj_data.qpos[:7].tolist()
        self.tilt = math.acos(max(-1.0, min(1.0, 1 - 2 * (i * i + j * j))))
        self.rocking = math.hypot(*self._plant.mj_data.qvel[3:5].tolist())
        return x, y, math.atan2(2 * (w * k + i * j), 1 - 2 * (j * j + k * k))

    def command_error(self, command: Float[np.ndarray, "3"], top: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3"]:
        """Return the filtered velocity less a command, as fractions of the top speeds ``(3,)``.

        Parameters
        ----------
        command : array, shape (3,)
            The commanded twist [m/s, m/s, rad/s].
        top : array, shape (3,)
            Top speed along each axis [m/s, m/s, rad/s].
        """
        error: np.ndarray = (self.velocity - command) / top
        return error
