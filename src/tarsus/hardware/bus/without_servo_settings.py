"""What is common to buses whose servos have neither speed limit, torque limit nor watchdog."""

from __future__ import annotations

from collections.abc import Sequence

from tarsus.hardware.bus.capabilities import Capabilities
from tarsus.hardware.bus.checks import checked_ids, checked_share, checked_speed

__all__ = ["WithoutServoSettings"]


class WithoutServoSettings:
    """The settings that a bus lacks: arguments are checked, nothing is sent, and False is returned.

    Attributes
    ----------
    name : str
        Name of the bus.
    capabilities : Capabilities
        What it can do.
    """

    name: str
    capabilities: Capabilities

    def set_speed_limit(self, ids: Sequence[int], speed: float | None) -> bool:
        """Do nothing: there is no speed limit.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        speed : float or None
            Speed, in the unit of the bus per second.
        """
        checked_speed(self.name, self.capabilities, speed)
        checked_ids(self.name, self.capabilities, ids)
        return False

    def set_torque_limit(self, ids: Sequence[int], share: float) -> bool:
        """Do nothing: there is no torque limit.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        share : float
            Share of the highest torque.
        """
        checked_share(self.name, share)
        checked_ids(self.name, self.capabilities, ids)
        return False

    def set_watchdog(self, ids: Sequence[int], seconds: float | None) -> bool:
        """Do nothing: there is no watchdog that can be set from here.

        Parameters
        ----------
        ids : sequence of int
            The servos.
        seconds : float or None
            The time [s].
        """
        checked_ids(self.name, self.capabilities, ids)
        del seconds
        return False
