"""The walk controller as a whole: how it executes commands, and which limitations it reports."""

import functools
import gc
import hashlib
import importlib
import itertools
import math
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from gait_robots import PRESETS, ROBOTS_AND_GAITS, point_feet, preset, ring
from tarsus.control.command import Command
from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.safety import Guard
from tarsus.control.walk_controller import WalkController
from tarsus.errors import InputError, UnknownNameError, UnreachableError
from tarsus.gait.gait import Gait
from tarsus.gait.path import twist_path
from tarsus.gait.plan import plan_walk
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.pose import Pose
from walk_trace import GAITS, Trace, drive

DIRECTIONS = {"forward": (1, 0, 0), "left": (0, 1, 0), "turning": (0, 0, 1), "all": (-0.6, 0.4, 1.5)}
STOP = (0.0, 0.0, 0.0)


def controller(name, gait="tripod", **given):
    return WalkController(point_feet(name), Gait.named(gait), **given)


def top(w, direction, share=1.0):
    """A share of the fastest twist in a direction."""
    return share * w.top_speed(direction) * np.asarray(direction, dtype=float)


def heading_feet(w):
    """The feet in the heading frame ``(legs,)``, complex [m]."""
    x, y, yaw = w.place
    return (w.feet[:, 0] + 1j * w.feet[:, 1] - (x + 1j * y)) * np.exp(-1j * yaw)


def stopped(trace, tick=0.025):
    """Command to stand until the robot does."""
    w = trace.controller
    until = w.time + 8 * w.cycle_time
    while w.walk_state != "standing":
        assert w.time < until, f"still {w.walk_state}"
        trace.step(STOP, tick)
    return trace


# Steady walking is what `plan_walk` plans.


def steady(w, twist, samples):
    """Angles over one cycle, once it is steady."""
    dt = w.cycle_time / samples
    for _ in range(6 * samples):
        w.step(twist, dt)
    return np.array([w.step(twist, dt) for _ in range(samples)])


def assert_planned(w, twist, **given):
    """The cycle is that of the planned walk, wherever in it each begins."""
    # Lifts of every gait fall on such samples.
    samples = 12 * math.ceil(w.cycle_time / 0.04 / 12)
    walked = steady(w, twist, samples)
    plan = plan_walk(
        w.robot,
        w.gait,
        twist_path(*twist, 6 * w.cycle_time),
        cycle_time=w.cycle_time,
        rate=samples / w.cycle_time,
        **given,
    )
    cruise = plan.angles[3 * samples : 4 * samples]
    assert min(np.abs(np.roll(cruise, k, axis=0) - walked).max() for k in range(samples)) < 1e-6
    assert np.ptp(walked, axis=0).max() > 0.1


@pytest.mark.lengthy
@pytest.mark.parametrize(("name", "gait"), ROBOTS_AND_GAITS)
def test_a_constant_twist_gives_the_planned_walks_cycle(name, gait):
    w = controller(name, gait)
    turn = PRESETS.index(name) + GAITS.index(gait)
    assert_planned(w, top(w, list(DIRECTIONS.values())[turn % len(DIRECTIONS)], 0.8))


@pytest.mark.parametrize("direction", DIRECTIONS.values(), ids=DIRECTIONS)
def test_so_it_does_with_another_height_lift_and_pace(direction):
    given = {"body_height": 0.13, "swing_height": 0.02}
    w = controller("strider", "ripple", cycle_time=2.3, **given)
    assert w.cycle_time == 2.3
    assert_planned(w, top(w, direction, 0.8), **given)


def test_a_cycle_time_goes_back_to_the_one_that_gets_farthest():
    w = controller("strider")
    best = w.cycle_time
    for command, expected in ((Command(cycle_time=2.0), 2.0), (Command(cycle_time="auto"), best)):
        for _ in range(400):
            w.step(command, 0.02)
        assert w.cycle_time == pytest.approx(expected, rel=1e-9)


