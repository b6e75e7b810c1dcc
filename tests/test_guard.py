"""The guard: what it lets through, what it does else, and what it never does, whatever it is given."""

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
from tarsus.control.safety.guard import Guard, GuardBounds
from tarsus.control.safety.interventions import KINDS
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
# What rounding may add to an angle [rad].
ROUNDING = 1e-11
DOWN = np.ones(6, dtype=bool)
NAN = np.full((6, 3), np.nan)


@functools.cache
def walk(name, gait="tripod", curved=False):
    """A walk of a preset, in which no joint is faster than the guard assumes of servos that it doesn't know."""
    robot = preset(name)
    unknown = any(servo is None or servo.no_load_speed is None for leg in robot.servos for servo in leg)
    path = curved_path(0.5, (0.1, 0.4)) if curved else straight_path(0.25)
    return plan_walk(robot, Gait.named(gait), path, cycle_time=4.5 if unknown else None)


@functools.cache
def standing(name="strider"):
    robot = preset(name)
    return inverse_kinematics(robot, default_stance(robot)).require().angles


def kinds(told):
    return [found.kind for found in told.interventions]


def run(guard, angles, ticks, **given_with):
    """Command the same angles for some ticks."""
    return [guard.check(angles, TICK, **given_with) for _ in range(ticks)]


def audit(bounds, told):
    """Hold the angles that were let through against every bound, by differences over their times."""
    time, angles = np.array([one.time for one in told]), np.array([one.angles for one in told])
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
    for one in told:
        assert not one.ok or not one.interventions
        assert one.ok == (one.state == "passing")


# A clean walk passes.


@pytest.mark.parametrize("gait", GAITS)
@pytest.mark.parametrize("name", PRESETS)
def test_a_clean_walk_passes_to_the_bit(name, gait):
    motion = walk(name, gait)
    guard = Guard(preset(name))
    for i, angles in enumerate(motion.angles):
        told = guard.check(angles, TICK, motion.contacts[i], motion.body[i])
        assert told.ok
        assert told.interventions == ()
        assert told.angles.tobytes() == angles.tobytes()
    assert dict(guard.counts) == {}
    assert guard.log == ()
    assert guard.summary() == f"0 interventions in {guard.time:.2f} s, now passing"
    assert guard.time == pytest.approx(len(motion.time) * TICK)


@pytest.mark.parametrize("name", ["strider", "phantomx"])
def test_a_curved_walk_at_steps_of_any_length_passes_without_a_pose(name):
    motion = walk(name, "ripple", True)
    rng = np.random.default_rng(1)
    moments = np.cumsum(rng.integers(1, 6, len(motion.time)))
    moments = moments[moments < len(motion.time)]
    guard = Guard(preset(name))
    for before, i in zip(np.r_[moments[0] - 1, moments], moments, strict=False):
        told = guard.check(motion.angles[i], (i - before) * TICK, motion.contacts[i])
        assert told.interventions == ()
        assert told.angles.tobytes() == motion.angles[i].tobytes()


def test_what_it_sends_another_guard_lets_through():
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


# Whatever comes in, what goes out keeps every bound.

JUNK = (NAN, np.full((6, 3), np.inf), np.full((6, 3), 1e308), "x", None, [[1.0], [2.0, 3.0]], {}, np.zeros((6, 2)))
JUNK += (np.zeros((6, 3), dtype=complex), np.zeros((6, 3), dtype=bool), [10**400] * 3, object(), np.zeros((2, 6, 3)))
STEPS = st.one_of(
    st.just(TICK),
    st.just(TICK),
    st.floats(0.001, 0.05),
    st.floats(0.0, 10.0),
    st.floats(0.0, 2e-4),
    st.floats(),
    st.sampled_from(["0.01", None, [], np.float32(0.02), 10**400, True]),
)
COMMANDS = ("walk", "anywhere", "beyond", "nearby", "to a limit", "straight on", "junk", "held")
CONTACTS = ("none", "all", "walk", "random", "junk")
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


def commanded(kind, share, rng, motion, tick, told):
    limits = motion.robot.limits
    low, high = limits[..., 0], limits[..., 1]
    last = motion.angles[0] if not told else told[-1].angles
    before = last if len(told) < 2 else told[-2].angles
    match kind:
        case "walk":
            return motion.angles[tick % len(motion.time)]
        case "anywhere":
            return rng.uniform(low, high)
        case "beyond":
            return rng.uniform(low - share, high + share)
        case "nearby":
            return last + rng.normal(size=last.shape) * 10 ** (-6 * share)
        case "to a limit":
            return np.clip(last + 0.12 * share * rng.choice([-1, 1], (6, 1)), low, high)
        case "straight on":
            return 2 * last - before
        case "held":
            return last
    return JUNK[rng.integers(len(JUNK))]


def contacts_of(kind, rng, motion, tick):
    match kind:
        case "none":
            return None
        case "all":
            return DOWN
        case "walk":
            return motion.contacts[tick % len(motion.time)]
        case "random":
            return rng.random(6) < 0.8
    return [np.ones(5, dtype=bool), np.ones(6), "down", [[True], [False, True]], object()][rng.integers(5)]


BODIES = (None, Pose(), Pose.from_rpy(0.1, 0.2, 3.0), Pose.from_rpy(0.0, [0.1, 0.2]), "level", np.eye(3))


@settings(max_examples=150)
@given(SEGMENTS, st.sampled_from(["hold", "sit"]), st.sampled_from(["near", "reset"]), st.sampled_from(PRESETS))
def test_no_stream_of_garbage_brings_out_what_breaks_a_bound(segments, policy, recover, name):
    motion = walk(name)
    bounds = GuardBounds.of(preset(name), sit_after=0.05, sit_speed=0.1)
    guard = Guard(preset(name), bounds=bounds, policy=policy, recover=recover, log_size=5)
    told = []
    tick = 0
    for kind, ticks, dt, touching, share, seed in segments:
        rng = np.random.default_rng(seed)
        for _ in range(ticks):
            angles = commanded(kind, share, rng, motion, tick, told)
            body = BODIES[rng.integers(len(BODIES))] if touching in ("random", "junk") else None
            told.append(guard.check(angles, dt, contacts_of(touching, rng, motion, tick), body))
            tick += 1
        if seed % 3 == 0:
            guard.reset()
    audit(bounds, told)
    assert set(guard.counts) <= set(KINDS)
    assert len(guard.log) == min(sum(guard.counts.values()), 5)
    assert guard.summary()


