"""The source documents in the studio: equations agree with Tarsus, errata with the page."""

import ast
import json
import math
import xml.etree.ElementTree as ET
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sample_studio import Asked
from tarsus import inverse_kinematics, list_robots, load_robot
from tarsus.load.handbook.method import handbook
from tarsus.robot.file import robot_to_dict
from tarsus.studio.messages.state import BodyState
from tarsus.studio.poses import standing
from tarsus.studio.sources.document import Step
from tarsus.studio.sources.errata import errata, rows_of_page
from tarsus.studio.sources.expression import FUNCTIONS, Expression, Quantity, symbol_node
from tarsus.studio.sources.live import Live
from tarsus.studio.sources.page import DOCUMENTS

PAGE = Path(__file__).parent.parent / "docs" / "sources.md"

POSE = {"x_mm": 8, "y_mm": -5, "z_mm": 6, "roll_deg": 3, "pitch_deg": -4, "yaw_deg": 7}


@cache
def with_robot(name):
    asked = Asked()
    asked.all("view", view="body")
    asked.all("robot", preset=name)
    return asked


def source(number, leg=0, robot="strider", **pose):
    asked = with_robot(robot)
    asked.all("body", body={**POSE, **pose})
    return asked("source", "source", source={"number": number, "leg": leg})


@pytest.mark.parametrize("robot", list_robots()[::3])
@pytest.mark.parametrize("number", DOCUMENTS)
def test_equations_agree_with_tarsus(number, robot):
    how = standing(load_robot(robot), BodyState(**POSE))
    for leg in (0, 4):
        answer, numbers = source(number, leg, robot), Live.of(how, leg)
        compared = 0
        for equation, line in zip(answer["equations"], DOCUMENTS[number].lines, strict=False):
            if isinstance(line, Step) and line.number is not None:
                ours = Quantity(float(line.number(numbers)), line.unit).shown
                apart = equation["value"] - ours
                apart = math.remainder(apart, 360) if line.unit == "deg" else apart
                assert apart == pytest.approx(0, abs=1e-4), line
                assert equation["note"] is None
                compared += 1
        assert compared >= 3


def test_unsupported_offsets_are_noted():
    robot = load_robot("strider")
    offset = robot.replace(femur_axis_offset=np.tile([0.02, 0.0], (6, 1)), name="offset")
    asked = Asked()
    asked.all("document", document=robot_to_dict(offset))
    answer = asked("source", "source", source={"number": "000", "leg": 0})
    assert "20.0 mm beside its coxa axis; the document has no such offset" in answer["about"]
    assert any(equation["note"] and equation["note"].startswith("Tarsus has coxa") for equation in answer["equations"])
    knows = asked("source", "source", source={"number": "001", "leg": 0})
    assert "no such offset" not in knows["about"]
    assert not any(equation["note"] for equation in knows["equations"])


def test_the_knee_down_branch_is_noted():
    notes = [equation["note"] for equation in source("004", knee="down")["equations"][:15]]
    assert any(note and note.startswith("Tarsus has femur") for note in notes)


def test_the_hand_method_is_that_of_the_handbook():
    answer = {equation["key"]: equation for equation in source("004")["equations"]}
    for line in handbook(load_robot("strider"), leg=0).lines:
        assert answer[line.key]["value"] == pytest.approx(line.value, rel=1e-6, abs=1e-9)
        assert answer[line.key]["printed_value"] == line.printed
        assert (answer[line.key]["formula"] is None) == (not line.formula)
    assert len(source("004", robot="mithi")["equations"]) == len(DOCUMENTS["004"].lines)


def test_the_hand_method_is_shown_for_three_and_for_five_feet():
    answer = {equation["key"]: equation for equation in source("004")["equations"]}
    lines = [
        line for line in handbook(load_robot("strider"), leg=0, feet_down=5).lines if line.key[:4] in ("stan", "walk")
    ]
    assert len(lines) >= 6
    for line in lines:
        assert answer[f"{line.key}.5"]["value"] == pytest.approx(line.value, rel=1e-6, abs=1e-9)
    assert "given" not in {equation["name"] for equation in answer.values()}
    assert answer["stance.load.5"]["name"] == "standing on five feet"
    assert answer["stance.load.5"]["value"] == pytest.approx(3.26536, abs=1e-5)


