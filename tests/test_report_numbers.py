"""Summaries and tables: numbers match the Python functions, in the units of the keys."""

import io
import math

import numpy as np
import pytest
from rich.console import Console

from sample_walks import WALKS, ring_robot, sample_walk
from tarsus.gait.gait import Gait
from tarsus.gait.path import curved_path, straight_path
from tarsus.gait.plan import plan_walk
from tarsus.gait.stroke import max_stroke
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.mass import total_mass
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.rest import resting_pose
from tarsus.kinematics.stance import default_body_height, default_stance
from tarsus.report.robot_check import check_robot, longest_stroke
from tarsus.report.robot_summary import dimensions, robot_summary
from tarsus.report.standing_summary import Standing, rest_summary
from tarsus.report.tables import angle_table, number, robot_table, source_table, verdict, walk_table
from tarsus.report.walk_summary import walk_summary
from tarsus.robot.file import list_robots, load_robot
from tarsus.robot.robot import GaitDefaults


def text_of(item):
    console = Console(width=200, file=io.StringIO())
    console.print(item)
    return console.file.getvalue()


def changed(motion, **changes):
    return type(motion)(**{name: getattr(motion, name) for name in motion.__dataclass_fields__} | changes)


# Walks


@pytest.mark.parametrize("kind", WALKS)
def test_walk_summary(kind):
    motion = sample_walk(kind)
    summary = walk_summary(motion)
    assert summary["possible"] is motion.ok
    assert summary["problems"] == list(motion.problems)
    assert summary["assumed"] == list(motion.assumed)
    assert summary["steps"] == motion.steps
    assert summary["duration_s"] == motion.duration
    assert summary["stroke_mm"] == pytest.approx(motion.stroke * 1000)
    assert summary["speed_mm_s"] == pytest.approx(motion.speed * 1000)
    assert summary["least_margin"]["mm"] == pytest.approx(motion.margin.min() * 1000)
    at = np.isclose(motion.time, summary["least_margin"]["at_s"])
    assert motion.margin[at] == pytest.approx(motion.margin.min())
    closest = summary["nearest_feet"]
    assert closest["mm"] == pytest.approx(motion.least_foot_distance.min() * 1000)
    first, second = (motion.robot.leg_codes.index(code) for code in closest["legs"])
    feet = motion.feet[np.isclose(motion.time, closest["at_s"])][0]
    assert math.dist(feet[first], feet[second]) * 1000 == pytest.approx(closest["mm"])
    for number_of, speed in enumerate(summary["joint_speed"].values()):
        assert speed["deg_s"] == pytest.approx(np.degrees(np.abs(motion.joint_speed[..., number_of]).max()))


def test_limit_fraction_is_that_of_the_critical_leg():
    motion = sample_walk("too fast")
    for joint, speed in enumerate(walk_summary(motion)["joint_speed"].values()):
        assert speed["limit_fraction"] == pytest.approx(motion.speed_ratio[:, joint].max())
        assert speed["no_load_deg_s"] == pytest.approx(math.degrees(motion.robot.servos[0][joint].no_load_speed))
        assert speed["servo"] == "DS3225"


def test_unknown_servos_have_the_speed_limit_of_live_walking():
    summary = walk_summary(sample_walk("round"))
    for speed in summary["joint_speed"].values():
        assert (speed["servo"], speed["no_load_deg_s"]) == (None, None)
        assert speed["limit_deg_s"] == pytest.approx(math.degrees(5))
        assert speed["limit_fraction"] == pytest.approx(speed["deg_s"] / speed["limit_deg_s"])
    assert "% of 286 deg/s, as the no-load speed is unknown" in text_of(walk_table(summary))


def test_yaw_counts_full_turns():
    motion = plan_walk(load_robot("strider"), Gait.named("tripod"), curved_path(math.radians(-400)), rate=20)
    assert walk_summary(motion)["end"]["turned_deg"] == pytest.approx(-400)


