import array_api_strict
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from sample_robots import hexapod, random_hexapod, standing
from tarsus.errors import InputError
from tarsus.kinematics import rest as rest_module
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.polygon import hull_margin
from tarsus.kinematics.rest import CORNERS, resting_pose
from tarsus.kinematics.roll import settle
from tarsus.robot.robot import Robot, stack_robots

jax.config.update("jax_enable_x64", True)

BOX = np.array([0.24, 0.16, 0.05])
UP = np.deg2rad(np.tile([0.0, 80.0, 0.0], (6, 1)))
"""All legs straight up in the air."""


def all_points(robot, angles):
    """Everything that can touch the ground, in B."""
    legs = forward_kinematics(robot, angles)
    legs = legs.reshape(*legs.shape[:-3], -1, 3)
    if robot.body_size is None:
        return legs
    corners = np.broadcast_to(robot.body_size * CORNERS, (*legs.shape[:-2], 8, 3))
    return np.concatenate([legs, corners], axis=-2)


def in_ground(robot, angles, rest):
    points = rest.body @ all_points(robot, angles)
    com = rest.body @ centre_of_mass(robot, angles)
    return points, com


def facets(points):
    """The hull's faces, coplanar triangles merged: outward normals, and the indices of each face's corners."""
    hull = ConvexHull(points)
    _, offsets = np.unique(np.round(hull.equations, 9), axis=0, return_index=True)
    equations = hull.equations[offsets]
    corners = [np.flatnonzero(np.abs(points @ e[:3] + e[3]) < 1e-9) for e in equations]
    return equations, corners


def check_at_rest(robot, angles, rest):
    points, com = in_ground(robot, angles, rest)
    assert points[..., 2].min() == pytest.approx(0, abs=1e-12)
    touching = points[..., 2] < 1e-9 + 1e-12
    down = np.concatenate([rest.leg_points_down.reshape(-1), rest.corners_down])
    assert not (down & ~touching).any()
    margin = hull_margin(points[:, :2], down, com[:2])
    assert rest.stable
    assert rest.margin == pytest.approx(max(margin, 0), abs=1e-12)
    assert margin > -1.1e-9
    np.testing.assert_array_equal(rest.contacts, rest.leg_points_down[:, 3])
    rotation = rest.body.rotation
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-14)
    assert np.linalg.det(rotation) == pytest.approx(1)
    assert rest.body.rpy[2] == pytest.approx(0, abs=1e-9)
    np.testing.assert_array_equal(rest.body.position[:2], 0)


