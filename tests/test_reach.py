"""The verdict on a leg, and what is said about it."""

import re
from dataclasses import replace

import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from robots import plain_hexapod, random_angles, random_robot, seeds
from tarsus.errors import UnreachableError
from tarsus.kinematics.ground import PoseComponents, certainly_above_ground
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.reach import Reach
from tarsus.robot.robot import stack_robots

SURE = 1e-6  # so far from a bound [m, rad] that rounding can't change the verdict


def turned(angle):
    return (angle + np.pi) % (2 * np.pi) - np.pi


def ways(robot, leg, foot, knee):
    """The two ways to reach a foot, by the textbook's law of cosines: what is wrong with each, and the doubt of it."""
    yaw = robot.mount_yaw[leg]
    side, up = robot.femur_axis_offset[leg]
    f, t = robot.femur[leg], robot.tibia[leg]
    x, y, z = foot - robot.mount_position[leg] - [0, 0, up]
    x, y = x * np.cos(yaw) + y * np.sin(yaw), y * np.cos(yaw) - x * np.sin(yaw)
    for facing in (1, -1):
        beside = np.hypot(x, y) - abs(side)
        if beside < 0:
            yield Reach.TOO_NEAR, -beside
            continue
        along = facing * np.sqrt(x * x + y * y - side * side)
        coxa = turned(np.arctan2(y, x) - np.arctan2(side, along))
        r = along - robot.coxa[leg]
        d = np.hypot(r, z)
        if d > f + t:
            yield Reach.TOO_FAR, d - f - t
            continue
        if d < abs(f - t):
            yield Reach.TOO_NEAR, abs(f - t) - d
            continue
        inner = np.arccos((f * f + d * d - t * t) / (2 * f * d))
        bend = np.pi - np.arccos((f * f + t * t - d * d) / (2 * f * t))
        sign = 1 if knee == "up" else -1
        angles = (coxa, turned(np.arctan2(z, r) + sign * inner), -sign * bend)
        over = [max(low - a, a - high) for a, (low, high) in zip(angles, robot.limits[leg], strict=True)]
        doubt = min(abs(v) for v in (*over, beside, d - f - t, d - abs(f - t)))
        broken = [joint for joint in range(3) if over[joint] > 0]
        yield (Reach(Reach.COXA_LIMIT + broken[0]) if broken else Reach.OK), doubt


@pytest.mark.no_cover
@pytest.mark.parametrize("knee", ["up", "down"])
@given(seed=seeds())
@example(seed=10000)  # a foot beside the leg's plane and far away
def test_reach_codes_agree_with_the_textbook(knee, seed):
    rng = np.random.default_rng(seed)
    robot = random_robot(rng)
    limits = np.array(robot.limits)
    limits[:, 2] = [-2.9, 2.9]  # a leg that has only one knee takes it whatever is asked
    robot = robot.replace(limits=limits)
    feet = forward_kinematics(robot, rng.uniform(-2, 2, (6, 3)))[:, 3] + rng.normal(0, 0.05, (6, 3))
    solution = inverse_kinematics(robot, feet, knee=knee)
    for leg in range(6):
        (towards, doubt), (away, other_doubt) = ways(robot, leg, feet[leg], knee)
        if min(doubt, other_doubt) < SURE:
            continue
        expected = Reach.OK if away is Reach.OK else towards
        assert solution.reach[leg] == expected


def test_the_comparison_covers_every_code():
    """The comparison above meets each of the codes that it speaks of."""
    seen = set()
    for seed in range(40):
        rng = np.random.default_rng(seed)
        robot = random_robot(rng)
        feet = forward_kinematics(robot, rng.uniform(-2, 2, (6, 3)))[:, 3] + rng.normal(0, 0.05, (6, 3))
        seen |= {next(ways(robot, leg, feet[leg], "up"))[0] for leg in range(6)}
    assert seen == set(Reach) - {Reach.BELOW_GROUND}


def low_body(rng, batch=()):
    tilt = rng.uniform(-1, 1, (2, *batch)) * rng.uniform(0, 1.5, batch)
    return Pose.from_rpy(*tilt, rng.uniform(-3, 3, batch), rng.uniform([-1, -1, -0.1], [1, 1, 0.35], (*batch, 3)))


