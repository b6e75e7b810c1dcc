"""What comes back to one request, and what is believed of it."""

from __future__ import annotations

from collections.abc import Callable, Collection

from tarsus.hardware.codec.scan import Frame, Scanned

__all__ = ["Exchange"]


class Exchange:
    """The answers to a request, as they come in.

    Parameters
    ----------
    frame : bytes
        The request.
    ids : collection of int
        Who is to answer.
    count : int
        How many bytes of data each answer has.
    sent : bytes
        What was sent before without an answer: its echo may come now.
    belongs : callable, optional
        Whether a frame answers this request, as far as the protocol tells.

    Attributes
    ----------
    found : dict of int to Frame
        Answers by id.
    twice : set of int
        Who answered more than once.
    other : dict of int to Frame
        Frames of those who were asked, which answer something else or refuse.
    foreign : bytes
        Whole frames that answer something else.
    noise : bytes
        What is no frame.
    echo : bool
        Whether the request itself came back.
    """

    def __init__(
        self,
        frame: bytes,
        ids: Collection[int],
        count: int,
        *,
        sent: bytes = b"",
        belongs: Callable[[Frame], bool] | None = None,
    ) -> None:
        self._frame, self._ids, self._count, self._sent, self._belongs = frame, ids, count, sent, belongs
        self.found: dict[int, Frame] = {}
        self.twice: set[int] = set()
        self.other: dict[int, Frame] = {}
        self.foreign, self.noise, self.echo = b"", b"", False

    @property
    def complete(self) -> bool:
        """Whether everybody has answered."""
        return len(self.found) == len(self._ids)

    @property
    def refused(self) -> list[int]:
        """Who has no answer that is believed."""
        return [id for id in self._ids if id not in self.found or id in self.twice]

    def take(self, scanned: Scanned) -> None:
        """Take what has come in.

        Parameters
        ----------
        scanned : Scanned
            What was found in it.
        """
        self.noise += b"".join(scanned.damaged)
        for answer in scanned.frames:
            if answer.raw == self._frame and not self.echo:
                self.echo = True
            elif answer.raw in self._sent:
                # The echo of what nobody answers.
                continue
            elif answer.id in self.found:
                self.twice.add(answer.id)
            elif self._wanted(answer):
                self.found[answer.id] = answer
            else:
                self.foreign += answer.raw
                self.other[answer.id] = answer

    def withdraw(self, suspect: Collection[Frame]) -> None:
        """No longer believe some answers.

        Parameters
        ----------
        suspect : collection of Frame
            Frames that may be damaged.
        """
        for one in suspect:
            if self.found.get(one.id) == one:
                self.noise += self.found.pop(one.id).raw

    def damaged(self, id: int, header: bytes) -> bool:
        """Return whether it is the answer of a servo that was damaged, rather than missing.

        Parameters
        ----------
        id : int
            The servo.
        header : bytes
            With which frames begin.
        """
        blamed = [one for one in self.refused if header + bytes((one,)) in self.noise]
        # If what came tells no id, it may be anybody's.
        return id in blamed if blamed else bool(self.noise)

    def _wanted(self, answer: Frame) -> bool:
        fits = answer.id in self._ids and len(answer.data) == self._count
        return fits and (self._belongs is None or self._belongs(answer))