def test_walk_table_and_verdict():
    summary = walk_summary(sample_walk("too fast"))
    text = text_of(walk_table(summary))
    for value in (
        f"{summary['stroke_mm']:.1f} mm at 900.0 mm/s",
        f"{summary['least_margin']['mm']:.1f} mm at",
        "x 200.0 mm, y 0.0 mm, yaw 0.0 deg",
        "of the no-load speed of DS3225",
        summary["assumed"][0],
    ):
        assert value in text
    text = text_of(verdict(summary))
    assert text.startswith("not possible")
    assert summary["problems"][0] in text
    assert text_of(verdict({"possible": True, "problems": []})).strip() == "possible"


def test_no_margin_without_a_foot_on_the_ground():
    motion = sample_walk("straight")
    flying = changed(motion, contacts=np.zeros_like(motion.contacts))
    assert "no foot on the ground" in text_of(walk_table(walk_summary(flying)))


@pytest.mark.parametrize(("value", "text"), [(None, "unknown"), (1.25, "1.2 mm"), (-3.0, "-3.0 mm")])
def test_number_format(value, text):
    assert number(value, "mm") == text


# Standing


def standing(name, *, knee="up", **move):
    robot = load_robot(name) if isinstance(name, str) else name
    height = default_body_height(robot)
    start = Pose.from_rpy(position=(0, 0, height))
    feet = default_stance(robot) + np.array([0, 0, height])
    body = Pose.from_rpy(
        move.get("roll", 0.0), move.get("pitch", 0.0), 0.0, (move.get("x", 0), 0, height + move.get("z", 0))
    )
    return Standing(solution=inverse_kinematics(robot, feet, body, knee=knee), start=start)


def test_standing_with_all_feet_on_their_footholds():
    posed = standing("strider", pitch=0.1)
    summary = posed.summary()
    assert summary["possible"]
    assert summary["problems"] == []
    assert summary["feasible_fraction"] == 1.0
    assert set(summary["reach"]) == {"OK"}
    np.testing.assert_allclose(np.radians(summary["angles_deg"]), posed.solution.angles)
    assert summary["body"]["pitch_deg"] == pytest.approx(math.degrees(0.1))
    assert summary["margin_mm"] == pytest.approx(posed.margin * 1000)
    assert summary["stands"]


def test_legs_that_do_not_reach_are_in_the_air():
    posed = standing("strider", roll=0.62)
    summary = posed.summary()
    assert not summary["possible"]
    assert 0 < posed.contacts.sum() < 6
    assert len(summary["problems"]) >= (~posed.contacts).sum()
    assert summary["stands"] == (posed.margin >= 0)
    assert ("tips" in summary["problems"][-1]) == (posed.margin < 0)
    assert 0 < summary["feasible_fraction"] < 1


def test_tipping_robot():
    posed = standing("strider", pitch=math.radians(42))
    assert posed.margin < 0
    assert posed.summary()["problems"][-1] == (
        f"the robot tips: its centre of mass is {-posed.margin * 1000:.1f} mm outside its support polygon"
    )


def test_no_leg_reaches_its_foothold():
    summary = standing("strider", z=0.3).summary()
    assert summary["problems"][-1] == "no foot is on the ground"
    assert not summary["stands"]


def test_body_below_the_ground():
    problems = standing("strider", z=-0.090).summary()["problems"]
    assert problems == []
    low = standing("strider", z=-0.100).summary()
    assert low["problems"] == ["the body is 7.0 mm below the ground; raise the body by that distance"]
    assert low["feasible_fraction"] == pytest.approx(0.93, abs=1e-5)
    assert not any("the body is" in problem for problem in standing("phoenix", z=-0.05).summary()["problems"])


def test_a_displacement_is_possible_up_to_where_the_robot_tips():
    heavy = standing(load_robot("strider").replace(body_com=np.array([0.5, 0.0, 0.0])), x=0.1)
    assert (heavy.solution.ok, heavy.margin < 0) == (True, True)
    upright = standing(heavy.solution.robot, x=0.1 * heavy.feasible_fraction)
    assert 0 < heavy.feasible_fraction < 1
    assert upright.margin == pytest.approx(0, abs=1e-6)


