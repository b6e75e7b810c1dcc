"""Robot files: what they refuse and in which words, and that a saved robot comes back to the bit."""

import copy
import datetime
import json
import os
import subprocess
import sys
import tomllib
from decimal import Decimal, localcontext
from fractions import Fraction
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

import tarsus.robot.file as robot_file
from tarsus.errors import RobotFileError
from tarsus.robot.catalogue import load_servo, servo_catalogue
from tarsus.robot.file import list_robots, load_robot, robot_from_dict, robot_to_dict, save_robot, template_text
from tarsus.robot.robot import GaitDefaults, Robot, Source, stack_robots
from tarsus.robot.schema import GAIT_NAMES, robot_schema
from tarsus.robot.servo import Servo
from tarsus.robot.units import degrees, from_milli, radians, to_milli
from tarsus.robot.writer import toml_number, toml_string

HERE = Path(robot_file.__file__).parent
LEG_ARRAYS = ("coxa", "femur", "tibia", "femur_axis_offset", "limits", "foot_radius", "link_com", "link_mass")
ARRAYS = ("mount_position", "mount_yaw", *LEG_ARRAYS, "body_mass", "body_com", "body_size")
# Pi to more digits than the code has, for exact reference values.
PI = Fraction("3.14159265358979323846264338327950288419716939937510582097494459230781640628620899862803482534211706798")


def strider():
    return robot_to_dict(load_robot("strider"))


def changed(key, value):
    """The strider's document with one key set, or taken away with `...`."""
    document = strider()
    table = document
    *way, last = key
    for part in way:
        table = table.setdefault(part, {}) if isinstance(table, dict) else table[part]
    if value is ...:
        del table[last]
    else:
        table[last] = value
    return document


def problems(document):
    with pytest.raises(RobotFileError) as caught:
        robot_from_dict(document, where="my.toml")
    text = str(caught.value)
    assert text.startswith("my.toml: ")
    assert "pydantic" not in text
    assert "http" not in text
    return caught.value.problems


def assert_same_bits(a, b):
    assert a == b
    for name in ARRAYS:
        mine, theirs = getattr(a, name), getattr(b, name)
        assert (mine is None) == (theirs is None), name
        if mine is not None:
            assert mine.shape == theirs.shape, name
            assert mine.tobytes() == theirs.tobytes(), name


NAN, INF = float("nan"), float("inf")


SERVO = {"name": "mine", "stall_torque_nm": 2}

