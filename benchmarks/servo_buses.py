"""Servo buses in real time, against emulated servos; `--write` writes the table into docs/buses.md."""

from __future__ import annotations

import argparse
import math
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

# Must be imported before NumPy: it sets the number of threads.
from measure import Row, all_cores, processor_time  # isort: split

from tarsus import hardware
from tarsus.hardware.transport.serial import SerialTransport

__all__ = ["servo_bus_rows"]

SERVOS = 18
PAGE = Path(__file__).parent.parent / "docs" / "buses.md"
BEGIN, END = "<!-- measured -->\n", "<!-- end of measured -->\n"


@dataclass(frozen=True)
class Setting:
    """What is measured: a bus, its baud rate, the rate of ticks, and for how long."""

    bus: str
    baud: int
    hertz: float
    seconds: float
    fast: bool = False

    @property
    def title(self) -> str:
        """The bus, with how it is read."""
        return self.bus + (", fast reading" if self.fast else "")


SETTINGS = (
    Setting("feetech-sts", 1_000_000, 100.0, 60.0),
    Setting("feetech-scs", 1_000_000, 25.0, 10.0),
    Setting("dynamixel-x", 1_000_000, 100.0, 10.0),
    Setting("dynamixel-x", 1_000_000, 100.0, 10.0, fast=True),
    Setting("dynamixel-mx", 1_000_000, 100.0, 10.0),
    Setting("dynamixel-ax", 1_000_000, 25.0, 10.0),
    Setting("lx16a", 115_200, 12.5, 10.0),
    Setting("maestro", 115_200, 100.0, 10.0),
    Setting("ssc32", 115_200, 50.0, 10.0),
    Setting("servo2040", 115_200, 100.0, 10.0),
    Setting("lines", 115_200, 100.0, 10.0),
)


@dataclass(frozen=True)
class Outcome:
    """What a run gave, in milliseconds where nothing else is said."""

    computed: float
    ticks: int
    missed: int
    lost: int
    took: tuple[float, float]
    begun: tuple[float, float]
    driver: float
    emulation: float


def measured(setting: Setting) -> Outcome:
    """Drive emulated servos of a process of their own at a constant rate."""
    command = [sys.executable, "-m", "tarsus.hardware.emulation", setting.bus, f"0-{SERVOS - 1}"]
    command += ["--baud", str(setting.baud), "--return-delay", "0"]
    if not setting.bus.startswith("dynamixel"):
        command = command[:-2]
    with all_cores(), subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        try:
            return driven(setting, process.stdout.readline().strip(), process.pid)
        finally:
            process.kill()


def driven(setting: Setting, port: str, emulation: int) -> Outcome:
    """Send goals and read positions at a constant rate."""
    reading: dict[str, object] = {}
    if setting.bus.startswith("dynamixel"):
        reading = {"turnaround": 50e-6, "fast": setting.fast}
    bus = hardware.bus_over(setting.bus, SerialTransport(port, setting.baud), **reading)
    ids, middle = range(SERVOS), (bus.capabilities.lowest + bus.capabilities.highest) / 2
    bus.set_torque(None, True)
    begun, took = [], []
    lost, tick, ticks = 0, 0, round(setting.seconds * setting.hertz)
    start, own, others = time.monotonic() + 0.1, time.process_time(), processor_time(emulation)
    while tick < ticks:
        due = start + tick / setting.hertz
        time.sleep(max(due - time.monotonic(), 0.0))
        begin = time.monotonic()
        bus.write_goals({id: middle + 60 * math.sin(2 * math.pi * tick / setting.hertz + id) for id in ids})
        lost += len(bus.read_positions(ids).errors)
        end = time.monotonic()
        begun.append(1e3 * (begin - due))
        took.append(1e3 * (end - begin))
        # Those that should have begun meanwhile are missed, not made up for.
        tick = max(tick + 1, math.ceil((end - start) * setting.hertz))
    missed = ticks - len(begun)
    own, after = time.process_time() - own, processor_time(emulation)
    timing = bus.timing(ids)
    bus.close()
    return Outcome(
        computed=1e3 * (timing.goals + timing.positions),
        ticks=ticks,
        missed=missed,
        lost=lost,
        took=quantiles(took),
        begun=quantiles(begun),
        driver=1e3 * own / len(begun),
        emulation=math.nan if others is None or after is None else 1e3 * (after - others) / len(begun),
    )


def quantiles(values: list[float]) -> tuple[float, float]:
    """Return the median and the 99 % quantile."""
    return statistics.median(values), statistics.quantiles(values, n=100)[98]


def servo_bus_rows() -> Iterator[Row]:
    """Measure 18 servos at 100 Hz for a minute."""
    setting = SETTINGS[0]
    outcome = measured(setting)
    yield Row(
        what=f"18 emulated servos ({setting.title}, {setting.baud} baud) at {setting.hertz:.0f} Hz for "
        f"{setting.seconds:.0f} s: goals sent and positions read",
        measured=f"{outcome.took[0]:.1f} ms, 99 % within {outcome.took[1]:.1f} ms; {outcome.missed} of {outcome.ticks} "
        f"ticks missed; begun late by {outcome.begun[0]:.2f} ms, 99 % by at most {outcome.begun[1]:.2f} ms",
        compared=f"on the wire: {outcome.computed:.1f} ms",
        target="< 1 % missed",
        met=outcome.missed < 0.01 * outcome.ticks,
    )


def table() -> str:
    """Return the table of all buses."""
    times = "missed | answers lost | processor time: driver | emulated servos"
    lines = [
        f"| bus | baud | rate | on the wire | a tick takes, median | 99 % | begins late, 99 % | {times} |",
        "|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for setting in SETTINGS:
        outcome = measured(setting)
        cells = (
            setting.title,
            f"{setting.baud}",
            f"{setting.hertz:g} Hz, {setting.seconds:g} s",
            f"{outcome.computed:.1f} ms",
            f"{outcome.took[0]:.1f} ms",
            f"{outcome.took[1]:.1f} ms",
            f"{outcome.begun[1]:.1f} ms",
            f"{outcome.missed} of {outcome.ticks}",
            f"{outcome.lost}",
            f"{outcome.driver:.2f} ms",
            f"{outcome.emulation:.2f} ms",
        )
        lines.append("| " + " | ".join(cells) + " |")
        print(lines[-1], flush=True)
    load = f"Load average meanwhile: {os.getloadavg()[0]:.1f}, on {os.cpu_count()} cores.\n\n"
    return load + "\n".join(lines) + "\n"


def main() -> None:
    """Measure all buses, print the table, and optionally write it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="write the table to docs/buses.md")
    options = parser.parse_args()
    found = table()
    if options.write:
        text = PAGE.read_text(encoding="utf-8")
        before, _, rest = text.partition(BEGIN)
        PAGE.write_text(before + BEGIN + found + END + rest.partition(END)[2], encoding="utf-8")


if __name__ == "__main__":
    main()
