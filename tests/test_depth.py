"""How low feet may look for ground."""

import numpy as np
import pytest

from sample_gait_states import EARTH, FACING, moment_of, rest_of, setup_of
from tarsus.control.filters import CriticallyDamped
from tarsus.control.terrain.ground_search import SEARCH_DEPTH, lowest_planned_height, lowest_reachable_height
from tarsus.control.workspace.stance_geometry import LEVEL_TERRAIN, TerrainEstimate
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.pose import Pose


def high(name="strider", **changes):
    setup, rest = setup_of(name), rest_of(name)
    now = moment_of(setup, rest, **changes)
    return setup, now._replace(elevation=CriticallyDamped.still(np.array([0.2])), ground_height=now.ground_height + 0.2)


def test_planned_is_a_depth_below_the_slope_under_each_foot():
    setup, now = high()
    slope = 0.1 - 0.05j
    seen = (now.foot - EARTH) * np.exp(-1j * FACING)
    expected = 0.2 + 0.1 * seen.real - 0.05 * seen.imag - SEARCH_DEPTH * setup.swing_height
    np.testing.assert_allclose(lowest_planned_height(now, TerrainEstimate(slope, SEARCH_DEPTH)), expected)
    np.testing.assert_allclose(lowest_planned_height(now, LEVEL_TERRAIN), 0.2 - SEARCH_DEPTH * setup.swing_height)


def test_with_room_below_it_is_all_the_depth():
    setup, now = high()
    assert lowest_reachable_height(setup.robot, now, 1, 0.3) == pytest.approx(0.2 - SEARCH_DEPTH * setup.swing_height)


@pytest.mark.parametrize("out", [1.3, 1.42])
def test_it_is_no_lower_than_the_leg_reaches(out):
    setup, now = high()
    far = np.where(np.arange(6) == 1, out, 1.0) * rest_of("strider")
    foot = EARTH + np.exp(1j * FACING) * far
    now = now._replace(
        foot=foot, foothold=foot, posture=CriticallyDamped.still(now.posture.value + np.eye(7)[2] * 0.05)
    )
    lowest = lowest_reachable_height(setup.robot, now, 1, 0.3)
    assert 0.2 - SEARCH_DEPTH * float(now.posture.value[6]) < lowest <= 0.2

    def reached(height):
        body = Pose.from_rpy(0, 0, FACING, (EARTH.real, EARTH.imag, 0.2 + float(now.posture.value[2])))
        feet = np.stack([foot.real, foot.imag, np.full(6, height)], axis=-1)
        return inverse_kinematics(setup.robot, body.inverse() @ feet).reach[1] == 0

    assert lowest == pytest.approx(0.2) or reached(lowest)
    assert not reached(lowest - 0.02)


def test_where_the_foot_goes_in_its_stance_counts():
    setup, now = high()
    far = np.where(np.arange(6) == 1, 1.2, 1.0) * rest_of("strider")
    foot = EARTH + np.exp(1j * FACING) * far
    now = now._replace(
        foot=foot, foothold=foot, posture=CriticallyDamped.still(now.posture.value + np.eye(7)[2] * 0.06)
    )
    away = -1j * np.sign(far[1].imag)
    leaving = now._replace(twist=CriticallyDamped.still(np.array([away.real, away.imag, 0.0]) * 0.12))
    assert lowest_reachable_height(setup.robot, leaving, 1, 0.5) > lowest_reachable_height(setup.robot, now, 1, 0.5)
