"""Commands of a felt walk that compensate for the deflection of loaded joints."""

import numpy as np
import pytest

import tarsus
from tarsus.control.pose import deflection_compensation
from tarsus.control.pose.deflection_compensation import _SHARE as SHARE
from tarsus.control.pose.deflection_compensation import DeflectionCompensation
from tarsus.control.readings import ValidReadings
from tarsus.control.walk.joint_solver import JointSolver
from tarsus.control.walk.state import GaitState
from tarsus.simulation import Sensor, SensorSuite, SimulatedPlant
from tarsus.simulation.sensors.suite import FootSwitch

ROBOT = tarsus.load_robot("phantomx")
ANGLES = np.array(tarsus.WalkController(ROBOT).angles)
# Three feet: equilibrium alone determines what they bear.
LOADS = np.array([6.0, 0.0, 9.0, 0.0, 12.0, 0.0])
# What vertical forces turn the joints: an independent reference.
_FORCES = np.c_[np.zeros((6, 2)), LOADS]
_TORQUES = np.einsum("lij,li->lj", np.asarray(tarsus.leg_jacobian(ROBOT, ANGLES)), _FORCES)
DEFLECTION = _TORQUES / tarsus.JointSprings.of(ROBOT).stiffness


def readings(softness, forces=_FORCES):
    measured = tuple(map(tuple, (ANGLES + softness * DEFLECTION).tolist()))
    return ValidReadings(joint_angles=measured, forces=tuple(map(tuple, forces.tolist())))


NOTHING_BEARS = [False] * 6


def stepped(valid, *, robot=ROBOT, ticks=800, compensation=None, slope=0.0, bears=NOTHING_BEARS):
    compensation = DeflectionCompensation(robot) if compensation is None else compensation
    for _ in range(ticks):
        compensation.step(valid, ANGLES, 0.01, slope=slope, bears=bears)
    return compensation


@pytest.mark.parametrize("softness", [0.0, 0.4, 1.0])
def test_it_learns_how_soft_servos_are_and_adds_a_share_of_what_vertical_forces_turn_them(softness):
    found = stepped(readings(softness))
    assert found.softness == pytest.approx(softness, abs=1e-6)
    np.testing.assert_allclose(found.offsets, -SHARE * softness * DEFLECTION, atol=1e-6)
    # As much lower as the foot goes that bears most.
    down = np.einsum("lij,lj->li", np.asarray(tarsus.leg_jacobian(ROBOT, ANGLES)), found.offsets)[:, 2]
    assert found.lowered == pytest.approx(-down.min(), abs=1e-6)


@pytest.mark.parametrize("softness", [0.4, 0.9])
def test_softness_is_learnt_by_the_whole_force_on_feet_that_lean_against_each_other(softness):
    inward = np.exp(1j * (ROBOT.mount_yaw + ANGLES[:, 0] + np.pi))
    forces = np.c_[0.4 * LOADS * inward.real, 0.4 * LOADS * inward.imag, LOADS]
    jacobian = np.asarray(tarsus.leg_jacobian(ROBOT, ANGLES))
    turned = np.einsum("lij,li->lj", jacobian, forces) / tarsus.JointSprings.of(ROBOT).stiffness
    measured = tuple(map(tuple, (ANGLES + softness * turned).tolist()))
    found = stepped(readings(0.0, forces)._replace(joint_angles=measured))
    assert found.softness == pytest.approx(softness, abs=1e-6)
    # What is added is that of the vertical forces: it takes the feet's lean away.
    np.testing.assert_allclose(found.offsets, -SHARE * softness * DEFLECTION, atol=1e-6)


def turned_by(loads):
    forces = np.c_[np.zeros((6, 2)), loads]
    torques = np.einsum("lij,li->lj", np.asarray(tarsus.leg_jacobian(ROBOT, ANGLES)), forces)
    return torques / tarsus.JointSprings.of(ROBOT).stiffness


def test_forces_with_which_feet_only_press_against_each_other_add_nothing(monkeypatch):
    monkeypatch.setattr(deflection_compensation, "_BEARS", 0.01)
    feet = np.array(tarsus.forward_kinematics(ROBOT, ANGLES))[:, 3, :2]
    loads = np.array([5.0, 6.0, 4.0, 5.0, 7.0, 6.0])
    equilibrium = np.vstack([np.ones(6), feet.T])
    internal = np.linalg.svd(equilibrium)[2][3:]  # without a sum or a moment
    np.testing.assert_allclose(equilibrium @ internal.T, 0.0, atol=1e-12)
    expected = -SHARE * 0.6 * turned_by(loads - internal.T @ (internal @ loads))
    for pressed in (loads, loads + 1.5 * internal[0], loads - internal[1] + 2 * internal[2]):
        measured = tuple(map(tuple, (ANGLES + 0.6 * turned_by(pressed)).tolist()))
        valid = readings(0.0, np.c_[np.zeros((6, 2)), pressed])._replace(joint_angles=measured)
        np.testing.assert_allclose(stepped(valid).offsets, expected, atol=1e-6)


