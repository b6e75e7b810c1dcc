import array_api_strict
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from robots import seeds
from tarsus.errors import InputError
from tarsus.kinematics.pose import Pose, rpy_from_rotation

angles = st.floats(-np.pi, np.pi)


def random_pose(rng, batch=()):
    turns = Rotation.random(int(np.prod(batch)), random_state=rng).as_matrix().reshape(*batch, 3, 3)
    return Pose(turns, rng.uniform(-1, 1, (*batch, 3)))


def carried(pose, points):
    """Each point by each pose, by the definition."""
    return np.einsum("...ij,...j->...i", pose.rotation, points) + pose.position


@given(roll=angles, pitch=angles, yaw=angles)
def test_roll_pitch_yaw_agree_with_scipy(roll, pitch, yaw):
    expected = Rotation.from_euler("ZYX", [yaw, pitch, roll]).as_matrix()
    assert np.abs(Pose.from_rpy(roll, pitch, yaw).rotation - expected).max() <= 1e-15


@given(roll=angles, pitch=st.floats(-1.57, 1.57), yaw=angles)
def test_roll_pitch_yaw_are_reproduced(roll, pitch, yaw):
    # At pitch 1.57, 0.8 mrad from where roll and yaw are one, the cosine costs three digits.
    found = Pose.from_rpy(roll, pitch, yaw).rpy
    turn = np.angle(np.exp(1j * (found - [roll, pitch, yaw])))
    assert np.abs(turn).max() <= 1e-15 / np.cos(pitch) * 4


@pytest.mark.parametrize("pitch", [np.pi / 2, -np.pi / 2])
def test_at_pitch_90_degrees_the_rotation_is_reproduced(pitch):
    rotation = Pose.from_rpy(0.3, pitch, 0.4).rotation
    assert np.abs(Pose.from_rpy(*rpy_from_rotation(rotation)).rotation - rotation).max() <= 1e-15


@given(seed=seeds())
def test_composition_and_inverse_agree_with_scipy(seed):
    rng = np.random.default_rng(seed)
    a, b = random_pose(rng), random_pose(rng, (4,))
    chained = a @ b
    turns = Rotation.from_matrix(a.rotation) * Rotation.from_matrix(b.rotation)
    assert np.abs(chained.rotation - turns.as_matrix()).max() <= 1e-14
    assert np.abs(chained.position - carried(a, b.position)).max() <= 1e-15
    back = b.inverse()
    assert np.abs(back.rotation - Rotation.from_matrix(b.rotation).inv().as_matrix()).max() <= 1e-14
    home = back @ b
    assert np.abs(home.rotation - np.eye(3)).max() <= 1e-14
    assert np.abs(home.position).max() <= 1e-14


@given(seed=seeds())
def test_composition_transforms_points_successively(seed):
    rng = np.random.default_rng(seed)
    a, b, points = random_pose(rng, (5, 3)), random_pose(rng, (5, 1)), rng.uniform(-1, 1, (5, 3, 7, 3))
    assert np.abs((a @ b) @ points - a @ (b @ points)).max() <= 1e-14


@pytest.mark.parametrize(
    ("batch", "points", "expected"),
    [
        ((), (3,), (3,)),
        ((), (6, 3), (6, 3)),
        ((), (2, 6, 4, 3), (2, 6, 4, 3)),
        ((5,), (3,), (5, 3)),
        ((5,), (5, 3), (5, 3)),
        ((5,), (1, 6, 3), (5, 6, 3)),
        ((5,), (5, 6, 3), (5, 6, 3)),
        ((5,), (5, 6, 4, 3), (5, 6, 4, 3)),
        ((4, 5), (5, 3), (4, 5, 3)),
        ((4, 5), (4, 5, 6, 3), (4, 5, 6, 3)),
        ((4, 1), (1, 5, 6, 3), (4, 5, 6, 3)),
        ((0,), (0, 6, 3), (0, 6, 3)),
    ],
)
def test_the_leading_axes_of_points_are_the_poses_batch_axes(batch, points, expected):
    rng = np.random.default_rng(1)
    pose, p = random_pose(rng, batch), rng.uniform(-1, 1, points)
    found = pose @ p
    assert found.shape == expected
    between = max(len(points) - 1 - len(batch), 0)
    spread = Pose(
        pose.rotation.reshape(*batch, *(1,) * between, 3, 3), pose.position.reshape(*batch, *(1,) * between, 3)
    )
    assert np.array_equal(found, carried(spread, p)) or np.abs(found - carried(spread, p)).max() <= 1e-15


@pytest.mark.parametrize(("batch", "points"), [((5,), (6, 3)), ((5,), (6, 5, 3)), ((4, 5), (5, 6, 3))])
def test_points_that_do_not_broadcast_are_refused(batch, points):
    with pytest.raises(InputError, match="the batch axes of the pose and the points don't broadcast"):
        random_pose(np.random.default_rng(1), batch) @ np.zeros(points)


def test_position_and_rotation_broadcast():
    pose = Pose(np.eye(3), np.zeros((7, 3)))
    assert pose.batch_shape == (7,)
    assert Pose().batch_shape == ()
    with pytest.raises(InputError, match=r"a pose don't broadcast: \(2,\) and \(3,\)"):
        Pose(np.tile(np.eye(3), (2, 1, 1)), np.zeros((3, 3)))


