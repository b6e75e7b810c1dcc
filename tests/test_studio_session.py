"""Messages of a session agree with the Python API."""

import json
import math
import tomllib

import numpy as np
import pytest

from sample_studio import Asked, table
from tarsus import (
    Gait,
    Payload,
    Pose,
    centre_of_mass,
    default_body_height,
    default_stance,
    forward_kinematics,
    inverse_kinematics,
    joint_loads,
    joint_torques,
    joint_verdicts,
    list_robots,
    list_servos,
    load_robot,
    max_stroke,
    plan_walk,
    resting_pose,
    size_servos,
    stability_margin,
    straight_path,
    support_polygon,
    twist_path,
)
from tarsus.gait.path import curved_path
from tarsus.gait.storage import motion_to_csv
from tarsus.report.walk_summary import walk_summary
from tarsus.robot.file import robot_from_text, robot_text, robot_to_dict, save_robot
from tarsus.studio.messages.state import RobotChoice, StudioState
from tarsus.studio.session import Session
from tarsus.studio.state_text import state_of

MM, DEG = 0.006, 0.0006
"""Half a unit of the last digit of messages, plus rounding."""

STRIDER = load_robot("strider")

PICTURE = {"camera": "top", "eye_mm": [1, 2, 3], "target_mm": [0, 0, 0], "time_s": 1.5, "leg": 2}


@pytest.fixture
def ask():
    return Asked()


def test_hello_is_answered_by_presets_gaits_and_servos():
    answers = Asked().all("hello")
    assert [answer["type"] for answer in answers] == ["welcome", "robot", "state", "walk", "done"]
    welcome = answers[0]
    assert welcome["robots"] == list(list_robots())
    assert welcome["servos"] == list(list_servos())
    assert "body" in welcome["robot_schema"]["properties"]
    assert StudioState.model_validate_json(json.dumps(answers[2]["state"])) == StudioState()


@pytest.mark.parametrize("name", list_robots())
def test_the_robot_message_suffices_for_forward_kinematics(name):
    asked = Asked()
    answer = asked("robot", "robot", preset=name)
    robot = load_robot(name)
    assert answer["name"] == name == answer["preset"]
    assert answer["document"] == robot_to_dict(robot)
    angles = np.random.default_rng(1).uniform(-1, 1, (robot.legs, 3))
    assert by_the_formula(answer, angles) == pytest.approx(forward_kinematics(robot, angles) * 1000, abs=0.03)
    assert table(answer["limits_deg"], 3, 2) == pytest.approx(np.degrees(robot.limits), abs=DEG)
    height = default_body_height(robot)
    assert answer["body_height_mm"] == pytest.approx(height * 1000)
    assert table(answer["stance_mm"], 3)[:, :2] == pytest.approx(default_stance(robot, height)[:, :2] * 1000, abs=MM)
    assert answer["longest_stroke_mm"] == pytest.approx(max_stroke(robot, Gait.named(robot.gait.name)) * 1000)
    assert [bool(servo) for servo in answer["servos"]] == [servo is not None for row in robot.servos for servo in row]


def by_the_formula(answer, angles):
    """The leg points as the message's description says that they follow."""
    points = []
    for leg in range(len(answer["leg_names"])):
        coxa, femur, tibia = angles[leg]
        yaw = math.radians(answer["mount_yaw_deg"][leg]) + coxa
        out, left, up = (
            np.array([math.cos(yaw), math.sin(yaw), 0]),
            np.array([-math.sin(yaw), math.cos(yaw), 0]),
            [0, 0, 1],
        )
        side, rise = table(answer["femur_axis_offset_mm"], 2)[leg]
        mount = table(answer["mount_mm"], 3)[leg]
        axis = mount + answer["coxa_mm"][leg] * out + side * left + rise * np.array(up)
        knee = axis + answer["femur_mm"][leg] * (math.cos(femur) * out + math.sin(femur) * np.array(up))
        bend = femur + tibia
        foot = knee + answer["tibia_mm"][leg] * (math.cos(bend) * out + math.sin(bend) * np.array(up))
        points.append([mount, axis, knee, foot])
    return np.array(points)


