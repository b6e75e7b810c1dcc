"""The guard: what it passes, how it holds, recovers and sits down, and the bounds that its output always keeps."""

import functools
import gc
import math
import re
import sys
from pathlib import Path
from types import FunctionType, ModuleType

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gait_robots import PRESETS, preset, ring
from sample_robots import random_hexapod
from tarsus.control.safety import Guard, GuardBounds, GuardState, InterventionKind
from tarsus.control.safety.leg_model import LegModel
from tarsus.errors import InputError, UnknownNameError
from tarsus.gait.gait import GAITS, Gait
from tarsus.gait.path import curved_path, straight_path
from tarsus.gait.plan import plan_walk
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stability import stability_margin
from tarsus.kinematics.stance import default_stance
from tarsus.robot.joint_limits import UNKNOWN_SPEED
from tarsus.robot.robot import stack_robots

TICK = 0.01
# Tolerance of a sent angle [rad].
ROUNDING = 1e-11
ALL_STANCE = np.ones(6, dtype=bool)
NAN = np.full((6, 3), np.nan)


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


def kinds_of(outputs):
    return [found.kind for found in outputs.interventions]


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


# Valid commands.


@pytest.mark.parametrize("gait", GAITS)
@pytest.mark.parametrize("name", PRESETS)
def test_a_valid_walk_passes_unchanged(name, gait):
    motion = walk(name, gait)
    guard = Guard(preset(name))
    for i, angles in enumerate(motion.angles):
        outputs = guard.check(angles, TICK, motion.contacts[i], motion.body[i])
        assert outputs.ok
        assert outputs.interventions == ()
        assert outputs.angles.tobytes() == angles.tobytes()
    assert dict(guard.counts) == {}
    assert guard.log == ()
    assert guard.summary() == f"0 interventions in {guard.time:.2f} s, state: passing"
    assert guard.time == pytest.approx(len(motion.time) * TICK)


@pytest.mark.parametrize("name", ["strider", "phantomx"])
def test_a_curved_walk_with_irregular_time_steps_passes_without_a_body_pose(name):
    motion = walk(name, "ripple", True)
    rng = np.random.default_rng(1)
    indices = np.cumsum(rng.integers(1, 6, len(motion.time)))
    indices = indices[indices < len(motion.time)]
    guard = Guard(preset(name))
    for before, i in zip(np.r_[indices[0] - 1, indices], indices, strict=False):
        outputs = guard.check(motion.angles[i], (i - before) * TICK, motion.contacts[i])
        assert outputs.interventions == ()
        assert outputs.angles.tobytes() == motion.angles[i].tobytes()


def test_a_second_guard_passes_the_output_of_the_first():
    rng = np.random.default_rng(2)
    first = Guard(preset("strider"))
    second = Guard(preset("strider"), start=first.check(NAN, TICK).angles)
    limits = preset("strider").limits
    for tick in range(300):
        wanted = rng.uniform(limits[..., 0], limits[..., 1]) if tick % 20 == 0 else standing()
        sent = first.check(wanted, TICK).angles
        assert second.check(sent, TICK).angles.tobytes() == sent.tobytes()
    assert dict(second.counts) == {}
    assert first.counts


# Bounds of the output for any input.

INVALID_ANGLES = (
    NAN,
    np.full((6, 3), np.inf),
    np.full((6, 3), 1e308),
    "x",
    None,
    [[1.0], [2.0, 3.0]],
    {},
    np.zeros((6, 2)),
)
INVALID_ANGLES += (
    np.zeros((6, 3), dtype=complex),
    np.zeros((6, 3), dtype=bool),
    [10**400] * 3,
    object(),
    np.zeros((2, 6, 3)),
)
STEPS = st.one_of(
    st.just(TICK),
    st.just(TICK),
    st.floats(0.001, 0.05),
    st.floats(0.0, 10.0),
    st.floats(0.0, 2e-4),
    st.floats(),
    st.sampled_from(["0.01", None, [], np.float32(0.02), 10**400, True]),
)
COMMANDS = ("walk", "anywhere", "beyond", "nearby", "to a limit", "straight on", "invalid", "held")
CONTACTS = ("none", "all", "walk", "random", "invalid")
SEGMENTS = st.lists(
    st.tuples(
        st.sampled_from(COMMANDS),
        st.integers(1, 30),
        STEPS,
        st.sampled_from(CONTACTS),
        st.floats(0, 1),
        st.integers(0, 2**32 - 1),
    ),
    min_size=1,
    max_size=12,
)