MISTAKES = [
    (("leg", "coxa_mm"), "68", 'leg.coxa_mm = "68": must be a number from 0 to 10000 mm'),
    (("leg", "coxa_mm"), True, "leg.coxa_mm = true: must be a number from 0 to 10000 mm"),
    (("leg", "coxa_mm"), [68], "leg.coxa_mm = [68]: must be a number from 0 to 10000 mm"),
    (("leg", "coxa_mm"), -1, "leg.coxa_mm = -1: must be from 0 to 10000 mm"),
    (("leg", "femur_mm"), 0, "leg.femur_mm = 0: must be from 0.001 to 10000 mm"),
    (("leg", "tibia_mm"), NAN, "leg.tibia_mm = nan: must be a finite number from 0.001 to 10000 mm"),
    (("leg", "tibia_mm"), -INF, "leg.tibia_mm = -inf: must be a finite number from 0.001 to 10000 mm"),
    (("leg", "tibia_mm"), Decimal("Infinity"), "leg.tibia_mm = inf: must be a finite number"),
    (("leg", "tibia_mm"), Decimal("1e-999999999"), "leg.tibia_mm = 1e-999999999: must be from 0.001"),
    (("leg", "tibia_mm"), 16**5000, "leg.tibia_mm = an integer of more than 38 digits: must be from 0.001"),
    (("leg", "tibia_mm"), -(2**100), "leg.tibia_mm = -1267650600228229401496703205376: must be from 0.001"),
    (("leg", "tibia_mm"), datetime.date(2020, 1, 2), "leg.tibia_mm = 2020-01-02: must be a number"),
    (("leg", "tibia_mm"), datetime.time(3, 4), "leg.tibia_mm = 03:04:00: must be a number"),
    (("leg", "tibia_mm"), None, "leg.tibia_mm: missing; every leg needs it, in [leg] for all legs alike or"),
    (("leg", "tibia_mm"), b"1", "leg.tibia_mm = a value of type bytes: must be a number"),
    (("leg", "tibia_mm"), ..., "leg.tibia_mm: missing; every leg needs it, in [leg] for all legs alike or"),
    (("leg", "mass_kg"), 0.2, "leg.mass_kg = 0.2: must be a table of keys"),
    (("leg", "mass_kg", "femur"), -0.1, "leg.mass_kg.femur = -0.1: must be from 0 to 10000 kg"),
    (("leg", "mass_kg", "femur"), ..., "leg.mass_kg.femur: missing; give the masses of all links of all legs"),
    (("leg", "limits_deg", "coxa"), ..., "leg.limits_deg.coxa: missing; every leg needs it"),
    (("leg", "limits_deg", "coxa"), [60, -60], "leg.limits_deg.coxa = [60, -60]: the limits are reversed"),
    (("leg", "limits_deg", "coxa"), [-181, 0], "the first number must be from -180 to 180 deg"),
    (("leg", "limits_deg", "coxa"), 60, "= 60: must be a list of 2 numbers from -180 to 180 deg"),
    (("leg", "limits_deg", "knee"), [0, 1], "leg.limits_deg.knee: unknown key; known here: coxa, femur, tibia"),
    (("leg", "limits_deg", "tibea"), [0, 1], "leg.limits_deg.tibea: unknown key; did you mean 'tibia'?"),
    (("leg", "femr_mm"), 98, "leg.femr_mm: unknown key; did you mean 'femur_mm'?"),
    (("leg", "qqq"), 98, "leg.qqq: unknown key; known here: coxa_mm, femur_mm,"),
    (("leg", 'a "b"'), 98, r'leg."a \"b\"": unknown key; known here: coxa_mm'),
    (("leg", "q" * 500), 98, f'leg."{"q" * 56}...: unknown key; known here: coxa_mm'),
    (("coxa_mm",), 68, "coxa_mm: unknown key; it belongs to [leg] or [[legs]]"),
    (("body_height_mm",), 68, "body_height_mm: unknown key; it belongs to [gait]"),
    (("body", "mass_kg"), 0, "body.mass_kg = 0: must be from 1e-06 to 10000 kg"),
    (("body", "com_mm"), [0, 0], "body.com_mm = [0, 0]: must be a list of 3 numbers from -10000 to 10000 mm, and"),
    (("body", "com_mm"), [[1], NAN, 0, 0, 0, 0, 0], "= [[...], nan, 0, 0, 0, 0, ...]: must be a list of 3"),
    (("body", "size_mm"), [1, 0, 1], "body.size_mm = [1, 0, 1]: the second number must be from 0.001"),
    (("body",), [], "body = []: must be a table of keys"),
    (("name",), ..., "name: missing; name of the robot"),
    (("name",), 5, 'name = 5: must be text in quotes, such as "front left"'),
    (("name",), "", 'name = "": must not be empty'),
    (("name",), "x" * 1001, "must be no longer than 1000 characters, and has 1001"),
    (("name",), "\ud800", "it contains an unpaired surrogate"),
    (("name",), "a\x01b", "must not contain control characters, such as U+0001"),
    (("legs", 2, "name"), "rear\nleft", "must not contain control characters, such as U+000A"),
    (
        ("gait", "name"),
        "tripd",
        'gait.name = "tripd": must be one of tripod, tetrapod, amble, ripple, wave, creep; ',
    ),
    (("gait", "name"), 3, "gait.name = 3: must be one of tripod, tetrapod, amble, ripple, wave, creep"),
    (("gait", "swing_height_mm"), 0, "gait.swing_height_mm = 0: must be from 0.001 to 10000 mm"),
    (("leg", "servo"), "MG-996", "leg.servo = \"MG-996\": the catalogue has no such servo; did you mean 'MG996R'?"),
    (("leg", "servo"), 996, "leg.servo = 996: must be the name of a servo, a table {"),
    (("leg", "servo"), {"coxa": 996}, "leg.servo.coxa = 996: must be the name of a servo, or a table with"),
    (("leg", "servo"), {"coxa": {"name": "a"}}, "leg.servo.coxa.stall_torque_nm: missing; stall torque [N m]"),
    (("leg", "servo"), {"coxa": "AX-12A", "knee": "AX-12A"}, "leg.servo.knee: unknown key; known here: coxa,"),
    (("leg", "servo"), {"name": "a", "stall_torque_nm": 1, "mass_kg": 1}, "leg.servo.mass_kg: "),
    (("leg", "servo"), SERVO | {"stall_torque_nm": 0}, "stall_torque_nm = 0: must be from 0.0001 to 10000 N m"),
    (("leg", "servo"), SERVO | {"no_load_rad_s": 0}, "no_load_rad_s = 0: must be from 0.001 to 10000 rad/s"),
    (("legs",), ..., "legs: missing; the legs, counter-clockwise from the front left"),
    (("legs",), {"name": "a"}, "legs: must be a list of tables, each under [[legs]]"),
    (("legs", 2), "rear", 'legs[2] = "rear": must be a table of keys'),
    (("legs", 2, "yaw_deg"), ..., "legs[2].yaw_deg: missing; direction of the leg: 0 is forward, 90 is left [deg]"),
    (("legs", 2, "yaw_deg"), 361, "legs[2].yaw_deg = 361: must be from -360 to 360 deg"),
    (("legs", 2, "position_mm"), [NAN, 0, 0], "legs[2].position_mm = [nan, 0, 0]: the first number must be a finite"),
    (("legs", 2, "name"), "front left", 'legs[2].name = "front left": legs[0] has the same name'),
    (
        ("legs", 2, "position_mm"),
        [0, 86.5, 0],
        '0.5 mm from legs[1], "middle left"; it must be at least 1 mm. Likely cause: x or y',
    ),
    (("sources", 0, "of"), "leg", 'sources[0].of = "leg": must be a list'),
    (("sources", 0, "confidence"), "sure", 'sources[0].confidence = "sure": must be one of A, A-, B, C, guess'),
    (("sources",), "me", 'sources = "me": must be a list of tables, each under [[sources]]'),
    ((1,), 2, "[1] = 1: keys must be text"),
]


