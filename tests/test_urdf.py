"""Robots from URDF files are those of the files, whatever their frames; what doesn't fit is named."""

import json
import math
import re
from xml.etree import ElementTree as ET

import numpy as np
import pinocchio as pin
import pytest

import tarsus
from robots import random_robot
from sample_commands import run, run_json
from tarsus.errors import InputError
from tarsus.export import to_urdf
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import centre_of_mass, total_mass
from tarsus.robot.file import list_robots, load_robot, robot_from_text, robot_text
from tarsus.robot.ring import ring
from tarsus.robot.shape import TAILS
from tarsus.urdf import robot_from_urdf, urdf_robot
from urdf_frames import framed_urdf, stl

STRIDER = load_robot("strider")
URDF = to_urdf(STRIDER)


def with_masses(name):
    robot = load_robot(name)
    if robot.has_masses:
        return robot
    return robot.replace(body_mass=np.array(1.2), link_mass=np.tile([0.02, 0.09, 0.06], (robot.legs, 1)))


@pytest.mark.parametrize("name", list_robots()[::2])
def test_what_is_exported_is_imported_again(name):
    robot = with_masses(name)
    found = urdf_robot(to_urdf(robot))
    assert found.robot.leg_names == robot.leg_names
    assert found.deviation < 1e-9
    # Through the robot file as well, to all digits.
    read = robot_from_text(robot_text(found.robot), where="the file")
    for one in (found.robot, read):
        for key in TAILS:
            mine, theirs = getattr(one, key), getattr(robot, key)
            if theirs is None:
                assert mine is None, key
            else:
                np.testing.assert_allclose(mine, theirs, rtol=0, atol=1e-9, err_msg=key)
    assert (found.signs == 1).all()
    assert np.abs(found.zeros).max() < 1e-9
    assert not any("incline" in remark or "beside" in remark for remark in found.remarks)


def in_pinocchio(text, made, found, samples, seed):
    """Foot points and centres of mass of the file at random angles, in the frame of its body, and those angles."""
    model = pin.buildModelFromXML(text, pin.JointModelFreeFlyer())
    data, random = model.createData(), np.random.default_rng(seed)
    chassis = model.getFrameId("chassis", pin.BODY)
    for _ in range(samples):
        q = pin.neutral(model)
        q[7:] = random.uniform(-1, 1, model.nq - 7)
        pin.forwardKinematics(model, data, q)
        pin.updateFramePlacements(model, data)
        T_body_root = data.oMf[chassis].inverse()
        feet, angles = [], np.empty((len(found.joints), 3))
        for leg, names in enumerate(found.joints):
            number = names[0].removeprefix("alpha")
            toe = model.getFrameId(f"toe_{number}", pin.BODY)
            feet.append(T_body_root * data.oMf[toe].translation)
            for joint, name in enumerate(names):
                angles[leg, joint] = q[model.joints[model.getJointId(name)].idx_q]
        yield np.array(feet), T_body_root * pin.centerOfMass(model, data, q), angles


@pytest.mark.parametrize("seed", range(4))
def test_frames_zeros_and_signs_do_not_matter(seed):
    robot = with_masses("phantomx") if seed == 0 else random_robot(np.random.default_rng(seed))
    robot = robot.replace(body_size=None)
    if not robot.has_masses:
        robot = robot.replace(body_mass=np.array(1.2), link_mass=np.tile([0.02, 0.09, 0.06], (robot.legs, 1)))
    made = framed_urdf(robot, seed=seed)
    found = urdf_robot(made.text)
    assert found.robot.leg_names == tuple(tarsus.load_robot("strider").leg_names)
    assert found.deviation < 1e-7
    assert float(total_mass(found.robot)) == pytest.approx(float(total_mass(robot)))
    for feet, com, angles in in_pinocchio(made.text, made, found, 20, seed):
        ours = found.signs * angles + found.zeros
        np.testing.assert_allclose(np.asarray(forward_kinematics(found.robot, ours))[:, 3], feet, atol=1e-7)
        np.testing.assert_allclose(centre_of_mass(found.robot, ours), com, atol=1e-7)
    # Legs that the file has in any order are those of the robot, with its lengths and limits.
    order = [int(names[0].removeprefix("alpha")) for names in found.joints]
    np.testing.assert_allclose(found.robot.tibia, np.asarray(robot.tibia)[order], atol=1e-9)
    limits = np.asarray(robot.limits)[order]
    np.testing.assert_allclose(found.robot.limits[:, 1:], limits[:, 1:], atol=1e-7)


