"""`tarsus loads`: what every joint bears through a walk, and whether its servo carries it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from tarsus.cli.folder import make_folder
from tarsus.cli.output import print_json, show
from tarsus.cli.values import examples, json_option, number_option, robot_argument
from tarsus.cli.walk_options import walk_options

__all__ = ["loads"]


@click.command(
    epilog=examples(
        "tarsus loads strider",
        "tarsus loads phantomx --body-height 130 --gait ripple",
        "tarsus loads strider --payload 0.2 --supply 6.8 --distance 300",
        "tarsus loads strider --static --capacity 3 --json",
        "tarsus loads strider --distance 300 --out loads",
    )
)
@robot_argument
@walk_options
@number_option("--payload", "KG", "What the body carries, at its origin.", default=0.0, show_default=True)
@number_option("--supply", "V", "Voltage at the servos.  [default: that of their figures]")
@click.option("--static", is_flag=True, help="Weights alone, without inertia.")
@number_option("--capacity", "AH", "Of the battery: tells how long it lasts.")
@click.option("--out", type=click.Path(path_type=Path), metavar="DIR", help="Write a table, pictures and a page here.")
@json_option
def loads(
    robot: str,
    payload: float,
    supply: float | None,
    static: bool,
    capacity: float | None,
    out: Path | None,
    as_json: bool,
    **asked: Any,
) -> int:
    """Tell what every joint bears through a walk, and whether its servo carries it.

    The factor is stall torque over peak torque: below 1 the robot cannot stand, below 1.5 its servos stall or burn,
    below 3 it walks warm and without reserve. The exit code is 0 only if every factor is at least 1.5 and the robot
    doesn't tip.
    """
    from tarsus.cli.planning import plan
    from tarsus.load.loads import joint_loads
    from tarsus.load.supply import supply_load
    from tarsus.report.loads_summary import loads_summary
    from tarsus.report.loads_table import loads_lines, loads_table, loads_verdict

    if out is not None:
        make_folder(out)
    motion = plan(robot, asked)
    found = joint_loads(motion.robot, motion, payload=payload, supply=supply, inertial=not static)
    drawn = supply_load(found, capacity=capacity)
    summary = loads_summary(found, drawn)
    if not as_json:
        show(loads_table(summary), *loads_lines(summary), loads_verdict(summary))
    files: list[Path] = []
    if out is not None:
        from tarsus.report.loads_files import write_loads

        files = write_loads(found, summary, out)
    if as_json:
        print_json({**summary, "files": [str(file) for file in files]})
    for file in files if not as_json else ():
        click.echo(f"wrote {file}")
    return 0 if summary["carried"] else 1
