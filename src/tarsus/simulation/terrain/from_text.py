"""Terrain from a line of text, as on the command line: ``blocks:rise=20,seed=3``."""

from __future__ import annotations

import math

from tarsus.errors import InputError
from tarsus.simulation.terrain.height_field import HeightField
from tarsus.simulation.terrain.kinds import TERRAINS, si_value, terrain_of, terrain_parameters
from tarsus.simulation.terrain.protocol import Terrain

__all__ = ["terrain_from_text", "terrain_help"]

_OF_PICTURES = ("rise", "length", "width", "friction")


def terrain_from_text(text: str, *, friction: float | None = None) -> Terrain:
    """Return a terrain from its name and parameters.

    Parameters
    ----------
    text : str
        ``KIND`` or ``KIND:NAME=VALUE,...``; lengths in mm, slopes in deg. A height field is
        ``FILE.png:rise=MM,length=MM,width=MM``.
    friction : float, optional
        Coefficient of friction; the terrain's default where left out.

    Raises
    ------
    UnknownNameError
        If there is no such kind.
    InputError
        If a parameter is unknown or not a number, or a value is out of its range.
    """
    kind, _, rest = text.partition(":")
    values = _values(text, rest)
    if friction is not None:
        values["friction"] = friction
    return _height_field(kind, values) if kind.lower().endswith(".png") else terrain_of(kind, values)


def terrain_help() -> str:
    """Return the kinds of terrain with their parameters, a line each."""
    lines = [f"{kind}: {', '.join(each.name for each in terrain_parameters(kind))}" for kind in TERRAINS]
    return "\n".join([*lines, f"FILE.png: {', '.join(_OF_PICTURES)}"])


def _values(text: str, rest: str) -> dict[str, float]:
    """Return the values as given, in mm and deg."""
    values: dict[str, float] = {}
    for part in filter(None, rest.split(",")):
        name, given, number = (piece.strip() for piece in part.partition("="))
        try:
            value = float(number)
        except ValueError:
            value = math.nan
        if not given or not math.isfinite(value):
            raise InputError(f"terrain {text!r}: {part!r} is not of the form NAME=NUMBER, such as rise=20")
        if name in values:
            raise InputError(f"terrain {text!r}: {name} is given twice")
        values[name] = value
    return values


def _height_field(path: str, given: dict[str, float]) -> Terrain:
    for name in given:
        if name not in _OF_PICTURES:
            raise InputError(f"terrain {path!r} has no parameter {name!r}; it has {', '.join(_OF_PICTURES)}")
    values = {name: si_value(name, value) for name, value in given.items()}
    size = (values.pop("length", 4.0), values.pop("width", 4.0))
    return HeightField.from_png(path, size=size, **{"rise": 0.05, **values})
