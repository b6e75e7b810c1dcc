import dataclasses
import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gait_robots import point_feet, preset, ring
from tarsus.errors import InputError
from tarsus.gait.gait import Gait
from tarsus.gait.motion import Motion
from tarsus.gait.path import curved_path, straight_path
from tarsus.gait.plan import plan_walk
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stance import default_stance
from tarsus.robot.joint_limits import UNKNOWN_SPEED

TRIPOD = Gait.named("tripod")


def walk(gait=TRIPOD, robot="strider", **more):
    more = {"stroke": 0.08, "cycle_time": 2.0, "rate": 50} | more
    return plan_walk(point_feet(robot), gait, more.pop("path", straight_path(0.3)), **more)


def kinds(motion):
    return [problem.split(":")[0] for problem in motion.problems]


def stepping(angles, *, robot=None, contacts=None, time=None, foot_distance=0.0):
    """A motion of given joint angles at a fixed height, feet where the angles have them."""
    robot = robot or ring(6)
    n = len(angles)
    body = Pose.from_rpy(np.zeros(n), position=np.tile([0.0, 0.0, 0.08], (n, 1)))
    return Motion(
        robot=robot,
        gait=TRIPOD,
        time=np.arange(n) * 0.1 if time is None else time,
        body=body,
        feet=body @ forward_kinematics(robot, angles)[..., 3, :],
        contacts=np.ones((n, 6), dtype=bool) if contacts is None else contacts,
        angles=angles,
        reach=np.zeros((n, 6), dtype=np.int8),
        cycle_time=1.0,
        stroke=0.01,
        speed=0.01,
        body_height=0.08,
        swing_height=0.02,
        foot_distance=foot_distance,
    )


def standing(n):
    robot = ring(6)
    return np.tile(inverse_kinematics(robot, default_stance(robot, 0.08)).angles, (n, 1, 1))


def test_a_feasible_walk_has_no_problems():
    motion = walk()
    assert motion.ok
    assert motion.problems == ()


def test_arrays_are_copied_in_and_locked():
    time = np.arange(3.0)
    motion = stepping(standing(3), time=time)
    time[0] = -5
    assert motion.time[0] == 0
    for name in ("time", "feet", "contacts", "angles", "reach"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(motion, name)[...] = 0
    with pytest.raises(dataclasses.FrozenInstanceError):
        motion.stroke = 1.0


def test_margin_is_the_distance_to_the_nearest_edge_of_the_support_polygon():
    """Reference: the edges of the ring of feet in contact, walked through one by one."""
    motion = walk(path=curved_path(0.9, (0.1, 0.3)))
    com = motion.body @ np.asarray(centre_of_mass(motion.robot, motion.angles))
    for k in range(0, motion.time.size, 7):
        ring_of_feet = motion.feet[k, motion.contacts[k], :2]
        distances = []
        for a, b in zip(ring_of_feet, np.roll(ring_of_feet, -1, axis=0), strict=True):
            edge, out = b - a, com[k, :2] - a
            distances.append((edge[0] * out[1] - edge[1] * out[0]) / np.hypot(*edge))
        assert motion.margin[k] == pytest.approx(min(distances), abs=1e-9)


def test_joint_speed_is_the_derivative_of_the_angles_to_second_order():
    def worst(rate):
        coarse = walk(rate=rate, cycle_time=1.0)
        fine = walk(rate=rate * 16, cycle_time=1.0)
        inside = slice(rate // 2, -rate // 2)
        return np.abs(coarse.joint_speed - fine.joint_speed[::16][: coarse.time.size])[inside].max()

    errors = [worst(rate) for rate in (50, 100, 200)]
    assert errors[2] < 0.02
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.5)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2, abs=0.4)


def test_speed_ratio_is_relative_to_each_servo_or_to_the_limit_of_live_walking():
    motion = walk()
    limit = motion.robot.servos[2][1].no_load_speed
    assert motion.speed_ratio[2, 1] == pytest.approx(np.abs(motion.joint_speed[:, 2, 1]).max() / limit)
    some = ((None,) * 3, *motion.robot.servos[1:])
    unknown = dataclasses.replace(motion, robot=motion.robot.replace(servos=some))
    np.testing.assert_allclose(unknown.speed_ratio[0], np.abs(motion.joint_speed[:, 0]).max(0) / UNKNOWN_SPEED)
    np.testing.assert_array_equal(unknown.speed_ratio[1:], motion.speed_ratio[1:])
    silent = dataclasses.replace(motion.robot.servos[0][0], no_load_speed=None)
    silent = dataclasses.replace(motion, robot=motion.robot.replace(servos=((silent,) * 3,) * 6))
    np.testing.assert_allclose(silent.speed_ratio, np.abs(motion.joint_speed).max(0) / UNKNOWN_SPEED)
    assert silent.ok


