"""Holding torques against Pinocchio, the design's reference case, and other array libraries."""

import array_api_strict
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pinocchio_model import Reference
from sample_robots import YAWS, hexapod, random_hexapod, standing
from tarsus.errors import InputError, MissingDataError
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.load.contact import contact_forces
from tarsus.load.payload import Payload
from tarsus.load.torque import joint_torques
from tarsus.robot.file import load_robot
from tarsus.robot.robot import stack_robots
from test_contact import ALL, TRIPOD, random_case


@given(st.integers(0, 2**32 - 1))
def test_agrees_with_pinocchio(seed):
    rng = np.random.default_rng(seed)
    robot, angles, body, contacts, payload = random_case(rng)
    if seed % 2:
        angles = rng.uniform(-np.pi, np.pi, (6, 3))
    if seed % 3 == 0:
        robot = robot.replace(coxa=np.zeros(6), femur_axis_offset=np.zeros((6, 2)), link_com=robot.link_com * [0, 1, 1])
    gravity = rng.normal(size=3) * 3 - [0, 0, 9.8]
    torques, forces = joint_torques(robot, angles, body, contacts, payload, gravity=gravity)
    reference = Reference(robot, payload=payload, gravity=gravity)
    np.testing.assert_allclose(torques, reference.residual(angles, body, forces)[1], rtol=0, atol=1e-12)
    solved = contact_forces(robot, angles, body, contacts, payload=payload, gravity=gravity)
    np.testing.assert_array_equal(forces, solved.forces)
    # Also with arbitrary forces on the feet.
    forces = rng.normal(size=(6, 3))
    torques, same = joint_torques(robot, angles, body, contacts, gravity=gravity, forces=forces)
    np.testing.assert_array_equal(same, forces)
    np.testing.assert_allclose(torques, reference.residual(angles, body, forces)[1], rtol=0, atol=1e-12)


@pytest.mark.parametrize(("height", "femur", "tibia"), [(0.102, -1.049, -0.485), (0.110, -1.0434, -0.4274)])
def test_reference_case(height, femur, tibia):
    """The case of the design: 185 mm out, 110 mm high on balls of 8 mm, so that the foot's point is 102 mm below B.

    With the point itself 110 mm below, the tibias bear 12 % less: their knees are nearly over the feet.
    """
    robot = load_robot("strider")
    assert (robot.foot_radius == 0.008).all()
    radial = np.stack([np.cos(YAWS), np.sin(YAWS), 0 * YAWS], axis=-1)
    robot = robot.replace(mount_position=0.086 * radial, mount_yaw=YAWS)
    feet = (0.086 + 0.185) * radial - [0, 0, height]
    angles = inverse_kinematics(robot, feet).require().angles
    torques, forces = joint_torques(robot, angles, Pose(), TRIPOD)
    np.testing.assert_allclose(forces[TRIPOD], [[0, 0, 10.03]] * 3, rtol=0.01, atol=1e-12)
    np.testing.assert_allclose(torques[TRIPOD], [[0, femur, tibia]] * 3, rtol=0.01, atol=1e-12)


def test_signs():
    """A standing leg pushes its foot down, a leg in the air is held up."""
    torques, _ = joint_torques(hexapod(), standing(), Pose(), TRIPOD)
    assert (torques[TRIPOD, 1] < 0).all()
    assert (torques[~TRIPOD, 1] > 0).all()
    level, _ = joint_torques(hexapod(), np.zeros((6, 3)), Pose(), TRIPOD)
    lever = 9.80665 * np.array([0.16 * 0.049 + 0.08 * (0.098 + 0.078), 0.08 * 0.078])
    np.testing.assert_allclose(level[1], [0, *lever], rtol=0, atol=1e-15)


def test_batch_equals_loop():
    rng = np.random.default_rng(0)
    robot, angles, body, contacts, payload = random_case(rng, (7, 5))
    torques, forces = joint_torques(robot, angles, body, contacts, payload)
    for at in np.ndindex(7, 5):
        single = joint_torques(robot, angles[at], body[at], contacts[at], payload)
        np.testing.assert_allclose(torques[at], single[0], rtol=0, atol=1e-14)
        np.testing.assert_allclose(forces[at], single[1], rtol=0, atol=1e-13)