@pytest.mark.no_cover
@given(seed=seeds())
def test_below_ground_agrees_with_the_points(seed):
    rng = np.random.default_rng(seed)
    robot = random_robot(rng)
    body = low_body(rng, (40,))
    feet = body @ (
        forward_kinematics(robot, random_angles(rng, robot, (40,)))[..., 3, :] + rng.normal(0, 0.01, (40, 6, 3))
    )
    solution = inverse_kinematics(robot, feet, body)
    plain = inverse_kinematics(robot, body.inverse() @ feet)
    heights = (body @ forward_kinematics(robot, solution.angles))[..., :3, 2]
    attachment, others = heights[..., 0] < 0, (heights[..., 1:] < 0).any(-1)
    expected = np.where(attachment | ((plain.reach == 0) & others), Reach.BELOW_GROUND, plain.reach)
    sure = (np.abs(heights) > SURE).all(-1)
    # Carried into B in two ways, a foot at the edge of a limit may be either side of it.
    agree = np.abs(solution.angles - plain.angles).max(-1) < 1e-9
    assert (sure & agree).mean() > 0.9
    assert np.array_equal(solution.reach[sure & agree], expected[sure & agree])


@pytest.mark.parametrize("seed", range(4))
def test_the_quick_bound_is_conservative(seed):
    """What is surely above by the bound is above by the points, for mounts above B's origin and steep tilts too."""
    rng = np.random.default_rng(seed)
    robot = random_robot(rng)
    mounts = np.array(robot.mount_position)
    mounts[:, :2] *= rng.uniform(0, 1)
    mounts[:, 2] += rng.uniform(-0.1, 0.3)
    robot = robot.replace(mount_position=mounts)
    found = 0
    for _ in range(300):
        body, q = low_body(rng), random_angles(rng, robot)
        if rng.random() < 0.3:
            body = Pose(np.eye(3), body.position)
        lowest = (body @ forward_kinematics(robot, q))[:, :3, 2].min()
        # At the very height where the lowest point touches the ground, and a little below.
        for depth in (0.0, 1e-9, 0.01):
            placed = Pose(body.rotation, body.position - [0, 0, lowest + depth])
            assert not certainly_above_ground(robot.geometry, q[:, 1], PoseComponents.of(np, placed)) or depth == 0.0
        found += certainly_above_ground(
            robot.geometry, q[:, 1], PoseComponents.of(np, Pose(body.rotation, [0, 0, 1.0]))
        )
    assert found > 0


@pytest.mark.parametrize(
    ("body", "femur", "sure"),
    [
        (Pose.from_rpy(np.pi, 0, 0, [0, 0, 5]), [0.1], False),
        (Pose(np.eye(3), [0, 0, 0.01]), [0.1], True),
        (Pose(np.eye(3), [0, 0, 0.01]), [-1.0], False),
        (Pose(np.eye(3), [0, 0, 0.097]), [-1.6], False),
        (Pose(np.eye(3), [0, 0, 0.099]), [-1.6], True),
        (Pose(np.eye(3), [0, 0, 0.097]), [3.2], False),
        (Pose(np.eye(3), [0, 0, -9]), [], True),
    ],
)
def test_the_quick_bound_by_cases(body, femur, sure):
    g = plain_hexapod().geometry
    assert certainly_above_ground(g, np.array(femur)[:, None], PoseComponents.of(np, body)) is sure


def test_an_axis_below_ground_overrides_whatever_else_is_wrong():
    robot = plain_hexapod()
    feet = forward_kinematics(robot, np.tile([0, 0.4, -1.4], (6, 1)))[:, 3] + [0, 0, 1]
    solution = inverse_kinematics(robot, feet * [9, 9, 1], Pose(np.eye(3), [0, 0, -0.02]))
    assert solution.reach.tolist() == [Reach.BELOW_GROUND] * 6
    assert solution.explain() == (
        "no leg can reach its target: the coxa axis would be 20.0 mm below the ground. Raised by 20.0 mm, the body is "
        "high enough, but the foot is out of reach: too far"
    )


def number(pattern, text):
    return float(re.search(pattern, text).group(1))