def test_steps_and_duration():
    motion = walk()
    # Of every leg, each rise counted by hand.
    rises = sum(
        sum(1 for before, after in itertools.pairwise(down) if before and not after)
        for down in motion.contacts.T.tolist()
    )
    assert motion.steps == rises > 6
    assert motion.duration == motion.time[-1]
    assert stepping(standing(4)).steps == 0


def test_least_foot_distance_is_that_of_the_two_closest_feet():
    motion = walk()
    for k in (0, 40, -1):
        feet = motion.feet[k]
        assert motion.least_foot_distance[k] == pytest.approx(
            min(math.dist(feet[i], feet[j]) for i in range(6) for j in range(i)), rel=1e-12
        )


# Every kind of problem


def test_out_of_reach_names_time_leg_and_reason():
    motion = walk(stroke=0.3, path=straight_path(1.5), strict=False)
    reached = motion.body @ forward_kinematics(motion.robot, motion.angles)[..., 3, :]
    miss = np.linalg.norm(reached - motion.feet, axis=-1)
    worst, leg = np.unravel_index(int(np.argmax(miss)), miss.shape)
    name = motion.robot.leg_names[leg]
    assert motion.problems[0].startswith(f"out of reach: at {motion.time[worst]:.2f} s {name} can't reach its target: ")
    assert motion.problems[0].endswith(f"{miss[worst, leg] * 1000:.1f} mm away")
    assert " mm too far. In the ground frame G the target is (" in motion.problems[0]
    assert not motion.ok


@pytest.mark.parametrize("tilt", [(0.0, 0.0), (0.03, 0.05)])
def test_a_body_too_low_names_its_depth_and_the_height_that_works(tilt):
    def at(height):
        return plan_walk(
            preset("strider"), TRIPOD, straight_path(0.2), body_height=height, swing_height=0.01, body_tilt=tilt
        )

    (problem,) = at(0.011).problems
    roll, pitch = np.abs(tilt)
    below = 80 * math.sin(roll) * math.cos(pitch) + 120 * math.sin(pitch) + 25 * math.cos(roll) * math.cos(pitch)
    start, least = problem.removesuffix(" mm is needed").split("; a body height of at least ")
    assert start == f"body too low: at 0.00 s its underside is {below - 8 - 11:.1f} mm below the ground"
    assert below - 8 <= float(least) < below - 8 + 0.1 + 1e-6
    assert at(float(least) / 1000).ok


def test_a_body_on_its_way_downhill_is_not_too_low():
    level = walk()
    down = np.array([0.0, 0.0, -0.3])
    lower = dataclasses.replace(
        level, feet=level.feet + down, body=Pose(level.body.rotation, level.body.position + down)
    )
    assert lower.ok
    lying = dataclasses.replace(level, feet=level.feet - down)
    assert not any(problem.startswith("body too low") for problem in lying.problems)


def test_with_three_left_legs_in_the_air_the_robot_tips_over():
    motion = walk(Gait(0.5, (0.0, 0.0, 0.0, 0.5, 0.5, 0.5)), strict=False)
    (problem,) = motion.problems
    worst = int(np.argmin(motion.margin))
    assert problem == (
        f"tips over: at {motion.time[worst]:.2f} s the centre of mass is {-motion.margin[worst] * 1000:.1f} mm outside "
        "the support polygon"
    )
    assert motion.margin[worst] < -0.05


def test_with_no_foot_on_the_ground_the_robot_tips_over():
    motion = walk(Gait(0.4, (0.0,) * 6))
    assert motion.contacts.sum(-1).min() == 0
    (problem,) = motion.problems
    assert problem.startswith("tips over: at ")
    assert problem.endswith("s no foot is on the ground")


def test_feet_too_close_names_legs_and_distance():
    motion = walk(foot_distance=0.28, strict=False)
    (problem,) = motion.problems
    near = int(np.argmin(motion.least_foot_distance))
    assert problem.startswith(f"feet too close: at {motion.time[near]:.2f} s ")
    assert (
        f" are {motion.least_foot_distance[near] * 1000:.1f} mm apart, less than the required foot distance of 280.0 mm"
        in problem
    )


