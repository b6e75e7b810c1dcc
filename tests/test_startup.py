"""Standing up, sitting down and folding from any joint angles: properties of the planned motion at all times."""

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from gait_robots import PRESETS, preset
from tarsus.control.startup.builder import BodyTarget
from tarsus.control.startup.initial_state import measured_state, over_feet, resting_state
from tarsus.control.startup.planner import fold, sit_down, stand_up
from tarsus.control.startup.raise_body import raise_body
from tarsus.errors import InputError, TarsusError, UnreachableError
from tarsus.kinematics.folded_pose import folded_pose
from tarsus.kinematics.foothold_stations import foothold_stations
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.polygon import hull_margin
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.rest import resting_pose
from tarsus.kinematics.stability import stability_margin
from tarsus.kinematics.stance import default_body_height, default_stance, default_swing_height
from tarsus.kinematics.underside import belly_depth, underside_points
from tarsus.robot.robot import stack_robots

_DT = 0.004


def stance_angles(robot, body_height=None, swing_height=None):
    swing_height = default_swing_height(robot) if swing_height is None else swing_height
    return inverse_kinematics(robot, default_stance(robot, body_height, swing_height=swing_height)).require().angles


def excess(robot, angles):
    low, high = robot.limits[..., 0], robot.limits[..., 1]
    return np.maximum(np.maximum(low - angles, angles - high), 0)


def sitting_height(robot):
    """Height of the body over the feet's centres with feet and belly on the ground."""
    return belly_depth(robot) - float(robot.foot_radius.min())


def sampled(sequence, times):
    """Samples, and as arrays: angles, contacts, leg points and centres of mass in G, height of the underside."""
    samples = [sequence.at(t) for t in times]
    angles = np.array([s.angles for s in samples])
    body = Pose(np.array([s.body.rotation for s in samples]), np.array([s.body.position for s in samples]))
    points = body @ forward_kinematics(sequence.robot, angles)
    com = body @ centre_of_mass(sequence.robot, angles)
    underside = (body @ underside_points(over_feet(sequence.robot))[None])[..., 2].min(-1)
    return samples, angles, np.array([s.contacts for s in samples]), points, com, underside


def check(sequence, start, *, dt=_DT):
    """Check the properties of every sequence on samples; return times and samples."""
    robot, limits = sequence.robot, sequence.joint_limits
    # At rest before and after.
    times = np.arange(-2 * dt, sequence.duration + 3 * dt, dt)
    samples, angles, contacts, points, com, underside = sampled(sequence, times)
    np.testing.assert_array_equal(angles[0], start if sequence.duration else sequence.angles_end)
    np.testing.assert_array_equal(angles[-1], sequence.angles_end)

    # Within speed and acceleration limits.
    assert (np.abs(np.diff(angles, axis=0)) / dt <= limits.speed * 1.0001 + 1e-9 / dt).all()
    assert (np.abs(np.diff(angles, 2, axis=0)) / dt**2 <= limits.acceleration * 1.0001 + 1e-9 / dt**2).all()

    # Joints beyond a limit initially return, and stay within it.
    assert (np.diff(excess(robot, angles), axis=0) <= 1e-7).all()

    # A foot on the ground is stationary.
    for leg in range(robot.legs):
        changes = np.flatnonzero(np.diff(contacts[:, leg].astype(int)))
        for part in np.split(np.arange(len(times)), changes + 1):
            if contacts[part[0], leg]:
                feet = points[part, leg, 3]
                assert np.abs(feet - feet[0]).max() < 1e-6
                assert np.abs(feet[:, 2]).max() < 1e-6
        # A foot rises before it moves horizontally.
        for off in changes[contacts[changes, leg]] + 1:
            feet = points[off - 1 :, leg, 3]
            low = feet[: int(np.argmax(feet[:, 2] > 1e-3))]
            assert np.linalg.norm((low - feet[0])[:, :2], axis=-1).max(initial=0) < 2.5e-3
    assert points[..., 1:, 2].min() > -2e-6
    assert underside.min() > -2e-6

    at_rest = np.array([s.belly for s in samples])
    at_time = [id(sequence.stage_at(t)[0]) for t in times]
    for stage in sequence.stages:
        part = np.array(at_time) == id(stage)
        if not part.any():
            continue
        supports = np.broadcast_to(stage.supports, (part.sum(), *stage.supports.shape))
        held = np.concatenate([points[part][:, :, 3], supports], axis=1)[..., :2]
        bears = np.concatenate([contacts[part], np.ones(supports.shape[:2], dtype=bool)], axis=1)
        assert (hull_margin(held, bears, com[part][:, :2]) >= -1e-6).all()
        if len(stage.supports):
            # Knees and points of the body bear load on the ground only.
            assert np.abs(stage.supports[:, 2]).max() < 1e-6
        else:
            assert (contacts[part & ~at_rest].sum(-1) >= 3).all()
    end = sequence.at(sequence.duration)
    np.testing.assert_allclose(end.body.position[:2], 0, atol=1e-12)
    np.testing.assert_allclose(end.body.rpy, 0, atol=1e-9)
    return times, samples