def test_so_it_does_after_a_change_on_the_move():
    w = controller("strider", "tripod")
    for _ in range(400):
        w.step(Command(twist=(0.05, 0, 0), gait="wave", body_height=0.12, swing_height=0.025), 0.04)
    assert w.gait.name == "wave"
    # It starts afresh, so that its lifts fall on samples.
    stopped(Trace(w))
    assert_planned(w, np.array((0.03, 0.01, 0.05)), body_height=0.12, swing_height=0.025)


# Start, move, stop.


def test_a_new_walker_stands_over_the_origin_in_the_stance_of_walks():
    w = controller("strider")
    assert w.walk_state == "standing"
    assert w.place == (0, 0, 0)
    assert w.time == 0
    assert w.contacts.all()
    assert not w.twist.any()
    assert w.limitations == ()
    plan = plan_walk(w.robot, w.gait, twist_path(0.1, 0, 0, 2.0))
    np.testing.assert_allclose(w.angles, plan.angles[0], atol=1e-9)
    with pytest.raises(ValueError, match="read-only"):
        w.angles[0, 0] = 1.0


@pytest.mark.parametrize("name", PRESETS)
def test_standing_still_is_still(name):
    w = controller(name)
    before = w.angles.copy()
    for _ in range(50):
        assert (w.step(STOP, 0.03) == before).all()
    assert w.walk_state == "standing"
    assert w.place == (0, 0, 0)
    assert w.time == pytest.approx(1.5)


@pytest.mark.lengthy
@pytest.mark.parametrize(("name", "gait"), ROBOTS_AND_GAITS)
def test_a_robot_that_stops_puts_every_foot_to_its_rest_foothold(name, gait):
    w = controller(name, gait)
    rest, angles = heading_feet(w), w.angles.copy()
    trace = Trace(w).run(top(w, (1, 0.5, 1)), 2.3 * w.cycle_time)
    assert w.walk_state == "walking"
    trace.step(STOP, 0.025)
    assert w.walk_state == "stopping"
    stopped(trace)
    np.testing.assert_allclose(heading_feet(w), rest, atol=1e-6)
    np.testing.assert_allclose(w.angles, angles, atol=1e-5)
    assert not w.twist.any()
    last = w.angles.copy()
    assert (w.step(STOP, 0.05) == last).all()
    trace.assert_sound()


def test_a_foot_that_is_at_its_rest_foothold_is_not_lifted_to_stop():
    w = controller("strider", "wave")
    trace = stopped(Trace(w).run((0.02, 0, 0), 0.2))
    assert trace.contacts.sum() > 0.9 * trace.contacts.size


def test_it_starts_again_from_where_it_stopped():
    w = controller("strider")
    trace = stopped(Trace(w).run((0.1, 0, 0), 3))
    x = w.place[0]
    trace.run((0.1, 0, 0), 3)
    assert w.walk_state == "walking"
    assert w.place[0] > x + 0.15
    trace.assert_sound()


@pytest.mark.lengthy
@pytest.mark.parametrize(("name", "gait"), ROBOTS_AND_GAITS)
def test_at_full_speed_from_standing_and_back(name, gait):
    # Robots and gaits share the directions out; the fuzzed streams go on in all others.
    even = (PRESETS.index(name) + GAITS.index(gait)) % 2 == 0
    for direction in ((1, 0, 0), (0, 0, 4)) if even else ((-1, 0, -4), (0, 1, 0)):
        w = controller(name, gait)
        trace = Trace(w).run(10 * np.array(direction), 3 * w.cycle_time, 0.05)
        stopped(trace, tick=0.05).assert_sound()


# The twist.


def test_linear_and_angular_speeds_are_scaled_together():
    for direction in ((1.0, 0.5, 3.0), (0.3, -0.8, 2.0), (-0.7, 0.1, -1.0)):
        w, command = controller("strider"), np.array(direction)
        reached = []
        for _ in range(300):
            w.step(10 * command, 0.025)
            reached.append(w.twist)
        along = np.array(reached) @ command / (command @ command)
        np.testing.assert_allclose(np.array(reached), along[:, None] * command, atol=1e-9)
        assert along[-1] == pytest.approx(w.top_speed(direction), rel=1e-6)
        (reason,) = map(Limitation.text, w.limitations)
        assert reason.startswith(f"twist: {100 * along[-1] / 10:.0f} % of the command; ")
        assert any(leg in reason for leg in w.robot.leg_names)


