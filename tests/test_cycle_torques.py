"""Cycle torques of a batch of designs against the general functions, one design at a time."""

import dataclasses
import math

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gait_robots import HEXAPOD_GAITS
from robots import random_robot, seeds
from sample_loads import robot_of
from sample_robots import hexapod
from tarsus.errors import InputError, MissingDataError, UnreachableError
from tarsus.gait.cycle import cycle_feet
from tarsus.gait.gait import Gait
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stance import default_body_height, default_stance
from tarsus.load import cycle_sweep
from tarsus.load.contact import contact_forces
from tarsus.load.cycle_torques import cycle_torques
from tarsus.load.payload import Payload
from tarsus.load.planar_statics import weight_fractions
from tarsus.load.torque import joint_torques
from tarsus.robot.robot import stack_robots

TRIPOD = Gait.named("tripod")
PARTS = ("angles", "torques", "forces")


def step_by_step(robot, gait, *, stroke, heading=0.0, body_height, swing_height, phases, payload=0.0):
    """Cycle of one design by the general functions."""
    feet, contacts = cycle_feet(
        gait,
        default_stance(robot, body_height, swing_height=swing_height),
        np.array([stroke * math.cos(heading), stroke * math.sin(heading), 0.0]),
        swing_height=np.asarray(swing_height),
        phases=np.arange(phases) / phases,
    )
    body = Pose(position=(0, 0, body_height))
    solution = inverse_kinematics(robot, feet + np.array([0, 0, body_height]), body)
    torques, forces = joint_torques(robot, solution.angles, body, contacts, payload)
    margin = contact_forces(robot, solution.angles, body, contacts, payload=payload).margin
    return solution, torques, forces, margin


def assert_same(found, index, expected):
    solution, torques, forces, margin = expected
    np.testing.assert_array_equal(found.reach[index], solution.reach)
    np.testing.assert_allclose(found.angles[index], solution.angles, atol=1e-9)
    np.testing.assert_allclose(found.forces[index], forces, atol=1e-9)
    np.testing.assert_allclose(found.torques[index], torques, atol=1e-9)
    clear = np.abs(margin) > 1e-9
    np.testing.assert_array_equal(found.balanced[index][clear], (margin > 0)[clear])


def sized(count, rng, robot=None):
    """Designs with random lengths."""
    robot = hexapod() if robot is None else robot
    scale = rng.uniform(0.8, 1.2, (3, count, 1))
    return robot.replace(
        **{name: getattr(robot, name) * scale[i] for i, name in enumerate(("coxa", "femur", "tibia"))},
        body_mass=rng.uniform(0.5, 3, count),
        body_com=rng.uniform(-0.02, 0.02, (count, 3)),
        link_mass=rng.uniform(0, 0.2, (count, 6, 3)),
    )


@pytest.mark.parametrize("gait", HEXAPOD_GAITS)
@pytest.mark.parametrize("name", ["strider", "phantomx", "ch3r", "freenove"])
def test_presets_match_the_general_functions(name, gait):
    robot = robot_of(name)
    if not robot.has_masses:
        robot = robot.replace(body_mass=1.0, link_mass=np.full((6, 3), 0.05))
    options = {
        "stroke": 0.03,
        "heading": 0.4,
        "body_height": default_body_height(robot),
        "swing_height": 0.02,
        "phases": 12,
    }
    found = cycle_torques(robot, Gait.named(gait), payload=Payload(0.4, (0.03, -0.01, 0.05)), **options)
    expected = step_by_step(robot, Gait.named(gait), payload=Payload(0.4, (0.03, -0.01, 0.05)), **options)
    assert_same(found, (), expected)
    assert found.torques.shape == (12, 6, 3)
    np.testing.assert_allclose(found.peak, np.abs(expected[1]).max((0, 1)), atol=1e-12)
    assert found.ok == bool(expected[0].ok.all() and (expected[3] >= 0).all())


