"""What is common to buses of boards that only send pulses: shafts are not measured, and there are no ids to find."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from tarsus.errors import NoAnswerError
from tarsus.hardware.bus.answers import Answers, BusServo, BusTiming, Telemetry
from tarsus.hardware.bus.capabilities import Capabilities
from tarsus.hardware.bus.checks import checked_goals, checked_ids, checked_range
from tarsus.hardware.bus.scanning import scanned
from tarsus.hardware.bus.without_servo_settings import WithoutServoSettings
from tarsus.hardware.transport.protocol import I2cTransport, Transport
from tarsus.representation import represented

__all__ = ["LONGEST_PULSE", "SHORTEST_PULSE", "BoardBus", "runs"]

SHORTEST_PULSE, LONGEST_PULSE = 400.0, 2600.0
"""Range of pulse widths that boards send [us]; the calibration has the narrower range of each servo."""


def runs(channels: Iterable[int], most: int) -> list[list[int]]:
    """Return channels in runs of consecutive numbers.

    Parameters
    ----------
    channels : iterable of int
        The channels.
    most : int
        Most channels in a run.
    """
    found: list[list[int]] = []
    for channel in sorted(channels):
        if found and found[-1][-1] == channel - 1 and len(found[-1]) < most:
            found[-1].append(channel)
        else:
            found.append([channel])
    return found


@represented("name", "port")
class BoardBus(WithoutServoSettings):
    """A board that sends pulses to analogue or digital servos; a kind of it for each board.

    Attributes
    ----------
    name : str
        Name of the bus.
    port : str
        Name of the port.
    capabilities : Capabilities
        What it can do.
    """

    def __init__(self, name: str, transport: Transport | I2cTransport, capabilities: Capabilities) -> None:
        self.name, self.port, self.capabilities = name, transport.port, capabilities
        self._close = transport.close

    def ping(self, id: int) -> BusServo | None:
        """Return the channel if its board answers, or None; no board can tell whether a servo is connected.

        Parameters
        ----------
        id : int
            The channel.
        """
        checked_ids(self.name, self.capabilities, (id,))
        try:
            board = self._board(id)
        except NoAnswerError:
            return None
        return BusServo(id, name=board)

    def scan(self, ids: Iterable[int] | None = None) -> Answers[BusServo]:
        """Return the channels of boards that answer.

        Parameters
        ----------
        ids : iterable of int, optional
            Channels to ask for; all if left out.
        """
        return scanned(self, ids)

    def read_positions(self, ids: Sequence[int]) -> Answers[float]:
        """Return nothing: a board does not measure where servos are.

        Parameters
        ----------
        ids : sequence of int
            The channels.
        """
        checked_ids(self.name, self.capabilities, ids)
        return Answers()

    def read_telemetry(self, ids: Sequence[int]) -> Answers[Telemetry]:
        """Return what the board measures, the same for each of its channels; nothing if it measures nothing.

        Parameters
        ----------
        ids : sequence of int
            The channels.
        """
        ids = checked_ids(self.name, self.capabilities, ids)
        if not self.capabilities.telemetry or not ids:
            return Answers()
        try:
            measured = self._measured()
        except NoAnswerError as error:
            return Answers({}, (error,))
        return Answers(dict.fromkeys(ids, measured))

    def write_goals(self, goals: Mapping[int, float]) -> None:
        """Send pulse widths [us].

        Parameters
        ----------
        goals : mapping of int to float
            Pulse widths by channel.
        """
        checked = checked_goals(self.name, self.capabilities, goals)
        if checked:
            self._send(checked)

    def set_torque(self, ids: Sequence[int] | None, on: bool) -> bool:
        """End the pulses of channels, or let them begin with the next goal.

        Parameters
        ----------
        ids : sequence of int, or None
            The channels; None for all.
        on : bool
            Whether they may have pulses.
        """
        chosen = None if ids is None else checked_ids(self.name, self.capabilities, ids)
        if chosen is None or chosen:
            self._switch(chosen, on)
        return True

    def set_limits(self, id: int, lowest: float, highest: float) -> bool:
        """Do nothing: limits of pulses are set with the board's own software, if it has any.

        Parameters
        ----------
        id : int
            The channel.
        lowest, highest : float
            Range [us].
        """
        checked_range(self.name, self.capabilities, id, lowest, highest)
        return False

    def timing(self, ids: Sequence[int]) -> BusTiming:
        """Return how long the bytes of a tick take on the wire.

        Parameters
        ----------
        ids : sequence of int
            The channels.
        """
        return BusTiming(self._goal_seconds(ids), 0.0, self._telemetry_seconds())

    def close(self) -> None:
        """Close the port; pulses go on, unless a watchdog ends them."""
        self._close()

    def _goal_seconds(self, ids: Sequence[int]) -> float:
        """Return how long goals of channels take on the wire [s]."""
        del ids
        return 0.0

    def _telemetry_seconds(self) -> float:
        """Return how long asking for telemetry takes on the wire [s]."""
        return 0.0

    def _board(self, id: int) -> str:
        """Return the name of the board that has a channel, or raise `NoAnswerError`."""
        del id
        return ""

    def _measured(self) -> Telemetry:
        """Return what the board measures."""
        return Telemetry()

    def _send(self, goals: Mapping[int, float]) -> None:
        """Send checked pulse widths [us]."""

    def _switch(self, ids: Sequence[int] | None, on: bool) -> None:
        """End pulses, or let them begin with the next goal."""