@pytest.mark.parametrize("seed", range(6))
def test_the_pose_of_joints_agrees_with_resting_pose(ask, seed):
    degrees = np.random.default_rng(seed).uniform((-70, -60, -150), (70, 90, 10), (6, 3))
    pose = ask("joints", "pose", joints={"angles_deg": degrees.ravel().tolist()})
    angles = np.radians(degrees)
    rest = resting_pose(STRIDER, angles)
    assert pose["position_mm"] == pytest.approx(rest.body.position * 1000, abs=MM)
    assert pose["rpy_deg"] == pytest.approx(np.degrees(rest.body.rpy), abs=DEG)
    assert pose["contacts"] == "".join(str(int(down)) for down in rest.contacts)
    assert pose["points_down"] == "".join(str(int(down)) for down in rest.leg_points_down.ravel())
    assert pose["corners_down"] == rest.corners_down.sum()
    assert pose["margin_mm"] == pytest.approx(float(rest.margin) * 1000, abs=MM)
    assert pose["stable"] == bool(rest.stable)
    assert pose["text"] == rest.describe()
    assert pose["com_mm"] == pytest.approx(rest.body @ centre_of_mass(STRIDER, angles) * 1000, abs=MM)
    beyond = (degrees < np.degrees(STRIDER.limits[..., 0])) | (degrees > np.degrees(STRIDER.limits[..., 1]))
    assert [(limit["leg"], limit["joint"]) for limit in pose["limits"]] == [
        (leg, ("coxa", "femur", "tibia")[joint]) for leg, joint in np.argwhere(beyond)
    ]
    named = [f"{STRIDER.leg_names[leg]}: the " for leg, _ in np.argwhere(beyond)]
    assert all(limit["text"].startswith(name) for limit, name in zip(pose["limits"], named, strict=True))
    assert pose["problems"] == ([] if rest.stable else ["the robot has no stable resting pose with these angles"])


def test_forces_and_torques_are_given_if_the_feet_alone_support_the_robot(ask):
    pose = ask("joints", "pose", joints={"angles_deg": [0, 30, -100] * 6})
    angles = np.radians([[0, 30, -100]] * 6)
    rest = resting_pose(STRIDER, angles)
    torques, forces = joint_torques(STRIDER, angles, rest.body, rest.contacts)
    assert pose["torques_nm"] == pytest.approx(torques.ravel(), abs=1e-4)
    assert pose["forces_n"] == pytest.approx(forces.ravel(), abs=1e-4)
    lying = ask("joints", "pose", joints={"angles_deg": [0, 90, 0] * 6})
    assert lying["corners_down"] == 4
    assert lying["forces_n"] is None
    assert lying["torques_nm"] is None


def test_during_a_change_forces_and_torques_are_computed_on_request_only(ask):
    for kind, given in (("joints", {"joints": {"angles_deg": [0, 30, -100] * 6}}), ("body", {"body": {"x_mm": 3}})):
        committed = ask(kind, "pose", **given)
        during = ask(kind, "pose", **given, commit=False)
        assert during["forces_n"] is during["torques_nm"] is None
        assert {**during, **{key: committed[key] for key in ("id", "forces_n", "torques_nm")}} == committed
        wanted = ask(kind, "pose", **given, commit=False, forces=True)
        assert wanted["forces_n"] == committed["forces_n"] is not None
        assert wanted["torques_nm"] == committed["torques_nm"]


def test_angles_for_another_number_of_legs_are_rejected(ask):
    assert "6 legs need 18" in ask.error("joints", joints={"angles_deg": [0.0] * 17})["text"]


BODY = {"x_mm": 12, "y_mm": -8, "z_mm": 5, "roll_deg": 4, "pitch_deg": -3, "yaw_deg": 6}


def stance_in_ground(height):
    return default_stance(STRIDER, height) + np.array([0, 0, height])


def body_pose(body, height):
    turn = np.radians([body.get(f"{axis}_deg", 0) for axis in ("roll", "pitch", "yaw")])
    place = np.array([body.get(f"{axis}_mm", 0) for axis in "xyz"]) / 1000 + [0, 0, height]
    return Pose.from_rpy(*turn, place)


