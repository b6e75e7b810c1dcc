"""What every joint bears over a whole motion: torque, speed, power, against its servo."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.motion import Motion
from tarsus.kinematics.mass import total_mass
from tarsus.load.contact import GRAVITY, upward
from tarsus.load.inverse_dynamics import motion_torques
from tarsus.load.payload import Payload, as_payload
from tarsus.robot.robot import JOINTS, Robot
from tarsus.robot.servo import Servo

__all__ = ["JointLoads", "at_supply", "joint_loads", "utilisation"]

Floats = np.ndarray[Any, np.dtype[np.float64]]

# What rounding may add to a margin [m]: a load on the very edge of the feet's polygon is in balance.
_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False, kw_only=True)
class JointLoads:
    """What the joints bear over a motion. Arrays ``(legs, 3)`` are of coxa, femur and tibia.

    Attributes
    ----------
    robot : Robot
        Who moves.
    motion : Motion
        How.
    payload : Payload
        What it carries.
    torques : array, shape (n, legs, 3)
        What the servos must exert [N m].
    forces : array, shape (n, legs, 3)
        Ground on foot, in G [N].
    margin : array, shape (n,)
        How far inside the polygon of the feet the load acts [m]; negative where the robot tips.
    gravity : tuple of float
        Gravity in G [m/s^2].
    inertial : bool
        Whether the inertia of legs and body is in it.
    supply : float or None
        Voltage that the servos get [V]; None for those at which their figures hold.
    assumed : tuple of str
        What was not given and had to be assumed.
    """

    robot: Robot
    motion: Motion
    payload: Payload
    torques: Floats
    forces: Floats
    margin: Floats
    gravity: tuple[float, ...]
    inertial: bool
    supply: float | None = None
    assumed: tuple[str, ...] = field(default=())

    @property
    def conditions(self) -> dict[str, Any]:
        """What `joint_loads` was told besides robot, motion and payload: to work out others under the same."""
        return {"gravity": self.gravity, "inertial": self.inertial, "supply": self.supply}

    @property
    def balanced(self) -> bool:
        """Whether the robot stays on its feet at every moment."""
        return bool((self.margin >= -_ROUNDING).all())

    @property
    def speeds(self) -> Floats:
        """Speed of every joint ``(n, legs, 3)`` [rad/s]."""
        return self.motion.joint_speed

    @cached_property
    def peak(self) -> Floats:
        """Largest torque of each joint ``(legs, 3)`` [N m]."""
        return _floats(np.abs(self.torques).max(0))

    @cached_property
    def peak_sample(self) -> np.ndarray[Any, np.dtype[np.int64]]:
        """Sample at which each joint bears most ``(legs, 3)``."""
        return np.asarray(np.abs(self.torques).argmax(0))

    @cached_property
    def rms(self) -> Floats:
        """Root mean square of each joint's torque over the motion ``(legs, 3)`` [N m]: what heats its motor."""
        mean = np.trapezoid(self.torques**2, self.motion.time, axis=0) / self.motion.duration
        return _floats(np.sqrt(mean))

    @cached_property
    def peak_speed(self) -> Floats:
        """Largest speed of each joint ``(legs, 3)`` [rad/s]."""
        return _floats(np.abs(self.speeds).max(0))

    @cached_property
    def power(self) -> Floats:
        """Mechanical power that each joint gives ``(n, legs, 3)`` [W]; negative where it is driven."""
        return _floats(self.torques * self.speeds)

    @cached_property
    def energy(self) -> float:
        """Mechanical work of all joints, without getting any back from those that are driven [J]."""
        given = np.maximum(self.power, 0).sum((1, 2))
        return float(np.trapezoid(given, self.motion.time))

    @property
    def distance(self) -> float:
        """How far the body's origin went over the ground [m]."""
        steps = np.diff(self.motion.body.position[:, :2], axis=0)
        return float(np.hypot(steps[:, 0], steps[:, 1]).sum())

    @property
    def weight(self) -> float:
        """Weight of robot and payload [N]."""
        return (float(total_mass(self.robot)) + self.payload.mass) * upward(self.gravity)[0]

    @property
    def cost_of_transport(self) -> float:
        """Mechanical energy over weight and distance; infinite where the body doesn't get anywhere.

        G. Gabrielli and Th. von Karman, "What price speed?", Mechanical Engineering 72 (1950).
        """
        return self.energy / (self.weight * self.distance) if self.distance > 0 else float("inf")

    @cached_property
    def stall_torque(self) -> Floats:
        """Stall torque of each joint's servo at its supply ``(legs, 3)`` [N m]; NaN where no servo is known."""
        return self._figures[..., 0]

    @cached_property
    def no_load_speed(self) -> Floats:
        """Speed without load of each joint's servo at its supply ``(legs, 3)`` [rad/s]; NaN where unknown."""
        return self._figures[..., 1]

    @cached_property
    def _figures(self) -> Floats:
        return np.array([[at_supply(servo, self.supply) for servo in leg] for leg in self.robot.servos])

    @cached_property
    def factor(self) -> Floats:
        """Stall torque over peak torque ``(legs, 3)``; NaN where no servo is known, infinite without load."""
        with np.errstate(divide="ignore"):
            return _floats(self.stall_torque / self.peak)

    @cached_property
    def utilisation(self) -> Floats:
        """Share of the servo's torque-speed line that each joint uses at every moment ``(n, legs, 3)``: `utilisation`.

        NaN where a figure is unknown.
        """
        return utilisation(self.torques, self.speeds, self.stall_torque, self.no_load_speed)

    def cause(self, leg: int, joint: int) -> str:
        """Say when and why a joint bears most.

        Parameters
        ----------
        leg, joint : int
            Which joint.
        """
        sample = int(self.peak_sample[leg, joint])
        codes = self.robot.leg_codes
        down = [code for code, contact in zip(codes, self.motion.contacts[sample], strict=True) if contact]
        moment = f"at {self.motion.time[sample]:.2f} s"
        if not self.motion.contacts[sample, leg]:
            return f"{moment}, swinging"
        share = float(self.forces[sample, leg] @ upward(self.gravity)[1][0]) / self.weight
        return f"{moment}, standing on {' '.join(down)}, {share:.0%} of the weight on {codes[leg]}"

    def worst(self, joint: int) -> int:
        """Return the leg whose joint of that kind bears most.

        Parameters
        ----------
        joint : int
            0 coxa, 1 femur, 2 tibia.
        """
        return int(self.peak[:, joint].argmax())

    def to_dict(self) -> dict[str, Any]:
        """Return what each joint bears, as plain numbers with units in their keys."""
        rows = []
        for leg, code in enumerate(self.robot.leg_codes):
            for joint, name in enumerate(JOINTS):
                rows.append(
                    {
                        "leg": code,
                        "joint": name,
                        "servo": None if (servo := self.robot.servos[leg][joint]) is None else servo.name,
                        "peak_nm": float(self.peak[leg, joint]),
                        "peak_at_s": float(self.motion.time[self.peak_sample[leg, joint]]),
                        "peak_cause": self.cause(leg, joint),
                        "rms_nm": float(self.rms[leg, joint]),
                        "peak_speed_rad_s": float(self.peak_speed[leg, joint]),
                        "peak_power_w": float(self.power[:, leg, joint].max()),
                        "stall_nm": _number(self.stall_torque[leg, joint]),
                        "factor": _number(self.factor[leg, joint]),
                        "utilisation": _number(self.utilisation[:, leg, joint].max()),
                    }
                )
        return {
            "robot": self.robot.name,
            "payload_kg": self.payload.mass,
            "payload_at_mm": [1000 * v for v in self.payload.position],
            "gravity_m_s2": list(self.gravity),
            "inertial": self.inertial,
            "supply_v": self.supply,
            "weight_n": self.weight,
            "distance_m": self.distance,
            "energy_j": self.energy,
            "cost_of_transport": _number(self.cost_of_transport),
            "balanced": self.balanced,
            "least_margin_mm": _number(float(self.margin.min()) * 1000),
            "assumed": list(self.assumed),
            "joints": rows,
        }


