"""Source 003: inverse kinematics of a leg, and of the body."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tarsus.kinematics.pose import Pose
from tarsus.studio.sources.document import Document, Given, Number, Slip, Step
from tarsus.studio.sources.live import Live

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["DOCUMENT"]

_TURNED = "cos(theta) * cos(beta) - sin(theta) * sin(alpha) * sin(beta)"

_ROTATION = (
    ("cos(alpha) * cos(beta)", "-(cos(alpha) * sin(beta))", "sin(alpha)"),
    ("sin(theta) * sin(alpha) * cos(beta) + cos(theta) * sin(beta)", _TURNED, "-(sin(theta) * cos(alpha))"),
    (
        "-(cos(theta) * sin(alpha) * cos(beta)) + sin(theta) * sin(beta)",
        "cos(theta) * sin(alpha) * sin(beta) + sin(theta) * cos(beta)",
        "cos(theta) * cos(alpha)",
    ),
)


def _rotation(leg: Live) -> Float[np.ndarray, "3 3"]:
    """Return the rotation matrix roll times pitch times yaw, which turns by the yaw first."""
    roll, pitch, yaw = map(float, leg.rpy)
    return np.asarray((Pose.from_rpy(roll=roll) @ Pose.from_rpy(pitch=pitch) @ Pose.from_rpy(yaw=yaw)).rotation)


def _entry(row: int, column: int) -> Number:
    return lambda leg: float(_rotation(leg)[row, column])


def _turned(row: int) -> Number:
    return lambda leg: float(_rotation(leg)[row] @ leg.mount)


DOCUMENT = Document(
    number="003",
    title="Modeling and Control of Robots – Project 2",
    about="Team 21: E. Veluchami, K. R. Nagaraj, S. S. Kumar, S. P. Murugan, J. Suresh. A leg's angles, and the body "
    "turned and moved over feet that stand still. Its y points up; femur and tibia angles count downwards.",
    lines=(
        Given("X", "foot from the coxa axis, outward", "mm", lambda leg: leg.foot[0]),
        Given("Z", "foot from the coxa axis, to the left", "mm", lambda leg: leg.foot[1]),
        Given("Y", "depth of the foot below the femur axis", "mm", lambda leg: leg.offset[1] - leg.foot[2]),
        Given("coxa", "length of the coxa", "mm", lambda leg: leg.length("coxa")),
        Given("femur", "length of the femur", "mm", lambda leg: leg.length("femur")),
        Given("tibia", "length of the tibia", "mm", lambda leg: leg.length("tibia")),
        Step("C_Angle", "coxa angle", "deg", "atan2(Z, X)", "coxa", lambda leg: leg.angles[0]),
        Step("l", "foot from the coxa axis, seen from above", "mm", "sqrt(X ** 2 + Z ** 2)"),
        Step("HF", "from the femur axis to the foot", "mm", "sqrt((l - coxa) ** 2 + Y ** 2)"),
        Step("A1", "between HF and the vertical", "deg", "atan2(l - coxa, Y)"),
        Step(
            "A2",
            "between HF and the femur",
            "deg",
            "acos((tibia ** 2 - femur ** 2 - HF ** 2) / (-2 * femur * HF))",
        ),
        Step("F_Angle", "femur angle, down", "deg", "deg(90) - (A1 + A2)", "−femur", lambda leg: -leg.angles[1]),
        Step(
            "B1",
            "angle inside the knee",
            "deg",
            "acos((HF ** 2 - tibia ** 2 - femur ** 2) / (-2 * femur * tibia))",
            "tibia + 180°",
            lambda leg: leg.angles[2] + math.pi,
        ),
        Step(
            "T_Angle",
            "tibia angle, from the perpendicular of the femur",
            "deg",
            "deg(90) - B1",
            "−90° − tibia",
            lambda leg: -math.pi / 2 - leg.angles[2],
        ),
        Given("theta", "turn of the body about x", "deg", lambda leg: leg.rpy[0]),
        Given("alpha", "turn of the body about z there, our y", "deg", lambda leg: leg.rpy[1]),
        Given("beta", "turn of the body about y there, our z", "deg", lambda leg: leg.rpy[2]),
        *(
            Step(
                f"R_{row + 1}{column + 1}",
                f"rotation of the body: row {row + 1}, column {column + 1}",
                "",
                formula,
                "roll · pitch · yaw",
                _entry(row, column),
            )
            for row, formulas in enumerate(_ROTATION)
            for column, formula in enumerate(formulas)
        ),
        Given("x", "coxa axis from the body's centre, forward", "mm", lambda leg: leg.mount[0]),
        Given("z", "coxa axis from the body's centre, to the left", "mm", lambda leg: leg.mount[1]),
        Given("y", "coxa axis from the body's centre, up", "mm", lambda leg: leg.mount[2]),
        *(
            Step(
                symbol,
                f"coxa axis in the turned body, {way}",
                "mm",
                f"x * R_{row}1 + z * R_{row}2 + y * R_{row}3",
                "turned coxa axis",
                _turned(row - 1),
            )
            for row, (symbol, way) in enumerate((("X_t", "forward"), ("Z_t", "to the left"), ("Y_t", "up")), start=1)
        ),
    ),
    slips={
        "test_003_erratum_the_femur_angle_wants_a_depth": Slip(
            "deg(90) - (atan((l - coxa) / -Y) + A2)", "deg(90) - (atan((l - coxa) / Y) + A2)", "deg"
        ),
        "test_003_erratum_a_sign_in_the_rotation": Slip(
            "cos(theta) * cos(beta) + sin(theta) * sin(alpha) * sin(beta)", _TURNED, ""
        ),
    },
)
