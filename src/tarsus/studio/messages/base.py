"""Base classes of messages, and types of finite and bounded numbers.

Lengths are in mm, angles in deg, times in s, masses in kg, forces in N, torques in N m; keys contain the unit. Arrays
are flat lists in row-major order: ``angles_deg`` of six legs has 18 numbers, that of a plan of `n` samples ``n * 18``.
Texts such as ``contacts`` have one character per leg: ``"101010"``.
"""

from __future__ import annotations

from typing import Annotated, TypeAlias

from pydantic import BaseModel, ConfigDict, Field

__all__ = ["MOST_LEGS", "Angle", "Coordinate", "Id", "Message", "Name", "Number", "Part", "Positive", "Triple"]

MOST_LEGS = 100
"""Greatest number of legs in a robot file."""

# Far beyond any robot; larger values are mistakes or attacks.
_LARGEST = 1e6

Number: TypeAlias = Annotated[float, Field(ge=-_LARGEST, le=_LARGEST, allow_inf_nan=False)]
"""A finite number of plausible size."""

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
"""Number that a client gives its message; all answers to it carry the same."""


class Part(BaseModel):
    """A part of a message: unknown keys, and numbers as texts, are rejected."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


class Message(Part):
    """A message: `type` identifies its kind, `id` the request that it is or answers."""

    id: Id
