"""`tarsus calibration new`: write a calibration file."""

from __future__ import annotations

import datetime
import os
from pathlib import Path

import click

from tarsus.cli.output import print_json
from tarsus.cli.values import examples, json_option, robot_argument

__all__ = ["new"]


@click.command(
    short_help="Write a calibration file to be filled in.",
    epilog=examples(
        "tarsus calibration new strider",
        "tarsus calibration new strider --bus pca9685 --port /dev/i2c-1",
        "tarsus calibration new phantomx-mk2 --nominal --out nominal.toml",
    ),
)
@robot_argument
@click.option("--bus", metavar="KIND", help="Kind of servo bus or board.  [default: that of the robot's servos]")
@click.option("--port", default="", metavar="PORT", help="Serial port or I2C device.  [default: searched for]")
@click.option("--nominal", is_flag=True, help="Fill in ids, zeros and directions of a machine built by the book.")
@click.option(
    "--out", type=click.Path(path_type=Path), metavar="FILE", help="Output file.  [default: ROBOT.calibration.toml]"
)
@json_option
def new(robot: str, bus: str | None, port: str, nominal: bool, out: Path | None, as_json: bool) -> int:
    """Write a calibration file for ROBOT, with what is known of its servos: scales and limits.

    tarsus bring-up finds the rest. Existing files are not overwritten.
    """
    from tarsus.hardware.calibration.blank import new_calibration, nominal_calibration
    from tarsus.robot.file import load_robot
    from tarsus.robot.preset_names import preset_names

    path = out or Path(f"{Path(robot).stem}.calibration.toml")
    # A calibration refers to its robot file relative to its own folder.
    written = robot if robot in preset_names() else os.path.relpath(robot, path.parent)
    make = nominal_calibration if nominal else new_calibration
    made = make(load_robot(robot), written, kind=bus, port=port)
    made = made.replace(date=datetime.datetime.now(tz=datetime.UTC).date())
    if path.exists():
        raise click.UsageError(f"{path} already exists; choose another file with --out")
    made.save(path)
    if as_json:
        print_json({"robot": robot, "file": str(path), "bus": made.buses[0].kind, "missing": list(made.missing)})
        return 0
    click.echo(f"wrote {path}: {len(made.buses)} x {made.buses[0].properties.text}")
    if made.missing:
        click.echo(f"{len(made.missing)} joints are not calibrated yet; next: tarsus bring-up {robot} {path}")
    return 0
