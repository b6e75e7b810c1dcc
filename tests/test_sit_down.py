"""The guard lowers a robot that it holds."""

import numpy as np
import pytest

from gait_robots import PRESETS, preset, ring
from sample_guard import ALL_STANCE, NAN, TICK, check_bounds, feet_at, only, run, stance_feet, standing, walk
from tarsus.control.safety import Guard, GuardBounds
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.pose import Pose


def sit(name, index, *, attitude=True, ticks=1200, **changes):
    """Hold a robot during a walk until it sits down; return the guard, all outputs, and those while sitting."""
    motion = walk(name)
    guard = Guard(preset(name), policy="sit", bounds=GuardBounds.of(preset(name), **changes))
    for i in range(index + 1):
        body = motion.body[i] if attitude else None
        assert guard.check(motion.angles[i], TICK, motion.contacts[i], body).ok
    outputs = run(guard, NAN, ticks)
    check_bounds(guard.bounds, outputs)
    return guard, outputs, [output for output in outputs if output.state == "sitting"]


@pytest.mark.parametrize(("name", "index"), list(zip(PRESETS, [0, 60] * 4, strict=True)))
def test_it_sits_down_with_stationary_feet(name, index):
    robot, motion = preset(name), walk(name)
    guard, outputs, sitting = sit(name, index)
    wait = guard.bounds.sit_delay / TICK
    assert wait - 2 < [output.state for output in outputs].index("sitting") < wait + 20
    assert outputs[-1].state == "holding"
    np.testing.assert_array_equal(outputs[-1].angles, outputs[-2].angles)
    points = forward_kinematics(robot, np.array([output.angles for output in sitting]))
    feet, down = points[..., 3, :], motion.contacts[index]
    assert np.ptp(feet[..., :2], axis=0).max() < 1e-5
    assert np.ptp(feet[:, down, 2] - feet[:1, down, 2], axis=1).max() < 1e-5
    assert (np.diff(feet[:, down, 2], axis=0) >= -1e-6).all()
    assert np.ptp(feet[-1, :, 2]) < 2e-3  # swing feet are set down
    belly = robot.mount_position[:, 2].min() if robot.body_size is None else -robot.body_size[2] / 2
    lowest = min(belly, points[-1, :, :3, 2].min()) - feet[-1, :, 2].mean()
    assert lowest == pytest.approx(guard.bounds.sit_height, abs=1e-3)
    lowering = np.diff(feet[:, down, 2].mean(-1)) / TICK
    assert lowering.max() < guard.bounds.sit_speed + 1e-3


def test_it_sits_down_within_the_recovery_speed():
    guard, _, sitting = sit("strider", 0, sit_speed=2.0)
    speed = np.abs(np.diff([output.angles for output in sitting], axis=0)) / TICK
    assert (speed <= guard.bounds.recovery_speed * guard.bounds.speed * (1 + 1e-9)).all()
    assert speed.max() > 0.5


def test_it_sits_down_along_the_vertical_of_a_tilted_body():
    robot = preset("strider")
    body = Pose.from_rpy(0.05, -0.08, 0.3, (0, 0, 0.11))
    guard = Guard(robot, policy="sit")
    feet = Pose.from_rpy(0, 0, 0.3) @ stance_feet()
    assert guard.check(feet_at(feet, body), TICK, ALL_STANCE, body).ok
    outputs = run(guard, NAN, 1000)
    moved = (forward_kinematics(robot, outputs[-1].angles) - forward_kinematics(robot, outputs[0].angles))[:, 3]
    up = body.rotation[2]
    np.testing.assert_allclose(moved, (moved @ up)[:, None] * up, atol=1e-5)
    assert (moved @ up).min() > 0.02


def test_sitting_down_ends_at_a_joint_limit():
    robot = preset("strider")
    limits = np.array(robot.limits)
    limits[2, 1, 1] = standing()[2, 1] + 0.1
    _, outputs, sitting = sit("strider", 0, limits=limits)
    assert sitting
    assert outputs[-1].state == "holding"
    assert 0 <= limits[2, 1, 1] - outputs[-1].angles[2, 1] < 0.02


