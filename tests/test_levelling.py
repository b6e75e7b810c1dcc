"""The ground plane against least squares of NumPy's, and the body's corrections against the geometry itself."""

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from sample_robots import hexapod
from tarsus import default_stance, inverse_kinematics, load_robot
from tarsus.control.filters import RateLimitedFilter
from tarsus.control.pose.attitude import CommandedAttitude, tilt_onto
from tarsus.control.pose.levelling import Correction, Levelling, com_shift_ratio
from tarsus.control.sensing.ground_plane import FLAT, GroundPlane, ground_plane
from tarsus.errors import InputError, UnknownNameError
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.pose import Pose

PAGE = (Path(__file__).parents[1] / "docs" / "ground.md").read_text(encoding="utf-8")
BEFORE = GroundPlane(1.0, 2.0, 3.0, 0.5, -0.25)
HERE = CommandedAttitude()
MOST_TILT, MOST_SHIFT = math.radians(20), 0.04


def random_feet(rng, batch=()):
    return rng.normal(size=(*batch, 6, 3)) * [0.2, 0.15, 0.02] + rng.normal(size=3) * [10, 10, 1]


def values(plane):
    return np.stack(
        np.broadcast_arrays(*(getattr(plane, name) for name in ("x", "y", "z", "slope_x", "slope_y"))), axis=-1
    )


# The plane.


@given(st.integers(0, 2**32 - 1), st.integers(3, 6))
def test_plane_agrees_with_lstsq(seed, count):
    rng = np.random.default_rng(seed)
    feet, contacts = random_feet(rng), rng.permutation(np.arange(6) < count)
    down = feet[contacts]
    matrix = np.column_stack([down[:, :2] - feet[0, :2], np.ones(count)])
    singular = np.linalg.svd(matrix[:, :2] - matrix[:, :2].mean(0), compute_uv=False)
    plane = ground_plane(feet, contacts, BEFORE)
    ratio = (singular[1] / singular[0]) ** 2
    want = np.linalg.lstsq(matrix, down[:, 2], rcond=None)[0]
    if ratio / (1 + ratio) ** 2 <= 0.05**2:  # as good as in a line
        want = [BEFORE.slope_x, BEFORE.slope_y, plane.height(*feet[0, :2])]
    np.testing.assert_allclose([plane.slope_x, plane.slope_y], want[:2], rtol=0, atol=1e-11)
    assert plane.height(*feet[0, :2]) == pytest.approx(want[2], abs=1e-11)
    assert plane.height(plane.x, plane.y) == plane.z


@given(st.integers(0, 2**32 - 1))
def test_a_plane_is_found_again_wherever_it_is(seed):
    rng = np.random.default_rng(seed)
    feet, (a, b, c) = random_feet(rng), rng.normal(size=3)
    feet[:, 2] = a * feet[:, 0] + b * feet[:, 1] + c
    plane = ground_plane(feet, np.ones(6, dtype=bool))
    np.testing.assert_allclose([plane.slope_x, plane.slope_y, plane.height(0.0, 0.0)], [a, b, c], rtol=0, atol=1e-10)


@given(st.integers(0, 2**32 - 1))
def test_batch_equals_loop(seed):
    rng = np.random.default_rng(seed)
    feet, contacts = random_feet(rng, (5, 4)), rng.random((5, 4, 6)) < 0.5
    feet[0] *= [0.0, 1.0, 1.0]  # in a line
    before = GroundPlane(*rng.normal(size=(5, 5, 4)))
    planes = ground_plane(feet, contacts, before)
    singles = [
        ground_plane(feet[at], contacts[at], GroundPlane(*values(before)[at].tolist())) for at in np.ndindex(5, 4)
    ]
    np.testing.assert_allclose(values(planes).reshape(20, 5), [values(s) for s in singles], rtol=0, atol=1e-11)
    np.testing.assert_array_equal(planes.height(np.zeros((5, 4)), 1.0).shape, (5, 4))
    # One robot's contacts for a batch of feet, and the other way.
    one = ground_plane(feet, contacts[0, 0])
    np.testing.assert_allclose(values(one)[2, 3], values(ground_plane(feet[2, 3], contacts[0, 0])), rtol=0, atol=1e-11)
    one = ground_plane(feet[2, 3], contacts)
    np.testing.assert_allclose(values(one)[1, 1], values(ground_plane(feet[2, 3], contacts[1, 1])), rtol=0, atol=1e-11)


