"""`tarsus robots show`: print a robot's numbers with their sources."""

from __future__ import annotations

import click

from tarsus.cli.output import print_json, show
from tarsus.cli.values import examples, json_option, robot_argument

__all__ = ["show_robot"]


@click.command(
    "show",
    epilog=examples(
        "tarsus robots show strider",
        "tarsus robots show phantomx --json",
    ),
)
@robot_argument
@json_option
def show_robot(robot: str, as_json: bool) -> int:
    """Show a robot's numbers, each with its source and confidence.

    Confidence: A from the primary file, B from a secondary copy, C general knowledge, or a guess.
    """
    from tarsus.report.robot_summary import dimensions, robot_summary
    from tarsus.report.tables import robot_table, source_table
    from tarsus.robot.file import load_robot

    loaded = load_robot(robot)
    rows = dimensions(loaded)
    if as_json:
        print_json({**robot_summary(loaded), "dimensions": rows})
        return 0
    descriptions = [f"{source.source}. {source.note}".strip() for source in loaded.sources]
    show(robot_table([robot_summary(loaded)]), source_table(rows))
    show(*(f"({number}) {text}" for number, text in enumerate(descriptions, start=1)))
    return 0