@st.composite
def initial_poses(draw):
    """A preset, and joint angles within its limits or slightly beyond."""
    robot = preset(draw(st.sampled_from(PRESETS)))
    low, high = robot.limits[..., 0] - 0.08, robot.limits[..., 1] + 0.08
    fractions = np.random.default_rng(draw(st.integers(0, 2**32 - 1))).uniform(size=low.shape)
    return robot, low + fractions * (high - low)


REASONS = (
    r"(leg [a-z]+ [a-z]+|front |middle |rear |supported by [A-Z ]+|underside|no leg|tilted by).*\d",
    r"(limits|has no path|can stay on|straight|drag|margin|below the ground|at most|reaches|too|beyond|works)",
)
"""An error names the leg or the feet, a number, and what prevents the motion."""


# Shrinking one example takes as long as trying all of them.
@settings(max_examples=8, phases=[Phase.explicit, Phase.generate])
@given(initial_poses(), st.floats(0.6, 1.4))
def test_it_stands_up_from_any_angles_or_gives_the_reason(start, fraction):
    robot, angles = start
    body_height = max(default_body_height(robot) * fraction, sitting_height(robot))
    try:
        stance = stance_angles(robot, body_height)
        sequence = stand_up(robot, angles, body_height=body_height)
    except TarsusError as error:
        message = str(error)
    else:
        message = None
    if message is not None:
        assert all(re.search(pattern, message) for pattern in REASONS), message
        return
    times, samples = check(sequence, angles)
    np.testing.assert_array_equal(sequence.angles_end, stance)
    assert samples[-1].contacts.all()
    assert samples[-1].body.position[2] == pytest.approx(body_height, abs=1e-12)
    check_rest(robot, sequence, times, samples)


def check_rest(robot, sequence, times, samples):
    """Check some samples against the resting pose of their joint angles, which is independent of the sequence.

    Only level samples are checked: a tilted robot often has more than one resting pose.
    """
    for i in np.linspace(0, len(times) - 1, 12).astype(int):
        sample, stage = samples[i], sequence.stage_at(times[i])[0]
        if sample.body.rotation[2, 2] < 1 - 1e-12 or supports_margin(robot, sample, stage) < 1e-4:
            continue  # tilted, or undetermined by rounding
        rest = resting_pose(over_feet(robot), sample.angles)
        assert rest.body.position[2] == pytest.approx(sample.body.position[2], abs=2e-6)
        np.testing.assert_allclose(rest.body.rotation[2], sample.body.rotation[2], atol=1e-4)
        if not sample.belly:
            lifted = (sample.body @ forward_kinematics(robot, sample.angles)[:, 3])[:, 2] > 1e-6
            np.testing.assert_array_equal(rest.contacts[lifted], False)
        down = rest.contacts | (rest.leg_points_down[:, :3].any() | rest.corners_down.any())
        assert (down | ~sample.contacts | ~touches_exactly(robot, sample)).all()


def touches_exactly(robot, sample):
    """Whether each foot is closer to the ground than the tolerance of resting poses."""
    return np.abs((sample.body @ forward_kinematics(robot, sample.angles)[:, 3])[:, 2]) < 1e-10


def supports_margin(robot, sample, stage):
    feet = (sample.body @ forward_kinematics(robot, sample.angles)[:, 3])[sample.contacts]
    held = np.concatenate([feet, stage.supports])[:, :2]
    com = sample.body @ centre_of_mass(robot, sample.angles)
    return float(hull_margin(held, np.ones(len(held), dtype=bool), com[:2]))


def test_it_stands_up_from_most_random_angles():
    """The property above would also hold if every plan were refused."""
    rng = np.random.default_rng(4)
    count = 0
    for robot in map(preset, PRESETS):
        for _ in range(2):
            low, high = robot.limits[..., 0], robot.limits[..., 1]
            try:
                count += stand_up(robot, rng.uniform(low, high)).duration > 0
            except TarsusError:
                count += 0
    assert count >= 12


