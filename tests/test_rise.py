"""Getting up, sitting down and folding: what holds at every moment, whatever the angles that the robot is found in."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gait_robots import PRESETS, preset
from tarsus.errors import TarsusError
from tarsus.gait.live.fold import belly_depth, folded_pose, legs_apart, rest_points
from tarsus.gait.live.rise import fold, sit_down, stand_up
from tarsus.gait.setup import default_lift
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.polygon import hull_margin
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.rest import resting_pose
from tarsus.kinematics.stability import stability_margin
from tarsus.kinematics.stance import default_clearance, default_stance
from tarsus.robot.robot import Robot

_DT = 0.004


def stance_angles(robot, clearance=None, lift=None):
    lift = default_lift(robot) if lift is None else lift
    return inverse_kinematics(robot, default_stance(robot, clearance, lift=lift)).require().angles


def excess(robot, angles):
    low, high = robot.limits[..., 0], robot.limits[..., 1]
    return np.maximum(np.maximum(low - angles, angles - high), 0)


def sampled(sequence, times):
    """Moments, and as arrays of them all: angles, contacts, leg points and centres of mass in G."""
    moments = [sequence.at(t) for t in times]
    angles = np.array([m.angles for m in moments])
    body = Pose(np.array([m.body.rotation for m in moments]), np.array([m.body.position for m in moments]))
    points = body @ forward_kinematics(sequence.robot, angles)
    com = body @ centre_of_mass(sequence.robot, angles)
    under = (body @ rest_points(sequence.robot)[None])[..., 2].min(-1)
    return moments, angles, np.array([m.contacts for m in moments]), points, com, under


def check(sequence, start, *, dt=_DT):
    """All that holds for every sequence, from samples of it alone; returns the moments."""
    robot, pace = sequence.robot, sequence.pace
    # Standing still before and after it.
    times = np.arange(-2 * dt, sequence.duration + 3 * dt, dt)
    moments, angles, contacts, points, com, under = sampled(sequence, times)
    np.testing.assert_array_equal(angles[0], start if sequence.duration else sequence.angles_end)
    np.testing.assert_array_equal(angles[-1], sequence.angles_end)

    # Within speeds and accelerations, and so without a jump.
    assert (np.abs(np.diff(angles, axis=0)) / dt <= pace.speed * 1.0001 + 1e-9 / dt).all()
    assert (np.abs(np.diff(angles, 2, axis=0)) / dt**2 <= pace.acceleration * 1.0001 + 1e-9 / dt**2).all()

    # Joints found beyond a limit come in, and stay within it.
    assert (np.diff(excess(robot, angles), axis=0) <= 1e-7).all()

    # Over the whole of each time on the ground a foot stays where it came down.
    for leg in range(robot.legs):
        changes = np.flatnonzero(np.diff(contacts[:, leg].astype(int)))
        for part in np.split(np.arange(len(times)), changes + 1):
            if contacts[part[0], leg]:
                feet = points[part, leg, 3]
                assert np.abs(feet - feet[0]).max() < 1e-6
                assert np.abs(feet[:, 2]).max() < 1e-6
    assert points[..., 1:, 2].min() > -2e-6
    assert under.min() > -2e-6

    at_rest = np.array([m.belly for m in moments])
    for stage in sequence.stages:
        part = np.array([sequence.stage_at(t)[0] is stage for t in times])
        if not part.any():
            continue
        props = np.broadcast_to(stage.props, (part.sum(), *stage.props.shape))
        held = np.concatenate([points[part][:, :, 3], props], axis=1)[..., :2]
        bears = np.concatenate([contacts[part], np.ones(props.shape[:2], dtype=bool)], axis=1)
        assert (hull_margin(held, bears, com[part][:, :2]) >= -1e-6).all()
        if len(stage.props):
            # Beside the feet, nothing but what was found so bears it, or the belly.
            assert np.abs(stage.props[:, 2]).max() < 1e-6
        else:
            assert (contacts[part & ~at_rest].sum(-1) >= 3).all()
    end = sequence.at(sequence.duration)
    np.testing.assert_allclose(end.body.position[:2], 0, atol=1e-12)
    np.testing.assert_allclose(end.body.rpy, 0, atol=1e-9)
    return times, moments
