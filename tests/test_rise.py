"""Getting up, sitting down and folding: what holds at every moment, whatever the angles that the robot is found in."""

import re

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from gait_robots import PRESETS, preset
from tarsus.control.sequence.joint_rates import JointRates
from tarsus.control.startup.folded_pose import belly_depth, folded_pose, rest_points
from tarsus.control.startup.foothold_stations import stations
from tarsus.control.startup.initial_state import initial_state
from tarsus.control.startup.planner import fold, sit_down, stand_up
from tarsus.control.startup.raise_body import raise_body
from tarsus.errors import InputError, TarsusError, UnreachableError
from tarsus.gait.setup import default_swing_height
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.polygon import hull_margin
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.rest import resting_pose
from tarsus.kinematics.stability import stability_margin
from tarsus.kinematics.stance import default_body_height, default_stance
from tarsus.robot.robot import stack_robots

_DT = 0.004


def stance_angles(robot, body_height=None, swing_height=None):
    swing_height = default_swing_height(robot) if swing_height is None else swing_height
    return inverse_kinematics(robot, default_stance(robot, body_height, swing_height=swing_height)).require().angles


def excess(robot, angles):
    low, high = robot.limits[..., 0], robot.limits[..., 1]
    return np.maximum(np.maximum(low - angles, angles - high), 0)


def sampled(sequence, times):
    """Moments, and as arrays of them all: angles, contacts, leg points and centres of mass in G."""
    moments = [sequence.at(t) for t in times]
    angles = np.array([m.angles for m in moments])
    body = Pose(np.array([m.body.rotation for m in moments]), np.array([m.body.position for m in moments]))
    points = body @ forward_kinematics(sequence.robot, angles)
    com = body @ centre_of_mass(sequence.robot, angles)
    under = (body @ rest_points(sequence.robot)[None])[..., 2].min(-1)
    return moments, angles, np.array([m.contacts for m in moments]), points, com, under


def check(sequence, start, *, dt=_DT):
    """All that holds for every sequence, from samples of it alone; returns the moments."""
    robot, pace = sequence.robot, sequence.pace
    # Standing still before and after it.
    times = np.arange(-2 * dt, sequence.duration + 3 * dt, dt)
    moments, angles, contacts, points, com, under = sampled(sequence, times)
    np.testing.assert_array_equal(angles[0], start if sequence.duration else sequence.angles_end)
    np.testing.assert_array_equal(angles[-1], sequence.angles_end)

    # Within speeds and accelerations, and so without a jump.
    assert (np.abs(np.diff(angles, axis=0)) / dt <= pace.speed * 1.0001 + 1e-9 / dt).all()
    assert (np.abs(np.diff(angles, 2, axis=0)) / dt**2 <= pace.acceleration * 1.0001 + 1e-9 / dt**2).all()

    # Joints found beyond a limit come in, and stay within it.
    assert (np.diff(excess(robot, angles), axis=0) <= 1e-7).all()

    # Over the whole of each time on the ground a foot stays where it came down.
    for leg in range(robot.legs):
        changes = np.flatnonzero(np.diff(contacts[:, leg].astype(int)))
        for part in np.split(np.arange(len(times)), changes + 1):
            if contacts[part[0], leg]:
                feet = points[part, leg, 3]
                assert np.abs(feet - feet[0]).max() < 1e-6
                assert np.abs(feet[:, 2]).max() < 1e-6
        # As it comes off, it goes up before it goes aside.
        for off in changes[contacts[changes, leg]] + 1:
            feet = points[off - 1 :, leg, 3]
            low = feet[: int(np.argmax(feet[:, 2] > 1e-3))]
            assert np.linalg.norm((low - feet[0])[:, :2], axis=-1).max(initial=0) < 2.5e-3
    assert points[..., 1:, 2].min() > -2e-6
    assert under.min() > -2e-6

    at_rest = np.array([m.belly for m in moments])
    for stage in sequence.stages:
        part = np.array([sequence.stage_at(t)[0] is stage for t in times])
        if not part.any():
            continue
        props = np.broadcast_to(stage.props, (part.sum(), *stage.props.shape))
        held = np.concatenate([points[part][:, :, 3], props], axis=1)[..., :2]
        bears = np.concatenate([contacts[part], np.ones(props.shape[:2], dtype=bool)], axis=1)
        assert (hull_margin(held, bears, com[part][:, :2]) >= -1e-6).all()
        if len(stage.props):
            # Beside the feet, nothing but what was found so bears it, or the belly.
            assert np.abs(stage.props[:, 2]).max() < 1e-6
        else:
            assert (contacts[part & ~at_rest].sum(-1) >= 3).all()
    end = sequence.at(sequence.duration)
    np.testing.assert_allclose(end.body.position[:2], 0, atol=1e-12)
    np.testing.assert_allclose(end.body.rpy, 0, atol=1e-9)
    return times, moments


