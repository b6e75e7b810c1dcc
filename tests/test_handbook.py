"""The hand calculation of source 004: printed numbers, corrected numbers, comparison with statics, docs/handbook.md."""

import contextlib
import dataclasses
import io
import math
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sample_robots import hexapod, random_hexapod
from tarsus import (
    Gait,
    InputError,
    MissingDataError,
    Pose,
    UnknownNameError,
    centre_of_mass,
    forward_kinematics,
    leg_jacobian,
    load_robot,
    stack_robots,
)
from tarsus.load.handbook.comparison import ComparisonRow
from tarsus.load.handbook.lines import Line, Term, plain_number
from tarsus.load.handbook.method import handbook
from tarsus.load.handbook.page import TABLES, docs_page
from tarsus.load.handbook.statics import compare_with_statics, minimal_contacts
from tarsus.load.torque import joint_torques
from tarsus.robot.robot import JOINTS

PAGE = Path(__file__).parents[1] / "docs" / "handbook.md"
STRIDER = load_robot("strider")
FACTS = settings(max_examples=25, deadline=None)

# The numbers of the document, to its digits, transcribed independently of the package.
FREE = {
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
DOWN = {
    3: {
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
    },
    5: {
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
    },
}
# Rows of source 004 that are correct as printed, and the corrected values of the others.
RIGHT_AS_PRINTED = {
    *("weight.body", "weight.coxa", "weight.femur", "weight.tibia", "swing.tibia", "swing.acceleration"),
    *("inertia.femur", "inertia.tibia", "inertia.tibia_at_coxa", "stance.l_femur_out"),
    *("stance.mass", "stance.weight", "stance.load", "stance.femur", "stance.tibia", "walk.acceleration_torque"),
}
CORRECTED = {
    3: {
        "swing.femur": "0.2148",
        "inertia.coxa": "0.000061",
        "inertia.femur_at_coxa": "0.002318",
        "inertia.leg": "0.00736",
        "swing.gravity": "0.00000",
        "swing.inertia": "0.00771",
        "swing.coxa": "0.00771",
        "swing.bending": "0.38808",
        "walk.inertia": "0.01921",
        "walk.inertia_torque": "0.02011",
        "walk.coxa": "0.2116",
        "walk.coxa_with_factor": "0.6347",
    },
    5: {
        "walk.inertia": "0.01437",
        "walk.inertia_torque": "0.01505",
        "walk.coxa": "0.1583",
        "walk.coxa_with_factor": "0.4750",
    },
}


def as_printed(text):
    """Approximately equal, to within rounding or truncation to that many digits."""
    return pytest.approx(float(text), rel=0, abs=10.0 ** -len(text.split(".")[1]))


def seeded(seed, **options):
    return random_hexapod(np.random.default_rng(seed), **options)


def evaluated(text):
    """Value of an arithmetic expression."""
    return eval(text.replace("×", "*").replace("²", "**2"), {"__builtins__": {}})


# The robot of the document


@pytest.mark.parametrize("feet_down", [3, 5])
def test_printed_numbers_are_reproduced(feet_down):
    hand = handbook(STRIDER, feet_down=feet_down, corrected=False)
    for key, text in (FREE | DOWN[feet_down]).items():
        assert hand.value(key) == as_printed(text), key
        assert hand.line(key).printed == text
        assert hand.line(key).agrees is True
    unprinted = {line.key for line in hand.lines if line.printed is None}
    assert unprinted == {"swing.bending"}


@pytest.mark.parametrize("feet_down", [3, 5])
def test_corrected_numbers(feet_down):
    hand = handbook(STRIDER, feet_down=feet_down)
    for key, text in CORRECTED[feet_down].items():
        assert hand.value(key) == as_printed(text), key
    for key in RIGHT_AS_PRINTED:
        assert hand.value(key) == as_printed((FREE | DOWN[feet_down])[key]), key
    printed = {line.key: line.agrees for line in hand.lines if not line.key.startswith("given.")}
    assert {key for key, agrees in printed.items() if agrees} == RIGHT_AS_PRINTED
    wrong = {key for key, agrees in printed.items() if agrees is False}
    assert wrong == (FREE | DOWN[feet_down]).keys() - RIGHT_AS_PRINTED
    assert all(hand.line(key).note for key in wrong)


def test_corrected_lines_by_plain_arithmetic():
    body, coxa, femur, tibia, g = 1.386, 0.04, 0.16, 0.08, 9.8
    alpha = 4 * (math.pi / 3) / 2**2
    femur_at, tibia_at = 0.068 + 0.049, 0.068 + 0.098 + 0.078
    rods = {
        "inertia.coxa": 0.33 * coxa * 0.068**2,
        "inertia.femur": 0.0833 * femur * 0.098**2,
        "inertia.tibia": 0.0833 * tibia * 0.181**2,
    }
    rods["inertia.femur_at_coxa"] = rods["inertia.femur"] + femur * femur_at**2
    rods["inertia.tibia_at_coxa"] = rods["inertia.tibia"] + tibia * tibia_at**2
    leg = rods["inertia.coxa"] + rods["inertia.femur_at_coxa"] + rods["inertia.tibia_at_coxa"]
    free = rods | {
        "swing.femur": femur * g * 0.049 + tibia * g * (0.098 + 0.078),
        "swing.tibia": tibia * g * 0.078,
        "swing.acceleration": alpha,
        "inertia.leg": leg,
        "swing.inertia": leg * alpha,
        "swing.bending": g * (coxa * 0.034 + femur * femur_at + tibia * tibia_at),
        "swing.gravity": 0.0,
        "swing.coxa": leg * alpha,
    }
    for feet_down in (3, 4, 5, 6):
        mass = body + (6 - feet_down) * 0.28
        load = mass * g / feet_down
        cube = 0.1666 * mass * 0.086**2 + mass * 0.086**2
        down = {
            "stance.mass": mass,
            "stance.weight": mass * g,
            "stance.load": load,
            "stance.femur": coxa * g * 0.034 + load * (0.068 + 0.086),
            "stance.tibia": femur * g * 0.0345 + coxa * g * (0.069 + 0.034) + load * (0.069 + 0.068 + 0.086),
            "walk.inertia": cube,
            "walk.inertia_torque": cube * alpha,
            "walk.acceleration_torque": mass * 1.0 * 0.086,
            "walk.coxa": mass * 0.086 + cube * alpha,
            "walk.coxa_with_factor": 3 * (mass * 0.086 + cube * alpha),
        }
        hand = handbook(STRIDER, feet_down=feet_down)
        for key, value in (free | down).items():
            # The radius of the preset is 85.99984 mm.
            assert hand.value(key) == pytest.approx(value, rel=5e-6, abs=0), key


def test_errors_of_the_document():
    tripod, wave = (handbook(STRIDER, feet_down=feet, corrected=False) for feet in (3, 5))
    assert tripod.line("swing.femur").substitution == "1.568 × 0.034 + 0.784 × (0.098 + 0.078)"
    assert tripod.line("inertia.femur_at_coxa").substitution == "0.000128 + 0.16 / 10 × (0.068 + 0.049)²"
    assert tripod.line("inertia.coxa").value == pytest.approx(0.08 * 0.068**2 / 3)
    assert tripod.line("walk.inertia").substitution == "0.1666 × 2.226 × 0.086 + 2.226 × 0.086²"
    assert tripod.line("walk.coxa").substitution == "0.191436 + 0.0506"
    assert wave.line("walk.coxa").substitution == "0.143276 + 0.0362"
    assert wave.line("walk.coxa").formula == "τ_acceleration + I_cube"
    assert "adds the moment of inertia" in wave.line("walk.coxa").note
    assert "adds the moment of inertia" not in tripod.line("walk.coxa").note
    assert tripod.line("stance.tibia").substitution == (
        "1.568 × 0.0345 + 0.392 × (0.069 + 0.034) + 7.2716 × (0.069 + 0.068 + 0.086)"
    )


@pytest.mark.parametrize(
    "changes",
    [{"gravity": 9.81}, {"safety_factor": 2.0}, {"feet_down": 4}, {"sweep": 1.0}, {"femur_out": 0.07}],
)
def test_no_printed_numbers_for_other_parameters(changes):
    hand = handbook(STRIDER, corrected=False, **changes)
    assert {line.printed for line in hand.lines} == {None}
    assert {line.agrees for line in hand.lines} == {None}


def test_no_printed_numbers_for_other_robots():
    heavier = STRIDER.replace(body_mass=1.5)
    assert {line.printed for line in handbook(heavier).lines} == {None}
    # The errors are reproduced with that robot's numbers: the coxa's lever arm, with full digits.
    hand = handbook(heavier, corrected=False)
    assert hand.value("swing.femur") == pytest.approx(0.191296, rel=1e-9)
    assert hand.value("inertia.leg") == pytest.approx(0.00545153, rel=1e-5)


def test_no_printed_numbers_for_eight_legs():
    names = ("mount_position", "mount_yaw", "coxa", "femur", "tibia", "limits", "link_com", "link_mass")
    eight = {name: np.concatenate([getattr(STRIDER, name), getattr(STRIDER, name)[:2]]) for name in names}
    robot = hexapod(**eight, leg_names=tuple("ABCDEFGH"), body_mass=STRIDER.body_mass)
    hand = handbook(robot, corrected=False)
    assert {line.printed for line in hand.lines} == {None}
    assert hand.value("stance.mass") == pytest.approx(1.386 + 5 * 0.28)


# Titles, tables, lookups


def test_gait_names_follow_the_literature():
    names = {feet: handbook(STRIDER, feet_down=feet).gait for feet in (3, 4, 5, 6)}
    assert names[3] == "tripod gait"
    assert "tetrapod gait, or ripple gait" in names[4]
    assert names[5] == 'wave gait (source 004\'s "ripple")'
    assert names[6] == "standing on all feet"
    four = hexapod(
        **{name: getattr(hexapod(), name)[:5] for name in ("mount_position", "mount_yaw", "coxa", "femur", "tibia")},
        **{name: getattr(hexapod(), name)[:5] for name in ("limits", "link_com", "link_mass")},
        leg_names=tuple("ABCDE"),
    )
    assert handbook(four, feet_down=3).gait == "3 feet down"
    assert handbook(four, feet_down=4).gait.startswith("wave")


def test_title_names_the_representative_leg():
    assert handbook(STRIDER).title == (
        "strider: 3 of 6 feet down, tripod gait; every leg taken as the front left one, errors corrected"
    )
    assert handbook(STRIDER, leg=4, corrected=False).title.endswith(
        "every leg taken as the middle right one, as printed"
    )


def test_table_has_a_row_for_each_line():
    hand = handbook(STRIDER)
    header, *rows = hand.table()
    assert {len(row) for row in rows} == {len(header)}
    assert [row[0] for row in rows] == [line.key for line in hand.lines]
    row = dict(zip(header, next(row for row in rows if row[0] == "swing.femur"), strict=True))
    assert row["with numbers"] == "1.568 × 0.049 + 0.784 × (0.098 + 0.078)"
    assert (row["value"], row["unit"], row["source 004"]) == ("0.214816", "N m", "0.1913")
    assert next(row for row in rows if row[0] == "swing.bending")[6] == ""


def test_joint_torques_with_and_without_the_factor():
    hand = handbook(STRIDER, safety_factor=2.5)
    assert hand.torque("coxa") == hand.value("walk.coxa")
    assert hand.torque("coxa", factor=True) == pytest.approx(hand.value("walk.coxa_with_factor"))
    assert hand.torque("femur") == hand.value("stance.femur")
    assert hand.torque("tibia", factor=True) == pytest.approx(2.5 * hand.value("stance.tibia"))
    with pytest.raises(UnknownNameError, match="no joint is called 'knee'"):
        hand.torque("knee")
    with pytest.raises(UnknownNameError, match=re.escape("Did you mean 'stance.femur'?")):
        hand.value("stance.femurs")


def test_keys_are_unique_and_symbols_are_defined_before_use():
    for corrected in (True, False):
        hand = handbook(STRIDER, feet_down=5, corrected=corrected)
        assert len({line.key for line in hand.lines}) == len(hand.lines)
        known = {"g", "Δθ", "t", "a", "k", "n_up", "n_down"}
        for line in hand.lines:
            names = set(re.findall(r"[^\W\d][\w>]*", line.formula.replace("²", "")))
            assert names <= known, line.key
            known.add(line.symbol)


# Any robot


@FACTS
@given(seed=st.integers(0, 10**6), feet_down=st.integers(3, 6), corrected=st.booleans())
def test_substitutions_evaluate_to_the_value(seed, feet_down, corrected):
    hand = handbook(seeded(seed), feet_down=feet_down, corrected=corrected)
    results = [line for line in hand.lines if line.formula]
    assert len(results) == 28
    for line in results:
        # Lengths are shown to 0.1 mm; the shortest are a few millimetres.
        rounding = 5e-5 if line.unit == "m" else 5e-6
        assert evaluated(line.substitution) == pytest.approx(line.value, rel=0.02, abs=rounding), line.key


@FACTS
@given(seed=st.integers(0, 10**6), scale=st.floats(0.1, 10), corrected=st.booleans(), feet_down=st.integers(3, 6))
def test_results_scale_with_the_masses(seed, scale, corrected, feet_down):
    robot = seeded(seed)
    heavier = robot.replace(body_mass=robot.body_mass * scale, link_mass=robot.link_mass * scale)
    light, heavy = (handbook(r, corrected=corrected, feet_down=feet_down) for r in (robot, heavier))
    assert heavy.leg == light.leg
    for line in light.lines:
        expected = line.value * (1 if line.unit in ("m", "rad/s²") else scale)
        assert heavy.value(line.key) == pytest.approx(expected, rel=1e-9, abs=1e-15)


@FACTS
@given(seed=st.integers(0, 10**6), scale=st.floats(0.1, 10))
def test_weights_scale_with_gravity_and_inertia_does_not(seed, scale):
    robot = seeded(seed)
    here, there = handbook(robot), handbook(robot, gravity=9.8 * scale)
    for line in here.lines:
        is_weight = line.key.startswith("weight.") or line.key in (
            *("swing.femur", "swing.tibia", "swing.bending"),
            *("stance.weight", "stance.load", "stance.femur", "stance.tibia"),
        )
        assert there.value(line.key) == pytest.approx(line.value * (scale if is_weight else 1), rel=1e-9)


@FACTS
@given(seed=st.integers(0, 10**6))
def test_feet_on_the_ground_share_the_load(seed):
    robot = seeded(seed)
    hands = [handbook(robot, feet_down=feet, leg=2) for feet in (3, 4, 5, 6)]
    for hand in hands:
        assert hand.value("stance.load") * hand.feet_down == pytest.approx(hand.value("stance.mass") * 9.8)
    masses = [hand.value("stance.mass") for hand in hands]
    assert -np.diff(masses) == pytest.approx([robot.link_mass[2].sum()] * 3)
    assert masses[-1] == pytest.approx(float(robot.body_mass))
    for joint in ("femur", "tibia"):
        assert (np.diff([hand.torque(joint) for hand in hands]) < 0).all()


def test_walking_torque_scales_with_acceleration_and_sweep():
    slow, fast = handbook(STRIDER), handbook(STRIDER, acceleration=2.0, sweep_time=1.0)
    assert fast.value("walk.acceleration_torque") == pytest.approx(2 * slow.value("walk.acceleration_torque"))
    assert fast.value("walk.inertia_torque") == pytest.approx(4 * slow.value("walk.inertia_torque"))
    assert handbook(STRIDER, sweep=math.pi / 6).value("swing.acceleration") == pytest.approx(math.pi / 6)


@FACTS
@given(seed=st.integers(0, 10**6))
def test_default_leg_has_the_largest_femur_torque(seed):
    robot = seeded(seed)
    by_leg = [handbook(robot, leg=leg).torque("femur") for leg in range(6)]
    worst = handbook(robot)
    assert worst.torque("femur") == max(by_leg)
    assert worst.leg == int(np.argmax(by_leg))


def test_horizontal_length_of_the_femur():
    assert handbook(STRIDER).value("given.L_femur_out") == 0.069
    longer = STRIDER.replace(femur=np.full(6, 0.15))
    assert handbook(longer).value("given.L_femur_out") == round(0.15 / math.sqrt(2), 3)
    given_arm = handbook(STRIDER, femur_out=0.08)
    assert given_arm.value("given.L_femur_out") == 0.08
    assert given_arm.value("stance.l_femur_out") == pytest.approx(0.04)
    more = given_arm.value("stance.tibia") - handbook(STRIDER).value("stance.tibia")
    assert more == pytest.approx(1.568 * 0.0055 + 0.392 * 0.011 + 7.2716 * 0.011)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"feet_down": 2}, "feet_down is 2; it must be a whole number from 3 to 6"),
        ({"feet_down": 7}, "feet_down is 7"),
        ({"feet_down": 3.5}, "feet_down is 3.5"),
        ({"feet_down": math.nan}, "feet_down is nan"),
        ({"leg": 6}, "leg is 6; it must be from 0 to 5"),
        ({"leg": -1}, "leg is -1"),
        ({"gravity": 0.0}, "gravity is 0.0; it must be a finite number greater than 0"),
        ({"sweep": -1.0}, "sweep is -1.0"),
        ({"sweep_time": math.inf}, "sweep_time is inf"),
        ({"acceleration": math.nan}, "acceleration is nan"),
        ({"safety_factor": -3.0}, "safety_factor is -3.0"),
        ({"femur_out": 0.0}, "femur_out is 0.0"),
    ],
)
def test_invalid_arguments(options, message):
    with pytest.raises(InputError, match=re.escape(message)):
        handbook(STRIDER, **options)