def test_batched_designs():
    rng = np.random.default_rng(1)
    robots = [random_hexapod(rng) for _ in range(3)]
    angles = standing() + rng.uniform(-0.3, 0.3, (4, 1, 6, 3))
    together, _ = joint_torques(stack_robots(robots), angles, Pose(), TRIPOD, 0.5)
    for i, robot in enumerate(robots):
        single, _ = joint_torques(robot, angles[:, 0], Pose(), TRIPOD, 0.5)
        np.testing.assert_allclose(together[:, i], single, rtol=0, atol=1e-14)


@pytest.mark.no_cover
@pytest.mark.parametrize("xp", [jnp, array_api_strict], ids=["jax", "strict"])
def test_other_libraries_agree(xp):
    robot, angles, body, contacts, payload = random_case(np.random.default_rng(2), (10,))
    want = joint_torques(robot, angles, body, contacts, payload)
    got = joint_torques(robot, xp.asarray(angles), body, xp.asarray(contacts), payload)
    given_ = joint_torques(robot, angles, body, contacts, forces=xp.asarray(want[1]))
    for found in (*got, *given_):
        assert isinstance(found, type(xp.asarray(angles)))
    for found, wanted in zip((*got, given_[0]), (*want, want[0]), strict=True):
        np.testing.assert_allclose(np.asarray(found), wanted, rtol=0, atol=1e-12)


@pytest.mark.no_cover
def test_jit_and_derivative_of_the_peak():
    robot, angles, body, contacts, _ = random_case(np.random.default_rng(4), (10,))
    contacts |= ALL
    payload = Payload(30.0, (0.2, 0.08, 0.0))  # off the middle, so that some feet would have to pull
    want, forces = joint_torques(robot, angles, body, contacts, payload)
    assert ((forces[..., 2] == 0) & contacts).any()
    both = jax.jit(lambda q, c: joint_torques(robot, q, body, c, payload))(angles, contacts)
    np.testing.assert_allclose(both[0], want, rtol=0, atol=1e-12)

    def peak(xp, femur, mass):
        changed = robot.replace(femur=femur, body_mass=mass)
        return xp.max(xp.abs(joint_torques(changed, angles, body, contacts, payload)[0]))

    slope = jax.jit(jax.grad(lambda *lengths: peak(jnp, *lengths), argnums=(0, 1)))
    by_femur, by_mass = slope(jnp.asarray(robot.femur), jnp.asarray(robot.body_mass))
    for leg in range(6):
        step = 1e-6 * np.eye(6)[leg]
        ahead, back = (peak(np, robot.femur + sign * step, robot.body_mass) for sign in (1, -1))
        np.testing.assert_allclose(by_femur[leg], (ahead - back) / 2e-6, rtol=0, atol=1e-6)
    ahead, back = (peak(np, robot.femur, robot.body_mass + sign * 1e-6) for sign in (1, -1))
    np.testing.assert_allclose(by_mass, (ahead - back) / 2e-6, rtol=0, atol=1e-6)


def test_errors():
    robot, angles = hexapod(), standing()
    with pytest.raises(MissingDataError, match=r"\[leg\] mass_kg missing"):
        joint_torques(robot.replace(link_mass=None), angles, Pose(), ALL)
    with pytest.raises(InputError, match="payload mass is nan"):
        joint_torques(robot, angles, Pose(), ALL, np.nan)
    with pytest.raises(InputError, match="no foot is on the ground"):
        joint_torques(robot, angles, Pose(), ~ALL)
    with pytest.raises(InputError, match=r"forces has shape \(5, 3\)"):
        joint_torques(robot, angles, Pose(), ALL, forces=np.zeros((5, 3)))
    with pytest.raises(InputError, match=r"forces\[1, 2\] is inf"):
        joint_torques(robot, angles, Pose(), ALL, forces=np.where(np.arange(18).reshape(6, 3) == 5, np.inf, 0))
    with pytest.raises(InputError, match="gravity"):
        joint_torques(robot, angles, Pose(), ALL, gravity=(0, 0, 0), forces=np.zeros((6, 3)))
