"""The terminal line that shows the progress of a run, and the totals of the run."""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import TracebackType
from typing import Self

import numpy as np

from tarsus.control.command import Command
from tarsus.control.control_output import ControlOutput
from tarsus.control.loop.run import CommandSource
from tarsus.hardware.plant.pacer import Timing
from tarsus.hardware.plant.servo_plant import ServoPlant
from tarsus.hardware.plant.tick_record import TickRecord

__all__ = ["StatusLine"]

# Interval at which the line is written [s]; writing takes less than a millisecond.
_INTERVAL = 0.25


class StatusLine:
    """Shows state, speed, rate and lateness of a run in one line of a terminal.

    Parameters
    ----------
    quiet : bool
        Whether nothing is shown.

    Attributes
    ----------
    plant : ServoPlant or None
        The plant whose timing is shown; None until it is set.
    timing : Timing or None
        How punctual the ticks of the run were, without those in which the robot sits down at the end.
    """

    def __init__(self, *, quiet: bool) -> None:
        self._quiet = quiet or not sys.stderr.isatty()
        self.plant: ServoPlant | None = None
        self.timing: Timing | None = None
        self.duration = 0.0
        self.lowest_voltage: float | None = None
        self._shown = -_INTERVAL
        self._squares, self._count, self._worst = 0.0, 0, 0.0
        self._running = False

    def __enter__(self) -> Self:
        """Return the line itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End the line in the terminal."""
        if not self._quiet and self._shown >= 0:
            self._put("\n")

    def say(self, text: str) -> None:
        """Write a text as a line of its own."""
        if not self._quiet:
            self._put(f"{text}\n")

    @property
    def tracking(self) -> dict[str, float] | None:
        """RMS and greatest difference of commanded and measured angles [deg]; None where nothing was measured."""
        if not self._count:
            return None
        return {"rms": float(np.degrees(np.sqrt(self._squares / self._count))), "worst": float(np.degrees(self._worst))}

    def observer(self, write: Callable[[TickRecord], None] | None) -> Callable[[TickRecord], None]:
        """Return an observer of the plant, which keeps the totals of its records.

        Parameters
        ----------
        write : callable, optional
            Another observer, to which every record is passed on.
        """

        def observe(record: TickRecord) -> None:
            if write is not None:
                write(record)
            if record.voltage is not None:
                self.lowest_voltage = min(record.voltage, self.lowest_voltage or np.inf)
            if self._running and not np.isnan(record.measured).any():
                behind = np.abs(record.sent - record.measured)
                self._squares += float((behind * behind).mean())
                self._worst = max(self._worst, float(behind.max()))
                self._count += 1

        return observe

    def watched(self, source: CommandSource) -> CommandSource:
        """Return a source of commands that shows each tick.

        Parameters
        ----------
        source : CommandSource
            The source whose commands are passed on.
        """
        line = self

        class Watched:
            def command(self, time: float, output: ControlOutput, note: Callable[[str, str], None]) -> Command:
                """Return the command for the next tick."""
                line._running = True
                line._show(time, output)
                return source.command(time, output, note)

            def over(self, time: float, output: ControlOutput) -> bool:
                """Return whether the run is over."""
                ended = source.over(time, output)
                if ended and line.plant is not None:
                    line._running, line.timing = False, line.plant.timing
                return ended

        return Watched()

    def _show(self, time: float, output: ControlOutput) -> None:
        self.duration = time
        if self.plant is not None and time - self._shown >= _INTERVAL:
            self._shown = time
            self.timing = self.plant.timing
            self._write(time, output, self.timing)

    def _write(self, time: float, output: ControlOutput, timing: Timing) -> None:
        if self._quiet:
            return
        vx, vy, wz = output.twist
        late = f"late {timing.median * 1e3:.1f} ms, worst {timing.worst * 1e3:.1f}, {timing.missed} missed"
        parts = [
            f"{time:6.1f} s {output.activity}",
            f"{np.hypot(vx, vy) * 1e3:.0f} mm/s {np.degrees(wz):.0f} deg/s",
            f"{timing.rate:.1f} Hz, {late}",
        ]
        if self.lowest_voltage is not None:
            parts.append(f"{self.lowest_voltage:.1f} V")
        self._put("\r" + "  ".join(parts).ljust(110)[:140])

    def _put(self, text: str) -> None:
        try:
            sys.stderr.write(text)
            sys.stderr.flush()
        except OSError:
            # A closed terminal must not end the run by an exception: its signal makes the robot sit down.
            self._quiet = True
