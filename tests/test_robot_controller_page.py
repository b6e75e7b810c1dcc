"""The page on the robot controller: its example prints what it shows, its tables are complete."""

import contextlib
import dataclasses
import io
import re
from pathlib import Path

import tarsus
from tarsus.control.command import Command
from tarsus.control.control_output import ControlOutput
from tarsus.control.plant import Plant

PAGE = (Path(__file__).parents[1] / "docs" / "robot-controller.md").read_text(encoding="utf-8")


def test_the_example_prints_what_the_page_shows():
    (code,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    (shown,) = re.findall(r"```text\n(.*?)```", PAGE, re.DOTALL)
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code, "docs/robot-controller.md", "exec"), {})
    assert printed.getvalue() == shown


def test_the_tables_have_every_field_and_method():
    fields = {field.name for field in dataclasses.fields(Command)}
    table = PAGE.partition("## Command")[2].partition("## Output")[0]
    assert set(re.findall(r"`(\w+)`", "".join(re.findall(r"^\| (.*?) \|", table, re.MULTILINE)))) == fields
    output = PAGE.partition("## Output")[2].partition("## Plants")[0]
    named = set(re.findall(r"`(\w+)`", output))
    assert {field.name for field in dataclasses.fields(ControlOutput)} - {"time", "guard"} <= named
    plants = PAGE.partition("## Plants")[2]
    methods = {name for name in vars(Plant) if not name.startswith("_") and callable(getattr(Plant, name))}
    assert methods == set(re.findall(r"^\| `(\w+)\(", plants, re.MULTILINE))


def test_the_page_on_a_tick_names_files_that_exist_and_every_limiter():
    page = (Path(__file__).parents[1] / "docs" / "life-of-a-tick.md").read_text(encoding="utf-8")
    control = Path(tarsus.__file__).parent / "control"
    named = {name.removeprefix("control/") for name in re.findall(r"`((?:\w+/)*\w+\.py)`", page)}
    table = page.partition("## Limiters")[2]
    limiters = set(re.findall(r"^\| `(\w+\.py)`", table, re.MULTILINE))
    assert limiters == {path.name for path in (control / "limiter").glob("*.py")} - {"__init__.py", "protocol.py"}
    assert {name for name in named - limiters if not (control / name).is_file()} == set()
