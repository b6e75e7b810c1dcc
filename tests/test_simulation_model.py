"""Robots as models of rigid bodies: masses, poses and limits are those of the robot; what cannot be is refused."""

import importlib
import itertools
import subprocess
import sys
from types import SimpleNamespace

import mujoco
import numpy as np
import pytest

import tarsus
from robots import RING, plain_hexapod, random_angles, random_robot
from tarsus.errors import InputError, MissingDataError, TarsusError
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import centre_of_mass, total_mass
from tarsus.kinematics.pose import Pose
from tarsus.robot.file import list_robots, load_robot
from tarsus.robot.robot import JOINTS
from tarsus.simulation import engine, model, model_assumptions
from tarsus.simulation.servos.actuators import ACTUATORS
from tarsus.simulation.terrain import Flat, Step

WEIGHED = [name for name in list_robots() if load_robot(name).has_masses]


def with_masses(robot, rng):
    """The robot with random masses and centres of mass."""
    legs = robot.legs
    return robot.replace(
        body_mass=rng.uniform(0.5, 3),
        body_com=rng.uniform(-0.02, 0.02, 3),
        body_size=rng.uniform(0.05, 0.3, 3) if rng.random() > 0.5 else None,
        link_mass=rng.uniform(0.01, 0.2, (legs, 3)),
        link_com=rng.uniform(0, 0.1, (legs, 3)),
    )


def compiled(robot, **options):
    made = model(robot, servos="ideal", **options).compile()
    return made, mujoco.MjData(made)


def assert_same_kinematics(robot, rng):
    made, data = compiled(robot)
    angles = random_angles(rng, robot)
    body = Pose.from_rpy(*rng.uniform(-1, 1, 3), rng.uniform(-1, 1, 3))
    data.qpos[:3] = body.position
    mujoco.mju_mat2Quat(data.qpos[3:7], np.asarray(body.rotation).ravel())
    data.qpos[7:] = angles.ravel()
    mujoco.mj_forward(made, data)
    points = forward_kinematics(robot, angles)
    expected = body @ points
    heading = robot.mount_yaw + angles[:, 0]
    for leg, joint in itertools.product(range(robot.legs), range(3)):
        link = data.body(f"{robot.leg_names[leg]} {JOINTS[joint]}")
        assert link.xpos == pytest.approx(expected[leg, joint], abs=1e-12)
        slope = angles[leg, 1 : joint + 1].sum()
        c, s = np.cos([heading[leg], slope]), np.sin([heading[leg], slope])
        rotation = np.array([[c[0] * c[1], -s[0], -c[0] * s[1]], [s[0] * c[1], c[0], -s[0] * s[1]], [s[1], 0, c[1]]])
        assert link.xmat.reshape(3, 3) == pytest.approx(body.rotation @ rotation, abs=1e-12)
    feet = np.array([data.geom(f"{name} foot").xpos for name in robot.leg_names])
    assert feet == pytest.approx(expected[:, 3], abs=1e-12)
    assert made.body_subtreemass[1] == pytest.approx(float(total_mass(robot)), rel=1e-14)
    assert data.subtree_com[1] == pytest.approx(body @ centre_of_mass(robot, angles), abs=1e-12)


@pytest.mark.parametrize("name", WEIGHED)
def test_links_and_masses_of_every_preset_are_where_the_kinematics_puts_them(name):
    rng = np.random.default_rng(1)
    for _ in range(3):
        assert_same_kinematics(load_robot(name), rng)


@pytest.mark.parametrize("seed", range(6))
def test_links_and_masses_of_random_robots_are_where_the_kinematics_puts_them(seed):
    rng = np.random.default_rng(seed)
    assert_same_kinematics(with_masses(random_robot(rng, legs=4 + seed % 4), rng), rng)


def test_there_are_presets_with_masses():
    assert {"strider", "phantomx"} <= set(WEIGHED)


def test_a_femur_axis_beside_the_coxa_axis_turns_the_coxa_links_inertia():
    robot = with_masses(plain_hexapod(), np.random.default_rng(0))
    robot = robot.replace(coxa=np.zeros(6), femur_axis_offset=np.tile([0.03, 0.0], (6, 1)), body_size=None)
    made, _ = compiled(robot)
    link = made.body(f"{RING[0]} coxa")
    assert link.ipos == pytest.approx([0, robot.link_com[0, 0], 0], abs=1e-15)
    axes = np.empty(9)
    mujoco.mju_quat2Mat(axes, link.iquat)
    # A long box has its smallest moment of inertia about its length, which is along y here.
    assert np.abs(axes.reshape(3, 3)[:, int(np.argmin(link.inertia))]) == pytest.approx([0, 1, 0], abs=1e-9)


@pytest.mark.parametrize(
    ("step", "turned"),
    [((1, 0, 0), (1, 0, 0)), ((0, 0, 1), (0, 0, 1)), ((-1, 0, 0), (-1, 0, 0)), ((0, 0, 0), (1, 0, 0))],
)
def test_the_inertia_of_a_link_is_turned_along_it(step, turned):
    from tarsus.simulation.robot_model import _quaternion_from_x

    found = np.empty(3)
    mujoco.mju_rotVecQuat(found, np.array([1.0, 0, 0]), _quaternion_from_x(np.array(step, dtype=float)))
    assert found == pytest.approx(turned, abs=1e-12)