def _floats(values: Any) -> Floats:
    return np.asarray(values, dtype=np.float64)


def _number(value: float) -> float | None:
    """Return a number, or None for what JSON has no word for."""
    return float(value) if np.isfinite(value) else None


def at_supply(servo: Servo | None, supply: float | None) -> tuple[float, float]:
    """Return a servo's stall torque [N m] and its speed without load [rad/s]; NaN where unknown.

    Parameters
    ----------
    servo : Servo or None
        The servo.
    supply : float or None
        Voltage that it gets [V]: both figures are in proportion to it, as a motor's with brushes are, as far as it
        is known at which voltage they hold. None for the figures as they are.
    """

    def one(value: float | None, at: float | None) -> float:
        if value is None:
            return math.nan
        return value * supply / at if supply and at else value

    if servo is None:
        return math.nan, math.nan
    return one(servo.stall_torque, servo.torque_at), one(servo.no_load_speed, servo.speed_at)


def utilisation(torque: Floats, speed: Floats, stall_torque: Floats, no_load_speed: Floats) -> Floats:
    """Return the share of a servo's torque-speed line that a torque at a speed uses; above 1 it can't be had.

    A servo that drives gives at most ``stall (1 - speed / no-load speed)``: the shares of torque and speed add up. One
    that is driven, by the load or by another joint, gives its full torque.

    Parameters
    ----------
    torque, speed : array
        What is asked for [N m, rad/s]; signs count.
    stall_torque, no_load_speed : array
        The servo's [N m, rad/s].
    """
    driving = np.maximum(np.sign(torque) * speed, 0.0)
    return _floats(np.abs(torque) / stall_torque + driving / no_load_speed)


