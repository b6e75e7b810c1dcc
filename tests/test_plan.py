import math
import re

import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from gait_robots import HEXAPOD_GAITS, PRESETS, in_heading_frame, point_feet, ring
from tarsus.errors import CollisionError, InputError, StrokeError, TarsusError, UnreachableError
from tarsus.gait import plan
from tarsus.gait.cycle import cycle_feet
from tarsus.gait.gait import Gait
from tarsus.gait.path import BodyPath, curved_path, straight_path, twist_path
from tarsus.gait.plan import plan_walk
from tarsus.gait.spacing import feet_distance
from tarsus.gait.stroke import max_stroke, unit_twist
from tarsus.gait.walk_setup import WalkSetup
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.stance import default_stance
from tarsus.robot.joint_limits import UNKNOWN_SPEED
from tarsus.robot.robot import GaitDefaults, stack_robots

PATHS = {
    "straight": straight_path(0.4),
    "aside": straight_path(0.3, 2.2),
    "curve": curved_path(1.1, (0.1, 0.4)),
    "turn": curved_path(-1.3),
    "twist": twist_path(0.05, -0.02, 0.2, 5.0),
    "short": straight_path(0.02),
    "tiny": straight_path(0.001),
    "nudge": curved_path(math.radians(0.1)),
}
TRIPOD = Gait.named("tripod")


def check_walk(motion, path, *, rest):
    """What holds for every walk: distance, stance, feet on the ground and in the air."""
    n, legs = motion.contacts.shape
    place = np.column_stack([motion.body.position[:, :2], motion.body.rpy[:, 2]])
    x, y, yaw = path.displacement
    end = expm(np.array([[0, -yaw, x], [yaw, 0, y], [0, 0, 0]]))
    np.testing.assert_allclose(place[0], 0, atol=1e-9)
    np.testing.assert_allclose(place[-1, :2], end[:2, 2], atol=1e-9)
    assert math.remainder(place[-1, 2] - yaw, math.tau) == pytest.approx(0, abs=1e-9)
    seen = in_heading_frame(motion)
    for moment in (0, -1):
        np.testing.assert_allclose(seen[moment], rest, atol=1e-9)
        assert motion.contacts[moment].all()
    np.testing.assert_allclose(motion.angles[0], motion.angles[-1], atol=1e-6)
    both = motion.contacts[1:] & motion.contacts[:-1]
    assert np.linalg.norm(np.diff(motion.feet, axis=0), axis=-1)[both].max(initial=0) <= 1e-9
    assert (motion.feet[..., 2][motion.contacts] == 0).all()
    assert motion.feet[..., 2].min() >= 0
    assert motion.feet[..., 2].max() <= motion.swing_height * (1 + 1e-12)
    assert motion.contacts.sum(-1).min() >= motion.gait.fewest_feet_down
    # No stance excursion exceeds half a stroke: the foot's way past the body, along its track.
    half = 0.5 * motion.stroke * path.travel(rest) / path.travel(rest).max()
    away = np.linalg.norm(seen - rest, axis=-1)
    assert (away <= np.where(motion.contacts, half + 1e-9, np.inf)).all()
    assert all(np.isfinite(a).all() for a in (motion.feet, motion.angles, motion.joint_speed))
    np.testing.assert_array_equal(np.isfinite(motion.margin), motion.contacts.any(-1))
    assert n == motion.time.size
    assert legs == motion.robot.legs


def rest_of(robot, **more):
    setup = {"body_height": None, "swing_height": None, "body_tilt": (0, 0), "foot_distance": None} | more
    return WalkSetup.of(robot, Gait.named("wave", legs=robot.legs), **setup).rest


@pytest.mark.parametrize("path", PATHS)
@pytest.mark.parametrize("name", HEXAPOD_GAITS)
def test_a_walk_starts_and_ends_in_the_rest_stance(name, path):
    robot = point_feet("strider")
    motion = plan_walk(robot, Gait.named(name), PATHS[path], stroke=0.09)
    check_walk(motion, PATHS[path], rest=rest_of(robot))
    assert motion.reach.max() == 0
    # Forward kinematics puts the feet where the plan has them.
    feet = motion.body @ forward_kinematics(robot, motion.angles)[..., 3, :]
    np.testing.assert_allclose(feet, motion.feet, atol=1e-9)