@pytest.mark.parametrize(("key", "value", "line"), MISTAKES, ids=range(len(MISTAKES)))
def test_errors_name_key_value_and_what_is_allowed(key, value, line):
    (problem,) = problems(changed(key, value))
    assert line in problem


@pytest.mark.parametrize(
    ("figures", "line"),
    [
        ({"supply_min_v": 5}, "supply_min_v and supply_max_v: give both or neither"),
        ({"supply_max_v": 5}, "supply_min_v and supply_max_v: give both or neither"),
        ({"supply_min_v": 6, "supply_max_v": 5}, "supply_min_v is 6 V, greater than supply_max_v, 5 V"),
    ],
)
def test_a_servo_has_both_ends_of_its_supply_or_none(figures, line):
    (problem,) = problems(changed(("leg", "servo"), SERVO | figures))
    assert problem == f"leg.servo: {line}" + (": give both or neither" if "go together" in line else "")


def test_all_problems_are_in_one_error():
    document = changed(("leg", "coxa_mm"), -1)
    document["leg"]["femr_mm"] = 3
    document["legs"][3]["yaw_deg"] = NAN
    found = problems(document)
    assert [line.split(" ")[0].rstrip(":") for line in found] == ["leg.coxa_mm", "leg.femr_mm", "legs[3].yaw_deg"]


@pytest.mark.parametrize("document", [5, [], "strider", None])
def test_values_that_are_not_documents_are_refused(document):
    (problem,) = problems(document)
    assert "must be a table of keys" in problem


@pytest.mark.parametrize(("count", "wanted"), [(0, "at least 4"), (3, "at least 4"), (101, "at most 100")])
def test_too_few_and_too_many_legs_are_refused(count, wanted):
    legs = (strider()["legs"] * 20)[:count]
    (problem,) = problems(changed(("legs",), legs))
    assert f"{count} entries; there must be {wanted}" in problem


def test_legs_out_of_order_are_refused_with_the_expected_order():
    document = strider()
    right_order = [leg["name"] for leg in document["legs"]]
    legs = document["legs"]
    causes = {
        "they are listed clockwise": legs[::-1],
        'the list does not start with "front left"': legs[1:] + legs[:1],
        '"front left" and "rear right" are exchanged': [legs[3], *legs[1:3], legs[0], *legs[4:]],
        "they are listed side by side or by number": [legs[i] for i in (0, 5, 1, 4, 2, 3)],
    }
    for cause, listed in causes.items():
        (problem,) = problems({**document, "legs": listed})
        assert "counter-clockwise from the front left: " + ", ".join(f'"{name}"' for name in right_order) in problem
        assert f"Likely cause: {cause}" in problem


@pytest.mark.parametrize(
    ("frame", "cause"),
    [
        (lambda x, y: [x, -y], "y points right"),
        (lambda x, y: [-x, y], "x points backward"),
        (lambda x, y: [y, x], "x and y are exchanged"),
        (lambda x, y: [-y, x], "x points right and y forward"),
    ],
)
def test_positions_in_another_frame_are_named(frame, cause):
    document = strider()
    for leg in document["legs"]:
        leg["position_mm"] = [*frame(*leg["position_mm"][:2]), 0]
    (problem,) = problems(document)
    assert f"Likely cause: {cause}; here " in problem


def test_names_that_fit_no_frame_leave_the_order_as_the_cause():
    document = strider()
    names = ["rear left", "front right", "front left", "rear right", "middle left", "middle right"]
    for leg, name in zip(document["legs"], names, strict=True):
        leg["name"] = name
    (problem,) = problems({**document, "legs": document["legs"][::-1]})
    assert problem.endswith("Likely cause: they are listed clockwise")


def test_positions_in_metres_are_one_problem():
    document = strider()
    for leg in document["legs"]:
        leg["position_mm"] = [x / 1000 for x in leg["position_mm"]]
    (problem,) = problems(document)
    assert problem.endswith("Likely cause: these look like m instead of mm")


@pytest.mark.parametrize(
    ("limits", "cause"),
    [
        ([500, 2500], "these look like pulse widths in us"),
        ([-740, 580], "these look like tenths of a degree"),
        ([0, 1023], "these look like the ticks of a servo"),
        ([0, 270], "the angles are measured from another direction"),
    ],
)
def test_limits_in_the_units_of_firmware_are_named(limits, cause):
    (problem,) = problems(changed(("leg", "limits_deg", "tibia"), limits))
    assert f"Likely cause: {cause}" in problem
    assert "tarsus robots convert-limits" in problem


@pytest.mark.parametrize("limits", [[-9e5, 0], [0, NAN], ["0", 500], [0, 500, 1]])
def test_other_limits_have_no_cause(limits):
    (problem,) = problems(changed(("leg", "limits_deg", "tibia"), limits))
    assert "Likely cause" not in problem


def test_two_legs_are_too_few():
    (problem,) = problems({**strider(), "legs": strider()["legs"][:2]})
    assert problem == "legs: 2 entries; there must be at least 4"
    (problem,) = problems({**strider(), "legs": strider()["legs"][:1]})
    assert problem == "legs: 1 entry; there must be at least 4"