@pytest.mark.parametrize("name", PRESETS)
def test_every_legs_reach_bounds_the_speed_in_every_direction(name):
    w = controller(name)
    for direction in itertools.product((-1, 0, 1), (-1, 0, 1), (-3, 0, 3)):
        if any(direction):
            whole = w.top_speed(direction)
            assert w.top_speed(2 * np.array(direction)) == pytest.approx(whole / 2)
            assert whole > 0.01


def test_a_feasible_command_is_what_is_walked():
    w = controller("phantomx")
    trace = Trace(w).run((0.08, 0.02, 0.2), 4)
    np.testing.assert_allclose(w.twist, (0.08, 0.02, 0.2), atol=1e-9)
    assert w.limitations == ()
    before, yaw = w.place, w.place[2]
    trace.run((0.08, 0.02, 0.2), 1.0)
    turn = 0.2
    # The exponential of the twist, by hand.
    s, c = math.sin(turn) / turn, (1 - math.cos(turn)) / turn
    ahead = complex(0.08 * s - 0.02 * c, 0.08 * c + 0.02 * s) * np.exp(1j * yaw)
    np.testing.assert_allclose(np.subtract(w.place, before), (ahead.real, ahead.imag, turn), atol=1e-9)


@pytest.mark.lengthy
@pytest.mark.parametrize("direction", ["forward", "turning"])
@pytest.mark.parametrize("name", ["strider", "phantomx"])
def test_top_speeds_are_reached_within_the_joints_limits(name, direction):
    w = controller(name)
    command = 10 * np.array(DIRECTIONS[direction])
    trace = Trace(w).run(command, 4 * w.cycle_time, 0.02)
    start, begun = np.array(w.place), w.time
    trace.run(command, 4 * w.cycle_time, 0.02).assert_sound()
    way, time = np.subtract(w.place, start), w.time - begun
    if direction == "forward":
        assert np.linalg.norm(way[:2]) / time >= 0.15
    else:
        assert way[2] / time >= 0.5


# Changing one's mind.


@pytest.mark.lengthy
@pytest.mark.parametrize(
    ("name", "gaits"),
    list(zip(["strider", "phantomx", "ch3r"] * 4, itertools.permutations(GAITS, 2), strict=True)),
)
def test_the_gait_changes_on_the_move_without_a_missing_support(name, gaits):
    first, second = gaits
    w = controller(name, first)
    twist = 0.8 * np.minimum(top(w, (1, 0, 1)), top(controller(name, second), (1, 0, 1)))
    trace = Trace(w).run(twist, 2.2 * w.cycle_time)
    trace.step(Command(twist=twist, gait=second), 0.025)
    until = w.time + 15
    while w.gait.name != second:
        assert w.time < until
        trace.step(twist, 0.025)
    trace.run(twist, 4.0)
    settled = len(trace.contacts)
    trace.run(twist, 2 * w.cycle_time)
    trace.assert_sound()
    np.testing.assert_allclose(w.twist, twist, rtol=1e-3)
    # It never stood still for it.
    moving = np.linalg.norm(np.diff(trace.body.position[:, :2], axis=0), axis=1) / trace.dt[1:]
    assert moving[40:].min() > 0.1 * twist[0]
    assert trace.contacts[settled:].mean() == pytest.approx(Gait.named(second).duty_factor, abs=0.03)


def aside_near_the_ground(trace, height=0.001):
    """How far a swinging foot that is lower than `height` is from its foothold at most [m]."""
    found = 0.0
    for leg in range(trace.controller.robot.legs):
        down, feet = trace.contacts[:, leg], trace.feet[:, leg]
        rows, last = np.arange(len(down)), np.flatnonzero(down)[-1]
        before = np.maximum.accumulate(np.where(down, rows, 0))
        after = np.minimum.accumulate(np.where(down, rows, last)[::-1])[::-1]
        low = ~down & (feet[:, 2] < height) & (rows < last)
        aside = [np.linalg.norm((feet - feet[foothold])[low, :2], axis=1) for foothold in (before, after)]
        found = max(found, np.minimum(*aside).max(initial=0.0))
    return found


