"""Undo and redo of whole states, from commit to commit."""

from __future__ import annotations

from collections import deque

from tarsus.errors import InputError
from tarsus.studio.messages.state import Picture, StudioState, View

__all__ = ["History"]

_MOST = 100


class History:
    """The present state, the previous states, and the undone ones.

    Attributes
    ----------
    present : StudioState
        The present state; uncommitted changes become part of the next commit.
    """

    def __init__(self, state: StudioState) -> None:
        self.present = state
        self._committed = state
        self._past: deque[StudioState] = deque(maxlen=_MOST)
        self._future: list[StudioState] = []

    @property
    def can_undo(self) -> bool:
        """Whether there is something to undo."""
        return bool(self._past) or self.present != self._committed

    @property
    def can_redo(self) -> bool:
        """Whether there is something to redo."""
        return bool(self._future)

    def change(self, state: StudioState, *, commit: bool) -> None:
        """Change the state.

        Parameters
        ----------
        state : StudioState
            The new state.
        commit : bool
            Whether undo returns to this state; false during a continuous change.
        """
        self.present = state
        if state != self._committed:
            self._future.clear()
            if commit:
                self._past.append(self._committed)
                self._committed = state

    def look(self, view: View, picture: Picture) -> None:
        """Change the view or the camera, which undo does not revert.

        Parameters
        ----------
        view : str
            The new view.
        picture : Picture
            Camera and time.
        """
        changes = {"view": view, "picture": picture}
        clean = self.present == self._committed
        self.present = self.present.model_copy(update=changes)
        self._committed = self.present if clean else self._committed.model_copy(update=changes)

    def undo(self) -> StudioState:
        """Return to the previous commit, and return its state; uncommitted changes are one step.

        Raises
        ------
        InputError
            If there is nothing to undo.
        """
        if self.present != self._committed:
            self._past.append(self._committed)
            self._committed = self.present
        if not self._past:
            raise InputError("there is nothing to undo")
        self._future.append(self._committed)
        return self._go(self._past.pop())

    def redo(self) -> StudioState:
        """Revert an undo, and return the state.

        Raises
        ------
        InputError
            If there is nothing to redo.
        """
        if not self._future:
            raise InputError("there is nothing to redo")
        self._past.append(self._committed)
        return self._go(self._future.pop())

    def _go(self, state: StudioState) -> StudioState:
        # Camera and time are kept.
        self.present = self._committed = state.model_copy(update={"picture": self.present.picture})
        return self.present
