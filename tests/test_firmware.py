"""Limits of firmware: checked with the presets' limits and with the inverse kinematics of each firmware."""

import math

import numpy as np
import pytest

from sample_commands import run, run_json
from tarsus.errors import InputError, UnknownNameError
from tarsus.robot.file import load_robot
from tarsus.robot.firmware import FIRMWARE, SIDES, convert_limits
from tarsus.robot.robot import JOINTS

# Limits as they stand in the sources: of the Phoenix configurations in tenths of a degree.
PHOENIX = {
    "front left": ((-740, 580), (-950, 1010), (-770, 1060)),
    "middle left": ((-530, 530), (-950, 1010), (-770, 1060)),
    "rear left": ((-740, 260), (-950, 1010), (-770, 1060)),
    "rear right": ((-260, 740), (-1010, 950), (-1060, 770)),
    "middle right": ((-530, 530), (-1010, 950), (-1060, 770)),
    "front right": ((-580, 740), (-1010, 950), (-1060, 770)),
}
CH3R = ((-650, 650), (-1050, 750), (-530, 900))
PHANTOMX = ((-750, 750), (-1000, 1000), (-1020, 670))


@pytest.mark.parametrize(
    ("preset", "firmware", "limits", "unit"),
    [
        ("phoenix", "lynxmotion", PHOENIX, "tenths"),
        ("ch3r", "phoenix", dict.fromkeys(PHOENIX, CH3R), "tenths"),
        (
            "phantomx-mk2",
            "phantomx",
            {**dict.fromkeys(PHOENIX, PHANTOMX), "middle left": ((-1000, 1000), *PHANTOMX[1:])},
            "tenths",
        ),
        ("freenove", "freenove", dict.fromkeys(PHOENIX, ((0, 180),) * 3), "deg"),
    ],
)
def test_the_sources_limits_become_those_of_the_preset(preset, firmware, limits, unit):
    robot = load_robot(preset)
    for leg, name in enumerate(robot.leg_names):
        side = name.split()[1]
        found = [
            convert_limits(firmware, joint, pair, side=side, unit=unit)
            for joint, pair in zip(JOINTS, limits[name], strict=True)
        ]
        np.testing.assert_allclose(found, np.degrees(robot.limits[leg]), atol=1e-9)


def phoenix_angles(x, y, z, *, coxa=29, femur=76, tibia=106):
    """The Phoenix code's angles for a foot: x outward, y down, z to the rear [mm], in degrees."""
    out = math.hypot(x, z) - coxa
    distance = math.hypot(out, y)
    down = math.atan2(out, y)
    inside = math.acos((femur**2 + distance**2 - tibia**2) / (2 * femur * distance))
    knee = math.acos((femur**2 + tibia**2 - distance**2) / (2 * femur * tibia))
    return math.degrees(math.atan2(z, x)), 90 - math.degrees(down + inside), math.degrees(knee) - 90


def freenove_angles(x, y, z, *, right, coxa=33, femur=90, tibia=110):
    """The angles of Freenove's servos for a foot: x outward, y counter-clockwise, z up [mm], in degrees."""
    a = math.pi / 2 - math.atan2(y, x)
    out = math.hypot(x, y) - coxa
    distance = math.hypot(out, z)
    b = math.asin(-z / distance) - math.acos((femur**2 + distance**2 - tibia**2) / (2 * femur * distance))
    c = math.pi - math.acos((femur**2 + tibia**2 - distance**2) / (2 * femur * tibia))
    a, b, c = map(math.degrees, (a, b, c))
    return (a, 90 - b, c) if right else (a, 90 + b, 180 - c)


def foot_of(angles, *, coxa, femur, tibia):
    """Our forward kinematics of one leg: x outward, y counter-clockwise, z up."""
    c, f, t = np.radians(angles)
    out = coxa + femur * math.cos(f) + tibia * math.cos(f + t)
    return out * math.cos(c), out * math.sin(c), femur * math.sin(f) + tibia * math.sin(f + t)


def ours(firmware, angles, side, **options):
    # Two equal limits are a single angle.
    return [
        convert_limits(firmware, joint, (angle, angle), side=side, **options)[0]
        for joint, angle in zip(JOINTS, angles, strict=True)
    ]


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("foot", [(120, 30, -60), (90, -45, -80), (140, 0, -20)])
def test_the_same_angles_put_the_foot_at_the_same_place(side, foot):
    x, y, z = foot
    # To the rear is counter-clockwise on the left, clockwise on the right.
    rear = y if side == "left" else -y
    links = {"coxa": 29, "femur": 76, "tibia": 106}
    np.testing.assert_allclose(foot_of(ours("phoenix", phoenix_angles(x, -z, rear), side), **links), foot, atol=1e-9)
    links = {"coxa": 33, "femur": 90, "tibia": 110}
    angles = freenove_angles(x, y, z, right=side == "right")
    np.testing.assert_allclose(foot_of(ours("freenove", angles, side), **links), foot, atol=1e-9)


