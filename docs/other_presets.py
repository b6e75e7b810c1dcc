"""Write the table of ground-measured.md with the other presets whose masses and servos are known, felt.

python docs/other_presets.py --jobs 16
"""

from __future__ import annotations

import argparse
import itertools

from page_tables import Several, measured, write_tables
from rough_ground import GROUNDS, PAGE, RANDOM, Outcome, cell, walk

ROBOTS = ("phoenix", "phantomx-mk2", "ch3r")
DEFAULT_GROUNDS = (
    *("flat", "smooth60", "smooth100", "blocks60", "blocks100"),
    *("step+40", "step-40", "ramp+20", "ramp-20", "stairs"),
)


def tables(asked: argparse.Namespace) -> dict[str, str]:
    """Measure, and return the table: a row for each ground, a column for each robot."""
    cells = list(itertools.product(asked.grounds, asked.robots))
    jobs = [
        (robot, ground, "felt", seed)
        for ground, robot in cells
        for seed in range(asked.seeds if ground.startswith(RANDOM) else 1)
    ]
    found: dict[tuple[str, str], list[Outcome]] = {}
    for (robot, ground, _, _), outcome in zip(jobs, measured(walk, jobs, asked.jobs), strict=True):
        found.setdefault((ground, robot), []).append(outcome)
    rows = [[ground, *(cell(found[ground, robot]) for robot in asked.robots)] for ground in asked.grounds]
    lines = [f"| | {' | '.join(asked.robots)} |", f"|---|{'---|' * len(asked.robots)}"]
    return {"other presets": "\n".join([*lines, *(f"| {' | '.join(row)} |" for row in rows)])}


if __name__ == "__main__":
    grounds = Several(DEFAULT_GROUNDS, choices=GROUNDS)
    write_tables(__doc__, PAGE, tables, robots=Several(ROBOTS), grounds=grounds, seeds=10, jobs=1)
