"""A bring-up that asks in a page: its thread waits until the visitor answers."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping

from tarsus.errors import InputError
from tarsus.hardware.bringup.dialogue import Left, Topic
from tarsus.hardware.transport.clock import Clock
from tarsus.studio.messages.machine import Choice, Question

__all__ = ["LeavingClock", "PageDialogue"]

# How many of the last lines a page shows.
_LINES = 8


class PageDialogue:
    """Someone who answers in a page. `say` and `choose` are called in the thread of the bring-up.

    Parameters
    ----------
    before_going_on : callable
        Called with the topic of a question, in the thread of the bring-up, once it was answered with the usual answer.
    """

    def __init__(self, before_going_on: Callable[[Topic], None]) -> None:
        self._before_going_on = before_going_on
        self._changed = threading.Condition()
        self._number = 0
        self._key: str | None = None
        self._leaving = False
        # Replaced, never changed: the page reads them in another thread.
        self.said: tuple[str, ...] = ()
        self.question: Question | None = None

    def say(self, text: str) -> None:
        """Tell something.

        Parameters
        ----------
        text : str
            What.
        """
        self.said = (*self.said, text)[-_LINES:]

    def choose(self, question: str, options: Mapping[str, str], *, topic: Topic) -> str:
        """Ask, and wait for the key of an option.

        Parameters
        ----------
        question : str
            The question.
        options : mapping of str to str
            Keys, and what they mean.
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
            Its number.
        key : str
            Key of one of its choices.

        Raises
        ------
        InputError
            If it is not asked now, or has no such choice.
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
        """Leave, at once where a question is asked, else with the next tick of a motion."""
        with self._changed:
            self._leaving = True
            self._changed.notify_all()

    def raise_if_left(self) -> None:
        """Raise `Left` where the visitor has left, once: what ends a motion then is not interrupted."""
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
        Where the visitor is.
    """

    def __init__(self, clock: Clock, dialogue: PageDialogue) -> None:
        self._clock, self._dialogue = clock, dialogue

    def now(self) -> float:
        """Return the time [s]; only differences mean something."""
        return self._clock.now()

    def sleep(self, seconds: float) -> None:
        """Wait.

        Parameters
        ----------
        seconds : float
            How long [s].

        Raises
        ------
        Left
            If the visitor has left.
        """
        self._dialogue.raise_if_left()
        self._clock.sleep(seconds)