@pytest.mark.parametrize("text", ['{"name": "x", "legs": []}', '{"name": "x", "legs": [}', '  {\n "name": NaN}'])
def test_json_gets_the_hint_that_toml_is_wanted(tmp_path, text):
    path = tmp_path / "my.json"
    path.write_text(text)
    with pytest.raises(RobotFileError, match="is JSON; a robot file is TOML"):
        load_robot(path)


def test_a_pipe_is_refused_without_waiting_for_it(tmp_path):
    os.mkfifo(tmp_path / "my.toml")
    with pytest.raises(RobotFileError, match="is a pipe or a device; a robot file is a regular file"):
        load_robot(tmp_path / "my.toml")


def test_a_leg_straight_ahead_may_be_the_first():
    document = strider()
    for leg, angle in zip(document["legs"], np.deg2rad(range(0, 360, 60)), strict=True):
        leg["position_mm"] = [100 * np.cos(angle), 100 * np.sin(angle), 0]
        leg["yaw_deg"] = float(np.rad2deg(angle))
    robot = robot_from_dict(document)
    np.testing.assert_allclose(robot.mount_position[0], [0.1, 0, 0], atol=1e-12)


def test_a_key_missing_for_one_leg_names_that_leg():
    document = strider()
    del document["leg"]["femur_mm"]
    for i in (0, 1, 2, 4, 5):
        document["legs"][i]["femur_mm"] = 98
    assert problems(document) == ("legs[3].femur_mm: missing; every leg needs it, here or in [leg]",)


def test_a_leg_overrides_single_joints_of_the_shared_values():
    document = strider()
    document["legs"][1] |= {
        "tibia_mm": 150,
        "limits_deg": {"coxa": [-90, 45]},
        "mass_kg": {"tibia": 0.1},
        "com_mm": {"tibia": 60},
        "servo": {"tibia": "ax-12a"},
        "foot_radius_mm": 9,
        "femur_axis_offset_mm": [1, -2],
    }
    base, robot = load_robot("strider"), robot_from_dict(document)
    np.testing.assert_array_equal(robot.tibia, [0.181, 0.15, *[0.181] * 4])
    np.testing.assert_allclose(np.rad2deg(robot.limits[1]), [[-90, 45], [-80, 100], [-160, 10]])
    np.testing.assert_array_equal(robot.limits[[0, 2, 3, 4, 5]], base.limits[[0, 2, 3, 4, 5]])
    np.testing.assert_array_equal(robot.link_mass[1], [0.04, 0.16, 0.1])
    np.testing.assert_array_equal(robot.link_com[1], [0.034, 0.049, 0.06])
    assert [s.name for s in robot.servos[1]] == ["DS3225", "DS3225", "AX-12A"]
    assert robot.servos[0] == base.servos[0]
    np.testing.assert_array_equal(robot.foot_radius[:2], [0.008, 0.009])
    np.testing.assert_array_equal(robot.femur_axis_offset[:2], [[0, 0], [0.001, -0.002]])


def test_optional_keys_are_unknown_or_default():
    document = strider()
    for key in ("body", "gait", "sources"):
        del document[key]
    for key in ("mass_kg", "com_mm", "servo", "foot_radius_mm"):
        del document["leg"][key]
    robot = robot_from_dict(document)
    assert robot.body_mass is None
    assert robot.link_mass is None
    assert robot.body_size is None
    assert not robot.has_masses
    assert robot.servos == ((None,) * 3,) * 6
    assert robot.gait == GaitDefaults(name="tripod", body_height=None, swing_height=None)
    assert robot.sources == ()
    np.testing.assert_array_equal(robot.body_com, 0)
    np.testing.assert_array_equal(robot.foot_radius, 0)
    np.testing.assert_array_equal(robot.femur_axis_offset, 0)
    np.testing.assert_array_equal(robot.link_com, np.array([[0.068, 0.098, 0.181]] * 6) / 2)
    assert_same_bits(robot_from_dict(robot_to_dict(robot)), robot)


def test_a_centre_of_mass_given_for_one_joint_leaves_the_others_in_the_middle():
    robot = robot_from_dict(changed(("leg", "com_mm"), {"tibia": 70}))
    np.testing.assert_array_equal(robot.link_com[0], [0.034, 0.049, 0.07])


def test_masses_known_for_some_legs_only_are_refused():
    document = strider()
    masses = document["leg"].pop("mass_kg")
    document["legs"][0]["mass_kg"] = masses
    assert len(problems(document)) == 15


@pytest.mark.parametrize("name", GAIT_NAMES)
def test_every_gait_name_is_accepted(name):
    assert robot_from_dict(changed(("gait", "name"), name)).gait.name == name


def test_a_document_may_contain_numpy_numbers():
    document = strider()
    document["leg"]["coxa_mm"] = np.int64(68)
    document["leg"]["femur_mm"] = np.float64(98)
    document["body"]["com_mm"] = np.zeros(3)
    assert_same_bits(robot_from_dict(document), load_robot("strider"))
    assert "must be a number" in problems(changed(("leg", "coxa_mm"), np.True_))[0]


