"""Write the table of ground-measured.md with the other presets whose masses and servos are known, felt.

python docs/other_presets.py --jobs 16
"""

from __future__ import annotations

import argparse

from page_tables import Several, write_tables
from rough_ground import GROUNDS, PAGE, cell, walked

ROBOTS = ("phoenix", "phantomx-mk2", "ch3r")
DEFAULT_GROUNDS = (
    *("flat", "smooth60", "smooth100", "blocks60", "blocks100"),
    *("step+40", "step-40", "ramp+20", "ramp-20", "stairs"),
)


def tables(asked: argparse.Namespace) -> dict[str, str]:
    """Measure, and return the table: a row for each ground, a column for each robot."""
    found = walked(asked, ["felt"])
    rows = [[ground, *(cell(found[robot, ground, "felt"]) for robot in asked.robots)] for ground in asked.grounds]
    lines = [f"| | {' | '.join(asked.robots)} |", f"|---|{'---|' * len(asked.robots)}"]
    return {"other presets": "\n".join([*lines, *(f"| {' | '.join(row)} |" for row in rows)])}


if __name__ == "__main__":
    grounds = Several(DEFAULT_GROUNDS, choices=GROUNDS)
    write_tables(__doc__, PAGE, tables, robots=Several(ROBOTS), grounds=grounds, seeds=10, jobs=1)