def command_of(kind, fraction, rng, motion, tick, outputs):
    limits = motion.robot.limits
    low, high = limits[..., 0], limits[..., 1]
    last = motion.angles[0] if not outputs else outputs[-1].angles
    before = last if len(outputs) < 2 else outputs[-2].angles
    match kind:
        case "walk":
            return motion.angles[tick % len(motion.time)]
        case "anywhere":
            return rng.uniform(low, high)
        case "beyond":
            return rng.uniform(low - fraction, high + fraction)
        case "nearby":
            return last + rng.normal(size=last.shape) * 10 ** (-6 * fraction)
        case "to a limit":
            return np.clip(last + 0.12 * fraction * rng.choice([-1, 1], (6, 1)), low, high)
        case "straight on":
            return 2 * last - before
        case "held":
            return last
    return INVALID_ANGLES[rng.integers(len(INVALID_ANGLES))]


def contacts_of(kind, rng, motion, tick):
    match kind:
        case "none":
            return None
        case "all":
            return ALL_STANCE
        case "walk":
            return motion.contacts[tick % len(motion.time)]
        case "random":
            return rng.random(6) < 0.8
    return [np.ones(5, dtype=bool), np.ones(6), "down", [[True], [False, True]], object()][rng.integers(5)]


BODIES = (None, Pose(), Pose.from_rpy(0.1, 0.2, 3.0), Pose.from_rpy(0.0, [0.1, 0.2]), "level", np.eye(3))


@settings(max_examples=150)
@given(SEGMENTS, st.sampled_from(["hold", "sit"]), st.sampled_from(["near", "reset"]), st.sampled_from(PRESETS))
def test_the_output_keeps_all_bounds_for_any_input(segments, policy, recover, name):
    motion = walk(name)
    bounds = GuardBounds.of(preset(name), sit_delay=0.05, sit_speed=0.1)
    guard = Guard(preset(name), bounds=bounds, policy=policy, recover=recover, log_size=5)
    outputs = []
    tick = 0
    for kind, ticks, dt, contact_kind, fraction, seed in segments:
        rng = np.random.default_rng(seed)
        for _ in range(ticks):
            angles = command_of(kind, fraction, rng, motion, tick, outputs)
            body = BODIES[rng.integers(len(BODIES))] if contact_kind in ("random", "invalid") else None
            outputs.append(guard.check(angles, dt, contacts_of(contact_kind, rng, motion, tick), body))
            tick += 1
        if seed % 3 == 0:
            guard.reset()
    check_bounds(bounds, outputs)
    assert set(guard.counts) <= set(InterventionKind)
    assert len(guard.log) == min(sum(guard.counts.values()), 5)
    assert guard.summary()


@given(st.lists(st.floats(1e-4, 0.3), min_size=5, max_size=40), st.floats(0.05, 1), st.booleans())
def test_a_joint_moving_towards_its_limit_always_stops_before_it(steps, fraction, upward):
    """At the greatest speed that passes towards a limit, then NaN at irregular time steps."""
    robot = ring(6)
    bounds = GuardBounds.of(robot, acceleration=20.0)
    guard = Guard(robot, bounds=bounds, start=np.zeros((6, 3)))
    limit = robot.limits[..., int(upward)]
    outputs = [guard.check(np.zeros((6, 3)), TICK)]
    for number in range(400):
        reach = fraction * (number + 1) ** 2 / 2 * 20.0 * TICK**2
        outputs.append(guard.check(np.clip(reach * np.sign(limit), robot.limits[..., 0], robot.limits[..., 1]), TICK))
        if not outputs[-1].ok:
            break
    assert not outputs[-1].ok
    outputs += [guard.check(NAN, dt) for dt in steps]
    outputs += run(guard, NAN, 50)
    check_bounds(bounds, outputs)
    np.testing.assert_array_equal(outputs[-1].angles, outputs[-2].angles)


def test_the_guard_is_deterministic():
    def stream():
        guard = Guard(preset("strider"), policy="sit")
        rng = np.random.default_rng(3)
        outputs = []
        for i in range(400):
            corrupted = standing() + rng.normal(size=(6, 3)) * (0.3 if i % 50 == 0 else 1e-4)
            outputs.append(guard.check(corrupted, rng.uniform(0.005, 0.02), rng.random(6) < 0.9))
        return np.array([output.angles for output in outputs]).tobytes(), guard.summary()

    assert stream() == stream()


def deep_size(thing):
    """Size of an object and of all that it refers to, without code [bytes]."""
    seen, waiting, total = set(), [thing], 0
    while waiting:
        one = waiting.pop()
        if id(one) not in seen and not isinstance(one, type | ModuleType | FunctionType):
            seen.add(id(one))
            total += sys.getsizeof(one)
            waiting += gc.get_referents(one)
    return total


def test_memory_is_bounded():
    guard = Guard(preset("strider"), log_size=20)
    rng = np.random.default_rng(4)

    def stream(ticks):
        for i in range(ticks):
            corrupted = INVALID_ANGLES[i % len(INVALID_ANGLES)] if i % 3 else standing() + rng.normal(size=(6, 3))
            guard.check(corrupted, TICK, rng.random(6) < 0.5)

    stream(1000)
    before = deep_size(guard)
    stream(1500)
    assert len(guard.log) == 20
    assert sum(guard.counts.values()) > 500
    assert deep_size(guard) == pytest.approx(before, rel=0.04)


