"""Write the table of ground-measured.md that compares walks that see the ground with those that feel it alone.

python docs/seen_ground.py --seeds 10
"""

from __future__ import annotations

import argparse
import itertools

from page_tables import write_tables
from rough_ground import CASES, PAGE, ROBOTS, Case, Outcome, cell, walk

GROUNDS = ("smooth60", "smooth100", "blocks60", "blocks100")
CASES["seen"] = Case(sensors="camera")


def tables(asked: argparse.Namespace) -> dict[str, str]:
    """Measure, and return the table."""
    lines = ["| walk | felt | seen |", "|---|---|---|"]
    for robot, ground in itertools.product(ROBOTS, GROUNDS):
        found: dict[str, list[Outcome]] = {
            case: [walk((robot, ground, case, seed)) for seed in range(asked.seeds)] for case in ("felt", "seen")
        }
        lines.append(f"| {robot}, {ground} | {cell(found['felt'])} | {cell(found['seen'])} |")
    return {"seen ground": "\n".join(lines)}


if __name__ == "__main__":
    write_tables(__doc__, PAGE, tables, seeds=5)
