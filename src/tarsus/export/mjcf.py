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
    `SimulatedPlant`: of their stiffness, that of control loop and gears in series, within their stall torques.
    Backlash, dead band, delays and the torque-speed line beyond its damping are not in it. The document needs no other
    file, except for height fields.

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
        If the mass of the body or of a link is unknown, or a servo for ``"catalogue"``.
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
    spec.compile()  # a document can only be written of a model that compiles
    return str(spec.to_xml())
