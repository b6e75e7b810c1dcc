from decimal import Decimal, localcontext

import array_api_strict
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots import (
    FULL_TURN,
    edge_angles,
    front,
    plain_hexapod,
    random_angles,
    random_robot,
    robots,
    seeds,
)
from tarsus.blocks import BLOCK
from tarsus.errors import InputError
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.reach import Reach
from tarsus.robot.file import list_robots, load_robot
from tarsus.robot.robot import stack_robots

KNEES = ("up", "down")


def feet_of(robot, angles):
    return forward_kinematics(robot, angles)[..., 3, :]


def in_branch(robot, knee):
    """The robot with its tibias' limits cut to one knee branch, where they allow any of it."""
    limits = np.array(robot.limits)
    low, high = limits[..., 2, 0], limits[..., 2, 1]
    if knee == "up":
        high[low <= 0] = np.minimum(high, 0)[low <= 0]
    else:
        low[high >= 0] = np.maximum(low, 0)[high >= 0]
    return robot.replace(limits=limits)


def random_body(rng, batch=()):
    tilt = rng.uniform(-0.5, 0.5, (2, *batch))
    return Pose.from_rpy(*tilt, rng.uniform(-3, 3, batch), rng.uniform([-1, -1, 1], [1, 1, 3], (*batch, 3)))


@pytest.mark.parametrize("knee", KNEES)
@pytest.mark.parametrize("with_body", [False, True])
@pytest.mark.parametrize("draw", [random_angles, edge_angles])
@given(robot=robots(), seed=seeds())
def test_every_foot_that_angles_within_the_limits_reach_is_reached(draw, with_body, knee, robot, seed):
    """FK(IK(p)) = p to 1e-12 m: anywhere, at the limits, behind the coxa axis, straight and folded."""
    rng = np.random.default_rng(seed)
    feet = feet_of(robot, draw(rng, in_branch(robot, knee), (20,)))
    body = random_body(rng, (20,)) if with_body else None
    solution = inverse_kinematics(robot, feet if body is None else body @ feet, body, knee=knee)
    assert solution.ok.all()
    assert np.abs(feet_of(robot, solution.angles) - feet).max() <= 1e-12


@pytest.mark.parametrize("knee", KNEES)
@pytest.mark.parametrize("draw", [random_angles, edge_angles])
@pytest.mark.parametrize("name", list_robots())
def test_every_preset_reaches_its_whole_workspace(name, draw, knee):
    rng = np.random.default_rng(9)
    robot = load_robot(name)
    feet = feet_of(robot, draw(rng, in_branch(robot, knee), (2000,)))
    body = random_body(rng, (2000,))
    for asked, place in ((feet, None), (body @ feet, body)):
        solution = inverse_kinematics(robot, asked, place, knee=knee)
        assert solution.ok.all()
        assert np.abs(feet_of(robot, solution.angles) - feet).max() <= 1e-12


@given(seed=seeds(), equal=st.booleans())
def test_without_limits_both_knee_branches_reach(seed, equal):
    rng = np.random.default_rng(seed)
    robot = random_robot(rng, limits="full", equal=equal)
    feet = feet_of(robot, random_angles(rng, robot, (50,)))
    up, down = (inverse_kinematics(robot, feet, knee=knee).require().angles for knee in KNEES)
    for angles in (up, down):
        assert np.abs(feet_of(robot, angles) - feet).max() <= 1e-12
    assert (up[..., 2] <= 0).all()
    assert (down[..., 2] >= 0).all()


@given(seed=seeds(), equal=st.booleans())
def test_angles_are_reproduced(seed, equal):
    """IK(FK(q)) = q to 1e-10 rad, the knee up, the foot in front of the coxa axis by a millimetre or more.

    Within 1 mrad of the straight or folded leg the foot's position, itself rounded to 1e-16 m, no longer tells
    the angles: there to 1e-6 rad, at a femur axis that the foot almost touches to 1e-16 m over their distance.
    """
    rng = np.random.default_rng(seed)
    robot = random_robot(rng, limits="up", equal=equal)
    q = random_angles(rng, robot, (100,))
    bend = rng.choice([0.0, 1e-9, 1e-6, 1e-3], q.shape[:-1]) * rng.random(q.shape[:-1])
    q[..., 2] = np.where(rng.random(q.shape[:-1]) < 0.3, -bend, q[..., 2])
    q[..., 2] = np.where(rng.random(q.shape[:-1]) < 0.2, bend - np.pi, q[..., 2])
    found = inverse_kinematics(robot, feet_of(robot, q)).require().angles
    off = np.abs(np.angle(np.exp(1j * (found - q)))).max(-1)
    ahead = front(robot, q) > 1e-3
    apart = np.hypot(robot.femur + robot.tibia * np.cos(q[..., 2]), robot.tibia * np.sin(q[..., 2]))
    telling = (np.abs(q[..., 2]) >= 1e-3) & (q[..., 2] >= 1e-3 - np.pi)
    assert off[ahead & telling].max() <= 1e-10
    clear = ahead & ~telling & (apart > 1e-3)
    assert off[clear].max(initial=0) <= 1e-6