def test_robot_without_masses_and_batch():
    with pytest.raises(MissingDataError, match=re.escape("[body] mass_kg and [leg] mass_kg missing")):
        handbook(hexapod(body_mass=None, link_mass=None))
    with pytest.raises(InputError, match=re.escape("not a batch (2,)")):
        handbook(stack_robots([STRIDER, STRIDER]))


@pytest.mark.parametrize("name", ["phantomx", "ch3r", "makeyourpet"])
def test_other_presets_with_masses(name):
    robot = load_robot(name)
    hand = handbook(robot)
    leg = hand.leg
    load = 9.8 * (robot.body_mass + 3 * robot.link_mass[leg].sum()) / 3
    arm = robot.coxa[leg] + math.hypot(*robot.mount_position[leg, :2])
    expected = 9.8 * robot.link_mass[leg, 0] * robot.link_com[leg, 0] + load * arm
    assert hand.torque("femur") == pytest.approx(expected)


# Terms


def test_brackets_follow_the_precedence():
    a, b, c = (Term(float(value), name, str(value)) for name, value in (("a", 2), ("b", 3), ("c", 4)))
    cases = {
        "a + b × c": a + b * c,
        "(a + b) × c": (a + b) * c,
        "a × (b + c)": a * (b + c),
        "a / (b × c)": a / (b * c),
        "a / b × c": a / b * c,
        "(a × b)²": (a * b).squared(),
        "a × b²": a * b.squared(),
        "a + b + c": a + (b + c),
    }
    for text, term in cases.items():
        assert term.symbols == text
        assert evaluated(term.numbers) == term.value
    assert Term.number(0.5) * a == Term(1.0, "0.5 × a", "0.5 × 2", 2)


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (0.08599984, "m", "0.086"),
        (0.08599984, "N", "0.0859998"),
        (0.0000610368, "kg m²", "0.0000610368"),
        (21.8148, "N", "21.8148"),
        (0.0, "N m", "0"),
        (3.0, "", "3"),
    ],
)
def test_number_format(value, unit, text):
    assert plain_number(value, unit) == text


