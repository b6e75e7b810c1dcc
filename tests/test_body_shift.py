"""The body shift of quadrupeds: stability by an independent hull, smoothness, and exact walks."""

import dataclasses

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from gait_robots import in_heading_frame, ring
from quadrupeds import hull_margin, random_quadruped
from sample_walks import ring_robot
from tarsus.errors import InputError, StrokeError
from tarsus.gait.body_shift import COEFFICIENTS, edge_constraints, fitted_shift, shift_at
from tarsus.gait.gait import Gait
from tarsus.gait.path import curved_path, straight_path
from tarsus.gait.plan import plan_walk
from tarsus.gait.storage import load_motion, save_motion
from tarsus.gait.stroke import max_stroke
from tarsus.load.cycle_torques import cycle_torques
from tarsus.robot.file import robot_from_dict, robot_to_dict

CREEP = Gait.named("creep", legs=4)
PATHS = {
    "forward": straight_path(0.25),
    "back": straight_path(0.25, np.pi),
    "left": straight_path(0.25, np.pi / 2),
    "across": straight_path(0.25, -2.4),
    "turning left": curved_path(1.2),
    "turning right": curved_path(-1.2),
    "an arc": curved_path(0.6, (0.05, -0.4)),
    "a short way": straight_path(0.01),
}


def creep(robot, path, **more):
    return plan_walk(robot, Gait.named("creep", legs=4, turning=path.angle), path, rate=50, **more)


@pytest.mark.parametrize(("seed", "path"), list(enumerate(PATHS)))
def test_random_quadrupeds_are_stable_throughout(seed, path):
    motion = creep(random_quadruped(seed), PATHS[path], stroke=0.012 if seed > 2 else None)
    assert motion.ok
    margin = hull_margin(motion.robot, motion.angles, motion.body, motion.contacts)
    np.testing.assert_allclose(motion.margin, margin, atol=1e-9)
    assert margin.min() > 0.002


@pytest.mark.parametrize("path", PATHS)
def test_the_body_moves_smoothly_and_arrives_where_the_path_ends(path):
    motion = creep_at(50, PATHS[path])
    end = PATHS[path].planar_pose(np.array(1.0))
    np.testing.assert_allclose(motion.body.position[-1, :2], end[:2], atol=1e-12)
    np.testing.assert_allclose(motion.body.position[0], [0, 0, motion.body_height], atol=1e-12)
    np.testing.assert_allclose(in_heading_frame(motion)[-1], in_heading_frame(motion)[0], atol=1e-12)
    # Halving the time between samples quarters the second differences: the acceleration is continuous.
    finer = creep_at(100, PATHS[path])
    coarse, fine = (np.abs(np.diff(m.body.position, n=2, axis=0)).max() * r**2 for m, r in ((motion, 50), (finer, 100)))
    assert coarse == pytest.approx(fine, rel=0.1)
    moved = np.diff(motion.feet, axis=0)[motion.contacts[1:] & motion.contacts[:-1]]
    assert np.abs(moved).max() < 1e-12


def creep_at(rate, path):
    return plan_walk(ring(4), Gait.named("creep", legs=4, turning=path.angle), path, stroke=0.06, rate=rate)


def test_every_foot_is_down_while_the_shift_begins_and_ends():
    motion = creep_at(50, PATHS["forward"])
    quarter = motion.time < motion.cycle_time / 2
    assert motion.contacts[quarter].all()
    assert motion.contacts[motion.time > motion.duration - motion.cycle_time / 2].all()
    assert np.abs(motion.body.position[quarter][-1, :2]).max() > 0.01


def test_without_the_shift_the_same_gait_tips_over():
    gait = dataclasses.replace(CREEP, body_shift=False)
    motion = plan_walk(ring(4), gait, straight_path(0.2), stroke=0.06)
    assert motion.problems[0].startswith("tips over")


