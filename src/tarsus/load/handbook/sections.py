"""The sections of source 004's hand calculation: weights, free swing, the coxa's swing, stance, walking.

Each writes its lines on the sheet, and adds what later sections need to the terms.
"""

from __future__ import annotations

from tarsus.load.handbook.lines import Sheet, Term
from tarsus.robot.robot import JOINTS

__all__ = ["work_out"]


def work_out(sheet: Sheet, terms: dict[str, Term], *, corrected: bool, one_leg_up: bool) -> None:
    """Write all sections, in the source's order.

    Parameters
    ----------
    sheet : Sheet
        Where the lines go; the given numbers stand on it already.
    terms : dict
        The given numbers and choices, by symbol.
    corrected : bool
        Whether the source's slips are put right.
    one_leg_up : bool
        Whether one leg is in the air at a time: there the source makes a slip of its own.
    """
    x = dict(terms)
    _weights(sheet, x)
    _free_swing(sheet, x, corrected)
    _coxa_swing(sheet, x, corrected)
    _stance(sheet, x)
    _walking(sheet, x, corrected, adds_inertia=one_leg_up and not corrected)


def _weights(sheet: Sheet, x: dict[str, Term]) -> None:
    for part in ("body", *JOINTS):
        x[f"W_{part}"] = sheet.work(f"weight.{part}", f"W_{part}", "N", x[f"m_{part}"] * x["g"])


def _free_swing(sheet: Sheet, x: dict[str, Term], corrected: bool) -> None:
    """Write what femur and tibia lift of a leg in the air, straight out."""
    arm = x["l_femur"] if corrected else x["l_coxa"]
    femur = x["W_femur"] * arm + x["W_tibia"] * (x["L_femur"] + x["l_tibia"])
    sheet.work("swing.femur", "τ_femur", "N m", femur)
    sheet.work("swing.tibia", "τ_tibia", "N m", x["W_tibia"] * x["l_tibia"])


def _coxa_swing(sheet: Sheet, x: dict[str, Term], corrected: bool) -> None:
    """Write what the coxa needs to sweep that leg from rest to rest: its links are uniform rods."""
    alpha = sheet.work("swing.acceleration", "α", "rad/s²", Term.number(4) * x["sweep"] / x["time"].squared())
    x["alpha"] = alpha
    if corrected:
        coxa, femur_mass = Term.number(0.33) * x["m_coxa"] * x["L_coxa"].squared(), x["m_femur"]
    else:
        coxa = Term(1 / 3, "1 / 3", "1 / 3", 2) * x["m_tibia"] * x["L_coxa"].squared()
        femur_mass = x["m_femur"] / Term.number(10)
    femur_at = x["L_coxa"] + x["l_femur"]
    tibia_at = x["L_coxa"] + x["L_femur"] + x["l_tibia"]
    at_coxa = sheet.work("inertia.coxa", "I_coxa", "kg m²", coxa)
    for joint, mass, arm in (("femur", femur_mass, femur_at), ("tibia", x["m_tibia"], tibia_at)):
        middle = Term.number(0.0833) * x[f"m_{joint}"] * x[f"L_{joint}"].squared()
        own = sheet.work(f"inertia.{joint}", f"I_{joint}", "kg m²", middle)
        moved = own + mass * arm.squared()
        at_coxa += sheet.work(f"inertia.{joint}_at_coxa", f"I_{joint}>coxa", "kg m²", moved)
    total = sheet.work("inertia.leg", "I_leg", "kg m²", at_coxa)
    inertia = sheet.work("swing.inertia", "τ_inertia", "N m", total * alpha)
    moment = x["W_coxa"] * x["l_coxa"] + x["W_femur"] * femur_at + x["W_tibia"] * tibia_at
    bending = sheet.work("swing.bending", "M_bending", "N m", moment)
    gravity = sheet.work("swing.gravity", "τ_gravity", "N m", Term.number(0) if corrected else bending)
    sheet.work("swing.coxa", "τ_coxa", "N m", inertia + gravity)


def _stance(sheet: Sheet, x: dict[str, Term]) -> None:
    """Write what the standing legs bear: the body and the legs in the air, on a cantilever from the body's centre."""
    mass = x["m_body"] + x["up"] * (x["m_coxa"] + x["m_femur"] + x["m_tibia"])
    x["m_tot"] = sheet.work("stance.mass", "m_tot", "kg", mass)
    weight = sheet.work("stance.weight", "W_tot", "N", x["m_tot"] * x["g"])
    load = sheet.work("stance.load", "W_leg", "N", weight / x["down"])
    middle = x["L_femur_out"] * x["l_femur"] / x["L_femur"]
    middle = sheet.work("stance.l_femur_out", "l_femur_out", "m", middle)
    femur = x["W_coxa"] * x["l_coxa"] + load * (x["L_coxa"] + x["R_b"])
    sheet.work("stance.femur", "τ_femur", "N m", femur)
    links = x["W_femur"] * middle + x["W_coxa"] * (x["L_femur_out"] + x["l_coxa"])
    tibia = links + load * (x["L_femur_out"] + x["L_coxa"] + x["R_b"])
    sheet.work("stance.tibia", "τ_tibia", "N m", tibia)


def _walking(sheet: Sheet, x: dict[str, Term], corrected: bool, *, adds_inertia: bool) -> None:
    """Write what a coxa needs to push forward and to turn all that the standing legs carry."""
    side = x["R_b"].squared()
    cube = Term.number(0.1666) * x["m_tot"] * (side if corrected else x["R_b"]) + x["m_tot"] * side
    inertia = sheet.work("walk.inertia", "I_cube", "kg m²", cube)
    turning = sheet.work("walk.inertia_torque", "τ_inertia", "N m", inertia * x["alpha"])
    pushing = sheet.work("walk.acceleration_torque", "τ_acceleration", "N m", x["m_tot"] * x["a"] * x["R_b"])
    coxa = sheet.work("walk.coxa", "τ_coxa", "N m", pushing + (inertia if adds_inertia else turning))
    sheet.work("walk.coxa_with_factor", "k τ_coxa", "N m", coxa * x["factor"])
