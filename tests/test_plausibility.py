"""Plausibility: mistyped robot files are named with their cause, and sound robots are not warned about."""

import importlib.util
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings

from gait_robots import ring
from robots import robots
from sample_robots import hexapod
from tarsus.errors import CollisionError, InputError
from tarsus.gait.gait import GAITS, Gait
from tarsus.gait.path import straight_path
from tarsus.gait.plan import plan_walk
from tarsus.gait.stroke import max_stroke
from tarsus.plausibility import directions, lengths, limits, masses, servos
from tarsus.plausibility.checks import plausibility_warnings
from tarsus.plausibility.gait_trials import NO_STROKE, try_gaits
from tarsus.robot.file import list_robots, load_robot, robot_from_dict, robot_from_text, robot_to_dict, template_text
from tarsus.robot.robot import GaitDefaults, Robot, stack_robots
from tarsus.robot.servo import Servo

ROOT = Path(__file__).parents[1]


def docs_module(name):
    if name not in sys.modules:
        spec = importlib.util.spec_from_file_location(name, ROOT / "docs" / f"{name}.py")
        sys.modules[name] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(sys.modules[name])
    return sys.modules[name]


mistyped = docs_module("mistyped")
# A range that is nearly symmetric about level is as sound with the other sign.
NOT_SEEN = {"femur positive downward"}


@pytest.mark.parametrize("mistake", mistyped.MISTAKES, ids=lambda mistake: mistake.words)
def test_every_mistake_is_named_with_its_cause_in_every_preset(mistake):
    made = {name: document for name in list_robots() if (document := mistake.of(name)) is not None}
    assert made
    unseen = [
        name for name, document in made.items() if not any(mistake.cause in t for t in mistyped.answers(document))
    ]
    assert bool(unseen) == (mistake.words in NOT_SEEN)


@pytest.mark.parametrize("words", mistyped.TEXTS)
def test_texts_that_are_no_robot_file_are_named(words):
    text, said = mistyped.TEXTS[words]
    assert said in mistyped.text_answer(text)


def test_the_table_has_all_groups_and_forty_kinds_of_mistakes():
    mistyped_values = [mistake for mistake in mistyped.MISTAKES if mistake.group != "keys"]
    assert len(mistyped_values) - len(NOT_SEEN) >= 40
    assert {mistake.group for mistake in mistyped.MISTAKES} == {
        "keys",
        "units",
        "signs",
        "order",
        "zeros",
        "magnitudes",
    }
    assert len({mistake.words for mistake in mistyped.MISTAKES}) == len(mistyped.MISTAKES)


def test_the_page_gives_the_bounds_of_the_code():
    def ends(bounds, factor=1):
        return " to ".join(f"{bound * factor:g}" for bound in bounds)

    rows = {
        "length of a straight leg": f"{ends(lengths.LEG)} mm",
        "tibia / femur": ends(lengths.TIBIA_TO_FEMUR),
        "coxa / (femur + tibia)": f"at most {lengths.MOST_COXA:g}",
        "distance of the coxa axes from their centre / length of a leg": ends(lengths.RADIUS_TO_LEG),
        "body's box / extent of the coxa axes": ends(lengths.BOX_TO_MOUNTS),
        "radius of the feet / tibia": f"at most {lengths.MOST_FOOT:g}",
        "body height / (femur + tibia)": ends(lengths.HEIGHT_TO_REACH),
        "swing height / (femur + tibia)": ends(lengths.SWING_TO_REACH),
        "mass / (length of a leg)^3": f"{ends(masses.DENSITY)} kg/m^3",
        "share of the links in the mass": f"{ends(masses.LINK_SHARE, 100)} %",
        "stall torque / mass of a servo": f"at most {servos.MOST_TORQUE_PER_MASS:g} N m/kg",
        "no-load speed": f"{ends(servos.SPEED)} rad/s",
        "middle of the coxa's range": f"{ends((-limits.MOST_COXA_MIDDLE, limits.MOST_COXA_MIDDLE))} deg",
        "middle of the femur's range": f"{ends(limits.FEMUR_MIDDLE)} deg",
        "middle of the tibia's range": f"at most {limits.MOST_TIBIA_MIDDLE:g} deg, unless it begins below "
        f"{limits.LEAST_TIBIA:g} deg",
        "direction of a leg": f"outward; opposite legs are mirror images within {directions.MOST_YAW_DIFFERENCE:g} deg",
    }
    page = (ROOT / "docs" / "robot-check.md").read_text(encoding="utf-8")
    table = page.partition("| value | bounds |\n|---|---|\n")[2].partition("\n\n")[0]
    assert table.splitlines() == [f"| {value} | {bounds} |" for value, bounds in rows.items()]
    assert f"A range of {limits.FREE_SPAN:g} deg or more" in page


