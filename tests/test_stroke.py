import math

import numpy as np
import pytest

from gait_robots import HEXAPOD_GAITS, PRESETS, ROBOTS_AND_GAITS, point_feet, ring
from tarsus.errors import CollisionError, InputError, StrokeError, UnreachableError
from tarsus.gait.branch import branches
from tarsus.gait.excursion import extreme_excursions, walk_excursions
from tarsus.gait.gait import Gait
from tarsus.gait.path import BodyPath, curved_path, straight_path
from tarsus.gait.plan import plan_walk
from tarsus.gait.spacing import default_foot_distance, feet_distance, passing_distance
from tarsus.gait.stroke import max_stroke, unit_twist
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.stance import default_stance, default_swing_height
from tarsus.robot.robot import stack_robots

DIRECTIONS = {
    "forward": (1.0, 0.0, 0.0),
    "aside": (math.cos(2.0), math.sin(2.0), 0.0),
    "curve": (1.0, 0.0, 2.0),
    "tight": (0.3, -1.0, -6.0),
    "turn": (0.0, 0.0, 1.0),
}
IMPOSSIBLE = ("out of reach", "jumps", "feet too close")


def walk_of(robot, gait, direction, *, stroke, cycles):
    """A path of a number of cycles at cruising speed."""
    rest = default_stance(robot, swing_height=default_swing_height(robot))
    return BodyPath(tuple(unit_twist(rest, direction) * stroke / gait.duty_factor * cycles))


def works(robot, gait, direction, *, stroke, cycles, of, **more):
    """Whether a walk is possible, from its samples alone."""
    path = walk_of(robot, gait, direction, stroke=of, cycles=cycles)
    motion = plan_walk(robot, gait, path, stroke=stroke, cycle_time=1.0, rate=150, strict=False, **more)
    return not any(problem.startswith(IMPOSSIBLE) for problem in motion.problems)


@pytest.mark.lengthy
@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize(("robot", "name"), ROBOTS_AND_GAITS)
def test_walks_are_possible_up_to_the_longest_stroke_and_refused_beyond(robot, name, direction):
    robot, gait, direction = point_feet(robot), Gait.named(name), DIRECTIONS[direction]
    longest = max_stroke(robot, gait, direction)
    assert longest > 0.02
    # A different length of walk for every case: start and stop meet the cycle at other moments.
    cycles = 0.4 + 3.2 * ((len(robot.name) * 0.37 + HEXAPOD_GAITS.index(name) * 0.23 + longest * 7) % 1.0)
    path = walk_of(robot, gait, direction, stroke=longest, cycles=cycles)
    motion = plan_walk(robot, gait, path, stroke=0.999 * longest, cycle_time=1.0, rate=60)
    assert not [problem for problem in motion.problems if problem.startswith(IMPOSSIBLE)]
    path = walk_of(robot, gait, direction, stroke=longest, cycles=3.55)
    with pytest.raises((StrokeError, CollisionError)) as refused:
        plan_walk(robot, gait, path, stroke=1.02 * longest, cycle_time=1.0, rate=40)
    if isinstance(refused.value, StrokeError):
        assert refused.value.longest == longest
        plan_walk(robot, gait, path, stroke=refused.value.longest, cycle_time=1.0, rate=40)
    assert f"{longest * 1000:.1f} mm" in str(refused.value)


@pytest.mark.lengthy
@pytest.mark.parametrize(
    ("robot", "name", "direction"),
    [("strider", "tripod", "forward"), ("phantomx", "wave", "curve"), ("phoenix", "ripple", "turn")],
)
def test_the_longest_stroke_equals_a_bisection_over_whole_walks(robot, name, direction):
    """Over walks of several lengths, the shortest limit: never less than `max_stroke`, at most 2 per cent more."""
    robot, gait, direction = point_feet(robot), Gait.named(name), DIRECTIONS[direction]
    longest = max_stroke(robot, gait, direction)
    limits = []
    for cycles in (1.0, 1.25, 2.0, 3.1, 3.55, 3.7):
        low, high = 0.9 * longest, 1.2 * longest
        while high - low > 1e-3 * longest:
            middle = (low + high) / 2
            good = works(robot, gait, direction, stroke=middle, cycles=cycles, of=longest)
            low, high = (middle, high) if good else (low, middle)
        limits.append(low)
    assert 0.999 * longest <= min(limits) <= 1.02 * longest