def test_too_few_feet_or_feet_in_a_line_keep_the_slope_and_give_the_height():
    feet = np.array([[0, 0, 0.1], [1, 0, 0.2], [2, 0, 0.6], [3, 0.01, 0.0], [1, 1, 0], [np.nan] * 3])
    for contacts, height in (([1, 0, 0, 0, 0, 0], 0.1), ([1, 1, 0, 0, 0, 0], 0.15), ([1, 1, 1, 0, 0, 0], 0.3)):
        down = np.array(contacts, dtype=bool)
        plane = ground_plane(feet, down, BEFORE)
        mean = feet[down].mean(0)
        np.testing.assert_allclose(values(plane), [*mean, BEFORE.slope_x, BEFORE.slope_y], rtol=0, atol=1e-15)
        assert plane.z == pytest.approx(height)
    nearly = ground_plane(feet, np.array([1, 1, 1, 1, 0, 0], dtype=bool), BEFORE)
    assert (nearly.slope_x, nearly.slope_y) == (0.5, -0.25)
    assert ground_plane(feet, np.zeros(6, dtype=bool), BEFORE) is BEFORE
    assert ground_plane(feet, np.zeros(6, dtype=bool)) == FLAT == GroundPlane(0, 0, 0, 0, 0)
    same = np.array([[0.1, 0.2, 0.3]] * 6)
    assert values(ground_plane(same, np.ones(6, dtype=bool)))[3:] == pytest.approx([0, 0])


def test_wrong_feet_are_refused():
    feet, down = np.zeros((6, 3)), np.ones(6, dtype=bool)
    with pytest.raises(InputError, match=r"feet has shape \(5, 3\)"):
        ground_plane(feet[:5], down)
    with pytest.raises(InputError, match="contacts"):
        ground_plane(feet, [0.1] * 6)
    with pytest.raises(InputError, match="feet has shape"):
        ground_plane(feet, np.bool_(True))
    with pytest.raises(InputError, match="feet and contacts"):
        ground_plane(np.zeros((2, 6, 3)), np.ones((3, 6), dtype=bool))
    for batch in ((), (2,)):
        for wrong in (np.nan, np.inf, -1e9):
            with pytest.raises(InputError, match="a stance foot is NaN, infinite or more"):
                ground_plane(np.full((*batch, 6, 3), wrong), down)


# The follower: bounds, smoothness, an independent solution.


def follow(goals, dts, **bounds):
    follower = RateLimitedFilter(**bounds)
    return np.array([follower.step(goal, dt) for goal, dt in zip(goals, dts, strict=True)])