def joint_loads(
    robot: Robot,
    motion: Motion,
    *,
    payload: Payload | float = 0.0,
    gravity: Sequence[float] = GRAVITY,
    inertial: bool = True,
    supply: float | None = None,
) -> JointLoads:
    """Return what every joint bears over a motion.

    Parameters
    ----------
    robot : Robot
        Who moves; its masses must be known. It may differ from the motion's own robot in masses and servos.
    motion : Motion
        How it moves.
    payload : Payload or float
        What the body carries; a number is a mass at its origin [kg].
    gravity : sequence of float
        Gravity in G [m/s^2]; tilted, it is that of a slope.
    inertial : bool
        Whether the inertia of legs and body counts; if not, statics alone.
    supply : float, optional
        Voltage that the servos get [V]: their torque and speed are taken in proportion to it. Left out, their
        figures are taken as they are in the catalogue.

    Raises
    ------
    MissingDataError
        If the robot's masses are unknown.
    InputError
        If a value is not finite or out of its range, or the motion has another number of legs.
    """
    if robot.legs != motion.angles.shape[1]:
        raise InputError(f"the motion is of {motion.angles.shape[1]} legs, robot {robot.name!r} has {robot.legs}")
    if supply is not None and not 0 < supply < float("inf"):
        raise InputError(f"supply is {supply} V; it must be greater than 0 and finite")
    solved = motion_torques(robot, motion, payload=payload, gravity=gravity, inertial=inertial)
    return JointLoads(
        robot=robot,
        motion=motion,
        payload=as_payload(payload),
        torques=np.asarray(solved.torques),
        forces=np.asarray(solved.forces),
        margin=np.asarray(solved.margin),
        gravity=tuple(float(v) for v in gravity),
        inertial=inertial,
        supply=supply,
        assumed=(*motion.assumed, *solved.assumed, *_assumed(robot, motion, supply)),
    )


def _assumed(robot: Robot, motion: Motion, supply: float | None) -> Iterator[str]:
    """Say what a calculation of loads takes for granted."""
    missed = int((motion.reach != 0).any(-1).sum())
    if missed:
        yield f"in {missed} of {len(motion.time)} samples a foot is out of reach: its leg is as near as it gets"
    for servo in {servo.name: servo for leg in robot.servos for servo in leg if servo is not None}.values():
        if supply is None:
            at = "a voltage that is not known" if servo.torque_at is None else f"{servo.torque_at:g} V"
            yield f"{servo.name} at {at}, that of its stall torque"
            continue
        if servo.torque_at is None or (servo.no_load_speed is not None and servo.speed_at is None):
            yield f"{servo.name}: not known at which voltage its figures hold; taken as they are at {supply:g} V"
        if servo.supply is not None and not servo.supply[0] <= supply <= servo.supply[1]:
            yield f"{servo.name} is made for {servo.supply[0]:g} to {servo.supply[1]:g} V, and is given {supply:g} V"
    without = [
        f"{JOINTS[joint]} of {robot.leg_codes[leg]}"
        for leg, row in enumerate(robot.servos)
        for joint, servo in enumerate(row)
        if servo is None
    ]
    if without:
        which = "any joint" if len(without) == 3 * robot.legs else ", ".join(without)
        yield f"the robot file names no servo for {which}: not judged"
