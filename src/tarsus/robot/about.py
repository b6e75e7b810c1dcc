"""What a robot file says beside the robot itself: how it likes to walk, and where its numbers come from."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["GaitDefaults", "Source"]


@dataclass(frozen=True, kw_only=True)
class GaitDefaults:
    """How this robot walks unless told otherwise.

    Attributes
    ----------
    name : str
        The gait's name.
    body_height : float or None
        Height of the body's origin over the ground [m]; None for a height worked out from the legs.
    swing_height : float or None
        How high a swinging foot is lifted [m]; None for a share of the body height.
    """

    name: str = "tripod"
    body_height: float | None = None
    swing_height: float | None = None


@dataclass(frozen=True, kw_only=True)
class Source:
    """Where numbers of a robot file come from, and how sure they are.

    Attributes
    ----------
    of : tuple of str
        The keys it speaks of, such as ``"leg.coxa_mm"``.
    source : str
        Where they were found.
    confidence : str
        ``"A"`` read in the primary file, ``"B"`` in a secondary copy, ``"C"`` mostly general knowledge,
        ``"guess"`` a guess of this project.
    note : str
        What else is known.
    """

    of: tuple[str, ...]
    source: str
    confidence: str
    note: str = ""
