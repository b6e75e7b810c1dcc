"""Option `--studio` of `tarsus run`: the view Drive of a studio that belongs to the run."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING

import click

from tarsus.control.robot_controller import RobotController
from tarsus.errors import InputError
from tarsus.hardware.calibration.calibration import Calibration

if TYPE_CHECKING:
    from tarsus.studio.machine.driven_run import DrivenRun

__all__ = ["driven_from_studio"]

# Frames per second [1/s]; fewer than usual, as the loop of the run shares the interpreter with the server.
_FRAME_RATE = 30.0


@contextlib.contextmanager
def driven_from_studio(
    controller: RobotController, calibration: Calibration, address: str, bus: str
) -> Iterator[DrivenRun]:
    """Serve a studio whose view Drive drives a run, and yield its source of commands.

    Parameters
    ----------
    controller : RobotController
        The controller of the run.
    calibration : Calibration
        Robot and servos that the studio shows.
    address : str
        Host and port: ``"127.0.0.1:8600"``.
    bus : str
        Name of what executes the angles, shown to visitors.

    Raises
    ------
    InputError
        If the address is not possible or in use.
    """
    from tarsus.hardware.calibration.file import calibration_text
    from tarsus.robot.file import robot_to_dict
    from tarsus.studio.machine.calibration import CalibrationText
    from tarsus.studio.machine.driven_run import DrivenRun
    from tarsus.studio.messages.state import Picture, StudioState
    from tarsus.studio.robots import choice_of_document, robot_of
    from tarsus.studio.server.serve import Serving
    from tarsus.studio.server.settings import Limits, Settings, is_loopback

    host, port = _parts(address)
    choice = choice_of_document(robot_to_dict(calibration.robot))
    robot_of(choice)
    run = DrivenRun(controller, bus)
    settings = Settings(
        host=host,
        port=port,
        token=None if is_loopback(host) else Settings.new_token(),
        start=StudioState(view="drive", robot=choice, picture=Picture(camera="follow")),
        limits=Limits(frame_hz=_FRAME_RATE),
        run=run,
        calibration=CalibrationText(calibration.name, calibration_text(calibration)),
    )
    with Serving(settings) as serving:
        click.echo(f"drive it here: {serving.url}", err=True)
        if sys.stdout.isatty():
            click.launch(serving.url)
        yield run


def _parts(address: str) -> tuple[str, int]:
    host, _, port = address.rpartition(":")
    if not host or not port.isdecimal() or int(port) > 65535:
        raise InputError(f"--studio {address}: it must be HOST:PORT, such as 127.0.0.1:8600")
    return host.strip("[]"), int(port)
