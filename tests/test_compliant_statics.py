"""Compliant statics: equilibrium, friction, its limits of stiff and slippery, and agreement with MuJoCo."""

import dataclasses

import mujoco
import numpy as np
import pytest

from tarsus.errors import InputError, MissingDataError
from tarsus.gait.gait import Gait
from tarsus.gait.motion import Motion
from tarsus.gait.path import straight_path
from tarsus.gait.plan import plan_walk
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import total_mass
from tarsus.kinematics.pose import Pose
from tarsus.load.compliant.applied_loads import applied_loads
from tarsus.load.compliant.balance import Demand, Past
from tarsus.load.compliant.compliant_loads import compliant_loads
from tarsus.load.compliant.decisive_loads import decisive_loads
from tarsus.load.compliant.equilibrium import Compliant
from tarsus.load.compliant.foot_contact import POINT_FOOT, FootContact
from tarsus.load.compliant.for_loads import compliant_or_missing
from tarsus.load.compliant.friction import friction_fraction
from tarsus.load.compliant.history import TOLERANCE
from tarsus.load.compliant.joint_springs import JointSprings
from tarsus.load.compliant.leg_derivatives import LegDerivatives
from tarsus.load.compliant.offset import moved, rotated, turned
from tarsus.load.compliant.tangent import contact_jacobian, newton_step
from tarsus.load.compliant.vibration import Vibration, rigid_inertia
from tarsus.load.loads import joint_loads
from tarsus.load.payload import Payload
from tarsus.load.sizing import size_servos
from tarsus.load.torque import joint_torques
from tarsus.robot.file import load_robot
from tarsus.simulation import ServoModel, SimulatedPlant
from tarsus.simulation.truth.traced_plant import play

STRIDER = load_robot("strider")
PHANTOMX = load_robot("phantomx")
RATE = 50.0
NO_CREEP = FootContact(creep_time=np.inf)
WEIGHT = float(total_mass(STRIDER)) * 9.80665


def walk(robot=STRIDER, gait="tripod", distance=0.12, **options):
    return plan_walk(robot, Gait.named(gait), straight_path(distance), **options)


def standing(robot=STRIDER, *, samples=3):
    """A robot that stands in its default stance."""
    motion = walk(robot)
    first = np.zeros(samples, dtype=int)
    return Motion(
        **{
            field.name: getattr(motion, field.name)
            for field in dataclasses.fields(Motion)
            if field.name not in ("time", "body", "feet", "contacts", "angles", "reach")
        },
        time=0.02 * np.arange(samples),
        body=motion.body[first],
        feet=motion.feet[first],
        contacts=motion.contacts[first],
        angles=motion.angles[first],
        reach=motion.reach[first],
    )


@pytest.fixture(scope="module")
def strider_walk():
    motion = walk()
    return motion, compliant_loads(STRIDER, motion, springs=JointSprings.uniform(STRIDER, 100.0, damping=1.0))


def test_derivatives_of_the_legs_are_those_of_forward_kinematics():
    robot = STRIDER.replace(femur_axis_offset=np.tile([0.01, -0.02], (6, 1)))
    rng = np.random.default_rng(1)
    angles = rng.uniform(-1, 1, (6, 3))
    radius = np.full(6, 0.008)
    legs, body = LegDerivatives(robot, radius), Pose.from_rpy(0.1, -0.2, 0.3)
    points = legs.at(angles, body.rotation)
    expected = body @ forward_kinematics(robot, angles)
    np.testing.assert_allclose(points[:, 0, :9].reshape(6, 3, 3), expected[:, 1:], atol=1e-15)
    step, pairs = 1e-6, [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]
    for joint in range(3):
        turned = step * np.eye(3)[joint]
        forward, backward = (legs.at(angles + sign * turned, body.rotation)[..., :9] for sign in (1, -1))
        slope = (forward - backward) / (2 * step)
        np.testing.assert_allclose(points[:, 1 + joint, :9], slope[:, 0], atol=1e-9)
        for number, (i, j) in enumerate(pairs):
            if i == joint:
                np.testing.assert_allclose(points[:, 4 + number, :9], slope[:, 1 + j], atol=1e-9)
    # A joint moves the foot by its axis times the lever.
    axes = points[:, 1:4, 9:] / radius[:, None, None]
    moved = np.cross(axes, expected[:, 3:] - expected[:, :3])
    np.testing.assert_allclose(points[:, 1:4, 6:9], moved, atol=1e-14)


