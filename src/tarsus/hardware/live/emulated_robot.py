"""An emulated robot: servos behind pseudo-terminals, on which the same drivers run as on real ones."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Mapping
from functools import cached_property
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from tarsus.hardware.bus.dialect import SERIES
from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.bus.registry import bus_kind, bus_over
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.calibration.parts import BusSettings
from tarsus.hardware.emulation.registry import emulate
from tarsus.hardware.live.emulated_feet import EmulatedFeet
from tarsus.hardware.transport.clock import SystemClock
from tarsus.hardware.transport.memory import MemoryI2c, MemoryTransport
from tarsus.hardware.transport.pty import PtyServer
from tarsus.hardware.transport.served import ServedTransport

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["EmulatedRobot"]

_PSEUDO_TERMINALS = hasattr(os, "openpty")
# Servos whose rate can be set get one at which 18 of them keep up with 100 ticks a second.
_FAST = 1_000_000


class EmulatedRobot:
    """The servos of a calibration, emulated at the level of bytes; serial ones behind pseudo-terminals.

    Where the system has no pseudo-terminals the same bytes travel in memory.

    Parameters
    ----------
    calibration : Calibration
        A complete calibration.
    angles : array, shape (legs, 3)
        Where the joints are at first [rad].

    Attributes
    ----------
    calibration : Calibration
        The calibration with the ports of the emulated buses.
    lines : mapping of str to EmulatedLine
        The emulated servos, by the names of their buses.
    """

    def __init__(self, calibration: Calibration, angles: Float[np.ndarray, "legs 3"]) -> None:
        self.lines: dict[str, Any] = {}
        self._servers: dict[str, PtyServer] = {}
        self._i2c: dict[str, Bus] = {}
        commands = calibration.commands(angles).tolist()
        buses = []
        for settings in calibration.buses:
            numbers = {
                joint.number: commands[leg][j]
                for leg, row in enumerate(calibration.joints)
                for j, joint in enumerate(row)
                if joint.bus == settings.name and joint.number is not None
            }
            kind = bus_kind(settings.kind)
            serial = kind.transport == "serial"
            baud = _FAST if settings.kind in SERIES else kind.baud
            line = emulate(settings.kind, numbers, **({"baud": baud} if serial else {}))
            for number, command in numbers.items():
                line.servos[number].place(command)
            self.lines[settings.name] = line
            if serial:
                port = f"emulated {settings.name}"
                if _PSEUDO_TERMINALS:
                    self._servers[settings.name] = PtyServer(line)
                    port = self._servers[settings.name].port
            else:
                port = "emulated I2C"
                self._i2c[settings.name] = bus_over(settings.kind, MemoryI2c(line, SystemClock()))
            buses.append(dataclasses.replace(settings, port=port, baud=baud if serial else None))
        self.calibration = calibration.replace(buses=tuple(buses))
        if calibration.foot_switches is not None:
            self.lines[calibration.foot_switches.bus].levels = EmulatedFeet(calibration, self.lines)

    @cached_property
    def buses(self) -> Mapping[str, Bus]:
        """The buses by name, as for a `ServoPlant`; closed with the robot."""
        return {each.name: self.open(each) for each in self.calibration.buses}

    def open(self, settings: BusSettings, baud: int | None = None) -> Bus:
        """Return a bus of the robot.

        Parameters
        ----------
        settings : BusSettings
            Its settings, as in `calibration`.
        baud : int, optional
            Another rate than that of the settings.
        """
        if settings.name in self._i2c:
            return self._i2c[settings.name]
        rate = baud or settings.baud or bus_kind(settings.kind).baud
        transport: ServedTransport | MemoryTransport
        if settings.name in self._servers:
            transport = ServedTransport(self._servers[settings.name], rate)
        else:
            transport = MemoryTransport(self.lines[settings.name], SystemClock(), port=settings.port)
        return bus_over(settings.kind, transport)

    def __enter__(self) -> Self:
        """Return the robot itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the buses, and end the emulation."""
        for bus in self.__dict__.get("buses", {}).values():
            bus.close()
        for server in self._servers.values():
            server.close()
