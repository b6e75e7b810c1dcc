"""Fair timing: one core, processor time, alternating contestants, medians."""

from __future__ import annotations

import os
import statistics
import subprocess
import time
import tracemalloc
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

__all__ = ["Row", "all_cores", "felt_row", "medians", "peak_bytes", "processor_time", "start_time", "use_one_core"]

FELT_RATIO = 1.3
"""Target: the median of ticks with readings over that of blind ones."""

# Mathematics libraries read these variables when they are loaded.
for _library in ("OMP", "OPENBLAS", "MKL"):
    os.environ[f"{_library}_NUM_THREADS"] = "1"


@dataclass(frozen=True, kw_only=True)
class Row:
    """A row of the table.

    Attributes
    ----------
    what : str
        Quantity.
    measured : str
        Median, with its unit.
    compared : str
        Reference value, and the ratio.
    target : str
        Target; empty if there is none.
    met : bool or None
        Whether the target is met; None without a target or a measurement.
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


def felt_row(what: str, ticks: Callable[[bool], Sequence[float]], *, runs: int) -> Row:
    """Compare ticks with readings with blind ones; each counts with its minimum of identical runs, taken by turns.

    Parameters
    ----------
    what : str
        Whose ticks.
    ticks : callable
        Returns the processor times of ticks that are blind (False) or have readings (True) [s].
    runs : int
        Number of runs.
    """
    times = [(ticks(False), ticks(True)) for _ in range(runs)]
    blind, felt = (statistics.median(map(min, zip(*same, strict=True))) for same in zip(*times, strict=True))
    return Row(
        what=f"{what}: median over a blind one",
        measured=f"{felt / blind:.2f}",
        compared=f"{felt * 1e6:.0f} and {blind * 1e6:.0f} us",
        target=f"<= {FELT_RATIO}",
        met=felt <= FELT_RATIO * blind,
    )


def use_one_core() -> None:
    """Restrict this process and its children to one core, if the system supports it."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})


@contextmanager
def all_cores() -> Iterator[None]:
    """Allow all cores, for measurements with several processes."""
    if not hasattr(os, "sched_setaffinity"):
        yield
        return
    previous = os.sched_getaffinity(0)
    os.sched_setaffinity(0, range(os.cpu_count() or 1))
    try:
        yield
    finally:
        os.sched_setaffinity(0, previous)


def processor_time(pid: int) -> float | None:
    """Return the processor time of a process [s]; None if the system does not provide it."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    except OSError:
        return None
    return (int(fields[11]) + int(fields[12])) / float(os.sysconf("SC_CLK_TCK"))


def medians(
    contestants: Mapping[str, Callable[[], object]],
    *,
    rounds: int = 11,
    loops: int = 1,
    clock: Callable[[], float] = time.process_time,
) -> dict[str, float]:
    """Return each contestant's median time [s] over rounds in which all run in alternating order.

    Parameters
    ----------
    contestants : mapping of str to callable
        Functions to time; each is called once before the first measurement.
    rounds : int
        Number of rounds.
    loops : int
        Number of consecutive calls per measurement, for functions that take microseconds.
    clock : callable
        Clock. Default: processor time, which excludes other processes on the core.
    """
    times: dict[str, list[float]] = {name: [] for name in contestants}
    for call in contestants.values():
        call()
    names = list(contestants)
    for index in range(rounds):
        shift = index % len(names)
        for name in names[shift:] + names[:shift]:
            call = contestants[name]
            start = clock()
            for _ in range(loops):
                call()
            times[name].append((clock() - start) / loops)
    return {name: statistics.median(values) for name, values in times.items()}


def peak_bytes(call: Callable[[], object]) -> int:
    """Return the peak memory of a call, above that before the call [bytes]."""
    tracemalloc.start()
    try:
        call()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def start_time(arguments: Sequence[str], *, rounds: int = 9) -> float:
    """Return the median wall-clock time of a command [s]."""
    return medians(
        {"command": lambda: subprocess.run(arguments, check=True, stdout=subprocess.DEVNULL)},
        rounds=rounds,
        clock=time.perf_counter,
    )["command"]