# Each check against an independent computation.


def only(robot, **changes):
    """Bounds of which only the changed ones can be violated."""
    wide = {"speed": 1e6, "acceleration": 1e12, "margin": -math.inf, "foot_drag": math.inf, "foot_height": math.inf}
    return GuardBounds.of(robot, **{**wide, **changes})


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
    """Feet of legs that fraction one mount and heading: three of them in one place, or on one line through B."""
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
    outputs = guard.check(at_limit + np.eye(6, 3)[::-1][-1] * 0 + [[0, (2 * side - 1) * 1e-10, 0]] * np.eye(6, 1), TICK)
    assert outputs.ok
    np.testing.assert_array_equal(outputs.angles, at_limit)


def feet_at(feet, body=None):
    """Joint angles of the strider for feet in G, by default at a body height of 110 mm."""
    body = Pose((np.eye(3)), (0, 0, 0.11)) if body is None else body
    return inverse_kinematics(preset("strider"), feet, body).require().angles


def stance_feet():
    return default_stance(preset("strider")) * [1, 1, 0]


def test_foot_drag_is_reported_with_its_distance_feet():
    robot = preset("strider")
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
    outputs = Guard(robot, bounds=only(robot, foot_height=0.01)).check(feet_at(raised), TICK, ALL_STANCE, body)
    (found,) = outputs.interventions
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
        outputs = guard.check(sloping, TICK, ALL_STANCE, Pose.from_rpy(attitude, 0, 0))
        assert kinds_of(outputs) == ([] if passes else ["foot_height"])


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
    outputs = guard.check(angles, TICK)
    assert kinds_of(outputs)[0] == kind
    assert not outputs.ok
    np.testing.assert_array_equal(outputs.angles, standing())
    assert value is None or np.array_equal(outputs.interventions[0].value, value, equal_nan=True)


@pytest.mark.parametrize("angles", [standing().astype(np.float32), standing().tolist(), np.zeros((6, 3), dtype=int)])
def test_angles_may_have_any_real_type(angles):
    outputs = Guard(preset("strider")).check(angles, TICK)
    assert outputs.ok
    assert outputs.angles.dtype == np.float64
    np.testing.assert_array_equal(outputs.angles, angles)


def test_outputs_are_read_only():
    guard = Guard(preset("strider"))
    mine = standing().copy()
    outputs = guard.check(mine, TICK)
    mine += 1.0
    np.testing.assert_array_equal(outputs.angles, standing())
    with pytest.raises(ValueError, match="read-only"):
        outputs.angles[0, 0] = 1
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


# Time steps.


@pytest.mark.parametrize("dt", [math.nan, -0.01, 0.0, math.inf, 1e9, "0.01", None, [], 10**400])
def test_an_invalid_time_step_stops_the_clock(dt):
    guard = Guard(preset("strider"), start=standing())
    before = guard.check(standing() + 1e-3, TICK)
    outputs = guard.check(standing() + 2e-3, dt)
    assert kinds_of(outputs) == ["time_step"]
    assert outputs.time == before.time
    np.testing.assert_array_equal(outputs.angles, before.angles)
    assert outputs.state == "holding"
    assert guard.check(standing() + 2e-3, dt).state == "holding"


def test_short_time_steps_accumulate():
    guard = Guard(preset("strider"), start=standing())
    moving = [guard.check(standing() + 3e-3 * tick**2, TICK) for tick in range(1, 5)][-1]
    assert moving.ok
    outputs = [guard.check(NAN, 3e-5) for _ in range(4)]
    assert [output.time - moving.time > 0 for output in outputs] == [False, False, False, True]
    assert outputs[3].time - moving.time == pytest.approx(1.2e-4)
    assert (outputs[2].angles == moving.angles).all()
    assert (outputs[3].angles > moving.angles).all()
    assert {kind for output in outputs for kind in kinds_of(output)} == {"not_finite", "time_step"}


def test_accumulated_time_adds_to_the_next_step():
    guard = Guard(preset("strider"), start=standing())
    for _ in range(2):
        guard.check(standing(), 3e-5)
    assert guard.check(standing(), TICK).time == pytest.approx(TICK + 6e-5)


def test_a_time_gap_holds_the_robot():
    guard = Guard(preset("strider"), start=standing())
    for fraction in range(1, 5):
        moving = guard.check(standing() + 1e-3 * fraction**2, TICK)
    assert moving.ok
    outputs = guard.check(standing() + 0.016, 0.5)
    assert (kinds_of(outputs), outputs.state) == (["time_gap"], "holding")
    (found,) = outputs.interventions
    assert (found.value, found.bound) == (0.5, 0.1)
    np.testing.assert_array_equal(outputs.angles, moving.angles)
    # The length of the gap does not allow a sudden start.
    after = guard.check(standing() + 0.05, TICK)
    assert after.state == "recovering"
    assert 0 < np.abs(after.angles - outputs.angles).max() <= guard.bounds.acceleration.max() * TICK**2 / 2 + ROUNDING


