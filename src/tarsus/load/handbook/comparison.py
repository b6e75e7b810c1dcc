"""The hand method and the statics side by side: where it is safe to size a servo by hand, and where it is not."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from tarsus.errors import UnknownNameError
from tarsus.gait.motion import Motion
from tarsus.load.handbook.lines import plain_number
from tarsus.load.handbook.method import Handbook
from tarsus.robot.robot import JOINTS

__all__ = ["SPEEDING", "STANDING", "SWINGING", "WALKING", "Comparison", "ComparisonRow"]

STANDING, WALKING, SPEEDING, SWINGING = "standing", "walking", "speeding up", "leg in the air"
_HEADER = ("case", "quantity", "unit", "hand", "hand x factor", "statics", "hand / statics", "leg", "at", "verdict")
_NOTHING = 1e-9  # torques below this are rounding [N m]
_FAR_TOO_MUCH = 2.0


@dataclass(frozen=True, kw_only=True)
class ComparisonRow:
    """One quantity by hand and by statics.

    Attributes
    ----------
    case : str
        ``"standing"``, ``"walking"``, ``"speeding up"`` or ``"leg in the air"``.
    quantity : str
        A joint, for its torque; or ``"load of a foot"``, ``"arm about the femur axis"``, ``"arm about the knee"``.
    unit : str
        ``"N m"``, ``"N"`` or ``"m"``.
    foot_target : float
        By the hand method, without a safety factor.
    statics : float
        The greatest that the statics give, without a sign.
    factor : float
        The safety factor; 1 where none applies.
    leg : str
        Which leg has that greatest.
    time : float or None
        When [s]; None while standing.
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
        """By the hand method, times the safety factor."""
        return self.hand * self.factor

    @property
    def ratio(self) -> float:
        """Hand method over statics; infinite where the statics give nothing."""
        return self.hand / self.statics if self.statics > _NOTHING else math.inf

    @property
    def reserve(self) -> float:
        """What is left of the safety factor: hand method times factor, over statics."""
        return self.ratio * self.factor

    @property
    def verdict(self) -> str:
        """Whether it is safe to go by the hand method."""
        if math.isinf(self.ratio):
            return "statics: nothing to bear"
        if self.ratio >= _FAR_TOO_MUCH:
            return "safe, far too much"
        if self.ratio >= 1:
            return "safe"
        return "safe by the factor only" if self.reserve >= 1 else "unsafe"


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """The hand method and the statics side by side.

    Attributes
    ----------
    foot_target : Handbook
        The hand calculation, its slips corrected.
    motion : Motion
        The walk that the statics were taken from.
    rows : tuple of ComparisonRow
        Torques.
    reasons : tuple of ComparisonRow
        What the torques come from: load of a foot, and its arms about femur axis and knee.
    acceleration : float
        With what the body speeds up, and brakes, in the rows that say so [m/s^2].
    margin : mapping
        For each case, how far inside the polygon of its feet the load stays [m]; negative: the robot tips, and the
        torques are those with which it begins to.
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
            Its case and quantity.

        Raises
        ------
        UnknownNameError
            If there is no such row.
        """
        rows = {f"{row.case}, {row.quantity}": row for row in (*self.rows, *self.reasons)}
        wanted = f"{case}, {quantity}"
        if wanted not in rows:
            raise UnknownNameError.of("row of the comparison", wanted, rows)
        return rows[wanted]

    def sentence(self, joint: str) -> str:
        """Say of a joint where the hand method is safe and where not, with the numbers.

        Parameters
        ----------
        joint : str
            ``"coxa"``, ``"femur"`` or ``"tibia"``.

        Raises
        ------
        UnknownNameError
            If there is no such joint.
        """
        if joint not in JOINTS:
            raise UnknownNameError.of("joint", joint, JOINTS)
        return _coxa_sentence(self) if joint == "coxa" else _carrying_sentence(self, joint)

    @property
    def sentences(self) -> tuple[str, ...]:
        """One sentence for each joint, and one for each case in which the robot tips."""
        tips = (
            f"{case}: the robot tips, the load is {-margin * 1000:.0f} mm outside its feet; what is given here is what "
            "it bears as it begins to."
            for case, margin in self.margin.items()
            if margin < 0
        )
        return (*(self.sentence(joint) for joint in JOINTS), *tips)

    def table(self, *, reasons: bool = False) -> tuple[tuple[str, ...], ...]:
        """Return torques, or what they come from, as rows of texts, a header first: for printing.

        Parameters
        ----------
        reasons : bool
            Whether loads and arms are wanted, not torques.
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


def _carrying_sentence(comparison: Comparison, joint: str) -> str:
    """Of the femur or the tibia: they carry the robot."""
    worst = min((r for r in comparison.rows if r.quantity == joint and r.case != SWINGING), key=lambda r: r.ratio)
    load = comparison.row(WALKING, "load of a foot")
    arm = comparison.row(WALKING, "arm about the femur axis" if joint == "femur" else "arm about the knee")
    factor = plain_number(worst.factor)
    ends = {
        "statics: nothing to bear": "there is nothing to bear",
        "unsafe": f"even {factor} times that is too little",
        "safe by the factor only": f"too little, and of the factor {factor} only {worst.reserve:.2f} is left",
        "safe": f"enough, and with the factor {factor} it is {worst.reserve:.1f} times as much",
        "safe, far too much": f"{worst.ratio:.1f} times as much as needed, {worst.reserve:.1f} times with the factor",
    }
    return (
        f"{joint}: by hand {worst.hand:.3f} N m where the statics have up to {worst.statics:.3f} N m "
        f"({worst.case}, {worst.leg}): {ends[worst.verdict]}. The hand method puts {load.hand:.1f} N at "
        f"{arm.hand * 1000:.0f} mm; walking, a foot bears up to {load.statics:.1f} N, up to "
        f"{arm.statics * 1000:.0f} mm out."
    )


def _coxa_sentence(comparison: Comparison) -> str:
    """Of the coxa: on the level it only pushes."""
    even, speeding = comparison.row(WALKING, "coxa"), comparison.row(SPEEDING, "coxa")
    return (
        f"coxa: on level ground at an even pace it holds {even.statics:.3f} N m; speeding up or braking with "
        f"{plain_number(comparison.acceleration)} m/s², shared by the standing feet, takes up to "
        f"{speeding.statics:.3f} N m ({speeding.leg}) where the hand method has {speeding.hand:.3f} N m: "
        f"{speeding.verdict}, {speeding.reserve:.2f} times as much with the factor {plain_number(speeding.factor)}. "
        "Friction between the feet that push against each other is in neither."
    )