def with_decimals(robot, leg, foot):
    """Femur and tibia of the knee-up solution to 40 digits, from the foot in the leg's plane as it is, unrounded."""
    with localcontext() as context:
        context.prec = 50
        g = robot.geometry
        x, z = (Decimal(float(v)) for v in foot)
        r = x - Decimal(float(g.coxa[leg]))
        f, t = Decimal(float(robot.femur[leg])), Decimal(float(robot.tibia[leg]))
        d2 = r * r + z * z
        cosine = (d2 - f * f - t * t) / (2 * f * t)
        sine = -(1 - cosine * cosine).sqrt()
        # tan of half the tibia's angle, and the foot's two coordinates turned back by the femur's
        k, m = f + t * cosine, t * sine
        return cosine, sine, (z * k - r * m, r * k + z * m)


def decimal_atan2(y, x):
    """An angle from its tangent: two Newton steps from the double's angle give 30 digits."""
    with localcontext() as context:
        context.prec = 50
        angle = Decimal(float(np.arctan2(float(y), float(x))))
        for _ in range(3):
            c, s = cos_sin(angle)
            angle += (y * c - x * s) / (x * c + y * s)
        return angle


def cos_sin(angle):
    cosine, sine, term, n = Decimal(1), Decimal(0), Decimal(1), 0
    while abs(term) > Decimal(10) ** -48:
        n += 1
        term *= angle / n
        if n % 2:
            sine += term if n % 4 == 1 else -term
        else:
            cosine += term if n % 4 == 0 else -term
    return cosine, sine


def by_arc_cosines(robot, r, z):
    """The textbook's form: two arc cosines, each rounded by itself."""
    f, t = robot.femur[0], robot.tibia[0]
    d = np.hypot(r, z)
    inner = np.arccos(np.clip((f * f + d * d - t * t) / (2 * f * d), -1, 1))
    knee = np.arccos(np.clip((f * f + t * t - d * d) / (2 * f * t), -1, 1))
    return np.arctan2(z, r) + inner, knee - np.pi


@pytest.mark.parametrize(("from_end", "bound"), [(1e-1, 2e-14), (1e-3, 2e-12), (1e-5, 2e-10), (1e-7, 2e-8)])
@pytest.mark.parametrize("folded", [False, True])
def test_accuracy_near_the_straight_and_folded_leg(folded, from_end, bound):
    """Against 50 digits for the very same foot.

    The angles are off by 1e-15 rad over the bend, which is what the rounding of a foot's position makes of them in any
    form. But the errors of femur and tibia cancel, and the foot is where it should be to 2e-16 m. Those of two arc
    cosines don't: measured, at a bend of 1e-7 rad their foot is off by 2.5e-10 m, half the digits lost.
    """
    robot = plain_hexapod(
        coxa=np.full(6, 0.2),  # so long that the folded leg's foot is in front of the coxa axis
        mount_yaw=np.zeros(6),
        mount_position=np.zeros((6, 3)),
        limits=np.tile(FULL_TURN, (6, 1, 1)),
    )
    worst = {"angle": 0.0, "foot": 0.0, "textbook": 0.0}
    for femur in np.linspace(-1.2, 1.2, 25):
        bend = from_end * (1 + 0.1 * femur)
        q = np.zeros((6, 3))
        q[:, 1], q[:, 2] = femur, -np.pi + bend if folded else -bend
        feet = feet_of(robot, q)
        feet[:, 1] = 0.0  # in the plane exactly, as the 50 digits have it
        x, z = feet[0, 0], feet[0, 2]
        found = inverse_kinematics(robot, feet).require().angles
        cosine, sine, (up, out) = with_decimals(robot, 0, (x, z))
        for joint, true in ((1, decimal_atan2(up, out)), (2, decimal_atan2(sine, cosine))):
            worst["angle"] = max(worst["angle"], abs(float(Decimal(float(found[0, joint])) - true)))
        worst["foot"] = max(worst["foot"], np.abs(feet_of(robot, found)[0] - feet[0]).max())
        textbook = found.copy()
        textbook[:, 1], textbook[:, 2] = by_arc_cosines(robot, x - robot.coxa[0], z)
        worst["textbook"] = max(worst["textbook"], np.abs(feet_of(robot, textbook)[0] - feet[0]).max())
    assert worst["angle"] <= bound
    assert worst["foot"] <= 2e-16
    assert worst["textbook"] >= 1e-18 / from_end


