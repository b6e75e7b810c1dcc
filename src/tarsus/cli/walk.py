"""`tarsus walk`: plan a walk, print its numbers, write joint angles and figures."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tarsus.cli.folder import make_folder, require_folder
from tarsus.cli.output import print_json, progress_bar, show
from tarsus.cli.pulses import calibration_of, pulses_option, walk_pulses
from tarsus.cli.values import examples, json_option, robot_argument
from tarsus.cli.walk_options import compensate_option, walk_options

if TYPE_CHECKING:
    from tarsus.gait.motion import Motion

__all__ = ["walk"]


@click.command(
    epilog=examples(
        "tarsus walk strider",
        "tarsus walk phantomx --gait ripple --distance 300 --heading -30",
        "tarsus walk strider --curve 90 --centre 0,300",
        "tarsus walk mithi --gait wave --curve -60",
        "tarsus walk strider --twist 40,0,10 --duration 3",
        "tarsus walk strider --distance 200 --stroke 80 --speed 60 --tilt 0,5 --json",
        "tarsus walk strider --distance 200 --out walk --no-animation",
        "tarsus walk strider --gait ripple --html walk.html",
        "tarsus walk strider --pulses my-strider.toml",
    )
)
@robot_argument
@walk_options
@compensate_option
@click.option(
    "--out", type=click.Path(path_type=Path), metavar="DIR", help="Write joint angles (CSV) and figures to this folder."
)
@click.option("--no-animation", is_flag=True, help="Do not write the animation (of the first 20 s at most).")
@click.option(
    "--html",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Write an offline HTML page that plays the walk in 3D.",
)
@pulses_option("Write servo commands (pulses.csv) and a cycle for Arduino (gait_cycle.h), to --out or here.")
@json_option
def walk(
    robot: str,
    out: Path | None,
    no_animation: bool,
    html: Path | None,
    pulses: Path | None,
    as_json: bool,
    **options: Any,
) -> int:
    """Plan a walk and check whether the robot can execute it.

    The path is straight unless --curve or --twist is given. Other parameters have feasible defaults, listed under
    "assumed". The exit code is 0 only if the whole walk is possible.
    """
    from tarsus.cli.planning import plan
    from tarsus.report.tables import verdict, walk_table
    from tarsus.report.walk_summary import walk_summary
    from tarsus.robot.file import load_robot

    if out is not None:
        make_folder(out, "matplotlib")
    if html is not None:
        from tarsus.studio.player import player_template

        require_folder(html, "--html")
        player_template()
    calibration = None if pulses is None else calibration_of(load_robot(robot), pulses)
    motion = plan(robot, options)
    summary = walk_summary(motion)
    if not as_json:
        show(walk_table(summary), f"servos: {summary['servos']['text']}", verdict(summary))
    files = [] if out is None else _write(motion, out, animation=not no_animation, quiet=as_json)
    if html is not None:
        files.append(_write_page(motion, html))
    if calibration is not None and summary["possible"]:
        files += walk_pulses(motion, options, calibration, out or Path())
    if as_json:
        print_json({**summary, "files": [str(file) for file in files]})
    else:
        for file in files:
            click.echo(f"wrote {file}")
    return 0 if summary["possible"] else 1


def _write(motion: Motion, out: Path, *, animation: bool, quiet: bool) -> list[Path]:
    from tarsus.cli.files import write_walk

    with progress_bar(enabled=not quiet) as progress:
        return write_walk(motion, out, animation=animation, progress=progress)


def _write_page(motion: Motion, html: Path) -> Path:
    from tarsus.errors import InputError
    from tarsus.studio.player import player_data, player_page

    page = player_page(player_data(motion))
    try:
        html.write_text(page, encoding="utf-8")
    except OSError as error:
        raise InputError(f"{html} can't be written: {error.strerror}") from None
    return html
