"""The model of a position-controlled servo: what limits its torque, and how it follows commands."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np

from tarsus.errors import InputError, MissingDataError
from tarsus.kinematics.mass import known_weight
from tarsus.load.servo_limits import at_supply, why_not_rated
from tarsus.representation import represented
from tarsus.robot.robot import Robot
from tarsus.robot.servo import Servo
from tarsus.robot.servo_dynamics import NO_LOAD_SPEED, ROTOR_INERTIA, servo_dynamics
from tarsus.simulation.servos.torque_law import drive_torque

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["ServoModel"]


@represented()
@dataclass(frozen=True, kw_only=True)
class ServoModel:
    """A position-controlled servo.

    The torque is proportional to the position error, falls with the speed by the slope of the torque-speed line, and is
    limited by that line: a servo that drives its load gives at most ``stall_torque (1 - speed / no_load_speed)``, one
    that is driven by its load at most the stall torque. Within the backlash there is no stiffness. Commands are taken
    over `update_rate` times a second and act after `delay`. A command within the dead band around the target changes
    nothing; one outside it moves the target only until the command is at the edge of the dead band.

    Attributes
    ----------
    name : str
        What it is called.
    stall_torque : float
        Greatest torque [N m]; may be infinite.
    no_load_speed : float
        Speed at which no driving torque is left [rad/s]; may be infinite.
    control_stiffness : float
        Torque per position error of the control loop [N m/rad].
    gear_stiffness : float
        Stiffness of gears and bracket, in series with that of the control loop [N m/rad]; may be infinite.
    damping : float
        Torque per speed beyond the torque-speed line: of the control loop and of friction [N m s/rad].
    rotor_inertia : float
        Inertia of rotor and gears, reflected to the output [kg m^2].
    backlash : float
        Free play at the output [rad].
    dead_band : float
        Width of the range of commands around the target in which it does not react [rad].
    delay : float
        Time from a command to its effect [s].
    update_rate : float
        How often commands are taken over [1/s]; infinite for once in every physics step.
    assumed : tuple of str
        What its numbers assume beyond the catalogue, a line each.

    Raises
    ------
    InputError
        If a number is NaN or out of its range.
    """

    name: str
    stall_torque: float = math.inf
    no_load_speed: float = math.inf
    control_stiffness: float = 100.0
    gear_stiffness: float = math.inf
    damping: float = 1.0
    rotor_inertia: float = ROTOR_INERTIA
    backlash: float = 0.0
    dead_band: float = 0.0
    delay: float = 0.0
    update_rate: float = math.inf
    assumed: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name, unit in _POSITIVE.items():
            value = getattr(self, name)
            if not value > 0:
                raise InputError(f"{self.name}: {name} is {value:g} {unit}; it must be greater than 0")
        for name, unit in _FINITE.items():
            value = getattr(self, name)
            if not 0 <= value < math.inf:
                raise InputError(f"{self.name}: {name} is {value:g} {unit}; it must be a finite number, not negative")

    @classmethod
    def ideal(cls, robot: Robot | None = None, *, stiffness: float | None = None, damping: float | None = None) -> Self:
        """Return a servo that follows at once, with any torque: a spring and a damper.

        Parameters
        ----------
        robot : Robot, optional
            The single robot that the servo is for. Stiffness, damping and rotor inertia are greater in a robot that is
            heavier than the presets, and less in a lighter one, whose feet would hit the ground too hard with those of
            the presets. Left out, they are as for the presets.
        stiffness : float, optional
            Torque per position error [N m/rad]; left out, 100 N m/rad for robots like the presets.
        damping : float, optional
            Torque per speed [N m s/rad]; left out, 1 N m s/rad for robots like the presets.
        """
        weight = 0.0 if robot is None else known_weight(robot)
        length = 0.0 if robot is None else float((robot.femur + robot.tibia).mean())
        stiffer = _beyond(weight * length, _IDEAL_TORQUES)
        rotor = ROTOR_INERTIA * _beyond(weight * length**2, _IDEAL_INERTIAS)
        stiffness = 100.0 * stiffer if stiffness is None else stiffness
        damping = stiffer if damping is None else damping
        described = f"{stiffness:.4g} N m/rad, {damping:.4g} N m s/rad, rotor inertia {rotor:.3g} kg m^2"
        return cls(
            name="ideal",
            control_stiffness=stiffness,
            damping=damping,
            rotor_inertia=rotor,
            assumed=(f"ideal servo: {described}",),
        )

    @classmethod
    def of(cls, servo: Servo | None, *, supply: float | None = None) -> Self:
        """Return the model of a servo; what its catalogue entry does not tell is assumed, and listed in `assumed`.

        Parameters
        ----------
        servo : Servo or None
            The servo.
        supply : float, optional
            Supply voltage [V]; left out, that of the catalogue's ratings.

        Raises
        ------
        MissingDataError
            If there is no servo, or the supply is too high for it.
        """
        if servo is None:
            raise MissingDataError(
                "a joint has no servo; give one in the robot's file ([leg] servo), or simulate with ideal servos"
            )
        if why := why_not_rated(servo, supply):
            raise MissingDataError(why)
        stall, speed = at_supply(servo, supply)
        unknown = math.isnan(speed)
        speed = NO_LOAD_SPEED if unknown else speed
        values, assumed = servo_dynamics(servo, stall, speed)
        if unknown:
            assumed.append(f"no-load speed {speed:g} rad/s")
        assumed.append("no damping beyond the torque-speed line, no dry friction, constant supply")
        return cls(
            name=servo.name,
            stall_torque=stall,
            no_load_speed=speed,
            damping=0.0,
            assumed=tuple(f"{servo.name}: {line}" for line in assumed),
            **values,
        )

    @property
    def stiffness(self) -> float:
        """Torque per position error of control loop and gears in series [N m/rad]."""
        return 1.0 / (1.0 / self.control_stiffness + 1.0 / self.gear_stiffness)

    @property
    def torque_speed_slope(self) -> float:
        """Torque that each rad/s of speed costs: stall torque over no-load speed [N m s/rad]; 0 without a limit."""
        return self.stall_torque / self.no_load_speed if math.isfinite(self.stall_torque) else 0.0

    @property
    def joint_damping(self) -> float:
        """All damping of the joint: slope of the torque-speed line and further damping [N m s/rad]."""
        return self.torque_speed_slope + self.damping

    def torque(
        self, error: Float[np.ndarray, "*#batch"], speed: Float[np.ndarray, "*#batch"]
    ) -> Float[np.ndarray, "*batch"]:
        """Return the torque at a position error and a speed.

        Parameters
        ----------
        error : array, shape (...)
            Target less joint angle [rad].
        speed : array, shape (...)
            Joint speed [rad/s].

        Returns
        -------
        array, shape (...)
            Torque [N m].
        """
        speeds = np.asarray(speed, dtype=float)
        drive = drive_torque(
            np.asarray(error, dtype=float),
            speeds,
            stiffness=self.stiffness,
            play=self.backlash / 2,
            stall_torque=self.stall_torque,
            slope=self.torque_speed_slope,
        )
        return drive - self.joint_damping * speeds


def _beyond(value: float, usual: tuple[float, float]) -> float:
    """Return the ratio of a value to the end of the usual range that it is beyond; 1 within the range, or for 0."""
    least, most = usual
    return value / min(max(value, least), most) if value else 1.0


# Ranges of weight times the length of femur and tibia [N m], and of weight times its square [N m^2]: all presets lie
# within, and so have the same ideal servos.
_IDEAL_TORQUES, _IDEAL_INERTIAS = (3.7, 8.5), (0.65, 2.4)
_POSITIVE = {
    "stall_torque": "N m",
    "no_load_speed": "rad/s",
    "control_stiffness": "N m/rad",
    "gear_stiffness": "N m/rad",
    "update_rate": "1/s",
}
_FINITE = {
    "control_stiffness": "N m/rad",
    "damping": "N m s/rad",
    "rotor_inertia": "kg m^2",
    "backlash": "rad",
    "dead_band": "rad",
    "delay": "s",
}
