"""Reading the same registers of several servos, with as few packets as they understand."""

from __future__ import annotations

from collections.abc import Sequence

from tarsus.hardware.bus.answers import Answers
from tarsus.hardware.bus.dialect import Series
from tarsus.hardware.bus.link import Link
from tarsus.hardware.bus.one_by_one import one_by_one
from tarsus.hardware.codec.dynamixel2_fast import split_fast
from tarsus.hardware.codec.packet import BROADCAST
from tarsus.hardware.codec.scan import Frame
from tarsus.hardware.transport.wire import serial_seconds

__all__ = ["RegisterReader"]


class RegisterReader:
    """Reads registers of servos.

    Parameters
    ----------
    link : Link
        The line.
    series : Series
        Series of the servos.
    fast : bool
        Whether several servos answer in one shared packet, if their series can.
    turnaround : float, optional
        Time from a request to the answer, for computed times [s]; by default with the servos' factory settings.
    """

    def __init__(self, link: Link, series: Series, *, fast: bool, turnaround: float | None) -> None:
        self._link, self._series = link, series
        self._fast = series.read_fast if fast else None
        self._turnaround = series.turnaround if turnaround is None else turnaround

    def read(self, ids: Sequence[int], block: tuple[int, int]) -> Answers[Frame]:
        """Return registers of servos.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        block : tuple of int
            The first address, and how many bytes.
        """
        many = self._series.read_many
        if self._fast is not None and len(ids) > 1:
            whole = self._link.ask(self._fast(ids, *block), (BROADCAST,), len(ids) * (block[1] + 4) - 3)
            parts = [one for frame in whole.values.values() for one in split_fast(frame, block[1])]
            if [one.id for one in parts] == list(ids):
                return Answers({one.id: one for one in parts})
        # If one servo is missing, the shared packet is incomplete; asked for separate packets, the other servos answer.
        if many is not None and len(ids) > 1:
            return self._link.ask(many(ids, *block), ids, block[1])
        return one_by_one(ids, lambda id: self._link.ask(self._series.dialect.read(id, *block), (id,), block[1]))

    def seconds(self, ids: Sequence[int], block: tuple[int, int]) -> float:
        """Return how long reading takes on the wire [s].

        Parameters
        ----------
        ids : sequence of int
            The servos.
        block : tuple of int
            The first address, and how many bytes.
        """
        series, baud, count = self._series, self._link.transport.baud, block[1]
        if self._fast is not None and len(ids) > 1:
            size = len(self._fast(ids, *block)) + 8 + len(ids) * (count + 4)
            return serial_seconds(size, baud) + self._turnaround
        answers = len(ids) * (serial_seconds(series.dialect.answer + count, baud) + self._turnaround)
        if series.read_many is not None and len(ids) > 1:
            return answers + serial_seconds(len(series.read_many(ids, *block)), baud)
        return answers + len(ids) * serial_seconds(len(series.dialect.read(1, *block)), baud)
