"""Stance geometry: the pose of the body over the ground and its rest footholds, and the joint margins of its legs.

Points of the ground plane are complex numbers, x + iy in the heading frame: a rotation is a product. A posture is an
array: x, y, z [m], roll, pitch, yaw [rad] of the body in the heading frame, swing height [m], and optionally the six
amplitudes of the sway.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from tarsus.kinematics.triangle import Triangle, solve_triangle, to_leg_frame
from tarsus.robot.geometry import LegGeometry

if TYPE_CHECKING:
    from jaxtyping import Complex, Float

__all__ = [
    "SWING_HEIGHT",
    "Rows",
    "StanceGeometry",
    "joint_margin",
    "rotation_rows",
    "stance_geometry_of",
    "sway_extremes",
    "sway_fraction",
    "with_sway",
]


# Margin kept to every joint limit [rad], and least angle of the knee from straight or folded [rad].
_LIMIT_MARGIN = 0.01
_LEAST_BEND = 0.2


class StanceGeometry(NamedTuple):
    """Body and rest footholds in the heading frame; heights are relative to the ground plane.

    Attributes
    ----------
    rest : complex array, shape (..., legs)
        Rest footholds [m].
    rotation : array, shape (3, 3)
        Rotation of the body in the heading frame.
    position : array, shape (3,)
        Position of the body's origin [m].
    swing_height : float
        Swing height [m].
    """

    rest: Complex[np.ndarray, "*batch legs"]
    rotation: Float[np.ndarray, "... 3 3"]
    position: Float[np.ndarray, "..."]
    swing_height: float

    def solve(
        self,
        geometry: LegGeometry,
        x: Float[np.ndarray, "*#batch"],
        y: Float[np.ndarray, "*#batch"],
        z: Float[np.ndarray, "*#batch"],
    ) -> Triangle:
        """Return the joint angles for feet in the heading frame.

        Parameters
        ----------
        geometry : LegGeometry
            The legs of a single robot.
        x, y, z : array, shape (..., legs), or as the geometry has further axes
            Positions of the feet, z over the ground plane [m].
        """
        g, p = geometry, self.position
        in_leg = to_leg_frame(g, *self.to_body(x - p[0], y - p[1], z - p[2]))
        return solve_triangle(np, g, *in_leg, knee=1, sideways=bool(g.side.any()))

    def to_body(
        self, x: Float[np.ndarray, "*#batch"], y: Float[np.ndarray, "*#batch"], z: Float[np.ndarray, "*#batch"]
    ) -> tuple[Float[np.ndarray, "... legs"], Float[np.ndarray, "... legs"], Float[np.ndarray, "... legs"]]:
        """Return the components in B of vectors in the heading frame.

        Parameters
        ----------
        x, y, z : array, shape (...)
            Components, z relative to the ground plane [m].
        """
        r = self.rotation
        in_x, in_y, in_z = (x * r[..., 0, i] + y * r[..., 1, i] + z * r[..., 2, i] for i in range(3))
        return in_x, in_y, in_z


def joint_margin(geometry: LegGeometry, solution: Triangle) -> Float[np.ndarray, "*batch legs"]:
    """Return the distance of each leg to its nearest bound, negative beyond it.

    Parameters
    ----------
    geometry, solution : LegGeometry, Triangle
        The legs; their joint angles.

    Returns
    -------
    array, shape (..., legs)
        Joint limits and knee bend in [rad]; reach in squared lengths over the square of the longest reach.
    """
    g, s = geometry, solution
    margin = np.minimum(s.coxa - g.coxa_lower, g.coxa_upper - s.coxa)
    margin = np.minimum(margin, np.minimum(s.femur - g.femur_lower, g.femur_upper - s.femur))
    margin = np.minimum(margin, np.minimum(s.tibia - g.tibia_lower, g.tibia_upper - s.tibia)) - _LIMIT_MARGIN
    bend = np.abs(s.tibia)
    margin = np.minimum(margin, np.minimum(bend, np.pi - bend) - _LEAST_BEND)
    across = np.minimum(np.minimum(s.far, s.near), s.beside) / g.farthest2
    return np.asarray(np.minimum(margin, across))


Rows: TypeAlias = tuple[tuple[float, ...], ...]

SWING_HEIGHT = 6
"""Index of the swing height in a posture."""

# Axes that sway with the beats; the others sway with the cycles.
_AXES_WITH_BEATS = np.array([1, 0, 1, 0, 1, 0])

# Greatest acceleration of the feet relative to the body due to its sway [m/s^2], and their lever arm for rotations [m].
_SWAY_ACCELERATION, _ARM = 1.5, 0.3


def rotation_rows(roll: float, pitch: float, yaw: float) -> Rows:
    """Return the rows of ``Rz(yaw) Ry(pitch) Rx(roll)``."""
    a, b, c = math.cos(yaw), math.cos(pitch), math.cos(roll)
    d, e, f = math.sin(yaw), math.sin(pitch), math.sin(roll)
    return (
        (a * b, a * e * f - d * c, a * e * c + d * f),
        (d * b, d * e * f + a * c, d * e * c - a * f),
        (-e, b * f, b * c),
    )


def stance_geometry_of(posture: Float[np.ndarray, "_"], rest: Complex[np.ndarray, "legs"]) -> StanceGeometry:
    """Return the stance geometry of a posture.

    Parameters
    ----------
    posture : array, shape (7,) or more
        The posture; its sway is ignored.
    rest : complex array, shape (legs,)
        Rest footholds in the heading frame [m].
    """
    roll, pitch, yaw, swing_height = posture[3 : SWING_HEIGHT + 1].tolist()
    return StanceGeometry(rest, np.array(rotation_rows(roll, pitch, yaw)), posture[:3], swing_height)


def with_sway(posture: Float[np.ndarray, "_"], cycles: float, beats: float) -> Float[np.ndarray, "7"]:
    """Return the posture with the sway's displacement added.

    x, z and pitch oscillate once per beat (the lift-off of a set of legs); y, roll and yaw once per gait cycle. Their
    phase relative to the steps is not defined.

    Parameters
    ----------
    posture : array, shape (13,)
        Posture and amplitudes of the sway.
    cycles, beats : float
        Number of gait cycles and beats walked.

    Returns
    -------
    array, shape (7,)
        The posture.
    """
    amplitude = posture[SWING_HEIGHT + 1 :]
    if not any(amplitude.tolist()):
        return posture[: SWING_HEIGHT + 1]
    per_cycle, per_beat = math.sin(2 * math.pi * cycles), math.sin(2 * math.pi * beats)
    swayed: np.ndarray = posture[: SWING_HEIGHT + 1].copy()
    swayed[:SWING_HEIGHT] += amplitude * np.array([per_beat, per_cycle, per_beat, per_cycle, per_beat, per_cycle])
    return swayed


def sway_extremes(posture: Float[np.ndarray, "7"], sway: tuple[float, ...]) -> list[Float[np.ndarray, "7"]]:
    """Return the postures at the extremes of a sway; the last one is that in the middle.

    Parameters
    ----------
    posture : array, shape (7,)
        The posture in the middle.
    sway : tuple of float
        Amplitudes: x, y, z [m], roll, pitch, yaw [rad].
    """
    if not any(sway):
        return [posture]
    # Half of the axes sway with the beats, half with the cycles: their extremes meet in any combination.
    beats, cycles = (np.append(np.array(sway) * axes, 0.0) for axes in (_AXES_WITH_BEATS, 1 - _AXES_WITH_BEATS))
    return [*(posture + a * beats + b * cycles for a in (1, -1) for b in (1, -1)), posture]


def sway_fraction(sway: Float[np.ndarray, "6"], frequency: float, beats: int) -> float:
    """Return the fraction of a sway that the joints can follow while walking.

    Parameters
    ----------
    sway : array, shape (6,)
        Amplitudes: x, y, z [m], roll, pitch, yaw [rad].
    frequency, beats : float, int
        Gait cycles per second [1/s]; number of beats per gait cycle.
    """
    square = (2 * math.pi * frequency) ** 2
    rates = np.array([beats**2, 1, beats**2, 1, beats**2, 1]) * square
    arms = np.array([1.0, 1.0, 1.0, _ARM, _ARM, _ARM])
    acceleration = float((np.abs(sway) * rates * arms).sum())
    return min(1.0, _SWAY_ACCELERATION / max(acceleration, 1e-12))