@given(st.lists(st.floats(1e-4, 0.3), min_size=5, max_size=40), st.floats(0.05, 1), st.booleans())
def test_a_joint_on_its_way_to_a_limit_always_comes_to_rest_before_it(steps, share, upward):
    """As fast as is let through towards a limit, then nothing but NaN, at steps of any length."""
    robot = ring(6)
    bounds = GuardBounds.of(robot, acceleration=20.0)
    guard = Guard(robot, bounds=bounds, start=np.zeros((6, 3)))
    limit = robot.limits[..., int(upward)]
    told = [guard.check(np.zeros((6, 3)), TICK)]
    for number in range(400):
        # Always as fast as the bounds permit, by the guard's own word.
        reach = share * (number + 1) ** 2 / 2 * 20.0 * TICK**2
        told.append(guard.check(np.clip(reach * np.sign(limit), robot.limits[..., 0], robot.limits[..., 1]), TICK))
        if not told[-1].ok:
            break
    assert not told[-1].ok
    told += [guard.check(NAN, dt) for dt in steps]
    told += run(guard, NAN, 50)
    audit(bounds, told)
    np.testing.assert_array_equal(told[-1].angles, told[-2].angles)


def test_the_same_stream_gives_the_same_to_the_bit():
    def stream():
        guard = Guard(preset("strider"), policy="sit")
        rng = np.random.default_rng(3)
        told = []
        for i in range(400):
            spoilt = standing() + rng.normal(size=(6, 3)) * (0.3 if i % 50 == 0 else 1e-4)
            told.append(guard.check(spoilt, rng.uniform(0.005, 0.02), rng.random(6) < 0.9))
        return np.array([one.angles for one in told]).tobytes(), guard.summary()

    assert stream() == stream()


def size_with_all_it_holds(thing):
    """Bytes of an object and of all that it refers to, but for code."""
    seen, waiting, total = set(), [thing], 0
    while waiting:
        one = waiting.pop()
        if id(one) not in seen and not isinstance(one, type | ModuleType | FunctionType):
            seen.add(id(one))
            total += sys.getsizeof(one)
            waiting += gc.get_referents(one)
    return total


def test_no_memory_grows():
    guard = Guard(preset("strider"), log_size=20)
    rng = np.random.default_rng(4)

    def stream(ticks):
        for i in range(ticks):
            spoilt = JUNK[i % len(JUNK)] if i % 3 else standing() + rng.normal(size=(6, 3))
            guard.check(spoilt, TICK, rng.random(6) < 0.5)

    stream(500)
    before = size_with_all_it_holds(guard)
    stream(1500)
    assert len(guard.log) == 20
    assert sum(guard.counts.values()) > 500
    assert size_with_all_it_holds(guard) == pytest.approx(before, rel=0.02)


# Each check, against something that the guard did not compute.


def only(robot, **changes):
    """Bounds so wide that nothing but what is changed can be broken."""
    wide = {"speed": 1e6, "acceleration": 1e12, "margin": -math.inf, "drag": math.inf, "ground": math.inf}
    return GuardBounds.of(robot, **{**wide, **changes})


@given(st.integers(0, 2**32 - 1), st.booleans())
def test_the_margin_is_that_of_stability_margin(seed, masses):
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
        assert found.kind == "stability"
        assert (found.leg, found.joint, found.bound) == ("", "", 1e6)
        assert found.value == pytest.approx(stability_margin(robot, angles, body, contacts), abs=1e-12)


@pytest.mark.parametrize("turned", [[[1, 0, 0], [0, 0, -1], [0, 1, 0]], [[0, 1, 0], [0, 0, 1], [1, 0, 0]]])
def test_the_margin_of_a_body_on_its_side(turned):
    robot = random_hexapod(np.random.default_rng(6))
    body = Pose(np.array(turned, dtype=float))
    (found,) = Guard(robot, bounds=only(robot, margin=1e6)).check(np.zeros((6, 3)), TICK, DOWN, body).interventions
    assert found.value == pytest.approx(stability_margin(robot, np.zeros((6, 3)), body, DOWN), abs=1e-12)


@given(st.integers(0, 2**32 - 1))
def test_without_a_pose_the_plane_of_the_feet_is_level(seed):
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


def test_the_margin_of_feet_that_span_nothing():
    robot = ring(6)
    angles = np.tile([0.0, 0.4, -1.2], (6, 1))
    for number in range(3):
        guard = Guard(robot, bounds=only(robot, margin=1e6))
        contacts = np.arange(6) < number
        (found,) = guard.check(angles, TICK, contacts).interventions
        assert found.value == pytest.approx(stability_margin(robot, angles, Pose(), contacts), abs=1e-12)


def test_margin_of_points_on_a_line_and_of_one_point():
    """Feet of legs that share one mount and heading: three of them in one place, or on one line through B."""
    place = np.tile([0.1, 0.0, 0.0], (6, 1))
    robot = ring(6, mount_position=place, mount_yaw=np.zeros(6), link_mass=None, body_mass=None)
    guard = Guard(robot, bounds=only(robot, margin=1e6))
    same = np.tile([0.0, 0.4, -1.2], (6, 1))
    line = same + np.arange(6)[:, None] * [0.0, 0.0, 0.1]
    for angles in (same, line):
        (found,) = guard.check(angles, TICK, DOWN).interventions
        assert found.value == pytest.approx(stability_margin(robot, angles, Pose(), DOWN), abs=1e-12)
        assert found.value < -0.1


