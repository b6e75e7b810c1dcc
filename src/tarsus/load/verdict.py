"""Verdict on each joint's servo: class of its safety factor, continuous load and speed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from tarsus.errors import InputError, UnknownNameError
from tarsus.load.loads import NO_LOAD, JointLoads
from tarsus.load.servo_limits import why_not_rated
from tarsus.representation import represented
from tarsus.robot.robot import JOINTS
from tarsus.robot.servo import Servo

if TYPE_CHECKING:
    from jaxtyping import Bool

__all__ = [
    "BURNOUT_FACTOR",
    "CLASSES",
    "CONTINUOUS_FRACTION",
    "RULES",
    "SAFETY_FACTOR",
    "JointVerdict",
    "Rule",
    "class_of",
    "joint_verdicts",
    "require_rule",
    "severity_of",
    "sufficient_joints",
]

Rule = Literal["factor", "continuous"]

RULES = ("factor", "continuous")
"""Sizing rules: a safety factor on the peak torque, or the manufacturer's limit of the continuous load."""

SAFETY_FACTOR = 3.0
"""Stall torque over peak torque recommended by source 004."""

CONTINUOUS_FRACTION = 1 / 5
"""Continuous load limit over stall torque, recommended by ROBOTIS for its AX-12A."""

BURNOUT_FACTOR = 1.5
"""Stall torque over peak torque below which servos stall or burn."""

CLASSES = ((1.0, "cannot stand"), (BURNOUT_FACTOR, "stalls or burns"), (SAFETY_FACTOR, "marginal"), (math.inf, "good"))
"""Classes of stall torque over peak torque: upper bound and name.

A marginal robot walks, but its servos run warm and have no reserve.
"""


def severity_of(name: str) -> Literal["good", "warning", "bad"]:
    """Return the severity of a class, which determines its colour in reports and in the studio.

    Parameters
    ----------
    name : str
        Name of a class in `CLASSES`, or ``"unknown"``.
    """
    if name in ("marginal", "unknown"):
        return "warning"
    return "good" if name == "good" else "bad"


def class_of(factor: float) -> str:
    """Return the name of a factor's class in `CLASSES`; ``"unknown"`` for NaN.

    Parameters
    ----------
    factor : float
        Stall torque over peak torque.
    """
    if math.isnan(factor):
        return "unknown"
    return next((name for bound, name in CLASSES if factor < bound), CLASSES[-1][1])


def require_rule(rule: str) -> None:
    """Check that a sizing rule is one of `RULES`.

    Parameters
    ----------
    rule : str
        Name of the rule.

    Raises
    ------
    UnknownNameError
        If the rule is unknown.
    """
    if rule not in RULES:
        raise UnknownNameError.of("rule", str(rule), RULES)