@pytest.mark.lengthy
@pytest.mark.parametrize(("gait", "direction"), list(zip(GAITS, DIRECTIONS.values(), strict=True)), ids=GAITS)
def test_reversing_drags_no_foot(gait, direction):
    """Feet leave the ground and come down to it about as steeply as when walking on."""
    aside = []
    for turns in ((1, 1, 1), (1, -1, 1)):
        w = controller("strider", gait)
        trace = Trace(w)
        for sign in turns:
            trace.run(sign * top(w, direction), 1.6 * w.cycle_time, 0.01)
        trace.assert_sound()
        aside.append(aside_near_the_ground(trace))
    assert 0 < aside[1] < 1.5 * aside[0]


def test_a_foot_in_the_air_goes_where_the_new_command_needs_it():
    """Strides adapt mid-swing: the foothold follows a command that arrives during the swing."""
    ends = []
    for second in ((0.15, 0, 0), (0.0, 0.1, 0.5)):
        w = controller("strider")
        trace = Trace(w).run((0.15, 0, 0), 2.0, 0.02)
        while w.contacts[0]:
            trace.step((0.15, 0, 0), 0.02)
        trace.step((0.15, 0, 0), 0.02)
        while not w.contacts[0]:
            trace.step(second, 0.02)
        ends.append(w.feet[0])
    assert np.linalg.norm(ends[0] - ends[1]) > 0.005


# How it stands and steps.


def test_height_lift_width_and_pace_change_on_the_move():
    w = controller("strider")
    trace = Trace(w).run((0.08, 0, 0), 2)
    command = Command(twist=(0.08, 0, 0), body_height=0.14, swing_height=0.045, stance_width=0.01, cycle_time=1.5)
    trace.run(command, 20)
    assert w.limitations == ()
    assert w.cycle_time == pytest.approx(1.5)
    assert w.body.position[2] == pytest.approx(0.14, abs=1e-3)
    begin = len(trace.contacts)
    trace.run((0.08, 0, 0), 4 * 1.5, 0.02).assert_sound()
    assert trace.feet[begin:, :, 2].max() == pytest.approx(0.045, abs=1e-3)
    touchdowns = np.flatnonzero(np.diff(trace.contacts[begin:, 0].astype(int)) == 1)
    np.testing.assert_allclose(np.diff(touchdowns) * 0.02, 1.5, atol=0.021)
    stopped(trace)
    # As if it had stood so from the start; there, the width alone makes the difference.
    narrow, wide = (
        controller("strider", body_height=0.14, swing_height=0.045, stance_width=width) for width in (0.0, 0.01)
    )
    np.testing.assert_allclose(heading_feet(w), heading_feet(wide), atol=1e-6)
    mount = w.robot.geometry.mount_x + 1j * w.robot.geometry.mount_y
    out = np.abs(heading_feet(wide) - mount) - np.abs(heading_feet(narrow) - mount)
    np.testing.assert_allclose(out, 0.01, atol=1e-9)


def test_what_a_command_leaves_out_stays_as_it_is():
    one, other = controller("strider"), controller("strider")
    command = Command(twist=(0.05, 0, 0), body=(0, 0, 0.01, 0, 0.05, 0), swing_height=0.02, cycle_time=1.3)
    for tick in range(300):
        first = one.step(command, 0.02)
        second = other.step(command if tick == 0 else (0.05, 0, 0), 0.02)
        assert (first == second).all()


