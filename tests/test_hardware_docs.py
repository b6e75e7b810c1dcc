"""The page on servo buses keeps up with what it describes."""

import re
import sys
from pathlib import Path

from tarsus import hardware
from tarsus.hardware.codec import lines

DOCS = Path(__file__).parents[1] / "docs"
PAGE = (DOCS / "buses.md").read_text(encoding="utf-8")


def test_the_tables_are_what_is_computed_and_the_examples_run(monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS))
    from bus_tables import with_buses
    from refresh import refreshed

    assert with_buses(refreshed(PAGE)) == PAGE, "run: make figures"
    for name in ("bus_tables", "refresh", "mistyped"):
        sys.modules.pop(name, None)


def test_the_other_examples_run(capsys):
    blocks = re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)
    assert len(blocks) == 2
    exec(compile(blocks[1], "docs/buses.md", "exec"), {})
    assert capsys.readouterr().out == "18\n"


def test_every_bus_is_described():
    described = set(re.findall(r"^- `([a-z0-9-]+)`(?:, `([a-z0-9-]+)`)?:", PAGE, flags=re.MULTILINE))
    assert {name for names in described for name in names if name} == set(hardware.BUSES)


def test_faults_are_measured_as_the_page_says(monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS))
    from fault_times import FAULTS, RATES, Walk

    page = (DOCS / "first-hour.md").read_text(encoding="utf-8")
    table = page.split("<!-- table: fault times -->\n")[1].split("<!-- end -->")[0].splitlines()
    assert [cell.strip() for cell in table[0].strip("|").split("|")] == ["bus", "rate", *FAULTS]
    assert [re.match(r"\| `([a-z0-9-]+)`", row)[1] for row in table[2:]] == list(RATES)
    assert 0 < Walk("feetech-sts", FAULTS["unplugged"], 0.1, 4).noticed("unplugged") < 0.02
    sys.modules.pop("fault_times", None)


def test_the_sketch_and_its_bus_agree():
    sketch = (DOCS.parent / "examples" / "pulse_lines" / "pulse_lines.ino").read_text(encoding="utf-8")
    can = hardware.emulated_bus("lines", range(18))[0].capabilities
    assert f"CHANNELS = {len(can.ids)};" in sketch
    assert f"SHORTEST = {can.lowest}, LONGEST = {can.highest};" in sketch
    assert f"Serial.begin({hardware.BUSES['lines'].baud});" in sketch
    pins = re.search(r"PINS\[CHANNELS\] = \{(.*)\}", sketch)[1].split(", ")
    assert len(set(pins)) == len(can.ids)
    # What the emulated board begins with.
    assert "limit = 500;" in sketch
    assert hardware.emulate("lines", range(18))._limit == 0.5
    # The longest line that the bus sends has to fit.
    longest = len(lines.pulses([2500] * len(can.ids)).rstrip())
    assert longest <= int(re.search(r"LONGEST_LINE = (\d+);", sketch)[1])


def test_every_bus_says_what_it_was_compared_with():
    table = PAGE.split("## What the codecs are compared with")[1].split("\n\n")[1]
    assert set(re.findall(r"`([a-z0-9-]+)`", table)) == set(hardware.BUSES)