@pytest.mark.parametrize("robot", PRESETS)
def test_the_default_walk_of_every_preset_is_possible(robot):
    robot = point_feet(robot)
    path = straight_path(0.5)
    motion = plan_walk(robot, Gait.named(robot.gait.name), path)
    check_walk(motion, path, rest=rest_of(robot))
    assert motion.ok, motion.problems
    assert 0.02 < motion.stroke < 0.2
    assert motion.body_height == robot.gait.body_height
    assert motion.swing_height == robot.gait.swing_height


@pytest.mark.lengthy
@pytest.mark.parametrize("cycle_time", [0.37, 1.0])
@pytest.mark.parametrize("rate", [100.0, 97.0, 100 / 3])
@pytest.mark.parametrize("name", HEXAPOD_GAITS)
def test_the_number_of_feet_on_the_ground_does_not_depend_on_the_rate(name, rate, cycle_time):
    gait, path = Gait.named(name), straight_path(0.25)
    if (1 - gait.duty_factor) * cycle_time * rate <= 1 + 1e-6:
        with pytest.raises(InputError, match="it would fall between two samples; rate must be more than"):
            plan_walk(point_feet("strider"), gait, path, stroke=0.06, cycle_time=cycle_time, rate=rate)
        return
    motion = plan_walk(point_feet("strider"), gait, path, stroke=0.06, cycle_time=cycle_time, rate=rate)
    check_walk(motion, path, rest=rest_of(point_feet("strider")))
    np.testing.assert_allclose(motion.time, np.arange(motion.time.size) / rate)
    # As often as at a rate that shows everything.
    fine = plan_walk(point_feet("strider"), gait, path, stroke=0.06, cycle_time=cycle_time, rate=1000)
    assert motion.steps == fine.steps
    assert 0 <= motion.duration - fine.duration < 1 / rate + 1e-3


def test_a_rate_that_falls_on_the_events_adds_no_sample():
    motion = plan_walk(point_feet("strider"), TRIPOD, straight_path(0.4), stroke=0.1, cycle_time=1.0, rate=100)
    # 2 strokes of 0.1 m a cycle: 2 cycles of path at speed, one more for the ramps, from the first lift-off on.
    first = motion.contacts.all(-1).argmin()
    last = motion.time.size - motion.contacts[::-1].all(-1).argmin()
    assert first == 1
    assert last == motion.time.size - 1


@pytest.mark.parametrize("name", HEXAPOD_GAITS)
@pytest.mark.parametrize("direction", [(1.0, 0, 0), (0.4, -1.0, 3.0), (0, 0, -1.0)])
def test_cruise_is_the_steady_cycle(name, direction):
    robot, gait, stroke = point_feet("strider"), Gait.named(name), 0.08
    rest = rest_of(robot)
    twist = unit_twist(rest, direction) * stroke
    path = BodyPath(tuple(twist / gait.duty_factor * 4))
    motion = plan_walk(robot, gait, path, stroke=stroke, cycle_time=1.0, rate=111)
    # The first sample is the first lift-off: a whole number of twelfths of the cycle, found by its contacts alone.
    seen = in_heading_frame(motion)
    cruise = (motion.time > 2.6) & (motion.time < 3.4)
    best = np.inf
    for shift in np.arange(36) / 36:
        phases = motion.time[cruise] + shift
        feet, contacts = cycle_feet(gait, rest, twist, swing_height=robot.gait.swing_height, phases=phases)
        error = np.abs(feet - seen[cruise]).max()
        if error < best:
            best, found, down = error, feet, contacts
    np.testing.assert_allclose(seen[cruise], found, atol=1e-12)
    np.testing.assert_array_equal(motion.contacts[cruise], down)
    angles = inverse_kinematics(robot, found - [0, 0, motion.body_height]).angles
    np.testing.assert_allclose(motion.angles[cruise], angles, atol=1e-9)


