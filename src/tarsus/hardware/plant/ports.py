"""The ports of a machine: opened as its calibration says, and closed again."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tarsus.errors import BusError, InputError, PortError
from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.bus.registry import open_bus
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.sensors.attitude_line import AttitudeLine

__all__ = ["Ports", "open_buses"]


class Ports:
    """The buses and the inertial sensor of a machine; buses that the caller gives stay open at the end.

    Parameters
    ----------
    calibration : Calibration
        Its calibration.
    buses : mapping of str to Bus, optional
        The buses by their names in the calibration; opened on its ports where left out.
    imu : AttitudeLine, optional
        The inertial sensor; that of the calibration where left out and the buses are opened here.
    timeout : float
        Longest time until an answer begins [s].

    Attributes
    ----------
    buses : mapping of str to Bus
        The buses by name.
    imu : AttitudeLine or None
        The inertial sensor.

    Raises
    ------
    InputError
        If a bus is missing, or has no port.
    PortError
        If a port can't be opened; those that are open already are closed again.
    """

    def __init__(
        self, calibration: Calibration, buses: Mapping[str, Bus] | None, imu: AttitudeLine | None, *, timeout: float
    ) -> None:
        self._opened = buses is None
        self.buses = open_buses(calibration, timeout=timeout) if buses is None else dict(buses)
        self.imu = imu
        missing = [bus.name for bus in calibration.buses if bus.name not in self.buses]
        if missing:
            raise InputError(f"no bus is given for {', '.join(missing)} of the calibration")
        if self._opened and imu is None and calibration.imu:
            try:
                self.imu = AttitudeLine(calibration.imu)
            except BusError:
                self.close()
                raise

    def close(self) -> None:
        """Close the ports that were opened here; may be called more than once."""
        if not self._opened:
            return
        for bus in self.buses.values():
            bus.close()
        if self.imu is not None:
            self.imu.close()


def open_buses(calibration: Calibration, *, timeout: float | None = None) -> Mapping[str, Bus]:
    """Open the ports of a calibration, and return its buses by name.

    Parameters
    ----------
    calibration : Calibration
        The calibration; each bus needs a port.
    timeout : float, optional
        Longest time until an answer begins, for buses whose servos answer [s].

    Raises
    ------
    InputError
        If a bus has no port.
    PortError
        If a port can't be opened; those that are open already are closed again.
    """
    opened: dict[str, Bus] = {}
    try:
        for settings in calibration.buses:
            if not settings.port:
                raise InputError(
                    f"the bus {settings.name!r} has no port in the calibration; add port = ..., or let tarsus bring-up "
                    "find it"
                )
            options: dict[str, Any] = (
                {} if timeout is None or not settings.properties.feedback else {"timeout": timeout}
            )
            if settings.addresses:
                options["addresses"] = settings.addresses
            opened[settings.name] = open_bus(settings.kind, settings.port, baud=settings.baud, **options)
    except (PortError, InputError):
        for bus in opened.values():
            bus.close()
        raise
    return opened