@pytest.mark.parametrize("body_height", [None, 130.0])
def test_the_body_moves_relative_to_fixed_feet(ask, body_height):
    answer = ask("body", "pose", body={**BODY, "body_height_mm": body_height})
    height = default_body_height(STRIDER) if body_height is None else body_height / 1000
    feet, body = stance_in_ground(height), body_pose(BODY, height)
    solution = inverse_kinematics(STRIDER, feet, body)
    assert table(answer["angles_deg"], 3) == pytest.approx(np.degrees(solution.angles), abs=DEG)
    assert table(answer["feet_mm"], 3) == pytest.approx(feet * 1000, abs=MM)
    assert answer["contacts"] == "111111"
    margin = stability_margin(STRIDER, solution.angles, body, np.ones(6, dtype=bool))
    assert answer["margin_mm"] == pytest.approx(margin * 1000, abs=MM)
    polygon = support_polygon(feet, np.ones(6, dtype=bool)) * 1000
    # Of two corners equally far back, rounding says which is the first.
    apart = np.linalg.norm(table(answer["support_mm"], 2)[:, None] - polygon, axis=-1)
    assert len(answer["support_mm"]) == polygon.size
    assert apart.min(0).max() < 2 * MM
    torques, forces = joint_torques(STRIDER, solution.angles, body, np.ones(6, dtype=bool))
    assert answer["torques_nm"] == pytest.approx(torques.ravel(), abs=1e-4)
    assert table(answer["forces_n"], 3)[:, 2].sum() == pytest.approx(forces[:, 2].sum(), abs=1e-3)
    assert (answer["legs"], answer["problems"], answer["feasible_fraction"]) == ([], [], 1.0)


def test_a_leg_out_of_reach_is_reported_with_reason_and_distance(ask):
    answer = ask("body", "pose", body={"pitch_deg": 42})
    height = default_body_height(STRIDER)
    solution = inverse_kinematics(STRIDER, stance_in_ground(height), body_pose({"pitch_deg": 42}, height))
    failing = np.flatnonzero(solution.reach)
    assert [leg["leg"] for leg in answer["legs"]] == failing.tolist() != []
    assert [leg["text"] for leg in answer["legs"]] == [solution.explain_leg((leg,)) for leg in failing]
    assert answer["problems"][: len(solution.explain().splitlines())] == solution.explain().splitlines()
    assert table(answer["angles_deg"], 3) == pytest.approx(np.degrees(solution.angles), abs=DEG)
    for leg in answer["legs"]:
        assert f"{leg['miss_mm']:.1f} mm away" in leg["text"]
        assert answer["contacts"][leg["leg"]] == "0"
    assert 0 < answer["feasible_fraction"] < 1
    there = {"pitch_deg": 42 * answer["feasible_fraction"] - 1e-3}
    assert ask("body", "pose", body=there)["legs"] == []


def test_a_body_height_out_of_reach_is_rejected(ask):
    assert ask.error("body", body={"body_height_mm": 400})["kind"] == "unreachable"


def test_a_foothold_is_dragged(ask):
    ask.all("view", view="body")
    state, answer, done = ask.all("drag_foot", leg=1, position_mm=[10, 240, 25])
    assert state["state"]["body"]["feet_mm"][3:6] == [10, 240, 25]
    height = default_body_height(STRIDER)
    feet = stance_in_ground(height)
    feet[1] = 0.010, 0.240, 0.025
    solution = inverse_kinematics(STRIDER, feet, body_pose({}, height))
    assert table(answer["angles_deg"], 3) == pytest.approx(np.degrees(solution.angles), abs=DEG)
    assert answer["contacts"] == "101111"
    assert done["undo"]
    below = ask("drag_foot", "state", leg=1, position_mm=[10, 240, -50])
    assert below["state"]["body"]["feet_mm"][5] == 0
    assert "legs 0 to 5" in ask.error("drag_foot", leg=6, position_mm=[0, 0, 0])["text"]


def test_dragging_a_foot_in_joints_changes_only_its_leg(ask):
    before = ask("view", "pose", view="joints")
    goal = np.array([20.0, 230.0, 10.0])
    state, answer, _ = ask.all("drag_foot", leg=1, position_mm=goal.tolist())
    assert state["state"]["joints"]["angles_deg"] == pytest.approx(answer["angles_deg"], abs=1e-3)
    was, now = table(before["angles_deg"], 3), table(answer["angles_deg"], 3)
    assert np.delete(now, 1, 0) == pytest.approx(np.delete(was, 1, 0), abs=DEG)
    rest = resting_pose(STRIDER, np.radians(was))
    foot = (rest.body @ forward_kinematics(STRIDER, np.radians(now)))[1, 3]
    assert foot * 1000 == pytest.approx(goal, abs=0.01)


