"""Running scenarios: what comes out is what walker, sequences and guard make of it, tick by tick."""

import csv
import dataclasses
import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import tarsus.control.robot_controller as robot_controller
from tarsus.control.command import Command
from tarsus.control.loop.recording import Recording
from tarsus.control.plant import Environment
from tarsus.control.pose.admittance import Admittance
from tarsus.control.safety import GuardOutput, GuardState, Intervention, InterventionKind
from tarsus.control.walk_controller import WalkController
from tarsus.errors import InputError, UnknownNameError
from tarsus.gait.gait import Gait
from tarsus.gait.storage import load_motion, save_motion
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import total_mass
from tarsus.kinematics.pose import Pose
from tarsus.load.loads import joint_loads
from tarsus.report.style import save_figure
from tarsus.report.timeline import plot_timeline
from tarsus.robot.file import list_robots, load_robot, robot_from_dict, robot_to_dict
from tarsus.scenario.commands import COMMANDS
from tarsus.scenario.file import load_scenario, scenario_from_text
from tarsus.scenario.runner import run_scenario
from tarsus.scenario.scenario import Scenario
from tarsus.scenario.summary import drive_summary

EXAMPLES = sorted((Path(__file__).parents[1] / "examples").glob("*.toml"))
SCENARIOS = [path for path in EXAMPLES if "timeline" in path.read_text() or "[[at]]" in path.read_text()]

SOFT = Admittance(mass=1.0, damping=60.0, stiffness=400.0, travel=0.008)
EVERY_COMMAND = scenario_from_text(
    """
    at 0.2 s: stand_up
    at 2.5 s: walk 40 mm/s; gait wave; ground RF 0 mm
    at 4 s: sway z 3 mm roll 1 deg; cycle_time 1.5 s; tilt pitch 0.3 deg
    at 5 s: body pitch 2 deg z 3 mm; swing_height 15 mm; stance_width 3 mm; body_height 85 mm
    at 7 s: walk vx 20 mm/s turn 5 deg/s; cycle_time auto
    at 9 s: stop; body; sway; foot_target LM x 0 mm y 200 mm z 40 mm
    at 10 s: foot_velocity LM vy -20 mm/s vz 10 mm/s
    at 10.5 s: foot_release LM
    at 11 s: sit; fold; power_off
    """,
    start="folded",
    admittance=SOFT,
)
PUSHED = scenario_from_text(
    "at 0.5 s: force RF 2 N; at 1.5 s: force RF -1 N; force LM 1 N; at 2.5 s: sit", admittance=SOFT
)


def test_the_scenarios_have_every_command():
    assert {type(command) for command in (*EVERY_COMMAND.commands, *PUSHED.commands)} == set(COMMANDS.values())


@pytest.mark.lengthy
@pytest.mark.parametrize("name", ["strider", "makeyourpet"])
def test_every_command_runs_clean_through_the_guard(name):
    found = run_scenario(EVERY_COMMAND, robot=name)
    # No robot meets all of it in full; that is said, and nothing else is wrong.
    assert {str(each.limitation.kind) for each in found.unmet} <= {"twist", "cycle_time", "sway", "foot_target"}
    assert found.problems == tuple(f"not met in full, {each.text()}" for each in found.unmet)
    assert not found.interventions
    assert set(found.guard) == {"passing"}
    assert found.belly[0]
    assert found.belly[-1]
    assert found.states[-1] == "folded"
    assert [event.kind for event in found.events].count("command") == len(EVERY_COMMAND.commands)
    assert {"stand_up", "sit", "fold"} <= {event.text for event in found.events}
    (standing,) = found.standing
    assert (standing.margin >= 0).all()
    # The feet are where the angles and the body take them, and go from each place to the next without a jump.
    motion = found.motion
    reached = motion.body @ forward_kinematics(found.robot, motion.angles)[..., 3, :]
    # A joint that cannot follow what is felt at once lags behind.
    assert np.abs(reached - motion.feet).max() < 0.02
    speed = np.linalg.norm(np.diff(motion.feet, axis=0), axis=-1) / np.diff(motion.time)[:, None]
    assert speed.max() < 3
    # Feet that search for ground, or land on it, move.
    slips = np.linalg.norm(np.diff(motion.feet, axis=0), axis=-1) * (motion.contacts[1:] & motion.contacts[:-1])
    assert slips.max() < 0.02