def test_a_foot_that_cannot_be_set_down_keeps_its_height():
    robot, motion = preset("strider"), walk("strider")
    limits = np.array(robot.limits)
    limits[:, 1, 0] = motion.angles[:, :, 1].min() - 0.02
    air = ~motion.contacts[60]
    limits[air, 1, 0] = motion.angles[60][air, 1] - 0.005
    guard = Guard(robot, policy="sit", bounds=GuardBounds.of(robot, limits=limits))
    assert guard.check(motion.angles[60], TICK, motion.contacts[60], motion.body[60]).ok
    outputs = run(guard, NAN, 800)
    before, after = (forward_kinematics(robot, output.angles)[:, 3, 2] for output in (outputs[0], outputs[-1]))
    np.testing.assert_allclose(np.ptp(after - before), 0, atol=5e-3)
    assert (after - before).min() > 0.02


def test_a_straight_leg_cannot_sit_down():
    robot = ring(6, tibia=np.full(6, 0.3), limits=np.broadcast_to([-3.0, 3.0], (6, 3, 2)))
    straight = np.tile([0.0, -0.7, 0.0], (6, 1))
    guard = Guard(robot, policy="sit", start=straight)
    outputs = run(guard, NAN, 200)
    assert guard.state == "holding"
    assert any(output.state == "sitting" for output in outputs)
    np.testing.assert_array_equal(outputs[-1].angles, straight)


def test_a_singular_leg_cannot_sit_down():
    robot = ring(6, mount_yaw=np.arange(6) * np.pi / 3, limits=np.broadcast_to([-3.0, 3.0], (6, 3, 2)))
    angles = np.tile([0.0, 0.4, -1.2], (6, 1))
    angles[0] = 0
    guard = Guard(robot, policy="sit", bounds=only(robot, sit_delay=0.1))
    assert guard.check(angles, TICK, np.arange(6) > 0).ok
    assert (run(guard, NAN, 50)[-1].angles == angles).all()


def test_without_stance_feet_it_does_not_sit_down():
    robot = preset("strider")
    guard = Guard(robot, policy="sit", bounds=only(robot, sit_delay=0.1))
    assert guard.check(standing(), TICK, ~ALL_STANCE).ok
    outputs = run(guard, NAN, 50)
    assert outputs[-1].state == "holding"
    np.testing.assert_array_equal(outputs[-1].angles, standing())


def test_without_contacts_all_feet_count_as_stance_feet():
    robot = preset("strider")
    guard = Guard(robot, policy="sit", start=standing())
    outputs = run(guard, NAN, 700)
    moved = (forward_kinematics(robot, outputs[-1].angles) - forward_kinematics(robot, standing()))[:, 3]
    np.testing.assert_allclose(moved, [[0, 0, moved[0, 2]]] * 6, atol=1e-5)
    assert moved[0, 2] > 0.05


def test_it_recovers_from_sitting_down():
    guard, outputs, sitting = sit("strider", 0, ticks=150)
    assert sitting
    assert guard.state == "sitting"
    outputs += run(guard, outputs[-1].angles, 30)
    assert outputs[-1].ok
    outputs += run(guard, NAN, 20)
    assert outputs[-1].state == "holding"
    outputs += run(guard, NAN, 1000)
    again = [output.state for output in outputs[200:]]
    assert "sitting" in again
    assert again[-1] == "holding"
    outputs += run(guard, outputs[-1].angles, 30)
    assert outputs[-1].ok
    guard.reset()
    outputs += [guard.check(NAN, TICK)]
    guard.reset()
    outputs += run(guard, standing(), 300)
    assert outputs[-1].ok
    outputs += run(guard, NAN, 200)
    assert outputs[-1].state == "sitting"
    check_bounds(guard.bounds, outputs)


def test_a_time_gap_interrupts_sitting_down():
    guard, outputs, _ = sit("strider", 0, ticks=150)
    outputs.append(guard.check(NAN, 0.3))
    assert outputs[-1].state == "holding"
    outputs += run(guard, NAN, 800)
    states = [output.state for output in outputs[151:]]
    assert "sitting" in states
    assert states[-1] == "holding"
    check_bounds(guard.bounds, outputs)
