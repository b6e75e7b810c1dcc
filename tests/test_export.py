"""Exported robots are those of Tarsus, in Pinocchio and in MuJoCo: masses, inertias, poses of all links."""

from xml.etree import ElementTree as ET

import mujoco
import numpy as np
import pinocchio as pin
import pytest

import tarsus
from robots import random_robot
from sample_commands import run, run_json
from tarsus.errors import InputError, MissingDataError, TarsusError
from tarsus.export import to_mjcf, to_urdf
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import centre_of_mass, total_mass
from tarsus.robot.file import list_robots, load_robot
from tarsus.robot.robot import JOINTS
from tarsus.simulation.robot_model import model
from tarsus.simulation.servos.servo_table import ServoTable

WITH_MASSES = [name for name in list_robots() if load_robot(name).has_masses]


def random_angles(robot, seed=0):
    limits = np.asarray(robot.limits)
    return np.random.default_rng(seed).uniform(limits[..., 0], limits[..., 1])


def in_pinocchio(robot, angles):
    """The model, and its data with the joints at these angles."""
    built = pin.buildModelFromXML(to_urdf(robot), pin.JointModelFreeFlyer())
    data, q = built.createData(), pin.neutral(built)
    for leg, name in enumerate(robot.leg_names):
        for joint, kind in enumerate(JOINTS):
            number = built.getJointId(f"{name.replace(' ', '_')}_{kind}")
            q[built.joints[number].idx_q] = angles[leg, joint]
    pin.forwardKinematics(built, data, q)
    pin.updateFramePlacements(built, data)
    pin.centerOfMass(built, data, q)
    return built, data, q


def feet_of(robot, built, data):
    names = [f"{'_'.join(leg.split())}_foot" for leg in robot.leg_names]
    return [data.oMf[built.getFrameId(name, pin.BODY)].translation for name in names]


@pytest.mark.parametrize("name", WITH_MASSES)
def test_a_urdf_is_the_robot_in_pinocchio(name):
    robot = load_robot(name)
    angles = random_angles(robot)
    built, data, _ = in_pinocchio(robot, angles)
    points = np.asarray(forward_kinematics(robot, angles))
    feet = [
        data.oMf[built.getFrameId(f"{leg.replace(' ', '_')}_foot", pin.BODY)].translation for leg in robot.leg_names
    ]
    np.testing.assert_allclose(feet, points[:, 3], atol=1e-12)
    assert pin.computeTotalMass(built) == pytest.approx(float(total_mass(robot)), rel=1e-12)
    np.testing.assert_allclose(data.com[0], centre_of_mass(robot, angles), atol=1e-12)
    limits = np.stack([built.lowerPositionLimit[7:], built.upperPositionLimit[7:]], axis=-1)
    np.testing.assert_array_equal(np.sort(limits, axis=0), np.sort(robot.limits.reshape(-1, 2), axis=0))


def moments_of(link):
    inertia = link.find("inertial/inertia")
    return np.linalg.eigvalsh([[float(inertia.get("i" + "".join(sorted(a + b)))) for a in "xyz"] for b in "xyz"])


@pytest.mark.parametrize("name", WITH_MASSES)
def test_every_link_of_a_urdf_has_an_inertia_that_exists_and_every_foot_a_shape(name):
    """Engines give links without inertia a mass of their own, Bullet 1 kg; feet without shapes sink into the ground."""
    robot, root = load_robot(name), ET.fromstring(to_urdf(load_robot(name)))
    links = {link.get("name"): link for link in root.iter("link")}
    assert len(links) == 1 + 4 * robot.legs
    for link in links.values():
        moments = moments_of(link)
        assert 0 < moments[0] <= moments[2] <= moments[0] + moments[1] + 1e-15
        assert float(link.find("inertial/mass").get("value")) > 0
    for leg, tibia in zip(robot.leg_names, robot.tibia, strict=True):
        (shape,) = links["_".join([*leg.split(), "tibia"])].findall("collision")
        assert float(shape.find("origin").get("xyz").split()[0]) == pytest.approx(float(tibia))


