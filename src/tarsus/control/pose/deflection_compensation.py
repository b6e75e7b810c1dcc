"""Deflection compensation of a live walk: loaded joints are commanded further by what they yield."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.readings import ValidReadings, Vector
from tarsus.load.compliant.joint_springs import JointSprings
from tarsus.load.foot_force import balanced_forces
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["DeflectionCompensation"]

# How fast the compensation follows the load, and how fast the softness is learnt [1/s]: a foot that lands hard must not
# be pressed down further.
_LOAD_RATE, _LEARNING_RATE = 30.0, 2.0
# Sum of squares of the femurs' deflections from which on they tell the softness [rad^2].
_LEAST = 1e-5
# Share of the deflection that is added: measured forces rise with it.
_SHARE = 0.5
# Share of all load from which on a foot bears load in full.
_BEARS = 0.2
# Friction that holds the feet of loaded legs where it needs no more.
_FRICTION = 0.8


class DeflectionCompensation:
    """Adds to the commands of femur and tibia what vertical forces on the feet turn them.

    Legs that yield give way outwards: feet that take over load slide, or press against each other through friction.
    With the deflection for a vertical force in the commands, little horizontal force is left. Of the measured forces
    only what equilibrium asks for counts: more than three feet press against each other, too, and would do so more and
    more as the foot that bears most is pressed further down. The stiffness is that of
    the robot's servos over their softness, which is learnt from the measured angles of the femurs: it is 0 for servos
    that do not yield. Nothing is added where forces or joint angles are not measured or servos unknown, nor where
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
        self._loads, self._legs = [0.0] * robot.legs, list[tuple[float, ...]]()
        if all(all(leg) for leg in robot.servos):
            yields, g = (1 / JointSprings.of(robot).stiffness[:, 1:]).T, robot.geometry
            columns = (*robot.mount_position.T[:2], robot.mount_yaw, g.coxa, g.femur, g.tibia, *yields)
            self._legs = list(zip(*(column.tolist() for column in columns), strict=True))

    def step(self, valid: ValidReadings, commanded: Float[np.ndarray, "legs 3"], dt: float, *, slope: float) -> None:
        """Follow the loads and learn the softness.

        Parameters
        ----------
        valid : ValidReadings
            The readings.
        commanded : array, shape (legs, 3)
            Joint angles that were commanded in the last tick [rad].
        dt : float
            Time since the last tick [s].
        slope : float
            Slope under the feet [m/m].
        """
        unknown = (None,) * len(self._loads)
        if self.offsets is None:
            if valid.forces is None or valid.joint_angles is None or not self._legs:
                return
            self._needed = self._needed or self._needed_friction(commanded)
            if self._needed + slope < _FRICTION:
                return
        wanted = _SHARE if self._needed + slope >= _FRICTION else 0.0
        self._share += min(_LEARNING_RATE * dt, 1.0) * (wanted - self._share)
        forces, measured = valid.forces or unknown, valid.joint_angles or unknown
        product, square, lowered, share = 0.0, 0.0, 0.0, self._share * self.softness
        offsets: list[tuple[float, float, float]] = []
        joints = commanded.tolist()
        known = [force if angles else None for force, angles in zip(forces, measured, strict=True)]
        arms = [_lever_arms(*leg[4:6], *turns[1:]) for leg, turns in zip(self._legs, joints, strict=True)]
        loads = self._balanced_loads(known, joints, [to_hip for _, _, to_hip, _ in arms], dt)
        for leg, (_, _, yaw, _, _, _, femur_yields, tibia_yields) in enumerate(self._legs):
            force, angles, load, (coxa, femur, _) = known[leg], measured[leg], loads[leg], joints[leg]
            to_knee, _, to_hip, below_hip = arms[leg]
            turned, bent = femur_yields * to_hip * load, tibia_yields * to_knee * load
            if force and angles:
                # The torque that bends the femur is that of the whole force: feet lean against each other.
                out = force[0] * math.cos(yaw + coxa) + force[1] * math.sin(yaw + coxa)
                bends = femur_yields * (to_hip * force[2] + below_hip * out)
                product, square = product + bends * (angles[1] - femur), square + bends * bends
            lowered = max(lowered, share * (turned * to_hip + bent * to_knee))
            offsets.append((0.0, -share * turned, -share * bent))
        if square > _LEAST:
            learnt = self.softness + min(_LEARNING_RATE * dt, 1.0) * (product / square - self.softness)
            self.softness = min(max(learnt, 0.0), 1.0)
        self.lowered += min(_LEARNING_RATE * dt, 1.0) * (lowered - self.lowered)
        self.offsets = np.array(offsets)

    def _balanced_loads(
        self, forces: Sequence[Vector | None], joints: list[list[float]], reaches: list[float], dt: float
    ) -> tuple[float, ...]:
        """Return the loads of the feet, as far as equilibrium asks for them; they follow the measured forces."""
        follows = min(_LOAD_RATE * dt, 1.0)
        feet: list[tuple[float, float]] = []
        for leg, (force, (coxa, *_), to_hip) in enumerate(zip(forces, joints, reaches, strict=True)):
            x, y, yaw, length = self._legs[leg][:4]
            out = length + to_hip
            feet.append((x + out * math.cos(yaw + coxa), y + out * math.sin(yaw + coxa)))
            self._loads[leg] += follows * ((max(force[2], 0.0) if force else 0.0) - self._loads[leg])
        total = sum(self._loads)
        if not total:
            return (0.0,) * len(feet)
        bear = [min(load / (_BEARS * total), 1.0) for load in self._loads]
        loaded = list(zip(self._loads, feet, strict=True))
        centre = [sum(load * foot[axis] for load, foot in loaded) / total for axis in (0, 1)]
        return balanced_forces(feet, bear, centre, total)

    def _needed_friction(self, commanded: Float[np.ndarray, "legs 3"]) -> float:
        """Return which friction keeps all feet in place under vertical loads: horizontal over vertical force."""
        needed = 0.0
        legs = zip(self._legs, commanded.tolist(), strict=True)
        for (*_, length, tibia, femur_yields, tibia_yields), (_, femur, bend) in legs:
            to_knee, below_knee, to_hip, below_hip = _lever_arms(length, tibia, femur, bend)
            outward = femur_yields * to_hip * below_hip + tibia_yields * to_knee * below_knee
            needed = max(needed, outward / max(femur_yields * below_hip**2 + tibia_yields * below_knee**2, 1e-12))
        return needed


def _lever_arms(femur: float, tibia: float, turned: float, bent: float) -> tuple[float, float, float, float]:
    """Return how far out and below the foot is from the knee, and from the femur axis [m]."""
    to_knee, below_knee = tibia * math.cos(turned + bent), -tibia * math.sin(turned + bent)
    return to_knee, below_knee, to_knee + femur * math.cos(turned), below_knee - femur * math.sin(turned)
