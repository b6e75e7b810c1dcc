"""The dialogue of a bring-up in a page: the thread of the bring-up waits until the visitor answers."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping

from tarsus.errors import InputError
from tarsus.hardware.bringup.dialogue import Left, Topic
from tarsus.hardware.transport.clock import Clock
from tarsus.studio.messages.machine import Choice, Question

__all__ = ["LeavingClock", "PageDialogue"]

# Number of the latest lines that a page shows.
_LINES = 8


class PageDialogue:
    """A dialogue with a visitor in a page. `say` and `choose` are called in the thread of the bring-up.

    Parameters
    ----------
    before_going_on : callable
        Called with the topic of a question after it was answered with the usual answer, in the thread of the bring-up.
    """

    def __init__(self, before_going_on: Callable[[Topic], None]) -> None:
        self._before_going_on = before_going_on
        self._changed = threading.Condition()
        self._number = 0
        self._key: str | None = None
        self._leaving = False
        # Replaced as a whole, never changed: the page reads it in another thread.
        self.said: tuple[str, ...] = ()
        self.question: Question | None = None

    def say(self, text: str) -> None:
        """Show a line of text in the page.

        Parameters
        ----------
        text : str
            The line.
        """
        self.said = (*self.said, text)[-_LINES:]

    def choose(self, question: str, options: Mapping[str, str], *, topic: Topic) -> str:
        """Ask a question, wait for the answer, and return the key of the option that was chosen.

        Parameters
        ----------
        question : str
            The question.
        options : mapping of str to str
            Meanings of the options by their keys; the empty key is the usual answer.
        topic : Topic
            What the question is about.

        Raises
        ------
        Left
            If the visitor leaves.
        """
        with self._changed:
            self.raise_if_left()
            self._number += 1
            self._key = None
            self.question = Question(
                number=self._number,
                title=topic.title,
                text=question,
                choices=[Choice(key=key, text=text) for key, text in options.items()],
                leg=topic.leg,
                joint=topic.joint,
            )
            self._changed.wait_for(lambda: self._key is not None or self._leaving)
            self.question = None
            self.raise_if_left()
            key = str(self._key)
        if not key:
            self._before_going_on(topic)
        return key

    def answer(self, number: int, key: str) -> None:
        """Answer a question.

        Parameters
        ----------
        number : int
            Number of the question.
        key : str
            Key of the choice.

        Raises
        ------
        InputError
            If the question is not asked now, or has no such choice.
        """
        with self._changed:
            question = self.question
            if question is None or question.number != number or self._key is not None:
                raise InputError("this question is not asked now: it was answered already")
            if key not in [choice.key for choice in question.choices]:
                keys = ", ".join(repr(choice.key) for choice in question.choices)
                raise InputError(f"{key!r} is no choice of this question; there are {keys}")
            self._key = key
            self._changed.notify_all()

    def leave(self) -> None:
        """End the dialogue: at once where a question is asked, else at the next tick of a motion."""
        with self._changed:
            self._leaving = True
            self._changed.notify_all()

    def raise_if_left(self) -> None:
        """Raise `Left` once after the visitor has left, so that what then ends a motion is not interrupted."""
        if self._leaving:
            self._leaving = False
            raise Left


class LeavingClock:
    """A clock that interrupts motions when the visitor leaves.

    Parameters
    ----------
    clock : Clock
        The clock.
    dialogue : PageDialogue
        The dialogue that the visitor may leave.
    """

    def __init__(self, clock: Clock, dialogue: PageDialogue) -> None:
        self._clock, self._dialogue = clock, dialogue

    def now(self) -> float:
        """Return the time since an arbitrary moment [s]."""
        return self._clock.now()

    def sleep(self, seconds: float) -> None:
        """Wait, unless the visitor has left.

        Parameters
        ----------
        seconds : float
            Time to wait [s].

        Raises
        ------
        Left
            If the visitor has left.
        """
        self._dialogue.raise_if_left()
        self._clock.sleep(seconds)
