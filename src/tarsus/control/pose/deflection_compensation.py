"""Deflection compensation of a live walk: loaded joints are commanded further by what they yield."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from operator import mul
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from tarsus.control.readings import ValidReadings
from tarsus.kinematics.mass import centre_of_mass, known_weight
from tarsus.load.compliant.joint_springs import JointSprings
from tarsus.load.foot_force import balanced_forces
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["DeflectionCompensation"]

# Lever arms of a foot: how far it is outward of and below its knee, then outward of and below its femur axis [m].
_Arms: TypeAlias = tuple[float, float, float, float]
# How fast the softness is learnt, and the share compensated for and the mean lowering of feet follow [1/s].
_LEARNING_RATE = 2.0
# Time between looks at where the feet are, and how soft the joints [s].
_PERIOD = 0.035
# Least sum of squares of the femurs' expected deflections for the softness to be learnt [rad^2].
_LEAST = 1e-5
# Share of the deflection that is added to the commands: not all, as measured forces rise with it.
_SHARE = 0.5
# Friction coefficient that feet are taken to have: where loaded legs need no more, nothing is compensated for.
_FRICTION = 0.8
# How fast the loads follow forces and contacts [1/s]: a foot that lands hard must not be pressed down further.
_LOAD_RATE = 30.0
# Share of the total load from which on a foot counts as bearing load in full; below, it counts in part.
_BEARS = 0.2
# Number of feet in contact from which on they bear the whole weight, where forces are not measured.
_FEWEST = 3


class DeflectionCompensation:
    """Adds to the commands of femur and tibia the angles by which vertical forces on the feet deflect them.

    Loaded legs yield outwards: feet that take over load slide, or press against each other through friction. With the
    deflection under a vertical force added to the commands, little horizontal force is left. The stiffness is that of
    the robot's servos over their softness, which is learnt from the measured angles of the femurs; it is 0 for servos
    that do not yield. Nothing is added where joint angles are not measured, where loads or servos are unknown, or where
    friction holds the feet on the slope under them: compensated legs are stiffer, and lose contact on rough ground.

    The loads come from measured forces; without these, the robot's weight is shared out among feet in contact. Of
    measured forces, only the part that equilibrium requires counts: more than three feet also press against each other,
    and would do so ever more if commands were compensated for those forces, too.

    Parameters
    ----------
    robot : Robot
        A single robot. Without masses in its file, contacts do not tell the loads.

    Attributes
    ----------
    offsets : array, shape (legs, 3), or None
        Angles that are added to the joint angles [rad]; None until compensation begins.
    lowered : float
        Greatest distance by which a foot is commanded lower to compensate, averaged over time [m].
    softness : float
        Measured deflection of the femurs over that expected of the robot's servos under the same forces, 0 to 1.
    """

    def __init__(self, robot: Robot) -> None:
        self.offsets: Float[np.ndarray, "legs 3"] | None = None
        self.lowered = self.softness = self._share = self._needed = 0.0
        # Time since the last look [s]; joint angles, lever arms and feet in B at that look; under a load of 1 N on each
        # foot, how far it sinks [m], and how far the joints of its leg turn [rad].
        self._since, self._joints, self._arms = _PERIOD, list[list[float]](), list[_Arms]()
        self._feet, self._sinks = list[tuple[float, float]](), list[float]()
        self._turns: Float[np.ndarray, "legs 3"] = np.zeros((robot.legs, 3))
        # Loads, following the measured ones [N]; centre of mass in B when it was first needed, as it moves little [m].
        self._loads, self._centre = [0.0] * robot.legs, list[float]()
        self._robot, self._weight, self._legs = robot, known_weight(robot), list[tuple[float, ...]]()
        if all(all(leg) for leg in robot.servos):
            yields, g = (1 / JointSprings.of(robot).stiffness[:, 1:]).T, robot.geometry
            columns = (*robot.mount_position.T[:2], robot.mount_yaw, g.coxa, g.side, g.femur, g.tibia, *yields)
            self._legs = list(zip(*(column.tolist() for column in columns), strict=True))

    def step(
        self, valid: ValidReadings, angles: Float[np.ndarray, "legs 3"], dt: float, *, slope: float, bears: list[bool]
    ) -> None:
        """Follow the loads and learn the softness.

        Parameters
        ----------
        valid : ValidReadings
            The readings.
        angles : array, shape (legs, 3)
            Joint angles that were commanded in the last tick [rad].
        dt, slope : float, float
            Time since the last tick [s]; slope under the feet [m/m].
        bears : list of bool
            Which feet bear load: they share the robot's weight out where forces are not measured.
        """
        if self.offsets is None:
            if valid.joint_angles is None or not self._legs or (valid.forces is None and not self._weight):
                return
            self._needed = self._needed or self._needed_friction(angles)
            if self._needed + slope < _FRICTION:
                return
        self._since += dt
        looks = self._since >= _PERIOD
        if looks:
            self._find_feet(angles.tolist())
        loads = self._balanced_loads(valid, bears, angles, dt)
        if looks:
            wanted = _SHARE if self._needed + slope >= _FRICTION else 0.0
            self._share += min(_LEARNING_RATE * self._since, 1.0) * (wanted - self._share)
            self._learn(valid, loads)
            self._since = 0.0
        share = self._share * self.softness
        self.offsets = np.array(loads)[:, None] * (-share * self._turns)
        lowered = share * max(map(mul, self._sinks, loads))
        self.lowered += min(_LEARNING_RATE * dt, 1.0) * (lowered - self.lowered)

    def _balanced_loads(
        self, valid: ValidReadings, bears: list[bool], angles: Float[np.ndarray, "legs 3"], dt: float
    ) -> tuple[float, ...]:
        """Return the balanced loads of the feet; they follow the measured ones, and return to 0 where these cease [N].

        A leg without joint angles, or without force where other legs have one, bears nothing.
        """
        if valid.forces is None:
            measured = [self._weight / _FEWEST * on for on in bears]
        else:
            measured = [force[2] if force and force[2] > 0.0 else 0.0 for force in valid.forces]
        follows, known = min(_LOAD_RATE * dt, 1.0), valid.joint_angles or (None,) * len(self._loads)
        legs = zip(self._loads, measured, known, strict=True)
        self._loads = loads = [load + follows * ((new if of_leg else 0.0) - load) for load, new, of_leg in legs]
        total = sum(loads)
        if not total:
            return (0.0,) * len(loads)
        full = _BEARS * total
        bear = [load / full if load < full else 1.0 for load in loads]
        if valid.forces is None:
            self._centre = self._centre or centre_of_mass(self._robot, angles)[:2].tolist()
            return balanced_forces(self._feet, bear, self._centre, min(total, self._weight))
        x, y = (sum(map(mul, loads, column)) / total for column in zip(*self._feet, strict=True))
        return balanced_forces(self._feet, bear, (x, y), total)

    def _find_feet(self, joints: list[list[float]]) -> None:
        """Find where the feet are, and how far a load of 1 N on each turns its joints."""
        self._joints, self._feet, self._sinks = joints, [], []
        turns: list[tuple[float, float, float]] = []
        self._arms = [_lever_arms(*leg[5:7], *turns[1:]) for leg, turns in zip(self._legs, joints, strict=True)]
        for leg, (coxa, *_), (to_knee, _, to_hip, _) in zip(self._legs, joints, self._arms, strict=True):
            x, y, yaw, length, side, _, _, femur_yields, tibia_yields = leg
            out = complex(length + to_hip, side) * cmath.rect(1.0, yaw + coxa)
            self._feet.append((x + out.real, y + out.imag))
            turned, bent = femur_yields * to_hip, tibia_yields * to_knee
            self._sinks.append(turned * to_hip + bent * to_knee)
            turns.append((0.0, turned, bent))
        self._turns = np.array(turns)

    def _learn(self, valid: ValidReadings, loads: Sequence[float]) -> None:
        """Learn the softness: how far the femurs have turned, over how far the servos in the robot's file would."""
        product = square = 0.0
        for leg, angles in enumerate(valid.joint_angles or ()):
            force = valid.forces[leg] if valid.forces else None
            if not angles or (valid.forces and not force):
                continue
            (coxa, femur, _), (_, _, to_hip, below_hip) = self._joints[leg], self._arms[leg]
            bends = to_hip * loads[leg]
            if force:
                # Not only the vertical force bends the femur, but the whole one: feet press against each other.
                heading = self._legs[leg][2] + coxa
                out = force[0] * math.cos(heading) + force[1] * math.sin(heading)
                bends = to_hip * force[2] + below_hip * out
            bends *= self._legs[leg][7]
            product, square = product + bends * (angles[1] - femur), square + bends * bends
        if square > _LEAST:
            learnt = self.softness + min(_LEARNING_RATE * self._since, 1.0) * (product / square - self.softness)
            self.softness = min(max(learnt, 0.0), 1.0)

    def _needed_friction(self, commanded: Float[np.ndarray, "legs 3"]) -> float:
        """Return the friction coefficient that keeps all feet in place under vertical loads."""
        needed = 0.0
        legs = zip(self._legs, commanded.tolist(), strict=True)
        for (*_, length, tibia, femur_yields, tibia_yields), (_, femur, bend) in legs:
            to_knee, below_knee, to_hip, below_hip = _lever_arms(length, tibia, femur, bend)
            outward = femur_yields * to_hip * below_hip + tibia_yields * to_knee * below_knee
            needed = max(needed, outward / max(femur_yields * below_hip**2 + tibia_yields * below_knee**2, 1e-12))
        return needed


def _lever_arms(femur: float, tibia: float, turned: float, bent: float) -> _Arms:
    """Return how far a foot is outward of and below its knee, then outward of and below its femur axis [m]."""
    knee = cmath.rect(tibia, turned + bent)
    hip = knee + cmath.rect(femur, turned)
    return knee.real, -knee.imag, hip.real, -hip.imag