@pytest.mark.no_cover
@pytest.mark.parametrize("direction", [0.0, 1.2, (0, 0, 1)])
def test_the_longest_stroke_is_possible_and_a_longer_one_is_not(direction):
    robot = ring_robot(4)
    longest = max_stroke(robot, CREEP, direction)
    twist = direction if np.ndim(direction) else (np.cos(direction), np.sin(direction), 0.0)
    path = dataclasses.replace(straight_path(1.0), displacement=tuple(0.5 * np.array(twist)))
    assert plan_walk(robot, CREEP, path, stroke=longest, rate=50).ok
    with pytest.raises(StrokeError) as error:
        plan_walk(robot, CREEP, path, stroke=longest * 1.05, rate=50)
    assert error.value.longest == pytest.approx(longest)


@pytest.mark.parametrize(
    ("gait", "com", "reason"),
    [
        (CREEP, 0.4, "is too long: at .* can't reach its target"),
        (Gait(0.6, (0.0, 0.5, 0.0, 0.5), body_shift=True), 0.0, "tips over: no body shift keeps the stability margin"),
    ],
)
def test_what_no_body_shift_makes_stable_is_refused(gait, com, reason):
    robot = ring(4, body_com=np.array([com, 0.0, 0.0]), femur=np.full(4, 0.14), tibia=np.full(4, 0.2))
    assert max_stroke(robot, gait) == 0
    with pytest.raises(StrokeError, match=reason):
        plan_walk(robot, gait, straight_path(0.2), stroke=0.02)


def test_joints_stay_below_half_the_speed_of_their_servos_by_default():
    document = robot_to_dict(ring_robot(4))
    document["leg"] = {**document.get("leg", {}), "servo": "DS3225"}
    motion = creep(robot_from_dict(document), straight_path(0.3))
    assert np.nanmax(motion.speed_ratio) <= 0.5 * 1.02


def test_a_saved_motion_keeps_its_gait(tmp_path):
    motion = creep(ring_robot(4), straight_path(0.1), stroke=0.02)
    save_motion(motion, tmp_path / "walk.npz")
    assert load_motion(tmp_path / "walk.npz").gait == motion.gait


def test_torques_of_a_cycle_are_refused():
    with pytest.raises(InputError, match=r"'creep' shifts the body, .* use joint_loads"):
        cycle_torques(ring(4), CREEP, stroke=0.02)


def test_a_fit_keeps_its_margin_with_the_least_acceleration():
    """Against SciPy's solver of the same constrained problem."""
    optimize = pytest.importorskip("scipy.optimize")
    phases = np.linspace(0, 1, 60, endpoint=False)
    inward = np.exp(2j * np.pi * phases)
    distance = np.where(np.sin(6 * np.pi * phases) > 0, 0.01, -0.02)
    found = fitted_shift(phases, inward, distance, margin=0.005)
    margin = distance + (inward.conj() * shift_at(found, phases)).real
    assert margin.min() == pytest.approx(0.005, abs=1e-4)

    def split(x):
        return x[:COEFFICIENTS] + 1j * x[COEFFICIENTS:]

    def cost(x):
        harmonics = np.array([0, 1, 1, 2, 2, 3, 3])
        return 1e4 * float(((0.1 + np.where(harmonics, harmonics**4.0, 0)) * np.abs(split(x)) ** 2).sum())

    kept = {"type": "ineq", "fun": lambda x: distance + (inward.conj() * shift_at(split(x), phases)).real - 0.005}
    best = optimize.minimize(cost, np.zeros(2 * COEFFICIENTS), constraints=kept, method="SLSQP")
    assert best.success
    mine = cost(np.concatenate([found.real, found.imag]))
    assert mine == pytest.approx(best.fun, rel=0.02)


def test_edges_are_those_of_the_hull():
    rng = np.random.default_rng(1)
    angle = 2 * np.pi * np.arange(5) / 5
    feet = np.exp(1j * angle) * rng.uniform(0.9, 1.1, 5)
    contacts = np.array([True, True, False, True, True])
    _, inward, distance = edge_constraints(feet[None], contacts[None], np.array([0.1 + 0.05j]))
    hull = ConvexHull(np.stack([feet.real, feet.imag], axis=-1)[contacts])
    expected = sorted(
        map(tuple, np.column_stack([-hull.equations[:, :2], -(hull.equations @ [0.1, 0.05, 1])]).round(9))
    )
    assert sorted(zip(inward.real.round(9), inward.imag.round(9), distance.round(9), strict=True)) == expected
