"""Source 001: a leg whose femur axis is offset; its foot at rest, on straight and curved walks, under a tilted body."""

from __future__ import annotations

import math

import numpy as np

from tarsus.studio.sources.document import Document, Given, Slip, Step
from tarsus.studio.sources.live import Live

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
        Given("L", "straight walk: distance", "mm", lambda leg: leg.walk.distance),
        Given("A_w", "straight walk: direction from the front, to the left", "deg", lambda leg: leg.walk.heading),
        Given("P", "stroke of a foot", "mm", lambda leg: leg.walk.stroke),
        Given("G", "height of the body's origin; in the document the clearance", "mm", lambda leg: leg.body_height),
        Step(
            "E_x", "rest foothold, to the right", "mm", "Dec_X1 + cos(A) * x_rest", "−y in B", lambda leg: -leg.rest[1]
        ),
        Step("E_y", "rest foothold, to the front", "mm", "Dec_Y1 + sin(A) * x_rest", "x in B", lambda leg: leg.rest[0]),
        Step("z_E", "foothold, up", "mm", "-G"),
        Step(
            "a_x",
            "straight walk: end ahead, to the right",
            "mm",
            "E_x - sin(A_w) * P / 2",
            "−y",
            lambda leg: -_ahead(leg)[1],
        ),
        Step(
            "a_y",
            "straight walk: end ahead, to the front",
            "mm",
            "E_y + cos(A_w) * P / 2",
            "x",
            lambda leg: _ahead(leg)[0],
        ),
        Step(
            "d_x",
            "straight walk: end behind, to the right",
            "mm",
            "E_x + sin(A_w) * P / 2",
            "−y",
            lambda leg: -_behind(leg)[1],
        ),
        Step(
            "d_y",
            "straight walk: end behind, to the front",
            "mm",
            "E_y - cos(A_w) * P / 2",
            "x",
            lambda leg: _behind(leg)[0],
        ),
        Step("n", "straight walk: number of strokes", "", "L / P"),
        Given("A_c", "curved walk: angle", "deg", lambda leg: leg.walk.angle),
        Given("X_C", "curved walk: centre, to the right", "mm", lambda leg: -leg.walk.centre[1]),
        Given("Y_C", "curved walk: centre, to the front", "mm", lambda leg: leg.walk.centre[0]),
        Given("CP_max", "greatest CP of all legs", "mm", lambda leg: float(np.hypot(*leg.from_centre.T).max())),
        Step("CP", "rest foothold from the centre", "mm", "sqrt((E_x - X_C) ** 2 + (E_y - Y_C) ** 2)"),
        Step(
            "T", "angle of a stroke about the centre", "deg", "P / CP_max", "stroke angle", lambda leg: leg.stroke_angle
        ),
        Step("A_d", "direction of one end from the centre", "deg", "atan2(E_y - Y_C, E_x - X_C) - T / 2"),
        Step("A_a", "direction of the other end", "deg", "atan2(E_y - Y_C, E_x - X_C) + T / 2"),
        Step("X_d", "one end, to the right", "mm", "cos(A_d) * CP + X_C", "−y", lambda leg: -_turned(leg, -1)[1]),
        Step("Y_d", "one end, to the front", "mm", "sin(A_d) * CP + Y_C", "x", lambda leg: _turned(leg, -1)[0]),
        Step("X_a", "other end, to the right", "mm", "cos(A_a) * CP + X_C", "−y", lambda leg: -_turned(leg, 1)[1]),
        Step("Y_a", "other end, to the front", "mm", "sin(A_a) * CP + Y_C", "x", lambda leg: _turned(leg, 1)[0]),
        Step("m", "curved walk: number of strokes", "", "A_c / T"),
        Given("A_roll", "tilt: turn of the body about its front axis", "deg", lambda leg: leg.rpy[0]),
        Given("B_pitch", "tilt: turn of the body about its side axis", "deg", lambda leg: leg.rpy[1]),
        Given("H", "tilt: height of the body's origin", "mm", lambda leg: float(leg.body.position[2])),
        Step("G_t", "tilt: height along the body's vertical axis", "mm", "H / (cos(A_roll) * cos(B_pitch))"),
        Step(
            "E_z",
            "tilt: foot on the tilted plane, up",
            "mm",
            "-G_t + E_x * tan(A_roll) + E_y * tan(B_pitch) / cos(A_roll)",
            "z in B",
            lambda leg: leg.ground_at(leg.rest),
        ),
        Step("t2", "angle between b and the femur axis' offset", "deg", "deg(90) + atan2(Dec_X2, Dec_Y2)"),
    ),
    slips={
        "test_001_erratum_the_summary_swaps_b_and_c": Slip(
            "sqrt(Dec_X2 ** 2 + Dec_Y2 ** 2)", "sqrt(Px_a3 ** 2 + Py_a3 ** 2)", "mm"
        ),
        "test_001_erratum_the_leg_frame_is_mirrored": Slip(
            "-(Pyc * cos(A) - Pxc * sin(A))", "Pyc * cos(A) - Pxc * sin(A)", "mm"
        ),
        "test_001_erratum_both_components_of_the_attachment_are_subtracted": Slip(
            "Pxc * cos(A) + Pyc * sin(A) - sqrt(Dec_X1 ** 2 + Dec_Y1 ** 2)", _IN_LEG_X, "mm"
        ),
        "test_001_erratum_arctan_of_a_quotient_loses_the_quadrant": Slip("atan(Pyc / Pxc)", "atan2(Pyc, Pxc)", "deg"),
        "test_001_erratum_a_step_is_the_stroke_not_the_distance": Slip("cos(A_w) * L / 2", "cos(A_w) * P / 2", "mm"),
        "test_001_erratum_the_tilted_plane_has_the_tangent_as_its_slope": Slip(
            "1 / tan(B_pitch)", "tan(B_pitch) / cos(A_roll)", ""
        ),
        "test_001_erratum_the_two_slopes_have_their_own_signs": Slip(
            "-G_t - (E_x / tan(A_roll) - E_y / tan(B_pitch))",
            "-G_t + E_x * tan(A_roll) + E_y * tan(B_pitch) / cos(A_roll)",
            "mm",
        ),
    },
)


def _ahead(leg: Live) -> tuple[float, float]:
    return _moved(leg, leg.walk.stroke / 2)


def _behind(leg: Live) -> tuple[float, float]:
    return _moved(leg, -leg.walk.stroke / 2)


def _moved(leg: Live, by: float) -> tuple[float, float]:
    """Return the rest foothold (x, y) moved along the straight walk [m]."""
    x, y = leg.rest
    return float(x) + by * math.cos(leg.walk.heading), float(y) + by * math.sin(leg.walk.heading)


def _turned(leg: Live, way: int) -> tuple[float, float]:
    """Return an end (x, y) of the stance on the curved walk [m]; `way` is 1 counter-clockwise and -1 clockwise."""
    return leg.on_curve(way * leg.stroke_angle / 2)
