"""Settings of a walk except its path and pace: robot, gait, heights and tilt, checked and completed by defaults."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np

from tarsus.arrays import Array, require_float
from tarsus.errors import InputError
from tarsus.gait.cycle import tilted_body
from tarsus.gait.gait import Gait
from tarsus.gait.spacing import default_foot_distance
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.solution import IKSolution
from tarsus.kinematics.stance import default_body_height, default_stance, default_swing_height
from tarsus.robot.estimates import MASS_KEYS, estimate_text
from tarsus.robot.joint_limits import UNKNOWN_SPEED, servo_speeds
from tarsus.robot.robot import Robot, require_robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["HEADING_FRAME", "WalkSetup", "require_number"]

HEADING_FRAME = "the heading frame (on the ground below the body)"
"""Name of the frame of feet that are given without a pose of the body in the ground plane."""

# Upper bound of lengths [m], so that their squares do not overflow.
_MOST = 1e3
# Units of arguments in messages, by name.
_LENGTHS = (
    *("stroke", "body_height", "swing_height", "foot_distance"),
    *("amplitude", "clear", "depth", "extent", "length", "rise", "size", "spacing", "tread", "wavelength", "width"),
)
_UNITS = {
    **dict.fromkeys(_LENGTHS, " m"),
    "speed": " m/s",
    "cycle_time": " s",
    "rate": " Hz",
}


def require_number(name: str, value: float, *, zero: bool, most: float = math.inf) -> float:
    """Return a finite number that is not negative as a float.

    Parameters
    ----------
    name : str
        Its name in messages, with its index if it is one of several.
    value : float
        The number.
    zero : bool
        Whether it may be 0.
    most : float
        Its upper bound.

    Raises
    ------
    InputError
        If it is not a number, or out of range.
    """
    number = require_float(name, value)
    unit = _UNITS.get(name.partition("[")[0], "")
    if not 0 <= number < math.inf:
        raise InputError(f"{name} is {number:g}{unit}; it must be a finite number, not negative")
    if number > most:
        raise InputError(f"{name} is {number:g}{unit}; it must be at most {most:g}{unit}")
    if number == 0 and not zero:
        raise InputError(f"{name} is 0; it must be greater than 0")
    return number


@dataclass(frozen=True)
class WalkSetup:
    """A robot and the settings of its walk, except path and pace.

    Attributes
    ----------
    robot : Robot
        A single robot.
    gait : Gait
        A gait for the robot's number of legs.
    rest : array, shape (legs, 3)
        Rest footholds in the body's heading frame on the ground [m].
    body_height, swing_height : float
        Height of the body's origin above the ground, swing height [m].
    body_tilt : (roll, pitch)
        Tilt of the body relative to the ground [rad].
    foot_distance : float
        Least distance between two feet [m].
    """

    robot: Robot
    gait: Gait
    rest: Float[np.ndarray, "legs 3"]
    body_height: float
    swing_height: float
    body_tilt: tuple[float, float]
    foot_distance: float

    @classmethod
    def of(
        cls,
        robot: Robot,
        gait: Gait | None,
        *,
        body_height: float | None,
        swing_height: float | None,
        body_tilt: Sequence[float] = (0.0, 0.0),
        foot_distance: float | None = None,
        stance_width: float | None = None,
    ) -> Self:
        """Check the settings given, and complete them with the robot's defaults.

        Parameters
        ----------
        robot, gait, body_height, swing_height, body_tilt, foot_distance
            As the attributes; None for the robot's default.
        stance_width : float, optional
            How much farther out than the default stance the feet rest [m]. Default: 0.

        Raises
        ------
        InputError
            If the robot is a batch, the gait is for another number of legs, or a number is out of range.
        UnreachableError
            If a leg does not reach the ground at that body height.
        """
        require_robot(robot)
        if robot.batch_shape:
            raise InputError(f"a walk is planned for a single robot, not for a batch {robot.batch_shape} of designs")
        gait = Gait.named(robot.gait.name, legs=robot.legs) if gait is None else gait
        if not isinstance(gait, Gait):
            raise InputError(f"gait is {gait!r}; it must be a Gait, like Gait.named('tripod')")
        gait.require_legs(robot.legs)
        robot = robot.item(())
        swing_height = (
            default_swing_height(robot)
            if swing_height is None
            else require_number("swing_height", swing_height, zero=True, most=_MOST)
        )
        distance = default_foot_distance(robot) if foot_distance is None else foot_distance
        height = default_body_height(robot) if body_height is None else require_float("body_height", body_height)
        if not abs(height) <= _MOST:
            raise InputError(f"body_height is {height} m; it must be a finite number, at most {_MOST:g} m")
        width = require_float("stance_width", stance_width or 0.0)
        stance = _widened(robot, default_stance(robot, height, swing_height=swing_height), width)
        return cls(
            robot=robot,
            gait=gait,
            rest=stance * np.array([1.0, 1.0, 0.0]),
            body_height=height,
            swing_height=swing_height,
            body_tilt=_tilt(body_tilt),
            foot_distance=require_number("foot_distance", distance, zero=True),
        )

    def assumed(self, body_height: float | None, swing_height: float | None) -> list[str]:
        """Return the assumptions about what neither the caller nor the robot file gives, a line for each.

        Parameters
        ----------
        body_height, swing_height : float, optional
            Arguments of the caller.
        """
        assumed = []
        if body_height is None and self.robot.gait.body_height is None:
            assumed.append(f"body height {self.body_height * 1000:.0f} mm: derived from femur and tibia")
        if swing_height is None and self.robot.gait.swing_height is None:
            assumed.append(f"swing height {self.swing_height * 1000:.0f} mm: a quarter of the body height")
        if any(speed is None for leg in servo_speeds(self.robot) for speed in leg):
            assumed.append(
                f"joint speed limit {math.degrees(UNKNOWN_SPEED):.0f} deg/s where the robot file gives no servo speed"
            )
        if not self.robot.has_masses:
            assumed.append(
                "the robot file gives no masses: the stability margin is that of the body's centre of mass, "
                "with massless links"
            )
        elif estimated := estimate_text(self.robot, MASS_KEYS):
            assumed.append(estimated)
        return assumed

    def solve(
        self, feet: Float[Array, "*#batch legs 3"], planar_pose: Float[Array, "*#batch 3"] | None = None
    ) -> IKSolution:
        """Return the inverse kinematics of feet relative to the ground.

        Parameters
        ----------
        feet : array, shape (..., legs, 3)
            Feet in G; without `planar_pose`, in the heading frame [m].
        planar_pose : array, shape (..., 3), optional
            Poses of the body in the ground plane: x [m], y [m] and yaw [rad].
        """
        pose = np.zeros(3) if planar_pose is None else planar_pose
        body = tilted_body(pose, body_height=np.asarray(self.body_height), body_tilt=self.body_tilt)
        return inverse_kinematics(self.robot, feet, body)


def _widened(robot: Robot, stance: Float[np.ndarray, "legs 3"], width: float) -> Float[np.ndarray, "legs 3"]:
    """Return the stance with every foot farther from its coxa axis by a width [m]."""
    if width == 0:
        return stance
    out = (stance - np.asarray(robot.mount_position))[:, :2]
    distance = np.hypot(*out.T)
    if not -distance.min() < width <= _MOST:
        raise InputError(
            f"stance_width is {width * 1000:g} mm; it must be a finite number, at most {_MOST:g} m, and more than "
            f"{-distance.min() * 1000:.1f} mm, where a foot is at its coxa axis"
        )
    wider = stance.copy()
    wider[:, :2] += width * out / np.maximum(distance, 1e-9)[:, None]
    return wider


def _tilt(body_tilt: Sequence[float]) -> tuple[float, float]:
    try:
        roll, pitch = (float(v) for v in body_tilt)
    except (TypeError, ValueError):
        raise InputError(f"body_tilt is {body_tilt!r}; it must be two numbers, roll and pitch in rad") from None
    if not (abs(roll) < math.pi / 2 and abs(pitch) < math.pi / 2):
        degrees = f"({math.degrees(roll):g}, {math.degrees(pitch):g}) deg"
        raise InputError(f"body_tilt is {degrees}; roll and pitch must be between -90 and 90 deg")
    return roll, pitch
