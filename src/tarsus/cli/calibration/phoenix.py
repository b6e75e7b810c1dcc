"""`tarsus calibration from-phoenix` and `to-phoenix`: configuration headers of the Phoenix firmware."""

from __future__ import annotations

from pathlib import Path

import click

from tarsus.cli.output import print_json, write_new
from tarsus.cli.values import examples, json_option

__all__ = ["from_phoenix", "to_phoenix"]

_LARGEST = 2**20


@click.command(
    "from-phoenix",
    short_help="Read Hex_Cfg.h of the Phoenix firmware.",
    epilog=examples(
        "tarsus calibration from-phoenix Hex_Cfg.h my-phoenix",
        "tarsus calibration from-phoenix Hex_Cfg.h my-phantomx --driver ax12",
    ),
)
@click.argument("header", type=click.Path(path_type=Path, exists=True, dir_okay=False))
@click.argument("name")
@click.option(
    "--driver",
    type=click.Choice(["ssc32", "maestro", "ax12"]),
    help="Servo driver of the firmware.  [default: the header's]",
)
@json_option
def from_phoenix(header: Path, name: str, driver: str | None, as_json: bool) -> int:
    """Write NAME.toml and NAME.calibration.toml from HEADER, the Hex_Cfg.h of a Phoenix firmware.

    The robot file has links, mounting points and limits, the calibration pins, zeros and directions. Offsets of single
    servos that are stored in an SSC-32 are not in the header.
    """
    from tarsus.hardware.phoenix.hex_cfg import calibration_from_hex_cfg, robot_from_hex_cfg
    from tarsus.robot.file import save_robot
    from tarsus.robot.special_file import is_pipe_or_device

    if is_pipe_or_device(header):
        raise click.UsageError(f"{header} is a pipe or a device; a configuration header is a regular file")
    size = header.stat().st_size
    if size > _LARGEST:
        raise click.UsageError(f"{header} has {size} bytes, more than {_LARGEST}; a configuration header has fewer")

    robot_file, calibration_file = Path(f"{name}.toml"), Path(f"{name}.calibration.toml")
    text = header.read_text(encoding="utf-8", errors="replace")
    robot = robot_from_hex_cfg(text, name=name, where=str(header))
    found = calibration_from_hex_cfg(text, robot=robot, robot_file=robot_file.name, driver=driver, where=str(header))
    for path in (robot_file, calibration_file):
        if path.exists():
            raise click.UsageError(f"{path} already exists; choose another name")
    save_robot(robot, robot_file)
    found.save(calibration_file)
    if as_json:
        print_json({"robot": name, "bus": found.buses[0].kind, "files": [str(robot_file), str(calibration_file)]})
        return 0
    click.echo(f"wrote {robot_file} and {calibration_file}; next: tarsus calibration check {calibration_file}")
    return 0


@click.command(
    "to-phoenix",
    short_help="Write Hex_Cfg.h of the Phoenix firmware.",
    epilog=examples(
        "tarsus calibration to-phoenix my-strider.toml",
        "tarsus calibration to-phoenix my-strider.toml --out My_Cfg.h",
    ),
)
@click.argument("file", type=click.Path(path_type=Path))
@click.option(
    "--out", type=click.Path(path_type=Path), default=Path("Hex_Cfg.h"), show_default=True, help="Output file."
)
@json_option
def to_phoenix(file: Path, out: Path, as_json: bool) -> int:
    """Write the calibration FILE and its robot as a header for the Phoenix firmware.

    The bus must be an SSC-32, a Maestro, or one of AX-12 servos.

    Existing files are not overwritten.
    """
    from tarsus.hardware.calibration.calibration import Calibration
    from tarsus.hardware.phoenix.hex_cfg_text import hex_cfg_text

    text = hex_cfg_text(Calibration.load(file))
    write_new(out, text)
    notes = [line.removeprefix("// ") for line in text.splitlines()[3:] if line.startswith("// ")]
    if as_json:
        print_json({"file": str(out), "notes": notes})
        return 0
    for note in notes:
        click.echo(f"note: {note}")
    click.echo(f"wrote {out}")
    return 0
