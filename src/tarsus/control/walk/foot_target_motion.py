"""Legs that leave the gait and are moved by hand: each foot goes where it is told, as far as its leg reaches."""

from __future__ import annotations

import cmath
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from tarsus.control.filters import CriticallyDamped
from tarsus.control.walk.state import GaitState
from tarsus.control.workspace.stance_geometry import SWING_HEIGHT, StanceGeometry, joint_margin, rotation_rows
from tarsus.kinematics.polygon import hull_margin
from tarsus.robot.robot import Robot

__all__ = ["FootTargetMotion", "apply_foot_targets", "begin_foot_target", "best_body_shift", "reachable_fraction"]

Floats = np.ndarray[Any, Any]

# How fast a foot follows what it is told [rad/s], and how fast it goes at the most [m/s].
_BANDWIDTH, _SPEED = 5.0, 0.12
_TRIED = np.arange(1, 17) / 16
# Shifts of the body that are tried when legs leave the gait [m].
_STEPS = np.arange(-4, 5) * 0.01
_LEANS = (_STEPS[:, None] + 1j * _STEPS).ravel()


class FootTargetMotion(NamedTuple):
    """A foot that is moved by hand.

    Attributes
    ----------
    position : CriticallyDamped
        Where it is in the heading frame ``(3,)`` [m].
    target : array, shape (3,)
        Where it goes [m].
    """

    position: CriticallyDamped
    target: Floats

    def step(self, dt: float) -> FootTargetMotion:
        """Return the hand after a time.

        Parameters
        ----------
        dt : float
            The time [s].
        """
        way = float(np.abs(self.target - self.position.value).max())
        # A lag whose bandwidth is 2 v over the way that is left comes to the speed v, and goes on at it.
        bandwidth = min(_BANDWIDTH, 2 * _SPEED / max(way, 1e-9))
        return self._replace(position=self.position.step(self.target, dt, bandwidth=bandwidth))

    def stopped(self) -> FootTargetMotion:
        """Return the hand, on its way to rest near where it is."""
        return self._replace(target=self.position.value + 2 * self.position.rate / _BANDWIDTH)


def begin_foot_target(now: GaitState, leg: int) -> FootTargetMotion:
    """Return a leg's foot as a hand, which begins where it stands.

    Parameters
    ----------
    now : Moment
        The moment.
    leg : int
        The leg; its foot is on the ground.
    """
    turn = cmath.exp(-1j * now.yaw)
    seen = (complex(now.foot[leg]) - now.origin) * turn
    vx, vy, wz = now.twist.value.tolist()
    # On the ground, it goes past the body as fast as that walks.
    past = -(complex(vx, vy) + 1j * wz * seen)
    here = np.array([seen.real, seen.imag, float(now.ground_height[leg] - now.elevation.value[0])])
    return FootTargetMotion(
        CriticallyDamped(here, np.array([past.real, past.imag, -float(now.elevation.rate[0])])), here
    )


def apply_foot_targets(now: GaitState, foot_targets: dict[int, FootTargetMotion], swing_time: float) -> GaitState:
    """Return the moment with the hands where they are; one that has been lifted to step is none any more.

    Parameters
    ----------
    now : Moment
        The moment.
    foot_targets : dict of leg to Hand
        The hands.
    swing_time : float
        How long a swing takes [s].
    """
    foot, ground, pace = now.foot.copy(), now.ground_height.copy(), now.swing_velocity.copy()
    turn = cmath.exp(1j * now.yaw)
    vx, vy, wz = now.twist.value.tolist()
    for leg, foot_target in foot_targets.items():
        if not now.down[leg]:
            continue
        x, y, z = foot_target.position.value.tolist()
        dx, dy, _ = foot_target.position.rate.tolist()
        seen = complex(x, y)
        foot[leg], ground[leg] = now.origin + turn * seen, z + float(now.elevation.value[0])
        pace[leg] = turn * (complex(dx, dy) + complex(vx, vy) + 1j * wz * seen) * swing_time
    target = np.where(now.down, foot, now.foothold)
    return now._replace(foot=foot, foothold=target, ground_height=ground, swing_velocity=pace)


def best_body_shift(rest: Floats, centre: complex, sets: Floats) -> complex:
    """Return where to shift the centre of mass so that it is as far inside every support as can be.

    Parameters
    ----------
    rest : complex array, shape (legs,)
        The feet [m].
    centre : complex
        The projected centre of mass [m].
    sets : array of bool, shape (n, legs)
        Feet that are down together.

    Returns
    -------
    complex
        The shift, among those of whole steps in the least that does; 0 where none is better [m].
    """
    feet = np.stack([rest.real, rest.imag], axis=-1)
    away = np.array([[(centre + shift).real, (centre + shift).imag] for shift in _LEANS])
    margins = hull_margin(feet, sets, away[:, None, :]).min(axis=-1)
    # A shift costs reach: of two that are about as good, the smaller.
    return complex(_LEANS[int(np.argmax(margins - np.abs(_LEANS) / 4))])


def reachable_fraction(robot: Robot, postures: Sequence[Floats], leg: int, start: Floats, wished: Floats) -> float:
    """Return how much of the straight way from one point to another a foot can go, in whichever of some postures.

    Parameters
    ----------
    robot : Robot
        A single robot.
    postures : sequence of array, shape (7,)
        How the body may stand: see `tarsus.control.workspace.stance_geometry`.
    leg : int
        The leg.
    start, wished : array, shape (3,)
        In the heading frame [m].
    """
    rows = np.array(postures)
    rotation = np.array([rotation_rows(*row) for row in rows[:, 3:SWING_HEIGHT].tolist()])[:, None, None]
    stand = StanceGeometry(np.zeros(robot.legs, dtype=complex), rotation, rows[:, :3].T[..., None, None], 0.0)
    points = (start + _TRIED[:, None] * (wished - start)).T[..., None] + np.zeros(robot.legs)
    works = (joint_margin(robot.geometry, stand.solve(robot, *points))[..., leg] >= 0).all(axis=0)
    return 1.0 if works.all() else float(_TRIED[int(np.argmin(works))] - _TRIED[0])