@represented()
@dataclass(frozen=True, kw_only=True)
class JointVerdict:
    """Verdict on one joint's servo.

    Attributes
    ----------
    leg, joint : str
        Short name of the leg, name of the joint.
    servo : Servo or None
        The servo; None if the robot file names none.
    peak, rms : float
        Peak and root mean square torque over the motion [N m].
    peak_speed : float
        Peak speed [rad/s].
    stall_torque, no_load_speed : float
        Stall torque and no-load speed at the supply voltage [N m, rad/s]; NaN if unknown.
    utilisation : float
        Largest utilisation of the servo's torque-speed line; NaN if unknown.
    cause : str
        When and why the joint has its peak torque.
    safety_factor : float
        Required stall torque over peak torque.
    supply : float or None
        Supply voltage [V]; None for that of the servo's ratings.
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
    supply: float | None = None

    @property
    def factor(self) -> float:
        """Safety factor: stall torque over peak torque; NaN if no servo is known."""
        return self.stall_torque / self.peak if self.peak > NO_LOAD else self.stall_torque * math.inf

    @property
    def class_name(self) -> str:
        """Name of the factor's class in `CLASSES`; ``"unknown"`` if no servo is known."""
        return class_of(self.factor)

    @property
    def thermal_ratio(self) -> float:
        """Root mean square torque over the continuous limit, 1/5 of the stall torque; NaN if unknown."""
        return self.rms / (CONTINUOUS_FRACTION * self.stall_torque)

    @property
    def strong_enough(self) -> bool:
        """Whether the factor is at least the required one."""
        return self.factor >= self.safety_factor

    @property
    def fast_enough(self) -> bool:
        """Whether torque and speed stay within the torque-speed line; False if the no-load speed is unknown."""
        return self.utilisation <= 1 and self.peak_speed <= self.no_load_speed

    @property
    def within_continuous_limit(self) -> bool:
        """Whether the root mean square torque is within the continuous limit."""
        return self.thermal_ratio <= 1

    def satisfies(self, rule: Rule) -> bool:
        """Return whether the servo satisfies a sizing rule, regardless of speed.

        Parameters
        ----------
        rule : {"factor", "continuous"}
            Safety factor, or continuous load limit.
        """
        return self.strong_enough if rule == "factor" else self.within_continuous_limit

    def is_sufficient(self, rule: Rule) -> bool:
        """Return whether the servo satisfies a sizing rule and is fast enough.

        Parameters
        ----------
        rule : {"factor", "continuous"}
            Safety factor, or continuous load limit.
        """
        return self.satisfies(rule) and self.fast_enough

    def text(self) -> str:
        """Describe the verdict: safety factor, shortfalls and unknown ratings."""
        unrated = "the robot file names no servo" if self.servo is None else why_not_rated(self.servo, self.supply)
        if unrated:
            return f"{unrated}; {self.safety_factor * self.peak:.2f} N m required"
        return f"{self._strength()}{self._speed()}{self._heat()}"

    def _strength(self) -> str:
        if self.strong_enough:
            return "no load" if math.isinf(self.factor) else f"safety factor {self.factor:.1f}"
        required = self.safety_factor * self.peak
        return (
            f"{self.class_name}: safety factor {self.factor:.2f}, {required - self.stall_torque:.2f} N m short of "
            f"factor {self.safety_factor:g}"
        )

    def _speed(self) -> str:
        name = self.servo.name if self.servo is not None else ""
        if math.isnan(self.no_load_speed):
            return f"; the no-load speed of {name} is unknown: set no_load_rad_s in the robot file"
        if self.peak_speed > self.no_load_speed:
            return f"; too slow by {math.degrees(self.peak_speed - self.no_load_speed):.0f} deg/s"
        if not self.fast_enough:
            return f"; too slow under load: {100 * self.utilisation:.0f} % of its torque-speed line"
        return ""

    def _heat(self) -> str:
        if self.within_continuous_limit:
            return ""
        return f"; runs warm: RMS torque {self.thermal_ratio:.1f} times its continuous limit (1/5 of stall)"


def sufficient_joints(
    loads: JointLoads, *, safety_factor: float = SAFETY_FACTOR, rule: Rule = "factor"
) -> Bool[np.ndarray, "legs 3"]:
    """Return for every joint whether its servo satisfies a sizing rule and is fast enough.

    As `JointVerdict.is_sufficient`, for all joints at once.

    Parameters
    ----------
    loads : JointLoads
        Joint loads.
    safety_factor : float
        Required stall torque over peak torque.
    rule : {"factor", "continuous"}
        Safety factor, or continuous load limit.
    """
    fast = (loads.utilisation.max(0) <= 1) & (loads.peak_speed <= loads.no_load_speed)
    if rule == "factor":
        return np.asarray((loads.factor >= safety_factor) & fast)
    return np.asarray((loads.rms <= CONTINUOUS_FRACTION * loads.stall_torque) & fast)


def joint_verdicts(loads: JointLoads, *, safety_factor: float = SAFETY_FACTOR) -> tuple[JointVerdict, ...]:
    """Return a verdict for every joint, leg by leg.

    Parameters
    ----------
    loads : JointLoads
        Joint loads.
    safety_factor : float
        Required stall torque over peak torque.

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
            supply=loads.supply,
        )
        for leg, code in enumerate(loads.robot.leg_codes)
        for joint, name in enumerate(JOINTS)
    )
