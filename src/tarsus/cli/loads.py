"""`tarsus loads`: joint loads over a walk, with a verdict on the servos."""

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
    short_help="Joint loads over a walk, with a verdict on each servo.",
    epilog=examples(
        "tarsus loads strider",
        "tarsus loads phantomx --body-height 130 --gait ripple",
        "tarsus loads strider --payload 0.2 --supply 6.8 --distance 300",
        "tarsus loads strider --static --capacity 3 --json",
        "tarsus loads strider --distance 300 --out loads",
    ),
)
@robot_argument
@walk_options
@number_option("--payload", "KG", "Payload at the body's origin.", default=0.0, show_default=True, least=0)
@number_option("--supply", "V", "Supply voltage.  [default: that of the servo ratings]", above=0)
@click.option("--static", is_flag=True, help="Quasi-static: without inertia.")
@number_option("--capacity", "AH", "Battery capacity, to estimate the battery life.", above=0)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Write a table, figures and an HTML page to this folder.",
)
@json_option
def loads(
    robot: str,
    payload: float,
    supply: float | None,
    static: bool,
    capacity: float | None,
    out: Path | None,
    as_json: bool,
    **options: Any,
) -> int:
    """Compute the joint loads over a walk, with a verdict on each servo.

    Peak torques are given twice: with vertical contact forces, and by compliant statics, in which servos give way like
    springs and feet press against each other through friction. The higher one counts.

    The factor is stall torque over peak torque: below 1 the robot cannot stand, below 1.5 its servos stall or burn,
    below 3 they run warm and have no reserve. The exit code is 0 only if every factor is at least 1.5 and the robot
    does not tip.
    """
    from tarsus.cli.planning import plan
    from tarsus.load.compliant.for_loads import compliant_or_missing
    from tarsus.load.loads import joint_loads
    from tarsus.load.supply import supply_load
    from tarsus.report.loads_summary import loads_summary
    from tarsus.report.loads_table import LEGEND, loads_lines, loads_table, loads_verdict, motion_line

    if out is not None:
        make_folder(out, "matplotlib")
    motion = plan(robot, options)
    joint_load_results = joint_loads(motion.robot, motion, payload=payload, supply=supply, inertial=not static)
    currents = supply_load(joint_load_results, capacity=capacity)
    compliant, missing = compliant_or_missing(joint_load_results)
    summary = loads_summary(joint_load_results, currents, compliant, missing)
    if not as_json:
        show(loads_table(summary), *LEGEND, "", *loads_lines(summary), motion_line(summary), loads_verdict(summary))
    files: list[Path] = []
    if out is not None:
        from tarsus.report.loads_files import write_loads

        files = write_loads(joint_load_results, summary, out)
    if as_json:
        print_json({**summary, "files": [str(file) for file in files]})
    for file in files if not as_json else ():
        click.echo(f"wrote {file}")
    return 0 if summary["carried"] else 1