def test_joint_limits_feet_and_body_are_the_robots():
    robot = load_robot("strider")
    made, data = compiled(robot)
    ranges = np.array([made.joint(f"{name} {joint}").range for name in robot.leg_names for joint in JOINTS])
    assert ranges.reshape(6, 3, 2) == pytest.approx(robot.limits)
    assert [made.geom(f"{name} foot").size[0] for name in robot.leg_names] == pytest.approx(robot.foot_radius)
    assert made.geom("body").size == pytest.approx(robot.body_size / 2)
    joints = [f"{n} {j}" for n in robot.leg_names for j in JOINTS]
    assert [made.joint(i + 1).name for i in range(18)] == joints
    assert [made.actuator(i).name for i in range(54)] == [f"{joint} {kind}" for joint in joints for kind in ACTUATORS]
    assert [made.sensor(i).name for i in range(7)] == [*(f"{n} foot" for n in robot.leg_names), "body"]
    assert made.nv == 24
    mujoco.mj_forward(made, data)


def test_a_body_without_a_box_is_the_polygon_of_its_coxa_axes():
    robot = with_masses(plain_hexapod(), np.random.default_rng(2)).replace(body_size=None, foot_radius=None)
    made, data = compiled(robot)
    data.qpos[2] = -0.5
    mujoco.mj_forward(made, data)
    deepest = min(c.dist for c in data.contact if "body" in [made.geom(g).name for g in c.geom])
    assert deepest == pytest.approx(-0.501, abs=1e-9)
    lines = "\n".join(model_assumptions(robot))
    assert "polygon of the coxa axes" in lines
    assert "foot radius where it is 0" in lines
    assert "polygon" not in "\n".join(model_assumptions(load_robot("strider")))


def test_the_terrain_is_in_the_model_and_its_friction_prevails():
    robot = load_robot("strider")
    made, data = compiled(robot, terrain=Step(rise=0.02, start=-5.0, friction=0.3))
    data.qpos[2] = 0.03
    mujoco.mj_forward(made, data)
    assert data.ncon
    assert data.contact.friction[:, 0] == pytest.approx(0.3)
    assert made.opt.timestep == 0.002


def test_a_coxa_without_length_has_no_geom():
    robot = load_robot("strider").replace(coxa=np.zeros(6))
    made, _ = compiled(robot)
    names = {made.geom(i).name for i in range(made.ngeom)}
    assert "front left coxa" not in names
    assert {"front left femur", "front left tibia", "front left foot"} <= names
    assert made.body("front left coxa").ipos == pytest.approx(0.0)


def test_a_fixed_joint_can_be_simulated():
    limits = np.array(load_robot("strider").limits)
    limits[0, 0] = 0.1
    made, _ = compiled(load_robot("strider").replace(limits=limits))
    assert made.joint("front left coxa").range == pytest.approx([0.1, 0.1], abs=2e-6)


def test_what_cannot_be_simulated_is_refused():
    robot = load_robot("strider")
    with pytest.raises(MissingDataError, match="mass_kg"):
        model(load_robot("mithi"), servos="ideal")
    with pytest.raises(InputError, match="batch of designs"):
        model(robot.replace(femur=np.full((2, 6), 0.1)))
    masses = np.array(robot.link_mass)
    masses[4, 2] = 0.0
    with pytest.raises(InputError, match=r"mass of middle right tibia is 0 kg; physics needs at least 0\.0001 kg"):
        model(robot.replace(link_mass=masses))


def test_without_the_engine_the_error_says_what_to_install(monkeypatch):
    def missing(name):
        raise ImportError(name)

    monkeypatch.setattr(engine, "import_module", missing)
    with pytest.raises(TarsusError, match=r"pip install 'tarsus\[sim\]'"):
        model(load_robot("strider"))


def test_the_faulty_version_of_the_engine_is_refused(monkeypatch):
    monkeypatch.setattr(engine, "import_module", lambda name: SimpleNamespace(__version__="4.0.0"))
    with pytest.raises(TarsusError, match=r"MuJoCo 4\.0\.0 computes contacts wrongly"):
        model(load_robot("strider"))


def test_the_package_is_lazy_and_its_names_are_there():
    code = (
        "import sys, tarsus; s = tarsus.simulation; s.terrain.Flat(); s.SimulatedPlant; s.SensorSuite.named('hobby')\n"
        "print('mujoco' in sys.modules)"
    )
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert answer.stdout.strip() == "False"
    assert tarsus.simulation is importlib.import_module("tarsus.simulation")
    assert "simulation" in dir(tarsus)
    names = dir(tarsus.simulation)
    assert names == sorted(tarsus.simulation.__all__)
    assert all(getattr(tarsus.simulation, name).__doc__ for name in names)
    with pytest.raises(AttributeError, match="no attribute 'Plant'"):
        _ = tarsus.simulation.Plant
    assert tarsus.simulation.__getattr__("terrain") is tarsus.simulation.terrain
    assert isinstance(Flat(), tarsus.simulation.terrain.Terrain)
    assert tarsus.simulation.model is model
