"""What servos answer, and how long it takes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Generic, TypeVar

from tarsus.errors import BusError
from tarsus.representation import represented

__all__ = ["Answers", "BusServo", "BusTiming", "Telemetry"]

_Value_co = TypeVar("_Value_co", covariant=True)


@represented()
@dataclass(frozen=True, slots=True)
class BusServo:
    """A servo, or a channel of a board, that answered.

    Attributes
    ----------
    id : int
        Its id or channel.
    model : int or None
        The maker's number of the model.
    name : str
        Name of the model, if it is known.
    firmware : str
        Version of its firmware, if it tells.
    """

    id: int
    model: int | None = None
    name: str = ""
    firmware: str = ""


@represented()
@dataclass(frozen=True, slots=True, kw_only=True)
class Telemetry:
    """What a servo measures, or a board for all of its servos; None for what it does not measure.

    Attributes
    ----------
    position : float or None
        Angle of the shaft, in the unit of the bus.
    speed : float or None
        Speed of the shaft, in the unit of the bus a second.
    load : float or None
        Drive of the motor, -1 to 1.
    current : float or None
        Current [A].
    voltage : float or None
        Supply [V].
    temperature : float or None
        Temperature [deg C].
    alarms : tuple of str
        What the servo complains of, such as ``"overload"``.
    """

    position: float | None = None
    speed: float | None = None
    load: float | None = None
    current: float | None = None
    voltage: float | None = None
    temperature: float | None = None
    alarms: tuple[str, ...] = ()


@represented("values", "errors", "alarms")
@dataclass(frozen=True)
class Answers(Generic[_Value_co]):
    """Answers of several servos, each with a value or an error.

    Attributes
    ----------
    values : mapping of int
        Values by the servos' ids.
    errors : tuple of BusError
        Why the other servos that were asked have none: each error has the servo's `id`.
    alarms : mapping of int to tuple of str
        What servos complain of in the same answers, where a protocol has that; `Bus.read_telemetry` tells details.
    """

    values: Mapping[int, _Value_co] = field(default_factory=dict)
    errors: tuple[BusError, ...] = ()
    alarms: Mapping[int, tuple[str, ...]] = field(default_factory=dict)

    def require(self) -> Mapping[int, _Value_co]:
        """Return the values.

        Raises
        ------
        BusError
            The first error, if there is one.
        """
        if self.errors:
            raise self.errors[0]
        return self.values


@represented()
@dataclass(frozen=True, slots=True)
class BusTiming:
    """How long the bytes of a tick take on the wire, computed from the baud rate and the servos' answering delay.

    Attributes
    ----------
    goals : float
        Goals to all servos [s].
    positions : float
        Positions of all servos [s]; 0 if the bus does not measure them.
    telemetry : float
        Telemetry of all servos [s]; 0 if the bus has none.
    """

    goals: float
    positions: float
    telemetry: float

    @property
    def rate(self) -> float:
        """Goals and positions of all servos per second, at most [Hz]."""
        return 1.0 / (self.goals + self.positions) if self.goals + self.positions else math.inf
