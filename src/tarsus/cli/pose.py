"""`tarsus pose`: move the body over feet that stand still."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import click

from tarsus.cli.output import print_json, show
from tarsus.cli.values import examples, json_option, number_option, robot_argument

if TYPE_CHECKING:
    from tarsus.report.standing_summary import Standing

__all__ = ["pose"]


@click.command(
    epilog=examples(
        "tarsus pose strider --pitch 12 --z 20",
        "tarsus pose strider --x 30 --yaw -10 --body-height 120",
        "tarsus pose strider --roll 8 --json",
        "tarsus pose mithi --knee down",
        "tarsus pose phantomx --z -15 --picture pose.png",
    )
)
@robot_argument
@number_option("--x", "MM", "Move the body forward.", default=0.0)
@number_option("--y", "MM", "Move it to the left.", default=0.0)
@number_option("--z", "MM", "Move it up.", default=0.0)
@number_option("--roll", "DEG", "Turn it about x: the left side up.", default=0.0)
@number_option("--pitch", "DEG", "Turn it about y: the front down.", default=0.0)
@number_option("--yaw", "DEG", "Turn it about z: to the left.", default=0.0)
@number_option("--body-height", "MM", "Height of the body's origin before it is moved.  [default: the robot's own]")
@click.option("--knee", type=click.Choice(["up", "down"]), default="up", show_default=True, help="Where the knees are.")
@click.option(
    "--picture", type=click.Path(path_type=Path), metavar="FILE", help="Draw it to this file (png, svg, pdf)."
)
@json_option
def pose(robot: str, knee: Literal["up", "down"], picture: Path | None, as_json: bool, **move: Any) -> int:
    """Move the body while the feet stand still: the joint angles, or why not.

    The feet stand where they stand at rest. A leg that can't reach its foothold is in the air; whether the others
    hold the robot is for its centre of mass and their support polygon to say. The exit code is 0 only if all legs
    reach and the robot stands.
    """
    from tarsus.report.tables import angle_table, number, verdict

    standing = _standing(robot, knee, move)
    summary = standing.summary()
    if picture is not None:
        _draw(standing, picture)
        summary["files"] = [str(picture)]
    if as_json:
        print_json(summary)
        return 0 if summary["possible"] else 1
    margin = number(summary["margin_mm"], "mm") if standing.contacts.any() else "none, no leg stands"
    show(angle_table(summary), f"stability margin: {margin}", *(f"assumed: {text}" for text in summary["assumed"]))
    show(verdict(summary))
    share = summary["share_that_works"]
    if not summary["possible"] and share is not None:
        show(f"with every foot where it stands, {share * 100:.1f} % of this move works")
    if picture is not None:
        click.echo(f"wrote {picture}")
    return 0 if summary["possible"] else 1


def _standing(name: str, knee: Literal["up", "down"], move: dict[str, Any]) -> Standing:
    import numpy as np

    from tarsus.kinematics.inverse import inverse_kinematics
    from tarsus.kinematics.pose import Pose
    from tarsus.kinematics.stance import default_body_height, default_stance
    from tarsus.report.standing_summary import Standing
    from tarsus.robot.file import load_robot

    robot = load_robot(name)
    height = default_body_height(robot) if move["body_height"] is None else move["body_height"] / 1000
    feet = np.asarray(default_stance(robot, height)) + np.array([0.0, 0.0, height])
    start = Pose.from_rpy(position=(0.0, 0.0, height))
    roll, pitch, yaw = np.radians([move["roll"], move["pitch"], move["yaw"]])
    place = np.array([move["x"], move["y"], move["z"]]) / 1000 + start.position
    body = Pose.from_rpy(roll, pitch, yaw, place)
    return Standing(solution=inverse_kinematics(robot, feet, body, knee=knee), start=start)


def _draw(standing: Standing, picture: Path) -> None:
    from tarsus.report.skeleton import plot_robot
    from tarsus.report.style import save_figure

    solution = standing.solution
    figure = plot_robot(solution.robot, solution.angles, body=standing.body, contacts=standing.contacts)
    save_figure(figure, picture)
