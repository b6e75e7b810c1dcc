"""Inverse dynamics against Pinocchio's recursive Newton-Euler algorithm, and torques of motions."""

import array_api_strict
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import tarsus
from pinocchio_model import Reference
from sample_robots import hexapod, random_hexapod, standing
from shape_enforcement import unchecked
from tarsus.errors import InputError, MissingDataError
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.pose import Pose
from tarsus.load.acceleration import BodyRates, JointRates, differences, point_accelerations
from tarsus.load.inverse_dynamics import dynamic_torques, motion_torques
from tarsus.load.payload import Payload
from tarsus.load.torque import joint_torques
from tarsus.robot.robot import stack_robots

ALL = np.ones(6, bool)
TRIPOD = np.array([True, False] * 3)


def random_rates(rng, batch=(), *, size=1.0):
    joints = JointRates(velocity=rng.normal(size=(*batch, 6, 3)), acceleration=4 * rng.normal(size=(*batch, 6, 3)))
    body = BodyRates(
        angular_velocity=rng.normal(size=(*batch, 3)),
        angular_acceleration=size * rng.normal(size=(*batch, 3)),
        acceleration=size * rng.normal(size=(*batch, 3)),
    )
    return joints, body


def on_level_ground(rng, batch=()):
    """Random robot with level feet and a tilted body, angles from inverse kinematics."""
    robot = random_hexapod(rng, box=bool(rng.integers(2))).replace(
        **{name: getattr(hexapod(), name) for name in ("coxa", "femur", "tibia", "link_com")}
    )
    feet = forward_kinematics(robot, standing())[:, 3] + rng.uniform(-0.02, 0.02, (*batch, 6, 3))
    feet[..., 2] = 0.0
    body = Pose.from_rpy(*rng.uniform(-0.1, 0.1, (3, *batch)), np.broadcast_to([0, 0, 0.11], (*batch, 3)))
    angles = inverse_kinematics(robot, feet, body=body).require().angles
    contacts = rng.random((*batch, 6)) < 0.8
    contacts[..., ::2] = True
    return robot, angles, body, contacts, Payload(rng.uniform(0, 1), tuple(rng.uniform(-0.03, 0.03, 3)))


@given(st.integers(0, 2**32 - 1))
def test_six_equations_of_motion_on_level_ground(seed):
    rng = np.random.default_rng(seed)
    robot, angles, body, contacts, payload = on_level_ground(rng)
    joints, rates = random_rates(rng, size=rng.choice([0.3, 8]))
    gravity = rng.normal(size=3) * (seed % 2) - [0, 0, 9.8]
    found = dynamic_torques(robot, angles, body, contacts, joints, rates, payload=payload, gravity=gravity)
    assert (found.forces[~contacts] == 0).all()
    reference = Reference(robot, payload=payload, gravity=gravity)
    base, torques = reference.dynamics(angles, body, found.forces, joints, rates)
    np.testing.assert_allclose(found.torques, torques, rtol=0, atol=1e-9)
    if found.margin == -np.inf:  # the ground would have to pull
        assert (body.rotation @ base[:3])[2] <= 0
        assert (found.forces == 0).all()
        return
    np.testing.assert_allclose(base[:3], 0, rtol=0, atol=1e-9)
    if found.margin >= 0:
        np.testing.assert_allclose(base, 0, rtol=0, atol=1e-9)
        assert (found.forces[:, 2] > -1e-9).all()
    else:  # what is missing is the force up, times how far the zero-moment point is outside
        tips = -found.margin * found.forces[:, 2].sum()
        np.testing.assert_allclose(np.linalg.norm((body.rotation @ base[3:])[:2]), tips, rtol=0, atol=1e-8)


@given(st.integers(0, 2**32 - 1))
def test_torques_agree_with_pinocchio_in_any_state(seed):
    """Feet anywhere, links without length or mass, given contact forces."""
    rng = np.random.default_rng(seed)
    robot = random_hexapod(rng, box=seed % 2 == 0)
    if seed % 3 == 0:
        robot = robot.replace(coxa=np.zeros(6), femur_axis_offset=np.zeros((6, 2)), link_com=robot.link_com * [0, 1, 1])
    if seed % 5 == 0:
        robot = robot.replace(link_mass=robot.link_mass * [1, 0, 1])
    angles, body = rng.uniform(-np.pi, np.pi, (6, 3)), Pose.from_rpy(*rng.uniform(-3, 3, 3), 100 * rng.normal(size=3))
    joints, rates = random_rates(rng, size=5)
    forces, payload = rng.normal(size=(6, 3)), Payload(0.7, (0.02, 0.01, 0.1))
    gravity = 5 * rng.normal(size=3)
    found = dynamic_torques(robot, angles, body, ALL, joints, rates, payload=payload, gravity=gravity, forces=forces)
    _, torques = Reference(robot, payload=payload, gravity=gravity).dynamics(angles, body, forces, joints, rates)
    np.testing.assert_allclose(found.torques, torques, rtol=0, atol=1e-9)
    np.testing.assert_array_equal(found.forces, forces)


