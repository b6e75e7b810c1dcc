"""Joint loads over a motion: torque, speed and power, compared with the servos."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.errors import InputError
from tarsus.gait.motion import Motion
from tarsus.kinematics.mass import total_mass
from tarsus.load.assumptions import load_assumptions
from tarsus.load.contact import GRAVITY, upward
from tarsus.load.inverse_dynamics import motion_torques
from tarsus.load.payload import Payload, as_payload
from tarsus.load.servo_limits import at_supply, utilisation
from tarsus.representation import Rows, represented
from tarsus.robot.robot import JOINTS, Robot, require_leg_number, require_robot

if TYPE_CHECKING:
    from jaxtyping import Float, Int

__all__ = ["NO_LOAD", "JointLoads", "joint_loads"]

NO_LOAD = 1e-9
"""Peak torque up to which a joint bears no load [N m]: rounding of the statics."""

# Rounding of a margin [m]: a load on the edge of the support polygon is in equilibrium.
_ROUNDING = 1e-9


@represented("robot", "payload", "balanced", "peak", "rms", "peak_speed", "margin", "inertial", "supply", "assumed")
@dataclass(frozen=True, eq=False, kw_only=True)
class JointLoads:
    """Joint loads over a motion; arrays ``(legs, 3)`` hold coxa, femur and tibia.

    Attributes
    ----------
    robot : Robot
        The robot.
    motion : Motion
        The motion.
    payload : Payload
        Payload on the body.
    torques : array, shape (n, legs, 3)
        Joint torques [N m].
    forces : array, shape (n, legs, 3)
        Ground on foot, in G [N].
    margin : array, shape (n,)
        Distance of the load from the nearest edge of the support polygon [m]; negative where the robot tips.
    gravity : tuple of float
        Gravity in G [m/s^2].
    inertial : bool
        Whether inertial forces are included.
    supply : float or None
        Supply voltage of the servos [V]; None for the voltage at which their ratings hold.
    assumed : tuple of str
        Assumptions made.
    """

    robot: Robot
    motion: Motion
    payload: Payload
    torques: Float[np.ndarray, "n legs 3"]
    forces: Float[np.ndarray, "n legs 3"]
    margin: Float[np.ndarray, "n"]
    gravity: tuple[float, ...]
    inertial: bool
    supply: float | None = None
    assumed: tuple[str, ...] = field(default=())

    def _rows(self) -> Rows:
        """Return the greatest and the root mean square torque of each joint, a row for each leg."""
        return [
            {"leg": name}
            | {f"{joint} peak [N m]": f"{self.peak[leg, i]:.2f}" for i, joint in enumerate(JOINTS)}
            | {f"{joint} rms [N m]": f"{self.rms[leg, i]:.2f}" for i, joint in enumerate(JOINTS)}
            for leg, name in enumerate(self.robot.leg_names)
        ]

    @property
    def conditions(self) -> dict[str, Any]:
        """Keyword arguments of `joint_loads` besides the payload, to compute other loads under the same conditions."""
        return {"gravity": self.gravity, "inertial": self.inertial, "supply": self.supply}

    @property
    def balanced(self) -> bool:
        """Whether the robot is in equilibrium throughout the motion."""
        return bool((self.margin >= -_ROUNDING).all())

    @property
    def speeds(self) -> Float[np.ndarray, "n legs 3"]:
        """Joint velocities ``(n, legs, 3)`` [rad/s]."""
        return self.motion.joint_speed

    @cached_property
    def peak(self) -> Float[np.ndarray, "legs 3"]:
        """Largest torque of each joint ``(legs, 3)`` [N m]."""
        return _floats(np.abs(self.torques).max(0))

    @cached_property
    def peak_sample(self) -> Int[np.ndarray, "legs 3"]:
        """Index of the sample with each joint's peak torque ``(legs, 3)``."""
        return np.asarray(np.abs(self.torques).argmax(0))

    @cached_property
    def rms(self) -> Float[np.ndarray, "legs 3"]:
        """Root mean square torque of each joint over the motion ``(legs, 3)`` [N m]; it determines motor heating."""
        mean = np.trapezoid(self.torques**2, self.motion.time, axis=0) / self.motion.duration
        return _floats(np.sqrt(mean))

    @cached_property
    def peak_speed(self) -> Float[np.ndarray, "legs 3"]:
        """Largest speed of each joint ``(legs, 3)`` [rad/s]."""
        return _floats(np.abs(self.speeds).max(0))

    @cached_property
    def power(self) -> Float[np.ndarray, "n legs 3"]:
        """Mechanical power of each joint ``(n, legs, 3)`` [W]; negative where the load drives the joint."""
        return _floats(self.torques * self.speeds)

    @cached_property
    def energy(self) -> float:
        """Positive mechanical work of all joints [J]; negative work is not recovered."""
        positive_power = np.maximum(self.power, 0).sum((1, 2))
        return float(np.trapezoid(positive_power, self.motion.time))

    @property
    def distance(self) -> float:
        """Length of the path of the body's origin over the ground, without its body shift [m]."""
        path = self.motion.body.position[:, :2]
        if self.motion.gait.body_shift:
            return self._distance_of_arcs(path)
        return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())

    def _distance_of_arcs(self, path: Float[np.ndarray, "n 2"]) -> float:
        """Return the length of arcs, of at most half a turn, through a path that begins and ends without shift."""
        turned = np.unwrap(np.asarray(self.motion.body.rpy)[:, 2])
        turned = np.abs(turned - turned[0])
        arcs = max(math.ceil(turned[-1] / math.pi - 1e-9), 1)
        ends = [0, *(int(np.argmax(turned >= turned[-1] * k / arcs)) for k in range(1, arcs)), -1]
        chords = np.linalg.norm(np.diff(path[ends], axis=0), axis=1)
        return float(chords.sum() / np.sinc(turned[-1] / arcs / (2 * math.pi)))

    @property
    def weight(self) -> float:
        """Weight of robot and payload [N]."""
        return (float(total_mass(self.robot)) + self.payload.mass) * upward(self.gravity)[0]

    @property
    def cost_of_transport(self) -> float:
        """Mechanical energy over weight times distance; infinite without any distance.

        G. Gabrielli and Th. von Karman, "What price speed?", Mechanical Engineering 72 (1950).
        """
        return self.energy / (self.weight * self.distance) if self.distance > 0 else float("inf")

    @cached_property
    def stall_torque(self) -> Float[np.ndarray, "legs 3"]:
        """Stall torque of each servo at the supply voltage ``(legs, 3)`` [N m]; NaN where no servo is known."""
        return self._ratings[..., 0]

    @cached_property
    def no_load_speed(self) -> Float[np.ndarray, "legs 3"]:
        """No-load speed of each servo at the supply voltage ``(legs, 3)`` [rad/s]; NaN where unknown."""
        return self._ratings[..., 1]

    @cached_property
    def _ratings(self) -> Float[np.ndarray, "... legs 3 n"]:
        return np.array([[at_supply(servo, self.supply) for servo in leg] for leg in self.robot.servos])

    @cached_property
    def factor(self) -> Float[np.ndarray, "legs 3"]:
        """Safety factor: stall torque over peak torque ``(legs, 3)``; NaN without a servo, infinite without load."""
        # A peak torque below rounding is no load: its factor would be 1e33.
        loaded = self.peak > NO_LOAD
        factor = self.stall_torque / np.where(loaded, self.peak, 1.0)
        return _floats(np.where(loaded, factor, self.stall_torque * np.inf))

    @cached_property
    def utilisation(self) -> Float[np.ndarray, "n legs 3"]:
        """Utilisation of each servo's torque-speed line ``(n, legs, 3)``; NaN where a rating is unknown."""
        return utilisation(self.torques, self.speeds, self.stall_torque, self.no_load_speed)

    def cause(self, leg: int, joint: int) -> str:
        """Describe when and why a joint has its peak torque.

        Parameters
        ----------
        leg, joint : int
            Indices of the joint.

        Raises
        ------
        InputError
            If there is no such joint.
        """
        require_leg_number("cause", leg, self.robot.legs)
        _require_joint("cause", joint)
        sample = int(self.peak_sample[leg, joint])
        codes = self.robot.leg_codes
        standing = [code for code, contact in zip(codes, self.motion.contacts[sample], strict=True) if contact]
        time = f"at {self.motion.time[sample]:.2f} s"
        if not self.motion.contacts[sample, leg]:
            return f"{time}, swing"
        fraction = float(self.forces[sample, leg] @ upward(self.gravity)[1][0]) / self.weight
        return f"{time}, stance of {' '.join(standing)}, {100 * fraction:.0f} % of the weight on {codes[leg]}"

    def worst(self, joint: int) -> int:
        """Return the leg with the largest peak torque in a joint.

        Parameters
        ----------
        joint : int
            0 coxa, 1 femur, 2 tibia.

        Raises
        ------
        InputError
            If there is no such joint.
        """
        _require_joint("worst", joint)
        return int(self.peak[:, joint].argmax())

    def to_dict(self) -> dict[str, Any]:
        """Return the loads as plain numbers, with units in the keys."""
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