def test_no_feasible_fraction_with_knees_down():
    summary = standing("mithi", knee="down").summary()
    assert summary["feasible_fraction"] is None
    assert summary["knee"] == "down"
    assert summary["assumed"]


# Resting


def test_rest_summary():
    robot = load_robot("strider")
    angles = np.radians(np.tile([0.0, -30.0, -60.0], (6, 1)))
    angles[0] = np.radians([0, 60, -60])
    rest = resting_pose(robot, angles)
    summary = rest_summary(robot, angles, rest)
    assert summary["description"] == rest.describe()
    assert summary["contacts"] == [
        code for code, in_contact in zip(robot.leg_codes, rest.contacts, strict=True) if in_contact
    ]
    assert summary["margin_mm"] == pytest.approx(float(rest.margin) * 1000)
    assert summary["body"]["z_mm"] == pytest.approx(rest.body.position[2] * 1000)
    np.testing.assert_allclose(
        [summary["body"][f"{axis}_deg"] for axis in ("roll", "pitch", "yaw")], np.degrees(rest.body.rpy)
    )
    assert summary["possible"]


def test_angles_outside_their_limits():
    robot = load_robot("strider")
    angles = np.radians(np.tile([0.0, 40.0, -100.0], (6, 1)))
    angles[2, 0] = math.radians(61)
    angles[5, 2] = math.radians(-161)
    problems = rest_summary(robot, angles, resting_pose(robot, angles))["problems"]
    assert problems == [
        "rear left: coxa angle 61 deg is outside its limits, -60 to 60 deg",
        "front right: tibia angle -161 deg is outside its limits, -160 to 10 deg",
    ]


def test_angle_at_its_limit_is_allowed():
    robot = load_robot("strider")
    summary = rest_summary(robot, robot.limits[..., 1], resting_pose(robot, robot.limits[..., 1]))
    assert summary["possible"]


def test_no_stable_resting_pose():
    robot = load_robot("strider")
    angles = np.radians(np.tile([0.0, -30.0, -60.0], (6, 1)))
    angles[:3] = np.radians([0.0, 60.0, 0.0])
    summary = rest_summary(robot, angles, resting_pose(robot, angles, max_rolls=0))
    assert summary["problems"] == ["the robot has no stable resting pose with these angles"]


def test_angle_format():
    text = text_of(angle_table({"legs": ["LF"], "joints": ["a", "b", "c"], "angles_deg": [[-0.001, 12.345, -90.0]]}))
    assert text.split()[-4:] == ["LF", "0.00", f"{12.345:.2f}", "-90.00"]


# Robots


@pytest.mark.parametrize("name", list_robots())
def test_robot_summary(name):
    robot = load_robot(name)
    summary = robot_summary(robot)
    assert summary["coxa_mm"] == pytest.approx(robot.coxa[0] * 1000)
    assert (summary["mass_kg"] is None) == (not robot.has_masses)
    if robot.has_masses:
        assert summary["mass_kg"] == pytest.approx(float(total_mass(robot)))
    assert summary["body_height_mm"] == pytest.approx(default_body_height(robot) * 1000)
    text = text_of(robot_table([summary]))
    assert name in text
    assert all(servo in text for servo in summary["servos"] or ["unknown"])


def test_different_leg_lengths_are_listed():
    robot = load_robot("strider")
    longer = robot.replace(femur=np.linspace(0.09, 0.1, 6))
    assert robot_summary(longer)["femur_mm"] == pytest.approx(np.linspace(90, 100, 6))
    assert "[90, 92, 94, 96, 98, 100]" in text_of(robot_table([robot_summary(longer)]))


@pytest.mark.parametrize("name", list_robots())
def test_every_number_of_a_preset_has_a_source(name):
    robot = load_robot(name)
    for row in dimensions(robot):
        assert row["source"], row["key"]
        assert robot.sources[row["source_number"] - 1].source == row["source"]
        assert row["confidence"] in ("A", "A-", "B", "C", "guess")
    assert "none" not in text_of(source_table(dimensions(robot)))


