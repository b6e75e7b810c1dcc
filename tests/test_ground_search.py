"""Feet that look for ground where there is none at the end of their swing."""

import numpy as np
import pytest

from sample_gait_states import moment_of, rest_of, setup_of
from tarsus.control.terrain.ground_search import GroundSearch

DT = 0.02
LIFT = 0.03
UP = np.arange(6) == 2


def landing():
    """Foot 2 is at the end of its swing."""
    return moment_of(setup_of("strider"), rest_of("strider"), down=~UP, swing_phase=np.where(UP, 1.0, 0.0))


def lowest(leg):
    return -0.6 * LIFT


def run(searches, now, ground, seconds=3.0):
    """Let feet go down to a ground that is so high; return the moments."""
    moments = [now]
    for _ in range(round(seconds / DT)):
        now = moments[-1]
        moments.append(
            searches.step(now, DT, touches=lambda leg, now=now: bool(now.ground_height[leg] <= ground), lowest=lowest)
        )
    return moments


def test_a_foot_that_touches_ground_just_then_needs_no_search():
    searches = GroundSearch(np.full((6, 3), 100.0))
    now = landing()
    assert searches.step(now, DT, touches=lambda leg: True, lowest=lowest).ground_height == pytest.approx(0)
    assert not searches
    assert searches.stands(2, touches=True)
    assert not searches.stands(2, touches=False)


def test_it_goes_down_gently_to_the_ground_and_stands_there():
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


def test_where_there_is_none_it_stops_at_its_lowest_and_says_so():
    searches = GroundSearch(np.full((6, 3), 100.0))
    moments = run(searches, landing(), -1.0)
    assert moments[-1].ground_height[2] == pytest.approx(-0.6 * LIFT, abs=1e-3)
    assert searches.failed_legs == [2]
    assert not searches.stands(2, touches=False)
    searches.land(~UP)
    assert searches
