"""Corrections of the body pose against the geometry of robot, ground and gravity."""

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sample_robots import hexapod
from tarsus import default_stance, inverse_kinematics, load_robot
from tarsus.control.pose.attitude import CommandedAttitude, tilt_onto
from tarsus.control.pose.levelling import Correction, Levelling, com_shift_ratio
from tarsus.control.sensing.ground_plane import GroundPlane
from tarsus.errors import InputError, UnknownNameError
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.pose import Pose

PAGE = (Path(__file__).parents[1] / "docs" / "ground.md").read_text(encoding="utf-8")
HERE = CommandedAttitude()
MOST_TILT, MOST_SHIFT = math.radians(20), 0.04


def rotation(roll, pitch, yaw=0.0):
    """A rotation as from `Pose.from_rpy`, ten times as fast."""
    (cr, sr), (cp, sp), (cy, sy) = ((math.cos(a), math.sin(a)) for a in (roll, pitch, yaw))
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def roll_and_pitch(matrix):
    """Roll and pitch of a rotation."""
    sine, *rest = matrix[2].tolist()
    return math.atan2(*rest), -math.asin(sine)


def test_rotations_equal_those_of_poses():
    for angles in ((0.1, -0.2, 2.0), (-1.0, 0.5, -3.0)):
        np.testing.assert_allclose(rotation(*angles), Pose.from_rpy(*angles).rotation, rtol=0, atol=1e-15)
        np.testing.assert_allclose(roll_and_pitch(rotation(*angles)), angles[:2], rtol=0, atol=1e-15)


@given(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(-0.4, 0.4), st.floats(-0.4, 0.4))
def test_tilt_onto_a_direction(roll, pitch, lean_roll, lean_pitch):
    """B has the commanded attitude relative to the direction."""
    up = rotation(lean_roll, lean_pitch)[:, 2]
    more = tilt_onto(tuple(up), CommandedAttitude(roll, pitch))
    got = rotation(roll + more[0], pitch + more[1])
    np.testing.assert_allclose(got.T @ up, rotation(roll, pitch)[2], rtol=0, atol=1e-12)
    if not (roll or pitch):
        np.testing.assert_allclose(got[:, 2], up, rtol=0, atol=1e-12)


def test_signs_by_the_right_hand_rule():
    """Ground rising ahead gives a negative pitch, ground rising to the left a positive roll."""
    level = CommandedAttitude(height=0.1)
    follow_ = Levelling("follow")
    ahead = settle(follow_, plane=GroundPlane(slope_x=0.1))
    assert ahead.pitch == pytest.approx(-math.atan(0.1))
    assert ahead.roll == pytest.approx(0, abs=1e-9)
    left = settle(Levelling("follow"), plane=GroundPlane(slope_y=0.1))
    assert left.roll == pytest.approx(math.atan(0.1))
    assert left.pitch == pytest.approx(0, abs=1e-9)
    turned = settle(Levelling("follow"), plane=GroundPlane(slope_x=0.1), commanded=level._replace(yaw=math.pi / 2))
    assert turned.roll == pytest.approx(-math.atan(0.1))  # facing y, what rises along x rises to the right
    # Feet on a slope that the walker takes for level: B is measured nose up, so it has to go nose down,
    # and forward, which is uphill, by h tan(slope).
    slope = math.atan(0.1)
    got = settle_in_the_world(Levelling("level"), slope_pitch=-slope, commanded=level)
    assert got.pitch == pytest.approx(slope, abs=1e-6)
    assert got.x == pytest.approx(0.1 * 0.1, abs=1e-6)
    got = settle_in_the_world(Levelling("follow"), slope_pitch=-slope, commanded=level)
    assert got.pitch == pytest.approx(0, abs=1e-6)
    assert got.x == pytest.approx(0.1 * 0.1, abs=1e-6)


def settle(levelling, *, plane=None, attitude=None, commanded=HERE, seconds=30.0):
    for _ in range(round(seconds / 0.05)):
        levelling.step(0.05, plane, attitude, commanded)
    return levelling.correction


def settle_in_the_world(levelling, *, slope_roll=0.0, slope_pitch=0.0, plane=None, commanded=HERE, seconds=30.0):
    """Simulate a robot whose frame G is tilted in the world, with an ideal sensor."""
    T_world_ground = rotation(slope_roll, slope_pitch)
    for _ in range(round(seconds / 0.05)):
        there = levelling.correction
        body = rotation(commanded.roll + there.roll, commanded.pitch + there.pitch, commanded.yaw)
        levelling.step(0.05, plane, roll_and_pitch(T_world_ground @ body), commanded)
    return levelling.correction