def test_while_cruising_touchdown_and_lift_off_are_symmetric_about_rest():
    robot, stroke = point_feet("strider"), 0.1
    motion = plan_walk(robot, TRIPOD, straight_path(0.9), stroke=stroke, cycle_time=1.0, rate=200)
    seen = in_heading_frame(motion) - rest_of(robot)
    for leg in range(6):
        down = motion.contacts[:, leg]
        touchdowns = np.flatnonzero(down[1:] & ~down[:-1]) + 1
        lift_offs = np.flatnonzero(down[:-1] & ~down[1:])
        cruise = [t for t in touchdowns if 1.2 < motion.time[t] < motion.duration - 1.8]
        assert len(cruise) >= 2
        for touchdown in cruise:
            lift_off = lift_offs[lift_offs > touchdown][0]
            np.testing.assert_allclose(seen[touchdown, leg], [stroke / 2, 0, 0], atol=1e-9)
            np.testing.assert_allclose(seen[lift_off, leg], [-stroke / 2, 0, 0], atol=1e-9)


@pytest.mark.parametrize("centre", [(0.0, 0.0), (0.0, 0.5), (-0.2, 0.1)])
def test_stances_on_a_curve_are_arcs_about_the_centre_by_the_same_angle(centre):
    """Source 001: T = P / max(CP), every foot on its own circle."""
    robot, stroke = point_feet("strider"), 0.07
    rest = rest_of(robot)
    motion = plan_walk(robot, TRIPOD, curved_path(1.5, centre), stroke=stroke, cycle_time=1.0)
    radius = np.hypot(*(rest[:, :2] - centre).T)
    turn = stroke / radius.max()
    seen = (in_heading_frame(motion)[..., :2] - centre) @ [1, 1j]
    start = (rest[:, :2] - centre) @ [1, 1j]
    away = np.abs(np.abs(seen) - radius)
    assert away[motion.contacts].max() < 1e-9
    angle = np.where(motion.contacts, np.angle(seen / start), 0)
    np.testing.assert_allclose(angle.max(0), turn / 2, rtol=1e-6)
    np.testing.assert_allclose(angle.min(0), -turn / 2, rtol=1e-6)


@pytest.mark.parametrize("end", ["lift-off", "touchdown"])
def test_feet_leave_and_meet_the_ground_without_velocity_and_acceleration(end):
    """With finer samples the foot's displacement near the ground shrinks with the cube: order 3."""
    ways = []
    for rate in (400, 800, 1600, 3200):
        motion = plan_walk(point_feet("strider"), TRIPOD, straight_path(0.3), stroke=0.1, cycle_time=1.0, rate=rate)
        down = motion.contacts[:, 0]
        if end == "lift-off":
            last = np.flatnonzero(down[:-1] & ~down[1:])[1]
            ways.append(np.linalg.norm(motion.feet[last + 4, 0] - motion.feet[last, 0]))
        else:
            first = np.flatnonzero(~down[:-1] & down[1:])[1] + 1
            ways.append(np.linalg.norm(motion.feet[first - 4, 0] - motion.feet[first, 0]))
    order = np.log2(np.array(ways[:-1]) / ways[1:])
    np.testing.assert_allclose(order[-1], 3, atol=0.1)
    assert abs(order[-1] - 3) < abs(order[0] - 3)


def test_swinging_feet_reach_the_swing_height():
    motion = plan_walk(
        point_feet("strider"), Gait.named("ripple"), straight_path(0.5), stroke=0.08, cycle_time=1.2, rate=500
    )
    np.testing.assert_allclose(motion.feet[..., 2].max(0), motion.swing_height, rtol=1e-3)


