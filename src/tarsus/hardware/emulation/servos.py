"""Emulated servos with what they share: the supply, and what goes wrong."""

from __future__ import annotations

import math
from collections.abc import Mapping

from tarsus.hardware.emulation.faults import Faults
from tarsus.hardware.emulation.servo import EmulatedServo
from tarsus.hardware.emulation.supply import Supply
from tarsus.representation import represented

__all__ = ["EmulatedServos"]

# Length of a step; longest time that is divided into steps, after which one step covers the rest [s].
_STEP, _WATCHED = 0.02, 3.0


@represented("ids", "supply", "faults")
class EmulatedServos:
    """Servos on one bus or board, at the level below bytes.

    Parameters
    ----------
    servos : mapping of int to EmulatedServo
        Servos by id or channel.
    supply : Supply, optional
        What feeds them.
    faults : Faults, optional
        What goes wrong.

    Attributes
    ----------
    servos : mapping of int to EmulatedServo
        Servos by id or channel.
    supply : Supply
        What feeds them.
    faults : Faults
        What goes wrong.
    """

    def __init__(
        self,
        servos: Mapping[int, EmulatedServo],
        *,
        supply: Supply | None = None,
        faults: Faults | None = None,
    ) -> None:
        self.servos = dict(servos)
        self.supply, self.faults = supply or Supply(), faults or Faults()
        self._heard: float | None = None
        self._time: float | None = None

    @property
    def ids(self) -> tuple[int, ...]:
        """Ids or channels of the servos."""
        return tuple(self.servos)

    @property
    def plugged(self) -> bool:
        """Whether the line is connected."""
        return not self.faults.unplugged

    def advance(self, now: float) -> None:
        """Move the servos on to a time, as at each request.

        Parameters
        ----------
        now : float
            The time [s], on the transport's clock: behind a pseudo-terminal that of `time.perf_counter`.
        """
        before = now if self._time is None else self._time
        # Time goes on in steps while a watchdog may act, so that it acts at the right time.
        steps = math.ceil(min(now - before, _WATCHED) / _STEP)
        for step in range(1, steps):
            self._step(before + step * _STEP)
        self._step(now)

    def positions(self, now: float) -> dict[int, float]:
        """Return where the shafts are, by id.

        Parameters
        ----------
        now : float
            The time [s].
        """
        self.advance(now)
        return {id: servo.position for id, servo in self.servos.items()}

    def _step(self, now: float) -> None:
        self._time = now
        self._watch(0.0 if self._heard is None else now - self._heard)
        if self.supply.up(now):
            self._follow()
        self.supply.advance(now, self.servos.values())
        if not self.supply.up(now):
            self._started_anew()

    def _watch(self, silent: float) -> None:
        """Carry out what the watchdog does after a time without requests; by default there is none."""

    def _follow(self) -> None:
        """Let servos follow the pulses that they receive; by default they receive none."""

    def _started_anew(self) -> None:
        """Forget what is lost without supply."""