@pytest.mark.parametrize("what", ["speed", "acceleration"])
@pytest.mark.parametrize("seed", range(5))
def test_speed_and_acceleration_are_numpys_differences(what, seed):
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
    (found,) = (one for one in guard.check(course[3], steps[2]).interventions if one.kind == what)
    leg, joint = np.unravel_index(np.argmax(want), (6, 3))
    assert (found.leg, found.joint) == (robot.leg_codes[leg], ("coxa", "femur", "tibia")[joint])
    assert found.value == pytest.approx(want.max(), rel=1e-9)
    assert found.bound == pytest.approx(want.max() * (1 - 1e-6))
    assert found.time == pytest.approx(steps.sum())


@pytest.mark.parametrize("what", ["speed", "acceleration"])
def test_a_hair_below_the_bound_passes(what):
    robot = preset("strider")
    steps = [0.01, 0.02, 0.03]
    course = [standing(), standing(), standing() + 1e-4, standing() + 5e-4]
    want = {"speed": 4e-4 / 0.03, "acceleration": (4e-4 / 0.03 - 1e-4 / 0.02) / 0.025}[what]
    want = max(want, {"speed": 0, "acceleration": 1e-4 / 0.02 / 0.015}[what])
    for share, passes in ((1 + 1e-6, True), (1 - 1e-6, False)):
        guard = Guard(robot, bounds=only(robot, **{what: want * share}))
        told = [guard.check(angles, dt) for angles, dt in zip(course, [0.01, *steps], strict=True)]
        assert all(one.ok for one in told) == passes


@pytest.mark.parametrize("contacts", [DOWN, np.arange(6) % 2 == 0])
def test_a_hair_below_the_margin_passes(contacts):
    robot = preset("strider")
    margin = stability_margin(robot, standing(), Pose(), contacts)
    assert Guard(robot, bounds=only(robot, margin=margin - 1e-9)).check(standing(), TICK, contacts).ok
    assert not Guard(robot, bounds=only(robot, margin=margin + 1e-9)).check(standing(), TICK, contacts).ok


def test_beyond_a_limit():
    guard = Guard(preset("strider"))
    beyond = standing().copy()
    beyond[3, 2] = preset("strider").limits[3, 2, 0] - 1e-6
    (found,) = guard.check(beyond, TICK).interventions
    assert (found.kind, found.leg, found.joint) == ("limit", "RR", "tibia")
    assert (found.value, found.bound) == (beyond[3, 2], preset("strider").limits[3, 2, 0])


@pytest.mark.parametrize("side", [0, 1])
def test_what_rounding_adds_to_a_limit_is_taken_off(side):
    robot = preset("strider")
    at_limit = standing().copy()
    at_limit[0, 1] = robot.limits[0, 1, side]
    guard = Guard(robot)
    told = guard.check(at_limit + np.eye(6, 3)[::-1][-1] * 0 + [[0, (2 * side - 1) * 1e-10, 0]] * np.eye(6, 1), TICK)
    assert told.ok
    np.testing.assert_array_equal(told.angles, at_limit)


def feet_at(feet, body=None):
    """Angles of the strider with its feet at places in G, the body 110 mm over it."""
    body = Pose((np.eye(3)), (0, 0, 0.11)) if body is None else body
    return inverse_kinematics(preset("strider"), feet, body).require().angles


def stance():
    return default_stance(preset("strider")) * [1, 1, 0]


def test_a_foot_that_drags_is_named_with_how_far_it_has_gone():
    robot = preset("strider")
    feet = np.array([stance() + share * np.eye(6)[:, 4:5] * [0.005, 0, 0] for share in np.linspace(0, 1, 50)])
    apart = np.linalg.norm(feet[:, :, None] - feet[:, None], axis=-1)
    most = np.abs(apart[-1] - apart[0]).max()
    bodies = [Pose.from_rpy(0, 0, 0.1 * share, (0.01 * share, 0.01 * share, 0.11)) for share in np.linspace(0, 1, 50)]
    for drag, passes in ((most * 1.001, True), (most * 0.999, False)):
        guard = Guard(robot, bounds=only(robot, drag=drag))
        told = [guard.check(feet_at(at, body), TICK, DOWN) for at, body in zip(feet, bodies, strict=True)]
        assert all(one.ok for one in told[:-1])
        assert told[-1].ok == passes
    (found,) = told[-1].interventions
    assert (found.kind, found.leg) in {("drag", "RM"), ("drag", "RF")}
    assert found.value == pytest.approx(most, rel=1e-9)
    assert found.bound == drag


def test_a_foot_that_was_lifted_may_come_down_elsewhere():
    robot = preset("strider")
    guard = Guard(robot, bounds=only(robot, drag=1e-3))
    moved = stance() + np.eye(6)[:, 4:5] * [0.03, 0, 0]
    lifted = np.arange(6) != 4
    assert guard.check(feet_at(stance()), TICK, DOWN).ok
    assert guard.check(feet_at(moved), TICK, lifted).ok
    assert guard.check(feet_at(moved), TICK, DOWN).ok
    assert kinds(guard.check(feet_at(stance()), TICK, DOWN)) == ["drag"]


def test_nothing_drags_where_contacts_are_not_told():
    robot = preset("strider")
    guard = Guard(robot, bounds=only(robot, drag=1e-3))
    moved = stance() + np.eye(6)[:, 4:5] * [0.03, 0, 0]
    assert guard.check(feet_at(stance()), TICK, DOWN).ok
    assert guard.check(feet_at(moved), TICK).ok
    assert guard.check(feet_at(stance()), TICK, DOWN).ok


def test_after_a_hold_the_feet_may_stand_elsewhere():
    robot = preset("strider")
    guard = Guard(robot)
    assert guard.check(feet_at(stance()), TICK, DOWN).ok
    assert guard.check(NAN, TICK, DOWN).state == "holding"
    told = run(guard, feet_at(stance() + np.eye(6)[:, 4:5] * [0.005, 0, 0]), 30, contacts=DOWN)
    assert told[-1].ok
    assert dict(guard.counts) == {"finite": 1}


