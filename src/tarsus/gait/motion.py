"""A motion: the body, the feet and the joints over time, with a verdict."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

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
from tarsus.robot.robot import JOINTS, Robot

__all__ = ["Motion"]

Floats = np.ndarray[Any, np.dtype[np.float64]]

# A leg that goes over to another way to reach its foot, and a joint with it by more than this, jumps [rad].
_JUMP = 0.1


@dataclass(frozen=True, eq=False, kw_only=True)
class Motion:
    """A motion of a robot, sampled in time.

    Attributes
    ----------
    robot : Robot
        Whose motion it is.
    gait : Gait
        The order of its steps.
    time : array, shape (n,)
        Moments, from 0 [s].
    body : Pose
        Places of B in G, ``(n,)``.
    feet : array, shape (n, legs, 3)
        Feet in G [m].
    contacts : array of bool, shape (n, legs)
        Whether each foot is on the ground.
    angles : array, shape (n, legs, 3)
        Joint angles [rad].
    reach : array of int8, shape (n, legs)
        Codes of `Reach`.
    cycle_time, stroke, speed : float
        Duration of a cycle [s]; stroke of the foot that goes farthest [m]; its speed past the body while cruising
        [m/s], on a straight walk the body's speed.
    body_height, swing_height, foot_distance : float
        Height of the body's origin, lift of the swinging feet, least distance between feet that was asked for [m].
    assumed : tuple of str
        What was not given and had to be assumed.
    """

    robot: Robot
    gait: Gait
    time: Floats
    body: Pose
    feet: Floats
    contacts: np.ndarray[Any, np.dtype[np.bool_]]
    angles: Floats
    reach: np.ndarray[Any, np.dtype[np.int8]]
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
        """Refuse arrays that don't fit together."""
        n, legs = self.time.size, self.robot.legs
        self.gait.require_legs(legs)
        shapes = {"time": (n,), "feet": (n, legs, 3), "contacts": (n, legs), "angles": (n, legs, 3), "reach": (n, legs)}
        for name, shape in shapes.items():
            if getattr(self, name).shape != shape:
                raise InputError(f"a motion's {name} has shape {getattr(self, name).shape}; expected {shape}")
        if self.body.batch_shape != (n,):
            raise InputError(f"a motion's body has batch axes {self.body.batch_shape}; expected {(n,)}")
        if n < 2 or not (np.diff(self.time) > 0).all():
            raise InputError("a motion needs two moments or more, each later than the one before")

    @cached_property
    def margin(self) -> Floats:
        """Static stability margin at every moment ``(n,)`` [m]."""
        return np.asarray(stability_margin(self.robot, self.angles, self.body, self.contacts))

    @cached_property
    def joint_speed(self) -> Floats:
        """Speed of every joint at every moment ``(n, legs, 3)`` [rad/s], by central differences."""
        speed: Floats = np.gradient(self.angles, self.time, axis=0)
        return speed

    @cached_property
    def feet_apart(self) -> Floats:
        """Distance between the two nearest feet at every moment ``(n,)`` [m]."""
        return feet_distance(self.feet)[0]

    @property
    def duration(self) -> float:
        """How long it takes [s]."""
        return float(self.time[-1])

    @property
    def steps(self) -> int:
        """How many times a foot is lifted."""
        return int((self.contacts[:-1] & ~self.contacts[1:]).sum())

    @cached_property
    def speed_ratio(self) -> Floats:
        """Largest speed of each joint over its servo's no-load speed ``(legs, 3)``; NaN where that is unknown."""
        limits = [[math.nan if s is None else s.no_load_speed or math.nan for s in leg] for leg in self.robot.servos]
        fastest: Floats = np.abs(self.joint_speed).max(0)
        return np.asarray(fastest / np.array(limits))

    @cached_property
    def problems(self) -> tuple[str, ...]:
        """What of it is not possible, a line for each kind with its first or worst moment; empty where all of it is."""
        return tuple(self._problems())

    @property
    def ok(self) -> bool:
        """Whether all of it is possible: reach without jumps, balance, distance between the feet, joint speeds."""
        return not self.problems

    def _problems(self) -> Iterator[str]:
        if (self.reach != Reach.OK).any():
            yield self._why_unreachable()
        yield from self._jumps()
        yield from self._tips_over()
        yield from self._feet_too_near()
        yield from self._too_fast()

    def _jumps(self) -> Iterator[str]:
        """Tell where a leg goes over to another way to reach its foot, as inverse kinematics may have it."""
        side = branches(self.robot, self.angles)
        change = np.abs(np.diff(self.angles, axis=0))
        change *= (side[1:] != side[:-1]).any(-1)[..., None]
        moment, leg, joint = np.unravel_index(int(np.argmax(change)), change.shape)
        if change[moment, leg, joint] > _JUMP:
            turn = math.degrees(change[moment, leg, joint])
            yield (
                f"jumps: at {self.time[moment]:.2f} s the {JOINTS[joint]} of {self.robot.leg_codes[leg]} would have to "
                f"turn {turn:.0f} deg at once, to another way to reach the same foot"
            )

    def _tips_over(self) -> Iterator[str]:
        worst = int(np.argmin(self.margin))
        at = f"tips over: at {self.time[worst]:.2f} s"
        if not self.contacts[worst].any():
            yield f"{at} no foot is on the ground"
        elif self.margin[worst] < 0:
            yield f"{at} the centre of mass is {-self.margin[worst] * 1000:.1f} mm outside the feet that are down"

    def _feet_too_near(self) -> Iterator[str]:
        distance, pair = feet_distance(self.feet)
        near = int(np.argmin(distance))
        if distance[near] < self.foot_distance - 1e-9:
            legs = " and ".join(self.robot.leg_codes[i] for i in pair[near])
            yield (
                f"feet too near: at {self.time[near]:.2f} s {legs} are {distance[near] * 1000:.1f} mm apart, "
                f"at least {self.foot_distance * 1000:.1f} mm are asked for"
            )

    def _too_fast(self) -> Iterator[str]:
        ratio = np.nan_to_num(self.speed_ratio, nan=0.0)
        leg, joint = np.unravel_index(int(np.argmax(ratio)), ratio.shape)
        servo = self.robot.servos[leg][joint]
        if ratio[leg, joint] > 1 and servo is not None and servo.no_load_speed is not None:
            needed = math.degrees(ratio[leg, joint] * servo.no_load_speed)
            yield (
                f"too fast: the {JOINTS[joint]} of {self.robot.leg_codes[leg]} would have to turn at "
                f"{needed:.0f} deg/s, its servo {servo.name} does {math.degrees(servo.no_load_speed):.0f} "
                f"without load; a cycle of {self.cycle_time * ratio[leg, joint]:.2f} s or longer works"
            )

    def _why_unreachable(self) -> str:
        failing = self.reach != Reach.OK
        reached = self.body @ forward_kinematics(self.robot, self.angles)[..., 3, :]
        miss = np.linalg.norm(reached - self.feet, axis=-1)
        moment, leg = np.unravel_index(int(np.argmax(np.where(failing, miss, -1.0))), miss.shape)
        solution = IKSolution(
            robot=self.robot,
            feet=self.feet[moment],
            body=self.body[int(moment)],
            knee="up",
            angles=self.angles[moment],
            reach=np.where(np.arange(self.robot.legs) == leg, self.reach[moment], Reach.OK),
        )
        return f"out of reach: at {self.time[moment]:.2f} s {solution.explain()}"
