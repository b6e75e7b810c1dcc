"""The driver of a visitor who drives a run from the view Drive."""

from __future__ import annotations

from tarsus.studio.machine.driven_run import DrivenRun
from tarsus.studio.messages import client as ask
from tarsus.studio.messages.motion import DriveFrame

__all__ = ["RunDriver"]


class RunDriver:
    """A visitor who drives a run.

    Parameters
    ----------
    run : DrivenRun
        The run.
    id : int
        Id of the message that started driving; all frames carry it.

    Raises
    ------
    InputError
        If another visitor drives.
    """

    is_planning = False

    def __init__(self, run: DrivenRun, *, id: int) -> None:
        self.id, self._run = id, run
        run.take(self)

    def command(self, message: ask.Command) -> None:
        """Set the command.

        Parameters
        ----------
        message : Command
            The command as received.

        Raises
        ------
        TarsusError
            If the controller would refuse it.
        """
        self._run.tell(self, message)

    def step(self, dt: float) -> DriveFrame:  # noqa: ARG002
        """Return a frame; the run itself keeps the time of its ticks."""
        return self._run.frame(self.id)

    def end_run(self) -> None:
        """Stop the robot, and end the run."""
        self._run.end(self)

    def close(self) -> None:
        """End driving; the robot stops."""
        self._run.leave(self)