@pytest.mark.parametrize("with_pose", [True, False])
def test_a_foot_in_the_air_is_not_down(with_pose):
    robot = preset("strider")
    raised = stance() + np.eye(6)[:, 2:3] * [0, 0, 0.03]
    body = Pose() if with_pose else None
    told = Guard(robot, bounds=only(robot, ground=0.01)).check(feet_at(raised), TICK, DOWN, body)
    (found,) = told.interventions
    assert (found.kind, found.leg, found.bound) == ("ground", "LR", 0.01)
    if with_pose:
        assert found.value == pytest.approx(0.025)
    else:
        heights = raised[:, 2]
        plane = np.c_[raised[:, :2], np.ones(6)]
        fitted = np.linalg.lstsq(plane, heights, rcond=None)[0]
        normal = math.hypot(*fitted[:2], 1)
        assert found.value == pytest.approx(np.abs(plane @ fitted - heights).max() / normal, rel=1e-9)
    said = np.arange(6) != 2
    assert Guard(robot, bounds=only(robot, ground=0.01)).check(feet_at(raised), TICK, said, body).ok


def test_sloping_ground_has_to_be_allowed():
    robot = preset("strider")
    sloping = feet_at(stance())
    for slope, attitude, passes in ((0.0, 0.2, False), (0.15, 0.2, False), (0.21, 0.2, True), (0.0, 0.0, True)):
        guard = Guard(robot, bounds=only(robot, ground=1e-3, slope=slope))
        told = guard.check(sloping, TICK, DOWN, Pose.from_rpy(attitude, 0, 0))
        assert kinds(told) == ([] if passes else ["ground"])


def test_one_foot_alone_is_on_the_ground():
    robot = preset("strider")
    assert Guard(robot, bounds=only(robot, ground=1e-6)).check(standing(), TICK, np.arange(6) == 1).ok


@pytest.mark.parametrize(
    ("angles", "kind", "value"),
    [
        *((junk, "shape", None) for junk in JUNK[3:]),
        (NAN, "finite", math.nan),
        (np.full((6, 3), -np.inf), "finite", -math.inf),
        (np.full((6, 3), 1e308), "limit", 1e308),
        (np.full((6, 3), 1e308, dtype=np.longdouble), "limit", 1e308),
    ],
)
def test_what_are_no_angles_is_named(angles, kind, value):
    guard = Guard(preset("strider"), start=standing())
    told = guard.check(angles, TICK)
    assert kinds(told)[0] == kind
    assert not told.ok
    np.testing.assert_array_equal(told.angles, standing())
    assert value is None or np.array_equal(told.interventions[0].value, value, equal_nan=True)


@pytest.mark.parametrize("angles", [standing().astype(np.float32), standing().tolist(), np.zeros((6, 3), dtype=int)])
def test_angles_may_be_of_any_real_kind(angles):
    told = Guard(preset("strider")).check(angles, TICK)
    assert told.ok
    assert told.angles.dtype == np.float64
    np.testing.assert_array_equal(told.angles, angles)


def test_what_it_tells_cannot_be_changed_from_outside():
    guard = Guard(preset("strider"))
    mine = standing().copy()
    told = guard.check(mine, TICK)
    mine += 1.0
    np.testing.assert_array_equal(told.angles, standing())
    with pytest.raises(ValueError, match="read-only"):
        told.angles[0, 0] = 1
    with pytest.raises(TypeError):
        guard.counts["speed"] = 1


@pytest.mark.parametrize("contacts", [[True] * 5, [1, 1, 1, 1, 1, 1], "down", [[True], [False, True]], math.nan])
def test_contacts_that_are_none_are_named(contacts):
    guard = Guard(preset("strider"), start=standing())
    assert kinds(guard.check(standing(), TICK, contacts)) == ["contacts"]
    assert kinds(guard.check(standing(), TICK, [True] * 6)) == []


@pytest.mark.parametrize("body", ["level", np.eye(3), Pose.from_rpy(0, [0.1, 0.2]), 1.0])
def test_a_body_that_is_none_is_named(body):
    guard = Guard(preset("strider"), start=standing())
    assert kinds(guard.check(standing(), TICK, DOWN, body)) == ["body"]
    assert kinds(guard.check(standing(), TICK, None, body)) == ["body"]
    assert kinds(guard.check(standing(), TICK, DOWN, Pose())) == []


# Time.


@pytest.mark.parametrize("dt", [math.nan, -0.01, 0.0, math.inf, 1e9, "0.01", None, [], 10**400])
def test_without_a_sane_time_step_nothing_moves(dt):
    guard = Guard(preset("strider"), start=standing())
    before = guard.check(standing() + 1e-3, TICK)
    told = guard.check(standing() + 2e-3, dt)
    assert kinds(told) == ["time_step"]
    assert told.time == before.time
    np.testing.assert_array_equal(told.angles, before.angles)
    assert told.state == "holding"
    assert guard.check(standing() + 2e-3, dt).state == "holding"


def test_steps_too_short_wait_until_they_make_one():
    guard = Guard(preset("strider"), start=standing())
    moving = [guard.check(standing() + 3e-3 * tick**2, TICK) for tick in range(1, 5)][-1]
    assert moving.ok
    told = [guard.check(NAN, 3e-5) for _ in range(4)]
    assert [one.time - moving.time > 0 for one in told] == [False, False, False, True]
    assert told[3].time - moving.time == pytest.approx(1.2e-4)
    assert (told[2].angles == moving.angles).all()
    assert (told[3].angles > moving.angles).all()
    assert {kind for one in told for kind in kinds(one)} == {"finite", "time_step"}


def test_time_in_steps_too_short_is_not_lost():
    guard = Guard(preset("strider"), start=standing())
    for _ in range(2):
        guard.check(standing(), 3e-5)
    assert guard.check(standing(), TICK).time == pytest.approx(TICK + 6e-5)


