"""Write the table of docs/first-hour.md that tells how soon faults are noticed, on emulated servos in their own time.

Each fault is brought about at several moments of a walk. What is measured is the time until the plant ends the run; for
a stuck joint from the moment at which its command is 2 deg away from where it stuck, as it is no different before.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from page_tables import write_tables
from tarsus import Command, RobotController, ServoFaultError, hardware, load_robot, run

PAGE = Path(__file__).parent / "first-hour.md"
ROBOT, SPEED = load_robot("strider"), 0.08
# The dead zone of the machine is measured by then; other faults need no time before them [s].
WALKED, BEFORE_STUCK = 1.0, 8.0
SPREAD, MOMENTS = 1.6, 5
AWAY = math.radians(2)
RATES = {
    "feetech-sts": 1_000_000,
    "feetech-scs": 1_000_000,
    "dynamixel-x": 1_000_000,
    "dynamixel-mx": 1_000_000,
    "dynamixel-ax": 1_000_000,
    "lx16a": 115_200,
    "servo2040": 115_200,
    "maestro": 115_200,
}
Cause = Callable[[Any, int], None]


def _set(name: str, value: Any) -> Cause:
    return lambda line, number: setattr(line.servos[number], name, value)


FAULTS: dict[str, Cause] = {
    "no answer": lambda line, number: line.faults.missing.add(number),
    "two servos with one id": lambda line, number: line.faults.duplicate.add(number),
    "damaged answers": lambda line, number: line.faults.corrupt.update({number: 1.0}),
    "unplugged": lambda line, _: setattr(line.faults, "unplugged", True),
    "brown-out": lambda line, _: setattr(line.supply, "source", 3.0),
    "stuck": _set("stuck", True),
    "hot: 72 deg C": _set("temperature", 72.0),
    "overheated, its own alarm": _set("temperature", 85.0),
}
# What a bus of boards can tell at all.
OF_BOARDS = {"servo2040": ("unplugged", "brown-out"), "maestro": ("unplugged",)}


class Walk:
    """A walk on emulated servos, in the middle of which something fails."""

    def __init__(self, kind: str, cause: Cause, at: float, joint: int) -> None:
        calibration = hardware.nominal_calibration(ROBOT, "strider", kind=kind)
        self.clock, self.cause, self.at, self.joint = hardware.ManualClock(), cause, at, joint
        ids = [each.number for row in calibration.joints for each in row if each.number is not None]
        self.number = ids[joint]
        delay = {"return_delay": 0.0} if kind.startswith("dynamixel") else {}
        self.line = hardware.emulate(kind, ids, baud=RATES[kind], **delay)
        options = {"turnaround": 50e-6} if kind.startswith("dynamixel") else {}
        transport = hardware.MemoryTransport(self.line, self.clock)
        bus = hardware.bus_over(kind, transport, timeout=0.02, **options)
        self.controller = RobotController(calibration.limited_robot)
        for number, command in zip(ids, calibration.commands(self.controller.output.angles).ravel(), strict=True):
            self.line.servos[number].place(float(command))
        self.plant = hardware.ServoPlant(
            calibration.limited_robot, calibration, buses={"main": bus}, clock=self.clock, observer=self._observe
        )
        self.rate = min(100.0, math.floor(self.plant.usual_rate))
        self.began = self.away = math.nan
        self._from = math.nan

    def command(self, time: float, _output: Any, _note: Any) -> Command:
        """Let it fail when its time has come."""
        if time >= self.at and math.isnan(self.began):
            self.began = self.clock.now()
            self.cause(self.line, self.number)
        return Command(twist=(SPEED, 0.0, 0.0))

    def over(self, time: float, _output: Any) -> bool:
        """Return whether nothing was noticed for long."""
        return time > self.at + 3.0

    def _observe(self, record: hardware.TickRecord) -> None:
        sent = float(record.sent.ravel()[self.joint])
        if math.isnan(self.began):
            self._from = sent
        elif math.isnan(self.away) and abs(sent - self._from) > AWAY:
            self.away = record.time

    def noticed(self, fault: str) -> float:
        """Return how long it took until the fault was noticed [s]; infinite if it was not."""
        with contextlib.suppress(ServoFaultError):
            run(self.controller, self.plant, self, rate=self.rate)
        if self.plant.fault is None:
            # Its command has not been elsewhere, or nobody noticed that it was.
            return math.nan if fault == "stuck" and math.isnan(self.away) else math.inf
        begin = self.away if fault == "stuck" and not math.isnan(self.away) else self.began
        return max(self.plant.fault.time - begin, 0.0)


def times(kind: str, fault: str) -> tuple[float, list[float]]:
    """Return the rate of a run [1/s], and how long it takes to notice a fault at several moments of it [s]."""
    found, rate = [], 0.0
    first = BEFORE_STUCK if fault == "stuck" else WALKED
    for i, at in enumerate(np.linspace(first, first + SPREAD, MOMENTS)):
        walk = Walk(kind, FAULTS[fault], float(at), (5 * i + 4) % 18)
        found.append(walk.noticed(fault))
        rate = walk.rate
    return rate, found


def rows() -> Iterator[str]:
    """Yield the lines of the table."""
    yield "| bus | rate | " + " | ".join(FAULTS) + " |"
    yield "|---|---|" + "---|" * len(FAULTS)
    for kind in RATES:
        cells, rate = [], 0.0
        for fault in FAULTS:
            if fault not in OF_BOARDS.get(kind, FAULTS):
                cells.append("-")
                continue
            rate, found = times(kind, fault)
            median, worst = 1e3 * float(np.nanmedian(found)), 1e3 * float(np.nanmax(found))
            cells.append(f"{median:.0f}, {worst:.0f} ms" if worst < math.inf else f"{median:.0f} ms, not always")
        yield f"| `{kind}` | {rate:.0f} Hz | " + " | ".join(cells) + " |"


if __name__ == "__main__":
    write_tables(__doc__, PAGE, lambda _: {"fault times": "\n".join(rows())})
