"""`tarsus rest`: resting pose for given joint angles."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tarsus.cli.folder import require_folder
from tarsus.cli.output import print_json, show
from tarsus.cli.values import Numbers, examples, json_option, robot_argument

if TYPE_CHECKING:
    from tarsus.robot.robot import Robot

__all__ = ["rest"]


# Angles are often negative, and must not be parsed as options.
@click.command(
    short_help="Resting pose on flat ground for joint angles.",
    context_settings={"ignore_unknown_options": True},
    epilog=examples(
        "tarsus rest strider --all 0,-30,-60",
        "tarsus rest strider 0 40 -100 0 40 -100 0 40 -100 0 40 -100 0 40 -100 0 90 -90",
        "tarsus rest strider --file angles.json --json",
        "tarsus rest phantomx --all 0,60,-110 --picture rest.png",
    ),
)
@robot_argument
@click.argument("angles", nargs=-1, metavar="[ANGLE]...")
@click.option("--all", "same_for_all", type=Numbers("C", "F", "T"), metavar="C,F,T", help="Three angles for every leg.")
@click.option("--file", type=click.Path(path_type=Path), metavar="FILE", help="Read the angles from a JSON file.")
@click.option(
    "--picture", type=click.Path(path_type=Path), metavar="FILE", help="Draw the robot to this file (png, svg, pdf)."
)
@json_option
def rest(
    robot: str,
    angles: tuple[str, ...],
    same_for_all: tuple[float, float, float] | None,
    file: Path | None,
    picture: Path | None,
    as_json: bool,
) -> int:
    """Compute the resting pose on flat ground with the joints held at ANGLES, in deg.

    Three angles for each leg (coxa, femur, tibia), in the order of the legs. A JSON file contains them as a list, as a
    list of three for each leg, or under the key angles_deg, as printed by tarsus pose --json. The exit code is 0 only
    if the robot has a stable resting pose and all angles are within the joint limits.
    """
    import numpy as np

    from tarsus.cli.leg_values import ANGLES, read_leg_values
    from tarsus.kinematics.rest import resting_pose
    from tarsus.report.standing_summary import rest_summary
    from tarsus.report.tables import verdict
    from tarsus.robot.file import load_robot

    if picture is not None:
        require_folder(picture, "--picture", "matplotlib")
    loaded = load_robot(robot)
    radians = np.radians(read_leg_values(loaded, ANGLES, angles, same_for_all=same_for_all, file=file))
    result = resting_pose(loaded, radians)
    summary = rest_summary(loaded, radians, result)
    if picture is not None:
        _draw(loaded, radians, result, picture)
        summary["files"] = [str(picture)]
    if as_json:
        print_json(summary)
    else:
        _print(summary)
        show(verdict(summary))
        if picture is not None:
            click.echo(f"wrote {picture}")
    return 0 if summary["possible"] else 1


def _print(summary: dict[str, Any]) -> None:
    body = summary["body"]
    show(
        f"{summary['robot']} {summary['description']}",
        f"roll {body['roll_deg']:z.2f} deg, pitch {body['pitch_deg']:z.2f} deg, body height {body['z_mm']:z.1f} mm",
        f"feet on the ground: {', '.join(summary['contacts']) or 'none'}",
        *(f"assumed: {text}" for text in summary["assumed"]),
    )


def _draw(robot: Robot, radians: Any, result: Any, picture: Path) -> None:
    from tarsus.report.sample import touching_points
    from tarsus.report.skeleton import plot_robot
    from tarsus.report.style import save_figure

    figure = plot_robot(
        robot,
        radians,
        body=result.body,
        contacts=result.contacts,
        support=touching_points(result, radians),
        title=f"{robot.name} {result.describe().partition(';')[0]}",
    )
    save_figure(figure, picture)
