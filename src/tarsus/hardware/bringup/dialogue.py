"""How the bring-up asks: what a terminal, or a test, must be able to do."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

__all__ = ["Dialogue", "Left"]


class Left(Exception):  # noqa: N818 - no error: the user went away
    """The bring-up was left; what was answered is saved."""


class Dialogue(Protocol):
    """Someone who answers."""

    def say(self, text: str) -> None:
        """Tell something.

        Parameters
        ----------
        text : str
            What.
        """

    def choose(self, question: str, options: Mapping[str, str]) -> str:
        """Ask, and return the key of an option; raise `Left` where whoever answers goes away.

        Parameters
        ----------
        question : str
            The question.
        options : mapping of str to str
            Keys, and what they mean; an empty key is the Enter key alone.
        """