def test_items_of_a_batch():
    poses = random_pose(np.random.default_rng(2), (4, 5))
    one = poses[1, 2]
    assert np.array_equal(one.rotation, poses.rotation[1, 2])
    assert np.array_equal(one.position, poses.position[1, 2])
    assert poses[1].batch_shape == (5,)
    assert poses[:, 3].batch_shape == (4,)
    assert poses[..., 0].batch_shape == (4,)
    level = Pose(np.eye(3), np.arange(12.0).reshape(4, 3))
    assert np.array_equal(level[2].rotation, np.eye(3))
    with pytest.raises(InputError, match="a single pose has no batch axes"):
        Pose()[0]


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Pose(np.eye(4)), r"rotation has shape \(4, 4\); expected \(..., 3, 3\)"),
        (lambda: Pose(np.eye(3), np.zeros(4)), r"position has shape \(4,\); expected \(..., 3\)"),
        (lambda: Pose(np.full((3, 3), np.nan)), r"rotation\[0, 0\] is nan; 9 of 9"),
        (lambda: Pose(np.eye(3), [0, np.inf, 0]), r"position\[1\] is inf; 1 of 3"),
        (lambda: Pose(np.eye(3), "here"), "position: expected an array of real numbers"),
        (lambda: Pose.from_rpy(roll=np.nan), "roll is nan"),
        (lambda: Pose.from_rpy(pitch=[0, np.inf]), r"pitch\[1\] is inf"),
        (lambda: Pose.from_rpy(yaw=1j), "yaw: expected an array of real numbers"),
        (lambda: Pose.from_rpy([0, 0], [0, 0, 0]), "the batch axes of roll, pitch and yaw don't broadcast"),
        (lambda: Pose() @ np.zeros(4), r"points has shape \(4,\)"),
        (lambda: Pose() @ "points", "points: expected an array of real numbers"),
        (lambda: Pose() @ [0, 0, np.nan], r"points\[2\] is nan"),
    ],
)
def test_invalid_arguments_are_refused(make, message):
    with pytest.raises(InputError, match=message):
        make()


def test_a_pose_is_a_value():
    rotation, position = np.eye(3), np.zeros((4, 3))
    shared = np.broadcast_to(rotation, (4, 3, 3))
    locked_view = position[:]
    locked_view.setflags(write=False)
    poses = [Pose(rotation, position), Pose(shared, locked_view)]
    rotation[0, 0], position[0, 0] = 5, 5
    for pose in poses:
        assert pose.rotation.max() == 1
        assert pose.position.max() == 0
        with pytest.raises(ValueError, match="read-only"):
            pose.position[0, 0] = 1
        with pytest.raises(ValueError, match="read-only"):
            pose.rotation[..., 0, 0] = 1


def test_locked_arrays_are_shared_not_copied():
    pose = Pose(np.eye(3), np.ones(3))
    again = Pose(pose.rotation, pose.position)
    assert again.rotation is pose.rotation
    assert pose.inverse().inverse().rotation.base is pose.rotation


def test_any_kind_of_numbers_is_accepted():
    pose = Pose(np.eye(3, dtype=int), [1, 2, 3])
    assert (pose @ [1, 1, 1]).tolist() == [2.0, 3.0, 4.0]
    assert (pose @ np.ones(3, dtype=np.float32)).dtype == np.float64


@pytest.mark.parametrize("xp", [jnp, array_api_strict])
def test_other_libraries_agree_with_numpy(xp):
    rng = np.random.default_rng(3)
    rpy, position, points = rng.uniform(-1, 1, (4, 3)), rng.uniform(-1, 1, (4, 3)), rng.uniform(-1, 1, (4, 6, 3))

    def compute(xp):
        r = xp.asarray(rpy)
        pose = Pose.from_rpy(r[:, 0], r[:, 1], r[:, 2], xp.asarray(position))
        chained = pose @ pose.inverse() @ Pose.from_rpy(0.1, 0.2, 0.3, [1, 2, 3]) @ pose
        return chained @ xp.asarray(points), chained.rpy, chained[2].position, pose @ points, chained.rotation

    for found, expected in zip(compute(xp), compute(np), strict=True):
        assert type(found) is type(xp.zeros(1))
        assert np.abs(np.asarray(found) - expected).max() <= 1e-14


def test_gradients_pass_through_poses():
    def height(rpy):
        return (Pose.from_rpy(rpy[0], rpy[1], rpy[2]) @ np.array([[0.3, 0.2, 0.1]]))[0, 2]

    at = np.array([0.1, 0.2, 0.3])
    step = 1e-6
    expected = [(height(at + step * e) - height(at - step * e)) / (2 * step) for e in np.eye(3)]
    assert np.abs(jax.jit(jax.grad(height))(jnp.asarray(at)) - np.array(expected)).max() <= 1e-9


@pytest.mark.parametrize(
    "wrong", [2 * np.eye(3), np.diag([1.0, 1.0, -1.0]), np.diag([2.0, 0.5, 1.0]), np.zeros((3, 3))]
)
def test_matrices_that_scale_or_mirror_are_refused(wrong):
    with pytest.raises(InputError, match="rotation is not a rotation matrix"):
        Pose(np.stack([np.eye(3), wrong]), np.zeros(3))


def test_a_rotation_in_single_precision_is_accepted():
    rotation = np.asarray(Pose.from_rpy(0.3, -0.7, 2.0).rotation, dtype=np.float32)
    assert np.allclose(Pose(rotation, np.zeros(3)).rotation, rotation)
