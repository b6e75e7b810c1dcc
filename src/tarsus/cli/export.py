"""`tarsus export`: a robot for other software."""

from __future__ import annotations

from pathlib import Path

import click

from tarsus.cli.output import print_json
from tarsus.cli.values import examples, json_option, robot_argument

__all__ = ["export"]


@click.command(epilog=examples("tarsus export urdf strider --out strider.urdf", "tarsus export mjcf phantomx"))
@click.argument("format_", metavar="FORMAT", type=click.Choice(["urdf", "mjcf"]))
@robot_argument
@click.option(
    "--out",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="Output file.  [default: standard output]",
)
@click.option(
    "--servos",
    type=click.Choice(["catalogue", "ideal"]),
    default="catalogue",
    show_default=True,
    help="MJCF: stiffness and torque of the actuators.",
)
@json_option
def export(format_: str, robot: str, out: Path | None, servos: str, as_json: bool) -> int:
    """Write a robot as URDF (for ROS, Pinocchio, MuJoCo and others) or MJCF (MuJoCo).

    One file, without meshes: boxes, cylinders and spheres. The robot needs masses; inertias are those of uniform boxes.
    """
    from tarsus.errors import InputError
    from tarsus.export import to_mjcf, to_urdf
    from tarsus.robot.file import load_robot

    found = load_robot(robot)
    text = to_urdf(found) if format_ == "urdf" else to_mjcf(found, servos=servos)
    if out is not None:
        try:
            out.write_text(text, encoding="utf-8")
        except OSError as error:
            raise InputError(f"{out} can't be written: {error.strerror}") from None
    if as_json:
        written = {"document": text} if out is None else {"file": str(out)}
        print_json({"robot": found.name, "format": format_, **written})
    else:
        click.echo(text if out is None else f"wrote {out}\n", nl=False)
    return 0
