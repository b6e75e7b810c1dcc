import math
import re

import array_api_strict
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robots import plain_hexapod, random_robot, robots, seeds
from tarsus.errors import InputError, UnreachableError
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.stance import (
    default_body_height,
    default_stance,
    foothold_distances,
    footholds_straight_out,
    reachable_band,
    stance_or_nan,
)
from tarsus.kinematics.underside import belly_depth
from tarsus.robot.robot import GaitDefaults, stack_robots

STEPS = 4001


def reached(robot, leg, distance, height):
    """Whether the leg reaches so far straight out, so high in B, by the textbook's law of cosines."""
    f, t = robot.femur[leg], robot.tibia[leg]
    r, z = distance - robot.coxa[leg], height - robot.mount_position[leg, 2] - robot.femur_axis_offset[leg, 1]
    d = np.hypot(r, z)
    with np.errstate(invalid="ignore", divide="ignore"):
        femur = np.arctan2(z, r) + np.arccos((f * f + d * d - t * t) / (2 * f * d))
        tibia = np.arccos((f * f + t * t - d * d) / (2 * f * t)) - np.pi
    femur = (femur + np.pi) % (2 * np.pi) - np.pi
    (_, _), (low, high), (bent, straight) = robot.limits[leg]
    return (femur >= low) & (femur <= high) & (tibia >= bent) & (tibia <= straight)


def scanned_bands(robot, leg, height):
    """All runs of reachable distances on a fine grid, as ``(first, last)``."""
    grid = np.linspace(0, robot.coxa[leg] + robot.femur[leg] + robot.tibia[leg], STEPS)
    works = np.concatenate([[False], reached(robot, leg, grid, height), [False]])
    edges = np.flatnonzero(np.diff(works.astype(int)))
    return [(grid[a], grid[b - 1]) for a, b in edges.reshape(-1, 2)], grid[1]


@given(robot=robots(), seed=seeds())
def test_the_band_is_the_widest_that_a_scan_finds(robot, seed):
    rng = np.random.default_rng(seed)
    height = rng.uniform(-0.3, 0.1)
    nearest, farthest = reachable_band(robot, height)
    for leg in range(robot.legs):
        bands, step = scanned_bands(robot, leg, height)
        widest = max((b - a for a, b in bands), default=0.0)
        if np.isnan(nearest[leg]):
            assert widest <= step
            continue
        found = farthest[leg] - nearest[leg]
        assert found >= widest - 1e-12
        if found <= 2 * step:
            continue
        a, b = min(bands, key=lambda band: abs(band[0] - nearest[leg]))
        assert abs(a - nearest[leg]) <= step
        assert abs(b - farthest[leg]) <= step


@given(robot=robots(), seed=seeds())
def test_the_ends_of_the_band_are_exact(robot, seed):
    """A nanometre inside works, a nanometre outside doesn't."""
    height = np.random.default_rng(seed).uniform(-0.3, 0.1)
    nearest, farthest = reachable_band(robot, height)
    for leg in np.flatnonzero(farthest - nearest > 1e-6):
        assert reached(robot, leg, nearest[leg] + 1e-9, height)
        assert reached(robot, leg, farthest[leg] - 1e-9, height)
        assert not reached(robot, leg, farthest[leg] + 2e-9, height)
        assert nearest[leg] == 0 or not reached(robot, leg, nearest[leg] - 2e-9, height)


def test_the_band_of_a_free_leg_is_the_ring_between_folded_and_straight():
    robot = plain_hexapod(limits=np.tile([[-3, 3], [-np.pi, np.pi], [-np.pi, 0]], (6, 1, 1)))
    nearest, farthest = reachable_band(robot, -0.15)
    assert np.abs(farthest - (0.068 + np.sqrt(0.279**2 - 0.15**2))).max() <= 1e-15
    assert nearest.tolist() == [0.0] * 6
    assert np.isnan(reachable_band(robot, -0.28)).all()


def test_a_leg_that_only_bends_upwards_has_the_band_of_its_mirror_image():
    limits = np.tile(np.deg2rad([[-60, 60], [-80, 60], [-150, -10]]), (6, 1, 1))
    down = plain_hexapod(limits=limits)
    up = plain_hexapod(limits=-limits[..., ::-1])
    found, expected = reachable_band(up, 0.12), reachable_band(down, -0.12)
    assert np.isfinite(expected).all()
    assert np.abs(np.array(found) - np.array(expected)).max() <= 1e-15


