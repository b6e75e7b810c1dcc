"""Terrain from a line of text, as on the command line: ``blocks:rise=20,seed=3``."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

from tarsus.errors import InputError, UnknownNameError
from tarsus.simulation.terrain.blocks import Blocks
from tarsus.simulation.terrain.flat import Flat
from tarsus.simulation.terrain.gaps import Gaps
from tarsus.simulation.terrain.height_field import HeightField
from tarsus.simulation.terrain.protocol import Terrain
from tarsus.simulation.terrain.ramp import Ramp
from tarsus.simulation.terrain.smooth import Smooth
from tarsus.simulation.terrain.stairs import Stairs
from tarsus.simulation.terrain.step import Step

__all__ = ["TERRAINS", "terrain_from_text", "terrain_help"]

TERRAINS: dict[str, Any] = {
    "flat": Flat,
    "ramp": Ramp,
    "step": Step,
    "stairs": Stairs,
    "blocks": Blocks,
    "smooth": Smooth,
    "gaps": Gaps,
}
"""Kinds of terrain by name; a path of a PNG file is a height field."""

# Values that a kind needs and has no default for.
_DEFAULTS: dict[str, dict[str, float]] = {
    "ramp": {"slope": math.radians(5)},
    "step": {"rise": 0.02},
    "stairs": {"rise": 0.02},
}
_PLAIN = ("friction", "seed", "steps", "count")


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
    if kind.lower().endswith(".png"):
        return _height_field(kind, values)
    if kind not in TERRAINS:
        raise UnknownNameError.of("terrain", kind, tuple(TERRAINS))
    known = [field.name for field in dataclasses.fields(TERRAINS[kind])]
    _require_known(kind, values, known)
    found: Terrain = TERRAINS[kind](**{**_DEFAULTS.get(kind, {}), **values})
    return found


def terrain_help() -> str:
    """Return the kinds of terrain with their parameters, a line each."""
    lines = [
        f"{name}: {', '.join(field.name for field in dataclasses.fields(kind))}" for name, kind in TERRAINS.items()
    ]
    return "\n".join([*lines, "FILE.png: rise, length, width, friction"])


def _values(text: str, rest: str) -> dict[str, Any]:
    values: dict[str, Any] = {}
    for part in filter(None, rest.split(",")):
        name, given, number = (piece.strip() for piece in part.partition("="))
        try:
            value = float(number)
        except ValueError:
            value = math.nan
        if not given or not math.isfinite(value):
            raise InputError(f"terrain {text!r}: {part!r} is not of the form NAME=NUMBER, such as rise=20")
        if name in ("seed", "steps", "count"):
            if not value.is_integer():
                raise InputError(f"terrain {text!r}: {name} is {value:g}; it must be a whole number")
            values[name] = int(value)
        else:
            values[name] = value if name in _PLAIN else math.radians(value) if name == "slope" else value / 1000
    return values


def _height_field(path: str, values: dict[str, Any]) -> Terrain:
    _require_known(path, values, ["rise", "length", "width", "friction"])
    size = (values.pop("length", 4.0), values.pop("width", 4.0))
    return HeightField.from_png(path, size=size, **{"rise": 0.05, **values})


def _require_known(kind: str, values: dict[str, Any], known: list[str]) -> None:
    for name in values:
        if name not in known:
            raise InputError(f"terrain {kind!r} has no parameter {name!r}; it has {', '.join(known)}")
