"""An emulated device behind a pseudo-terminal, so that the driver opens it like a serial port."""

from __future__ import annotations

import contextlib
import heapq
import itertools
import math
import os
import select
import sys
import threading
import time
from types import TracebackType
from typing import Self

from tarsus.errors import PortError
from tarsus.hardware.transport.protocol import Device
from tarsus.hardware.transport.wire import serial_seconds
from tarsus.representation import represented

__all__ = ["PtyServer"]

_IDLE = 0.05


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
    """

    def __init__(self, device: Device, *, frame: float = 1e-3) -> None:
        if sys.platform == "win32":  # pragma: no cover
            raise PortError(
                "emulation",
                "pty",
                expected="a system with pseudo-terminals",
                received="Windows",
                remedy="Use the emulated servos in memory.",
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

    def _serve(self) -> None:
        try:
            self._loop()
        finally:
            # Closing the master hangs up the terminal: whoever has it open is told that the port is gone.
            for file in (self._master, self._slave):
                with contextlib.suppress(OSError):
                    os.close(file)

    def _loop(self) -> None:
        waiting: list[tuple[float, int, bytes]] = []
        order = itertools.count()
        line_free = 0.0
        while not self._stopping.is_set() and self._device.plugged:
            now = time.monotonic()
            timeout = max(min(waiting[0][0] - now, _IDLE), 0.0) if waiting else _IDLE
            ready, _, _ = select.select([self._master, self._wake_reader], [], [], timeout)
            now = time.monotonic()
            if self._master in ready:
                data = os.read(self._master, 65536)
                # The bytes are here at once; on a wire they would have taken until then.
                line_free = max(now, line_free) + serial_seconds(len(data), self._device.baud)
                with self.lock:
                    deliveries = self._device.receive(data, line_free)
                for delivery in deliveries:
                    heapq.heappush(waiting, (self._arrival(delivery.at), next(order), delivery.data))
            arrived = b""
            while waiting and waiting[0][0] <= now:
                arrived += heapq.heappop(waiting)[2]
            if arrived:
                with contextlib.suppress(BlockingIOError):
                    os.write(self._master, arrived)

    def _arrival(self, at: float) -> float:
        """Return when the frame of USB ends in which bytes are passed on [s]."""
        return math.ceil(at / self._frame) * self._frame if self._frame else at
