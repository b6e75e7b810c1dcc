"""Footing: feet and body in the heading frame, and whether feet hold the body."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import NamedTuple

from tarsus.control.readings import RollPitch
from tarsus.control.walk.state import GaitState

__all__ = ["Footing", "along_gravity", "holds", "off_commanded", "sunk_at"]

# Margin of a centre of mass inside the support polygon: it sees neighbouring feet less than pi apart, by this [rad].
_LEAST_ANGLE = 0.02


class Footing(NamedTuple):
    """Feet and body of a walk in a tick, in the heading frame.

    Attributes
    ----------
    places : list of complex
        Where the feet are, x + iy [m].
    down : list of bool
        Which feet should stand.
    centre : complex
        Where the centre of mass is above the feet, along gravity [m].
    height : float
        Commanded height of the body [m].
    """

    places: list[complex]
    down: list[bool]
    centre: complex
    height: float

    def held_by(self, legs: Sequence[int]) -> bool:
        """Return whether the feet of these legs hold the robot."""
        return holds([self.places[leg] for leg in legs], self.centre)


def holds(feet: Sequence[complex], centre: complex) -> bool:
    """Return whether a point is inside the support polygon of feet, by a small margin; x + iy [m]."""
    angles = sorted(cmath.phase(foot - centre) for foot in feet)
    if len(angles) < 3:
        return False
    gaps = [after - before for before, after in zip(angles, [*angles[1:], angles[0] + math.tau], strict=True)]
    return max(gaps) < math.pi - _LEAST_ANGLE


def along_gravity(centre: complex, posture: Sequence[float], tilt: RollPitch) -> complex:
    """Return where a point of the body is above its feet along gravity, x + iy in the heading frame [m].

    Parameters
    ----------
    centre, posture : complex, (x, y, z, roll, pitch, yaw, swing height)
        The point in the body's frame; posture of the body, z over the feet [m], [rad].
    tilt : (roll, pitch)
        By how much the body is tilted more than commanded [rad].
    """
    (x, y, height, _, _, yaw, _), (roll, pitch) = posture, tilt
    return centre * cmath.exp(1j * yaw) + complex(x + height * math.tan(pitch), y - height * math.tan(roll))


def off_commanded(attitude: RollPitch, state: GaitState) -> RollPitch:
    """Return by how much a body is tilted more than commanded, about the axes of the heading frame [rad].

    Parameters
    ----------
    attitude, state : (roll, pitch), GaitState
        Measured roll and pitch, about the body's axes [rad]; the gait state.
    """
    roll, pitch, yaw = state.moved_posture[3:6].tolist()
    off = complex(attitude[0] - roll, attitude[1] - pitch) * cmath.exp(1j * yaw)
    return off.real, off.imag


def sunk_at(place: complex, tilt: RollPitch, before: RollPitch = (0.0, 0.0)) -> float:
    """Return how far a body has sunk at a place by a change of its tilt [m].

    Parameters
    ----------
    place : complex
        The place, x + iy in the heading frame [m].
    tilt, before : (roll, pitch)
        The tilt, and the one before [rad].
    """
    return place.real * (tilt[1] - before[1]) - place.imag * (tilt[0] - before[0])
