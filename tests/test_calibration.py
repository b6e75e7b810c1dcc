"""Calibration files: angles and commands both ways, what contradicts the robot, what is missing."""

import dataclasses
import json
import math
import re
import tomllib
from decimal import Decimal

import jsonschema
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import tarsus
from sample_commands import run, run_json
from tarsus.errors import CalibrationError, InputError, UnknownNameError
from tarsus.hardware import (
    BUS_COMMANDS,
    BUSES,
    Calibration,
    FootSwitches,
    JointCalibration,
    Mounting,
    SupplySettings,
    calibration_schema,
    emulated_bus,
    new_calibration,
    nominal_calibration,
)
from tarsus.hardware.calibration.contradictions import angle_range
from tarsus.hardware.calibration.file import calibration_text
from tarsus.hardware.calibration.lines import key_lines, line_of
from tarsus.robot.units import per_degree, per_radian

STRIDER = tarsus.load_robot("strider")


def nominal(kind="feetech-sts", **changes):
    return nominal_calibration(STRIDER, "strider", kind=kind).replace(**changes)


def whole():
    return nominal(
        "servo2040",
        supply=SupplySettings(voltage=7.4, least_voltage=6.2, greatest_current=20.0),
        foot_switches=FootSwitches(bus="main", inputs=(0, 1, 2, 3, 4, None), closed=False),
        imu=Mounting(port="/dev/ttyACM1", rpy=(0.0, math.pi, 0.1)),
    ).with_joint(0, 1, soft_limits=(-0.5, 0.7))


@pytest.mark.parametrize("kind", BUS_COMMANDS)
@pytest.mark.parametrize("name", tarsus.list_robots())
def test_a_file_reads_back_to_the_same_bits(name, kind, tmp_path):
    robot = tarsus.load_robot(name)
    made = nominal_calibration(robot, name, kind=kind)
    made.save(tmp_path / "c.toml")
    read = Calibration.load(tmp_path / "c.toml")
    assert (read.joints, read.buses, read.robot) == (made.joints, made.buses, robot)
    assert list(tmp_path.iterdir()) == [tmp_path / "c.toml"]


def test_supply_sensors_and_soft_limits_read_back(tmp_path):
    made = whole()
    made.save(tmp_path / "c.toml")
    read = Calibration.load(tmp_path / "c.toml")
    assert (read.supply, read.foot_switches, read.imu) == (made.supply, made.foot_switches, made.imu)
    assert read.joints == made.joints
    np.testing.assert_array_equal(read.limits[0, 1], (-0.5, 0.7))


@given(
    zero=st.floats(-5000, 5000),
    direction=st.sampled_from([1, -1]),
    scale=st.floats(1, 2000),
    angle=st.floats(-math.pi, math.pi),
)
def test_a_command_is_zero_plus_direction_times_scale_times_angle(zero, direction, scale, angle):
    made = nominal().with_joint(2, 1, zero=0.0, direction=1, scale=1000.0)
    joint = JointCalibration(bus="main", number=8, zero=zero, direction=direction, scale=scale, limits=(0.0, 4095.0))
    low, high = angle_range(joint)
    assert joint.command(low) == pytest.approx(4095 if direction < 0 else 0, abs=1e-6)
    own = made.robot.limits[2, 1]
    if high < own[0] or low > own[1] or (high - low) > math.radians(270 * 1.01):
        with pytest.raises(CalibrationError, match="rear left femur"):
            made.with_joint(2, 1, **vars(joint))
        return
    made = made.with_joint(2, 1, **vars(joint))
    angles = np.full((6, 3), angle)
    assert made.commands(angles)[2, 1] == joint.command(angle) == zero + direction * scale * angle
    np.testing.assert_allclose(made.angles(made.commands(angles)), angles, atol=1e-9)


