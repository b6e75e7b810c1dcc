"""The public face: what `import tarsus` offers is what its tables say, everywhere documented and acyclic."""

import ast
import importlib
import inspect
import pkgutil
import re
import subprocess
import sys
from enum import Enum
from pathlib import Path

import pytest

import tarsus

SOURCE = Path(tarsus.__file__)
MODULES = sorted(info.name for info in pkgutil.walk_packages(tarsus.__path__, "tarsus."))


def test_the_tables_of_names_agree():
    tree = ast.parse(SOURCE.read_text(encoding="utf-8"))
    typed = {
        (node.module, alias.name)
        for branch in tree.body
        if isinstance(branch, ast.If)
        for node in branch.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    lazy = {(module, name) for module, names in tarsus._HOMES.items() for name in names}
    assert typed == lazy | {("tarsus", package) for package in tarsus._PACKAGES}
    assert {name for _, name in lazy} | {"__version__"} == set(tarsus.__all__)
    assert len(tarsus.__all__) == len(set(tarsus.__all__))


@pytest.mark.parametrize("name", sorted(set(tarsus.__all__) - {"__version__"}))
def test_every_public_name_is_there_and_documented(name):
    value = getattr(tarsus, name)
    assert value is getattr(importlib.import_module(tarsus._HOME_OF[name]), name)
    if callable(value):
        assert inspect.getdoc(value)


def public_callables():
    """Public functions and classes, and the public methods of the classes, by their dotted names."""
    for name in sorted(set(tarsus.__all__) - {"__version__"}):
        value = getattr(tarsus, name)
        if not callable(value) or (inspect.isclass(value) and issubclass(value, BaseException | Enum)):
            continue
        yield name, value
        for method, found in vars(value).items() if inspect.isclass(value) else ():
            function = getattr(found, "__func__", found)
            if inspect.isfunction(function) and not method.startswith("_"):
                yield f"{name}.{method}", function


def documented_types(doc):
    """The names that a NumPy docstring documents, with the line that states the type."""
    lines = doc.splitlines()
    entries = [line for line in lines if re.match(r"\*{0,2}\w+(, \*{0,2}\w+)* : ", line)]
    return {name.strip(" *"): line for line in entries for name in line.partition(" : ")[0].split(",")}


PUBLIC = dict(public_callables())


@pytest.mark.parametrize("name", PUBLIC)
def test_every_public_callable_documents_its_parameters_and_their_shapes(name):
    value = PUBLIC[name]
    doc = inspect.getdoc(value)
    assert doc
    assert doc.split("\n\n")[0].endswith((".", ":"))
    documented = documented_types(doc)
    unshaped = [line for line in documented.values() if re.search(r"\barrays?\b", line) and "shape" not in line]
    assert unshaped == []
    kinds = (inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD)
    parameters = [p.name for p in inspect.signature(value).parameters.values() if p.kind not in kinds]
    parameters = [name for name in parameters if name not in ("self", "cls")]
    # The summary may be enough for a single parameter.
    if documented or len(parameters) > 1:
        assert set(parameters) <= set(documented)


@pytest.mark.parametrize("module", MODULES)
def test_every_module_imports_and_its_all_is_true(module):
    loaded = importlib.import_module(module)
    assert loaded.__doc__
    for name in getattr(loaded, "__all__", ()):
        assert hasattr(loaded, name)


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'leg_count'"):
        _ = tarsus.leg_count
    assert dir(tarsus) == sorted([*tarsus.__all__, *tarsus._PACKAGES])


def test_importing_tarsus_loads_nothing_heavy():
    code = "import sys, tarsus; print(sorted({'numpy', 'pydantic', 'matplotlib', 'rich'} & set(sys.modules)))"
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert answer.stdout.strip() == "[]"


def test_planning_a_walk_loads_nothing_but_numpy():
    code = (
        "import sys, tarsus; r = tarsus.load_robot('strider')\n"
        "tarsus.plan_walk(r, tarsus.Gait.named('wave'), tarsus.straight_path(0.1)).margin\n"
        "print(sorted({'matplotlib', 'rich', 'click', 'xarray', 'scipy', 'jax', 'mujoco'} & set(sys.modules)))"
    )
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert answer.stdout.strip() == "[]"


def test_the_version_is_the_packages():
    from importlib.metadata import version

    assert tarsus.__version__ == version("tarsus")
