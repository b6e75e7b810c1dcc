"""Source 002: forward and inverse kinematics of Hexy's leg."""

from __future__ import annotations

import math

from tarsus.studio.sources.document import Document, Given, Slip, Step

__all__ = ["DOCUMENT"]

DOCUMENT = Document(
    number="002",
    title="Hexapod Leg Kinematics",
    about="About the robot Hexy, 2015, author not given. Forward and inverse kinematics of a leg. Its y axis "
    "points up; the coxa angle is positive clockwise, seen from above.",
    lines=(
        Given("c", "length of the coxa", "mm", lambda leg: leg.length("coxa")),
        Given("f", "length of the femur", "mm", lambda leg: leg.length("femur")),
        Given("t", "length of the tibia", "mm", lambda leg: leg.length("tibia")),
        Given("Oc", "coxa angle: our coxa, negated", "deg", lambda leg: -leg.angles[0]),
        Given("Of", "femur angle: our femur", "deg", lambda leg: leg.angles[1]),
        Given("Ot", "tibia angle, bent down: our tibia, negated", "deg", lambda leg: -leg.angles[2]),
        Step("r", "foot from the coxa axis, seen from above", "mm", "c + f * cos(Of) + t * cos(Of - Ot)"),
        Step(
            "y",
            "foot, up from the femur axis",
            "mm",
            "f * sin(Of) + t * sin(Of - Ot)",
            "z in C",
            lambda leg: leg.foot[2] - leg.offset[1],
        ),
        Step("x", "foot, outward", "mm", "r * cos(Oc)", "x in C", lambda leg: leg.foot[0]),
        Step("z", "foot, to the right", "mm", "r * sin(Oc)", "−y in C", lambda leg: -leg.foot[1]),
        Step("d", "reach from the femur axis", "mm", "r - c"),
        Step("L", "from the femur axis to the foot", "mm", "sqrt(d * d + y * y)"),
        Step("alpha", "between femur and L", "deg", "acos((f * f + L * L - t * t) / (2 * f * L))"),
        Step("beta", "between L and the vertical", "deg", "atan2(d, -y)"),
        Step(
            "gamma",
            "angle inside the knee",
            "deg",
            "acos((f * f + t * t - L * L) / (2 * f * t))",
            "tibia + 180°",
            lambda leg: leg.angles[2] + math.pi,
        ),
        Step("Of", "femur angle from the foot", "deg", "alpha + beta - deg(90)", "femur", lambda leg: leg.angles[1]),
        Step("Ot", "tibia angle from the foot", "deg", "deg(180) - gamma", "−tibia", lambda leg: -leg.angles[2]),
    ),
    slips={
        "test_002_erratum_the_hypotenuse_is_of_d_and_y": Slip("r * r + d * d", "d * d + y * y", "mm²"),
        "test_002_erratum_the_law_of_cosines_subtracts": Slip(
            "f * f + L * L", "f * f + L * L - 2 * f * L * cos(alpha)", "mm²"
        ),
        "test_002_erratum_the_femur_angle_has_the_opposite_sign": Slip(
            "deg(90) - alpha - beta", "alpha + beta - deg(90)", "deg"
        ),
    },
)