@pytest.mark.lengthy
@pytest.mark.parametrize("name", PRESETS)
def test_it_rises_vertically_from_the_folded_pose(name):
    robot = preset(name)
    sequence = stand_up(robot, folded_pose(robot))
    times, samples = check(sequence, folded_pose(robot))
    assert list(dict.fromkeys(stage.name for stage in sequence.stages)) == ["place feet", "raise body"]
    heights = [s.body.position[2] for s in samples]
    assert (np.diff(heights) >= -1e-12).all()
    assert heights[0] == pytest.approx(sitting_height(robot))
    assert all(abs(s.body.position[:2]).max() < 1e-12 for s in samples)
    check_rest(robot, sequence, times, samples)


@pytest.mark.lengthy
@pytest.mark.parametrize("name", PRESETS)
def test_sitting_down_reverses_standing_up(name):
    robot = preset(name)
    up = stand_up(robot, folded_pose(robot))
    down = sit_down(robot, up.angles_end)
    _, samples = check(down, up.angles_end)
    np.testing.assert_allclose(down.angles_end, up.stages[-1].angles, atol=1e-9)
    assert samples[-1].body.position[2] == pytest.approx(sitting_height(robot))
    assert samples[-1].belly is False
    assert resting_pose(robot, down.angles_end).body.position[2] == pytest.approx(belly_depth(robot), abs=1e-9)
    np.testing.assert_array_equal(sit_down(robot).angles_end, down.angles_end)
    folded = fold(robot, down.angles_end)
    check(folded, down.angles_end)
    np.testing.assert_array_equal(folded.angles_end, folded_pose(robot))
    assert folded.at(folded.duration).belly


@pytest.mark.lengthy
@pytest.mark.parametrize("name", PRESETS[::2])
def test_it_changes_footholds_within_the_margin_on_the_way_to_a_great_height(name):
    robot = preset(name)
    body_height = {"makeyourpet": 0.125, "strider": 0.2}.get(name, 0.17)
    sequence = stand_up(robot, folded_pose(robot), body_height=body_height, margin=0.02)
    check(sequence, folded_pose(robot))
    names = [stage.name for stage in sequence.stages]
    assert names.count("raise body") == 2
    changes = [stage for stage in sequence.stages if stage.name.startswith("place") and stage.name != "place feet"]
    assert [stage.name for stage in changes] == ["place LF LR RM", "place LM RR RF"]
    for stage in changes:
        for fraction in np.linspace(0, 1, 9):
            at = np.array([fraction])
            angles, body = stage.angles_at(at)[0], stage.body_at(at)[0]
            assert stability_margin(robot, angles, body, stage.contacts) >= 0.02
    down = sit_down(robot, sequence.angles_end)
    check(down, sequence.angles_end)
    assert down.stages[-1].name in ("lower body", "lie down")
    assert down.at(down.duration).body.position[2] == pytest.approx(sitting_height(robot), abs=1e-9)


@pytest.mark.lengthy
@pytest.mark.parametrize("name", PRESETS)
def test_a_standing_robot_moves_its_feet_in_tripods(name):
    robot = preset(name)
    stance = stance_angles(robot)
    assert stand_up(robot, stance).duration == 0
    assert stand_up(robot, stance).at(0).stage == "hold"
    rng = np.random.default_rng(1)
    start = stance + np.deg2rad(rng.uniform(-2, 2, stance.shape))
    sequence = stand_up(robot, start)
    _, samples = check(sequence, start)
    assert not any(sample.belly for sample in samples)
    np.testing.assert_array_equal(sequence.angles_end, stance)


def test_single_legs_are_lifted_where_a_tripod_has_too_little_margin():
    """With the centre of mass far forward, three feet have too little stability margin, five have enough."""
    robot = preset("strider").replace(body_com=np.array([0.1, 0, 0]))
    start = stance_angles(robot, 0.11)
    names = {
        margin: {s.name for s in stand_up(robot, start, body_height=0.2, margin=margin).stages if "place" in s.name}
        for margin in (0.06, 0.074)
    }
    assert names[0.06] == {"place LF LR RM", "place LM RR RF"}
    assert names[0.074] == {f"place {code}" for code in robot.leg_codes}
    check(stand_up(robot, start, body_height=0.2, margin=0.074), start)
    with pytest.raises(TarsusError, match=r"supported by .*, the stability margin would be .* at least 300.0 mm"):
        stand_up(robot, start, body_height=0.2, margin=0.3)