def test_a_joint_of_an_unknown_servo_has_the_speed_limit_of_live_walking():
    motion = walk(cycle_time=0.4, rate=200)
    none = motion.robot.replace(servos=((None,) * 3,) * 6)
    (problem,) = dataclasses.replace(motion, robot=none).problems
    assert problem.startswith("too fast: the tibia of ")
    assert "the limit is 286 deg/s, as the speed of its servo is unknown" in problem
    longer = float(problem.split("a cycle time of about ")[1].split(" s")[0])
    assert longer == pytest.approx(0.4 * np.abs(motion.joint_speed).max() / UNKNOWN_SPEED, abs=0.006)


def test_too_fast_names_the_joint_and_a_feasible_cycle_time():
    motion = walk(cycle_time=0.5, rate=200)
    (problem,) = motion.problems
    assert problem.startswith("too fast: the tibia of ")
    assert "its servo DS3225 reaches 462 deg/s without load" in problem
    longer = float(problem.split("a cycle time of about ")[1].split(" s")[0])
    assert longer == pytest.approx(0.5 * motion.speed_ratio.max(), abs=0.006)
    assert walk(cycle_time=longer * 1.01, rate=200).ok
    assert kinds(walk(cycle_time=longer * 0.97, rate=200)) == ["too fast"]


def test_a_leg_that_changes_its_branch_jumps():
    angles = standing(6)
    angles[3:, 4] = [0.0, 2.6, 0.1]
    motion = stepping(angles)
    assert kinds(motion) == ["jumps"]
    change = np.degrees(np.abs(angles[3, 4] - angles[2, 4]))
    joint = ("coxa", "femur", "tibia")[int(change.argmax())]
    assert motion.problems[0] == (
        f"jumps: at 0.20 s the {joint} of 4L would turn {change.max():.0f} deg within one sample, to another "
        "inverse-kinematics branch"
    )


def test_a_knee_that_passes_straight_slowly_does_not_jump():
    angles = standing(60)
    angles[:, :, 2] = np.linspace(-0.5, 0.4, 60)[:, None]
    assert kinds(stepping(angles)) == []


def test_problems_of_every_kind_are_in_order():
    one_sided = Gait(0.5, (0.0, 0.0, 0.0, 0.5, 0.5, 0.5))
    motion = walk(
        one_sided,
        path=straight_path(1.5),
        stroke=0.35,
        cycle_time=0.2,
        rate=200,
        foot_distance=0.4,
        strict=False,
    )
    assert kinds(motion) == ["out of reach", "tips over", "feet too close", "too fast"]


# What doesn't fit together


@pytest.mark.parametrize("name", ["feet", "contacts", "angles", "reach"])
def test_inconsistent_arrays_are_refused(name):
    motion = stepping(standing(4))
    with pytest.raises(InputError, match=f"a motion's {name} has shape"):
        dataclasses.replace(motion, **{name: getattr(motion, name)[1:]})
    with pytest.raises(InputError, match=f"a motion's {name} has shape"):
        dataclasses.replace(motion, **{name: getattr(motion, name)[:, 1:]})


def test_inconsistent_times_bodies_and_gaits_are_refused():
    motion = stepping(standing(4))
    with pytest.raises(InputError, match=r"a motion's time has shape \(2, 2\)"):
        dataclasses.replace(motion, time=motion.time.reshape(2, 2))
    for time in ([0.0, 0.1, 0.1, 0.3], [0.0, 0.2, 0.1, 0.3], [0.0, np.nan, 0.2, 0.3]):
        with pytest.raises(InputError, match="at increasing times"):
            dataclasses.replace(motion, time=np.array(time))
    with pytest.raises(InputError, match="two samples or more"):
        stepping(standing(1))
    with pytest.raises(InputError, match=r"a motion's body has batch axes \(\); expected \(4,\)"):
        dataclasses.replace(motion, body=Pose())
    with pytest.raises(InputError, match="is for 8 legs, the robot has 6"):
        dataclasses.replace(motion, gait=Gait.named("wave", legs=8))


@given(st.integers(2, 30), st.integers(0, 2**32 - 1))
def test_problems_of_any_angles_contain_no_nan(n, seed):
    rng = np.random.default_rng(seed)
    angles = standing(n) + rng.normal(size=(n, 6, 3)) * 0.3
    motion = stepping(angles, contacts=rng.random((n, 6)) < 0.6, foot_distance=0.05)
    assert motion.ok == (motion.problems == ())
    assert not any("nan" in problem for problem in motion.problems)
