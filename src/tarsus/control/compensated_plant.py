"""A plant that adds to its commands what the loaded joints deflect, tick by tick."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import read_only
from tarsus.control.control_output import ControlOutput
from tarsus.control.filters import CriticallyDamped
from tarsus.control.plant import Plant
from tarsus.control.readings import SensorReadings
from tarsus.load.compliant.joint_springs import JointSprings
from tarsus.load.deflection import SHARE, checked_share, commands_within_limits
from tarsus.load.payload import Payload
from tarsus.load.torque import joint_torques
from tarsus.representation import represented

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["CompensatedPlant"]

# Bandwidth with which the compensation follows the load [rad/s]: a foot takes over its load within about 80 ms.
_BANDWIDTH = 40.0


@represented("plant", "share")
class CompensatedPlant:
    """Executes commands on another plant, with the expected deflection of the loaded joints added to them.

    The joint loads follow from vertical forces on the standing feet, for the pose and the contacts that the controller
    gives out; where the belly bears the robot, from the legs' own weight alone. Commands stay within the joint limits.
    Real and simulated servos yield under load: without compensation the body sags, swinging feet touch the ground
    early, and the walk is shorter than commanded.

    Parameters
    ----------
    plant : Plant
        The plant that executes the commands: a simulated robot, or servos.
    springs : JointSprings, optional
        Elasticity of the joints; by default that of the robot's servos.
    share : float
        Share of the deflection that is compensated for, 0 to 1.
    payload : Payload or float
        Payload on the body; a number is a mass at the body's origin [kg].

    Attributes
    ----------
    robot : Robot
        The plant's robot.
    plant : Plant
        The plant that executes the commands.
    share : float
        Share of the deflection that is compensated for.

    Raises
    ------
    MissingDataError
        If masses of the robot are unknown, or a servo is unknown and `springs` is left out.
    InputError
        If the share is not between 0 and 1.

    See Also
    --------
    tarsus.compensate_deflection : The same for a planned walk.
    """

    def __init__(
        self, plant: Plant, *, springs: JointSprings | None = None, share: float = SHARE, payload: Payload | float = 0.0
    ) -> None:
        self.robot, self.plant, self.share = plant.robot, plant, checked_share(share)
        self.robot.require_masses()
        springs = JointSprings.of(self.robot) if springs is None else springs
        self._compliance, self._payload = self.share / springs.stiffness.ravel(), payload
        self._offset = CriticallyDamped.still(np.zeros(3 * self.robot.legs))

    def start(self, output: ControlOutput) -> None:
        """Start the plant, with the deflection in the initial pose compensated for.

        Parameters
        ----------
        output : ControlOutput
            What the controller starts with.
        """
        self._offset = CriticallyDamped.still(self._deflection(output))
        self.plant.start(self._compensated(output))

    def step(self, output: ControlOutput, dt: float) -> SensorReadings:
        """Execute compensated joint angles for one tick, and return what the plant measures.

        Parameters
        ----------
        output, dt : ControlOutput, float
            What the controller gave out; duration of the tick [s].

        Returns
        -------
        SensorReadings
            What is measured at the end of the tick.
        """
        self._offset = self._offset.step(self._deflection(output), dt, bandwidth=_BANDWIDTH)
        return self.plant.step(self._compensated(output), dt)

    def stop(self) -> None:
        """Stop the plant."""
        self.plant.stop()

    def _deflection(self, output: ControlOutput) -> Float[np.ndarray, "_"]:
        unloaded = output.belly or not output.contacts.any()
        forces = np.zeros_like(output.feet) if unloaded else None
        torques, _ = joint_torques(
            self.robot, output.angles, output.body, output.contacts, self._payload, forces=forces
        )
        return np.asarray(torques).ravel() * self._compliance

    def _compensated(self, output: ControlOutput) -> ControlOutput:
        angles = commands_within_limits(self.robot, output.angles, self._offset.value.reshape(-1, 3))
        return dataclasses.replace(output, angles=read_only(angles))