@pytest.mark.no_cover
@given(seed=seeds(), gait=st.sampled_from(HEXAPOD_GAITS), heading=st.floats(-4, 4))
def test_batch_equals_loop(seed, gait, heading):
    rng = np.random.default_rng(seed)
    together = sized(3, rng)
    stroke, body_height = rng.uniform(0.01, 0.09, 3), rng.uniform(0.08, 0.13, 3)
    gait = Gait.named(gait)
    found = cycle_torques(
        together, gait, stroke=stroke, heading=heading, body_height=body_height, swing_height=0.02, phases=9
    )
    for i in range(3):
        options = {
            "stroke": stroke[i],
            "body_height": body_height[i],
            "swing_height": 0.02,
            "phases": 9,
            "heading": heading,
        }
        assert_same(found, (i,), step_by_step(together.item((i,)), gait, **options))


@given(seed=seeds())
def test_offset_axes_and_different_legs(seed):
    rng = np.random.default_rng(seed)
    robot = random_robot(rng, legs=6, limits="full").replace(
        body_mass=1.5, link_mass=rng.uniform(0, 0.2, (6, 3)), body_com=rng.uniform(-0.05, 0.05, 3)
    )
    body_height = default_body_height(robot)
    options = {"stroke": 0.02, "body_height": body_height, "swing_height": 0.0, "phases": 8}
    assert_same(cycle_torques(robot, TRIPOD, **options), (), step_by_step(robot, TRIPOD, **options))


def test_unreachable_strokes_give_the_nearest_pose():
    rng = np.random.default_rng(3)
    together = sized(40, rng)
    stroke = np.where(np.arange(40) % 3 == 0, 0.45, 0.05)
    found = cycle_torques(together, TRIPOD, stroke=stroke, body_height=0.1, swing_height=0.02, phases=8)
    assert (found.reach != 0).any((1, 2))[stroke > 0.4].all()
    assert not found.ok[stroke > 0.4].any()
    assert found.ok[stroke < 0.4].any()
    for i in range(0, 40, 4):
        options = {"stroke": stroke[i], "body_height": 0.1, "swing_height": 0.02, "phases": 8}
        assert_same(found, (i,), step_by_step(together.item((i,)), TRIPOD, **options))


def test_knees_below_the_ground():
    robot = hexapod(limits=np.broadcast_to(np.deg2rad([[-60, 60], [-90, 90], [-170, 170]]), (6, 3, 2)))
    low = robot.replace(mount_position=robot.mount_position * 1.0)
    options = {"stroke": 0.02, "body_height": -0.02, "swing_height": 0.0, "phases": 4}
    found = cycle_torques(low, TRIPOD, **options)
    expected = step_by_step(low, TRIPOD, **options)
    assert (np.asarray(expected[0].reach) == 6).any()
    assert_same(found, (), expected)


def test_foot_on_a_joint_axis():
    """A coxa of zero length and a foot that passes through the coxa axis, where its direction is undefined."""
    robot = hexapod(coxa=np.zeros(6), femur=np.full(6, 0.1), tibia=np.full(6, 0.1), link_com=np.zeros((6, 3)))
    rest = default_stance(robot, 0.1, swing_height=0.0)
    out = float(np.linalg.norm((rest - robot.mount_position)[1, :2]))
    options = {"stroke": 2 * out, "heading": math.pi / 2, "body_height": 0.1, "swing_height": 0.0, "phases": 4}
    found = cycle_torques(robot, TRIPOD, **options)
    assert np.isfinite(found.torques).all()
    assert_same(found, (), step_by_step(robot, TRIPOD, **options))