# Sound robots


def published(position, yaw, links, limits, **changes):
    """A robot from numbers of the left side, front to rear [mm, deg]; the right side is its mirror image."""
    left = np.array([[*p, 0] for p in position]) / 1000
    yaw = np.radians(yaw)
    count = 2 * len(yaw)
    coxa, femur, tibia = (np.full(count, length / 1000) for length in links)
    values = {
        "name": "published",
        "leg_names": tuple(f"leg {i}" for i in range(count)),
        "mount_position": np.concatenate([left, left[::-1] * [1, -1, 1]]),
        "mount_yaw": np.concatenate([yaw, -yaw[::-1]]),
        "coxa": coxa,
        "femur": femur,
        "tibia": tibia,
        "limits": np.broadcast_to(np.radians(limits), (count, 3, 2)),
    }
    return Robot(**{**values, **changes})


AX = [[120, 60], [0, 100], [-120, 60]]
ROUND = [45, 90, 135]
# Limits of the Phoenix firmware are converted: femur = -there, tibia = there - 90 deg.
PUBLISHED = {
    "PhantomX Mark I": published(AX, ROUND, (52, 83, 140), [[-70, 70], [-90, 90], [-160, 0]]),
    "PhantomX of HumaRobotics": published(AX, ROUND, (54, 66, 133), [[-150, 150]] * 3),
    "PhantomX Mk-2 of hase111111": published(AX, ROUND, (52, 66, 130), [[-81, 81], [-105, 99], [-145, 25.5]]),
    "razbot": published(
        [[147, 84.75], [0, 170], [-147, 84.75]], [30, 90, 150], (52, 65, 133), [[-60, 60], [-100, 100], [-150, 20]]
    ),
    "T-Hex": published([[102, 60], [0, 72], [-102, 53]], ROUND, (29, 76, 104), [[-55, 55], [-55, 90], [-130, -15]]),
    "OpenSHC": published(
        [[43.3, 25], [0, 50], [-43.3, 25]],
        [30, 90, 150],
        (50, 50, 100),
        np.degrees([[-0.55, 0.55], [-1.5, 1.5], [-2.355, -0.1]]),
    ),
    "Bullet, all legs sideways": published(
        [[250, 70], [0, 70], [-250, 70]],
        [90, 90, 90],
        (100, 114, 200),
        np.degrees([[-1.571, 1.571], [-1.571, 1.45], [-2.355, 0.001]]),
        body_mass=6.0,
        link_mass=np.tile([0.6, 0.4, 0.228], (6, 1)),
    ),
    "walking machine of 40 kg": published(
        [[400, 150], [0, 150], [-400, 150]],
        [75, 90, 105],
        (120, 380, 480),
        [[-80, 80], [-70, 70], [-150, -10]],
        body_mass=18.0,
        link_mass=np.tile([1.6, 1.4, 0.7], (6, 1)),
        body_size=np.array([1.0, 0.25, 0.2]),
    ),
    "printed, with servos of 2 g": published(
        [[18, 12], [0, 15], [-18, 12]],
        ROUND,
        (10, 18, 30),
        [[-45, 45], [-60, 80], [-140, -10]],
        body_mass=0.05,
        link_mass=np.tile([0.003, 0.003, 0.001], (6, 1)),
        gait=GaitDefaults(body_height=0.02, swing_height=0.006),
    ),
    "quadruped": published([[60, 40], [-60, 40]], [45, 135], (30, 60, 90), [[-60, 60], [-80, 90], [-150, 0]]),
    "quadruped, legs sideways": published(
        [[120, 40], [-120, 40]], [90, 90], (30, 90, 100), [[-45, 45], [-60, 90], [-160, -10]]
    ),
    "spider": published(
        [[60, 30], [25, 45], [-25, 45], [-60, 30]],
        [35, 70, 110, 145],
        (25, 70, 110),
        [[-40, 40], [-45, 90], [-150, -20]],
    ),
    "wheel of five": ring(5),
    "wheel with twisted legs": ring(6, mount_yaw=np.pi / 6 + np.pi / 3 * np.arange(6) + 0.6),
    "one leg lost": ring(7).replace(leg_names=tuple("abcdefg")),
}