def test_joints_brake_through_a_short_time_gap():
    robot = preset("strider")
    bounds = GuardBounds.of(robot, acceleration=2.0)
    guard = Guard(robot, bounds=bounds, start=standing())
    outputs = [guard.check(standing() + 1e-4 * tick**2 * 0.9, TICK) for tick in range(1, 40)]
    assert outputs[-1].ok
    outputs.append(guard.check(NAN, 0.11))
    assert (outputs[-1].angles > outputs[-2].angles).all()
    outputs += run(guard, NAN, 40)
    check_bounds(bounds, outputs)


# Holding and recovering.


def with_glitch(guard, motion, start, ticks, corrupted=NAN):
    """A walk with some corrupted ticks."""
    return [
        guard.check(
            corrupted if start <= i < start + ticks else motion.angles[i], TICK, motion.contacts[i], motion.body[i]
        )
        for i in range(len(motion.time))
    ]


@pytest.mark.parametrize("ticks", [1, 2, 3])
def test_the_guard_recovers_from_a_glitch(ticks):
    motion = walk("strider")
    guard = Guard(preset("strider"))
    outputs = with_glitch(guard, motion, 100, ticks, standing() + 0.3)
    check_bounds(guard.bounds, outputs)
    states = [output.state for output in outputs]
    assert states[:100] == ["passing"] * 100
    assert states[100 : 100 + ticks] == ["holding"] * ticks
    back = states.index("passing", 100)
    assert 100 + ticks < back < 100 + ticks + 15
    assert set(states[100 + ticks : back]) == {"recovering"}
    assert states[back:] == ["passing"] * (len(states) - back)
    assert outputs[back].angles.tobytes() == motion.angles[back].tobytes()
    assert sum(guard.counts.values()) == len(guard.log) == len({output.kind for output in guard.log})
    assert "state: passing" in guard.summary()


def test_with_recover_reset_it_waits_for_a_reset():
    motion = walk("strider")
    guard = Guard(preset("strider"), recover="reset")
    outputs = with_glitch(guard, motion, 100, 1)
    assert {output.state for output in outputs[100:]} == {"holding"}
    guard.check(NAN, TICK)
    guard.reset()
    after = run(guard, motion.angles[-1], 200)
    assert after[0].state == "recovering"
    assert after[-1].ok
    check_bounds(guard.bounds, outputs + after)
    # A reset applies only to the current hold.
    guard.reset()
    assert {output.state for output in [guard.check(NAN, TICK), *run(guard, motion.angles[-1], 50)]} == {"holding"}


def test_a_reset_recovers_over_any_distance_at_the_recovery_speed():
    robot = preset("strider")
    guard = Guard(robot, start=standing())
    far = standing() + 0.4
    assert {output.state for output in run(guard, far, 50)} == {"holding"}
    assert guard.counts["command_distance"] == 1
    guard.reset()
    outputs = run(guard, far, 100)
    assert {output.state for output in outputs} == {"recovering", "passing"}
    check_bounds(guard.bounds, outputs)
    speed = np.abs(np.diff([output.angles for output in outputs], axis=0)) / TICK
    slow = guard.bounds.recovery_speed * guard.bounds.speed
    assert (speed <= slow * (1 + 1e-9)).all()
    assert speed.max() > slow.max() * 0.99


def test_a_violation_while_recovering_cancels_the_reset():
    guard = Guard(preset("strider"), start=standing())
    run(guard, standing() + 0.4, 5)
    guard.reset()
    assert guard.check(standing() + 0.4, TICK).state == "recovering"
    assert guard.check(NAN, TICK).state == "holding"
    assert guard.check(standing() + 0.4, TICK).state == "holding"


def test_recovery_ends_when_the_command_moves_too_far_away():
    guard = Guard(preset("strider"), start=standing())
    guard.check(NAN, TICK)
    near, on_the_way, far = (guard.check(standing() + distance, TICK) for distance in (0.09, 0.18, 0.25))
    assert [near.state, on_the_way.state, far.state] == ["recovering", "recovering", "holding"]
    (found,) = far.interventions
    assert (found.kind, found.bound) == ("command_distance", 2 * guard.bounds.recovery_distance)
    assert found.value == pytest.approx(0.25 - (on_the_way.angles - standing()).min())


def test_a_zero_time_step_while_recovering_holds():
    guard = Guard(preset("strider"), start=standing())
    guard.check(NAN, TICK)
    assert guard.check(standing() + 0.05, TICK).state == "recovering"
    assert guard.check(standing() + 0.05, 0.0).state == "holding"


