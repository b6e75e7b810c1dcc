"""Hex_Cfg.h of the Phoenix firmware: read and written, against the firmware's own equations."""

import math
import os
import warnings

import numpy as np
import pytest

import tarsus
from sample_commands import run, run_json
from tarsus.errors import InputError, RobotFileError
from tarsus.hardware import Calibration, nominal_calibration
from tarsus.hardware.phoenix.defines import read_defines
from tarsus.hardware.phoenix.hex_cfg import calibration_from_hex_cfg, robot_from_hex_cfg
from tarsus.hardware.phoenix.hex_cfg_text import hex_cfg_text

# Numbers of Phoenix_PS2_SSC32 and PhantomX_V2_Commander_AX12_Stock in github.com/KurtE/Arduino_Phoenix_Parts @35eb0e1:
# pins, limits of the coxa, its angle and offsets, by leg.
PHOENIX = {
    "RR": (0, (-260, 740), -600, (-43, 82)),
    "RM": (4, (-530, 530), 0, (-63, 0)),
    "RF": (8, (-580, 740), 600, (-43, -82)),
    "LR": (16, (-740, 260), -600, (43, 82)),
    "LM": (20, (-530, 530), 0, (63, 0)),
    "LF": (24, (-740, 580), 600, (43, -82)),
}
PHANTOMX_PINS = {"RR": 8, "RM": 14, "RF": 2, "LR": 7, "LM": 13, "LF": 1}


PINS = {
    "ssc32": {code: numbers[0] for code, numbers in PHOENIX.items()},
    "maestro": {"RR": 3, "RM": 9, "RF": 15, "LR": 0, "LM": 6, "LF": 12},
    "ax12": PHANTOMX_PINS,
}
# What AliPhoenix_PS2_Maestro/Hex_Cfg.h @013e5c2 has instead of the Phoenix's.
MAESTRO = {"USE_MAESTRO": "", "cMAESTRO_BAUD": 115200}
MAESTRO |= {f"c{code}{joint}Inv": int(joint == "Tibia") for code in PHOENIX for joint in ("Coxa", "Femur", "Tibia")}


def header(legs=tuple(PHOENIX), *, driver="ssc32", **defines):
    phantomx = driver == "ax12"
    defines |= MAESTRO if driver == "maestro" else {}
    lines = ["#ifndef HEX_CFG_H", "#define HEX_CFG_H /* a guard */", "#define cXXFemurLength 76 // shared"]
    for code in legs:
        _, coxa, angle, (x, z) = PHOENIX[code]
        pin = PINS[driver][code]
        femur, tibia = ((-1010, 950), (-1060, 770)) if code[0] == "R" else ((-950, 1010), (-770, 1060))
        if phantomx:
            coxa, angle = (-750, 750), round(angle * 0.75)
            femur, tibia = (-1000, 1000), (-1020, 670)
        step = 2 if phantomx else 1
        for i, (joint, (low, high)) in enumerate({"Coxa": coxa, "Femur": femur, "Tibia": tibia}.items()):
            lines += [f"#define c{code}{joint}Pin\t{pin + i * step}  // pin"]
            lines += [f"#define c{code}{joint}Min1 {low}", f"#define c{code}{joint}Max1 {high}"]
        lines += [f"#define c{code}CoxaLength 29", f"#define c{code}FemurLength cXXFemurLength"]
        lines += [f"#define c{code}TibiaLength (100 + 6)", f"#define c{code}CoxaAngle1 {angle}"]
        lines += [f"#define c{code}OffsetX {x}", f"#define c{code}OffsetZ {z}"]
    if phantomx:
        lines += ["#define USE_AX12_DRIVER", "#define cFemurHornOffset1 -35", "#define cTibiaHornOffset1 463"]
        lines += [f"#define c{code}TibiaInv {int(code[0] == 'L')}" for code in legs]
    lines += ["#ifdef QUADMODE", "#define cRRCoxaPin 99", "#else", "#define cSSC_BAUD 38400", "#endif", "#endif"]
    return "\n".join([*lines, *(f"#define {name} {value}" for name, value in defines.items())])


def firmware_angles(point, *, side, coxa_angle, lengths, horns):
    """The code's angles for a point from the coxa axis: x outward, y down, z to the rear [mm], in degrees (LegIK)."""
    x, y, z = point
    coxa, femur, tibia = lengths
    out = math.hypot(x, z) - coxa
    distance = math.hypot(out, y)
    first = math.atan2(out, y)
    second = math.acos((femur**2 - tibia**2 + distance**2) / (2 * femur * distance))
    knee = math.acos((femur**2 + tibia**2 - distance**2) / (2 * femur * tibia))
    return (
        math.degrees(math.atan2(z, x)) + coxa_angle,
        -math.degrees(first + second) + 90 + horns[0],
        -(90 - math.degrees(knee) + horns[1]),
    )


