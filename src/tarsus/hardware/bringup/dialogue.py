"""How the bring-up asks: what a terminal, a page of the studio, or a test, must be able to do."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, Protocol

__all__ = ["Dialogue", "Left", "Topic"]


class Left(Exception):  # noqa: N818 - no error: the user went away
    """The bring-up was left; what was answered is saved."""


@dataclass(frozen=True, kw_only=True)
class Topic:
    """What a question is about, for a dialogue that shows it in a picture.

    Attributes
    ----------
    title : str
        The step: ``"Zeros"``.
    leg, joint : int or None
        Numbers of the leg and of the joint; None where it is about all or none.
    pose : str
        Where the leg or the joint is to be brought, by hand or in small steps: to the reference pose or an end of its
        travel; ``"pressed"`` where its foot is to be pressed, empty where nothing is to be moved.
    """

    title: str = ""
    leg: int | None = None
    joint: int | None = None
    pose: Literal["", "reference", "one end", "the other end", "pressed"] = ""


class Dialogue(Protocol):
    """Someone who answers."""

    def say(self, text: str) -> None:
        """Show a message.

        Parameters
        ----------
        text : str
            The message.
        """

    def choose(self, question: str, options: Mapping[str, str], *, topic: Topic) -> str:
        """Ask a question, and return the key of the chosen option; raise `Left` where whoever answers goes away.

        Parameters
        ----------
        question : str
            The question.
        options : mapping of str to str
            Keys, and what they mean; an empty key is the Enter key alone.
        topic : Topic
            What the question is about.
        """
