"""`tarsus robots import`: a robot file from a URDF file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tarsus.cli.output import file_name, print_json, show, write_new
from tarsus.cli.values import Numbers, examples, json_option

if TYPE_CHECKING:
    from tarsus.urdf import ImportedRobot

__all__ = ["import_urdf"]


@click.command(
    "import",
    short_help="Write a robot file from a URDF file.",
    epilog=examples(
        "tarsus robots import hexapod.urdf",
        "tarsus robots import hexapod.urdf --name my-hexapod --out my-hexapod.toml",
        "tarsus robots import hexapod.urdf --forward y --centre --foot 181,0,0 --json",
    ),
)
@click.argument("urdf", metavar="URDF", type=click.Path(path_type=Path, dir_okay=False))
@click.option("--name", metavar="NAME", help="Name of the robot.  [default: that of the URDF file]")
@click.option(
    "--forward",
    type=click.Choice(["x", "-x", "y", "-y"]),
    default="x",
    show_default=True,
    help="Axis of the body's link that points forward.",
)
@click.option("--centre", is_flag=True, help="Move the body frame to the middle of the coxa axes.")
@click.option(
    "--foot",
    type=Numbers("X", "Y", "Z"),
    metavar="X,Y,Z",
    help="Foot point in the frame of each leg's last link, where the file doesn't have it (mm).",
)
@click.option(
    "--out", type=click.Path(path_type=Path, dir_okay=False), metavar="FILE", help="Output.  [default: NAME.toml]"
)
@json_option
def import_urdf(
    urdf: Path,
    name: str | None,
    forward: str,
    centre: bool,
    foot: tuple[float, ...] | None,
    out: Path | None,
    as_json: bool,
) -> int:
    """Write a robot file from the URDF file of a robot with legs of three joints.

    Legs are found by how links hang together, whatever their names and frames. What the file lacks, and what does not
    fit a robot file, is listed. Existing files are not overwritten.
    """
    from tarsus.robot.file import robot_text
    from tarsus.urdf import robot_from_urdf

    point = None if foot is None else (foot[0] / 1000, foot[1] / 1000, foot[2] / 1000)
    found = robot_from_urdf(urdf, forward=forward, centre=centre, foot=point, name=name)
    path = Path(f"{file_name(found.robot.name)}.toml") if out is None else out
    text = _with_comments(robot_text(found.robot), found, urdf)
    write_new(path, text)
    if as_json:
        print_json(_summary(found, path))
        return 0
    show(*_lines(found))
    click.echo(f"wrote {path}; check it with: tarsus robots check {path}")
    return 0


def _lines(found: ImportedRobot) -> list[str]:
    """Return the lines that describe an imported robot: legs, remarks, conversions of angles."""
    robot = found.robot
    differ = f"foot points differ from those of the URDF file by at most {1000 * found.deviation:.3f} mm"
    return [
        f"{robot.name}: {robot.legs} legs; {differ}",
        *(f"- {remark}" for remark in found.remarks),
        "joint angles here, from those of the URDF file:",
        *(f"  {line}" for line in _conversions(found)),
    ]


def _conversions(found: ImportedRobot) -> list[str]:
    """Return lines on how angles of the URDF file become those of the robot file; equal legs share a line."""
    from tarsus.robot.robot import JOINTS

    by_text: dict[str, list[str]] = {}
    for leg, code in enumerate(found.robot.leg_codes):
        parts = (
            f"{joint} = {'-' if found.signs[leg, number] < 0 else ''}{joint}_urdf {_degrees(found.zeros[leg, number])}"
            for number, joint in enumerate(JOINTS)
        )
        by_text.setdefault(", ".join(part.strip() for part in parts), []).append(code)
    return [f"{' '.join(codes)}: {text}" for text, codes in by_text.items()]


def _degrees(angle: float) -> str:
    import math

    degrees = round(math.degrees(angle), 4) + 0.0
    return f"{'+' if degrees > 0 else '-'} {abs(degrees):g} deg" if degrees else ""


def _with_comments(text: str, found: ImportedRobot, urdf: Path) -> str:
    lines = [f"Imported from {urdf.name} by tarsus robots import.", *_lines(found)[1:]]
    return "".join(f"# {line}\n" for line in lines) + "\n" + text


def _summary(found: ImportedRobot, path: Path) -> dict[str, Any]:
    import numpy as np

    return {
        "name": found.robot.name,
        "file": str(path),
        "legs": [
            {"leg": name, "joints": list(joints), "signs": signs, "zeros_deg": zeros}
            for name, joints, signs, zeros in zip(
                found.robot.leg_names, found.joints, found.signs.tolist(), np.degrees(found.zeros).tolist(), strict=True
            )
        ],
        "deviation_mm": 1000 * found.deviation,
        "has_masses": found.robot.has_masses,
        "remarks": list(found.remarks),
    }
