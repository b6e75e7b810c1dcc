"""Foot switches of an emulated robot: which feet of its pose touch flat ground."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.hardware.calibration.calibration import Calibration
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.rest import resting_pose

if TYPE_CHECKING:
    from jaxtyping import Bool

__all__ = ["EmulatedFeet"]

# Feet no higher than this touch the ground: gear play lifts feet of a rigid robot, but not of an elastic one [m].
_TOUCH = 0.004


class EmulatedFeet(Mapping[int, float]):
    """Levels of the inputs of foot switches, by their numbers.

    Parameters
    ----------
    calibration : Calibration
        A complete calibration with foot switches.
    lines : mapping of str to emulated servos
        The servos, by the names of their buses.
    """

    def __init__(self, calibration: Calibration, lines: Mapping[str, Any]) -> None:
        switches = calibration.foot_switches
        assert switches is not None
        self._calibration, self._lines, self._closed = calibration, lines, switches.closed
        self._known: tuple[list[list[float]], Bool[np.ndarray, "legs"]] | None = None
        self._legs = {number: leg for leg, number in enumerate(switches.inputs) if number is not None}

    def __getitem__(self, number: int) -> float:
        return float(bool(self._contacts()[self._legs[number]]) == self._closed)

    def __contains__(self, number: object) -> bool:
        return number in self._legs

    def __iter__(self) -> Iterator[int]:
        return iter(self._legs)

    def __len__(self) -> int:
        return len(self._legs)

    def _contacts(self) -> Bool[np.ndarray, "legs"]:
        """Return which feet touch the ground, as the robot rests on it with the present angles."""
        shafts = [
            [self._lines[joint.bus].servos[joint.number].position for joint in row] for row in self._calibration.joints
        ]
        # All inputs are read together.
        if self._known is not None and self._known[0] == shafts:
            return self._known[1]
        robot, angles = self._calibration.robot, self._calibration.angles(np.array(shafts))
        body = resting_pose(robot, angles).body
        heights = (body @ forward_kinematics(robot, angles)[..., 3, :])[..., 2]
        self._known = shafts, np.asarray(heights <= _TOUCH)
        return self._known[1]