def test_batches_are_converted_at_once():
    made = nominal()
    angles = np.random.default_rng(0).uniform(-1, 1, (4, 5, 6, 3))
    commands = made.commands(angles)
    np.testing.assert_array_equal(commands[2, 3], made.commands(angles[2, 3]))
    np.testing.assert_allclose(made.angles(commands), angles)
    clamped = made.clamped(commands * 3)
    assert (clamped >= made.command_limits[..., 0]).all()
    assert (clamped <= made.command_limits[..., 1]).all()
    for method in (made.commands, made.angles, made.clamped):
        with pytest.raises(InputError, match=r"must be \(\.\.\., 6, 3\)"):
            method(np.zeros((3, 6)))
    commands[1, 2, 3, 1] = math.nan
    with pytest.raises(InputError, match="rear right femur is NaN"):
        made.clamped(commands)


def test_the_limits_are_the_narrowest_of_robot_commands_and_soft_limits():
    made = nominal().with_joint(0, 0, limits=(1900.0, 2200.0))
    made = made.with_joint(3, 2, soft_limits=(-1.0, -0.5))
    ends = np.sort(made.angles(np.array(made.command_limits).transpose(2, 0, 1)), axis=0)
    np.testing.assert_allclose(ends.transpose(1, 2, 0), made.limits, atol=1e-12)
    np.testing.assert_array_equal(made.limits[3, 2], (-1.0, -0.5))
    np.testing.assert_allclose(made.command_limits[0, 0], (1900, 2200))
    np.testing.assert_array_equal(made.limited_robot.limits, made.limits)
    assert (made.limits[..., 0] >= STRIDER.limits[..., 0]).all()


EDITS = {
    "id of another": (
        ("id = 2,", "id = 1,"),
        r"front left femur: id 1 on bus 'main' is that of front left coxa alr.*11",
    ),
    "id beyond": (("id = 2,", "id = 253,"), None),
    "travel": (
        ("limits_ticks = [512, 3583]", "limits_ticks = [0, 4095]"),
        r"359.9 deg, beyond the travel.*270 deg.*10",
    ),
    "wrong zero": (
        ("zero_ticks = 2047.5", "zero_ticks = 9000"),
        r"front left coxa: its limits are.*beyond.*\(line 10\)",
    ),
    "limits beyond the bus": (("[512, 3583]", "[2000, 5000]"), r"Feetech STS and SMS can send 0 to 4095.*line 10"),
    "reversed limits": (("[512, 3583]", "[3000, 2000]"), "the lower one comes first"),
    "soft limits beyond the robot": (("[512, 3583]", "[512, 3583], soft_limits_deg = [-70, 0]"), "-60 to 60 deg.*line"),
    "soft limits alike": (("[512, 3583]", "[512, 3583], soft_limits_deg = [5, 5]"), "the lower one comes first"),
    "soft limits beyond the commands": (
        ("limits_ticks = [512, 3583]", "limits_ticks = [2000, 2100], soft_limits_deg = [-20, 20]"),
        "beyond what the limits of the commands allow",
    ),
    "direction": (("direction = 1,", "direction = 2,"), r"direction \(line 10\) = 2: must be 1 or -1"),
    "no number": (("zero_ticks = 2047.5", 'zero_ticks = "a"'), r"zero_ticks.*must be a number"),
    "pulse width": (
        ("zero_ticks = 2047.5", "zero_us = 1500"),
        r"front left coxa \(line 10\): zero_us does not fit.*ticks",
    ),
    "channel": (("id = 1,", "channel = 1,"), "channel does not fit the bus 'main'.*write id"),
    "leg": (('"front left"', '"front lft"'), r"legs\[0\].name.*line 9.*did you mean 'front left'"),
    "strange leg": (('"front left"', '"x"'), "there are: front left, middle left"),
    "leg twice": (('"middle left"', '"front left"'), "that leg is there already"),
    "kind": (('"feetech-sts"', '"feetech"'), r"buses\[0\].kind \(line 6\).*did you mean"),
    "unknown key": (("id = 1,", "ident = 1,"), r"legs\[0\].coxa.ident \(line 10\): unknown key; did you mean 'id'"),
    "other place": (("[[legs]]", "zero_us = 3\n[[legs]]"), "it belongs to the table of a joint"),
    "bus": (("id = 1,", 'bus = "arm", id = 1,'), "there is no bus 'arm'; there are: main"),
    "date": (('robot = "strider"', 'robot = "strider"\ndate = "soon"'), "must be a date such as 2026-05-31"),
    "robot": (('robot = "strider"', 'robot = "stridr"'), r"c.toml \(line 2\): 1 problem\n  the robot file"),
    "two buses": (("[[legs]]", '[[buses]]\nname = "b"\nkind = "lx16a"\n[[legs]]'), "bus: missing; there are 2"),
    "same buses": (("[[legs]]", '[[buses]]\nname = "main"\nkind = "maestro"\n[[legs]]'), None),
    "no TOML": (("[[legs]]", "[[legs"), "not valid TOML"),
}