def test_a_gap_is_a_watchdog():
    guard = Guard(preset("strider"), start=standing())
    for share in range(1, 5):
        moving = guard.check(standing() + 1e-3 * share**2, TICK)
    assert moving.ok
    told = guard.check(standing() + 0.016, 0.5)
    assert (kinds(told), told.state) == (["gap"], "holding")
    (found,) = told.interventions
    assert (found.value, found.bound) == (0.5, 0.1)
    np.testing.assert_array_equal(told.angles, moving.angles)
    # The length of the gap is no licence to start at full speed.
    after = guard.check(standing() + 0.05, TICK)
    assert after.state == "recovering"
    assert 0 < np.abs(after.angles - told.angles).max() <= guard.bounds.acceleration.max() * TICK**2 / 2 + ROUNDING


def test_a_gap_too_short_to_stop_in_is_braked_through():
    robot = preset("strider")
    bounds = GuardBounds.of(robot, acceleration=2.0)
    guard = Guard(robot, bounds=bounds, start=standing())
    told = [guard.check(standing() + 1e-4 * tick**2 * 0.9, TICK) for tick in range(1, 40)]
    assert told[-1].ok
    told.append(guard.check(NAN, 0.11))
    assert (told[-1].angles > told[-2].angles).all()
    told += run(guard, NAN, 40)
    audit(bounds, told)


# What it does.


def glitched(guard, motion, start, ticks, spoilt=NAN):
    """A walk, some ticks of which are spoilt."""
    return [
        guard.check(
            spoilt if start <= i < start + ticks else motion.angles[i], TICK, motion.contacts[i], motion.body[i]
        )
        for i in range(len(motion.time))
    ]


@pytest.mark.parametrize("ticks", [1, 2, 3])
def test_a_glitch_is_braked_and_caught_up_with(ticks):
    motion = walk("strider")
    guard = Guard(preset("strider"))
    told = glitched(guard, motion, 100, ticks, standing() + 0.3)
    audit(guard.bounds, told)
    states = [one.state for one in told]
    assert states[:100] == ["passing"] * 100
    assert states[100 : 100 + ticks] == ["holding"] * ticks
    back = states.index("passing", 100)
    assert 100 + ticks < back < 100 + ticks + 15
    assert set(states[100 + ticks : back]) == {"recovering"}
    assert states[back:] == ["passing"] * (len(states) - back)
    assert told[back].angles.tobytes() == motion.angles[back].tobytes()
    assert sum(guard.counts.values()) == len(guard.log) == len({one.kind for one in guard.log})
    assert "now passing" in guard.summary()


def test_only_after_a_reset_where_that_is_asked_for():
    motion = walk("strider")
    guard = Guard(preset("strider"), recover="reset")
    told = glitched(guard, motion, 100, 1)
    assert {one.state for one in told[100:]} == {"holding"}
    guard.check(NAN, TICK)
    guard.reset()
    after = run(guard, motion.angles[-1], 200)
    assert after[0].state == "recovering"
    assert after[-1].ok
    audit(guard.bounds, told + after)
    # A reset counts for the hold that it ends, not for the next.
    guard.reset()
    assert {one.state for one in [guard.check(NAN, TICK), *run(guard, motion.angles[-1], 50)]} == {"holding"}


def test_a_reset_lets_it_come_back_from_far_at_the_bounds_share_of_speed():
    robot = preset("strider")
    guard = Guard(robot, start=standing())
    far = standing() + 0.4
    assert {one.state for one in run(guard, far, 50)} == {"holding"}
    assert guard.counts["away"] == 1
    guard.reset()
    told = run(guard, far, 100)
    assert {one.state for one in told} == {"recovering", "passing"}
    audit(guard.bounds, told)
    speed = np.abs(np.diff([one.angles for one in told], axis=0)) / TICK
    slow = guard.bounds.recovery * guard.bounds.speed
    assert (speed <= slow * (1 + 1e-9)).all()
    assert speed.max() > slow.max() * 0.99


def test_a_reset_is_off_when_something_breaks_a_bound_on_the_way():
    guard = Guard(preset("strider"), start=standing())
    run(guard, standing() + 0.4, 5)
    guard.reset()
    assert guard.check(standing() + 0.4, TICK).state == "recovering"
    assert guard.check(NAN, TICK).state == "holding"
    assert guard.check(standing() + 0.4, TICK).state == "holding"


def test_a_command_that_runs_away_while_it_recovers_is_let_go():
    guard = Guard(preset("strider"), start=standing())
    guard.check(NAN, TICK)
    near, on_the_way, excluded = (guard.check(standing() + apart, TICK) for apart in (0.09, 0.18, 0.25))
    assert [near.state, on_the_way.state, excluded.state] == ["recovering", "recovering", "holding"]
    (found,) = excluded.interventions
    assert (found.kind, found.bound) == ("away", 2 * guard.bounds.near)
    assert found.value == pytest.approx(0.25 - (on_the_way.angles - standing()).min())


def test_no_time_while_it_recovers_means_hold():
    guard = Guard(preset("strider"), start=standing())
    guard.check(NAN, TICK)
    assert guard.check(standing() + 0.05, TICK).state == "recovering"
    assert guard.check(standing() + 0.05, 0.0).state == "holding"


@pytest.mark.parametrize("seed", range(10))
def test_it_catches_up_with_a_command_at_full_speed_that_stops_dead_at_a_limit(seed):
    """Every bound is pressed at once: speed on the way, braking and the limit itself at its end."""
    rng = np.random.default_rng(seed)
    robot = ring(6, limits=np.stack([np.full((6, 3), -1.0), rng.uniform(0.5, 1.0, (6, 3))], axis=-1))
    high = robot.limits[..., 1]
    guard = Guard(robot, bounds=GuardBounds.of(robot, near=3.0), start=np.zeros((6, 3)))
    told = [guard.check(NAN, TICK)]
    reached = rng.uniform(0.0, 0.1, (6, 3))
    for _ in range(60):
        reached = np.minimum(reached + rng.uniform(0.03, 0.05, (6, 3)), high)
        told.append(guard.check(reached, TICK))
    assert {one.state for one in told[1:10]} == {"recovering"}
    assert told[-1].ok
    audit(guard.bounds, told)
    speed = np.diff([one.angles for one in told], axis=0) / TICK
    assert speed.max() == pytest.approx(UNKNOWN_SPEED)


