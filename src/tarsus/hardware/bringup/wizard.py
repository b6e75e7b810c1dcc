"""The steps of a bring-up in their order, each of which can be left and resumed."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from tarsus.hardware.bringup.connection import Connection, Opener, find_servos
from tarsus.hardware.bringup.dialogue import Dialogue
from tarsus.hardware.bringup.feet import board_of_inputs, find_foot_switches
from tarsus.hardware.bringup.identification import identify
from tarsus.hardware.bringup.limits import set_limits
from tarsus.hardware.bringup.progress import Progress
from tarsus.hardware.bringup.trial import check_pose, walk_in_the_air
from tarsus.hardware.bringup.zeros import set_zeros
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.transport.clock import Clock, SystemClock

__all__ = ["BringUp"]


class BringUp:
    """Finds out which servo is which joint, which way it turns, where its zero is and how far it may go.

    Parameters
    ----------
    calibration : Calibration
        As far as it is known.
    path : Path
        Where it is saved after every answer.
    dialogue : Dialogue
        Who answers the questions.
    open_bus : callable
        Opens the bus that settings describe.
    ports : callable
        Returns the names of the ports that there are.
    clock : Clock, optional
        The machine's.
    """

    def __init__(
        self,
        calibration: Calibration,
        path: Path,
        dialogue: Dialogue,
        *,
        open_bus: Opener,
        ports: Callable[[], tuple[str, ...]],
        clock: Clock | None = None,
    ) -> None:
        self._progress = Progress(calibration, path, dialogue)
        self._clock: Clock = clock or SystemClock()
        self._connection = Connection(self._progress, open_bus=open_bus, ports=ports, clock=self._clock)

    @property
    def calibration(self) -> Calibration:
        """The calibration as far as it is known now."""
        return self._progress.calibration

    def perform(self) -> None:
        """Go through all steps that are not done yet.

        Raises
        ------
        Left
            If whoever answers goes away; all servos are released then.
        TarsusError
            If something can't be done, for example the file can't be written.
        """
        progress, connection = self._progress, self._connection
        try:
            for number in connection.perform(partial(find_servos, progress)):
                if number not in progress.assigned:
                    connection.perform(partial(identify, progress, number=number))
            for leg, row in enumerate(self.calibration.joints):
                if any(joint.number is not None and joint.zero is None for joint in row):
                    connection.perform(partial(set_zeros, progress, leg=leg))
                connection.perform(partial(set_limits, progress, leg=leg))
            self.calibration.require_complete()
            settings = board_of_inputs(progress)
            if settings is not None:
                connection.perform(partial(find_foot_switches, progress, connection, settings=settings))
            check_pose(progress, connection, clock=self._clock)
            walk_in_the_air(progress, connection, clock=self._clock)
        finally:
            connection.close()