@pytest.mark.parametrize("name", PUBLISHED)
def test_published_and_unusual_robots_are_not_warned_about(name):
    robot = PUBLISHED[name]
    assert [warning.text() for warning in plausibility_warnings(robot)] == []


@pytest.mark.parametrize("name", list_robots())
def test_presets_are_not_warned_about_at_any_size(name):
    robot = load_robot(name)
    assert plausibility_warnings(robot) == ()
    assert mistyped.answers(mistyped.sound(name)) == []
    for factor in (0.3, 3.0):
        lengths = (
            "mount_position",
            "coxa",
            "femur",
            "tibia",
            "femur_axis_offset",
            "foot_radius",
            "link_com",
            "body_com",
        )
        masses = ("link_mass", "body_mass")
        changes = {key: np.asarray(getattr(robot, key)) * factor for key in lengths}
        changes |= {
            key: np.asarray(getattr(robot, key)) * factor**3 for key in masses if getattr(robot, key) is not None
        }
        if robot.body_size is not None:
            changes["body_size"] = np.asarray(robot.body_size) * factor
        gait = GaitDefaults(body_height=robot.gait.body_height * factor, swing_height=robot.gait.swing_height * factor)
        # The catalogue has no servos for robots of a tenth of the mass.
        scaled = robot.replace(**changes, gait=gait, servos=())
        assert [warning.text() for warning in plausibility_warnings(scaled)] == []


@pytest.mark.parametrize("legs", [4, 5, 6, 7, 8])
def test_wheels_of_legs_are_not_warned_about(legs):
    assert plausibility_warnings(ring(legs)) == ()
    turned = ring(legs)
    turn = np.radians(10)
    matrix = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    turned = turned.replace(
        mount_position=turned.mount_position @ matrix.T, mount_yaw=np.asarray(turned.mount_yaw) + turn
    )
    assert plausibility_warnings(turned) == ()


def test_templates_and_examples_are_not_warned_about():
    assert plausibility_warnings(robot_from_text(template_text("mine"), where="template")) == ()
    for path in sorted((ROOT / "examples").glob("burnt-*.toml")):
        assert plausibility_warnings(load_robot(path)) == ()


def test_a_batch_of_designs_is_refused():
    batch = stack_robots([load_robot("strider")] * 2)
    with pytest.raises(InputError, match="plausibility is checked for a single robot"):
        plausibility_warnings(batch)
    with pytest.raises(InputError, match="gaits are tried for a single robot"):
        try_gaits(batch)


# Single checks


def codes(robot):
    return {warning.code: warning for warning in plausibility_warnings(robot)}


def test_a_warning_says_where_what_why_and_what_would_work():
    document = robot_to_dict(load_robot("strider"))
    document["legs"][5]["yaw_deg"] = 30
    (warning,) = plausibility_warnings(robot_from_dict(document))
    assert (warning.code, warning.where) == ("leg-inward", "front right: yaw_deg")
    assert warning.cause == "its sign is wrong"
    assert warning.text() == f"{warning.where}: {warning.what}. Likely cause: {warning.cause}. {warning.remedy}"
    assert "-30 deg" in warning.remedy


def test_a_leg_ahead_that_points_backward_is_off_by_half_a_turn():
    long = PUBLISHED["Bullet, all legs sideways"]
    yaw = np.array(long.mount_yaw)
    yaw[0] = np.pi
    assert "off by 180 deg" in codes(long.replace(mount_yaw=yaw))["leg-inward"].cause


def test_a_leg_that_points_inward_either_way_belongs_elsewhere():
    yaw = np.array(hexapod().mount_yaw)
    yaw[0] = np.radians(135)
    assert "another leg" in codes(hexapod(mount_yaw=yaw))["leg-inward"].cause


def test_unexplained_directions_are_named_leg_by_leg():
    yaw = np.array(hexapod().mount_yaw)
    yaw[[0, 4]] *= -1
    inward = [warning for warning in plausibility_warnings(hexapod(mount_yaw=yaw)) if warning.code == "leg-inward"]
    assert [warning.where for warning in inward] == ["front left: yaw_deg", "middle right: yaw_deg"]


