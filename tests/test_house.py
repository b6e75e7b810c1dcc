"""The import graph where import-linter's contracts say nothing of it: cycles, deferred imports, sizes.

The order of the layers, siblings without cycles and the guard's independence are contracts in `pyproject.toml`. Here
and there every import counts, also one inside a function or under `TYPE_CHECKING`: deferring an import hides a cycle,
it does not remove it. Only the table of public names in `tarsus/__init__.py` is exempt, as it refers to every layer.
"""

import ast
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from graphlib import CycleError, TopologicalSorter
from itertools import chain
from pathlib import Path

import pytest

import tarsus

ROOT = Path(tarsus.__file__).parent
MOST_MODULES, MOST_LINES = 12, 300


@dataclass(frozen=True)
class Import:
    """One imported name: the importing module, what is imported, and where."""

    importer: str
    imported: str
    name: str
    line: int
    deferred: bool
    typing: bool

    def __str__(self) -> str:
        return f"{self.importer}:{self.line} imports {self.imported}"


def module_name(path: Path) -> str:
    parts = path.relative_to(ROOT.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


FILES = {module_name(path): path for path in sorted(ROOT.rglob("*.py"))}


def imports_of(module: str) -> Iterator[Import]:
    """Every import of a module, of Tarsus's own modules and of other packages."""

    def visit(parent: ast.AST, deferred: bool, typing: bool) -> Iterator[Import]:
        for node in ast.iter_child_nodes(parent):
            if isinstance(node, ast.Import):
                for alias in node.names:
                    yield Import(module, alias.name, alias.name, node.lineno, deferred, typing)
            elif isinstance(node, ast.ImportFrom):
                assert not node.level, f"{module}:{node.lineno} is a relative import"
                for alias in node.names:
                    whole = f"{node.module}.{alias.name}"
                    imported = whole if whole in FILES else str(node.module)
                    yield Import(module, imported, alias.name, node.lineno, deferred, typing)
            else:
                in_function = isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda)
                for_types = isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)
                yield from visit(node, deferred or in_function, typing or for_types)

    return visit(ast.parse(FILES[module].read_text(encoding="utf-8")), False, False)


IMPORTS = {module: tuple(imports_of(module)) for module in FILES}
INSIDE = [one for one in chain(*IMPORTS.values()) if one.imported in FILES and one.importer != "tarsus"]


def layer_of(module: str) -> str:
    return module.split(".")[1]


def cycle_in(edges: set[tuple[str, str]]) -> list[str]:
    """Return the nodes of one cycle, or an empty list."""
    sorter: TopologicalSorter[str] = TopologicalSorter()
    for importer, imported in edges:
        sorter.add(importer, imported)
    try:
        sorter.prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


def loaded_by(module: str) -> set[str]:
    """Return the packages beyond the standard library that importing a module loads."""
    found, seen, waiting = set(), set(), [module]
    while waiting:
        at = waiting.pop()
        if at in seen:
            continue
        seen.add(at)
        waiting += [parent for parent in (at.rpartition(".")[0],) if parent]
        for one in IMPORTS[at]:
            if one.deferred or one.typing:
                continue
            if one.imported in FILES:
                waiting.append(one.imported)
            else:
                found.add(one.imported.split(".")[0])
    return found - sys.stdlib_module_names


def modules_in(folder: Path) -> list[Path]:
    return [path for path in folder.glob("*.py") if path.name != "__init__.py"]


CONTROL = sorted(path.parent for path in (ROOT / "control").rglob("__init__.py"))


def test_no_module_imports_itself_through_others():
    assert cycle_in({(one.importer, one.imported) for one in INSIDE if one.importer != one.imported}) == []


def test_no_module_uses_the_table_of_public_names():
    uses = [one for one in INSIDE if one.imported == "tarsus" and one.name != "__version__"]
    assert [str(one) for one in uses] == []


def test_imports_in_functions_only_keep_a_heavy_package_from_loading():
    # Commands of the command line load what they need when they run: `tarsus --help` stays fast.
    deferred = [one for one in INSIDE if one.deferred and layer_of(one.importer) != "cli"]
    needless = [one for one in deferred if loaded_by(one.imported) <= loaded_by(one.importer)]
    assert [str(one) for one in needless] == []


@pytest.mark.parametrize("folder", CONTROL, ids=lambda folder: folder.relative_to(ROOT).as_posix())
def test_folders_and_modules_of_control_stay_small(folder):
    assert len(modules_in(folder)) <= MOST_MODULES
    lines = {path.name: len(path.read_text(encoding="utf-8").splitlines()) for path in folder.glob("*.py")}
    assert {name: count for name, count in lines.items() if count > MOST_LINES} == {}
