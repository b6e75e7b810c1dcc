"""Time steps, start, holding, recovery and log of the guard."""

import math
import re

import numpy as np
import pytest

from gait_robots import PRESETS, preset, ring
from sample_guard import ALL_STANCE, NAN, ROUNDING, TICK, check_bounds, kinds_of, run, standing, walk
from tarsus.control.safety import Guard, GuardBounds
from tarsus.robot.joint_limits import UNKNOWN_SPEED


@pytest.mark.parametrize("dt", [math.nan, -0.01, 0.0, math.inf, 1e9, "0.01", None, [], 10**400])
def test_an_invalid_time_step_stops_the_clock(dt):
    guard = Guard(preset("strider"), start=standing())
    before = guard.check(standing() + 1e-3, TICK)
    output = guard.check(standing() + 2e-3, dt)
    assert kinds_of(output) == ["time_step"]
    assert output.time == before.time
    np.testing.assert_array_equal(output.angles, before.angles)
    assert output.state == "holding"
    assert guard.check(standing() + 2e-3, dt).state == "holding"


def test_short_time_steps_accumulate():
    guard = Guard(preset("strider"), start=standing())
    moving = [guard.check(standing() + 3e-3 * tick**2, TICK) for tick in range(1, 5)][-1]
    assert moving.ok
    outputs = [guard.check(NAN, 3e-5) for _ in range(4)]
    assert [output.time - moving.time > 0 for output in outputs] == [False, False, False, True]
    assert outputs[3].time - moving.time == pytest.approx(1.2e-4)
    assert (outputs[2].angles == moving.angles).all()
    assert (outputs[3].angles > moving.angles).all()
    assert {kind for output in outputs for kind in kinds_of(output)} == {"not_finite", "time_step"}


def test_accumulated_time_adds_to_the_next_step():
    guard = Guard(preset("strider"), start=standing())
    for _ in range(2):
        guard.check(standing(), 3e-5)
    assert guard.check(standing(), TICK).time == pytest.approx(TICK + 6e-5)


def test_a_time_gap_holds_the_robot():
    guard = Guard(preset("strider"), start=standing())
    for fraction in range(1, 5):
        moving = guard.check(standing() + 1e-3 * fraction**2, TICK)
    assert moving.ok
    output = guard.check(standing() + 0.016, 0.5)
    assert (kinds_of(output), output.state) == (["time_gap"], "holding")
    (found,) = output.interventions
    assert (found.value, found.bound) == (0.5, 0.1)
    np.testing.assert_array_equal(output.angles, moving.angles)
    # The length of the gap does not allow a sudden start.
    after = guard.check(standing() + 0.05, TICK)
    assert after.state == "recovering"
    assert 0 < np.abs(after.angles - output.angles).max() <= guard.bounds.acceleration.max() * TICK**2 / 2 + ROUNDING


def test_joints_brake_through_a_short_time_gap():
    robot = preset("strider")
    bounds = GuardBounds.of(robot, acceleration=2.0)
    guard = Guard(robot, bounds=bounds, start=standing())
    outputs = [guard.check(standing() + 1e-4 * tick**2 * 0.9, TICK) for tick in range(1, 40)]
    assert outputs[-1].ok
    outputs.append(guard.check(NAN, 0.11))
    assert (outputs[-1].angles > outputs[-2].angles).all()
    outputs += run(guard, NAN, 40)
    check_bounds(bounds, outputs)


def with_glitch(guard, motion, start, ticks, corrupted=NAN):
    """A walk with some corrupted ticks."""
    return [
        guard.check(
            corrupted if start <= i < start + ticks else motion.angles[i], TICK, motion.contacts[i], motion.body[i]
        )
        for i in range(len(motion.time))
    ]


@pytest.mark.parametrize("ticks", [1, 2, 3])
def test_the_guard_recovers_from_a_glitch(ticks):
    motion = walk("strider")
    guard = Guard(preset("strider"))
    outputs = with_glitch(guard, motion, 100, ticks, standing() + 0.3)
    check_bounds(guard.bounds, outputs)
    states = [output.state for output in outputs]
    assert states[:100] == ["passing"] * 100
    assert states[100 : 100 + ticks] == ["holding"] * ticks
    back = states.index("passing", 100)
    assert 100 + ticks < back < 100 + ticks + 15
    assert set(states[100 + ticks : back]) == {"recovering"}
    assert states[back:] == ["passing"] * (len(states) - back)
    assert outputs[back].angles.tobytes() == motion.angles[back].tobytes()
    assert sum(guard.counts.values()) == len(guard.log) == len({output.kind for output in guard.log})
    assert "state: passing" in guard.summary()


