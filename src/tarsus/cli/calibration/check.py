"""`tarsus calibration check`: check a calibration file against its robot."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tarsus.cli.output import print_json, show
from tarsus.cli.values import examples, json_option
from tarsus.errors import CalibrationError

if TYPE_CHECKING:
    from rich.table import Table

    from tarsus.hardware.calibration.calibration import Calibration

__all__ = ["check"]


@click.command(
    short_help="Check a calibration file against its robot.",
    epilog=examples("tarsus calibration check my-strider.toml", "tarsus calibration check my-strider.toml --json"),
)
@click.argument("file", type=click.Path(path_type=Path))
@json_option
def check(file: Path, as_json: bool) -> int:
    """Check a calibration file for errors and contradictions with the robot file, and list what is missing.

    Prints the zero, the direction and the limits of each joint, as commands and as angles. The exit code is 0 only if
    nothing is wrong and nothing is missing.
    """
    from tarsus.hardware.calibration.calibration import Calibration

    try:
        found = Calibration.load(file)
    except CalibrationError as error:
        if not as_json:
            raise
        print_json({"file": str(file), "complete": False, "problems": list(error.problems), "missing": []})
        return 1
    joints = _joints(found)
    if as_json:
        print_json(
            {
                "file": str(file),
                "name": found.name,
                "robot": found.robot.name,
                "complete": not found.missing,
                "problems": [],
                "missing": list(found.missing),
                "joints": joints,
            }
        )
    else:
        buses = ", ".join(f"{bus.name}: {bus.properties.text}{bus.port and f' on {bus.port}'}" for bus in found.buses)
        show(_table(joints), f"{found.name}: a {found.robot.name}; {buses}")
        for line in found.missing:
            show(f"  missing: {line}")
        show("complete" if not found.missing else "not complete: tarsus bring-up asks for what is missing")
    return 0 if not found.missing else 1


def _joints(found: Calibration) -> list[dict[str, Any]]:
    import numpy as np

    from tarsus.robot.robot import JOINTS

    complete = not found.missing
    return [
        {
            "joint": found.joint_name(leg, j),
            "bus": joint.bus,
            found.kind(leg, j).number_key: joint.number,
            "unit": found.kind(leg, j).unit,
            "zero": joint.zero,
            "direction": joint.direction,
            "commands": found.command_limits[leg, j].round(1) if complete else joint.limits,
            "angles_deg": np.degrees(found.limits[leg, j]).round(1) if complete else None,
        }
        for leg, row in enumerate(found.joints)
        for j, joint in zip(range(len(JOINTS)), row, strict=True)
    ]


def _table(joints: list[dict[str, Any]]) -> Table:
    from rich.table import Table

    table = Table(box=None, pad_edge=False)
    for heading in ("joint", "servo", "zero", "direction", "commands", "angles [deg]"):
        table.add_column(heading, justify="left" if heading == "joint" else "right")
    for row in joints:
        number = row.get("id", row.get("channel"))
        table.add_row(
            row["joint"],
            "?" if number is None else f"{number}",
            "?" if row["zero"] is None else f"{row['zero']:g}",
            "?" if row["direction"] is None else f"{row['direction']:+d}",
            "?" if row["commands"] is None else f"{row['commands'][0]:g} to {row['commands'][1]:g} {row['unit']}",
            "?" if row["angles_deg"] is None else f"{row['angles_deg'][0]:g} to {row['angles_deg'][1]:g}",
        )
    return table