def test_the_duration_follows_from_the_joint_limits():
    robot = preset("phantomx")
    fast = stand_up(robot, folded_pose(robot))
    slow = stand_up(robot, folded_pose(robot), joint_speed=0.5, joint_acceleration=[1.0, 2.0, 3.0])
    check(slow, folded_pose(robot), dt=0.02)
    assert slow.duration > 2 * fast.duration
    np.testing.assert_array_equal(slow.joint_limits.acceleration, np.tile([1.0, 2.0, 3.0], (6, 1)))
    np.testing.assert_allclose(fast.joint_limits.speed, 0.5 * 6.39)
    np.testing.assert_allclose(fast.joint_limits.acceleration, 0.5 * 6.39 / 0.05)


def test_stages_use_the_joint_limits():
    """In each stage, some joint comes close to its greatest speed or acceleration."""
    robot = preset("phantomx")
    sequence = stand_up(robot, folded_pose(robot) + 0.1, joint_acceleration=1e3)
    for stage in sequence.stages:
        first, second = (each / stage.duration**n for n, each in enumerate(stage.derivatives, 1))
        used = max(
            (np.abs(first) / sequence.joint_limits.speed).max(),
            (np.abs(second) / sequence.joint_limits.acceleration).max(),
        )
        assert 0.9 < used <= 1


def test_joints_beyond_their_limits_return_first():
    robot = preset("strider")
    start = np.array(folded_pose(robot))
    start[2] = robot.limits[2, :, 1] + np.deg2rad(4)
    sequence = stand_up(robot, start)
    check(sequence, start)


def test_a_leg_on_its_knee_is_lifted_first():
    robot = preset("strider")
    start = np.array(stance_angles(robot, 0.08))
    start[0] = np.deg2rad([0.0, -60.0, 0.0])
    rest = resting_pose(robot, start)
    assert rest.leg_points_down[0, 2] or rest.contacts[0]
    sequence = stand_up(robot, start)
    check(sequence, start)


def test_a_robot_that_has_fallen_over_is_rejected():
    robot = preset("strider").replace(body_com=np.array([0.0, -0.5, 0.0]))
    start = np.tile(np.deg2rad([0.0, 80.0, 0.0]), (6, 1))
    with pytest.raises(
        TarsusError, match=r"tilted by \d+ deg; at most 60 deg can be levelled: place the robot on its belly"
    ):
        stand_up(robot, start)


def test_an_unreachable_height_is_rejected_with_one_that_works():
    robot = preset("ch3r")
    with pytest.raises(
        UnreachableError,
        match=r"raising the body to 180.0 mm: at body height 180.0 mm, leg [a-z ]+ cannot reach the ground 111.1 mm "
        r"from its coxa axis: 0.7 mm too far, it reaches from .* a body height of 175.0 mm works",
    ):
        stand_up(robot, folded_pose(robot), body_height=0.18, swing_height=0.12)
    straight = preset("freenove")
    with pytest.raises(UnreachableError, match=r"at body height 200.0 mm, front left would be straight, or folded"):
        stand_up(straight, folded_pose(straight), body_height=0.2, swing_height=0.02)
    strider = preset("strider")
    with pytest.raises(UnreachableError, match=r"body_height is 10.0 mm; it must be at least 17.0 mm"):
        stand_up(strider, folded_pose(strider), body_height=0.01)


def test_a_height_out_of_all_reach_is_reported():
    robot = preset("strider")
    feet = default_stance(robot, 0.11)
    with pytest.raises(UnreachableError, match=r"at body height .* mm, leg .* cannot reach the ground at any distance"):
        foothold_stations(robot, 0.025, 0.5, feet, swing_height=0.03)


def test_the_error_says_if_no_lower_height_works():
    robot = preset("strider")
    builder = resting_state(measured_state(robot, folded_pose(robot), swing_height=10.0))
    feet = default_stance(robot, 0.11) * [2, 2, 1]
    with pytest.raises(UnreachableError, match=r"raising the body to 110.0 mm: .*; no lower body height works either"):
        raise_body(builder, feet, stance_angles(robot))


def test_with_three_feet_on_the_ground_none_is_lifted():
    robot = preset("strider")
    builder = resting_state(measured_state(robot, stance_angles(robot)))
    for leg in (0, 2, 4):
        builder = builder.unload(leg)
    turned = stance_angles(robot) + [0.1, 0, 0] * np.array([[0], [1], [0], [1], [0], [1]])
    feet = np.asarray(forward_kinematics(robot, turned))[:, 3] * [1, 1, 0] - [0, 0, builder.height]
    with pytest.raises(TarsusError, match=r"only 3 feet are on the ground; .* requires at least 4"):
        raise_body(builder, feet, turned)