def test_a_tilted_body_keeps_its_tilt_over_flat_ground():
    """Source 001's plane: seen from the body, the ground rises with the tilt's tangents; in G it is flat."""
    roll, pitch = 0.12, -0.08
    robot, path = point_feet("strider"), curved_path(0.8, (0.0, 0.5))
    motion = plan_walk(robot, TRIPOD, path, stroke=0.05, body_tilt=(roll, pitch))
    check_walk(motion, path, rest=rest_of(robot))
    np.testing.assert_allclose(motion.body.rpy[:, 0], roll, atol=1e-12)
    np.testing.assert_allclose(motion.body.rpy[:, 1], pitch, atol=1e-12)
    np.testing.assert_array_equal(motion.body.position[:, 2], motion.body_height)
    seen = forward_kinematics(robot, motion.angles)[..., 3, :]
    height = -motion.body_height / (math.cos(roll) * math.cos(pitch))
    plane = height + seen[..., 0] * math.tan(pitch) / math.cos(roll) - seen[..., 1] * math.tan(roll)
    np.testing.assert_allclose(seen[..., 2][motion.contacts], plane[motion.contacts], atol=1e-9)


@pytest.mark.no_cover
@settings(max_examples=40)
@given(
    st.floats(0.3, 0.95),
    st.lists(st.floats(0, 0.999), min_size=6, max_size=6),
    st.floats(0.001, 0.5),
    st.floats(-math.pi, math.pi),
    st.floats(-1.5, 1.5),
    st.floats(0.01, 1.3),
    st.sampled_from([0.5, 1.0, 2.3]),
    st.sampled_from([50.0, 97.0, 100.0, 240.0]),
)
def test_any_gait_on_any_path(duty_factor, offsets, distance, heading, angle, share, cycle_time, rate):
    robot, gait = ring(6), Gait(duty_factor, tuple(offsets))
    path = BodyPath((distance * math.cos(heading), distance * math.sin(heading), angle))
    args = {"stroke": 0.04 * share, "cycle_time": cycle_time, "rate": rate, "foot_distance": 0}
    if (1 - duty_factor) * cycle_time * rate < 1:
        with pytest.raises(InputError, match="a swing takes"):
            plan_walk(robot, gait, path, **args)
        return
    motion = plan_walk(robot, gait, path, **args)
    check_walk(motion, path, rest=rest_of(robot))


@settings(max_examples=40)
@given(
    st.floats(1e-12, 1e12),
    st.one_of(st.none(), st.floats(1e-12, 1e12)),
    st.one_of(st.none(), st.floats(1e-12, 1e12)),
    st.floats(1e-6, 1e6),
    st.tuples(*[st.floats(-1e9, 1e9)] * 3),
)
def test_whatever_the_numbers_there_is_a_motion_or_an_error_of_tarsus(stroke, speed, cycle_time, rate, displacement):
    robot = ring(6)
    try:
        path = BodyPath(displacement)
        motion = plan_walk(robot, TRIPOD, path, stroke=stroke, speed=speed, cycle_time=cycle_time, rate=rate)
    except TarsusError as error:
        text = str(error)
    else:
        text = f"a walk of {motion.duration} s"
        assert np.isfinite(motion.angles).all()
    assert len(text) > 10


@pytest.mark.parametrize(("legs", "gait"), [(5, "wave"), (7, "tetrapod"), (8, "ripple")])
def test_robots_with_other_numbers_of_legs(legs, gait):
    robot, gait, path = ring(legs), Gait.named(gait, legs=legs), curved_path(0.7, (0.0, 0.3))
    motion = plan_walk(robot, gait, path)
    check_walk(motion, path, rest=rest_of(robot))


def test_a_long_walk_has_the_exact_distance():
    path = straight_path(20.0, 0.3)
    motion = plan_walk(point_feet("strider"), TRIPOD, path, stroke=0.1, cycle_time=1.0, rate=20)
    check_walk(motion, path, rest=rest_of(point_feet("strider")))
    assert motion.duration == pytest.approx(20 / 0.2 + 1 + 0.5, abs=0.6)


def test_a_robot_of_another_array_library_walks():
    robot = point_feet("strider")
    traced = robot.replace(femur=jnp.asarray(robot.femur), tibia=jnp.asarray(robot.tibia))
    one, other = (plan_walk(r, TRIPOD, straight_path(0.1), stroke=0.05, cycle_time=1.0) for r in (robot, traced))
    assert isinstance(other.angles, np.ndarray)
    np.testing.assert_allclose(other.angles, one.angles, atol=1e-12)