def test_six_equations_of_motion_on_uneven_feet():
    """Three feet at any heights, all pushing."""
    rng = np.random.default_rng(5)
    robot, (joints, rates) = random_hexapod(rng), random_rates(rng)
    angles = standing()
    angles[2, 1] += 0.3
    found = dynamic_torques(robot, angles, Pose(), TRIPOD, joints, rates)
    assert np.ptp(forward_kinematics(robot, angles)[TRIPOD, 3, 2]) > 0.02
    assert found.margin > 0
    base, _ = Reference(robot).dynamics(angles, Pose(), found.forces, joints, rates)
    np.testing.assert_allclose(base, 0, rtol=0, atol=1e-9)


def test_statics_at_rest():
    rng = np.random.default_rng(0)
    robot, angles, body, contacts, payload = on_level_ground(rng, (30,))
    still = JointRates(velocity=np.zeros((6, 3)), acceleration=np.zeros((6, 3)))
    for gravity in ((0, 0, -9.80665), (1.0, -2.0, -9.0)):
        found = dynamic_torques(robot, angles, body, contacts, still, BodyRates(), payload=payload, gravity=gravity)
        torques, forces = joint_torques(robot, angles, body, contacts, payload, gravity=gravity)
        np.testing.assert_allclose(found.forces, forces, rtol=0, atol=1e-9)
        np.testing.assert_allclose(found.torques, torques, rtol=0, atol=1e-9)


def test_single_foot():
    robot = hexapod()
    com = centre_of_mass(robot, standing())
    foot = forward_kinematics(robot, standing())[0, 3] - [0, 0, com[2]]
    still = JointRates(velocity=np.zeros((6, 3)), acceleration=np.zeros((6, 3)))
    rates = BodyRates(acceleration=np.array([0.5, 0.2, 1.0]))
    found = dynamic_torques(robot, standing(), Pose(), np.arange(6) == 0, still, rates)
    mass = 1.386 + 6 * 0.28
    np.testing.assert_allclose(found.forces[0], mass * np.array([0.5, 0.2, 10.80665]), rtol=1e-12)
    np.testing.assert_array_equal(found.forces[1:], 0)
    # The margin is that of the load projected along gravity and inertia to the foot's height.
    zero_moment = foot[2] / 10.80665 * np.array([0.5, 0.2])
    np.testing.assert_allclose(found.margin, -np.linalg.norm(foot[:2] - zero_moment - com[:2]), rtol=1e-9)


def test_falling_robot_has_no_contact_forces():
    still = JointRates(velocity=np.zeros((6, 3)), acceleration=np.zeros((6, 3)))
    falls = BodyRates(acceleration=np.array([[0, 0, -12.0], [0, 0, -9.80665], [0, 0, 0]]))
    found = dynamic_torques(hexapod(), standing(), Pose(), ALL, still, falls)
    np.testing.assert_array_equal(found.margin == -np.inf, [True, True, False])
    np.testing.assert_array_equal(found.forces[:2], 0)
    assert (found.forces[2, :, 2] > 1).all()
    np.testing.assert_allclose(found.torques[1], 0, rtol=0, atol=1e-15)


def test_point_accelerations_against_finite_differences():
    """Second differences of forward kinematics along smooth motions of joints and body."""
    rng = np.random.default_rng(2)
    robot, step = random_hexapod(rng), 1e-3
    start, speed, gain = standing(), rng.normal(size=(6, 3)), rng.normal(size=(6, 3))
    turn, place = rng.normal(size=(2, 3)), rng.normal(size=(2, 3))
    time = step * np.arange(-1, 2)
    angles = np.array([start + speed * t + gain * t * t / 2 for t in time])
    body = Pose.from_rpy(
        *(turn[0] * time[:, None] + turn[1] * time[:, None] ** 2 / 2).T,
        place[0] * time[:, None] + place[1] * time[:, None] ** 2 / 2,
    )
    seen = body @ forward_kinematics(robot, angles)
    want = (seen[0] - 2 * seen[1] + seen[2]) / step**2
    rates = BodyRates.of(time, body)
    turns = tuple(v[1] for v in rates.within(np, body.rotation))
    joints = JointRates(velocity=speed, acceleration=gain)
    points = forward_kinematics(robot, angles[1])
    got = point_accelerations(np, robot, angles[1], points, joints, turns)
    np.testing.assert_allclose(got @ body.rotation[1].T, want, rtol=0, atol=1e-5)


def test_differences():
    time = np.array([0.0, 0.1, 0.25, 0.3, 0.5])
    first, second = differences(time, np.stack([3 * time**2 - time, time], axis=-1))
    np.testing.assert_allclose(first, np.stack([6 * time - 1, time**0], axis=-1), rtol=0, atol=1e-12)
    np.testing.assert_allclose(second, np.tile([6.0, 0], (5, 1)), rtol=0, atol=1e-12)
    errors = []
    for n in (101, 201):
        time = np.linspace(0, 1, n)
        first, second = differences(time, np.sin(3 * time))
        errors.append([np.abs(first - 3 * np.cos(3 * time)).max(), np.abs(second + 9 * np.sin(3 * time))[1:-1].max()])
    np.testing.assert_allclose(np.divide(*errors), 4, rtol=0.05)  # of second order
    np.testing.assert_array_equal(differences(np.array([0, 0.5]), np.array([1.0, 2.0])), [[2, 2], [0, 0]])
    np.testing.assert_array_equal(differences(np.zeros(1), np.ones((1, 6))), np.zeros((2, 1, 6)))