@pytest.mark.parametrize("frozen", [False, True])
def test_a_newton_step_solves_the_linearised_equations(frozen):
    """The tangent against finite differences of the residual, with feet that stick, slide and hang in the air."""
    rng = np.random.default_rng(3)
    motion = standing()
    inertia = rigid_inertia(STRIDER, motion.angles[0], Payload(0.4, (0.02, 0.01, 0.05)))
    compliant = Compliant(STRIDER, JointSprings.uniform(STRIDER, 60.0), FootContact(friction=0.3), inertia)
    loads = applied_loads(
        STRIDER,
        motion,
        np.array([0]),
        payload=Payload(0.0),
        gravity=(0, 0, -9.80665),
        inertial=False,
        rotor_inertia=np.zeros((6, 3)),
    )
    turned = Pose.from_rpy(0.002, -0.003, 0.1, (0.01, 0.02, 0.0))
    angles = motion.angles[0] + 0.002 * rng.normal(size=(6, 3))
    heights = np.sort(compliant.bottoms(turned.rotation, turned.position, angles)[:, 2])
    # Four of the six balls touch the ground.
    pose = Pose(turned.rotation, turned.position - np.array([0, 0, heights[3:5].mean()]))
    bottoms = compliant.bottoms(pose.rotation, pose.position, angles)
    contacts = bottoms + 1e-4 * rng.normal(size=(6, 3)), 0.3 * rng.normal(size=(6, 2)), np.ones(6, dtype=bool)
    past = Past(pose.rotation, pose.position, angles - 1e-3, *contacts)
    # The commanded pose is so close that inertial forces are of the size of the others.
    offset = 1e-3 * rng.normal(size=24)
    offset[3:6] = 0.0
    demand = Demand(
        targets=motion.angles[0],
        forces=np.hstack([loads.points[0].reshape(6, 9), np.zeros((6, 3))]),
        loads=np.concatenate([loads.force[0], loads.moment[0], np.zeros(18)]),
        angles=angles - offset[6:].reshape(6, 3),
        rotation=pose.rotation,
        position=pose.position - offset[:3],
        inertia=inertia,
        step=0.02,
        ahead=1e-3 * rng.normal(size=24),
        resistance=compliant.resistance(inertia, Vibration.gain(0.02)),
    )
    at = compliant.configuration(offset, past, demand)
    limit = compliant.contact.friction * at.normal if frozen else None
    balance = compliant.balance(at, demand, limit)
    assert (at.normal > 0).sum() == 4
    assert 0 < (balance.fraction[at.normal > 0] < 1).sum() < (at.normal > 0).sum()
    step = newton_step(compliant, at, balance, contact_jacobian(compliant, at), demand, frozen=frozen)
    small = 1e-5

    def residual(length):
        further = compliant.configuration(moved(at.offset, length * step), past, demand)
        return compliant.balance(further, demand, limit).residual

    now = balance.residual
    change = (residual(small) - residual(-small)) / (2 * small)
    assert np.linalg.norm(change + now) < 0.03 * np.linalg.norm(now)


