"""Files of a run."""

from __future__ import annotations

from pathlib import Path

from tarsus.control.loop.recording import Recording
from tarsus.hardware.telemetry.log import read_log
from tarsus.report.servo_tracking import plot_tracking
from tarsus.report.style import save_figure
from tarsus.report.timeline import plot_timeline
from tarsus.robot.robot import Robot

__all__ = ["write_figures"]


def write_figures(robot: Robot, recording: Recording | None, servos: bool, out: Path) -> list[Path]:
    """Write log and figures of a run, and return the paths of all its files.

    Parameters
    ----------
    robot : Robot
        The robot.
    recording : Recording or None
        The run; None where a fault ended it.
    servos : bool
        Whether telemetry of servos was recorded.
    out : Path
        Existing folder.

    Raises
    ------
    InputError
        If a file can't be written.
    """
    files = []
    if servos:
        table, picture = out / "telemetry.csv", out / "joints.png"
        time, sent, measured = read_log(table, robot)
        save_figure(plot_tracking(robot, time, sent, measured, title=f"{robot.name}: commanded and measured"), picture)
        files += [table, out / "telemetry.mcap", picture]
    if recording is not None:
        log, picture = out / "log.csv", out / "timeline.png"
        recording.to_csv(log)
        save_figure(plot_timeline(recording), picture)
        files += [log, picture]
    return files
