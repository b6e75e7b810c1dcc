"""One rest stance: a robot in the stance of one command does not jump when another starts."""

import numpy as np
import pytest

from sample_commands import run_json
from tarsus import (
    Gait,
    RobotController,
    WalkController,
    default_stance,
    inverse_kinematics,
    list_robots,
    load_robot,
    plan_walk,
    straight_path,
)
from tarsus.studio.messages.state import BodyState, JointsState
from tarsus.studio.poses import resting, standing


@pytest.mark.parametrize("name", list_robots())
def test_every_command_and_view_starts_in_the_same_stance(name):
    robot = load_robot(name)
    stance = inverse_kinematics(robot, default_stance(robot)).require().angles
    gait = Gait.named("tripod")
    walk = plan_walk(robot, gait, straight_path(0.1))
    found = {
        "first sample of a walk": walk.angles[0],
        "last sample of a walk": walk.angles[-1],
        "pose": np.radians(run_json("pose", name)[1]["angles_deg"]),
        "Joints": resting(robot, JointsState()).angles,
        "Body": standing(robot, BodyState()).solution.angles,
        "live walking": WalkController(robot, gait).angles,
        "Drive": RobotController(robot).output.angles,
    }
    jumps = {what: float(np.abs(angles - stance).max()) for what, angles in found.items()}
    assert max(jumps.values()) < 1e-8, jumps


def test_pose_takes_the_heights_of_a_walk():
    walk = plan_walk(load_robot("strider"), Gait.named("wave"), straight_path(0.1), body_height=0.13, swing_height=0.05)
    _, document = run_json("pose", "strider", "--body-height", 130, "--swing-height", 50)
    assert np.abs(np.radians(document["angles_deg"]) - walk.angles[0]).max() < 1e-8