@pytest.mark.parametrize("seed", range(10))
def test_rounding_brings_no_joint_beyond_a_limit(seed):
    """Limits near zero, where the step to one is not exact, and one joint on a long way that keeps it recovering."""
    rng = np.random.default_rng(seed)
    limits = np.array([-1.0, 1.0]) * np.concatenate([rng.uniform(0, 2e-3, 17), [1.0]]).reshape(6, 3, 1)
    robot = ring(6, limits=limits)
    guard = Guard(robot, bounds=GuardBounds.of(robot, near=3.0, acceleration=1e4), start=np.zeros((6, 3)))
    side = rng.choice([-1, 1], (60, 6, 3))
    side[:, 5, 2] = 1
    told = [guard.check(NAN, TICK)]
    for towards in np.repeat(side, 4, axis=0)[:60]:
        told.append(guard.check(limits[..., 1] * towards, rng.uniform(0.003, 0.02)))
    assert {one.state for one in told[1:30]} == {"recovering"}
    audit(guard.bounds, told)


def test_an_intervention_that_lasts_counts_once():
    guard = Guard(preset("strider"), start=standing())
    run(guard, NAN, 10)
    assert dict(guard.counts) == {"finite": 1}
    run(guard, standing(), 10)
    run(guard, NAN, 10)
    assert dict(guard.counts) == {"finite": 2}
    assert [one.time for one in guard.log] == pytest.approx([0.01, 0.21])


def test_the_log_is_a_ring_and_the_summary_has_the_worst():
    guard = Guard(preset("strider"), start=standing(), log_size=3)
    for size in (0.3, 0.5, 0.4, 0.2, 0.6):
        guard.check(standing() + size * np.eye(6, 3), TICK)
        run(guard, standing(), 30)
        assert guard.state == "passing"
    assert guard.counts["speed"] == 5
    assert len(guard.log) == 3
    lines = guard.summary().splitlines()
    assert lines[0] == f"{sum(guard.counts.values())} interventions in {guard.time:.2f} s, now passing"
    speed = preset("strider").servos[0][0].no_load_speed
    worst = (
        rf"  5 x speed: \w\w (coxa|femur|tibia) {np.rad2deg(60):.4g} deg/s \(bound {np.rad2deg(speed):.4g}\) at 1.250 s"
    )
    assert [line for line in lines if re.fullmatch(worst, line)]


def test_texts():
    guard = Guard(preset("strider"), start=standing())
    guard.check(NAN, TICK)
    assert guard.log[-1].text() == "finite: LF coxa at 0.010 s"
    guard.check(np.zeros(4), TICK)
    assert guard.log[-1].text() == "shape: 4 values (bound 18) at 0.020 s"
    guard.check(standing(), TICK, ~DOWN)
    assert guard.log[-1].text() == "stability: -inf mm (bound 0) at 0.030 s"
    assert guard.summary().startswith("3 interventions in 0.03 s, now holding\n")


# Where it starts.


def test_the_first_angles_that_pass_are_taken_for_where_it_is():
    guard = Guard(preset("strider"))
    assert guard.check(standing() + 0.2, TICK).ok
    assert guard.check(standing(), TICK).state == "holding"


def test_a_start_is_where_it_is():
    guard = Guard(preset("strider"), start=standing() + 0.2)
    told = guard.check(standing(), TICK)
    assert told.state == "holding"
    np.testing.assert_array_equal(told.angles, standing() + 0.2)


@pytest.mark.parametrize("dt", [TICK, math.nan])
@pytest.mark.parametrize("name", PRESETS)
def test_garbage_at_first_starts_it_in_the_stance(name, dt):
    guard = Guard(preset(name))
    told = guard.check(NAN, dt)
    assert told.state == "holding"
    np.testing.assert_array_equal(told.angles, standing(name))
    assert run(guard, standing(name), 5)[-1].ok


def test_a_stance_outside_the_bounds_starts_it_straight():
    robot = preset("strider")
    limits = np.tile([[0.3, 0.5], [-0.5, 0.5], [-0.5, -0.2]], (6, 1, 1))
    guard = Guard(robot, bounds=GuardBounds.of(robot, limits=limits))
    np.testing.assert_array_equal(guard.check(NAN, TICK).angles, np.tile([0.3, 0.0, -0.2], (6, 1)))


def test_a_robot_without_a_stance_starts_straight():
    robot = ring(6, limits=np.broadcast_to([[-0.1, 0.1], [1.0, 1.5], [0.0, 0.2]], (6, 3, 2)))
    guard = Guard(robot)
    np.testing.assert_array_equal(guard.check(NAN, TICK).angles, np.tile([0.0, 1.0, 0.0], (6, 1)))


# SitDown down.


def sit(name, moment, *, attitude=True, ticks=1200, **changes):
    """A robot that is held at a moment of its walk until it sits; what was told from when it sits."""
    motion = walk(name)
    guard = Guard(preset(name), policy="sit", bounds=GuardBounds.of(preset(name), **changes))
    for i in range(moment + 1):
        body = motion.body[i] if attitude else None
        assert guard.check(motion.angles[i], TICK, motion.contacts[i], body).ok
    told = run(guard, NAN, ticks)
    audit(guard.bounds, told)
    return guard, told, [one for one in told if one.state == "sitting"]


@pytest.mark.parametrize("moment", [0, 60])
@pytest.mark.parametrize("name", PRESETS)
def test_it_sits_down_on_feet_that_stay_where_they_are(name, moment):
    robot, motion = preset(name), walk(name)
    guard, told, sitting = sit(name, moment)
    wait = guard.bounds.sit_after / TICK
    assert wait - 2 < [one.state for one in told].index("sitting") < wait + 20
    assert told[-1].state == "holding"
    np.testing.assert_array_equal(told[-1].angles, told[-2].angles)
    points = forward_kinematics(robot, np.array([one.angles for one in sitting]))
    feet, down = points[..., 3, :], motion.contacts[moment]
    assert np.ptp(feet[..., :2], axis=0).max() < 1e-5
    assert np.ptp(feet[:, down, 2] - feet[:1, down, 2], axis=1).max() < 1e-5
    assert (np.diff(feet[:, down, 2], axis=0) >= -1e-6).all()
    assert np.ptp(feet[-1, :, 2]) < 2e-3  # those in the air have come down
    belly = robot.mount_position[:, 2].min() if robot.body_size is None else -robot.body_size[2] / 2
    lowest = min(belly, points[-1, :, :3, 2].min()) - feet[-1, :, 2].mean()
    assert lowest == pytest.approx(guard.bounds.sit_height, abs=1e-3)
    lowering = np.diff(feet[:, down, 2].mean(-1)) / TICK
    assert lowering.max() < guard.bounds.sit_speed + 1e-3


