"""Timing that is fair: one core, the processor's time, contestants taking turns within one run, medians."""

from __future__ import annotations

import os
import statistics
import subprocess
import time
import tracemalloc
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

__all__ = ["Row", "medians", "peak_bytes", "start_time", "use_one_core"]

# A mathematics library reads these when it is loaded, so they are set before any is.
for _library in ("OMP", "OPENBLAS", "MKL"):
    os.environ[f"{_library}_NUM_THREADS"] = "1"


@dataclass(frozen=True, kw_only=True)
class Row:
    """A line of the table.

    Attributes
    ----------
    what : str
        What was measured.
    measured : str
        The median, with its unit.
    compared : str
        What it is compared with, and the ratio.
    target : str
        What was asked for; empty where nothing was.
    met : bool or None
        Whether the target was met; None where there is none, or nothing could be measured.
    """

    what: str
    measured: str
    compared: str = ""
    target: str = ""
    met: bool | None = None

    @property
    def verdict(self) -> str:
        """``met``, ``MISSED`` or nothing."""
        return "" if self.met is None else ("met" if self.met else "MISSED")


def use_one_core() -> None:
    """Keep this process and its children on one core, where the system can."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})


def medians(
    contestants: Mapping[str, Callable[[], object]],
    *,
    rounds: int = 11,
    loops: int = 1,
    clock: Callable[[], float] = time.process_time,
) -> dict[str, float]:
    """Return each contestant's median time [s] over rounds in which all take turns, the order changing each round.

    Parameters
    ----------
    contestants : mapping of str to callable
        What to time; each is called once before the clock starts.
    rounds : int
        How many rounds.
    loops : int
        Calls in a row that make one measurement, for what takes microseconds.
    clock : callable
        What tells the time: by default the processor's time, which other processes on the core do not add to.
    """
    times: dict[str, list[float]] = {name: [] for name in contestants}
    for call in contestants.values():
        call()
    names = list(contestants)
    for turn in range(rounds):
        shift = turn % len(names)
        for name in names[shift:] + names[:shift]:
            call = contestants[name]
            start = clock()
            for _ in range(loops):
                call()
            times[name].append((clock() - start) / loops)
    return {name: statistics.median(values) for name, values in times.items()}


def peak_bytes(call: Callable[[], object]) -> int:
    """Return the most memory that a call holds above what was there before [bytes]."""
    tracemalloc.start()
    try:
        call()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def start_time(arguments: Sequence[str], *, rounds: int = 9) -> float:
    """Return the median time that a command takes from start to end, on the wall's clock [s]."""
    return medians(
        {"command": lambda: subprocess.run(arguments, check=True, stdout=subprocess.DEVNULL)},
        rounds=rounds,
        clock=time.perf_counter,
    )["command"]