@pytest.mark.no_cover
@pytest.mark.parametrize("with_body", [False, True])
@given(seed=seeds())
def test_explanations_are_correct(with_body, seed):
    """Every number of every line, against distances and angles worked out anew; the point named is reached."""
    rng = np.random.default_rng(seed)
    robot = random_robot(rng)
    body = low_body(rng) if with_body else None
    feet = forward_kinematics(robot, random_angles(rng, robot))[:, 3] + rng.normal(0, 0.05, (6, 3))
    feet = body @ feet if body is not None else feet
    solution = inverse_kinematics(robot, feet, body)
    points = forward_kinematics(robot, solution.angles)
    points = points if body is None else body @ points
    failing = np.flatnonzero(solution.reach)
    if not len(failing):
        assert solution.explain() == "every leg reaches its target"
        return
    for leg in failing:
        line = solution.explain_leg((int(leg),))
        code = Reach(int(solution.reach[leg]))
        assert line.startswith(f"leg {leg} can't reach its target: the ")
        if code is Reach.BELOW_GROUND:
            depth = -points[leg, :3, 2].min() * 1000
            assert abs(number(r"would be ([\d.]+) mm below the ground", line) - depth) <= 0.051
            check_raise(robot, feet, body, leg, line)
            continue
        frame = "the body frame B" if body is None else "the ground frame G"
        named = re.search(rf"In {frame} the target is \((.*?)\) mm, the nearest reachable point \((.*?)\) mm", line)
        for text, point in zip(named.groups(), (feet[leg], points[leg, 3]), strict=True):
            assert np.abs(np.array([float(v) for v in text.split(", ")]) - point * 1000).max() <= 0.051
        assert (
            abs(number(r"\) mm, ([\d.]+) mm away", line) - np.linalg.norm(points[leg, 3] - feet[leg]) * 1000) <= 0.051
        )
        foot = (feet if body is None else body.inverse() @ feet)[leg]
        expected, excess = next(ways(robot, leg, foot, "up"))
        if code in (Reach.TOO_FAR, Reach.TOO_NEAR):
            assert code is expected
            assert abs(number(r": ([\d.]+) mm too", line) - excess * 1000) <= 0.051
            assert f"too {code.name[4:].lower()}" in line
        else:
            joint = code - Reach.COXA_LIMIT
            assert line.split("target: the ")[1].startswith(("coxa", "femur", "tibia")[joint])
            excess_deg = number(r", ([\d.]+) deg (?:above|below) its", line)
            angle, bound = number(r"would be (-?[\d.]+) deg", line), number(r"limit of (-?[\d.]+)", line)
            end = np.rad2deg(robot.limits[leg, joint])[0 if "below its lower" in line else 1]
            assert abs(bound - end) <= 0.051
            assert abs(abs(angle - bound) - excess_deg) <= 0.11
            assert angle <= bound if "below its lower" in line else angle >= bound


def check_raise(robot, feet, body, leg, line):
    """Raised by the distance printed, the leg is above the ground; raised by 0.2 mm less, it is not."""
    rise = np.array([0, 0, number(r"by ([\d.]+) mm", line) / 1000])
    higher = inverse_kinematics(robot, feet, Pose(body.rotation, body.position + rise))
    verdict = Reach(int(higher.reach[leg]))
    assert verdict is not Reach.BELOW_GROUND
    assert ("Raise the body by" in line) == (verdict is Reach.OK)
    assert verdict is Reach.OK or line.endswith(f"the foot is out of reach: {verdict.text}")
    lower = inverse_kinematics(robot, feet, Pose(body.rotation, body.position + np.maximum(rise - 2e-4, 0)))
    assert lower.reach[leg] == Reach.BELOW_GROUND


def test_every_reason_has_a_message():
    robot = plain_hexapod(
        mount_yaw=np.zeros(6),
        mount_position=np.zeros((6, 3)),
        limits=np.tile(np.deg2rad([[-60, 60], [-80, 54], [-150, 10]]), (6, 1, 1)),
    )
    feet = [[0.4, 0, 0], [0.068, 0, 0], [0.1, 0.2, -0.1], [0.15, 0, -0.1], [0.1, 0, -0.1], [0.2, 0, -0.1]]
    lines = inverse_kinematics(robot, np.array(feet)).explain().splitlines()
    assert [line.replace(" can't reach its target", "").split(". In the body frame B ")[0] for line in lines] == [
        "LF: the target is 332.0 mm from the femur axis, and femur and tibia are 279.0 mm long: 53.0 mm too far",
        (
            "LM: the target is 0.0 mm from the femur axis, and the folded leg reaches no nearer than 83.0 mm: "
            "83.0 mm too near"
        ),
        "LR: the coxa angle would be 63.4 deg, 3.4 deg above its upper limit of 60.0 deg",
        "RR: the femur angle would be 54.1 deg, 0.1 deg above its upper limit of 54.0 deg",
        "RM: the tibia angle would be -152.1 deg, 2.1 deg below its lower limit of -150.0 deg",
    ]
    assert lines[0].endswith(
        ". In the body frame B the target is (400.0, 0.0, 0.0) mm, the nearest reachable point (347.0, 0.0, 0.0) mm, "
        "53.0 mm away"
    )
    assert "-0.0" not in "".join(lines)


def test_a_sideways_offset_keeps_the_foot_away_from_the_coxa_axis():
    robot = plain_hexapod(
        mount_yaw=np.zeros(6),
        mount_position=np.zeros((6, 3)),
        femur_axis_offset=np.tile([0.02, 0], (6, 1)),
        limits=np.tile([[-3, 3], [-3, 3], [-3, 0]], (6, 1, 1)),
    )
    assert inverse_kinematics(robot, np.tile([0.005, 0, -0.15], (6, 1))).explain() == (
        "no leg can reach its target: the target is 5.0 mm from the coxa axis, less than the sideways offset of the "
        "femur axis, 20.0 mm: 15.0 mm too near. The nearest reachable points are 15.0 mm away"
    )