WALKS = [
    ({}, lambda r: plan_walk(r, Gait.named("tripod"), straight_path(0.5))),
    (
        {"gait": "wave", "body_height_mm": 120, "swing_height_mm": 25,
         "path": {"kind": "curve", "angle_deg": 60, "centre_mm": [0, 300]}},
        lambda r: plan_walk(
            r, Gait.named("wave"), curved_path(math.radians(60), (0, 0.3)), body_height=0.12, swing_height=0.025
        ),
    ),
    (
        {"gait": "ripple", "rate_hz": 50,
         "path": {"kind": "twist", "velocity_mm_s": [30, 10], "turn_deg_s": 8, "duration_s": 3}},
        lambda r: plan_walk(r, Gait.named("ripple"), twist_path(0.03, 0.01, math.radians(8), 3), rate=50),
    ),
    (
        {"path": {"kind": "straight", "distance_mm": 300, "heading_deg": 90}, "stroke_mm": 50, "cycle_time_s": 1.5,
         "roll_deg": 2, "pitch_deg": 3, "foot_distance_mm": 30},
        lambda r: plan_walk(
            r, Gait.named("tripod"), straight_path(0.3, math.pi / 2), stroke=0.05, cycle_time=1.5,
            body_tilt=np.radians([2, 3]), foot_distance=0.03,
        ),
    ),
    (
        {"gait": {"duty_factor": 0.75, "offsets": [0, 0.5, 0, 0.5, 0, 0.5]}, "speed_mm_s": 20, "strict": False},
        lambda r: plan_walk(
            r, Gait(duty_factor=0.75, offsets=(0, 0.5) * 3), straight_path(0.5), speed=0.02, strict=False
        ),
    ),
]  # fmt: skip


@pytest.mark.parametrize(("options", "plan"), WALKS)
def test_a_walk_agrees_with_plan_walk(ask, options, plan):
    answer, motion = ask("walk", "walk", walk=options), plan(STRIDER)
    assert answer["count"] == len(motion.time)
    assert np.arange(answer["count"]) / answer["rate_hz"] == pytest.approx(motion.time)
    assert table(answer["angles_deg"], 6, 3) == pytest.approx(np.degrees(motion.angles), abs=DEG)
    assert table(answer["position_mm"], 3) == pytest.approx(motion.body.position * 1000, abs=MM)
    rpy = motion.body.rpy
    assert table(answer["rpy_deg"], 3)[:, :2] == pytest.approx(np.degrees(rpy[:, :2]), abs=DEG)
    turned = np.radians(table(answer["rpy_deg"], 3)[:, 2]) - rpy[:, 2]
    assert np.cos(turned) == pytest.approx(np.ones(len(turned)))
    assert np.abs(np.diff(table(answer["rpy_deg"], 3)[:, 2])).max() < 20
    assert answer["contacts"] == ["".join(str(int(down)) for down in row) for row in motion.contacts]
    assert answer["reach"] is None
    assert answer["margin_mm"] == pytest.approx(motion.margin * 1000, abs=MM)
    com = (motion.body @ centre_of_mass(STRIDER, motion.angles)[:, None])[:, 0, :2]
    assert table(answer["com_mm"], 2) == pytest.approx(com * 1000, abs=MM)
    summary = walk_summary(motion)
    for key in (
        "gait",
        "duration_s",
        "cycle_time_s",
        "steps",
        "stroke_mm",
        "speed_mm_s",
        "body_height_mm",
        "swing_height_mm",
    ):
        assert answer[key] == pytest.approx(summary[key])
    for key in ("possible", "problems", "assumed"):
        assert answer[key] == summary[key]
    assert answer["end"] == pytest.approx(summary["end"])
    assert answer["least_margin"]["at_s"] == summary["least_margin"]["at_s"]
    assert answer["nearest_legs"] == summary["nearest_feet"]["legs"]
    assert [joint["deg_s"] for joint in answer["joint_speed"]] == pytest.approx(
        [summary["joint_speed"][joint]["deg_s"] for joint in ("coxa", "femur", "tibia")]
    )


