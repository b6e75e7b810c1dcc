"""Maps the servos of each bus to joints."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from tarsus.hardware.calibration.calibration import Calibration
from tarsus.robot.robot import JOINTS

if TYPE_CHECKING:
    from jaxtyping import Int

__all__ = ["Joint", "JointMap"]

Joint: TypeAlias = tuple[int, int]
"""Numbers of a leg and of a joint."""


class JointMap:
    """Maps servos, by bus and number, to joints, and joints to servos.

    Parameters
    ----------
    calibration : Calibration
        A complete calibration.
    """

    def __init__(self, calibration: Calibration) -> None:
        self._calibration = calibration
        self.by_bus: dict[str, dict[int, Joint]] = {bus.name: {} for bus in calibration.buses}
        for leg, row in enumerate(calibration.joints):
            for j, joint in enumerate(row):
                assert joint.number is not None
                self.by_bus[joint.bus][joint.number] = (leg, j)

    def joint(self, bus: str, number: int) -> Joint:
        """Return the joint of a servo.

        Parameters
        ----------
        bus : str
            Name of the bus.
        number : int
            Id or channel.
        """
        return self.by_bus[bus][number]

    def without(self, bus: str, number: int) -> JointMap:
        """Return the same map without one servo.

        Parameters
        ----------
        bus : str
            Name of the bus.
        number : int
            Id or channel.
        """
        others = JointMap(self._calibration)
        others.by_bus[bus].pop(number, None)
        return others

    def numbers(self, bus: str, legs: Iterable[int] | None = None) -> tuple[int, ...]:
        """Return the ids or channels on a bus, of the given legs or of all.

        Parameters
        ----------
        bus : str
            Name of the bus.
        legs : iterable of int, optional
            Numbers of the legs.
        """
        chosen = None if legs is None else set(legs)
        return tuple(number for number, (leg, _) in self.by_bus[bus].items() if chosen is None or leg in chosen)

    def goals(self, commands: Int[np.ndarray, "legs 3"]) -> dict[str, dict[int, float]]:
        """Return commands by bus and number.

        Parameters
        ----------
        commands : array of int, shape (legs, 3)
            The commands.
        """
        values = commands.tolist()
        return {
            bus: {number: float(values[leg][j]) for number, (leg, j) in joints.items()}
            for bus, joints in self.by_bus.items()
        }

    def describe(self, bus: str, number: int) -> str:
        """Return the name of a joint with its servo: ``"front left femur (id 2 on main)"``.

        Parameters
        ----------
        bus : str
            Name of the bus.
        number : int
            Id or channel.
        """
        leg, j = self.joint(bus, number)
        key = self._calibration.kind(leg, j).number_key
        return f"{self._calibration.robot.leg_names[leg]} {JOINTS[j]} ({key} {number} on {bus})"
