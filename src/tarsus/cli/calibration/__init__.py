"""`tarsus calibration`: calibration files of real robots."""

from __future__ import annotations

import click

from tarsus.cli.calibration.check import check
from tarsus.cli.calibration.new import new
from tarsus.cli.calibration.phoenix import from_phoenix, to_phoenix
from tarsus.cli.calibration.schema import schema
from tarsus.cli.values import examples

__all__ = ["calibration"]


@click.group(
    short_help="Create, check and convert calibration files.",
    epilog=examples(
        "tarsus calibration new strider",
        "tarsus calibration new strider --nominal --bus feetech-sts --out my-strider.toml",
        "tarsus calibration check my-strider.toml",
        "tarsus calibration from-phoenix Hex_Cfg.h my-phoenix",
        "tarsus calibration schema",
    ),
)
def calibration() -> None:
    """Create, check and convert calibration files: which servo moves which joint, and how angles become commands."""


for command in (new, check, from_phoenix, to_phoenix, schema):
    calibration.add_command(command)
