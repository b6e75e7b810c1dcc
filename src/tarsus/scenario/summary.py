"""A recording in numbers: what `tarsus drive` prints and ``--json`` returns."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tarsus.control.loop.recording import Recording

__all__ = ["drive_summary"]


def drive_summary(recording: Recording) -> dict[str, Any]:
    """Return a recording in numbers, in the units that the keys name; what is unknown is None.

    Parameters
    ----------
    recording : Recording
        From `tarsus.run` or `tarsus.run_scenario`.
    """
    motion = recording.motion
    walking = recording.upright & np.array([activity != "standing" for activity in recording.activities])
    steps = np.diff(motion.time)
    # The twist is that of the heading frame, so that swaying or shifting the body does not count as distance.
    path = np.linalg.norm(recording.twist[1:, :2], axis=1) * steps
    moved = walking[1:]
    yaw = np.unwrap(np.asarray(motion.body.rpy)[:, 2])
    x, y = motion.body.position[-1, :2] * 1000
    return {
        "scenario": recording.name,
        "robot": recording.robot.name,
        "rate_hz": recording.rate,
        "duration_s": motion.duration,
        "walked_s": float(steps[moved].sum()),
        "distance_mm": float(path[moved].sum()) * 1000,
        "steps": motion.steps,
        "end": {
            "x_mm": x,
            "y_mm": y,
            "turned_deg": math.degrees(yaw[-1] - yaw[0]),
            "body_height_mm": float(motion.body.position[-1, 2]) * 1000,
            "state": recording.states[-1],
        },
        "gaits": list(dict.fromkeys(recording.gaits)),
        "top_speed_mm_s": float(np.hypot(*recording.twist[:, :2].T).max()) * 1000,
        "top_turn_deg_s": math.degrees(float(np.abs(recording.twist[:, 2]).max())),
        "least_margin": _least_margin(recording),
        "commands": [{"time_s": e.time, "text": e.text} for e in recording.events if e.kind == "command"],
        "limits": [
            {"from_s": event.time, "until_s": event.until, "text": event.text}
            for event in recording.events
            if event.kind == "limit"
        ],
        "unmet": [
            {
                "from_s": each.time,
                "until_s": each.until,
                "kind": str(each.limitation.kind),
                "text": each.limitation.text(),
            }
            for each in recording.unmet
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
