"""Vertical loads of the feet of a live walk: what equilibrium asks for, by measured forces or by contacts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.readings import ValidReadings
from tarsus.kinematics.mass import centre_of_mass, known_weight
from tarsus.load.foot_force import balanced_forces
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["VerticalLoads"]

# How fast the loads follow forces and contacts [1/s]: a foot that lands hard must not be pressed down further.
_RATE = 30.0
# Share of all load from which on a foot bears load in full.
_BEARS = 0.2
# Least number of feet that share the weight by their contacts.
_FEWEST = 3


class VerticalLoads:
    """Shares the load of a robot out among its feet: by the forces on them, else its weight by their contacts.

    Of measured forces only what equilibrium asks for counts: more than three feet press against each other, too, and
    would do so more and more where commands are compensated by them.

    Parameters
    ----------
    robot : Robot
        A single robot. Without masses in its file contacts do not tell its loads.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot, self._loads = robot, [0.0] * robot.legs
        self._weight = known_weight(robot)
        self._centre: list[float] | None = None

    def are_known(self, valid: ValidReadings) -> bool:
        """Return whether loads are known with the joint angles: by measured forces, or by contacts."""
        return valid.joint_angles is not None and (valid.forces is not None or self._weight > 0.0)

    def step(
        self,
        valid: ValidReadings,
        bears: list[bool],
        dt: float,
        *,
        feet: Sequence[Sequence[float]],
        angles: Float[np.ndarray, "legs 3"],
    ) -> tuple[float, ...]:
        """Return the loads of the feet; they follow what is measured, and go back to 0 where it is not any more [N].

        Parameters
        ----------
        valid : ValidReadings
            The readings; a leg without joint angles, or without force where other legs have one, bears nothing.
        bears, dt : list of bool, float
            Which feet bear load: of use where forces are not measured; time since the last tick [s].
        feet : sequence of (x, y)
            The feet in B [m].
        angles : array, shape (legs, 3)
            Joint angles [rad].
        """
        if valid.forces is not None:
            measured = [force[2] if force and force[2] > 0.0 else 0.0 for force in valid.forces]
        else:
            measured = [self._weight / _FEWEST * on for on in bears]
        follows, known = min(_RATE * dt, 1.0), valid.joint_angles or (None,) * len(feet)
        legs = zip(self._loads, measured, known, strict=True)
        self._loads = loads = [load + follows * ((new if of_leg else 0.0) - load) for load, new, of_leg in legs]
        total = sum(loads)
        if not total:
            return (0.0,) * len(feet)
        full = _BEARS * total
        bear = [load / full if load < full else 1.0 for load in loads]
        if valid.forces is None:
            if self._centre is None:
                # As it was when it was first of use: it moves little in B.
                self._centre = centre_of_mass(self._robot, angles)[:2].tolist()
            return balanced_forces(feet, bear, self._centre, min(total, self._weight))
        x = y = 0.0
        for load, foot in zip(loads, feet, strict=True):
            x, y = x + load * foot[0], y + load * foot[1]
        return balanced_forces(feet, bear, (x / total, y / total), total)
