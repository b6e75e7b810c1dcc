"""Bounds and arguments of the guard."""

import math

import numpy as np
import pytest

from gait_robots import preset, ring
from sample_guard import NAN, TICK, check_bounds, kinds_of, run
from tarsus.control.safety import Guard, GuardBounds
from tarsus.errors import InputError, UnknownNameError
from tarsus.kinematics.pose import Pose
from tarsus.robot.joint_limits import UNKNOWN_SPEED
from tarsus.robot.robot import stack_robots


def test_default_bounds_come_from_the_robot():
    robot = preset("strider")
    bounds = GuardBounds.of(robot)
    np.testing.assert_array_equal(bounds.limits, robot.limits)
    np.testing.assert_array_equal(bounds.speed, [[servo.no_load_speed for servo in leg] for leg in robot.servos])
    np.testing.assert_allclose(bounds.acceleration, bounds.speed / 0.05)
    assert bounds.assumptions == ()
    assert not bounds.limits.flags.writeable
    assert not bounds.speed.flags.writeable


def test_unknown_speeds_are_assumed_and_listed():
    bounds = GuardBounds.of(ring(6))
    assert (bounds.speed == UNKNOWN_SPEED).all()
    assert bounds.assumptions == ("joint speed 5 rad/s for 18 joints: servo speed unknown",)
    given_speed = GuardBounds.of(ring(6), speed=[1.0, 2.0, 3.0])
    assert given_speed.assumptions == ()
    np.testing.assert_allclose(given_speed.acceleration, np.tile([20.0, 40.0, 60.0], (6, 1)))
    assert (GuardBounds.of(ring(6), acceleration=7).acceleration == 7).all()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"speed": 0}, "guard bound speed contains 0; every number must be finite and greater than 0"),
        ({"speed": np.ones(4)}, r"guard bound speed is array.*; expected a number or an array of shape"),
        ({"speed": "fast"}, "guard bound speed is 'fast'; expected a number"),
        ({"acceleration": math.nan}, "guard bound acceleration contains nan; every number must be finite"),
        ({"limits": "wide"}, "guard bound limits: expected an array of real numbers"),
        ({"limits": np.full((6, 3, 2), math.nan)}, r"guard bound limits\[0, 0, 0\] is nan"),
        ({"limits": np.zeros((6, 3))}, r"guard bound limits has shape \(6, 3\); expected \(legs, 3, 2\)"),
        ({"limits": np.tile([1.0, 0.0], (6, 3, 1))}, "a lower limit is greater than its upper limit"),
        ({"limits": np.zeros((5, 3, 2)), "speed": 1, "acceleration": 1}, "guard bound limits is for 5 legs"),
        ({"margin": math.nan}, "guard bound margin is nan"),
        ({"margin": None}, "guard bound margin is None; it must be a number"),
        ({"foot_drag": 0}, "guard bound foot_drag is 0; it must be greater than 0 and at most inf"),
        ({"ground_slope": 2}, "guard bound ground_slope is 2; it must be at least 0 and at most 1.5708"),
        ({"recovery_distance": math.nan}, "guard bound recovery_distance is nan"),
        ({"max_time_step": 1e-5}, "max_time_step is 1e-05 s; it must be at least min_time_step, 0.0001 s"),
    ],
)
def test_invalid_bounds_are_rejected(changes, message):
    with pytest.raises(InputError, match=message):
        GuardBounds.of(ring(6), **changes)


def test_invalid_arguments_are_rejected():
    robot = preset("strider")
    with pytest.raises(UnknownNameError, match=r"no policy is called 'sti'\. Did you mean 'sit'"):
        Guard(robot, policy="sti")
    with pytest.raises(UnknownNameError, match="no recovery is called 'never'"):
        Guard(robot, recover="never")
    with pytest.raises(InputError, match="is a batch of"):
        Guard(stack_robots([robot, robot]))
    with pytest.raises(InputError, match="the bounds are for 8 legs; 'strider' has 6"):
        Guard(robot, bounds=GuardBounds.of(ring(8)))
    with pytest.raises(InputError, match="the bounds are for 6 legs; 'strider' has 6"):
        Guard(stack_robots([robot, robot]), bounds=GuardBounds.of(robot))
    for size in (0, 2.5):
        with pytest.raises(InputError, match=f"log_size is {size}; it must be a whole number of at least 1"):
            Guard(robot, log_size=size)
    with pytest.raises(InputError, match=r"start must be .*: joint angle array 9 values"):
        Guard(robot, start=np.zeros((3, 3)))
    with pytest.raises(InputError, match=r"start must be .*LF tibia: joint angle 5730 deg"):
        Guard(robot, start=np.full((6, 3), 100.0))


@pytest.mark.parametrize("legs", [4, 5, 8, 10])
def test_it_works_with_any_number_of_legs(legs):
    robot = ring(legs)
    angles = np.tile([0.0, 0.4, -1.2], (legs, 1))
    guard = Guard(robot, policy="sit", bounds=GuardBounds.of(robot, sit_delay=0.05))
    assert guard.check(angles, TICK, np.ones(legs, dtype=bool), Pose()).ok
    outputs = run(guard, NAN, 800)
    assert kinds_of(outputs[0]) == ["shape"]
    check_bounds(guard.bounds, outputs)
    assert any(output.state == "sitting" for output in outputs)
