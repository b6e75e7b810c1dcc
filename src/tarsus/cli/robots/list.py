"""`tarsus robots list`: list the bundled robots."""

from __future__ import annotations

import click

from tarsus.cli.output import print_json, show
from tarsus.cli.values import examples, json_option

__all__ = ["list_all"]


@click.command(
    "list",
    epilog=examples(
        "tarsus robots list",
        "tarsus robots list --json",
    ),
)
@json_option
def list_all(as_json: bool) -> int:
    """List the bundled robots with sizes, masses and servos."""
    from tarsus.report.robot_summary import robot_summary
    from tarsus.report.tables import robot_table
    from tarsus.robot.file import list_robots, load_robot

    summaries = [robot_summary(load_robot(name)) for name in list_robots()]
    if as_json:
        print_json(summaries)
    else:
        unknown = ", ".join(summary["name"] for summary in summaries if summary["mass_kg"] is None)
        show(robot_table(summaries))
        show(
            f"unknown masses: {unknown}. Without masses there are no torques: copy the robot with tarsus robots new "
            "my-robot --from NAME; the file says what to weigh"
        )
    return 0