@pytest.mark.parametrize(
    ("value", "printed", "agrees"),
    [
        (0.24203, "0.2420", True),
        (0.2421, "0.2420", False),
        (0.0484, "0.04835", False),
        (2.0, "2", True),
        (1, None, None),
    ],
)
def test_line_agrees_if_it_rounds_or_truncates_to_the_printed_number(value, printed, agrees):
    line = Line(key="k", symbol="s", formula="", substitution="", value=value, unit="N m", printed=printed)
    assert line.agrees is agrees


# Comparison with statics


def test_swing_torques_are_the_statics_of_a_stretched_leg():
    hand = handbook(STRIDER)
    lifted = np.array([True, False, True, True, True, True])
    torques, _ = joint_torques(STRIDER, np.zeros((6, 3)), Pose(), lifted, gravity=(0, 0, -9.8))
    assert torques[1] == pytest.approx([0.0, hand.value("swing.femur"), hand.value("swing.tibia")], rel=1e-9, abs=1e-12)
    angles = np.random.default_rng(5).uniform(-1.5, 1.5, (500, 6, 3))
    others = np.abs(joint_torques(STRIDER, angles, Pose(), lifted, gravity=(0, 0, -9.8))[0][:, 1])
    assert (others.max(0)[1:] <= torques[1, 1:]).all()