def values(answer):
    return {equation["key"].partition(".")[2]: equation["value"] for equation in answer["equations"]}


@pytest.mark.parametrize("leg", range(6))
def test_walks_of_source_001_are_those_of_the_view_walk(leg):
    asked = Asked()
    asked.all("view", view="sources")

    def numbers(**walk):
        asked.all("walk", walk={"stroke_mm": 60, **walk})
        return values(asked("source", "source", source={"number": "001", "leg": leg}))

    straight = numbers(path={"kind": "straight", "distance_mm": 300, "heading_deg": 90})
    # To the left, which is the document's -x: half a stroke before and behind the foothold.
    assert straight["n"] == pytest.approx(5)
    assert [straight["a_x"], straight["a_y"]] == pytest.approx([straight["E_x"] - 30, straight["E_y"]], abs=1e-3)
    assert [straight["d_x"], straight["d_y"]] == pytest.approx([straight["E_x"] + 30, straight["E_y"]], abs=1e-3)
    curve = numbers(path={"kind": "curve", "angle_deg": -40, "centre_mm": [100, -200]})
    assert (curve["A_c"], curve["X_C"], curve["Y_C"]) == (-40, 200, 100)
    ends = np.array([[curve[f"{axis}_{end}"] for axis in "XY"] for end in "da"])
    radii = np.hypot(*(ends - [200, 100]).T)
    assert radii == pytest.approx(curve["CP"], abs=1e-3)
    assert 60 * curve["CP"] / curve["CP_max"] == pytest.approx(curve["CP"] * math.radians(curve["T"]), rel=1e-6)


def test_the_rotation_of_source_003_is_a_rotation():
    answer = values(source("003"))
    entries = np.array([[answer[f"R_{row}{column}"] for column in (1, 2, 3)] for row in (1, 2, 3)])
    assert entries @ entries.T == pytest.approx(np.eye(3), abs=1e-5)
    assert np.linalg.det(entries) == pytest.approx(1, abs=1e-5)


def test_errata_agree_with_the_page():
    assert errata() == rows_of_page(PAGE.read_text(encoding="utf-8")), (
        "run: python -m tarsus.studio.sources.errata docs/sources.md"
    )
    assert {row.number for row in errata()} == set(DOCUMENTS)


@pytest.mark.parametrize("number", DOCUMENTS)
def test_errata_are_listed_and_printed_formulas_give_other_values(number):
    answer, rows = source(number)["errata"], [row for row in errata() if row.number == number]
    assert [erratum["reason"] for erratum in answer] == [row.reason for row in rows]
    assert set(DOCUMENTS[number].slips) <= {row.test for row in rows}
    in_numbers = [erratum for erratum in answer if erratum["correct_formula"]]
    assert in_numbers
    for erratum in in_numbers:
        if "whole translation" not in erratum["printed"]:  # on strider's circle it makes no difference
            assert erratum["printed_value"] != pytest.approx(erratum["correct_value"], rel=1e-5)


def test_an_erratum_that_cannot_be_evaluated_has_no_value():
    answer = source("001", pitch_deg=0, roll_deg=0)["errata"]
    slope = next(erratum for erratum in answer if "1 / tan" in erratum["printed"])
    assert (slope["printed_value"], slope["correct_value"]) == (None, 0)


def test_a_leg_out_of_reach_is_shown_at_its_position():
    answer = source("000", z_mm=150)
    robot = load_robot("strider")
    how = standing(robot, BodyState(**{**POSE, "z_mm": 150}))
    assert np.asarray(how.solution.reach).any()
    angle = next(equation["value"] for equation in answer["equations"] if equation["ours"] == "coxa")
    found = inverse_kinematics(robot, np.asarray(how.solution.feet), how.body)
    assert angle == pytest.approx(math.degrees(found.angles[0, 0]), abs=1e-4)


