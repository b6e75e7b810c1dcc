"""Which readings a live walker believes: those that a real robot could give."""

from __future__ import annotations

import math

from tarsus.control.readings import SensorReadings, ValidReadings
from tarsus.control.sensing.attitude_validation import AttitudeValidator
from tarsus.control.sensing.channel_validation import ContactChannel, Range, VectorChannel, number
from tarsus.control.sensing.foot_force import STANDARD_GRAVITY
from tarsus.errors import InputError
from tarsus.kinematics.mass import total_mass
from tarsus.robot.robot import Robot

__all__ = ["ReadingsValidator"]

# Where the robot's masses or servos are unknown: more than any robot with legs of this kind weighs or exerts.
_ANY_WEIGHT = 1e4  # [N]
_ANY_STALL_TORQUE = 1e3  # [N m]
# A load cell is a little off zero, and a swinging foot pulls a little; a foot that is held down is a wrong sign.
_PULL = 0.25

_NOTHING = ValidReadings()


class ReadingsValidator:
    """Takes the sensors' readings tick by tick and lets only the plausible ones through.

    A reading is refused that is not finite numbers of the right shape, too old, or beyond what the robot could feel:
    of one leg where it is one leg's, else the whole sense. Once refused, a sense is believed again after it has been
    plausible `settle` times in a row; an attitude must also agree from one reading to the next. Whatever is in the
    fields, nothing is raised.

    Parameters
    ----------
    robot : Robot
        One robot; its weight and its servos' stall torques bound forces and torques, where it has them.
    max_age : float
        Greatest age of a reading [s].
    max_tilt : float
        Greatest roll or pitch, either way [rad].
    max_turn : float
        Greatest speed of roll and pitch from one reading to the next [rad/s].
    max_weights : float
        Greatest force on one foot, in weights of the robot.
    max_stalls : float
        Greatest torque, in stall torques of the joint's servo.
    settle : int
        Plausible readings in a row after which a sense that was refused is believed again.

    Attributes
    ----------
    counts : dict of str to int
        How often each reason was given so far.

    Raises
    ------
    InputError
        If the robot is a batch of designs, or a bound is not positive.
    """

    def __init__(
        self,
        robot: Robot,
        *,
        max_age: float = 0.1,
        max_tilt: float = math.radians(60.0),
        max_turn: float = 6.0,
        max_weights: float = 4.0,
        max_stalls: float = 1.5,
        settle: int = 3,
    ) -> None:
        if robot.batch_shape:
            raise InputError(f"robot {robot.name!r} is a batch of designs {robot.batch_shape}; expected one robot")
        for name, bound in (
            ("max_age", max_age),
            ("max_tilt", max_tilt),
            ("max_turn", max_turn),
            ("max_weights", max_weights),
            ("max_stalls", max_stalls),
            ("settle", settle),
        ):
            if not 0 < bound < math.inf:
                raise InputError(f"{name} is {bound}; it must be a positive number")
        self._max_age = max_age
        weight = float(total_mass(robot)) * STANDARD_GRAVITY if robot.has_masses else _ANY_WEIGHT
        legs, most = robot.leg_codes, max_weights * weight
        self._contacts = ContactChannel(legs, settle=settle)
        self._attitude = AttitudeValidator(max_tilt=max_tilt, max_turn=max_turn, settle=settle)
        self._forces = VectorChannel(
            "forces",
            legs,
            bounds=[((-most, most), (-most, most), (-_PULL * weight, most))] * robot.legs,
            beyond=f"beyond {max_weights:g} times the weight, or pulling down",
            lone=True,
            settle=settle,
        )
        self._torques = VectorChannel(
            "torques",
            legs,
            bounds=[_both_ways([max_stalls * torque for torque in row]) for row in _stall_torques(robot)],
            beyond=f"beyond {max_stalls:g} times the stall torque",
            lone=False,
            settle=settle,
        )
        self._old = f"senses: older than {max_age * 1e3:g} ms"
        self.counts: dict[str, int] = {}

    def admit(self, readings: SensorReadings | None, dt: float) -> ValidReadings:
        """Return what can be believed of the readings.

        Parameters
        ----------
        readings : SensorReadings or None
            The readings; anything else is refused as a whole.
        dt : float
            Time since the last call [s].
        """
        self._attitude.wait(dt)
        if readings is None:
            return _NOTHING
        rejected: list[str] = []
        why = self._wrong_as_a_whole(readings)
        if why:
            rejected.append(why)
            for channel in (self._contacts, self._attitude, self._forces, self._torques):
                channel.distrust()
            admitted = ValidReadings(rejected=(why,))
        else:
            admitted = ValidReadings(
                contacts=self._contacts.read(readings.contacts, rejected),
                attitude=self._attitude.read(readings.attitude, rejected),
                forces=self._forces.read(readings.forces, rejected),
                torques=self._torques.read(readings.torques, rejected),
                rejected=tuple(rejected),
            )
        for reason in rejected:
            self.counts[reason] = self.counts.get(reason, 0) + 1
        return admitted

    def _wrong_as_a_whole(self, readings: SensorReadings) -> str:
        """Return what is wrong with all readings at once, nothing if they can be looked at one by one."""
        if type(readings) is not SensorReadings:
            return "senses: not of the class SensorReadings"
        age = number(readings.age)
        if 0.0 <= age <= self._max_age:
            return ""
        return self._old if age > 0 else "senses: of no possible age"


def _stall_torques(robot: Robot) -> list[list[float]]:
    """Stall torques of each leg's joints [N m]; a great one where the servo is unknown."""
    return [[s.stall_torque if s else _ANY_STALL_TORQUE for s in row] for row in robot.servos]


def _both_ways(most: list[float]) -> tuple[Range, Range, Range]:
    return (-most[0], most[0]), (-most[1], most[1]), (-most[2], most[2])
