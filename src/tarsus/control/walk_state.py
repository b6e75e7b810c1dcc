"""The states of walking, and which of them follow each other."""

from __future__ import annotations

from enum import StrEnum

__all__ = ["WalkState"]


class WalkState(StrEnum):
    """What the walk controller does; the value is its name in records and messages."""

    STANDING = "standing"
    WALKING = "walking"
    STOPPING = "stopping"
    SEARCHING = "searching"