def test_no_joint_is_fast_while_it_sits_down():
    guard, _, sitting = sit("strider", 0, sit_speed=2.0)
    speed = np.abs(np.diff([one.angles for one in sitting], axis=0)) / TICK
    assert (speed <= guard.bounds.recovery * guard.bounds.speed * (1 + 1e-9)).all()
    assert speed.max() > 0.5


def test_it_sits_down_straight_by_the_bodys_attitude():
    robot = preset("strider")
    body = Pose.from_rpy(0.05, -0.08, 0.3, (0, 0, 0.11))
    guard = Guard(robot, policy="sit")
    feet = Pose.from_rpy(0, 0, 0.3) @ stance()
    assert guard.check(feet_at(feet, body), TICK, DOWN, body).ok
    told = run(guard, NAN, 1000)
    moved = (forward_kinematics(robot, told[-1].angles) - forward_kinematics(robot, told[0].angles))[:, 3]
    up = body.rotation[2]
    np.testing.assert_allclose(moved, (moved @ up)[:, None] * up, atol=1e-5)
    assert (moved @ up).min() > 0.02


def test_it_stops_where_a_limit_does_not_let_it_lower_the_body():
    robot = preset("strider")
    limits = np.array(robot.limits)
    limits[2, 1, 1] = standing()[2, 1] + 0.1
    _, told, sitting = sit("strider", 0, limits=limits)
    assert sitting
    assert told[-1].state == "holding"
    assert 0 <= limits[2, 1, 1] - told[-1].angles[2, 1] < 0.02


def test_a_foot_that_cannot_be_set_down_stays_in_the_air():
    robot, motion = preset("strider"), walk("strider")
    limits = np.array(robot.limits)
    limits[:, 1, 0] = motion.angles[:, :, 1].min() - 0.02
    air = ~motion.contacts[60]
    limits[air, 1, 0] = motion.angles[60][air, 1] - 0.005
    guard = Guard(robot, policy="sit", bounds=GuardBounds.of(robot, limits=limits))
    assert guard.check(motion.angles[60], TICK, motion.contacts[60], motion.body[60]).ok
    told = run(guard, NAN, 800)
    before, after = (forward_kinematics(robot, one.angles)[:, 3, 2] for one in (told[0], told[-1]))
    np.testing.assert_allclose(np.ptp(after - before), 0, atol=5e-3)
    assert (after - before).min() > 0.02


def test_a_straight_leg_cannot_sit_down():
    robot = ring(6, tibia=np.full(6, 0.3), limits=np.broadcast_to([-3.0, 3.0], (6, 3, 2)))
    straight = np.tile([0.0, -0.7, 0.0], (6, 1))
    guard = Guard(robot, policy="sit", start=straight)
    told = run(guard, NAN, 200)
    assert guard.state == "holding"
    assert any(one.state == "sitting" for one in told)
    np.testing.assert_array_equal(told[-1].angles, straight)


def test_a_leg_that_is_straight_to_the_bit_cannot_sit_down():
    robot = ring(6, mount_yaw=np.arange(6) * np.pi / 3, limits=np.broadcast_to([-3.0, 3.0], (6, 3, 2)))
    angles = np.tile([0.0, 0.4, -1.2], (6, 1))
    angles[0] = 0
    guard = Guard(robot, policy="sit", bounds=only(robot, sit_after=0.1))
    assert guard.check(angles, TICK, np.arange(6) > 0).ok
    assert (run(guard, NAN, 50)[-1].angles == angles).all()


def test_without_a_foot_on_the_ground_there_is_nothing_to_sit_on():
    robot = preset("strider")
    guard = Guard(robot, policy="sit", bounds=only(robot, sit_after=0.1))
    assert guard.check(standing(), TICK, ~DOWN).ok
    told = run(guard, NAN, 50)
    assert told[-1].state == "holding"
    np.testing.assert_array_equal(told[-1].angles, standing())


def test_where_contacts_were_never_told_all_feet_stand():
    robot = preset("strider")
    guard = Guard(robot, policy="sit", start=standing())
    told = run(guard, NAN, 700)
    moved = (forward_kinematics(robot, told[-1].angles) - forward_kinematics(robot, standing()))[:, 3]
    np.testing.assert_allclose(moved, [[0, 0, moved[0, 2]]] * 6, atol=1e-5)
    assert moved[0, 2] > 0.05


def test_it_gets_up_again_when_the_command_is_near():
    guard, told, sitting = sit("strider", 0, ticks=150)
    assert sitting
    assert guard.state == "sitting"
    told += run(guard, told[-1].angles, 30)
    assert told[-1].ok
    told += run(guard, NAN, 20)
    assert told[-1].state == "holding"
    told += run(guard, NAN, 1000)
    again = [one.state for one in told[200:]]
    assert "sitting" in again
    assert again[-1] == "holding"
    told += run(guard, told[-1].angles, 30)
    assert told[-1].ok
    guard.reset()
    told += [guard.check(NAN, TICK)]
    guard.reset()
    told += run(guard, standing(), 300)
    assert told[-1].ok
    told += run(guard, NAN, 200)
    assert told[-1].state == "sitting"
    audit(guard.bounds, told)


def test_a_gap_while_it_sits_down_interrupts_it():
    guard, told, _ = sit("strider", 0, ticks=150)
    told.append(guard.check(NAN, 0.3))
    assert told[-1].state == "holding"
    told += run(guard, NAN, 800)
    states = [one.state for one in told[151:]]
    assert "sitting" in states
    assert states[-1] == "holding"
    audit(guard.bounds, told)


