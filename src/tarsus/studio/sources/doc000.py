"""Source 000: the inverse kinematics of a leg."""

from __future__ import annotations

import math

from tarsus.studio.sources.document import Document, Given, Slip, Step

__all__ = ["DOCUMENT"]

DOCUMENT = Document(
    number="000",
    title="Kinematics Calculations for Hexapod Robot",
    about="Nabeel Chowdhury, 2021. The joint angles of a leg for a foot position, by the law of cosines.",
    lines=(
        Given("P_x", "foot from the coxa axis, outward", "mm", lambda leg: leg.foot[0]),
        Given("P_y", "foot from the coxa axis, to the left", "mm", lambda leg: leg.foot[1]),
        Given("P_z", "foot from the femur axis, up", "mm", lambda leg: leg.foot[2] - leg.offset[1]),
        Given("L_C", "length of the coxa", "mm", lambda leg: leg.length("coxa")),
        Given("L_F", "length of the femur", "mm", lambda leg: leg.length("femur")),
        Given("L_T", "length of the tibia", "mm", lambda leg: leg.length("tibia")),
        Step("theta_C", "coxa angle", "deg", "atan2(P_y, P_x)", "coxa", lambda leg: leg.angles[0]),
        Step("H", "height of the femur axis over the foot", "mm", "-P_z"),
        Step("R", "reach from the femur axis", "mm", "hypot(P_x, P_y) - L_C"),
        Step("A", "from the femur axis to the foot", "mm", "sqrt(H ** 2 + R ** 2)"),
        Step(
            "theta_F",
            "femur angle",
            "deg",
            "acos((L_T ** 2 - L_F ** 2 - A ** 2) / (-2 * L_F * A)) - atan2(H, R)",
            "femur",
            lambda leg: leg.angles[1],
        ),
        Step(
            "theta_gamma",
            "angle inside the knee",
            "deg",
            "acos((A ** 2 - L_F ** 2 - L_T ** 2) / (-2 * L_F * L_T))",
            "tibia + 180°",
            lambda leg: leg.angles[2] + math.pi,
        ),
        Step(
            "theta_T",
            "tibia angle, from the perpendicular of the femur",
            "deg",
            "theta_gamma - deg(90)",
            "tibia + 90°",
            lambda leg: leg.angles[2] + math.pi / 2,
        ),
    ),
    slips={
        "test_000_erratum_reach_is_horizontal_not_along_x": Slip("P_x - L_C", "hypot(P_x, P_y) - L_C", "mm"),
    },
)