@pytest.mark.parametrize("name", EDITS)
def test_what_is_wrong_is_refused_with_its_line(name, tmp_path):
    (old, new), message = EDITS[name]
    text = calibration_text(nominal())
    assert old in text
    text = text.replace(old, new, 1) if name != "kind" else text.replace(old, new)
    (tmp_path / "c.toml").write_text(text, encoding="utf-8")
    if name == "id beyond":
        assert Calibration.load(tmp_path / "c.toml").joints[0][1].number == 253
        return
    with pytest.raises(CalibrationError) as caught:
        Calibration.load(tmp_path / "c.toml")
    if message is not None:
        assert re.search(message, str(caught.value)), str(caught.value)


def test_what_is_wrong_in_python_is_refused():
    made = nominal()
    for changes, message in [
        ({"direction": 3}, "direction is 3"),
        ({"scale": -1.0}, "scale is -1; it must be a finite number greater than 0"),
        ({"zero": math.nan}, "zero is nan"),
        ({"number": 400}, "id is 400; on Feetech STS and SMS it is from 0 to 253"),
    ]:
        with pytest.raises(CalibrationError, match=message):
            made.with_joint(1, 1, **changes)
    for joints in (made.joints[:5], tuple(row[:2] for row in made.joints)):
        with pytest.raises(InputError, match="3 joints for each of its 6 legs"):
            made.replace(joints=joints)
    with pytest.raises(CalibrationError, match="no kind of bus is called 'zzz'; there are"):
        made.replace(buses=(tarsus.hardware.BusSettings(name="main", kind="zzz"),))
    with pytest.raises(CalibrationError, match="two buses are called 'main'"):
        made.replace(buses=made.buses * 2)
    for switches, message in [
        (FootSwitches(bus="x", inputs=(0, 1, 2, 3, 4, 5)), "there is no bus 'x'"),
        (FootSwitches(bus="main", inputs=(0, 1)), "2 inputs; the robot has 6 legs"),
        (FootSwitches(bus="main", inputs=(0, 0, 1, 2, 3, 4)), "two legs have the same input"),
        (FootSwitches(bus="main", inputs=(0, 1, 2, 3, 4, 5)), "a feetech-sts bus has no inputs; .* maestro, ssc32, "),
    ]:
        with pytest.raises(CalibrationError, match=message):
            made.replace(foot_switches=switches)
    for kind, inputs, message in [
        ("servo2040", (0, 1, 2, 3, 4, 6), "servo2040 has no input 6; inputs are 0 to 5"),
        ("maestro", (17, 18, 19, 20, 21, 22), "channel 17 is that of a servo"),
    ]:
        with pytest.raises(CalibrationError, match=message):
            nominal(kind, foot_switches=FootSwitches(bus="main", inputs=inputs))
    with pytest.raises(InputError, match="single robot"):
        made.replace(robot=tarsus.stack_robots([STRIDER, STRIDER]))
    with pytest.raises(UnknownNameError, match="kind of bus"):
        nominal_calibration(STRIDER, "strider", kind="sts")
    blank = new_calibration(STRIDER, "strider").joints[0][0]
    with pytest.raises(InputError, match="number, zero, direction must be known"):
        angle_range(blank)
    with pytest.raises(InputError, match="zero must be known"):
        blank.command(0.1)
    with pytest.raises(InputError, match="direction and scale must be known"):
        dataclasses.replace(blank, zero=1500.0).command(0.1)
    assert vars(nominal())["joints"][0][0].missing == ()


