"""One source document as a message."""

from __future__ import annotations

from tarsus.studio.messages.plain import SourceMessage
from tarsus.studio.messages.state import SourceChoice
from tarsus.studio.standing import OnFootholds

__all__ = ["source_message"]


def source_message(standing: OnFootholds, choice: SourceChoice, *, id: int) -> SourceMessage:
    """Return it."""
    return SourceMessage(
        type="source", id=id, number=choice.number, title="", about="", leg=choice.leg, equations=[], errata=[]
    )
