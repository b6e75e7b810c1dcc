"""Emulated servos in the same process, without a port."""

from __future__ import annotations

import heapq
import itertools

from tarsus.errors import NoAnswerError, PortError
from tarsus.hardware.transport.clock import Clock, ManualClock
from tarsus.hardware.transport.protocol import Device, I2cDevice
from tarsus.hardware.transport.wire import i2c_seconds, serial_seconds
from tarsus.representation import represented

__all__ = ["MemoryI2c", "MemoryTransport"]


def _unplugged(port: str) -> PortError:
    return PortError(
        "emulation",
        port,
        expected="an open port",
        received="nothing, as the emulated line is unplugged",
        remedy="Plug it in.",
    )


@represented("port", "baud")
class MemoryTransport:
    """A line to an emulated device; sending and waiting take the time they would take on a wire.

    Parameters
    ----------
    device : Device
        The far end.
    clock : Clock, optional
        By default a clock that stands still unless something waits.
    port : str
        Name for messages.
    """

    def __init__(self, device: Device, clock: Clock | None = None, *, port: str = "memory") -> None:
        self.port = port
        self.clock: Clock = clock or ManualClock()
        self._device = device
        self._order = itertools.count()
        self._waiting: list[tuple[float, int, bytes]] = []

    @property
    def baud(self) -> int:
        """Bits per second on the wire."""
        return self._device.baud

    def now(self) -> float:
        """Return the time of the transport's clock [s]."""
        return self.clock.now()

    def write(self, data: bytes) -> None:
        """Send bytes.

        Parameters
        ----------
        data : bytes
            What to send.
        """
        self._require()
        self.clock.sleep(serial_seconds(len(data), self._device.baud))
        for delivery in self._device.receive(data, self.clock.now()):
            heapq.heappush(self._waiting, (delivery.at, next(self._order), delivery.data))

    def read(self, timeout: float) -> bytes:
        """Return the bytes that have arrived; wait for the first one if there are none.

        Parameters
        ----------
        timeout : float
            Longest wait [s].
        """
        self._require()
        now = self.clock.now()
        until = self._waiting[0][0] if self._waiting else now + timeout
        self.clock.sleep(min(until, now + timeout) - now)
        return self._arrived()

    def discard(self) -> bytes:
        """Empty the input, and return what was in it."""
        self._require()
        return self._arrived()

    def close(self) -> None:
        """Do nothing: there is no port."""

    def _arrived(self) -> bytes:
        arrived, now = bytearray(), self.clock.now()
        while self._waiting and self._waiting[0][0] <= now:
            arrived += heapq.heappop(self._waiting)[2]
        return bytes(arrived)

    def _require(self) -> None:
        if not self._device.plugged:
            raise _unplugged(self.port)


@represented("port", "frequency")
class MemoryI2c:
    """An I2C bus with emulated devices; transfers take the time they would take on a wire.

    Parameters
    ----------
    device : I2cDevice
        The devices.
    clock : Clock, optional
        By default a clock that stands still unless something waits.
    frequency : int
        Clock of the bus [Hz].
    port : str
        Name for messages.
    """

    def __init__(
        self, device: I2cDevice, clock: Clock | None = None, *, frequency: int = 400_000, port: str = "memory"
    ) -> None:
        self.port, self.frequency = port, frequency
        self.clock: Clock = clock or ManualClock()
        self._device = device

    def now(self) -> float:
        """Return the time of the transport's clock [s]."""
        return self.clock.now()

    def sleep(self, seconds: float) -> None:
        """Wait.

        Parameters
        ----------
        seconds : float
            How long [s].
        """
        self.clock.sleep(seconds)

    def write(self, address: int, data: bytes) -> None:
        """Send bytes to a device.

        Parameters
        ----------
        address : int
            The device's address, 7 bits.
        data : bytes
            What to send.
        """
        self._require(address)
        self.clock.sleep(i2c_seconds(1 + len(data), self.frequency))
        self._device.write(address, data, self.clock.now())

    def read(self, address: int, register: int, count: int) -> bytes:
        """Return the content of consecutive registers of a device.

        Parameters
        ----------
        address : int
            The device's address, 7 bits.
        register : int
            The first register.
        count : int
            How many bytes.
        """
        self._require(address)
        self.clock.sleep(i2c_seconds(3 + count, self.frequency))
        return self._device.read(address, register, count, self.clock.now())

    def close(self) -> None:
        """Do nothing: there is no port."""

    def _require(self, address: int) -> None:
        if not self._device.plugged:
            raise _unplugged(self.port)
        if not self._device.answers(address):
            raise NoAnswerError(
                "i2c",
                self.port,
                expected=f"an acknowledge from address {address:#04x}",
                received="none",
                remedy="Check supply, SDA, SCL and the address jumpers of the board.",
            )
