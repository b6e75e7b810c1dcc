import math

import array_api_strict
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm

from gait_robots import HEXAPOD_GAITS, PRESETS, preset
from tarsus.gait.cycle import cycle_feet, tilted_body
from tarsus.gait.gait import Gait
from tarsus.gait.path import curved_path
from tarsus.gait.stroke import unit_twist
from tarsus.kinematics.stance import default_stance

PHASES = np.arange(240) / 240
TWISTS = [(0.06, 0.0, 0.0), (0.0, -0.05, 0.0), (0.03, 0.02, 0.2), (0.0, 0.0, 0.3), (0.0, 0.0, -0.3)]


def rest_of(name="strider"):
    robot = preset(name)
    return default_stance(robot, swing_height=robot.gait.swing_height) * [1, 1, 0]


def reference(gait, rest, twist, swing_height, phase):
    """One leg after the other, with matrices of the plane and the definition of the foothold."""
    x, y, yaw = twist
    se2 = np.array([[0, -yaw, x], [yaw, 0, y], [0, 0, 0]])
    feet, down = [], []
    for leg, offset in enumerate(gait.offsets):
        own = (phase - offset) % 1.0
        point = np.array([rest[leg, 0], rest[leg, 1], 1.0])
        # The body is at the origin now; the middle of its stance was so many stance times ago.
        middle = expm(-(own / gait.duty_factor - 0.5) * se2) @ point
        following = expm((1 / gait.duty_factor - (own / gait.duty_factor - 0.5)) * se2) @ point
        share = max(0.0, (own - gait.duty_factor) / (1 - gait.duty_factor))
        place = middle + (following - middle) * share**3 * (10 - 15 * share + 6 * share**2)
        feet.append([*place[:2], swing_height * 64 * share**3 * (1 - share) ** 3])
        down.append(own < gait.duty_factor)
    return np.array(feet), np.array(down)


@pytest.mark.parametrize("name", HEXAPOD_GAITS)
@pytest.mark.parametrize("twist", TWISTS)
def test_the_cycle_follows_its_definition_leg_by_leg(name, twist):
    gait, rest = Gait.named(name), rest_of()
    phases = (np.arange(8) + 0.41) / 8
    feet, contacts = cycle_feet(gait, rest, twist, swing_height=0.03, phases=phases)
    for i, phase in enumerate(phases):
        expected, down = reference(gait, rest, twist, 0.03, phase)
        np.testing.assert_allclose(feet[i], expected, atol=1e-14)
        np.testing.assert_array_equal(contacts[i], down)


@given(st.sampled_from(HEXAPOD_GAITS), st.floats(-0.1, 0.1), st.floats(-0.1, 0.1), st.floats(-0.6, 0.6))
def test_stances_are_straight_or_arcs_symmetric_about_rest(name, x, y, yaw):
    gait, rest = Gait.named(name), rest_of()
    for leg, offset in enumerate(gait.offsets):
        ends = np.array([offset, offset + gait.duty_factor / 2, offset + gait.duty_factor])
        feet, contacts = cycle_feet(gait, rest, (x, y, yaw), swing_height=0.02, phases=ends)
        assert contacts[:, leg].all()
        touchdown, middle, lift_off = feet[:, leg]
        np.testing.assert_allclose(middle, rest[leg], atol=1e-12)
        # Body-frame displacement of half a stance either way: the screw's forward and backward half.
        for end, sign in ((touchdown, 1), (lift_off, -1)):
            half = expm(sign * 0.5 * np.array([[0, -yaw, x], [yaw, 0, y], [0, 0, 0]]))
            np.testing.assert_allclose(end[:2], (half @ [*rest[leg, :2], 1])[:2], atol=1e-12)
        np.testing.assert_allclose(np.linalg.norm(touchdown - middle), np.linalg.norm(lift_off - middle), atol=1e-12)


def test_a_straight_stroke_goes_from_half_a_stroke_ahead_to_half_a_stroke_behind():
    gait, rest = Gait.named("tripod"), rest_of()
    feet, _ = cycle_feet(gait, rest, (0.08, 0.0, 0.0), swing_height=0.02, phases=np.array([0.0, 0.25, 0.5]))
    np.testing.assert_allclose(feet[:, 0] - rest[0], [[0.04, 0, 0], [0, 0, 0], [-0.04, 0, 0]], atol=1e-15)


@pytest.mark.parametrize("centre", [(0.0, 0.0), (0.0, 0.4), (0.0, -0.15), (0.3, 0.2), (-1.0, 5.0)])
def test_stances_of_a_curve_are_arcs_by_the_angle_of_source_001(centre):
    """Source 001: the foot farthest from the centre makes the stroke P, every foot turns by T = P / max(CP)."""
    gait, rest, stroke = Gait.named("wave"), rest_of(), 0.05
    twist = unit_twist(rest, curved_path(1.0, centre).displacement) * stroke
    radius = np.hypot(*(rest[:, :2] - centre).T)
    turn = stroke / radius.max()
    phases = np.linspace(0, 1, 400, endpoint=False)
    feet, contacts = cycle_feet(gait, rest, twist, swing_height=0.02, phases=phases)
    for leg in range(6):
        track = feet[contacts[:, leg], leg, :2] - centre
        np.testing.assert_allclose(np.hypot(*track.T), radius[leg], rtol=1e-12)
        angle = np.angle((track[:, 0] + 1j * track[:, 1]) / complex(*(rest[leg, :2] - centre)))
        ends, _ = cycle_feet(
            gait, rest, twist, swing_height=0.02, phases=gait.offsets[leg] + np.array([0, gait.duty_factor])
        )
        first, last = (complex(*(end[leg, :2] - centre)) / complex(*(rest[leg, :2] - centre)) for end in ends)
        assert np.angle(first) == pytest.approx(turn / 2, abs=1e-12)
        assert np.angle(last) == pytest.approx(-turn / 2, abs=1e-12)
        assert np.abs(angle).max() <= turn / 2 + 1e-12


