"""Walks, stances and checks for the tests of the guard."""

import functools
import math

import numpy as np

from gait_robots import preset
from tarsus.control.safety import GuardBounds
from tarsus.gait.gait import Gait
from tarsus.gait.path import curved_path, straight_path
from tarsus.gait.plan import plan_walk
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stance import default_stance

TICK = 0.01
# Tolerance of a sent angle [rad].
ROUNDING = 1e-11
ALL_STANCE = np.ones(6, dtype=bool)
NAN = np.full((6, 3), np.nan)
INVALID_ANGLES = (
    NAN,
    np.full((6, 3), np.inf),
    np.full((6, 3), 1e308),
    "x",
    None,
    [[1.0], [2.0, 3.0]],
    {},
    np.zeros((6, 2)),
    np.zeros((6, 3), dtype=complex),
    np.zeros((6, 3), dtype=bool),
    [10**400] * 3,
    object(),
    np.zeros((2, 6, 3)),
)


@functools.cache
def walk(name, gait="tripod", curved=False):
    """A walk of a preset within the speed that the guard assumes for unknown servos."""
    robot = preset(name)
    unknown = any(servo is None or servo.no_load_speed is None for leg in robot.servos for servo in leg)
    path = curved_path(0.5, (0.1, 0.4)) if curved else straight_path(0.25)
    return plan_walk(robot, Gait.named(gait), path, cycle_time=4.5 if unknown else None)


@functools.cache
def standing(name="strider"):
    robot = preset(name)
    return inverse_kinematics(robot, default_stance(robot)).require().angles


def kinds_of(output):
    return [found.kind for found in output.interventions]


def run(guard, angles, ticks, **given_with):
    """Command the same angles for some ticks."""
    return [guard.check(angles, TICK, **given_with) for _ in range(ticks)]


def check_bounds(bounds, outputs):
    """Check the angles of the outputs against every bound by divided differences."""
    time, angles = np.array([output.time for output in outputs]), np.array([output.angles for output in outputs])
    assert np.isfinite(angles).all()
    assert (angles >= bounds.limits[..., 0]).all()
    assert (angles <= bounds.limits[..., 1]).all()
    step = np.diff(time)
    assert (step >= 0).all()
    np.testing.assert_array_equal(angles[1:][step == 0], angles[:-1][step == 0])
    angles = angles[np.r_[True, step > 0]]
    step = step[step > 0][:, None, None]
    moved = np.diff(angles, axis=0)
    assert (np.abs(moved) <= bounds.speed * step + ROUNDING).all()
    change = np.abs(np.diff(moved / step, axis=0))
    between = (step[1:] + step[:-1]) / 2
    assert (change * step[1:] <= bounds.acceleration * between * step[1:] + ROUNDING).all()
    for output in outputs:
        assert not output.ok or not output.interventions
        assert output.ok == (output.state == "passing")


def only(robot, **changes):
    """Bounds of which only the changed ones can be violated."""
    wide = {"speed": 1e6, "acceleration": 1e12, "margin": -math.inf, "foot_drag": math.inf, "foot_height": math.inf}
    return GuardBounds.of(robot, **{**wide, **changes})


def feet_at(feet, body=None):
    """Joint angles of the strider for feet in G, by default at a body height of 110 mm."""
    body = Pose((np.eye(3)), (0, 0, 0.11)) if body is None else body
    return inverse_kinematics(preset("strider"), feet, body).require().angles


def stance_feet():
    return default_stance(preset("strider")) * [1, 1, 0]