def test_bending_moment_is_the_coxa_torque_of_a_robot_on_its_side():
    """Legs pointing forward, with gravity along the body's y axis."""
    robot = STRIDER.replace(mount_yaw=np.zeros(6))
    torques, _ = joint_torques(
        robot, np.zeros((6, 3)), Pose(), np.ones(6, dtype=bool), gravity=(0, -9.8, 0), forces=np.zeros((6, 3))
    )
    bending = handbook(STRIDER).value("swing.bending")
    assert torques[:, 0] == pytest.approx(np.full(6, bending), rel=1e-9)


def plain_torques(robot, angles, body, contacts, gravity):
    """Statics of one sample in plain steps: least-squares contact forces, Jacobians, weights."""
    strength = float(np.linalg.norm(gravity))
    up = -np.asarray(gravity) / strength
    points = forward_kinematics(robot, angles)
    mass = float(robot.body_mass + robot.link_mass.sum())
    arms = points[:, 3] - centre_of_mass(robot, angles)
    moments = np.cross(arms[contacts], up)
    fractions = np.linalg.lstsq(
        np.vstack([np.ones(contacts.sum()), moments.T]), np.array([mass * strength, 0, 0, 0]), rcond=None
    )[0]
    assert fractions.min() >= -1e-9
    forces = np.zeros((6, 3))
    forces[contacts] = fractions[:, None] * up
    torques = -np.einsum("lij,li->lj", leg_jacobian(robot, angles), forces)
    step = 1e-6
    for joint in range(3):
        high, low = (forward_kinematics(robot, angles + sign * step * np.eye(3)[joint]) for sign in (1, -1))
        for link in range(3):
            fraction = robot.link_com[:, link] / np.linalg.norm(points[:, link + 1] - points[:, link], axis=-1)
            moved = (high - low)[:, link] * (1 - fraction)[:, None] + (high - low)[:, link + 1] * fraction[:, None]
            torques[:, joint] += robot.link_mass[:, link] * (moved @ up) / (2 * step) * strength
    return np.abs(torques), np.linalg.norm(forces, axis=-1)