# What is asked of it must make sense.


def test_bounds_by_default_are_the_robots():
    robot = preset("strider")
    bounds = GuardBounds.of(robot)
    np.testing.assert_array_equal(bounds.limits, robot.limits)
    np.testing.assert_array_equal(bounds.speed, [[servo.no_load_speed for servo in leg] for leg in robot.servos])
    np.testing.assert_allclose(bounds.acceleration, bounds.speed / 0.05)
    assert bounds.assumed == ()
    assert not bounds.limits.flags.writeable
    assert not bounds.speed.flags.writeable


def test_speeds_that_are_unknown_are_assumed_and_that_is_said():
    bounds = GuardBounds.of(ring(6))
    assert (bounds.speed == UNKNOWN_SPEED).all()
    assert bounds.assumed == ("18 joints turn at up to 5 rad/s: their servos' speed is unknown",)
    given_speed = GuardBounds.of(ring(6), speed=[1.0, 2.0, 3.0])
    assert given_speed.assumed == ()
    np.testing.assert_allclose(given_speed.acceleration, np.tile([20.0, 40.0, 60.0], (6, 1)))
    assert (GuardBounds.of(ring(6), acceleration=7).acceleration == 7).all()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"speed": 0}, "speed of a guard is 0; it must be greater than 0"),
        ({"speed": np.ones(4)}, r"speed of a guard has shape \(4,\); expected a number or \(6, 3\)"),
        ({"speed": "fast"}, "speed of a guard: expected an array of numbers"),
        ({"acceleration": math.nan}, "acceleration of a guard holds a value that is not a finite number"),
        ({"limits": np.zeros((6, 3))}, r"limits of a guard have shape \(6, 3\); expected \(legs, 3, 2\)"),
        ({"limits": np.tile([1.0, 0.0], (6, 3, 1))}, "a lowest angle is greater than its highest"),
        ({"limits": np.zeros((5, 3, 2)), "speed": 1, "acceleration": 1}, "limits of a guard are for 5 legs"),
        ({"margin": math.nan}, "margin of a guard is nan"),
        ({"margin": None}, "margin of a guard is None; it must be a number"),
        ({"drag": 0}, "drag of a guard is 0; it must be more than 0, at most inf"),
        ({"slope": 2}, "slope of a guard is 2; it must be at least 0, at most 1.5708"),
        ({"near": math.nan}, "near of a guard is nan"),
        ({"longest": 1e-5}, "longest of a guard is 1e-05 s, less than shortest, 0.0001 s"),
    ],
)
def test_bounds_that_make_no_sense_are_refused(changes, message):
    with pytest.raises(InputError, match=message):
        GuardBounds.of(ring(6), **changes)


def test_a_guard_that_makes_no_sense_is_refused():
    robot = preset("strider")
    with pytest.raises(UnknownNameError, match=r"no policy is called 'sti'\. Did you mean 'sit'"):
        Guard(robot, policy="sti")
    with pytest.raises(UnknownNameError, match="no way to recover is called 'never'"):
        Guard(robot, recover="never")
    with pytest.raises(InputError, match="is a batch of"):
        Guard(stack_robots([robot, robot]))
    with pytest.raises(InputError, match="bounds for 8 legs don't fit 'strider': 6 legs"):
        Guard(robot, bounds=GuardBounds.of(ring(8)))
    with pytest.raises(InputError, match="bounds for 6 legs don't fit 'strider'"):
        Guard(stack_robots([robot, robot]), bounds=GuardBounds.of(robot))
    with pytest.raises(InputError, match="log_size is 0"):
        Guard(robot, log_size=0)
    with pytest.raises(InputError, match=r"start of a guard .* shape: 9 values"):
        Guard(robot, start=np.zeros((3, 3)))
    with pytest.raises(InputError, match=r"start of a guard .* limit: LF tibia 5730 deg"):
        Guard(robot, start=np.full((6, 3), 100.0))


@pytest.mark.parametrize("legs", [4, 5, 8, 10])
def test_any_number_of_legs(legs):
    robot = ring(legs)
    angles = np.tile([0.0, 0.4, -1.2], (legs, 1))
    guard = Guard(robot, policy="sit", bounds=GuardBounds.of(robot, sit_after=0.05))
    assert guard.check(angles, TICK, np.ones(legs, dtype=bool), Pose()).ok
    told = run(guard, NAN, 800)
    assert kinds(told[0]) == ["shape"]
    audit(guard.bounds, told)
    assert any(one.state == "sitting" for one in told)


# The page about it.

PAGE = (Path(__file__).parents[1] / "docs" / "guard.md").read_text(encoding="utf-8")


def test_the_page_tells_every_kind_and_every_bound():
    rows = re.findall(r"^\| `(\w+)` \|", PAGE, flags=re.MULTILINE)
    assert rows[: len(KINDS)] == list(KINDS)
    named = set(GuardBounds.__dataclass_fields__) - {"assumed"}
    assert set(rows[len(KINDS) :]) == named


def test_the_pages_example_runs(capsys):
    (example,) = re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)
    exec(example, {})
    printed = capsys.readouterr().out
    (shown,) = re.findall(r"```text\n(.*?)```", PAGE, flags=re.DOTALL)
    assert printed == shown


def test_the_centre_of_mass_is_that_of_the_whole_robot():
    rng = np.random.default_rng(9)
    from tarsus.control.safety.feet_monitor import FeetMonitor

    for _ in range(20):
        robot = random_hexapod(rng)
        angles = rng.uniform(-3, 3, (6, 3))
        feet, com = FeetMonitor(robot, GuardBounds.of(robot)).points(angles.ravel().tolist())
        np.testing.assert_allclose(feet, forward_kinematics(robot, angles)[:, 3], rtol=0, atol=1e-15)
        np.testing.assert_allclose(com, centre_of_mass(robot, angles), rtol=0, atol=1e-15)