def test_a_servo_that_is_not_in_the_catalogue():
    figures = {
        "name": "mine",
        "stall_torque_nm": 2.5,
        "torque_at_v": 7.4,
        "rated_torque_nm": 0.8,
        "no_load_rad_s": 6.5,
        "speed_at_v": 7.4,
        "stall_current_a": 3,
        "mass_g": 61.5,
        "supply_min_v": 6,
        "supply_max_v": 8.4,
        "travel_deg": 180,
        "maker": "me",
        "note": "measured",
    }
    expected = Servo(
        name="mine",
        stall_torque=2.5,
        torque_at=7.4,
        rated_torque=0.8,
        no_load_speed=6.5,
        speed_at=7.4,
        stall_current=3.0,
        mass=0.0615,
        supply=(6.0, 8.4),
        travel=np.pi,
        maker="me",
        note="measured",
    )
    robot = robot_from_dict(changed(("leg", "servo"), figures))
    assert robot.servos == ((expected,) * 3,) * 6
    assert robot_to_dict(robot)["leg"]["servo"] == figures
    mixed = robot_from_dict(changed(("leg", "servo"), {"coxa": "mg996r", "tibia": figures}))
    assert mixed.servos == ((load_servo("MG996R"), None, expected),) * 6
    assert robot_from_dict(robot_to_dict(mixed)) == mixed


# Files


@pytest.mark.parametrize(
    ("content", "line"),
    [
        (b"", "the file is empty"),
        (b" \n\t\n", "the file is empty"),
        (b"\xef\xbb\xbf", "the file is empty"),
        (b"name = 'x'\n\xff\xfe", "byte 11 is not UTF-8; a robot file is a text file"),
        (b"name 'x'", "line 1, column 6: not valid TOML: expected '=' after a key in a key/value pair; in: name 'x'"),
        (b"a = 1\n" + b"b" * 100 + b"\n", "in: " + "b" * 57 + "..."),
        (b"a = [1\n\n", "line 2, at the end: not valid TOML: unclosed array"),
        (b"a = 1\na = 2", "cannot overwrite a value"),
        (b"a = " + b"[" * 100_000, "nested too deeply"),
        (b"a = " + b"{b=" * 100_000, "nested too deeply"),
        (b"a = " + b"9" * 5000, "a number has too many digits or too large an exponent"),
        (b"a = 1e99999999999999999999", "a number has too many digits or too large an exponent"),
        (b"#" * (2**20 + 1), "larger than 1 MiB"),
        (b"x = 1", "x: unknown key"),
    ],
)
def test_invalid_files_are_refused_with_a_reason(tmp_path, content, line):
    path = tmp_path / "my.toml"
    path.write_bytes(content)
    with pytest.raises(RobotFileError) as caught:
        load_robot(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert any(line in problem for problem in caught.value.problems)


def test_a_file_of_exactly_one_mebibyte_is_read(tmp_path):
    path = tmp_path / "my.toml"
    text = template_text("big") + "#"
    path.write_text(text + "x" * (2**20 - len(text)))
    assert load_robot(path).name == "big"


def test_byte_order_mark_and_windows_line_ends_are_accepted(tmp_path):
    path = tmp_path / "my.toml"
    path.write_bytes(b"\xef\xbb\xbf" + template_text("mine").replace("\n", "\r\n").encode())
    assert load_robot(str(path)).name == "mine"


def test_an_unknown_name_suggests_the_nearest():
    with pytest.raises(RobotFileError, match=r"no preset robot of that name\. Did you mean 'strider'\?"):
        load_robot("stridr")
    for path in ("/nowhere/to/be/found.toml", "my-strider.toml", "robots/stridr", "missing"):
        with pytest.raises(RobotFileError, match=r"of that name\. Presets: ch3r, freenove"):
            load_robot(path)


@pytest.mark.parametrize(
    ("name", "line"),
    [
        (".", "is a folder"),
        ("file/my.toml", "can't be read: Not a directory"),
        ("a\0b", "can't be read: is not a valid path"),
    ],
)
def test_an_invalid_path_is_refused(tmp_path, monkeypatch, name, line):
    monkeypatch.chdir(tmp_path)
    Path("file").touch()
    with pytest.raises(RobotFileError, match=line):
        load_robot(name)


def test_a_file_without_read_permission_is_refused(tmp_path, monkeypatch):
    def locked(*_, **__):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "open", locked)
    with pytest.raises(RobotFileError, match="can't be read: Permission denied"):
        load_robot(tmp_path / "my.toml")


