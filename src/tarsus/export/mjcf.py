"""A robot as an MJCF file: MuJoCo's own format."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np

from tarsus.robot.robot import Robot
from tarsus.simulation.engine import mujoco_module
from tarsus.simulation.robot_model import link_name, passive_model
from tarsus.simulation.servos.servo_table import ServoTable
from tarsus.simulation.terrain.protocol import Terrain

__all__ = ["to_mjcf"]


def to_mjcf(robot: Robot, *, terrain: Terrain | None = None, servos: Any = "catalogue") -> str:
    """Return a robot on a terrain as an MJCF document.

    The model is that of `tarsus.simulation.model`, with position actuators in place of the servos of
    `SimulatedPlant`. Their gain is the stiffness of control loop and gears in series, their limits are the stall
    torques. Of the torque-speed line it has only the damping; it has no backlash, dead band or delays. The document
    needs no other file, except for height fields.

    Parameters
    ----------
    robot : Robot
        A single robot with masses.
    terrain : Terrain, optional
        What it stands on; flat ground where left out.
    servos : "catalogue", "ideal", ServoModel or nested sequence of ServoModel
        See `SimulatedPlant`.

    Raises
    ------
    MissingDataError
        If the mass of the body or of a link is unknown; with ``"catalogue"``, also if a servo is.
    InputError
        If the robot is a batch.
    TarsusError
        If MuJoCo is not installed.
    """
    spec, table = passive_model(robot, terrain=terrain, servos=servos), ServoTable.of(robot, servos)
    for leg, joint in itertools.product(range(robot.legs), range(3)):
        name, servo = link_name(robot, leg, joint), table.servos[leg][joint]
        actuator = spec.add_actuator(name=name, target=name, trntype=mujoco_module().mjtTrn.mjTRN_JOINT)
        actuator.set_to_position(kp=servo.stiffness)
        actuator.ctrlrange = np.asarray(robot.limits[leg, joint])
        if math.isfinite(servo.stall_torque):
            actuator.forcerange = (-servo.stall_torque, servo.stall_torque)
    spec.compile()  # only a model that compiles can be written as a document
    return str(spec.to_xml())