@pytest.mark.lengthy
@pytest.mark.parametrize("name", [name for name in list_robots() if load_robot(name).has_masses][::2])
def test_feet_of_every_robot_give_way_clean_through_the_guard(name):
    found = run_scenario(PUSHED, robot=name)
    assert found.ok, found.problems
    assert not found.interventions
    assert all(event.kind in ("command", "stage") for event in found.events)


@pytest.mark.no_cover
def test_feet_that_give_way_walk_on_without_a_jump():
    text = "at 0 s: walk 80 mm/s; force RF 2 N; force LM -2 N; at 4 s: stop"
    found = run_scenario(scenario_from_text(text, duration=8.0, admittance=SOFT), robot="strider")
    assert found.ok, found.events
    # The ground stays where it is, however feet give way on it.
    assert np.abs(found.motion.feet[..., 2])[found.motion.contacts].max() < 0.012
    assert found.motion.body.position[:, 2] == pytest.approx(found.motion.body.position[0, 2], abs=6e-3)


@pytest.mark.no_cover
def test_a_foot_gives_way_by_the_force_over_its_stiffness():
    text = "at 0 s: force RF 2 N; force LM -1 N; at 3 s: force RF 0 N; force LM 1e3 N; "
    text += "at 6 s: force LM 0 N; force RF 3.5 N"
    found = run_scenario(scenario_from_text(text, duration=9.0, admittance=SOFT), robot="strider", guard=False)
    heights = found.motion.feet[..., 2]
    right, left = load_robot("strider").leg_codes.index("RF"), load_robot("strider").leg_codes.index("LM")
    others = np.delete(heights, (right, left), axis=1)
    # The controller takes the centre of mass that the robot has in its first stance.
    assert heights[300, [right, left]] == pytest.approx([2.0 / 400, -1.0 / 400], abs=2e-5)
    # What no robot could feel is not believed.
    assert heights[600, [right, left]] == pytest.approx(0.0, abs=2e-5)
    assert [event.text for event in found.events if event.kind == "limit"] == [
        "readings: forces of LM: beyond 4 times the robot's weight, or downward beyond 0.25 times",
        "readings: forces of LM: settling after a rejected reading",
    ]
    # More than leads to the end of its travel is cut off.
    assert heights[900, [right, left]] == pytest.approx([SOFT.travel, 0.0], abs=2e-5)
    # Critically damped or slower, no foot goes beyond where it goes, and it goes there all the time.
    assert (np.diff(heights[1:300, right]) > 0).all()
    assert (np.diff(heights[1:300, left]) < 0).all()
    assert np.abs(others).max() < 2e-5
    # The angles put the feet where they have gone.
    reached = found.motion.body @ forward_kinematics(found.robot, found.motion.angles)[..., 3, :]
    assert np.abs(reached - found.motion.feet).max() < 1e-9


@pytest.mark.lengthy
@pytest.mark.parametrize("speed", [(0.02, 0.0, 0.0), (0.0, -0.01, 0.015), (-0.01, 0.02, -0.01)])
def test_a_foot_velocity_holds_until_another_command(speed):
    vx, vy, vz = (f"{name} {1000 * value:g} mm/s" for name, value in zip(("vx", "vy", "vz"), speed, strict=True))
    text = (
        "at 0 s: gait wave; foot_target RF x 250 mm y -200 mm z 60 mm; "
        f"at 12 s: foot_velocity RF {vx} {vy} {vz}; at 14.5 s: foot_velocity RF; at 18 s: foot_release RF"
    )
    found = run_scenario(scenario_from_text(text), robot="strider")
    assert found.ok
    foot, time = found.motion.feet[:, found.robot.leg_codes.index("RF")], found.motion.time
    # It stands, so that the heading frame is the ground's.
    before, after = (foot[np.searchsorted(time, at)] for at in (12.0, 17.9))
    assert before == pytest.approx([0.25, -0.2, 0.06], abs=1e-6)
    assert after - before == pytest.approx(2.5 * np.array(speed), abs=1e-6)
    midway = slice(*np.searchsorted(time, (13.8, 14.4)))
    assert np.diff(foot[midway], axis=0) / 0.01 == pytest.approx(np.tile(speed, (59, 1)), abs=2e-4)
    assert found.motion.contacts[-1].all()


