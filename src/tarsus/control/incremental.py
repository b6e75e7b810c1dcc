"""Work in parts: what a control loop can't wait for at once, it does one part of a tick."""

from __future__ import annotations

from collections.abc import Generator
from typing import TypeAlias, TypeVar

__all__ = ["Incremental", "complete"]

_T = TypeVar("_T")
Incremental: TypeAlias = Generator[None, None, _T]
"""A piece of work in parts."""


def complete(work: Incremental[_T]) -> _T:
    """Do a piece of work at once.

    Parameters
    ----------
    work : generator
        The parts.
    """
    while True:
        try:
            next(work)
        except StopIteration as done:
            result: _T = done.value
            return result
