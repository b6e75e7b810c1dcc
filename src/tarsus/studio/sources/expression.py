"""Equations that are written once, evaluated with numbers, and shown as MathML with symbols or with numbers.

An expression is a line of Python arithmetic: names, numbers, ``+ - * / **``, and the functions of `FUNCTIONS`. It is
never executed as Python: it is parsed into a syntax tree, and the tree is evaluated here.
"""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from tarsus.studio.messages.general import MathNode

__all__ = ["FUNCTIONS", "UNITS", "Expression", "Quantity", "symbol_node"]

UNITS: Mapping[str, float] = {"mm": 1e-3, "deg": math.pi / 180, "mm²": 1e-6, "": 1.0}
"""Units in which numbers are shown, and their sizes in SI units; other units are SI units."""

_SUM, _PRODUCT, _POWER, _ATOM = 1, 2, 3, 4
_GREEK = {
    "alpha": "α",
    "beta": "β",
    "gamma": "γ",
    "theta": "θ",
    "phi": "φ",
    "psi": "ψ",
    "rho": "ρ",
    "pi": "π",
    "tau": "τ",
}


def _deg(degrees: float) -> float:
    return math.radians(degrees)


FUNCTIONS: Mapping[str, tuple[str, Callable[..., float]]] = {
    "sin": ("sin", math.sin),
    "cos": ("cos", math.cos),
    "tan": ("tan", math.tan),
    "asin": ("arcsin", math.asin),
    "acos": ("arccos", math.acos),
    "atan": ("arctan", math.atan),
    "atan2": ("atan2", math.atan2),
    "hypot": ("hypot", math.hypot),
    "sqrt": ("sqrt", math.sqrt),
    "abs": ("abs", abs),
    "deg": ("deg", _deg),
}
"""Functions of expressions by name: the name in print, and the function that computes the value."""

_SIGNS: Mapping[type[ast.operator], tuple[str, int]] = {
    ast.Add: ("+", _SUM),
    ast.Sub: ("−", _SUM),
    ast.Mult: ("·", _PRODUCT),
}


@dataclass(frozen=True)
class Quantity:
    """A number and how it is shown.

    Attributes
    ----------
    value : float
        The number in SI units.
    unit : str
        Unit in which it is shown.
    """

    value: float
    unit: str

    @property
    def shown(self) -> float:
        """The number in the unit in which it is shown."""
        return self.value / UNITS.get(self.unit, 1.0)

    @property
    def text(self) -> str:
        """The number in print: five significant digits, degrees with their sign."""
        # A zero with rounding errors is shown as zero.
        shown = self.shown if abs(self.shown) > 1e-12 else 0.0
        number = np.format_float_positional(shown, precision=5, fractional=False, trim="-").replace("-", "−")
        return f"{number}°" if self.unit == "deg" else number


Symbols: TypeAlias = Mapping[str, Quantity]


@dataclass(frozen=True)
class Expression:
    """An expression that can be evaluated and shown.

    Attributes
    ----------
    source : str
        The expression as Python arithmetic.
    """

    source: str

    @property
    def _tree(self) -> ast.expr:
        return ast.parse(self.source, mode="eval").body

    def value(self, symbols: Symbols) -> float:
        """Return the value; NaN where there is none, as for the root of a negative number.

        Parameters
        ----------
        symbols : mapping
            Quantities by the names that stand for them.
        """
        try:
            return _value(self._tree, symbols)
        except (ValueError, ZeroDivisionError, OverflowError):
            return math.nan

    def formula(self) -> MathNode:
        """Return the expression with its symbols, as MathML."""
        return _node(self._tree, {})

    def numbers(self, symbols: Symbols) -> MathNode:
        """Return the expression with numbers in place of its symbols, as MathML.

        Parameters
        ----------
        symbols : mapping
            Quantities by the names that stand for them.
        """
        return _node(self._tree, symbols)


def _value(tree: ast.expr, symbols: Symbols) -> float:
    match tree:
        case ast.Constant(value=float() | int() as number):
            return float(number)
        case ast.Name(id="pi"):
            return math.pi
        case ast.Name(id=name):
            return symbols[name].value
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_value(operand, symbols)
        case ast.BinOp(left=left, op=sign, right=right):
            return _combined(sign, _value(left, symbols), _value(right, symbols))
        case ast.Call(func=ast.Name(id=name), args=arguments):
            return FUNCTIONS[name][1](*(_value(argument, symbols) for argument in arguments))
    raise SyntaxError(f"an equation can't hold {ast.unparse(tree)!r}")


