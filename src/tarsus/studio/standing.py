"""Messages on the standing or resting robot, for the views Joints and Body."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np

from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import MassWeights, centre_of_mass
from tarsus.kinematics.polygon import support_polygon
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.reach import Reach
from tarsus.kinematics.rest import CORNERS, RestingPose, rest_of_points
from tarsus.load.torque import joint_torques
from tarsus.report.standing_summary import NOT_STABLE, Standing
from tarsus.robot.robot import JOINTS, Robot
from tarsus.studio.encoding import degrees, flags, millimetres, or_null, plain
from tarsus.studio.messages.pose import BrokenLimit, LegProblem, PoseMessage
from tarsus.studio.messages.state import View

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["OnFootholds", "Resting", "broken_limits", "resting_message", "standing_message"]

# Height up to which a dragged foot is on the ground [m], and least number of feet that can support a robot.
_ON_GROUND = 1e-5
_LEAST_FEET = 3
# Tolerance of joint limits, for rounding [rad].
_SLACK = 1e-8


class OnFootholds(Standing):
    """A robot on footholds, some of which may be above the ground."""

    @property
    def grounded(self) -> Bool[np.ndarray, "legs"]:
        """Which footholds are on the ground ``(legs,)``."""
        return np.asarray(np.asarray(self.solution.feet)[:, 2] <= _ON_GROUND)


@dataclass(frozen=True, eq=False)
class Resting:
    """Joint angles and the resting pose that they lead to.

    Attributes
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Joint angles [rad].
    points : array, shape (legs, 4, 3)
        Leg points in B [m].
    com : array, shape (3,)
        Centre of mass in B [m].
    rest : RestingPose
        Result of `resting_pose`.
    """

    robot: Robot
    angles: Float[np.ndarray, "legs 3"]
    points: Float[np.ndarray, "legs 4 3"]
    com: Float[np.ndarray, "3"]
    rest: RestingPose

    @classmethod
    def of(cls, robot: Robot, masses: MassWeights, angles: Float[np.ndarray, "legs 3"]) -> Self:
        """Return the resting pose of joint angles.

        Parameters
        ----------
        robot : Robot
            A single robot.
        masses : MassWeights
            Its masses.
        angles : array, shape (legs, 3)
            Joint angles [rad].
        """
        points = np.asarray(forward_kinematics(robot, angles))
        com = masses.centre_of_mass(points)
        return cls(robot, angles, points, com, rest_of_points(robot, points, com))


@dataclass(frozen=True, eq=False)
class _Placed:
    """Joint angles, body pose and contacts, with the leg points and the centre of mass in G [m]."""

    robot: Robot
    angles: Float[np.ndarray, "legs 3"]
    body: Pose
    contacts: Bool[np.ndarray, "legs"]
    points: Float[np.ndarray, "*#batch legs 4 3"]
    com: Float[np.ndarray, "batch"]

    @classmethod
    def of(
        cls,
        robot: Robot,
        angles: Float[np.ndarray, "legs 3"],
        points: Float[np.ndarray, "legs 4 3"],
        com: Float[np.ndarray, "3"],
        body: Pose,
        contacts: Bool[np.ndarray, "legs"],
    ) -> Self:
        """Place the leg points and the centre of mass, given in B."""
        # All points in one transformation, as its cost hardly depends on their number.
        placed = np.asarray(body @ np.concatenate([points.reshape(-1, 3), com[None]]))
        return cls(robot, angles, body, contacts, placed[:-1].reshape(points.shape), placed[-1])

    def statics(self, *, balanced: bool) -> tuple[list[float] | None, list[float] | None]:
        """Return contact forces and joint torques if the feet alone support the robot."""
        if not (balanced and self.robot.has_masses and self.contacts.sum() >= _LEAST_FEET):
            return None, None
        torques, forces = joint_torques(self.robot, self.angles, self.body, self.contacts)
        return plain(forces), plain(torques)


def resting_message(found: Resting, *, id: int, view: View, forces: bool = True) -> PoseMessage:
    """Return the resting pose of joint angles.

    Parameters
    ----------
    found : Resting
        The robot, its joint angles and its resting pose.
    id : int
        Id of the message that is answered.
    view : str
        View that shows the pose.
    forces : bool
        Whether to compute contact forces and joint torques.
    """
    robot, angles, rest = found.robot, found.angles, found.rest
    down, corners = np.asarray(rest.leg_points_down), np.asarray(rest.corners_down)
    placed = _Placed.of(robot, angles, found.points, found.com, rest.body, np.asarray(rest.contacts))
    points, margin, stable = placed.points, float(rest.margin), bool(rest.stable)
    on_feet = not (down[:, :3].any() or corners.any())
    statics = placed.statics(balanced=forces and on_feet and stable and margin >= 0)
    touching = points[down]
    if corners.any():
        box = np.asarray(rest.body @ (CORNERS * np.asarray(robot.body_size)))
        touching = np.concatenate([touching, box[corners]])
    return PoseMessage(
        type="pose",
        id=id,
        view=view,
        position_mm=millimetres(rest.body.position),
        rpy_deg=degrees(rest.body.rpy),
        angles_deg=degrees(angles),
        feet_mm=millimetres(points[:, 3]),
        contacts=flags(rest.contacts),
        points_down=flags(down),
        corners_down=int(corners.sum()),
        margin_mm=or_null(margin * 1000),
        stable=stable,
        com_mm=millimetres(placed.com),
        support_mm=_polygon(touching),
        forces_n=statics[0],
        torques_nm=statics[1],
        legs=[],
        limits=broken_limits(robot, angles),
        text=rest.describe(),
        problems=[] if stable else [NOT_STABLE],
        feasible_fraction=None,
    )


def standing_message(standing: OnFootholds, *, id: int, view: View, forces: bool = True) -> PoseMessage:
    """Return the pose of a robot on its footholds.

    Parameters
    ----------
    standing : OnFootholds
        A single configuration.
    id : int
        Id of the message that is answered.
    view : str
        View that shows the pose.
    forces : bool
        Whether to compute contact forces and joint torques.
    """
    robot, solution = standing.solution.robot, standing.solution
    angles, feet, contacts = np.asarray(solution.angles), np.asarray(solution.feet), standing.contacts
    margin, problems = standing.margin, standing.problems
    points = np.asarray(forward_kinematics(robot, angles))
    com = np.asarray(centre_of_mass(robot, angles, points=points))
    placed = _Placed.of(robot, angles, points, com, standing.body, contacts)
    statics = placed.statics(balanced=forces and margin >= 0)
    reached = placed.points
    down = np.zeros((robot.legs, 4), dtype=bool)
    down[:, 3] = contacts
    return PoseMessage(
        type="pose",
        id=id,
        view=view,
        position_mm=millimetres(standing.body.position),
        rpy_deg=degrees(standing.body.rpy),
        angles_deg=degrees(angles),
        feet_mm=millimetres(feet),
        contacts=flags(contacts),
        points_down=flags(down),
        corners_down=0,
        margin_mm=or_null(margin * 1000),
        stable=margin >= 0,
        com_mm=millimetres(placed.com),
        support_mm=_polygon(reached[contacts, 3]),
        forces_n=statics[0],
        torques_nm=statics[1],
        legs=_leg_problems(standing, reached[:, 3] - feet),
        limits=[],
        text=_text(robot, contacts, margin),
        problems=problems,
        feasible_fraction=standing.feasible_fraction if problems else 1.0,
    )


def _text(robot: Robot, contacts: Bool[np.ndarray, "legs"], margin: float) -> str:
    codes = [code for code, down in zip(robot.leg_codes, contacts, strict=True) if down]
    if not codes:
        return "no foot on the ground"
    feet = f"{len(codes)} {'foot' if len(codes) == 1 else 'feet'}"
    if margin < 0:
        return f"tips over: {feet} on the ground, {', '.join(codes)}"
    return f"stands on {feet}: {', '.join(codes)}; stability margin {margin * 1000:.1f} mm"


def _leg_problems(standing: OnFootholds, miss: Float[np.ndarray, "legs 3"]) -> list[LegProblem]:
    reach = np.asarray(standing.solution.reach)
    return [
        LegProblem(
            leg=int(leg),
            reach=Reach(int(reach[leg])).name,  # type: ignore[arg-type] # every code but OK is one of the names
            miss_mm=or_null(float(np.linalg.norm(miss[leg])) * 1000) or 0.0,
            text=standing.solution.explain_leg((int(leg),)),
        )
        for leg in np.flatnonzero(reach)
    ]


def broken_limits(robot: Robot, angles: Float[np.ndarray, "legs 3"]) -> list[BrokenLimit]:
    """Return the joints beyond their limits.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Joint angles [rad].
    """
    limits = np.asarray(robot.limits)
    broken = (angles < limits[..., 0] - _SLACK) | (angles > limits[..., 1] + _SLACK)
    if not broken.any():
        return []
    turned, limits = np.degrees(angles), np.degrees(limits)
    return [
        _broken(robot.leg_names[leg], leg, joint, float(turned[leg, joint]), *map(float, limits[leg, joint]))
        for leg, joint in np.argwhere(broken).tolist()
    ]


def _broken(leg_name: str, leg: int, joint: int, angle: float, low: float, high: float) -> BrokenLimit:
    above = angle > high
    bound, beyond = (high, angle - high) if above else (low, low - angle)
    name = JOINTS[joint]
    return BrokenLimit(
        leg=leg,
        joint=name,  # type: ignore[arg-type] # one of the three
        angle_deg=round(angle, 3),
        low_deg=round(low, 3),
        high_deg=round(high, 3),
        text=f"{leg_name}: the {name} angle is {angle:.1f} deg, {math.fabs(beyond):.1f} deg "
        f"{'above its upper' if above else 'below its lower'} limit of {bound:.1f} deg",
    )


def _polygon(points: Float[np.ndarray, "*batch 3"]) -> list[float]:
    return millimetres(support_polygon(points[:, :2].reshape(-1, 2), np.ones(len(points), dtype=bool)))
