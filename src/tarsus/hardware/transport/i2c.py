"""I2C buses of Linux, over smbus2."""

from __future__ import annotations

import errno
import time

from tarsus.errors import BusError, NoAnswerError, PortError
from tarsus.representation import represented

__all__ = ["SmbusTransport"]

# Linux has no call for the clock of an I2C bus; Raspberry Pi's default is 100 kHz.
_DEFAULT_FREQUENCY = 100_000
_NOT_ACKNOWLEDGED = (errno.EREMOTEIO, errno.ENXIO, errno.EIO)


@represented("port", "frequency")
class SmbusTransport:
    """An I2C bus of Linux.

    Parameters
    ----------
    port : str
        Path of the bus, such as ``"/dev/i2c-1"``.
    frequency : int
        Clock of the bus, for computed times only [Hz].

    Raises
    ------
    PortError
        If the bus can't be opened.
    """

    def __init__(self, port: str, frequency: int = _DEFAULT_FREQUENCY) -> None:
        self.port, self.frequency = port, frequency
        try:
            import smbus2
        except ImportError as error:
            raise self._error("smbus2", error, "Install the extra: pip install 'tarsus[hardware]'.") from error
        self._message = smbus2.i2c_msg
        try:
            self._bus = smbus2.SMBus(port)
        except OSError as error:
            remedy = "Enable I2C (raspi-config, Interface Options), and add yourself to the group i2c."
            raise self._error("an I2C bus that opens", error, remedy) from error

    def now(self) -> float:
        """Return the time of the machine's clock [s]."""
        return time.perf_counter()

    def sleep(self, seconds: float) -> None:
        """Wait.

        Parameters
        ----------
        seconds : float
            How long [s].
        """
        time.sleep(seconds)

    def write(self, address: int, data: bytes) -> None:
        """Send bytes to a device.

        Parameters
        ----------
        address : int
            The device's address, 7 bits.
        data : bytes
            What to send.
        """
        try:
            self._bus.i2c_rdwr(self._message.write(address, data))
        except OSError as error:
            raise self._refused(address, error) from error

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
        answer = self._message.read(address, count)
        try:
            self._bus.i2c_rdwr(self._message.write(address, [register]), answer)
        except OSError as error:
            raise self._refused(address, error) from error
        return bytes(answer)

    def close(self) -> None:
        """Close the port; may be called more than once."""
        self._bus.close()

    def _refused(self, address: int, error: OSError) -> BusError:
        if error.errno in _NOT_ACKNOWLEDGED:
            return NoAnswerError(
                "i2c",
                self.port,
                expected=f"an acknowledge from address {address:#04x}",
                received=str(error),
                remedy="Check supply, SDA, SCL and the address jumpers of the board.",
            )
        return self._error("an open I2C bus", error, "Check the wiring, then start again.")

    def _error(self, expected: str, error: Exception, remedy: str) -> PortError:
        return PortError("i2c", self.port, expected=expected, received=str(error), remedy=remedy)
