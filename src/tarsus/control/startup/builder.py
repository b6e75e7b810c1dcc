"""Builder of motion sequences: the current state of the robot, and the checked stages that led to it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple, Self

import numpy as np

from tarsus.arrays import read_only
from tarsus.control.sequence.sequence import MotionSequence
from tarsus.control.sequence.stage import Stage
from tarsus.control.startup.checks import check_stage
from tarsus.errors import UnreachableError
from tarsus.kinematics.ground import ground_frame
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.leg_path import LegFreeSpace, Path
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.underside import underside_points
from tarsus.robot.joint_limits import JointLimits
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["GROUND_TOLERANCE", "BodyTarget", "SequenceBuilder", "body_contacts"]

GROUND_TOLERANCE = 1e-7
"""Height below which a point counts as on the ground [m]."""

# Stages in which no joint moves by more than this are omitted [rad].
_MIN_MOTION = 1e-12


class BodyTarget(NamedTuple):
    """A level pose of the body.

    Attributes
    ----------
    body : Pose
        Pose of B in G.
    pivot : array, shape (3,)
        Point in B that moves there in a straight line [m].
    belly : bool
        Whether the body lies on the ground in this pose.
    """

    body: Pose
    pivot: Float[np.ndarray, "3"]
    belly: bool


@dataclass(frozen=True, eq=False, kw_only=True)
class SequenceBuilder:
    """Current state of the robot, and the stages that led to it.

    The methods that move the robot return a builder with the new state and with the checked stages added. They raise a
    `TarsusError` if a motion is impossible.

    Attributes
    ----------
    robot : Robot
        A single robot.
    joint_limits : JointLimits
        Joint speeds and accelerations of the plan.
    angles : array, shape (legs, 3)
        Joint angles [rad].
    body : Pose
        Pose of B in G.
    contacts : array of bool, shape (legs,)
        Feet on the ground.
    supports : array, shape (n, 3)
        Points in G other than feet that bear load: points of the body, or knees [m].
    belly : bool
        Whether the body lies on the ground.
    initial_margin : float
        Stability margin of the initial state [m].
    swing_height : float
        Swing height of feet that change their foothold [m].
    margin : float
        Least stability margin while feet that bear load change their footholds [m].
    stages : tuple of Stage
        The stages so far.
    """

    robot: Robot
    joint_limits: JointLimits
    angles: Float[np.ndarray, "legs 3"]
    body: Pose
    contacts: Bool[np.ndarray, "legs"]
    supports: Float[np.ndarray, "n 3"]
    belly: bool = False
    initial_margin: float = 0.0
    swing_height: float = 0.0
    margin: float = 0.0
    stages: tuple[Stage, ...] = ()

    @property
    def points(self) -> Float[np.ndarray, "legs 4 3"]:
        """Points of the legs in G, in the order of `forward_kinematics`: shape (legs, 4, 3) [m]."""
        return np.asarray(self.body @ forward_kinematics(self.robot, self.angles))

    @property
    def feet(self) -> Float[np.ndarray, "legs 3"]:
        """Feet in G, shape (legs, 3) [m]."""
        return self.points[:, 3]

    @property
    def height(self) -> float:
        """Body height [m]."""
        return float(self.body.position[2])

    def stage(self, name: str, **changes: Any) -> Stage:
        """Return an unchecked stage of one second in which nothing moves, with changes to its attributes."""
        feet = self.feet
        still = Stage(
            name=name,
            robot=self.robot,
            duration=1.0,
            start=self.body,
            end=self.body,
            pivot=np.zeros(3),
            angles=self.angles,
            angles_end=self.angles,
            feet=feet,
            feet_end=feet,
            swing_height=0.0,
            cartesian=np.zeros(self.robot.legs, dtype=bool),
            contacts=self.contacts,
            contacts_end=self.contacts,
            supports=self.supports,
            belly=self.belly,
        )
        return replace(still, **changes)

    def move_legs(self, name: str, angles: Float[np.ndarray, "legs 3"], *, landed: bool, margin: float = 0.0) -> Self:
        """Move legs through the air to joint angles, with the body stationary and no point below the ground.

        Parameters
        ----------
        name : str
            Name of the stages.
        angles : array, shape (legs, 3)
            Joint angles at the end; legs that have these already stay in place [rad].
        landed, margin : bool, float
            Whether the feet that move are on the ground at the end; least stability margin [m].
        """
        legs = (self.angles != angles).any(-1)
        paths = {leg: self._path(name, leg, angles[leg]) for leg in np.flatnonzero(legs).tolist()}
        count, builder = max(map(len, paths.values()), default=0), self
        for k in range(count):
            target = builder.angles.copy()
            for leg, path in paths.items():
                target[leg] = path[min(k, len(path) - 1)]
            stationary = builder.contacts & (target == builder.angles).all(-1)
            after = (builder.contacts & ~legs) | (legs & (landed and k == count - 1))
            builder = builder._add(name, margin=margin, angles_end=target, contacts=stationary, contacts_end=after)
        return builder

    def _path(self, name: str, leg: int, end: Float[np.ndarray, "3"]) -> Path:
        """Return a path of a leg through the air from its present joint angles to others."""
        start = self.angles[leg]
        path = LegFreeSpace.of(self.robot, leg, self.body).find_path(start, end)
        if path is None:
            raise UnreachableError(
                f"{name}: at body height {self.height * 1000:.1f} mm, leg {self.robot.leg_names[leg]} has no "
                f"path through the air from {_degrees(start)} to {_degrees(end)} deg; place the robot on its "
                "belly, or support it higher"
            )
        return path

    def swing(
        self, name: str, legs: Bool[np.ndarray, "legs"], feet: Float[np.ndarray, "legs 3"], *, margin: float
    ) -> Self:
        """Swing feet to new footholds, with the body stationary.

        Parameters
        ----------
        name : str
            Name of the stage.
        legs : array of bool, shape (legs,)
            Legs to move.
        feet : array, shape (legs, 3)
            New footholds of these legs in G [m].
        margin : float
            Least stability margin [m].
        """
        stance = self.contacts & ~legs
        changes = {"cartesian": legs, "feet_end": feet, "swing_height": self.swing_height}
        return self._add(name, margin=margin, contacts=stance, contacts_end=stance | legs, **changes)

    def move_body(self, name: str, target: BodyTarget, stationary: Bool[np.ndarray, "legs"]) -> Self:
        """Move the body over stationary feet; where it is to lie, its points on the ground support it as well.

        Parameters
        ----------
        name, target : str, BodyTarget
            Name of the stage; pose of the body at the end.
        stationary : array of bool, shape (legs,)
            Legs whose feet are stationary, with or without load; the others keep their joint angles.
        """
        supports = body_contacts(self.robot, self.body) if target.belly else np.zeros((0, 3))
        builder = replace(self, belly=False, supports=supports)
        return builder._add(name, end=target.body, pivot=target.pivot, cartesian=stationary)

    def unload(self, leg: int) -> Self:
        """Return the robot with a leg that bears no load any more: not on its foot, its knee or its femur axis."""
        others = (np.abs(self.supports[:, None] - self.points[leg, 1:3]) > GROUND_TOLERANCE).any(-1).all(-1)
        contacts = self.contacts & (np.arange(self.robot.legs) != leg)
        return replace(self, supports=self.supports[others], contacts=contacts)

    def lie_down(self) -> Self:
        """Return the robot with its body lying on the ground in its present pose."""
        return replace(self, belly=True, supports=body_contacts(self.robot, self.body))

    def end_at(self, angles: Float[np.ndarray, "legs 3"]) -> Self:
        """Return the robot with its joint angles replaced by given ones, equal to them up to rounding [rad]."""
        angles = read_only(np.array(angles))
        last = [replace(stage, angles_end=angles) for stage in self.stages[-1:]]
        return replace(self, angles=angles, stages=(*self.stages[:-1], *last))

    def sequence(self, robot: Robot) -> MotionSequence:
        """Return the sequence, moved in G so that the body ends over the origin with yaw 0.

        Parameters
        ----------
        robot : Robot
            The robot that moves; that of the builder may have a thinner body: see `over_feet`.
        """
        stages = self.stages or (self.stage("hold", duration=0.0),)
        home = ground_frame(self.body).inverse()
        stages = tuple(replace(stage.transformed(home), robot=robot) for stage in stages)
        return MotionSequence(robot=robot, stages=stages, joint_limits=self.joint_limits)

    def _add(self, name: str, *, margin: float = 0.0, **changes: Any) -> Self:
        """Add a stage with changes, checked and of the shortest duration; omit it if no joint moves."""
        stage = self.stage(name, **changes)
        check_stage(stage, margin)
        after = replace(self, contacts=stage.contacts_end, body=stage.end)
        if np.abs(stage.table - self.angles).max() <= _MIN_MOTION:
            return after
        stage = replace(stage, duration=stage.shortest_duration(self.joint_limits))
        angles = np.where(stage.cartesian[:, None], stage.table[-1], stage.angles_end)
        return replace(after, stages=(*self.stages, stage)).end_at(angles)


def body_contacts(robot: Robot, body: Pose) -> Float[np.ndarray, "n 3"]:
    """Return the points of the body's underside that are on the ground: array, shape (n, 3), in G [m]."""
    points: np.ndarray = body @ underside_points(robot)
    return points[points[:, 2] < GROUND_TOLERANCE]


def _degrees(angles: Float[np.ndarray, "3"]) -> str:
    return "(" + ", ".join(f"{a:.0f}" for a in np.degrees(angles)) + ")"