def test_an_offset_moves_as_rotations_follow_each_other():
    rng = np.random.default_rng(5)
    commanded = Pose.from_rpy(0.1, 0.2, 0.3).rotation
    offset, step = 0.1 * rng.normal(size=24), 1e-4 * rng.normal(size=24)
    expected = rotated(rotated(commanded, offset[3:6]), step[3:6])
    after = rotated(commanded, moved(offset, step)[3:6])
    np.testing.assert_allclose(after, expected, atol=1e-6)
    np.testing.assert_allclose(turned(expected, rotated(commanded, offset[3:6])), step[3:6], atol=1e-11)
    np.testing.assert_allclose(after @ after.T, np.eye(3), atol=1e-15)
    # A large rotation vector is still a rotation about its own direction.
    far = rotated(np.eye(3), np.array([0.0, 0.0, 2.5]))
    np.testing.assert_allclose(far, Pose.from_rpy(yaw=2.5).rotation, atol=1e-9)


def test_every_sample_is_in_equilibrium(strider_walk):
    motion, found = strider_walk
    assert found.converged.all()
    assert found.residual.max() <= TOLERANCE * WEIGHT
    motion = walk(distance=0.03)
    quasi_static = compliant_loads(STRIDER, motion, springs=100.0, inertial=False, rate=RATE)
    np.testing.assert_allclose(
        quasi_static.forces.sum(1)[::2],
        np.tile([0, 0, WEIGHT], (len(motion.time[::2]), 1)),
        atol=5 * TOLERANCE * WEIGHT,
    )
    # The torques are those that the achieved angles and the forces require; friction acts one radius lower.
    for sample in (0, 40, len(motion.time) - 1 - (len(motion.time) - 1) % 2):
        torques, _ = joint_torques(
            STRIDER,
            quasi_static.angles[sample],
            quasi_static.body[sample],
            motion.contacts[sample],
            forces=quasi_static.forces[sample],
        )
        lever = 0.008 * np.linalg.norm(quasi_static.forces[sample, :, :2], axis=-1).max()
        np.testing.assert_allclose(quasi_static.torques[sample], torques, atol=lever + 2e-3)


def test_friction_stays_in_its_cone_and_feet_slide_only_on_it():
    friction, motion = 0.2, walk(distance=0.05)
    contact = FootContact(friction=friction, creep_time=np.inf)
    found = compliant_loads(STRIDER, motion, springs=100.0, contact=contact, rate=100.0)
    normal, tangential = found.forces[..., 2], np.linalg.norm(found.forces[..., :2], axis=-1)
    assert (normal >= 0).all()
    assert (tangential <= friction * normal * (1 + 1e-9)).all()
    slid = np.diff(found.slip, axis=0) > 1e-9
    assert slid.any()
    assert not slid.all()
    np.testing.assert_allclose(tangential[1:][slid], friction * normal[1:][slid], rtol=1e-6)


def test_sliding_is_opposed_by_friction():
    rng = np.random.default_rng(5)
    displacement, stiffness = rng.normal(size=(50, 2)), 1e4
    trial = -stiffness * displacement
    force = trial * friction_fraction(trial, np.full(50, 3.0))[:, None]
    work = (force * (displacement + force / stiffness)).sum(-1)
    assert (work <= 0).all()
    assert (np.linalg.norm(force, axis=-1) <= 3.0 + 1e-12).all()


def test_without_friction_the_forces_are_vertical_and_those_of_statics_for_three_feet():
    motion = walk(PHANTOMX, distance=0.02)
    slippery = compliant_loads(
        PHANTOMX, motion, springs=300.0, contact=FootContact(friction=1e-3), inertial=False, rate=RATE
    )
    vertical = joint_loads(PHANTOMX, motion, inertial=False)
    weight = vertical.weight
    assert np.abs(slippery.forces[..., :2]).max() < 1e-3 * weight
    three = (motion.contacts.sum(-1) == 3) & (slippery.forces[..., 2] > 0.01 * weight).sum(-1).__eq__(3)
    assert three.sum() > 20
    # The body sags by a degree: levers and load shares differ by that.
    np.testing.assert_allclose(slippery.forces[three], vertical.forces[three], atol=0.04 * weight)
    np.testing.assert_allclose(slippery.torques[three], vertical.torques[three], atol=0.06)


