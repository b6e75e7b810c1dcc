"""`tarsus servos`: whether a robot's servos do, and which ones would."""

from __future__ import annotations

from typing import Any, Literal

import click

from tarsus.cli.output import print_json, show
from tarsus.cli.values import examples, json_option, number_option, robot_argument
from tarsus.cli.walk_options import walk_options

__all__ = ["servos"]


@click.command(
    epilog=examples(
        "tarsus servos strider --gait wave --body-height 130",
        "tarsus servos strider --factor 1.5 --payload 0.2",
        "tarsus servos phantomx --gait ripple --body-height 130 --distance 300 --json",
        "tarsus servos strider --rule continuous --gait wave --body-height 140",
    )
)
@robot_argument
@walk_options
@number_option("--factor", "N", "Stall torque over peak torque that is asked for.", default=3.0, show_default=True)
@click.option(
    "--rule",
    type=click.Choice(["factor", "continuous"]),
    default="factor",
    show_default=True,
    help="Ask for that factor, or for a lasting load of at most 1/5 of the stall torque.",
)
@number_option("--payload", "KG", "What the body carries, at its origin.", default=0.0, show_default=True)
@number_option("--supply", "V", "Voltage at the servos.  [default: that of their figures]")
@click.option("--static", is_flag=True, help="Weights alone, without inertia.")
@json_option
def servos(
    robot: str,
    factor: float,
    rule: Literal["factor", "continuous"],
    payload: float,
    supply: float | None,
    static: bool,
    as_json: bool,
    **asked: Any,
) -> int:
    """Tell whether the servos of a robot carry it through a walk, and which ones would.

    Every servo of the catalogue is tried with its own mass. The exit code is 0 only if the present servos keep the
    rule, are fast enough, and the robot doesn't tip.
    """
    from rich.text import Text

    from tarsus.cli.planning import plan
    from tarsus.load.loads import joint_loads
    from tarsus.load.sizing import size_servos
    from tarsus.report.loads_summary import servos_summary
    from tarsus.report.loads_table import candidate_table, servo_lines

    motion = plan(robot, asked)
    found = joint_loads(motion.robot, motion, payload=payload, supply=supply, inertial=not static)
    summary = servos_summary(size_servos(motion.robot, found, safety_factor=factor, rule=rule), found)
    done = bool(summary["present_do"] and summary["balanced"])
    if as_json:
        print_json(summary)
        return 0 if done else 1
    show(*(f"{row['leg']} {row['joint']} ({row['servo'] or 'no servo'}): {row['text']}" for row in summary["joints"]))
    table = candidate_table(summary)
    show(table if table.row_count else "no servo of the catalogue would do in all joints")
    show(*servo_lines(summary))
    tips = "" if summary["balanced"] else "; and the robot tips"
    words = "its servos do" if done else f"its servos don't do{tips}"
    show(Text(words, style="bold green" if done else "bold red"))
    return 0 if done else 1