@st.composite
def found(draw):
    """A preset, and joint angles anywhere within its limits and a little beyond."""
    robot = preset(draw(st.sampled_from(PRESETS)))
    low, high = robot.limits[..., 0] - 0.08, robot.limits[..., 1] + 0.08
    shares = np.random.default_rng(draw(st.integers(0, 2**32 - 1))).uniform(size=low.shape)
    return robot, low + shares * (high - low)


REASONS = (
    r"(leg [a-z]+ [a-z]+|front |middle |rear |held by [A-Z ]+|underside|no leg|tilted by).*\d",
    r"(limits|finds no way|can stay down|straight|dragged|margin|in the ground|at most|reaches|too|beyond|works)",
)
"""A refusal names the leg or the feet, with a number, and says what stands in the way."""


# Not shrunk: an example takes as long to shrink as all of them to try.
@settings(max_examples=18, phases=[Phase.explicit, Phase.generate])
@given(found(), st.floats(0.6, 1.4))
def test_it_gets_up_from_any_angles_or_says_why_not(start, share):
    robot, angles = start
    body_height = max(default_body_height(robot) * share, belly_depth(robot))
    try:
        stance = stance_angles(robot, body_height)
        sequence = stand_up(robot, angles, body_height=body_height)
    except TarsusError as error:
        refusal = str(error)
    else:
        refusal = None
    if refusal is not None:
        assert all(re.search(reason, refusal) for reason in REASONS), refusal
        return
    times, moments = check(sequence, angles)
    np.testing.assert_array_equal(sequence.angles_end, stance)
    assert moments[-1].contacts.all()
    assert moments[-1].body.position[2] == pytest.approx(body_height, abs=1e-12)
    as_it_rests(robot, sequence, times, moments)


def as_it_rests(robot, sequence, times, moments):
    """Held at some moments, the robot rests as the sequence says: an independent look, which knows of no sequence.

    Let down level, that is: tilted, a robot often has more than one way to rest.
    """
    for i in np.linspace(0, len(times) - 1, 12).astype(int):
        moment, stage = moments[i], sequence.stage_at(times[i])[0]
        if moment.body.rotation[2, 2] < 1 - 1e-12 or supports_margin(robot, moment, stage) < 1e-4:
            continue  # not level; or on the edge, where rounding decides
        rest = resting_pose(robot, moment.angles)
        assert rest.body.position[2] == pytest.approx(moment.body.position[2], abs=2e-6)
        np.testing.assert_allclose(rest.body.rotation[2], moment.body.rotation[2], atol=1e-4)
        if not moment.belly:
            lifted = (moment.body @ forward_kinematics(robot, moment.angles)[:, 3])[:, 2] > 1e-6
            np.testing.assert_array_equal(rest.contacts[lifted], False)
        down = rest.contacts | (rest.leg_points_down[:, :3].any() | rest.corners_down.any())
        assert (down | ~moment.contacts | ~touches_to_the_bit(robot, moment)).all()


def touches_to_the_bit(robot, moment):
    """Whether each foot is nearer to the ground than a resting foot need be."""
    return np.abs((moment.body @ forward_kinematics(robot, moment.angles)[:, 3])[:, 2]) < 1e-10


def supports_margin(robot, moment, stage):
    feet = (moment.body @ forward_kinematics(robot, moment.angles)[:, 3])[moment.contacts]
    held = np.concatenate([feet, stage.props])[:, :2]
    com = moment.body @ centre_of_mass(robot, moment.angles)
    return float(hull_margin(held, np.ones(len(held), dtype=bool), com[:2]))


def test_most_random_angles_are_got_up_from():
    """So that the property above is not kept by refusing."""
    rng = np.random.default_rng(4)
    up = 0
    for robot in map(preset, PRESETS):
        for _ in range(2):
            low, high = robot.limits[..., 0], robot.limits[..., 1]
            try:
                up += stand_up(robot, rng.uniform(low, high)).duration > 0
            except TarsusError:
                up += 0
    assert up >= 12


@pytest.mark.parametrize("name", PRESETS)
def test_from_the_folded_pose_it_pushes_straight_up(name):
    robot = preset(name)
    sequence = stand_up(robot, folded_pose(robot))
    times, moments = check(sequence, folded_pose(robot))
    assert list(dict.fromkeys(stage.name for stage in sequence.stages)) == ["put the feet down", "push up"]
    heights = [m.body.position[2] for m in moments]
    assert (np.diff(heights) >= -1e-12).all()
    assert heights[0] == pytest.approx(belly_depth(robot))
    assert all(abs(m.body.position[:2]).max() < 1e-12 for m in moments)
    as_it_rests(robot, sequence, times, moments)


