"""Joint loads over a motion: peaks, work, speeds, servo limits, assumptions."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gait_robots import ring
from sample_loads import BURNT, robot_of, sample_loads, sample_motion
from tarsus.errors import InputError, MissingDataError
from tarsus.gait.gait import Gait
from tarsus.gait.path import curved_path, straight_path
from tarsus.gait.plan import plan_walk
from tarsus.kinematics.mass import total_mass
from tarsus.load.inverse_dynamics import motion_torques
from tarsus.load.loads import joint_loads
from tarsus.load.payload import Payload
from tarsus.load.servo_limits import at_supply, utilisation, why_not_rated
from tarsus.load.verdict import BURNOUT_FACTOR, joint_verdicts
from tarsus.robot.catalogue import load_servo
from tarsus.robot.file import robot_from_dict, robot_to_dict
from tarsus.robot.robot import JOINTS
from tarsus.robot.servo import Servo


def test_peaks_follow_from_the_torques():
    found = sample_loads()
    for leg in range(6):
        for joint in range(3):
            column = np.abs(found.torques[:, leg, joint])
            sample = found.peak_sample[leg, joint]
            assert column[sample] == found.peak[leg, joint] == max(column)
    for joint in range(3):
        assert found.peak[found.worst(joint), joint] == found.peak[:, joint].max()


def test_torques_with_and_without_inertia():
    motion = sample_motion()
    for inertial in (True, False):
        solved = motion_torques(motion.robot, motion, payload=0.3, inertial=inertial)
        found = joint_loads(motion.robot, motion, payload=0.3, inertial=inertial)
        np.testing.assert_array_equal(found.torques, solved.torques)
        np.testing.assert_array_equal(found.forces, solved.forces)
        np.testing.assert_array_equal(found.margin, solved.margin)
        assert found.inertial is inertial


def test_rms_of_a_constant_torque():
    found = sample_loads()
    constant = replace(found, torques=np.broadcast_to([0.1, -0.5, 0.2], found.torques.shape))
    np.testing.assert_allclose(constant.rms, np.broadcast_to([0.1, 0.5, 0.2], (6, 3)), rtol=1e-12)
    assert (found.rms <= found.peak).all()


def test_energy_is_positive_work_only():
    """A joint with constant torque does torque times angle as work; the negative work of a driven joint is lost."""
    found = sample_loads()
    n = len(found.motion.time)
    angles = np.zeros((n, 6, 3))
    angles[:, 0, 1] = np.linspace(0, 0.8, n)
    angles[:, 1, 1] = np.linspace(0, -0.8, n)
    torques = np.zeros((n, 6, 3))
    torques[:, :2, 1] = 0.5
    turned = replace(found, motion=replace(found.motion, angles=angles), torques=torques)
    assert turned.energy == pytest.approx(0.4)
    assert turned.power[:, 1, 1].max() < 0
    np.testing.assert_allclose(turned.peak_speed[0, 1], 0.8 / found.motion.duration)


def test_cost_of_transport():
    found = sample_loads(payload=0.5)
    weight = 9.80665 * (total_mass(found.robot) + 0.5)
    assert found.weight == pytest.approx(weight)
    assert found.distance == pytest.approx(0.3)
    assert found.cost_of_transport == pytest.approx(found.energy / (weight * 0.3))
    body = found.motion.body[np.zeros(len(found.motion.time), dtype=int)]
    assert replace(found, motion=replace(found.motion, body=body)).cost_of_transport == math.inf


def test_weight_under_other_gravity():
    moon = sample_loads(gravity=(0.0, 0.0, -1.62), inertial=False)
    earth = sample_loads(inertial=False)
    assert moon.weight / earth.weight == pytest.approx(1.62 / 9.80665)
    np.testing.assert_allclose(moon.peak[:, 1:] * 9.80665 / 1.62, earth.peak[:, 1:])
    assert moon.conditions == {"gravity": (0.0, 0.0, -1.62), "inertial": False, "supply": None}


def test_cause_of_the_peak_torque():
    found = sample_loads(inertial=False)
    leg = found.worst(1)
    sample = found.peak_sample[leg, 1]
    text = found.cause(leg, 1)
    assert text.startswith(f"at {found.motion.time[sample]:.2f} s, stance of ")
    down = [code for code, at in zip(found.robot.leg_codes, found.motion.contacts[sample], strict=True) if at]
    assert f"stance of {' '.join(down)}, " in text
    assert f"{100 * found.forces[sample, leg, 2] / found.forces[sample, :, 2].sum():.0f} % of the weight" in text
    air = replace(found, motion=replace(found.motion, contacts=np.zeros_like(found.motion.contacts)))
    assert air.cause(leg, 1).endswith("s, swing")


# Servo limits


@given(volts=st.floats(1, 30))
def test_ratings_scale_with_the_voltage(volts):
    servo = Servo(name="a", stall_torque=2.0, torque_at=6.0, no_load_speed=5.0, speed_at=5.0)
    assert at_supply(servo, volts) == pytest.approx((2 * volts / 6, volts))
    assert at_supply(servo, None) == (2.0, 5.0)
    unrated = Servo(name="b", stall_torque=2.0, no_load_speed=5.0)
    assert at_supply(unrated, volts) == (2.0, 5.0)


@pytest.mark.parametrize(("volts", "known"), [(7.2, True), (9.0, True), (9.01, False), (600.0, False)])
def test_ratings_are_unknown_far_above_the_rated_supply(volts, known):
    servo = Servo(name="a", stall_torque=2.0, torque_at=6.0, no_load_speed=5.0, speed_at=6.0, supply=(4.8, 6.0))
    assert np.isfinite(at_supply(servo, volts)).tolist() == [known, known]
    why = "a is rated for 4.8 to 6 V; torque and speed are unknown at the supply of 600 V, more than 1.5 times that"
    assert why_not_rated(servo, 600.0) == why
    assert why_not_rated(servo, 9.0) == why_not_rated(servo, None) == ""
    motion = sample_motion()
    assert why in joint_loads(motion.robot.replace(servos=((servo,) * 3,) * 6), motion, supply=600.0).assumed


def test_unknown_ratings_are_nan():
    np.testing.assert_array_equal(at_supply(None, 6.0), (math.nan, math.nan))
    np.testing.assert_array_equal(at_supply(Servo(name="a", stall_torque=2.0), 6.0), (2.0, math.nan))


@given(
    fraction=st.floats(0, 1),
    stall=st.floats(0.1, 10),
    free=st.floats(0.1, 20),
    sign=st.sampled_from([-1, 1]),
)
def test_utilisation_is_1_along_the_torque_speed_line(fraction, stall, free, sign):
    torque, speed = np.array(sign * fraction * stall), np.array(sign * (1 - fraction) * free)
    assert utilisation(torque, speed, stall, free) == pytest.approx(1 if fraction else (fraction or 0.0), abs=1e-9)
    # A driven servo is limited by its torque alone.
    assert utilisation(torque, -speed, stall, free) == pytest.approx(fraction, abs=1e-9)


def test_factor_and_utilisation_of_the_joints():
    found = sample_loads()
    servo = load_servo("DS3225")
    np.testing.assert_allclose(found.factor, servo.stall_torque / found.peak)
    used = found.utilisation
    assert used.shape == found.torques.shape
    assert (used >= np.abs(found.torques) / servo.stall_torque).all()
    assert sample_loads(supply=3.4).factor == pytest.approx(found.factor / 2)


# Assumptions and errors


def test_assumptions():
    strider = sample_loads().assumed
    assert any("slender uniform rod" in text for text in strider)
    assert "DS3225 at 6.8 V, the voltage of its rated stall torque" in strider
    given_volts = sample_loads(supply=9.0).assumed
    assert "DS3225 is rated for 4.8 to 6.8 V; torque and speed are extrapolated to the supply of 9 V" in given_volts
    assert not any("rated stall torque" in text for text in given_volts)
    assert not any("rod" in text for text in sample_loads(inertial=False).assumed)
    assert not any("DS3225" in text for text in sample_loads(supply=6.0).assumed)


@pytest.mark.parametrize(
    ("servo", "supply", "text"),
    [
        (Servo(name="X", stall_torque=2.0), None, "X at an unknown voltage, the voltage of its rated stall torque"),
        (
            Servo(name="X", stall_torque=2.0),
            6.0,
            "X: the voltage of its ratings is unknown; they are used unchanged at 6 V",
        ),
        (
            Servo(name="X", stall_torque=2.0, torque_at=6.0, no_load_speed=5.0),
            5.0,
            "X: the voltage of its ratings is unknown; they are used unchanged at 5 V",
        ),
    ],
)
def test_unknown_rated_voltage_is_an_assumption(servo, supply, text):
    motion = sample_motion()
    robot = motion.robot.replace(servos=((servo,) * 3,) * 6)
    assert text in joint_loads(robot, motion, supply=supply).assumed


def test_joints_without_a_servo():
    motion = sample_motion()
    rows = [list(row) for row in motion.robot.servos]
    rows[2][1] = None
    some = joint_loads(motion.robot.replace(servos=rows), motion)
    assert "the robot file names no servo for femur of LR; no verdict there" in some.assumed
    assert np.isnan(some.factor[2, 1])
    assert np.isnan(some.factor).sum() == 1
    none = joint_loads(motion.robot.replace(servos=()), motion)
    assert "the robot file names no servo for any joint; no verdict there" in none.assumed


def test_feet_out_of_reach_are_an_assumption():
    motion = sample_motion()
    reach = motion.reach.copy()
    reach[3:5, 1] = 1
    found = joint_loads(motion.robot, replace(motion, reach=reach))
    assert (
        f"a foot is out of reach in 2 of {len(motion.time)} samples; its leg takes the nearest reachable pose"
        in found.assumed
    )


def test_missing_masses():
    motion = sample_motion()
    with pytest.raises(MissingDataError, match=r"\[body\] mass_kg and \[leg\] mass_kg missing"):
        joint_loads(motion.robot.replace(body_mass=None, link_mass=None), motion)


@pytest.mark.parametrize("supply", [0.0, -6.0, math.nan, math.inf])
def test_invalid_supply_voltage(supply):
    with pytest.raises(InputError, match="supply is"):
        joint_loads(sample_motion().robot, sample_motion(), supply=supply)


def test_motion_with_another_number_of_legs():
    robot = sample_motion().robot
    four = robot_from_dict({**robot_to_dict(robot), "legs": [robot_to_dict(robot)["legs"][i] for i in (0, 2, 3, 5)]})
    with pytest.raises(InputError, match="the motion has 6 legs, robot 'strider' has 4"):
        joint_loads(four, sample_motion())


def test_eccentric_payload_tips_the_robot():
    motion = sample_motion()
    assert joint_loads(motion.robot, motion).balanced
    tipping = joint_loads(motion.robot, motion, payload=Payload(3.0, (0.4, 0.0, 0.0)))
    assert not tipping.balanced
    assert tipping.to_dict()["balanced"] is False


def test_to_dict():
    found = sample_loads(payload=0.2)
    document = found.to_dict()
    assert [(row["leg"], row["joint"]) for row in document["joints"]] == [
        (code, joint) for code in found.robot.leg_codes for joint in JOINTS
    ]
    row = document["joints"][4]
    assert row["peak_nm"] == found.peak[1, 1]
    assert row["peak_at_s"] == found.motion.time[found.peak_sample[1, 1]]
    assert row["peak_power_w"] == found.power[:, 1, 1].max()
    assert row["factor"] == found.factor[1, 1]
    assert document["payload_kg"] == 0.2
    nameless = joint_loads(found.robot.replace(servos=()), found.motion).to_dict()["joints"][0]
    assert (nameless["servo"], nameless["stall_nm"], nameless["factor"]) == (None, None, None)


# Robots whose servos are known to have survived or burnt


@pytest.mark.parametrize("name", BURNT)
@pytest.mark.parametrize("inertial", [True, False])
def test_burnt_robots_have_femur_factors_below_1_5(name, inertial):
    found = sample_loads(name, inertial=inertial)
    worst = min(joint_verdicts(found), key=lambda verdict: verdict.factor)
    assert worst.joint == "femur"
    assert worst.factor < BURNOUT_FACTOR
    assert worst.class_name in ("cannot stand", "stalls or burns")


@pytest.mark.parametrize("living", ["phantomx", "strider"])
@pytest.mark.parametrize("gait", ["tripod", "wave"])
def test_surviving_robots_have_larger_factors_than_burnt_ones(living, gait):
    for dead in BURNT:
        assert sample_loads(living, gait).factor.min() > 0.99 * sample_loads(dead, gait).factor.min()


def test_masses_of_the_burnt_robots():
    assert total_mass(robot_of("burnt-5kg")) == pytest.approx(5.0)
    assert total_mass(robot_of("burnt-mg996r")) == pytest.approx(1.8 + 0.25, abs=0.001)


@pytest.mark.parametrize(
    ("path", "length"),
    [
        (straight_path(0.1), 0.1),
        (curved_path(1.5, (0.0, 0.3)), 0.45),
        (curved_path(-1.5, (0.0, 0.0)), 0.0),
        (curved_path(4.5, (0.0, 0.3)), 1.35),
    ],
)
def test_the_distance_of_a_walk_does_not_include_the_body_shift(path, length):
    quadruped = ring(4)
    found = joint_loads(quadruped, plan_walk(quadruped, Gait.named("creep", legs=4), path, rate=25.0))
    assert found.distance == pytest.approx(length, rel=0.1, abs=1e-6)