# Pace


def test_any_two_of_stroke_speed_and_cycle_time_determine_the_third():
    def pace(**given):
        motion = plan_walk(point_feet("strider"), Gait.named("ripple"), straight_path(0.2), **given)
        return motion.stroke, motion.speed, motion.cycle_time

    expected = (0.06, pytest.approx(0.06 / (2 / 3 * 1.2)), pytest.approx(1.2))
    assert pace(stroke=0.06, cycle_time=1.2) == expected
    assert pace(stroke=0.06, speed=0.075) == expected
    stroke, *others = pace(speed=0.075, cycle_time=1.2)
    assert (pytest.approx(stroke), *others) == expected
    assert pace(stroke=0.06, speed=0.075, cycle_time=1.2) == expected


def test_cruising_speed_is_that_of_the_body():
    motion = plan_walk(point_feet("strider"), TRIPOD, straight_path(0.8), stroke=0.1, cycle_time=1.0)
    middle = motion.time.size // 2
    assert (motion.body.position[middle + 1] - motion.body.position[middle])[0] * 100 == pytest.approx(motion.speed)


def test_inconsistent_arguments_are_refused():
    with pytest.raises(InputError, match=r"are inconsistent: with duty factor 0.500 the stroke would be 50.0 mm"):
        plan_walk(point_feet("strider"), TRIPOD, straight_path(0.2), stroke=0.06, speed=0.1, cycle_time=1.0)


def test_a_twist_path_is_walked_at_its_speed():
    path = twist_path(0.1, 0, 0, 5.0)
    free = plan_walk(point_feet("strider"), TRIPOD, path)
    assert free.speed == pytest.approx(0.1)
    assert free.cycle_time == pytest.approx(free.stroke / (0.1 * 0.5))
    assert plan_walk(point_feet("strider"), TRIPOD, path, cycle_time=1.0).stroke == pytest.approx(0.05)
    assert plan_walk(point_feet("strider"), TRIPOD, path, stroke=0.05).cycle_time == pytest.approx(1.0)
    # Both given, the duration has no say.
    assert plan_walk(point_feet("strider"), TRIPOD, path, stroke=0.06, cycle_time=1.0).speed == pytest.approx(0.12)


@pytest.mark.parametrize("name", HEXAPOD_GAITS)
@pytest.mark.parametrize("robot", ["strider", "phantomx", "ch3r"])
@pytest.mark.parametrize("path", [straight_path(0.4), curved_path(0.8, (0.0, 0.4))])
def test_the_default_cycle_time_keeps_joints_at_half_the_servo_speed(robot, name, path):
    """To 0.5 %: the maximum lies between the samples of the planner."""
    motion = plan_walk(point_feet(robot), Gait.named(name), path, rate=400)
    assert motion.cycle_time > 1
    assert 0.48 < np.nanmax(motion.speed_ratio) <= 0.5 * 1.005
    assert any("half the no-load speed of its servo" in line for line in motion.assumed)


@pytest.mark.parametrize("name", ["mithi", "freenove"])
def test_without_known_servos_a_walk_keeps_half_the_joint_speed_limit_of_live_walking(name):
    robot = point_feet(name)
    motion = plan_walk(robot, Gait.named("wave"), curved_path(np.pi), rate=200)
    assert 0.47 * UNKNOWN_SPEED < np.abs(motion.joint_speed).max() <= 0.5 * UNKNOWN_SPEED * 1.005
    assert "joint speed limit 286 deg/s where the robot file gives no servo speed" in motion.assumed
    assert any("no joint exceeds half its speed limit" in line for line in motion.assumed)
    # Walked in a second, as before there was a limit, it is not possible, and the cycle time given is.
    fast = plan_walk(robot, Gait.named("wave"), curved_path(np.pi), cycle_time=1.0, rate=1000)
    (problem,) = fast.problems
    possible = float(re.search(r"a cycle time of about ([\d.]+) s or longer is possible$", problem)[1])
    assert plan_walk(robot, Gait.named("wave"), curved_path(np.pi), cycle_time=1.01 * possible, rate=200).ok