@pytest.mark.parametrize("driver", ["ssc32", "ax12", "maestro"])
def test_commands_are_those_of_the_firmware_for_the_same_feet(driver):
    text, phantomx = header(driver=driver), driver == "ax12"
    robot = robot_from_hex_cfg(text, name="mine")
    made = calibration_from_hex_cfg(text, robot=robot, robot_file="mine.toml")
    feet = np.asarray(tarsus.default_stance(robot, 0.06)) + np.array([0.004, -0.003, 0.002])
    solution = tarsus.inverse_kinematics(robot, feet)
    assert solution.ok
    commands = made.commands(np.asarray(solution.angles))
    for leg, name in enumerate(robot.leg_names):
        end, side = name.split()
        code = (side[0] + end[0]).upper()
        x, y, z = (feet[leg] - robot.mount_position[leg]) * 1000
        point = (y if side == "left" else -y, -z, -x)
        angle = PHOENIX[code][2] / 10 * (0.75 if phantomx else 1)
        horns = (-3.5, 46.3) if phantomx else (0, 0)
        angles = firmware_angles(point, side=side, coxa_angle=angle, lengths=(29, 76, 106), horns=horns)
        for j, a in enumerate(angles):
            inverted = side == "right"
            if driver != "ssc32" and j == 2:
                # Of the Maestro: inverted by the header, and on the right again by the driver.
                inverted = not inverted
            servo = -a if inverted else a
            expected = 512 + servo * 10 * 128 / 375 if phantomx else (servo * 10 + 900) * 1000 / 991 + 592
            assert commands[leg, j] == pytest.approx(expected, abs=0.02)
            assert made.joints[leg][j].number == PINS[driver][code] + j * (2 if phantomx else 1)


def test_the_header_of_the_phoenix_is_the_preset():
    robot, preset = robot_from_hex_cfg(header(), name="mine"), tarsus.load_robot("phoenix")
    assert robot.leg_names == preset.leg_names
    for name in ("mount_position", "mount_yaw", "coxa", "femur", "tibia", "limits"):
        np.testing.assert_allclose(getattr(robot, name), getattr(preset, name), atol=1e-12, err_msg=name)


@pytest.mark.parametrize("driver", ["ssc32", "ax12", "maestro"])
@pytest.mark.parametrize("legs", [tuple(PHOENIX), ("RR", "RF", "LR", "LF")])
def test_a_header_that_is_written_reads_back(driver, legs):
    text = header(legs, driver=driver)
    robot = robot_from_hex_cfg(text, name="mine")
    made = calibration_from_hex_cfg(text, robot=robot, robot_file="mine.toml")
    again = hex_cfg_text(made)
    other = robot_from_hex_cfg(again, name="mine")
    np.testing.assert_allclose(other.mount_position, robot.mount_position, atol=1e-12)
    np.testing.assert_allclose(other.mount_yaw, robot.mount_yaw, atol=1e-12)
    np.testing.assert_allclose(other.limits, made.limits, atol=math.radians(0.1))
    assert (other.limits[..., 0] >= made.limits[..., 0] - 1e-9).all()
    assert (other.limits[..., 1] <= made.limits[..., 1] + 1e-9).all()
    read = calibration_from_hex_cfg(again, robot=other, robot_file="mine.toml")
    assert read.buses == made.buses
    np.testing.assert_allclose(read.zeros, made.zeros, atol=0.51)
    np.testing.assert_allclose(read.slopes, made.slopes)
    assert "//" not in "".join(line for line in again.splitlines() if line.startswith("// c"))


def test_what_the_firmware_can_t_express_is_said_or_refused():
    robot = tarsus.load_robot("ch3r")
    made = nominal_calibration(robot, "ch3r", kind="ssc32")
    made = made.with_joint(0, 0, zero=made.joints[0][0].zero + 40)
    notes = [line for line in hex_cfg_text(made).splitlines() if line.startswith("// c")]
    assert "// cLFCoxa: turn this servo's offset to 1540 us for 0" in notes
    assert "// cRFTibia: the servo has 11.11 us/deg, the driver 10.09" in notes
    with pytest.raises(InputError, match=r"one bus of ssc32, maestro, dynamixel-ax; .* has servo2040"):
        hex_cfg_text(nominal_calibration(robot, "ch3r", kind="servo2040"))
    moved = robot.replace(femur_axis_offset=np.full((6, 2), 0.01))
    with pytest.raises(InputError, match="offset femur axes"):
        hex_cfg_text(nominal_calibration(moved, "ch3r", kind="ssc32"))
    renamed = robot.replace(leg_names=tuple("abcdef"))
    with pytest.raises(InputError, match="the firmware's legs are front left"):
        hex_cfg_text(nominal_calibration(renamed, "ch3r", kind="ssc32"))


