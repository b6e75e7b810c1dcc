"""`tarsus simulate`: a walk or a scenario in physics."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tarsus.cli.folder import make_folder, require_folder
from tarsus.cli.output import print_json, progress_bar, show
from tarsus.cli.values import examples, json_option, number_option, robot_argument
from tarsus.cli.walk_options import compensate_option, walk_options

if TYPE_CHECKING:
    from tarsus.cli.simulated_run import SimulatedRun

__all__ = ["simulate"]

_VIDEOS = (".mp4", ".gif")


@click.command(
    epilog=examples(
        "tarsus simulate strider",
        "tarsus simulate phantomx --gait wave --distance 200 --servos ideal",
        "tarsus simulate ch3r --compensate",
        "tarsus simulate strider --twist 40,0,10 --duration 3 --terrain ramp:slope=5",
        'tarsus simulate strider --scenario "at 0 s: walk 50 mm/s; at 4 s: stop; at 6 s: sit"',
        "tarsus simulate strider --terrain blocks:rise=20,seed=1 --out simulated --video walk.gif",
    )
)
@robot_argument
@walk_options
@compensate_option
@click.option(
    "--scenario",
    metavar="SCENARIO",
    help="Run this scenario (file or timeline) through the controller, in place of a planned walk.",
)
@click.option(
    "--terrain",
    default="flat",
    show_default=True,
    metavar="KIND[:NAME=VALUE,...]",
    help="flat, ramp, step, stairs, blocks, smooth, gaps, box or FILE.png, such as blocks:rise=20,seed=1 (mm, deg).",
)
@number_option("--friction", "NUMBER", "Coefficient of friction.  [default: 0.8]", above=0)
@click.option(
    "--servos",
    type=click.Choice(["catalogue", "ideal"]),
    default="catalogue",
    show_default=True,
    help="Torque, speed and stiffness of the servos in the robot file, or ideal servos.",
)
@click.option(
    "--sensors",
    default="blind",
    show_default=True,
    metavar="SUITE",
    help="What the controller of a scenario reads: ideal, camera, hobby, smart or blind.",
)
@click.option("--seed", type=int, default=0, show_default=True, help="Random seed of the sensor noise.")
@click.option(
    "--out", type=click.Path(path_type=Path), metavar="DIR", help="Write every sample to a table (CSV) in this folder."
)
@click.option("--zarr", is_flag=True, help="Also write a Zarr store to the folder.")
@click.option(
    "--video",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="Write a video, .mp4 or .gif (of the first 20 s at most).",
)
@click.option("--view", is_flag=True, help="Replay in MuJoCo's viewer, where there is a screen.")
@json_option
def simulate(
    robot: str,
    scenario: str | None,
    out: Path | None,
    zarr: bool,
    video: Path | None,
    view: bool,
    as_json: bool,
    **options: Any,
) -> int:
    """Simulate a walk in physics (MuJoCo), and compare it with the plan.

    A planned walk is executed as it is, without feedback; a scenario runs through the controller, which reads the
    simulated sensors. The exit code is 0 only if the robot neither fell nor stalled, and every command of a scenario
    was met in full.
    """
    from tarsus.cli.simulated_run import run_plan, run_timeline, write_run
    from tarsus.cli.viewer import replay, require_screen
    from tarsus.report.simulation_summary import simulation_summary, simulation_table, simulation_verdict
    from tarsus.simulation.terrain.from_text import terrain_from_text

    if view:
        require_screen()
    if video is not None and video.suffix.lower() not in _VIDEOS:
        raise click.UsageError(f"--video {video}: the name must end in {' or '.join(_VIDEOS)}")
    if video is not None:
        require_folder(video, "--video", "matplotlib")
    if zarr and out is None:
        raise click.UsageError("--zarr needs --out, the folder to write to")
    if out is not None:
        make_folder(out, *(("xarray", "zarr") if zarr else ()))
    terrain, friction = options.pop("terrain"), options.pop("friction")
    plant: dict[str, Any] = {name: options.pop(name) for name in ("servos", "sensors", "seed")}
    plant["terrain"] = terrain_from_text(terrain, friction=friction)
    with progress_bar(enabled=not as_json) as progress:
        found = (
            run_plan(robot, options, plant, progress)
            if scenario is None
            else run_timeline(scenario, robot, options, plant, progress)
        )
    summary = {
        "robot": found.trace.robot.name,
        "terrain": terrain,
        "servos": plant["servos"],
        "sensors": plant["sensors"],
        **simulation_summary(found.outcome, found.planned, found.command_problems),
        "assumed": list(found.assumed),
    }
    if not as_json:
        show(simulation_table(summary), *_assumptions(found), simulation_verdict(summary))
    with progress_bar(enabled=not as_json) as progress:
        files = write_run(found, out=out, zarr=zarr, video=video, progress=progress)
    if as_json:
        print_json({**summary, "files": [str(file) for file in files]})
    for file in files if not as_json else ():
        click.echo(f"wrote {file}")
    if view:
        replay(found)
    return 0 if summary["ok"] else 1


def _assumptions(found: SimulatedRun) -> list[str]:
    return ["assumed:\n" + "\n".join(f"  {line}" for line in found.assumed)] if found.assumed else []
