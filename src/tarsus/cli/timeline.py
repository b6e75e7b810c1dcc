"""Scenarios from the command line: a file, or the timeline itself."""

from __future__ import annotations

import dataclasses
import os

from tarsus.errors import InputError
from tarsus.scenario.file import load_scenario, scenario_from_text
from tarsus.scenario.scenario import Scenario

__all__ = ["timeline_of"]


def timeline_of(text: str, rate: float | None) -> Scenario:
    """Return the scenario of a file, or of a timeline.

    Parameters
    ----------
    text : str
        Path of a scenario file, or commands such as ``at 0 s: walk 50 mm/s``, separated by semicolons.
    rate : float, optional
        Ticks per second; the scenario's own where left out [1/s].

    Raises
    ------
    InputError
        If the file can't be read, or a command is malformed.
    """
    if not text.strip():
        raise InputError("the scenario is empty; give a TOML file, or commands such as 'at 0 s: walk 50 mm/s'")
    # Text that begins with "at " is a timeline, unless a file has that name.
    is_timeline = text.lstrip().startswith("at ") and not os.path.isfile(text)
    if " " in text and not is_timeline and not os.path.exists(text):
        raise InputError(f"there is no file {text!r}; a timeline has the form 'at 0 s: walk 50 mm/s; at 5 s: stop'")
    found = scenario_from_text(text) if is_timeline else load_scenario(text)
    return found if rate is None else dataclasses.replace(found, rate=rate)
