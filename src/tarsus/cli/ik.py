"""`tarsus ik`: inverse kinematics of the legs."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import click

from tarsus.cli.output import print_json, show
from tarsus.cli.values import Numbers, examples, json_option, robot_argument

__all__ = ["ik"]


# Coordinates are often negative, and must not be parsed as options.
@click.command(
    short_help="Inverse kinematics: joint angles for foot positions.",
    context_settings={"ignore_unknown_options": True},
    epilog=examples(
        "tarsus ik strider --leg LF 230 130 -110",
        "tarsus ik strider --leg LF --frame coxa 170 20 -110",
        "tarsus ik strider --all 170,0,-110 --frame coxa",
        "tarsus ik makeyourpet --leg RM 0 -220 -60 --json",
    ),
)
@robot_argument
@click.argument("coordinates", nargs=-1, metavar="[X Y Z]...")
@click.option("--leg", metavar="LEG", help="Only this leg, with one target.")
@click.option("--all", "same_for_all", type=Numbers("X", "Y", "Z"), metavar="X,Y,Z", help="One target for every leg.")
@click.option("--file", type=click.Path(path_type=Path), metavar="FILE", help="Read the targets from a JSON file.")
@click.option(
    "--frame",
    type=click.Choice(["body", "coxa"]),
    default="body",
    show_default=True,
    help="Frame of the targets: the body's, or the coxa frame of each leg.",
)
@click.option(
    "--knee", type=click.Choice(["up", "down"]), default="up", show_default=True, help="Configuration of the knees."
)
@json_option
def ik(
    robot: str,
    coordinates: tuple[str, ...],
    leg: str | None,
    same_for_all: tuple[float, float, float] | None,
    file: Path | None,
    frame: Literal["body", "coxa"],
    knee: Literal["up", "down"],
    as_json: bool,
) -> int:
    """Inverse kinematics: the joint angles for targets X Y Z of the feet, in mm.

    One target for each leg, in the order of the legs, or that of one leg. A JSON file contains them as a list, as a
    list of three for each leg, or under the key feet_mm, as printed by tarsus fk --json. For a target out of reach, the
    angles are those of the nearest reachable point. The exit code is 0 only if every leg reaches its target.
    """
    from tarsus.cli.leg_values import POINTS, leg_of, read_leg_values
    from tarsus.report.leg_summary import FRAMES, ik_summary, target_table
    from tarsus.report.tables import verdict
    from tarsus.robot.file import load_robot

    loaded = load_robot(robot)
    index = None if leg is None else leg_of(loaded, leg)
    targets = read_leg_values(loaded, POINTS, coordinates, same_for_all=same_for_all, file=file, leg=index)
    legs = range(loaded.legs) if index is None else [index]
    summary = ik_summary(loaded, targets / 1000, legs, frame=frame, knee=knee)
    if as_json:
        print_json(summary)
    else:
        notes = (f"assumed: {text}" for text in summary["assumed"])
        show(target_table(summary), f"targets in the {FRAMES[frame == 'coxa']}", *notes, verdict(summary))
    return 0 if summary["possible"] else 1