def test_a_calibration_that_is_not_complete_says_what_is_missing_and_converts_nothing(tmp_path):
    made = new_calibration(STRIDER, "strider", kind="pca9685")
    assert made.missing[4] == "middle left femur: channel, zero, direction"
    made.save(tmp_path / "c.toml")
    read = Calibration.load(tmp_path / "c.toml")
    assert read.joints == made.joints
    for use in (lambda: read.commands(STRIDER.limits[..., 0]), lambda: read.limits, lambda: read.slopes):
        with pytest.raises(CalibrationError, match=r"18 problems\n  front left coxa: channel, zero, direction"):
            use()


def test_servos_set_steps_and_travel():
    assert new_calibration(tarsus.load_robot("phantomx"), "phantomx").buses[0].kind == "dynamixel-x"
    for name, kind, step in [
        ("AX-12A", "dynamixel-ax", 300 / 1024),
        ("MX-28T/AT", "dynamixel-x", 360 / 4096),
        ("STS3215 12V (C018)", "feetech-sts", 360 / 4096),
        ("SCS15 / Waveshare SC15", "feetech-scs", 300 / 1024),
        ("LX-16A", "lx16a", 0.24),
    ]:
        made = new_calibration(STRIDER.replace(servos=((tarsus.load_servo(name),) * 3,) * 6), "strider")
        assert made.buses[0].kind == kind
        assert made.joints[0][0].scale == pytest.approx(1 / math.radians(step), rel=1e-5)
    blank = new_calibration(STRIDER.replace(servos=()), "strider")
    assert (blank.buses[0].kind, blank.units[0][0]) == ("servo2040", "us")
    assert math.radians(180) * blank.joints[0][0].scale == pytest.approx(2000, rel=1e-3)


def test_the_robot_file_is_found_beside_the_calibration(tmp_path):
    tarsus.save_robot(STRIDER.replace(name="mine"), tmp_path / "mine.toml")
    made = nominal().replace(robot_file="mine.toml")
    made.save(tmp_path / "c.toml")
    assert Calibration.load(tmp_path / "c.toml").robot.name == "mine"
    assert Calibration.load(tmp_path / "c.toml", robot=STRIDER).robot is STRIDER


def test_files_that_are_none(tmp_path):
    for content, message in [
        (b"\xff", "not UTF-8"),
        (b"a" * (2**20 + 1), "larger than 1 MiB"),
        (b"x", "line 1, at the end: not valid TOML"),
        (b'robot = "strider\n', r"line 1, column 17: not valid TOML: .*Likely cause: a quote is missing"),
    ]:
        (tmp_path / "c.toml").write_bytes(content)
        with pytest.raises(CalibrationError, match=message):
            Calibration.load(tmp_path / "c.toml")
    for path, message in [
        (tmp_path / "none.toml", "calibration new"),
        (tmp_path, "can't be read"),
        ("\0", "valid path"),
    ]:
        with pytest.raises(CalibrationError, match=message):
            Calibration.load(path)
    with pytest.raises(CalibrationError, match="a pipe or a device"):
        Calibration.load("/dev/null")
    with pytest.raises(CalibrationError, match="can't be written"):
        nominal().save(tmp_path / "none" / "c.toml")