@given(robot=robots(), height=st.floats(0.02, 0.25), swing_height=st.sampled_from([0.0, 0.02]))
def test_every_default_foothold_is_reached_on_the_ground_and_lifted(robot, height, swing_height):
    try:
        feet = default_stance(robot, height, swing_height=swing_height)
    except UnreachableError:
        return
    assert np.array_equal(feet[:, 2], np.full(robot.legs, -height))
    for rise in (0, swing_height):
        angles = inverse_kinematics(robot, feet + np.array([0, 0, rise])).require().angles
        straight = np.clip(0, robot.limits[:, 0, 0], robot.limits[:, 0, 1])
        middle = sum(np.array(v) for v in reachable_band(robot, -height)) / 2
        assert np.abs(angles[:, 0] - straight)[middle > 1e-6].max(initial=0) <= 1e-9


@given(robot=robots(), height=st.floats(0.02, 0.25))
def test_a_default_foothold_is_in_the_middle_of_its_band(robot, height):
    nearest, farthest = reachable_band(robot, -height)
    if np.isnan(nearest).any():
        with pytest.raises(UnreachableError):
            default_stance(robot, height, swing_height=0)
        return
    feet = default_stance(robot, height, swing_height=0) - robot.mount_position
    far = np.hypot(*feet[:, :2].T)
    assert np.abs(far - np.hypot((nearest + farthest) / 2, robot.femur_axis_offset[:, 0])).max() <= 1e-15


@pytest.mark.parametrize("seed", [1, 2])
def test_a_leg_stands_where_a_scan_finds_a_foothold_for_both_heights(seed):
    """Also with several separate bands at either height, of which the widest ones have no distance in common."""
    rng = np.random.default_rng(seed)
    femur, tibia = (np.sort(rng.uniform(low, high, (200, 6, 2))) for low, high in ((-2.1, 2.1), (-3, 1.1)))
    limits = np.stack([np.broadcast_to([-1.0, 1.0], femur.shape), femur, tibia], axis=-2)
    for some in limits:
        robot = plain_hexapod(limits=some)
        height, rise = rng.uniform(0.02, 0.2), rng.uniform(0, 0.06)
        found = stance_or_nan(robot, height, swing_height=rise)[:, 0]
        grid = np.linspace(0, 0.35, STEPS)
        for leg in range(6):
            works = reached(robot, leg, grid, -height) & reached(robot, leg, grid, rise - height)
            assert not (np.isnan(found[leg]) and works[:-1][works[1:]].any()), (seed, leg)


def test_a_coxa_whose_limits_exclude_0_stands_at_its_limit():
    limits = np.tile(np.deg2rad([[20, 60], [-80, 100], [-160, 10]]), (6, 1, 1))
    limits[3:, 0] = np.deg2rad([-60, -25])
    robot = plain_hexapod(limits=limits, femur_axis_offset=np.tile([0.01, 0], (6, 1)))
    angles = inverse_kinematics(robot, default_stance(robot, 0.1)).require().angles
    assert np.abs(angles[:, 0] - np.deg2rad([20, 20, 20, -25, -25, -25])).max() <= 1e-12


def test_the_default_body_height_is_that_of_the_file_or_from_the_lengths():
    robot = plain_hexapod()
    assert default_body_height(robot) == pytest.approx(0.181 - 0.098 / 2, abs=1e-15)
    short = robot.replace(tibia=np.full(6, 0.08))
    assert default_body_height(short) == pytest.approx(0.04, abs=1e-15)
    raised = robot.replace(mount_position=robot.mount_position + np.array([0, 0, 0.02]))
    assert default_body_height(raised) == pytest.approx(0.132 - 0.02, abs=1e-15)
    assert default_body_height(robot.replace(gait=GaitDefaults(body_height=0.11))) == 0.11
    assert default_body_height(stack_robots([robot, short])) == pytest.approx(0.04, abs=1e-15)
    assert np.array_equal(default_stance(robot), default_stance(robot, default_body_height(robot)))


def test_the_error_names_the_leg_and_the_possible_body_heights():
    robot = plain_hexapod(tibia=np.array([0.181, 0.181, 0.12, 0.181, 0.181, 0.181]))
    with pytest.raises(UnreachableError) as caught:
        default_stance(robot, 0.25, swing_height=0)
    text = str(caught.value)
    assert text.startswith(
        "body height 250.0 mm: leg LR does not reach the ground within its joint limits; all legs do at"
    )
    low, high, nearest = (float(v) / 1000 for v in re.findall(r"(-?\d+\.\d) (?:and|mm$|mm,)", text))
    # The femur at its -80 deg and the tibia upright: 98 sin 80 deg + 120 = 216.51 mm; the body lies on the ground at 0.
    assert (low, high, nearest) == (0.0, 0.2165, 0.2165)
    for works in (low, high, nearest):
        assert np.isfinite(default_stance(robot, works, swing_height=0)).all()
    with pytest.raises(UnreachableError):
        default_stance(robot, high + 1e-4, swing_height=0)


