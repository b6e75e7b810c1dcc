"""The protocol that all servo buses follow."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Protocol

from tarsus.hardware.bus.answers import Answers, BusServo, BusTiming, Telemetry
from tarsus.hardware.bus.capabilities import Capabilities

__all__ = ["Bus"]


class Bus(Protocol):
    """Servos on one port.

    Goals and positions are pulse widths [us] or ticks, as `capabilities` says; the calibration relates them to angles.
    Every method raises `PortError` if the port is gone, and `InputError` for ids, goals and limits that the bus does
    not have; nothing is sent then.

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
        """Return the servo if it answers, or None if it does not, or if this kind of bus has no answers.

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
            Speed, in the unit of the bus per second; None for the servo's own highest speed.
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
