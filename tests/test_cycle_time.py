"""Cycle times and strokes against finite differences of densely sampled steady cycles."""

import itertools

import numpy as np
import pytest

from gait_robots import PRESETS, preset, ring
from sample_stances import cycle_timing_of, setup_of, standing, velocity_limits_of
from tarsus.control.workspace.cycle_time import _SteadyCycle, cycle_timing
from tarsus.control.workspace.stance_limits import velocity_limits
from tarsus.gait.cycle import cycle_feet
from tarsus.gait.gait import Gait
from tarsus.gait.stance.velocity_limits import with_stroke_limits
from tarsus.incremental import complete
from tarsus.robot.joint_limits import JointLimits, joint_limits

HEADINGS = [(np.cos(a), np.sin(a), 0.0) for a in np.arange(7) * 2 * np.pi / 7 + 0.2]
TWISTS = [
    (1.0, 0.0, 0.0),
    (0.0, 1.0, 0.0),
    *HEADINGS,
    (0.0, 0.0, 1.0),
    (0.0, 0.0, -1.0),
    (1.0, 0.0, 5.0),
    (0.5, 0.5, -4.0),
]


def strain(setup, limits, twist, cycle_time):
    """Greatest joint speed and acceleration over their limits in a steady cycle at the feasible fraction of a twist."""
    share, _ = limits.feasible_fraction(np.array(twist), stance_time=1.0, duty_factor=setup.gait.duty_factor)
    phases, step = np.linspace(0, 1, 1201, retstep=True)
    feet, _ = cycle_feet(
        setup.gait, setup.rest, share * np.array(twist), swing_height=np.asarray(setup.swing_height), phases=phases
    )
    stand = standing(setup)
    angles = np.stack(stand.solve(setup.robot.geometry, feet[..., 0], feet[..., 1], feet[..., 2])[:3], axis=-1)
    rate = np.diff(angles, axis=0) / (step * cycle_time)
    change = np.diff(rate, axis=0) / (step * cycle_time)
    speed, acceleration = joint_limits(setup.robot, None, None)
    return (np.abs(rate) / speed).max(), (np.abs(change) / acceleration).max()


def limits_of(name, gait, found):
    return with_stroke_limits(
        velocity_limits_of(name, gait), found.stroke, found.turning, duty_factor=Gait.named(gait).duty_factor
    )


@pytest.mark.parametrize(("name", "gait"), list(itertools.product(PRESETS, ["tripod", "ripple", "wave"])))
def test_steady_walks_keep_within_the_joints_speed_and_acceleration(name, gait):
    found = cycle_timing_of(name, gait)
    setup, limits = setup_of(name, gait), limits_of(name, gait, found)
    strains = np.array([strain(setup, limits, twist, found.cycle_time) for twist in TWISTS])
    assert strains.max() <= 1
    # A cycle shorter by an eighth would be too short for the same strokes.
    assert max(max(strain(setup, limits, twist, found.cycle_time / 1.14)) for twist in TWISTS) > 1


@pytest.mark.parametrize("name", PRESETS)
def test_in_a_given_cycle_time_the_strokes_are_as_long_as_the_joints_allow(name):
    shortest = cycle_timing_of(name, "tripod", 0.05).cycle_time
    found = cycle_timing_of(name, "tripod", 1.5 * shortest)
    assert found.cycle_time == pytest.approx(1.5 * shortest)
    limits = limits_of(name, "tripod", found)
    strains = [max(strain(setup_of(name), limits, twist, found.cycle_time)) for twist in TWISTS]
    assert max(strains) <= 1


@pytest.mark.parametrize("name", ["strider", "phantomx"])
def test_too_short_a_cycle_time_is_increased(name):
    asked = cycle_timing_of(name, "tripod", 0.05)
    assert asked.cycle_time == cycle_timing_of(name, "tripod", 0.1).cycle_time > 0.1
    limits = limits_of(name, "tripod", asked)
    assert max(strain(setup_of(name), limits, (1.0, 0.0, 0.0), asked.cycle_time)) <= 1
    # There it still gets on: by a quarter of what the legs allow.
    assert min(asked.stroke, asked.turning) > 0.01


def test_a_long_cycle_time_is_limited_by_reach_only():
    found = cycle_timing_of("strider", "tripod", 30.0)
    assert found.cycle_time == 30.0
    for twist in TWISTS[:-2]:
        legs, _ = velocity_limits_of("strider").feasible_fraction(np.array(twist), stance_time=1.0, duty_factor=0.5)
        joints, _ = limits_of("strider", "tripod", found).feasible_fraction(
            np.array(twist), stance_time=1.0, duty_factor=0.5
        )
        assert joints == pytest.approx(legs)


