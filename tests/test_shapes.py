"""Array shapes: stated in every signature, enforced in this test run, and free at run time."""

import ast
import importlib
import subprocess
import sys
import textwrap
from pathlib import Path

import numpy as np
import pytest

import shape_enforcement
import tarsus
from shape_enforcement import ShapeError
from tarsus.gait.foot_polygons import polygon_margin

SOURCE = Path(tarsus.__file__).parent
FILES = sorted(SOURCE.rglob("*.py"))
TREES = {path.relative_to(SOURCE).as_posix(): ast.parse(path.read_text(encoding="utf-8")) for path in FILES}

ARRAYS = {"Array", "np.ndarray", "numpy.ndarray", "ndarray", "NDArray"}
# Shapes are jaxtyping's; a function that is passed on or a type that is named may leave them open.
OPAQUE = {*shape_enforcement.DTYPES, "Callable", "TypeAlias"}

SAMPLE = '''"""Functions and classes with shapes."""
from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from elsewhere import Unknown
    from jaxtyping import Bool, Complex, Float

Array = Any


def scaled(
    feet: Float[Array, "*#batch legs 3"], factor: Float[Array, "*#batch"] | float
) -> Float[Array, "*batch legs 3"]:
    return np.asarray(feet, dtype=float) * np.asarray(factor)[..., None, None]


def dropped(feet: Float[Array, "*batch legs 3"]) -> Float[Array, "*batch legs 3"]:
    return feet[..., :-1, :]


def pair(feet: Float[Array, "legs 3"]) -> tuple[Float[Array, "3"], Bool[Array, "legs"]]:
    return feet.sum(0), feet[:, 2]


def several(
    *parts: Float[Array, "n"], last: Complex[np.ndarray, "n"] | None = None, other: Unknown | None = None
) -> None:
    pass


def refuses(feet: Float[Array, "legs 3"]) -> None:
    raise ValueError("not these")


@dataclass
class Stance:
    feet: Float[np.ndarray, "legs 3"]
    down: Bool[np.ndarray, "legs"]

    @property
    def lowest(self) -> Float[Array, ""]:
        return self.feet[:, 2]

    @cached_property
    def highest(self) -> Float[Array, ""]:
        return self.feet[:, 2].max()

    @staticmethod
    def on_ground(height: Float[Array, "legs"]) -> Bool[Array, "legs"]:
        return height <= 0


class Step(NamedTuple):
    start: Complex[np.ndarray, "legs"]
    end: Complex[np.ndarray, "legs"]
'''


@pytest.fixture(scope="module")
def sample(tmp_path_factory):
    path = tmp_path_factory.mktemp("shapes") / "sample_shapes.py"
    path.write_text(textwrap.dedent(SAMPLE), encoding="utf-8")
    yield shape_enforcement.load("sample_shapes", str(path))
    del sys.modules["sample_shapes"]


FEET = np.zeros((6, 3))
DOWN = np.ones(6, dtype=bool)


def test_fitting_shapes_pass(sample):
    assert sample.scaled(FEET, 2.0).shape == (6, 3)
    assert sample.scaled(np.zeros((5, 1, 6, 3)), np.ones(4)).shape == (5, 4, 6, 3)
    assert sample.scaled([[0, 0, 1]], factor=1).shape == (1, 3)  # nested sequences and integers, as NumPy takes them
    sample.several(np.zeros(3), np.zeros(3), last=np.zeros(3, dtype=complex), other=3)
    stance = sample.Stance(FEET, DOWN)
    assert stance.highest == 0
    assert stance.on_ground(FEET[:, 2]).all()
    assert sample.Step(FEET[:, 0] + 0j, end=FEET[:, 0] + 0j)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda s: s.scaled(np.zeros((6, 2)), 1.0), "feet is ndarray of float64, shape (6, 2)"),
        (lambda s: s.scaled(np.zeros(3), 1.0), "feet is ndarray of float64, shape (3,)"),
        (lambda s: s.dropped(np.zeros((6, 3), dtype=complex)), "feet is ndarray of complex128"),
        (lambda s: s.scaled(feet=np.zeros((6, 3), dtype=bool), factor=1.0), "feet is ndarray of bool"),
        (lambda s: s.dropped(FEET), "return is ndarray of float64, shape (5, 3)"),
        (lambda s: s.pair(FEET), "return is tuple"),
        (lambda s: s.several(np.zeros(3), np.zeros(4)), "parts is ndarray of float64, shape (4,)"),
        (lambda s: s.several(np.zeros(3), last=np.zeros(3)), "last is ndarray of float64"),
        (lambda s: s.Stance(FEET.tolist(), DOWN), "feet is list"),
        (lambda s: s.Stance(FEET, DOWN[:5]), "down is ndarray of bool, shape (5,)"),
        (lambda s: s.Stance(FEET, DOWN).lowest, "return is ndarray of float64, shape (6,)"),
        (lambda s: s.Stance.on_ground(DOWN), "height is ndarray of bool"),
        (lambda s: s.Step(FEET[:, 0] + 0j, FEET[:, 0]), "end is ndarray of float64"),
    ],
)
def test_wrong_shapes_and_dtypes_are_caught(sample, call, message):
    with pytest.raises(ShapeError) as caught:
        call(sample)
    assert message in str(caught.value)


