"""The answers to one request: which of them are accepted, and what else arrives."""

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
        Ids of the servos that are to answer.
    count : int
        How many bytes of data each answer has.
    sent : bytes
        Frames sent before that nobody answers: their echoes may still arrive.
    belongs : callable, optional
        Returns whether a frame answers this request, as far as the protocol shows.

    Attributes
    ----------
    found : dict of int to Frame
        Answers by id.
    twice : set of int
        Ids that answered more than once.
    other : dict of int to Frame
        Frames by id that are no answer to this request: they answer something else, or refuse it.
    foreign : bytes
        The bytes of all such frames, in the order of their arrival.
    noise : bytes
        Bytes that belong to no frame, damaged frames, and answers that were withdrawn.
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
        """Whether all servos have answered."""
        return len(self.found) == len(self._ids)

    @property
    def refused(self) -> list[int]:
        """Ids without an accepted answer, or with more than one answer."""
        return [id for id in self._ids if id not in self.found or id in self.twice]

    def take(self, scanned: Scanned) -> None:
        """Sort what has arrived into answers, other frames and noise.

        Parameters
        ----------
        scanned : Scanned
            What was found in the bytes that have arrived.
        """
        self.noise += b"".join(scanned.damaged)
        for answer in scanned.frames:
            if answer.raw == self._frame and not self.echo:
                self.echo = True
            elif answer.raw in self._sent:
                # The echo of a frame that nobody answers.
                continue
            elif answer.id in self.found:
                self.twice.add(answer.id)
            elif self._wanted(answer):
                self.found[answer.id] = answer
            else:
                self.foreign += answer.raw
                self.other[answer.id] = answer

    def withdraw(self, suspect: Collection[Frame]) -> None:
        """Withdraw answers that may be damaged.

        Parameters
        ----------
        suspect : collection of Frame
            Frames that may be damaged.
        """
        for one in suspect:
            if self.found.get(one.id) == one:
                self.noise += self.found.pop(one.id).raw

    def damaged(self, id: int, header: bytes) -> bool:
        """Return whether the answer of a servo was damaged, rather than missing.

        Parameters
        ----------
        id : int
            The servo.
        header : bytes
            Bytes with which frames begin.
        """
        blamed = [one for one in self.refused if header + bytes((one,)) in self.noise]
        # Where the noise shows none of these ids behind a header, it may come from any servo.
        return id in blamed if blamed else bool(self.noise)

    def _wanted(self, answer: Frame) -> bool:
        fits = answer.id in self._ids and len(answer.data) == self._count
        return fits and (self._belongs is None or self._belongs(answer))
