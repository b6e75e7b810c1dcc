"""Ground search: lowest heights of the search, and feet lowered until they touch the ground."""

import numpy as np
import pytest

from sample_gait_states import EARTH, FACING, moment_of, rest_of, setup_of
from tarsus.control.filters import CriticallyDamped
from tarsus.control.terrain.ground_search import (
    SEARCH_DEPTH,
    GroundSearch,
    lowest_planned_height,
    lowest_reachable_height,
)
from tarsus.control.workspace.stance_geometry import LEVEL_TERRAIN, TerrainEstimate
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.pose import Pose

DT = 0.02
LIFT = 0.03
UP = np.arange(6) == 2


def landing():
    """A state with foot 2 at the end of its swing."""
    return moment_of(setup_of("strider"), rest_of("strider"), down=~UP, swing_phase=np.where(UP, 1.0, 0.0))


def lowest(leg):
    return -0.6 * LIFT


def run(searches, now, ground, seconds=3.0):
    """Lower feet to ground of a given height; return the states."""
    moments = [now]
    for _ in range(round(seconds / DT)):
        now = moments[-1]
        moments.append(
            searches.step(now, DT, touches=lambda leg, now=now: bool(now.ground_height[leg] <= ground), lowest=lowest)
        )
    return moments


def test_a_foot_in_contact_does_not_search():
    searches = GroundSearch(np.full((6, 3), 100.0))
    now = landing()
    assert searches.step(now, DT, touches=lambda leg: True, lowest=lowest).ground_height == pytest.approx(0)
    assert not searches
    assert searches.stands(2, touches=True)
    assert not searches.stands(2, touches=False)


def test_a_searching_foot_stops_smoothly_on_the_ground():
    searches = GroundSearch(np.full((6, 3), 100.0))
    moments = run(searches, landing(), -0.01)
    height = np.array([now.ground_height[2] for now in moments])
    assert (np.diff(height) <= 1e-9).all()
    speed = np.diff(height) / DT
    assert np.abs(speed).max() <= 0.051
    assert np.abs(np.diff(speed, prepend=0)).max() / DT < 2
    assert -0.013 < height[-1] <= -0.01
    assert np.abs([now.ground_height[~UP] for now in moments]).max() == 0
    assert searches
    assert searches.stands(2, touches=True)
    assert searches.failed_legs == []
    searches.land(UP)
    assert not searches


def test_a_search_without_ground_fails_at_its_lowest_height():
    searches = GroundSearch(np.full((6, 3), 100.0))
    moments = run(searches, landing(), -1.0)
    assert moments[-1].ground_height[2] == pytest.approx(-0.6 * LIFT, abs=1e-3)
    assert searches.failed_legs == [2]
    assert not searches.stands(2, touches=False)
    searches.land(~UP)
    assert searches


def high(name="strider", **changes):
    setup, rest = setup_of(name), rest_of(name)
    now = moment_of(setup, rest, **changes)
    return setup, now._replace(elevation=CriticallyDamped.still(np.array([0.2])), ground_height=now.ground_height + 0.2)


def test_the_lowest_planned_height_is_a_depth_below_the_slope():
    setup, now = high()
    slope = 0.1 - 0.05j
    seen = (now.foot - EARTH) * np.exp(-1j * FACING)
    expected = 0.2 + 0.1 * seen.real - 0.05 * seen.imag - SEARCH_DEPTH * setup.swing_height
    np.testing.assert_allclose(lowest_planned_height(now, TerrainEstimate(slope, SEARCH_DEPTH)), expected)
    np.testing.assert_allclose(lowest_planned_height(now, LEVEL_TERRAIN), 0.2 - SEARCH_DEPTH * setup.swing_height)


def test_within_reach_the_whole_depth_is_searched():
    setup, now = high()
    assert lowest_reachable_height(setup.robot, now, 1, 0.3) == pytest.approx(0.2 - SEARCH_DEPTH * setup.swing_height)


@pytest.mark.parametrize("out", [1.3, 1.42])
def test_the_lowest_reachable_height_is_within_reach(out):
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


def test_reach_is_checked_at_the_end_of_the_stance_too():
    setup, now = high()
    far = np.where(np.arange(6) == 1, 1.2, 1.0) * rest_of("strider")
    foot = EARTH + np.exp(1j * FACING) * far
    now = now._replace(
        foot=foot, foothold=foot, posture=CriticallyDamped.still(now.posture.value + np.eye(7)[2] * 0.06)
    )
    away = -1j * np.sign(far[1].imag)
    leaving = now._replace(twist=CriticallyDamped.still(np.array([away.real, away.imag, 0.0]) * 0.12))
    assert lowest_reachable_height(setup.robot, leaving, 1, 0.5) > lowest_reachable_height(setup.robot, now, 1, 0.5)
