"""Servo sizing: every servo of the catalogue is a candidate, insufficient, or excluded with a reason."""

import math

import numpy as np
import pytest

from sample_loads import robot_of, sample_loads, sample_motion
from tarsus.errors import InputError, MissingDataError, UnknownNameError
from tarsus.load.design_changes import largest_payload, with_servos
from tarsus.load.loads import joint_loads
from tarsus.load.sizing import size_servos
from tarsus.load.verdict import joint_verdicts, sufficient_joints
from tarsus.robot.catalogue import list_servos, load_servo
from tarsus.robot.robot import JOINTS
from tarsus.robot.servo import Servo


def is_carried_with(found, servos, *, rule, safety_factor, supply=None):
    """Whether other servos carry the robot, computed independently."""
    supply = found.supply if supply is None else supply
    loads = joint_loads(with_servos(found.robot, servos), found.motion, inertial=found.inertial, supply=supply)
    return all(verdict.is_sufficient(rule) for verdict in joint_verdicts(loads, safety_factor=safety_factor))


@pytest.mark.no_cover
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


@pytest.mark.parametrize(("name", "supply"), [("strider", None), ("burnt-mg996r", None), ("burnt-mg996r", 12.0)])
def test_sets_are_of_one_bus_and_one_supply_and_minimal_in_each_joint(name, supply):
    found = sample_loads(name, supply=supply)
    sizing = size_servos(found.robot, found, safety_factor=2.0)
    assert sizing.sets
    assert len({each.name for each in (*sizing.candidates, *sizing.sets)}) == len(sizing.candidates) + len(sizing.sets)
    masses = [each.servo_mass for each in sizing.sets]
    assert masses == sorted(masses)
    assert sizing.mixed is sizing.sets[0]
    for found_set in sizing.sets:
        servos = found_set.servos
        assert found_set.bus in frozenset.intersection(*(servo.buses for servo in servos.values()))
        assert all(servo.supply[0] <= found_set.supply <= servo.supply[1] for servo in servos.values())
        assert supply is None or found_set.supply == supply
        rules = {"rule": "factor", "safety_factor": 2.0, "supply": found_set.supply}
        assert is_carried_with(found, servos, **rules)
        assert found_set.factor >= 2
        if len(set(servos.values())) > 1:
            assert found_set.name == " / ".join(servos[joint].name for joint in JOINTS)
        for joint in JOINTS:
            for lighter in (load_servo(name) for name in set(list_servos()) - set(sizing.excluded)):
                on_bus = found_set.bus in lighter.buses and lighter.mass < servos[joint].mass
                if on_bus and lighter.supply[0] <= found_set.supply <= lighter.supply[1]:
                    assert not is_carried_with(found, {**servos, joint: lighter}, **rules)


def test_the_lightest_set_of_the_strider_can_be_bought():
    """One controller and one supply drive it; the lightest servo of each joint would be of three buses."""
    found = sample_loads("strider")
    lightest = size_servos(found.robot, found).sets[0]
    assert lightest.name == "XL430-W250-T / MX-64T/AT / XM430-W350-T"
    assert (lightest.bus, lightest.supply) == ("Dynamixel 2.0", 12.0)


@pytest.mark.parametrize("rule", ["factor", "continuous"])
@pytest.mark.parametrize("conditions", [{}, {"inertial": False}, {"supply": 5.0}])
def test_sufficient_joints_are_those_of_the_verdicts(rule, conditions):
    for name in ("strider", "burnt-5kg"):
        found = sample_loads(name, **conditions)
        expected = [verdict.is_sufficient(rule) for verdict in joint_verdicts(found, safety_factor=1.7)]
        assert sufficient_joints(found, safety_factor=1.7, rule=rule).ravel().tolist() == expected


def test_no_sufficient_servo():
    found = sample_loads("burnt-5kg")
    sizing = size_servos(found.robot, found, safety_factor=30.0)
    assert sizing.candidates == ()
    assert (sizing.sets, sizing.mixed) == ((), None)
    assert not sizing.ok


def test_servos_of_another_voltage_are_excluded():
    found = sample_loads("burnt-mg996r", supply=6.0)
    sizing = size_servos(found.robot, found, safety_factor=1.0)
    assert sizing.excluded["AX-12A"] == "the rated supply is 9 to 12 V, the supply is 6 V"
    assert "DS3218" not in sizing.excluded


def test_a_supply_that_no_servo_takes_excludes_all():
    found = sample_loads("burnt-mg996r", supply=20.0)
    sizing = size_servos(found.robot, found)
    assert set(sizing.excluded) == set(list_servos())
    assert (sizing.candidates, sizing.sets, sizing.mixed) == ((), (), None)


@pytest.mark.no_cover
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
    assert (
        size_servos(found.robot, found)
        .assumed[-1]
        .startswith("a servo is part of the link on the inner side of its joint")
    )


def test_errors():
    found = sample_loads()
    with pytest.raises(UnknownNameError, match="no rule is called 'guess'"):
        size_servos(found.robot, found, rule="guess")
    with pytest.raises(InputError, match="safety_factor"):
        size_servos(found.robot, found, safety_factor=0.0)
    with pytest.raises(MissingDataError, match="mass_kg"):
        size_servos(robot_of("strider").replace(link_mass=None), found)