@pytest.mark.parametrize("foot", ["sphere", "cylinder", "box", "mesh"])
def test_the_foot_is_the_end_of_the_last_shape(foot, tmp_path):
    made = framed_urdf(STRIDER, seed=7, foot=foot)
    reference = urdf_robot(framed_urdf(STRIDER, seed=7).text)
    meshes = tmp_path / "meshes"
    meshes.mkdir()
    for leg in range(6):
        angles = np.zeros((6, 3))
        angles[leg] = made.zeros[leg]
        points = np.asarray(forward_kinematics(STRIDER, angles))[leg]
        tip = 1000 * (points[3] - points[2])
        (meshes / f"tibia_{leg}.stl").write_bytes(stl([[[0, 0, 0], [5, 5, 0], tip]]))
    path = tmp_path / "urdf" / "robot.urdf"
    path.parent.mkdir()
    path.write_text(made.text, encoding="utf-8")
    found = robot_from_urdf(path)
    np.testing.assert_allclose(found.robot.tibia, reference.robot.tibia, atol=1e-7)
    np.testing.assert_allclose(found.zeros, reference.zeros, atol=1e-6)
    assert (found.robot.foot_radius == (0.008 if foot == "sphere" else 0.0)).all()
    assert any("radius of the foot is missing" in remark for remark in found.remarks) is (foot != "sphere")


def test_an_unknown_foot_can_be_given():
    made = framed_urdf(STRIDER, seed=3, foot="mesh")
    with pytest.raises(InputError, match=r"the foot behind joint 'gamma\d' is unknown.*give the foot point"):
        urdf_robot(made.text)
    found = urdf_robot(made.text, foot=(0.1, 0.0, 0.05))
    assert found.robot.tibia.max() <= math.hypot(0.1, 0.05) + 1e-9


@pytest.mark.parametrize(("forward", "turn"), [("y", 90), ("-x", 180), ("-y", -90)])
def test_forward_is_any_axis_of_the_body(forward, turn):
    found, same = urdf_robot(URDF, forward=forward).robot, urdf_robot(URDF).robot
    yaw = np.degrees(same.mount_yaw) - turn
    found_yaw = np.degrees(found.mount_yaw)
    assert sorted(np.round(found_yaw) % 360) == sorted(np.round(yaw) % 360)
    assert found.mount_position[0, 0] > 0
    assert found.mount_position[0, 1] >= 0


def test_origins_along_the_axes_are_named_and_harmless():
    made = framed_urdf(STRIDER, seed=5, slide=0.02)
    found = urdf_robot(made.text)
    assert found.deviation < 1e-7
    assert any(re.search(r"the knee lies \d+\.\d mm beside the plane of the foot", line) for line in found.remarks)


def changed(change, text=URDF):
    root = ET.fromstring(text)
    change(root)
    return ET.tostring(root, encoding="unicode")


def element(root, tag, name):
    return next(one for one in root.iter(tag) if one.get("name") == name)


def add_joint(root, name, kind, parent, child):
    ET.SubElement(root, "link", name=child)
    joint = ET.SubElement(root, "joint", name=name, type=kind)
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)
    return joint


def test_what_is_missing_or_does_not_fit_is_named():
    def change(root):
        femur = element(root, "joint", "front_left_femur")
        femur.find("origin").set("rpy", f"{math.radians(3)} 0 0")
        femur.remove(femur.find("limit"))
        ET.SubElement(femur, "mimic", joint="front_right_femur")
        element(root, "joint", "rear_left_tibia").find("limit").set("lower", "-4.5")
        element(root, "link", "middle_left_tibia").find("inertial").find("origin").set("xyz", "0.05 0.02 0")
        link = element(root, "link", "rear_right_coxa")
        link.remove(link.find("inertial"))
        body = element(root, "link", "body")
        body.find("inertial").find("mass").set("value", "0")
        for kind in ("visual", "collision"):
            body.find(kind).find("origin").set("xyz", "0 0 0.01")
        add_joint(root, "pan", "continuous", "body", "camera")
        add_joint(root, "tilt", "revolute", "camera", "lens")
        add_joint(root, "ankle", "revolute", "front_left_tibia", "sole")
        add_joint(root, "slider", "prismatic", "front_right_coxa", "sled")

    found = urdf_robot(changed(change))
    text = "\n".join(found.remarks)
    for line in (
        "front left: the femur axis is inclined by 3.00 deg to the horizontal",
        "front left: the femur has no limits: -180 to 180 deg assumed",
        "rear left: the limits of the tibia, -257.8 to 10.0 deg, are cut at 180 deg",
        "middle left: the centre of mass of the tibia lies 19.8 mm beside its line",  # with the foot, which is on it
        "the mass of the body is missing",
        "masses of links are missing",
        "the box of the body is 10.0 mm off its origin",
        "joints beyond the third of a leg, held at zero: ankle, slider",
        "joints that belong to no leg, held at zero: pan, tilt",
        "joints that follow others in the file, and are free here: front_left_femur",
        "servos are missing; limits of the file: coxa 2.452 N m, 8.06 rad/s",
    ):
        assert line in text, text
    assert found.robot.body_mass is None
    assert found.robot.link_mass is None
    assert 1e-3 < found.deviation < 0.05