def test_a_foot_velocity_holds_to_the_end_of_reach_and_a_point_ends_it():
    text = (
        "at 0 s: gait wave; foot_target RF x 250 mm y -200 mm z 60 mm; at 12 s: foot_velocity RF vx 50 mm/s; "
        "at 16 s: foot_target RF x 250 mm y -200 mm z 50 mm"
    )
    found = run_scenario(scenario_from_text(text, duration=20.0), robot="strider")
    # At the edge it comes and goes from tick to tick, and is reported once.
    (limit,) = (event for event in found.events if event.kind == "limit")
    assert "front right: out of reach" in limit.text
    assert limit.time == pytest.approx(14.5, abs=0.5)
    assert limit.until == pytest.approx(16.0, abs=0.02)
    foot = found.motion.feet[:, found.robot.leg_codes.index("RF")]
    assert foot[1590, 0] > 0.3
    assert foot[-1] == pytest.approx([0.25, -0.2, 0.05], abs=1e-6)


@pytest.mark.no_cover
def test_a_foot_with_a_velocity_is_put_down_before_the_robot_sits_down():
    text = "at 0 s: gait wave; foot_velocity RF vz 20 mm/s; at 5 s: sit; at 6 s: foot_release RF"
    found = run_scenario(scenario_from_text(text, duration=10.0), robot="strider")
    assert found.ok, found.problems
    assert not found.motion.contacts[found.motion.time < 5.0].all()
    assert found.states[-1] == "lying"


@pytest.mark.no_cover
def test_the_cycle_time_goes_back_to_auto():
    text = "at 0 s: walk 30 mm/s; at 1 s: cycle_time 1.6 s; at 5 s: cycle_time auto; at 10 s: stop"
    found = run_scenario(scenario_from_text(text), robot="strider")
    before, own, after = (found.cycle_times[np.searchsorted(found.motion.time, at)] for at in (0.9, 4.9, 9.9))
    assert own == pytest.approx(1.6)
    assert after == before
    assert before < 1.5
    assert found.ok


def test_it_is_what_the_walker_gives():
    text = "at 0 s: walk vx 50 mm/s turn 5 deg/s; swing_height 20 mm; at 1 s: gait ripple; body z 5 mm; at 2.5 s: stop"
    found = run_scenario(scenario_from_text(text, duration=4.0, rate=50.0), robot="strider")
    controller = WalkController(load_robot("strider"), Gait.named("tripod", legs=6))
    sticky = {"swing_height": 0.02}
    twist = (0.05, 0.0, math.radians(5))
    for tick in range(1, 201):
        before = (tick - 1) / 50
        if before == 1:
            sticky |= {"gait": "ripple", "body": (0.0, 0.0, 0.005, 0.0, 0.0, 0.0)}
        if before == 2.5:
            twist = (0.0, 0.0, 0.0)
        angles = controller.step(Command(twist=twist, **sticky), tick / 50 - before)
        assert (found.motion.angles[tick] == angles).all()
        assert (found.motion.feet[tick] == controller.feet).all()
        assert (found.motion.contacts[tick] == controller.contacts).all()
        assert (found.twist[tick] == controller.twist).all()
        assert found.twist_commanded[tick] == pytest.approx(twist)
        assert found.gaits[tick] == controller.gait.name
    assert len(found.motion.time) == 201


def test_the_same_scenario_gives_the_same_to_the_bit_and_a_seed_is_used():
    scenario = scenario_from_text("at 0 s: walk 50 mm/s", duration=2.0, jitter=0.004, seed=7, robot="phantomx")
    one, two = run_scenario(scenario), run_scenario(scenario)
    other = run_scenario(dataclasses.replace(scenario, seed=8))
    assert one.motion.angles.tobytes() == two.motion.angles.tobytes()
    assert one.motion.time.tobytes() == two.motion.time.tobytes()
    assert one.events == two.events
    assert (one.motion.time[:50] != other.motion.time[:50]).any()
    assert np.ptp(np.diff(one.motion.time)) > 0.001
    assert np.diff(one.motion.time).max() <= 0.014