@pytest.fixture(scope="module")
def tripod():
    return compare_with_statics(STRIDER, gait="tripod")


@pytest.fixture(scope="module")
def wave():
    return compare_with_statics(STRIDER, gait=Gait.named("wave"))


@pytest.mark.parametrize("gait", ["tripod", "wave"])
@pytest.mark.parametrize(("case", "push"), [("walking", 0.0), ("accelerating", 1.0)])
def test_peaks_match_plain_statics(gait, case, push, request):
    comparison = request.getfixturevalue(gait)
    motion = comparison.motion
    for joint in ("coxa", "femur", "tibia"):
        row = comparison.row(case, joint)
        sample, leg = int(np.argmin(np.abs(motion.time - row.time))), STRIDER.leg_codes.index(row.leg)
        samples = {sample, *range(0, len(motion.time), 97)}
        peaks = {}
        for n in samples:
            both = [
                plain_torques(STRIDER, motion.angles[n], motion.body[n], motion.contacts[n], (sign * push, 0, -9.8))[0]
                for sign in (1, -1)
            ]
            peaks[n] = np.where(motion.contacts[n, :, None], np.max(both, axis=0), 0.0)[:, JOINTS.index(joint)]
        assert row.statics == pytest.approx(peaks[sample][leg], rel=1e-6, abs=1e-8)
        assert max(peak.max() for peak in peaks.values()) <= row.statics + 1e-6


