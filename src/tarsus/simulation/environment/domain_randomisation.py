"""Domain randomisation: robots, servos and ground that differ a little from one episode to the next."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from tarsus.errors import InputError
from tarsus.representation import represented
from tarsus.robot.robot import Robot
from tarsus.simulation.servos.servo_model import ServoModel
from tarsus.simulation.servos.servo_table import ServoTable

__all__ = ["Domain", "DomainRandomisation"]

Range = tuple[float, float]


class Domain(NamedTuple):
    """What an episode is simulated with.

    Attributes
    ----------
    robot : Robot
        The robot.
    servos : tuple of tuple of ServoModel
        Its servos.
    friction : float
        Factor for the ground's coefficient of friction.
    """

    robot: Robot
    servos: tuple[tuple[ServoModel, ...], ...]
    friction: float


@represented()
@dataclass(frozen=True, kw_only=True)
class DomainRandomisation:
    """Ranges of the factors by which an episode's values differ from those of the robot's file and its servos' models.

    Every joint has its own stiffness, torque, backlash and dead band; all have one delay, that of the bus or pulse
    generator. The defaults are as wide as the uncertainty about the servos (`ServoModel.assumed`); those of the torque
    reflect a battery's discharge, those of the mass a payload.

    Attributes
    ----------
    stiffness : (float, float)
        Stiffness of control loop and gears.
    stall_torque : (float, float)
        Stall torque and no-load speed, which vary together, as with the supply voltage.
    backlash : (float, float)
        Backlash and dead band, which vary together.
    delay : (float, float)
        Delay of commands.
    mass : (float, float)
        Mass of the body.
    friction : (float, float)
        Friction of the ground.

    Raises
    ------
    InputError
        If a range is not two positive finite numbers, ascending.
    """

    stiffness: Range = (0.7, 1.4)
    stall_torque: Range = (0.85, 1.05)
    backlash: Range = (0.5, 2.0)
    delay: Range = (0.5, 2.0)
    mass: Range = (0.9, 1.2)
    friction: Range = (0.6, 1.2)

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            low, high = getattr(self, field.name)
            if not 0 < low <= high < math.inf:
                raise InputError(f"{field.name} is ({low:g}, {high:g}); it must be two positive factors, ascending")

    def sample(self, robot: Robot, servos: Any, random: np.random.Generator) -> Domain:
        """Return an episode's robot, servos and friction.

        Parameters
        ----------
        robot : Robot
            The robot.
        servos : "catalogue", "ideal", ServoModel or nested sequence of ServoModel
            Its servos, as for `SimulatedPlant`.
        random : numpy.random.Generator
            The random number generator.
        """
        rows, delay = ServoTable.of(robot, servos).servos, random.uniform(*self.delay)
        varied = tuple(tuple(self._servo(servo, delay, random) for servo in row) for row in rows)
        mass = np.asarray(robot.body_mass) * random.uniform(*self.mass)
        return Domain(robot.replace(body_mass=mass), varied, float(random.uniform(*self.friction)))

    def _servo(self, servo: ServoModel, delay: float, random: np.random.Generator) -> ServoModel:
        stiffness, torque, play = (
            float(random.uniform(*limits)) for limits in (self.stiffness, self.stall_torque, self.backlash)
        )
        return dataclasses.replace(
            servo,
            control_stiffness=stiffness * servo.control_stiffness,
            gear_stiffness=stiffness * servo.gear_stiffness,
            stall_torque=torque * servo.stall_torque,
            no_load_speed=torque * servo.no_load_speed,
            backlash=play * servo.backlash,
            dead_band=play * servo.dead_band,
            delay=delay * servo.delay,
        )