def at_leg(robot, points):
    """Points given in every leg's own coxa frame, raised to the femur axis: carried into B."""
    g = robot.geometry
    x, y, z = np.moveaxis(np.broadcast_to(np.asarray(points, dtype=float), (robot.legs, 3)), -1, 0)
    out = (g.cos_yaw * x - g.sin_yaw * y, g.sin_yaw * x + g.cos_yaw * y, z + g.up)
    return np.stack(out, axis=-1) + robot.mount_position


def within_limits(robot, angles):
    low, high = np.moveaxis(robot.limits, -1, 0)
    return (angles >= low - 1e-9).all() and (angles <= high + 1e-9).all()


@pytest.mark.no_cover
@pytest.mark.parametrize("knee", KNEES)
@given(robot=robots(), seed=seeds())
def test_angles_are_always_within_the_limits(knee, robot, seed):
    rng = np.random.default_rng(seed)
    feet = rng.uniform(-1, 1, (60, robot.legs, 3)) * 10 ** rng.uniform(-12, 4, (60, 1, 1))
    feet[0] = robot.mount_position
    assert within_limits(robot, inverse_kinematics(robot, feet, knee=knee).angles)
    assert within_limits(robot, inverse_kinematics(robot, feet, random_body(rng), knee=knee).angles)


@pytest.mark.parametrize("knee", KNEES)
@pytest.mark.parametrize("sideways", [0.0, 0.02])
@pytest.mark.parametrize("shift", [0.0, 1.0, -1.5])
def test_at_singular_points_an_angle_within_the_limits_is_chosen(knee, sideways, shift):
    """On the coxa axis any coxa angle will do, on the femur axis of a leg that folds any femur angle."""
    limits = np.tile(np.deg2rad([[-40, 40], [-40, 40], [-180, 180]]), (6, 1, 1))
    limits[:, :2] += shift
    robot = plain_hexapod(
        tibia=np.full(6, 0.098),
        limits=limits,
        femur_axis_offset=np.tile([sideways, 0.01], (6, 1)),
        coxa=np.full(6, 0.05),
    )
    on_femur_axis = forward_kinematics(robot, np.tile([shift, 0, 0], (6, 1)))[:, 1]
    solution = inverse_kinematics(robot, on_femur_axis, knee=knee)
    assert solution.ok
    assert np.abs(feet_of(robot, solution.angles) - on_femur_axis).max() <= 1e-15
    assert within_limits(robot, solution.angles)
    straight = feet_of(robot, np.tile([shift, shift, 0], (6, 1)))
    solution = inverse_kinematics(robot, straight, knee=knee)
    assert solution.ok
    assert np.abs(solution.angles - [shift, shift, 0]).max() <= 1e-7
    on_coxa_axis = at_leg(robot, [0, 0, -0.01])
    solution = inverse_kinematics(robot, on_coxa_axis, knee=knee)
    assert within_limits(robot, solution.angles)
    if sideways:
        assert (solution.reach == Reach.TOO_NEAR).all()


@pytest.mark.parametrize("shift", [0.0, 1.0, -1.5])
def test_a_foot_on_the_coxa_axis_is_within_reach_whatever_the_coxas_limits(shift):
    limits = np.tile(np.deg2rad([[-40, 40], [-180, 180], [-180, 0]]), (6, 1, 1))
    limits[:, 0] += shift
    robot = plain_hexapod(limits=limits)
    feet = at_leg(robot, [0.0, 0.0, -0.2])
    solution = inverse_kinematics(robot, feet)
    assert solution.ok
    assert within_limits(robot, solution.angles)
    assert np.abs(feet_of(robot, solution.angles) - feet).max() <= 1e-15


