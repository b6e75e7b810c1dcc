"""Queue of received messages, in which the newest of a type replaces earlier ones."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Any

from tarsus.studio.messages import client as ask
from tarsus.studio.messages.general import Done

if TYPE_CHECKING:
    from tarsus.studio.messages import ClientMessage

__all__ = ["Inbox"]

# Types of which only the newest message is processed: each sets a part of the state as a whole, or requests a result.
_NEWEST = (
    *(ask.SetJoints, ask.SetBody, ask.DragFoot, ask.SetWalk, ask.SetLoads, ask.SetDocument, ask.ChooseSource),
    *(ask.SizeServos, ask.ShowWorkspace, ask.Command),
)


class Inbox:
    """Messages in the order of processing.

    Parameters
    ----------
    most : int
        Greatest number of messages.
    """

    def __init__(self, most: int) -> None:
        self._most = most
        self._waiting: deque[ClientMessage] = deque()

    def __len__(self) -> int:
        return len(self._waiting)

    @property
    def full(self) -> bool:
        """Whether the queue is full."""
        return len(self._waiting) >= self._most

    def pop(self) -> ClientMessage:
        """Remove and return the first message."""
        return self._waiting.popleft()

    def push(self, message: ClientMessage) -> list[Done]:
        """Add a message.

        Parameters
        ----------
        message : ClientMessage
            The message.

        Returns
        -------
        list of Done
            The answers to the messages that it replaces.
        """
        dropped: list[Done] = []
        if isinstance(message, _NEWEST):
            kept: deque[ClientMessage] = deque()
            # Only back to the last message whose order matters, such as undo.
            while self._waiting and isinstance(self._waiting[-1], _NEWEST):
                older = self._waiting.pop()
                if _same(older, message):
                    dropped.append(Done(type="done", id=older.id, dropped=True))
                    message = _with_commit_of(older, message)
                else:
                    kept.appendleft(older)
            self._waiting.extend(kept)
        self._waiting.append(message)
        return dropped[::-1]


def _same(older: ClientMessage, newer: ClientMessage) -> bool:
    if isinstance(older, ask.DragFoot) and isinstance(newer, ask.DragFoot):
        return older.leg == newer.leg
    return type(older) is type(newer)


def _with_commit_of(older: ClientMessage, newer: ClientMessage) -> ClientMessage:
    """Return the newer message; it commits if the older one does."""
    if not getattr(older, "commit", False):
        return newer
    committed: Any = newer.model_copy(update={"commit": True})
    message: ClientMessage = committed
    return message
