"""Joint verdicts: class boundaries, continuous load, speed, and their text."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sample_loads import sample_loads, sample_motion
from tarsus.errors import InputError, UnknownNameError
from tarsus.load.loads import joint_loads
from tarsus.load.verdict import CLASSES, JointVerdict, class_of, joint_verdicts, require_rule
from tarsus.robot.servo import Servo

SERVO = Servo(name="S", stall_torque=3.0, no_load_speed=6.0)


def verdict(**changes):
    values = {
        "leg": "LM",
        "joint": "femur",
        "servo": SERVO,
        "peak": 1.0,
        "rms": 0.5,
        "peak_speed": 3.0,
        "stall_torque": 3.0,
        "no_load_speed": 6.0,
        "utilisation": 0.5,
        "cause": "at 1.00 s",
        "safety_factor": 3.0,
    }
    return JointVerdict(**{**values, **changes})


@pytest.mark.parametrize(
    ("factor", "name"),
    [
        (0.0, "cannot stand"),
        (np.nextafter(1.0, 0), "cannot stand"),
        (1.0, "stalls or burns"),
        (np.nextafter(1.5, 0), "stalls or burns"),
        (1.5, "marginal"),
        (np.nextafter(3.0, 0), "marginal"),
        (3.0, "good"),
        (1e9, "good"),
        (math.inf, "good"),
        (math.nan, "unknown"),
    ],
)
def test_class_boundaries(factor, name):
    assert class_of(factor) == name


@given(factor=st.floats(0, 100))
def test_class_is_monotonic_in_the_factor(factor):
    names = [name for _, name in CLASSES]
    assert names.index(class_of(factor)) <= names.index(class_of(factor * 1.5 + 0.1))


@given(stall=st.floats(0.1, 10), peak=st.floats(0.01, 10), rms=st.floats(0, 5))
def test_factor_and_thermal_ratio(stall, peak, rms):
    one = verdict(stall_torque=stall, peak=peak, rms=rms)
    assert one.factor == stall / peak
    assert one.thermal_ratio == pytest.approx(5 * rms / stall)
    assert one.within_continuous_limit == (one.thermal_ratio <= 1)
    assert one.strong_enough == one.satisfies("factor") == (stall >= 3 * peak or stall / peak >= 3)
    assert one.satisfies("continuous") == one.within_continuous_limit
    assert one.class_name == class_of(stall / peak)


def test_joint_without_load():
    assert verdict(peak=0.0, rms=0.0).factor == math.inf
    assert verdict(peak=0.0, rms=0.0).text() == "no load"
    assert math.isnan(verdict(peak=0.0, servo=None, stall_torque=math.nan).factor)


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({}, "safety factor 3.0"),
        ({"peak": 2.4}, "stalls or burns: safety factor 1.25, 4.20 N m short of factor 3"),
        ({"peak": 4.0, "rms": 0.0}, "cannot stand: safety factor 0.75, 9.00 N m short of factor 3"),
        ({"peak": 1.5, "safety_factor": 2.0}, "safety factor 2.0"),
        ({"rms": 0.9}, "safety factor 3.0; runs warm: RMS torque 1.5 times its continuous limit (1/5 of stall)"),
        ({"peak_speed": 8.0, "utilisation": 1.4}, "safety factor 3.0; too slow by 115 deg/s"),
        (
            {"utilisation": 1.1},
            "safety factor 3.0; too slow under load: 110 % of its torque-speed line",
        ),
        (
            {"no_load_speed": math.nan, "utilisation": math.nan},
            "safety factor 3.0; the no-load speed of S is unknown: set no_load_rad_s in the robot file",
        ),
        (
            {"servo": None, "stall_torque": math.nan, "no_load_speed": math.nan, "utilisation": math.nan},
            "the robot file names no servo; 3.00 N m required",
        ),
    ],
)
def test_text(changes, text):
    assert verdict(**changes).text() == text


@pytest.mark.parametrize(
    ("changes", "factor", "continuous"),
    [
        ({}, True, True),
        ({"utilisation": 1.01}, False, False),
        ({"peak_speed": 6.01}, False, False),
        ({"utilisation": math.nan}, False, False),
        ({"peak": 2.0}, False, True),
        ({"rms": 0.7}, True, False),
        ({"stall_torque": math.nan, "servo": None}, False, False),
    ],
)
def test_sufficient_servo_satisfies_the_rule_and_is_fast_enough(changes, factor, continuous):
    assert verdict(**{"rms": 0.5, **changes}).is_sufficient("factor") is factor
    assert verdict(**{"rms": 0.5, **changes}).is_sufficient("continuous") is continuous


def test_verdicts_cover_every_joint_in_order():
    found = sample_loads()
    verdicts = joint_verdicts(found, safety_factor=2.0)
    assert [v.leg for v in verdicts[::3]] == list(found.robot.leg_codes)
    assert [v.joint for v in verdicts[:3]] == ["coxa", "femur", "tibia"]
    for number, one in enumerate(verdicts):
        leg, joint = divmod(number, 3)
        assert one.peak == found.peak[leg, joint]
        assert one.rms == found.rms[leg, joint]
        assert one.factor == pytest.approx(found.factor[leg, joint])
        assert one.utilisation == found.utilisation[:, leg, joint].max()
        assert one.cause == found.cause(leg, joint)
        assert one.safety_factor == 2.0


def test_unknown_no_load_speed():
    motion = sample_motion()
    robot = motion.robot.replace(servos=((Servo(name="mystery", stall_torque=9.0),) * 3,) * 6)
    for one in joint_verdicts(joint_loads(robot, motion)):
        assert "the no-load speed of mystery is unknown: set no_load_rad_s" in one.text()
        assert not one.fast_enough


def test_a_supply_far_above_the_rated_one_leaves_no_verdict():
    for one in joint_verdicts(sample_loads(supply=12.0)):
        assert (one.class_name, one.is_sufficient("factor")) == ("unknown", False)
        assert one.text() == (
            "DS3225 is rated for 4.8 to 6.8 V; torque and speed are unknown at the supply of 12 V, more than 1.5 times "
            f"that; {3 * one.peak:.2f} N m required"
        )


@pytest.mark.parametrize("factor", [0.0, -1.0, math.nan, math.inf])
def test_invalid_safety_factor(factor):
    with pytest.raises(InputError, match="safety_factor is"):
        joint_verdicts(sample_loads(), safety_factor=factor)


def test_unknown_rule():
    with pytest.raises(UnknownNameError, match="Did you mean 'continuous'"):
        require_rule("continous")
    require_rule("factor")
