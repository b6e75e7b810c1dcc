"""Write the table of ground-measured.md with gaits other than the robots' own, felt.

python docs/gaits_on_ground.py --jobs 16
"""

from __future__ import annotations

from functools import partial

from page_tables import Several, write_tables
from rough_ground import GAIT_CASES, PAGE, tables

ROBOTS = ("strider", "phantomx")
GROUNDS = ("flat", "smooth60", "blocks40", "step+40", "ramp+20", "ramp-20")

if __name__ == "__main__":
    options = {"robots": Several(ROBOTS), "grounds": Several(GROUNDS), "cases": Several(tuple(GAIT_CASES))}
    write_tables(__doc__, PAGE, partial(tables, name="gaits"), **options, seeds=5, jobs=1)