@pytest.mark.parametrize("size", [0.0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-4])
@pytest.mark.parametrize("what", ["femur axis", "coxa axis"])
def test_a_foot_slightly_too_near_is_not_reached(size, what):
    """Femur and tibia that differ by `size`, or an offset of `size`: the miss, told apart from 1e-13 m on."""
    changes = {"tibia": np.full(6, 0.098 + size)} if what == "femur axis" else {}
    limits = np.tile([[-1, 1], [-np.pi, np.pi], [-np.pi, np.pi]], (6, 1, 1))
    offset = size if what == "coxa axis" else 0
    robot = plain_hexapod(limits=limits, femur_axis_offset=np.tile([offset, 0], (6, 1)), **changes)
    solution = inverse_kinematics(robot, at_leg(robot, [0.068, 0, 0] if what == "femur axis" else [0, 0, -0.2]))
    miss = np.linalg.norm(feet_of(robot, solution.angles) - solution.feet, axis=-1)
    assert np.abs(miss - size).max() <= 1e-15
    assert solution.reach.tolist() == [0 if size < 1e-13 else Reach.TOO_NEAR] * 6


def test_a_leg_limited_to_the_other_branch_uses_it():
    limits = np.tile(np.deg2rad([[-60, 60], [-90, 90], [10, 150]]), (6, 1, 1))
    robot = plain_hexapod(limits=limits)
    q = random_angles(np.random.default_rng(1), robot, (50,))
    for bent, feet, knee in ((robot, feet_of(robot, q), "up"), (robot, feet_of(robot, q), "down")):
        solution = inverse_kinematics(bent, feet, knee=knee)
        assert solution.ok.all()
        assert (solution.angles[..., 2] > 0).all()
    mirrored = plain_hexapod(limits=-limits[..., ::-1])
    solution = inverse_kinematics(mirrored, feet_of(mirrored, -q), knee="down").require()
    assert (solution.angles[..., 2] < 0).all()


def test_a_foot_behind_the_coxa_axis_is_reached_backwards():
    robot = plain_hexapod(limits=np.tile(np.deg2rad([[-30, 30], [-90, 170], [-170, 0]]), (6, 1, 1)))
    q = np.tile(np.deg2rad([10.0, 150, -30]), (6, 1))
    assert (front(robot, q) < 0).all()
    solution = inverse_kinematics(robot, feet_of(robot, q)).require()
    assert np.abs(solution.angles - q).max() <= 1e-14