@pytest.mark.parametrize("robot", PRESETS)
def test_every_shorter_stroke_is_possible(robot):
    robot, gait = point_feet(robot), Gait.named("tripod")
    for direction in DIRECTIONS.values():
        longest = max_stroke(robot, gait, direction)
        for share in (0.02, 0.3, 0.7, 0.9):
            path = walk_of(robot, gait, direction, stroke=share * longest, cycles=1.3)
            plan_walk(robot, gait, path, stroke=share * longest, cycle_time=1.0, rate=40)


def scan(robot, gait, heading, body_height, swing_height):
    """The longest straight stroke by an independent scan: feet by the definition, legs checked through their angles."""
    rest = default_stance(robot, body_height, swing_height=swing_height) * [1, 1, 0]
    way = np.array([math.cos(heading), math.sin(heading), 0.0])
    s = np.linspace(0, 1, 60)
    ground, height = s**3 * (10 - 15 * s + 6 * s**2), swing_height * 64 * s**3 * (1 - s) ** 3
    step = 1 / gait.duty_factor
    along = np.concatenate([np.linspace(0.5, -0.5, 40), -0.5 + step * ground - (step - 1) * s])
    up = np.concatenate([np.zeros(40), height])
    strokes = np.arange(1e-3, 0.6, 1e-3)
    feet = rest + (strokes[:, None] * along)[..., None, None] * way + up[:, None, None] * [0, 0, 1]
    solution = inverse_kinematics(robot, feet - [0, 0, body_height])
    limits = np.asarray(robot.limits)
    within = (solution.angles > limits[..., 0] - 1e-6) & (solution.angles < limits[..., 1] + 1e-6)
    hits = np.abs(forward_kinematics(robot, solution.angles)[..., 3, :] + [0, 0, body_height] - feet).max(-1) < 1e-9
    knees = solution.angles[..., 2] <= 1e-9
    works = (within.all(-1) & hits & knees).all((1, 2))
    return strokes[int(np.argmin(works)) - 1] if not works[0] or not works.all() else strokes[-1]


@pytest.mark.lengthy
@pytest.mark.parametrize(
    ("robot", "heading"), [("strider", 0.0), ("ch3r", 0.9), ("makeyourpet", math.pi / 2), ("phantomx-mk2", 0.9)]
)
def test_the_longest_stroke_against_an_independent_scan_of_the_steady_cycle(robot, heading):
    """Excursions during start and stop exceed those of the steady cycle scanned: at most 5 per cent of the stroke."""
    robot, gait = point_feet(robot), Gait.named("tetrapod")
    steady = scan(robot, gait, heading, robot.gait.body_height, robot.gait.swing_height)
    assert 0.95 * steady <= max_stroke(robot, gait, heading) <= steady + 1e-3


def test_the_worst_leg_of_a_direction_limits_the_stroke():
    robot, gait = ring(6), Gait.named("tripod")
    limits = np.array(robot.limits)
    limits[1, 0] = [-0.2, 0.2]
    stiff = robot.replace(limits=limits)
    # The middle left leg points to the left: walking forward turns its coxa, walking to the left does not.
    assert max_stroke(stiff, gait, 0.0) < 0.5 * max_stroke(robot, gait, 0.0)
    assert max_stroke(stiff, gait, math.pi / 2) > 0.95 * max_stroke(robot, gait, math.pi / 2)
    # The coxa angle at the end of a stroke bounds it: 0.2 rad at the radius of the rest foothold.
    rest = default_stance(stiff, swing_height=default_swing_height(stiff))[1] - stiff.mount_position[1]
    half = math.hypot(*rest[:2]) * math.tan(0.2)
    assert 1.6 * half < max_stroke(stiff, gait, 0.0) < 2 * half


def test_headings_and_twists_of_any_size_are_equivalent():
    robot, gait = point_feet("strider"), Gait.named("ripple")
    expected = max_stroke(robot, gait, (math.cos(0.4), math.sin(0.4), 0.0))
    assert max_stroke(robot, gait, 0.4) == expected
    assert max_stroke(robot, gait, np.float64(0.4)) == expected
    assert max_stroke(robot, gait, np.asarray(0.4)) == expected
    assert max_stroke(robot, gait, (1e-200, 0, 0)) == max_stroke(robot, gait, (1e200, 0, 0)) == max_stroke(robot, gait)


