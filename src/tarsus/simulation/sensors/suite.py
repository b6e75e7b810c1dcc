"""Sensor suites: which sensors a simulated robot has, and how good they are."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Self

from tarsus.errors import InputError, UnknownNameError
from tarsus.representation import represented

__all__ = ["CHANNELS", "FootSwitch", "Sensor", "SensorSuite"]


@dataclass(frozen=True, kw_only=True)
class Sampling:
    """When a channel is measured.

    Attributes
    ----------
    delay : float
        Time from the measurement to the reading [s].
    rate : float
        Measurements per second [1/s]; infinite for one in each tick.
    dropout : float
        Probability that a measurement is lost; the last reading is then given again, with its age.
    """

    delay: float = 0.0
    rate: float = math.inf
    dropout: float = 0.0

    def __post_init__(self) -> None:
        if not 0 <= self.delay < math.inf:
            raise InputError(f"delay is {self.delay:g} s; it must be a finite number, not negative")
        if not self.rate > 0:
            raise InputError(f"rate is {self.rate:g} 1/s; it must be greater than 0")
        _require_probability("dropout", self.dropout)


@dataclass(frozen=True, kw_only=True)
class Sensor(Sampling):
    """A sensor of numbers, with the errors of its measurements in the units of the channel.

    Attributes
    ----------
    noise : float
        Standard deviation of the error of each measurement.
    bias : float
        Standard deviation of the errors that are drawn once for each element, and constant throughout a run.
    resolution : float
        Step to which measurements are rounded; 0 for none.
    """

    noise: float = 0.0
    bias: float = 0.0
    resolution: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in ("noise", "bias", "resolution"):
            value = getattr(self, name)
            if not 0 <= value < math.inf:
                raise InputError(f"{name} is {value:g}; it must be a finite number, not negative")


@dataclass(frozen=True, kw_only=True)
class FootSwitch(Sampling):
    """A switch in each foot.

    Attributes
    ----------
    threshold : float
        Force at which it closes [N].
    flips : float
        Probability that a switch reads the opposite.
    """

    threshold: float = 0.5
    flips: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 0 <= self.threshold < math.inf:
            raise InputError(f"threshold is {self.threshold:g} N; it must be a finite number, not negative")
        _require_probability("flips", self.flips)


def _require_probability(name: str, value: float) -> None:
    if not 0 <= value < 1:
        raise InputError(f"{name} is {value:g}; it must be at least 0 and less than 1")


@represented()
@dataclass(frozen=True, kw_only=True)
class SensorSuite:
    """The sensors of a robot; channels that are None are not measured. Channels are those of `SensorReadings`.

    Attributes
    ----------
    name : str
        What it is called.
    joint_angles, joint_speeds : Sensor or None
        Angles and speeds of the joints, measured in the servos [rad, rad/s].
    currents : Sensor or None
        Currents of the servos [A]; measured only where the stall currents of all servos are known.
    torques : Sensor or None
        Torques of the servos [N m].
    contacts : FootSwitch or None
        Switches in the feet.
    forces : Sensor or None
        Load cells in the feet: forces along the axes of B [N].
    attitude, angular_rates : Sensor or None
        Roll and pitch [rad], and angular rates along the axes of B [rad/s].
    ground : Sensor or None
        Heights of the terrain around the body, 0.6 m to each side in steps of 20 mm [m].
    """

    name: str = "custom"
    joint_angles: Sensor | None = None
    joint_speeds: Sensor | None = None
    currents: Sensor | None = None
    torques: Sensor | None = None
    contacts: FootSwitch | None = None
    forces: Sensor | None = None
    attitude: Sensor | None = None
    angular_rates: Sensor | None = None
    ground: Sensor | None = None

    @classmethod
    def named(cls, name: str) -> Self:
        """Return the suite of a name.

        Parameters
        ----------
        name : str
            ``"ideal"``: everything but the ground, exactly. ``"camera"``: the ground as well, with small errors.
            ``"hobby"``: foot switches and a cheap inertial sensor. ``"smart"``: servos that report position, speed and
            load. ``"blind"``: nothing.

        Raises
        ------
        UnknownNameError
            If no suite has that name.
        """
        if name not in _SUITES:
            raise UnknownNameError.of("sensor suite", name, _SUITES)
        return cls(name=name, **_SUITES[name])


CHANNELS = (
    "joint_angles",
    "joint_speeds",
    "currents",
    "torques",
    "contacts",
    "forces",
    "attitude",
    "angular_rates",
    "ground",
)
"""The channels that can be simulated."""

_EXACT = Sensor()
_IDEAL = {name: FootSwitch() if name == "contacts" else _EXACT for name in CHANNELS if name != "ground"}
_SUITES: Mapping[str, Mapping[str, Any]] = MappingProxyType(
    {
        "ideal": _IDEAL,
        # Noise of a stereo camera at 0.5 m (2 to 3 mm), rate and delay are assumed; legs hide no ground.
        "camera": _IDEAL | {"ground": Sensor(noise=0.003, delay=0.05, rate=20.0)},
        # Inertial sensor such as the MPU-6050: the noise of its rates is 0.05 deg/s (data sheet); their offset that is
        # left after zeroing at rest, and noise and offset of the attitude from a complementary filter, are assumed.
        "hobby": {
            "contacts": FootSwitch(threshold=1.0, flips=0.001, delay=0.005),
            "attitude": Sensor(noise=math.radians(0.3), bias=math.radians(0.5), delay=0.01),
            "angular_rates": Sensor(noise=math.radians(0.05), bias=math.radians(0.2), delay=0.005),
        },
        # Position in steps of 1/4096 turn, as the STS3215 reports it; the 10 ms to read 18 servos in turn, the noise,
        # the offsets of the horns and the lost messages are assumed.
        "smart": {
            "joint_angles": Sensor(resolution=math.tau / 4096, bias=math.radians(0.3), delay=0.01, dropout=0.002),
            "joint_speeds": Sensor(noise=0.02, resolution=0.0153, delay=0.01, dropout=0.002),
            "torques": Sensor(noise=0.05, bias=0.03, resolution=0.003, delay=0.01, dropout=0.002),
        },
        "blind": {},
    }
)