def test_standing_uses_the_worst_contact_pattern(wave):
    angles, body = wave.motion.angles[0], wave.motion.body[0]
    found = [plain_torques(STRIDER, angles, body, np.arange(6) != lifted, (0, 0, -9.8)) for lifted in range(6)]
    femur = max(float(torques[np.arange(6) != lifted, 1].max()) for lifted, (torques, _) in enumerate(found))
    assert wave.row("standing", "femur").statics == pytest.approx(femur, rel=1e-6)
    load = max(float(forces.max()) for _, forces in found)
    assert wave.row("standing", "foot load").statics == pytest.approx(load)
    assert wave.row("standing", "femur").time is None
    feet = forward_kinematics(STRIDER, angles)
    arm = np.hypot(*(feet[:, 3] - feet[:, 1])[:, :2].T)
    assert wave.row("standing", "lever arm about the femur axis").statics == pytest.approx(arm.max())
    assert wave.row("standing", "lever arm about the knee").statics == pytest.approx(
        np.hypot(*(feet[:, 3] - feet[:, 2])[:, :2].T).max()
    )


def test_swing_legs_are_held_against_their_weight(wave):
    motion = wave.motion
    held = np.abs(
        joint_torques(
            STRIDER, motion.angles, motion.body, motion.contacts, gravity=(0, 0, -9.8), forces=np.zeros((6, 3))
        )[0]
    )
    held = np.where(motion.contacts[..., None], 0.0, held)
    for joint in ("femur", "tibia"):
        peaks = held[..., JOINTS.index(joint)].max(0)
        row = wave.row("leg in swing", joint)
        assert row.statics == pytest.approx(peaks.max())
        assert row.statics == pytest.approx(peaks[STRIDER.leg_codes.index(row.leg)], rel=2e-6)


