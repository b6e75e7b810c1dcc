"""A sequence while it is being made: where the robot is by now, and one checked stage after the other."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from typing import Any, Self

import numpy as np

from tarsus.control.sequence.joint_rates import JointRates
from tarsus.control.sequence.sequence import MotionSequence
from tarsus.control.sequence.stage import Stage
from tarsus.control.startup.checks import check_ground, check_lift, check_limits, check_margin, check_reach
from tarsus.control.startup.folded_pose import rest_points
from tarsus.control.startup.leg_path import LegFreeSpace
from tarsus.errors import UnreachableError
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.robot.robot import Robot

__all__ = ["SequenceBuilder"]

Floats = np.ndarray[Any, np.dtype[np.float64]]
Flags = np.ndarray[Any, np.dtype[np.bool_]]

# Joints that turn by less than this in all, and bodies that move by less, don't move [rad, m].
_STILL = 1e-12
# Points of the body this near to the ground touch it [m].
_TOUCH = 1e-6
# Of the greatest speed and acceleration, what is planned with: they are measured at the shares of `GRID`, not between.
_OF_SPEED = 0.99
_OF_ACCELERATION = 0.96


@dataclass(eq=False, kw_only=True)
class SequenceBuilder:
    """Where the robot is, and the stages that led there.

    Attributes
    ----------
    robot : Robot
        A single robot.
    pace : JointRates
        What its joints may do.
    angles : array, shape (legs, 3)
        Joint angles [rad].
    body : Pose
        The body in G.
    contacts : array of bool, shape (legs,)
        The feet on the ground.
    belly : bool
        Whether the body lies flat on the ground.
    props : array, shape (n, 3)
        Points in G, besides the feet, that bear load [m]: of the body, or knees.
    margin : float
        How safely it rested as it was found [m]: legs that were found bearing load are lifted with no less than that,
        or with what is asked for where that is less.
    stages : list of Stage
        What led there.
    """

    robot: Robot
    pace: JointRates
    angles: Floats
    body: Pose
    contacts: Flags
    belly: bool
    props: Floats
    margin: float
    stages: list[Stage] = field(default_factory=list)

    def copy(self) -> Self:
        """Return a draft that can go on in another way."""
        return replace(self, stages=list(self.stages))

    def take(self, other: SequenceBuilder) -> None:
        """Go on from where another draft is."""
        for spec in fields(self):
            setattr(self, spec.name, getattr(other, spec.name))

    @property
    def feet(self) -> Floats:
        """The feet in G ``(legs, 3)`` [m]."""
        feet: Floats = self.body @ forward_kinematics(self.robot, self.angles)[:, 3]
        return feet

    @property
    def height(self) -> float:
        """Height of B's origin over the ground [m]."""
        return float(self.body.position[2])

    def turn_joints(self, name: str, angles: Floats, *, landed: Flags | None = None, least: float = 0.0) -> None:
        """Turn the joints of legs in the air, the body held still.

        Parameters
        ----------
        name : str
            What to call the stage.
        angles : array, shape (legs, 3)
            Joint angles after it [rad]; legs that keep theirs stay on the ground if they are.
        landed : array of bool, shape (legs,), optional
            The legs that are on the ground after it; those that stayed where left out.
        least : float
            The least stability margin [m].

        Raises
        ------
        TarsusError
            If it can't be done.
        """
        stay = self.contacts & (angles == self.angles).all(-1)
        after = stay if landed is None else landed
        self._add(name, least=least, angles_end=angles, contacts=stay, contacts_end=after)

    def fly(self, name: str, legs: Flags, angles: Floats, *, landed: bool, least: float = 0.0) -> None:
        """Take legs through the air to joint angles, with no point of them through the ground.

        Parameters
        ----------
        name : str
            What to call the stages.
        legs : array of bool, shape (legs,)
            Which legs.
        angles : array, shape (legs, 3)
            Their joint angles after it [rad].
        landed : bool
            Whether their feet are on the ground after it.
        least : float
            The least stability margin [m].

        Raises
        ------
        TarsusError
            If it can't be done.
        """
        routes: dict[int, tuple[Floats, ...]] = {}
        for leg in np.flatnonzero(legs).tolist():
            route = LegFreeSpace.of(self.robot, leg, self.body).route(self.angles[leg], angles[leg])
            if route is None:
                raise UnreachableError(
                    f"{name}: leg {self.robot.leg_names[leg]} finds no way through the air from "
                    f"{_degrees(self.angles[leg])} to {_degrees(angles[leg])} deg with the body's origin "
                    f"{self.height * 1000:.1f} mm up; lifting the robot by hand makes room"
                )
            routes[leg] = route
        last = max(map(len, routes.values()), default=0) - 1
        for k in range(last + 1):
            target = self.angles.copy()
            for leg, route in routes.items():
                target[leg] = route[min(k, len(route) - 1)]
            after = (self.contacts & ~legs) | (legs & (landed and k == last))
            self.turn_joints(name, target, landed=after, least=least)

    def swing(self, name: str, legs: Flags, feet: Floats, *, swing_height: float, least: float) -> None:
        """Lift feet and put them down elsewhere, the body held still.

        Parameters
        ----------
        name : str
            What to call the stage.
        legs : array of bool, shape (legs,)
            Which legs.
        feet : array, shape (legs, 3)
            Their new footholds in G [m].
        swing_height : float
            How high they are lifted on the way [m].
        least : float
            The least stability margin [m].

        Raises
        ------
        TarsusError
            If it can't be done.
        """
        stay = self.contacts & ~legs
        changes = {"by_foot": legs, "feet_end": feet, "swing_height": swing_height}
        self._add(name, least=least, contacts=stay, contacts_end=stay | legs, **changes)

    def move_body(
        self,
        name: str,
        body: Pose,
        *,
        pivot: Floats | None = None,
        props: Floats | None = None,
        still: Flags | None = None,
    ) -> None:
        """Move the body with all feet on the ground still; legs in the air keep their joint angles.

        Parameters
        ----------
        name : str
            What to call the stage.
        body : Pose
            Where it goes.
        pivot : array, shape (3,), optional
            The point of B that goes straight; B's origin where left out.
        props : array, shape (n, 3), optional
            Points in G that bear load besides the feet all the while [m]; none where left out.
        still : array of bool, shape (legs,), optional
            Legs whose feet stay where they are without bearing load; none where left out.

        Raises
        ------
        TarsusError
            If it can't be done.
        """
        self.belly, self.props = False, np.zeros((0, 3)) if props is None else props
        by_foot = self.contacts if still is None else self.contacts | still
        self._add(name, end=body, pivot=np.zeros(3) if pivot is None else pivot, by_foot=by_foot)

    def let_go(self, leg: int) -> None:
        """Note that a leg bears nothing from now on: neither its foot, nor its knee, nor its femur axis."""
        points = self.body @ forward_kinematics(self.robot, self.angles)[leg, 1:3]
        self.props = self.props[(np.abs(self.props[:, None] - points) > _TOUCH).any(-1).all(-1)]
        self.contacts = self.contacts & (np.arange(self.robot.legs) != leg)

    def lie(self) -> None:
        """Note that the body now lies flat on the ground."""
        self.belly = True
        points = self.body @ rest_points(self.robot)
        self.props = points[points[:, 2] < _TOUCH]

    def _add(self, name: str, *, least: float = 0.0, **changes: Any) -> None:
        """Add a stage, as long as the joints need for it; none where nothing moves.

        `changes` are the stage's attributes in which it differs from one in which everything is held.
        """
        stage = replace(self._hold(name), **changes)
        check_reach(stage)
        check_limits(stage)
        check_ground(stage)
        check_lift(stage)
        check_margin(stage, np.concatenate([stage.feet[stage.contacts], stage.props]), least)
        end = stage.table.angles[-1]
        moved = float(np.abs(stage.table.angles - self.angles).max()) > _STILL
        duration = _duration(stage, self.pace)
        self.contacts, self.body = stage.contacts_end, stage.end
        if moved:
            self.angles = np.where(stage.by_foot[:, None], end, stage.angles_end)
            self.angles.setflags(write=False)
            self.stages.append(replace(stage, duration=duration, angles_end=self.angles))

    def end_in(self, angles: Floats) -> None:
        """Let the last stage end in these angles to the bit; they differ from its own by rounding alone."""
        self.angles = np.array(angles)
        self.angles.setflags(write=False)
        if self.stages:
            self.stages[-1] = replace(self.stages[-1], angles_end=self.angles)

    def sequence(self) -> MotionSequence:
        """Return the sequence, moved on the ground so that it ends with the body over G's origin, heading along x."""
        stages = self.stages or [replace(self._hold("hold"), duration=0.0)]
        yaw = float(self.body.rpy[2])
        turned = Pose.from_rpy(0.0, 0.0, -yaw)
        away = turned.rotation @ (self.body.position * [1.0, 1.0, 0.0])
        home = Pose(turned.rotation, -away)
        if yaw or away.any():
            stages = [
                replace(
                    s,
                    start=home @ s.start,
                    end=home @ s.end,
                    **{name: home @ getattr(s, name) for name in ("feet", "feet_end", "props")},
                )
                for s in stages
            ]
        return MotionSequence(robot=self.robot, stages=tuple(stages), pace=self.pace)

    def _hold(self, name: str) -> Stage:
        """Return a stage of one second in which nothing moves."""
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
            by_foot=np.zeros(self.robot.legs, dtype=bool),
            contacts=self.contacts,
            contacts_end=self.contacts,
            props=self.props,
            belly=self.belly,
        )


def _degrees(angles: Floats) -> str:
    return "(" + ", ".join(f"{a:.0f}" for a in np.degrees(angles)) + ")"


def _duration(stage: Stage, pace: JointRates) -> float:
    """Return how long a stage takes so that no joint exceeds its speed or its acceleration [s]."""
    fastest, hardest = (np.abs(values).max(0) for values in stage.table[1:])
    by_speed = float((fastest / pace.speed).max()) / _OF_SPEED
    return max(by_speed, float(np.sqrt((hardest / pace.acceleration).max() / _OF_ACCELERATION)))
