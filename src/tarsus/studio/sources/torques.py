"""Torques of source 004: the lines of `handbook` for the robot that is shown."""

from __future__ import annotations

import re
from collections.abc import Mapping

from tarsus.load.handbook.lines import Line
from tarsus.load.handbook.method import handbook
from tarsus.robot.robot import Robot
from tarsus.studio.encoding import or_null
from tarsus.studio.messages.general import Equation, Erratum, MathNode
from tarsus.studio.sources.errata import errata
from tarsus.studio.sources.expression import Expression, symbol_node

__all__ = ["FEET_DOWN", "torque_equations", "torque_slips"]

FEET_DOWN = (3, 5)
"""Numbers of feet on the ground for which the document computes torques: a tripod, and all legs but one."""

_COUNTS = {3: "three", 5: "five"}

_SECTIONS: Mapping[str, str] = {
    "weight": "weight",
    "swing": "a leg that swings freely",
    "inertia": "inertia about the coxa axis",
    "stance": "standing on {} feet",
    "walk": "walking on {} feet",
}

_PARTS = ("body", "coxa", "femur", "tibia")
_GIVEN: Mapping[str, str] = {
    **{f"given.m_{part}": f"mass of the {part}" for part in _PARTS},
    **{f"given.L_{part}": f"length of the {part}" for part in _PARTS},
    **{f"given.l_{part}": f"centre of mass of the {part}, from its inner joint" for part in _PARTS},
    "given.R_b": "coxa axis from the body's centre",
    "given.L_femur_out": "horizontal length of the femur in stance",
}

# The line of the hand method in which each erratum is, by the name of the erratum's test.
_SLIPS: Mapping[str, str] = {
    "test_004_erratum_femur_swing_torque_takes_the_coxas_arm": "swing.femur",
    "test_004_erratum_coxa_inertia": "inertia.coxa",
    "test_004_erratum_femur_inertia_takes_a_tenth_of_the_mass": "inertia.femur_at_coxa",
    "test_004_erratum_total_inertia_follows": "inertia.leg",
    "test_004_erratum_gravity_has_no_moment_about_a_vertical_axis": "swing.gravity",
    "test_004_erratum_the_cubes_inertia_takes_a_length_unsquared": "walk.inertia",
}


def torque_equations(robot: Robot, leg: int, *, feet_down: int) -> list[Equation]:
    """Return the lines of the hand method; none if the masses are unknown, or no leg would be off the ground.

    Parameters
    ----------
    robot : Robot
        A single robot.
    leg : int
        Index of the leg whose values are used for all legs.
    feet_down : int
        Number of feet on the ground, one of `FEET_DOWN`; except for the first, only lines that depend on it.
    """
    if not robot.has_masses or robot.legs <= feet_down:
        return []
    lines = handbook(robot, leg=leg, feet_down=feet_down).lines
    return [
        _equation(line, feet_down)
        for line in lines
        if feet_down == FEET_DOWN[0] or line.key.partition(".")[0] in ("stance", "walk")
    ]


def _equation(line: Line, feet_down: int) -> Equation:
    section = _SECTIONS.get(line.key.partition(".")[0], "given").format(_COUNTS[feet_down])
    formula = f" = {line.formula}" if line.formula else ""
    return Equation(
        key=line.key if feet_down == FEET_DOWN[0] else f"{line.key}.{feet_down}",
        name=_GIVEN.get(line.key, section),
        symbol=_symbol(line.symbol),
        formula=_node(line.formula),
        numbers=_node(line.substitution),
        plain=f"{line.symbol}{formula} = {line.value:.5g} {line.unit}",
        value=or_null(line.value, decimals=9),
        unit=line.unit,
        ours=None,
        printed_value=line.printed,
        note=line.note or None,
    )


def torque_slips(robot: Robot, leg: int) -> dict[str, Erratum]:
    """Return the errata of the hand method with this robot's numbers, by the names of their tests.

    Parameters
    ----------
    robot : Robot
        A single robot.
    leg : int
        Index of the leg whose values are used for all legs.
    """
    if not robot.has_masses:
        return {}
    printed, right = (handbook(robot, leg=leg, corrected=corrected) for corrected in (False, True))
    slips = {}
    for row in errata():
        if row.test in _SLIPS:
            as_printed, as_it_is = printed.line(_SLIPS[row.test]), right.line(_SLIPS[row.test])
            slips[row.test] = Erratum(
                printed=row.printed,
                correct=row.correct,
                reason=row.reason,
                printed_formula=_node(as_printed.formula),
                correct_formula=_node(as_it_is.formula),
                printed_value=or_null(as_printed.value, decimals=9),
                correct_value=or_null(as_it_is.value, decimals=9),
                unit=as_it_is.unit,
            )
    return slips


def _symbol(text: str) -> MathNode:
    factor, _, name = text.rpartition(" ")
    node = symbol_node(name.replace(">", "_at_"))
    return node if not factor else MathNode(tag="mrow", children=[symbol_node(factor), node])


def _node(text: str) -> MathNode | None:
    """Return a line of the hand method as MathML; its signs, such as × and ², are those of print, not of Python."""
    if not text:
        return None
    arithmetic = text.replace("×", "*").replace("²", " ** 2").replace(">", "_at_").replace("Δθ", "Δ_θ")
    return Expression(re.sub(r"\bk τ", "k * τ", arithmetic)).formula()
