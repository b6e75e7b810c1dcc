"""An emulated device behind a pseudo-terminal, so that the driver opens it like a serial port."""

from __future__ import annotations

import contextlib
import heapq
import itertools
import math
import os
import platform
import select
import sys
import threading
import time
from collections import deque
from types import TracebackType
from typing import Self

from tarsus.errors import PortError
from tarsus.hardware.transport.protocol import Device
from tarsus.hardware.transport.wire import serial_seconds
from tarsus.representation import represented

__all__ = ["PtyServer"]

# Longest pause between two turns of the device [s].
_IDLE = 0.05
# Longest wait for a turn of the device [s].
_LONGEST_TURN = 10.0


@represented("port")
class PtyServer:
    """Serves an emulated device behind a pseudo-terminal, from a thread of its own.

    A pseudo-terminal has no baud rate: what the device receives and sends is delayed by its time on the wire, and what
    it sends arrives in the frames of USB.

    Parameters
    ----------
    device : Device
        The far end. While the server runs, use it only under `lock`.
    frame : float
        Time between two frames of USB, in which adapters pass bytes on [s].

    Attributes
    ----------
    port : str
        Path of the terminal, to be opened as a serial port.
    lock : threading.Lock
        Held while the device works.
    written : int
        How many bytes the device has sent.
    """

    def __init__(self, device: Device, *, frame: float = 1e-3) -> None:
        if sys.platform == "win32" or not hasattr(os, "openpty"):
            raise PortError(
                "emulation",
                "pty",
                expected="a system with pseudo-terminals",
                received=platform.system(),
                remedy="Use emulated servos in memory: emulated_bus, or tarsus run --bus emulated.",
            )
        import tty

        self._device, self._frame = device, frame
        self.lock = threading.Lock()
        self._master, self._slave = os.openpty()
        # Without raw mode the terminal echoes, and turns some bytes into others.
        tty.setraw(self._slave)
        os.set_blocking(self._master, False)
        self.port = os.ttyname(self._slave)
        self._stopping = threading.Event()
        self._served = threading.Condition()
        self._asked = self._answered = 0
        self.written = 0
        self._expected: deque[tuple[float, int]] = deque()
        self._wake_reader, self._wake_writer = os.pipe()
        self._thread = threading.Thread(target=self._serve, name=f"emulated servos on {self.port}", daemon=True)
        self._thread.start()

    def __enter__(self) -> Self:
        """Return the server itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Stop serving."""
        self.close()

    def close(self) -> None:
        """Stop serving; the port is gone afterwards."""
        if self._stopping.is_set():
            return
        self._stopping.set()
        os.write(self._wake_writer, b"x")
        self._thread.join()
        for file in (self._wake_reader, self._wake_writer):
            os.close(file)

    def expect(self, now: float, count: int) -> None:
        """Record that bytes are being sent: for the device they are sent at that time, however late they are read.

        Parameters
        ----------
        now : float
            The time [s].
        count : int
            How many.
        """
        self._expected.append((now, count))

    def catch_up(self) -> None:
        """Wait until the device has received what was sent, and has sent what is due."""
        with self._served:
            self._asked += 1
            asked = self._asked
            if not self._stopping.is_set():
                os.write(self._wake_writer, b"x")
            self._served.wait_for(lambda: self._answered >= asked, _LONGEST_TURN)

    def _serve(self) -> None:
        try:
            self._loop()
        finally:
            # Closing the master hangs up the terminal: whoever has it open is told that the port is gone.
            for file in (self._master, self._slave):
                with contextlib.suppress(OSError):
                    os.close(file)
            self._had_turn(sys.maxsize)

    def _loop(self) -> None:
        waiting: list[tuple[float, int, bytes]] = []
        order = itertools.count()
        line_free = 0.0
        while not self._stopping.is_set() and self._device.plugged:
            now = time.perf_counter()
            timeout = max(min(waiting[0][0] - now, _IDLE), 0.0) if waiting else _IDLE
            ready, _, _ = select.select([self._master, self._wake_reader], [], [], timeout)
            asked = self._asked
            if self._wake_reader in ready:
                os.read(self._wake_reader, 64)
            if asked > self._answered:
                # Bytes sent before the turn was asked for may have arrived since.
                ready, _, _ = select.select([self._master], [], [], 0.0)
            if self._master in ready:
                data = os.read(self._master, 65536)
                # The bytes are here at once; on a wire the last of them would arrive at this time.
                line_free = max(self._sent_at(len(data)), line_free) + serial_seconds(len(data), self._device.baud)
                with self.lock:
                    deliveries = self._device.receive(data, line_free)
                for delivery in deliveries:
                    heapq.heappush(waiting, (self._arrival(delivery.at), next(order), delivery.data))
            arrived, now = b"", time.perf_counter()
            while waiting and waiting[0][0] <= now:
                arrived += heapq.heappop(waiting)[2]
            if arrived:
                with contextlib.suppress(BlockingIOError):
                    self.written += os.write(self._master, arrived)
            if asked > self._answered:
                self._had_turn(asked)

    def _sent_at(self, count: int) -> float:
        """Return when the first of some bytes was sent [s]: now, unless `expect` was told."""
        first = self._expected[0][0] if self._expected else time.perf_counter()
        while count > 0 and self._expected:
            at, size = self._expected.popleft()
            count -= size
            if count < 0:
                self._expected.appendleft((at, -count))
        return first

    def _had_turn(self, asked: int) -> None:
        with self._served:
            self._answered = asked
            self._served.notify_all()

    def _arrival(self, at: float) -> float:
        """Return the end of the USB frame in which bytes are passed on [s]."""
        return math.ceil(at / self._frame) * self._frame if self._frame else at
