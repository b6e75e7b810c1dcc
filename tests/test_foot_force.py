"""Foot forces from joint torques against statics, and forces in equilibrium against `tarsus.load`."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sample_robots import hexapod, random_hexapod, standing
from tarsus.errors import InputError
from tarsus.kinematics.leg import forward_kinematics, leg_jacobian
from tarsus.kinematics.pose import Pose
from tarsus.load.contact import contact_forces
from tarsus.load.foot_force import FootForceEstimator, balanced_forces
from tarsus.load.torque import joint_torques
from tarsus.robot.robot import stack_robots


def forces_of(robot, angles, torques, up=(0.0, 0.0, 1.0)):
    return FootForceEstimator(robot).forces(angles.tolist(), torques.tolist(), up)


@given(st.integers(0, 2**32 - 1))
def test_forces_are_recovered_from_their_torques(seed):
    rng = np.random.default_rng(seed)
    robot = random_hexapod(rng)
    angles, forces = rng.uniform(-np.pi, np.pi, (6, 3)), rng.normal(size=(6, 3)) * 5
    body = Pose.from_rpy(*rng.uniform(-0.5, 0.5, 2), rng.uniform(-3, 3))
    torques, _ = joint_torques(robot, angles, body, np.ones(6, dtype=bool), forces=forces @ body.rotation.T)
    found = forces_of(robot, angles, torques, tuple(body.rotation[2].tolist()))
    jacobians = leg_jacobian(robot, angles)
    for leg in range(6):
        if found[leg] is not None:
            np.testing.assert_allclose(found[leg], forces[leg], rtol=0, atol=1e-10)
        else:  # there a torque's error makes a far greater one of the force than it would elsewhere
            lengths = [robot.coxa[leg] + robot.femur[leg] + robot.tibia[leg], robot.femur[leg], robot.tibia[leg]]
            assert np.linalg.svd(jacobians[leg] / lengths, compute_uv=False)[-1] < 0.11


def test_singular_legs_and_unknown_torques_are_none():
    robot, angles, torques = hexapod(), standing(), np.zeros((6, 3))
    angles[1, 2] = 0.0  # straight
    angles[2, 2] = math.pi  # folded
    found = forces_of(robot, angles, torques)
    assert [part is None for part in found] == [False, True, True, False, False, False]
    # The foot under the coxa axis: no torque of the coxa tells of a force across.
    reach = (0.068 + 0.098 * math.cos(2.0)) / 0.181
    angles[4, 1:] = [2.0, math.pi - math.acos(reach) - 2.0]
    assert abs(np.linalg.norm((forward_kinematics(robot, angles)[4, 3] - robot.mount_position[4])[:2])) < 1e-12
    assert forces_of(robot, angles, torques)[4] is None
    some = FootForceEstimator(robot).forces(angles.tolist(), [None, *torques.tolist()[1:]])
    assert some[0] is some[1] is None
    assert some[5] is not None


def test_without_masses_the_links_are_massless():
    robot = hexapod(link_mass=None, body_mass=None)
    forces = np.array([[0.3, -0.2, 5.0]] * 6)
    torques = -np.einsum("lij,li->lj", leg_jacobian(robot, standing()), forces)
    found = forces_of(robot, standing(), torques)
    np.testing.assert_allclose(found, forces, rtol=0, atol=1e-12)


def test_a_batch_of_designs_is_refused():
    with pytest.raises(InputError, match="batch of designs"):
        FootForceEstimator(stack_robots([hexapod(), hexapod()]))


@given(st.integers(0, 2**32 - 1), st.integers(3, 6))
def test_balanced_forces_equal_those_of_statics(seed, count):
    """Against the solver of `tarsus.load`, on level ground with massless links, where no foot has to pull."""
    rng = np.random.default_rng(seed)
    robot = hexapod(link_mass=np.zeros((6, 3)), body_com=rng.uniform(-0.05, 0.05, 3))
    angles = standing() + rng.uniform(-0.3, 0.3, (6, 3))
    contacts = rng.permutation(np.arange(6) < count)
    want = contact_forces(robot, angles, Pose(), contacts).forces[:, 2]
    feet = forward_kinematics(robot, angles)[:, 3]
    found = balanced_forces(feet.tolist(), contacts.tolist(), robot.body_com[:2].tolist(), 1.386 * 9.80665)
    matrix = np.stack([np.ones(count), *feet[contacts, :2].T])
    free = np.linalg.lstsq(matrix, 1.386 * 9.80665 * np.array([1, *robot.body_com[:2]]), rcond=None)[0]
    np.testing.assert_allclose(np.array(found)[contacts], np.maximum(free, 0), rtol=0, atol=1e-9)
    if free.min() > 1e-3:
        np.testing.assert_allclose(found, want, rtol=0, atol=1e-6)
    assert not np.array(found)[~contacts].any()


def test_feet_that_bear_load_in_part_bear_less():
    rng = np.random.default_rng(5)
    feet, parts = rng.uniform(-0.2, 0.2, (6, 2)), np.array([1.0, 0.3, 1.0, 0.0, 0.8, 1.0])
    feet -= np.average(feet, axis=0, weights=parts)
    found = np.array(balanced_forces(feet.tolist(), parts.tolist(), (0.02, -0.01), 30.0))
    # The least sum of squares over parts, by the pseudo-inverse.
    equilibrium, root = np.vstack([np.ones(6), feet.T]), np.sqrt(parts)
    expected = root * (np.linalg.pinv(equilibrium * root) @ [30.0, 0.6, -0.3])
    assert expected.min() >= 0.0
    np.testing.assert_allclose(found, expected, atol=1e-9)


def test_balanced_forces_without_equilibrium():
    line = [[0.1, 0.0, 0.0], [-0.1, 0.0, 0.0], [0.3, 0.0, 0.0]]
    assert balanced_forces(line, [False] * 3, (0.0, 0.0), 30.0) == (0.0, 0.0, 0.0)
    assert balanced_forces(line, [True] * 3, (0.0, 0.0), 30.0) == pytest.approx((10.0,) * 3)
    assert balanced_forces(line, [True, True, False], (0.05, 0.0), 30.0) == pytest.approx((15.0, 15.0, 0.0))
    triangle = [[1.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0]]
    assert min(balanced_forces(triangle, [True] * 3, (3.0, 0.0), 30.0)) == 0.0
