"""Comparison of the hand method with statics: where sizing a servo by hand is safe, and where it is not."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from tarsus.errors import UnknownNameError
from tarsus.gait.motion import Motion
from tarsus.load.handbook.lines import plain_number
from tarsus.load.handbook.method import Handbook
from tarsus.representation import represented
from tarsus.robot.robot import JOINTS

__all__ = ["ACCELERATING", "STANDING", "SWINGING", "WALKING", "Comparison", "ComparisonRow"]

STANDING, WALKING, ACCELERATING, SWINGING = "standing", "walking", "accelerating", "leg in swing"
_HEADER = ("case", "quantity", "unit", "hand", "hand x factor", "statics", "hand / statics", "leg", "at", "verdict")
_NO_LOAD = 1e-9  # torques below this are rounding [N m]
_OVERSIZED = 2.0


@represented()
@dataclass(frozen=True, kw_only=True)
class ComparisonRow:
    """One quantity by the hand method and by statics.

    Attributes
    ----------
    case : str
        ``"standing"``, ``"walking"``, ``"accelerating"`` or ``"leg in swing"``.
    quantity : str
        A joint, for its torque; or ``"foot load"``, ``"lever arm about the femur axis"``,
        ``"lever arm about the knee"``.
    unit : str
        ``"N m"``, ``"N"`` or ``"m"``.
    hand : float
        Value of the hand method, without a safety factor.
    statics : float
        Largest absolute value of the statics.
    factor : float
        Safety factor; 1 where none applies.
    leg : str
        Leg with the largest value.
    time : float or None
        Time of the largest value [s]; None while standing.
    """

    case: str
    quantity: str
    unit: str
    hand: float
    statics: float
    factor: float
    leg: str
    time: float | None

    @property
    def with_factor(self) -> float:
        """Value of the hand method times the safety factor."""
        return self.hand * self.factor

    @property
    def ratio(self) -> float:
        """Hand method over statics; infinite if the statics give no load."""
        return self.hand / self.statics if self.statics > _NO_LOAD else math.inf

    @property
    def reserve(self) -> float:
        """Effective safety factor: hand method times factor over statics."""
        return self.ratio * self.factor

    @property
    def verdict(self) -> str:
        """Whether sizing by the hand method is safe."""
        if math.isinf(self.ratio):
            return "no load in statics"
        if self.ratio >= _OVERSIZED:
            return "safe, oversized"
        if self.ratio >= 1:
            return "safe"
        return "safe with the factor only" if self.reserve >= 1 else "unsafe"


@represented()
@dataclass(frozen=True, kw_only=True)
class Comparison:
    """Comparison of the hand method with statics.

    Attributes
    ----------
    hand : Handbook
        The hand calculation, with the errors of the source corrected.
    motion : Motion
        The walk evaluated by statics.
    rows : tuple of ComparisonRow
        Joint torques.
    reasons : tuple of ComparisonRow
        Causes of the torques: foot load, and its lever arms about the femur axis and the knee.
    acceleration : float
        Acceleration and deceleration of the body in the case ``"accelerating"`` [m/s^2].
    margin : mapping
        For each case, smallest distance of the load from the nearest edge of the support polygon [m]. Negative: the
        robot tips, and the torques are those at the onset of tipping.
    """

    hand: Handbook
    motion: Motion
    rows: tuple[ComparisonRow, ...]
    reasons: tuple[ComparisonRow, ...]
    acceleration: float
    margin: Mapping[str, float]

    def row(self, case: str, quantity: str) -> ComparisonRow:
        """Return a row of `rows` or `reasons`.

        Parameters
        ----------
        case, quantity : str
            Case and quantity of the row.

        Raises
        ------
        UnknownNameError
            If the row does not exist.
        """
        rows = {f"{row.case}, {row.quantity}": row for row in (*self.rows, *self.reasons)}
        name = f"{case}, {quantity}"
        if name not in rows:
            raise UnknownNameError.of("row of the comparison", name, rows)
        return rows[name]

    def sentence(self, joint: str) -> str:
        """Summarise the comparison for a joint in a sentence with numbers.

        Parameters
        ----------
        joint : str
            ``"coxa"``, ``"femur"`` or ``"tibia"``.

        Raises
        ------
        UnknownNameError
            If the joint is unknown.
        """
        if joint not in JOINTS:
            raise UnknownNameError.of("joint", joint, JOINTS)
        return _coxa_sentence(self) if joint == "coxa" else _supporting_joint_sentence(self, joint)

    @property
    def sentences(self) -> tuple[str, ...]:
        """One sentence for each joint, and one for each case with a tipping robot."""
        tipping = (
            f"{case}: the robot tips, with the load {-margin * 1000:.0f} mm outside its support polygon; the torques "
            "are those at the onset of tipping."
            for case, margin in self.margin.items()
            if margin < 0
        )
        return (*(self.sentence(joint) for joint in JOINTS), *tipping)

    def table(self, *, reasons: bool = False) -> tuple[tuple[str, ...], ...]:
        """Return torques, or foot loads and lever arms, as rows of text with a header.

        Parameters
        ----------
        reasons : bool
            Whether to return foot loads and lever arms instead of torques.
        """
        return (_HEADER, *(_texts(row) for row in (self.reasons if reasons else self.rows)))


def _texts(row: ComparisonRow) -> tuple[str, ...]:
    digits = 1 if row.unit == "N" else 3
    return (
        row.case,
        row.quantity,
        row.unit,
        f"{row.hand:.{digits}f}",
        "" if row.unit != "N m" else f"{row.with_factor:.{digits}f}",
        f"{row.statics:.{digits}f}",
        "" if math.isinf(row.ratio) else f"{row.ratio:.2f}",
        "" if math.isinf(row.ratio) else row.leg,
        "" if row.time is None or math.isinf(row.ratio) else f"{row.time:.2f} s",
        row.verdict if row.unit == "N m" else "",
    )


def _supporting_joint_sentence(comparison: Comparison, joint: str) -> str:
    """Return the sentence for the femur or the tibia, which support the robot."""
    worst = min((r for r in comparison.rows if r.quantity == joint and r.case != SWINGING), key=lambda r: r.ratio)
    load = comparison.row(WALKING, "foot load")
    arm = comparison.row(WALKING, f"lever arm about the {'femur axis' if joint == 'femur' else 'knee'}")
    factor = plain_number(worst.factor)
    conclusions = {
        "no load in statics": "no load",
        "unsafe": f"too small even with the factor {factor}",
        "safe with the factor only": f"too small; of the factor {factor}, {worst.reserve:.2f} remains",
        "safe": f"sufficient, with an effective safety factor of {worst.reserve:.1f}",
        "safe, oversized": f"{worst.ratio:.1f} times the required torque, {worst.reserve:.1f} times with the factor",
    }
    return (
        f"{joint}: {worst.hand:.3f} N m by the hand method, up to {worst.statics:.3f} N m by statics "
        f"({worst.case}, {worst.leg}): {conclusions[worst.verdict]}. The hand method assumes {load.hand:.1f} N at a "
        f"lever arm of {arm.hand * 1000:.0f} mm; while walking, the foot load reaches {load.statics:.1f} N and the "
        f"lever arm {arm.statics * 1000:.0f} mm."
    )


def _coxa_sentence(comparison: Comparison) -> str:
    """Return the sentence for the coxa, which only pushes on level ground."""
    constant_speed, accelerating = comparison.row(WALKING, "coxa"), comparison.row(ACCELERATING, "coxa")
    return (
        f"coxa: {constant_speed.statics:.3f} N m by statics at constant speed on level ground; an acceleration of "
        f"{plain_number(comparison.acceleration)} m/s², distributed over the feet on the ground, requires up to "
        f"{accelerating.statics:.3f} N m ({accelerating.leg}), the hand method gives {accelerating.hand:.3f} N m: "
        f"{accelerating.verdict}, with an effective safety factor of {accelerating.reserve:.2f}. "
        "Neither includes friction forces of feet that push against each other."
    )
