"""An inertial sensor that sends its attitude as lines of text: roll, pitch and yaw in degrees."""

from __future__ import annotations

import math
import re

import numpy as np

from tarsus.hardware.calibration.parts import Mounting
from tarsus.hardware.transport.protocol import Transport
from tarsus.hardware.transport.serial import SerialTransport
from tarsus.kinematics.pose import Pose
from tarsus.representation import represented

__all__ = ["AttitudeLine"]

# Longer than any line of three numbers: a line that goes on after this many bytes is left out.
_LONGEST = 200
_NUMBER = re.compile(rb"[-+]?\d+(?:\.\d*)?")
_LARGEST = 360.0


@represented("attitude", "time")
class AttitudeLine:
    """Reads the lines of an inertial sensor, and gives the attitude of the body.

    Parameters
    ----------
    mounting : Mounting
        Its port, and how it is mounted on the body.
    transport : Transport, optional
        An open line; the port is opened where left out.

    Attributes
    ----------
    attitude : (float, float) or None
        Roll and pitch of B, z along gravity; None until a whole line has come [rad].
    time : float
        When that came, on the clock of the line [s].

    Raises
    ------
    PortError
        If the port can't be opened.
    """

    def __init__(self, mounting: Mounting, transport: Transport | None = None) -> None:
        self._line = transport or SerialTransport(mounting.port, mounting.baud)
        # The sensor's axes in B.
        self._mounted = np.asarray(Pose.from_rpy(*mounting.rpy).rotation)
        # What has come of a line. Its beginning is missing at first: the port opens while the sensor sends.
        self._rest, self._begun_late = b"", True
        self.attitude: tuple[float, float] | None = None
        self.time = -math.inf

    def read(self) -> float:
        """Take in what has arrived, without waiting, and return the age of the attitude [s].

        Raises
        ------
        PortError
            If the port is gone.
        """
        self._rest += self._line.discard()
        *lines, self._rest = self._rest.split(b"\n")
        whole = lines[1:] if self._begun_late else lines
        self._begun_late = self._begun_late and not lines
        if len(self._rest) > _LONGEST:
            self._rest, self._begun_late = b"", True
        for line in reversed(whole):
            angles = _angles(line)
            if angles is not None:
                world = np.asarray(Pose.from_rpy(*angles).rotation) @ self._mounted.T
                roll, pitch, _ = Pose(world, np.zeros(3)).rpy
                self.attitude, self.time = (float(roll), float(pitch)), self._line.now()
                break
        return self._line.now() - self.time

    def close(self) -> None:
        """Close the port."""
        self._line.close()


def _angles(line: bytes) -> tuple[float, float, float] | None:
    """Return roll, pitch and yaw of a line [rad]; None where it holds no attitude."""
    words = re.split(rb"[,;\s]+", line.strip())
    if len(words) != 3 or not all(_NUMBER.fullmatch(word) for word in words):
        return None
    values = [float(word) for word in words]
    if max(map(abs, values)) > _LARGEST:
        return None
    roll, pitch, yaw = (math.radians(value) for value in values)
    return roll, pitch, yaw
