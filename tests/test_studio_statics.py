"""The studio's short way to margin, forces and torques gives what the long one gives."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tarsus import (
    Pose,
    centre_of_mass,
    default_body_height,
    default_stance,
    forward_kinematics,
    inverse_kinematics,
    joint_torques,
    load_robot,
    resting_pose,
    stability_margin,
)
from tarsus.studio.statics import margin_of, torques_and_forces

ROBOTS = [load_robot(name) for name in ("strider", "phantomx", "ch3r")]
small = st.floats(-1, 1)
masks = st.lists(st.booleans(), min_size=6, max_size=6).map(np.array)


@given(st.sampled_from(ROBOTS), st.tuples(*[small] * 6), masks)
def test_of_a_robot_that_stands(robot, shift, contacts):
    height = default_body_height(robot)
    x, y, z, roll, pitch, yaw = shift
    body = Pose.from_rpy(roll * 0.2, pitch * 0.2, yaw, (x * 0.12, y * 0.12, height + z * 0.02))
    angles = np.asarray(inverse_kinematics(robot, default_stance(robot, height)).angles)
    compared(robot, angles, body, contacts)


@given(st.sampled_from(ROBOTS), st.lists(st.floats(-1.5, 1.5), min_size=18, max_size=18))
def test_of_a_robot_that_rests(robot, angles):
    angles = np.array(angles).reshape(6, 3)
    rest = resting_pose(robot, angles)
    compared(robot, angles, rest.body, np.asarray(rest.contacts))


def compared(robot, angles, body, contacts):
    feet = np.asarray(body @ forward_kinematics(robot, angles)[:, 3])
    com = np.asarray(body @ centre_of_mass(robot, angles))
    margin = stability_margin(robot, angles, body, contacts)
    assert margin_of(feet, contacts, com) == pytest.approx(float(margin), abs=1e-9)
    assume(contacts.any())
    torques, forces = torques_and_forces(robot, angles, body, contacts, feet=feet, com=com)
    by_the_long_way = joint_torques(robot, angles, body, contacts)
    assert torques == pytest.approx(by_the_long_way[0], abs=1e-7)
    assert forces == pytest.approx(by_the_long_way[1], abs=1e-6)


def test_without_feet_there_is_no_margin():
    assert margin_of(np.zeros((6, 3)), np.zeros(6, dtype=bool), np.zeros(3)) == -np.inf