@pytest.mark.parametrize("name", PRESETS)
def test_it_sits_down_the_way_it_got_up(name):
    robot = preset(name)
    up = stand_up(robot, folded_pose(robot))
    down = sit_down(robot, up.angles_end)
    _, moments = check(down, up.angles_end)
    np.testing.assert_allclose(down.angles_end, up.stages[-1].angles, atol=1e-9)
    assert moments[-1].body.position[2] == pytest.approx(belly_depth(robot))
    assert moments[-1].belly is False
    assert resting_pose(robot, down.angles_end).body.position[2] == pytest.approx(belly_depth(robot), abs=1e-9)
    np.testing.assert_array_equal(sit_down(robot).angles_end, down.angles_end)
    folded = fold(robot, down.angles_end)
    check(folded, down.angles_end)
    np.testing.assert_array_equal(folded.angles_end, folded_pose(robot))
    assert folded.at(folded.duration).belly


@pytest.mark.parametrize("name", PRESETS)
def test_too_high_for_one_foothold_it_changes_footholds_with_the_margin_kept(name):
    robot = preset(name)
    body_height = {"makeyourpet": 0.125, "strider": 0.2}.get(name, 0.17)
    sequence = stand_up(robot, folded_pose(robot), body_height=body_height, margin=0.02)
    check(sequence, folded_pose(robot))
    names = [stage.name for stage in sequence.stages]
    assert names.count("push up") == 2
    swing_heights = [stage for stage in sequence.stages if stage.name.startswith("place")]
    assert [stage.name for stage in swing_heights] == ["place LF LR RM", "place LM RR RF"]
    for stage in swing_heights:
        for share in np.linspace(0, 1, 9):
            angles, body = stage.angles_at(np.array([share]))[0], stage.body_at(np.array([share]))[0]
            assert stability_margin(robot, angles, body, stage.contacts) >= 0.02
    down = sit_down(robot, sequence.angles_end)
    check(down, sequence.angles_end)
    assert down.stages[-1].name in ("let down", "lie down")
    assert down.at(down.duration).body.position[2] == pytest.approx(belly_depth(robot), abs=1e-9)


@pytest.mark.parametrize("name", PRESETS)
def test_standing_already_it_keeps_its_feet_and_lifts_them_in_tripods(name):
    robot = preset(name)
    stance = stance_angles(robot)
    assert stand_up(robot, stance).duration == 0
    assert stand_up(robot, stance).at(0).stage == "hold"
    rng = np.random.default_rng(1)
    start = stance + np.deg2rad(rng.uniform(-2, 2, stance.shape))
    sequence = stand_up(robot, start)
    _, moments = check(sequence, start)
    assert not any(moment.belly for moment in moments)
    np.testing.assert_array_equal(sequence.angles_end, stance)


def test_only_single_legs_are_lifted_where_a_tripod_would_not_hold():
    """With the centre of mass far forward, no three feet hold it as safely as is asked for, five do."""
    robot = preset("strider").replace(body_com=np.array([0.1, 0, 0]))
    start = stance_angles(robot, 0.11)
    names = {
        margin: {s.name for s in stand_up(robot, start, body_height=0.2, margin=margin).stages if "place" in s.name}
        for margin in (0.06, 0.074)
    }
    assert names[0.06] == {"place LF LR RM", "place LM RR RF"}
    assert names[0.074] == {f"place {code}" for code in robot.leg_codes}
    check(stand_up(robot, start, body_height=0.2, margin=0.074), start)
    with pytest.raises(TarsusError, match=r"held by .*, the stability margin would be .* at least 300.0 mm"):
        stand_up(robot, start, body_height=0.2, margin=0.3)


def test_slower_joints_take_longer_and_limits_are_kept_by_each():
    robot = preset("phantomx")
    fast = stand_up(robot, folded_pose(robot))
    slow = stand_up(robot, folded_pose(robot), joint_speed=0.5, joint_acceleration=[1.0, 2.0, 3.0])
    check(slow, folded_pose(robot), dt=0.02)
    assert slow.duration > 2 * fast.duration
    np.testing.assert_array_equal(slow.pace.acceleration, np.tile([1.0, 2.0, 3.0], (6, 1)))
    np.testing.assert_allclose(fast.pace.speed, 0.5 * 6.39)
    np.testing.assert_allclose(fast.pace.acceleration, 0.5 * 6.39 / 0.05)


def test_stages_take_no_longer_than_the_limits_ask():
    """Some joint comes near to its greatest speed or acceleration in each."""
    robot = preset("phantomx")
    sequence = stand_up(robot, folded_pose(robot) + 0.1, joint_acceleration=1e3)
    for stage in sequence.stages:
        first, second = stage.table.first / stage.duration, stage.table.second / stage.duration**2
        used = max((np.abs(first) / sequence.pace.speed).max(), (np.abs(second) / sequence.pace.acceleration).max())
        assert 0.9 < used <= 1