def test_names_that_contradict_the_direction_are_named():
    assert not any("contradict" in remark for remark in urdf_robot(URDF).remarks)
    (remark,) = [remark for remark in urdf_robot(URDF, forward="y").remarks if "contradict" in remark]
    assert "'front_left_coxa' is the front right leg" in remark


def test_robots_with_other_numbers_of_legs():
    four = load_robot("strider").replace()
    indices = [0, 2, 3, 5]
    keys = [key for key, tail in TAILS.items() if getattr(four, key) is not None and tail[:1] == ("legs",)]
    small = tarsus.Robot(
        name="four",
        leg_names=tuple(four.leg_names[i] for i in indices),
        body_mass=four.body_mass,
        body_size=four.body_size,
        **{key: np.asarray(getattr(four, key))[indices] for key in keys},
    )
    assert urdf_robot(to_urdf(small)).robot.leg_names == ("front left", "rear left", "rear right", "front right")


def one_of(tag, name, key, value, inner=None):
    def change(root):
        at = element(root, tag, name)
        (at if inner is None else at.find(inner)).set(key, value)

    return change


def without_legs(root):
    for joint in [one for one in root.findall("joint") if "rear" in one.get("name")]:
        root.remove(joint)


def looped(root):
    joint = ET.SubElement(root, "joint", name="loop", type="fixed")
    ET.SubElement(joint, "parent", link="front_left_foot")
    ET.SubElement(joint, "child", link="body")


REFUSED = {
    "is not valid XML": "<robot>",
    "is not valid XML: ": "",
    "has the root element <model>": "<model/>",
    "has a DOCTYPE": '<!DOCTYPE robot [<!ENTITY a "b">]><robot/>',
    "has macros of xacro; expand it first": '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:leg/></robot>',
    "found 4 legs": None,
    "found 0 legs, chains of three revolute joints from one link": "<robot><link name='a'/></robot>",
    "form a loop": changed(looped),
    "the link 'front_left_femur' is moved by more than one joint": changed(
        one_of("joint", "front_left_tibia", "link", "front_left_femur", "child")
    ),
    "joins the link 'nothing', which the file does not have": changed(
        one_of("joint", "front_left_tibia", "link", "nothing", "child")
    ),
    "xyz of 'front_left_tibia' is '1 2'; expected 3 numbers": changed(
        one_of("joint", "front_left_tibia", "xyz", "1 2", "axis")
    ),
    "upper of 'rear_left_coxa' is 'nan'; expected a number": changed(
        one_of("joint", "rear_left_coxa", "upper", "nan", "limit")
    ),
    "the lower limit of joint 'rear_left_coxa', 9 rad, is above its upper limit": changed(
        one_of("joint", "rear_left_coxa", "lower", "9", "limit")
    ),
    "the axis of joint 'rear_left_coxa' has no direction": changed(
        one_of("joint", "rear_left_coxa", "xyz", "0 0 0", "axis")
    ),
    "joint 'rear_left_coxa': the coxa axis is inclined by 90.0 deg to the vertical": changed(
        one_of("joint", "rear_left_coxa", "xyz", "1 0 0", "axis")
    ),
    "joint 'rear_left_femur': the femur axis is inclined by 90.0 deg to the horizontal": changed(
        one_of("joint", "rear_left_femur", "xyz", "0 0 1", "axis")
    ),
    "the femur of joint 'rear_left_femur' has no length": changed(
        one_of("joint", "rear_left_tibia", "xyz", "0 0 0", "origin")
    ),
}
REFUSED["has no <link>"] = '<robot name="empty"/>'
REFUSED["lower of 'rear_left_coxa' is '1e200'; expected a number up to 1e+12"] = changed(
    one_of("joint", "rear_left_coxa", "lower", "1e200", "limit")
)
REFUSED["found 3 legs"] = REFUSED.pop("found 4 legs")


