"""Source 004's hand calculation of joint torques, line by line, for students.

The hand method models the body as a load on a cantilever and ignores the foot positions. `joint_torques` computes the
actual torques; `compare_with_statics` compares both.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tarsus.errors import InputError, UnknownNameError
from tarsus.load.handbook.lines import Line, Sheet, Term, plain_number
from tarsus.load.handbook.sections import write_sections
from tarsus.load.handbook.source import NOTES, NOTES_ONE_LEG_UP, printed_numbers
from tarsus.representation import represented
from tarsus.robot.robot import JOINTS, Robot, require_robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Handbook", "handbook"]

_FEMUR_ANGLE = math.pi / 4
_HEADER = ("key", "symbol", "formula", "with numbers", "value", "unit", "source 004", "note")


@represented()
@dataclass(frozen=True, kw_only=True)
class Handbook:
    """Hand calculation of a robot's joint torques.

    Attributes
    ----------
    robot : Robot
        The robot.
    leg : int
        Index of the leg whose dimensions represent all legs.
    feet_down : int
        Number of feet on the ground.
    safety_factor : float
        Factor applied to the walking torque.
    corrected : bool
        Whether the errors of the source are corrected.
    lines : tuple of Line
        The lines, in the order of the source.
    """

    robot: Robot
    leg: int
    feet_down: int
    safety_factor: float
    corrected: bool
    lines: tuple[Line, ...]

    @property
    def gait(self) -> str:
        """Name of a gait with that many feet on the ground; source 004 calls the wave "ripple"."""
        legs = self.robot.legs
        names = {legs: "standing on all feet", legs - 1: 'wave gait (source 004\'s "ripple")'}
        if legs == 6:
            names |= {3: "tripod gait", 4: "tetrapod gait, or ripple gait as in the literature"}
        return names.get(self.feet_down, f"{self.feet_down} feet down")

    @property
    def title(self) -> str:
        """Title of the calculation, in one line."""
        return (
            f"{self.robot.name}: {self.feet_down} of {self.robot.legs} feet down, {self.gait}; every leg taken as the "
            f"{self.robot.leg_names[self.leg]} one, {'errors corrected' if self.corrected else 'as printed'}"
        )

    def line(self, key: str) -> Line:
        """Return a line.

        Parameters
        ----------
        key : str
            Key of the line, such as ``"stance.femur"``.

        Raises
        ------
        UnknownNameError
            If the line does not exist.
        """
        for line in self.lines:
            if line.key == key:
                return line
        raise UnknownNameError.of("line of the hand calculation", key, [line.key for line in self.lines])

    def value(self, key: str) -> float:
        """Return the result of a line, in SI units.

        Parameters
        ----------
        key : str
            Key of the line, such as ``"stance.femur"``.

        Raises
        ------
        UnknownNameError
            If the line does not exist.
        """
        return self.line(key).value

    def torque(self, joint: str, *, factor: bool = False) -> float:
        """Return the torque of a joint in stance [N m].

        Femur and tibia support the robot; the coxa pushes it forward.

        Parameters
        ----------
        joint : str
            ``"coxa"``, ``"femur"`` or ``"tibia"``.
        factor : bool
            Whether to multiply by the safety factor.

        Raises
        ------
        UnknownNameError
            If the joint is unknown.
        """
        if joint not in JOINTS:
            raise UnknownNameError.of("joint", joint, JOINTS)
        torque = self.value("walk.coxa" if joint == "coxa" else f"stance.{joint}")
        return torque * self.safety_factor if factor else torque

    def table(self) -> tuple[tuple[str, ...], ...]:
        """Return the lines as rows of text with a header."""
        rows = (
            (
                line.key,
                line.symbol,
                line.formula,
                line.substitution,
                plain_number(line.value, line.unit),
                line.unit,
                line.printed or "",
                line.note,
            )
            for line in self.lines
        )
        return (_HEADER, *rows)


def handbook(  # noqa: PLR0913 - the calculation's assumptions are one list, all of it optional
    robot: Robot,
    *,
    feet_down: int = 3,
    gravity: float = 9.8,
    sweep: float = math.pi / 3,
    sweep_time: float = 2.0,
    acceleration: float = 1.0,
    safety_factor: float = 3.0,
    corrected: bool = True,
    femur_out: float | None = None,
    leg: int | None = None,
) -> Handbook:
    """Compute a robot's joint torques by the hand method of source 004: swing, stance, walking.

    All legs are assumed to be equal. Femur axis offsets and the body's centre of mass are ignored.

    Parameters
    ----------
    robot : Robot
        A single robot with masses.
    feet_down : int
        Number of feet on the ground: 3 for the tripod, 5 for the wave, which the source calls "ripple".
    gravity : float
        Magnitude of gravity [m/s^2]; 9.8 in the source.
    sweep : float
        Angle of the coxa's swing, from rest to rest [rad].
    sweep_time : float
        Duration of the swing [s].
    acceleration : float
        Acceleration of the body [m/s^2].
    safety_factor : float
        Factor applied to the walking torque.
    corrected : bool
        Whether to correct the errors of the source. If not, they are reproduced for any robot, and for the source's own
        robot the calculation continues with the printed, rounded numbers, as the source does.
    femur_out : float, optional
        Horizontal length of the femur in stance [m]. Default: its length at 45 deg, rounded to 1 mm, which gives the
        source's 0.069.
    leg : int, optional
        Index of the leg that represents all. Default: the leg with the largest femur torque in stance.

    Raises
    ------
    MissingDataError
        If the robot's masses are unknown.
    InputError
        If the robot is a batch, the leg does not exist, or a number is out of range.
    """
    require_robot(robot)
    if robot.batch_shape:
        raise InputError(f"handbook takes a single robot, not a batch {robot.batch_shape}")
    robot.require_masses()
    parameters = {
        "gravity": gravity,
        "sweep": sweep,
        "sweep_time": sweep_time,
        "acceleration": acceleration,
        "safety_factor": safety_factor,
    }
    _check(robot, feet_down, leg, parameters | ({} if femur_out is None else {"femur_out": femur_out}))
    feet_down, leg = int(feet_down), _worst_leg(robot, feet_down, gravity) if leg is None else int(leg)
    values = _given(robot, leg, femur_out)
    printed = printed_numbers(values, parameters, legs=robot.legs, feet_down=feet_down)
    one_leg_up = robot.legs - feet_down == 1
    sheet = Sheet(printed, {**NOTES, **(NOTES_ONE_LEG_UP if one_leg_up else {})}, carry_printed=not corrected)
    terms = {key.partition(".")[2]: sheet.given(key, *_symbol(key), value) for key, value in values.items()}
    terms |= {
        "g": Term(gravity, "g", plain_number(gravity)),
        "sweep": Term(sweep, "Δθ", plain_number(sweep)),
        "time": Term(sweep_time, "t", plain_number(sweep_time)),
        "a": Term(acceleration, "a", plain_number(acceleration)),
        "factor": Term(safety_factor, "k", plain_number(safety_factor)),
        "up": Term(robot.legs - feet_down, "n_up", str(robot.legs - feet_down)),
        "down": Term(feet_down, "n_down", str(feet_down)),
    }
    write_sections(sheet, terms, corrected=corrected, one_leg_up=one_leg_up)
    return Handbook(
        robot=robot,
        leg=leg,
        feet_down=feet_down,
        safety_factor=safety_factor,
        corrected=corrected,
        lines=tuple(sheet.lines),
    )


def _check(robot: Robot, feet_down: int, leg: int | None, numbers: Mapping[str, float]) -> None:
    if feet_down not in range(3, robot.legs + 1):
        raise InputError(f"feet_down is {feet_down}; it must be a whole number from 3 to {robot.legs}")
    if leg is not None and leg not in range(robot.legs):
        raise InputError(f"leg is {leg}; it must be from 0 to {robot.legs - 1}")
    for name, value in numbers.items():
        if not 0 < value < math.inf:
            raise InputError(f"{name} is {value}; it must be a finite number greater than 0")


def _worst_leg(robot: Robot, feet_down: int, gravity: float) -> int:
    """Return the leg that gives the largest femur torque in stance if all legs are like it; the first of equals."""
    masses, radius = np.asarray(robot.link_mass), _radius(robot)
    load = (float(np.asarray(robot.body_mass)) + (robot.legs - feet_down) * masses.sum(-1)) * gravity / feet_down
    femur = masses[:, 0] * gravity * robot.link_com[:, 0] + load * (robot.coxa + radius)
    return int(np.argmax(femur > femur.max() * (1 - 1e-5)))


def _radius(robot: Robot) -> Float[np.ndarray, "... legs"]:
    """Return the horizontal distance of each coxa axis from the body's origin [m]."""
    radius: np.ndarray = np.hypot(robot.mount_position[:, 0], robot.mount_position[:, 1])
    return radius


def _given(robot: Robot, leg: int, femur_out: float | None) -> dict[str, float]:
    """Return the given numbers of the calculation [kg, m]."""
    lengths = [float(length[leg]) for length in (robot.coxa, robot.femur, robot.tibia)]
    given = {"given.m_body": float(np.asarray(robot.body_mass))}
    given |= {f"given.m_{joint}": float(np.asarray(robot.link_mass)[leg, i]) for i, joint in enumerate(JOINTS)}
    given |= {f"given.L_{joint}": lengths[i] for i, joint in enumerate(JOINTS)}
    given |= {f"given.l_{joint}": float(robot.link_com[leg, i]) for i, joint in enumerate(JOINTS)}
    given["given.R_b"] = float(_radius(robot)[leg])
    given["given.L_femur_out"] = round(lengths[1] * math.cos(_FEMUR_ANGLE), 3) if femur_out is None else femur_out
    return given


def _symbol(key: str) -> tuple[str, str]:
    """Return symbol and unit of a given number."""
    symbol = key.partition(".")[2]
    return symbol, "kg" if symbol.startswith("m_") else "m"
