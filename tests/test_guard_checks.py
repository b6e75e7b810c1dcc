"""The checks of the guard, each against an independent computation."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gait_robots import point_feet, preset, ring
from sample_guard import ALL_STANCE, INVALID_ANGLES, NAN, TICK, feet_at, kinds_of, only, run, stance_feet, standing
from sample_robots import random_hexapod
from tarsus.control.safety import Guard
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stability import stability_margin
from tarsus.kinematics.stance import default_stance


@given(st.integers(0, 2**32 - 1), st.booleans())
def test_the_stability_margin_equals_that_of_kinematics(seed, masses):
    rng = np.random.default_rng(seed)
    robot = random_hexapod(rng)
    if not masses:
        robot = robot.replace(link_mass=None)
    elif seed % 2:
        robot = robot.replace(coxa=np.zeros(6), femur_axis_offset=np.zeros((6, 2)))
    guard = Guard(robot, bounds=only(robot, margin=1e6))
    for _ in range(10):
        angles, contacts = rng.uniform(-1, 1, (6, 3)), rng.random(6) < rng.uniform(0, 1)
        body = Pose.from_rpy(*rng.uniform(-1.5, 1.5, 2), rng.uniform(-3, 3), rng.normal(size=3))
        (found,) = guard.check(angles, TICK, contacts, body).interventions
        assert found.kind == "stability_margin"
        assert (found.leg, found.joint, found.bound) == ("", "", 1e6)
        assert found.value == pytest.approx(stability_margin(robot, angles, body, contacts), abs=1e-12)


@pytest.mark.parametrize("turned", [[[1, 0, 0], [0, 0, -1], [0, 1, 0]], [[0, 1, 0], [0, 0, 1], [1, 0, 0]]])
def test_the_stability_margin_with_the_body_on_its_side(turned):
    robot = random_hexapod(np.random.default_rng(6))
    body = Pose(np.array(turned, dtype=float))
    (found,) = (
        Guard(robot, bounds=only(robot, margin=1e6)).check(np.zeros((6, 3)), TICK, ALL_STANCE, body).interventions
    )
    assert found.value == pytest.approx(stability_margin(robot, np.zeros((6, 3)), body, ALL_STANCE), abs=1e-12)


@given(st.integers(0, 2**32 - 1))
def test_without_a_body_pose_the_plane_of_the_feet_is_horizontal(seed):
    rng = np.random.default_rng(seed)
    robot = ring(6)
    body = Pose.from_rpy(*rng.uniform(-0.2, 0.2, 2), rng.uniform(-3, 3), (0, 0, 0.1))
    stance = default_stance(robot, body_height=0.1) * [1, 1, 0] + [0, 0, -0.1]
    feet = Pose.from_rpy(0, 0, body.rpy[2], (0, 0, 0.1)) @ stance + [*rng.uniform(-0.01, 0.01, 2), 0]
    angles = inverse_kinematics(robot, feet, body).angles
    contacts = np.zeros(6, dtype=bool)
    contacts[rng.choice(6, rng.integers(3, 7), replace=False)] = True
    guard = Guard(robot, bounds=only(robot, margin=1e6))
    (found,) = guard.check(angles, TICK, contacts).interventions
    assert found.value == pytest.approx(stability_margin(robot, angles, body, contacts), abs=1e-9)


def test_the_stability_margin_of_fewer_than_three_feet():
    robot = ring(6)
    angles = np.tile([0.0, 0.4, -1.2], (6, 1))
    for number in range(3):
        guard = Guard(robot, bounds=only(robot, margin=1e6))
        contacts = np.arange(6) < number
        (found,) = guard.check(angles, TICK, contacts).interventions
        assert found.value == pytest.approx(stability_margin(robot, angles, Pose(), contacts), abs=1e-12)


def test_the_stability_margin_of_collinear_and_coincident_feet():
    """Legs that share one mount and yaw: the feet coincide or are collinear."""
    place = np.tile([0.1, 0.0, 0.0], (6, 1))
    robot = ring(6, mount_position=place, mount_yaw=np.zeros(6), link_mass=None, body_mass=None)
    guard = Guard(robot, bounds=only(robot, margin=1e6))
    same = np.tile([0.0, 0.4, -1.2], (6, 1))
    line = same + np.arange(6)[:, None] * [0.0, 0.0, 0.1]
    for angles in (same, line):
        (found,) = guard.check(angles, TICK, ALL_STANCE).interventions
        assert found.value == pytest.approx(stability_margin(robot, angles, Pose(), ALL_STANCE), abs=1e-12)
        assert found.value < -0.1


@pytest.mark.parametrize("what", ["speed", "acceleration"])
@pytest.mark.parametrize("seed", range(5))
def test_speed_and_acceleration_are_divided_differences(what, seed):
    rng = np.random.default_rng(seed)
    robot = preset("strider")
    steps = rng.uniform(0.005, 0.05, 3)
    moves = rng.normal(size=(4, 6, 3)) * np.reshape([0, 1e-6, 1e-6, 1e-2], (4, 1, 1))
    course = standing() + np.cumsum(moves, axis=0)
    rates = np.diff(course, axis=0) / steps[:, None, None]
    second = np.diff(rates, axis=0) / ((steps[1:] + steps[:-1]) / 2)[:, None, None]
    want = np.abs({"speed": rates[2], "acceleration": second[1]}[what])
    guard = Guard(robot, bounds=only(robot, **{what: want.max() * (1 - 1e-6)}), start=course[0])
    assert guard.check(course[1], steps[0]).ok
    assert guard.check(course[2], steps[1]).ok
    (found,) = (output for output in guard.check(course[3], steps[2]).interventions if output.kind == f"joint_{what}")
    leg, joint = np.unravel_index(np.argmax(want), (6, 3))
    assert (found.leg, found.joint) == (robot.leg_codes[leg], ("coxa", "femur", "tibia")[joint])
    assert found.value == pytest.approx(want.max(), rel=1e-9)
    assert found.bound == pytest.approx(want.max() * (1 - 1e-6))
    assert found.time == pytest.approx(steps.sum())


@pytest.mark.parametrize("what", ["speed", "acceleration"])
def test_motion_just_below_a_bound_passes(what):
    robot = preset("strider")
    steps = [0.01, 0.02, 0.03]
    course = [standing(), standing(), standing() + 1e-4, standing() + 5e-4]
    want = {"speed": 4e-4 / 0.03, "acceleration": (4e-4 / 0.03 - 1e-4 / 0.02) / 0.025}[what]
    want = max(want, {"speed": 0, "acceleration": 1e-4 / 0.02 / 0.015}[what])
    for fraction, passes in ((1 + 1e-6, True), (1 - 1e-6, False)):
        guard = Guard(robot, bounds=only(robot, **{what: want * fraction}))
        outputs = [guard.check(angles, dt) for angles, dt in zip(course, [0.01, *steps], strict=True)]
        assert all(output.ok for output in outputs) == passes


@pytest.mark.parametrize("contacts", [ALL_STANCE, np.arange(6) % 2 == 0])
def test_a_margin_just_above_its_bound_passes(contacts):
    robot = preset("strider")
    margin = stability_margin(robot, standing(), Pose(), contacts)
    assert Guard(robot, bounds=only(robot, margin=margin - 1e-9)).check(standing(), TICK, contacts).ok
    assert not Guard(robot, bounds=only(robot, margin=margin + 1e-9)).check(standing(), TICK, contacts).ok


def test_an_angle_beyond_its_limit_is_reported():
    guard = Guard(preset("strider"))
    beyond = standing().copy()
    beyond[3, 2] = preset("strider").limits[3, 2, 0] - 1e-6
    (found,) = guard.check(beyond, TICK).interventions
    assert (found.kind, found.leg, found.joint) == ("joint_limit", "RR", "tibia")
    assert (found.value, found.bound) == (beyond[3, 2], preset("strider").limits[3, 2, 0])


@pytest.mark.parametrize("side", [0, 1])
def test_rounding_beyond_a_limit_is_clamped(side):
    robot = preset("strider")
    at_limit = standing().copy()
    at_limit[0, 1] = robot.limits[0, 1, side]
    guard = Guard(robot)
    output = guard.check(at_limit + np.eye(6, 3)[::-1][-1] * 0 + [[0, (2 * side - 1) * 1e-10, 0]] * np.eye(6, 1), TICK)
    assert output.ok
    np.testing.assert_array_equal(output.angles, at_limit)


def test_foot_drag_is_reported_with_its_distance():
    robot = point_feet("strider")
    feet = np.array(
        [stance_feet() + fraction * np.eye(6)[:, 4:5] * [0.005, 0, 0] for fraction in np.linspace(0, 1, 50)]
    )
    distance = np.linalg.norm(feet[:, :, None] - feet[:, None], axis=-1)
    most = np.abs(distance[-1] - distance[0]).max()
    bodies = [
        Pose.from_rpy(0, 0, 0.1 * fraction, (0.01 * fraction, 0.01 * fraction, 0.11))
        for fraction in np.linspace(0, 1, 50)
    ]
    for drag, passes in ((most * 1.001, True), (most * 0.999, False)):
        guard = Guard(robot, bounds=only(robot, foot_drag=drag))
        outputs = [guard.check(feet_at(at, body), TICK, ALL_STANCE) for at, body in zip(feet, bodies, strict=True)]
        assert all(output.ok for output in outputs[:-1])
        assert outputs[-1].ok == passes
    (found,) = outputs[-1].interventions
    assert (found.kind, found.leg) in {("foot_drag", "RM"), ("foot_drag", "RF")}
    assert found.value == pytest.approx(most, rel=1e-9)
    assert found.bound == drag


def test_a_foot_may_change_its_foothold_in_swing():
    robot = preset("strider")
    guard = Guard(robot, bounds=only(robot, foot_drag=1e-3))
    moved = stance_feet() + np.eye(6)[:, 4:5] * [0.03, 0, 0]
    lifted = np.arange(6) != 4
    assert guard.check(feet_at(stance_feet()), TICK, ALL_STANCE).ok
    assert guard.check(feet_at(moved), TICK, lifted).ok
    assert guard.check(feet_at(moved), TICK, ALL_STANCE).ok
    assert kinds_of(guard.check(feet_at(stance_feet()), TICK, ALL_STANCE)) == ["foot_drag"]


def test_without_contacts_foot_drag_is_not_checked():
    robot = preset("strider")
    guard = Guard(robot, bounds=only(robot, foot_drag=1e-3))
    moved = stance_feet() + np.eye(6)[:, 4:5] * [0.03, 0, 0]
    assert guard.check(feet_at(stance_feet()), TICK, ALL_STANCE).ok
    assert guard.check(feet_at(moved), TICK).ok
    assert guard.check(feet_at(stance_feet()), TICK, ALL_STANCE).ok


def test_holding_resets_the_foot_distances():
    robot = preset("strider")
    guard = Guard(robot)
    assert guard.check(feet_at(stance_feet()), TICK, ALL_STANCE).ok
    assert guard.check(NAN, TICK, ALL_STANCE).state == "holding"
    outputs = run(guard, feet_at(stance_feet() + np.eye(6)[:, 4:5] * [0.005, 0, 0]), 30, contacts=ALL_STANCE)
    assert outputs[-1].ok
    assert dict(guard.counts) == {"not_finite": 1}


@pytest.mark.parametrize("with_pose", [True, False])
def test_a_stance_foot_above_the_ground_is_reported(with_pose):
    robot = preset("strider")
    raised = stance_feet() + np.eye(6)[:, 2:3] * [0, 0, 0.03]
    body = Pose() if with_pose else None
    output = Guard(robot, bounds=only(robot, foot_height=0.01)).check(feet_at(raised), TICK, ALL_STANCE, body)
    (found,) = output.interventions
    assert (found.kind, found.leg, found.bound) == ("foot_height", "LR", 0.01)
    if with_pose:
        assert found.value == pytest.approx(0.025)
    else:
        heights = raised[:, 2]
        plane = np.c_[raised[:, :2], np.ones(6)]
        fitted = np.linalg.lstsq(plane, heights, rcond=None)[0]
        normal = math.hypot(*fitted[:2], 1)
        assert found.value == pytest.approx(np.abs(plane @ fitted - heights).max() / normal, rel=1e-9)
    said = np.arange(6) != 2
    assert Guard(robot, bounds=only(robot, foot_height=0.01)).check(feet_at(raised), TICK, said, body).ok


def test_a_slope_beyond_its_bound_is_reported():
    robot = preset("strider")
    sloping = feet_at(stance_feet())
    for slope, attitude, passes in ((0.0, 0.2, False), (0.15, 0.2, False), (0.21, 0.2, True), (0.0, 0.0, True)):
        guard = Guard(robot, bounds=only(robot, foot_height=1e-3, ground_slope=slope))
        output = guard.check(sloping, TICK, ALL_STANCE, Pose.from_rpy(attitude, 0, 0))
        assert kinds_of(output) == ([] if passes else ["foot_height"])


def test_a_single_stance_foot_defines_the_ground():
    robot = preset("strider")
    assert Guard(robot, bounds=only(robot, foot_height=1e-6)).check(standing(), TICK, np.arange(6) == 1).ok


@pytest.mark.parametrize(
    ("angles", "kind", "value"),
    [
        *((invalid, "shape", None) for invalid in INVALID_ANGLES[3:]),
        (NAN, "not_finite", math.nan),
        (np.full((6, 3), -np.inf), "not_finite", -math.inf),
        (np.full((6, 3), 1e308), "joint_limit", 1e308),
        (np.full((6, 3), 1e308, dtype=np.longdouble), "joint_limit", 1e308),
    ],
)
def test_invalid_angles_are_reported(angles, kind, value):
    guard = Guard(preset("strider"), start=standing())
    output = guard.check(angles, TICK)
    assert kinds_of(output)[0] == kind
    assert not output.ok
    np.testing.assert_array_equal(output.angles, standing())
    assert value is None or np.array_equal(output.interventions[0].value, value, equal_nan=True)


@pytest.mark.parametrize("angles", [standing().astype(np.float32), standing().tolist(), np.zeros((6, 3), dtype=int)])
def test_angles_may_have_any_real_type(angles):
    output = Guard(preset("strider")).check(angles, TICK)
    assert output.ok
    assert output.angles.dtype == np.float64
    np.testing.assert_array_equal(output.angles, angles)


def test_outputs_are_read_only():
    guard = Guard(preset("strider"))
    mine = standing().copy()
    output = guard.check(mine, TICK)
    mine += 1.0
    np.testing.assert_array_equal(output.angles, standing())
    with pytest.raises(ValueError, match="read-only"):
        output.angles[0, 0] = 1
    with pytest.raises(TypeError):
        guard.counts["joint_speed"] = 1


@pytest.mark.parametrize("contacts", [[True] * 5, [1, 1, 1, 1, 1, 1], "down", [[True], [False, True]], math.nan])
def test_invalid_contacts_are_reported(contacts):
    guard = Guard(preset("strider"), start=standing())
    assert kinds_of(guard.check(standing(), TICK, contacts)) == ["contacts"]
    assert kinds_of(guard.check(standing(), TICK, [True] * 6)) == []


@pytest.mark.parametrize("body", ["level", np.eye(3), Pose.from_rpy(0, [0.1, 0.2]), 1.0])
def test_an_invalid_body_pose_is_reported(body):
    guard = Guard(preset("strider"), start=standing())
    assert kinds_of(guard.check(standing(), TICK, ALL_STANCE, body)) == ["body_pose"]
    assert kinds_of(guard.check(standing(), TICK, None, body)) == ["body_pose"]
    assert kinds_of(guard.check(standing(), TICK, ALL_STANCE, Pose())) == []