def test_a_function_may_refuse_a_wrong_shape_itself(sample):
    with pytest.raises(ValueError, match="not these"):
        sample.refuses(np.zeros(2))


def test_wrong_shapes_may_be_let_pass(sample):
    with shape_enforcement.unchecked():
        assert sample.dropped(FEET).shape == (5, 3)
    with pytest.raises(ShapeError):
        sample.dropped(FEET)


def test_shapes_are_enforced_in_tarsus_itself(monkeypatch):
    monkeypatch.setattr(shape_enforcement.Checks, "interval", 1)  # this function may have been called often
    # NumPy alone would broadcast the one point to all polygons.
    with pytest.raises(ShapeError, match="polygon_margin: inside is ndarray of complex128"):
        polygon_margin(np.ones((6, 16)), np.zeros(1, dtype=complex))


def test_nothing_that_is_imported_already_can_be_enforced():
    with pytest.raises(RuntimeError, match=r"already imported.*tarsus\.control"):
        shape_enforcement.install(("tarsus.control",))


def test_no_alias_stands_for_an_array_type():
    """A second name for arrays would hide their dtype; `tarsus.arrays.Array` is the one for any library's."""
    aliases = [
        f"{name}:{statement.lineno}: {ast.unparse(statement)}"
        for name, tree in TREES.items()
        for statement in tree.body
        if isinstance(statement, ast.Assign | ast.AnnAssign)
        and statement.value is not None
        and _is_array_type(statement.value)
    ]
    assert aliases == []


def test_every_array_in_a_signature_has_a_shape():
    bare = [
        f"{name}:{annotation.lineno}: {ast.unparse(annotation)}"
        for name, tree in TREES.items()
        for annotation in _signatures(tree)
        if _names_bare_array(annotation)
    ]
    assert bare == []


@pytest.mark.no_cover
def test_jaxtyping_is_imported_for_type_checkers_only():
    for name, tree in TREES.items():
        guarded = {
            id(statement)
            for branch in ast.walk(tree)
            if isinstance(branch, ast.If) and ast.unparse(branch.test) == "TYPE_CHECKING"
            for statement in branch.body
        }
        for node in ast.walk(tree):
            if isinstance(node, ast.Import | ast.ImportFrom) and "jaxtyping" in ast.unparse(node):
                assert id(node) in guarded, name


def test_every_annotation_can_be_evaluated():
    """A shape that jaxtyping cannot read would be found only when the function is called."""
    for name, tree in TREES.items():
        module = importlib.import_module(
            ".".join(("tarsus", *name.removesuffix(".py").split("/"))).removesuffix(".__init__")
        )
        checks = shape_enforcement.Checks("", module.__name__, {})
        for text in map(ast.unparse, _signatures(tree)):
            if shape_enforcement.NAMES_DTYPE.search(text):
                checks.hint(text)


def test_neither_jaxtyping_nor_beartype_is_needed_at_run_time():
    code = (
        "import sys, tarsus; r = tarsus.load_robot('strider')\n"
        "tarsus.plan_walk(r, tarsus.Gait.named('wave'), tarsus.straight_path(0.1)).margin\n"
        "tarsus.WalkController(r)\n"
        "print(sorted({'jaxtyping', 'beartype', 'jax'} & set(sys.modules)))"
    )
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert answer.stdout.strip() == "[]"


def _is_array_type(value: ast.expr) -> bool:
    if isinstance(value, ast.Subscript):
        value = value.value
    return ast.unparse(value) in ARRAYS


def _signatures(scope: ast.Module | ast.ClassDef):
    """Yield the annotations of functions and methods, and of the fields of classes."""
    for node in scope.body:
        if isinstance(node, ast.FunctionDef):
            given = node.args
            for argument in (*given.posonlyargs, *given.args, given.vararg, *given.kwonlyargs, given.kwarg):
                if argument is not None and argument.annotation is not None:
                    yield argument.annotation
            if node.returns is not None:
                yield node.returns
        elif isinstance(node, ast.ClassDef):
            yield from _signatures(node)
        elif isinstance(node, ast.AnnAssign) and isinstance(scope, ast.ClassDef):
            yield node.annotation


def _names_bare_array(annotation: ast.expr) -> bool:
    if isinstance(annotation, ast.Subscript) and ast.unparse(annotation.value) in OPAQUE:
        return False
    if ast.unparse(annotation) in ARRAYS:
        return True
    return any(_names_bare_array(part) for part in ast.iter_child_nodes(annotation) if isinstance(part, ast.expr))
