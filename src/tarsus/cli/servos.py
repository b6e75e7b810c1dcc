"""`tarsus servos`: servo sizing for a walk."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import click

from tarsus.cli.output import print_json, show
from tarsus.cli.values import examples, json_option, number_option, robot_argument
from tarsus.cli.walk_options import walk_options

if TYPE_CHECKING:
    from tarsus.gait.motion import Motion

__all__ = ["servos"]


@click.command(
    short_help="Evaluate the robot's servos for a walk, and find sufficient ones.",
    epilog=examples(
        "tarsus servos strider --gait wave --body-height 130",
        "tarsus servos strider --factor 1.5 --payload 0.2",
        "tarsus servos phantomx --gait ripple --body-height 140 --distance 300 --json",
        "tarsus servos strider --rule continuous --gait wave --body-height 140",
    ),
)
@robot_argument
@walk_options
@number_option("--factor", "N", "Required stall torque over peak torque.", default=3.0, show_default=True, above=0)
@click.option(
    "--rule",
    type=click.Choice(["factor", "continuous"]),
    default="factor",
    show_default=True,
    help="Require that factor, or an RMS torque of at most 1/5 of the stall torque.",
)
@number_option("--payload", "KG", "Payload at the body's origin.", default=0.0, show_default=True, least=0)
@number_option("--supply", "V", "Supply voltage.  [default: that of the servo ratings]", above=0)
@click.option("--static", is_flag=True, help="Quasi-static: without inertia.")
@json_option
def servos(
    robot: str,
    factor: float,
    rule: Literal["factor", "continuous"],
    payload: float,
    supply: float | None,
    static: bool,
    as_json: bool,
    **options: Any,
) -> int:
    """Evaluate the robot's servos for a walk, list changes that reduce their load, and find sufficient servos.

    The first table lists changes of the walk that raise the safety factor of the robot's own servos: a higher body,
    feet nearer to it, shorter strokes, another gait. The second lists sufficient servos of the catalogue, evaluated
    with their own masses: one servo in all joints, or a set for one bus and one supply voltage. The exit code is 0
    only if the robot's servos satisfy the rule and are fast enough, and the robot does not tip.
    """
    from rich.text import Text

    from tarsus.cli.planning import plan, with_changes
    from tarsus.load.compliant.for_loads import compliant_or_missing
    from tarsus.load.loads import joint_loads
    from tarsus.load.sizing import size_servos
    from tarsus.load.walk_changes import walk_changes
    from tarsus.report.loads_summary import servos_summary
    from tarsus.report.loads_table import SERVO_LEGEND, candidate_table, change_table, on_estimates, servo_lines

    def plan_with(**changes: Any) -> Motion:
        return plan(robot, with_changes(options, changes))

    motion = plan(robot, options)
    loads = joint_loads(motion.robot, motion, payload=payload, supply=supply, inertial=not static)
    compliant, missing = compliant_or_missing(loads)
    sizing = size_servos(motion.robot, loads, safety_factor=factor, rule=rule, compliant=compliant)
    changes = () if sizing.ok else walk_changes(loads, plan_with, safety_factor=factor)
    summary = servos_summary(sizing, loads, changes)
    sufficient = bool(summary["sufficient"] and summary["balanced"])
    if as_json:
        print_json(summary)
        return 0 if sufficient else 1
    show(*(f"{row['leg']} {row['joint']} ({row['servo'] or 'no servo'}): {row['text']}" for row in summary["joints"]))
    for table in (change_table(summary), candidate_table(summary)):
        if table.row_count:
            show(table)
    if not summary["candidates"] and not summary["sets"]:
        show("no servo of the catalogue is sufficient in all joints")
    if missing:
        show(f"compliant statics: not computed: {missing}")
    show(*SERVO_LEGEND, "", *servo_lines(summary))
    tipping = "" if summary["balanced"] else "; the robot tips"
    text = "the robot's servos are sufficient" if sufficient else f"the robot's servos are not sufficient{tipping}"
    text += on_estimates(summary)
    show(Text(text, style="bold green" if sufficient else "bold red"))
    return 0 if sufficient else 1
