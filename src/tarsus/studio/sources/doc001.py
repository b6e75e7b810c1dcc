"""Source 001: a leg whose femur axis is offset, and where its foot stands at rest."""

from __future__ import annotations

import math

from tarsus.studio.sources.document import Document, Given, Slip, Step

__all__ = ["DOCUMENT"]

_IN_LEG_X = "(Pxc - Dec_X1) * cos(A) + (Pyc - Dec_Y1) * sin(A)"

DOCUMENT = Document(
    number="001",
    title="Equations for Hexapod robot control",
    about="Author not given. A leg whose femur axis lies beside the coxa axis, the rest foothold, straight and curved "
    "walks, and tilt. Its body frame has x to the right and y to the front.",
    sideways=True,
    lines=(
        Given("Pxc", "foot in the body frame, to the right", "mm", lambda leg: -leg.foot_in_body[1]),
        Given("Pyc", "foot in the body frame, to the front", "mm", lambda leg: leg.foot_in_body[0]),
        Given("Pzc", "foot in the body frame, up", "mm", lambda leg: leg.foot_in_body[2]),
        Given("Dec_X1", "coxa axis in the body frame, to the right", "mm", lambda leg: -leg.mount[1]),
        Given("Dec_Y1", "coxa axis in the body frame, to the front", "mm", lambda leg: leg.mount[0]),
        Given("Dec_Z1", "coxa axis in the body frame, up", "mm", lambda leg: leg.mount[2]),
        Given("A", "direction of the leg, from the x axis there", "deg", lambda leg: leg.yaw + math.pi / 2),
        Given("Dec_X2", "femur axis from the coxa axis, outward", "mm", lambda leg: leg.length("coxa")),
        Given("Dec_Y2", "femur axis from the coxa axis, sideways", "mm", lambda leg: leg.offset[0]),
        Given("Dec_Z2", "femur axis from the coxa axis, up", "mm", lambda leg: leg.offset[1]),
        Given("l2", "middle link", "mm", lambda leg: leg.length("femur")),
        Given("l1", "last link", "mm", lambda leg: leg.length("tibia")),
        Step("Px_a3", "foot from the coxa axis, outward", "mm", _IN_LEG_X, "x in C", lambda leg: leg.foot[0]),
        Step(
            "Py_a3",
            "foot from the coxa axis, to the left",
            "mm",
            "(Pyc - Dec_Y1) * cos(A) - (Pxc - Dec_X1) * sin(A)",
            "y in C",
            lambda leg: leg.foot[1],
        ),
        Step("b", "foot from the coxa axis, seen from above", "mm", "hypot(Px_a3, Py_a3)"),
        Step("c", "femur axis from the coxa axis, seen from above", "mm", "hypot(Dec_X2, Dec_Y2)"),
        Step("Px_a2", "reach from the femur axis", "mm", "sqrt(b ** 2 - Dec_Y2 ** 2) - Dec_X2"),
        Step("Pz_a2", "foot from the femur axis, up", "mm", "Pzc - Dec_Z1 - Dec_Z2"),
        Step(
            "T3",
            "angle of the coxa",
            "deg",
            "atan2(Py_a3, Px_a3) - atan2(Dec_Y2, Dec_X2 + Px_a2)",
            "coxa",
            lambda leg: leg.angles[0],
        ),
        Step("B", "from the femur axis to the foot", "mm", "hypot(Px_a2, Pz_a2)"),
        Step(
            "T1",
            "angle inside the knee",
            "deg",
            "acos((l1 ** 2 + l2 ** 2 - B ** 2) / (2 * l1 * l2))",
            "tibia + 180°",
            lambda leg: leg.angles[2] + math.pi,
        ),
        Step(
            "T2",
            "angle of the femur from the horizontal",
            "deg",
            "acos((B ** 2 + l2 ** 2 - l1 ** 2) / (2 * l2 * B)) + atan2(Pz_a2, Px_a2)",
            "femur",
            lambda leg: leg.angles[1],
        ),
        Given("x_min", "nearest that the foot stands straight out", "mm", lambda leg: leg.band[0]),
        Given("x_max", "farthest that the foot stands straight out", "mm", lambda leg: leg.band[1]),
        Step("x_rest", "rest foothold, from the coxa axis", "mm", "x_min + (x_max - x_min) / 2"),
        Given("A_roll", "turn of the body about its front axis", "deg", lambda leg: leg.rpy[0]),
        Given("B_pitch", "turn of the body about its side axis", "deg", lambda leg: leg.rpy[1]),
        Step("t2", "angle between b and the femur axis' offset", "deg", "deg(90) + atan2(Dec_X2, Dec_Y2)"),
    ),
    slips={
        "test_001_erratum_the_summary_swaps_b_and_c": Slip(
            "sqrt(c ** 2 - b ** 2 * sin(t2) ** 2) + b * cos(t2)",
            "sqrt(b ** 2 - c ** 2 * sin(t2) ** 2) + c * cos(t2)",
            "mm",
        ),
        "test_001_erratum_the_leg_frame_is_mirrored": Slip("-Py_a3", "Py_a3", "mm"),
        "test_001_erratum_both_components_of_the_attachment_are_subtracted": Slip(
            "Pxc * cos(A) + Pyc * sin(A) - sqrt(Dec_X1 ** 2 + Dec_Y1 ** 2)", _IN_LEG_X, "mm"
        ),
        "test_001_erratum_arctan_of_a_quotient_loses_the_quadrant": Slip("atan(Pyc / Pxc)", "atan2(Pyc, Pxc)", "deg"),
        "test_001_erratum_the_tilted_plane_has_the_tangent_as_its_slope": Slip(
            "1 / tan(B_pitch)", "tan(B_pitch) / cos(A_roll)", ""
        ),
    },
)
