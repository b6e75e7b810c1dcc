"""The servo catalogue: every row sourced and sound, what is unknown unknown."""

import csv
import math
from pathlib import Path

import pytest

import tarsus.robot.catalogue as catalogue
from tarsus.errors import InputError, UnknownNameError
from tarsus.robot.catalogue import list_servos, load_servo, servo_catalogue
from tarsus.robot.schema import ServoFigures
from tarsus.robot.servo import Servo

CSV = Path(catalogue.__file__).with_name("servos.csv")
with CSV.open(encoding="utf-8", newline="") as table:
    ROWS = list(csv.DictReader(table))


def test_every_row_is_in_the_catalogue_once():
    assert [row["name"] for row in ROWS] == list(list_servos())
    assert len({name.lower() for name in list_servos()}) == len(ROWS) == 31


def test_the_columns_are_the_keys_of_robot_files():
    assert list(ROWS[0]) == sorted(ServoFigures.model_fields, key=list(ROWS[0]).index)


@pytest.mark.parametrize("row", ROWS, ids=[row["name"] for row in ROWS])
def test_every_row_is_plausible_and_has_a_source(row):
    servo = load_servo(row["name"])
    assert servo.source
    assert servo.confidence in ("A", "B", "C")
    assert servo.maker
    assert servo.control
    assert servo.feedback
    assert 0.1 < servo.stall_torque < 10
    assert servo.supply is not None
    assert servo.supply[0] < servo.supply[1]
    assert servo.supply[0] <= servo.torque_at <= servo.supply[1]
    assert (servo.no_load_speed is None) == (servo.speed_at is None)
    assert servo.rated_torque is None or servo.rated_torque < servo.stall_torque
    figures = catalogue.figures_of(servo)
    ServoFigures.model_validate(figures)
    assert catalogue.servo_of({**dict.fromkeys(row), **figures}) == servo
    assert {key for key, value in row.items() if value} == figures.keys()


def test_data_are_in_si_units():
    servo = load_servo("MG996R")
    assert servo.stall_torque == 1.079
    assert servo.torque_at == 6.0
    assert servo.no_load_speed == 7.48
    assert servo.stall_current == 2.5
    assert servo.mass == 0.055
    assert servo.supply == (4.8, 7.2)
    assert servo.travel == pytest.approx(math.radians(120), rel=1e-15)
    assert servo.rated_torque is None


@pytest.mark.parametrize(
    ("name", "attribute", "value"),
    [
        ("HS-485HB", "stall_current", 1.2),
        ("STS3032", "stall_current", 1.2),
        ("STS3032", "rated_torque", 0.15),
        ("SCS15 / Waveshare SC15", "stall_current", 1.7),
        ("AX-18A", "stall_current", 2.2),
        ("STS3215 7.4V (C001)", "rated_torque", 0.5),
        ("LSS-ST1", "mass", None),
        ("HTS-35H", "no_load_speed", None),
        ("Savox SC-1258TG", "travel", None),
    ],
)
def test_known_and_unknown_data(name, attribute, value):
    assert getattr(load_servo(name), attribute) == value


@pytest.mark.parametrize(
    ("name", "buses"),
    [
        ("SG90", {"PWM"}),
        ("Savox SB-2271SG", {"PWM"}),
        ("LX-16A", {"LewanSoul/Hiwonder"}),
        ("STS3032", {"Feetech STS/SMS"}),
        ("SCS15 / Waveshare SC15", {"Feetech SCS"}),
        ("AX-12A", {"Dynamixel 1.0"}),
        ("MX-28T/AT", {"Dynamixel 1.0", "Dynamixel 2.0"}),
        ("XL430-W250-T", {"Dynamixel 2.0"}),
        ("LSS-HT1", {"Lynxmotion LSS", "PWM"}),
    ],
)
def test_buses(name, buses):
    assert load_servo(name).buses == buses


def test_every_servo_of_the_catalogue_has_a_bus():
    assert all(servo.buses for servo in servo_catalogue().values())
    assert Servo(name="own", stall_torque=1.0).buses == frozenset()


@pytest.mark.parametrize(
    ("figures", "line"),
    [
        ({"stall_torque": 0.0}, "servo 'own': stall_torque is 0 N m; it must be greater than 0"),
        (
            {"stall_torque": 1.0, "no_load_speed": -2.0},
            "servo 'own': no_load_speed is -2 rad/s; it must be greater than 0; None where unknown",
        ),
    ],
)
def test_torque_and_speed_of_a_servo_are_greater_than_0(figures, line):
    with pytest.raises(InputError) as caught:
        Servo(name="own", **figures)
    assert str(caught.value) == line


def test_names_are_case_insensitive():
    assert load_servo("ax-12a") is load_servo("AX-12A") is servo_catalogue()["AX-12A"]


def test_an_unknown_name_suggests_the_nearest_and_lists_all():
    with pytest.raises(UnknownNameError, match=r"no servo is called 'MG99R'\. Did you mean 'MG996R'\?") as caught:
        load_servo("MG99R")
    assert all(name in str(caught.value) for name in list_servos())


def test_the_catalogue_is_read_once_and_immutable():
    assert servo_catalogue() is servo_catalogue()
    with pytest.raises(TypeError):
        servo_catalogue()["AX-12A"] = None
