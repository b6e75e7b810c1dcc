"""The page on servo buses keeps up with what it describes."""

import re
import sys
from pathlib import Path

from tarsus import hardware

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
