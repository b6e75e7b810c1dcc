"""A recording in numbers: what `tarsus drive` prints and ``--json`` returns."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.scenario.recording import Recording
from tarsus.scenario.wording import command_text

__all__ = ["drive_summary"]


def drive_summary(recording: Recording) -> dict[str, Any]:
    """Return a recording in numbers, in the units that the keys name; what is unknown is None.

    Parameters
    ----------
    recording : Recording
        From `tarsus.drive.run.run`.
    """
    motion, scenario = recording.motion, recording.scenario
    walking = recording.upright & np.array([doing != "standing" for doing in recording.doing])
    steps = np.diff(motion.time)
    path = np.linalg.norm(np.diff(motion.body.position[:, :2], axis=0), axis=1)
    moved = walking[1:]
    yaw = np.unwrap(np.asarray(motion.body.rpy)[:, 2])
    x, y = motion.body.position[-1, :2] * 1000
    return {
        "scenario": scenario.name,
        "robot": recording.robot.name,
        "rate_hz": scenario.rate,
        "duration_s": motion.duration,
        "walked_s": float(steps[moved].sum()),
        "way_mm": float(path[moved].sum()) * 1000,
        "steps": motion.steps,
        "end": {"x_mm": x, "y_mm": y, "turned_deg": math.degrees(yaw[-1] - yaw[0])},
        "gaits": list(dict.fromkeys(recording.gaits)),
        "top_speed_mm_s": float(np.hypot(*recording.done[:, :2].T).max()) * 1000,
        "top_turn_deg_s": math.degrees(float(np.abs(recording.done[:, 2]).max())),
        "least_margin": _least_margin(recording),
        "commands": [{"time_s": command.at, "text": command_text(command)} for command in scenario.commands],
        "limits": [
            {"from_s": event.time, "until_s": event.until, "text": event.text}
            for event in recording.events
            if event.kind == "limit"
        ],
        "guard": bool(recording.guard),
        "interventions": dict(recording.interventions),
        "possible": recording.ok,
        "problems": list(recording.problems),
        "assumed": list(motion.assumed),
    }


def _least_margin(recording: Recording) -> dict[str, float] | None:
    """Return the least margin while the body was off the ground, and when; None where it never was."""
    if recording.belly.all():
        return None
    margin = np.where(recording.belly, np.inf, recording.motion.margin)
    worst = int(np.argmin(margin))
    return {"mm": float(margin[worst]) * 1000, "at_s": float(recording.motion.time[worst])}