NAMES = {name: Quantity(value, "") for name, value in (("a", 2.0), ("b", -0.5), ("c_2", 3.0), ("theta", 0.25))}
leaves = st.sampled_from([*NAMES, "2", "0.5", "pi"])
expressions = st.recursive(
    leaves,
    lambda inner: (
        st.builds("({} {} {})".format, inner, st.sampled_from(["+", "-", "*"]), inner)
        | st.builds("-{}".format, inner)
        | st.builds("({}) ** 2".format, inner)
        | st.builds("sin({})".format, inner)
        | st.builds("atan2({}, {})".format, inner, inner)
    ),
    max_leaves=12,
)


@given(expressions)
def test_expressions_are_evaluated_like_python(text):
    plain = {name: quantity.value for name, quantity in NAMES.items()}
    expected = eval(text, {"sin": math.sin, "atan2": math.atan2, "pi": math.pi}, plain)
    assert Expression(text).value(NAMES) == pytest.approx(expected, rel=1e-12)


@given(expressions)
def test_displayed_text_parses_to_the_same_expression(text):
    """The MathML, its brackets included, is turned back into arithmetic: nothing may bind otherwise than it did."""
    plain = {"α": None, **{name.replace("c_2", "c2"): quantity.value for name, quantity in NAMES.items()}}
    plain["θ"] = plain["theta"]
    shown = arithmetic(Expression(text).formula())
    expected = Expression(text).value(NAMES)
    again = eval(shown, {"sin": math.sin, "atan2": math.atan2, "π": math.pi}, plain)
    assert again == pytest.approx(expected, rel=1e-9, abs=1e-12)


def arithmetic(node):
    children = [arithmetic(child) for child in node.children]
    match node.tag:
        case "mfrac":
            return f"(({children[0]}) / ({children[1]}))"
        case "msup":
            return f"{children[0]} ** {children[1]}"
        case "msub":
            return "".join(children)
        case "msqrt":
            return f"math.sqrt({children[0]})"
        case "mrow":
            return " ".join(children)
    return {"−": "-", "·": "*"}.get(node.text, node.text)


def test_values_replace_symbols():
    quantities = {"L": Quantity(0.098, "mm"), "q": Quantity(math.radians(-30), "deg"), "n": Quantity(2.0, "")}
    numbers = Expression("L * cos(q) - n ** 2").numbers(quantities)
    texts = [child.text for child in walk(numbers) if child.text]
    assert texts == ["98", "·", "cos", "(", "−30°", ")", "−", "2", "2"]


def walk(node):
    yield node
    for child in node.children:
        yield from walk(child)


@pytest.mark.parametrize(
    ("name", "text"), [("theta_C", "θC"), ("L1", "L1"), ("Px_a3", "Pxa3"), ("alpha", "α"), ("C_Angle", "CAngle")]
)
def test_symbols_are_typeset(name, text):
    node = symbol_node(name)
    assert "".join(part.text for part in walk(node) if part.text) == text


@pytest.mark.parametrize("bad", ["__import__('os')", "a.b", "[1]", "a < b", "lambda: 1", "'text'"])
def test_equations_allow_arithmetic_only(bad):
    with pytest.raises((SyntaxError, KeyError)):
        Expression(bad).value(NAMES)


def test_every_formula_is_well_formed_mathml():
    for number in DOCUMENTS:
        answer = source(number)
        for equation in answer["equations"]:
            for part in ("symbol", "formula", "numbers"):
                if equation[part]:
                    ET.fromstring(xml(equation[part]))
    assert set(FUNCTIONS) >= {
        node.func.id
        for document in DOCUMENTS.values()
        for line in document.lines
        if isinstance(line, Step)
        for node in ast.walk(ast.parse(line.formula))
        if isinstance(node, ast.Call)
    }


def xml(node):
    needed = {"mfrac": 2, "msup": 2, "msub": 2, "msqrt": 1}
    if node["tag"] in needed:
        assert len(node["children"]) == needed[node["tag"]]
    assert bool(node["text"]) != bool(node["children"]), json.dumps(node)
    inside = node["text"] or "".join(xml(child) for child in node["children"])
    return f"<{node['tag']}>{inside}</{node['tag']}>"