def test_headers_that_are_none():
    with pytest.raises(InputError, match=r"defines the pins of 0 legs.*must be 4 or 6"):
        robot_from_hex_cfg("int main() {}", name="x")
    with pytest.raises(InputError, match=r"Hex_Cfg.h, line 4: cRRCoxaPin is 'A\+\+'; it must be a whole number"):
        calibration_from_hex_cfg(
            header().replace("cRRCoxaPin\t0", "cRRCoxaPin A++"), robot=tarsus.load_robot("phoenix"), robot_file="x"
        )
    with pytest.raises(InputError, match="does not define cXXFemurLength"):
        robot_from_hex_cfg(header().replace("#define cXXF", "#define x"), name="x")
    with pytest.raises(RobotFileError, match="tibia_mm = 0"):
        robot_from_hex_cfg(header().replace("(100 + 6)", "0"), name="x")
    with pytest.raises(InputError, match="has the legs front left"):
        calibration_from_hex_cfg(
            header(), robot=tarsus.load_robot("phoenix").replace(leg_names="abcdef"), robot_file=""
        )


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("#define a 3", 3),
        ("# define a -(2 * 3) + 7/2", -3),
        ("#define b 0x10\n#define a +b", 16),
        ("/* #define a 1\n*/#define a 2 // 3", 2),
        ("#if defined(x)\n#define a 1\n#elif !defined(x)\n#define a 2\n#else\n#define a 3\n#endif", 2),
        ("#define x\n#if defined x\n#define a 1\n#elif defined(x)\n#define a 2\n#endif\n#undef x", 1),
        ("#ifndef x\n#ifdef y\n#define a 1\n#endif\n#define a 5\n#endif", 5),
        ("#if ARDUINO>99\n#define a 1\n#else\n#define a 2\n#endif\n#endif", 2),
        ("#define a(x) x\n#define a 4", 4),
        ("#if 1\n#define a 6\n#endif\n#else", 6),
    ],
)
def test_constants_of_headers(text, value):
    assert read_defines(text, where="x").number("a") == value


@pytest.mark.parametrize("text", ["a", "b", "1/0", '"x"', "f(1)", "1.5", "1 +", "99999999999", "()"])
def test_what_is_no_number(text):
    with pytest.raises(InputError):
        read_defines(f"#define a {text}\n#define b a", where="x").number("a")


def test_the_commands_convert_both_ways(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "Hex_Cfg.h").write_text(header(), encoding="utf-8")
    code, made = run_json("calibration", "from-phoenix", "Hex_Cfg.h", "mine")
    assert (code, made["bus"]) == (0, "ssc32")
    assert Calibration.load("mine.calibration.toml").buses[0].baud == 38400
    assert run("calibration", "from-phoenix", "Hex_Cfg.h", "mine").exit_code == 2
    assert run("calibration", "to-phoenix", "mine.calibration.toml").exit_code == 2
    code, written = run_json("calibration", "to-phoenix", "mine.calibration.toml", "--out", "b.h")
    assert (code, written["notes"]) == (0, [])
    assert run("calibration", "from-phoenix", "b.h", "other", "--driver", "ax12").exit_code == 0
    assert Calibration.load("other.calibration.toml").buses[0].kind == "dynamixel-ax"
    assert run("calibration", "to-phoenix", "mine.calibration.toml", "--out", "none/b.h").exit_code == 2


def test_no_warning_of_python_reaches_a_user():
    text = header().replace("#define cSSC_BAUD 38400", "#define cSSC_BAUD 38400if")
    robot = robot_from_hex_cfg(header(), name="x", where="h")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        with pytest.raises(InputError, match="cSSC_BAUD is '38400if'; it must be a whole number"):
            calibration_from_hex_cfg(text, robot=robot, robot_file="x.toml", where="h")
    assert caught == []


@pytest.mark.parametrize(
    ("size", "message"), [(None, "is a pipe or a device"), (2**20 + 1, "has 1048577 bytes, more than 1048576")]
)
def test_what_can_be_no_header_is_refused_before_it_is_read(tmp_path, monkeypatch, size, message):
    monkeypatch.chdir(tmp_path)
    header = tmp_path / "Hex_Cfg.h"
    if size is None:
        os.mkfifo(header)
    else:
        header.write_bytes(b"\n" * size)
    refused = run("calibration", "from-phoenix", str(header), "robot")
    assert refused.exit_code == 2
    assert message in " ".join(refused.output.split())
