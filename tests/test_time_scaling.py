"""The walker's own time: slower wherever the joints could not keep up, along the same way."""

import numpy as np
import pytest

from tarsus.control.walk.time_scaling import TimeScaling
from tarsus.robot.joint_limits import JointLimits

LIMITS = JointLimits(np.full((1, 3), 5.0), np.full((1, 3), 100.0))
ANYWHERE = np.broadcast_to([-np.inf, np.inf], (1, 3, 2))


def driven(way, ticks, dt):
    """Go along a way; return the own times and the joints' speed and acceleration over the greatest."""
    own = TimeScaling(way(0.0), LIMITS, ANYWHERE)
    time, times, angles = 0.0, [0.0], [own.angles]
    for _ in range(ticks):
        time = own.advance(lambda step, time=time: time + step, way, dt)
        times.append(time)
        angles.append(own.angles)
        np.testing.assert_array_equal(own.angles, way(time))
    rate = np.diff(angles, axis=0, prepend=[angles[0]]) / dt
    change = np.diff(rate, axis=0) / dt
    return np.array(times), np.abs(rate).max() / 5.0, np.abs(change).max() / 100.0


@pytest.mark.parametrize("dt", [0.001, 0.01, 0.03])
def test_where_joints_keep_up_it_is_the_worlds(dt):
    times, speed, change = driven(lambda t: np.array([[1.0, 0.5, -0.7]]) * np.sin(2 * t) ** 2, 300, dt)
    assert times == pytest.approx(dt * np.arange(301))
    assert speed < 1
    assert change < 1


@pytest.mark.parametrize("dt", [0.002, 0.01, 0.02])
@pytest.mark.parametrize("fast", [5.5, 6.5, 8.0])
def test_where_they_do_not_it_is_slower_and_they_do(fast, dt):
    times, speed, change = driven(lambda t: np.array([[1.0, 0.5, -0.7]]) * np.sin(fast * t) ** 2, 1000, dt)
    assert (np.diff(times) >= 0).all()
    assert times[-1] < 1000 * dt
    assert times[-1] > 0.2 * 1000 * dt
    assert speed <= 1
    assert change <= 1.001


def test_where_no_high_acceleration_is_ahead_it_looks_again_once_that_is_half_over():
    def way(time):
        return np.array([[0.5, 0.2, -0.3]]) * np.sin(8 * time) ** 2

    own, dt, time, looks = TimeScaling(way(0.0), LIMITS, ANYWHERE), 0.01, 0.0, []
    for tick in range(200):
        steps = []
        time = own.advance(lambda step, time=time, steps=steps: steps.append(step) or time + step, way, dt)
        if len(steps) > 1:
            looks.append(tick)
        assert steps[-1] == dt
    # With 64 % of the joints' acceleration at most, always at the world's pace.
    assert len(looks) > 20
    assert min(np.diff(looks)) == 2


def test_a_path_beyond_the_joints_is_followed_as_far_as_possible():
    own = TimeScaling(np.zeros((1, 3)), LIMITS, ANYWHERE)
    tried = []

    def jumping(time):
        tried.append(time)
        return np.full((1, 3), (-1.0) ** len(tried))

    own.advance(lambda step: step, jumping, 0.01)
    # Six times in all, never for longer than before.
    assert len(tried) == 6
    assert (np.diff(tried) <= 0).all()


@pytest.mark.parametrize("others", [0.0, 1.0])
def test_a_joint_that_reverses_at_once_brakes_as_hard_as_it_may(others):
    """Alone, or while another joint must go on at its speed: whatever rate is tried, a joint is too sudden."""

    def way(time):
        ahead = 30 * min(time, 0.07) ** 2 + 4.2 * max(time - 0.07, 0.0)
        back = 30 * min(time, 0.07) ** 2 - 4.2 * max(time - 0.07, 0.0)
        return np.array([[back, others * ahead, 0.0]])

    own, time, angles = TimeScaling(way(0.0), LIMITS, ANYWHERE), 0.0, []
    for _ in range(30):
        time = own.advance(lambda step, time=time: time + step, way, 0.01)
        angles.append(own.angles)
    speeds = np.diff(angles, axis=0) / 0.01
    # Slower or not, no joint moves faster than along the way, and all of them go on afterwards.
    assert np.abs(speeds).max() < 4.3
    assert speeds[-1, 0, 0] < 0
    assert time > 0.1


def test_a_walk_whose_feet_keep_to_their_paths_slows_down_where_joints_are_a_little_behind():
    rates = {}
    for exact in (False, True):
        own, time = TimeScaling(np.zeros((1, 3)), LIMITS, ANYWHERE), 0.0
        for _ in range(5):
            time = own.follow(
                lambda step, time=time: time + step, lambda time: np.full((1, 3), 0.15), 0.01, exact=exact
            )
        rates[exact] = own.rate
    assert rates[False] == 1.0
    assert rates[True] < 0.9