@given(st.integers(0, 2**32 - 1), st.sampled_from(["level", "follow"]))
def test_centre_of_mass_and_attitude_are_kept_on_a_slope(seed, mode):
    """Exact geometry: G is tilted in the world, the ground in G; projected along gravity onto the ground."""
    rng = np.random.default_rng(seed)
    com = rng.uniform(-0.03, 0.03, 3)
    commanded = CommandedAttitude(*rng.uniform(-0.15, 0.15, 2), yaw=rng.uniform(-3, 3), height=rng.uniform(0.05, 0.15))
    plane = GroundPlane(*rng.normal(size=3), *rng.uniform(-0.15, 0.15, 2))
    lean = rng.uniform(-0.15, 0.15, 2)
    levelling = Levelling(mode, com=tuple(com), max_shift=1.0, max_tilt=1.0, gain=5.0)
    got = settle_in_the_world(
        levelling, slope_roll=lean[0], slope_pitch=lean[1], plane=plane, commanded=commanded, seconds=10
    )

    T_world_ground, turn = rotation(*lean), rotation(0, 0, commanded.yaw)
    over = np.array([0.3, -0.2])  # B's origin without correction, in G
    origin = np.array([*over, plane.height(*over) + commanded.height])
    wanted = origin + rotation(commanded.roll, commanded.pitch, commanded.yaw) @ com
    support = np.array([*wanted[:2], plane.height(*wanted[:2])])
    body = rotation(commanded.roll + got.roll, commanded.pitch + got.pitch, commanded.yaw)
    centre = origin + turn @ [got.x, got.y, 0] + body @ com
    # From the centre of mass down along gravity until the ground is met.
    down = T_world_ground.T @ [0, 0, -1]
    normal = np.array([-plane.slope_x, -plane.slope_y, 1])
    way = normal @ (support - centre) / (normal @ down)
    np.testing.assert_allclose(centre + way * down, support, rtol=0, atol=1e-9)
    if mode == "level":
        np.testing.assert_allclose(roll_and_pitch(T_world_ground @ body), commanded[:2], rtol=0, atol=1e-9)
    else:
        normal /= np.linalg.norm(normal)
        np.testing.assert_allclose(body.T @ normal, rotation(*commanded[:2])[2], rtol=0, atol=1e-9)


def test_the_mass_of_the_legs_is_compensated():
    """On the strider, with fixed feet and the masses of its links: within a tenth of a millimetre."""
    robot = load_robot("strider")
    feet = default_stance(robot)
    angles = inverse_kinematics(robot, feet).require().angles
    share = com_shift_ratio(robot, feet)
    body_share = float(robot.body_mass / (robot.body_mass + robot.link_mass.sum()))
    assert body_share < share < 1
    assert f"(strider: {share:.2f})" in PAGE
    com = centre_of_mass(robot, angles)
    height = -float(feet[0, 2])
    got = settle_in_the_world(
        Levelling("follow", com=tuple(com), com_shift_ratio=share),
        slope_pitch=-0.15,
        commanded=CommandedAttitude(height=height),
    )
    body = Pose(position=np.array([got.x, got.y, height]))
    standing = inverse_kinematics(robot, feet + np.array([0, 0, height]), body=body).require().angles
    centre = body @ centre_of_mass(robot, standing)
    want = com[:2] + np.array([(height + com[2]) * math.tan(0.15), 0])
    np.testing.assert_allclose(centre[:2], want, rtol=0, atol=1e-4)
    assert com_shift_ratio(hexapod(link_mass=None, body_mass=None), feet) == pytest.approx(1.0)


# The loop through the real robot: late, soft, noisy.


def closed_loop(levelling, *, lean, delay, dt, stiffness=1.0, noise=0.0, seconds=40.0, seed=0):
    """Measured attitudes of a robot on a slope, with delay and partly executed commands."""
    rng = np.random.default_rng(seed)
    waiting = [(0.0, 0.0)] * round(delay / dt)
    ground, measured = rotation(*lean), []
    for _ in range(round(seconds / dt)):
        got = levelling.correction
        waiting.append((stiffness * got.roll, stiffness * got.pitch))
        measured.append(roll_and_pitch(ground @ rotation(*waiting.pop(0))))
        noisy = rng.normal(size=2) * noise + measured[-1]
        levelling.step(dt, None, (float(noisy[0]), float(noisy[1])), CommandedAttitude(height=0.1))
    return np.array(measured)


@pytest.mark.parametrize("delay", [0.0, 0.02, 0.1])
@pytest.mark.parametrize("stiffness", [0.8, 1.0, 1.2])
@pytest.mark.parametrize("dt", [0.005, 0.05])
def test_it_settles_without_overshoot_under_delay_and_compliance(delay, stiffness, dt):
    measured = closed_loop(Levelling("level"), lean=(0.1, -0.2), delay=delay, dt=dt, stiffness=stiffness, seconds=15)
    np.testing.assert_allclose(measured[-1], 0, rtol=0, atol=1e-4)
    assert measured[:, 0].min() > -0.002  # 2 % of where it began
    assert measured[:, 1].max() < 0.004


def test_noise_is_averaged():
    measured = closed_loop(Levelling("level"), lean=(0.0, 0.1), delay=0.1, dt=0.01, noise=0.02)
    assert measured[1000:].std() < 0.003
    np.testing.assert_allclose(measured[1000:].mean(0), 0, rtol=0, atol=0.002)