def test_two_feet_that_are_pressed_down_in_turn_share_their_load():
    pressed = readings(1.0)._replace(forces=((0.0, 0.0, 8.0), (0.0, 0.0, 4.0), *[None] * 4))
    # Taken as they are measured, each would be pressed down further, until the other is.
    shared = turned_by(np.array([6.0, 6.0, 0.0, 0.0, 0.0, 0.0]))
    found = stepped(pressed)
    np.testing.assert_allclose(found.offsets, -SHARE * found.softness * shared, atol=1e-6)
    assert found.softness > 0.1


@pytest.mark.no_cover
@pytest.mark.parametrize("servos", ["ideal", "catalogue"])
def test_in_physics_the_feet_of_a_wave_walk_slide_little(servos):
    """Feet that had lost contact searched at once and lifted the others off; loaded ones were pressed further down."""
    wave = tarsus.Gait.named("wave")
    plant = SimulatedPlant(ROBOT, sensors="ideal", servos=servos)
    controller = tarsus.RobotController(ROBOT, wave)
    speed = 0.5 * tarsus.WalkController(ROBOT, wave).top_speed((1, 0, 0))
    output, slip, start = controller.output, 0.0, 0.0
    plant.start(output)
    for tick in range(1000):
        output = controller.step((speed, 0.0, 0.0), 0.01, plant.step(output, 0.01))
        if tick >= 400:
            start = start or plant.state.body.position[0]
            slip += plant.state.slip_speeds.mean() * 0.01
    way = plant.state.body.position[0] - start
    assert way == pytest.approx(speed * 6.0, rel=0.03)
    assert slip < 0.05 * way  # about 0.1 before
    assert abs(np.degrees(plant.state.body.rpy[:2])).max() < 0.6


def test_feet_that_bear_nothing_add_nothing():
    assert not stepped(readings(1.0, np.zeros((6, 3))), ticks=2).offsets.any()


def test_softness_is_within_its_bounds():
    assert stepped(readings(3.0)).softness == 1.0
    assert stepped(readings(-1.0)).softness == 0.0


def test_it_follows_the_load_slowly_and_pushes_no_foot_that_is_pulled():
    found = stepped(readings(1.0))
    before = found.offsets
    stepped(readings(1.0, 5 * _FORCES), ticks=1, compensation=found)
    assert np.abs(found.offsets - before).max() < 4 * SHARE * 0.31 * np.abs(DEFLECTION).max()
    stepped(readings(0.0, -_FORCES), compensation=found)
    assert np.abs(found.offsets).max() < 1e-9


def test_without_loads_angles_or_known_servos_nothing_is_added():
    valid = readings(1.0)
    assert stepped(valid._replace(joint_angles=None), ticks=3).offsets is None
    assert not stepped(valid._replace(forces=None), ticks=3).offsets.any()
    for missing in ("forces", "joint_angles"):
        # What has been added goes back.
        found = stepped(valid)
        assert np.abs(stepped(valid._replace(**{missing: None}), compensation=found).offsets).max() < 1e-9
        assert found.softness == pytest.approx(1.0, abs=1e-6)
    unknown = ROBOT.replace(servos=((None,) * 3,) * 6)
    assert stepped(valid, robot=unknown, ticks=3).offsets is None


def needed_friction(robot, angles):
    """Force that brings the foot of a loaded leg back, over the load: an independent reference."""
    needed = []
    for jacobian, stiffness in zip(
        np.asarray(tarsus.leg_jacobian(robot, angles)), tarsus.JointSprings.of(robot).stiffness, strict=True
    ):
        outward = jacobian[:2, 0] @ [[0.0, -1.0], [1.0, 0.0]]
        rows = np.array([-outward / np.linalg.norm(outward) @ jacobian[:2, 1:], jacobian[2, 1:]])
        compliance = rows / stiffness[1:] @ rows.T
        needed.append(abs(compliance[0, 1] / compliance[0, 0]))
    return max(needed)


@pytest.mark.parametrize("name", ["strider", "phantomx", "makeyourpet", "phantomx-mk2", "phoenix", "ch3r"])
def test_legs_that_friction_holds_are_left_alone(name):
    robot = tarsus.load_robot(name)
    angles = np.array(tarsus.WalkController(robot).angles)
    compensation, valid = DeflectionCompensation(robot), readings(1.0)
    compensation.step(
        valid._replace(joint_angles=tuple(map(tuple, angles.tolist()))), angles, 0.01, slope=0.0, bears=NOTHING_BEARS
    )
    assert (compensation.offsets is None) == (needed_friction(robot, angles) < 0.8)


