"""`tarsus studio`: interactive 3D view of a robot in the browser."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tarsus.cli.output import print_json
from tarsus.cli.values import examples, json_option

if TYPE_CHECKING:
    from tarsus.robot.robot import Robot
    from tarsus.studio.machine.calibration import CalibrationText
    from tarsus.studio.messages.state import StudioState
    from tarsus.studio.server.serve import Serving

__all__ = ["studio"]

_PORT = 8600


@click.command(
    epilog=examples(
        "tarsus studio --check",
        "tarsus studio phantomx --check --json",
        "tarsus studio strider --port 0 --no-browser --check",
        "tarsus studio --host 0.0.0.0 --check",
        "tarsus studio --host 0.0.0.0 --public --check",
    )
)
@click.argument("robot", metavar="[ROBOT]", required=False)
@click.option("--port", type=click.IntRange(0, 65535), help=f"Port; 0 for a free one.  [default: {_PORT}]")
@click.option(
    "--host",
    default="127.0.0.1",
    show_default=True,
    help="Address to listen on; addresses other than loopback need a token.",
)
@click.option("--public", is_flag=True, help="Serve without a token, restricted to the simulator.")
@click.option("--token", help="Access token.  [default: a new one if --host needs one]")
@click.option(
    "--calibration",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Calibration file: pulses beside joint angles; its robot, where ROBOT is left out.",
)
@click.option("--no-browser", is_flag=True, help="Print the link without opening a browser.")
@click.option("--check", is_flag=True, help="Start the server, check that it responds, and stop.")
@json_option
def studio(
    robot: str | None,
    port: int | None,
    host: str,
    public: bool,
    token: str | None,
    calibration: Path | None,
    no_browser: bool,
    check: bool,
    as_json: bool,
) -> int:
    """Open the robot in the browser. Without --check the server runs until Ctrl-C.

    The server accepts connections from this machine only, unless --host is given; then visitors need the printed link
    with its token.
    """
    from tarsus.studio.machine.hardware import Hardware
    from tarsus.studio.server.serve import Serving
    from tarsus.studio.server.settings import Settings, is_loopback

    if public and token is not None:
        raise click.UsageError("--public and --token exclude each other")
    if token is None and not public and not is_loopback(host):
        token = Settings.new_token()
    # A check selects any free port, so that it does not fail because a studio is already running.
    chosen_port = port if port is not None else 0 if check else _PORT
    chosen, own = _robot(robot, calibration)
    settings = Settings(
        host=host,
        port=chosen_port,
        public=public,
        token=token,
        start=_start(chosen),
        hardware=None if public else Hardware(Path(), robot_file=own, calibration=calibration),
        calibration=None if calibration is None else _text(calibration),
    )
    serving = Serving(settings)
    if check:
        return _check(serving, as_json=as_json)
    _announce(serving, as_json=as_json)
    if not no_browser and sys.stdout.isatty():
        click.launch(serving.url)
    serving.run()
    return 0


def _robot(name: str | None, calibration: Path | None) -> tuple[Robot, Path | None]:
    """Return the named robot, else that of the calibration, else the default; and its file where it is no preset."""
    from tarsus.cli.pulses import calibration_of
    from tarsus.hardware.calibration.calibration import Calibration
    from tarsus.robot.file import load_robot
    from tarsus.robot.preset_names import preset_names

    if calibration is None:
        file = name or "strider"
        return load_robot(file), None if file in preset_names() else Path(file)
    found = Calibration.load(calibration) if name is None else calibration_of(load_robot(name), calibration)
    found.require_complete()
    return found.robot, None if found.robot_file in preset_names() else calibration.parent / found.robot_file


def _text(calibration: Path) -> CalibrationText:
    from tarsus.studio.machine.calibration import CalibrationText

    return CalibrationText(calibration.name, calibration.read_text(encoding="utf-8-sig"))


def _start(robot: Robot) -> StudioState:
    from tarsus.robot.file import robot_to_dict
    from tarsus.studio.messages.state import StudioState
    from tarsus.studio.robots import choice_of_document, robot_of

    choice = choice_of_document(robot_to_dict(robot))
    robot_of(choice)
    return StudioState(robot=choice)


def _announce(serving: Serving, *, as_json: bool) -> None:
    if as_json:
        print_json({"url": serving.url})
        return
    click.echo(f"Tarsus Studio: {serving.url}")
    click.echo("Press Ctrl-C to stop.")


def _check(serving: Serving, *, as_json: bool) -> int:
    with serving:
        health = serving.health()
    if as_json:
        print_json({"url": serving.url, **health})
    else:
        pages = "with its pages" if health["pages"] else "but its pages are not built: run `make web`"
        click.echo(f"the studio responds at {serving.url} {pages}")
    return 0 if health["status"] == "ok" else 1
