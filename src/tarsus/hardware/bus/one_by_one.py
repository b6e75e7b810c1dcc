"""Asking servos one after the other, where no packet asks several."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

from tarsus.errors import BusError, NoAnswerError
from tarsus.hardware.bus.answers import Answers

__all__ = ["one_by_one"]

_Value = TypeVar("_Value")


def one_by_one(ids: Sequence[int], ask: Callable[[int], Answers[_Value]]) -> Answers[_Value]:
    """Return the answers of servos that are asked in turn.

    If the first servo is silent, the middle one of the others is next; if it is silent too, no other is asked.

    Parameters
    ----------
    ids : sequence of int
        The servos.
    ask : callable
        Asks one of them.
    """
    values: dict[int, _Value] = {}
    errors: dict[int, BusError] = {}
    waiting = list(ids)
    while waiting:
        id = waiting.pop(len(waiting) // 2 if errors and not values else 0)
        answer = ask(id)
        values.update(answer.values)
        if answer.errors:
            errors[id] = answer.errors[0]
        if not values and len(errors) > 1 and all(isinstance(error, NoAnswerError) for error in errors.values()):
            errors |= {other: _not_asked(other, errors[id]) for other in waiting}
            break
    found = {id: values[id] for id in ids if id in values}
    return Answers(found, tuple(errors[id] for id in ids if id in errors))


def _not_asked(id: int, error: BusError) -> NoAnswerError:
    return NoAnswerError(
        error.bus,
        error.port,
        id=id,
        expected=error.expected,
        received="nothing from others, and was not waited for",
        remedy=error.remedy,
    )
