"""`tarsus pose`: move the body over fixed feet."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import click

from tarsus.cli.folder import require_folder
from tarsus.cli.output import print_json, show
from tarsus.cli.pulses import pose_pulses, pulse_table, pulses_option
from tarsus.cli.values import examples, json_option, number_option, robot_argument

if TYPE_CHECKING:
    from rich.table import Table

    from tarsus.report.standing_summary import Standing

__all__ = ["pose"]


@click.command(
    short_help="Joint angles for a body pose over fixed feet.",
    epilog=examples(
        "tarsus pose strider --pitch 12 --z 20",
        "tarsus pose strider --x 30 --yaw -10 --body-height 120",
        "tarsus pose strider --roll 8 --json",
        "tarsus pose mithi --knee down",
        "tarsus pose phantomx --z -15 --picture pose.png",
        "tarsus pose strider --z 20 --pulses my-strider.toml",
    ),
)
@robot_argument
@number_option("--x", "MM", "Move the body forward.", default=0.0)
@number_option("--y", "MM", "Move the body to the left.", default=0.0)
@number_option("--z", "MM", "Move the body up.", default=0.0)
@number_option("--roll", "DEG", "Roll: the left side up.", default=0.0)
@number_option("--pitch", "DEG", "Pitch: the front down.", default=0.0)
@number_option("--yaw", "DEG", "Yaw: to the left.", default=0.0)
@number_option("--body-height", "MM", "Body height before the displacement.  [default: the robot's]")
@number_option("--swing-height", "MM", "Swing height for which the feet are placed.  [default: the robot's]", least=0)
@click.option(
    "--knee", type=click.Choice(["up", "down"]), default="up", show_default=True, help="Configuration of the knees."
)
@click.option(
    "--picture", type=click.Path(path_type=Path), metavar="FILE", help="Draw the robot to this file (png, svg, pdf)."
)
@pulses_option("Print the servo commands, and write them to pulses.csv.")
@json_option
def pose(
    robot: str,
    knee: Literal["up", "down"],
    picture: Path | None,
    pulses: Path | None,
    as_json: bool,
    **displacement: Any,
) -> int:
    """Move the body while the feet stay on their rest footholds, those in which a walk starts and ends.

    Prints the joint angles. A leg that can't reach its foothold is in the air; the centre of mass and the support
    polygon of the other feet determine whether the robot stands. The exit code is 0 only if all legs reach their
    footholds, the body is above the ground and the robot stands.
    """
    from tarsus.report.tables import angle_table, number, verdict

    if picture is not None:
        require_folder(picture, "--picture", "matplotlib")
    standing = _standing(robot, knee, displacement)
    summary = standing.summary()
    if picture is not None:
        _draw(standing, picture)
        summary["files"] = [str(picture)]
    table: list[Table] = []
    if pulses is not None and summary["possible"]:
        calibration, commands, written = pose_pulses(standing.solution, pulses, Path())
        table = [pulse_table(calibration, commands)]
        summary |= {"commands": commands, "units": calibration.units}
        summary["files"] = [*summary.get("files", []), str(written)]
    if as_json:
        print_json(summary)
        return 0 if summary["possible"] else 1
    margin = number(summary["margin_mm"], "mm") if standing.contacts.any() else "none, no foot is on the ground"
    show(angle_table(summary), f"stability margin: {margin}", *(f"assumed: {text}" for text in summary["assumed"]))
    show(verdict(summary))
    fraction = summary["feasible_fraction"]
    displaced = any(displacement[name] for name in ("x", "y", "z", "roll", "pitch", "yaw"))
    if displaced and not summary["possible"] and fraction is not None:
        show(f"feasible with every foot on its foothold: {fraction * 100:.1f} % of this displacement")
    show(*table)
    for file in summary.get("files", []):
        click.echo(f"wrote {file}")
    return 0 if summary["possible"] else 1


def _standing(name: str, knee: Literal["up", "down"], displacement: dict[str, Any]) -> Standing:
    import numpy as np

    from tarsus.kinematics.inverse import inverse_kinematics
    from tarsus.kinematics.pose import Pose
    from tarsus.kinematics.stance import default_body_height, default_stance
    from tarsus.report.standing_summary import Standing
    from tarsus.robot.file import load_robot

    robot = load_robot(name)
    height = default_body_height(robot) if displacement["body_height"] is None else displacement["body_height"] / 1000
    rise = None if displacement["swing_height"] is None else displacement["swing_height"] / 1000
    feet = np.asarray(default_stance(robot, height, swing_height=rise)) + np.array([0.0, 0.0, height])
    start = Pose.from_rpy(position=(0.0, 0.0, height))
    roll, pitch, yaw = np.radians([displacement["roll"], displacement["pitch"], displacement["yaw"]])
    position = np.array([displacement["x"], displacement["y"], displacement["z"]]) / 1000 + start.position
    body = Pose.from_rpy(roll, pitch, yaw, position)
    return Standing(solution=inverse_kinematics(robot, feet, body, knee=knee), start=start)


def _draw(standing: Standing, picture: Path) -> None:
    from tarsus.report.skeleton import plot_robot
    from tarsus.report.style import save_figure

    solution = standing.solution
    figure = plot_robot(solution.robot, solution.angles, body=standing.body, contacts=standing.contacts)
    save_figure(figure, picture)
