"""What a transport offers to a bus, and what an emulated transport has at its far end."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

__all__ = ["Delivery", "Device", "I2cDevice", "I2cTransport", "Transport"]


class Transport(Protocol):
    """A line of bytes in both directions.

    Each method raises `PortError` if the port is gone.

    Attributes
    ----------
    port : str
        Name of the port, for messages.
    baud : int
        Bits per second on the wire.
    """

    port: str
    baud: int

    def now(self) -> float:
        """Return the time of the transport's clock [s]; only differences mean something."""

    def write(self, data: bytes) -> None:
        """Send bytes.

        Parameters
        ----------
        data : bytes
            What to send.
        """

    def read(self, timeout: float) -> bytes:
        """Return the bytes that have arrived; wait for the first one if there are none.

        Parameters
        ----------
        timeout : float
            Longest wait [s]; after it the result is empty.
        """

    def discard(self) -> bytes:
        """Empty the input, and return what was in it."""

    def close(self) -> None:
        """Close the port; may be called more than once."""


class I2cTransport(Protocol):
    """An I2C bus, with this computer as its master.

    Each method raises `PortError` if the bus is gone, and `NoAnswerError` if no device acknowledges its address.

    Attributes
    ----------
    port : str
        Name of the port, for messages.
    frequency : int
        Clock of the bus [Hz].
    """

    port: str
    frequency: int

    def now(self) -> float:
        """Return the time of the transport's clock [s]; only differences mean something."""

    def sleep(self, seconds: float) -> None:
        """Wait.

        Parameters
        ----------
        seconds : float
            How long [s].
        """

    def write(self, address: int, data: bytes) -> None:
        """Send bytes to a device.

        Parameters
        ----------
        address : int
            The device's address, 7 bits.
        data : bytes
            What to send, by custom the register first.
        """

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

    def close(self) -> None:
        """Close the port; may be called more than once."""


@dataclass(frozen=True, slots=True)
class Delivery:
    """Bytes that a device sends.

    Attributes
    ----------
    at : float
        When the last of them has arrived [s], on the clock that the device was given.
    data : bytes
        The bytes.
    """

    at: float
    data: bytes


class Device(Protocol):
    """The far end of an emulated line: servos or a board.

    Attributes
    ----------
    baud : int
        Bits per second on the wire.
    plugged : bool
        Whether the line is connected; if not, the port is gone.
    """

    baud: int

    @property
    def plugged(self) -> bool:
        """Whether the line is connected."""

    def receive(self, data: bytes, now: float) -> Sequence[Delivery]:
        """Take bytes in, and return what is sent in answer.

        Parameters
        ----------
        data : bytes
            What the computer sent.
        now : float
            When the last byte was on the wire [s].
        """


class I2cDevice(Protocol):
    """The far end of an emulated I2C bus: all devices on it.

    Attributes
    ----------
    plugged : bool
        Whether the bus is connected; if not, the port is gone.
    """

    @property
    def plugged(self) -> bool:
        """Whether the bus is connected."""

    def answers(self, address: int) -> bool:
        """Return whether a device acknowledges an address.

        Parameters
        ----------
        address : int
            The address, 7 bits.
        """

    def write(self, address: int, data: bytes, now: float) -> None:
        """Take bytes in.

        Parameters
        ----------
        address : int
            The device's address, 7 bits.
        data : bytes
            What the computer sent.
        now : float
            When [s].
        """

    def read(self, address: int, register: int, count: int, now: float) -> bytes:
        """Return the content of consecutive registers.

        Parameters
        ----------
        address : int
            The device's address, 7 bits.
        register : int
            The first register.
        count : int
            How many bytes.
        now : float
            When [s].
        """
