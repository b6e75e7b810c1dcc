"""Observations: what a real robot with the sensors would know, as one vector."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.control.readings import SensorReadings

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["BOUND", "Observer"]

BOUND = 10.0
"""Observations are within plus and minus this."""

# Divisors for the values of each channel, which bring them to a size of about 1
# [rad, rad/s, A, N m, 1, N, rad, rad/s].
_SCALES = {
    "joint_angles": 0.5,
    "joint_speeds": 5.0,
    "currents": 1.0,
    "torques": 1.0,
    "contacts": 1.0,
    "forces": 10.0,
    "attitude": 0.2,
    "angular_rates": 1.0,
}


class Observer:
    """Puts observations together.

    They are, in this order: the command over the top speeds (3); what the sensor suite measures, channel by channel;
    the last joint targets (3 a leg); with residual actions the joint angles of the walk controller (3 a leg) and
    which feet it has on the ground (1 a leg); with joint actions sine and cosine of a clock (2). Joint angles are
    relative to standing.

    Parameters
    ----------
    standing : array, shape (legs, 3)
        Joint angles of standing [rad].
    top : array, shape (3,)
        Top speed along each axis [m/s, m/s, rad/s].
    first : SensorReadings
        Readings with all the channels that are measured.
    residual : bool
        Whether actions are residuals.

    Attributes
    ----------
    layout : dict of str to slice
        Where each part is in the vector.
    size : int
        Length of the vector.
    """

    def __init__(
        self,
        standing: Float[np.ndarray, "legs 3"],
        top: Float[np.ndarray, "3"],
        first: SensorReadings,
        *,
        residual: bool,
    ) -> None:
        self._standing, self._top = standing, top
        self._channels = tuple(
            (name, standing if name == "joint_angles" else 0.0, scale)
            for name, scale in _SCALES.items()
            if getattr(first, name) is not None
        )
        sizes = {"command": 3, **{name: np.size(getattr(first, name)) for name, _, _ in self._channels}}
        sizes |= {"targets": standing.size}
        sizes |= {"walk_angles": standing.size, "walk_contacts": len(standing)} if residual else {"clock": 2}
        self.layout, self.size = dict[str, slice](), 0
        for name, size in sizes.items():
            self.layout[name] = slice(self.size, self.size + size)
            self.size += size

    def vector(
        self,
        command: Float[np.ndarray, "3"],
        readings: SensorReadings,
        targets: Float[np.ndarray, "legs 3"],
        *walk: Any,
    ) -> Float[np.ndarray, "size"]:
        """Return an observation, ``(size,)``, of 32-bit floats.

        Parameters
        ----------
        command : array, shape (3,)
            The command [m/s, m/s, rad/s].
        readings : SensorReadings
            What is measured.
        targets : array, shape (legs, 3)
            The last joint targets [rad].
        walk
            Joint angles and contacts of the walk controller, or the clock's phase in [0, 1).
        """
        scale = _SCALES["joint_angles"]
        parts = [command / self._top]
        parts += [((getattr(readings, name) - zero) / unit).ravel() for name, zero, unit in self._channels]
        parts.append(((targets - self._standing) / scale).ravel())
        if len(walk) == 1:
            angle = math.tau * walk[0]
            parts.append(np.array([math.sin(angle), math.cos(angle)]))
        else:
            parts += [((walk[0] - self._standing) / scale).ravel(), walk[1]]
        vector: np.ndarray = np.minimum(np.maximum(np.concatenate(parts), -BOUND), BOUND).astype(np.float32)
        return vector