@pytest.mark.parametrize(
    ("changes", "least"),
    [
        ({"body_size": [0.24, 0.16, 0.05], "foot_radius": np.full(6, 0.008)}, 17.0),
        ({"body_size": [0.24, 0.16, 0.01], "foot_radius": np.full(6, 0.008)}, 0.0),
        ({"mount_position": "lower"}, 30.0),
        ({"mount_position": "higher"}, -400.0),
    ],
)
def test_the_body_heights_that_an_error_names_leave_the_body_above_the_ground(changes, least):
    robot = plain_hexapod()
    if "mount_position" in changes:
        up = {"lower": -0.03, "higher": 0.4}[changes["mount_position"]]
        changes = {"mount_position": robot.mount_position + np.array([0, 0, up])}
    with pytest.raises(UnreachableError, match=f"all legs do at body heights between {least} and .* mm"):
        default_stance(robot.replace(**changes), 0.9, swing_height=0)


@pytest.mark.parametrize("size", [3, 30])
def test_an_error_of_a_large_robot_names_the_ends_of_its_body_heights(size):
    """Also where it looks at few heights at first: the ends are those at which the legs just reach the ground."""
    robot = plain_hexapod()
    lengths = ("mount_position", "coxa", "femur", "tibia")
    large = robot.replace(**{name: size * getattr(robot, name) for name in lengths})
    with pytest.raises(UnreachableError) as caught:
        default_stance(large, -1.0 * size, swing_height=0)
    low, high, nearest = (float(v) for v in re.findall(r"(-?\d+\.\d) (?:and|mm$|mm,)", str(caught.value)))
    assert (low, nearest) == (0, 0)
    assert high == math.floor(size * (0.098 * math.sin(math.radians(80)) + 0.181) * 1e4) / 10


@given(robot=robots(), body_height=st.floats(-1, 1), swing_height=st.sampled_from([0.0, 0.03]))
def test_every_body_height_that_an_error_names_is_possible(robot, body_height, swing_height):
    try:
        default_stance(robot, body_height, swing_height=swing_height)
    except UnreachableError as error:
        text = str(error)
        assert ("with a swing height of 30.0 mm" in text) == (swing_height > 0)
        if "there is no body height" in text:
            for height in belly_depth(robot) + np.linspace(0, 1, 5):
                with pytest.raises(UnreachableError):
                    default_stance(robot, height, swing_height=swing_height)
            return
        named = re.search(r"between (-?[\d.]+) and (-?[\d.]+) mm, the nearest is (-?[\d.]+) mm$", text).groups()
        for works in named:
            assert np.isfinite(default_stance(robot, float(works) / 1000, swing_height=swing_height)).all()


def test_an_error_says_where_no_body_height_is_possible():
    limits = np.array(plain_hexapod().limits)
    limits[0, 1:] = np.deg2rad([[80, 90], [-20, 0]])
    limits[3, 1:] = np.deg2rad([[-80, -70], [-20, 0]])
    with pytest.raises(UnreachableError, match=r"there is no body height above the ground at which all legs do$"):
        default_stance(plain_hexapod(limits=limits), 0.1)


def test_in_a_batch_the_error_names_body_height_and_design():
    robot = plain_hexapod()
    with pytest.raises(UnreachableError, match=r"^\[2\] body height 900.0 mm: leg LF .*the nearest is 277.5 mm$"):
        default_stance(robot, np.array([0.05, 0.11, 0.9]))
    short = robot.replace(tibia=np.full(6, 0.03))
    with pytest.raises(UnreachableError, match=r"^\[1\] body height 150.0 mm: leg LF .*between .* and 126.5 mm"):
        default_stance(stack_robots([robot, short]), 0.15)


def test_a_batch_equals_its_loop():
    rng = np.random.default_rng(1)
    designs = [random_robot(rng) for _ in range(50)]
    heights = np.linspace(-0.1, 0.02, 7)
    batch = stack_robots(designs)
    column = batch.replace(
        **{
            name: np.expand_dims(getattr(batch, name), 1)
            for name in ("mount_position", "mount_yaw", "coxa", "femur", "tibia", "femur_axis_offset", "limits")
        }
        | {name: np.expand_dims(getattr(batch, name), 1) for name in ("foot_radius", "link_com", "body_com")}
    )
    found = np.array(reachable_band(column, heights))
    assert found.shape == (2, 50, 7, 6)
    for i, design in enumerate(designs):
        for j, height in enumerate(heights):
            assert np.array_equal(found[:, i, j], np.array(reachable_band(design, height)), equal_nan=True)