@pytest.mark.parametrize("seed", range(10))
def test_it_recovers_to_a_fast_command_that_stops_at_a_limit(seed):
    """Speed, braking distance and limit are all reached."""
    rng = np.random.default_rng(seed)
    robot = ring(6, limits=np.stack([np.full((6, 3), -1.0), rng.uniform(0.5, 1.0, (6, 3))], axis=-1))
    high = robot.limits[..., 1]
    guard = Guard(robot, bounds=GuardBounds.of(robot, recovery_distance=3.0), start=np.zeros((6, 3)))
    outputs = [guard.check(NAN, TICK)]
    reached = rng.uniform(0.0, 0.1, (6, 3))
    for _ in range(60):
        reached = np.minimum(reached + rng.uniform(0.03, 0.05, (6, 3)), high)
        outputs.append(guard.check(reached, TICK))
    assert {output.state for output in outputs[1:10]} == {"recovering"}
    assert outputs[-1].ok
    check_bounds(guard.bounds, outputs)
    speed = np.diff([output.angles for output in outputs], axis=0) / TICK
    assert speed.max() == pytest.approx(UNKNOWN_SPEED)


@pytest.mark.parametrize("seed", range(10))
def test_recovery_stays_within_limits_despite_rounding(seed):
    """Limits near zero, where a step to the limit is inexact; one joint far away keeps the guard recovering."""
    rng = np.random.default_rng(seed)
    limits = np.array([-1.0, 1.0]) * np.concatenate([rng.uniform(0, 2e-3, 17), [1.0]]).reshape(6, 3, 1)
    robot = ring(6, limits=limits)
    guard = Guard(robot, bounds=GuardBounds.of(robot, recovery_distance=3.0, acceleration=1e4), start=np.zeros((6, 3)))
    side = rng.choice([-1, 1], (60, 6, 3))
    side[:, 5, 2] = 1
    outputs = [guard.check(NAN, TICK)]
    for towards in np.repeat(side, 4, axis=0)[:60]:
        outputs.append(guard.check(limits[..., 1] * towards, rng.uniform(0.003, 0.02)))
    assert {output.state for output in outputs[1:30]} == {"recovering"}
    check_bounds(guard.bounds, outputs)


def test_a_lasting_intervention_counts_once():
    guard = Guard(preset("strider"), start=standing())
    run(guard, NAN, 10)
    assert dict(guard.counts) == {"not_finite": 1}
    run(guard, standing(), 10)
    run(guard, NAN, 10)
    assert dict(guard.counts) == {"not_finite": 2}
    assert [output.time for output in guard.log] == pytest.approx([0.01, 0.21])


def test_the_log_is_bounded_and_the_summary_shows_the_worst():
    guard = Guard(preset("strider"), start=standing(), log_size=3)
    for size in (0.3, 0.5, 0.4, 0.2, 0.6):
        guard.check(standing() + size * np.eye(6, 3), TICK)
        run(guard, standing(), 30)
        assert guard.state == "passing"
    assert guard.counts["joint_speed"] == 5
    assert len(guard.log) == 3
    lines = guard.summary().splitlines()
    assert lines[0] == f"{sum(guard.counts.values())} interventions in {guard.time:.2f} s, state: passing"
    speed = preset("strider").servos[0][0].no_load_speed
    worst = (
        rf"  5 x \w\w (coxa|femur|tibia): joint speed {np.rad2deg(60):.4g} deg/s, "
        rf"bound {np.rad2deg(speed):.4g} deg/s, at 1.250 s"
    )
    assert [line for line in lines if re.fullmatch(worst, line)]


def test_intervention_texts():
    guard = Guard(preset("strider"), start=standing())
    guard.check(NAN, TICK)
    assert guard.log[-1].text() == "LF coxa: non-finite joint angle, at 0.010 s"
    guard.check(np.zeros(4), TICK)
    assert guard.log[-1].text() == "joint angle array 4 values, bound 18 values, at 0.020 s"
    guard.check(standing(), TICK, ~ALL_STANCE)
    assert guard.log[-1].text() == "stability margin -inf mm, bound 0 mm, at 0.030 s"
    assert guard.summary().startswith("3 interventions in 0.03 s, state: holding\n")


# Start.


def test_the_first_valid_command_sets_the_start():
    guard = Guard(preset("strider"))
    assert guard.check(standing() + 0.2, TICK).ok
    assert guard.check(standing(), TICK).state == "holding"


def test_a_given_start_is_used():
    guard = Guard(preset("strider"), start=standing() + 0.2)
    outputs = guard.check(standing(), TICK)
    assert outputs.state == "holding"
    np.testing.assert_array_equal(outputs.angles, standing() + 0.2)


@pytest.mark.parametrize("dt", [TICK, math.nan])
@pytest.mark.parametrize("name", PRESETS)
def test_an_invalid_first_command_starts_in_the_default_stance(name, dt):
    guard = Guard(preset(name))
    outputs = guard.check(NAN, dt)
    assert outputs.state == "holding"
    np.testing.assert_array_equal(outputs.angles, standing(name))
    assert run(guard, standing(name), 5)[-1].ok