@pytest.mark.parametrize("centre", [-10.0, -1.5, -0.45, 0.078, 0.7, 10.0])
def test_a_centre_of_mass_far_from_the_foot_leaves_every_link_an_inertia_that_exists(centre):
    strider = load_robot("strider")
    robot = strider.replace(link_com=np.append(strider.link_com[:, :2], np.full((6, 1), centre), axis=1))
    for link in ET.fromstring(to_urdf(robot)).iter("link"):
        moments = moments_of(link)
        assert 0 < moments[0] <= moments[2] <= (moments[0] + moments[1]) * (1 + 1e-9)
    angles = random_angles(robot)
    built, data, _ = in_pinocchio(robot, angles)
    np.testing.assert_allclose(data.com[0], centre_of_mass(robot, angles), atol=1e-12)
    assert pin.computeTotalMass(built) == pytest.approx(float(total_mass(robot)), rel=1e-12)


@pytest.mark.parametrize("name", ["strider", "phantomx"])
def test_urdf_and_physics_have_the_same_mass_matrix(name):
    """Against the model that is built for MuJoCo, by another library's algorithm."""
    robot = load_robot(name)
    angles = random_angles(robot, 1)
    built, data, q = in_pinocchio(robot, angles)
    ours = model(robot, servos="ideal").compile()
    state = mujoco.MjData(ours)
    state.qpos[:7] = [0, 0, 0, 1, 0, 0, 0]
    state.qpos[7:] = angles.ravel()
    mujoco.mj_forward(ours, state)
    full = np.empty((ours.nv, ours.nv))
    for column, unit in zip(full.T, np.eye(ours.nv), strict=True):
        product = np.empty(ours.nv)
        mujoco.mj_mulM(ours, state, product, unit)
        column[:] = product
    order = [
        built.joints[built.getJointId(f"{leg.replace(' ', '_')}_{kind}")].idx_v
        for leg in robot.leg_names
        for kind in JOINTS
    ]
    theirs = pin.crba(built, data, q)
    theirs = np.triu(theirs) + np.triu(theirs, 1).T
    joints = full[6:, 6:] - np.diag(ours.dof_armature[6:])
    np.testing.assert_allclose(joints, theirs[np.ix_(order, order)], atol=1e-12)