def _floats(values: Any) -> Float[np.ndarray, "... legs 3"]:
    return np.asarray(values, dtype=np.float64)


def _number(value: float) -> float | None:
    """Return a number, or None if it is not finite: JSON has no NaN or infinity."""
    return float(value) if np.isfinite(value) else None


def _require_joint(name: str, joint: object) -> None:
    if joint not in range(len(JOINTS)):
        raise InputError(f"{name}: a leg has no joint {joint!r}; its joints are 0 coxa, 1 femur, 2 tibia")


def joint_loads(
    robot: Robot,
    motion: Motion,
    *,
    payload: Payload | float = 0.0,
    gravity: Sequence[float] = GRAVITY,
    inertial: bool = True,
    supply: float | None = None,
) -> JointLoads:
    """Return the joint loads over a motion.

    Parameters
    ----------
    robot : Robot
        The robot; its masses must be known. It may differ from the motion's robot in masses and servos.
    motion : Motion
        The motion.
    payload : Payload or float
        Payload on the body; a number is a mass at the body's origin [kg].
    gravity : sequence of float
        Gravity in G [m/s^2]; tilted, it represents a slope.
    inertial : bool
        Whether inertial forces are included; without them the torques are quasi-static.
    supply : float, optional
        Supply voltage of the servos [V]; their torque and speed scale with it. Default: their rated values.

    Raises
    ------
    MissingDataError
        If the robot's masses are unknown.
    InputError
        If a value is not finite or out of range, or the motion has another number of legs.
    """
    require_robot(robot)
    if robot.legs != motion.angles.shape[1]:
        raise InputError(f"the motion has {motion.angles.shape[1]} legs, robot {robot.name!r} has {robot.legs}")
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
        assumed=(*motion.assumed, *solved.assumed, *load_assumptions(robot, motion, supply)),
    )
