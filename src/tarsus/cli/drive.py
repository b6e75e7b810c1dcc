"""`tarsus drive`: run a scenario, print a summary, write tables and pictures."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tarsus.cli.folder import make_folder
from tarsus.cli.output import print_json, progress_bar, show
from tarsus.cli.values import examples, json_option, number_option

if TYPE_CHECKING:
    from rich.table import Table

    from tarsus.control.loop.recording import Recording
    from tarsus.load.loads import JointLoads

__all__ = ["drive"]

_DEFAULT_ROBOT = "strider"


@click.command(
    epilog=examples(
        'tarsus drive --dry "at 0 s: walk 0.05 m/s; at 3 s: gait wave; at 6 s: stop"',
        'tarsus drive --dry "at 0 s: walk 60 mm/s turn 10 deg/s" --robot phantomx --rate 50 --json',
        'tarsus drive --dry "at 0 s: body pitch 5 deg; at 1 s: sit" --out driven --no-animation',
    )
)
@click.argument("scenario", metavar="SCENARIO")
@click.option("--dry", is_flag=True, help="Run on an ideal plant, without servos.")
@click.option("--robot", metavar="ROBOT", help="Robot to drive.  [default: the scenario's, else strider]")
@click.option(
    "--out", type=click.Path(path_type=Path), metavar="DIR", help="Write tables, motion and figures to this folder."
)
@click.option("--no-animation", is_flag=True, help="Do not write the animation (of the first 20 s at most).")
@click.option("--no-guard", is_flag=True, help="Run without the guard, which checks the joint angles of every tick.")
@number_option("--rate", "HZ", "Ticks per second.  [default: the scenario's, else 100]", above=0)
@json_option
def drive(
    scenario: str,
    dry: bool,
    robot: str | None,
    out: Path | None,
    no_animation: bool,
    no_guard: bool,
    rate: float | None,
    as_json: bool,
) -> int:
    """Drive a robot through a scenario: a timeline of commands.

    SCENARIO is the path of a scenario file (TOML), or the timeline itself: commands such as "at 2 s: walk 0.1 m/s",
    with semicolons between them. The exit code is 0 only if every command was met in full, the guard did not
    intervene, and the motion is possible.
    """
    from tarsus.cli.timeline import timeline_of
    from tarsus.scenario.runner import run_scenario
    from tarsus.scenario.summary import drive_summary

    if not dry:
        raise click.UsageError("give --dry, which runs the scenario on an ideal plant; tarsus run drives servos")
    if out is not None:
        make_folder(out, "matplotlib")
    timeline = timeline_of(scenario, rate)
    recording = run_scenario(timeline, robot=robot or timeline.robot or _DEFAULT_ROBOT, guard=not no_guard)
    found = _loads(recording)
    summary = {**drive_summary(recording), "loads": _load_numbers(found)}
    if not as_json:
        from tarsus.report.tables import verdict

        show(_table(summary), verdict(summary))
    files = [] if out is None else _write(recording, out, animation=not no_animation, quiet=as_json)
    if as_json:
        print_json({**summary, "files": [str(file) for file in files]})
    for file in files if not as_json else ():
        click.echo(f"wrote {file}")
    return 0 if summary["possible"] else 1


def _loads(recording: Recording) -> JointLoads | None:
    """Return the loads of the longest interval in which the body is off the ground; None where they are unknown."""
    from tarsus.load.loads import joint_loads

    longest = recording.longest_standing
    return None if longest is None or not recording.robot.has_masses else joint_loads(recording.robot, longest)


def _load_numbers(found: JointLoads | None) -> dict[str, Any] | None:
    """Return the peak torque and the safety factor of the most critical coxa, femur and tibia; None without loads."""
    if found is None:
        return None
    from tarsus.load.verdict import joint_verdicts
    from tarsus.report.loads_summary import worst_of_each

    return {
        verdict.joint: {"leg": verdict.leg, "peak_nm": verdict.peak, "factor": verdict.factor}
        for verdict in worst_of_each(joint_verdicts(found))
    }


def _write(recording: Recording, out: Path, *, animation: bool, quiet: bool) -> list[Path]:
    from tarsus.cli.files import write_walk
    from tarsus.gait.storage import save_motion
    from tarsus.report.style import save_figure
    from tarsus.report.timeline import plot_timeline

    log, motion, picture = out / "log.csv", out / "motion.npz", out / "timeline.png"
    recording.to_csv(log)
    save_motion(recording.motion, motion)
    save_figure(plot_timeline(recording), picture)
    with progress_bar(enabled=not quiet) as progress:
        return [log, motion, picture, *write_walk(recording.motion, out, animation=animation, progress=progress)]


def _table(summary: dict[str, Any]) -> Table:
    """Return the summary as a table of two columns."""
    from rich.table import Table

    end, margin = summary["end"], summary["least_margin"]
    table = Table(box=None, show_header=False, pad_edge=False)
    table.add_row("robot", summary["robot"])
    if summary["scenario"]:
        table.add_row("scenario", summary["scenario"])
    table.add_row("duration", f"{summary['duration_s']:.2f} s at {summary['rate_hz']:g} ticks per second")
    table.add_row("walked", f"{summary['walked_s']:.2f} s, {summary['distance_mm']:.0f} mm, {summary['steps']} steps")
    table.add_row("gaits", ", ".join(summary["gaits"]))
    table.add_row(
        "end", f"x {end['x_mm']:z.1f} mm, y {end['y_mm']:z.1f} mm, yaw {end['turned_deg']:z.1f} deg, {end['state']}"
    )
    table.add_row("peak speed", f"{summary['top_speed_mm_s']:.1f} mm/s, {summary['top_turn_deg_s']:.1f} deg/s")
    table.add_row(
        "stability margin",
        "none: the body is never off the ground"
        if margin is None
        else f"minimum {margin['mm']:.1f} mm at {margin['at_s']:.2f} s",
    )
    for joint, load in (summary["loads"] or {}).items():
        factor = "" if load["factor"] != load["factor"] else f", safety factor {load['factor']:.2f}"
        table.add_row(f"peak torque, {joint}", f"{load['peak_nm']:.3f} N m ({load['leg']}){factor}")
    for each in summary["unmet"]:
        table.add_row("not met", f"{each['from_s']:.2f} to {each['until_s']:.2f} s: {each['text']}")
    unmet = [{name: value for name, value in each.items() if name != "kind"} for each in summary["unmet"]]
    for limit in (limit for limit in summary["limits"] if limit not in unmet):
        table.add_row("limited", f"{limit['from_s']:.2f} to {limit['until_s']:.2f} s: {limit['text']}")
    number = sum(summary["interventions"].values())
    table.add_row("guard", f"{number} intervention{'s' * (number != 1)}" if summary["guard"] else "none")
    for assumed in summary["assumed"]:
        table.add_row("assumed", assumed)
    return table
