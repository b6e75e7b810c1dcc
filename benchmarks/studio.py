"""Rows on the studio: updates a second to one visitor and to twenty, from a slider to its picture, and their cost."""

from __future__ import annotations

import asyncio
import json
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

# Before NumPy is loaded: this one chooses the number of threads.
from measure import Row  # isort: split

from websockets.asyncio.client import ClientConnection, connect

from tarsus.studio.messages import SOCKET

__all__ = ["studio_rows"]

SECONDS = 5.0
"""How long each row is measured."""

VISITORS = 20
ONE_HZ, EACH_HZ = 60.0, 30.0
LATENCY = 0.05
ALMOST = 0.97
"""Share of the updates asked for that counts as all of them: a clock's tick at either end."""


@dataclass
class Seen:
    """What one visitor saw.

    Attributes
    ----------
    updates : int
        Poses or frames that came.
    latencies : list of float
        From a slider's message to the pose that answers it [s].
    received : int
        Bytes.
    """

    updates: int = 0
    latencies: list[float] = field(default_factory=list)
    received: int = 0


@contextmanager
def server() -> Iterator[tuple[str, int]]:
    """Run a studio in a process of its own; give its address and the process."""
    command = Path(sys.executable).with_name("tarsus")
    with all_cores():
        process = subprocess.Popen(
            [command, "studio", "--port", "0", "--no-browser", "--json"], stdout=subprocess.PIPE, text=True
        )
    try:
        assert process.stdout is not None
        answer = "".join(iter(process.stdout.readline, "}\n")) + "}"
        yield json.loads(answer)["url"].replace("http", "ws", 1).rstrip("/"), process.pid
    finally:
        process.terminate()
        process.communicate()


@contextmanager
def all_cores() -> Iterator[None]:
    """Lift the rule that a benchmark keeps to one core: a server and its visitors are several processes."""
    if not hasattr(os, "sched_setaffinity"):
        yield
        return
    kept = os.sched_getaffinity(0)
    os.sched_setaffinity(0, range(os.cpu_count() or 1))
    try:
        yield
    finally:
        os.sched_setaffinity(0, kept)


def processor_time(pid: int) -> float | None:
    """Return the processor's time that a process has used [s], where the system tells."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    except OSError:
        return None
    return (int(fields[11]) + int(fields[12])) / float(os.sysconf("SC_CLK_TCK"))


async def ask(socket: ClientConnection, number: int, **message: Any) -> None:
    """Say something, and wait until it is answered."""
    await socket.send(json.dumps({"id": number, **message}))
    while True:
        answer = json.loads(await socket.recv())
        if answer["type"] == "done" and answer["id"] == number:
            return


async def slide(socket: ClientConnection, seen: Seen, hertz: float) -> None:
    """Move a slider, steadily, and note when each picture comes."""
    sent: dict[int, float] = {}

    async def look() -> None:
        async for text in socket:
            seen.received += len(text)
            answer = json.loads(text)
            if answer["type"] == "pose" and answer["id"] in sent:
                seen.updates += 1
                seen.latencies.append(time.perf_counter() - sent.pop(answer["id"]))

    looking = asyncio.create_task(look())
    start = time.perf_counter()
    for number in range(int(SECONDS * hertz)):
        await asyncio.sleep(start + number / hertz - time.perf_counter())
        angles = [0.0, 30.0 + number % 20, -100.0] * 6
        message = {"type": "joints", "id": 100 + number, "joints": {"angles_deg": angles}, "commit": False}
        sent[100 + number] = time.perf_counter()
        await socket.send(json.dumps(message))
    await asyncio.sleep(0.2)
    looking.cancel()


async def drive(socket: ClientConnection, seen: Seen, _hertz: float) -> None:
    """Drive, and count the frames that come."""
    await socket.send(json.dumps({"type": "drive", "id": 100, "on": True}))
    await socket.send(json.dumps({"type": "command", "id": 101, "velocity_mm_s": [60, 0], "turn_deg_s": 5}))
    end = time.perf_counter() + SECONDS
    while (left := end - time.perf_counter()) > 0:
        try:
            text = await asyncio.wait_for(socket.recv(), left)
        except TimeoutError:
            return
        seen.received += len(text)
        seen.updates += '"type":"frame"' in str(text)


Visiting = Callable[[ClientConnection, Seen, float], Awaitable[None]]


async def visited(url: str, visiting: Visiting, visitors: int, hertz: float) -> list[Seen]:
    """Have so many visitors at a time do the same; return what each saw."""

    async def one(seen: Seen, wait: float) -> Seen:
        async with connect(f"{url}{SOCKET}", max_size=None, compression=None) as socket:
            await ask(socket, 1, type="hello")
            await ask(socket, 2, type="view", view="joints")
            await everybody.wait()
            # Visitors don't move in step.
            await asyncio.sleep(wait)
            await visiting(socket, seen, hertz)
        return seen

    everybody = asyncio.Barrier(visitors)
    return await asyncio.gather(*(one(Seen(), number / visitors / hertz) for number in range(visitors)))


def measured(url: str, pid: int, visiting: Visiting, visitors: int, hertz: float) -> tuple[list[Seen], str]:
    """Return what the visitors saw, and what it cost the server in words."""
    with all_cores():
        before = processor_time(pid)
        start = time.perf_counter()
        seen = asyncio.run(visited(url, visiting, visitors, hertz))
        took, after = time.perf_counter() - start, processor_time(pid)
    kilobytes = statistics.median(one.received for one in seen) / SECONDS / 1000
    cost = "" if before is None or after is None else f"server {(after - before) / took * 100:.0f} % of a core, "
    return seen, f"{cost}{kilobytes:.0f} kB/s each"


def studio_rows() -> Iterator[Row]:
    """Measure a studio in a process of its own, as its visitors see it."""
    cases: list[tuple[str, Visiting, int, float]] = [
        ("one visitor moves a slider", slide, 1, ONE_HZ),
        (f"{VISITORS} visitors move sliders", slide, VISITORS, EACH_HZ),
        ("one visitor drives", drive, 1, ONE_HZ),
        (f"{VISITORS} visitors drive", drive, VISITORS, EACH_HZ),
    ]
    with server() as (url, pid):
        for what, visiting, visitors, hertz in cases:
            seen, cost = measured(url, pid, visiting, visitors, hertz)
            least = min(one.updates for one in seen) / SECONDS
            yield Row(
                what=f"studio: {what}, updates a second",
                measured=f"{least:.0f} to the one that gets fewest" if visitors > 1 else f"{least:.0f}",
                compared=cost,
                target=f">= {hertz:.0f}",
                met=least >= ALMOST * hertz,
            )
            latencies = sorted(latency for one in seen for latency in one.latencies)
            if latencies:
                high = latencies[int(0.99 * (len(latencies) - 1))]
                yield Row(
                    what=f"studio: {what}, from the slider to its pose",
                    measured=f"{statistics.median(latencies) * 1e3:.0f} ms; 99 of 100 within {high * 1e3:.0f} ms",
                    target=f"< {LATENCY * 1e3:.0f} ms",
                    met=high < LATENCY,
                )


if __name__ == "__main__":
    for row in studio_rows():
        print(row.what, "|", row.measured, "|", row.compared, "|", row.target, "|", row.verdict)
