"""The protocol that all servo buses follow, what each can do, and what it measures."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Generic, Literal, Protocol, TypeVar

from tarsus.errors import BusError
from tarsus.representation import represented

__all__ = ["Answers", "Bus", "BusServo", "BusTiming", "Capabilities", "Telemetry"]

_Value_co = TypeVar("_Value_co", covariant=True)


@represented()
@dataclass(frozen=True, kw_only=True)
class Capabilities:
    """What a bus can do; the methods of a bus do nothing where it says that it can't.

    Attributes
    ----------
    unit : str
        Unit of goals and positions: ``"us"`` for pulse widths, ``"tick"`` for steps of a servo's position sensor.
    lowest, highest : float
        Range of goals, in `unit`.
    per_turn : float or None
        How many units a turn has; None if that depends on the servo.
    ids : range
        Ids or channels that a servo may have.
    ping : str
        Who answers: each ``"servo"``, only the ``"board"``, or ``"none"``.
    positions : bool
        Whether the angles of the servos' shafts are measured.
    telemetry : frozenset of str
        What else is measured: names of fields of `Telemetry`.
    torque_off : str
        How a servo is released: ``"torque"`` for a command of its own, ``"pulses"`` if the pulses end (analogue servos
        then let go, many digital ones hold), ``"none"``.
    limits, speed_limit, torque_limit : bool
        Whether a servo or the board takes limits of goals, of speed and of torque.
    watchdog : tuple of float, or None
        Shortest and longest time after which servos or board stop by themselves if no packet comes [s].
    watchdog_action : str
        What they do then: ``"hold"`` where they are, or ``"release"``.
    synchronous : bool
        Whether the goals of all servos take effect at the same time.
    """

    unit: Literal["us", "tick"]
    lowest: float
    highest: float
    ids: range
    per_turn: float | None = None
    ping: Literal["servo", "board", "none"] = "none"
    positions: bool = False
    telemetry: frozenset[str] = frozenset()
    torque_off: Literal["torque", "pulses", "none"] = "none"
    limits: bool = False
    speed_limit: bool = False
    torque_limit: bool = False
    watchdog: tuple[float, float] | None = None
    watchdog_action: Literal["hold", "release", "none"] = "none"
    synchronous: bool = True


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


class Bus(Protocol):
    """Servos on one port.

    Goals and positions are pulse widths [us] or ticks, as `capabilities` says; what they mean as angles is the
    calibration's affair. Every method raises `PortError` if the port is gone, and `InputError` for ids, goals and
    limits that the bus does not have; nothing is sent then.

    Attributes
    ----------
    name : str
        Name of the kind of bus, such as ``"feetech-sts"``.
    port : str
        Name of the port.
    capabilities : Capabilities
        What it can do.
    """

    name: str
    port: str
    capabilities: Capabilities

    def ping(self, id: int) -> BusServo | None:
        """Return a servo that answers, or None if it does not, or if nothing on this bus answers.

        Parameters
        ----------
        id : int
            Its id or channel.

        Raises
        ------
        CorruptAnswerError
            If what comes back is damaged: noise, or two servos with this id.
        """

    def scan(self, ids: Iterable[int] | None = None) -> Answers[BusServo]:
        """Return the servos that answer, and an error for each id whose answer is damaged.

        Parameters
        ----------
        ids : iterable of int, optional
            Ids to ask; all if left out.
        """

    def read_positions(self, ids: Sequence[int]) -> Answers[float]:
        """Return measured positions, with alarms of the servos, or nothing if the bus does not measure them.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        """

    def read_telemetry(self, ids: Sequence[int]) -> Answers[Telemetry]:
        """Return what servos measure, or nothing if the bus has no telemetry.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        """

    def write_goals(self, goals: Mapping[int, float]) -> None:
        """Send goals, in as few packets as possible; nothing is waited for.

        Parameters
        ----------
        goals : mapping of int to float
            Goals by id, in the unit of the bus.
        """

    def set_torque(self, ids: Sequence[int] | None, on: bool) -> bool:
        """Switch the torque of servos, or their pulses, on or off; return whether the bus can.

        Pulses begin with the next goal. A smart servo that is switched on may go to its last goal at once: send the
        goal first.

        Parameters
        ----------
        ids : sequence of int, or None
            The servos; None for all on the bus, with as few packets as possible.
        on : bool
            Whether they hold.
        """

    def set_limits(self, id: int, lowest: float, highest: float) -> bool:
        """Set the range of goals that a servo or the board itself accepts; return whether the bus can.

        Parameters
        ----------
        id : int
            The servo.
        lowest, highest : float
            Range, in the unit of the bus.
        """

    def set_speed_limit(self, ids: Sequence[int], speed: float | None) -> bool:
        """Set the highest speed of servos; return whether the bus can.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        speed : float or None
            In the unit of the bus a second; None for the servo's own.
        """

    def set_torque_limit(self, ids: Sequence[int], share: float) -> bool:
        """Set the highest torque of servos; return whether the bus can.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        share : float
            Share of the highest torque, 0 to 1.
        """

    def set_watchdog(self, ids: Sequence[int], seconds: float | None) -> bool:
        """Make servos or board stop by themselves if no packet comes for some time; return whether the bus can.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        seconds : float or None
            The time [s]; None for never.
        """

    def timing(self, ids: Sequence[int]) -> BusTiming:
        """Return how long the bytes of a tick take on the wire.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        """

    def close(self) -> None:
        """Close the port; torque stays as it is. May be called more than once."""