def test_with_a_stance_beyond_the_limits_it_starts_near_zero_angles():
    robot = preset("strider")
    limits = np.tile([[0.3, 0.5], [-0.5, 0.5], [-0.5, -0.2]], (6, 1, 1))
    guard = Guard(robot, bounds=GuardBounds.of(robot, limits=limits))
    np.testing.assert_array_equal(guard.check(NAN, TICK).angles, np.tile([0.3, 0.0, -0.2], (6, 1)))


def test_without_a_stance_it_starts_near_zero_angles():
    robot = ring(6, limits=np.broadcast_to([[-0.1, 0.1], [1.0, 1.5], [0.0, 0.2]], (6, 3, 2)))
    guard = Guard(robot)
    np.testing.assert_array_equal(guard.check(NAN, TICK).angles, np.tile([0.0, 1.0, 0.0], (6, 1)))


# Sitting down.


def sit(name, index, *, attitude=True, ticks=1200, **changes):
    """Hold a robot during a walk until it sits down; return the guard, all outputs, and those while sitting."""
    motion = walk(name)
    guard = Guard(preset(name), policy="sit", bounds=GuardBounds.of(preset(name), **changes))
    for i in range(index + 1):
        body = motion.body[i] if attitude else None
        assert guard.check(motion.angles[i], TICK, motion.contacts[i], body).ok
    outputs = run(guard, NAN, ticks)
    check_bounds(guard.bounds, outputs)
    return guard, outputs, [output for output in outputs if output.state == "sitting"]


@pytest.mark.parametrize("index", [0, 60])
@pytest.mark.parametrize("name", PRESETS)
def test_it_sits_down_with_stationary_feet(name, index):
    robot, motion = preset(name), walk(name)
    guard, outputs, sitting = sit(name, index)
    wait = guard.bounds.sit_delay / TICK
    assert wait - 2 < [output.state for output in outputs].index("sitting") < wait + 20
    assert outputs[-1].state == "holding"
    np.testing.assert_array_equal(outputs[-1].angles, outputs[-2].angles)
    points = forward_kinematics(robot, np.array([output.angles for output in sitting]))
    feet, down = points[..., 3, :], motion.contacts[index]
    assert np.ptp(feet[..., :2], axis=0).max() < 1e-5
    assert np.ptp(feet[:, down, 2] - feet[:1, down, 2], axis=1).max() < 1e-5
    assert (np.diff(feet[:, down, 2], axis=0) >= -1e-6).all()
    assert np.ptp(feet[-1, :, 2]) < 2e-3  # swing feet are set down
    belly = robot.mount_position[:, 2].min() if robot.body_size is None else -robot.body_size[2] / 2
    lowest = min(belly, points[-1, :, :3, 2].min()) - feet[-1, :, 2].mean()
    assert lowest == pytest.approx(guard.bounds.sit_height, abs=1e-3)
    lowering = np.diff(feet[:, down, 2].mean(-1)) / TICK
    assert lowering.max() < guard.bounds.sit_speed + 1e-3


def test_it_sits_down_within_the_recovery_speed():
    guard, _, sitting = sit("strider", 0, sit_speed=2.0)
    speed = np.abs(np.diff([output.angles for output in sitting], axis=0)) / TICK
    assert (speed <= guard.bounds.recovery_speed * guard.bounds.speed * (1 + 1e-9)).all()
    assert speed.max() > 0.5


def test_it_sits_down_along_the_vertical_of_a_tilted_body():
    robot = preset("strider")
    body = Pose.from_rpy(0.05, -0.08, 0.3, (0, 0, 0.11))
    guard = Guard(robot, policy="sit")
    feet = Pose.from_rpy(0, 0, 0.3) @ stance_feet()
    assert guard.check(feet_at(feet, body), TICK, ALL_STANCE, body).ok
    outputs = run(guard, NAN, 1000)
    moved = (forward_kinematics(robot, outputs[-1].angles) - forward_kinematics(robot, outputs[0].angles))[:, 3]
    up = body.rotation[2]
    np.testing.assert_allclose(moved, (moved @ up)[:, None] * up, atol=1e-5)
    assert (moved @ up).min() > 0.02


def test_sitting_down_ends_at_a_joint_limit():
    robot = preset("strider")
    limits = np.array(robot.limits)
    limits[2, 1, 1] = standing()[2, 1] + 0.1
    _, outputs, sitting = sit("strider", 0, limits=limits)
    assert sitting
    assert outputs[-1].state == "holding"
    assert 0 <= limits[2, 1, 1] - outputs[-1].angles[2, 1] < 0.02


