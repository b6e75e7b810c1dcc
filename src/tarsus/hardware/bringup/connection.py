"""The port of a machine under bring-up: found, opened, and opened again after the cable was out."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import TypeAlias, TypeVar

from tarsus.errors import BusError, CorruptAnswerError, PortError
from tarsus.hardware.bringup.bench import Bench
from tarsus.hardware.bringup.dialogue import Topic
from tarsus.hardware.bringup.progress import Progress
from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.calibration.parts import BusSettings
from tarsus.hardware.transport.clock import Clock

__all__ = ["Connection", "Opener", "find_servos"]

Opener: TypeAlias = Callable[[BusSettings], Bus]
"""Opens the bus that settings describe."""

_Result = TypeVar("_Result")
# How many more ids than needed are searched, as servos may come with other ids than expected.
_SPARE = 12
_TOPIC = Topic(title="Port and servos")


class Connection:
    """Connects to the servos, and repeats a step during which the connection was lost.

    Parameters
    ----------
    progress : Progress
        The calibration so far, with the settings of the bus.
    open_bus : callable
        Opens the bus of settings.
    ports : callable
        Returns the names of the ports that there are.
    clock : Clock
        The clock.
    """

    def __init__(
        self, progress: Progress, *, open_bus: Opener, ports: Callable[[], tuple[str, ...]], clock: Clock
    ) -> None:
        self._progress, self._open, self._ports, self._clock = progress, open_bus, ports, clock
        self._bench: Bench | None = None
        self._boards: dict[str, Bus] = {}

    def perform(self, step: Callable[[Bench], _Result]) -> _Result:
        """Do a step and return its result; where the connection is lost, ask for the cable and begin the step again.

        Parameters
        ----------
        step : callable
            The step.
        """
        ask = self._progress.ask
        while True:
            try:
                if self._bench is None:
                    self._bench = self._connect()
                    if not self._bench.measures:
                        # Pulses that a board still sends would hold servos that are not identified yet.
                        self._bench.release(None)
                return step(self._bench)
            except PortError as error:
                self.close()
                ask.say(str(error))
                options = {"": "go on", "s": "search for the servos on all ports"}
                if ask.choose("Plug it in again.", options, topic=_TOPIC) == "s":
                    self._search_anew()
            except BusError as error:
                self.close()
                ask.say(str(error))
                ask.choose("Look at the cable and the supply.", {"": "try again"}, topic=_TOPIC)

    def _search_anew(self) -> None:
        calibration = self._progress.calibration
        first = dataclasses.replace(calibration.buses[0], port="")
        self._progress.keep(calibration.replace(buses=(first, *calibration.buses[1:])))

    def close(self) -> None:
        """Release all servos, and close the ports."""
        if self._bench is not None:
            self._bench.close()
            self._bench = None
        for board in self._boards.values():
            board.close()
        self._boards.clear()

    def board(self, bench: Bench, settings: BusSettings) -> Bus:
        """Return the bus that settings describe: that of the bench, or another one, which is opened if need be.

        Parameters
        ----------
        bench : Bench
            The servos.
        settings : BusSettings
            Settings of a bus of the calibration.

        Raises
        ------
        PortError
            If its port can't be opened.
        """
        if settings.name == self._progress.calibration.buses[0].name:
            return bench.bus
        if settings.name not in self._boards:
            self._boards[settings.name] = self._open(settings)
        return self._boards[settings.name]

    def open_all(self) -> dict[str, Bus]:
        """Close the bench, and open all buses of the calibration, by their names."""
        self.close()
        return {settings.name: self._open(settings) for settings in self._progress.calibration.buses}

    def _connect(self) -> Bench:
        """Open the port of the calibration, or the first one on which servos answer."""
        progress, ask = self._progress, self._progress.ask
        settings = progress.calibration.buses[0]
        if settings.port:
            return Bench(self._open(settings), progress.calibration, self._clock, blank=progress.blank)
        while True:
            for port in self._ports():
                found = dataclasses.replace(settings, port=port)
                try:
                    bus = self._open(found)
                except PortError:
                    continue
                if bus.capabilities.ping == "none" or bus.scan(_range(progress, bus)).values:
                    progress.keep(progress.calibration.replace(buses=(found, *progress.calibration.buses[1:])))
                    ask.say(f"servos answer on {port}")
                    return Bench(bus, progress.calibration, self._clock, blank=progress.blank)
                bus.close()
            names = ", ".join(self._ports()) or "none"
            ask.say(f"no servo answers; ports found: {names}. Check the USB cable and switch the servos on.")
            ask.choose("Search again?", {"": "yes"}, topic=_TOPIC)


def find_servos(progress: Progress, bench: Bench) -> tuple[int, ...]:
    """Return the ids or channels of the servos; where some are missing, ask whether to search again.

    Parameters
    ----------
    progress : Progress
        The calibration so far.
    bench : Bench
        The servos.
    """
    bus, needed, ask = bench.bus, progress.joints, progress.ask
    if bus.capabilities.ping != "servo":
        return tuple(_range(progress, bus))
    while True:
        found = bus.scan(_range(progress, bus))
        numbers = tuple(sorted(found.values))
        for number in sorted(
            {error.id for error in found.errors if error.id is not None and isinstance(error, CorruptAnswerError)}
        ):
            ask.say(f"id {number}: damaged answers. Two servos may have it: give one of them another id.")
        ask.say(f"{len(numbers)} of {needed} servos answer: {_listed(numbers)}")
        if len(numbers) >= needed:
            return numbers
        options = {"": "search again", "c": "continue without them"}
        if ask.choose("Some are missing.", options, topic=_TOPIC) == "c":
            return numbers


def _range(progress: Progress, bus: Bus) -> range:
    ids = bus.capabilities.ids
    return range(ids.start, min(ids.start + progress.joints + _SPARE, ids.stop))


def _listed(numbers: tuple[int, ...]) -> str:
    """Return numbers as ranges: ``1 to 5, 7``."""
    parts: list[list[int]] = []
    for number in numbers:
        if parts and parts[-1][-1] == number - 1:
            parts[-1].append(number)
        else:
            parts.append([number])
    return ", ".join(f"{part[0]} to {part[-1]}" if len(part) > 1 else str(part[0]) for part in parts) or "none"
