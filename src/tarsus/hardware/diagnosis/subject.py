"""What is checked: a bus of a calibration, with the joints on it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.calibration.parts import BusSettings
from tarsus.hardware.plant.joint_map import JointMap
from tarsus.hardware.transport.clock import Clock

__all__ = ["Opener", "Subject"]

Opener: TypeAlias = Callable[[BusSettings, int | None], Bus]


@dataclass(frozen=True, kw_only=True)
class Subject:
    """A bus of a calibration.

    Attributes
    ----------
    calibration : Calibration
        A complete calibration.
    joints : JointMap
        Its joints.
    settings : BusSettings
        Settings of the bus.
    open_port : callable
        Opens the bus that settings describe, at a baud rate.
    clock : Clock
        The clock.
    """

    calibration: Calibration
    joints: JointMap
    settings: BusSettings
    open_port: Opener
    clock: Clock

    @property
    def numbers(self) -> tuple[int, ...]:
        """Ids or channels of its servos."""
        return self.joints.numbers(self.settings.name)

    def describe(self, number: int) -> str:
        """Return the name of a servo: its id and joint.

        Parameters
        ----------
        number : int
            Its id or channel.
        """
        return self.joints.describe(self.settings.name, number)
