"""Leg odometry: how far the body is behind its commanded place, from the measured angles of the standing legs."""

from __future__ import annotations

import cmath
from collections.abc import Sequence
from typing import NamedTuple

from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.readings import ValidReadings, Vector
from tarsus.gait.stance.stance_geometry import rotation_rows
from tarsus.kinematics.scalar_solver import ScalarSolver
from tarsus.robot.robot import Robot

__all__ = ["CommandedMotion", "LegOdometry"]

# Gain from lost way to the speed that makes up for it [1/s]; greatest value of that speed, over the commanded one.
_GAIN, _MOST = 1.5, 0.25
# Greatest lost way that is kept, as the time that it takes at the commanded speed [s]; more is given up.
_MEMORY = 0.3
# Speed above which a sliding foot slips [m/s], and the cause that is then reported.
_SLIPS, _CAUSE = 0.03, "the foot slips"
# Time over which slip is averaged [s]; fewest standing feet among which slip can be told.
_SLIP_TIME, _LEAST_FEET = 0.2, 3


class CommandedMotion(NamedTuple):
    """How the body was to move over its standing feet since the last look, in the heading frame.

    Attributes
    ----------
    velocity : complex
        Velocity of the walk [m/s].
    moved, turned : complex, float
        Displacement of the body, that of its pose and sway included [m]; angle by which the heading frame turns [rad].
    yaw : float
        Yaw of the body in the heading frame [rad].
    """

    velocity: complex
    moved: complex
    turned: float
    yaw: float


class LegOdometry:
    """Compares the body's commanded motion with its motion over the standing feet, from measured joint angles.

    Legs yield when load shifts to them; uphill and downhill, they always do so to the same side. Without a correction,
    the robot covers less or more of its way than commanded: the difference is the lost way.

    Parameters
    ----------
    robot : Robot
        A single robot.

    Attributes
    ----------
    behind : complex
        Lost way: from where the body is to where it should be, in the heading frame [m].
    slip : list of float
        Speed at which each standing foot slides, relative to the others [m/s].
    """

    def __init__(self, robot: Robot) -> None:
        self._names, self._solver = robot.leg_names, ScalarSolver(robot)
        self._mounts = list(zip(robot.mount_yaw.tolist(), robot.foot_radius.tolist(), strict=True))
        self.forget()

    @property
    def limitations(self) -> list[Limitation]:
        """The foot that slips most, if any does."""
        slip = max(self.slip)
        kind, name = LimitationKind.GROUND, self._names[self.slip.index(slip)]
        return [Limitation(kind=kind, cause=_CAUSE, leg=name, granted=slip, bound=_SLIPS)] if slip > _SLIPS else []

    def forget(self) -> None:
        """Forget the lost way, where the feet were, and their slip, as for a robot that is carried."""
        self.behind, self.slip, self._slides = 0j, [0.0] * len(self._mounts), [0j] * len(self._mounts)
        # Where the feet that bore load were [m], and the inclination of their tibiae [rad].
        self._before = dict[int, tuple[complex, float]]()

    def step(self, valid: ValidReadings, bears: Sequence[int], commanded: CommandedMotion, dt: float) -> complex:
        """Return the velocity that makes up for lost way, in the heading frame [m/s].

        Parameters
        ----------
        valid : ValidReadings
            The readings; without the joint angles of all legs nothing is corrected.
        bears : sequence of int
            Legs whose feet bear load.
        commanded, dt : CommandedMotion, float
            How the body was to move; time since the last look [s].
        """
        measured = [each for each in valid.joint_angles or () if each is not None]
        if len(measured) < len(self._mounts):
            self.forget()
            return 0j
        yaw, speed = commanded.yaw, abs(commanded.velocity)
        rotation = rotation_rows(*(valid.attitude or (0.0, 0.0)), yaw)
        feet = [complex(x, y) for x, y, _ in self._solver.feet(measured, rotation)]
        before, self._before, over_feet, places = self._before, {}, dict[int, complex](), 0j
        for leg in bears:
            (mount_yaw, radius), (coxa, femur, tibia) = self._mounts[leg], measured[leg]
            direction = cmath.rect(1.0, mount_yaw + coxa)
            rise = rotation[2][0] * direction.real + rotation[2][1] * direction.imag
            self._before[leg] = feet[leg], femur + tibia + rise
            if leg in before:
                # As a foot's ball rolls, its centre moves along with the body.
                then, was = before[leg]
                rolled = radius * (was - self._before[leg][1]) * direction * cmath.exp(1j * yaw)
                over_feet[leg] = then - feet[leg] + rolled
                places += (then + feet[leg]) / 2
        if over_feet:
            moved = sum(over_feet.values()) / len(over_feet)
            self._note_slip(feet, {leg: over - moved for leg, over in over_feet.items()}, dt)
            # Where the middle of the feet is beside the body's origin, the body's turn displaces it.
            passed = 1j * commanded.turned * places / len(over_feet)
            self.behind = _at_most(self.behind + (commanded.moved + passed - moved), speed * _MEMORY)
        return _at_most(_GAIN * self.behind, _MOST * speed)

    def feet_off_commanded(self, legs: list[int], valid: ValidReadings, commanded: list[Vector]) -> dict[int, Vector]:
        """Return how far the feet of legs are from where they are commanded, as far as their angles are measured.

        Parameters
        ----------
        legs, valid : list of int, ValidReadings
            The legs; the readings.
        commanded : list of (coxa, femur, tibia)
            Commanded joint angles of each leg [rad].

        Returns
        -------
        dict of int to (x, y, z)
            Measured less commanded position of the foot by leg, in the body's frame [m].
        """
        measured = valid.joint_angles
        if not (legs and measured):
            return {}
        found = self._solver.feet([each or asked for each, asked in zip(measured, commanded, strict=True)])
        feet = zip(found, self._solver.feet(commanded), strict=True)
        off = [(x - wanted_x, y - wanted_y, z - wanted_z) for (x, y, z), (wanted_x, wanted_y, wanted_z) in feet]
        return {leg: off[leg] for leg in legs if measured[leg] is not None}

    def _note_slip(self, feet: list[complex], moved: dict[int, complex], dt: float) -> None:
        """Update each foot's slip: how its motion differs from that of a body that turns over all feet."""
        slides, share = [0j] * len(self.slip), min(dt / _SLIP_TIME, 1.0)
        if len(moved) >= _LEAST_FEET:
            middle = sum(feet[leg] for leg in moved) / len(moved)
            places = {leg: feet[leg] - middle for leg in moved}
            turned = sum((place.conjugate() * moved[leg]).imag for leg, place in places.items())
            turned /= sum(abs(place) ** 2 for place in places.values())
            for leg, place in places.items():
                slides[leg] = (moved[leg] - 1j * turned * place) / dt
        # Averaging cancels the noise of joint angles, which changes sign.
        self._slides = [mean + share * (now - mean) for mean, now in zip(self._slides, slides, strict=True)]
        self.slip = [abs(mean) for mean in self._slides]


def _at_most(vector: complex, length: float) -> complex:
    """Return a vector, shortened to a length if it is longer."""
    return vector * min(1.0, length / max(abs(vector), 1e-12))