def test_a_preset_name_is_a_name_and_a_path_a_path(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("strider").write_text(template_text("mine"))
    assert load_robot("strider").name == "strider"
    assert load_robot("./strider").name == "mine"
    assert load_robot(Path("strider")).name == "mine"


# Saving


def floats(low, high):
    return st.floats(low, high, allow_nan=False, allow_infinity=False)


def arrays(elements, *shape):
    count = int(np.prod(shape))
    return st.lists(elements, min_size=count, max_size=count).map(lambda values: np.reshape(values, shape))


def optional(strategy):
    return st.none() | strategy


def shared_or_not(elements, legs, *tail):
    """Values for every leg: all alike, or each its own."""
    alike = arrays(elements, *tail).map(lambda values: np.array([values] * legs))
    return alike | arrays(elements, legs, *tail)


NAMES = st.text(
    st.characters(exclude_categories=("Cc", "Cs"), exclude_characters="\ufffe\uffff"), min_size=1, max_size=50
)

SERVOS = st.sampled_from(list(servo_catalogue().values())) | st.builds(
    Servo,
    name=st.text(min_size=1, max_size=5) | st.just("MG996R"),
    stall_torque=floats(1e-4, 1e4),
    torque_at=optional(floats(0, 1000)),
    no_load_speed=optional(floats(1e-3, 1e4)),
    mass=optional(floats(0, 99)),
    travel=optional(floats(0, 600)),
    supply=optional(st.tuples(floats(0, 9), floats(9, 1000))),
    note=st.text(max_size=5),
)


@st.composite
def robots(draw):
    """Any robot that a file may hold, its numbers any doubles in range."""
    legs = draw(st.integers(4, 8))
    spread = np.array(draw(arrays(floats(-0.1, 0.1), legs)))
    angles = (np.arange(legs) + 0.5 + spread) * 2 * np.pi / legs
    radii = draw(arrays(floats(0.09, 0.11), legs))
    heights = draw(arrays(floats(-10, 10), legs))
    limits = np.sort(draw(shared_or_not(floats(-np.pi, np.pi), legs, 3, 2)), axis=-1)
    lengths = floats(1e-6, 10)
    servo = draw(optional(SERVOS))
    return Robot(
        name=draw(NAMES),
        leg_names=draw(st.lists(NAMES, min_size=legs, max_size=legs, unique=True)),
        mount_position=np.stack([radii * np.cos(angles), radii * np.sin(angles), heights], axis=-1),
        mount_yaw=draw(arrays(floats(-6.28, 6.28), legs)),
        coxa=draw(shared_or_not(floats(0, 10), legs)),
        femur=draw(shared_or_not(lengths, legs)),
        tibia=draw(shared_or_not(lengths, legs)),
        limits=limits,
        femur_axis_offset=draw(optional(shared_or_not(floats(-10, 10), legs, 2))),
        foot_radius=draw(optional(shared_or_not(floats(0, 10), legs))),
        link_com=draw(optional(shared_or_not(floats(-10, 10), legs, 3))),
        link_mass=draw(optional(shared_or_not(floats(0, 1e4), legs, 3))),
        body_mass=draw(optional(floats(1e-6, 1e4))),
        body_com=draw(optional(arrays(floats(-10, 10), 3))),
        body_size=draw(optional(arrays(lengths, 3))),
        servos=draw(
            st.just(((servo,) * 3,) * legs)
            | st.lists(st.tuples(*[optional(SERVOS)] * 3), min_size=legs, max_size=legs).map(tuple)
        ),
        gait=GaitDefaults(
            name=draw(st.sampled_from(GAIT_NAMES)),
            body_height=draw(optional(lengths)),
            swing_height=draw(optional(lengths)),
        ),
        sources=tuple(
            draw(
                st.lists(
                    st.builds(
                        Source,
                        of=st.lists(st.text(min_size=1, max_size=9), max_size=2).map(tuple),
                        source=st.text(min_size=1, max_size=9),
                        confidence=st.sampled_from(["A", "A-", "B", "C", "guess"]),
                        note=st.text(max_size=9),
                    ),
                    max_size=2,
                )
            )
        ),
    )


@pytest.mark.no_cover
@settings(max_examples=30, deadline=None, suppress_health_check=list(HealthCheck))
@given(robot=robots())
def test_saving_and_loading_is_exact_to_the_bit(tmp_path_factory, robot):
    path = tmp_path_factory.getbasetemp() / "robot.toml"
    save_robot(robot, path)
    assert_same_bits(load_robot(path), robot)
    json.dumps(robot_to_dict(robot))


@pytest.mark.parametrize("name", list_robots())
def test_conversion_to_a_dict_is_exact_to_the_bit(name, tmp_path):
    robot = load_robot(name)
    assert_same_bits(robot_from_dict(json.loads(json.dumps(robot_to_dict(robot)))), robot)
    save_robot(robot, tmp_path / "robot.toml")
    assert_same_bits(load_robot(tmp_path / "robot.toml"), robot)


def test_a_saved_file_has_the_layout_of_a_hand_written_one(tmp_path):
    robot = load_robot("phoenix").replace(body_com=[0.0, -0.0, 1e-15], sources=())
    save_robot(robot, tmp_path / "robot.toml")
    text = (tmp_path / "robot.toml").read_text(encoding="utf-8")
    assert text.startswith(
        """name = "phoenix"

[body]
mass_kg = 1.01
com_mm = [0, -0.0, 1e-12]

[leg]
coxa_mm = 29
femur_mm = 76
tibia_mm = 106
mass_kg = { coxa = 0.07, femur = 0.02, tibia = 0.09 }
limits_deg = { femur = [-101, 95], tibia = [-167, 16] }
servo = "HS-645MG"

[[legs]]
name = "front left"
position_mm = [82, 43, 0]
yaw_deg = 30
limits_deg = { coxa = [-74, 58] }
"""
    )
    assert text.endswith('[gait]\nname = "tripod"\nbody_height_mm = 60\nswing_height_mm = 40\n')


def test_shared_values_are_written_once():
    robot = load_robot("phantomx-mk2")
    document = robot_to_dict(robot)
    assert document["leg"]["limits_deg"].keys() == {"femur", "tibia"}
    assert all(leg.keys() == {"name", "position_mm", "yaw_deg", "limits_deg"} for leg in document["legs"])
    assert document["legs"][1]["limits_deg"] == {"coxa": [-100, 100]}


def test_a_batch_of_designs_is_not_written(tmp_path):
    batch = stack_robots([load_robot("strider")] * 2)
    for attempt in (lambda: robot_to_dict(batch), lambda: save_robot(batch, tmp_path / "x.toml")):
        with pytest.raises(RobotFileError, match=r"robot 'strider': .*\n  a batch of designs \(2,\) can't"):
            attempt()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"gait": GaitDefaults(name="gallop")}, 'gait.name = "gallop": must be one of'),
        ({"femur": np.full(6, 11.0)}, "leg.femur_mm = 11000: must be from"),
        ({"mount_yaw": np.linspace(0, 7, 6)}, "legs[5].yaw_deg = 401"),
        ({"leg_names": ("a",) * 6}, "has the same name"),
        ({"servos": ((Servo(name="x", stall_torque=NAN),) * 3,) * 6}, "leg.servo.stall_torque_nm = nan"),
    ],
)
def test_a_robot_with_values_that_no_file_may_have_is_not_written(tmp_path, changes, line):
    path = tmp_path / "x.toml"
    with pytest.raises(RobotFileError) as caught:
        save_robot(load_robot("strider").replace(**changes), path)
    assert str(caught.value).startswith("robot 'strider' as a file: ")
    assert line in str(caught.value)
    assert not path.exists()


