"""Pose controller: target posture, speed limits and sway."""

import math

import numpy as np
import pytest

from tarsus.control.filters import CriticallyDamped
from tarsus.control.pose.pose_controller import PoseController
from tarsus.gait.stance.stance_geometry import sway_fraction

LEVEL = np.array([0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.03])
SWAY = (0.0, 0.01, 0.0, 0.02, 0.0, 0.0)


def test_a_reached_posture_has_no_distance_left():
    carriage = PoseController(LEVEL)
    assert carriage.reached(carriage.target)
    assert carriage.reached(carriage.target + 1e-4)
    assert not carriage.reached(carriage.target + 3e-4)


@pytest.mark.parametrize(
    ("axis", "way", "fastest"), [(0, 0.05, 0.08), (2, -0.03, 0.08), (4, 0.4, 0.5), (5, -1.0, 0.5), (6, 0.06, 0.08)]
)
def test_the_body_keeps_to_its_speed_limits(axis, way, fastest):
    carriage = PoseController(LEVEL)
    there = LEVEL.copy()
    there[axis] += way
    carriage.set_posture(there)
    posture, speeds = CriticallyDamped.still(np.append(LEVEL, np.zeros(6))), []
    for _ in range(3000):
        after = posture.step(carriage.target, 0.002, bandwidth=carriage.bandwidth(posture.value))
        speeds.append(abs(after.value[axis] - posture.value[axis]) / 0.002)
        posture = after
    assert carriage.reached(posture.value)
    assert 0.3 * min(fastest, 4 * abs(way) / math.e) < max(speeds) <= fastest


def test_a_sway_is_limited_by_acceleration_and_ends():
    carriage = PoseController(LEVEL)
    carriage.set_sway(SWAY, frequency=2.0, beats=2)
    calm = sway_fraction(np.array(SWAY), 2.0, 2)
    assert 0 < calm < 1
    np.testing.assert_allclose(carriage.target, [*LEVEL, *(calm * np.array(SWAY))])
    same = carriage.target
    carriage.set_sway(SWAY, frequency=2.0, beats=2)
    assert carriage.target is same
    # On the way to another posture it sways on.
    carriage.set_posture(LEVEL + 0.01)
    np.testing.assert_allclose(carriage.target, [*(LEVEL + 0.01), *(calm * np.array(SWAY))])
    carriage.set_sway((0.0,) * 6, frequency=2.0, beats=2)
    np.testing.assert_array_equal(carriage.target, [*(LEVEL + 0.01), *np.zeros(6)])
