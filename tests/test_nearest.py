"""Where a foot can't be reached: the nearest point that can, against searches that know nothing of how it is found."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import least_squares

from robots import plain_hexapod, random_robot, seeds
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.leg import forward_kinematics, leg_jacobian
from tarsus.kinematics.nearest import clip_angle, tibia_bend, tibia_branch, wrap


def branch_limits(robot, knee):
    """Limits ``(legs, 3, 2)`` with the tibia's cut to one knee branch, where they allow any of it."""
    limits = np.array(robot.limits)
    low, high = limits[:, 2, 0], limits[:, 2, 1]
    if knee == "up":
        high[low <= 0] = np.minimum(high, 0)[low <= 0]
    else:
        low[high >= 0] = np.maximum(low, 0)[high >= 0]
    return limits


def misses(robot, angles, feet):
    return np.linalg.norm(forward_kinematics(robot, angles)[..., 3, :] - feet, axis=-1)


def on_a_grid(robot, limits, feet, *, steps=(61, 41, 41)):
    """The least distance over an even grid of angles, refined three times about its best point; and the angles."""
    low, high = limits[..., 0], limits[..., 1]
    shares = np.stack(np.meshgrid(*(np.linspace(0, 1, n) for n in steps), indexing="ij"), axis=-1).reshape(-1, 1, 3)
    grid = low + shares * (high - low)
    pitch = (high - low) / (np.array(steps) - 1)
    for _ in range(4):
        best = np.take_along_axis(grid, np.argmin(misses(robot, grid, feet), axis=0)[None, :, None], axis=0)[0]
        offsets = np.stack(np.meshgrid(*[np.linspace(-1, 1, 9)] * 3, indexing="ij"), axis=-1).reshape(-1, 1, 3)
        grid = np.clip(best + offsets * pitch, low, high)
        pitch = pitch / 4
    return best


def polished(robot, limits, feet, leg, start):
    """The local least distance that scipy finds from a start."""
    low, high = limits[leg, :, 0] - 1e-9, limits[leg, :, 1] + 1e-9
    whole = np.zeros((robot.legs, 3))

    def off(q):
        whole[leg] = q
        return forward_kinematics(robot, whole)[leg, 3] - feet[leg]

    def jacobian(q):
        whole[leg] = q
        return leg_jacobian(robot, whole)[leg]

    found = least_squares(
        off,
        np.clip(start, low + 1e-10, high - 1e-10),
        jac=jacobian,
        bounds=(low, high),
        xtol=1e-15,
        ftol=1e-15,
        gtol=1e-15,
    )
    return np.linalg.norm(found.fun)


def unreachable_feet(rng, robot, near_axis):
    size = (robot.coxa + robot.femur + robot.tibia)[:, None]
    feet = rng.uniform(-1.3, 1.3, (robot.legs, 3)) * size
    if near_axis:
        feet[:, :2] *= rng.uniform(0, 0.1, (robot.legs, 1))
    return robot.mount_position + feet


@pytest.mark.no_cover
@pytest.mark.parametrize(("limits", "sideways"), [("random", 0.0), ("random", 0.03), ("full", 0.03)])
@pytest.mark.parametrize("knee", ["up", "down"])
@settings(max_examples=4)
@given(seed=seeds(), near_axis=st.booleans())
def test_no_search_finds_a_nearer_point(limits, sideways, knee, seed, near_axis):
    """Neither a grid over all angles nor scipy, started from the grid's best and from anywhere, by more than 1e-6 m."""
    rng = np.random.default_rng(seed)
    robot = random_robot(rng, legs=4, limits=limits, sideways=sideways)
    feet = unreachable_feet(rng, robot, near_axis)
    bounds = branch_limits(robot, knee)
    solution = inverse_kinematics(robot, feet, knee=knee)
    mine = misses(robot, solution.angles, feet)
    starts = on_a_grid(robot, bounds, feet)
    assert (mine <= misses(robot, starts, feet) + 1e-6).all()
    for leg in range(robot.legs):
        anywhere = rng.uniform(bounds[leg, :, 0], bounds[leg, :, 1], (3, 3))
        for start in (starts[leg], *anywhere):
            assert mine[leg] <= polished(robot, bounds, feet, leg, start) + 1e-6
    # What is called reached is reached, and nothing else is.
    assert (mine[solution.reach == 0] <= 1e-12).all()
    assert (mine[solution.reach != 0] > 1e-13).all()