def test_the_schema_accepts_what_is_written():
    document = tomllib.loads(calibration_text(whole().replace(date=None)))
    jsonschema.Draft202012Validator(calibration_schema()).validate(document)
    document["legs"][0]["coxa"]["direction"] = 0
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.Draft202012Validator(calibration_schema()).validate(document)
    assert json.loads(run("calibration", "schema").stdout) == calibration_schema()


@pytest.mark.parametrize("kind", BUSES)
def test_what_a_kind_of_bus_takes_is_what_its_bus_says(kind):
    bus, _ = emulated_bus(kind, range(1, 19) if kind not in ("servo2040", "lines") else range(18))
    can, known = bus.capabilities, BUS_COMMANDS[kind]
    assert set(BUS_COMMANDS) == set(BUSES)
    assert known.unit.removesuffix("s") == can.unit.removesuffix("s")
    assert known.commands[0] >= can.lowest
    assert known.commands[1] <= can.highest
    assert known.numbers[0] == can.ids.start
    # An Arduino has as many channels as its sketch says.
    assert known.numbers[1] == can.ids.stop - 1 or kind == "lines"
    assert known.feedback == can.positions
    assert (known.steps is None) == (can.per_turn is None)
    if known.steps is not None:
        assert known.steps[0] * 360 / known.steps[1] == can.per_turn


def test_channels_beyond_the_boards_are_refused(tmp_path):
    made = nominal("pca9685")
    one = made.buses[0]
    with pytest.raises(CalibrationError, match="channel is 16; on PCA9685 boards on I2C it is from 0 to 15"):
        made.replace(buses=(dataclasses.replace(one, addresses=(0x42,)),))
    both = made.replace(buses=(dataclasses.replace(one, addresses=(0x42, 0x40)),))
    both.save(tmp_path / "c.toml")
    assert Calibration.load(tmp_path / "c.toml").buses == both.buses


@settings(max_examples=50)
@given(st.decimals(Decimal("0.001"), 10000, places=6))
def test_a_scale_of_a_degree_converts_back_to_its_digits(value):
    assert per_degree(per_radian(value)) == value


def test_dates_numbers_and_ports_as_other_writers_write_them(tmp_path):
    text = calibration_text(nominal()).replace("id = 1,", "id = 1.0,", 1)
    text = text.replace('kind = "feetech-sts"', 'kind = "feetech-sts"\nport = "/dev/ttyUSB0"\nbaud = 500_000')
    (tmp_path / "c.toml").write_text(f"date = 2026-05-31T10:00:00\n{text}", encoding="utf-8")
    read = Calibration.load(tmp_path / "c.toml")
    assert str(read.date) == "2026-05-31"
    assert read.joints[0][0].number == 1
    assert (read.buses[0].port, read.buses[0].baud) == ("/dev/ttyUSB0", 500_000)
    read.save(tmp_path / "d.toml")
    assert Calibration.load(tmp_path / "d.toml").buses == read.buses
    (tmp_path / "c.toml").write_text(text.replace("id = 1.0,", "id = 1.5,"), encoding="utf-8")
    with pytest.raises(CalibrationError, match="must be a whole number from 0 to 253"):
        Calibration.load(tmp_path / "c.toml")
    text = calibration_text(nominal("lines"))
    for inputs, switches in [("[0, 1, 2, 3, -1, 5]", (0, 1, 2, 3, None, 5)), ("[]", None)]:
        (tmp_path / "c.toml").write_text(f"{text}\n[sensors]\nfoot_switches = {{ inputs = {inputs} }}")
        if switches is None:
            with pytest.raises(CalibrationError, match=r"0 inputs.*\(line"):
                Calibration.load(tmp_path / "c.toml")
        else:
            assert Calibration.load(tmp_path / "c.toml").foot_switches.inputs == switches