def test_commands_are_given_at_the_first_tick_at_or_after_their_time():
    found = run_scenario(scenario_from_text("at 0.1 s: walk 10 mm/s; at 0.255 s: stop", duration=0.5), robot="strider")
    asked = found.motion.time[1:][found.twist_commanded[1:, 0] > 0]
    assert asked[0] == pytest.approx(0.11)
    assert asked[-1] == pytest.approx(0.26)
    assert [event.time for event in found.events] == pytest.approx([0.1, 0.26])


@pytest.mark.no_cover
def test_without_a_duration_it_ends_when_what_was_begun_is_over():
    walking = run_scenario(scenario_from_text("at 1 s: walk 20 mm/s"), robot="strider")
    assert walking.motion.duration == pytest.approx(3.0)
    stopped = run_scenario(scenario_from_text("at 0 s: walk 20 mm/s; at 2 s: stop"), robot="strider")
    assert stopped.activities[-1] == "standing"
    assert run_scenario(Scenario(), robot="strider").motion.duration == pytest.approx(2.0)


def test_what_can_not_be_now_is_refused_and_said():
    text = "at 0 s: stand_up; power_off; sit; sit; power_off; at 5 s: stand_up"
    found = run_scenario(scenario_from_text(text), robot="strider")
    (refused,) = (event.text for event in found.events if event.kind == "refused")
    assert refused == "power_off: the robot stands; it must lie on its belly before the joints are released"
    assert [event.text[:15] for event in found.events if event.kind == "power"] == ["joints released"]
    assert not found.ok
    assert found.states[-1] == "standing"
    assert f"at 0.00 s {refused}" in found.problems


def test_a_robot_that_stands_sits_down_before_it_folds():
    found = run_scenario(scenario_from_text("at 0 s: fold"), robot="strider")
    assert found.ok
    assert list(dict.fromkeys(found.states)) == ["standing", "sitting", "lying", "folding", "folded"]


def test_a_robot_that_can_not_get_up_says_why(monkeypatch):
    def refuse(*_args, **_more):
        raise InputError("no way up")

    monkeypatch.setattr(robot_controller, "stand_up", refuse)
    found = run_scenario(scenario_from_text("at 0 s: stand_up", start="sitting"), robot="strider")
    assert found.problems[0] == "at 0.01 s stand_up: rising is not possible: no way up"
    assert found.standing == ()
    assert drive_summary(found)["least_margin"] is None


@pytest.mark.no_cover
def test_it_gets_up_where_it_has_sat_down():
    text = "at 0 s: walk vx 60 mm/s turn 20 deg/s; at 3 s: sit; walk 30 mm/s; at 6 s: stand_up; at 9 s: stop"
    found = run_scenario(scenario_from_text(text), robot="strider")
    assert found.ok
    assert len(found.standing) == 2
    motion = found.motion
    assert np.linalg.norm(np.diff(motion.body.position, axis=0), axis=1).max() < 0.01
    sat = motion.body.position[found.belly][:, :2]
    assert np.linalg.norm(sat[0]) > 0.05
    assert np.ptp(sat, axis=0).max() < 1e-6
    second = found.standing[1].body.position[:, :2]
    assert np.linalg.norm(second[0] - sat[-1]) < 1e-6
    assert np.linalg.norm(second[-1] - second[0]) > 0.02
    assert found.standing[1].time[0] == 0


def test_limitations_are_reported_once_with_their_time():
    found = run_scenario(
        scenario_from_text("at 0.5 s: walk 3 m/s; at 2 s: walk 10 mm/s", duration=3.0), robot="strider"
    )
    (limit,) = (event for event in found.events if event.kind == "limit")
    assert limit.text.startswith("twist: ")
    assert limit.time == pytest.approx(0.51, abs=0.011)
    assert limit.until == pytest.approx(2.0, abs=0.011)
    (unmet,) = found.unmet
    assert str(unmet.limitation.kind) == "twist"
    assert not found.ok


class Rejecting:
    """A guard that lets nothing through for a while, and sends zeros instead."""

    def __init__(self, robot, **_more):
        self.robot, self.ticks, self.state = robot, 0, GuardState.PASSING

    def check(self, angles, dt, contacts, body):
        self.ticks += 1
        held = 30 <= self.ticks < 60
        self.state = GuardState.HOLDING if held else GuardState.PASSING
        sent = np.zeros_like(angles) if held else angles
        found = (Intervention(InterventionKind.JOINT_SPEED, "LF", "coxa", 9.0, 5.0, 0.3),) if held else ()
        return GuardOutput(sent, not held, self.state, 0.0, found)


