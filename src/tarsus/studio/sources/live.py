"""Values of one leg of the standing robot, as the source documents use them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np

from tarsus.kinematics.body import coxa_frames
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.stance import reachable_band
from tarsus.robot.robot import Robot
from tarsus.studio.standing import OnFootholds

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Live"]


@dataclass(frozen=True, eq=False)
class Live:
    """One leg of a standing robot.

    Attributes
    ----------
    robot : Robot
        A single robot.
    leg : int
        Index of the leg.
    angles : array, shape (3,)
        Angles of coxa, femur and tibia [rad].
    foot : array, shape (3,)
        Position of the foot in the coxa frame C [m].
    foot_in_body : array, shape (3,)
        Position of the foot in B [m].
    mount : array, shape (3,)
        Position of the coxa axis in B [m].
    rpy : array, shape (3,)
        Attitude of the body [rad].
    body_height : float
        Height of the body's origin before it was moved [m].
    """

    robot: Robot
    leg: int
    angles: Float[np.ndarray, "3"]
    foot: Float[np.ndarray, "3"]
    foot_in_body: Float[np.ndarray, "3"]
    mount: Float[np.ndarray, "3"]
    rpy: Float[np.ndarray, "3"]
    body_height: float

    @classmethod
    def of(cls, standing: OnFootholds, leg: int) -> Self:
        """Return the values of a leg.

        Parameters
        ----------
        standing : OnFootholds
            The standing robot.
        leg : int
            Index of the leg.
        """
        robot, angles = standing.solution.robot, np.asarray(standing.solution.angles)
        feet = np.asarray(forward_kinematics(robot, angles))[:, 3]
        in_legs = np.asarray(coxa_frames(robot).inverse() @ feet[:, None])[:, 0]
        return cls(
            robot=robot,
            leg=leg,
            angles=angles[leg],
            foot=in_legs[leg],
            foot_in_body=feet[leg],
            mount=np.asarray(robot.mount_position)[leg],
            rpy=np.asarray(standing.body.rpy),
            body_height=float(standing.start.position[2]),
        )

    def length(self, link: str) -> float:
        """Return the length of a link [m].

        Parameters
        ----------
        link : str
            ``"coxa"``, ``"femur"`` or ``"tibia"``.
        """
        return float(getattr(self.robot, link)[self.leg])

    @property
    def yaw(self) -> float:
        """Yaw of the mount of the leg [rad]."""
        return float(self.robot.mount_yaw[self.leg])

    @property
    def offset(self) -> tuple[float, float]:
        """Sideways and vertical offset of the femur axis from the coxa axis [m]."""
        side, up = self.robot.femur_axis_offset[self.leg]
        return float(side), float(up)

    @property
    def band(self) -> tuple[float, float]:
        """Nearest and farthest reachable distance of the foot straight outward [m]; NaN if none."""
        near, far = reachable_band(self.robot, np.asarray(-self.body_height))
        return float(near[self.leg]), float(far[self.leg])