@pytest.mark.parametrize("box", [True, False])
@pytest.mark.parametrize("seed", range(6))
def test_it_rests_on_a_face_of_the_hull(seed, box):
    rng = np.random.default_rng(seed)
    robot = random_hexapod(rng, box=box)
    for angles in rng.uniform(-2, 2, (12, 6, 3)):
        rest = resting_pose(robot, angles)
        check_at_rest(robot, angles, rest)
        points, com = all_points(robot, angles), centre_of_mass(robot, angles)
        equations, corners = facets(points)
        downness = equations[:, :3] @ -rest.body.rotation[2]
        face = np.argmax(downness)
        assert downness[face] == pytest.approx(1, abs=1e-12)
        height_over_face = -(equations[face, :3] @ com + equations[face, 3])
        ground, com_in_ground = in_ground(robot, angles, rest)
        assert com_in_ground[2] == pytest.approx(height_over_face, abs=1e-12)
        polygon = ConvexHull(ground[corners[face], :2])
        depth = -np.max(polygon.equations[:, :2] @ com_in_ground[:2] + polygon.equations[:, 2])
        assert rest.margin == pytest.approx(depth, abs=1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_near_a_stance_it_rests_on_the_face_below_the_centre_of_mass(seed):
    """From the face that a plumb line from the centre pierces, over the edges that the centre is beyond."""
    rng = np.random.default_rng(seed)
    robot = random_hexapod(rng)
    for angles in standing() + rng.uniform(-0.15, 0.15, (20, 6, 3)):
        points, com = all_points(robot, angles), centre_of_mass(robot, angles)
        hull = ConvexHull(points)
        normals, offsets = hull.equations[:, :3], hull.equations[:, 3]
        below = normals[:, 2] < -1e-9
        drop = np.where(below, (normals @ com + offsets) / np.where(below, normals[:, 2], 1), np.inf)
        face = np.argmin(drop)
        for _ in range(20):
            foot = com - (normals[face] @ com + offsets[face]) * normals[face]
            corners = points[hull.simplices[face]]
            beyond = []
            for i in range(3):
                a, b = np.delete(corners, i, axis=0)
                outward = np.cross(b - a, normals[face])
                outward *= -np.sign(outward @ (corners[i] - a)) / np.linalg.norm(outward)
                beyond.append(outward @ (foot - a))
            if max(beyond) <= 0:
                break
            face = hull.neighbors[face][np.argmax(beyond)]
        np.testing.assert_allclose(resting_pose(robot, angles).body.rotation[2], -normals[face], atol=1e-9)


@pytest.mark.no_cover
def test_it_follows_the_steepest_descent():
    """The same way in twenty thousand small steps down the slope of the centre's height, with no idea of contacts."""
    rng = np.random.default_rng(11)
    robot = random_hexapod(rng)
    angles = rng.uniform(-1.6, 1.6, (80, 6, 3))
    arms = centre_of_mass(robot, angles)[:, None] - all_points(robot, angles)
    up = np.broadcast_to([0.0, 0.0, 1.0], (80, 3))
    step = 8e-3
    for _ in range(20000):
        lowest = np.argmax(np.einsum("bni,bi->bn", arms, up), axis=1)
        slope = np.take_along_axis(arms, lowest[:, None, None], axis=1)[:, 0]
        slope = slope - np.sum(slope * up, axis=1, keepdims=True) * up
        up = up - step * slope
        up = up / np.linalg.norm(up, axis=1, keepdims=True)
    rest = resting_pose(robot, angles)
    turned = np.linalg.norm(rest.body.rotation[:, 2] - up, axis=1)
    assert np.mean(rest.rolls > 1) > 0.5
    assert turned.max() < 5e-3


@pytest.mark.parametrize("box", [True, False])
def test_the_centre_of_mass_never_rises(box):
    rng = np.random.default_rng(12)
    robot = random_hexapod(rng, box=box)
    angles = rng.uniform(-np.pi, np.pi, (300, 6, 3))
    final = resting_pose(robot, angles)
    before = np.full(300, np.inf)
    for rolls in range(int(final.rolls.max()) + 1):
        rest = resting_pose(robot, angles, max_rolls=rolls)
        points, com = in_ground(robot, angles, rest)
        assert (com[:, 2] <= before + 1e-12).all()
        assert (points[..., 2] >= -1e-12).all()
        np.testing.assert_array_equal(rest.rolls, np.minimum(rolls, final.rolls))
        np.testing.assert_array_equal(rest.stable, final.rolls <= rolls)
        before = com[:, 2]
    assert final.rolls.max() > 3
    assert final.stable.all()


@given(st.integers(0, 10**6), st.booleans(), st.data())
def test_any_robot_at_any_angles_comes_to_rest(seed, box, data):
    """Multiples of 15 degrees and equal legs: points that coincide, lie in one plane, touch at the same time."""
    rng = np.random.default_rng(seed)
    robot = random_hexapod(rng, box=box) if seed % 2 else hexapod(body_size=BOX if box else None)
    one = st.tuples(*[st.integers(-12, 12)] * 3)
    steps = data.draw(st.lists(one, min_size=6, max_size=6) | one.map(lambda leg: [leg] * 6))
    angles = np.deg2rad(15.0 * np.array(steps))
    check_at_rest(robot, angles, resting_pose(robot, angles))


def test_standing():
    robot = hexapod(body_size=BOX)
    rest = resting_pose(robot, standing())
    feet = forward_kinematics(robot, standing())[:, 3]
    np.testing.assert_allclose(rest.body.rotation, np.eye(3), atol=1e-15)
    np.testing.assert_allclose(rest.body.position, [0, 0, -feet[0, 2]], atol=1e-15)
    assert rest.margin == pytest.approx(np.hypot(*feet[0, :2]) * np.cos(np.pi / 6))
    assert rest.contacts.all()
    assert rest.leg_points_down.sum() == 6
    assert not rest.corners_down.any()
    assert rest.rolls == 0
    assert rest.robot is robot
    assert rest.describe() == f"stands on 6 feet: LF, LM, LR, RR, RM, RF; stability margin {1000 * rest.margin:.1f} mm"


def test_a_raised_leg_changes_nothing_and_a_long_one_tips_the_robot():
    robot = hexapod(body_size=BOX)
    angles = standing()
    angles[1, 1] += 0.2
    rest = resting_pose(robot, angles)
    np.testing.assert_allclose(rest.body.rotation, np.eye(3), atol=1e-15)
    assert rest.describe().startswith("stands on 5 feet: LF, LR, RR, RM, RF; ")
    names = ("front left", "middle left", "mid left", "rear right", "middle right", "front right")
    assert ": front left, mid left, rear right, " in resting_pose(robot.replace(leg_names=names), angles).describe()
    angles[1, 1] -= 0.3
    rest = resting_pose(robot, angles)
    assert rest.contacts[1]
    assert rest.contacts.sum() == 3
    assert rest.body.rpy[0] > 0.01  # the left side is lifted
    assert rest.margin > 0


def test_on_the_belly_with_the_legs_up():
    robot = hexapod(body_size=BOX)
    rest = resting_pose(robot, UP)
    np.testing.assert_array_equal(rest.corners_down, CORNERS[:, 2] < 0)
    assert rest.body.position[2] == pytest.approx(0.025)
    assert rest.margin == pytest.approx(0.08)
    assert rest.describe() == "lies on its belly; stability margin 80.0 mm"


def test_without_a_box_the_coxa_axes_are_the_belly():
    rest = resting_pose(hexapod(coxa=np.zeros(6)), UP)
    assert rest.corners_down.shape == (0,)
    assert rest.leg_points_down[:, 0].all()
    assert rest.body.position[2] == 0
    assert rest.margin == pytest.approx(0.086 * np.cos(np.pi / 6))
    assert rest.describe().startswith("lies on its belly and the femur axes LF, LM, LR, RR, RM, RF; ")


def test_on_the_belly_and_feet():
    robot = hexapod(body_size=BOX)
    angles = UP.copy()
    # The feet of one side just at the height of the belly: knee 98 mm up, then down by 123 mm.
    angles[:3] = [0, np.pi / 2, -np.pi / 2 - np.arcsin((0.098 + 0.025) / 0.181)]
    rest = resting_pose(robot, angles)
    assert rest.describe().startswith("lies on its belly and the feet LF, LM, LR; stability margin ")


@pytest.mark.parametrize(
    ("push", "face", "angles"),
    [
        ([0.08, 0, 0], "front", [0, 90, 0]),
        ([-0.08, 0, 0], "rear", [0, -90, 0]),
        ([0, 0.08, 0], "left side", [-90, 0, 0]),
        ([0, -0.08, 0], "right side", [90, 0, 0]),
    ],
)
def test_a_tall_body_tips_to_the_side_of_its_centre_of_mass(push, face, angles):
    """No legs to speak of; the corners of the box are what it lies on."""
    size = np.array([0.1, 0.1, 0.3])
    robot = hexapod(
        body_size=size,
        body_com=push,
        mount_position=np.zeros((6, 3)),
        **{link: np.full(6, 0.001) for link in ("coxa", "femur", "tibia")},
        link_mass=None,
    )
    rest = resting_pose(robot, standing())
    assert (
        rest.describe() == f"lies on its {face}; stability margin 50.0 mm (masses unknown: margin of the body's centre)"
    )
    np.testing.assert_allclose(rest.body.rpy, np.deg2rad(angles), atol=1e-9)
    assert rest.body.position[2] == pytest.approx(0.05)
    assert rest.corners_down.sum() == 4
    assert rest.rolls == 1


def test_on_its_knees():
    robot = hexapod(body_size=BOX)
    rest = resting_pose(robot, np.deg2rad(np.tile([0.0, -60.0, 90.0], (6, 1))))
    assert rest.leg_points_down[:, 2].all()
    assert not rest.contacts.any()
    assert rest.describe().startswith("rests on the knees LF, LM, LR, RR, RM, RF; stability margin ")
    angles = np.deg2rad(np.tile([0.0, -60.0, 90.0], (6, 1)))
    angles[1] = [0, np.deg2rad(-60), -np.pi / 6]
    assert "the foot LM and the knees" in resting_pose(robot, angles).describe()


def test_onto_the_back_by_more_than_one_roll():
    """Top-heavy to the left, the left legs folded inward: over the side, which does not hold it, onto the back."""
    robot = hexapod(body_size=BOX, body_com=[0, 0.06, 0.02], link_mass=np.full((6, 3), 0.01))
    angles = np.deg2rad([[0.0, -90.0, -45.0]] * 3 + [[0.0, -30.0, -60.0]] * 3)
    rest = resting_pose(robot, angles)
    check_at_rest(robot, angles, rest)
    assert rest.rolls > 3
    np.testing.assert_array_equal(rest.corners_down, CORNERS[:, 2] > 0)
    np.testing.assert_allclose(np.abs(rest.body.rpy), [np.pi, 0, 0], atol=1e-9)
    assert rest.describe().startswith("lies on its back; stability margin 29.")


def four_legged(yaws, angles, **changes):
    """No mass but the body's, no coxa, the mounts where the body's centre is."""
    robot = Robot(
        name="cross",
        leg_names=("a", "b", "c", "d"),
        mount_position=np.zeros((4, 3)),
        mount_yaw=np.deg2rad(yaws),
        coxa=np.zeros(4),
        femur=np.full(4, 0.1),
        tibia=np.full(4, 0.1),
        limits=np.broadcast_to(np.array([-np.pi, np.pi]), (4, 3, 2)),
        **changes,
    )
    return robot, np.deg2rad(np.array(angles, dtype=float))


LEVEL, DOWN, STILT = [0, 0, 0], [0, -90, 0], [0, -60, 0]


@pytest.mark.parametrize(
    ("yaws", "angles", "rpy_signs"),
    [
        ([0, 90, 180, -90], [DOWN, LEVEL, LEVEL, LEVEL], (0, 1, 0)),  # on a point: forward
        ([0, 90, 180, -90], [LEVEL, STILT, LEVEL, STILT], (0, 1, 0)),  # on an edge across: forward
        ([0, 90, 180, -90], [STILT, LEVEL, STILT, LEVEL], (-1, 0, 0)),  # on an edge along: left
        ([45, 135, 225, -45], [STILT, LEVEL, STILT, LEVEL], (1, 1, 0)),  # on a diagonal: forward, to the right
        ([45, 135, 225, -45], [LEVEL, STILT, LEVEL, STILT], (-1, 1, 0)),  # on the other: forward, to the left
    ],
)
def test_the_direction_in_which_a_balanced_robot_tips(yaws, angles, rpy_signs):
    robot, angles = four_legged(yaws, angles)
    upright = resting_pose(robot, angles, max_rolls=0)
    assert not upright.stable
    assert upright.margin == pytest.approx(0, abs=1e-12)
    rest = resting_pose(robot, angles, max_rolls=1)
    assert rest.rolls == 1
    turns = np.where(np.abs(rest.body.rpy) < 1e-12, 0, np.sign(rest.body.rpy))
    np.testing.assert_array_equal(turns, rpy_signs)
    np.testing.assert_array_equal(resting_pose(robot, angles).stable, True)


def test_over_the_edge_of_a_polygon_with_an_area_it_rests_with_margin_zero():
    robot, angles = four_legged([0, 90, 180, -90], [STILT, STILT, LEVEL, STILT])
    rest = resting_pose(robot, angles)
    assert rest.stable
    assert rest.rolls == 0
    assert rest.margin == pytest.approx(0, abs=1e-15)
    assert rest.describe() == (
        "stands on 3 feet: a, b, d; stability margin 0.0 mm (masses unknown: margin of the body's centre)"
    )


def test_a_centre_of_mass_outside_the_robot_is_never_stable():
    robot, angles = four_legged([0, 90, 180, -90], [LEVEL] * 4, body_com=[1.0, 0, 0])
    rest = resting_pose(robot, angles)
    assert not rest.stable
    assert rest.margin == pytest.approx(-0.8)
    assert rest.describe() == (
        "does not come to rest; after 0 rolls it lies on its belly and the feet a, b, c, d"
        " and the knees a, b, c, d and the femur axes a, b, c, d"
    )
    robot, angles = four_legged([0, 90, 180, -90], [DOWN, LEVEL, LEVEL, LEVEL])
    rest = resting_pose(robot, angles, max_rolls=0)
    assert rest.describe() == "does not come to rest; after 0 rolls it stands on 1 foot: a"


def test_batch_equals_loop(monkeypatch):
    rng = np.random.default_rng(13)
    robots = [random_hexapod(rng) for _ in range(2)]
    angles = rng.uniform(-2, 2, (5, 1, 6, 3))
    monkeypatch.setattr(rest_module, "BLOCK", 3 * 6)
    together = resting_pose(stack_robots(robots), angles)
    assert together.leg_points_down.shape == (5, 2, 6, 4)
    assert together.corners_down.shape == (5, 2, 8)
    for i in range(5):
        for j in range(2):
            alone = resting_pose(robots[j], angles[i, 0])
            np.testing.assert_allclose(together.body.rotation[i, j], alone.body.rotation, rtol=0, atol=1e-14)
            np.testing.assert_allclose(together.body.position[i, j], alone.body.position, rtol=0, atol=1e-14)
            np.testing.assert_allclose(together.margin[i, j], alone.margin, rtol=0, atol=1e-14)
            for name in ("contacts", "leg_points_down", "corners_down", "stable", "rolls"):
                np.testing.assert_array_equal(getattr(together, name)[i, j], getattr(alone, name))


@pytest.mark.parametrize("box", [True, False])
def test_a_single_robot_that_stands_as_lowered_is_not_settled(monkeypatch, box):
    """The short way of a robot that doesn't roll gives what the general one gives."""
    rng = np.random.default_rng(21)
    robot = hexapod(body_size=BOX if box else None)
    # With equal legs, of which some are raised, it stands level, or rolls where those on the ground don't carry it.
    angles = [standing() + np.array([0.0, 1.0, 0.0]) * raised[:, None] for raised in rng.integers(0, 2, (60, 6)) * 0.3]
    general = [resting_pose(robot, one[None]) for one in (*angles, UP)]
    angles.append(UP)
    lowered = [index for index, rest in enumerate(general) if rest.rolls[0] == 0 and rest.margin[0] > 1e-9]
    assert 10 < len(lowered) < 60

    def refuse(*_args, **_options):
        raise AssertionError("it is settled")

    monkeypatch.setattr(rest_module, "settle", refuse)
    for index in lowered:
        alone, want = resting_pose(robot, angles[index]), general[index]
        np.testing.assert_allclose(alone.body.rotation, want.body.rotation[0], rtol=0, atol=0)
        np.testing.assert_allclose(alone.body.position, want.body.position[0], rtol=0, atol=0)
        np.testing.assert_allclose(alone.margin, want.margin[0], rtol=0, atol=1e-15)
        for name in ("contacts", "leg_points_down", "corners_down", "stable", "rolls"):
            np.testing.assert_array_equal(getattr(alone, name), getattr(want, name)[0])
            assert getattr(alone, name).dtype == getattr(want, name).dtype


def test_an_empty_batch():
    rest = resting_pose(hexapod(body_size=BOX), np.zeros((0, 6, 3)))
    assert rest.margin.shape == (0,)
    assert rest.body.batch_shape == (0,)
    assert rest.corners_down.shape == (0, 8)


@pytest.mark.no_cover
@pytest.mark.parametrize(("xp", "shape"), [(jnp, ()), (array_api_strict, ()), (array_api_strict, (2, 3))])
def test_other_libraries_agree(xp, shape):
    robot = random_hexapod(np.random.default_rng(14))
    angles = standing() + np.random.default_rng(15).uniform(-0.2, 0.2, (*shape, 6, 3))
    want, rest = resting_pose(robot, angles), resting_pose(robot, xp.asarray(angles))
    assert want.rolls.min() > 0
    np.testing.assert_allclose(np.asarray(rest.body.rotation), want.body.rotation, rtol=0, atol=1e-13)
    np.testing.assert_allclose(np.asarray(rest.margin), want.margin, rtol=0, atol=1e-13)
    np.testing.assert_array_equal(np.asarray(rest.leg_points_down), want.leg_points_down)
    np.testing.assert_array_equal(np.asarray(rest.corners_down), want.corners_down)
    if not shape:
        assert rest.describe() == want.describe()


def test_one_array_of_another_library_makes_the_result_one():
    robot = random_hexapod(np.random.default_rng(14))
    mixed = robot.replace(body_size=jnp.asarray(robot.body_size))
    rest = resting_pose(mixed, UP)
    assert isinstance(rest.margin, jax.Array)
    np.testing.assert_allclose(rest.margin, resting_pose(robot, UP).margin, rtol=0, atol=1e-14)


def test_in_single_precision_nearly_level_feet_touch_together():
    cube = np.float32(0.1) * CORNERS.astype(np.float32)
    cube[0, 2] += np.float32(2e-6)
    points, com = tuple(cube.T[..., None]), tuple(np.zeros((3, 1), dtype=np.float32))
    settled = settle(np, points, com, max_rolls=4)
    assert settled.down.sum() == 4
    assert settled.margin.dtype == np.float32
    double = settle(np, tuple(p.astype(float) for p in points), tuple(np.zeros((3, 1))), max_rolls=4)
    assert double.down.sum() == 3


def test_invalid_arguments_are_refused():
    robot, angles = hexapod(), standing()
    with pytest.raises(InputError, match="max_rolls is -1; it must not be negative"):
        resting_pose(robot, angles, max_rolls=-1)
    for traced in (robot, robot.replace(link_mass=None)):
        with pytest.raises(InputError, match="can't be traced"):
            jax.jit(lambda q, traced=traced: resting_pose(traced, q).margin)(angles)
    with pytest.raises(InputError, match=r"this is a batch of shape \(2,\)"):
        resting_pose(robot, np.stack([angles, angles])).describe()
    angles[3, 2] = np.nan
    with pytest.raises(InputError, match=r"angles\[3, 2\] is nan"):
        resting_pose(robot, angles)
