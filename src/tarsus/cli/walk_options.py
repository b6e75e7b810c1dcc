"""Options of commands that plan a walk."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

from tarsus.cli.values import Numbers, number_option

__all__ = ["compensate_option", "walk_options"]

_F = TypeVar("_F", bound=Callable[..., Any])


def walk_options(function: _F) -> _F:
    """Add the options of `tarsus.cli.planning.plan`."""
    for option in reversed(_OPTIONS):
        function = option(function)
    return function


def compensate_option(function: _F) -> _F:
    """Add the option that commands compensate for the deflection of the joints."""
    return click.option(
        "--compensate",
        is_flag=True,
        default=None,
        help="Command loaded feet lower by most of what the servos yield under vertical forces.",
    )(function)


_OPTIONS = (
    click.option(
        "--gait",
        metavar="NAME",
        help="tripod, tetrapod (also: amble), ripple, wave or, with four legs, creep.  [default: the robot's]",
    ),
    number_option("--distance", "MM", "Straight walk: distance.  [default: 500]"),
    number_option("--heading", "DEG", "Straight walk: direction from the front; 90 is to the left.  [default: 0]"),
    number_option("--curve", "DEG", "Walk around a centre by this angle; negative is clockwise."),
    click.option(
        "--centre",
        type=Numbers("X", "Y"),
        metavar="X,Y",
        help="Centre of the curve, in mm.  [default: 0,0: turn in place]",
    ),
    click.option(
        "--twist",
        type=Numbers("VX", "VY", "WZ"),
        metavar="VX,VY,WZ",
        help="Walk with a constant twist, in mm/s,mm/s,deg/s.",
    ),
    number_option("--duration", "S", "Duration of the twist.", above=0),
    number_option("--stroke", "MM", "Stroke: travel of a foot relative to the body during a stance.", above=0),
    number_option("--speed", "MM/S", "Speed of the fastest foot relative to the body.", above=0),
    number_option("--cycle", "S", "Cycle time.", above=0),
    number_option("--body-height", "MM", "Body height: height of the body's origin over the ground."),
    number_option("--swing-height", "MM", "Swing height: lift of the feet in swing.", least=0),
    click.option(
        "--tilt", type=Numbers("ROLL", "PITCH"), metavar="ROLL,PITCH", help="Roll and pitch of the body, in deg."
    ),
    number_option("--stance-width", "MM", "Outward displacement of the feet from their default rest positions."),
    number_option("--foot-distance", "MM", "Smallest allowed distance between two feet.", least=0),
    number_option("--rate", "HZ", "Samples per second.", default=100.0, show_default=True, above=0),
)