@pytest.mark.parametrize(
    ("failing", "start", "end"),
    [
        ([0], "LF can't reach its target: ", "the target is (150.0, 0.0, -100.0) mm, the nearest reachable point ("),
        ([0, 5], "LF and RF can't reach their targets: ", "the targets are (150.0, 0.0, -100.0) and (150.0, 0.0, "),
        ([0, 1, 5], "LF, LM and RF can't reach their targets: ", "The nearest reachable points are "),
        ([0, 1, 2, 3, 4, 5], "no leg can reach its target: ", "The nearest reachable points are "),
    ],
)
def test_legs_that_fail_alike_share_a_sentence(failing, start, end):
    robot = plain_hexapod(
        mount_yaw=np.zeros(6),
        mount_position=np.zeros((6, 3)),
        limits=np.tile(np.deg2rad([[-60, 60], [-80, 54], [-150, 10]]), (6, 1, 1)),
    )
    feet = np.tile([0.2, 0, -0.1], (6, 1))
    feet[failing] = [0.15, 0, -0.1]
    (line,) = inverse_kinematics(robot, feet).explain().splitlines()
    assert line.startswith(f"{start}the femur angle would be 54.1 deg, 0.1 deg above its upper limit of 54.0 deg. ")
    assert end in line
    named = inverse_kinematics(robot, feet).explain(frame="frame F")
    assert ("In frame F the" in named) == (len(failing) <= 2)


def test_excess_over_a_limit_is_measured_in_the_shorter_direction():
    robot = plain_hexapod(mount_yaw=np.zeros(6), mount_position=np.zeros((6, 3)))
    robot = robot.replace(limits=np.tile(np.deg2rad([[100, 170], [-80, 80], [-160, 0]]), (6, 1, 1)))
    feet = np.tile([0.2 * np.cos(np.deg2rad(175)), -0.2 * np.sin(np.deg2rad(175)), -0.1], (6, 1))
    assert (
        "angle would be 185.0 deg, 15.0 deg above its upper limit of 170.0 deg"
        in inverse_kinematics(robot, feet).explain()
    )


def test_require_returns_the_solution_or_raises_its_explanation():
    robot = plain_hexapod()
    feet = forward_kinematics(robot, np.tile([0, 0.4, -1.4], (6, 1)))[:, 3]
    solution = inverse_kinematics(robot, feet)
    assert solution.require() is solution
    assert solution.explain() == "every leg reaches its target"
    far = inverse_kinematics(robot, feet * [3, 3, 1])
    with pytest.raises(UnreachableError) as caught:
        far.require()
    assert str(caught.value) == far.explain()
    assert not far.ok


@pytest.mark.parametrize("xp", [np, jnp])
def test_in_a_batch_the_sample_is_named_and_long_lists_are_cut(xp):
    rng = np.random.default_rng(1)
    designs = [random_robot(rng, sideways=0.0) for _ in range(3)]
    feet = rng.uniform(-1, 1, (4, 1, 6, 3))
    body = Pose(np.eye(3), [[0, 0, 2.0], [0, 0, 0.5], [0, 0, 1]])
    found = inverse_kinematics(stack_robots(designs), feet, body)
    found = replace(found, **{name: xp.asarray(getattr(found, name)) for name in ("feet", "angles", "reach")})
    count = int((np.asarray(found.reach) != 0).sum())
    lines = found.explain().splitlines()
    assert len(lines) == 13
    assert lines[-1] == f"... and {count - 12} more of 72 legs"
    expected = []
    for i in range(4):
        for j, design in enumerate(designs):
            one = inverse_kinematics(design, feet[i, 0], body[j])
            expected += [f"[{i}, {j}] {line}" for line in one.explain().splitlines() if not one.ok]
    assert lines[:12] == expected[:12]


@pytest.mark.no_cover
@settings(max_examples=10)
@given(knee=st.sampled_from(["up", "down"]), seed=seeds())
def test_explaining_has_no_side_effects(knee, seed):
    rng = np.random.default_rng(seed)
    robot = random_robot(rng)
    solution = inverse_kinematics(robot, rng.uniform(-0.4, 0.4, (3, 6, 3)), low_body(rng, (3,)), knee=knee)
    before = solution.angles.copy(), solution.reach.copy()
    assert solution.explain() == solution.explain()
    assert np.array_equal(solution.angles, before[0])
    assert np.array_equal(solution.reach, before[1])
