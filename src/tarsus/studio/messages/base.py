"""What all messages share: strictness, and numbers that are finite and bounded.

On the wire lengths are in mm, angles in deg, times in s, masses in kg, forces in N, torques in N m; the unit stands in
the key's name. Arrays are flat lists, the last index running fastest: ``angles_deg`` of six legs has 18 numbers, those
of a plan of `n` moments ``n * 18``. One character stands for one thing in texts such as ``contacts``: ``"101010"``.
"""

from __future__ import annotations

from typing import Annotated, TypeAlias

from pydantic import BaseModel, ConfigDict, Field

__all__ = ["MOST_LEGS", "Angle", "Coordinate", "Id", "Message", "Name", "Number", "Part", "Positive", "Triple"]

MOST_LEGS = 100
"""As many legs as a robot file may have."""

# Far beyond any robot; what a slider can't reach is a slip or an attack.
_LARGEST = 1e6

Number: TypeAlias = Annotated[float, Field(ge=-_LARGEST, le=_LARGEST, allow_inf_nan=False)]
"""Any number that is finite and not absurd."""

Positive: TypeAlias = Annotated[float, Field(ge=0, le=_LARGEST, allow_inf_nan=False)]
"""A number that is not negative."""

Coordinate: TypeAlias = Annotated[float, Field(ge=-100_000, le=100_000, allow_inf_nan=False)]
"""A coordinate or an offset [mm]."""

Angle: TypeAlias = Annotated[float, Field(ge=-3600, le=3600, allow_inf_nan=False)]
"""An angle [deg]."""

Triple: TypeAlias = tuple[Coordinate, Coordinate, Coordinate]
"""A point: x, y, z [mm]."""

Name: TypeAlias = Annotated[str, Field(max_length=200)]
"""A name of a robot, a gait, a file."""

Id: TypeAlias = Annotated[int, Field(ge=0, le=2**53 - 1)]
"""The number that a client gives its message; every answer to it bears the same."""


class Part(BaseModel):
    """A part of a message: unknown keys and numbers as texts are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


class Message(Part):
    """A message. `type` tells which, `id` which question it is or answers."""

    id: Id