@pytest.fixture(scope="module")
def walk():
    return tarsus.plan_walk(tarsus.load_robot("strider"), tarsus.Gait.named("tripod"), tarsus.straight_path(0.3))


def test_walk(walk):
    robot = walk.robot
    found = motion_torques(robot, walk, payload=0.5)
    assert found.torques.shape == walk.angles.shape
    velocity, acceleration = differences(walk.time, walk.angles)
    rates = BodyRates.of(walk.time, walk.body)
    reference = Reference(robot, payload=Payload(0.5))
    for i in range(0, len(walk.time), 25):
        one = JointRates(velocity=velocity[i], acceleration=acceleration[i])
        of_body = BodyRates(**{name: value[i] for name, value in vars(rates).items()})
        base, torques = reference.dynamics(walk.angles[i], walk.body[i], found.forces[i], one, of_body)
        np.testing.assert_allclose(found.torques[i], torques, rtol=0, atol=1e-9)
        np.testing.assert_allclose(base, 0, rtol=0, atol=1e-9)
    assert (found.margin > 0).all()
    assert (found.forces[..., 2] >= -1e-9).all()
    assert "slender uniform rod, the body a homogeneous box;" in found.assumed[0]
    point = motion_torques(robot.replace(body_size=None), walk)
    assert "the body a point mass, as its size is unknown;" in point.assumed[0]


def test_walk_without_inertia_is_statics(walk):
    found = motion_torques(walk.robot, walk, payload=0.5, inertial=False)
    torques, forces = joint_torques(walk.robot, walk.angles, walk.body, walk.contacts, 0.5)
    np.testing.assert_array_equal(found.torques, torques)
    np.testing.assert_array_equal(found.forces, forces)
    assert found.assumed == ()
    np.testing.assert_array_less(0, found.margin)


def test_walk_of_a_batch_of_designs(walk):
    designs = [walk.robot.replace(body_mass=mass, link_mass=walk.robot.link_mass * mass) for mass in (1.0, 2.0)]
    stacked = stack_robots(designs)
    arrays = {name: value[:, None] for name, value in vars(stacked).items() if isinstance(value, np.ndarray)}
    together = motion_torques(stacked.replace(**arrays), walk)
    for i, robot in enumerate(designs):
        single = motion_torques(robot, walk)
        np.testing.assert_allclose(together.torques[i], single.torques, rtol=0, atol=1e-12)
        np.testing.assert_allclose(together.margin[i], single.margin, rtol=0, atol=1e-12)


@pytest.mark.parametrize("xp", [jnp, array_api_strict], ids=["jax", "strict"])
def test_other_libraries_agree(xp):
    rng = np.random.default_rng(3)
    robot, angles, body, contacts, payload = on_level_ground(rng, (12,))
    joints, rates = random_rates(rng, (12,))

    def solve(q, speed):
        moves = JointRates(velocity=speed, acceleration=joints.acceleration)
        found = dynamic_torques(robot, q, body, contacts, moves, rates, payload=payload)
        return found.torques, found.forces, found.margin

    want = solve(angles, joints.velocity)
    solve = jax.jit(solve) if xp is jnp else solve
    for got, wanted in zip(solve(xp.asarray(angles), xp.asarray(joints.velocity)), want, strict=True):
        np.testing.assert_allclose(np.asarray(got), wanted, rtol=0, atol=1e-9)


def test_errors(walk):
    robot, joints, rates = hexapod(), *random_rates(np.random.default_rng(4))
    with pytest.raises(MissingDataError, match=r"\[body\] mass_kg"):
        motion_torques(robot.replace(body_mass=None), walk)
    with pytest.raises(InputError, match="no foot is on the ground"):
        dynamic_torques(robot, standing(), Pose(), ~ALL, joints, rates)
    with unchecked():
        slow = JointRates(velocity=np.zeros((5, 3)), acceleration=joints.acceleration)
        askew = BodyRates(angular_velocity=np.zeros(2))
    wild = JointRates(velocity=joints.velocity, acceleration=joints.acceleration * np.nan)
    with pytest.raises(InputError, match=r"joint velocity has shape \(5, 3\)"):
        dynamic_torques(robot, standing(), Pose(), ALL, slow, rates)
    with pytest.raises(InputError, match=r"joint acceleration\[0, 0\] is nan"):
        dynamic_torques(robot, standing(), Pose(), ALL, wild, rates)
    with pytest.raises(InputError, match=r"angular_velocity has shape \(2,\)"):
        dynamic_torques(robot, standing(), Pose(), ALL, joints, askew)
    with pytest.raises(InputError, match=r"acceleration\[0\] is inf"):
        dynamic_torques(robot, standing(), Pose(), ALL, joints, BodyRates(acceleration=np.full(3, np.inf)))