def test_with_recover_reset_it_waits_for_a_reset():
    motion = walk("strider")
    guard = Guard(preset("strider"), recover="reset")
    outputs = with_glitch(guard, motion, 100, 1)
    assert {output.state for output in outputs[100:]} == {"holding"}
    guard.check(NAN, TICK)
    guard.reset()
    after = run(guard, motion.angles[-1], 200)
    assert after[0].state == "recovering"
    assert after[-1].ok
    check_bounds(guard.bounds, outputs + after)
    # A reset applies only to the current hold.
    guard.reset()
    assert {output.state for output in [guard.check(NAN, TICK), *run(guard, motion.angles[-1], 50)]} == {"holding"}


def test_a_reset_recovers_over_any_distance_at_the_recovery_speed():
    robot = preset("strider")
    guard = Guard(robot, start=standing())
    far = standing() + 0.4
    assert {output.state for output in run(guard, far, 50)} == {"holding"}
    assert guard.counts["command_distance"] == 1
    guard.reset()
    outputs = run(guard, far, 100)
    assert {output.state for output in outputs} == {"recovering", "passing"}
    check_bounds(guard.bounds, outputs)
    speed = np.abs(np.diff([output.angles for output in outputs], axis=0)) / TICK
    slow = guard.bounds.recovery_speed * guard.bounds.speed
    assert (speed <= slow * (1 + 1e-9)).all()
    assert speed.max() > slow.max() * 0.99


def test_a_violation_while_recovering_cancels_the_reset():
    guard = Guard(preset("strider"), start=standing())
    run(guard, standing() + 0.4, 5)
    guard.reset()
    assert guard.check(standing() + 0.4, TICK).state == "recovering"
    assert guard.check(NAN, TICK).state == "holding"
    assert guard.check(standing() + 0.4, TICK).state == "holding"


def test_recovery_ends_when_the_command_moves_too_far_away():
    guard = Guard(preset("strider"), start=standing())
    guard.check(NAN, TICK)
    near, on_the_way, far = (guard.check(standing() + distance, TICK) for distance in (0.09, 0.18, 0.25))
    assert [near.state, on_the_way.state, far.state] == ["recovering", "recovering", "holding"]
    (found,) = far.interventions
    assert (found.kind, found.bound) == ("command_distance", 2 * guard.bounds.recovery_distance)
    assert found.value == pytest.approx(0.25 - (on_the_way.angles - standing()).min())


def test_a_zero_time_step_while_recovering_holds():
    guard = Guard(preset("strider"), start=standing())
    guard.check(NAN, TICK)
    assert guard.check(standing() + 0.05, TICK).state == "recovering"
    assert guard.check(standing() + 0.05, 0.0).state == "holding"


@pytest.mark.parametrize("seed", range(10))
def test_it_recovers_to_a_fast_command_that_stops_at_a_limit(seed):
    """Speed, braking distance and limit are all reached."""
    rng = np.random.default_rng(seed)
    robot = ring(6, limits=np.stack([np.full((6, 3), -1.0), rng.uniform(0.5, 1.0, (6, 3))], axis=-1))
    high = robot.limits[..., 1]
    guard = Guard(robot, bounds=GuardBounds.of(robot, recovery_distance=3.0), start=np.zeros((6, 3)))
    outputs = [guard.check(NAN, TICK)]
    reached = rng.uniform(0.0, 0.1, (6, 3))
    for _ in range(60):
        reached = np.minimum(reached + rng.uniform(0.03, 0.05, (6, 3)), high)
        outputs.append(guard.check(reached, TICK))
    assert {output.state for output in outputs[1:10]} == {"recovering"}
    assert outputs[-1].ok
    check_bounds(guard.bounds, outputs)
    speed = np.diff([output.angles for output in outputs], axis=0) / TICK
    assert speed.max() == pytest.approx(UNKNOWN_SPEED)