@pytest.mark.parametrize("name", ["no/such/folder.toml", "", "a\0b"])
def test_an_unwritable_path_is_refused(tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(RobotFileError, match="can't be written: "):
        save_robot(load_robot("strider"), name)


def test_an_operating_system_error_without_a_message(tmp_path, monkeypatch):
    def fail(*_):
        raise OSError

    monkeypatch.setattr(Path, "write_bytes", fail)
    with pytest.raises(RobotFileError, match="can't be written: is not a regular file"):
        save_robot(load_robot("strider"), tmp_path / "x.toml")


# Anything at all


def assert_loads_or_is_refused_in_words(load):
    """Nothing but a `RobotFileError` may come of it: any other exception fails the test."""
    words = ("none",)
    try:
        load()
    except RobotFileError as error:
        words = error.problems
    assert words
    assert not any("pydantic" in line or "http" in line for line in words)


@settings(max_examples=80, deadline=None, suppress_health_check=list(HealthCheck))
@given(content=st.binary(max_size=300) | st.text(max_size=300).map(str.encode))
@example(content=b"\x00")
@example(content=b"legs = [[]]")
def test_random_bytes_are_refused_with_a_reason(tmp_path_factory, content):
    path = tmp_path_factory.getbasetemp() / "bytes.toml"
    path.write_bytes(content)
    with pytest.raises(RobotFileError) as caught:
        load_robot(path)
    assert caught.value.problems


PIECES = [
    "",
    "nan",
    "-inf",
    "1e400",
    "-1",
    "true",
    '"x"',
    "[",
    "]",
    "{",
    "}",
    "=",
    ".",
    "\n[leg]\n",
    "\n",
    "0x" + "f" * 99,
]


@settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))
@given(
    name=st.sampled_from(list_robots()),
    place=st.floats(0, 1),
    length=st.integers(0, 30),
    piece=st.sampled_from(PIECES) | st.text(max_size=5),
)
def test_a_mutated_preset_loads_or_is_refused_with_a_reason(tmp_path_factory, name, place, length, piece):
    text = (HERE / "presets" / f"{name}.toml").read_text(encoding="utf-8")
    start = int(place * len(text))
    path = tmp_path_factory.getbasetemp() / "mutant.toml"
    path.write_bytes((text[:start] + piece + text[start + length :]).encode())
    assert_loads_or_is_refused_in_words(lambda: load_robot(path))


ANYTHING = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5) | st.binary(max_size=2) | st.dates(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=3) | st.integers(), inner, max_size=3),
    max_leaves=8,
)
KEYS = [
    ("name",),
    ("body",),
    ("leg",),
    ("legs",),
    ("gait",),
    ("sources",),
    ("leg", "servo"),
    ("leg", "servo", "coxa"),
    ("leg", "limits_deg"),
    ("leg", "limits_deg", "coxa"),
    ("leg", "com_mm", "tibia"),
    ("legs", 0),
    ("legs", 0, "position_mm"),
    ("sources", 0, "of"),
    ("body", "mass_kg"),
    ("new",),
]