def test_an_impossible_walk_is_rejected_with_the_longest_stroke(ask):
    error = ask.error("walk", walk={"stroke_mm": 400})
    assert error["kind"] == "stroke"
    longest = max_stroke(STRIDER, Gait.named("tripod")) * 1000
    assert error["longest_stroke_mm"] == pytest.approx(longest)
    assert ask("walk", "walk", walk={"stroke_mm": longest * 0.999})["longest_stroke_mm"] == pytest.approx(longest)
    shown = ask("walk", "walk", walk={"stroke_mm": 400, "strict": False})
    assert not shown["possible"]
    assert any(set(row) != {"0"} for row in shown["reach"])


@pytest.mark.parametrize(
    "options",
    [
        {"path": {"kind": "straight", "distance_mm": 99_000, "heading_deg": 0}},
        {"rate_hz": 1e5},
        {"cycle_time_s": 1e4},
        {"path": {"kind": "curve", "angle_deg": 3600, "centre_mm": [0, 90_000]}, "stroke_mm": 1},
    ],
)
def test_a_walk_with_too_many_samples_is_rejected_with_their_number(ask, options):
    error = ask.error("walk", walk=options)
    assert error["kind"] == "input"
    assert "at most 10000" in error["text"]


@pytest.mark.parametrize("name", ["no-such-gait", "tripod "])
def test_an_unknown_gait_is_rejected_with_its_name(ask, name):
    error = ask.error("walk", walk={"gait": name})
    assert error["kind"] == "unknown_name"
    assert "tripod, tetrapod, ripple, wave, creep" in error["text"]


LOADS = {"payload_kg": 0.2, "payload_at_mm": [10, 0, 20], "supply_v": 6.8, "capacity_ah": 3, "safety_factor": 2}


def test_loads_agree_with_joint_loads(ask):
    motion = plan_walk(STRIDER, Gait.named("tripod"), straight_path(0.5))
    answer = ask("loads", "loads", loads=LOADS)
    found = joint_loads(STRIDER, motion, payload=Payload(0.2, (0.01, 0, 0.02)), supply=6.8)
    assert table(answer["torques_nm"], 6, 3) == pytest.approx(found.torques, abs=1e-4)
    assert table(answer["forces_n"], 6, 3) == pytest.approx(found.forces, abs=1e-4)
    verdicts = joint_verdicts(found, safety_factor=2)
    assert [joint["text"] for joint in answer["joints"]] == [verdict.text() for verdict in verdicts]
    assert [joint["grade"] for joint in answer["joints"]] == [verdict.class_name for verdict in verdicts]
    assert [joint["peak_nm"] for joint in answer["joints"]] == pytest.approx(found.peak.ravel())
    assert answer["weight_n"] == pytest.approx(found.weight)
    assert answer["cost_of_transport"] == pytest.approx(found.cost_of_transport)


def test_loads_are_sent_with_the_walk_if_it_has_changed(ask):
    ask.all("view", view="robot")
    ask.all("robot", preset="phantomx")
    assert ask.types("loads", loads={}) == ["walk", "loads", "done"]
    assert ask.types("loads", loads={"payload_kg": 1}) == ["loads", "done"]
    ask.all("view", view="loads")
    assert ask.types("walk", walk={"gait": "ripple"}) == ["walk", "loads", "done"]


def test_loads_without_masses_report_the_missing_values(ask):
    ask.all("robot", preset="mithi")
    assert ask.error("loads", loads={})["kind"] == "missing_data"
    assert ask.types("view", view="loads") == ["walk", "error", "pose", "done"]


@pytest.mark.parametrize("loading", [{"safety_factor": 0}, {"supply_v": 0}, {"capacity_ah": 0}])
def test_load_options_out_of_range_are_rejected(ask, loading):
    assert ask.error("loads", loads=loading)["kind"] == "input"


