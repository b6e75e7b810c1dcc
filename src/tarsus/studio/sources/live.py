"""Values of one leg of the standing robot, as the source documents use them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from tarsus.kinematics.body import coxa_frames
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stance import reachable_band
from tarsus.robot.robot import Robot
from tarsus.studio.messages.state import Curve, Straight, WalkOptions
from tarsus.studio.standing import OnFootholds

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Live", "WalkValues"]


@dataclass(frozen=True)
class WalkValues:
    """Values of a walk in the equations of source 001.

    Attributes
    ----------
    stroke : float
        Stroke of a foot [m].
    distance, heading : float
        Length and direction of a straight walk [m, rad].
    angle : float
        Angle of a curved walk about its centre, positive to the left [rad].
    centre : tuple of float
        Centre (x, y) of a curved walk in the body frame [m].
    """

    stroke: float = 0.04
    distance: float = 0.5
    heading: float = 0.0
    angle: float = math.radians(60)
    centre: tuple[float, float] = (0.0, 0.5)

    @classmethod
    def of(cls, options: WalkOptions) -> Self:
        """Return the values of the view Walk; those that it does not state are the defaults of this class.

        Parameters
        ----------
        options : WalkOptions
            Options of the walk.
        """
        given: dict[str, Any] = {} if options.stroke_mm is None else {"stroke": options.stroke_mm / 1000}
        path = options.path
        if isinstance(path, Straight):
            given |= {"distance": path.distance_mm / 1000, "heading": math.radians(path.heading_deg)}
        elif isinstance(path, Curve):
            x, y = path.centre_mm
            given |= {"angle": math.radians(path.angle_deg), "centre": (x / 1000, y / 1000)}
        return cls(**given)


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
    body : Pose
        Pose of the body in G.
    walk : WalkValues
        Values of a walk.
    """

    robot: Robot
    leg: int
    angles: Float[np.ndarray, "3"]
    foot: Float[np.ndarray, "3"]
    foot_in_body: Float[np.ndarray, "3"]
    mount: Float[np.ndarray, "3"]
    rpy: Float[np.ndarray, "3"]
    body_height: float
    body: Pose
    walk: WalkValues

    @classmethod
    def of(cls, standing: OnFootholds, leg: int, walk: WalkValues | None = None) -> Self:
        """Return the values of a leg.

        Parameters
        ----------
        standing : OnFootholds
            The standing robot.
        leg : int
            Index of the leg.
        walk : WalkValues, optional
            Values of a walk.
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
            body=standing.body,
            walk=WalkValues() if walk is None else walk,
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

    @property
    def rests(self) -> Float[np.ndarray, "legs 2"]:
        """Rest footholds (x, y) of all legs in B, in the middle of their reachable bands [m]; NaN if there are none."""
        near, far = reachable_band(self.robot, np.asarray(-self.body_height))
        yaw = np.asarray(self.robot.mount_yaw)
        outward = np.stack([np.cos(yaw), np.sin(yaw)], axis=-1)
        rests: np.ndarray = np.asarray(self.robot.mount_position)[:, :2] + ((near + far) / 2)[:, None] * outward
        return rests

    @property
    def rest(self) -> Float[np.ndarray, "2"]:
        """Rest foothold (x, y) in B [m]."""
        rest: np.ndarray = self.rests[self.leg]
        return rest

    @property
    def from_centre(self) -> Float[np.ndarray, "legs 2"]:
        """Rest footholds of all legs relative to the centre of the curve [m]."""
        arms: np.ndarray = self.rests - np.asarray(self.walk.centre)
        return arms

    @property
    def stroke_angle(self) -> float:
        """Angle of a stroke about the centre of the curve [rad]."""
        return self.walk.stroke / float(np.hypot(*self.from_centre.T).max())

    def on_curve(self, turn: float) -> tuple[float, float]:
        """Return the rest foothold turned about the centre of the curve, (x, y) in B [m].

        Parameters
        ----------
        turn : float
            Angle [rad].
        """
        turned = complex(*self.from_centre[self.leg]) * complex(math.cos(turn), math.sin(turn))
        return self.walk.centre[0] + turned.real, self.walk.centre[1] + turned.imag

    def ground_at(self, place: Float[np.ndarray, "2"]) -> float:
        """Return the z coordinate in B of the ground at a place (x, y) of B [m].

        Parameters
        ----------
        place : array, shape (2,)
            In B [m].
        """
        normal = np.asarray(self.body.rotation)[2]
        return float(-(float(self.body.position[2]) + normal[:2] @ place) / normal[2])