@pytest.mark.parametrize("seed", range(10))
def test_recovery_stays_within_limits_despite_rounding(seed):
    """Limits near zero, where a step to the limit is inexact; one joint far away keeps the guard recovering."""
    rng = np.random.default_rng(seed)
    limits = np.array([-1.0, 1.0]) * np.concatenate([rng.uniform(0, 2e-3, 17), [1.0]]).reshape(6, 3, 1)
    robot = ring(6, limits=limits)
    guard = Guard(robot, bounds=GuardBounds.of(robot, recovery_distance=3.0, acceleration=1e4), start=np.zeros((6, 3)))
    side = rng.choice([-1, 1], (60, 6, 3))
    side[:, 5, 2] = 1
    outputs = [guard.check(NAN, TICK)]
    for towards in np.repeat(side, 4, axis=0)[:60]:
        outputs.append(guard.check(limits[..., 1] * towards, rng.uniform(0.003, 0.02)))
    assert {output.state for output in outputs[1:30]} == {"recovering"}
    check_bounds(guard.bounds, outputs)


def test_a_lasting_intervention_counts_once():
    guard = Guard(preset("strider"), start=standing())
    run(guard, NAN, 10)
    assert dict(guard.counts) == {"not_finite": 1}
    run(guard, standing(), 10)
    run(guard, NAN, 10)
    assert dict(guard.counts) == {"not_finite": 2}
    assert [output.time for output in guard.log] == pytest.approx([0.01, 0.21])


def test_the_log_is_bounded_and_the_summary_shows_the_worst():
    guard = Guard(preset("strider"), start=standing(), log_size=3)
    for size in (0.3, 0.5, 0.4, 0.2, 0.6):
        guard.check(standing() + size * np.eye(6, 3), TICK)
        run(guard, standing(), 30)
        assert guard.state == "passing"
    assert guard.counts["joint_speed"] == 5
    assert len(guard.log) == 3
    lines = guard.summary().splitlines()
    assert lines[0] == f"{sum(guard.counts.values())} interventions in {guard.time:.2f} s, state: passing"
    speed = preset("strider").servos[0][0].no_load_speed
    worst = (
        rf"  5 x \w\w (coxa|femur|tibia): joint speed {np.rad2deg(60):.4g} deg/s, "
        rf"bound {np.rad2deg(speed):.4g} deg/s, at 1.250 s"
    )
    assert [line for line in lines if re.fullmatch(worst, line)]


def test_intervention_texts():
    guard = Guard(preset("strider"), start=standing())
    guard.check(NAN, TICK)
    assert guard.log[-1].text() == "LF coxa: non-finite joint angle, at 0.010 s"
    guard.check(np.zeros(4), TICK)
    assert guard.log[-1].text() == "joint angle array 4 values, bound 18 values, at 0.020 s"
    guard.check(standing(), TICK, ~ALL_STANCE)
    assert guard.log[-1].text() == "stability margin -inf mm, bound 0 mm, at 0.030 s"
    assert guard.summary().startswith("3 interventions in 0.03 s, state: holding\n")


def test_the_first_valid_command_sets_the_start():
    guard = Guard(preset("strider"))
    assert guard.check(standing() + 0.2, TICK).ok
    assert guard.check(standing(), TICK).state == "holding"


def test_a_given_start_is_used():
    guard = Guard(preset("strider"), start=standing() + 0.2)
    output = guard.check(standing(), TICK)
    assert output.state == "holding"
    np.testing.assert_array_equal(output.angles, standing() + 0.2)


@pytest.mark.parametrize("dt", [TICK, math.nan])
@pytest.mark.parametrize("name", PRESETS)
def test_an_invalid_first_command_starts_in_the_default_stance(name, dt):
    guard = Guard(preset(name))
    output = guard.check(NAN, dt)
    assert output.state == "holding"
    np.testing.assert_array_equal(output.angles, standing(name))
    assert run(guard, standing(name), 5)[-1].ok


def test_with_a_stance_beyond_the_limits_it_starts_near_zero_angles():
    robot = preset("strider")
    limits = np.tile([[0.3, 0.5], [-0.5, 0.5], [-0.5, -0.2]], (6, 1, 1))
    guard = Guard(robot, bounds=GuardBounds.of(robot, limits=limits))
    np.testing.assert_array_equal(guard.check(NAN, TICK).angles, np.tile([0.3, 0.0, -0.2], (6, 1)))


def test_without_a_stance_it_starts_near_zero_angles():
    robot = ring(6, limits=np.broadcast_to([[-0.1, 0.1], [1.0, 1.5], [0.0, 0.2]], (6, 3, 2)))
    guard = Guard(robot)
    np.testing.assert_array_equal(guard.check(NAN, TICK).angles, np.tile([0.0, 1.0, 0.0], (6, 1)))
