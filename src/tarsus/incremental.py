"""Incremental computations: generators that do one stage per tick."""

from __future__ import annotations

from collections.abc import Generator
from typing import TypeAlias, TypeVar

__all__ = ["Incremental", "complete"]

_T = TypeVar("_T")
Incremental: TypeAlias = Generator[None, None, _T]
"""A computation in stages; it yields after each stage and returns its result."""


def complete(work: Incremental[_T]) -> _T:
    """Run all stages of a computation at once, and return its result."""
    while True:
        try:
            next(work)
        except StopIteration as done:
            result: _T = done.value
            return result
