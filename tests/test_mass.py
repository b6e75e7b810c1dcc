import array_api_strict
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from pinocchio_model import Reference
from sample_robots import hexapod, random_hexapod, standing
from tarsus.errors import InputError, MissingDataError
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import MassWeights, centre_of_mass, known_weight, total_mass
from tarsus.robot.robot import stack_robots

jax.config.update("jax_enable_x64", True)


@pytest.mark.parametrize("seed", range(8))
def test_agrees_with_pinocchio(seed):
    rng = np.random.default_rng(seed)
    robot = random_hexapod(rng)
    for angles in rng.uniform(-np.pi, np.pi, (5, 6, 3)):
        mass, com = Reference(robot).com(angles)
        np.testing.assert_allclose(centre_of_mass(robot, angles), com, rtol=0, atol=1e-12)
        np.testing.assert_allclose(total_mass(robot), mass, rtol=1e-14)


def test_an_unknown_mass_has_no_weight():
    robot = hexapod(link_mass=np.full((6, 3), 0.1), body_mass=1.2)
    assert known_weight(robot) == pytest.approx(3.0 * 9.80665, rel=1e-4)
    assert known_weight(robot.replace(body_mass=None)) == 0.0


def test_by_hand():
    level = np.zeros((6, 3))
    robot = hexapod(link_mass=np.zeros((6, 3)), body_com=[0.01, 0, 0.02])
    np.testing.assert_allclose(centre_of_mass(robot, level), [0.01, 0, 0.02], atol=1e-15)
    masses = np.zeros((6, 3))
    masses[1] = [1.0, 2.0, 4.0]  # middle left: its links lie along y
    robot = hexapod(link_mass=masses, body_mass=3.0, link_com=np.broadcast_to([0.01, 0.02, 0.03], (6, 3)))
    y = (1 * (0.086 + 0.01) + 2 * (0.086 + 0.068 + 0.02) + 4 * (0.086 + 0.068 + 0.098 + 0.03)) / 10
    np.testing.assert_allclose(centre_of_mass(robot, level), [0, y, 0], atol=1e-15)
    assert total_mass(robot) == 10.0


def test_a_coxa_link_without_length_acts_at_the_coxa_axis():
    masses = np.zeros((6, 3))
    masses[1, 0] = 1.0
    robot = hexapod(coxa=np.zeros(6), link_mass=masses, body_mass=1.0)
    np.testing.assert_allclose(centre_of_mass(robot, standing()), [0, 0.043, 0], atol=1e-15)


@pytest.mark.parametrize("missing", ["body_mass", "link_mass"])
def test_without_masses_the_links_are_massless(missing):
    robot = hexapod(body_com=[0.01, 0.02, 0.03], **{missing: None})
    com = centre_of_mass(robot, np.zeros((4, 1, 6, 3)))
    np.testing.assert_array_equal(com, np.broadcast_to([0.01, 0.02, 0.03], (4, 1, 3)))
    with pytest.raises(MissingDataError, match=r"\[body\] mass_kg" if missing == "body_mass" else r"\[leg\] mass_kg"):
        total_mass(robot)


def test_batch_equals_loop():
    rng = np.random.default_rng(1)
    robots = [random_hexapod(rng) for _ in range(3)]
    angles = rng.uniform(-2, 2, (4, 1, 6, 3))
    together = centre_of_mass(stack_robots(robots), angles)
    one_by_one = [[centre_of_mass(robot, row[0]) for robot in robots] for row in angles]
    np.testing.assert_allclose(together, one_by_one, rtol=0, atol=1e-14)
    np.testing.assert_allclose(total_mass(stack_robots(robots)), [total_mass(r) for r in robots], rtol=1e-14)


def test_known_points_are_used():
    robot = random_hexapod(np.random.default_rng(2))
    points = forward_kinematics(robot, standing())
    np.testing.assert_array_equal(centre_of_mass(robot, None, points=points), centre_of_mass(robot, standing()))
    with pytest.raises(InputError, match="points has shape"):
        centre_of_mass(robot, None, points=points[1:])


def test_refuses_nan():
    angles = standing()
    angles[2, 1] = np.nan
    with pytest.raises(InputError, match=r"angles\[2, 1\] is nan"):
        centre_of_mass(hexapod(), angles)


@pytest.mark.parametrize("xp", [jnp, array_api_strict], ids=["jax", "strict"])
@pytest.mark.parametrize("massless", [False, True])
def test_other_libraries_agree(xp, massless):
    rng = np.random.default_rng(3)
    robot = random_hexapod(rng)
    robot = robot.replace(link_mass=None) if massless else robot
    angles = rng.uniform(-2, 2, (5, 6, 3))
    com = centre_of_mass(robot, xp.asarray(angles))
    assert isinstance(com, type(xp.asarray(angles)))
    np.testing.assert_allclose(np.asarray(com), centre_of_mass(robot, angles), rtol=0, atol=1e-14)


def test_jax_transforms():
    rng = np.random.default_rng(4)
    robot = random_hexapod(rng)
    angles = rng.uniform(-2, 2, (5, 6, 3))
    want = centre_of_mass(robot, angles)
    com = jax.vmap(jax.jit(lambda q: centre_of_mass(robot, q)))(jnp.asarray(angles))
    np.testing.assert_allclose(com, want, rtol=0, atol=1e-14)
    slope = jax.jit(jax.jacobian(lambda q: centre_of_mass(robot, q)))(angles[0])
    step = 1e-6
    for leg, joint in ((0, 0), (2, 1), (5, 2)):
        change = np.zeros((6, 3))
        change[leg, joint] = step
        difference = (centre_of_mass(robot, angles[0] + change) - centre_of_mass(robot, angles[0] - change)) / (
            2 * step
        )
        np.testing.assert_allclose(slope[:, leg, joint], difference, rtol=0, atol=1e-9)


def test_a_design_can_be_differentiated_down_to_no_coxa():
    robot = hexapod(coxa=np.zeros(6), link_com=np.zeros((6, 3)))

    def height(femur, coxa):
        return centre_of_mass(robot.replace(femur=femur, coxa=coxa), standing())[2]

    by_femur, by_coxa = jax.grad(height, argnums=(0, 1))(jnp.asarray(robot.femur), jnp.asarray(robot.coxa))
    # A longer femur lifts the knee, from which the tibia's mass hangs; a longer coxa lifts nothing.
    np.testing.assert_allclose(by_femur, 0.08 * np.sin(np.deg2rad(35)) / total_mass(robot), rtol=1e-12)
    np.testing.assert_allclose(by_coxa, 0, atol=1e-15)


@pytest.mark.parametrize("massless", [False, True])
def test_the_weights_of_the_leg_points_give_the_same_centre(massless):
    rng = np.random.default_rng(3)
    robot = random_hexapod(rng)
    robot = robot.replace(link_mass=None) if massless else robot
    weights = MassWeights.of(robot)
    for angles in rng.uniform(-2, 2, (5, 6, 3)):
        com = weights.centre_of_mass(forward_kinematics(robot, angles))
        np.testing.assert_allclose(com, centre_of_mass(robot, angles), rtol=0, atol=1e-15)
