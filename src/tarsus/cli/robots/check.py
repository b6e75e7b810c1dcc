"""`tarsus robots check`: validate a robot file, its values and its gaits."""

from __future__ import annotations

from typing import Any

import click

from tarsus.cli.output import print_json, show
from tarsus.cli.values import examples, json_option
from tarsus.errors import RobotFileError

__all__ = ["check"]


@click.command(
    short_help="Check a robot file, and plan a walk with each gait.",
    epilog=examples(
        "tarsus robots check my-robot.toml",
        "tarsus robots check my-robot.toml --strict",
        "tarsus robots check mithi --json",
    ),
)
@click.argument("file")
@click.option("--strict", is_flag=True, help="Treat warnings as errors: exit code 1.")
@json_option
def check(file: str, strict: bool, as_json: bool) -> int:
    """Check a robot file for errors, implausible values and missing values, and plan a walk with each gait.

    A warning names a value that no robot like this one has, and its likely cause: a unit, a sign, a zero, the order or
    a digit. The exit code is 0 only if the file has no errors and the robot can walk with its own gait; with --strict
    also only without warnings.
    """
    from tarsus.report.robot_check import check_robot
    from tarsus.robot.file import load_robot

    try:
        robot = load_robot(file)
    except RobotFileError as error:
        if not as_json:
            raise
        print_json({"file": file, "possible": False, "problems": list(error.problems), "missing": [], "warnings": []})
        return 1
    report = check_robot(robot)
    if as_json:
        print_json({"file": file, **report})
    else:
        _print(file, report, strict=strict)
    return 0 if report["possible"] and not (strict and report["warnings"]) else 1


def _print(file: str, report: dict[str, Any], *, strict: bool) -> None:
    from rich.text import Text

    from tarsus.report.tables import gait_table, robot_table

    warnings = report["warnings"]
    show(robot_table([report["robot"]]), f"{file}: no errors, {_count(len(warnings), 'warning')}")
    for line in report["missing"]:
        show(f"  missing: {line}")
    if report["estimated"]:
        show(
            f"  estimated, not measured: {', '.join(report['estimated'])}; verdicts on loads and servos depend on them"
        )
    for warning in warnings:
        show(Text(f"  {'error' if strict else 'warning'}: {warning['text']}", style="red" if strict else "yellow"))
    show(gait_table(report["gaits"]), *_why_not(report["gaits"]))
    if report["possible"]:
        show(Text(f"can walk with its own gait, {report['robot']['gait']}", style="bold green"))
    else:
        show(Text(f"cannot walk: {report['problems'][-1]}", style="bold red"))


def _why_not(trials: list[dict[str, Any]]) -> list[str]:
    """Return a line for each reason, with the gaits that it makes impossible."""
    gaits: dict[str, list[str]] = {}
    for trial in trials:
        for problem in trial["problems"]:
            gaits.setdefault(problem, []).append(trial["gait"])
    return [f"  {', '.join(names)}: {problem}" for problem, names in gaits.items()]


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number or 'no'} {noun}s"
