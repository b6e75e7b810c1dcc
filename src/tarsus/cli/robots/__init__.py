"""`tarsus robots`: bundled robots and robot files."""

from __future__ import annotations

import click

from tarsus.cli.robots.check import check
from tarsus.cli.robots.convert_limits import convert_limits
from tarsus.cli.robots.import_urdf import import_urdf
from tarsus.cli.robots.list import list_all
from tarsus.cli.robots.new import new
from tarsus.cli.robots.schema import schema
from tarsus.cli.robots.show import show_robot
from tarsus.cli.values import examples

__all__ = ["robots"]


@click.group(
    short_help="List, show, create, import and check robot files.",
    epilog=examples(
        "tarsus robots list",
        "tarsus robots show strider",
        "tarsus robots new my-robot --out my-robot.toml",
        "tarsus robots check my-robot.toml",
        "tarsus robots import hexapod.urdf",
        "tarsus robots convert-limits phoenix --coxa -65,65 --femur -105,75 --tibia -53,90",
        "tarsus robots schema",
    ),
)
def robots() -> None:
    """List robots, show their dimensions and sources, create, import and check robot files, convert joint limits."""


for command in (list_all, show_robot, new, import_urdf, check, convert_limits, schema):
    robots.add_command(command)