def test_a_foot_that_cannot_be_set_down_keeps_its_height():
    robot, motion = preset("strider"), walk("strider")
    limits = np.array(robot.limits)
    limits[:, 1, 0] = motion.angles[:, :, 1].min() - 0.02
    air = ~motion.contacts[60]
    limits[air, 1, 0] = motion.angles[60][air, 1] - 0.005
    guard = Guard(robot, policy="sit", bounds=GuardBounds.of(robot, limits=limits))
    assert guard.check(motion.angles[60], TICK, motion.contacts[60], motion.body[60]).ok
    outputs = run(guard, NAN, 800)
    before, after = (forward_kinematics(robot, output.angles)[:, 3, 2] for output in (outputs[0], outputs[-1]))
    np.testing.assert_allclose(np.ptp(after - before), 0, atol=5e-3)
    assert (after - before).min() > 0.02


def test_a_straight_leg_cannot_sit_down():
    robot = ring(6, tibia=np.full(6, 0.3), limits=np.broadcast_to([-3.0, 3.0], (6, 3, 2)))
    straight = np.tile([0.0, -0.7, 0.0], (6, 1))
    guard = Guard(robot, policy="sit", start=straight)
    outputs = run(guard, NAN, 200)
    assert guard.state == "holding"
    assert any(output.state == "sitting" for output in outputs)
    np.testing.assert_array_equal(outputs[-1].angles, straight)


def test_a_singular_leg_cannot_sit_down():
    robot = ring(6, mount_yaw=np.arange(6) * np.pi / 3, limits=np.broadcast_to([-3.0, 3.0], (6, 3, 2)))
    angles = np.tile([0.0, 0.4, -1.2], (6, 1))
    angles[0] = 0
    guard = Guard(robot, policy="sit", bounds=only(robot, sit_delay=0.1))
    assert guard.check(angles, TICK, np.arange(6) > 0).ok
    assert (run(guard, NAN, 50)[-1].angles == angles).all()


def test_without_stance_feet_it_does_not_sit_down():
    robot = preset("strider")
    guard = Guard(robot, policy="sit", bounds=only(robot, sit_delay=0.1))
    assert guard.check(standing(), TICK, ~ALL_STANCE).ok
    outputs = run(guard, NAN, 50)
    assert outputs[-1].state == "holding"
    np.testing.assert_array_equal(outputs[-1].angles, standing())


def test_without_contacts_all_feet_count_as_stance_feet():
    robot = preset("strider")
    guard = Guard(robot, policy="sit", start=standing())
    outputs = run(guard, NAN, 700)
    moved = (forward_kinematics(robot, outputs[-1].angles) - forward_kinematics(robot, standing()))[:, 3]
    np.testing.assert_allclose(moved, [[0, 0, moved[0, 2]]] * 6, atol=1e-5)
    assert moved[0, 2] > 0.05


def test_it_recovers_from_sitting_down():
    guard, outputs, sitting = sit("strider", 0, ticks=150)
    assert sitting
    assert guard.state == "sitting"
    outputs += run(guard, outputs[-1].angles, 30)
    assert outputs[-1].ok
    outputs += run(guard, NAN, 20)
    assert outputs[-1].state == "holding"
    outputs += run(guard, NAN, 1000)
    again = [output.state for output in outputs[200:]]
    assert "sitting" in again
    assert again[-1] == "holding"
    outputs += run(guard, outputs[-1].angles, 30)
    assert outputs[-1].ok
    guard.reset()
    outputs += [guard.check(NAN, TICK)]
    guard.reset()
    outputs += run(guard, standing(), 300)
    assert outputs[-1].ok
    outputs += run(guard, NAN, 200)
    assert outputs[-1].state == "sitting"
    check_bounds(guard.bounds, outputs)


def test_a_time_gap_interrupts_sitting_down():
    guard, outputs, _ = sit("strider", 0, ticks=150)
    outputs.append(guard.check(NAN, 0.3))
    assert outputs[-1].state == "holding"
    outputs += run(guard, NAN, 800)
    states = [output.state for output in outputs[151:]]
    assert "sitting" in states
    assert states[-1] == "holding"
    check_bounds(guard.bounds, outputs)


# Bounds and arguments.


def test_default_bounds_come_from_the_robot():
    robot = preset("strider")
    bounds = GuardBounds.of(robot)
    np.testing.assert_array_equal(bounds.limits, robot.limits)
    np.testing.assert_array_equal(bounds.speed, [[servo.no_load_speed for servo in leg] for leg in robot.servos])
    np.testing.assert_allclose(bounds.acceleration, bounds.speed / 0.05)
    assert bounds.assumptions == ()
    assert not bounds.limits.flags.writeable
    assert not bounds.speed.flags.writeable


