"""`tarsus run`: a real, emulated or simulated robot, driven by a scenario, keys, a gamepad or the studio."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tarsus.cli.folder import make_folder
from tarsus.cli.output import print_json, show
from tarsus.cli.values import examples, json_option, number_option, robot_argument

if TYPE_CHECKING:
    from rich.table import Table

__all__ = ["run"]

_STUDIO = "127.0.0.1:8600"


@click.command(
    short_help="Run a real, emulated or simulated robot.",
    epilog=examples(
        "tarsus run strider --bus emulated --duration 1",
        'tarsus run strider --scenario "at 0 s: walk 60 mm/s; at 0.5 s: sit" --duration 1 --out run',
        "tarsus run strider --bus simulated --duration 1",
    ),
)
@robot_argument
@click.option(
    "--calibration", type=click.Path(path_type=Path), metavar="FILE", help="Calibration file of the real robot."
)
@click.option(
    "--bus",
    metavar="BUS",
    help="real, emulated, emulated:KIND or simulated.  [default: real with --calibration, else emulated]",
)
@click.option("--port", metavar="PORT", help="Port of the real robot.  [default: that of the calibration]")
@click.option("--scenario", metavar="SCENARIO", help="Scenario file or timeline.  [default: a short walk]")
@click.option("--keys", is_flag=True, help="Drive with the keys of this terminal: keep w, a, s, d pressed.")
@click.option("--gamepad", is_flag=False, flag_value="/dev/input/js0", metavar="DEVICE", help="Drive with a gamepad.")
@click.option(
    "--studio",
    is_flag=False,
    flag_value=_STUDIO,
    metavar="HOST:PORT",
    help=f"Drive with the view Drive of the studio.  [default address: {_STUDIO}]",
)
@click.option(
    "--start",
    type=click.Choice(["lying", "standing"]),
    help="How the robot is found.  [default: lying if it is real, else standing]",
)
@number_option("--duration", "S", "End after this time.  [default: the scenario's]", above=0)
@number_option("--rate", "HZ", "Ticks per second.  [default: 100, or what the bus carries]", above=0)
@click.option(
    "--out", type=click.Path(path_type=Path), metavar="DIR", help="Record telemetry (CSV, MCAP) and figures here."
)
@json_option
def run(robot: str, out: Path | None, as_json: bool, **options: Any) -> int:
    """Run ROBOT with the robot controller: on servos, emulated servos or in physics.

    Shows rate and lateness of the ticks while it runs. Ctrl-C sits the robot down and releases the servos, a second one
    releases them at once. The exit code is 0 only if nothing failed and every command was met in full.
    """
    from tarsus.cli.run.live_run import perform

    given = [name for name in ("scenario", "keys", "gamepad", "studio") if options[name]]
    if len(given) > 1:
        raise click.UsageError(f"--{given[0]} and --{given[1]} exclude each other")
    if out is not None:
        make_folder(out, "matplotlib")
    summary = perform(robot, options, out=out, quiet=as_json)
    if as_json:
        print_json(summary)
    else:
        from tarsus.report.tables import verdict

        show(_table(summary), "interrupted" if summary["interrupted"] else verdict(summary))
        for file in summary["files"]:
            click.echo(f"wrote {file}")
    if summary["interrupted"]:
        raise click.Abort
    return 0 if summary["possible"] else 1


def _table(summary: dict[str, Any]) -> Table:
    from rich.table import Table

    table = Table(box=None, show_header=False, pad_edge=False)
    table.add_row("robot", summary["robot"])
    table.add_row("servos", summary["bus"])
    if summary["duration_s"] is not None:
        walked = f", {summary['distance_mm']:.0f} mm" if summary["distance_mm"] is not None else ""
        table.add_row("duration", f"{summary['duration_s']:.2f} s{walked}")
    timing = summary["timing"]
    if timing is not None:
        late = f"late by {timing['median_late_ms']:.2f} ms in the median, {timing['worst_late_ms']:.1f} ms at worst"
        table.add_row("ticks", f"{timing['ticks']} at {timing['rate_hz']:.1f} Hz, {timing['missed']} missed; {late}")
    tracking = summary["tracking_deg"]
    if tracking is not None:
        table.add_row(
            "joints", f"behind their commands by {tracking['rms']:.2f} deg RMS, {tracking['worst']:.1f} at most"
        )
    if summary["voltage_v"] is not None:
        table.add_row("supply", f"{summary['voltage_v']:.1f} V at least")
    for note in summary["notes"]:
        table.add_row("note", note)
    return table