def test_a_final_stance_with_other_angles_is_rejected():
    robot = preset("strider")
    stance = stance_angles(robot)
    builder = resting_state(measured_state(robot, stance))
    with pytest.raises(UnreachableError, match=r"final joint angles differ from those of the stance by 0\.[0-9]+ deg"):
        raise_body(builder, default_stance(robot, swing_height=0.03), stance - 1e-5)


def test_an_unloaded_foot_is_not_dragged():
    robot = preset("strider")
    builder = resting_state(measured_state(robot, stance_angles(robot))).unload(0)
    aside, up = (
        BodyTarget(
            Pose(builder.body.rotation, builder.body.position + np.array([0.02, 0.0, height])), np.zeros(3), belly=False
        )
        for height in (0.001, 0.04)
    )
    with pytest.raises(UnreachableError, match=r"foot of leg front left would drag .* rises by 1.0 mm"):
        builder.move_body("move", aside, builder.contacts)
    assert builder.move_body("move", up, builder.contacts).feet[0, 2] == pytest.approx(0.04)


def test_only_a_lying_robot_folds():
    robot = preset("strider")
    with pytest.raises(
        TarsusError, match=r"stands on 6 feet.* 93.0 mm higher .* folding its legs requires .* sit_down"
    ):
        fold(robot, stance_angles(robot))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"joint_speed": 0.0}, "joint_speed contains 0"),
        ({"joint_speed": np.nan}, "joint_speed contains nan"),
        (
            {"joint_acceleration": np.ones((2, 3))},
            r"(?s)joint_acceleration is .*; expected a number or an array of shape",
        ),
        ({"margin": -1.0}, "margin is -1"),
        ({"swing_height": np.inf}, "swing_height is inf"),
        ({"angles": np.zeros((2, 6, 3))}, r"a single robot in a single pose, not for a batch \(2,\)"),
        ({"angles": np.zeros((5, 3))}, "angles has shape"),
        ({"angles": np.full((6, 3), np.nan)}, "angles"),
        ({"robot": stack_robots([preset("strider"), preset("strider")])}, r"not for a batch \(2,\)"),
    ],
)
def test_invalid_input_is_rejected(changes, message):
    arguments = {"robot": preset("strider"), "angles": np.zeros((6, 3)), **changes}
    for plan in (stand_up, sit_down):
        with pytest.raises(InputError, match=message):
            plan(**arguments)


@pytest.mark.parametrize(
    ("angles", "loaded", "message"),
    [
        (np.zeros((2, 6, 3)), [True] * 6, "a single robot in a single pose"),
        (None, [True] * 5, "loaded has shape"),
        (None, [[True] * 6] * 2, "loaded has shape"),
        (None, [1] * 6, "loaded holds int64 values; expected booleans"),
    ],
)
def test_invalid_angles_and_feet_of_a_robot_on_uneven_ground_are_rejected(angles, loaded, message):
    with pytest.raises(InputError, match=message):
        sit_down(preset("strider"), angles, loaded=loaded)


PAGE = (Path(__file__).parents[1] / "docs" / "rising.md").read_text(encoding="utf-8")


def test_the_example_of_the_page_runs(capsys):
    (example,) = re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)
    exec(example, {})
    (shown,) = re.findall(r"```text\n(.*?)```", PAGE, flags=re.DOTALL)
    assert capsys.readouterr().out == shown


def test_feet_that_bear_load_on_uneven_ground_stay_where_they_are_until_the_robot_lies():
    robot = preset("strider")
    feet = np.asarray(default_stance(robot)) + np.outer([0.01, 0.0, 0.02, -0.01, 0.01, -0.02], [0, 0, 1])
    angles, loaded = inverse_kinematics(robot, feet).require().angles, np.array([True, True, True, True, True, False])
    down = sit_down(robot, angles, loaded=loaded)
    lying = down.stages[-1]
    assert lying.name == "lie down"
    for stage in down.stages:
        np.testing.assert_allclose(stage.feet_end[loaded], down.stages[0].feet[loaded], atol=1e-9)
        np.testing.assert_array_equal(stage.contacts, loaded)
    # Without that, three feet count as standing, and legs under load are retracted.
    assert sit_down(robot, angles).stages[0].contacts.sum() == 3


@pytest.mark.parametrize("loaded", [[True, True, False, False, False, False], [True, True, True, False, False, False]])
def test_a_robot_that_its_loaded_feet_do_not_hold_sits_down_as_on_a_plane(loaded):
    robot = preset("strider")
    angles = inverse_kinematics(robot, default_stance(robot)).require().angles
    assert sit_down(robot, angles, loaded=np.array(loaded)).stages[0].contacts.sum() > 3