def _combined(sign: ast.operator, left: float, right: float) -> float:
    match sign:
        case ast.Add():
            return left + right
        case ast.Sub():
            return left - right
        case ast.Mult():
            return left * right
        case ast.Div():
            return left / right
    return float(left**right)


def _node(tree: ast.expr, symbols: Symbols) -> MathNode:
    match tree:
        case ast.Constant(value=number):
            return _leaf("mn", np.format_float_positional(float(str(number)), trim="-"))
        case ast.Name(id=name):
            return _leaf("mn", symbols[name].text) if name in symbols else symbol_node(name)
        case ast.UnaryOp(operand=operand):
            return _row(_leaf("mo", "−"), _bracketed(operand, symbols, _PRODUCT))
        case ast.BinOp():
            return _joined(tree, symbols)
        case ast.Call(func=ast.Name(id=name), args=arguments):
            return _call(name, arguments, symbols)
    raise SyntaxError(f"an equation can't hold {ast.unparse(tree)!r}")


def _joined(tree: ast.BinOp, symbols: Symbols) -> MathNode:
    match tree.op:
        case ast.Div():
            return MathNode(tag="mfrac", children=[_node(tree.left, symbols), _node(tree.right, symbols)])
        case ast.Pow():
            power = [_bracketed(tree.left, symbols, _ATOM), _node(tree.right, symbols)]
            return MathNode(tag="msup", children=power)
    text, level = _SIGNS[type(tree.op)]
    # To the right of a minus sign, a sum needs brackets; to the right of a plus or multiplication sign, its own level
    # does not.
    after = level + 1 if isinstance(tree.op, ast.Sub) else level
    return _row(_bracketed(tree.left, symbols, level), _leaf("mo", text), _bracketed(tree.right, symbols, after))


def _call(name: str, arguments: list[ast.expr], symbols: Symbols) -> MathNode:
    if name == "sqrt":
        return MathNode(tag="msqrt", children=[_node(arguments[0], symbols)])
    if name == "deg":
        return _leaf("mn", f"{ast.unparse(arguments[0])}°")
    if name == "abs":
        return _row(_leaf("mo", "|"), _node(arguments[0], symbols), _leaf("mo", "|"))
    inside: list[MathNode] = []
    for argument in arguments:
        inside += [*([_leaf("mo", ",")] if inside else []), _node(argument, symbols)]
    return _row(_leaf("mi", FUNCTIONS[name][0]), _leaf("mo", "("), *inside, _leaf("mo", ")"))


def _bracketed(tree: ast.expr, symbols: Symbols, least: int) -> MathNode:
    """Return a part of an expression, in brackets where its operator binds less tightly than the one around it."""
    node = _node(tree, symbols)
    loose = _firmness(tree) < least or _is_negative(tree, symbols)
    return _row(_leaf("mo", "("), node, _leaf("mo", ")")) if loose else node


def _is_negative(tree: ast.expr, symbols: Symbols) -> bool:
    return isinstance(tree, ast.Name) and tree.id in symbols and symbols[tree.id].value < 0


def _firmness(tree: ast.expr) -> int:
    match tree:
        case ast.BinOp(op=ast.Add() | ast.Sub()):
            return _SUM
        case ast.BinOp(op=ast.Mult()) | ast.UnaryOp():
            return _PRODUCT
        case ast.BinOp(op=ast.Pow()):
            return _POWER
    return _ATOM


def _leaf(tag: str, text: str) -> MathNode:
    return MathNode(tag=tag, text=text)  # type: ignore[arg-type] # one of the tags


def _row(*children: MathNode) -> MathNode:
    return MathNode(tag="mrow", children=list(children))


def symbol_node(name: str) -> MathNode:
    """Return a symbol: names of Greek letters become letters; an index after an underscore, or a number, is set low.

    Parameters
    ----------
    name : str
        As in an expression: ``theta_C``, ``L1``.
    """
    found = re.fullmatch(r"([^\W\d_]+)_?(\w*)", name)
    base, below = (found[1], found[2]) if found else (name, "")
    letter = _leaf("mi", _GREEK.get(base, base))
    if not below:
        return letter
    low = _leaf("mn" if below.isdigit() else "mi", _GREEK.get(below, below.replace("_", " ")))
    return MathNode(tag="msub", children=[letter, low])