def test_strokes_of_a_symmetric_robot_are_symmetric():
    robot, gait = point_feet("strider"), Gait.named("wave")
    assert max_stroke(robot, gait, math.pi) == pytest.approx(max_stroke(robot, gait, 0.0), rel=2e-3)
    assert max_stroke(robot, gait, 0.5) == pytest.approx(max_stroke(robot, gait, -0.5), rel=2e-3)
    assert max_stroke(robot, gait, (1, 0, 3)) == pytest.approx(max_stroke(robot, gait, (1, 0, -3)), rel=2e-3)


def test_swing_height_tilt_and_foot_distance_shorten_the_stroke():
    robot, gait = point_feet("strider"), Gait.named("tripod")
    usual = max_stroke(robot, gait)
    assert max_stroke(robot, gait, swing_height=0.09) < usual
    assert max_stroke(robot, gait, body_tilt=(0.2, 0.1)) < usual
    rest = default_stance(robot, swing_height=robot.gait.swing_height)
    apart = float(feet_distance(rest)[0])
    near = max_stroke(robot, gait, foot_distance=0.9 * apart)
    assert 0 < near < usual
    with pytest.raises(CollisionError, match="are possible"):
        plan_walk(robot, gait, straight_path(1.0), stroke=1.03 * near, cycle_time=1.0, foot_distance=0.9 * apart)
    plan_walk(robot, gait, straight_path(1.0), stroke=0.999 * near, cycle_time=1.0, foot_distance=0.9 * apart)


def test_the_stroke_is_0_where_stepping_on_the_spot_is_impossible():
    robot, gait = point_feet("strider"), Gait.named("tripod")
    assert max_stroke(robot, gait, foot_distance=1.0) == 0
    assert max_stroke(robot, gait, body_tilt=(0.9, 0.0)) == 0


def test_the_search_ends_at_its_upper_bound():
    """With every coxa axis in the origin, turning on the spot only turns coxas: no stroke fails that is tried."""
    wide = np.array(ring(6).limits)
    wide[:, 0] = [-math.pi, math.pi]
    robot = ring(6, mount_position=np.zeros((6, 3)), limits=wide)
    longest = max_stroke(robot, Gait.named("tripod"), (0, 0, 1), foot_distance=0.0)
    assert longest == pytest.approx(0.998 * 2 * 0.25)


@pytest.mark.parametrize(("legs", "gait"), [(5, "ripple"), (7, "wave"), (8, "tetrapod")])
def test_robots_with_other_numbers_of_legs(legs, gait):
    robot, gait = ring(legs), Gait.named(gait, legs=legs)
    for direction in (0.3, (0.0, 0.0, 1.0), (1.0, 0.0, 4.0)):
        longest = max_stroke(robot, gait, direction)
        assert longest > 0.05
        assert works(robot, gait, direction, stroke=0.999 * longest, cycles=2.3, of=longest)


def test_no_foot_moves_behind_its_coxa_axis():
    """mithi has no limits: it could reach behind its coxa axes, with a jump of half a turn."""
    robot, gait = point_feet("mithi"), Gait.named("tripod")
    for direction in ((0, 0, 1), (0, 1, 1), (0.9, 0.5, 0)):
        longest = max_stroke(robot, gait, direction)
        path = walk_of(robot, gait, direction, stroke=longest, cycles=2.0)
        motion = plan_walk(robot, gait, path, stroke=longest, cycle_time=1.0, rate=400)
        assert not branches(robot, motion.angles)[..., 0].any()
        jump = plan_walk(robot, gait, path, stroke=1.1 * longest, cycle_time=1.0, rate=400, strict=False)
        assert branches(robot, jump.angles)[..., 0].any() or jump.reach.any()


@pytest.mark.parametrize("duty_factor", [0.3, 0.5, 2 / 3, 0.95])
@pytest.mark.parametrize("curved", [False, True])
def test_no_walk_exceeds_the_extreme_excursions(duty_factor, curved):
    """Against walks with other lengths and offsets than those that the extremes were picked from."""
    extremes = extreme_excursions(duty_factor, curved=curved)
    levels = np.unique(extremes.up.round(12))
    bound = [np.abs(extremes.offset[np.abs(extremes.up - level) < 1e-9]).max() for level in levels]
    rng = np.random.default_rng(7)
    for _ in range(4):
        walk = walk_excursions(Gait(duty_factor, tuple(rng.uniform(0, 1, 7))))
        air = walk.up > 0
        assert (np.abs(walk.offset[air]) <= np.interp(walk.up[air], levels, bound) + 0.02).all()
        assert np.abs(walk.offset[~air]).max() <= 0.5 + 1e-9


