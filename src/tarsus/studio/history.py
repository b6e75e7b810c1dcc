"""Undo and redo over whole states: a commit is a place to come back to."""

from __future__ import annotations

from collections import deque

from tarsus.errors import InputError
from tarsus.studio.messages.state import Picture, StudioState, View

__all__ = ["History"]

_MOST = 100


class History:
    """The present state, those before it and those undone.

    Attributes
    ----------
    present : StudioState
        The state now; what is not committed is taken together with the next commit.
    """

    def __init__(self, state: StudioState) -> None:
        self.present = state
        self._committed = state
        self._past: deque[StudioState] = deque(maxlen=_MOST)
        self._future: list[StudioState] = []

    @property
    def can_undo(self) -> bool:
        """Whether there is a state to go back to."""
        return bool(self._past) or self.present != self._committed

    @property
    def can_redo(self) -> bool:
        """Whether there is an undone state."""
        return bool(self._future)

    def change(self, state: StudioState, *, commit: bool) -> None:
        """Take a new state.

        Parameters
        ----------
        state : StudioState
            The state.
        commit : bool
            Whether it is one to come back to; if not, more is to follow.
        """
        self.present = state
        if commit and state != self._committed:
            self._past.append(self._committed)
            self._future.clear()
            self._committed = state

    def look(self, view: View, picture: Picture) -> None:
        """Go to a view or look at it differently, which is nothing to undo.

        Parameters
        ----------
        view : str
            The view.
        picture : Picture
            How it is looked at.
        """
        looked = {"view": view, "picture": picture}
        clean = self.present == self._committed
        self.present = self.present.model_copy(update=looked)
        self._committed = self.present if clean else self._committed.model_copy(update=looked)

    def undo(self) -> StudioState:
        """Go back to the commit before, and return it; what is not committed yet is one step.

        Raises
        ------
        InputError
            If there is none.
        """
        if self.present != self._committed:
            self._past.append(self._committed)
            self._committed = self.present
        if not self._past:
            raise InputError("there is nothing to undo")
        self._future.append(self._committed)
        return self._go(self._past.pop())

    def redo(self) -> StudioState:
        """Take an undo back, and return the state.

        Raises
        ------
        InputError
            If nothing is undone.
        """
        if not self._future:
            raise InputError("there is nothing to redo")
        self._past.append(self._committed)
        return self._go(self._future.pop())

    def _go(self, state: StudioState) -> StudioState:
        # Where one looks from is not undone.
        self.present = self._committed = state.model_copy(update={"picture": self.present.picture})
        return self.present