def test_more_specific_source_is_used():
    rows = {row["key"]: row for row in dimensions(load_robot("phantomx"))}
    assert rows["leg.servo"]["note"] == "The repository does not name the servo."
    assert rows["body.size_mm"]["note"].startswith("Only the underside")
    assert rows["front left: yaw_deg"]["value"] == 45
    assert rows["gait.swing_height_mm"]["source_number"] == 4


def test_numbers_without_a_source():
    text = text_of(source_table(dimensions(ring_robot(6))))
    assert "none" in text
    assert "unknown" in text


def test_check_lists_missing_values():
    robot = ring_robot(6)
    report = check_robot(robot)
    assert report["possible"]
    assert report["longest_stroke_mm"] == pytest.approx(max_stroke(robot, Gait.named("tripod")) * 1000)
    keys = [line.split(":")[0] for line in report["missing"]]
    assert keys == [
        *("body.mass_kg, leg.mass_kg", "body.size_mm", "leg.servo"),
        *("gait.body_height_mm", "gait.swing_height_mm"),
    ]
    assert check_robot(load_robot("strider"))["missing"] == []


def test_check_lists_servos_with_unknown_speed():
    robot = load_robot("strider")
    from dataclasses import replace

    slow = replace(robot.servos[0][0], no_load_speed=None)
    report = check_robot(robot.replace(servos=((slow,) * 3,) * 6))
    assert report["missing"] == ["no_load_rad_s of the servo DS3225: without it, joint speeds are limited to 286 deg/s"]


@pytest.mark.no_cover
@pytest.mark.parametrize(
    ("gait", "text"),
    [
        (GaitDefaults(name="tetrapod"), "does not exist for 4 legs"),
        (GaitDefaults(name="creep", body_height=0.5), "does not reach the ground"),
    ],
)
def test_check_gives_the_reason_why_a_robot_cannot_walk(gait, text):
    report = check_robot(ring_robot(4).replace(gait=gait))
    assert not report["possible"]
    assert text in report["problems"][0]
    assert report["longest_stroke_mm"] is None


def test_check_of_a_robot_that_cannot_step():
    robot = load_robot("strider")
    locked = np.array(robot.limits)
    locked[:, 1] = locked[:, 2] = np.radians([[-0.001, 0.001]])
    report = check_robot(robot.replace(limits=locked, gait=GaitDefaults(body_height=0.0, swing_height=0.05)))
    assert not report["possible"]


def test_end_position_of_a_sideways_walk():
    motion = plan_walk(load_robot("strider"), Gait.named("tripod"), straight_path(0.1, math.pi / 2), rate=20)
    end = walk_summary(motion)["end"]
    assert (end["x_mm"], end["y_mm"], end["turned_deg"]) == pytest.approx((0, 100, 0), abs=1e-9)


def test_the_longest_stroke_of_the_robots_own_gait():
    robot = load_robot("strider")
    assert longest_stroke(robot) == (pytest.approx(max_stroke(robot, Gait.named("tripod")) * 1000), [])
    assert longest_stroke(ring_robot(5).replace(gait=GaitDefaults(name="tripod")))[0] is None
    limits = np.array(robot.limits)
    limits[:, 0] = 0
    stiff = robot.replace(limits=limits, mount_yaw=np.full(6, np.pi / 2))
    stroke, (problem,) = longest_stroke(stiff)
    assert stroke == 0
    assert problem.startswith("the longest stroke is 0")


def test_check_of_a_gait_for_another_number_of_legs_names_those_that_exist():
    report = check_robot(ring_robot(8).replace(gait=GaitDefaults(name="tetrapod")))
    possible = [trial["gait"] for trial in report["gaits"] if trial["possible"]]
    if "tetrapod" in possible:
        assert report["possible"]
    else:
        assert report["problems"][0].endswith(f"set [gait] name to one that is possible: {', '.join(possible)}")
    assert "tripod" in possible


@pytest.mark.no_cover
def test_check_lists_what_is_estimated():
    assert check_robot(load_robot("ch3r"))["estimated"] == ["body.mass_kg", "leg.mass_kg"]
    assert check_robot(ring_robot(6))["estimated"] == []