def test_legs_that_cross_each_other():
    yaw = np.array(hexapod().mount_yaw)
    # The rear legs point forward a little, past the middle legs.
    yaw[2], yaw[3] = np.radians([65, -65])
    warnings = [warning for warning in plausibility_warnings(hexapod(mount_yaw=yaw)) if warning.code == "legs-cross"]
    assert [warning.where for warning in warnings] == [
        "middle left, rear left: yaw_deg",
        "rear right, middle right: yaw_deg",
    ]


def test_half_of_the_pairs_decide_which_directions_differ():
    yaw = np.array(hexapod().mount_yaw)
    yaw[0], yaw[1] = yaw[0] + 0.6, yaw[1] - 0.6
    assert "leg-differs" not in codes(hexapod(mount_yaw=yaw))


def test_names_of_two_legs_exchanged():
    names = list(hexapod().leg_names)
    names[0], names[5] = names[5], names[0]
    warning = codes(hexapod(leg_names=tuple(names)))["leg-name"]
    assert "points in the other direction" not in warning.cause
    assert "the names of left and right legs are exchanged" in warning.cause


def test_a_coxa_range_elsewhere_for_each_leg():
    limits = np.array(np.broadcast_to(np.radians([[-60, 60], [-80, 90], [-150, 0]]), (6, 3, 2)))
    limits[0, 0], limits[3, 0] = np.radians([[60, 100], [-100, -40]])
    assert "a direction other than the leg's own" in codes(hexapod(limits=limits))["limits-zero"].cause


def test_limits_that_no_convention_explains():
    limits = np.array(np.broadcast_to(np.radians([[-60, 60], [-80, 90], [-150, 0]]), (6, 3, 2)))
    limits[:, 2] = np.radians([-20, -10])
    warning = codes(hexapod(limits=limits))["limits-zero"]
    assert "keep it above -20 deg" in warning.what
    limits[:, 2] = np.radians([-110, 175])
    assert codes(hexapod(limits=limits))["limits-zero"].cause == "a different zero or sign of the angle"


def test_a_locked_joint_is_no_joint_in_radians():
    limits = np.array(np.broadcast_to(np.radians([[0, 0], [-80, 90], [-150, 0]]), (6, 3, 2)))
    assert plausibility_warnings(hexapod(limits=limits)) == ()


def test_lengths_beyond_every_unit():
    assert (
        "typing error"
        in codes(hexapod(coxa=np.full(6, 1e-6), femur=np.full(6, 1e-6), tibia=np.full(6, 1e-6)))["length-unit"].cause
    )
    giant = hexapod(coxa=np.full(6, 1.0), femur=np.full(6, 5.0), tibia=np.full(6, 5.0))
    assert "digit too many" in codes(giant)["length-unit"].cause
    assert "In mm it would be 1100" in codes(giant)["length-unit"].remedy


def test_pairs_of_legs_may_have_other_lengths():
    tibia = np.full(6, 0.181)
    tibia[[2, 3]] = 0.65
    assert plausibility_warnings(hexapod(tibia=tibia)) == ()
    tibia[3] = 0.181
    assert "rear left: tibia_mm" in codes(hexapod(tibia=tibia))["leg-differs"].where
    coxa = np.full(6, 0.068)
    coxa[1] = 0.0
    assert "typing error" in codes(hexapod(coxa=coxa))["leg-differs"].cause


def test_coxa_axes_far_from_short_legs():
    far = np.asarray(hexapod().mount_position) * 10
    warning = codes(hexapod(mount_position=far))["position-unit"]
    assert "more than 2" in warning.what
    assert "tenths of a mm" in warning.cause


def test_no_box_is_compared_with_legs_in_one_line():
    line = np.array(hexapod().mount_position)
    line[:, 1] = 0
    assert "box-unit" not in codes(hexapod(mount_position=line, body_size=np.array([1e-3, 1e-3, 1e-3])))
    large = codes(hexapod(body_size=np.array([5.0, 5.0, 0.1])))["box-unit"]
    assert "typing error" in large.cause


def test_body_in_the_ground():
    robot = hexapod(body_size=np.array([0.2, 0.16, 0.15]), gait=GaitDefaults(body_height=0.07))
    assert "into the ground" in codes(robot)["body-in-ground"].what
    assert "body-in-ground" not in codes(robot.replace(foot_radius=np.full(6, 0.006)))


def test_masses_without_an_explanation():
    assert codes(hexapod(body_mass=3e6))["mass-unit"].cause == "a unit or a digit is wrong"
    heavy_legs = hexapod(body_mass=0.01)
    assert "of the robot" in codes(heavy_legs)["mass-unit"].what
    assert plausibility_warnings(hexapod(link_mass=np.zeros((6, 3)))) == ()


