"""Gait defaults of a robot file, and the sources of its numbers."""

from __future__ import annotations

from dataclasses import dataclass

from tarsus.representation import represented

__all__ = ["GaitDefaults", "Source"]


@dataclass(frozen=True, kw_only=True)
class GaitDefaults:
    """Default settings of the robot's walks.

    Attributes
    ----------
    name : str
        Name of the gait.
    body_height : float or None
        Height of the body's origin above the ground [m]; None for a height derived from the legs.
    swing_height : float or None
        Swing height [m]; None for a fraction of the body height.
    """

    name: str = "tripod"
    body_height: float | None = None
    swing_height: float | None = None


@represented()
@dataclass(frozen=True, kw_only=True)
class Source:
    """Source of numbers in a robot file, and their confidence.

    Attributes
    ----------
    of : tuple of str
        The keys concerned, such as ``"leg.coxa_mm"``.
    source : str
        Where the numbers were found.
    confidence : str
        ``"A"`` from the primary source, ``"B"`` from a secondary copy, ``"C"`` mostly general knowledge,
        ``"guess"`` an estimate of this project.
    note : str
        Remarks.
    """

    of: tuple[str, ...]
    source: str
    confidence: str
    note: str = ""