def test_feet_are_not_dragged_before_they_touch_down():
    """Rare samples see a foot late on the ground; what it moved in the air before must not load the legs."""
    motion = walk(distance=0.05, rate=200.0)
    springs = JointSprings.uniform(STRIDER, 100.0, damping=1.0)
    coarse, fine = (compliant_loads(STRIDER, motion, springs=springs, rate=rate) for rate in (50.0, 200.0))
    for joint, bound in ((0, 0.07), (1, 0.02), (2, 0.04)):
        rms = [np.sqrt((found.torques[::4, :, joint] ** 2).mean()) for found in (coarse, fine)]
        assert rms[0] == pytest.approx(rms[1], rel=bound)


def test_stiff_joints_follow_their_commands():
    motion = walk(distance=0.02)
    deviations = [
        np.abs(compliant_loads(STRIDER, motion, springs=stiffness, rate=RATE).angles - motion.angles).max()
        for stiffness in (50.0, 500.0)
    ]
    assert deviations[1] < 0.25 * deviations[0] < 0.03


def test_a_symmetric_stance_has_symmetric_forces():
    found = compliant_loads(STRIDER, standing(), springs=40.0, contact=NO_CREEP)
    mirrored = [5, 4, 3, 2, 1, 0]
    forces, torques = found.forces[-1], found.torques[-1]
    np.testing.assert_allclose(forces[mirrored] * [1, -1, 1], forces, atol=1e-3 * WEIGHT)
    np.testing.assert_allclose(torques[mirrored] * [-1, 1, 1], torques, atol=1e-3 * WEIGHT)
    # Legs that give way spread: the ground pushes the feet inward.
    outward = forward_kinematics(STRIDER, found.angles[-1])[:, 3, :2]
    assert ((forces[:, :2] * outward).sum(-1) < 0).all()


def test_friction_creeps_to_vertical_forces():
    motion = standing(samples=100)
    held, relaxed = (
        compliant_loads(STRIDER, motion, springs=100.0, contact=contact) for contact in (NO_CREEP, FootContact())
    )
    size = [np.linalg.norm(found.forces[:, :, :2], axis=-1).mean(-1) for found in (held, relaxed)]
    np.testing.assert_allclose(size[0], size[0][0], rtol=0.01)
    assert size[1][0] == pytest.approx(size[0][0], rel=0.01)
    assert size[1][-1] < 0.65 * size[1][0]


def test_point_feet_are_those_of_the_simulation():
    robot = load_robot("ch3r")
    assert not robot.foot_radius.any()
    model = SimulatedPlant(robot, sensors="blind").mj_model
    balls = model.geom_size[model.geom_type == mujoco.mjtGeom.mjGEOM_SPHERE, 0]
    assert POINT_FOOT in balls


def test_a_rolling_ball_is_not_displaced_at_its_contact_point():
    """A robot that pitches while the ball of a leg, of 8 mm, rolls forward as far as it turns."""
    compliant = Compliant(STRIDER, JointSprings.uniform(STRIDER, 100.0), FootContact())
    angles, leg, pitch, none = standing().angles[0], 1, 1e-4, np.zeros(24)
    rotation, origin = rotated(np.eye(3), np.array([0.0, pitch, 0.0])), np.zeros(3)
    before, after = compliant.bottoms(np.eye(3), origin, angles), compliant.bottoms(rotation, origin, angles)
    position = before[leg] + [0.008 * pitch, 0.0, 0.0] - after[leg]
    past = Past(np.eye(3), origin, angles, before, np.zeros((6, 2)), np.zeros(6, dtype=bool))
    matrix = np.zeros((24, 24))
    demand = Demand(angles, np.zeros((6, 12)), none, angles, rotation, position, matrix[:6, :6], 0.02, none, matrix)
    displacement = compliant.configuration(none, past, demand).displacement
    # The balls of the other legs roll as far, but for the second order.
    assert np.linalg.norm(displacement, axis=1).max() < 0.01 * 0.008 * pitch


