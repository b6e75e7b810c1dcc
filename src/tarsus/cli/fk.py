"""`tarsus fk`: forward kinematics of the legs."""

from __future__ import annotations

from pathlib import Path

import click

from tarsus.cli.output import print_json, show
from tarsus.cli.values import Numbers, examples, json_option, robot_argument

__all__ = ["fk"]


# Angles are often negative, and must not be parsed as options.
@click.command(
    short_help="Forward kinematics: points of the legs for joint angles.",
    context_settings={"ignore_unknown_options": True},
    epilog=examples(
        "tarsus fk strider --leg LF 10 40 -100",
        "tarsus fk phantomx --all 0,40,-100",
        "tarsus fk strider --file angles.json --json",
    ),
)
@robot_argument
@click.argument("angles", nargs=-1, metavar="[ANGLE]...")
@click.option("--leg", metavar="LEG", help="Only this leg, with its three angles, and all of its points.")
@click.option("--all", "same_for_all", type=Numbers("C", "F", "T"), metavar="C,F,T", help="Three angles for every leg.")
@click.option("--file", type=click.Path(path_type=Path), metavar="FILE", help="Read the angles from a JSON file.")
@json_option
def fk(
    robot: str,
    angles: tuple[str, ...],
    leg: str | None,
    same_for_all: tuple[float, float, float] | None,
    file: Path | None,
    as_json: bool,
) -> int:
    """Forward kinematics: where the feet are for given joint ANGLES, in deg.

    Three angles for each leg (coxa, femur, tibia), in the order of the legs, or those of one leg. A JSON file contains
    them as for tarsus rest. The points are printed in the body frame and in the coxa frame of each leg. The exit code
    is 0 only if all angles are within the joint limits.
    """
    import numpy as np

    from tarsus.cli.leg_values import ANGLES, leg_of, read_leg_values
    from tarsus.report.leg_summary import FRAMES, fk_summary, point_table
    from tarsus.report.tables import verdict
    from tarsus.robot.file import load_robot

    loaded = load_robot(robot)
    index = None if leg is None else leg_of(loaded, leg)
    degrees = read_leg_values(loaded, ANGLES, angles, same_for_all=same_for_all, file=file, leg=index)
    summary = fk_summary(loaded, np.radians(degrees), range(loaded.legs) if index is None else [index])
    if as_json:
        print_json(summary)
    else:
        show(point_table(summary), *FRAMES, verdict(summary))
    return 0 if summary["possible"] else 1
