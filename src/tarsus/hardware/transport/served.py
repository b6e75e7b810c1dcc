"""The serial port of emulated servos in this process, where a busy computer can't make servos silent."""

from __future__ import annotations

from tarsus.hardware.transport.pty import PtyServer
from tarsus.hardware.transport.serial import SerialTransport

__all__ = ["ServedTransport"]

# Longest time that the system takes to pass written bytes on [s].
_LONGEST_DELAY = 1.0


class ServedTransport(SerialTransport):
    """The port of a `PtyServer`, on which a wait ends only after the emulated servos have had their turn.

    Real servos answer while the computer is busy; emulated ones run on it. They receive each request at the time when
    it was sent, and an answer counts as missing only if they have not sent it after a turn.

    Parameters
    ----------
    server : PtyServer
        Serves the emulated device.
    baud : int
        Bits per second.

    Raises
    ------
    PortError
        If the port can't be opened.
    """

    def __init__(self, server: PtyServer, baud: int) -> None:
        super().__init__(server.port, baud)
        self._server, self._taken = server, server.written

    def write(self, data: bytes) -> None:
        """Send bytes.

        Parameters
        ----------
        data : bytes
            What to send.
        """
        self._server.expect(self.now(), len(data))
        super().write(data)

    def read(self, timeout: float) -> bytes:
        """Return the bytes that have arrived; wait for the first one if there are none.

        Parameters
        ----------
        timeout : float
            Longest wait [s].
        """
        data = super().read(timeout)
        if not data:
            self._server.catch_up()
            # The system passes written bytes on with some delay.
            data = super().read(_LONGEST_DELAY if self._taken < self._server.written else 0.0)
        self._taken += len(data)
        return data

    def discard(self) -> bytes:
        """Empty the input, and return what was in it."""
        data = super().discard()
        self._taken += len(data)
        return data
