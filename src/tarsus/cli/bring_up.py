"""`tarsus bring-up`: from a box of servos to a calibrated machine."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from pathlib import Path

import click

from tarsus.cli.output import print_json, show
from tarsus.cli.signals import as_interrupts
from tarsus.cli.values import examples, json_option, robot_argument
from tarsus.hardware.bringup.dialogue import Left, Topic

__all__ = ["bring_up"]

_AGAIN = 20


class _Terminal:
    """A dialogue in a terminal, with a line for each answer; it is on standard error if a JSON document is printed."""

    def __init__(self, *, beside: bool = False) -> None:
        self._beside = beside

    def say(self, text: str) -> None:
        """Print a line."""
        if self._beside:
            click.echo(text, err=True)
        else:
            show(text)

    def choose(self, question: str, options: Mapping[str, str], *, topic: Topic) -> str:  # noqa: ARG002
        """Ask until the answer is one of the options."""
        words = "  ".join(f"[{key or 'Enter'}] {text}" for key, text in options.items())
        for _ in range(_AGAIN):
            self.say(f"{question}  {words}  [q] leave")
            try:
                answer = sys.stdin.readline()
            except (EOFError, OSError):
                raise Left from None
            if not answer or answer.strip() == "q":
                raise Left
            if answer.strip().lower() in options:
                return answer.strip().lower()
            self.say(f"{answer.strip()!r} is none of them.")
        raise Left


@click.command(
    "bring-up",
    short_help="Set up the servos of a new machine, step by step.",
    epilog=examples("tarsus bring-up strider --drawing-only", "tarsus bring-up phantomx-mk2 --drawing-only"),
)
@robot_argument
@click.argument("calibration", type=click.Path(path_type=Path), required=False)
@click.option("--bus", metavar="KIND", help="Kind of servo bus or board.  [default: asked for]")
@click.option("--port", metavar="PORT", help="Serial port or I2C device.  [default: asked for]")
@click.option("--drawing-only", is_flag=True, help="Only draw the reference pose.")
@json_option
def bring_up(
    robot: str, calibration: Path | None, bus: str | None, port: str | None, drawing_only: bool, as_json: bool
) -> int:
    """Bring up the servos of ROBOT: port, ids, directions, zeros and limits, then a slow walk in the air.

    One servo at a time moves a little, with little torque, and you say which leg moved and which way. Every answer is
    saved to CALIBRATION (default: ROBOT.calibration.toml); leave with q, and resume with the same command. Put the
    robot on a box, so that all feet are in the air.
    """
    from tarsus.hardware.bringup.beginning import begin
    from tarsus.hardware.bringup.opening import bring_up_of
    from tarsus.robot.file import load_robot
    from tarsus.robot.preset_names import preset_names

    path = calibration or Path(f"{Path(robot).stem}.calibration.toml")
    if drawing_only:
        drawing = _draw(robot, path)
        if as_json:
            print_json({"files": [str(drawing)]})
        else:
            click.echo(f"wrote {drawing}")
        return 0
    written = robot if robot in preset_names() else os.path.relpath(robot, path.parent)
    terminal = _Terminal(beside=as_json)
    try:
        with as_interrupts():
            found = begin(load_robot(robot), written, path, terminal, kind=bus, port=port)
            terminal.say(f"the reference pose is drawn in {_draw(robot, path)}")
            wizard = bring_up_of(found, path, terminal)
            wizard.perform()
            complete = not wizard.calibration.missing
            terminal.say(f"wrote {path}; next: tarsus run {robot} --calibration {path}")
            code = 0
    except Left:
        terminal.say(f"left; {_unknown(path)} Resume with: tarsus bring-up {robot} {path}")
        complete, code = False, 1
    if as_json:
        print_json({"calibration": str(path), "complete": complete})
    return code


def _unknown(path: Path) -> str:
    """Return a sentence on how many joints of a calibration are not complete, or that none was saved."""
    from tarsus.hardware.calibration.calibration import Calibration

    return f"{len(Calibration.load(path).missing)} joints are not complete." if path.exists() else "nothing was saved."


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
