"""What source 004 prints, and what is to be said of its lines."""

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
_FREE = {
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
_CHOICES = {"gravity": 9.8, "sweep": math.pi / 3, "sweep_time": 2.0, "acceleration": 1.0, "safety_factor": 3.0}
_DOWN = {3: _THREE_DOWN, 5: _FIVE_DOWN}

NOTES: Mapping[str, str] = {
    "given.L_femur_out": "how far out the standing femur reaches, to the millimetre: its length at 45 deg, unless "
    "given otherwise; the source gives 0.069 m for 0.098 m without a reason, and that is what 45 deg gives",
    "swing.femur": "the source puts the coxa's arm for the femur's",
    "swing.acceleration": "half of the time speeding up, half slowing down; the source writes rad/s",
    "inertia.coxa": "a rod about its end, 0.33 for 1/3; the source's number is not that of its formula, but a third "
    "of the tibia's mass times the square of the coxa's length",
    "inertia.femur_at_coxa": "the source puts a tenth of the femur's mass",
    "inertia.leg": "in the source with the two slips above",
    "swing.inertia": "in the source with the slips above",
    "swing.bending": "a bending load on the coxa's bearing; a torque only for a robot on its side",
    "swing.gravity": "a weight has no moment about a vertical axis; the source puts the bending load here",
    "swing.coxa": "in the source with the bending load",
    "stance.mass": "the weight of the legs that stand is left out; the source writes 0.05 kg for its coxa of 0.04 kg, "
    "but did the sum with 0.04",
    "stance.load": "shared evenly, as it is only with the centre of mass midway between the feet",
    "stance.femur": "the body's weight on a cantilever: where the foot stands does not enter; the source writes N",
    "stance.tibia": "the same cantilever, longer by the femur: a knee over the foot bears far less",
    "walk.inertia": "a cube with the circle's radius for its side, about a coxa axis; the source leaves out a square",
    "walk.inertia_torque": "in the source with the slip above",
    "walk.coxa": "in the source with the slip above",
    "walk.coxa_with_factor": "in the source with the slip above",
}
NOTES_ONE_LEG_UP: Mapping[str, str] = {
    "walk.coxa": "in the source with the slip above, and the inertia added where its torque is meant",
    "walk.coxa_with_factor": "in the source with both slips above",
}


def printed_numbers(
    given: Mapping[str, float], choices: Mapping[str, float], *, legs: int, feet_down: int
) -> Mapping[str, str]:
    """Return what source 004 prints for each line, where robot and choices are its own; nothing otherwise.

    Parameters
    ----------
    given : mapping
        The robot's numbers by key [kg, m].
    choices : mapping
        Gravity, sweep, its time, acceleration and safety factor.
    legs, feet_down : int
        How many legs there are, and how many of them stand.
    """
    same_robot = legs == 6 and all(math.isclose(given[key], float(text), rel_tol=1e-5) for key, text in _GIVEN.items())
    same_choices = all(math.isclose(choices[key], value, rel_tol=1e-5) for key, value in _CHOICES.items())
    if not (same_robot and same_choices and feet_down in _DOWN):
        return {}
    return {**_GIVEN, **_FREE, **_DOWN[feet_down]}
