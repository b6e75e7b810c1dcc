"""Rotations about an axis against SciPy's, and the one that makes a direction vertical."""

import numpy as np
from scipy.spatial.transform import Rotation

from tarsus.kinematics.rotation import axis_and_angle, levelling_rotation, rotation_about


def test_rotations_about_an_axis_are_those_of_scipy():
    random = np.random.default_rng(3)
    for vector in random.normal(size=(50, 3)):
        axis, angles = vector / np.linalg.norm(vector), random.uniform(-4, 4, (2, 3))
        expected = Rotation.from_rotvec((angles[..., None] * axis).reshape(-1, 3)).as_matrix().reshape(2, 3, 3, 3)
        assert np.abs(rotation_about(axis, angles) - expected).max() < 1e-14


def test_axis_and_angle_are_those_of_scipy():
    for rotation in Rotation.random(200, rng=np.random.default_rng(5)):
        axis, angle = axis_and_angle(rotation.as_matrix())
        assert np.abs(angle * axis - rotation.as_rotvec()).max() < 1e-9


def test_without_a_rotation_there_is_no_axis():
    axis, angle = axis_and_angle(np.eye(3))
    assert (axis.tolist(), angle) == ([0.0, 0.0, 0.0], 0.0)


def test_the_levelling_rotation_turns_a_vector_into_z_about_a_horizontal_axis():
    for vector in np.random.default_rng(7).normal(size=(50, 3)):
        up = vector / np.linalg.norm(vector)
        rotation = Rotation.from_matrix(levelling_rotation(up))
        np.testing.assert_allclose(rotation.apply(up), (0.0, 0.0, 1.0), atol=1e-12)
        assert abs(rotation.as_rotvec()[2]) < 1e-9