@pytest.mark.parametrize("name", ["strider", "ch3r"])
def test_a_standing_robot_bears_what_it_bears_in_physics(name):
    robot = load_robot(name)
    plant = SimulatedPlant(robot, servos="ideal", sensors="blind")
    plant.mj_model.opt.impratio = 2000
    trace = play(standing(robot), plant)
    found = compliant_loads(robot, standing(robot), springs=100.0, contact=NO_CREEP)
    np.testing.assert_allclose(found.torques[-1], trace.torques[-1], atol=0.05)
    np.testing.assert_allclose(found.forces[-1, :, 2], trace.foot_forces[-1, :, 2], rtol=0.05)
    assert found.body.position[-1, 2] == pytest.approx(trace.body.position[-1, 2], abs=5e-4)


def test_a_walk_bears_what_it_bears_in_physics(strider_walk):
    motion, found = strider_walk
    physics = play(motion, SimulatedPlant(STRIDER, servos="ideal", sensors="blind")).torques[: len(motion.time)]
    for joint, peak, rms in ((0, 0.3, 0.25), (1, 0.1, 0.1), (2, 0.25, 0.2)):
        ours, theirs = found.torques[..., joint], physics[..., joint]
        assert np.abs(ours).max() == pytest.approx(np.abs(theirs).max(), rel=peak)
        assert np.sqrt((ours**2).mean()) == pytest.approx(np.sqrt((theirs**2).mean()), rel=rms)
        assert np.corrcoef(ours.ravel(), theirs.ravel())[0, 1] > 0.85
    # Statics with vertical forces does not predict the coxa at all.
    assert found.loads.peak[:, 0].max() > 3 * joint_loads(STRIDER, motion).peak[:, 0].max()


def test_a_walk_on_soft_servos_bears_what_it_bears_in_physics():
    """Bodies on soft legs swing when feet take over, and dead bands hold coxae back: the peaks need both."""
    motion = walk()
    found = compliant_loads(STRIDER, motion)
    physics = play(motion, SimulatedPlant(STRIDER, sensors="blind")).torques[: len(motion.time)]
    for joint, peak, rms in ((0, 0.2, 0.12), (1, 0.07, 0.07), (2, 0.2, 0.12)):
        ours, theirs = found.torques[..., joint], physics[..., joint]
        assert np.abs(ours).max() == pytest.approx(np.abs(theirs).max(), rel=peak)
        assert np.sqrt((ours**2).mean()) == pytest.approx(np.sqrt((theirs**2).mean()), rel=rms)
        assert np.corrcoef(ours.ravel(), theirs.ravel())[0, 1] > 0.9


def test_a_vibration_is_that_of_an_oscillator():
    frequency, step, time = 30.0, 1e-4, 0.3
    moving = Vibration(np.array([0.01]), np.zeros(1), np.array([-(frequency**2) * 0.01]))
    for _ in range(round(time / step)):
        gain = Vibration.gain(step)
        moving = moving.after(gain * moving.ahead(step) / (gain + frequency**2), step)
    # What damps it is the method, by (gamma - 1/2) / 2 of frequency times step.
    kept = 0.01 * np.exp(-0.2 * frequency**2 * step * time)
    assert moving.offset[0] == pytest.approx(kept * np.cos(frequency * time), rel=5e-3)
    assert moving.speed[0] == pytest.approx(-kept * frequency * np.sin(frequency * time), rel=2e-2)
    assert not Vibration.still(np.ones(3)).ahead(0.1).any() - 1