def test_the_default_cycle_time_gives_the_fastest_walk():
    setup, free = setup_of("phantomx"), cycle_timing_of("phantomx")

    def speed(cycle_time):
        found = cycle_timing_of("phantomx", "tripod", cycle_time)
        limits = limits_of("phantomx", "tripod", found)
        forward = np.array([1.0, 0.0, 0.0])
        return limits.feasible_fraction(
            forward, stance_time=setup.gait.duty_factor * found.cycle_time, duty_factor=0.5
        )[0]

    best = speed(free.cycle_time)
    assert best >= 0.99 * max(speed(part * free.cycle_time) for part in (0.8, 0.9, 1.1, 1.3, 1.8))


def test_with_short_stances_the_speed_in_stance_counts():
    # Eight legs, five in the air in turn: a foot on the ground goes faster than one that swings.
    robot = ring(8)
    gait = Gait(3 / 8, tuple((3 * leg % 8) / 8 for leg in range(8)))
    setup = setup_of(robot, gait)
    # Support isn't what this is about: all but one at once.
    limits = complete(velocity_limits(robot, Gait.named("wave", legs=8), [standing(setup)], foot_distance=0.01))
    found = complete(cycle_timing(robot, gait, standing(setup), limits, joint_limits(robot)))
    less = with_stroke_limits(limits, found.stroke, found.turning, duty_factor=gait.duty_factor)
    strains = [strain(setup, less, twist, found.cycle_time)[0] for twist in TWISTS[:-2]]
    assert 0.8 < max(strains) <= 1


def test_slower_joints_step_slower():
    setup = setup_of("strider")
    speed, acceleration = joint_limits(setup.robot, None, None)

    def found(part):
        return complete(
            cycle_timing(
                setup.robot,
                setup.gait,
                standing(setup),
                velocity_limits_of("strider"),
                JointLimits(part * speed, part * part * acceleration),
            )
        )

    # Half the speed, a quarter of the acceleration: the same walk in slow motion.
    assert found(0.5).cycle_time == pytest.approx(2 * found(1).cycle_time, rel=1e-9)
    assert found(0.5).stroke == pytest.approx(found(1).stroke, rel=1e-9)


def test_default_joint_limits_are_no_load_speeds():
    robot = preset("phantomx")
    speed, acceleration = joint_limits(robot, None, None)
    assert speed.shape == acceleration.shape == (6, 3)
    assert speed[0, 0] == robot.servos[0][0].no_load_speed
    np.testing.assert_allclose(acceleration, speed / 0.05)


def test_joint_limits_without_servos_and_as_given():
    bare = ring(6)
    np.testing.assert_array_equal(joint_limits(bare, None, None)[0], 5.0)
    speed, acceleration = joint_limits(bare, 3.0, None)
    np.testing.assert_array_equal(speed, 3.0)
    np.testing.assert_allclose(acceleration, 60.0)
    speed, acceleration = joint_limits(bare, None, 7.0)
    np.testing.assert_array_equal(speed, 5.0)
    np.testing.assert_array_equal(acceleration, 7.0)


@pytest.mark.parametrize(("legs", "gait"), [(4, "creep"), (6, "wave"), (8, "wave")])
def test_more_legs_take_more_increments(legs, gait):
    setup = setup_of(ring(legs), gait)
    limits = complete(velocity_limits(setup.robot, setup.gait, [standing(setup)], foot_distance=0.01))
    work = cycle_timing(setup.robot, setup.gait, standing(setup), limits, joint_limits(setup.robot))
    assert sum(1 for _ in work) >= legs // 3


@pytest.mark.parametrize(("duty_factor", "swing_height"), [(0.5, 0.03), (5 / 6, 0.1), (3 / 8, 0.0)])
def test_the_complex_form_equals_the_planned_cycle(duty_factor, swing_height):
    moves = np.array([(0.1, 0.0, 0.0), (0.0, 0.0, 0.5), (-0.03, 0.07, -0.4), (0.0, 0.0, 0.0), (0.02, 0.01, 1e-9)])
    rest = np.array([0.2 + 0.1j, -0.1 + 0.25j, 0.0 - 0.3j])
    cycle = _SteadyCycle(Gait(duty_factor, (0.0,) * 3), moves, swing_height)
    points = np.stack([rest.real, rest.imag, 0 * rest.real], axis=-1)
    together = Gait(duty_factor, (0.0,) * 3)
    feet, _ = cycle_feet(together, points, moves, swing_height=np.asarray(swing_height), phases=cycle.phases)
    found = cycle.shift[..., None] + cycle.factor[..., None] * rest
    np.testing.assert_allclose(found, (feet[..., 0] + 1j * feet[..., 1]).swapaxes(0, 1), atol=1e-15)
    np.testing.assert_allclose(np.broadcast_to(cycle.height, feet.shape[1:3]), feet[0, ..., 2], atol=1e-15)