def test_hand_values_are_those_of_the_handbook(tripod, wave):
    for comparison, feet in ((tripod, 3), (wave, 5)):
        hand = handbook(STRIDER, feet_down=feet)
        for case in ("standing", "walking", "accelerating"):
            for joint in JOINTS[case == "standing" :]:
                row = comparison.row(case, joint)
                assert (row.hand, row.with_factor) == (hand.torque(joint), hand.torque(joint, factor=True))
        assert comparison.row("leg in swing", "femur").hand == hand.value("swing.femur")
        assert comparison.row("leg in swing", "tibia").hand == hand.value("swing.tibia")
        assert comparison.row("walking", "foot load").hand == hand.value("stance.load")
        assert comparison.row("walking", "lever arm about the knee").hand == pytest.approx(0.223, abs=1e-6)


def test_verdicts_for_the_strider(tripod, wave):
    assert tripod.row("walking", "femur").verdict == "safe with the factor only"
    assert tripod.row("walking", "femur").ratio == pytest.approx(0.78, abs=0.02)
    assert tripod.row("walking", "tibia").verdict == "safe, oversized"
    assert tripod.row("walking", "coxa").verdict == "no load in statics"
    assert tripod.row("accelerating", "coxa").verdict == "safe"
    assert wave.row("walking", "femur").reserve == pytest.approx(1.33, abs=0.03)
    assert wave.row("leg in swing", "femur").verdict == "safe"
    low = compare_with_statics(STRIDER, gait="wave", body_height=0.04)
    assert low.row("accelerating", "femur").verdict == "unsafe"
    assert "too small even with the factor 3" in low.sentence("femur")


def test_sentences(tripod, wave):
    coxa, femur, tibia = tripod.sentences
    for sentence, row in ((femur, tripod.row("accelerating", "femur")), (tibia, tripod.row("accelerating", "tibia"))):
        assert f"{row.hand:.3f} N m by the hand method" in sentence
        assert f"up to {row.statics:.3f} N m by statics (accelerating, {row.leg})" in sentence
        assert "assumes 7.3 N at " in sentence
    assert f"of the factor 3, {tripod.row('accelerating', 'femur').reserve:.2f} remains" in femur
    assert "2.1 times the required torque" in tibia
    assert "sufficient, with an effective safety factor of" in wave.sentence("tibia")
    assert "0.000 N m by statics at constant speed on level ground; an acceleration of 1 m/s²" in coxa
    with pytest.raises(UnknownNameError, match="no joint is called 'knee'"):
        tripod.sentence("knee")
    with pytest.raises(UnknownNameError, match="no row of the comparison is called 'standing, coxa'"):
        tripod.row("standing", "coxa")


def test_tipping_robot(tripod):
    assert len(tripod.sentences) == 3
    assert min(tripod.margin.values()) > 0
    tipping = compare_with_statics(STRIDER.replace(body_com=[0.3, 0.0, 0.0]))
    assert tipping.margin["walking"] < 0
    sentences = tipping.sentences[3:]
    assert [sentence.partition(":")[0] for sentence in sentences] == [c for c, m in tipping.margin.items() if m < 0]
    assert f"{-tipping.margin['walking'] * 1000:.0f} mm outside its support polygon" in " ".join(sentences)


def row_of(hand, statics, factor=3.0):
    return ComparisonRow(
        case="walking", quantity="femur", unit="N m", hand=hand, statics=statics, factor=factor, leg="LF", time=0.0
    )


@pytest.mark.parametrize(
    ("hand", "statics", "verdict"),
    [
        (2.0, 1.0, "safe, oversized"),
        (1.9, 1.0, "safe"),
        (1.0, 1.0, "safe"),
        (0.9, 1.0, "safe with the factor only"),
        (1.0, 3.0, "safe with the factor only"),
        (0.3, 1.0, "unsafe"),
        (0.3, 0.0, "no load in statics"),
    ],
)
def test_verdict_boundaries(hand, statics, verdict, tripod):
    row = row_of(hand, statics)
    assert row.verdict == verdict
    assert row.reserve == pytest.approx(3 * row.ratio)
    sentences = dataclasses.replace(tripod, rows=(row,)).sentence("femur")
    conclusions = {
        "safe, oversized": "2.0 times the required torque, 6.0 times with the factor",
        "safe": "sufficient, with an effective safety factor of",
        "safe with the factor only": "too small; of the factor 3,",
        "unsafe": "too small even with the factor 3",
        "no load in statics": ": no load.",
    }
    assert conclusions[verdict] in sentences