def test_thresholds_of_sensors_of_force_are_kept_and_checked(tmp_path):
    inputs, volts = (0, 1, 2, 3, 4, None), (0.5, 1.0, 1.5, 2.0, 2.5, 0.0)
    switches = FootSwitches(bus="main", inputs=inputs, thresholds=volts, hysteresis=0.1)
    made = nominal("servo2040", foot_switches=switches)
    made.save(tmp_path / "c.toml")
    assert Calibration.load(tmp_path / "c.toml").foot_switches == switches
    text = (tmp_path / "c.toml").read_text(encoding="utf-8")
    for wrong, message in [
        (
            "[0.5, 1.0, 1.5, 2.0, 3.28, 0]",
            r"middle right leg is 3.28 V; .* between 0.05 and 3.25 V, as Pimoroni .*\(line",
        ),
        ("[0.5, 1.0]", "2 thresholds; the robot has 6 legs"),
        ("[0.5, 1.0, 1.5, 2.0, 2.5, 6]", "from 0 to 5 V"),
        ("[0.5, 1.0, 1.5, 2.0, nan, 1]", "from 0 to 5 V"),
        ("1.5", "thresholds_v"),
    ]:
        changed = re.sub(r"thresholds_v = \[[^]]*\]", f"thresholds_v = {wrong}", text)
        assert changed != text
        (tmp_path / "d.toml").write_text(changed, encoding="utf-8")
        with pytest.raises(CalibrationError, match=message):
            Calibration.load(tmp_path / "d.toml")
    with pytest.raises(CalibrationError, match="input 12 of Pololu Mini Maestro tells high or low"):
        nominal("lines").replace(
            buses=(*nominal("lines").buses, tarsus.hardware.BusSettings(name="feet", kind="maestro")),
            foot_switches=FootSwitches(bus="feet", inputs=(0, 1, 2, 3, 4, 12), thresholds=(1.0,) * 6),
        )
    with pytest.raises(CalibrationError, match="has no threshold; none measures a voltage"):
        nominal("lines", foot_switches=FootSwitches(bus="main", inputs=(0, 1, 2, 3, 4, 5), thresholds=(1.0,) * 6))


def test_a_supply_below_its_least_voltage_is_refused_with_its_line(tmp_path):
    wrong = "\n[supply]\nvoltage_v = 7.4\nleast_v = 9\n"
    (tmp_path / "c.toml").write_text(calibration_text(nominal()) + wrong, encoding="utf-8")
    with pytest.raises(CalibrationError, match=r"7.4 V, and .* below 9 V: least_v must be less than .*\(line \d+"):
        Calibration.load(tmp_path / "c.toml")


@pytest.mark.parametrize("value", ["inf", "-inf", "nan", "1e400"])
def test_numbers_that_are_none_are_refused_wherever_a_whole_one_is_due(value, tmp_path):
    text = calibration_text(nominal())
    for changed in (
        text.replace("id = 1,", f"id = {value},", 1),
        text.replace("[[legs]]", f"baud = {value}\n[[legs]]", 1),
    ):
        assert changed != text
        (tmp_path / "c.toml").write_text(changed, encoding="utf-8")
        with pytest.raises(CalibrationError, match="must be a whole number"):
            Calibration.load(tmp_path / "c.toml")


def test_joints_and_switches_find_the_bus_that_fits(tmp_path):
    feet = tarsus.hardware.BusSettings(name="feet", kind="lines")
    made = nominal()
    made = made.replace(buses=(*made.buses, feet), foot_switches=FootSwitches(bus="feet", inputs=(0, 1, 2, 3, 4, 5)))
    text = calibration_text(made).replace('bus = "main", ', "").replace('bus = "feet", ', "")
    (tmp_path / "c.toml").write_text(text, encoding="utf-8")
    read = Calibration.load(tmp_path / "c.toml")
    assert (read.joints, read.foot_switches) == (made.joints, made.foot_switches)
    text = text.replace('kind = "lines"', 'kind = "feetech-sts"')
    (tmp_path / "c.toml").write_text(text, encoding="utf-8")
    with pytest.raises(CalibrationError, match="bus: missing; there are 2: main, feet"):
        Calibration.load(tmp_path / "c.toml")


