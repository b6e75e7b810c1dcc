"""A question about servos, and what was measured."""

from __future__ import annotations

from dataclasses import dataclass

from tarsus.representation import represented

__all__ = ["Finding"]


@represented()
@dataclass(frozen=True, kw_only=True)
class Finding:
    """A question of the decision tree, answered by measuring.

    Attributes
    ----------
    question : str
        What was asked.
    ok : bool or None
        Whether the answer is as it must be; None where nothing can be measured.
    measured : str
        What was found.
    remedy : str
        What would help; empty where nothing is wrong.
    """

    question: str
    ok: bool | None
    measured: str
    remedy: str = ""
