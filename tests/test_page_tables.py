"""The runner of the scripts that write tables on pages."""

from concurrent.futures import ThreadPoolExecutor

import pytest

from page_tables import Several, measured, with_tables, write_tables

PAGE = "before\n<!-- table: walks -->\nold\n<!-- end -->\nafter\n<!-- table: falls -->\n<!-- end -->\n"


def tables(asked):
    return {"walks": f"{asked.robots} {asked.seeds}\n", "falls": f"{asked.grounds}"}


def run(monkeypatch, page, *words):
    monkeypatch.setattr("sys.argv", ["script.py", *words])
    grounds = Several(("flat",), choices=("flat", "steps"))
    write_tables("Write tables.", page, tables, robots=Several(("strider",)), grounds=grounds, seeds=3)


def test_tables_are_written_in_their_places(monkeypatch, tmp_path):
    page = tmp_path / "page.md"
    page.write_text(PAGE, encoding="utf-8")
    run(monkeypatch, page, "--robots", "ch3r", "phantomx", "--seeds", "5")
    assert page.read_text(encoding="utf-8") == (
        "before\n<!-- table: walks -->\n['ch3r', 'phantomx'] 5\n<!-- end -->\nafter\n"
        "<!-- table: falls -->\n['flat']\n<!-- end -->\n"
    )


def test_printed_tables_leave_the_page_as_it_is(monkeypatch, tmp_path, capsys):
    run(monkeypatch, tmp_path / "none.md", "--print", "--grounds", "steps", "flat")
    assert capsys.readouterr().out == "['strider'] 3\n\n['steps', 'flat']\n"
    assert not (tmp_path / "none.md").exists()


@pytest.mark.parametrize("words", [("--grounds", "sand"), ("--seeds", "many"), ("--legs", "6")])
def test_what_a_script_does_not_have_is_refused(monkeypatch, tmp_path, words, capsys):
    with pytest.raises(SystemExit):
        run(monkeypatch, tmp_path / "none.md", *words)
    assert words[-1] in capsys.readouterr().err


def test_a_table_without_a_place_is_refused():
    with pytest.raises(ValueError, match="no place for the table 'tilts'"):
        with_tables(PAGE, {"tilts": "new"})


@pytest.mark.parametrize("processes", [1, 2])
def test_what_is_measured_comes_in_the_order_of_the_jobs(processes, monkeypatch):
    # A process that runs tests has threads of JAX, which must not be forked.
    monkeypatch.setattr("page_tables.ProcessPoolExecutor", ThreadPoolExecutor)
    assert list(measured(abs, [-3, 1, -2], processes)) == [3, 1, 2]
