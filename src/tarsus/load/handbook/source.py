"""Numbers printed in source 004, and remarks on its lines."""

from __future__ import annotations

import math
from collections.abc import Mapping

__all__ = ["NOTES", "NOTES_ONE_LEG_UP", "printed_numbers"]

_GIVEN = {
    "given.m_body": "1.386",
    "given.m_coxa": "0.04",
    "given.m_femur": "0.16",
    "given.m_tibia": "0.08",
    "given.L_coxa": "0.068",
    "given.L_femur": "0.098",
    "given.L_tibia": "0.181",
    "given.l_coxa": "0.034",
    "given.l_femur": "0.049",
    "given.l_tibia": "0.078",
    "given.R_b": "0.086",
    "given.L_femur_out": "0.069",
}
_SWING = {
    "weight.body": "13.5828",
    "weight.coxa": "0.392",
    "weight.femur": "1.568",
    "weight.tibia": "0.784",
    "swing.femur": "0.1913",
    "swing.tibia": "0.06115",
    "swing.acceleration": "1.0472",
    "inertia.coxa": "0.0001233",
    "inertia.femur": "0.000128",
    "inertia.femur_at_coxa": "0.000347",
    "inertia.tibia": "0.000218",
    "inertia.tibia_at_coxa": "0.00498",
    "inertia.leg": "0.0054503",
    "swing.inertia": "0.0057",
    "swing.gravity": "0.38808",
    "swing.coxa": "0.39378",
    "stance.l_femur_out": "0.0345",
}
_THREE_DOWN = {
    "stance.mass": "2.226",
    "stance.weight": "21.8148",
    "stance.load": "7.2716",
    "stance.femur": "1.13315",
    "stance.tibia": "1.716",
    "walk.inertia": "0.04835",
    "walk.inertia_torque": "0.0506",
    "walk.acceleration_torque": "0.191436",
    "walk.coxa": "0.2420",
    "walk.coxa_with_factor": "0.7260",
}
_FIVE_DOWN = {
    "stance.mass": "1.666",
    "stance.weight": "16.3268",
    "stance.load": "3.26536",
    "stance.femur": "0.5162",
    "stance.tibia": "0.8226",
    "walk.inertia": "0.0362",
    "walk.inertia_torque": "0.0379",
    "walk.acceleration_torque": "0.143276",
    "walk.coxa": "0.1794",
    "walk.coxa_with_factor": "0.5382",
}
_PARAMETERS = {"gravity": 9.8, "sweep": math.pi / 3, "sweep_time": 2.0, "acceleration": 1.0, "safety_factor": 3.0}
_BY_FEET_DOWN = {3: _THREE_DOWN, 5: _FIVE_DOWN}

NOTES: Mapping[str, str] = {
    "given.L_femur_out": "horizontal length of the femur in stance; default: its length at 45 deg, rounded to 1 mm. "
    "The source gives 0.069 m for 0.098 m without a reason, which is the value at 45 deg",
    "swing.femur": "the source uses the coxa's lever arm instead of the femur's",
    "swing.acceleration": "acceleration for half of the time, deceleration for the other half; the source has the unit "
    "rad/s",
    "inertia.coxa": "rod about its end, 0.33 for 1/3; the number in the source does not follow from its formula, but "
    "is 1/3 of the tibia's mass times the square of the coxa's length",
    "inertia.femur_at_coxa": "the source uses 1/10 of the femur's mass",
    "inertia.leg": "the source includes the two errors above",
    "swing.inertia": "the source includes the errors above",
    "swing.bending": "bending moment on the coxa's bearing; a joint torque only for a robot lying on its side",
    "swing.gravity": "weight has no moment about a vertical axis; the source uses the bending moment",
    "swing.coxa": "the source includes the bending moment",
    "stance.mass": "without the weight of the stance legs; the source writes 0.05 kg for its coxa of 0.04 kg, but "
    "calculates with 0.04",
    "stance.load": "equal loads, valid only with the centre of mass midway between the feet",
    "stance.femur": "the body's weight on a cantilever, independent of the foot position; the source has the unit N",
    "stance.tibia": "the same cantilever, extended by the femur; a knee above the foot bears far less",
    "walk.inertia": "cube with the circle's radius as its side, about a coxa axis; the source omits a square",
    "walk.inertia_torque": "the source includes the error above",
    "walk.coxa": "the source includes the error above",
    "walk.coxa_with_factor": "the source includes the error above",
}
NOTES_ONE_LEG_UP: Mapping[str, str] = {
    "walk.coxa": "the source includes the error above, and adds the moment of inertia instead of its torque",
    "walk.coxa_with_factor": "the source includes both errors above",
}


def printed_numbers(
    given: Mapping[str, float], parameters: Mapping[str, float], *, legs: int, feet_down: int
) -> Mapping[str, str]:
    """Return the numbers printed in source 004 by key; empty for another robot or other parameters.

    Parameters
    ----------
    given : mapping
        Given numbers of the robot by key [kg, m].
    parameters : mapping
        Gravity, sweep, sweep time, acceleration and safety factor.
    legs, feet_down : int
        Number of legs, and number of feet on the ground.
    """
    same_robot = legs == 6 and all(math.isclose(given[key], float(text), rel_tol=1e-5) for key, text in _GIVEN.items())
    same_parameters = all(math.isclose(parameters[key], value, rel_tol=1e-5) for key, value in _PARAMETERS.items())
    if not (same_robot and same_parameters and feet_down in _BY_FEET_DOWN):
        return {}
    return {**_GIVEN, **_SWING, **_BY_FEET_DOWN[feet_down]}