@pytest.mark.parametrize("name", ["strider", "phantomx"])
def test_the_inertia_of_the_robot_is_that_of_physics(name):
    robot = load_robot(name)
    motion = standing(robot)
    plant = SimulatedPlant(robot, sensors="blind")
    plant.mj_data.qpos[:] = 0.0
    plant.mj_data.qpos[3] = 1.0
    plant.mj_data.qpos[7:] = motion.angles[0].ravel()
    mujoco.mj_forward(plant.mj_model, plant.mj_data)
    full = np.zeros((plant.mj_model.nv, plant.mj_model.nv))
    mujoco.mj_fullM(plant.mj_model, plant.mj_data, full)
    ours = rigid_inertia(robot, motion.angles[0], Payload(0.0))
    np.testing.assert_allclose(ours[:3, :3], full[:3, :3], atol=1e-9)
    np.testing.assert_allclose(ours[:3, 3:], full[:3, 3:6], atol=1e-9)
    np.testing.assert_allclose(ours[3:, 3:], full[3:6, 3:6], atol=0.1 * full[5, 5])
    carried = rigid_inertia(robot, motion.angles[0], Payload(0.5, (0.0, 0.0, 0.1))) - ours
    assert np.diag(carried) == pytest.approx([0.5, 0.5, 0.5, 0.005, 0.005, 0.0])


def test_targets_of_servos_follow_their_commands_outside_the_dead_band():
    springs = JointSprings.of(STRIDER)
    half = springs.dead_band[0, 0]
    assert half > 0
    commands = half * np.array([0.0, 0.9, 3.0, 2.5, 1.5, -1.0])[:, None, None] * np.ones((6, 3))
    targets = springs.targets(commands)[:, 0, 0] / half
    assert targets == pytest.approx([0.0, 0.0, 2.0, 2.0, 2.0, 0.0])
    ideal = JointSprings.uniform(STRIDER, 100.0)
    np.testing.assert_array_equal(ideal.targets(commands), commands)


def test_servos_of_the_catalogue_are_those_of_the_simulation():
    springs = JointSprings.of(STRIDER)
    servo = ServoModel.of(STRIDER.servos[0][0])
    for name in ("stiffness", "stall_torque", "rotor_inertia"):
        assert getattr(springs, name) == pytest.approx(getattr(servo, name))
    assert springs.play == pytest.approx(servo.backlash / 2)
    assert springs.dead_band == pytest.approx(servo.dead_band / 2)
    assert springs.damping == pytest.approx(servo.joint_damping)
    error, turned, step = np.full((6, 3), 0.3), np.full((6, 3), 0.02), 0.01
    torque, slope = springs.torque(error, turned, step)
    expected = servo.torque(np.array(0.3), np.array(2.0))
    assert torque == pytest.approx(np.full((6, 3), float(expected)), rel=0.01)
    small = 1e-7
    changed, _ = springs.torque(error - small, turned + small, step)
    assert (torque - changed) / small == pytest.approx(slope, rel=1e-4)
    assert JointSprings.of(STRIDER, supply=5.0).stall_torque[0, 0] < springs.stall_torque[0, 0]


def test_a_servo_without_known_speed_has_the_speed_assumed_elsewhere():
    servo = dataclasses.replace(STRIDER.servos[0][0], no_load_speed=None)
    springs = JointSprings.of(STRIDER.replace(servos=((servo,) * 3,) * 6))
    assert springs.damping == pytest.approx(springs.stall_torque / 5.0)


def test_weak_servos_do_not_carry_the_robot():
    heavy = compliant_loads(STRIDER, standing(), payload=20.0)
    assert not heavy.ok
    assert not heavy.converged.all()
    assert heavy.saturated.any()
    found, stalled = heavy.problems
    assert "at 0.00 s the servos find no equilibrium" in found
    assert "gives all of its 2.45 N m" in stalled


def test_soft_servos_with_play_settle_with_sliding_feet():
    """Knees inside their play: the loads tip the potential over, and plain Newton steps lead uphill."""
    robot = load_robot("ch3r")
    found = compliant_loads(robot, standing(robot, samples=2))
    assert found.converged.all()
    np.testing.assert_allclose(found.torques[0], np.tile(found.torques[0, 0], (6, 1)), atol=1e-3)