@pytest.mark.lengthy
@pytest.mark.parametrize(
    ("name", "axis"),
    list(zip(["strider", "phantomx"] * 3, range(6), strict=True)),
    ids=("x", "y", "z", "roll", "pitch", "yaw"),
)
def test_the_body_goes_as_far_as_all_legs_reach_and_says_which_one_stops_it(name, axis):
    w = controller(name)
    size = 0.3 if axis < 3 else 1.5
    body = np.eye(6)[axis] * size
    level = w.body.position[2]
    trace = Trace(w).run(Command(body=body), 45, 0.05)
    trace.assert_sound()
    assert w.walk_state == "standing"
    (reason,) = map(Limitation.text, w.limitations)
    (leg,) = [leg for leg, named in enumerate(w.robot.leg_names) if named in reason]
    row = np.array((*w.body.position - (0, 0, level), *w.body.rpy))
    assert 0.1 < row[axis] / size < 0.95
    np.testing.assert_allclose(np.delete(row, axis), 0, atol=1e-3)
    # On the ground and lifted every foot is within reach; a sixteenth of the way farther, that leg's isn't.
    feet = w.feet * [1, 1, 0] + np.array([0.0, w.robot.gait.swing_height])[:, None, None] * [0, 0, 1]
    assert inverse_kinematics(w.robot, feet, w.body).ok.all()
    row += body / 15
    beyond = Pose.from_rpy(*row[3:], row[:3] + np.array((0, 0, level)))
    assert inverse_kinematics(w.robot, feet, beyond).reach[:, leg].any()


def test_a_small_body_pose_is_met_in_full_while_walking():
    w = controller("strider")
    body = (0.01, -0.01, 0.015, 0.05, -0.04, 0.08)
    level = w.body.position[2]
    trace = Trace(w).run(Command(twist=(0.06, 0, 0), body=body), 5)
    trace.assert_sound()
    x, y, yaw = w.place
    seen = Pose.from_rpy(0, 0, yaw, (x, y, level)).inverse() @ w.body
    np.testing.assert_allclose((*seen.position, *seen.rpy), body, atol=1e-3)
    assert w.limitations == ()


def test_a_cycle_that_is_too_short_for_the_joints_is_lengthened_and_said():
    w = controller("phantomx", cycle_time=0.2)
    w.step(STOP, 0.02)
    (reason,) = map(Limitation.text, w.limitations)
    assert reason.startswith("cycle_time: ")
    assert f"{w.cycle_time:.4g} s instead of 0.2 s" in reason
    Trace(w).run((1, 0, 0), 4).assert_sound()


def test_what_cannot_be_is_refused_by_name_and_walking_goes_on():
    w = controller("strider")
    trace = Trace(w).run((0.1, 0, 0), 1)
    trace.run(Command(twist=(0.1, 0, 0), body_height=5.0), 3)
    (limitation,) = w.limitations
    assert limitation.kind is LimitationKind.BODY_HEIGHT
    assert limitation.asked == 5.0
    assert limitation.granted == pytest.approx(w.body.position[2], abs=1e-3)
    assert w.walk_state == "walking"
    trace.run(Command(twist=(0.1, 0, 0), body_height=0.11), 3).assert_sound()
    assert w.limitations == ()


# Legs as hands, a body that sways, ground that is felt.


def hand_of(trace, leg):
    """Where a foot is in the heading frame ``(n, 3)``, by forward kinematics."""
    body = trace.body
    seen = body.inverse() @ trace.feet
    level = Pose.from_rpy(*(body.rpy * [1, 1, 0]).T, body.position * [0, 0, 1])
    return (level @ seen)[:, leg]


def test_a_leg_leaves_the_gait_follows_its_target_and_returns():
    w = controller("strider", "wave")
    point = w.feet[0] + [0.03, 0.02, 0.06]
    trace = Trace(w).run((0.006, 0, 0.01), 3)
    trace.run(Command(twist=(0.006, 0, 0.01), foot_targets={0: point}), 20)
    assert w.limitations == ()
    x, y, yaw = w.place
    seen = Pose.from_rpy(0, 0, yaw, (x, y, 0)).inverse() @ trace.feet[-1]
    np.testing.assert_allclose(seen[0], point, atol=1e-4)
    assert not w.contacts[0]
    np.testing.assert_allclose(w.twist, (0.006, 0, 0.01), atol=1e-4)
    trace.run(Command(twist=(0.006, 0, 0.01), foot_targets={0: None}), 20)
    before = len(trace.contacts)
    trace.run((0.006, 0, 0.01), 2 * w.cycle_time)
    assert trace.contacts[before:, 0].mean() == pytest.approx(w.gait.duty_factor, abs=0.03)
    stopped(trace).assert_sound()
    assert w.contacts.all()


