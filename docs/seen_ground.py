"""Write the table of ground.md that compares walks over ground that is felt with those over ground that is seen, too.

python docs/seen_ground.py --seeds 5
"""

from __future__ import annotations

import argparse
import itertools

from page_tables import replace_tables
from rough_ground import CASES, PAGE, ROBOTS, Case, Outcome, cell, walk

GROUNDS = ("smooth60", "smooth100", "blocks60", "blocks100")
CASES["seen"] = Case(sensors="camera")


def main() -> None:
    """Measure, and replace the table on the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=3)
    asked = parser.parse_args()
    lines = ["| walk | felt | seen |", "|---|---|---|"]
    for robot, ground in itertools.product(ROBOTS, GROUNDS):
        found: dict[str, list[Outcome]] = {
            case: [walk((robot, ground, case, seed)) for seed in range(asked.seeds)] for case in ("felt", "seen")
        }
        lines.append(f"| {robot}, {ground} | {cell(found['felt'])} | {cell(found['seen'])} |")
    replace_tables(PAGE, {"seen ground": "\n".join(lines)})


if __name__ == "__main__":
    main()