@pytest.mark.parametrize("message", REFUSED)
def test_what_is_no_robot_is_refused(message):
    text = REFUSED[message]
    if text is None:
        text = changed(
            lambda root: (
                [root.remove(one) for one in root.findall("joint") if one.get("name")[:4] == "rear"]
                and root.remove(element(root, "joint", "middle_left_coxa"))
            )
        )
    with pytest.raises(InputError) as caught:
        urdf_robot(text, where="robot.urdf")
    assert message in str(caught.value)


def test_a_negative_mass_and_a_wrong_direction_are_refused():
    def change(root):
        element(root, "link", "body").find("inertial").find("mass").set("value", "-1")

    with pytest.raises(InputError, match="the mass of link 'body' is -1 kg; it must not be negative"):
        urdf_robot(changed(change))
    with pytest.raises(InputError, match="forward is 'up'; it must be one of x, y, -x, -y"):
        urdf_robot(URDF, forward="up")


def test_a_file_that_cannot_be_read_is_an_error(tmp_path):
    with pytest.raises(InputError, match="can't be read: No such file"):
        robot_from_urdf(tmp_path / "none.urdf")
    (tmp_path / "bytes.urdf").write_bytes(b"\xff\xfe\xff")
    with pytest.raises(InputError, match="it is not text in UTF-8"):
        robot_from_urdf(tmp_path / "bytes.urdf")


def test_the_command_writes_a_robot_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    made = framed_urdf(STRIDER, seed=11)
    (tmp_path / "crawler.urdf").write_text(made.text, encoding="utf-8")
    result = run("robots", "import", "crawler.urdf", "--name", "crawler")
    assert result.exit_code == 0, result.output
    assert "crawler: 6 legs; foot points differ from those of the URDF file by at most 0.000 mm" in result.stdout
    assert "wrote crawler.toml; check it with: tarsus robots check crawler.toml" in result.stdout
    robot = load_robot("crawler.toml")
    assert robot == urdf_robot(made.text, name="crawler", where="crawler.urdf").robot
    text = (tmp_path / "crawler.toml").read_text(encoding="utf-8")
    assert text.startswith("# Imported from crawler.urdf by tarsus robots import.\n# - ")
    assert re.search(r"^#   LF: coxa = -?coxa_urdf( [+-] [\d.]+ deg)?, femur = -?femur_urdf [+-] ", text, re.MULTILINE)
    again = run("robots", "import", "crawler.urdf", "--name", "crawler")
    assert again.exit_code == 2
    assert "crawler.toml already exists" in again.stderr
    _, found = run_json("robots", "import", "crawler.urdf", "--out", "other.toml")
    assert found["file"] == "other.toml"
    assert len(found["legs"]) == 6
    assert json.dumps(found["remarks"])
    assert run("robots", "import", "crawler.urdf", "--out", "no/such/folder.toml").exit_code == 2


def test_an_origin_beside_the_legs_can_be_moved():
    def change(root):
        for one in root.iter("joint"):
            if one.find("parent").get("link") == "body":
                x, y, z = map(float, one.find("origin").get("xyz").split())
                one.find("origin").set("xyz", f"{x + 0.1} {y} {z - 0.02}")
        element(root, "link", "body").find("inertial").find("origin").set("xyz", "0.1 0 -0.02")

    text = changed(change)
    off, moved = urdf_robot(text), urdf_robot(text, centre=True)
    assert any("the origin lies 100 mm beside the middle of the coxa axes" in remark for remark in off.remarks)
    assert not any("the origin lies" in remark for remark in moved.remarks)
    np.testing.assert_allclose(moved.robot.mount_position, STRIDER.mount_position, atol=1e-9)
    np.testing.assert_allclose(moved.robot.body_com, 0, atol=1e-9)
    assert moved.deviation < 1e-9


@pytest.mark.parametrize(("codes", "wrong"), [("lf lm lr rr rm rf", 0), ("fr r2 br bl l2 fl", 1), ("a b c d e f", 0)])
def test_short_names_of_legs_are_understood(codes, wrong):
    text = URDF
    for name, code in zip(STRIDER.leg_names, codes.split(), strict=True):
        text = text.replace(name.replace(" ", "_"), f"j_{code}")
    found = urdf_robot(text)
    assert sum("names of joints contradict" in remark for remark in found.remarks) == wrong