@pytest.mark.parametrize("width", [-0.03, 0.02])
def test_a_stance_width_moves_the_feet_away_from_their_coxa_axes(width):
    robot = point_feet("strider")
    motion = plan_walk(robot, TRIPOD, straight_path(0.2), stance_width=width)
    usual = plan_walk(robot, TRIPOD, straight_path(0.2))
    mounts = np.asarray(robot.mount_position)[:, :2]
    out, usually = (np.linalg.norm(each.feet[0, :, :2] - mounts, axis=1) for each in (motion, usual))
    np.testing.assert_allclose(out, usually + width, atol=1e-9)
    assert np.abs(motion.angles[0, :, 0]).max() < 1e-9
    assert motion.ok


def test_a_stance_width_that_brings_a_foot_to_its_coxa_axis_is_refused():
    robot = point_feet("strider")
    for bad in (-0.3, math.nan, math.inf):
        with pytest.raises(InputError, match=r"stance_width is .* and more than -22"):
            plan_walk(robot, TRIPOD, straight_path(0.2), stance_width=bad)


def test_the_default_cycle_time_is_at_least_a_second():
    motion = plan_walk(point_feet("strider"), TRIPOD, straight_path(0.05), stroke=0.01, swing_height=0.003)
    assert motion.cycle_time == 1
    assert "cycle time 1 s" in motion.assumed


def test_assumptions_are_listed():
    bare = ring(6, body_mass=None, link_mass=None)
    assumed = plan_walk(bare, TRIPOD, straight_path(0.2)).assumed
    for part in (
        "body height 80 mm: derived from femur and tibia",
        "swing height 20 mm: a quarter of the body height",
        "the robot file gives no masses",
        "0.6 of the longest possible",
        "joint speed limit 286 deg/s where the robot file gives no servo speed",
    ):
        assert any(part in line for line in assumed), part
    given_all = plan_walk(
        ring(6), TRIPOD, straight_path(0.2), body_height=0.08, swing_height=0.02, stroke=0.03, cycle_time=1.0
    )
    assert given_all.assumed == ("joint speed limit 286 deg/s where the robot file gives no servo speed",)
    own = ring(6, gait=GaitDefaults(body_height=0.08, swing_height=0.02))
    own = own.replace(servos=point_feet("strider").servos)
    assert plan_walk(own, TRIPOD, straight_path(0.2), stroke=0.03, cycle_time=1.0).assumed == ()


def test_the_default_stroke_is_a_fraction_of_the_longest():
    robot = point_feet("strider")
    motion = plan_walk(robot, TRIPOD, straight_path(0.4, 0.7))
    assert motion.stroke == pytest.approx(0.6 * max_stroke(robot, TRIPOD, 0.7), rel=1e-9)


# What is refused


@pytest.mark.parametrize("name", ["stroke", "speed", "cycle_time", "rate", "swing_height", "foot_distance"])
def test_numbers_must_be_finite_and_not_negative(name):
    for bad in (math.nan, math.inf, -math.inf, -0.1, "fast", (1, 2)):
        with pytest.raises(InputError, match=f"{name} is"):
            plan_walk(point_feet("strider"), TRIPOD, straight_path(0.1), **{name: bad})


@pytest.mark.parametrize("name", ["stroke", "speed", "cycle_time", "rate"])
def test_some_numbers_must_not_be_zero(name):
    with pytest.raises(InputError, match=f"{name} is 0; it must be greater than 0"):
        plan_walk(point_feet("strider"), TRIPOD, straight_path(0.1), **{name: 0})


def test_a_swing_height_of_0_is_allowed():
    motion = plan_walk(point_feet("strider"), TRIPOD, straight_path(0.1), stroke=0.05, cycle_time=1.0, swing_height=0)
    assert motion.feet[..., 2].max() == 0


