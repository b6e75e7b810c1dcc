"""Builder of motion sequences: the current state of the robot, and one checked stage after the other."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from tarsus.control.sequence.sequence import MotionSequence
from tarsus.control.sequence.stage import Stage
from tarsus.control.startup.checks import check_stage
from tarsus.errors import UnreachableError
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.leg_path import LegFreeSpace, Path
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.underside import underside_points
from tarsus.robot.joint_limits import JointLimits
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["SequenceBuilder"]


# Stages in which no joint moves by more are omitted [rad].
_MIN_MOTION = 1e-12
# Height below which a point counts as on the ground [m].
_GROUND_TOLERANCE = 1e-6


@dataclass(eq=False, kw_only=True)
class SequenceBuilder:
    """Current state of the robot, and the stages that led to it.

    The methods that move the robot add checked stages. They raise a `TarsusError` if a motion is impossible; the
    builder may then hold some of the stages, so callers try a motion on a copy.

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
    belly : bool
        Whether the body lies on the ground.
    supports : array, shape (n, 3)
        Points in G other than feet that bear load: points of the body, or knees [m].
    initial_margin : float
        Stability margin of the initial state [m].
    swing_height : float
        Swing height of feet that change their foothold [m].
    margin : float
        Least stability margin while feet that bear load change their footholds [m].
    stages : list of Stage
        The stages so far.
    """

    robot: Robot
    joint_limits: JointLimits
    angles: Float[np.ndarray, "legs 3"]
    body: Pose
    contacts: Bool[np.ndarray, "legs"]
    belly: bool
    supports: Float[np.ndarray, "n 3"]
    initial_margin: float
    swing_height: float = 0.0
    margin: float = 0.0
    stages: list[Stage] = field(default_factory=list)

    def copy(self) -> Self:
        """Return an independent copy."""
        return replace(self, stages=list(self.stages))

    def adopt(self, other: SequenceBuilder) -> None:
        """Take over state and stages of another builder.

        Parameters
        ----------
        other : SequenceBuilder
            A builder for the same robot.
        """
        for spec in fields(self):
            setattr(self, spec.name, getattr(other, spec.name))

    @property
    def feet(self) -> Float[np.ndarray, "legs 3"]:
        """Feet in G, shape (legs, 3) [m]."""
        feet: np.ndarray = self.body @ forward_kinematics(self.robot, self.angles)[:, 3]
        return feet

    @property
    def height(self) -> float:
        """Body height [m]."""
        return float(self.body.position[2])

    def hold(self, name: str) -> Stage:
        """Return a stage of one second in which nothing moves.

        Parameters
        ----------
        name : str
            Name of the stage.
        """
        feet = self.feet
        return Stage(
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

    def move_legs(
        self,
        name: str,
        legs: Bool[np.ndarray, "legs"],
        angles: Float[np.ndarray, "legs 3"],
        *,
        landed: bool,
        margin: float = 0.0,
    ) -> None:
        """Move legs through the air to joint angles, with the body stationary and no point below the ground.

        Parameters
        ----------
        name : str
            Name of the stages.
        legs : array of bool, shape (legs,)
            Legs to move.
        angles : array, shape (legs, 3)
            Joint angles of these legs at the end [rad].
        landed, margin : bool, float
            Whether the feet are on the ground at the end; least stability margin [m].
        """
        paths = {leg: self._path(name, leg, angles[leg]) for leg in np.flatnonzero(legs).tolist()}
        count = max(map(len, paths.values()), default=0)
        for k in range(count):
            target = self.angles.copy()
            for leg, path in paths.items():
                target[leg] = path[min(k, len(path) - 1)]
            stationary = self.contacts & (target == self.angles).all(-1)
            after = (self.contacts & ~legs) | (legs & (landed and k == count - 1))
            self._add(name, margin=margin, angles_end=target, contacts=stationary, contacts_end=after)

    def _path(self, name: str, leg: int, end: Float[np.ndarray, "3"]) -> Path:
        """Return a path of a leg through the air from its joint angles to others."""
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
    ) -> None:
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
        self._add(name, margin=margin, contacts=stance, contacts_end=stance | legs, **changes)

    def move_body(
        self,
        name: str,
        body: Pose,
        *,
        pivot: Float[np.ndarray, "3"] | None = None,
        supports: Float[np.ndarray, "n 3"] | None = None,
        stationary: Bool[np.ndarray, "legs"] | None = None,
    ) -> None:
        """Move the body with all feet on the ground stationary; legs in the air keep their joint angles.

        Parameters
        ----------
        name, body : str, Pose
            Name of the stage; pose of B in G at the end.
        pivot : array, shape (3,), optional
            Point in B that moves in a straight line [m]; by default the origin.
        supports : array, shape (n, 3), optional
            Points in G other than feet that bear load throughout [m]; by default none.
        stationary : array of bool, shape (legs,), optional
            Further legs whose feet are stationary without bearing load; by default none.
        """
        self.belly, self.supports = False, np.zeros((0, 3)) if supports is None else supports
        cartesian = self.contacts if stationary is None else self.contacts | stationary
        self._add(name, end=body, pivot=np.zeros(3) if pivot is None else pivot, cartesian=cartesian)

    def unload(self, leg: int) -> None:
        """Mark a leg as bearing no load, neither on its foot nor on its knee or femur axis.

        Parameters
        ----------
        leg : int
            Index of the leg.
        """
        points = self.body @ forward_kinematics(self.robot, self.angles)[leg, 1:3]
        self.supports = self.supports[(np.abs(self.supports[:, None] - points) > _GROUND_TOLERANCE).any(-1).all(-1)]
        self.contacts = self.contacts & (np.arange(self.robot.legs) != leg)

    def set_lying(self) -> None:
        """Mark the body as lying on the ground."""
        self.belly = True
        points = self.body @ underside_points(self.robot)
        self.supports = points[points[:, 2] < _GROUND_TOLERANCE]

    def set_end_angles(self, angles: Float[np.ndarray, "legs 3"]) -> None:
        """Replace the final joint angles by ones that are equal up to rounding.

        Parameters
        ----------
        angles : array, shape (legs, 3)
            Joint angles [rad].
        """
        self.angles = np.array(angles)
        self.angles.setflags(write=False)
        if self.stages:
            self.stages[-1] = replace(self.stages[-1], angles_end=self.angles)

    def sequence(self, robot: Robot) -> MotionSequence:
        """Return the sequence, moved in G so that the body ends over the origin with yaw 0.

        Parameters
        ----------
        robot : Robot
            The robot that moves; the builder's differs from it in the thickness of its body.
        """
        stages = self.stages or [replace(self.hold("hold"), duration=0.0)]
        yaw = float(self.body.rpy[2])
        rotation = Pose.from_rpy(0.0, 0.0, -yaw).rotation
        offset = rotation @ (self.body.position * [1.0, 1.0, 0.0])
        if yaw or offset.any():
            home = Pose(rotation, -offset)
            stages = [stage.transformed(home) for stage in stages]
        stages = [replace(stage, robot=robot) for stage in stages]
        return MotionSequence(robot=robot, stages=tuple(stages), joint_limits=self.joint_limits)

    def _add(self, name: str, *, margin: float = 0.0, **changes: Any) -> None:
        """Add a stage of the shortest duration that differs from `hold` by `changes`; omit it if no joint moves."""
        stage = replace(self.hold(name), **changes)
        check_stage(stage, margin)
        end = stage.table.angles[-1]
        moves = float(np.abs(stage.table.angles - self.angles).max()) > _MIN_MOTION
        self.contacts, self.body = stage.contacts_end, stage.end
        if moves:
            duration = stage.shortest_duration(self.joint_limits)
            self.angles = np.where(stage.cartesian[:, None], end, stage.angles_end)
            self.angles.setflags(write=False)
            self.stages.append(replace(stage, duration=duration, angles_end=self.angles))


def _degrees(angles: Float[np.ndarray, "3"]) -> str:
    return "(" + ", ".join(f"{a:.0f}" for a in np.degrees(angles)) + ")"
