"""`tarsus walk`: plan a walk, tell how it goes, write its angles and pictures."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tarsus.cli.output import print_json, progress_bar, show
from tarsus.cli.values import Numbers, examples, json_option, number_option, robot_argument

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
    )
)
@robot_argument
@click.option("--gait", metavar="NAME", help="tripod, tetrapod, ripple or wave.  [default: the robot's own]")
@number_option("--distance", "MM", "Straight walk: how far.  [default: 500]")
@number_option("--heading", "DEG", "Straight walk: where to, from the front; 90 is to the left.  [default: 0]")
@number_option("--curve", "DEG", "Walk round a centre by this angle; negative is clockwise.")
@click.option("--centre", type=Numbers("X", "Y"), metavar="X,Y", help="The centre, in mm.  [default: 0,0: on the spot]")
@click.option("--twist", type=Numbers("VX", "VY", "WZ"), metavar="VX,VY,WZ", help="Walk at mm/s,mm/s,deg/s.")
@number_option("--duration", "S", "For how long at that twist.")
@number_option("--stroke", "MM", "How far a foot goes past the body while it is down.")
@number_option("--speed", "MM/S", "Speed of the fastest foot past the body.")
@number_option("--cycle", "S", "Duration of a cycle.")
@number_option("--clearance", "MM", "Height of the body's origin over the ground.")
@number_option("--lift", "MM", "Lift of the swinging feet.")
@click.option("--tilt", type=Numbers("ROLL", "PITCH"), metavar="ROLL,PITCH", help="Tilt of the body, in deg.")
@number_option("--foot-distance", "MM", "Least distance between two feet.")
@number_option("--rate", "HZ", "Samples per second.", default=100.0, show_default=True)
@click.option("--out", type=click.Path(path_type=Path), metavar="DIR", help="Write angles (CSV) and pictures here.")
@click.option("--no-animation", is_flag=True, help="Leave out the animation (of the first 20 s at most).")
@json_option
def walk(robot: str, out: Path | None, no_animation: bool, as_json: bool, **asked: Any) -> int:
    """Plan a walk and tell whether the robot can do it.

    Straight ahead unless --curve or --twist says otherwise. What is left out is chosen so that it works, and named.
    The exit code is 0 only if the whole walk is possible.
    """
    from tarsus.cli.planning import plan
    from tarsus.report.tables import verdict, walk_table
    from tarsus.report.walk_summary import walk_summary

    if out is not None:
        _make_folder(out)
    motion = plan(robot, asked)
    summary = walk_summary(motion)
    if not as_json:
        show(walk_table(summary), verdict(summary))
    files = [] if out is None else _write(motion, out, animation=not no_animation, quiet=as_json)
    if as_json:
        print_json({**summary, "files": [str(file) for file in files]})
    else:
        for file in files:
            click.echo(f"wrote {file}")
    return 0 if summary["possible"] else 1


def _write(motion: Motion, out: Path, *, animation: bool, quiet: bool) -> list[Path]:
    from tarsus.cli.files import write_walk

    with progress_bar(wanted=not quiet) as progress:
        return write_walk(motion, out, animation=animation, progress=progress)


def _make_folder(out: Path) -> None:
    """Find out before the work, not after it, that nothing can be written."""
    import tempfile

    try:
        out.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=out):
            pass
    except OSError as error:
        raise click.UsageError(f"--out {out}: nothing can be written there: {error.strerror}") from None