def test_a_foot_moves_at_its_commanded_velocity():
    w = controller("strider", "wave")
    trace = Trace(w).run(Command(foot_targets={5: w.feet[5] + [0, 0, 0.03]}), 18)
    start = hand_of(trace, 5)[-1]
    for _ in range(100):
        trace.step(Command(foot_velocities={5: (0.01, 0, 0.02)}), 0.02)
    trace.run(STOP, 2).assert_sound()
    np.testing.assert_allclose(hand_of(trace, 5)[-1] - start, (0.02, 0, 0.04), atol=1e-3)


def test_a_foot_target_out_of_reach_is_limited_and_reported():
    w = controller("strider", "wave")
    trace = Trace(w).run(Command(foot_targets={0: (0.6, 0.3, 0.1)}), 16)
    (reason,) = map(Limitation.text, w.limitations)
    assert reason.startswith("foot_target: ")
    assert "front left" in reason
    trace.run(Command(foot_targets={0: None}), 16).assert_sound()
    assert w.limitations == ()


def test_legs_that_no_gait_can_do_without_stay_and_the_margin_is_said():
    w = controller("strider", "tripod")
    targets = {leg: w.feet[leg] + [0, 0, 0.05] for leg in (0, 1)}
    trace = Trace(w).run(Command(twist=(0.05, 0, 0), foot_targets=targets), 10)
    trace.assert_sound()
    (reason,) = map(Limitation.text, w.limitations)
    assert re.search(r"middle left: not enough support in the tripod gait without this leg, \d+ mm outside its", reason)
    assert trace.contacts[-60:, 0].any()


def test_the_body_sways_with_the_steps_and_is_still_when_it_stands():
    w = controller("strider", "wave")
    level = w.body.position[2]
    trace = Trace(w).run(Command(sway=(0, 0, 0.01, 0, 0, 0)), 2)
    assert (trace.body.position[:, 2] == level).all()
    trace.run((0.03, 0, 0), 4 * w.cycle_time)
    before = len(trace.contacts)
    trace.run((0.03, 0, 0), 2 * w.cycle_time)
    swayed = trace.body.position[before:, 2] - level
    assert 0.005 < swayed.max() <= 0.0101
    assert swayed.mean() == pytest.approx(0, abs=1e-3)
    stopped(trace).assert_sound()
    trace.run(STOP, 3)
    assert w.body.position[2] == pytest.approx(level, abs=1e-4)


# Time.


def test_a_late_tick_is_no_jump():
    late, prompt = Trace(controller("strider")), Trace(controller("strider"))
    for tick in range(100):
        late.step((0.2, 0, 0.3), 2.0 if tick % 7 == 3 else 0.05)
        prompt.step((0.2, 0, 0.3), 0.05)
    assert (late.angles == prompt.angles).all()
    assert late.controller.time == prompt.controller.time


def test_short_and_long_ticks_follow_the_same_path():
    places, angles = [], []
    for dt in (0.005, 0.01, 0.025, 0.05):
        w = controller("strider")
        trace = Trace(w)
        for twist in ((0.1, 0, 0), (0.1, 0.05, 0.4), (-0.1, 0, 0.2), STOP):
            trace.run(twist, 2.5, dt)
        places.append(w.place)
        angles.append(w.angles)
        trace.assert_sound()
    np.testing.assert_allclose(places, [places[0]] * 4, atol=0.02)
    np.testing.assert_allclose(angles, [angles[0]] * 4, atol=1e-6)


def digest(seed):
    trace = drive(controller("phantomx", "ripple"), seed, 20.0)
    return hashlib.sha256(trace.angles.tobytes()).hexdigest()


@pytest.mark.no_cover
def test_the_same_stream_gives_the_same_angles_to_the_bit():
    script = "import test_walk_controller; print(test_walk_controller.digest(5))"
    command = [sys.executable, "-c", script]
    # Another process, another order of whatever is hashed.
    environment = os.environ | {"PYTHONHASHSEED": "7", "PYTHONPATH": os.pathsep.join(sys.path)}
    answer = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert answer.stdout.strip() == digest(5) == digest(5)
    assert digest(6) != digest(5)


