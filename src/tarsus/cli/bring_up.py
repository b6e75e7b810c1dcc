"""`tarsus bring-up`: from a box of servos to a calibrated machine."""

from __future__ import annotations

import datetime
import os
import sys
from collections.abc import Mapping
from pathlib import Path

import click

from tarsus.cli.output import print_json, show
from tarsus.cli.signals import as_interrupts
from tarsus.cli.values import examples, json_option, robot_argument
from tarsus.hardware.bringup.dialogue import Left

__all__ = ["bring_up"]

_AGAIN = 20


class _Terminal:
    """A dialogue in a terminal: one line for each answer."""

    def say(self, text: str) -> None:
        """Print a line."""
        show(text)

    def choose(self, question: str, options: Mapping[str, str]) -> str:
        """Ask until the answer is one of the options."""
        words = "  ".join(f"[{key or 'Enter'}] {text}" for key, text in options.items())
        for _ in range(_AGAIN):
            show(f"{question}  {words}  [q] leave")
            try:
                answer = sys.stdin.readline()
            except (EOFError, OSError):
                raise Left from None
            if not answer or answer.strip() == "q":
                raise Left
            if answer.strip().lower() in options:
                return answer.strip().lower()
            show(f"{answer.strip()!r} is none of them.")
        raise Left


@click.command(
    "bring-up",
    short_help="Set up the servos of a new machine, step by step.",
    epilog=examples("tarsus bring-up strider --drawing-only", "tarsus bring-up phantomx-mk2 --drawing-only"),
)
@robot_argument
@click.argument("calibration", type=click.Path(path_type=Path), required=False)
@click.option("--bus", metavar="KIND", help="Kind of servo bus or board.  [default: that of the robot's servos]")
@click.option("--port", default="", metavar="PORT", help="Serial port or I2C device.  [default: searched for]")
@click.option("--drawing-only", is_flag=True, help="Only draw the reference pose.")
@json_option
def bring_up(
    robot: str, calibration: Path | None, bus: str | None, port: str, drawing_only: bool, as_json: bool
) -> int:
    """Bring up the servos of ROBOT: port, ids, directions, zeros and limits, then a slow walk in the air.

    One servo at a time moves a little, with little torque, and you say which leg moved and which way. Every answer is
    saved to CALIBRATION (default: ROBOT.calibration.toml); leave with q, and resume with the same command. Put the
    robot on a box, so that all feet are in the air.
    """
    from tarsus.hardware.bringup.wizard import BringUp
    from tarsus.hardware.bus.registry import open_bus
    from tarsus.hardware.calibration.blank import new_calibration
    from tarsus.hardware.calibration.calibration import Calibration
    from tarsus.hardware.transport.serial import list_ports
    from tarsus.robot.file import load_robot
    from tarsus.robot.preset_names import preset_names

    path = calibration or Path(f"{Path(robot).stem}.calibration.toml")
    drawing = _draw(robot, path)
    if drawing_only:
        if as_json:
            print_json({"files": [str(drawing)]})
        else:
            click.echo(f"wrote {drawing}")
        return 0
    if path.exists():
        found = Calibration.load(path)
        show(f"resumed from {path}: {len(found.missing)} joints are not complete")
    else:
        written = robot if robot in preset_names() else os.path.relpath(robot, path.parent)
        found = new_calibration(load_robot(robot), written, kind=bus, port=port)
        found = found.replace(date=datetime.datetime.now(tz=datetime.UTC).date())
        found.save(path)
    show(f"the reference pose is drawn in {drawing}")
    wizard = BringUp(
        found,
        path,
        _Terminal(),
        open_bus=lambda settings: open_bus(settings.kind, settings.port, baud=settings.baud),
        ports=list_ports,
    )
    try:
        with as_interrupts():
            wizard.perform()
    except Left:
        left = len(wizard.calibration.missing)
        show(f"left; {left} joints are not complete. Resume with: tarsus bring-up {robot} {path}")
        return 1
    if as_json:
        print_json({"calibration": str(path), "complete": not wizard.calibration.missing})
    else:
        show(f"wrote {path}; next: tarsus run {robot} --calibration {path}")
    return 0


def _draw(robot: str, path: Path) -> Path:
    """Draw the reference pose beside the calibration file."""
    from tarsus.hardware.bringup.reference_pose import reference_angles
    from tarsus.report.skeleton import plot_robot
    from tarsus.report.style import save_figure
    from tarsus.robot.file import load_robot

    drawing = path.with_name(f"{path.name.split('.')[0]}.reference-pose.png")
    chosen = load_robot(robot)
    save_figure(plot_robot(chosen, reference_angles(chosen)), drawing)
    return drawing
