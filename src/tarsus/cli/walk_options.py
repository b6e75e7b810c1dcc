"""The options that say which walk, for every command that plans one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

from tarsus.cli.values import Numbers, number_option

__all__ = ["walk_options"]

_F = TypeVar("_F", bound=Callable[..., Any])


def walk_options(function: _F) -> _F:
    """Add the options that `tarsus.cli.planning.plan` takes."""
    for option in reversed(_OPTIONS):
        function = option(function)
    return function


_OPTIONS = (
    click.option("--gait", metavar="NAME", help="tripod, tetrapod, ripple or wave.  [default: the robot's own]"),
    number_option("--distance", "MM", "Straight walk: how far.  [default: 500]"),
    number_option("--heading", "DEG", "Straight walk: where to, from the front; 90 is to the left.  [default: 0]"),
    number_option("--curve", "DEG", "Walk round a centre by this angle; negative is clockwise."),
    click.option(
        "--centre", type=Numbers("X", "Y"), metavar="X,Y", help="The centre, in mm.  [default: 0,0: on the spot]"
    ),
    click.option("--twist", type=Numbers("VX", "VY", "WZ"), metavar="VX,VY,WZ", help="Walk at mm/s,mm/s,deg/s."),
    number_option("--duration", "S", "For how long at that twist."),
    number_option("--stroke", "MM", "How far a foot goes past the body while it is down."),
    number_option("--speed", "MM/S", "Speed of the fastest foot past the body."),
    number_option("--cycle", "S", "Duration of a cycle."),
    number_option("--body-height", "MM", "Height of the body's origin over the ground."),
    number_option("--swing-height", "MM", "Lift of the swinging feet."),
    click.option("--tilt", type=Numbers("ROLL", "PITCH"), metavar="ROLL,PITCH", help="Tilt of the body, in deg."),
    number_option("--foot-distance", "MM", "Least distance between two feet."),
    number_option("--rate", "HZ", "Samples per second.", default=100.0, show_default=True),
)
