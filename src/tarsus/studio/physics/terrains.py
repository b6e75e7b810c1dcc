"""Terrain in the studio: the kinds that are offered, the chosen one, and its shapes for the 3D view."""

from __future__ import annotations

import math

from tarsus.errors import InputError
from tarsus.simulation.engine import engine_problem
from tarsus.simulation.terrain.blocks import Blocks
from tarsus.simulation.terrain.kinds import TERRAINS, TerrainParameter, terrain_of, terrain_parameters
from tarsus.simulation.terrain.protocol import Terrain
from tarsus.simulation.terrain.smooth import Smooth
from tarsus.simulation.terrain.solids import terrain_solids
from tarsus.studio.encoding import millimetres
from tarsus.studio.messages.physics import (
    PhysicsOffer,
    TerrainChoice,
    TerrainField,
    TerrainKind,
    TerrainMessage,
    TerrainParameterRange,
)

__all__ = ["MOST_BLOCKS", "MOST_COUNT", "MOST_POINTS", "chosen_terrain", "physics_offer", "terrain_message"]

MOST_BLOCKS, MOST_POINTS, MOST_COUNT = 1600, 40_000, 100
"""Greatest numbers of parts that are simulated for a visitor: blocks, points of smooth ground, steps or gaps."""

# Range of lengths that are simulated [mm]: the physics engine refuses smaller shapes, and has no unbounded ones.
_SMALLEST, _LARGEST = 0.5, 20_000.0

# Ranges of the sliders: least, greatest value and step [mm, deg]. Values outside can be typed.
_RANGES: dict[str, tuple[float, float, float]] = {
    "friction": (0.1, 1.5, 0.05),
    "slope": (-25, 25, 0.5),
    "rise": (-60, 60, 1),
    "start": (-1000, 2000, 10),
    "length": (100, 4000, 50),
    "aside": (-500, 500, 10),
    "yaw": (-90, 90, 1),
    "tread": (100, 600, 10),
    "steps": (1, 20, 1),
    "count": (1, 20, 1),
    "size": (100, 500, 10),
    "extent": (500, 3000, 100),
    "clear": (0, 1000, 50),
    "amplitude": (1, 80, 1),
    "wavelength": (200, 2000, 50),
    "width": (10, 300, 5),
    "spacing": (100, 1000, 10),
    "depth": (10, 500, 10),
    "seed": (0, 99, 1),
}
_OF_KIND: dict[str, dict[str, tuple[float, float, float]]] = {
    "blocks": {"rise": (1, 80, 1)},
    "box": {"rise": (5, 500, 5), "length": (10, 2000, 10), "width": (10, 2000, 10)},
}


def physics_offer() -> PhysicsOffer:
    """Return what physics this server has."""
    return PhysicsOffer(
        missing=engine_problem(),
        terrains=[
            TerrainKind(kind=kind, parameters=[_ranged(kind, each) for each in terrain_parameters(kind)])  # type: ignore[arg-type] # one of the names
            for kind in TERRAINS
        ],
    )


def _ranged(kind: str, parameter: TerrainParameter) -> TerrainParameterRange:
    least, most, step = (_RANGES | _OF_KIND.get(kind, {}))[parameter.name]
    return TerrainParameterRange(
        name=parameter.name,
        unit=parameter.unit,  # type: ignore[arg-type] # one of the units
        default=parameter.default,
        least=least,
        most=most,
        step=step,
    )


def chosen_terrain(choice: TerrainChoice) -> Terrain:
    """Return the chosen terrain, unless it is too large.

    Parameters
    ----------
    choice : TerrainChoice
        Kind and parameters.

    Raises
    ------
    InputError
        If a parameter is unknown or out of its range, or the terrain has too many parts.
    """
    for name in ("steps", "count"):
        count = choice.values.get(name, 0)
        if count > MOST_COUNT:
            raise InputError(f"terrain {choice.kind!r}: {name} is {count:g}; the studio simulates at most {MOST_COUNT}")
    for each in terrain_parameters(choice.kind):
        size = abs(choice.values.get(each.name, 0.0))
        if each.unit == "mm" and size and not _SMALLEST <= size <= _LARGEST:
            raise InputError(
                f"terrain {choice.kind!r}: {each.name} is {choice.values[each.name]:g} mm; the studio simulates "
                f"{_SMALLEST:g} to {_LARGEST:g} mm"
            )
    terrain = terrain_of(choice.kind, choice.values)
    if isinstance(terrain, Blocks):
        _check_parts(terrain.side**2, MOST_BLOCKS, f"blocks: use a size of at least {_least(terrain)} mm")
    if isinstance(terrain, Smooth):
        _check_parts(terrain.points**2, MOST_POINTS, "points: use longer waves or a smaller extent")
    return terrain


def _least(terrain: Blocks) -> int:
    return math.ceil(2000 * terrain.extent / math.isqrt(MOST_BLOCKS))


def _check_parts(count: int, most: int, what: str) -> None:
    if count > most:
        raise InputError(f"the terrain has {count} of at most {most} {what}")


def terrain_message(terrain: Terrain, choice: TerrainChoice, *, id: int) -> TerrainMessage:
    """Return a terrain with its shapes.

    Parameters
    ----------
    terrain : Terrain
        The terrain.
    choice : TerrainChoice
        The choice that it was made from.
    id : int
        Id of the message that is answered.

    Raises
    ------
    TarsusError
        If MuJoCo is not installed.
    """
    solids = terrain_solids(terrain)
    field = solids.field
    return TerrainMessage(
        type="terrain",
        id=id,
        kind=choice.kind,
        friction=terrain.friction,
        level=solids.level,
        boxes_mm=millimetres(solids.boxes),
        triangles_mm=millimetres(solids.triangles),
        field=None
        if field is None
        else TerrainField(
            rows=field.heights.shape[0],
            columns=field.heights.shape[1],
            corners_mm=millimetres(field.corners),
            heights_mm=millimetres(field.heights),
        ),
    )
