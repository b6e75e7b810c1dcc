"""The supply of emulated servos: it sags under their currents, and below a voltage they start anew."""

from __future__ import annotations

import math
from collections.abc import Collection

from tarsus.hardware.emulation.servo import EmulatedServo
from tarsus.representation import represented

__all__ = ["Supply"]


@represented("voltage", "nominal", "resistance")
class Supply:
    """A battery with a resistance, cables included.

    Parameters
    ----------
    nominal : float
        Voltage at which servos have their nominal speed [V].
    resistance : float
        Of battery and cables [ohm].
    least : float
        Voltage below which servos lose their memory and start anew [V].
    boot : float
        How long that takes [s].

    Attributes
    ----------
    source : float
        Voltage without load [V]; may be changed.
    """

    def __init__(
        self, nominal: float = 7.4, *, resistance: float = 0.03, least: float = 4.5, boot: float = 0.3
    ) -> None:
        self.nominal, self.resistance, self.least, self.boot = nominal, resistance, least, boot
        self.source = self.voltage = nominal
        self._booted = -math.inf

    def advance(self, now: float, servos: Collection[EmulatedServo]) -> None:
        """Move servos on to a time, at the voltage that remains under their common current.

        Parameters
        ----------
        now : float
            The time [s].
        servos : collection of EmulatedServo
            All that the supply feeds.
        """
        self.voltage = max(self.source - self.resistance * sum(servo.current for servo in servos), 0.0)
        if self.voltage < self.least:
            for servo in servos:
                servo.reset()
            self._booted = now + self.boot
        for servo in servos:
            servo.advance(now, self.voltage / self.nominal)

    def up(self, now: float) -> bool:
        """Return whether servos answer: the voltage is high enough, and they have restarted since it was too low.

        Parameters
        ----------
        now : float
            The time [s].
        """
        return self.voltage >= self.least and now >= self._booted