def test_feet_of_excursions():
    rest = default_stance(point_feet("strider"), swing_height=0.03) * [1, 1, 0]
    moments = walk_excursions(Gait.named("tripod"))
    feet = moments.feet(rest, np.array([[0.1, 0.0, 0.0], [0.0, 0.2, 0.0]]), 0.03)
    assert feet.shape == (2, len(moments.up), 6, 3)
    np.testing.assert_allclose(
        feet[0] - rest, np.stack([0.1 * moments.offset, 0 * moments.up, 0.03 * moments.up], -1), atol=1e-15
    )
    np.testing.assert_allclose(
        feet[1] - rest, np.stack([0 * moments.up, 0.2 * moments.offset, 0.03 * moments.up], -1), atol=1e-15
    )


def test_branches_distinguish_facing_and_knee():
    robot = ring(4)
    angles = np.deg2rad([[[0, 30, -60], [0, 30, 40], [0, 130, 60], [0, 100, -10]]] * 2)
    np.testing.assert_array_equal(
        branches(robot, angles)[0], [[False, False], [False, True], [True, True], [False, False]]
    )


def test_default_swing_height_and_foot_distance():
    robot = point_feet("strider")
    assert default_swing_height(robot) == robot.gait.swing_height
    assert default_foot_distance(robot) == 2 * float(np.max(robot.foot_radius)) + 0.01
    assert default_swing_height(ring(6)) == pytest.approx((0.12 - 0.04) / 4)


def test_feet_distance_returns_the_closest_pair():
    feet = np.array([[0, 0, 0], [1, 0, 0], [1, 0.1, 0.2], [5, 5, 5.0]])
    distance, pair = feet_distance(np.stack([feet, feet[::-1]]))
    np.testing.assert_allclose(distance, math.hypot(0.1, 0.2))
    np.testing.assert_array_equal(pair, [[1, 2], [1, 2]])


def test_feet_that_pass_each_other_between_samples_are_found():
    start = np.array([[0.0, 0, 0], [1.0, 0.03, 0], [9, 9, 0]])
    feet = np.stack([start, [[1.0, 0, 0], [0.0, 0.03, 0], [9, 9, 0]], [[1.0, 0, 0], [0.0, 0.03, 0], [9, 9, 0]]])
    distance, pair = passing_distance(feet)
    np.testing.assert_allclose(distance, [0.03, math.hypot(1, 0.03)])
    np.testing.assert_array_equal(pair, [[0, 1], [0, 1]])
    rng = np.random.default_rng(3)
    moves = rng.normal(size=(2, 5, 3))
    fine = moves[0] + np.linspace(0, 1, 3001)[:, None, None] * (moves[1] - moves[0])
    assert passing_distance(moves)[0][0] == pytest.approx(feet_distance(fine)[0].min(), abs=1e-5)


def test_invalid_arguments_are_refused():
    robot, gait = point_feet("strider"), Gait.named("tripod")
    with pytest.raises(InputError, match="single robot, not for a batch"):
        max_stroke(stack_robots([robot, robot]), gait)
    with pytest.raises(InputError, match="for 8 legs, the robot has 6"):
        max_stroke(robot, Gait.named("wave", legs=8))
    with pytest.raises(UnreachableError, match="body heights between"):
        max_stroke(robot, gait, body_height=0.5)
    for direction in (math.nan, math.inf, (math.nan, 0, 1), (0, 0, 0), (1, 2)):
        with pytest.raises(InputError, match=r"finite|has no length"):
            max_stroke(robot, gait, direction)
    for bad in (math.nan, math.inf, -math.inf, 1e300):
        with pytest.raises(InputError, match="body_height is"):
            max_stroke(robot, gait, body_height=bad)
    for name in ("swing_height", "foot_distance"):
        for bad in (math.nan, math.inf, -0.01, "x"):
            with pytest.raises(InputError, match=f"{name} is"):
                max_stroke(robot, gait, **{name: bad})
    for bad in ((math.nan, 0), (2.0, 0), (0, -2.0), (0.1,), "ab", 3):
        with pytest.raises(InputError, match="body_tilt is"):
            max_stroke(robot, gait, body_tilt=bad)


def test_the_stroke_of_a_curve_is_that_of_the_outermost_foot():
    rest = default_stance(point_feet("strider"), swing_height=0.03)
    for centre in ((0.0, 0.0), (0.0, 0.5), (0.2, -0.1)):
        twist = unit_twist(rest, curved_path(2.0, centre).displacement)
        assert abs(twist[2]) * np.hypot(*(rest[:, :2] - centre).T).max() == pytest.approx(1.0)