def test_while_the_guard_holds_the_walker_waits_and_what_is_sent_is_recorded(monkeypatch):
    monkeypatch.setattr(robot_controller, "Guard", Rejecting)
    found = run_scenario(scenario_from_text("at 0 s: walk 60 mm/s", duration=1.5), robot="strider")
    assert found.interventions == {"joint_speed": 1}
    (event,) = (event for event in found.events if event.kind == "guard")
    assert event.text.startswith("LF coxa: joint speed")
    assert "guard: 1 x joint_speed" in found.problems
    assert set(found.states[30:60]) == {"fault"}
    assert [event.text for event in found.events if event.kind == "state"] == ["fault", "walking"]
    assert not found.motion.angles[30:60].any()
    assert np.array(found.guard)[30:60].tolist() == ["holding"] * 30
    assert (found.motion.body.position[31:61] == found.motion.body.position[30]).all()
    reached = found.motion.body @ forward_kinematics(found.robot, found.motion.angles)[..., 3, :]
    assert np.abs(reached - found.motion.feet).max() < 1e-9
    free = run_scenario(scenario_from_text("at 0 s: walk 60 mm/s", duration=1.5), robot="strider", guard=False)
    assert free.guard == ()
    assert (free.motion.angles[:30] == found.motion.angles[:30]).all()
    # The guard here held 30 ticks; from then on the joints go on from where they were, from rest, as the guard does.
    moved = np.concatenate([found.motion.angles[[29]], found.motion.angles[60:]])
    speeds = np.diff(moved, axis=0) / 0.01
    changes = np.diff(speeds, axis=0, prepend=np.zeros((1, *speeds.shape[1:]))) / 0.01
    assert (np.abs(changes) <= WalkController(found.robot).joint_acceleration).all()


@pytest.mark.parametrize(
    ("text", "robot", "error", "wanted"),
    [
        ("at 3 s: foot_target XY x 1 mm y 1 mm z 1 mm", "strider", UnknownNameError, "at 3 s: no leg is called 'XY'"),
        ("at 3 s: foot_velocity XY", "strider", UnknownNameError, "at 3 s: no leg is called 'XY'"),
        ("at 3 s: force XY 1 N", "strider", UnknownNameError, "at 3 s: no leg is called 'XY'"),
        ("at 3 s: force RF 2 N", "strider", InputError, "at 3 s: force RF 2 N: the feet are not compliant; set in"),
        ("at 1 s: stop", None, InputError, "the scenario names no robot"),
    ],
)
def test_infeasible_commands_are_refused_before_the_start(text, robot, error, wanted):
    with pytest.raises(error, match=wanted):
        run_scenario(scenario_from_text(text), robot=robot)


def test_without_masses_no_force_is_felt():
    (name, *_) = (name for name in list_robots() if not load_robot(name).has_masses)
    with pytest.raises(InputError, match=f"at 0.5 s: force RF 2 N: {name} has no masses"):
        run_scenario(PUSHED, robot=name)


def test_a_gait_for_six_legs_is_refused_for_four():
    document = robot_to_dict(load_robot("strider"))
    document["legs"] = [document["legs"][leg] for leg in (0, 2, 3, 5)]
    four = robot_from_dict(document)
    with pytest.raises(InputError, match=r"at 2 s: .*4 legs"):
        run_scenario(scenario_from_text("at 2 s: gait ripple", gait="creep"), robot=four)


@pytest.mark.no_cover
def test_loads_of_what_stood():
    found = run_scenario(
        scenario_from_text("at 0 s: stand_up; at 2 s: walk 50 mm/s; at 4 s: sit", start="sitting"), robot="strider"
    )
    (standing,) = found.standing
    bears = joint_loads(found.robot, standing)
    assert bears.balanced
    assert 0.3 < bears.peak[:, 1].max() < 4