def test_a_robot_lighter_than_its_servos():
    light = hexapod(link_mass=np.full((6, 3), 0.02), body_mass=0.3, servos=load_robot("strider").servos)
    assert "its servos alone 1.08 kg" in codes(light)["mass-below-servos"].what


def test_a_centre_of_mass_far_above():
    assert "coxa axes' plane" in codes(hexapod(body_com=np.array([0, 0, 0.5])))["com-outside"].what
    assert "digit too many" not in codes(hexapod(body_com=np.array([0, 0, 5.0])))["com-outside"].cause


def servo_codes(**figures):
    values = {"name": "mine", "stall_torque": 2.0, "mass": 0.06, **figures}
    return codes(hexapod(servos=((None, Servo(**values), None),) * 6))


def test_servos_with_other_units():
    assert "leg.servo, mine" in servo_codes(stall_torque=20.0)["servo-torque"].where
    assert "ounce inches" in servo_codes(stall_torque=280.0)["servo-torque"].cause
    assert "ounce inches" not in servo_codes(stall_torque=20.0)["servo-torque"].cause
    assert "radians" in servo_codes(travel=np.radians(4.7))["servo-travel"].cause
    assert "rpm" in servo_codes(no_load_speed=60.0)["servo-speed"].remedy
    assert servo_codes() == {}
    assert servo_codes(mass=None, stall_torque=100.0) == {}


def test_several_servos_are_named_by_their_joint():
    servo = load_robot("strider").servos[0][0]
    strong = replace(servo, name="strong", stall_torque=25.0)
    found = codes(hexapod(servos=((servo, strong, servo),) * 6))
    assert found["servo-torque"].where == "leg.servo.femur, strong: stall_torque_nm"


# Gaits


def test_every_gait_for_the_number_of_legs_is_tried():
    robot = load_robot("strider")
    trials = try_gaits(robot)
    assert {"tripod", "tetrapod", "ripple", "wave"} <= {trial.gait for trial in trials} <= set(GAITS)
    for trial in trials:
        gait = Gait.named(trial.gait)
        assert trial.possible
        assert trial.longest_stroke == max_stroke(robot, gait)
        walk = plan_walk(robot, gait, straight_path(1.8 * trial.longest_stroke), rate=50)
        assert trial.least_margin == pytest.approx(walk.margin.min())


def test_gaits_for_other_numbers_of_legs_are_left_out():
    names = [trial.gait for trial in try_gaits(ring(5))]
    assert "wave" in names
    assert "tripod" not in names
    assert all(Gait.named(name, legs=5) for name in names)


def test_a_quadruped_creeps():
    (trial,) = try_gaits(PUBLISHED["quadruped"])
    assert (trial.gait, trial.possible) == ("creep", True)


def test_why_a_gait_is_not_possible():
    high = ring(6, gait=GaitDefaults(body_height=0.5))
    assert all("does not reach the ground" in trial.problems[0] for trial in try_gaits(high))
    assert all(trial.longest_stroke is None for trial in try_gaits(high))
    limits = np.array(ring(6).limits)
    limits[:, 0] = 0
    stiff = ring(6, limits=limits, mount_yaw=np.zeros(6) + np.pi / 2)
    assert {trial.problems for trial in try_gaits(stiff)} == {(NO_STROKE,)}
    (trial,) = [trial for trial in try_gaits(ring(6, body_com=np.array([0.5, 0, 0]))) if trial.gait == "tripod"]
    assert trial.problems[0].startswith("tips over")
    assert trial.least_margin < 0


def test_a_walk_that_cannot_be_planned_is_a_problem(monkeypatch):
    def refused(*_, **__):
        raise CollisionError("the feet of LF and LM are 2.0 mm apart")

    monkeypatch.setattr("tarsus.plausibility.gait_trials.plan_walk", refused)
    for trial in try_gaits(load_robot("strider")):
        assert trial.problems == ("the feet of LF and LM are 2.0 mm apart",)
        assert trial.longest_stroke > 0
        assert trial.least_margin is None


@settings(max_examples=40, deadline=None)
@given(robot=robots())
def test_every_robot_can_be_checked(robot):
    for warning in plausibility_warnings(robot):
        assert warning.text().count("Likely cause: ") == 1
        assert all((warning.code, warning.where, warning.what, warning.cause, warning.remedy))
