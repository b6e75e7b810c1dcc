"""How the body is to be carried: where its posture goes, how fast, and by how much it sways there."""

from __future__ import annotations

from typing import Any

import numpy as np

from tarsus.control.workspace.stance_geometry import SWING_HEIGHT, sway_fraction

__all__ = ["ELEVATION_BANDWIDTH", "PoseController", "elevation_bandwidth"]

Floats = np.ndarray[Any, Any]

# How fast the posture follows [rad/s], and how fast it may move the body at the most [m/s], turn it [rad/s].
_BANDWIDTH = 4.0
_BODY_SPEED, _BODY_TURN = 0.08, 0.5
ELEVATION_BANDWIDTH = _BANDWIDTH
"""How fast the heading frame follows the ground's height [rad/s]."""

# How near the posture counts as reached, and how near its sway [m, rad].
_REACHED, _SWAYS = 2e-4, 1e-3
_NOWHERE = [0.0] * (SWING_HEIGHT + 1)


class PoseController:
    """The posture to go to, and the sway.

    Parameters
    ----------
    posture : array, shape (7,)
        The posture to begin with.

    Attributes
    ----------
    posture : array, shape (7,)
        The posture to go to.
    target : array, shape (13,)
        The same with the sway's amplitudes; the same array for as long as it stays the same.
    """

    def __init__(self, posture: Floats) -> None:
        self.posture = posture
        self.target = np.append(posture, np.zeros(SWING_HEIGHT))

    def set_posture(self, posture: Floats) -> None:
        """Go to another posture.

        Parameters
        ----------
        posture : array, shape (7,)
            The posture.
        """
        self.posture = posture
        self.target = np.append(posture, self.target[SWING_HEIGHT + 1 :])

    def set_sway(self, wished: tuple[float, ...], *, frequency: float, beats: int) -> None:
        """Sway as much as is wished for and slow enough.

        Parameters
        ----------
        wished : tuple of float
            Amplitudes: x, y, z [m], roll, pitch, yaw [rad].
        frequency : float
            Cycles a second [1/s].
        beats : int
            How often in a cycle feet are lifted.
        """
        if not any(wished) and not any(self.target[SWING_HEIGHT + 1 :].tolist()):
            return
        amplitude = np.array(wished)
        if amplitude.any():
            amplitude *= sway_fraction(amplitude, frequency, beats)
        if (self.target[SWING_HEIGHT + 1 :] != amplitude).any():
            self.target = np.append(self.posture, amplitude)

    def is_swaying(self, value: Floats) -> bool:
        """Return whether a posture sways, or is to.

        Parameters
        ----------
        value : array, shape (13,)
            The posture now.
        """
        swaying = any(self.target[SWING_HEIGHT + 1 :].tolist())
        return swaying or (value is not self.target and any(value[SWING_HEIGHT + 1 :].tolist()))

    def reached(self, value: Floats) -> bool:
        """Return whether a posture is the one to go to, and sways as it is to.

        Parameters
        ----------
        value : array, shape (13,)
            The posture now.
        """
        if value is self.target:
            return True
        off: list[float] = np.abs(value - self.target).tolist()
        return max(off[: SWING_HEIGHT + 1]) < _REACHED and max(off[SWING_HEIGHT + 1 :]) < _SWAYS

    def bandwidth(self, value: Floats) -> float:
        """Return how fast the posture is to follow, for the body to be no faster than it may [rad/s].

        Parameters
        ----------
        value : array, shape (13,)
            The posture now.
        """
        left = self._left(value)
        if max(left) < _REACHED:
            return _BANDWIDTH
        far = max(max(left[:3]) / _BODY_SPEED, max(left[3:SWING_HEIGHT]) / _BODY_TURN, left[SWING_HEIGHT] / _BODY_SPEED)
        return _no_faster(far)

    def _left(self, value: Floats) -> list[float]:
        """Return how far there is to go, each of the posture's numbers."""
        if value is self.target:
            return _NOWHERE
        posture, now = self.posture.tolist(), value[: SWING_HEIGHT + 1].tolist()
        return [abs(a - b) for a, b in zip(posture, now, strict=True)]


def elevation_bandwidth(gap: float) -> float:
    """Return how fast the heading frame is to follow the ground, for the body to be no faster than it may [rad/s].

    Parameters
    ----------
    gap : float
        How much higher the ground is [m].
    """
    return _no_faster(abs(gap) / _BODY_SPEED)


def _no_faster(time: float) -> float:
    """Return how fast to follow what is so long away at the greatest speed [rad/s]."""
    # A lag whose bandwidth is 2 v over the way that is left comes to the speed v, and goes on at it.
    return min(_BANDWIDTH, 2 / max(time, 1e-9))