@pytest.mark.no_cover
def test_servos_agree_with_size_servos(ask):
    ask.all(
        "walk",
        walk={
            "gait": "wave",
            "body_height_mm": 130,
            "path": {"kind": "straight", "distance_mm": 150, "heading_deg": 0},
        },
    )
    ask.all("loads", loads={"safety_factor": 2.5})
    answer = ask("servos", "servos")
    motion = plan_walk(STRIDER, Gait.named("wave"), straight_path(0.15), body_height=0.13)
    sizing = size_servos(STRIDER, joint_loads(STRIDER, motion), safety_factor=2.5)
    assert answer["sufficient"] == sizing.ok
    assert [servo["name"] for servo in answer["candidates"]] == [servo.name for servo in sizing.candidates] != []
    assert answer["mixed"]["factor"] == pytest.approx(sizing.mixed.factor)
    assert answer["payload_kg"] == pytest.approx(sizing.payload)
    ask.all("walk", walk={"rate_hz": 800})
    assert "at most 3000" in ask.error("servos")["text"]


def test_a_document_changes_the_robot_and_keeps_the_pose(ask):
    ask.all("joints", joints={"angles_deg": [0, 30, -100] * 6})
    document = robot_to_dict(STRIDER)
    document["leg"]["femur_mm"] = 110
    robot, state, *_ = ask.all("document", document=document)
    assert robot["femur_mm"] == [110.0] * 6
    assert robot["preset"] is None
    assert state["state"]["joints"]["angles_deg"] == [0, 30, -100] * 6
    document["leg"]["femur_mm"] = 98
    assert ask("document", "robot", document=document)["preset"] == "strider"


def test_problems_of_a_document_have_their_keys(ask):
    document = robot_to_dict(STRIDER)
    document["leg"]["femur_mm"] = -3
    document["legs"][2]["yaw"] = 3
    error = ask.error("document", document=document)
    assert error["kind"] == "robot_file"
    assert [problem["key"] for problem in error["problems"]] == ["leg.femur_mm", "legs[2].yaw"]
    assert ask.error("document", document={})["problems"]
    turns = [math.radians((i + 0.5) * 360 / 13) for i in range(13)]
    legs = [
        {"name": f"leg {i}", "position_mm": [300 * math.cos(t), 300 * math.sin(t), 0], "yaw_deg": 0}
        for i, t in enumerate(turns)
    ]
    many = {**robot_to_dict(STRIDER), "legs": legs}
    assert "has 13 legs; the studio accepts at most 12" in ask.error("document", document=many)["text"]


def test_a_document_too_large_is_rejected(ask):
    sources = [{"of": ["gait"], "source": "x" * 1000, "confidence": "guess"}] * 70
    error = ask.error("document", document={**robot_to_dict(STRIDER), "sources": sources})
    assert "limit is 65536" in error["text"]


def test_toml_is_imported_and_exported(ask):
    text = ask("download", "file", what="toml")
    assert (text["name"], text["mime"]) == ("strider.toml", "application/toml")
    assert robot_from_text(text["text"], where="it") == STRIDER
    changed = text["text"].replace("tibia_mm = 181", "tibia_mm = 150")
    assert ask("toml", "robot", text=changed)["tibia_mm"] == [150.0] * 6
    assert tomllib.loads(ask("download", "file", what="toml")["text"])["leg"]["tibia_mm"] == 150
    error = ask.error("toml", text="name = ")
    assert "line 1" in error["text"]


def test_a_robot_that_cannot_stand_is_shown(ask):
    document = robot_to_dict(STRIDER)
    document["gait"]["body_height_mm"] = 500
    answers = ask.all("document", document=document)
    assert [answer["type"] for answer in answers] == ["robot", "state", "error", "pose", "done"]
    assert answers[0]["stance_mm"] is None
    assert answers[0]["problems"]
    assert answers[2]["kind"] == "unreachable"
    assert ask.types("view", view="joints") == ["pose", "done"]


def test_a_preset_with_another_number_of_legs_resets_the_state(ask):
    document = robot_to_dict(STRIDER)
    document["legs"] = document["legs"][:5]
    ask.all("joints", joints={"angles_deg": [0, 30, -100] * 6})
    ask.all("drag_foot", leg=5, position_mm=[100, -200, 0])
    ask.all("walk", walk={"gait": {"duty_factor": 0.75, "offsets": [0, 0.5, 0, 0.5, 0, 0.5]}, "speed_mm_s": 20})
    ask.all("source", source={"number": "001", "leg": 5})
    state = ask("document", "state", document=document)["state"]
    assert state["joints"]["angles_deg"] is None
    assert state["body"]["feet_mm"] is None
    assert state["walk"]["gait"] is None
    assert state["source"]["leg"] == 0
    assert ask("robot", "robot", preset="phantomx")["leg_codes"] == ["LF", "LM", "LR", "RR", "RM", "RF"]