def test_extreme_sizes_are_refused():
    robot = point_feet("strider")
    for bad, match in (
        ({"stroke": 1e4}, "stroke is 10000 m; it must be at most 1000 m"),
        ({"speed": 1e300, "cycle_time": 1e300}, "stroke is inf"),
        ({"speed": 1e-300, "cycle_time": 1e-300}, "a swing takes|stroke is 0"),
        ({"speed": 1e-9, "cycle_time": 1.0}, "at most 500000 samples"),
        ({"stroke": 0.05, "speed": 1e-308}, "at most 500000"),
        ({"stroke": 0.05, "speed": 1e308}, "a swing takes"),
        ({"stroke": 0.05, "cycle_time": 1.0, "rate": 1e9}, "at most 500000"),
        ({"stroke": 0.05, "cycle_time": 1.0, "rate": 2.0}, "a swing takes 0.5 s.*more than 2 Hz"),
        ({"stroke": 0.05, "cycle_time": 1.0, "rate": 1.5}, "a swing takes 0.5 s.*more than 2 Hz"),
        ({"swing_height": 1e6}, "swing_height is"),
    ):
        with pytest.raises(InputError, match=match):
            plan_walk(robot, TRIPOD, straight_path(0.5), **bad)
    for path in (straight_path(1e-12), BodyPath((0, 0, 1e-200)), BodyPath((1e308, 1e308, 0))):
        with pytest.raises(InputError, match=r"must be a finite number of at least 1e-09 m|at most 500000"):
            plan_walk(robot, TRIPOD, path, stroke=0.05, cycle_time=1.0)


def test_batches_and_other_gaits_are_refused():
    robot = point_feet("strider")
    with pytest.raises(InputError, match=r"not for a batch \(2,\) of designs"):
        plan_walk(stack_robots([robot, robot]), TRIPOD, straight_path(0.1))
    with pytest.raises(InputError, match="gait 'wave' is for 5 legs, the robot has 6"):
        plan_walk(robot, Gait.named("wave", legs=5), straight_path(0.1))


def test_an_unreachable_body_height_names_the_reachable_ones():
    with pytest.raises(UnreachableError, match=r"body height 400.0 mm: leg .*all legs do at body heights between"):
        plan_walk(point_feet("strider"), TRIPOD, straight_path(0.1), body_height=0.4)
    for bad in (math.nan, math.inf, -math.inf):
        with pytest.raises(InputError, match="body_height is"):
            plan_walk(point_feet("strider"), TRIPOD, straight_path(0.1), body_height=bad)


def test_a_stroke_too_long_names_leg_reason_and_longest_stroke():
    robot = point_feet("strider")
    with pytest.raises(StrokeError, match=r"300.0 mm is too long: at .* s front .* mm too far\.") as refused:
        plan_walk(robot, TRIPOD, straight_path(1.0), stroke=0.3, cycle_time=1.0)
    assert refused.value.longest == max_stroke(robot, TRIPOD)
    assert f"longest possible is {refused.value.longest * 1000:.1f} mm" in str(refused.value)


def test_a_stroke_impossible_only_in_other_walks_is_refused():
    """On a short path no step has that length; the stroke is refused all the same."""
    with pytest.raises(
        StrokeError, match=r"during start or stop, .* can't reach .* mm too far\. In the heading frame \("
    ):
        plan_walk(point_feet("strider"), TRIPOD, straight_path(0.001), stroke=0.3, cycle_time=1.0)


def test_a_leg_that_would_jump_is_refused():
    robot = point_feet("mithi")
    longest = max_stroke(robot, TRIPOD, (0, 0, 1))
    with pytest.raises(StrokeError, match="jumps: ") as refused:
        plan_walk(robot, TRIPOD, curved_path(6.0), stroke=1.04 * longest, cycle_time=1.0, foot_distance=0, rate=400)
    assert refused.value.longest >= longest
    with pytest.raises(
        StrokeError, match=r"jumps: during start or stop, leg .* would change its inverse-kinematics branch"
    ):
        plan_walk(robot, TRIPOD, curved_path(0.01), stroke=1.04 * longest, cycle_time=1.0, foot_distance=0)