@pytest.mark.parametrize("twist", TWISTS)
@pytest.mark.parametrize("duty_factor", [0.3, 0.5, 0.8, 0.95])
def test_the_cycle_is_closed_and_continuous(twist, duty_factor):
    gait = Gait(duty_factor, tuple(np.arange(6) / 6.3))
    rest = rest_of()
    first, _ = cycle_feet(gait, rest, twist, swing_height=0.03, phases=np.array([0.137]))
    again, _ = cycle_feet(gait, rest, twist, swing_height=0.03, phases=np.array([5.137]))
    np.testing.assert_allclose(again, first, atol=1e-12)
    moments = 4000
    feet, _ = cycle_feet(gait, rest, twist, swing_height=0.03, phases=np.arange(moments + 1) / moments)
    # The swing's fastest share of the way is 15/8 a swing time; lift and body add less than as much again.
    fastest = 4 * (0.12 / duty_factor + 0.03) / (1 - duty_factor)
    assert np.linalg.norm(np.diff(feet, axis=0), axis=-1).max() < fastest / moments


def test_swinging_feet_reach_the_swing_height_and_stay_above_the_ground():
    feet, contacts = cycle_feet(Gait.named("ripple"), rest_of(), (0.06, 0, 0), swing_height=0.03, phases=PHASES)
    assert feet[..., 2].min() == 0
    assert (feet[..., 2][contacts] == 0).all()
    np.testing.assert_allclose(feet[..., 2].max(0), 0.03, rtol=2e-3)


def test_a_batch_equals_its_loop():
    gait = Gait.named("ripple")
    rests = np.stack([rest_of(name) for name in PRESETS])[:, None]
    twists = np.array(TWISTS)
    swing_heights = np.linspace(0.01, 0.05, len(twists))
    feet, contacts = cycle_feet(gait, rests, twists, swing_height=swing_heights, phases=PHASES[:31])
    assert feet.shape == (len(PRESETS), len(twists), 31, 6, 3)
    assert contacts.shape == (31, 6)
    for i in range(len(PRESETS)):
        for j in range(len(twists)):
            one, down = cycle_feet(gait, rests[i, 0], twists[j], swing_height=swing_heights[j], phases=PHASES[:31])
            np.testing.assert_allclose(feet[i, j], one, atol=1e-14, rtol=0)
            np.testing.assert_array_equal(contacts, down)


@pytest.mark.no_cover
@pytest.mark.parametrize("library", [jnp, array_api_strict], ids=["jax", "strict"])
@pytest.mark.parametrize("given", ["rest", "twist", "swing_height", "phases"])
def test_any_argument_may_be_of_another_library(library, given):
    gait = Gait.named("tetrapod")
    args = {"rest": rest_of(), "twist": np.array(TWISTS), "swing_height": np.asarray(0.02), "phases": PHASES}
    expected, down = cycle_feet(
        gait, args["rest"], args["twist"], swing_height=args["swing_height"], phases=args["phases"]
    )
    args[given] = library.asarray(args[given])
    feet, contacts = cycle_feet(
        gait, args["rest"], args["twist"], swing_height=args["swing_height"], phases=args["phases"]
    )
    assert not isinstance(feet, np.ndarray)
    np.testing.assert_allclose(np.asarray(feet), expected, atol=1e-14, rtol=0)
    np.testing.assert_array_equal(np.asarray(contacts), down)


@pytest.mark.no_cover
def test_feet_are_differentiable_in_the_stroke_under_jit():
    gait, rest = Gait.named("tripod"), rest_of()
    direction = unit_twist(rest, (1.0, 0.3, 2.0))

    @jax.jit
    def feet(stroke):
        return cycle_feet(gait, rest, stroke * direction, swing_height=0.03, phases=PHASES[:40])[0]

    step = 1e-6
    difference = (np.asarray(feet(0.06 + step)) - np.asarray(feet(0.06 - step))) / (2 * step)
    np.testing.assert_allclose(jax.jacobian(feet)(0.06), difference, atol=1e-12)
    zero = jax.jacobian(feet)(0.0)
    assert np.isfinite(np.asarray(zero)).all()


@given(
    st.floats(-1, 1),
    st.floats(-1, 1),
    st.floats(-3, 3),
    st.floats(0.01, 0.3),
    st.floats(-0.6, 0.6),
    st.floats(-0.6, 0.6),
    st.integers(0, 2**32 - 1),
)
def test_the_ground_relative_to_a_tilted_body_is_the_plane_of_source_001(x, y, yaw, body_height, roll, pitch, seed):
    """``z = -G + x tan(..) + y tan(..)``, corrected: slopes by the right-hand rule, G measured along the body's z."""
    body = tilted_body(np.array([x, y, yaw]), body_height=np.asarray(body_height), body_tilt=(roll, pitch))
    ground = np.random.default_rng(seed).uniform(-2, 2, (6, 3)) * [1, 1, 0]
    seen = body.inverse() @ ground
    along_z = body_height / (math.cos(pitch) * math.cos(roll))
    plane = -along_z + seen[:, 0] * math.tan(pitch) / math.cos(roll) - seen[:, 1] * math.tan(roll)
    np.testing.assert_allclose(seen[:, 2], plane, atol=1e-12)
    np.testing.assert_allclose(body.rpy, [roll, pitch, math.remainder(yaw, math.tau)], atol=1e-12)
    np.testing.assert_array_equal(body.position, [x, y, body_height])
