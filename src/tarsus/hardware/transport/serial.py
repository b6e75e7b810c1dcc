"""Serial ports and USB serial adapters, over pyserial."""

from __future__ import annotations

import contextlib
import os
import select
import time
from typing import TYPE_CHECKING

from tarsus.errors import BusError, PortError
from tarsus.representation import represented

if TYPE_CHECKING:
    import serial

__all__ = ["SerialTransport", "list_ports"]

_INSTALL = "Install the extra: pip install 'tarsus[hardware]'."


def list_ports() -> tuple[str, ...]:
    """Return the names of this machine's serial ports."""
    try:
        from serial.tools import list_ports as tools
    except ImportError as error:
        raise _port_error("?", "pyserial", str(error), _INSTALL) from error
    return tuple(sorted(port.device for port in tools.comports()))


@represented("port", "baud")
class SerialTransport:
    """A serial port.

    Parameters
    ----------
    port : str
        Name of the port, such as ``"/dev/ttyUSB0"`` or ``"COM3"``.
    baud : int
        Bits per second.

    Raises
    ------
    PortError
        If the port can't be opened.
    """

    def __init__(self, port: str, baud: int) -> None:
        self.port, self.baud = port, baud
        try:
            import serial
        except ImportError as error:
            raise _port_error(port, "pyserial", str(error), _INSTALL) from error
        self._gone: tuple[type[Exception], ...] = (serial.SerialException, OSError, TypeError, ValueError)
        try:
            self._serial: serial.Serial = serial.Serial(port, baud, timeout=0, write_timeout=1.0, exclusive=_POSIX)
        except (serial.SerialException, OSError, ValueError) as error:
            raise _port_error(port, "a port that opens", _reason(error), _open_remedy(port)) from error
        with contextlib.suppress(AttributeError, OSError, ValueError, NotImplementedError):
            # Adapters otherwise hold answers back for up to 16 ms; a pseudo-terminal knows no such mode.
            self._serial.set_low_latency_mode(True)

    def now(self) -> float:
        """Return the time of the machine's clock [s]."""
        return time.perf_counter()

    def write(self, data: bytes) -> None:
        """Send bytes.

        Parameters
        ----------
        data : bytes
            What to send.
        """
        try:
            self._serial.write(data)
        except self._gone as error:
            raise self._lost(error) from error

    def read(self, timeout: float) -> bytes:
        """Return the bytes that have arrived; wait for the first one if there are none.

        Parameters
        ----------
        timeout : float
            Longest wait [s].
        """
        try:
            if _POSIX:
                # pyserial would configure the port anew for each timeout.
                select.select([self._serial.fileno()], [], [], max(timeout, 0.0))
                return bytes(self._serial.read(self._serial.in_waiting))
            self._serial.timeout = max(timeout, 0.0)
            return bytes(self._serial.read(1) + self._serial.read(self._serial.in_waiting))
        except self._gone as error:
            raise self._lost(error) from error

    def discard(self) -> bytes:
        """Empty the input, and return what was in it."""
        try:
            return bytes(self._serial.read(self._serial.in_waiting))
        except self._gone as error:
            raise self._lost(error) from error

    def close(self) -> None:
        """Close the port; may be called more than once."""
        with contextlib.suppress(*self._gone):
            self._serial.close()

    def _lost(self, error: Exception) -> BusError:
        return _port_error(
            self.port, "an open port", str(error), "Check the USB cable and the adapter's supply, then start again."
        )


_POSIX = os.name == "posix"


def _open_remedy(port: str) -> str:
    """Return advice for a port that does not open."""
    try:
        found = list_ports()
    except BusError:
        found = ()
    if _POSIX and os.path.exists(port) and not os.access(port, os.R_OK | os.W_OK):
        return "You may not use this port: add yourself to its group (dialout or uucp), then log in again."
    return f"Serial ports found: {', '.join(found) or 'none; check the USB cable and the driver'}."


def _reason(error: Exception) -> str:
    """Return why a port can't be opened; pyserial's text says it twice, with numbers."""
    number = getattr(error, "errno", None)
    if number:
        return os.strerror(number)
    return "something that is no serial port" if "Could not configure port" in str(error) else str(error)


def _port_error(port: str, expected: str, received: str, remedy: str) -> PortError:
    return PortError("serial port", port, expected=expected, received=received, remedy=remedy)
