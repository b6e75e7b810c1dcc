"""Playback of motion sequences, with stops and in reverse, and their conversion to motions."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gait_robots import preset
from tarsus.control.sequence import SequencePlayer
from tarsus.control.startup import fold, stand_up
from tarsus.errors import InputError
from tarsus.kinematics.folded_pose import folded_pose
from tarsus.load.loads import joint_loads

STRIDER = preset("strider")
UP = stand_up(STRIDER, folded_pose(STRIDER), body_height=0.2)


def play(player, dt):
    angles = [player.angles]
    while not player.done:
        angles.append(player.step(dt))
    return np.array(angles)


@pytest.mark.no_cover
@pytest.mark.parametrize("dt", [0.001, 0.0173, 0.05])
def test_playback_equals_the_sequence(dt):
    player = SequencePlayer(UP)
    angles = play(player, dt)
    expected = [UP.at(i * dt).angles for i in range(len(angles))]
    np.testing.assert_allclose(angles, expected, atol=1e-9)
    np.testing.assert_array_equal(angles[-1], UP.angles_end)
    assert player.done
    assert player.stopped
    assert player.stage == "raise body"
    assert player.now.contacts.all()
    assert player.now.body.position[2] == pytest.approx(0.2)
    assert not player.step(dt).flags.writeable


ORDERS = st.lists(st.tuples(st.sampled_from(["stop", "resume", "reverse"]), st.integers(1, 40)), min_size=1, max_size=5)


@pytest.mark.no_cover
@settings(max_examples=8)
@given(ORDERS, st.sampled_from([0.002, 0.004, 0.01]))
def test_with_stops_and_reversals_it_keeps_its_path_and_joint_limits(orders, dt):
    player = SequencePlayer(UP)
    angles, times = [player.angles] * 3, [0.0] * 3
    for order, ticks in orders:
        for _ in range(ticks):
            angles.append(player.step(dt))
            times.append(player.time)
        getattr(player, order)()
    while not player.stopped:
        angles.append(player.step(dt))
        times.append(player.time)
    angles += [player.step(dt)] * 3
    angles = np.array(angles)
    assert (np.abs(np.diff(angles, axis=0)) / dt <= UP.joint_limits.speed * 1.0001).all()
    assert (np.abs(np.diff(angles, 2, axis=0)) / dt**2 <= UP.joint_limits.acceleration * 1.01 + 1e-9 / dt**2).all()
    for time, at in zip(times, angles, strict=False):
        np.testing.assert_array_equal(UP.at(time).angles, at)
    last = orders[-1][0]
    if last == "resume":
        assert player.time == UP.duration
    elif last == "reverse":
        assert player.time == 0
    else:
        assert player.done or player.rate == 0


def test_it_stops_within_the_stage():
    player = SequencePlayer(UP)
    for _ in range(20):
        player.step(0.01)
    player.stop()
    name, before = player.stage, player.time
    ticks = 0
    while not player.stopped:
        player.step(0.001)
        ticks += 1
    assert player.stage == name
    assert 0 < player.time - before < 0.15
    assert ticks * 0.001 >= 0.05 - 1e-9
    assert not player.done
    held = player.angles
    np.testing.assert_array_equal(player.step(1.0), held)
    player.resume()
    assert not player.stopped
    np.testing.assert_array_equal(play(player, 0.01)[-1], UP.angles_end)


def test_it_plays_in_reverse_from_the_end():
    player = SequencePlayer(UP)
    player.step(100.0)
    assert player.done
    player.reverse()
    assert not player.done
    assert player.rate == 1
    back = play(player, 0.01)
    np.testing.assert_array_equal(back[-1], folded_pose(STRIDER))
    assert player.time == 0


def test_a_sequence_without_duration_is_done_immediately():
    player = SequencePlayer(fold(STRIDER, folded_pose(STRIDER)))
    assert player.done
    np.testing.assert_array_equal(player.step(0.01), folded_pose(STRIDER))
    player.reverse()
    player.step(0.01)
    assert player.done


@pytest.mark.parametrize("dt", [-0.01, np.nan, np.inf])
def test_an_invalid_time_step_is_rejected(dt):
    with pytest.raises(InputError, match="dt is"):
        SequencePlayer(UP).step(dt)


def test_an_invalid_time_is_rejected():
    with pytest.raises(InputError, match="time is nan"):
        UP.at(np.nan)
    np.testing.assert_array_equal(UP.at(-1.0).angles, UP.at(0.0).angles)


def test_it_converts_to_a_motion_with_joint_loads():
    motion = UP.to_motion(rate=50)
    assert motion.duration >= UP.duration > motion.time[-2]
    np.testing.assert_array_equal(motion.angles[-1], UP.angles_end)
    np.testing.assert_array_equal(motion.angles[0], folded_pose(STRIDER))
    standing = UP.to_motion(rate=50, standing=True)
    assert standing.contacts.sum(-1).min() >= 3
    assert standing.ok
    assert standing.time[-1] < motion.time[-1]
    assert 0 < np.abs(joint_loads(STRIDER, standing).torques).max() < 5
    with pytest.raises(InputError, match="lies on the ground in every stage"):
        fold(STRIDER, UP.stages[1].angles).to_motion(standing=True)
    with pytest.raises(InputError, match="rate is 0"):
        UP.to_motion(rate=0)