@pytest.mark.parametrize("side", SIDES)
def test_pulse_widths_and_ticks_are_those_of_the_drivers(side):
    code = np.array([12.0, -34.0, 8.0])
    inverted = -1 if side == "right" else 1
    pulses = ((inverted * code * 10 + 900) * 1000) / 991 + 592
    # The driver's constants put 0 at 1500.2 us.
    assert ours("phoenix", pulses, side, unit="us") == pytest.approx(ours("phoenix", code, side), abs=0.03)
    assert ours("lynxmotion", inverted * code, side) == pytest.approx(ours("phoenix", code, side))
    ticks = np.array([inverted, inverted, -inverted]) * code * 10 * 128 / 375 + 512
    assert ours("phantomx", ticks, side, unit="ticks") == pytest.approx(ours("phantomx", code, side))
    servo = np.array([100.0, 60.0, 45.0])
    assert ours("freenove", 500 + servo * 2000 / 180, side, unit="us") == pytest.approx(ours("freenove", servo, side))


def test_horns_are_those_given_or_the_usual_ones():
    usual = convert_limits("phantomx", "femur", (-100, 100), side="left")
    assert usual == convert_limits("phoenix", "femur", (-100, 100), side="left", horn=-3.5)
    assert usual == pytest.approx((-103.5, 96.5))
    with pytest.raises(InputError, match="beyond half a turn"):
        convert_limits("phantomx", "tibia", (-102, 67), side="left", horn=0)


@pytest.mark.parametrize(
    ("changes", "error", "words"),
    [
        ({"firmware": "phoenx"}, UnknownNameError, "no firmware is called 'phoenx'. Did you mean 'phoenix'?"),
        ({"joint": "knee"}, UnknownNameError, "no joint is called 'knee'"),
        ({"side": "middle"}, UnknownNameError, "no side is called 'middle'"),
        ({"unit": "ticks"}, UnknownNameError, "no unit of the phoenix firmware is called 'ticks'"),
        ({"limits": (1, 2, 3)}, InputError, "they must be two finite numbers"),
        ({"limits": (0, math.nan)}, InputError, "they must be two finite numbers"),
        ({"limits": (-106, 77)}, InputError, "are -196 to -13 deg here, beyond half a turn: perhaps"),
        ({"limits": (0, 300)}, InputError, "beyond half a turn"),
    ],
)
def test_what_cannot_be_converted_is_refused(changes, error, words):
    values = {"firmware": "phoenix", "joint": "tibia", "limits": (-77, 106), "side": "left", **changes}
    firmware, joint, limits = (values.pop(key) for key in ("firmware", "joint", "limits"))
    with pytest.raises(error) as caught:
        convert_limits(firmware, joint, limits, **values)
    assert words in str(caught.value)


def test_every_firmware_has_degrees():
    assert all("deg" in firmware.units and name == firmware.name for name, firmware in FIRMWARE.items())


# The command


def test_the_command_prints_a_line_for_the_robot_file():
    result = run("robots", "convert-limits", "phoenix", "--coxa", "-65,65", "--femur", "-105,75", "--tibia", "-53,90")
    assert result.exit_code == 0
    assert result.stdout == "limits_deg = { coxa = [-65, 65], femur = [-75, 105], tibia = [-143, 0] }\n"
    sides = run("robots", "convert-limits", "phoenix", "--coxa", "-74,26")
    assert sides.stdout.splitlines() == [
        "# left legs",
        "limits_deg = { coxa = [-74, 26] }",
        "# right legs",
        "limits_deg = { coxa = [-26, 74] }",
    ]


def test_the_command_as_json_and_its_errors():
    arguments = ["robots", "convert-limits", "freenove", "--side", "right", "--tibia", "0,150"]
    assert run_json(*arguments) == (
        0,
        {"firmware": "freenove", "unit": "deg", "right": {"limits_deg": {"tibia": [-150.0, 0.0]}}},
    )
    nothing = run("robots", "convert-limits", "freenove")
    assert nothing.exit_code == 2
    assert "--coxa, --femur or --tibia" in nothing.stderr
    assert run("robots", "convert-limits", "fenove", "--tibia", "0,1").exit_code == 2
    assert run("robots", "convert-limits", "phoenix", "--tibia", "-106,77").exit_code == 2
