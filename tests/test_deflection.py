"""Commands that compensate for the deflection of loaded joints."""

import numpy as np
import pytest

import tarsus
from tarsus.errors import InputError, MissingDataError
from tarsus.load.deflection import SHARE, compensate_deflection, joint_deflections
from tarsus.simulation import compare


def walk(name="strider", *, gait="tripod", way=0.15, **options):
    return tarsus.plan_walk(tarsus.load_robot(name), tarsus.Gait.named(gait), tarsus.straight_path(way), **options)


def test_deflection_is_torque_over_stiffness():
    motion = walk()
    springs = tarsus.JointSprings.of(motion.robot)
    at_once = joint_deflections(motion, transfer_time=0)
    torques = tarsus.joint_loads(motion.robot, motion).torques
    assert at_once * springs.stiffness == pytest.approx(torques, abs=1e-12)
    # Softer joints yield more, and so do those under a payload.
    assert joint_deflections(motion, springs=tarsus.JointSprings.uniform(motion.robot, 10.0)) == pytest.approx(
        2 * joint_deflections(motion, springs=tarsus.JointSprings.uniform(motion.robot, 20.0))
    )
    assert np.abs(joint_deflections(motion, payload=0.5)).max() > np.abs(joint_deflections(motion)).max()


@pytest.mark.parametrize("rate", [50.0, 200.0])
def test_loads_are_taken_over_gradually(rate):
    motion = walk(rate=rate)
    gradual, at_once = joint_deflections(motion), joint_deflections(motion, transfer_time=0)
    # The same load in all, and no step: the whole deflection takes the time of the transfer.
    assert gradual.mean((0, 1)) == pytest.approx(at_once.mean((0, 1)), rel=0.03, abs=1e-3)
    steepest = np.abs(np.diff(gradual, axis=0)).max() * rate
    assert steepest < 1.5 * np.ptp(at_once, axis=0).max() / 0.08
    assert np.abs(np.diff(at_once, axis=0)).max() * rate > 2 * steepest


def test_commands_stay_within_the_limits():
    motion = walk()
    limits = np.asarray(motion.robot.limits)
    soft = compensate_deflection(motion, springs=tarsus.JointSprings.uniform(motion.robot, 0.5))
    assert (soft.angles >= limits[..., 0] - 1e-12).all()
    assert (soft.angles <= limits[..., 1] + 1e-12).all()
    assert np.isclose(soft.angles, limits[..., 1]).any() or np.isclose(soft.angles, limits[..., 0]).any()
    assert soft.feet is not motion.feet
    assert (soft.feet == motion.feet).all()


def test_feet_slide_less_and_the_way_is_longer_in_physics():
    motion = walk("ch3r", rate=100.0)
    before, after = compare(motion).outcome, compare(compensate_deflection(motion)).outcome
    assert after.slip < 0.3 * before.slip
    assert abs(after.way_ratio - 1) < 0.5 * abs(before.way_ratio - 1)
    assert after.tilt < before.tilt


def test_a_share_of_the_deflection_is_compensated_for():
    motion = walk()
    deflection = joint_deflections(motion)
    for given, share in (({}, SHARE), ({"share": 1.0}, 1.0), ({"share": 0.0}, 0.0)):
        commands = compensate_deflection(motion, **given)
        assert commands.angles - motion.angles == pytest.approx(share * deflection, abs=1e-12)
        assert f"{100 * share:.0f} % of the deflection" in commands.assumed[-1]
    with pytest.raises(InputError, match=r"share is 1.2; it must be a number from 0 to 1"):
        compensate_deflection(motion, share=1.2)


@pytest.mark.parametrize("time", [-0.01, np.nan, np.inf])
def test_a_wrong_time_of_transfer_is_refused(time):
    with pytest.raises(InputError, match=r"transfer_time is .* s; it must be a finite number, not negative"):
        joint_deflections(walk(), transfer_time=time)


def test_unknown_masses_are_named():
    without = tarsus.load_robot("phoenix").replace(body_mass=None, link_mass=None)
    motion = tarsus.plan_walk(without, tarsus.Gait.named("tripod"), tarsus.straight_path(0.15))
    with pytest.raises(MissingDataError, match="mass_kg"):
        compensate_deflection(motion)