def test_joints_beyond_their_limits_come_in_first():
    robot = preset("strider")
    start = np.array(folded_pose(robot))
    start[2] = robot.limits[2, :, 1] + np.deg2rad(4)
    sequence = stand_up(robot, start)
    check(sequence, start)


def test_on_a_knee_it_lifts_that_leg_with_the_others_down():
    robot = preset("strider")
    start = np.array(stance_angles(robot, 0.08))
    start[0] = np.deg2rad([0.0, -60.0, 0.0])
    rest = resting_pose(robot, start)
    assert rest.leg_points_down[0, 2] or rest.contacts[0]
    sequence = stand_up(robot, start)
    check(sequence, start)


def test_a_robot_that_has_fallen_over_is_refused():
    robot = preset("strider").replace(body_com=np.array([0.0, -0.5, 0.0]))
    start = np.tile(np.deg2rad([0.0, 80.0, 0.0]), (6, 1))
    with pytest.raises(TarsusError, match=r"tilted by \d+ deg; at most 60 deg can be made level: put it on its belly"):
        stand_up(robot, start)


def test_what_cannot_be_pushed_up_is_refused_with_what_would_work():
    robot = preset("ch3r")
    with pytest.raises(
        UnreachableError,
        match=r"pushing the body up to 180.0 mm: leg [a-z ]+ can't stand 111.1 mm from its coxa axis with the body's "
        r"origin 180.0 mm up: 0.7 mm too far, it reaches from .* a body height of 175.0 mm works",
    ):
        stand_up(robot, folded_pose(robot), body_height=0.18, swing_height=0.12)
    straight = preset("freenove")
    with pytest.raises(UnreachableError, match=r"origin 200.0 mm up, front left: it would be straight, or folded back"):
        stand_up(straight, folded_pose(straight), body_height=0.2, swing_height=0.02)
    strider = preset("strider")
    with pytest.raises(
        UnreachableError, match=r"at a body height of 10.0 mm the body would be in the ground: .* 25.0 mm"
    ):
        stand_up(strider, folded_pose(strider), body_height=0.01)


def test_heights_beyond_all_reach_are_named():
    robot = preset("strider")
    feet = default_stance(robot, 0.11)
    with pytest.raises(UnreachableError, match=r"origin .* mm up: there it reaches the ground nowhere"):
        stations(robot, 0.025, 0.5, feet, swing_height=0.03)


def test_a_stance_of_other_angles_is_no_end_to_jump_to():
    robot = preset("strider")
    stance = stance_angles(robot)
    draft = initial_state(robot, stance, JointRates.of(robot))
    with pytest.raises(UnreachableError, match=r"the stance is reached by other angles, 0\.[0-9]+ deg off"):
        raise_body(draft, default_stance(robot, swing_height=0.03), stance - 1e-5, swing_height=0.03, least=0.01)


def test_a_foot_that_bears_nothing_is_not_dragged_along_either():
    robot = preset("strider")
    draft = initial_state(robot, stance_angles(robot), JointRates.of(robot))
    draft.let_go(0)
    aside = Pose(draft.body.rotation, draft.body.position + np.array([0.02, 0.0, 0.001]))
    with pytest.raises(UnreachableError, match=r"foot of leg front left would be dragged .* up 1.0 mm"):
        draft.move_body("move", aside)
    draft.move_body("move", Pose(draft.body.rotation, draft.body.position + np.array([0.02, 0.0, 0.04])))
    assert draft.feet[0, 2] == pytest.approx(0.04)


def test_only_what_lies_on_its_belly_can_fold():
    robot = preset("strider")
    with pytest.raises(TarsusError, match=r"stands on 6 feet.* 85.0 mm higher .* sit_down"):
        fold(robot, stance_angles(robot))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"joint_speed": 0.0}, "joint_speed holds 0"),
        ({"joint_speed": np.nan}, "joint_speed holds nan"),
        (
            {"joint_acceleration": np.ones((2, 3))},
            r"(?s)joint_acceleration is .*; expected a number, or numbers of shape",
        ),
        ({"margin": -1.0}, "margin is -1"),
        ({"swing_height": np.inf}, "swing_height is inf"),
        ({"angles": np.zeros((2, 6, 3))}, "a single robot in a single pose"),
        ({"angles": np.zeros((5, 3))}, "angles has shape"),
        ({"angles": np.full((6, 3), np.nan)}, "angles"),
        ({"robot": stack_robots([preset("strider"), preset("strider")])}, r"not a batch \(2,\) of designs"),
    ],
)
def test_wrong_input_is_refused(changes, message):
    arguments = {"robot": preset("strider"), "angles": np.zeros((6, 3)), **changes}
    for plan in (stand_up, sit_down):
        with pytest.raises(InputError, match=message):
            plan(**arguments)
