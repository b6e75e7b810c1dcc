"""Servo sizing: every servo of the catalogue is a candidate, insufficient, or excluded with a reason."""

import math

import numpy as np
import pytest

from sample_loads import robot_of, sample_loads, sample_motion
from tarsus.errors import InputError, MissingDataError, UnknownNameError
from tarsus.load.design_changes import largest_payload, with_servos
from tarsus.load.loads import joint_loads
from tarsus.load.sizing import size_servos
from tarsus.load.verdict import joint_verdicts
from tarsus.robot.catalogue import list_servos, load_servo
from tarsus.robot.robot import JOINTS
from tarsus.robot.servo import Servo


def is_carried_with(found, servos, *, rule, safety_factor):
    """Whether other servos carry the robot, computed independently."""
    loads = joint_loads(with_servos(found.robot, servos), found.motion, inertial=found.inertial, supply=found.supply)
    return all(verdict.is_sufficient(rule) for verdict in joint_verdicts(loads, safety_factor=safety_factor))


@pytest.mark.parametrize(
    ("name", "gait", "factor", "rule"),
    [
        ("strider", "wave", 2.0, "factor"),
        ("burnt-mg996r", "tripod", 3.0, "factor"),
        ("ch3r", "wave", 3.0, "continuous"),
    ],
)
def test_candidates_are_exactly_the_sufficient_servos(name, gait, factor, rule):
    found = sample_loads(name, gait)
    sizing = size_servos(found.robot, found, safety_factor=factor, rule=rule)
    candidate_names = {candidate.name for candidate in sizing.candidates}
    assert candidate_names
    for servo in list_servos():
        if servo in sizing.excluded:
            assert "unknown" in sizing.excluded[servo]
            assert servo not in candidate_names
            continue
        sufficient = is_carried_with(found, dict.fromkeys(JOINTS, load_servo(servo)), rule=rule, safety_factor=factor)
        assert sufficient == (servo in candidate_names)
    masses = [candidate.servo_mass for candidate in sizing.candidates]
    assert masses == sorted(masses)
    for candidate in sizing.candidates:
        servo = candidate.servos["coxa"]
        assert candidate.servo_mass == pytest.approx(18 * servo.mass)
        current = sum(s.mass for leg in found.robot.servos for s in leg)
        assert candidate.robot_mass - candidate.servo_mass == pytest.approx(found.weight / 9.80665 - current)


def test_mixed_choice_is_sufficient_and_minimal_in_each_joint():
    found = sample_loads("burnt-mg996r")
    sizing = size_servos(found.robot, found)
    mixed = sizing.mixed
    assert is_carried_with(found, mixed.servos, rule="factor", safety_factor=3.0)
    assert mixed.servo_mass <= sizing.candidates[0].servo_mass
    assert mixed.factor >= 3
    assert mixed.name == " / ".join(mixed.servos[joint].name for joint in JOINTS)
    for joint in JOINTS:
        for name in set(list_servos()) - set(sizing.excluded):
            if load_servo(name).mass < mixed.servos[joint].mass:
                lighter = {**mixed.servos, joint: load_servo(name)}
                assert not is_carried_with(found, lighter, rule="factor", safety_factor=3.0)


def test_no_sufficient_servo():
    found = sample_loads("burnt-5kg")
    sizing = size_servos(found.robot, found, safety_factor=30.0)
    assert sizing.candidates == ()
    assert sizing.mixed is None
    assert not sizing.ok


def test_servos_of_another_voltage_are_excluded():
    found = sample_loads("burnt-mg996r", supply=6.0)
    sizing = size_servos(found.robot, found, safety_factor=1.0)
    assert sizing.excluded["AX-12A"] == "it is rated for 9 to 12 V, the supply is 6 V"
    assert "DS3218" not in sizing.excluded


def test_verdict_on_the_current_servos():
    found = sample_loads("strider", "wave")
    sizing = size_servos(found.robot, found, safety_factor=2.0)
    assert sizing.ok
    assert sizing.worst.joint == "femur"
    assert sizing.worst.factor == pytest.approx(found.factor.min())
    assert sizing.payload == largest_payload(found, safety_factor=2.0)
    assert sizing.maximum_payload == largest_payload(found, safety_factor=1.5)
    assert not size_servos(found.robot, found, safety_factor=3.0).ok
    assert not size_servos(found.robot, found, safety_factor=2.0, rule="continuous").ok
    assert set(sizing.sensitivity) == set(JOINTS)


def test_loads_of_another_robot_are_recomputed():
    found = sample_loads("strider", "wave")
    strong = found.robot.replace(servos=((Servo(name="S", stall_torque=9.0, no_load_speed=8.0, mass=0.06),) * 3,) * 6)
    sizing = size_servos(strong, found)
    assert sizing.ok
    assert sizing.worst.factor == pytest.approx(9 / found.peak.max())


def test_candidates_use_gravity_and_payload_of_the_loads():
    earth = sample_loads("burnt-mg996r", inertial=False)
    moon = sample_loads("burnt-mg996r", inertial=False, gravity=(0.0, 0.0, -1.62))
    on_earth, on_moon = (size_servos(found.robot, found) for found in (earth, moon))
    assert on_moon.ok
    by_name = {candidate.name: candidate for candidate in on_moon.candidates}
    for candidate in on_earth.candidates:
        assert by_name[candidate.name].factor == pytest.approx(candidate.factor * 9.80665 / 1.62)
    loaded = sample_loads("burnt-mg996r", inertial=False, payload=0.5)
    heavier = {c.name: c.factor for c in size_servos(loaded.robot, loaded).candidates}
    assert all(heavier[name] < by_name[name].factor for name in heavier)


def test_robot_without_servos():
    motion = sample_motion("strider", "wave")
    bare = motion.robot.replace(servos=())
    sizing = size_servos(bare, joint_loads(bare, motion), safety_factor=2.0)
    assert sizing.candidates
    assert not sizing.ok
    assert (sizing.payload, sizing.maximum_payload) == (None, None)
    assert sizing.worst.servo is None
    assert math.isnan(sizing.worst.factor)
    assert sizing.assumed[-1].startswith(
        "the robot file names no servo for the coxa of LF: the masses of the robot file are used unchanged"
    )
    for candidate in sizing.candidates:
        assert candidate.robot_mass == pytest.approx(float(bare.body_mass + np.sum(bare.link_mass)))


def test_assumptions():
    found = sample_loads("strider")
    assert "the coxa servos may need more torque" in size_servos(found.robot, found).assumed[-2]
    assert size_servos(found.robot, found).assumed[-1].startswith("a servo sits on the inner side of its joint")


def test_errors():
    found = sample_loads()
    with pytest.raises(UnknownNameError, match="no rule is called 'guess'"):
        size_servos(found.robot, found, rule="guess")
    with pytest.raises(InputError, match="safety_factor"):
        size_servos(found.robot, found, safety_factor=0.0)
    with pytest.raises(MissingDataError, match="mass_kg"):
        size_servos(robot_of("strider").replace(link_mass=None), found)