def test_batches_of_several_axes_and_broadcast_arguments():
    rng = np.random.default_rng(5)
    together = sized(4, rng)
    grid = together.replace(**{name: getattr(together, name)[:, None] for name in ("coxa", "femur", "tibia")})
    grid = grid.replace(
        body_mass=together.body_mass[:, None],
        body_com=together.body_com[:, None],
        link_mass=together.link_mass[:, None],
    )
    strokes = np.array([0.02, 0.05, 0.4])
    found = cycle_torques(grid, TRIPOD, stroke=strokes, body_height=0.1, swing_height=0.02, phases=6)
    assert found.torques.shape == (4, 3, 6, 6, 3)
    assert found.reach.shape == (4, 3, 6, 6)
    assert found.balanced.shape == (4, 3, 6)
    assert found.peak.shape == (4, 3, 3)
    for i, j in ((0, 0), (3, 1), (2, 2)):
        options = {"stroke": strokes[j], "body_height": 0.1, "swing_height": 0.02, "phases": 6}
        assert_same(found, (i, j), step_by_step(together.item((i,)), TRIPOD, **options))
    alone = cycle_torques(hexapod(), TRIPOD, stroke=strokes, body_height=0.1, swing_height=0.02, phases=6)
    assert alone.torques.shape == (3, 6, 6, 3)


def test_blocks_do_not_change_the_result(monkeypatch):
    together = sized(11, np.random.default_rng(6))
    whole = cycle_torques(together, TRIPOD, stroke=0.05, body_height=0.1, swing_height=0.02, phases=5)
    monkeypatch.setattr(cycle_sweep, "_BLOCK_SIZE", 100)
    cut = cycle_torques(together, TRIPOD, stroke=0.05, body_height=0.1, swing_height=0.02, phases=5)
    for part in (*PARTS, "reach", "balanced"):
        np.testing.assert_array_equal(getattr(cut, part), getattr(whole, part))


def test_a_body_below_the_ground_is_not_possible():
    heights, strider = np.array([0.005, 0.0169, 0.017, 0.1]), robot_of("strider")

    def cycle(height):
        robot = stack_robots([strider] * 4) if height.shape else strider
        found = cycle_torques(robot, TRIPOD, stroke=0.02, body_height=height, phases=4)
        return found.body_depth, found.ok

    for depth, ok in (cycle(heights), jax.jit(cycle)(jnp.asarray(heights))):
        np.testing.assert_allclose(depth, 0.017 - heights, atol=1e-9)
        np.testing.assert_array_equal(ok, [False, False, True, True])
    assert not cycle(heights[0])[1]


def test_tipping_robot():
    back = hexapod(body_com=np.array([-0.7, 0.0, 0.0]))
    options = {"stroke": 0.05, "body_height": 0.11, "swing_height": 0.02, "phases": 8}
    found = cycle_torques(back, TRIPOD, **options)
    assert not found.ok
    assert not found.balanced.all()
    assert_same(found, (), step_by_step(back, TRIPOD, **options))


@given(seed=seeds(), feet=st.integers(1, 6))
def test_fractions_are_non_negative_and_balance(seed, feet):
    rng = np.random.default_rng(seed)
    x, y = rng.uniform(-1, 1, (2, feet, 20))
    fractions, balanced = weight_fractions(np, x, y)
    assert (fractions >= 0).all()
    np.testing.assert_allclose(fractions.sum(0), 1, atol=1e-9)
    moments = np.stack([(fractions * x).sum(0), (fractions * y).sum(0)])
    np.testing.assert_allclose(moments[:, balanced], 0, atol=1e-9)
    assert feet > 2 or not balanced.any()


def test_jax_agrees_for_unreachable_feet_and_tipping_robots():
    together = sized(3, np.random.default_rng(7)).replace(body_com=np.array([[0, 0, 0], [0, 0, 0], [-0.7, 0, 0]]))

    def cycle(stroke):
        found = cycle_torques(
            together, TRIPOD, stroke=stroke, body_height=0.1, swing_height=0.02, phases=4, payload=0.2
        )
        return [getattr(found, part) for part in (*PARTS, "reach", "balanced", "peak", "ok")]

    stroke = np.array([0.05, 0.4, 0.05])
    expected = cycle(stroke)
    for mine, wanted in zip(jax.jit(cycle)(jnp.asarray(stroke)), expected, strict=True):
        assert isinstance(mine, jax.Array)
        np.testing.assert_allclose(np.asarray(mine), wanted, atol=1e-9)
    np.testing.assert_array_equal(expected[-1], [True, False, False])