@given(seed=seeds(), knee=st.sampled_from(["up", "down"]))
def test_without_a_sideways_offset_the_nearest_point_is_exact(seed, knee):
    """No point a short way off along the limits or between them is nearer: least to 1e-12 m, over 2,000 steps."""
    rng = np.random.default_rng(seed)
    robot = random_robot(rng, sideways=0.0)
    feet = unreachable_feet(rng, robot, rng.random() < 0.5)
    bounds = branch_limits(robot, knee)
    q = inverse_kinematics(robot, feet, knee=knee).angles
    steps = rng.normal(size=(2000, 6, 3)) * 10 ** rng.uniform(-7, 0, (2000, 1, 1))
    around = np.clip(q + steps, bounds[..., 0], bounds[..., 1])
    assert (misses(robot, around, feet) >= misses(robot, q, feet) - 1e-12).all()


@given(seed=seeds())
def test_the_nearest_point_is_itself_reached(seed):
    rng = np.random.default_rng(seed)
    robot = random_robot(rng)
    solution = inverse_kinematics(robot, unreachable_feet(rng, robot, rng.random() < 0.3))
    again = inverse_kinematics(robot, forward_kinematics(robot, solution.angles)[:, 3])
    assert again.ok


@pytest.mark.parametrize("stretch", [1.001, 2, 1e6])
def test_the_leg_points_at_a_distant_foot(stretch):
    robot = plain_hexapod()
    direction = np.array([0.8, 0.36, -0.48])
    axis = forward_kinematics(robot, np.zeros((6, 3)))[:, 1]
    turn = np.stack([np.cos(robot.mount_yaw), np.sin(robot.mount_yaw)], axis=-1)
    out = np.concatenate([turn * 0.88, np.full((6, 1), -0.48)], axis=-1)
    feet = axis + (0.098 + 0.181) * stretch * out / np.linalg.norm(direction)
    q = inverse_kinematics(robot, feet).angles
    assert np.abs(q - [0, -np.arctan2(0.48, 0.88), 0]).max() <= 1e-7


def test_angles_beyond_the_limits_are_clipped_to_the_nearer_limit():
    lower, upper = np.array(-1.0), np.array(2.0)
    angles = np.array([-3.0, -2.6, -1.1, -1.0, 0.0, 2.0, 2.1, 3.0])
    # The gap between the limits is centred on -2.64, where an angle is as far from either.
    expected = [2.0, -1.0, -1.0, -1.0, 0.0, 2.0, 2.0, 2.0]
    assert clip_angle(np, angles, lower, upper).tolist() == expected


def test_angles_are_wrapped_into_one_turn():
    angles = np.linspace(-20, 20, 1001)
    found = wrap(np, angles)
    assert np.abs(found).max() <= np.pi
    assert np.abs(np.exp(1j * found) - np.exp(1j * angles)).max() <= 1e-14


@pytest.mark.parametrize(
    ("limits", "up", "down"),
    [((-2, 1), (-2, 0, -1), (0, 1, 1)), ((-2, -1), (-2, -1, -1), (-2, -1, -1)), ((1, 2), (1, 2, 1), (1, 2, 1))],
)
def test_knee_branches_are_restricted_by_the_limits(limits, up, down):
    robot = plain_hexapod(limits=np.tile([(-1, 1), (-1, 1), limits], (6, 1, 1)))
    for knee, (low, high, sign) in ((1, up), (-1, down)):
        found = (*tibia_branch(np, robot.geometry, knee=knee), tibia_bend(np, robot.geometry, knee=knee))
        assert [set(v.tolist()) for v in found] == [{low}, {high}, {sign}]


def test_the_best_coxa_angle_equals_the_best_of_many():
    """Near the coxa axis, where turn and distance settle slowest: against 2 x 181 legs whose coxas can't turn."""
    rng = np.random.default_rng(1)
    robot = random_robot(rng, legs=300, sideways=0.03, limits="full")
    limits = np.array(robot.limits)
    limits[::2, 0] = np.stack([rng.uniform(-3, 0, 150), rng.uniform(0, 3, 150)], axis=-1)
    robot = robot.replace(limits=limits)
    feet = rng.uniform(-1, 1, (300, 3)) * np.stack(
        [*[np.abs(robot.femur_axis_offset[:, 0]) + 1e-3] * 2, robot.tibia], -1
    )
    feet += robot.mount_position
    mine = misses(robot, inverse_kinematics(robot, feet).angles, feet)
    low, high = robot.limits[:, 0].T
    turns = low + np.linspace(0, 1, 181)[:, None] * (high - low)
    for pitch in ((high - low) / 180, None):
        fixed = np.array(np.broadcast_to(robot.limits, (181, 300, 3, 2)))
        fixed[..., 0, :] = turns[..., None]
        still = robot.replace(limits=fixed)
        least = misses(still, inverse_kinematics(still, feet).angles, feet)
        assert (mine <= least.min(0) + 1e-6).all()
        if pitch is not None:
            best = np.take_along_axis(turns, least.argmin(0)[None], axis=0)[0]
            turns = np.clip(best + np.linspace(-1, 1, 181)[:, None] * pitch, low, high)
