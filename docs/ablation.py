"""Write the table of ground-measured.md that shows what each mechanism of the felt walk is worth: it is switched off.

python docs/ablation.py --seeds 3
python docs/ablation.py --grounds blocks40 --without obstacles --print
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from typing import Any
from unittest.mock import patch

import numpy as np

import tarsus
from page_tables import Several, write_tables
from rough_ground import CASES, GROUNDS, PAGE, RANDOM, Case, Outcome, walk
from tarsus.control.contact.foot_contacts import FootContacts
from tarsus.control.felt import landing
from tarsus.control.pose.posture_feedback import PostureFeedback

ROBOT, SHOWN = "strider", ("smooth60", "blocks60", "step+40", "ramp+20", "stairs")


def off(owner: Any, name: str, result: Any) -> Callable[[], AbstractContextManager[Any]]:
    """Return what has a function return one result for the length of a walk."""
    return partial(patch.object, owner, name, lambda *_, **__: result)


# In place of the attribute: all feet that should stand do.
ALL_STAND = property(lambda contacts: [True] * len(contacts.lifted), lambda *_: None)

CASES["without lost time"] = Case(options={"adaptation": tarsus.GroundAdaptation(catch_up=1.0)})
# What is switched off: by an option or a sensor that is missing, or in place of a function.
MECHANISMS: dict[str, tuple[str, Callable[[], AbstractContextManager[Any]]]] = {
    "nothing": ("felt", nullcontext),
    "levelling": ("without levelling", nullcontext),
    "adaptation": ("without adaptation", nullcontext),
    "lost time": ("without lost time", nullcontext),
    "lost way": ("without odometry", nullcontext),
    "obstacles": ("felt", off(landing, "_collides", result=False)),
    "search in stance": ("felt", partial(patch.object, FootContacts, "standing", ALL_STAND, create=True)),
    "reach": ("felt", off(PostureFeedback, "fit_to_reach", result=None)),
    "contacts": ("blind", nullcontext),
}


def walked(without: str, ground: str, seed: int) -> Outcome:
    """Return the outcome of a walk without a mechanism."""
    case, switched_off = MECHANISMS[without]
    with switched_off():
        return walk((ROBOT, ground, case, seed))


def cell(found: list[Outcome]) -> str:
    """Return the medians of way and tilt, with the number of falls."""
    falls = sum(each.fell for each in found)
    medians = f"{np.median([each.way for each in found]):.2f}, {np.median([each.tilt for each in found]):.1f}"
    return medians + (f" ({falls} of {len(found)} fell)" if falls else "")


def tables(asked: argparse.Namespace) -> dict[str, str]:
    """Measure, and return the table."""
    lines = [f"| {ROBOT} without | {' | '.join(asked.grounds)} |", f"|---|{'---|' * len(asked.grounds)}"]
    for without in asked.without:
        cells = []
        for ground in asked.grounds:
            seeds = asked.seeds if ground.startswith(RANDOM) else 1
            cells.append(cell([walked(without, ground, seed) for seed in range(seeds)]))
        lines.append(f"| {without} | {' | '.join(cells)} |")
    return {"ablation": "\n".join(lines)}


if __name__ == "__main__":
    grounds, without = Several(SHOWN, choices=GROUNDS), Several(MECHANISMS, choices=MECHANISMS)
    write_tables(__doc__, PAGE, tables, grounds=grounds, without=without, seeds=3)
