"""Timelines of commands, and how they are run on a plant."""

from __future__ import annotations

from tarsus.scenario.commands import (
    BodyHeight,
    CycleTime,
    Fold,
    FootRelease,
    FootTarget,
    FootVelocity,
    Force,
    GaitChange,
    Ground,
    MoveBody,
    PowerOff,
    Sit,
    StanceWidth,
    StandUp,
    Stop,
    Sway,
    SwingHeight,
    Tilt,
    Walk,
)

__all__ = [
    "BodyHeight",
    "CycleTime",
    "Fold",
    "FootRelease",
    "FootTarget",
    "FootVelocity",
    "Force",
    "GaitChange",
    "Ground",
    "MoveBody",
    "PowerOff",
    "Sit",
    "StanceWidth",
    "StandUp",
    "Stop",
    "Sway",
    "SwingHeight",
    "Tilt",
    "Walk",
]
