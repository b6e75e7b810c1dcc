"""A motion: body, feet and joint angles over time, and the reasons why it is not possible."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.branch import branches
from tarsus.gait.gait import Gait
from tarsus.gait.spacing import feet_distance
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.reach import Reach
from tarsus.kinematics.solution import IKSolution
from tarsus.kinematics.stability import stability_margin
from tarsus.kinematics.underside import FLOOR_TOLERANCE, floor_depth, too_low_text
from tarsus.representation import Rows, represented
from tarsus.robot.joint_limits import joint_limits, servo_speeds
from tarsus.robot.robot import JOINTS, Robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float, Int

__all__ = ["Motion"]


# A leg that changes its branch jumps if one of its angles changes by more than this from a sample to the next [rad].
_JUMP = 0.1


@represented(
    "robot",
    "gait",
    "ok",
    "steps",
    "duration",
    "stroke",
    "cycle_time",
    "speed",
    "body_height",
    "margin",
    "angles",
    "assumed",
)
@dataclass(frozen=True, eq=False, kw_only=True)
class Motion:
    """A motion of a robot, sampled in time.

    Attributes
    ----------
    robot : Robot
        The robot.
    gait : Gait
        Its gait.
    time : array, shape (n,)
        Times of the samples, from 0 [s].
    body : Pose
        Poses of B in G, with batch axes ``(n,)``.
    feet : array, shape (n, legs, 3)
        Feet in G [m].
    contacts : array of bool, shape (n, legs)
        Whether each foot is on the ground.
    angles : array, shape (n, legs, 3)
        Joint angles [rad].
    reach : array of int8, shape (n, legs)
        Codes of `Reach`.
    cycle_time, stroke, speed : float
        Duration of a cycle [s]; stroke of the outermost foot [m]; its speed relative to the body while cruising [m/s],
        on a straight walk the speed of the body.
    body_height, swing_height, foot_distance : float
        Height of the body's origin above the ground, swing height, least allowed distance between feet [m].
    assumed : tuple of str
        Assumptions where neither the caller nor the robot file gave a value.
    """

    robot: Robot
    gait: Gait
    time: Float[np.ndarray, "n"]
    body: Pose
    feet: Float[np.ndarray, "n legs 3"]
    contacts: Bool[np.ndarray, "n legs"]
    angles: Float[np.ndarray, "n legs 3"]
    reach: Int[np.ndarray, "n legs"]
    cycle_time: float
    stroke: float
    speed: float
    body_height: float
    swing_height: float
    foot_distance: float
    assumed: tuple[str, ...] = field(default=())

    def __post_init__(self) -> None:
        for name in ("time", "feet", "contacts", "angles", "reach"):
            array = np.array(getattr(self, name))
            array.setflags(write=False)
            object.__setattr__(self, name, array)
        self._check_shapes()

    def _check_shapes(self) -> None:
        """Refuse arrays of inconsistent shapes."""
        n, legs = self.time.size, self.robot.legs
        self.gait.require_legs(legs)
        shapes = {"time": (n,), "feet": (n, legs, 3), "contacts": (n, legs), "angles": (n, legs, 3), "reach": (n, legs)}
        for name, shape in shapes.items():
            if getattr(self, name).shape != shape:
                raise InputError(f"a motion's {name} has shape {getattr(self, name).shape}; expected {shape}")
        if self.body.batch_shape != (n,):
            raise InputError(f"a motion's body has batch axes {self.body.batch_shape}; expected {(n,)}")
        if n < 2 or not (np.diff(self.time) > 0).all():
            raise InputError("a motion needs two samples or more, at increasing times")

    @cached_property
    def margin(self) -> Float[np.ndarray, "n"]:
        """Static stability margin at every sample ``(n,)`` [m]."""
        return np.asarray(stability_margin(self.robot, self.angles, self.body, self.contacts))

    @cached_property
    def joint_speed(self) -> Float[np.ndarray, "n legs 3"]:
        """Velocity of every joint at every sample ``(n, legs, 3)`` [rad/s], by central differences."""
        speed: np.ndarray = np.gradient(self.angles, self.time, axis=0)
        return speed

    @cached_property
    def least_foot_distance(self) -> Float[np.ndarray, "n"]:
        """Distance between the two closest feet at every sample ``(n,)`` [m]."""
        return np.asarray(feet_distance(self.feet)[0])

    def _rows(self) -> Rows:
        """Return the angles and the greatest speed of each joint, a row for each leg."""
        low, high, speed = (
            np.degrees(values) for values in (self.angles.min(0), self.angles.max(0), np.abs(self.joint_speed).max(0))
        )
        return [
            {"leg": name}
            | {f"{joint} [deg]": f"{low[leg, i]:.1f} to {high[leg, i]:.1f}" for i, joint in enumerate(JOINTS)}
            | {f"{joint} [deg/s]": f"{speed[leg, i]:.0f}" for i, joint in enumerate(JOINTS)}
            for leg, name in enumerate(self.robot.leg_names)
        ]

    @property
    def duration(self) -> float:
        """Duration [s]."""
        return float(self.time[-1])

    @property
    def steps(self) -> int:
        """Number of lift-offs."""
        return int((self.contacts[:-1] & ~self.contacts[1:]).sum())

    @cached_property
    def speed_ratio(self) -> Float[np.ndarray, "legs 3"]:
        """Greatest speed of each joint over its limit ``(legs, 3)``.

        The limit is the servo's no-load speed, and 5 rad/s where that is unknown, as in live walking.
        """
        fastest: np.ndarray = np.abs(self.joint_speed).max(0)
        return np.asarray(fastest / joint_limits(self.robot).speed)

    @cached_property
    def problems(self) -> tuple[str, ...]:
        """Why the motion is impossible: a line for each kind of problem with its first or worst sample; else empty."""
        return tuple(self._problems())

    @property
    def ok(self) -> bool:
        """Whether the motion is possible: reach, body height, branch, stability, feet's distance, joint speeds."""
        return not self.problems

    def _problems(self) -> Iterator[str]:
        if (self.reach != Reach.OK).any():
            yield self._why_unreachable()
        yield from self._too_low()
        jumps = list(self._jumps())
        yield from jumps
        yield from self._tips_over()
        yield from self._feet_too_close()
        if not jumps:  # no cycle time makes a jump slow enough
            yield from self._too_fast()

    def _too_low(self) -> Iterator[str]:
        """Yield the greatest depth of the body; on ground that is not level, below the lowest foot."""
        ground = np.minimum(self.feet[..., 2].min(-1), 0.0)
        depth = np.asarray(floor_depth(self.robot, self.body)) + ground
        worst = int(np.argmax(depth))
        if depth[worst] > FLOOR_TOLERANCE:
            low = too_low_text(float(depth[worst]), float(self.body.position[worst, 2] - ground[worst]))
            yield f"body too low: at {self.time[worst]:.2f} s its underside is {low}"

    def _jumps(self) -> Iterator[str]:
        """Yield the largest jump of a leg that changes its inverse-kinematics branch."""
        side = branches(self.robot, self.angles)
        change = np.abs(np.diff(self.angles, axis=0))
        change *= (side[1:] != side[:-1]).any(-1)[..., None]
        sample, leg, joint = np.unravel_index(int(np.argmax(change)), change.shape)
        if change[sample, leg, joint] > _JUMP:
            turn = math.degrees(change[sample, leg, joint])
            yield (
                f"jumps: at {self.time[sample]:.2f} s the {JOINTS[joint]} of {self.robot.leg_codes[leg]} would turn "
                f"{turn:.0f} deg within one sample, to another inverse-kinematics branch"
            )

    def _tips_over(self) -> Iterator[str]:
        worst = int(np.argmin(self.margin))
        at = f"tips over: at {self.time[worst]:.2f} s"
        if not self.contacts[worst].any():
            yield f"{at} no foot is on the ground"
        elif self.margin[worst] < 0:
            yield f"{at} the centre of mass is {-self.margin[worst] * 1000:.1f} mm outside the support polygon"

    def _feet_too_close(self) -> Iterator[str]:
        distance, pair = feet_distance(self.feet)
        near = int(np.argmin(distance))
        if distance[near] < self.foot_distance - 1e-9:
            legs = " and ".join(self.robot.leg_codes[i] for i in pair[near])
            yield (
                f"feet too close: at {self.time[near]:.2f} s {legs} are {distance[near] * 1000:.1f} mm apart, "
                f"less than the required foot distance of {self.foot_distance * 1000:.1f} mm"
            )

    def _too_fast(self) -> Iterator[str]:
        ratio = self.speed_ratio
        leg, joint = np.unravel_index(int(np.argmax(ratio)), ratio.shape)
        worst = float(ratio[leg, joint])
        if worst <= 1:
            return
        limit, servo = float(joint_limits(self.robot).speed[leg, joint]), self.robot.servos[leg][joint]
        bound = f"the limit is {math.degrees(limit):.0f} deg/s, as the speed of its servo is unknown"
        if servo is not None and servo_speeds(self.robot)[leg][joint] is not None:
            bound = f"its servo {servo.name} reaches {math.degrees(limit):.0f} deg/s without load"
        yield (
            f"too fast: the {JOINTS[joint]} of {self.robot.leg_codes[leg]} would turn at "
            f"{math.degrees(worst * limit):.0f} deg/s, {bound}; "
            f"a cycle time of about {self.cycle_time * worst:.2f} s or longer is possible"
        )

    def _why_unreachable(self) -> str:
        failing = self.reach != Reach.OK
        reached = self.body @ forward_kinematics(self.robot, self.angles)[..., 3, :]
        miss = np.linalg.norm(reached - self.feet, axis=-1)
        sample, leg = np.unravel_index(int(np.argmax(np.where(failing, miss, -1.0))), miss.shape)
        solution = IKSolution(
            robot=self.robot,
            feet=self.feet[sample],
            body=self.body[int(sample)],
            knee="up",
            angles=self.angles[sample],
            reach=np.where(np.arange(self.robot.legs) == leg, self.reach[sample], Reach.OK),
        )
        return f"out of reach: at {self.time[sample]:.2f} s {solution.explain()}"
