"""The guard: valid commands pass unchanged, and the output keeps all bounds for any input."""

import gc
import re
import sys
from pathlib import Path
from types import FunctionType, ModuleType

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gait_robots import PRESETS, ROBOTS_AND_GAITS, preset, ring
from sample_guard import ALL_STANCE, INVALID_ANGLES, NAN, TICK, check_bounds, run, standing, walk
from sample_robots import random_hexapod
from tarsus.control.safety import Guard, GuardBounds, GuardState, InterventionKind
from tarsus.control.safety.scalar_geometry import LegModel
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.pose import Pose


@pytest.mark.lengthy
@pytest.mark.parametrize(("name", "gait"), ROBOTS_AND_GAITS)
def test_a_valid_walk_passes_unchanged(name, gait):
    motion = walk(name, gait)
    guard = Guard(preset(name))
    for i, angles in enumerate(motion.angles):
        output = guard.check(angles, TICK, motion.contacts[i], motion.body[i])
        assert output.ok
        assert output.interventions == ()
        assert output.angles.tobytes() == angles.tobytes()
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
        output = guard.check(motion.angles[i], (i - before) * TICK, motion.contacts[i])
        assert output.interventions == ()
        assert output.angles.tobytes() == motion.angles[i].tobytes()


def test_a_second_guard_passes_the_output_of_the_first():
    rng = np.random.default_rng(2)
    first = Guard(preset("strider"))
    second = Guard(preset("strider"), start=first.check(NAN, TICK).angles)
    limits = preset("strider").limits
    for tick in range(300):
        command = rng.uniform(limits[..., 0], limits[..., 1]) if tick % 20 == 0 else standing()
        sent = first.check(command, TICK).angles
        assert second.check(sent, TICK).angles.tobytes() == sent.tobytes()
    assert dict(second.counts) == {}
    assert first.counts


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


@pytest.mark.no_cover
@settings(max_examples=80)
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