def test_legs_that_friction_holds_on_level_ground_are_compensated_on_a_slope_and_left_alone_after_it():
    robot = tarsus.load_robot("strider")
    angles = np.array(tarsus.WalkController(robot).angles)
    measured = tuple(map(tuple, (angles - [0.0, -0.05, 0.0]).tolist()))
    found, valid = DeflectionCompensation(robot), readings(0.0)._replace(joint_angles=measured)
    found.step(valid, angles, 0.01, slope=0.0, bears=NOTHING_BEARS)
    assert found.offsets is None
    for _ in range(300):
        found.step(valid, angles, 0.01, slope=0.2, bears=NOTHING_BEARS)
    assert np.abs(found.offsets).max() > 0.005
    for _ in range(300):
        found.step(valid, angles, 0.01, slope=0.0, bears=NOTHING_BEARS)
    assert np.abs(found.offsets).max() < 1e-3


def test_angles_are_with_the_offsets_and_feet_without():
    solver, walk = JointSolver(ROBOT), tarsus.WalkController(ROBOT)
    state: GaitState = walk._tick.gait
    plain = solver.angles(state)
    stepped(readings(0.5), compensation=solver.deflection)
    angles = solver.angles(state)
    np.testing.assert_allclose(angles, plain + solver.deflection.offsets, atol=1e-12)
    np.testing.assert_allclose(solver.feet(state, angles), walk.feet, atol=1e-9)
    assert not angles.flags.writeable


def equilibrium(bears, robot):
    """Loads of three feet that carry the robot: three equations."""
    feet = np.array(tarsus.forward_kinematics(robot, ANGLES))[:, 3, :2]
    centre, loads = np.array(tarsus.centre_of_mass(robot, ANGLES))[:2], np.zeros(6)
    weight = float(tarsus.total_mass(robot)) * 9.80665
    loads[bears] = np.linalg.solve(np.vstack([np.ones(3), feet[bears].T]), weight * np.array([1.0, *centre]))
    return loads


@pytest.mark.parametrize(("softness", "side"), [(0.0, 0.0), (0.5, 0.02), (1.0, 0.0)])
def test_without_forces_the_feet_in_contact_share_the_weight(softness, side):
    bears, robot = np.array([True, False] * 3), ROBOT.replace(femur_axis_offset=[[side, 0.0]] * 6)
    turned = turned_by(equilibrium(bears, robot))
    measured = tuple(map(tuple, (ANGLES + softness * turned).tolist()))
    valid = ValidReadings(joint_angles=measured)
    found = stepped(valid, robot=robot, bears=bears.tolist())
    assert found.softness == pytest.approx(softness, abs=1e-6)
    np.testing.assert_allclose(found.offsets, -SHARE * softness * turned, atol=1e-6)
    # Feet that leave the ground give their load back, and so do legs whose joint angles are not measured any more.
    assert np.abs(stepped(valid, robot=robot, compensation=found).offsets).max() < 1e-9
    again = stepped(valid, robot=robot, bears=bears.tolist())
    unread = valid._replace(joint_angles=(None, *measured[1:]))
    assert np.abs(stepped(unread, robot=robot, bears=bears.tolist(), compensation=again).offsets[0]).max() < 1e-9


def test_a_robot_without_masses_has_no_loads_by_contacts():
    robot = ROBOT.replace(body_mass=None, link_mass=None)
    valid = readings(1.0)._replace(forces=None)
    assert stepped(valid, robot=robot, ticks=3, bears=[True] * 6).offsets is None


def slip(**channels):
    """Slip of a felt walk in physics [m/m]."""
    robot = tarsus.load_robot("makeyourpet")
    suite = SensorSuite(contacts=FootSwitch(), attitude=Sensor(), **channels)
    plant, controller = SimulatedPlant(robot, sensors=suite), tarsus.RobotController(robot)
    output, slid, way = controller.output, 0.0, 0.0
    plant.start(output)
    for _ in range(500):
        output = controller.step((0.1, 0.0, 0.0), 0.01, plant.step(output, 0.01))
        slid, way = slid + 0.01 * float(plant.state.slip_speeds.mean()), float(plant.state.body.position[0])
    return slid / way


@pytest.mark.no_cover
def test_feet_of_soft_legs_slip_less_in_physics():
    free = slip()
    assert slip(joint_angles=Sensor()) < 0.6 * free
    assert slip(joint_angles=Sensor(), forces=Sensor()) < 0.6 * free