def test_unknown_speeds_are_assumed_and_listed():
    bounds = GuardBounds.of(ring(6))
    assert (bounds.speed == UNKNOWN_SPEED).all()
    assert bounds.assumptions == ("joint speed 5 rad/s for 18 joints: servo speed unknown",)
    given_speed = GuardBounds.of(ring(6), speed=[1.0, 2.0, 3.0])
    assert given_speed.assumptions == ()
    np.testing.assert_allclose(given_speed.acceleration, np.tile([20.0, 40.0, 60.0], (6, 1)))
    assert (GuardBounds.of(ring(6), acceleration=7).acceleration == 7).all()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"speed": 0}, "guard bound speed is 0; it must be greater than 0"),
        ({"speed": np.ones(4)}, r"guard bound speed has shape \(4,\); expected a number or \(6, 3\)"),
        ({"speed": "fast"}, "guard bound speed must be an array of numbers"),
        ({"acceleration": math.nan}, "guard bound acceleration contains a value that is not a finite number"),
        ({"limits": np.zeros((6, 3))}, r"guard bound limits has shape \(6, 3\); expected \(legs, 3, 2\)"),
        ({"limits": np.tile([1.0, 0.0], (6, 3, 1))}, "a lower limit is greater than its upper limit"),
        ({"limits": np.zeros((5, 3, 2)), "speed": 1, "acceleration": 1}, "guard bound limits is for 5 legs"),
        ({"margin": math.nan}, "guard bound margin is nan"),
        ({"margin": None}, "guard bound margin is None; it must be a number"),
        ({"foot_drag": 0}, "guard bound foot_drag is 0; it must be greater than 0 and at most inf"),
        ({"ground_slope": 2}, "guard bound ground_slope is 2; it must be at least 0 and at most 1.5708"),
        ({"recovery_distance": math.nan}, "guard bound recovery_distance is nan"),
        ({"max_time_step": 1e-5}, "max_time_step is 1e-05 s; it must be at least min_time_step, 0.0001 s"),
    ],
)
def test_invalid_bounds_are_rejected(changes, message):
    with pytest.raises(InputError, match=message):
        GuardBounds.of(ring(6), **changes)


def test_invalid_arguments_are_rejected():
    robot = preset("strider")
    with pytest.raises(UnknownNameError, match=r"no policy is called 'sti'\. Did you mean 'sit'"):
        Guard(robot, policy="sti")
    with pytest.raises(UnknownNameError, match="no recovery is called 'never'"):
        Guard(robot, recover="never")
    with pytest.raises(InputError, match="is a batch of"):
        Guard(stack_robots([robot, robot]))
    with pytest.raises(InputError, match="the bounds are for 8 legs; 'strider' has 6"):
        Guard(robot, bounds=GuardBounds.of(ring(8)))
    with pytest.raises(InputError, match="the bounds are for 6 legs; 'strider' has 6"):
        Guard(stack_robots([robot, robot]), bounds=GuardBounds.of(robot))
    with pytest.raises(InputError, match="log_size is 0"):
        Guard(robot, log_size=0)
    with pytest.raises(InputError, match=r"start must be .*: joint angle array 9 values"):
        Guard(robot, start=np.zeros((3, 3)))
    with pytest.raises(InputError, match=r"start must be .*LF tibia: joint angle 5730 deg"):
        Guard(robot, start=np.full((6, 3), 100.0))


@pytest.mark.parametrize("legs", [4, 5, 8, 10])
def test_it_works_with_any_number_of_legs(legs):
    robot = ring(legs)
    angles = np.tile([0.0, 0.4, -1.2], (legs, 1))
    guard = Guard(robot, policy="sit", bounds=GuardBounds.of(robot, sit_delay=0.05))
    assert guard.check(angles, TICK, np.ones(legs, dtype=bool), Pose()).ok
    outputs = run(guard, NAN, 800)
    assert kinds_of(outputs[0]) == ["shape"]
    check_bounds(guard.bounds, outputs)
    assert any(output.state == "sitting" for output in outputs)


# Documentation.

PAGE = (Path(__file__).parents[1] / "docs" / "guard.md").read_text(encoding="utf-8")


def test_the_page_lists_every_kind_state_and_bound():
    tables = [re.findall(r"^\| `(\w+)` \|", section, flags=re.MULTILINE) for section in PAGE.split("\n## ")]
    kinds, states, bounds = (table for table in tables if table)
    assert kinds == list(InterventionKind)
    assert states == list(GuardState)
    assert set(bounds) == set(GuardBounds.__dataclass_fields__) - {"assumptions"}


def test_the_example_of_the_page_runs(capsys):
    (example,) = re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)
    exec(example, {})
    printed = capsys.readouterr().out
    (shown,) = re.findall(r"```text\n(.*?)```", PAGE, flags=re.DOTALL)
    assert printed == shown


def test_the_leg_model_equals_the_kinematics():
    rng = np.random.default_rng(9)
    for _ in range(20):
        robot = random_hexapod(rng)
        angles = rng.uniform(-3, 3, (6, 3))
        feet, com = LegModel(robot).points(angles.ravel().tolist())
        np.testing.assert_allclose(feet, forward_kinematics(robot, angles)[:, 3], rtol=0, atol=1e-15)
        np.testing.assert_allclose(com, centre_of_mass(robot, angles), rtol=0, atol=1e-15)