def test_where_no_stroke_is_possible_the_message_says_why():
    robot = point_feet("strider")
    path = straight_path(0.2)
    with pytest.raises(
        StrokeError, match=r"in the rest stance two feet are .* less than the required foot distance of 1000.0 mm"
    ) as refused:
        plan_walk(robot, TRIPOD, path, foot_distance=1.0)
    assert refused.value.longest == 0
    with pytest.raises(
        StrokeError, match=r"stepping on the spot is impossible: [a-z ]+ can't reach .*In the heading frame \("
    ):
        plan_walk(robot, TRIPOD, path, body_tilt=(0.9, 0))
    with pytest.raises(StrokeError, match="no stroke is possible here"):
        plan_walk(robot, TRIPOD, path, stroke=0.05, cycle_time=1.0, body_tilt=(0.9, 0))
    with pytest.raises(CollisionError, match="No stroke is possible here"):
        plan_walk(robot, TRIPOD, path, stroke=0.05, cycle_time=1.0, foot_distance=1.0)


@pytest.mark.parametrize("rate", [10.0, 400.0])
def test_close_feet_are_refused_with_legs_distance_and_time(rate):
    robot, path = point_feet("strider"), straight_path(0.7)
    free = plan_walk(robot, Gait.named("ripple"), path, stroke=0.12, cycle_time=1.0, rate=2000)
    distance, pair = feet_distance(free.feet)
    closest = distance.min()
    closest_samples = np.flatnonzero(distance < closest + 1e-5)
    with pytest.raises(CollisionError) as refused:
        plan_walk(
            robot, Gait.named("ripple"), path, stroke=0.12, cycle_time=1.0, rate=rate, foot_distance=closest + 0.001
        )
    text = str(refused.value)
    near = float(text.split(" are ")[1].split(" mm", maxsplit=1)[0]) / 1000
    when = float(text.split(" mm apart at ")[1].split(" s", maxsplit=1)[0])
    # The true minimum at any rate, to the tenth of a millimetre that is printed and half of one more.
    assert near == pytest.approx(closest, abs=1.5e-4)
    assert np.abs(free.time[closest_samples] - when).min() < 0.03
    legs = {" and ".join(robot.leg_codes[i] for i in pair[k]) for k in np.flatnonzero(distance < closest + 2e-4)}
    assert any(f"the feet of {two} are" in text for two in legs)
    plan_walk(robot, Gait.named("ripple"), path, stroke=0.12, cycle_time=1.0, rate=rate, foot_distance=closest - 0.001)


def test_not_strict_returns_the_motion_with_its_problems():
    motion = plan_walk(point_feet("strider"), TRIPOD, straight_path(1.0), stroke=0.35, cycle_time=1.0, strict=False)
    assert motion.reach.max() > 0
    assert np.isfinite(motion.angles).all()
    assert motion.problems[0].startswith("out of reach")


def test_samples_out_of_reach_are_refused_even_if_the_stroke_is_feasible(monkeypatch):
    def blind(setup, twist):
        works, solution = np.ones(6, dtype=bool), None
        return works, solution

    monkeypatch.setattr(plan, "leg_feasibility", blind)
    with pytest.raises(
        UnreachableError, match=r"a stroke of 300.0 mm is not possible here: at .* s front left can.t reach"
    ):
        plan_walk(point_feet("strider"), TRIPOD, straight_path(1.0), stroke=0.3, cycle_time=1.0)


def test_rest_footholds_allow_the_swing_height():
    robot = point_feet("phoenix")
    np.testing.assert_allclose(
        rest_of(robot)[:, :2], default_stance(robot, swing_height=robot.gait.swing_height)[:, :2]
    )


def test_an_unreachable_stroke_does_not_affect_the_pace():
    robot = point_feet("strider")
    motion = plan_walk(robot, Gait.named("tripod"), straight_path(0.5), stroke=0.3, strict=False)
    assert motion.cycle_time == 1.0
    assert not motion.ok
