import array_api_strict
import jax
import jax.numpy as jnp
import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots import plain_hexapod, random_angles, random_robot, robots, seeds
from tarsus.blocks import BLOCK
from tarsus.errors import InputError
from tarsus.kinematics.leg import forward_kinematics, leg_jacobian
from tarsus.robot.robot import stack_robots


def pinocchio_model(robot):
    """The robot as Pinocchio knows it: revolute joints about z, -y, -y, and a frame at every point of every leg."""
    model = pin.Model()
    points = []
    for leg in range(robot.legs):
        yaw = robot.mount_yaw[leg]
        place = pin.SE3(pin.utils.rotate("z", yaw), robot.mount_position[leg])
        axis = np.array([robot.coxa[leg], *robot.femur_axis_offset[leg]])
        coxa = model.addJoint(0, pin.JointModelRZ(), place, f"coxa{leg}")
        down = np.array([0.0, -1.0, 0.0])
        femur = model.addJoint(coxa, pin.JointModelRevoluteUnaligned(down), pin.SE3(np.eye(3), axis), f"femur{leg}")
        along = pin.SE3(np.eye(3), np.array([robot.femur[leg], 0, 0]))
        tibia = model.addJoint(femur, pin.JointModelRevoluteUnaligned(down), along, f"tibia{leg}")
        foot = pin.SE3(np.eye(3), np.array([robot.tibia[leg], 0, 0]))
        still = pin.SE3.Identity()
        for name, joint, offset in (
            ("c", coxa, still),
            ("f", femur, still),
            ("k", tibia, still),
            ("foot", tibia, foot),
        ):
            points.append(model.addFrame(pin.Frame(f"{name}{leg}", joint, offset, pin.FrameType.OP_FRAME)))
    return model, points


@settings(max_examples=25)
@given(robot=robots(), seed=seeds())
def test_points_and_jacobian_agree_with_pinocchio(robot, seed):
    rng = np.random.default_rng(seed)
    model, frames = pinocchio_model(robot)
    data = model.createData()
    for _ in range(4):
        q = rng.uniform(-np.pi, np.pi, (robot.legs, 3))
        pin.framesForwardKinematics(model, data, q.ravel())
        expected = np.array([data.oMf[f].translation for f in frames]).reshape(robot.legs, 4, 3)
        assert np.abs(forward_kinematics(robot, q) - expected).max() <= 1e-14
        pin.computeJointJacobians(model, data, q.ravel())
        found = leg_jacobian(robot, q)
        for leg in range(robot.legs):
            J = pin.getFrameJacobian(model, data, frames[4 * leg + 3], pin.LOCAL_WORLD_ALIGNED)[:3]
            own = slice(3 * leg, 3 * leg + 3)
            assert np.abs(found[leg] - J[:, own]).max() <= 1e-14
            assert not np.delete(J, own, axis=1).any()


@given(robot=robots(), seed=seeds())
def test_the_jacobian_is_the_finite_difference(robot, seed):
    q = np.random.default_rng(seed).uniform(-np.pi, np.pi, (robot.legs, 3))
    step = 1e-6
    found = leg_jacobian(robot, q)
    for joint in range(3):
        moved = step * np.eye(3)[joint]
        ends = [forward_kinematics(robot, q + sign * moved)[:, 3] for sign in (1, -1)]
        assert np.abs(found[..., joint] - (ends[0] - ends[1]) / (2 * step)).max() <= 1e-9


def test_the_jacobian_agrees_with_jax():
    robot = random_robot(np.random.default_rng(1))
    q = random_angles(np.random.default_rng(2), robot)
    full = jax.jacobian(lambda q: forward_kinematics(robot, q)[:, 3])(jnp.asarray(q))
    for leg in range(robot.legs):
        assert np.abs(np.asarray(full[leg, :, leg]) - leg_jacobian(robot, q)[leg]).max() <= 1e-15


def test_all_joints_at_zero_is_the_leg_straight_out_and_level():
    robot = plain_hexapod(femur_axis_offset=np.tile([0.01, -0.02], (6, 1)))
    points = forward_kinematics(robot, np.zeros((6, 3)))
    c, s = np.cos(robot.mount_yaw), np.sin(robot.mount_yaw)
    out, left = np.stack([c, s, 0 * c], axis=-1), np.stack([-s, c, 0 * c], axis=-1)
    for i, far in enumerate((0.068, 0.068 + 0.098, 0.068 + 0.098 + 0.181), start=1):
        expected = robot.mount_position + far * out + 0.01 * left + [0, 0, -0.02]
        assert np.abs(points[:, i] - expected).max() <= 1e-16
    assert np.array_equal(points[:, 0], robot.mount_position)


@pytest.mark.parametrize(("joint", "moved"), [(0, (0, 1, 0)), (1, (0, 0, 1)), (2, (0, 0, 1))])
def test_positive_angles_turn_counter_clockwise_and_lift(joint, moved):
    robot = plain_hexapod(mount_yaw=np.zeros(6))
    q = np.zeros((6, 3))
    rest = forward_kinematics(robot, q)[:, 3]
    q[:, joint] = 1e-3
    assert (((forward_kinematics(robot, q)[:, 3] - rest) @ moved) > 1e-4).all()