@pytest.mark.no_cover
@settings(max_examples=200, deadline=None)
@given(key=st.sampled_from(KEYS), value=ANYTHING)
def test_any_value_at_any_key_loads_or_is_refused_with_a_reason(key, value):
    document = strider()
    document["leg"]["servo"] = {"coxa": "DS3225"}
    table = document
    for part in key[:-1]:
        table = table[part]
    table[key[-1]] = copy.deepcopy(value)
    assert_loads_or_is_refused_in_words(lambda: robot_from_dict(document))


# The pieces


@given(value=floats(-1e4, 1e4))
def test_conversion_of_thousandths_is_exact_to_the_bit(value):
    assert from_milli(to_milli(value)) == value
    assert np.signbit(from_milli(to_milli(value))) == np.signbit(value)


@given(value=floats(-650, 650))
@example(value=5e-324)
@example(value=np.pi)
def test_conversion_of_angles_is_exact_to_the_bit(value):
    with localcontext(prec=3):  # the program that uses Tarsus may compute with fewer digits
        assert radians(degrees(value)) == value


@given(value=st.decimals(-360, 360, places=9))
def test_an_angle_is_rounded_once(value):
    assert radians(value) == float(Fraction(value) * PI / 180)


@given(value=st.decimals(-360, 360, places=5))
def test_an_angle_reads_as_it_was_written(value):
    assert degrees(radians(value)) == value


@given(value=st.decimals(-10_000, 10_000, places=6))
def test_a_length_is_rounded_once_and_reads_as_it_was_written(value):
    assert from_milli(value) == float(Fraction(value) / 1000)
    assert to_milli(from_milli(value)) == value


def test_half_turns_are_pi():
    assert radians(Decimal(180)) == np.pi
    assert str(degrees(np.pi)) in ("180", "1.8E+2")
    assert repr(radians(Decimal("-0.0"))) == "-0.0"


def test_an_angle_of_seventeen_digits_has_no_shorter_form():
    value = np.nextafter(1.0, 2.0)
    assert radians(degrees(value)) == value != radians(degrees(1.0))


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ("68", "68"),
        ("68.000", "68"),
        ("6.8E+1", "68"),
        ("74.50", "74.5"),
        ("-0.001", "-0.001"),
        ("0.0", "0"),
        ("-0", "-0.0"),
        ("1E-9", "0.000000001"),
        ("-1.5E-12", "-1.5e-12"),
        ("1E-320", "1e-320"),
        ("1E+4", "10000"),
    ],
)
def test_numbers_are_written_with_all_their_digits(value, text):
    assert toml_number(Decimal(value)) == text


@given(value=st.decimals(-10_000, 10_000))
def test_written_numbers_are_toml(value):
    assert tomllib.loads(f"x = {toml_number(value)}", parse_float=Decimal)["x"] == value


@given(text=st.text())
@example(text='\x7f\0"\\\n\U0001f577')
def test_written_strings_are_toml(text):
    assert tomllib.loads(f"x = {toml_string(text)}")["x"] == text


@given(name=NAMES)
def test_the_template_loads_under_any_name(tmp_path_factory, name):
    path = tmp_path_factory.getbasetemp() / "template.toml"
    path.write_text(template_text(name), encoding="utf-8", newline="")
    robot = load_robot(path)
    assert robot.name == name
    assert robot.has_masses


# The schema


def test_the_published_schema_is_up_to_date():
    published = (HERE / "robot.schema.json").read_text(encoding="utf-8")
    assert published == json.dumps(robot_schema(), indent=2) + "\n"


def test_the_schema_is_valid_and_describes_every_key():
    schema = robot_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    assert "null" not in json.dumps(schema)
    for table in (schema, *schema["$defs"].values()):
        assert table["description"]
        assert table["additionalProperties"] is False
    for table in ("Leg", "LegEntry", "Body", "Gait", "SourceEntry", "ServoFigures"):
        for key, value in schema["$defs"][table]["properties"].items():
            assert "description" in value or "$ref" in value, f"{table}.{key}"


@pytest.mark.parametrize("name", list_robots())
def test_the_schema_accepts_every_preset(name):
    text = (HERE / "presets" / f"{name}.toml").read_text(encoding="utf-8")
    assert text.startswith("#:schema ../robot.schema.json\n")
    jsonschema.validate(tomllib.loads(text), robot_schema())


@pytest.mark.parametrize(
    ("key", "value"),
    [
        (("leg", "coxa_mm"), -1),
        (("leg", "coxa_mm"), "68"),
        (("leg", "coxa"), 68),
        (("legs",), []),
        (("legs", 0, "position_mm"), [0, 0]),
        (("leg", "limits_deg", "coxa"), [-181, 0]),
        (("gait", "name"), "gallop"),
        (("leg", "servo"), 3),
        (("leg", "servo"), SERVO | {"stall_torque_nm": 0}),
        (("leg", "servo"), SERVO | {"no_load_rad_s": 0}),
        (("name",), ...),
        (("name",), "a\x01b"),
        (("legs", 0, "name"), "a\nb"),
    ],
)
def test_the_schema_refuses_what_the_loader_refuses(key, value):
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(changed(key, value), robot_schema())
    problems(changed(key, value))


def test_heavy_packages_are_not_imported_before_a_file_is_read():
    code = "import sys, tarsus.robot; sys.exit('pydantic' in sys.modules or 'tomllib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], env=os.environ, check=False).returncode == 0
