"""The robots that come with Tarsus: sourced number by number, and able to stand."""

import math
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

import tarsus.robot.file as robot_file
from tarsus.robot.catalogue import load_servo
from tarsus.robot.file import list_robots, load_robot

PRESETS = Path(robot_file.__file__).parent / "presets"
NAMES = ("ch3r", "freenove", "makeyourpet", "mithi", "phantomx", "phantomx-mk2", "phoenix", "strider")
LEGS = ("front left", "middle left", "rear left", "rear right", "middle right", "front right")
MIRROR = [5, 4, 3, 2, 1, 0]


def read(name):
    return tomllib.loads((PRESETS / f"{name}.toml").read_text(encoding="utf-8"))


def keys_of(table, way=""):
    """Every key that holds a value, and not only more keys; the legs' numbers left out."""
    for key, value in table.items():
        path = f"{way}{key}"
        if isinstance(value, dict):
            yield from keys_of(value, f"{path}.")
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            for item in value:
                yield from keys_of(item, f"{path}.")
        else:
            yield path


def knee_up(robot, leg, reach, depth):
    """Angles of femur and tibia, knee up, for a foot so far out from and below the femur axis; None if too far."""
    femur, tibia = robot.femur[leg], robot.tibia[leg]
    distance = math.hypot(reach, depth)
    cosine = (distance**2 - femur**2 - tibia**2) / (2 * femur * tibia)
    if abs(cosine) > 1:
        return None
    bend = -math.acos(cosine)
    return math.atan2(-depth, reach) - math.atan2(tibia * math.sin(bend), femur + tibia * math.cos(bend)), bend


def test_the_presets_are_these_eight():
    assert list_robots() == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_a_preset_is_named_after_its_file_and_loaded_once(name):
    assert load_robot(name).name == name
    assert load_robot(name) is load_robot(name)


@pytest.mark.parametrize("name", NAMES)
def test_every_number_has_a_source(name):
    document = read(name)
    sources = document.pop("sources")
    spoken_of = [key for source in sources for key in source["of"]]
    for key in set(keys_of(document)) - {"name", "legs.name"}:
        assert any(key == of or key.startswith(f"{of}.") for of in spoken_of), f"{key} has no source"
    for of in spoken_of:
        assert any(key == of or key.startswith(f"{of}.") for key in keys_of(document)), f"{of} speaks of nothing"
    assert len(spoken_of) == len(set(spoken_of)), "two sources for one key"


@pytest.mark.parametrize("name", NAMES)
def test_estimates_of_this_project_are_marked_as_guesses(name):
    for source in load_robot(name).sources:
        if source.source == "this project":
            assert source.confidence == "guess"


@pytest.mark.parametrize("name", NAMES)
def test_legs_are_in_order_and_mirror_symmetric(name):
    robot = load_robot(name)
    assert robot.leg_names == LEGS
    np.testing.assert_array_equal(robot.mount_position[MIRROR] * [1, -1, 1], robot.mount_position)
    np.testing.assert_array_equal(robot.mount_yaw[MIRROR], -robot.mount_yaw)
    mirrored = robot.limits[MIRROR]
    np.testing.assert_array_equal(mirrored[:, 1:], robot.limits[:, 1:])
    if name != "phantomx-mk2":  # whose source has one leg's coxa unlike the others
        np.testing.assert_array_equal(-mirrored[:, 0, ::-1], robot.limits[:, 0])