@pytest.mark.parametrize("compute", [forward_kinematics, leg_jacobian])
@pytest.mark.parametrize("legs", [4, 5, 6, 8])
@pytest.mark.parametrize("batch", [(7,), (3, 5), (0,), (0, 2), (BLOCK // 4 + 3,), (2, BLOCK // 8 + 5)])
def test_a_batch_equals_its_loop(compute, legs, batch):
    rng = np.random.default_rng(legs)
    robot = random_robot(rng, legs=legs)
    q = rng.uniform(-np.pi, np.pi, (*batch, legs, 3))
    found = compute(robot, q)
    assert found.shape[:-2] == (*batch, legs)
    items = list(np.ndindex(batch))
    for i in [*items[:3], *items[-3:], *items[:: max(len(items) // 20, 1)]]:
        assert np.abs(found[i] - compute(robot, q[i])).max() <= 1e-14


@pytest.mark.parametrize("compute", [forward_kinematics, leg_jacobian])
def test_a_thousand_designs_in_one_call(compute):
    rng = np.random.default_rng(4)
    designs = [random_robot(rng) for _ in range(1000)]
    q = rng.uniform(-np.pi, np.pi, (1000, 6, 3))
    found = compute(stack_robots(designs), q)
    assert np.abs(found - np.stack([compute(r, a) for r, a in zip(designs, q, strict=True)])).max() <= 1e-14


@pytest.mark.parametrize("xp", [np, jnp])
def test_designs_against_poses(xp):
    rng = np.random.default_rng(5)
    designs = [random_robot(rng) for _ in range(5)]
    batch = stack_robots(designs)
    column = batch.replace(
        **{name: getattr(batch, name)[:, None] for name in NUMBERS}, body_com=batch.body_com[:, None]
    )
    q = rng.uniform(-1, 1, (7, 6, 3))
    found = np.asarray(forward_kinematics(column, xp.asarray(q)))
    assert found.shape == (5, 7, 6, 4, 3)
    assert np.abs(found - np.stack([forward_kinematics(r, q) for r in designs])).max() <= 1e-14


NUMBERS = (
    *("mount_position", "mount_yaw", "coxa", "femur", "tibia", "limits"),
    *("femur_axis_offset", "foot_radius", "link_com"),
)


@pytest.mark.parametrize("xp", [np, jnp])
@pytest.mark.parametrize("compute", [forward_kinematics, leg_jacobian])
def test_designs_that_differ_in_one_number(xp, compute):
    femurs = np.linspace(0.05, 0.15, 4)[:, None] * np.ones(6)
    one = plain_hexapod()
    q = np.full((6, 3), 0.3)
    found = np.asarray(compute(one.replace(femur=femurs), xp.asarray(q)))
    assert np.abs(found - np.stack([compute(one.replace(femur=f), q) for f in femurs])).max() <= 1e-15
    masses = one.replace(body_mass=np.ones(4))
    assert np.asarray(compute(masses, xp.asarray(q))).shape == found.shape


@pytest.mark.parametrize("xp", [jnp, array_api_strict])
@pytest.mark.parametrize("compute", [forward_kinematics, leg_jacobian])
def test_other_libraries_agree_with_numpy(xp, compute):
    rng = np.random.default_rng(6)
    robot = random_robot(rng)
    q = rng.uniform(-np.pi, np.pi, (9, 6, 3))
    found = compute(robot, xp.asarray(q))
    assert type(found) is type(xp.zeros(1))
    assert np.abs(np.asarray(found) - compute(robot, q)).max() <= 1e-15


def test_jit_and_vmap_agree_with_numpy():
    rng = np.random.default_rng(7)
    robot = random_robot(rng)
    q = rng.uniform(-np.pi, np.pi, (9, 6, 3))
    found = jax.jit(jax.vmap(lambda a: forward_kinematics(robot, a)))(q)
    assert np.abs(np.asarray(found) - forward_kinematics(robot, q)).max() <= 1e-15


def test_the_gradient_with_respect_to_a_length_is_the_finite_difference():
    robot = plain_hexapod()
    q = random_angles(np.random.default_rng(8), robot)

    def lowest(femur):
        return forward_kinematics(robot.replace(femur=femur), q)[:, 3, 2].sum()

    found = jax.grad(lowest)(jnp.asarray(robot.femur))
    assert np.abs(np.asarray(found) - np.sin(q[:, 1])).max() <= 1e-15


@pytest.mark.parametrize("compute", [forward_kinematics, leg_jacobian])
@pytest.mark.parametrize(
    ("angles", "message"),
    [
        (np.zeros(3), r"angles has shape \(3,\); expected \(..., 6, 3\)"),
        (np.zeros((5, 3)), r"angles has shape \(5, 3\); expected \(..., 6, 3\)"),
        (np.full((6, 3), np.nan), r"angles\[0, 0\] is nan; 18 of 18"),
        (np.full((6, 3), np.inf), r"angles\[0, 0\] is inf"),
        ("zero", "angles: expected an array of real numbers"),
        (np.zeros((6, 3)) * 1j, "angles: expected an array of real numbers, got complex128"),
    ],
)
def test_invalid_arguments_are_refused(compute, angles, message):
    with pytest.raises(InputError, match=message):
        compute(plain_hexapod(), angles)


def test_batches_that_do_not_broadcast_are_named():
    robot = stack_robots([plain_hexapod()] * 4)
    for xp in (np, jnp):
        with pytest.raises(InputError, match=r"the robot and the angles don't broadcast: \(4,\) and \(3,\)"):
            forward_kinematics(robot, xp.zeros((3, 6, 3)))


@given(batch=st.sampled_from([(), (400,)]), kind=st.sampled_from([np.int64, np.float32]))
@settings(max_examples=4)
def test_any_kind_of_input_is_accepted_and_not_modified(batch, kind):
    robot = plain_hexapod()
    q = np.ones((*batch, 6, 3), dtype=kind)
    before = q.copy()
    found = forward_kinematics(robot, q)
    assert np.array_equal(q, before)
    assert np.array_equal(found, forward_kinematics(robot, q.astype(float)))
    assert not np.shares_memory(found, q)