def test_a_urdf_loads_in_mujoco():
    robot = load_robot("strider")
    spec = mujoco.MjSpec.from_string(to_urdf(robot))
    spec.body("body").add_freejoint()
    built = spec.compile()
    assert built.nq == 7 + 18
    assert built.body_subtreemass[0] == pytest.approx(float(total_mass(robot)))
    state, angles = mujoco.MjData(built), random_angles(robot, 2)
    for leg, name in enumerate(robot.leg_names):
        for joint, kind in enumerate(JOINTS):
            state.joint(f"{name.replace(' ', '_')}_{kind}").qpos = angles[leg, joint]
    mujoco.mj_kinematics(built, state)
    feet = [state.body(f"{name.replace(' ', '_')}_foot").xpos for name in robot.leg_names]
    np.testing.assert_allclose(feet, np.asarray(forward_kinematics(robot, angles))[:, 3], atol=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_robots_of_any_number_of_legs_are_exported(seed):
    robot = random_robot(np.random.default_rng(seed))
    if not robot.has_masses:
        robot = robot.replace(body_mass=1.0, link_mass=np.full((robot.legs, 3), 0.05), link_com=robot.link_com)
    angles = random_angles(robot, seed)
    built, data, _ = in_pinocchio(robot, angles)
    feet = [
        data.oMf[built.getFrameId(f"{'_'.join(leg.split())}_foot", pin.BODY)].translation for leg in robot.leg_names
    ]
    np.testing.assert_allclose(feet, np.asarray(forward_kinematics(robot, angles))[:, 3], atol=1e-12)


@pytest.mark.parametrize("servos", ["catalogue", "ideal"])
def test_an_mjcf_file_stands_under_its_own_actuators(servos):
    robot = load_robot("strider")
    built = mujoco.MjModel.from_xml_string(to_mjcf(robot, servos=servos))
    state = mujoco.MjData(built)
    assert built.body_subtreemass[0] == pytest.approx(float(total_mass(robot)))
    np.testing.assert_allclose(built.actuator_gainprm[:, 0], ServoTable.of(robot, servos).stiffness, rtol=1e-4)
    controller = tarsus.RobotController(robot)
    state.qpos[2] = controller.output.body.position[2] + 0.01
    state.qpos[7:] = state.ctrl[:] = controller.output.angles.ravel()
    for _ in range(1000):
        mujoco.mj_step(built, state)
    assert state.qpos[2] == pytest.approx(controller.output.body.position[2], abs=0.01)
    assert np.abs(state.qpos[7:] - state.ctrl).max() < np.radians(4)
    limited = built.actuator_forcelimited.astype(bool)
    assert limited.all() == (servos == "catalogue")


def test_what_cannot_be_exported_is_refused():
    robot = load_robot("mithi")
    with pytest.raises(MissingDataError, match="mass_kg"):
        to_urdf(robot)
    with pytest.raises(MissingDataError, match="mass_kg"):
        to_mjcf(robot)
    strider = load_robot("strider")
    with pytest.raises(InputError, match="is a batch of designs"):
        to_urdf(tarsus.stack_robots([strider, strider]))


@pytest.mark.parametrize("name", ["my--robot", "robot-", "a&<b>", "größe"])
def test_any_name_of_a_robot_leaves_a_urdf_well_formed(name):
    root = ET.fromstring(to_urdf(load_robot("strider").replace(name=name)))
    assert root.get("name") == name


@pytest.mark.parametrize("name", ["front_left", "front  left"])
def test_legs_whose_links_would_have_the_same_name_are_refused(name):
    names = load_robot("strider").leg_names
    robot = load_robot("strider").replace(leg_names=(names[0], name, *names[2:]))
    with pytest.raises(InputError, match=f"legs 'front left' and '{name}' would both have the link front_left_coxa"):
        to_urdf(robot)
    assert mujoco.MjModel.from_xml_string(to_mjcf(robot)).njnt == 1 + 18


def test_the_command_writes_a_file_or_prints_it(tmp_path):
    path = tmp_path / "strider.urdf"
    assert run("export", "urdf", "strider", "--out", path).output == f"wrote {path}\n"
    assert path.read_text() == to_urdf(load_robot("strider"))
    assert run("export", "urdf", "strider").output == path.read_text()
    assert run_json("export", "urdf", "strider")[1]["document"] == path.read_text()
    assert run_json("export", "mjcf", "strider", "--out", path)[1] == {
        "robot": "strider",
        "format": "mjcf",
        "file": str(path),
    }
    assert "<mujoco model=" in run("export", "mjcf", "strider", "--servos", "ideal").output
    result = run("export", "urdf", "strider", "--out", tmp_path / "missing" / "strider.urdf")
    assert result.exit_code == 2
    assert "can't be written: No such file" in result.output
    assert run("export", "urdf", "mithi").exit_code == 1


def test_without_mujoco_the_extra_is_named(monkeypatch):
    monkeypatch.setattr("tarsus.simulation.engine.import_module", _missing)
    assert to_urdf(load_robot("strider")).startswith("<?xml")
    with pytest.raises(TarsusError, match=r"tarsus\[sim\]"):
        to_mjcf(load_robot("strider"))


def _missing(name):
    raise ImportError(name)


def test_a_link_without_length_has_no_shape():
    robot = load_robot("strider").replace(coxa=np.zeros(6), link_com=load_robot("strider").link_com * [0, 1, 1])
    text = to_urdf(robot)
    assert text.count("<cylinder") == 12
    assert pin.buildModelFromXML(text).nq == 18


def test_unknown_servos_are_named_in_the_file():
    robot = load_robot("strider")
    bare = robot.replace(servos=((None,) * 3,) * 6)
    assert "Unknown servos have an effort of 100 N m." in to_urdf(bare)
    assert 'effort="100.0"' in to_urdf(bare)
    assert "Unknown servos" not in to_urdf(robot)
