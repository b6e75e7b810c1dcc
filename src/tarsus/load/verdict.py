"""Whether a joint's servo carries its load: the classes, and the maker's rule for lasting loads."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from tarsus.errors import InputError, UnknownNameError
from tarsus.load.loads import JointLoads
from tarsus.robot.robot import JOINTS
from tarsus.robot.servo import Servo

__all__ = [
    "BURNS_BELOW",
    "CLASSES",
    "CONTINUOUS_SHARE",
    "RULES",
    "SAFETY_FACTOR",
    "JointVerdict",
    "Rule",
    "class_of",
    "joint_verdicts",
    "require_rule",
]

Rule = Literal["factor", "continuous"]

RULES = ("factor", "continuous")
"""What a servo can be asked to keep: the safety factor on its peak, or the maker's rule for its lasting load."""

SAFETY_FACTOR = 3.0
"""Stall torque over peak torque that source 004 asks for."""

CONTINUOUS_SHARE = 1 / 5
"""Share of its stall torque that a servo bears lastingly: ROBOTIS' advice for its AX-12A."""

BURNS_BELOW = 1.5
"""Stall torque over peak torque below which servos stall, or burn in time."""

CLASSES = ((1.0, "cannot stand"), (BURNS_BELOW, "stalls or burns"), (SAFETY_FACTOR, "marginal"), (math.inf, "good"))
"""Names of the classes of stall torque over peak torque, each with the bound that it stays below.

A marginal robot walks, warm and without reserve.
"""


def class_of(factor: float) -> str:
    """Return the name of a factor's class: see `CLASSES`; ``"unknown"`` for NaN.

    Parameters
    ----------
    factor : float
        Stall torque over peak torque.
    """
    if math.isnan(factor):
        return "unknown"
    return next((name for bound, name in CLASSES if factor < bound), CLASSES[-1][1])


def require_rule(rule: str) -> None:
    """Refuse a rule that is none of `RULES`.

    Parameters
    ----------
    rule : str
        Its name.

    Raises
    ------
    UnknownNameError
        If there is no such rule.
    """
    if rule not in RULES:
        raise UnknownNameError.of("rule", str(rule), RULES)


@dataclass(frozen=True, kw_only=True)
class JointVerdict:
    """Whether one joint's servo carries its load.

    Attributes
    ----------
    leg, joint : str
        Which joint.
    servo : Servo or None
        What turns it; None where the robot file names none.
    peak, rms : float
        Largest torque, and its root mean square over the motion [N m].
    peak_speed : float
        Largest speed [rad/s].
    stall_torque, no_load_speed : float
        The servo's at its supply [N m, rad/s]; NaN where unknown.
    utilisation : float
        Largest share of the servo's torque-speed line; NaN where unknown.
    cause : str
        When and why the joint bears most.
    safety_factor : float
        What stall torque over peak torque is asked for.
    """

    leg: str
    joint: str
    servo: Servo | None
    peak: float
    rms: float
    peak_speed: float
    stall_torque: float
    no_load_speed: float
    utilisation: float
    cause: str
    safety_factor: float

    @property
    def factor(self) -> float:
        """Stall torque over peak torque; NaN where no servo is known."""
        return self.stall_torque / self.peak if self.peak > 0 else self.stall_torque * math.inf

    @property
    def class_name(self) -> str:
        """Name of the factor's class: see `CLASSES`; ``"unknown"`` where no servo is known."""
        return class_of(self.factor)

    @property
    def thermal_ratio(self) -> float:
        """Root mean square torque over what the servo bears lastingly, 1/5 of its stall torque; NaN where unknown."""
        return self.rms / (CONTINUOUS_SHARE * self.stall_torque)

    @property
    def strong_enough(self) -> bool:
        """Whether the factor is what is asked for."""
        return self.factor >= self.safety_factor

    @property
    def fast_enough(self) -> bool:
        """Whether the torque-speed line covers every moment, driven ones included; False where the speed is unknown."""
        return self.utilisation <= 1 and self.peak_speed <= self.no_load_speed

    @property
    def lasting(self) -> bool:
        """Whether the maker's rule for lasting loads is kept."""
        return self.thermal_ratio <= 1

    def keeps(self, rule: Rule) -> bool:
        """Return whether a rule is kept, speed apart.

        Parameters
        ----------
        rule : {"factor", "continuous"}
            The safety factor, or the maker's rule for lasting loads.
        """
        return self.strong_enough if rule == "factor" else self.lasting

    def does(self, rule: Rule) -> bool:
        """Return whether the servo keeps a rule and is fast enough.

        Parameters
        ----------
        rule : {"factor", "continuous"}
            The safety factor, or the maker's rule for lasting loads.
        """
        return self.keeps(rule) and self.fast_enough

    def text(self) -> str:
        """Say whether it carries, by how much, and what is unknown."""
        if self.servo is None:
            return f"no servo is named in the robot file; {self.safety_factor * self.peak:.2f} N m are needed"
        return f"{self._strength()}{self._speed()}{self._heat()}"

    def _strength(self) -> str:
        if self.strong_enough:
            return "bears nothing" if math.isinf(self.factor) else f"carries with factor {self.factor:.1f}"
        needed = self.safety_factor * self.peak
        return (
            f"{self.class_name}: factor {self.factor:.2f}, too weak by {needed - self.stall_torque:.2f} N m "
            f"for factor {self.safety_factor:g}"
        )

    def _speed(self) -> str:
        name = self.servo.name if self.servo is not None else ""
        if math.isnan(self.no_load_speed):
            return f"; the speed of {name} is unknown: give its no_load_rad_s in the robot file"
        if self.peak_speed > self.no_load_speed:
            return f"; too slow by {math.degrees(self.peak_speed - self.no_load_speed):.0f} deg/s"
        if not self.fast_enough:
            return f"; too slow under load: torque and speed together are {self.utilisation:.2f} of what it gives"
        return ""

    def _heat(self) -> str:
        if self.lasting:
            return ""
        return f"; warm: its lasting load is {self.thermal_ratio:.1f} times a fifth of its stall torque"


def joint_verdicts(loads: JointLoads, *, safety_factor: float = SAFETY_FACTOR) -> tuple[JointVerdict, ...]:
    """Return a verdict for every joint, leg by leg.

    Parameters
    ----------
    loads : Loads
        What the joints bear.
    safety_factor : float
        What stall torque over peak torque is asked for.

    Raises
    ------
    InputError
        If the safety factor is not positive and finite.
    """
    if not 0 < safety_factor < math.inf:
        raise InputError(f"safety_factor is {safety_factor}; it must be greater than 0 and finite")
    return tuple(
        JointVerdict(
            leg=code,
            joint=name,
            servo=loads.robot.servos[leg][joint],
            peak=float(loads.peak[leg, joint]),
            rms=float(loads.rms[leg, joint]),
            peak_speed=float(loads.peak_speed[leg, joint]),
            stall_torque=float(loads.stall_torque[leg, joint]),
            no_load_speed=float(loads.no_load_speed[leg, joint]),
            utilisation=float(loads.utilisation[:, leg, joint].max()),
            cause=loads.cause(leg, joint),
            safety_factor=safety_factor,
        )
        for leg, code in enumerate(loads.robot.leg_codes)
        for joint, name in enumerate(JOINTS)
    )
