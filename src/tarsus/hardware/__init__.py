"""Real robots: calibration, servo buses and their transports, and emulated servos that speak the same bytes.

::

    from tarsus import hardware

    bus = hardware.open_bus("feetech-sts", "/dev/ttyUSB0")
    print(bus.scan())
    bus.write_goals({1: 2048, 2: 1900})

pyserial and smbus2 are imported when a port is opened; the extra ``hardware`` installs them.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tarsus.hardware.bus.answers import Answers, BusServo, BusTiming, Telemetry
    from tarsus.hardware.bus.capabilities import Capabilities
    from tarsus.hardware.bus.inputs import InputBoard
    from tarsus.hardware.bus.protocol import Bus
    from tarsus.hardware.bus.registry import BUSES, BusKind, bus_over, open_bus
    from tarsus.hardware.calibration.blank import new_calibration, nominal_calibration
    from tarsus.hardware.calibration.bus_commands import BUS_COMMANDS, BusCommands
    from tarsus.hardware.calibration.calibration import Calibration
    from tarsus.hardware.calibration.parts import (
        BusSettings,
        FootSwitches,
        JointCalibration,
        Mounting,
        SupplySettings,
    )
    from tarsus.hardware.calibration.schema import calibration_schema
    from tarsus.hardware.emulation.faults import Faults
    from tarsus.hardware.emulation.line import EmulatedLine
    from tarsus.hardware.emulation.registry import emulate, emulated_bus
    from tarsus.hardware.emulation.servo import EmulatedServo, ServoTraits
    from tarsus.hardware.emulation.supply import Supply
    from tarsus.hardware.plant.fault import FaultKind, Reaction, ServoFault
    from tarsus.hardware.plant.pacer import Timing
    from tarsus.hardware.plant.servo_plant import ServoPlant
    from tarsus.hardware.plant.settings import PlantSettings
    from tarsus.hardware.plant.tick_record import TickRecord
    from tarsus.hardware.sensors.attitude_line import AttitudeLine
    from tarsus.hardware.transport.clock import ManualClock, SystemClock
    from tarsus.hardware.transport.memory import MemoryI2c, MemoryTransport
    from tarsus.hardware.transport.pty import PtyServer
    from tarsus.hardware.transport.serial import SerialTransport, list_ports

_HOMES = {
    "tarsus.hardware.bus.inputs": ("InputBoard",),
    "tarsus.hardware.bus.answers": ("Answers", "BusServo", "BusTiming", "Telemetry"),
    "tarsus.hardware.bus.capabilities": ("Capabilities",),
    "tarsus.hardware.bus.protocol": ("Bus",),
    "tarsus.hardware.bus.registry": ("BUSES", "BusKind", "bus_over", "open_bus"),
    "tarsus.hardware.calibration.blank": ("new_calibration", "nominal_calibration"),
    "tarsus.hardware.calibration.bus_commands": ("BUS_COMMANDS", "BusCommands"),
    "tarsus.hardware.calibration.calibration": ("Calibration",),
    "tarsus.hardware.calibration.parts": (
        *("BusSettings", "FootSwitches", "JointCalibration", "Mounting", "SupplySettings"),
    ),
    "tarsus.hardware.calibration.schema": ("calibration_schema",),
    "tarsus.hardware.emulation.faults": ("Faults",),
    "tarsus.hardware.emulation.line": ("EmulatedLine",),
    "tarsus.hardware.emulation.registry": ("emulate", "emulated_bus"),
    "tarsus.hardware.emulation.servo": ("EmulatedServo", "ServoTraits"),
    "tarsus.hardware.emulation.supply": ("Supply",),
    "tarsus.hardware.plant.fault": ("FaultKind", "Reaction", "ServoFault"),
    "tarsus.hardware.plant.pacer": ("Timing",),
    "tarsus.hardware.plant.servo_plant": ("ServoPlant",),
    "tarsus.hardware.plant.settings": ("PlantSettings",),
    "tarsus.hardware.plant.tick_record": ("TickRecord",),
    "tarsus.hardware.sensors.attitude_line": ("AttitudeLine",),
    "tarsus.hardware.transport.clock": ("ManualClock", "SystemClock"),
    "tarsus.hardware.transport.memory": ("MemoryI2c", "MemoryTransport"),
    "tarsus.hardware.transport.pty": ("PtyServer",),
    "tarsus.hardware.transport.serial": ("SerialTransport", "list_ports"),
}
_HOME_OF = {name: module for module, names in _HOMES.items() for name in names}

__all__ = [
    "BUSES",
    "BUS_COMMANDS",
    "Answers",
    "AttitudeLine",
    "Bus",
    "BusCommands",
    "BusKind",
    "BusServo",
    "BusSettings",
    "BusTiming",
    "Calibration",
    "Capabilities",
    "EmulatedLine",
    "EmulatedServo",
    "FaultKind",
    "Faults",
    "FootSwitches",
    "InputBoard",
    "JointCalibration",
    "ManualClock",
    "MemoryI2c",
    "MemoryTransport",
    "Mounting",
    "PlantSettings",
    "PtyServer",
    "Reaction",
    "SerialTransport",
    "ServoFault",
    "ServoPlant",
    "ServoTraits",
    "Supply",
    "SupplySettings",
    "SystemClock",
    "Telemetry",
    "TickRecord",
    "Timing",
    "bus_over",
    "calibration_schema",
    "emulate",
    "emulated_bus",
    "list_ports",
    "new_calibration",
    "nominal_calibration",
    "open_bus",
]


def __getattr__(name: str) -> Any:
    """Import a public name from where it lives."""
    if name not in _HOME_OF:
        raise AttributeError(f"module 'tarsus.hardware' has no attribute {name!r}")
    value = getattr(import_module(_HOME_OF[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
