"""The workspace of a leg agrees with inverse kinematics and `reachable_band`."""

import numpy as np
import pytest

from sample_studio import Asked, table
from tarsus import Pose, default_body_height, inverse_kinematics, list_robots, load_robot, reachable_band
from tarsus.gait.branch import branches
from tarsus.studio.leg_workspace import ground_band, ground_outline, plane_outline

TILTED = Pose.from_rpy(0.08, -0.05, 0.4, (0.03, -0.02, 0.12))


def level(robot):
    return Pose.from_rpy(position=(0, 0, default_body_height(robot)))


def reached(robot, leg, feet, body=None):
    """Which of the points ``(n, 3)`` the leg reaches: in G with a body, else in B."""
    every = np.broadcast_to(feet[:, None], (len(feet), robot.legs, 3))
    solution = inverse_kinematics(robot, every, body)
    return (np.asarray(solution.reach)[:, leg] == 0) & ~branches(robot, solution.angles)[:, leg, 0]


@pytest.mark.parametrize("name", list_robots())
def test_reachable_distances_agree_with_reachable_band(name):
    robot = load_robot(name)
    near, far = (np.asarray(end) for end in reachable_band(robot, -default_body_height(robot)))
    for leg in (0, 3):
        found = ground_band(robot, leg, level(robot))
        assert found[1] == pytest.approx(far[leg], abs=2e-6)
        # Near the coxa axis the knee may be below the ground, which the band does not ask for.
        assert found[0] >= near[leg] - 2e-6


@pytest.mark.parametrize("name", ["strider", "phantomx", "ch3r"])
@pytest.mark.parametrize("tilted", [False, True])
def test_the_outline_on_the_ground_separates_reachable_points(name, tilted):
    robot, leg = load_robot(name), 1
    body = TILTED if tilted else level(robot)
    outline = ground_outline(robot, leg, body)
    near, far = (np.asarray(body @ end) for end in (outline.near, outline.far))
    assert np.abs(far[:, 2]).max() < 1e-9
    assert np.linalg.norm(far - near, axis=-1).min() > 1e-5
    inside = near + (far - near) * np.linspace(0.01, 0.999, 9)[:, None, None]
    # The two outermost rays lie on the coxa's limits.
    assert reached(robot, leg, inside[:, 1:-1].reshape(-1, 3), body).all()
    outward = (far - near) / np.linalg.norm(far - near, axis=-1, keepdims=True)
    assert not reached(robot, leg, far + 1e-4 * outward, body).any()


def test_an_outline_ends_at_the_coxa_limits():
    robot = load_robot("strider")
    outline = ground_outline(robot, 1, level(robot))
    turn = np.arctan2(outline.far[:, 1] - 0.086, outline.far[:, 0]) - np.pi / 2
    assert [turn.min(), turn.max()] == pytest.approx([-np.pi / 3, np.pi / 3], abs=1e-4)


@pytest.mark.parametrize("name", ["strider", "phantomx"])
@pytest.mark.parametrize("coxa", [0.0, 0.4, 9.0])
def test_the_outline_in_the_plane_of_the_leg_separates_reachable_points(name, coxa):
    robot, leg = load_robot(name), 0
    outline = plane_outline(robot, leg, coxa)
    inside = outline.near + (outline.far - outline.near) * np.linspace(0.01, 0.99, 7)[:, None, None]
    assert reached(robot, leg, inside[:, 1:-1].reshape(-1, 3)).all()
    length = np.linalg.norm(outline.far - outline.far.mean(0), axis=-1)
    assert length.max() > 0.03


def test_the_outline_is_empty_without_reachable_points():
    robot = load_robot("strider")
    high = Pose.from_rpy(position=(0, 0, 1.0))
    assert ground_outline(robot, 0, high).closed.shape == (0, 3)
    assert np.isnan(ground_band(robot, 0, high)).all()


def test_the_workspace_is_that_of_the_shown_body_pose():
    ask = Asked()
    ask.all("view", view="body")
    ask.all("body", body={"z_mm": 20, "pitch_deg": 5})
    answer = ask("workspace", "workspace", leg=2)
    robot = load_robot("strider")
    body = Pose.from_rpy(pitch=np.radians(5), position=(0, 0, default_body_height(robot) + 0.02))
    assert table(answer["ground_mm"], 3) == pytest.approx(ground_outline(robot, 2, body).closed * 1000, abs=0.006)
    assert answer["farthest_mm"] == pytest.approx(ground_band(robot, 2, body)[1] * 1000, abs=1e-3)
    assert len(answer["plane_mm"]) > 100
    ask.all("view", view="walk")
    walking = ask("workspace", "workspace", leg=2)
    assert table(walking["ground_mm"], 3) == pytest.approx(
        ground_outline(robot, 2, level(robot)).closed * 1000, abs=0.006
    )
    ask.all("view", view="joints")
    assert ask("workspace", "workspace", leg=2)["leg"] == 2
    assert "legs 0 to 5" in ask.error("workspace", leg=6)["text"]