@given(st.integers(0, 2**32 - 1))
def test_follower_keeps_circle_rate_and_change_of_rate_whatever_the_goal(seed):
    rng = np.random.default_rng(seed)
    n = 400
    goals = rng.normal(size=(n, 2)) * 10.0 ** rng.integers(-3, 3, (n, 1))
    if seed % 2:  # bang-bang: as bad as it gets
        goals = np.repeat(rng.choice([-1.0, 1.0], (n // 20, 2)), 20, axis=0)
    goals[rng.random(n) < 0.05] = rng.choice([np.nan, np.inf, -np.inf], 2)
    dts = rng.uniform(0.001, 0.05, n)
    found = follow(goals.tolist(), dts.tolist(), radius=0.3, rate=0.2, frequency=8.0)
    assert np.hypot(*found.T).max() <= 0.3 + 1e-12
    moves = np.diff(found, axis=0, prepend=0.0)
    assert (np.hypot(*moves.T) <= 0.2 * dts + 1e-12).all()
    speeds = moves / dts[:, None]
    changes = np.abs(np.diff(speeds, axis=0)) / ((dts[1:] + dts[:-1]) / 2)[:, None]
    assert changes.max() <= 2 / math.e * 8.0 * 0.2 + 1e-9


def test_follower_agrees_with_an_integration_and_with_itself_in_other_ticks():
    goal, rate, w = (0.3, -0.1), 0.25, 6.0
    way = math.hypot(*goal)

    def motion(t, state):
        point = np.array(goal) * min(t * rate / way, 1.0)
        return [*state[2:], *(w * w * (point - state[:2]) - 2 * w * state[2:])]

    at = [0.4, 1.2, 3.0]
    want = solve_ivp(motion, (0, 3), [0] * 4, rtol=1e-10, atol=1e-12, max_step=0.01, t_eval=at).y[:2]
    for dt in (0.01, 0.05):
        found = np.array(follow([goal] * round(3 / dt), [dt] * round(3 / dt), radius=1.0, rate=rate, frequency=w))
        found = found[[round(t / dt) - 1 for t in at]].T
        # While the point runs, and long after, ticks don't matter; the tick in which it arrives spreads the arrival.
        np.testing.assert_allclose(found[:, [0, 2]], want[:, [0, 2]], rtol=0, atol=1e-6)
        np.testing.assert_allclose(found[:, 1], want[:, 1], rtol=0, atol=1e-6 if dt == 0.01 else 1e-3)
    np.testing.assert_allclose(found[:, 2], goal, rtol=0, atol=1e-4)


def test_follower_comes_to_exactly_nothing_and_stays_for_ticks_that_are_none():
    follower = RateLimitedFilter(1.0, rate=1.0, frequency=10.0)
    assert follower.step((0.0, 0.0), 0.01) == (0.0, 0.0)
    follower.step((1.0, 1.0), 0.1)
    there = follower.values
    for dt in (0.0, -1.0, math.nan, math.inf):
        assert follower.step((0.5, 0.5), dt) == there != (0.0, 0.0)
    for _ in range(1000):
        follower.step((0.0, 0.0), 0.01)
    assert follower.values == (0.0, 0.0)
    far = RateLimitedFilter(0.5, rate=1.0, frequency=10.0)
    for _ in range(400):
        far.step((0.36, 0.48), 0.01)
    assert far.values == pytest.approx((0.3, 0.4))
    # One tick of a week is as good as many.
    assert follower.step((0.6, 0.8), 1e6) == pytest.approx((0.6, 0.8), abs=1e-6)


# Tilting.


def rotation(roll, pitch, yaw=0.0):
    """What `Pose.from_rpy` gives (a test says so), in a tenth of the time: the loops below make many."""
    (cr, sr), (cp, sp), (cy, sy) = ((math.cos(a), math.sin(a)) for a in (roll, pitch, yaw))
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def leaning(matrix):
    """Roll and pitch of a rotation."""
    sine, *rest = matrix[2].tolist()
    return math.atan2(*rest), -math.asin(sine)


def test_rotations_are_the_projects():
    for angles in ((0.1, -0.2, 2.0), (-1.0, 0.5, -3.0)):
        np.testing.assert_allclose(rotation(*angles), Pose.from_rpy(*angles).rotation, rtol=0, atol=1e-15)
        np.testing.assert_allclose(leaning(rotation(*angles)), angles[:2], rtol=0, atol=1e-15)


@given(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(-0.4, 0.4), st.floats(-0.4, 0.4))
def test_tilt_onto_a_direction(roll, pitch, lean_roll, lean_pitch):
    """Seen from the direction, B leans as it was commanded to lean against z."""
    up = rotation(lean_roll, lean_pitch)[:, 2]
    more = tilt_onto(tuple(up), CommandedAttitude(roll, pitch))
    got = rotation(roll + more[0], pitch + more[1])
    np.testing.assert_allclose(got.T @ up, rotation(roll, pitch)[2], rtol=0, atol=1e-12)
    if not (roll or pitch):
        np.testing.assert_allclose(got[:, 2], up, rtol=0, atol=1e-12)


def test_signs_by_the_right_hand_rule():
    """Ground that rises ahead: nose up is a negative pitch. Ground that rises to the left: left side up, roll > 0."""
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
    """Run it on a robot whose frame G leans in the world, with an ideal sensor."""
    T_world_ground = rotation(slope_roll, slope_pitch)
    for _ in range(round(seconds / 0.05)):
        there = levelling.correction
        body = rotation(commanded.roll + there.roll, commanded.pitch + there.pitch, commanded.yaw)
        levelling.step(0.05, plane, leaning(T_world_ground @ body), commanded)
    return levelling.correction


@given(st.integers(0, 2**32 - 1), st.sampled_from(["level", "follow"]))
def test_the_centre_of_mass_stays_over_its_place_and_the_attitude_is_the_wished(seed, mode):
    """The true geometry: G leans in the world, the ground leans in G; projected along gravity, on the ground."""
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
    wished = origin + rotation(commanded.roll, commanded.pitch, commanded.yaw) @ com
    support = np.array([*wished[:2], plane.height(*wished[:2])])
    body = rotation(commanded.roll + got.roll, commanded.pitch + got.pitch, commanded.yaw)
    centre = origin + turn @ [got.x, got.y, 0] + body @ com
    # From the centre of mass down along gravity until the ground is met.
    down = T_world_ground.T @ [0, 0, -1]
    normal = np.array([-plane.slope_x, -plane.slope_y, 1])
    way = normal @ (support - centre) / (normal @ down)
    np.testing.assert_allclose(centre + way * down, support, rtol=0, atol=1e-9)
    if mode == "level":
        np.testing.assert_allclose(leaning(T_world_ground @ body), commanded[:2], rtol=0, atol=1e-9)
    else:
        normal /= np.linalg.norm(normal)
        np.testing.assert_allclose(body.T @ normal, rotation(*commanded[:2])[2], rtol=0, atol=1e-9)


def test_legs_that_lag_behind_are_made_up_for():
    """With the feet where they are and the links' masses counted, on the strider: within a tenth of a millimetre."""
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
    """Measured attitudes of a robot on ground that leans: `delay` late, commands carried out to a share."""
    rng = np.random.default_rng(seed)
    waiting = [(0.0, 0.0)] * round(delay / dt)
    ground, measured = rotation(*lean), []
    for _ in range(round(seconds / dt)):
        got = levelling.correction
        waiting.append((stiffness * got.roll, stiffness * got.pitch))
        measured.append(leaning(ground @ rotation(*waiting.pop(0))))
        noisy = rng.normal(size=2) * noise + measured[-1]
        levelling.step(dt, None, (float(noisy[0]), float(noisy[1])), CommandedAttitude(height=0.1))
    return np.array(measured)


@pytest.mark.parametrize("delay", [0.0, 0.02, 0.1])
@pytest.mark.parametrize("stiffness", [0.8, 1.0, 1.2])
@pytest.mark.parametrize("dt", [0.005, 0.05])
def test_levels_a_robot_that_is_late_and_soft_without_swinging(delay, stiffness, dt):
    measured = closed_loop(Levelling("level"), lean=(0.1, -0.2), delay=delay, dt=dt, stiffness=stiffness, seconds=15)
    np.testing.assert_allclose(measured[-1], 0, rtol=0, atol=1e-4)
    assert measured[:, 0].min() > -0.002  # 2 % of where it began
    assert measured[:, 1].max() < 0.004


def test_noise_is_averaged():
    measured = closed_loop(Levelling("level"), lean=(0.0, 0.1), delay=0.1, dt=0.01, noise=0.02)
    assert measured[1000:].std() < 0.003
    np.testing.assert_allclose(measured[1000:].mean(0), 0, rtol=0, atol=0.002)


def test_does_not_wind_up_at_its_bound():
    """Minutes on a slope steeper than the bound, then on level ground: it starts back at once."""
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
def test_without_attitude_it_fades_to_exactly_nothing(lost):
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


def test_what_no_robot_could_stand_on_still_gives_something_finite():
    for attitude in ((0.0, 1.57), (-1.57, 0.0), (3.0, 0.0)):
        levelling = Levelling("level", com=(0.0, 0.0, 0.05))
        got = settle(levelling, attitude=attitude, commanded=CommandedAttitude(0.0, 1.57, height=0.1))
        assert np.isfinite(got).all()
        assert math.hypot(got.roll, got.pitch) <= MOST_TILT + 1e-12


ODD = st.one_of(st.floats(), st.sampled_from([0.0, 0.3, math.nan, math.inf, 1e300]))


@given(st.lists(st.tuples(ODD, ODD, ODD, ODD, ODD, ODD, ODD, ODD, st.sampled_from([None, "level", "follow"]), ODD)))
def test_bounded_slow_and_smooth_whatever_comes_in(stream):
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