def test_servos_that_carry_the_robot():
    found = compliant_loads(STRIDER, walk(distance=0.03), rate=RATE)
    assert found.ok
    assert not found.problems
    assert any("DS3225: 23.4 N m/rad" in line for line in found.assumed)
    assert any("no creep" in line for line in compliant_loads(STRIDER, standing(), contact=NO_CREEP).assumed)


def test_what_is_missing_or_wrong_is_named():
    with pytest.raises(MissingDataError, match=r"servo of the coxa is unknown, so its stiffness is"):
        compliant_loads(STRIDER.replace(servos=((None,) * 3,) * 6), walk())
    with pytest.raises(MissingDataError, match=r"unknown at the supply of 12 V, .*, and so is its stiffness"):
        JointSprings.of(STRIDER, supply=12.0)
    with pytest.raises(MissingDataError, match="mass"):
        compliant_loads(load_robot("mithi"), walk(load_robot("mithi")))
    with pytest.raises(InputError, match="batch of designs"):
        compliant_loads(STRIDER.replace(femur=np.full((2, 6), 0.1)), walk())
    with pytest.raises(InputError, match="rate is 0"):
        compliant_loads(STRIDER, walk(), rate=0.0)
    with pytest.raises(InputError, match="stiffness is 0 N m/rad"):
        compliant_loads(STRIDER, walk(), springs=0.0)
    with pytest.raises(InputError, match="damping is -1 N m s/rad"):
        JointSprings.uniform(STRIDER, 1.0, damping=-1.0)
    with pytest.raises(InputError, match="friction is -1"):
        FootContact(friction=-1.0)
    with pytest.raises(InputError, match="normal_stiffness is 0 N/m"):
        FootContact(normal_stiffness=0.0)
    with pytest.raises(InputError, match="creep_time is 0 s"):
        FootContact(creep_time=0.0)


def test_servos_are_sized_by_the_higher_loads(strider_walk):
    motion, pressed = strider_walk
    vertical = joint_loads(STRIDER, motion)
    decisive = decisive_loads(vertical, pressed)
    np.testing.assert_allclose(decisive.peak, np.maximum(vertical.peak, pressed.loads.peak))
    assert decisive_loads(vertical, None) is vertical
    np.testing.assert_allclose(decisive.rms, np.maximum(vertical.rms, pressed.loads.rms))
    # When and why a joint has its peak is of the case that has it.
    higher = pressed.loads.peak > vertical.peak
    assert 0 < np.count_nonzero(higher) < higher.size
    for leg, joint in np.ndindex(higher.shape):
        case = pressed.loads if higher[leg, joint] else vertical
        assert decisive.cause(leg, joint) == case.cause(leg, joint)
        assert decisive.peak_sample[leg, joint] == case.peak_sample[leg, joint]
    alone, both = (size_servos(STRIDER, vertical, compliant=found) for found in (None, pressed))
    coxae = [[v for v in found.verdicts if v.joint == "coxa"] for found in (alone, both)]
    assert all(b.factor < 0.5 * a.factor for a, b in zip(*coxae, strict=True))
    assert any("friction between the feet, slopes" in line for line in alone.assumed)
    assert any("what friction between the feet adds" in line for line in both.assumed)
    assert both.maximum_payload <= alone.maximum_payload
    lightest = [
        min((c.servo_mass for c in (*found.candidates, *found.sets)), default=np.inf) for found in (alone, both)
    ]
    assert lightest[1] >= lightest[0]


def test_without_servos_it_is_said_what_is_missing():
    motion = walk(distance=0.02)
    found, missing = compliant_or_missing(joint_loads(STRIDER.replace(servos=((None,) * 3,) * 6), motion))
    assert found is None
    assert "the servo of the coxa is unknown" in missing
    found, missing = compliant_or_missing(joint_loads(STRIDER, motion, payload=0.5, supply=6.0))
    assert found.loads.payload.mass == 0.5
    assert found.springs.stall_torque[0, 0] == pytest.approx(2.452 * 6.0 / 6.8)
    assert missing == ""