@pytest.mark.parametrize("with_body", [False, True])
@pytest.mark.parametrize(
    ("legs", "batch"),
    [
        (4, (7,)),
        (5, (3, 5)),
        (6, (0,)),
        (6, (0, 2)),
        (8, (7,)),
        (8, (400,)),
        (6, (2, BLOCK // 12 + 5)),
        (4, (BLOCK // 4 + 3,)),
    ],
)
def test_a_batch_equals_its_loop(batch, legs, with_body):
    rng = np.random.default_rng(legs)
    robot = random_robot(rng, legs=legs)
    feet = feet_of(robot, random_angles(rng, robot, batch)) + rng.normal(0, 0.003, (*batch, legs, 3))
    body = None
    if with_body:
        body = Pose.from_rpy(
            *rng.uniform(-0.5, 0.5, (3, *batch)), rng.uniform([-1, -1, -0.1], [1, 1, 0.4], (*batch, 3))
        )
        feet = body @ feet
    found = inverse_kinematics(robot, feet, body)
    assert found.angles.shape == (*batch, legs, 3)
    assert found.reach.shape == (*batch, legs)
    assert found.ok.shape == batch
    items = list(np.ndindex(batch))
    for i in [*items[:3], *items[-3:], *items[:: max(len(items) // 20, 1)]]:
        one = inverse_kinematics(robot, feet[i], body[i] if with_body else None)
        assert np.array_equal(found.reach[i], one.reach)
        assert np.abs(found.angles[i] - one.angles).max() <= 1e-14


@pytest.mark.no_cover
@pytest.mark.parametrize("with_body", [False, True])
def test_a_thousand_designs_in_one_call(with_body):
    rng = np.random.default_rng(4)
    designs = [random_robot(rng) for _ in range(1000)]
    feet, body = rng.uniform(-0.3, 0.3, (6, 3)), random_body(rng) if with_body else None
    feet = feet if body is None else body @ feet
    found = inverse_kinematics(stack_robots(designs), feet, body)
    loop = [inverse_kinematics(r, feet, body) for r in designs[::7]]
    assert found.angles.shape == (1000, 6, 3)
    assert np.array_equal(found.reach[::7], np.stack([s.reach for s in loop]))
    assert np.abs(found.angles[::7] - np.stack([s.angles for s in loop])).max() <= 1e-14


def both(solve, xp, *arrays):
    """Angles and codes as NumPy arrays; JAX's from jitted code, which compiles faster than its single steps."""

    def compute(*arrays):
        solution = solve(*arrays)
        return solution.angles, solution.reach

    compute = jax.jit(compute) if xp is jnp else compute
    return tuple(np.asarray(a) for a in compute(*(xp.asarray(a) for a in arrays)))


DIFFERENT = {
    "coxa": np.linspace(0.03, 0.15, 5)[:, None] * np.ones(6),
    "femur": np.linspace(0.03, 0.15, 5)[:, None] * np.ones(6),
    "mount_yaw": np.linspace(0.03, 0.15, 5)[:, None] * np.ones(6),
    "limits": np.linspace(0.2, 3, 5)[:, None, None, None] * np.array([-1, 1]) * np.ones((6, 3, 1)),
    "body_mass": np.linspace(1, 2, 5),
}


@pytest.mark.parametrize(
    ("xp", "what"), [*((np, what) for what in DIFFERENT), (jnp, "femur"), (jnp, "limits"), (jnp, "body_mass")]
)
@pytest.mark.parametrize("spread", [0.001, 0.2])
def test_designs_that_differ_in_one_number(xp, what, spread):
    one, values = plain_hexapod(), DIFFERENT[what]
    batch = one.replace(**{what: values})
    rng = np.random.default_rng(2)
    feet = feet_of(one, np.tile([0.0, 0.1, -0.2], (6, 1))) + rng.uniform(-spread, spread, (7, 1, 6, 3))
    angles, reach = both(lambda p: inverse_kinematics(batch, p), xp, feet)
    assert angles.shape == (7, 5, 6, 3)
    for i, value in enumerate(values):
        expected = inverse_kinematics(one.replace(**{what: value}), feet[:, 0])
        assert np.array_equal(reach[:, i], expected.reach)
        assert np.abs(angles[:, i] - expected.angles).max() <= 1e-13


@pytest.mark.parametrize("batches", [((), (9,)), ((9,), ()), ((4, 1), (9,)), ((1,), (400, 1))])
def test_feet_and_bodies_broadcast(batches):
    rng = np.random.default_rng(3)
    robot = random_robot(rng)
    feet, body = rng.uniform(-0.3, 0.3, (*batches[0], 6, 3)), random_body(rng, batches[1])
    feet[..., 2] += 2
    whole = np.broadcast_shapes(*batches)
    found = inverse_kinematics(robot, feet, body)
    spread = Pose(np.broadcast_to(body.rotation, (*whole, 3, 3)), np.broadcast_to(body.position, (*whole, 3)))
    expected = inverse_kinematics(robot, np.broadcast_to(feet, (*whole, 6, 3)), spread)
    assert np.array_equal(found.reach, expected.reach)
    assert np.abs(found.angles - expected.angles).max() <= 1e-14


def mixed_case(rng, *, sideways):
    """A robot and feet of which some are reached, some not, some with the body in the ground."""
    robot = random_robot(rng, sideways=sideways)
    feet = feet_of(robot, random_angles(rng, robot, (30,))) + rng.normal(0, 0.02, (30, 6, 3))
    body = Pose.from_rpy(*rng.uniform(-0.3, 0.3, (3, 30)), rng.uniform([-1, -1, -0.05], [1, 1, 0.3], (30, 3)))
    return robot, body @ feet, body


def assert_alike(found, expected, *, sideways):
    assert np.array_equal(np.asarray(found[1]), expected.reach)
    # Where turn and distance are corrected in turn, rounding decides which of two points equally near is kept.
    unlike = 0.02 if sideways else 1e-9
    off = np.abs(np.asarray(found[0]) - expected.angles)
    assert (off <= np.where(expected.reach[..., None] == 0, 1e-12, unlike)).all()


@pytest.mark.parametrize(("xp", "sideways"), [(jnp, 0.0), (array_api_strict, 0.0), (array_api_strict, 0.02)])
def test_other_libraries_agree_with_numpy(xp, sideways):
    robot, feet, body = mixed_case(np.random.default_rng(5), sideways=sideways)
    theirs = Pose(xp.asarray(np.asarray(body.rotation)), xp.asarray(np.asarray(body.position)))
    found = inverse_kinematics(robot, xp.asarray(feet), theirs)
    expected = inverse_kinematics(robot, feet, body)
    assert type(found.angles) is type(xp.zeros(1))
    assert_alike((found.angles, found.reach), expected, sideways=sideways)
    assert np.array_equal(np.asarray(found.ok), expected.ok)
    assert set(np.unique(expected.reach)) >= {0, 6}
    if not sideways:
        assert found.explain() == expected.explain()


@pytest.mark.parametrize("sideways", [0.0, 0.02])
def test_jit_and_vmap_agree_with_numpy(sideways):
    robot, feet, body = mixed_case(np.random.default_rng(6), sideways=sideways)

    def one(feet, rotation, position):
        solution = inverse_kinematics(robot, feet, Pose(rotation, position))
        return solution.angles, solution.reach

    found = jax.jit(jax.vmap(one))(feet, body.rotation, body.position)
    assert_alike(found, inverse_kinematics(robot, feet, body), sideways=sideways)


def test_single_precision_passes_through_jax():
    robot = plain_hexapod()
    feet = feet_of(robot, np.tile([0.1, 0.4, -1.5], (6, 1))).astype(np.float32)
    feet[5] += 1
    found = jax.jit(lambda p: inverse_kinematics(robot, p).angles)(jnp.asarray(feet))
    assert np.abs(np.asarray(found) - inverse_kinematics(robot, feet).angles).max() <= 1e-12


def test_the_gradient_with_respect_to_the_feet_is_the_inverse_jacobian():
    robot = random_robot(np.random.default_rng(7), limits="up")
    q = np.tile([0.1, 0.5, -1.4], (6, 1))
    feet = jnp.asarray(feet_of(robot, q))

    def there_and_back(p):
        return forward_kinematics(robot, inverse_kinematics(robot, p).angles)[..., 3, :]

    full = np.asarray(jax.jacobian(there_and_back)(feet))
    expected = np.eye(18).reshape(6, 3, 6, 3)
    assert np.abs(full - expected).max() <= 1e-12


def test_gradients_with_respect_to_a_length_are_the_finite_differences():
    robot = plain_hexapod()
    feet = feet_of(robot, np.tile([0.1, 0.4, -1.5], (6, 1)))
    feet[1] = robot.mount_position[1] * 6  # far out of reach

    def tibias(length):
        changed = robot.replace(
            femur=length * robot.femur if isinstance(length, float) else length * jnp.asarray(robot.femur)
        )
        return inverse_kinematics(changed, feet).angles.sum()

    step = 1e-6
    found = jax.jit(jax.grad(tibias))(jnp.asarray(1.0))
    assert abs(float(found) - (tibias(1 + step) - tibias(1 - step)) / (2 * step)) <= 1e-7


@pytest.mark.no_cover
@pytest.mark.parametrize(("offset", "equal"), [(0.0, True), (0.01, False)])
def test_gradients_are_finite_at_singular_and_unreachable_points_too(offset, equal, monkeypatch):
    monkeypatch.setattr("tarsus.kinematics.nearest._STEP_SIZES", (1.0,))  # compiles in a third of the time
    robot = plain_hexapod(
        femur_axis_offset=np.tile([offset, 0], (6, 1)), **({"tibia": np.full(6, 0.098)} if equal else {})
    )
    q = np.tile([0.0, 0.3, -1.4], (6, 1))
    feet = feet_of(robot, q)
    feet[0] = robot.mount_position[0]
    feet[1] = forward_kinematics(robot, q)[1, 1]
    feet[2] = feet_of(robot, np.zeros((6, 3)))[2]
    feet[3] *= 10
    feet[4] = at_leg(robot, [-0.1, 0, -0.1])[4]

    def length(femur, p):
        changed = robot.replace(femur=femur)
        return (inverse_kinematics(changed, p).angles ** 2).sum()

    found = jax.jit(jax.grad(length, argnums=(0, 1)))(jnp.asarray(robot.femur), jnp.asarray(feet))
    assert all(np.isfinite(np.asarray(g)).all() for g in found)


@pytest.mark.parametrize(
    ("feet", "message"),
    [
        (np.zeros(3), r"feet has shape \(3,\); expected \(..., 6, 3\)"),
        (np.zeros((3, 6)), r"feet has shape \(3, 6\); expected \(..., 6, 3\)"),
        (np.full((2, 6, 3), np.nan), r"feet\[0, 0, 0\] is nan; 36 of 36 values are not finite"),
        (np.where(np.arange(18).reshape(6, 3) == 4, np.inf, 0), r"feet\[1, 1\] is inf; 1 of 18"),
        ([["a"] * 3] * 6, "feet: expected an array of real numbers, got <U1"),
        (np.ones((6, 3)) * 1j, "feet: expected an array of real numbers, got complex128"),
        (None, "feet: expected an array of real numbers"),
    ],
)
def test_invalid_arguments_are_refused(feet, message):
    with pytest.raises(InputError, match=message):
        inverse_kinematics(plain_hexapod(), feet)


@pytest.mark.parametrize("knee", ["sideways", "UP", 1, None])
def test_a_wrong_knee_is_refused(knee):
    with pytest.raises(InputError) as caught:
        inverse_kinematics(plain_hexapod(), np.zeros((6, 3)), knee=knee)
    assert str(caught.value) == f"knee is {knee!r}; it can be 'up' or 'down'"


@pytest.mark.parametrize("xp", [np, jnp])
def test_batches_that_do_not_broadcast_are_named(xp):
    feet, body = xp.zeros((3, 6, 3)), Pose(np.eye(3), np.zeros((4, 3)))
    with pytest.raises(InputError, match=r"the robot, the feet and the body's poses don't broadcast: \(\) and \(3,\)"):
        inverse_kinematics(plain_hexapod(), feet, body)


@given(batch=st.sampled_from([(), (400,)]), kind=st.sampled_from([np.int64, np.float32, np.float64]))
@settings(max_examples=6)
def test_any_kind_of_input_is_accepted_not_modified_and_not_kept(batch, kind):
    robot = plain_hexapod()
    feet = np.full((*batch, 6, 3), 1, dtype=kind)
    feet[..., :3, :] = 0
    before = feet.copy()
    found = inverse_kinematics(robot, feet)
    assert np.array_equal(feet, before)
    assert np.array_equal(found.angles, inverse_kinematics(robot, feet.astype(float)).angles)
    text = found.explain()
    feet[...] = 7
    assert found.explain() == text
    for array in (found.angles, found.reach, found.feet):
        assert not np.shares_memory(array, feet)
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0


@pytest.mark.parametrize("library", [np, jnp])
@pytest.mark.parametrize("knee", ["up", "down"])
def test_a_leg_whose_limits_allow_one_knee_branch_tells_why_that_one_fails(library, knee):
    limits = np.tile(np.deg2rad([[-60, 60], [-80, 30], [10, 160]]), (6, 1, 1))
    robot = plain_hexapod(limits=limits)
    # 15 deg below the lower limit of the femur.
    feet = forward_kinematics(robot, np.tile(np.deg2rad([0.0, -95.0, 90.0]), (6, 1)))[:, 3]
    found = inverse_kinematics(robot, library.asarray(feet), knee=knee)
    assert set(np.asarray(found.reach).tolist()) == {int(Reach.FEMUR_LIMIT)}
    if library is np:
        assert "the femur angle would be -95.0 deg, 15.0 deg below its lower limit of -80.0 deg" in found.explain()


@pytest.mark.parametrize("name", ["explain", "require", "explain_leg"])
def test_under_jit_a_solution_is_not_explained(name):
    arguments = [(0,)] if name == "explain_leg" else []

    @jax.jit
    def explained(feet):
        getattr(inverse_kinematics(load_robot("strider"), feet), name)(*arguments)
        return feet

    with pytest.raises(
        InputError, match=f"^{name} can't be traced: it depends on which legs fail; call it outside jit"
    ):
        explained(jnp.zeros((6, 3)))