def test_tables_of_the_comparison(tripod):
    header, *rows = tripod.table()
    assert {len(row) for row in rows} == {len(header)}
    assert [(row[0], row[1]) for row in rows] == [(row.case, row.quantity) for row in tripod.rows]
    by_name = {(row[0], row[1]): dict(zip(header, row, strict=True)) for row in rows}
    unloaded = by_name["walking", "coxa"]
    assert (unloaded["hand / statics"], unloaded["leg"], unloaded["at"]) == ("", "", "")
    femur = by_name["walking", "femur"]
    assert (femur["hand"], femur["hand x factor"], femur["verdict"]) == ("1.133", "3.399", "safe with the factor only")
    assert femur["at"] == f"{tripod.row('walking', 'femur').time:.2f} s"
    assert by_name["standing", "femur"]["at"] == ""
    loads = {(row[0], row[1]): row for row in tripod.table(reasons=True)[1:]}
    assert loads["walking", "foot load"][2:5] == ("N", "7.3", "")
    assert loads["walking", "lever arm about the knee"][-1] == ""


@pytest.mark.parametrize("name", ["tripod", "tetrapod", "ripple", "wave"])
def test_minimal_contacts(name):
    gait = Gait.named(name)
    patterns = minimal_contacts(gait)
    clock = (np.arange(997) + 0.5) / 997
    contacts = np.asarray(gait.phase(clock)[2])
    fewest = {tuple(row) for row in contacts if row.sum() == gait.fewest_feet_down}
    assert {tuple(row) for row in patterns} == fewest
    assert len(patterns) == len(fewest) == {"tripod": 2, "tetrapod": 3, "ripple": 6, "wave": 6}[name]


def test_heading_stroke_gravity_and_factor():
    comparison = compare_with_statics(
        STRIDER, gait="tripod", heading=math.pi / 2, stroke=0.05, gravity=3.7, acceleration=0.5, safety_factor=2.0
    )
    motion = comparison.motion
    assert motion.stroke == 0.05
    assert motion.body.position[-1] == pytest.approx([0.0, 1.0, motion.body_height], abs=1e-9)
    row = comparison.row("walking", "femur")
    on_earth = compare_with_statics(STRIDER, gait="tripod", heading=math.pi / 2, stroke=0.05)
    assert row.statics == pytest.approx(on_earth.row("walking", "femur").statics * 3.7 / 9.8)
    assert row.hand == pytest.approx(on_earth.row("walking", "femur").hand * 3.7 / 9.8)
    assert row.factor == 2.0
    push = comparison.row("accelerating", "coxa")
    sample, leg = int(np.argmin(np.abs(motion.time - push.time))), STRIDER.leg_codes.index(push.leg)
    moment = (motion.angles[sample], motion.body[sample], motion.contacts[sample])
    sideways = [plain_torques(STRIDER, *moment, (0, sign * 0.5, -3.7))[0][leg, 0] for sign in (1, -1)]
    assert push.statics == pytest.approx(max(sideways), rel=1e-6)
    assert push.statics == pytest.approx(on_earth.row("accelerating", "coxa").statics / 2, rel=0.1)
    with pytest.raises(InputError, match="feet_down is 2"):
        compare_with_statics(STRIDER, gait=Gait(duty_factor=0.4, offsets=(0.0, 0.3, 0.6, 0.0, 0.3, 0.6)))


# docs/handbook.md


def test_tables_of_the_page_are_current():
    page = PAGE.read_text(encoding="utf-8")
    names = re.findall(r"<!-- table: (.*?) -->", page)
    assert sorted(names) == sorted(TABLES)
    assert docs_page(page, STRIDER) == page, "docs/handbook.md is outdated: run docs/refresh.py"


def test_unknown_table():
    with pytest.raises(UnknownNameError, match=re.escape("no table is called 'tripods'. Did you mean 'tripod'?")):
        docs_page("<!-- table: tripods -->\n<!-- end -->", STRIDER)


def test_page_of_another_robot():
    longer = STRIDER.replace(coxa=np.full(6, 0.07))
    page = docs_page("before\n<!-- table: given -->\nold\n<!-- end -->\nafter\n", longer)
    assert page.startswith("before\n<!-- table: given -->\n| key |")
    assert page.endswith("\n<!-- end -->\nafter\n")
    assert "old" not in page
    assert "| `given.L_coxa` | L_coxa |  | 0.07 m |  |  |" in page


def test_example_on_the_page():
    (example,) = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), flags=re.DOTALL)
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(example, "handbook.md", "exec"), {})
    assert "τ_femur = W_femur × l_femur + W_tibia × (L_femur + l_tibia) = 1.568 × 0.049" in printed.getvalue()
    assert printed.getvalue().rstrip().splitlines()[-1].startswith("tibia: 0.823 N m by the hand method")
