"""Joint solver against the public inverse kinematics."""

import numpy as np
import pytest

from sample_gait_states import EARTH, FACING, moment_of, rest_of, setup_of
from tarsus import Pose, inverse_kinematics, list_robots
from tarsus.control.filters import CriticallyDamped
from tarsus.control.walk.joint_solver import JointSolver
from tarsus.gait.swing import horizontal_profile, vertical_profile

SWAY = (0.01, 0.005, 0.004, 0.02, -0.03, 0.05)


def moment(name, *, sway=(0.0,) * 6, out=1.0):
    """A state with every other foot at 0.4 of its swing."""
    setup, rest = setup_of(name), out * rest_of(name)
    up = np.arange(len(rest)) % 2 == 0
    now = moment_of(setup, rest, down=~up, swing_phase=np.where(up, 0.4, 0.0), start_height=np.full(len(rest), 0.002))
    now = now._replace(
        elevation=0.3,
        admittance_offset=CriticallyDamped.still(np.linspace(-0.002, 0.002, len(rest))),
    )
    now = now._replace(ground_height=now.ground_height + 0.3, start_height=now.start_height + 0.3)
    return setup, now._replace(
        posture=CriticallyDamped.still(np.append(now.posture.value, sway)), cycles=0.3, beats=0.6
    )


def expected(setup, now, sway):
    x, y, z, roll, pitch, yaw, swing_height = now.posture.value[:7]
    once, often = np.sin(2 * np.pi * now.cycles), np.sin(2 * np.pi * now.beats)
    dx, dy, dz, dr, dp, dw = np.array(sway) * [often, once, often, once, often, once]
    heading = Pose.from_rpy(0, 0, FACING, (EARTH.real, EARTH.imag, 0.3))
    body = heading @ Pose.from_rpy(roll + dr, pitch + dp, yaw + dw, (x + dx, y + dy, z + dz))
    swinging = 0.002 * (1 - horizontal_profile(now.swing_phase)) + swing_height * vertical_profile(now.swing_phase)
    height = 0.3 + np.where(now.down, 0.0, swinging) + now.admittance_offset.value
    feet = np.stack([now.foot.real, now.foot.imag, height], axis=-1)
    return inverse_kinematics(setup.robot, body.inverse() @ feet)


@pytest.mark.parametrize("sway", [(0.0,) * 6, SWAY], ids=["still", "swaying"])
@pytest.mark.parametrize("name", list_robots())
def test_it_is_the_inverse_kinematics_of_the_state(name, sway):
    setup, now = moment(name, sway=sway)
    solver = JointSolver(setup.robot)
    found = expected(setup, now, sway)
    assert found.ok.all()
    for _ in range(2):
        np.testing.assert_allclose(solver.angles(now), found.angles, atol=1e-9)
    # The pose kept for the first posture is not used for another.
    higher = now._replace(posture=CriticallyDamped.still(now.posture.value + np.eye(13)[2] * 0.002))
    found = expected(setup, higher, sway)
    np.testing.assert_allclose(solver.angles(higher), found.angles, atol=1e-9)


def test_out_of_reach_it_gives_the_nearest_reachable_point():
    setup, now = moment("strider", out=2.0)
    found = expected(setup, now, (0.0,) * 6)
    assert not found.ok.all()
    angles = JointSolver(setup.robot).angles(now)
    np.testing.assert_allclose(angles, found.angles, atol=1e-9)
    assert not angles.flags.writeable