@pytest.mark.parametrize("name", NAMES)
def test_every_preset_can_stand_with_its_knees_up(name):
    robot = load_robot(name)
    margin = math.radians(10)
    for leg in range(robot.legs):
        stances = [knee_up(robot, leg, reach, robot.gait.body_height) for reach in np.linspace(0, 0.3, 301)]
        lower, upper = robot.limits[leg, :, 0], robot.limits[leg, :, 1]
        assert lower[0] + margin < 0 < upper[0] - margin
        inside = [
            stance
            for stance in stances
            if stance
            and all(lower[j] + margin < angle < upper[j] - margin for j, angle in zip((1, 2), stance, strict=True))
        ]
        assert len(inside) > 50, "a foot can be at fewer places than 50 mm of reach"
        femur, tibia = inside[len(inside) // 2]
        assert femur > math.radians(-10)
        assert tibia < math.radians(-45)


@pytest.mark.parametrize(
    ("name", "total"), [("strider", 3.066), ("phantomx", 3.216268), ("ch3r", 2.09), ("makeyourpet", 2.25)]
)
def test_masses_add_up_to_the_total_of_the_source(name, total):
    robot = load_robot(name)
    assert robot.body_mass + robot.link_mass.sum() == pytest.approx(total, abs=1e-9)


@pytest.mark.parametrize("name", ["freenove", "mithi"])
def test_unknown_masses_stay_unknown(name):
    robot = load_robot(name)
    assert robot.body_mass is None
    assert robot.link_mass is None


def test_estimated_masses_are_those_of_the_robot_they_are_estimated_from():
    phoenix, ch3r = load_robot("phoenix"), load_robot("ch3r")
    np.testing.assert_array_equal(phoenix.link_mass, ch3r.link_mass)
    assert phoenix.body_mass == ch3r.body_mass
    # The Mark IV with AX-12As of 54.6 g in place of XL430s of 57.2 g: one in each femur and tibia, six in the body.
    mark_2, mark_4 = load_robot("phantomx-mk2"), load_robot("phantomx")
    lighter = load_servo("XL430-W250-T").mass - load_servo("AX-12A").mass
    assert lighter == pytest.approx(2.6e-3)
    np.testing.assert_allclose(mark_2.link_mass, mark_4.link_mass - [0, lighter, lighter], atol=5e-4)
    assert mark_2.body_mass == pytest.approx(float(mark_4.body_mass) - 6 * lighter, abs=1e-3)
    for robot in (phoenix, mark_2):
        confidence = {key: source.confidence for source in robot.sources for key in source.of}
        assert confidence["body.mass_kg"] == confidence["leg.mass_kg"] == "guess"


@pytest.mark.parametrize(
    ("name", "servo"),
    [
        ("strider", "DS3225"),
        ("phantomx", "XL430-W250-T"),
        ("phantomx-mk2", "AX-12A"),
        ("phoenix", "HS-645MG"),
        ("ch3r", "HS-645MG"),
        ("makeyourpet", "MG996R"),
    ],
)
def test_servos_are_in_the_catalogue(name, servo):
    assert load_robot(name).servos == ((load_servo(servo),) * 3,) * 6


@pytest.mark.parametrize("name", ["freenove", "mithi"])
def test_unknown_servos_stay_unknown(name):
    assert load_robot(name).servos == ((None,) * 3,) * 6


def test_strider_has_the_numbers_of_its_source():
    robot = load_robot("strider")
    np.testing.assert_allclose(np.hypot(*robot.mount_position.T[:2]), 0.086, atol=1e-6)
    np.testing.assert_allclose(np.rad2deg(robot.mount_yaw), [30, 90, 150, -150, -90, -30])
    np.testing.assert_allclose(np.arctan2(*robot.mount_position.T[1::-1]), robot.mount_yaw, atol=1e-5)
    np.testing.assert_array_equal([robot.coxa, robot.femur, robot.tibia], [[0.068] * 6, [0.098] * 6, [0.181] * 6])
    np.testing.assert_array_equal(robot.link_com, [[0.034, 0.049, 0.078]] * 6)
    assert (robot.gait.body_height, robot.gait.swing_height) == (0.11, 0.03)


def test_phantomx_follows_from_the_model_of_its_maker():
    robot = load_robot("phantomx")
    knee, foot = np.array([60, -15]), np.array([95, -90])
    femur_up, foot_up = np.degrees(np.arctan2(knee[1], knee[0])), np.degrees(np.arctan2(foot[1], foot[0]))
    np.testing.assert_allclose(robot.femur, np.hypot(*knee) / 1000, atol=1e-6)
    np.testing.assert_allclose(robot.tibia, np.hypot(*foot) / 1000, atol=1e-6)
    # Positive is downward there, so the highest angle becomes the lowest.
    np.testing.assert_allclose(np.degrees(robot.limits[0, 1]), femur_up - np.array([90, -98]), atol=0.05)
    np.testing.assert_allclose(np.degrees(robot.limits[0, 2]), foot_up - femur_up - np.array([125, -45]), atol=0.05)
    centres = [
        19.066,
        np.dot([20.226, -0.63], knee) / np.hypot(*knee),
        np.dot([36.797, -11.991], foot) / np.hypot(*foot),
    ]
    np.testing.assert_allclose(robot.link_com[0] * 1000, centres, atol=1e-3)


@pytest.mark.parametrize(
    ("name", "femur_there", "femur_horn", "tibia_there", "tibia_horn"),
    [
        ("phoenix", (-95, 101), 0, (-77, 106), 0),
        ("ch3r", (-105, 75), 0, (-53, 90), 0),
        ("phantomx-mk2", (-100, 100), -3.5, (-102, 67), 46.3),
    ],
)
def test_limits_of_the_phoenix_code_are_converted(name, femur_there, femur_horn, tibia_there, tibia_horn):
    limits = np.degrees(load_robot(name).limits[0])
    # There: femur = horn - elevation; tibia = angle at the knee - 90 - horn, which is 180 for a straight leg.
    np.testing.assert_allclose(limits[1], [femur_horn - femur_there[1], femur_horn - femur_there[0]], atol=1e-9)
    np.testing.assert_allclose(limits[2], np.array(tibia_there) + tibia_horn + 90 - 180, atol=1e-9)


def test_makeyourpet_follows_from_its_model():
    limits = np.degrees(load_robot("makeyourpet").limits[0])
    femur_up, foot_up = np.degrees(np.arctan2(46, 65)), np.degrees(np.arctan2(-107.7, 47.7))
    np.testing.assert_allclose(limits[1], femur_up - np.array([45, -45]), atol=0.05)
    np.testing.assert_allclose(limits[2], foot_up - femur_up - np.array([60, -60]), atol=0.05)


@pytest.mark.parametrize(
    "path", [*PRESETS.glob("*.toml"), PRESETS.parent / "template.toml"], ids=lambda path: path.stem
)
def test_every_file_states_its_units_and_sources(path):
    text = path.read_text(encoding="utf-8")
    comments = re.findall(r"#\s.*", text)
    assert len(comments) >= 2
    assert re.search(r"mm,? .*deg.*kg", " ".join(comments))