def test_a_motion_of_it_is_saved_and_comes_back(tmp_path):
    found = run_scenario(scenario_from_text("at 0 s: walk 50 mm/s", duration=1.0), robot="strider")
    save_motion(found.motion, tmp_path / "motion.npz")
    back = load_motion(tmp_path / "motion.npz")
    assert (back.angles == found.motion.angles).all()
    assert found.motion.speed == pytest.approx(np.linalg.norm(found.twist[:, :2], axis=1).max())
    assert found.standing == (found.motion,)


def test_the_log_is_a_table_of_every_tick(tmp_path):
    found = run_scenario(
        scenario_from_text("at 0.5 s: walk vx 50 mm/s turn 5 deg/s", duration=1.0), robot="strider", guard=False
    )
    found.to_csv(tmp_path / "log.csv")
    with open(tmp_path / "log.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(found.motion.time)
    assert float(rows[-1]["commanded_vx_mm_s"]) == 50
    assert float(rows[-1]["walked_turn_deg_s"]) == pytest.approx(math.degrees(found.twist[-1, 2]), abs=1e-6)
    assert float(rows[-1]["cycle_time_s"]) == pytest.approx(found.motion.cycle_time, abs=1e-6)
    assert (rows[-1]["state"], rows[-1]["activity"], rows[-1]["gait"]) == ("walking", "walking", "tripod")
    with pytest.raises(InputError, match="can't be written"):
        found.to_csv(tmp_path)


def test_an_environment_is_ground_under_each_leg_and_tilt():
    environment, feet = Environment(load_robot("strider")), np.zeros((6, 3))
    output = SimpleNamespace(feet=feet, body=Pose(), contacts=np.ones(6, dtype=bool))
    assert set(environment.readings(output).values()) == {None}
    environment.set_ground(5, 0.005)
    feet[:, 2] = [0.0, 0.001, 0.0, 0.0, 0.006, 0.004]
    measured = environment.readings(output)
    assert measured["contacts"].tolist() == [True, False, True, True, False, True]
    assert measured["attitude"] is None
    assert measured["forces"] is None
    environment.set_tilt(0.1, 0.0)
    output.body = Pose.from_rpy(0.01, -0.02, 1.0, (0.0, 0.0, 0.0))
    measured = environment.readings(output)
    assert measured["attitude"] == pytest.approx((0.11, -0.02))


@pytest.mark.parametrize("yaw", [0.0, 1.0, math.pi])
def test_the_slope_of_the_ground_does_not_turn_with_the_body(yaw):
    robot = load_robot("strider")
    environment, output = Environment(robot), robot_controller.RobotController(robot).output
    for leg, place in enumerate(output.feet):
        environment.set_ground(leg, 0.1 * place[0])
    environment.set_tilt(0.0, 0.0)
    turned = Pose.from_rpy(yaw=yaw)
    output = SimpleNamespace(feet=output.feet, body=turned, contacts=output.contacts)
    # The normal of ground that rises along x, in the body's frame.
    normal = turned.rotation.T @ Pose.from_rpy(pitch=-math.atan(0.1)).rotation[:, 2]
    roll, pitch = environment.readings(output)["attitude"]
    found = Pose.from_rpy(roll, pitch, 0.0).rotation[:, 2]
    np.testing.assert_allclose(found, normal, atol=1e-3)


def test_an_environment_refuses_what_can_not_be():
    environment = Environment(load_robot("strider"))
    for leg in (6, -1, "front left"):
        with pytest.raises(InputError, match=f"environment: the robot has no leg {leg!r}; its legs are 0 to 5"):
            environment.set_ground(leg, 0.0)
    with pytest.raises(InputError, match="force is nan; it must be a finite number"):
        environment.set_force(0, math.nan)
    with pytest.raises(InputError, match="pitch is 'flat'; it must be a number"):
        environment.set_tilt(0.0, "flat")


def test_forces_are_the_weight_and_what_is_set():
    robot = load_robot("strider")
    environment, controller = Environment(robot), WalkController(robot)
    weight = float(total_mass(robot)) * 9.80665
    environment.set_force(5, -2.0)
    standing = environment.readings(controller)
    assert standing["contacts"] is None
    assert standing["forces"] == pytest.approx([weight / 6] * 5 + [weight / 6 - 2])
    lifted = controller.feet + np.array([False, True] * 3)[:, None] * [0.0, 0.0, 0.01]
    stands = np.array([True, False] * 3)
    output = SimpleNamespace(feet=lifted, body=controller.body, contacts=stands, angles=controller.angles)
    tripod = environment.readings(output)
    assert tripod["forces"].sum() == pytest.approx(weight)
    assert (tripod["forces"][1::2] == 0).all()


@pytest.mark.lengthy
@pytest.mark.parametrize("path", SCENARIOS, ids=lambda path: path.stem)
def test_the_examples_run(path):
    scenario = load_scenario(path)
    found = run_scenario(scenario)
    assert found.ok, found.problems
    assert not found.interventions
    assert all(event.kind != "refused" for event in found.events)


def test_there_are_examples():
    assert {path.stem for path in SCENARIOS} >= {"stroll", "gaits", "tilt", "whole-day"}


@pytest.mark.no_cover
def test_the_timeline_shows_every_command_and_phase(tmp_path):
    text = "at 0 s: power_off; stand_up; at 2 s: walk 5 m/s; gait wave; "
    text += "at 3 s: foot_target LM x 0.123456 mm y 200.123456 mm z 40.456 mm"
    found = run_scenario(scenario_from_text(text, start="sitting", duration=4.0, name="a try"), robot="strider")
    figure = plot_timeline(found)
    words = {text.get_text() for axes in figure.axes for text in axes.texts}
    assert {"stand_up", "gait wave", "tripod"} <= words
    assert any(word.startswith("foot_target LM x 0.12") and word.endswith("...") for word in words)
    assert any(word.startswith("commanded: up to 5000") for word in words)
    assert "strider: a try" in figure.get_suptitle()
    save_figure(figure, tmp_path / "timeline.png")
    assert (tmp_path / "timeline.png").stat().st_size > 10_000


@pytest.mark.no_cover
def test_the_timeline_shows_how_high_bearing_feet_are_where_they_may_give_way():
    found = run_scenario(load_scenario(next(path for path in SCENARIOS if path.stem == "soft-foot")))
    figure = plot_timeline(found)
    (panel,) = (axes for axes in figure.axes if axes.get_ylabel().startswith("stance feet"))
    highest = max(
        np.nanmax(line.get_ydata()) for line in panel.lines if line.get_label() in found.motion.robot.leg_codes
    )
    bearing = found.motion.contacts & found.upright[:, None]
    assert highest == pytest.approx(1000 * found.motion.feet[..., 2][bearing].max(), abs=0.2)
    assert highest > 1


def test_the_timeline_of_a_robot_that_never_stands_and_of_one_without_a_guard():
    lying = run_scenario(scenario_from_text("at 0 s: sit", start="sitting", duration=0.5), robot="strider", guard=False)
    assert isinstance(lying, Recording)
    assert "no guard" in plot_timeline(lying).get_suptitle()


def test_no_label_of_the_timeline_ends_within_a_word():
    found = run_scenario(scenario_from_text("at 0 s: power_off", start="sitting", duration=0.5), robot="strider")
    (released,) = (event.text for event in found.events if event.kind == "power")
    assert len(released) > 100
    words = {text.get_text() for text in plot_timeline(found).axes[0].texts}
    assert "joints released: coxae, femurs, tibiae" in words


def test_the_summary_is_of_the_motion():
    found = run_scenario(
        scenario_from_text("at 0.5 s: walk 50 mm/s; at 3 s: walk turn 10 deg/s; at 5 s: stop"), robot="strider"
    )
    summary = drive_summary(found)
    motion = found.motion
    assert summary["top_speed_mm_s"] == pytest.approx(50, rel=0.01)
    assert summary["top_turn_deg_s"] == pytest.approx(10, rel=0.01)
    assert summary["end"]["x_mm"] == pytest.approx(motion.body.position[-1, 0] * 1000)
    assert summary["distance_mm"] == pytest.approx(summary["end"]["x_mm"], rel=0.05)
    assert summary["least_margin"]["mm"] == pytest.approx(motion.margin.min() * 1000)
    assert 4 < summary["walked_s"] < motion.duration - 0.4
    assert summary["possible"]
    assert [command["text"] for command in summary["commands"]] == ["walk vx 50 mm/s", "walk turn 10 deg/s", "stop"]