def test_paths_are_not_accepted_as_presets(ask, tmp_path):
    save_robot(STRIDER, tmp_path / "mine.toml")
    assert ask.error("robot", preset=str(tmp_path / "mine.toml"))["kind"] == "unknown_name"
    assert "Did you mean 'phantomx'" in ask.error("robot", preset="phantom")["text"]


@pytest.mark.parametrize(
    ("view", "types"),
    [
        ("joints", ["pose"]),
        ("body", ["pose"]),
        ("drive", ["pose"]),
        ("loads", ["walk", "loads"]),
        ("robot", ["pose"]),
        ("sources", ["pose", "source"]),
    ],
)
def test_a_view_sends_its_content(ask, view, types):
    answers = ask.all("view", view=view, picture=PICTURE)
    assert [answer["type"] for answer in answers] == [*types, "done"]
    assert not answers[-1]["undo"]
    held = state_of(answers[-1]["state"])
    assert held.view == view
    assert held.picture.eye_mm == (1, 2, 3)
    assert ask.types("view", view=view) == ["done"]


def test_undo_and_redo_go_from_commit_to_commit(ask):
    ask.all("view", view="body")
    for x in (5, 10, 15):
        assert ask.all("body", body={"x_mm": x}, commit=False)[-1]["state"] is None
    first = ask.all("body", body={"x_mm": 20})[-1]
    assert state_of(first["state"]).body.x_mm == 20
    ask.all("body", body={"x_mm": 40})
    ask.all("robot", preset="phantomx")
    answers = ask.all("undo")
    assert [answer["type"] for answer in answers] == ["robot", "state", "pose", "done"]
    assert answers[0]["name"] == "strider"
    assert answers[1]["state"]["body"]["x_mm"] == 40
    assert ask("undo", "state")["state"]["body"]["x_mm"] == 20
    last = ask.all("undo")
    assert last[1]["state"]["body"]["x_mm"] == 0
    assert (last[-1]["undo"], last[-1]["redo"]) == (False, True)
    assert "nothing to undo" in ask.error("undo")["text"]
    assert ask("redo", "state")["state"]["body"]["x_mm"] == 20
    ask.all("body", body={"x_mm": 7})
    assert "nothing to redo" in ask.error("redo")["text"]


def test_undo_reverts_uncommitted_changes(ask):
    ask.all("view", view="body")
    ask.all("body", body={"x_mm": 20})
    ask.all("body", body={"x_mm": 30}, commit=False)
    assert ask("undo", "state")["state"]["body"]["x_mm"] == 20
    assert ask("redo", "state")["state"]["body"]["x_mm"] == 30


def test_a_state_is_restored_in_another_session(ask):
    ask.all("robot", preset="phantomx")
    ask.all("view", view="body")
    text = ask.all("body", body=BODY)[-1]["state"]
    resumed = Asked()
    answers = resumed.all("hello", state=text)
    assert [answer["type"] for answer in answers] == ["welcome", "robot", "state", "pose", "done"]
    assert resumed.session.state == ask.session.state
    assert not answers[-1]["undo"]
    opened = Asked()
    answers = opened.all("open", state=text)
    assert opened.session.state == ask.session.state
    assert answers[-1]["undo"]
    assert opened.error("open", state="1.nonsense")["kind"] == "input"


def test_a_damaged_link_is_reported_and_the_session_starts():
    answers = Asked().all("hello", state="1.%%%")
    assert [answer["type"] for answer in answers] == ["welcome", "error", "robot", "state", "walk", "done"]


def test_exports_agree_with_the_api(ask, tmp_path):
    motion = plan_walk(STRIDER, Gait.named("tripod"), straight_path(0.5))
    motion_to_csv(motion, tmp_path / "walk.csv")
    file = ask("download", "file", what="csv")
    assert (file["name"], file["mime"]) == ("strider-walk.csv", "text/csv")
    assert file["text"].encode() == (tmp_path / "walk.csv").read_bytes()
    ask.all("view", view="joints")
    ask.all("joints", joints={"angles_deg": [1, 30, -100] * 6})
    lines = ask("download", "file", what="angles")["text"].splitlines()
    assert lines[0] == "leg,coxa_deg,femur_deg,tibia_deg"
    assert lines[1] == "LF,1.000000,30.000000,-100.000000"
    assert len(lines) == 7


