"""A robot that does all that is commanded has lost no way and no heading, and its attitude is the commanded one."""

import cmath
import math

import numpy as np
import pytest

from gait_robots import point_feet
from tarsus.control.command import Command
from tarsus.control.contact.footing import along_gravity, off_commanded
from tarsus.control.readings import SensorReadings
from tarsus.control.walk.state import GaitState
from tarsus.control.walk_controller import WalkController
from tarsus.gait.gait import Gait
from tarsus.kinematics.pose import Pose

DT = 0.01
COMMANDS = {
    "turn": Command(twist=(0.04, 0.0, 0.4)),
    "body": Command(twist=(0.06, 0.0, 0.0), body=(0.02, -0.015, 0.0, 0.03, -0.03, 0.15)),
    "sway": Command(twist=(0.05, 0.02, 0.0), sway=(0.0, 0.01, 0.0, 0.05, 0.03, 0.08)),
}


def walked(command, seconds=6.0):
    """Yield a walk that is read as it is commanded, and its body over the ground, once for each look at it."""
    controller = WalkController(point_feet("strider"), Gait.named("wave"))
    yaw = 0.0
    for _ in range(round(seconds / DT)):
        roll, pitch, now = np.asarray(controller.body.rpy).tolist()
        rate = math.remainder(now - yaw, math.tau) / DT
        yaw = now
        body = np.asarray(controller.body.rotation).T @ np.array([0.0, 0.0, rate])
        readings = SensorReadings(
            joint_angles=controller.angles,
            contacts=controller.contacts,
            attitude=(roll, pitch),
            angular_rates=body,
        )
        controller.step(command, DT, readings=readings)
        felt = controller._walk.ground.body
        if felt.since == 0.0:
            yield felt


@pytest.mark.parametrize("command", COMMANDS.values(), ids=COMMANDS)
def test_a_robot_that_does_what_is_commanded_has_lost_nothing(command):
    for felt in walked(command):
        assert abs(felt.odometry.behind) < 1e-3
        assert abs(felt.heading.behind) < 5e-3
        assert max(map(abs, felt.tilt)) < 4e-3
        assert max(map(abs, felt.contacts.sunk)) < 2e-3


@pytest.mark.parametrize("yaw", [0.0, 0.35, -1.2])
def test_the_tilt_is_about_the_axes_of_the_heading_frame_however_the_body_is_turned(yaw):
    state = GaitState.standing(np.zeros(6, dtype=complex), np.array([0.0, 0.0, 0.1, 0.0, 0.0, yaw, 0.03, *[0.0] * 6]))
    tilted = Pose.from_rpy(0.02, -0.03, 0.0) @ Pose.from_rpy(yaw=yaw)
    roll, pitch, _ = np.asarray(tilted.rpy).tolist()
    assert off_commanded((roll, pitch), state) == pytest.approx((0.02, -0.03), abs=1e-3)
    # A point of the body is where the body has turned it to.
    assert along_gravity(0.02 + 0j, state.moved_posture.tolist(), (0.0, 0.0)) == pytest.approx(
        0.02 * cmath.exp(1j * yaw)
    )
