"""The tables of docs/buses.md: what each servo bus can do, and how long a tick takes on the wire."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from page_tables import with_tables
from tarsus import hardware

__all__ = ["with_buses"]

SERVOS = range(18)
# Bus, rate, options of the bus, and what to say of them.
RATES: tuple[tuple[str, int, dict[str, Any], str], ...] = (
    ("feetech-sts", 1_000_000, {}, ""),
    ("feetech-scs", 1_000_000, {}, ""),
    ("dynamixel-x", 57_600, {}, "as delivered"),
    ("dynamixel-x", 1_000_000, {}, "return delay as delivered, 500 us"),
    ("dynamixel-x", 1_000_000, {"turnaround": 50e-6}, "return delay 0"),
    ("dynamixel-x", 1_000_000, {"turnaround": 50e-6, "fast": True}, "return delay 0, fast reading"),
    ("dynamixel-x", 4_000_000, {"turnaround": 50e-6, "fast": True}, "return delay 0, fast reading"),
    ("dynamixel-mx", 1_000_000, {"turnaround": 50e-6}, "return delay 0"),
    ("dynamixel-ax", 1_000_000, {"turnaround": 50e-6}, "return delay 0"),
    ("lx16a", 115_200, {}, "the only rate"),
    ("maestro", 115_200, {}, "serial line; USB is faster"),
    ("ssc32", 9_600, {}, "as delivered"),
    ("ssc32", 115_200, {}, ""),
    ("servo2040", 115_200, {}, "USB is faster"),
    ("lines", 115_200, {}, ""),
    ("pca9685", 100_000, {}, "Raspberry Pi as delivered; no other I2C device"),
    ("pca9685", 400_000, {}, ""),
)


def bus_at(name: str, rate: int, **options: Any) -> hardware.Bus:
    """Return a bus in memory at a baud rate, or clock of I2C."""
    device = hardware.emulate(name, SERVOS)
    if hardware.BUSES[name].transport == "i2c":
        return hardware.bus_over(name, hardware.MemoryI2c(device, frequency=rate), **options)
    device.baud = rate
    return hardware.bus_over(name, hardware.MemoryTransport(device), **options)


def yes(value: object) -> str:
    return "yes" if value else "-"


def capability_rows() -> Iterator[str]:
    yield "| bus | for | goals in | measures | inputs | torque off | limits, speed, torque | watchdog |"
    yield "|---|---|---|---|---|---|---|---|"
    for name, kind in hardware.BUSES.items():
        can = bus_at(name, kind.baud).capabilities
        measured = sorted({*can.telemetry, *(("position",) if can.positions else ())})
        limits = ", ".join(yes(one) for one in (can.limits, can.speed_limit, can.torque_limit))
        watchdog, inputs = "-", str(hardware.BUS_COMMANDS[name].inputs or "-")
        if can.watchdog:
            watchdog = f"{can.watchdog[0]:g} to {can.watchdog[1]:g} s, then {can.watchdog_action}"
        unit = f"{can.unit}, {can.lowest:g} to {can.highest:g}"
        unit += f", {can.per_turn:g} a turn" if can.per_turn else ""
        cells = (f"`{name}`", kind.title, unit, ", ".join(measured) or "-", inputs, can.torque_off, limits, watchdog)
        yield "| " + " | ".join(cells) + " |"


def rate_rows() -> Iterator[str]:
    yield "| bus | rate | setting | goals | positions | telemetry | goals and positions, at most |"
    yield "|---|---|---|---|---|---|---|"
    for name, rate, options, note in RATES:
        timing = bus_at(name, rate, **options).timing(SERVOS)
        parts = (timing.goals, timing.positions, timing.telemetry)
        times = [f"{1e3 * seconds:.2f} ms" if seconds else "-" for seconds in parts]
        unit = "Hz" if hardware.BUSES[name].transport == "i2c" else "baud"
        yield "| " + " | ".join((f"`{name}`", f"{rate} {unit}", note, *times, f"{timing.rate:.0f} Hz")) + " |"


def with_buses(text: str) -> str:
    """Return the page with the current tables."""
    return with_tables(text, {"capabilities": "\n".join(capability_rows()), "rates": "\n".join(rate_rows())})
