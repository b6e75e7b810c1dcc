"""Leg odometry: how far the body is behind where it is commanded to be, by the measured angles of the standing legs."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.readings import Vector
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Complex, Float

__all__ = ["LegOdometry"]

# Speed that makes up for what is missing, over that [1/s], and its greatest share of the commanded speed.
_GAIN, _MOST = 1.5, 0.25
# What is missing for longer than this speed lasts is given up [s].
_MEMORY = 0.3
# A foot that slides faster slips [m/s].
_SLIPS, _CAUSE = 0.03, "the foot slips"
# Time over which slip is averaged [s], and the fewest feet of which some may slip against others.
_SLIP_TIME, _LEAST_FEET = 0.2, 3


class LegOdometry:
    """Compares the commanded motion of the body with that over the feet that stand, by their measured joint angles.

    Legs give way when load shifts to them, uphill and downhill always to the same side: without a correction the robot
    covers less or more of the way than commanded.

    Parameters
    ----------
    robot : Robot
        A single robot.

    Attributes
    ----------
    behind : complex
        Where the body should be, as seen from where it is, in the heading frame [m].
    slip : array, shape (legs,)
        How fast each standing foot slides, as far as it differs from the others [m/s].
    """

    def __init__(self, robot: Robot) -> None:
        self.behind, self.slip = 0j, np.zeros(robot.legs)
        self._names = robot.leg_names
        self._g = robot.geometry
        self._radius = np.asarray(robot.foot_radius, dtype=float)
        self._before: tuple[Complex[np.ndarray, "legs"], Float[np.ndarray, "legs"]] | None = None
        self._stood: list[bool] = []

    @property
    def limitations(self) -> list[Limitation]:
        """The foot that slips most, if any does."""
        leg, slip = int(self.slip.argmax()), float(self.slip.max())
        kind, name = LimitationKind.GROUND, self._names[leg]
        return [Limitation(kind=kind, cause=_CAUSE, leg=name, granted=slip, bound=_SLIPS)] if slip > _SLIPS else []

    def step(
        self,
        angles: Sequence[Vector | None] | None,
        stands: list[bool],
        velocity: complex,
        dt: float,
        *,
        tilt: tuple[float, float],
        yaw: float,
    ) -> complex:
        """Return the velocity that makes up for what is missing, in the heading frame [m/s].

        Parameters
        ----------
        angles : sequence of ((coxa, femur, tibia) or None), or None
            Measured joint angles [rad]; without all of them nothing is corrected.
        stands : list of bool
            Which feet bear load.
        velocity : complex
            Commanded velocity of the body in the heading frame [m/s].
        dt : float
            Time since the last tick [s].
        tilt : (roll, pitch)
            Of the body against gravity [rad].
        yaw : float
            Of the body in the heading frame [rad].
        """
        if angles is None or None in angles:
            self.behind, self._before = 0j, None
            return 0j
        measured, turn = np.array(angles), cmath.exp(1j * yaw)
        feet, legs = self._feet(measured, *tilt) * turn, self._directions(measured)
        inclinations = self._inclinations(measured, legs, *tilt)
        both = [now and then for now, then in zip(stands, self._stood, strict=False)]
        if self._before is not None and any(both):
            # The centre of a ball moves with the body as the ball rolls.
            rolled = self._radius * (self._before[1] - inclinations) * legs * turn
            over_feet = rolled - (feet - self._before[0])
            moved = complex(over_feet[both].mean())
            self._note_slip(feet, over_feet - moved, np.array(both), dt)
            most = abs(velocity) * _MEMORY
            self.behind += velocity * dt - moved
            self.behind *= min(1.0, most / max(abs(self.behind), 1e-12))
        self._before, self._stood = (feet, inclinations), stands
        wanted, most = _GAIN * self.behind, _MOST * abs(velocity)
        return wanted * min(1.0, most / max(abs(wanted), 1e-12))

    def _note_slip(
        self,
        feet: Complex[np.ndarray, "legs"],
        moved: Complex[np.ndarray, "legs"],
        stand: Bool[np.ndarray, "legs"],
        dt: float,
    ) -> None:
        """Take note of what the motion over each foot differs by from that of a body that turns over all of them."""
        speeds, share = np.zeros(len(feet)), min(dt / _SLIP_TIME, 1.0)
        if stand.sum() >= _LEAST_FEET:
            places = feet - feet[stand].mean()
            turned = (places.conj() * moved)[stand].imag.sum() / np.square(np.abs(places[stand])).sum()
            speeds[stand] = np.abs(moved - 1j * turned * places)[stand] / dt
        self.slip = self.slip + share * (speeds - self.slip)

    def _directions(self, angles: Float[np.ndarray, "legs 3"]) -> Complex[np.ndarray, "legs"]:
        """Return the directions of the legs in B, x + iy."""
        found: np.ndarray = np.exp(1j * angles[:, 0]) * (self._g.cos_yaw + 1j * self._g.sin_yaw)
        return found

    @staticmethod
    def _inclinations(
        angles: Float[np.ndarray, "legs 3"], legs: Complex[np.ndarray, "legs"], roll: float, pitch: float
    ) -> Float[np.ndarray, "legs"]:
        """Return the inclinations of the tibiae over the ground, upwards [rad]."""
        rise = legs.imag * (math.cos(pitch) * math.sin(roll)) - legs.real * math.sin(pitch)
        return np.asarray(angles[:, 1] + angles[:, 2] + rise)

    def _feet(self, angles: Float[np.ndarray, "legs 3"], roll: float, pitch: float) -> Complex[np.ndarray, "legs"]:
        """Return the horizontal positions of the feet from the body, x + iy in axes with its yaw [m]."""
        g = self._g
        reach = g.coxa + g.femur * np.cos(angles[:, 1]) + g.tibia * np.cos(angles[:, 1] + angles[:, 2])
        down = g.femur * np.sin(angles[:, 1]) + g.tibia * np.sin(angles[:, 1] + angles[:, 2]) + g.mount_z + g.up
        out = (reach + 1j * g.side) * self._directions(angles)
        x, y = g.mount_x + out.real, g.mount_y + out.imag
        across = y * math.cos(roll) - down * math.sin(roll)
        up = y * math.sin(roll) + down * math.cos(roll)
        found: np.ndarray = x * math.cos(pitch) + up * math.sin(pitch) + 1j * across
        return found