@pytest.mark.no_cover
def test_gradient_against_finite_differences(monkeypatch):
    # Every foot is within reach; one correction towards the nearest reachable point compiles in half the time.
    monkeypatch.setattr("tarsus.kinematics.nearest._STEP_SIZES", (1.0,))
    robot = hexapod()

    def peak(scale):
        longer = robot.replace(femur=robot.femur * scale)
        return cycle_torques(longer, TRIPOD, stroke=0.05, body_height=0.1, swing_height=0.02, phases=4).peak[1]

    value, slope = jax.jit(jax.value_and_grad(peak))(1.0)
    assert float(value) == pytest.approx(float(peak(1.0)))
    assert float(slope) == pytest.approx(float((peak(1 + 1e-6) - peak(1 - 1e-6)) / 2e-6), rel=1e-5)


def test_stacked_robots():
    robots = [robot_of("strider").replace(body_mass=mass) for mass in (1.0, 2.0)]
    found = cycle_torques(stack_robots(robots), TRIPOD, stroke=0.05)
    for i, robot in enumerate(robots):
        alone = cycle_torques(robot, TRIPOD, stroke=0.05)
        np.testing.assert_allclose(found.torques[i], alone.torques, atol=1e-12)
    np.testing.assert_array_equal(found.phases, np.arange(32) / 32)
    assert found.contacts.shape == (32, 6)


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"phases": 0}, "phases is 0"),
        ({"phases": 1.5}, "phases is 1.5"),
        ({"phases": math.nan}, "phases is nan"),
        ({"heading": math.inf}, "heading is inf"),
        ({"stroke": math.nan}, "stroke is nan"),
        ({"swing_height": math.inf}, "swing_height is inf"),
        ({"stroke": -0.06}, "^stroke is -0.06 m; it must be a finite number, not negative$"),
        ({"stroke": 0.0}, "^stroke is 0; it must be greater than 0$"),
        ({"stroke": np.array([[0.05, 0.0]])}, r"^stroke\[0, 1\] is 0; it must be greater than 0$"),
        ({"stroke": jnp.array([0.05, -1.0])}, r"^stroke\[1\] is -1 m; it must be a finite number, not negative$"),
        ({"stroke": np.full(2, 0.05), "body_height": np.full(3, 0.1)}, "don't broadcast"),
        ({"gait": Gait.named("wave", legs=8)}, "is for 8 legs"),
        ({"gait": Gait(duty_factor=0.4, offsets=(0.0, 0.5) * 3)}, "no foot is on the ground at phase 0.4"),
        ({"payload": -1.0}, "payload"),
    ],
)
def test_invalid_arguments(changes, text):
    asked = {"gait": TRIPOD, "stroke": 0.05, **changes}
    with pytest.raises(InputError, match=text):
        cycle_torques(robot_of("strider"), asked.pop("gait"), **asked)


def test_missing_masses_and_unreachable_ground():
    with pytest.raises(MissingDataError, match="mass_kg"):
        cycle_torques(robot_of("strider").replace(body_mass=None), TRIPOD, stroke=0.05)
    with pytest.raises(UnreachableError, match="does not reach the ground"):
        cycle_torques(robot_of("strider"), TRIPOD, stroke=0.05, body_height=2.0)


def test_traced_torques_have_no_table():
    found, tables = cycle_torques(hexapod(), Gait.named("tripod"), stroke=0.03, phases=4), []

    def keep(torques):
        tables.append(dataclasses.replace(found, torques=torques)._rows())
        return torques

    jax.jit(keep)(jnp.asarray(found.torques))
    assert tables == [()]
    assert [row["joint"] for row in found._rows()] == ["coxa", "femur", "tibia"]
