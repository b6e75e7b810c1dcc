"""Benchmarks of the studio: update rates, latencies and server load for one visitor and for twenty."""

from __future__ import annotations

import asyncio
import json
import statistics
import subprocess
import sys
import time
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

# Must be imported before NumPy: it sets the number of threads.
from measure import Row, all_cores, processor_time  # isort: split

from websockets.asyncio.client import ClientConnection, connect

from tarsus.studio.messages import SOCKET

__all__ = ["studio_rows"]

SECONDS = 5.0
"""Duration of each measurement."""

VISITORS = 20
ONE_HZ, EACH_HZ = 60.0, 30.0
LATENCY = 0.05
PHYSICS_LOAD = 0.1
"""Target: fraction of a core that the physics of one visitor takes."""

RATE_TOLERANCE = 0.97
"""Fraction of the requested updates that meets the target, for rounding at the start and the end."""


@dataclass
class VisitorStatistics:
    """Statistics of a visitor.

    Attributes
    ----------
    updates : int
        Number of poses or frames received.
    latencies : list of float
        Times from a slider's message to the pose that answers it [s].
    received : int
        Number of bytes received.
    """

    updates: int = 0
    latencies: list[float] = field(default_factory=list)
    received: int = 0


@contextmanager
def server() -> Iterator[tuple[str, int]]:
    """Run a studio in a separate process; yield its address and process id."""
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


async def ask(socket: ClientConnection, number: int, **message: Any) -> None:
    """Send a request and wait for its answer."""
    await socket.send(json.dumps({"id": number, **message}))
    while True:
        answer = json.loads(await socket.recv())
        if answer["type"] == "done" and answer["id"] == number:
            return


async def slide(socket: ClientConnection, visitor: VisitorStatistics, hertz: float) -> None:
    """Move a slider at a constant rate, and record the arrival of each pose."""
    sent: dict[int, float] = {}

    async def receive() -> None:
        async for text in socket:
            visitor.received += len(text)
            answer = json.loads(text)
            if answer["type"] == "pose" and answer["id"] in sent:
                visitor.updates += 1
                visitor.latencies.append(time.perf_counter() - sent.pop(answer["id"]))

    receiving = asyncio.create_task(receive())
    start = time.perf_counter()
    for number in range(int(SECONDS * hertz)):
        await asyncio.sleep(start + number / hertz - time.perf_counter())
        angles = [0.0, 30.0 + number % 20, -100.0] * 6
        message = {"type": "joints", "id": 100 + number, "joints": {"angles_deg": angles}, "commit": False}
        sent[100 + number] = time.perf_counter()
        await socket.send(json.dumps(message))
    await asyncio.sleep(0.2)
    receiving.cancel()


async def drive_in_physics(socket: ClientConnection, visitor: VisitorStatistics, hertz: float) -> None:
    """Drive in physics, and count the received frames."""
    await ask(socket, 3, type="view", view="drive")
    await ask(socket, 4, type="physics", physics={"on": True})
    await drive(socket, visitor, hertz)


async def drive(socket: ClientConnection, visitor: VisitorStatistics, _hertz: float) -> None:
    """Drive, and count the received frames."""
    await socket.send(json.dumps({"type": "drive", "id": 100, "on": True}))
    await socket.send(json.dumps({"type": "command", "id": 101, "velocity_mm_s": [60, 0], "turn_deg_s": 5}))
    end = time.perf_counter() + SECONDS
    while (remaining := end - time.perf_counter()) > 0:
        try:
            text = await asyncio.wait_for(socket.recv(), remaining)
        except TimeoutError:
            return
        visitor.received += len(text)
        visitor.updates += '"type":"frame"' in str(text)


Visit = Callable[[ClientConnection, VisitorStatistics, float], Awaitable[None]]


async def visit_all(url: str, visit: Visit, visitors: int, hertz: float) -> list[VisitorStatistics]:
    """Run several visitors concurrently, and return the statistics of each."""

    async def one(visitor: VisitorStatistics, wait: float) -> VisitorStatistics:
        async with connect(f"{url}{SOCKET}", max_size=None, compression=None) as socket:
            await ask(socket, 1, type="hello")
            await ask(socket, 2, type="view", view="joints")
            await start_barrier.wait()
            # Visitors send at different times.
            await asyncio.sleep(wait)
            await visit(socket, visitor, hertz)
        return visitor

    start_barrier = asyncio.Barrier(visitors)
    return await asyncio.gather(*(one(VisitorStatistics(), number / visitors / hertz) for number in range(visitors)))


def measured(
    url: str, pid: int, visit: Visit, visitors: int, hertz: float
) -> tuple[list[VisitorStatistics], float | None, str]:
    """Return the statistics of the visitors, the server load as a fraction of a core, and as text."""
    with all_cores():
        before = processor_time(pid)
        start = time.perf_counter()
        all_visitors = asyncio.run(visit_all(url, visit, visitors, hertz))
        duration, after = time.perf_counter() - start, processor_time(pid)
    kilobytes = statistics.median(one.received for one in all_visitors) / SECONDS / 1000
    load = None if before is None or after is None else (after - before) / duration
    cost = "" if load is None else f"server {load * 100:.0f} % of a core, "
    return all_visitors, load, f"{cost}{kilobytes:.0f} kB/s each"


def studio_rows() -> Iterator[Row]:
    """Measure a studio in a separate process from its visitors."""
    cases: list[tuple[str, Visit, int, float]] = [
        ("one visitor moves a slider", slide, 1, ONE_HZ),
        (f"{VISITORS} visitors move sliders", slide, VISITORS, EACH_HZ),
        ("one visitor drives", drive, 1, ONE_HZ),
        ("one visitor drives in physics", drive_in_physics, 1, ONE_HZ),
        (f"{VISITORS} visitors drive", drive, VISITORS, EACH_HZ),
    ]
    loads: dict[str, float | None] = {}
    with server() as (url, pid):
        for what, visit, visitors, hertz in cases:
            all_visitors, loads[what], cost = measured(url, pid, visit, visitors, hertz)
            lowest = min(one.updates for one in all_visitors) / SECONDS
            yield Row(
                what=f"studio: {what}, updates per second",
                measured=f"{lowest:.0f} (slowest visitor)" if visitors > 1 else f"{lowest:.0f}",
                compared=cost,
                target=f">= {hertz:.0f}",
                met=lowest >= RATE_TOLERANCE * hertz,
            )
            latencies = sorted(latency for one in all_visitors for latency in one.latencies)
            if latencies:
                high = latencies[int(0.99 * (len(latencies) - 1))]
                yield Row(
                    what=f"studio: {what}, from the slider to its pose",
                    measured=f"{statistics.median(latencies) * 1e3:.0f} ms; 99 %: {high * 1e3:.0f} ms",
                    target=f"< {LATENCY * 1e3:.0f} ms",
                    met=high < LATENCY,
                )
    planned, physical = loads["one visitor drives"], loads["one visitor drives in physics"]
    if planned is not None and physical is not None:
        yield Row(
            what="studio: what the physics of one driving visitor adds",
            measured=f"{100 * (physical - planned):.0f} % of a core",
            compared="the controller reads sensors then, which is part of it",
            target=f"< {100 * PHYSICS_LOAD:.0f} %",
            met=physical - planned < PHYSICS_LOAD,
        )


if __name__ == "__main__":
    for row in studio_rows():
        print(row.what, "|", row.measured, "|", row.compared, "|", row.target, "|", row.verdict)