def test_lines_of_tables_and_keys():
    lines = key_lines("a = 1\n[[legs]]\n[[legs]]\nname = 2\n[legs.coxa]\nid = 1\n[supply]\n# x\nv = 1\n")
    assert lines[("legs", 1, "name")] == 4
    assert lines[("legs", 1, "coxa", "id")] == 6
    assert line_of(("supply", "v", "x"), lines) == 9
    assert line_of(("b",), lines) == 1


def test_the_commands_write_and_check_files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert "18 joints are not calibrated yet" in run("calibration", "new", "strider").stdout
    assert run("calibration", "new", "strider").exit_code == 2
    assert run_json("calibration", "check", "strider.calibration.toml")[0] == 1
    tarsus.save_robot(STRIDER, "own.toml")
    code, made = run_json("calibration", "new", "own.toml", "--nominal", "--bus", "lx16a", "--out", "c.toml")
    assert (code, made["bus"], made["missing"]) == (0, "lx16a", [])
    table = run("calibration", "check", "c.toml")
    assert table.exit_code == 0
    assert "front left coxa         1" in table.stdout
    code, found = run_json("calibration", "check", "c.toml")
    assert code == 0
    assert found["joints"][17]["angles_deg"] == [-160, 10]
    assert "missing: front left coxa" in run("calibration", "check", "strider.calibration.toml").stdout
    (tmp_path / "c.toml").write_text("name = 3", encoding="utf-8")
    assert run("calibration", "check", "c.toml").exit_code == 1
    code, found = run_json("calibration", "check", "c.toml")
    assert (code, found["complete"]) == (1, False)
    assert len(found["problems"]) == 3


def test_lines_are_found_in_everything_that_toml_allows():
    text = """[sensors . imu]
"port" = "x"
[[ a.b ]]
[[a.b]]
c.d = [
  [1],
  "]", # ]
]
[a.b.e]
f = \"\"\"[x]
g = 1 \"\"\"
h = 2
i = '[' # [
j = {k = [1]}
"""
    lines = key_lines(text)
    assert lines == {
        (): 1,
        ("sensors",): 1,
        ("sensors", "imu"): 1,
        ("sensors", "imu", "port"): 2,
        ("a",): 3,
        ("a", "b"): 3,
        ("a", "b", 0): 3,
        ("a", "b", 1): 4,
        ("a", "b", 1, "c"): 5,
        ("a", "b", 1, "c", "d"): 5,
        ("a", "b", 1, "e"): 9,
        ("a", "b", 1, "e", "f"): 10,
        ("a", "b", 1, "e", "h"): 12,
        ("a", "b", 1, "e", "i"): 13,
        ("a", "b", 1, "e", "j"): 14,
    }
    assert line_of(("nothing",), lines) == 1
    assert line_of(("nothing",), {}) is None


def test_every_message_about_a_calibration_file_names_a_line():
    good = calibration_text(nominal()).splitlines()
    mistaken = [""]
    for i, line in enumerate(good):
        mistaken.append("\n".join(good[:i] + good[i + 1 :]))
        mistaken += ["\n".join([*good[:i], new, *good[i:]]) for new in ("[foo]", "odd = 1", "[supply]", "[[legs]]")]
        if "=" in line:
            mistaken += [
                "\n".join([*good[:i], line.replace("= ", new, 1), *good[i + 1 :]]) for new in ("= -", "= [] #")
            ]
    refused = []
    for text in mistaken:
        try:
            Calibration.from_text(text, STRIDER)
        except CalibrationError as error:
            refused += [problem for problem in error.problems if not re.search(r"line \d+", problem)] or [""]
    assert len(refused) > 100
    assert not any(refused), sorted(set(refused))
