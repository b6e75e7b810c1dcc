"""Dimensions that the checks compare with each other, in the units of the robot file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np

from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Dimensions", "wrapped"]


def wrapped(angle: Float[np.ndarray, "*batch"]) -> Float[np.ndarray, "*batch"]:
    """Return angles in the range of -180 to 180 [deg].

    Parameters
    ----------
    angle : array, shape (...)
        Angles [deg].
    """
    return np.asarray((angle + 180.0) % 360.0 - 180.0, dtype=np.float64)


@dataclass(frozen=True, kw_only=True)
class Dimensions:
    """Dimensions of a robot [mm, deg].

    Medians over the legs, so that a single leg typed wrong does not change them.

    Attributes
    ----------
    coxa, femur, tibia : float
        Median lengths of the links.
    radius : float
        Median horizontal distance of the coxa axes from their centre.
    position : array, shape (legs, 2)
        Horizontal positions of the coxa axes.
    yaw : array, shape (legs,)
        Directions of the legs, from -180 to 180.
    limits : array, shape (legs, 3, 2)
        Lower and upper limit of each joint.
    """

    coxa: float
    femur: float
    tibia: float
    radius: float
    position: Float[np.ndarray, "legs 2"]
    yaw: Float[np.ndarray, "legs"]
    limits: Float[np.ndarray, "legs 3 2"]

    @classmethod
    def of(cls, robot: Robot) -> Self:
        """Return the dimensions of a single robot."""
        coxa, femur, tibia = (float(np.median(link)) * 1000 for link in (robot.coxa, robot.femur, robot.tibia))
        position = np.asarray(robot.mount_position)[:, :2] * 1000
        return cls(
            coxa=coxa,
            femur=femur,
            tibia=tibia,
            radius=float(np.median(np.linalg.norm(position - position.mean(axis=0), axis=-1))),
            position=position,
            yaw=wrapped(np.degrees(np.asarray(robot.mount_yaw, dtype=np.float64))),
            limits=np.degrees(np.asarray(robot.limits, dtype=np.float64)),
        )

    @property
    def leg(self) -> float:
        """Length of a straight leg."""
        return self.coxa + self.femur + self.tibia

    @property
    def reach(self) -> float:
        """Length of femur and tibia."""
        return self.femur + self.tibia

    @property
    def middle(self) -> Float[np.ndarray, "legs 3"]:
        """Middle of the range of each joint."""
        return np.asarray(self.limits.mean(axis=-1))

    @property
    def span(self) -> Float[np.ndarray, "legs 3"]:
        """Range of each joint."""
        return np.asarray(self.limits[..., 1] - self.limits[..., 0])
