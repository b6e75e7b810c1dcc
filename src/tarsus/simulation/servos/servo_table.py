"""The servos of all joints, as arrays for the physics steps."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Self

import numpy as np

from tarsus.errors import InputError, MissingDataError, UnknownNameError
from tarsus.robot.robot import JOINTS, Robot
from tarsus.simulation.servos.servo_model import ServoModel

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["ServoTable"]

# Fraction of the greatest torque at its speed from which on a servo counts as saturated.
_ALL = 0.99


class ServoTable(NamedTuple):
    """The servo of every joint; the arrays have one axis for all joints, leg by leg.

    Attributes
    ----------
    servos : tuple of tuple of ServoModel
        ``servos[leg][joint]``.
    stiffness : array, shape (joints,)
        Torque per position error [N m/rad].
    damping : array, shape (joints,)
        All damping of the joints [N m s/rad].
    stall_torque : array, shape (joints,)
        Greatest torque [N m].
    slope : array, shape (joints,)
        Stall torque over no-load speed [N m s/rad].
    """

    servos: tuple[tuple[ServoModel, ...], ...]
    stiffness: Float[np.ndarray, "joints"]
    damping: Float[np.ndarray, "joints"]
    stall_torque: Float[np.ndarray, "joints"]
    slope: Float[np.ndarray, "joints"]

    @classmethod
    def of(cls, robot: Robot, servos: Any) -> Self:
        """Return the servos of a robot.

        Parameters
        ----------
        robot : Robot
            A single robot.
        servos : "catalogue", "ideal", ServoModel or nested sequence of ServoModel
            Models of the servos in the robot's file, ideal ones, one for all joints, or one for each leg's joints.

        Raises
        ------
        MissingDataError
            With ``"catalogue"``, if a servo is unknown.
        InputError
            If `servos` is none of these.
        """
        rows = _rows(robot, servos)
        each = [servo for row in rows for servo in row]
        return cls(
            servos=rows,
            stiffness=np.array([servo.stiffness for servo in each]),
            damping=np.array([servo.joint_damping for servo in each]),
            stall_torque=np.array([servo.stall_torque for servo in each]),
            slope=np.array([servo.torque_speed_slope for servo in each]),
        )

    @property
    def assumed(self) -> tuple[str, ...]:
        """What the models assume, a line each."""
        return tuple(dict.fromkeys(line for row in self.servos for servo in row for line in servo.assumed))

    def saturated(
        self, drive: Float[np.ndarray, "joints"], speed: Float[np.ndarray, "joints"]
    ) -> Bool[np.ndarray, "joints"]:
        """Return which servos give at least 99 % of the greatest torque at their speed.

        Parameters
        ----------
        drive : array, shape (joints,)
            Torque before damping, as from `drive_torque` [N m].
        speed : array, shape (joints,)
            Joint speed [rad/s].
        """
        loss = self.slope * speed
        forward, backward = np.minimum(loss, 0.0) + self.stall_torque, self.stall_torque - np.maximum(loss, 0.0)
        return np.asarray(np.where(drive > 0, drive >= _ALL * forward, -drive >= _ALL * backward))


def _rows(robot: Robot, servos: Any) -> tuple[tuple[ServoModel, ...], ...]:
    if isinstance(servos, str):
        if servos == "ideal":
            return ((ServoModel.ideal(robot),) * 3,) * robot.legs
        if servos != "catalogue":
            raise UnknownNameError.of("choice of servos", servos, ("catalogue", "ideal"))
        return tuple(tuple(_of_joint(robot, leg, joint) for joint in range(3)) for leg in range(robot.legs))
    if isinstance(servos, ServoModel):
        return ((servos,) * 3,) * robot.legs
    rows = tuple(tuple(row) for row in servos) if isinstance(servos, Sequence) else ()
    if [len(row) for row in rows] != [3] * robot.legs or not all(
        isinstance(s, ServoModel) for row in rows for s in row
    ):
        raise InputError(
            f"servos must be 'catalogue', 'ideal', a ServoModel, or three of them for each of {robot.legs} legs"
        )
    return rows


def _of_joint(robot: Robot, leg: int, joint: int) -> ServoModel:
    servo = robot.servos[leg][joint]
    if servo is None:
        raise MissingDataError(
            f"robot {robot.name!r}, leg {robot.leg_names[leg]}: the servo of the {JOINTS[joint]} is unknown; add it to "
            "its file ([leg] servo); `tarsus simulate` with --servos ideal needs none"
        )
    return ServoModel.of(servo)
