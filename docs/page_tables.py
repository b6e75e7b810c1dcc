"""Tables on pages, between ``<!-- table: NAME -->`` and ``<!-- end -->``, and what runs the scripts that write them."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import NamedTuple, TypeVar

__all__ = ["Several", "measured", "replace_tables", "with_tables", "write_tables"]


Job = TypeVar("Job")
Found = TypeVar("Found")


class Several(NamedTuple):
    """An option with one or more words: those it has by default, and those it may have."""

    default: Collection[str]
    choices: Collection[str] | None = None


def write_tables(
    script: str | None,
    page: Path,
    tables: Callable[[argparse.Namespace], Mapping[str, str]],
    **options: int | Several,
) -> None:
    """Run a script: parse its options, measure, and replace its tables on the page or, with ``--print``, print them.

    Parameters
    ----------
    script : str or None
        What the script does and how it is called: its docstring.
    page : Path
        The page.
    tables : callable
        What makes the tables by their names, from the options.
    **options : int or Several
        The options with their defaults.
    """
    parser = argparse.ArgumentParser(description=script, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, option in options.items():
        if isinstance(option, int):
            parser.add_argument(f"--{name}", type=int, default=option)
        else:
            parser.add_argument(f"--{name}", nargs="+", default=list(option.default), choices=option.choices)
    parser.add_argument("--print", action="store_true", help="print the tables, and leave the page as it is")
    asked = parser.parse_args()
    found = tables(asked)
    if asked.print:
        print(*(table.rstrip() for table in found.values()), sep="\n\n")
    else:
        replace_tables(page, found)


def measured(measure: Callable[[Job], Found], jobs: Iterable[Job], processes: int) -> Iterator[Found]:
    """Yield what is found for each job in turn, with so many processes at a time."""
    if processes == 1:
        yield from map(measure, jobs)
        return
    with ProcessPoolExecutor(processes) as pool:
        yield from pool.map(measure, jobs)


def replace_tables(page: Path, tables: Mapping[str, str]) -> None:
    """Write tables onto a page, in place of those with their names."""
    page.write_text(with_tables(page.read_text(encoding="utf-8"), tables), encoding="utf-8")


def with_tables(text: str, tables: Mapping[str, str]) -> str:
    """Return the text of a page with tables in place of those with their names."""
    for name, table in tables.items():
        before, start, rest = text.partition(f"<!-- table: {name} -->\n")
        _, end, after = rest.partition("<!-- end -->")
        if not end:
            raise ValueError(f"the page has no place for the table {name!r}: <!-- table: {name} -->, <!-- end -->")
        text = f"{before}{start}{table.rstrip()}\n{end}{after}"
    return text
