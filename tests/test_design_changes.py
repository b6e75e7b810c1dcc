"""Loads with other servos, payloads and link lengths."""

import math
from dataclasses import replace

import numpy as np
import pytest

from sample_loads import robot_of, sample_loads, sample_motion
from tarsus.errors import InputError, MissingDataError, UnknownNameError
from tarsus.kinematics.mass import total_mass
from tarsus.load.design_changes import largest_payload, length_sensitivity, why_masses_stay, with_lengths, with_servos
from tarsus.load.loads import joint_loads
from tarsus.load.payload import Payload
from tarsus.robot.catalogue import load_servo
from tarsus.robot.robot import JOINTS
from tarsus.robot.servo import Servo

HEAVY = Servo(name="heavy", stall_torque=5.0, no_load_speed=6.0, mass=0.1)


def light(mass):
    return Servo(name=f"of {mass} kg", stall_torque=5.0, no_load_speed=6.0, mass=mass)


# Servos


def test_servo_masses_change_on_the_inner_side_of_the_joint():
    robot = robot_of("burnt-mg996r")  # links of 75, 75 and 42 g, servos of 55 g
    changed = with_servos(robot, dict.fromkeys(JOINTS, HEAVY))
    assert changed.body_mass == pytest.approx(robot.body_mass + 6 * 0.045)
    np.testing.assert_allclose(changed.link_mass - robot.link_mass, np.tile([0.045, 0.045, 0.0], (6, 1)))
    assert changed.servos == ((HEAVY,) * 3,) * 6
    only = with_servos(robot, {"femur": HEAVY})
    np.testing.assert_allclose(only.link_mass - robot.link_mass, np.tile([0.045, 0.0, 0.0], (6, 1)))
    assert only.servos[0] == (robot.servos[0][0], HEAVY, robot.servos[0][2])


def test_servo_sits_on_the_outer_side_if_the_inner_part_is_too_light():
    robot = robot_of("strider")  # links of 40, 160 and 80 g, servos of 60 g: the femur holds two
    changed = with_servos(robot, dict.fromkeys(JOINTS, light(0.01)))
    assert changed.body_mass == pytest.approx(robot.body_mass - 6 * 0.05)
    np.testing.assert_allclose(changed.link_mass - robot.link_mass, np.tile([0.0, -0.1, 0.0], (6, 1)))


def test_same_servos_change_nothing():
    robot = robot_of("phantomx")
    same = with_servos(robot, dict.fromkeys(JOINTS, robot.servos[0][0]))
    np.testing.assert_allclose(same.link_mass, robot.link_mass, rtol=1e-15)
    assert total_mass(same) == pytest.approx(total_mass(robot))


@pytest.mark.parametrize(
    ("servos", "why"),
    [
        ((), "the robot file names no servo for the coxa of LF"),
        (((Servo(name="X", stall_torque=1.0),) * 3,) * 6, "the mass of the current servo X is unknown (mass_g)"),
        (((light(5.0),) * 3,) * 6, "leg LF is lighter than its current servos"),
    ],
)
def test_masses_stay_if_servo_masses_cannot_be_separated(servos, why):
    robot = robot_of("strider").replace(servos=servos)
    assert why_masses_stay(robot) == why
    changed = with_servos(robot, dict.fromkeys(JOINTS, HEAVY))
    assert changed.servos == ((HEAVY,) * 3,) * 6
    np.testing.assert_array_equal(changed.link_mass, robot.link_mass)
    assert changed.body_mass == robot.body_mass


def test_servo_masses_are_separable_in_the_examples():
    assert why_masses_stay(robot_of("strider")) is None
    assert why_masses_stay(robot_of("burnt-5kg")) is None


def test_with_servos_errors():
    robot = robot_of("strider")
    with pytest.raises(MissingDataError, match="the mass of servo LSS-ST1 is unknown; set its mass_g"):
        with_servos(robot, {"coxa": load_servo("LSS-ST1")})
    with pytest.raises(InputError, match="unknown joint 'hip'; the joints are coxa, femur, tibia"):
        with_servos(robot, {"hip": HEAVY})
    with pytest.raises(MissingDataError, match="mass_kg"):
        with_servos(robot.replace(body_mass=None), {"coxa": HEAVY})


# Payload