def test_does_not_wind_up_at_its_bound():
    """After minutes on a slope steeper than the bound, the correction decreases immediately on level ground."""
    dt, levelling = 0.05, Levelling("level", max_tilt=0.1)
    closed_loop(levelling, lean=(0.0, -0.3), delay=0.1, dt=dt, seconds=120)
    assert levelling.correction.pitch == pytest.approx(0.1)
    assert levelling.lean[0] == pytest.approx(math.sin(0.3), abs=1e-6)
    closed_loop(levelling, lean=(0.0, 0.0), delay=0.0, dt=dt, seconds=3)
    assert levelling.correction.pitch < 0.05
    after_shorter = Levelling("level", max_tilt=0.1)
    closed_loop(after_shorter, lean=(0.0, -0.3), delay=0.1, dt=dt, seconds=20)
    closed_loop(after_shorter, lean=(0.0, 0.0), delay=0.0, dt=dt, seconds=3)
    assert after_shorter.correction.pitch == pytest.approx(levelling.correction.pitch, abs=1e-6)


@pytest.mark.parametrize("lost", [None, (math.nan, 0.0), (0.0, math.inf)])
def test_without_attitude_it_decays_to_zero(lost):
    levelling = Levelling("level", com=(0.01, 0.0, 0.02))
    settle(levelling, attitude=(0.1, 0.2), commanded=CommandedAttitude(0.05, 0.02, 1.0, 0.1), seconds=3)
    assert min(map(abs, levelling.correction)) > 0.001
    settle(levelling, attitude=lost, commanded=CommandedAttitude(0.05, 0.02, 1.0, 0.1), seconds=40)
    assert levelling.correction == Correction(0, 0, 0, 0)
    assert levelling.lean == (0.0, 0.0)
    never = Levelling("level", com=(0.01, 0.0, 0.02))
    assert (
        settle(never, attitude=lost, plane=GroundPlane(slope_x=0.3), commanded=CommandedAttitude(height=0.1))
        == Correction()
    )


def test_modes():
    levelling = Levelling()
    assert levelling.mode is None
    args = {"plane": GroundPlane(slope_x=0.1), "attitude": (0.0, 0.1), "commanded": CommandedAttitude(height=0.1)}
    assert settle(levelling, **args) == Correction()
    levelling.mode = "follow"
    assert settle(levelling, **args).pitch == pytest.approx(-math.atan(0.1))
    levelling.mode = None
    assert settle(levelling, **args) == Correction()
    with pytest.raises(UnknownNameError, match=r"no levelling mode is called 'flollow'\. Did you mean 'follow'"):
        levelling.mode = "flollow"
    for name in ("com_shift_ratio", "gain", "max_tilt", "max_shift", "tilt_rate", "shift_rate", "frequency"):
        with pytest.raises(InputError, match=f"{name} is 0; it must be a positive number"):
            Levelling("level", **{name: 0})
    for com in ((0.0, 0.0), (0.0, 0.0, math.nan)):
        with pytest.raises(InputError, match="com is"):
            Levelling("level", com=com)


def test_extreme_slopes_give_finite_corrections():
    for attitude in ((0.0, 1.57), (-1.57, 0.0), (3.0, 0.0)):
        levelling = Levelling("level", com=(0.0, 0.0, 0.05))
        got = settle(levelling, attitude=attitude, commanded=CommandedAttitude(0.0, 1.57, height=0.1))
        assert np.isfinite(got).all()
        assert math.hypot(got.roll, got.pitch) <= MOST_TILT + 1e-12


ODD = st.one_of(st.floats(), st.sampled_from([0.0, 0.3, math.nan, math.inf, 1e300]))


@given(st.lists(st.tuples(ODD, ODD, ODD, ODD, ODD, ODD, ODD, ODD, st.sampled_from([None, "level", "follow"]), ODD)))
def test_bounds_rates_and_smoothness_hold_for_any_input(stream):
    levelling = Levelling(com=(0.01, -0.02, 0.03))
    last, speed = np.zeros(4), np.zeros(4)
    for slope_x, slope_y, roll, pitch, *commanded, mode, odd_dt in stream:
        levelling.mode = mode
        plane = GroundPlane(slope_x=slope_x, slope_y=slope_y) if odd_dt == odd_dt else None
        before = levelling.correction
        if not 0 < odd_dt < math.inf:
            assert levelling.step(odd_dt, plane, (roll, pitch), CommandedAttitude(*commanded)) == before
        for _ in range(3):
            moving = math.isfinite(sum(commanded))
            now = np.array(levelling.step(0.02, plane, (roll, pitch), CommandedAttitude(*commanded)))
            assert np.isfinite(now).all()
            assert math.hypot(*now[:2]) <= MOST_SHIFT + 1e-12
            assert math.hypot(*now[2:]) <= MOST_TILT + 1e-12
            new = (now - last) / 0.02
            assert math.hypot(*new[:2]) <= 0.05 + 1e-9
            assert math.hypot(*new[2:]) <= 0.3 + 1e-9
            if moving:
                most = np.array([0.05, 0.05, 0.3, 0.3]) * 2 / math.e * 8.0
                assert (np.abs(new - speed) / 0.02 <= most + 1e-9).all()
                speed = new
            last = now
