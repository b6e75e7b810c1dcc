"""`tarsus robots check`: validate a robot file."""

from __future__ import annotations

from typing import Any

import click

from tarsus.cli.output import print_json, show
from tarsus.cli.values import examples, json_option
from tarsus.errors import RobotFileError

__all__ = ["check"]


@click.command(
    epilog=examples(
        "tarsus robots check my-robot.toml",
        "tarsus robots check mithi --json",
    )
)
@click.argument("file")
@json_option
def check(file: str, as_json: bool) -> int:
    """Check a robot file for errors and missing values, and whether the robot can walk.

    The exit code is 0 only if the file has no errors and the robot can walk; missing optional values are listed.
    """
    from tarsus.report.robot_summary import check_robot
    from tarsus.robot.file import load_robot

    try:
        robot = load_robot(file)
    except RobotFileError as error:
        if not as_json:
            raise
        print_json({"file": file, "possible": False, "problems": list(error.problems), "missing": []})
        return 1
    report = check_robot(robot)
    if as_json:
        print_json({"file": file, **report})
    else:
        _print(file, report)
    return 0 if report["possible"] else 1


def _print(file: str, report: dict[str, Any]) -> None:
    from tarsus.report.tables import number, robot_table, verdict

    show(robot_table([report["robot"]]), f"{file}: no errors")
    for line in report["missing"]:
        show(f"  missing: {line}")
    if report["possible"]:
        show(f"longest stroke straight ahead: {number(report['longest_stroke_mm'], 'mm')}")
    else:
        show("walking:", verdict(report))