@pytest.mark.parametrize("part", ["coxa", "femur", "tibia", "mount_position", "limits", "femur_axis_offset"])
def test_a_batch_in_one_argument_equals_its_loop(part):
    robot = random_robot(np.random.default_rng(3))
    shares = np.linspace(0.98, 1.02, 5)
    values = np.asarray(getattr(robot, part))
    batch = robot.replace(**{part: np.stack([share * values for share in shares])})
    designs = [robot.replace(**{part: share * values}) for share in shares]
    height = -float(np.asarray(robot.tibia).max()) / 2
    found = np.array(reachable_band(batch, height))
    expected = np.stack([np.array(reachable_band(design, height)) for design in designs], axis=1)
    assert np.array_equal(found, expected, equal_nan=True)
    assert np.isfinite(found).any()
    body_height = np.full(5, -height)
    for swing_height in (0.0, np.linspace(0, 0.01, 5)):
        feet = stance_or_nan(batch, body_height, swing_height=swing_height)
        rises = np.broadcast_to(swing_height, 5)
        loop = [stance_or_nan(design, -height, swing_height=rise) for design, rise in zip(designs, rises, strict=True)]
        assert np.array_equal(feet, np.stack(loop), equal_nan=True)


@pytest.mark.parametrize("xp", [jnp, array_api_strict])
def test_other_libraries_agree_with_numpy(xp):
    robot = random_robot(np.random.default_rng(2))
    heights = np.linspace(-0.2, 0.1, 20)
    for found, expected in zip(reachable_band(robot, xp.asarray(heights)), reachable_band(robot, heights), strict=True):
        assert type(found) is type(xp.zeros(1))
        assert np.allclose(np.asarray(found), expected, rtol=0, atol=1e-15, equal_nan=True)


def test_under_jit_the_stance_agrees_with_numpy_and_is_nan_without_a_foothold():
    robot = plain_hexapod()
    stance = jax.jit(lambda body_height: default_stance(robot, body_height, swing_height=0.03))
    assert np.abs(np.asarray(stance(0.11)) - default_stance(robot, 0.11, swing_height=0.03)).max() <= 1e-15
    assert np.isnan(np.asarray(stance(0.9))[:, 0]).all()


def test_the_gradient_with_respect_to_a_length_is_the_finite_difference():
    robot = plain_hexapod()

    def far(tibia, body_height):
        return (default_stance(robot.replace(tibia=tibia), body_height, swing_height=0.03)[..., :2] ** 2).sum()

    step = 1e-6 * np.eye(6)
    expected = [(far(robot.tibia + h, 0.11) - far(robot.tibia - h, 0.11)) / 2e-6 for h in step]
    found = jax.jit(jax.grad(far))(jnp.asarray(robot.tibia), 0.11)
    assert np.abs(np.asarray(found) - expected).max() <= 1e-9
    own = jax.grad(lambda tibia: default_body_height(robot.replace(tibia=tibia)))(robot.tibia - 0.01 * np.eye(6)[0])
    assert np.abs(np.asarray(own) - np.eye(6)[0]).max() <= 1e-15


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda r: default_stance(r, np.nan), "^body_height is nan; it must be a finite number$"),
        (lambda r: default_stance(r, np.inf), "body_height is inf"),
        (lambda r: default_stance(r, [0.1, np.nan]), r"body_height\[1\] is nan"),
        (lambda r: default_stance(r, "high"), "body_height: expected an array of real numbers"),
        (lambda r: default_stance(r, 0.1, swing_height=np.inf), "swing_height is inf"),
        (lambda r: reachable_band(r, np.nan), "height is nan"),
        (lambda r: reachable_band(r, 1j), "height: expected an array of real numbers"),
    ],
)
def test_invalid_arguments_are_refused(call, message):
    with pytest.raises(InputError, match=message):
        call(plain_hexapod())


@given(robot=robots(), seed=seeds())
def test_distances_are_those_of_the_footholds_straight_out(robot, seed):
    distances = np.random.default_rng(seed).uniform(0.05, 0.3, (4, robot.legs))
    feet = footholds_straight_out(robot, distances, np.linspace(-0.2, 0.0, 4))
    assert (feet[..., 2] == np.linspace(-0.2, 0.0, 4)[:, None]).all()
    np.testing.assert_allclose(foothold_distances(robot, feet), distances, rtol=0, atol=1e-9)
