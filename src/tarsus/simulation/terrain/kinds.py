"""The kinds of terrain by name, and their parameters in mm and degrees, as for files and screens."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from tarsus.errors import InputError, UnknownNameError
from tarsus.simulation.terrain.blocks import Blocks
from tarsus.simulation.terrain.box import Box
from tarsus.simulation.terrain.flat import Flat
from tarsus.simulation.terrain.gaps import Gaps
from tarsus.simulation.terrain.protocol import Terrain
from tarsus.simulation.terrain.ramp import Ramp
from tarsus.simulation.terrain.smooth import Smooth
from tarsus.simulation.terrain.stairs import Stairs
from tarsus.simulation.terrain.step import Step

__all__ = ["TERRAINS", "TerrainParameter", "si_value", "terrain_of", "terrain_parameters"]

TERRAINS: dict[str, Any] = {
    "flat": Flat,
    "ramp": Ramp,
    "step": Step,
    "stairs": Stairs,
    "blocks": Blocks,
    "smooth": Smooth,
    "gaps": Gaps,
    "box": Box,
}
"""Kinds of terrain by name."""

# Defaults of the parameters that a kind of terrain requires [m, rad].
_DEFAULTS: dict[str, dict[str, float]] = {
    "ramp": {"slope": math.radians(5)},
    "step": {"rise": 0.02},
    "stairs": {"rise": 0.02},
}
_WHOLE = ("seed", "steps", "count")
_PLAIN = ("friction", *_WHOLE)


class TerrainParameter(NamedTuple):
    """A parameter of a kind of terrain.

    Attributes
    ----------
    name : str
        Name of the parameter.
    unit : str
        ``"mm"``, ``"deg"``, or empty for a plain number.
    default : float
        Its value where none is given, in that unit.
    whole : bool
        Whether it is a whole number.
    """

    name: str
    unit: str
    default: float
    whole: bool


def terrain_parameters(kind: str) -> tuple[TerrainParameter, ...]:
    """Return the parameters of a kind of terrain.

    Parameters
    ----------
    kind : str
        One of `TERRAINS`.

    Raises
    ------
    UnknownNameError
        If there is no such kind.
    """
    if kind not in TERRAINS:
        raise UnknownNameError.of("terrain", kind, tuple(TERRAINS))
    found = []
    for field in dataclasses.fields(TERRAINS[kind]):
        name = field.name
        default: Any = _DEFAULTS.get(kind, {}).get(name, field.default)
        scale = 1.0 / si_value(name, 1.0)
        # Rounded, as 1 / 0.001 is not a whole number of millimetres in binary.
        found.append(TerrainParameter(name, _unit(name), round(float(default) * scale, 9), name in _WHOLE))
    return tuple(found)


def terrain_of(kind: str, values: Mapping[str, float]) -> Terrain:
    """Return a terrain from its kind and parameters.

    Parameters
    ----------
    kind : str
        One of `TERRAINS`.
    values : mapping
        Parameters in mm and deg; those that are left out have their default.

    Raises
    ------
    UnknownNameError
        If there is no such kind.
    InputError
        If a parameter is unknown, or a value is out of its range.
    """
    known = {parameter.name: parameter for parameter in terrain_parameters(kind)}
    given: dict[str, Any] = dict(_DEFAULTS.get(kind, {}))
    for name, value in values.items():
        if name not in known:
            raise InputError(f"terrain {kind!r} has no parameter {name!r}; it has {', '.join(known)}")
        if not known[name].whole:
            given[name] = si_value(name, value)
        elif float(value).is_integer():
            given[name] = int(value)
        else:
            raise InputError(f"terrain {kind!r}: {name} is {value:g}; it must be a whole number")
    try:
        found: Terrain = TERRAINS[kind](**given)
    except InputError as error:
        as_given = ", ".join(f"{name} {value:g} {known[name].unit}".rstrip() for name, value in values.items())
        raise InputError(f"terrain {kind!r} with {as_given}: {error}") from None
    return found


def si_value(name: str, value: float) -> float:
    """Return a parameter in SI units, from mm and deg.

    Parameters
    ----------
    name : str
        Name of the parameter.
    value : float
        Its value.
    """
    return {"mm": value / 1000, "deg": math.radians(value)}.get(_unit(name), value)


def _unit(name: str) -> str:
    return "" if name in _PLAIN else "deg" if name in ("slope", "yaw") else "mm"
