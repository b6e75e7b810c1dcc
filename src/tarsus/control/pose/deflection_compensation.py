"""Deflection compensation of a live walk: loaded joints are commanded further by what they yield."""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from tarsus.control.pose.vertical_loads import Bears, VerticalLoads
from tarsus.control.readings import ValidReadings
from tarsus.load.compliant.joint_springs import JointSprings
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["DeflectionCompensation"]

# How far out and below the foot is from the knee, and from the femur axis [m].
_Arms: TypeAlias = tuple[float, float, float, float]
# How fast the softness is learnt [1/s].
_LEARNING_RATE = 2.0
# Sum of squares of the femurs' deflections from which on they tell the softness [rad^2].
_LEAST = 1e-5
# Share of the deflection that is added: measured forces rise with it.
_SHARE = 0.5
# Friction that holds the feet of loaded legs where it needs no more.
_FRICTION = 0.8


class DeflectionCompensation:
    """Adds to the commands of femur and tibia what vertical forces on the feet turn them.

    Legs that yield give way outwards: feet that take over load slide, or press against each other through friction.
    With the deflection for a vertical force in the commands, little horizontal force is left. The stiffness is that of
    the robot's servos over their softness, which is learnt from the measured angles of the femurs: it is 0 for servos
    that do not yield. Nothing is added where joint angles are not measured, loads or servos unknown, nor where
    friction holds the feet on the slope under them: compensated legs are stiffer, and lose contact on rough ground.

    Parameters
    ----------
    robot : Robot
        A single robot.

    Attributes
    ----------
    offsets : array, shape (legs, 3), or None
        What is added to the joint angles [rad]; None as long as that is nothing.
    lowered : float
        How much lower the foot is commanded that bears most, on the average [m].
    softness : float
        Deflection of the femurs over that of the robot's servos under the same forces, 0 to 1.
    """

    def __init__(self, robot: Robot) -> None:
        self.offsets: Float[np.ndarray, "legs 3"] | None = None
        self.lowered = self.softness = self._share = self._needed = 0.0
        self._loads, self._legs = VerticalLoads(robot), list[tuple[float, ...]]()
        if all(all(leg) for leg in robot.servos):
            yields, g = (1 / JointSprings.of(robot).stiffness[:, 1:]).T, robot.geometry
            columns = (*robot.mount_position.T[:2], robot.mount_yaw, g.coxa, g.femur, g.tibia, *yields)
            self._legs = list(zip(*(column.tolist() for column in columns), strict=True))

    def step(
        self, valid: ValidReadings, angles: Float[np.ndarray, "legs 3"], dt: float, *, slope: float, bears: Bears
    ) -> None:
        """Follow the loads and learn the softness.

        Parameters
        ----------
        valid : ValidReadings
            The readings.
        angles : array, shape (legs, 3)
            Joint angles that were commanded in the last tick [rad].
        dt : float
            Time since the last tick [s].
        slope : float
            Slope under the feet [m/m].
        bears : callable
            Which feet bear load: they share the robot's weight out where forces are not measured.
        """
        if self.offsets is None:
            if not (self._loads.are_known(valid) and self._legs):
                return
            self._needed = self._needed or self._needed_friction(angles)
            if self._needed + slope < _FRICTION:
                return
        wanted = _SHARE if self._needed + slope >= _FRICTION else 0.0
        self._share += min(_LEARNING_RATE * dt, 1.0) * (wanted - self._share)
        joints, share = angles.tolist(), self._share * self.softness
        arms = [_lever_arms(*leg[4:6], *turns[1:]) for leg, turns in zip(self._legs, joints, strict=True)]
        loads = self._loads.step(valid, bears, dt, feet=self._feet(joints, arms), joints=joints)
        offsets, lowered, femurs = list[tuple[float, float, float]](), 0.0, list[float]()
        for (*_, femur_yields, tibia_yields), (to_knee, _, to_hip, _), load in zip(
            self._legs, arms, loads, strict=True
        ):
            turned, bent = femur_yields * to_hip * load, tibia_yields * to_knee * load
            lowered = max(lowered, share * (turned * to_hip + bent * to_knee))
            offsets.append((0.0, -share * turned, -share * bent))
            femurs.append(turned)
        self._learn(valid, joints, arms, femurs, dt)
        self.lowered += min(_LEARNING_RATE * dt, 1.0) * (lowered - self.lowered)
        self.offsets = np.array(offsets)

    def _learn(
        self, valid: ValidReadings, joints: list[list[float]], arms: list[_Arms], turned: list[float], dt: float
    ) -> None:
        """Learn the softness: how far the femurs have turned, over how far the servos of the file would be bent."""
        product = square = 0.0
        for leg, angles in enumerate(valid.joint_angles or ()):
            force = valid.forces[leg] if valid.forces else None
            if not angles or (valid.forces and not force):
                continue
            (coxa, femur, _), bends = joints[leg], turned[leg]
            if force:
                # The torque that bends the femur is that of the whole force: feet lean against each other.
                _, _, yaw, _, _, _, femur_yields, _ = self._legs[leg]
                out = force[0] * math.cos(yaw + coxa) + force[1] * math.sin(yaw + coxa)
                bends = femur_yields * (arms[leg][2] * force[2] + arms[leg][3] * out)
            product, square = product + bends * (angles[1] - femur), square + bends * bends
        if square > _LEAST:
            learnt = self.softness + min(_LEARNING_RATE * dt, 1.0) * (product / square - self.softness)
            self.softness = min(max(learnt, 0.0), 1.0)

    def _feet(self, joints: list[list[float]], arms: list[_Arms]) -> list[tuple[float, float]]:
        """Return where the feet are in B, x and y [m]."""
        feet: list[tuple[float, float]] = []
        for (x, y, yaw, length, *_), (coxa, *_), (_, _, to_hip, _) in zip(self._legs, joints, arms, strict=True):
            out = cmath.rect(length + to_hip, yaw + coxa)
            feet.append((x + out.real, y + out.imag))
        return feet

    def _needed_friction(self, commanded: Float[np.ndarray, "legs 3"]) -> float:
        """Return which friction keeps all feet in place under vertical loads: horizontal over vertical force."""
        needed = 0.0
        legs = zip(self._legs, commanded.tolist(), strict=True)
        for (*_, length, tibia, femur_yields, tibia_yields), (_, femur, bend) in legs:
            to_knee, below_knee, to_hip, below_hip = _lever_arms(length, tibia, femur, bend)
            outward = femur_yields * to_hip * below_hip + tibia_yields * to_knee * below_knee
            needed = max(needed, outward / max(femur_yields * below_hip**2 + tibia_yields * below_knee**2, 1e-12))
        return needed


def _lever_arms(femur: float, tibia: float, turned: float, bent: float) -> _Arms:
    """Return how far out and below the foot is from the knee, and from the femur axis [m]."""
    knee = cmath.rect(tibia, turned + bent)
    hip = knee + cmath.rect(femur, turned)
    return knee.real, -knee.imag, hip.real, -hip.imag