@pytest.mark.no_cover
def test_memory_does_not_grow():
    """One number kept a tick would show, and an object kept for each change of how it walks."""
    w = controller("strider")
    commands = [Command(twist=(0.1, 0, 0.2), gait=gait, body=(0, 0, z, 0, 0, 0)) for gait in GAITS for z in (0.0, 0.01)]

    def kept():
        """Walk for two minutes, and count what is there afterwards: objects that hold others, and blocks of memory."""
        for command in commands:
            for _ in range(300):
                w.step(command, 0.05)
        gc.collect()
        return np.array([len(gc.get_objects()), sys.getallocatedblocks()])

    kept()
    objects, blocks = -kept() + kept()
    # Eight changes of at least five objects each; caches of NumPy's own fill by a few dozen blocks.
    assert objects < 30
    assert blocks < 200


# Malformed commands.

NAN, INF = math.nan, math.inf
BAD = {
    "NaN": ((NAN, 0, 0), 0.02),
    "infinite": ((0, INF, 0), 0.02),
    "two numbers": ((0, 0), 0.02),
    "text": ("fast", 0.02),
    "nothing": (None, 0.02),
    "no time": ((0, 0, 0), 0.0),
    "back in time": ((0, 0, 0), -0.01),
    "NaN time": ((0, 0, 0), NAN),
    "infinite time": ((0, 0, 0), INF),
    "time in words": ((0, 0, 0), "soon"),
}
BAD_WISHES = {
    "body": {"body": (0, 0, NAN, 0, 0, 0)},
    "body of two": {"body": (0, 0)},
    "body_height": {"body_height": NAN},
    "body height in words": {"body_height": "high"},
    "swing_height": {"swing_height": -0.01},
    "infinite lift": {"swing_height": INF},
    "width": {"stance_width": -INF},
    "cycle time": {"cycle_time": 0.0},
    "negative cycle time": {"cycle_time": -1.0},
    "a leg too many": {"foot_targets": {6: (0, 0, 0)}},
    "a hand that is nowhere": {"foot_targets": {0: (NAN, 0, 0)}},
    "hands without legs": {"foot_targets": [(0, 0, 0)]},
    "a hand's speed in words": {"foot_velocities": {0: "slow"}},
    "sway": {"sway": (INF,) * 6},
    "a leg that is no whole number": {"foot_targets": {1.0: (0, 0, 0)}},
    "a hand's speed that is none": {"foot_velocities": {1: None}},
    "cycle times": {"cycle_time": np.array([1.0, 2.0])},
    "gait by number": {"gait": 3},
    "gait for four": {"gait": Gait(duty_factor=0.75, offsets=(0, 0.25, 0.5, 0.75))},
}


@functools.cache
def undisturbed():
    return Trace(controller("strider")).run((0.1, 0, 0.1), 1).run((0, 0.1, 0), 1).angles


@pytest.mark.parametrize("bad", [*BAD.values(), *({"twist": (0, 0, 0), **w} for w in BAD_WISHES.values())], ids=repr)
def test_what_is_no_command_is_refused_and_changes_nothing(bad):
    w = controller("strider")
    trace = Trace(w).run((0.1, 0, 0.1), 1)
    with pytest.raises(InputError):
        w.step(Command(**bad), 0.02) if isinstance(bad, dict) else w.step(*bad)
    trace.run((0, 0.1, 0), 1)
    assert (trace.angles == undisturbed()).all()


def test_a_robot_that_could_not_step_as_it_stands_is_refused_with_the_reason():
    with pytest.raises(
        UnreachableError, match=r"can't stand and step in this stance: front left: end of the leg's reach"
    ):
        controller("strider", stance_width=0.1)


@pytest.mark.parametrize("direction", [(0, 0, 0), (NAN, 0, 0), (1, 0), "ahead"])
def test_a_top_speed_is_of_a_direction(direction):
    with pytest.raises(InputError, match="direction"):
        controller("strider").top_speed(direction)


def test_an_unknown_gait_is_refused_with_those_that_there_are():
    w = controller("strider")
    with pytest.raises(UnknownNameError, match="tripod"):
        w.step(Command(gait="tripot"), 0.02)
    assert (w.step(STOP, 0.02) == controller("strider").angles).all()