def test_other_numbers_of_legs_are_numbered_in_the_ring():
    yaw = np.radians([25.0, 70.0, 115.0, 160.0, -155.0, -110.0, -65.0, -20.0])
    limits = np.radians([[[-60, 60], [-80, 100], [-160, 10]]] * 8)
    spider = tarsus.Robot(
        name="spider",
        leg_names=tuple(f"leg {number}" for number in range(1, 9)),
        mount_position=0.1 * np.stack([np.cos(yaw), np.sin(yaw), 0 * yaw], axis=-1),
        mount_yaw=yaw,
        coxa=np.full(8, 0.05),
        femur=np.full(8, 0.08),
        tibia=np.full(8, 0.12),
        limits=limits,
        body_mass=np.array(1.0),
        link_mass=np.full((8, 3), 0.05),
    )
    found = urdf_robot(framed_urdf(spider, seed=2).text)
    assert found.robot.leg_names == spider.leg_names
    assert found.deviation < 1e-7


def around(mounts, yaw):
    """A robot with legs at mounts (legs, 2), which point to yaw."""
    legs = len(yaw)
    return tarsus.Robot(
        name="around",
        leg_names=tuple(f"leg {number}" for number in range(1, legs + 1)),
        mount_position=np.column_stack([mounts, np.zeros(legs)]),
        mount_yaw=np.asarray(yaw),
        coxa=np.full(legs, 0.05),
        femur=np.full(legs, 0.08),
        tibia=np.full(legs, 0.12),
        limits=np.radians([[[-60, 60], [-80, 100], [-160, 10]]] * legs),
        body_mass=np.array(1.0),
        link_mass=np.full((legs, 3), 0.05),
    )


def assert_listed_as_imported(mounts, yaw):
    """In this order, through the robot file too, whatever the order in the URDF file."""
    for order in (np.arange(len(yaw)), np.random.default_rng(3).permutation(len(yaw))):
        found = urdf_robot(to_urdf(around(mounts[order], yaw[order]))).robot
        np.testing.assert_allclose(found.mount_position[:, :2], mounts, atol=1e-9)
        np.testing.assert_allclose(np.exp(1j * found.mount_yaw), np.exp(1j * yaw), atol=1e-9)
        assert robot_from_text(robot_text(found), where="the file") == found


@pytest.mark.parametrize("turn", [-35.0, 35.0])
def test_mounts_order_the_legs_however_far_these_are_turned(turn):
    """The feet of every other leg are beyond those of its neighbour."""
    at = np.radians(np.arange(10) * 36.0 + 4.0)
    yaw = at + np.radians(turn) * np.tile([1, -1], 5)
    assert_listed_as_imported(0.08 * np.stack([np.cos(at), np.sin(at)], axis=-1), yaw)


@pytest.mark.parametrize("apart", [0.0, 0.004])
def test_mounts_on_one_line_are_listed_around_the_body_by_where_their_legs_point(apart):
    left = np.stack([np.array([0.11, 0.03, -0.07]), np.full(3, apart)], axis=-1)
    mounts, yaw = np.concatenate([left, -left]), np.radians([60, 90, 120, -120, -90, -60])
    assert_listed_as_imported(mounts, yaw)
    # From front to rear, it is no ring.
    rows = np.argsort(-mounts[:, 0])
    assert ring(mounts[rows] @ [1, 1j], np.exp(1j * yaw[rows])) == [0, 2, 4, 5, 3, 1]


def test_a_leg_whose_foot_is_over_its_coxa_axis_points_outward():
    tip = np.array([0.068 + 0.098, 0.0, 0.0])
    text = changed(
        lambda root: [
            element(root, "joint", f"{name.replace(' ', '_')}_foot").find("origin").set("xyz", f"{-tip[0]} 0 0.05")
            for name in STRIDER.leg_names
        ]
    )
    found = urdf_robot(text)
    np.testing.assert_allclose(found.robot.mount_yaw, STRIDER.mount_yaw, atol=1e-9)
    assert found.deviation < 1e-9


def test_a_file_of_unreasonable_size_is_refused():
    with pytest.raises(InputError, match="at most 20000000 are read"):
        urdf_robot("<robot>" + " " * 20_000_000)