def test_a_session_starts_with_a_custom_robot():
    document = robot_to_dict(STRIDER.replace(name="mine"))
    asked = Asked(Session(StudioState(robot=RobotChoice(preset=None, document=document))))
    robot = asked("hello", "robot")
    assert robot["name"] == "mine"
    asked.all("robot", preset="mithi")
    assert asked("undo", "robot")["name"] == "mine"


def test_values_for_other_numbers_of_legs_are_dropped(ask):
    document = robot_to_dict(STRIDER)
    document["legs"] = document["legs"][:5]
    ask.all("view", view="body", picture={**PICTURE, "leg": 5})
    assert ask("document", "state", document=document)["state"]["picture"]["leg"] is None


def test_a_walk_is_valid_without_loads(ask):
    ask.all("robot", preset="mithi")
    ask.all("view", view="loads")
    assert ask.types("walk", walk={"gait": "wave"}) == ["walk", "error", "done"]
    assert ask.session.state.walk.gait == "wave"


def test_the_values_in_sources_follow_the_body_pose(ask):
    ask.all("view", view="sources")
    assert ask.types("body", body=BODY) == ["pose", "source", "done"]
    assert "legs 0 to 5" in ask.error("source", source={"number": "000", "leg": 7})["text"]


def test_the_offline_player_requires_the_built_front_end(ask, monkeypatch, tmp_path):
    monkeypatch.setattr("tarsus.studio.player.WEB", tmp_path)
    assert "make web" in ask.error("download", what="html")["text"]
    (tmp_path / "player.html").write_text("<script>__MOTION__</script>", encoding="utf-8")
    file = ask("download", "file", what="html")
    assert (file["name"], file["mime"]) == ("strider-walk.html", "text/html")
    assert json.loads(file["text"][8:-9])["robot"]["preset"] == "strider"


def test_lack_of_memory_is_not_reported_as_a_bug(ask, monkeypatch):
    def fails(*_given, **_more):
        raise MemoryError

    monkeypatch.setattr("tarsus.studio.views.Views.walk", fails)
    assert ask.error("walk", walk={"gait": "wave"})["kind"] == "limit"


def test_a_ping_is_answered(ask):
    assert ask.types("ping") == ["done"]


def test_unexpected_errors_are_reported_as_bugs_and_the_session_continues(ask, monkeypatch, caplog):
    def fails(*_given, **_more):
        raise RuntimeError("nobody thought of this")

    with monkeypatch.context() as patched:
        patched.setattr("tarsus.studio.views.Views.walk", fails)
        error = ask.error("walk", walk={"gait": "wave"})
    assert error["kind"] == "internal"
    assert "nobody thought of this" in caplog.text
    assert ask("walk", "walk", walk={"gait": "wave"})["gait"] == "wave"


def test_an_imported_robot_of_another_name_starts_in_its_own_stance(ask):
    ask("joints", "pose", joints={"angles_deg": [0, -60, 0] * 6})
    text = robot_text(STRIDER)
    edited = text.replace("tibia_mm = 181", "tibia_mm = 180")
    assert edited != text
    ask("view", "pose", view="joints")
    assert ask("toml", "state", text=edited)["state"]["joints"]["angles_deg"] == [0, -60, 0] * 6
    own = edited.replace('name = "strider"', 'name = "mine"')
    answers = {answer["type"]: answer for answer in ask.all("toml", text=own)}
    assert answers["state"]["state"]["joints"]["angles_deg"] is None
    assert answers["pose"]["text"].startswith("stands on 6 feet")


def test_a_walk_tells_the_phases_of_its_gait(ask):
    walk = ask("walk", "walk", walk={"gait": "ripple"})
    gait = Gait.named("ripple")
    assert walk["offsets"] == pytest.approx(gait.offsets)
    own = ask("walk", "walk", walk={"gait": {"duty_factor": walk["duty_factor"], "offsets": walk["offsets"]}})
    assert own["possible"]
    assert own["angles_deg"] == walk["angles_deg"]
