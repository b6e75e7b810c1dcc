"""Sections of source 004's hand calculation: weights, swing of femur and tibia, swing of the coxa, stance, walking.

Each section adds its lines to the sheet, and the terms that later sections need.
"""

from __future__ import annotations

from tarsus.load.handbook.lines import Sheet, Term
from tarsus.robot.robot import JOINTS

__all__ = ["write_sections"]


def write_sections(sheet: Sheet, terms: dict[str, Term], *, corrected: bool, one_leg_up: bool) -> None:
    """Write all sections, in the order of the source.

    Parameters
    ----------
    sheet : Sheet
        Sheet with the given numbers.
    terms : dict
        Given numbers and parameters, by symbol.
    corrected : bool
        Whether the errors of the source are corrected.
    one_leg_up : bool
        Whether a single leg is in swing, for which the source contains an additional error.
    """
    x = dict(terms)
    _weights(sheet, x)
    _free_swing(sheet, x, corrected)
    _coxa_swing(sheet, x, corrected)
    _stance(sheet, x)
    _walking(sheet, x, corrected, adds_inertia=one_leg_up and not corrected)


def _weights(sheet: Sheet, x: dict[str, Term]) -> None:
    for body_part in ("body", *JOINTS):
        x[f"W_{body_part}"] = sheet.result(f"weight.{body_part}", f"W_{body_part}", "N", x[f"m_{body_part}"] * x["g"])


def _free_swing(sheet: Sheet, x: dict[str, Term], corrected: bool) -> None:
    """Write the femur and tibia torques of a leg in swing, stretched out horizontally."""
    arm = x["l_femur"] if corrected else x["l_coxa"]
    femur = x["W_femur"] * arm + x["W_tibia"] * (x["L_femur"] + x["l_tibia"])
    sheet.result("swing.femur", "τ_femur", "N m", femur)
    sheet.result("swing.tibia", "τ_tibia", "N m", x["W_tibia"] * x["l_tibia"])


def _coxa_swing(sheet: Sheet, x: dict[str, Term], corrected: bool) -> None:
    """Write the coxa torque that swings that leg from rest to rest; its links are uniform rods."""
    alpha = sheet.result("swing.acceleration", "α", "rad/s²", Term.number(4) * x["sweep"] / x["time"].squared())
    x["alpha"] = alpha
    if corrected:
        coxa, femur_mass = Term.number(0.33) * x["m_coxa"] * x["L_coxa"].squared(), x["m_femur"]
    else:
        coxa = Term(1 / 3, "1 / 3", "1 / 3", 2) * x["m_tibia"] * x["L_coxa"].squared()
        femur_mass = x["m_femur"] / Term.number(10)
    femur_radius = x["L_coxa"] + x["l_femur"]
    tibia_radius = x["L_coxa"] + x["L_femur"] + x["l_tibia"]
    about_coxa = sheet.result("inertia.coxa", "I_coxa", "kg m²", coxa)
    for joint, mass, arm in (("femur", femur_mass, femur_radius), ("tibia", x["m_tibia"], tibia_radius)):
        central = Term.number(0.0833) * x[f"m_{joint}"] * x[f"L_{joint}"].squared()
        link_inertia = sheet.result(f"inertia.{joint}", f"I_{joint}", "kg m²", central)
        shifted = link_inertia + mass * arm.squared()
        about_coxa += sheet.result(f"inertia.{joint}_at_coxa", f"I_{joint}>coxa", "kg m²", shifted)
    total = sheet.result("inertia.leg", "I_leg", "kg m²", about_coxa)
    inertia = sheet.result("swing.inertia", "τ_inertia", "N m", total * alpha)
    moment = x["W_coxa"] * x["l_coxa"] + x["W_femur"] * femur_radius + x["W_tibia"] * tibia_radius
    bending = sheet.result("swing.bending", "M_bending", "N m", moment)
    gravity = sheet.result("swing.gravity", "τ_gravity", "N m", Term.number(0) if corrected else bending)
    sheet.result("swing.coxa", "τ_coxa", "N m", inertia + gravity)


def _stance(sheet: Sheet, x: dict[str, Term]) -> None:
    """Write the torques of the stance legs: body and swing legs as a load on a cantilever from the body's centre."""
    mass = x["m_body"] + x["up"] * (x["m_coxa"] + x["m_femur"] + x["m_tibia"])
    x["m_tot"] = sheet.result("stance.mass", "m_tot", "kg", mass)
    weight = sheet.result("stance.weight", "W_tot", "N", x["m_tot"] * x["g"])
    load = sheet.result("stance.load", "W_leg", "N", weight / x["down"])
    central = x["L_femur_out"] * x["l_femur"] / x["L_femur"]
    central = sheet.result("stance.l_femur_out", "l_femur_out", "m", central)
    femur = x["W_coxa"] * x["l_coxa"] + load * (x["L_coxa"] + x["R_b"])
    sheet.result("stance.femur", "τ_femur", "N m", femur)
    links = x["W_femur"] * central + x["W_coxa"] * (x["L_femur_out"] + x["l_coxa"])
    tibia = links + load * (x["L_femur_out"] + x["L_coxa"] + x["R_b"])
    sheet.result("stance.tibia", "τ_tibia", "N m", tibia)


def _walking(sheet: Sheet, x: dict[str, Term], corrected: bool, *, adds_inertia: bool) -> None:
    """Write the coxa torque that accelerates and rotates the mass carried by the stance legs."""
    side = x["R_b"].squared()
    cube = Term.number(0.1666) * x["m_tot"] * (side if corrected else x["R_b"]) + x["m_tot"] * side
    inertia = sheet.result("walk.inertia", "I_cube", "kg m²", cube)
    rotation = sheet.result("walk.inertia_torque", "τ_inertia", "N m", inertia * x["alpha"])
    propulsion = sheet.result("walk.acceleration_torque", "τ_acceleration", "N m", x["m_tot"] * x["a"] * x["R_b"])
    coxa = sheet.result("walk.coxa", "τ_coxa", "N m", propulsion + (inertia if adds_inertia else rotation))
    sheet.result("walk.coxa_with_factor", "k τ_coxa", "N m", coxa * x["factor"])