@pytest.mark.parametrize(
    "given",
    [
        {"body_height": NAN},
        {"swing_height": -0.1},
        {"cycle_time": 0.0},
        {"stance_width": INF},
        {"joint_speed": 0.0},
        {"joint_acceleration": NAN},
        {"foot_distance": -1.0},
    ],
    ids=repr,
)
def test_a_walker_of_nonsense_is_refused(given):
    with pytest.raises(InputError):
        controller("strider", **given)


def test_a_robot_that_cannot_walk_so_is_refused():
    with pytest.raises(UnreachableError):
        controller("strider", body_height=2.0)
    with pytest.raises(InputError):
        WalkController(preset("strider"), Gait(duty_factor=0.75, offsets=(0, 0.25, 0.5, 0.75)))


# With the guard behind it, and on other legs.


@pytest.mark.lengthy
@pytest.mark.parametrize("name", PRESETS[::2])
def test_the_guard_lets_clean_walks_through(name):
    w = controller(name)
    guard = Guard(w.robot, start=w.angles)
    script = [top(w, (1, 0, 0)), top(w, (0.5, 0.5, 1)), top(w, (-1, 0, 0)), STOP]
    gaits = ("tripod", "ripple", "tripod", "wave")
    for twist, gait in zip(script, gaits, strict=True):
        for _ in range(150):
            angles = w.step(Command(twist=twist, gait=gait), 0.02)
            checked = guard.check(angles, 0.02, w.contacts, w.body)
            assert checked.ok, checked.interventions
            assert (checked.angles == angles).all()
    assert not any(guard.counts.values())


@pytest.mark.parametrize("legs", [5, 8])
def test_other_numbers_of_legs_walk_too(legs):
    robot = ring(legs)
    w = WalkController(robot, Gait.named("wave", legs=legs))
    trace = Trace(w).run(top(w, (1, 0, 1)), 2.5 * w.cycle_time, 0.05)
    stopped(trace).assert_sound()
    assert w.place[0] > 0.01


def test_slow_joints_make_a_slow_walk():
    slow, quick = (controller("strider", joint_speed=speed, joint_acceleration=20 * speed) for speed in (1.5, 6.0))
    assert slow.cycle_time > 2 * quick.cycle_time
    assert slow.top_speed((1, 0, 0)) < 0.5 * quick.top_speed((1, 0, 0))
    Trace(slow).run((1, 0, 1), 10, 0.05).assert_sound()


# The page about it.

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "walking-live.md").read_text(encoding="utf-8")


def benchmark():
    """`benchmarks/walk_controller.py`, which writes the table of top speeds."""
    sys.path.insert(0, str(ROOT / "benchmarks"))
    try:
        return importlib.import_module("walk_controller")
    finally:
        sys.path.pop(0)


def test_the_pages_example_runs(capsys):
    (example,) = re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)
    exec(example, {})
    (shown,) = re.findall(r"```text\n(.*?)```", PAGE, flags=re.DOTALL)
    assert capsys.readouterr().out == shown


@pytest.mark.lengthy
@pytest.mark.parametrize(("name", "gait"), [("strider", "tripod"), ("phantomx", "tripod"), ("ch3r", "wave")])
def test_the_pages_top_speeds_are_those_reached(name, gait):
    (shown,) = re.findall(rf"^\| {name} \| {gait} \|(.*)\|$", PAGE, flags=re.MULTILINE)
    cells = [float(cell) for cell in shown.split("|")]
    reached = [benchmark().top_speed(preset(name), gait, direction) for direction in benchmark().DIRECTIONS]
    np.testing.assert_allclose(
        cells, [WalkController(preset(name), Gait.named(gait)).cycle_time, *reached], atol=0.0051
    )


def test_the_page_shows_every_preset_gait_and_direction():
    rows = re.findall(r"^\| ([\w-]+) \| (\w+) \| [\d. |]+$", PAGE, flags=re.MULTILINE)
    assert rows == list(itertools.product(PRESETS, GAITS))
    for name in Command.__dataclass_fields__:
        assert f"`{name}`" in PAGE