@pytest.mark.parametrize("rule", ["factor", "continuous"])
def test_largest_payload_is_at_the_limit(rule):
    found = sample_loads("strider", "wave", inertial=False)
    strong = replace(found, robot=found.robot.replace(servos=((replace(HEAVY, stall_torque=9.0),) * 3,) * 6))
    most = largest_payload(strong, safety_factor=3.0, rule=rule)
    assert most > 0.1

    def used(mass):
        heavier = joint_loads(strong.robot, strong.motion, payload=mass, inertial=False)
        return (3 / heavier.factor if rule == "factor" else 5 * heavier.rms / heavier.stall_torque).max()

    assert used(most) <= 1 < used(most + 2e-4)


def test_payload_at_the_centre_of_mass_adds_in_proportion():
    """With massless legs and the body's centre of mass at the origin, torques are proportional to the total mass."""
    motion = sample_motion()
    robot = motion.robot.replace(link_mass=np.zeros((6, 3)), body_com=np.zeros(3), body_mass=2.0)
    found = joint_loads(robot, motion, inertial=False)
    factor = found.factor.min()
    assert largest_payload(found, safety_factor=factor / 1.75) == pytest.approx(1.5, abs=2e-4)


def test_payload_is_zero_if_the_servos_do_not_carry_the_robot():
    assert largest_payload(sample_loads("burnt-5kg"), safety_factor=3.0) == 0.0


def test_payload_is_limited_by_tipping():
    found = sample_loads(payload=Payload(0.0, (0.4, 0.0, 0.0)))
    most = largest_payload(found, safety_factor=0.01)
    assert 0 < most < 100
    assert joint_loads(found.robot, found.motion, payload=Payload(most, (0.4, 0.0, 0.0))).balanced
    assert not joint_loads(found.robot, found.motion, payload=Payload(most + 1e-3, (0.4, 0.0, 0.0))).balanced


def test_payload_is_limited_to_a_tonne():
    found = sample_loads()
    strong = replace(found, robot=found.robot.replace(servos=((replace(HEAVY, stall_torque=1e9),) * 3,) * 6))
    assert largest_payload(strong, safety_factor=3.0) == pytest.approx(1000.0, abs=1e-3)


def test_largest_payload_errors():
    found = sample_loads()
    with pytest.raises(MissingDataError, match="the torque of its servos, unknown for some"):
        largest_payload(replace(found, robot=found.robot.replace(servos=())))
    with pytest.raises(UnknownNameError, match="no rule is called 'half'"):
        largest_payload(found, rule="half")
    with pytest.raises(InputError, match="safety_factor"):
        largest_payload(found, safety_factor=math.nan)


# Lengths


def test_link_lengths_scale_with_their_centres_of_mass():
    robot = robot_of("strider")
    longer = with_lengths(robot, femur=1.1, tibia=0.9)
    np.testing.assert_allclose(longer.femur, 1.1 * robot.femur)
    np.testing.assert_allclose(longer.tibia, 0.9 * robot.tibia)
    np.testing.assert_allclose(longer.link_com, robot.link_com * [1, 1.1, 0.9])
    np.testing.assert_array_equal(longer.coxa, robot.coxa)
    np.testing.assert_array_equal(longer.link_mass, robot.link_mass)
    with pytest.raises(InputError, match="unknown link 'foot'"):
        with_lengths(robot, foot=2.0)


def test_longer_coxa_reduces_the_femur_torque_by_the_foot_load():
    """With massless legs and fixed feet, the femur's lever arm shrinks by as much as the coxa grows."""
    motion = sample_motion()
    robot = motion.robot.replace(link_mass=np.zeros((6, 3)))
    found = joint_loads(robot, motion, inertial=False)
    change = length_sensitivity(found)["coxa"]
    leg = found.worst(1)
    load = found.forces[found.peak_sample[leg, 1], leg, 2]
    assert change[1] == pytest.approx(-load, rel=1e-6)


def test_sensitivity_converges():
    found = sample_loads("phantomx", inertial=False)
    fine, coarse = length_sensitivity(found, step=0.002), length_sensitivity(found, step=0.02)
    for link in JOINTS:
        np.testing.assert_allclose(fine[link], coarse[link], atol=0.15, rtol=0.05)


def test_sensitivity_is_nan_for_unreachable_feet_or_zero_length():
    motion = sample_motion()
    found = joint_loads(motion.robot.replace(coxa=np.zeros(6), link_com=motion.robot.link_com * [0, 1, 1]), motion)
    assert np.isnan(length_sensitivity(found)["coxa"]).all()
    assert np.isnan(length_sensitivity(sample_loads(), step=0.6)["femur"]).all()
