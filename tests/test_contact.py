"""Contact forces: equilibrium, non-negative forces, tipping."""

import array_api_strict
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pinocchio_model import Reference
from sample_robots import hexapod, random_hexapod, standing
from tarsus.errors import InputError, MissingDataError
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import centre_of_mass, total_mass
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stability import stability_margin
from tarsus.load.contact import GRAVITY, contact_forces
from tarsus.load.payload import Payload, as_payload
from tarsus.robot.robot import stack_robots

TRIPOD = np.array([True, False] * 3)
ALL = np.ones(6, bool)


def feet_of(*down):
    return np.array(down, dtype=bool)


def random_case(rng, batch=()):
    """Random robot, angles, tilted bodies, contacts and payload."""
    robot = random_hexapod(rng)
    angles = standing() + rng.uniform(-0.5, 0.5, (*batch, 6, 3))
    body = Pose.from_rpy(*rng.uniform(-0.3, 0.3, (2, *batch)), rng.uniform(-3, 3, batch), rng.normal(size=(*batch, 3)))
    contacts = rng.random((*batch, 6)) < 0.7
    contacts[..., rng.integers(6)] = True
    return robot, angles, body, contacts, Payload(rng.uniform(0, 2), tuple(rng.uniform(-0.05, 0.05, 3)))


def moments_about(point, robot, angles, body, payload, gravity, forces):
    """Moment of weight and contact forces about a point of G."""
    feet = body @ forward_kinematics(robot, angles)[..., 3, :]
    weights = [(total_mass(robot), centre_of_mass(robot, angles)), (payload.mass, np.array(payload.position))]
    total = np.cross(feet - point, forces).sum(0)
    for mass, place in weights:
        total += np.cross(body @ place - point, mass * np.asarray(gravity))
    return total


@given(st.integers(0, 2**32 - 1))
def test_equilibrium(seed):
    rng = np.random.default_rng(seed)
    robot, angles, body, contacts, payload = random_case(rng)
    gravity = np.array(GRAVITY) + rng.uniform(-3, 3, 3) * (seed % 2)
    found = contact_forces(robot, angles, body, contacts, payload=payload, gravity=gravity)
    assert (found.forces @ -gravity >= 0).all()
    assert (found.forces[~contacts] == 0).all()
    weight = (total_mass(robot) + payload.mass) * np.linalg.norm(gravity)
    np.testing.assert_allclose(found.weight, weight, rtol=1e-14)
    np.testing.assert_allclose(found.forces.sum(0), -(total_mass(robot) + payload.mass) * gravity, rtol=0, atol=1e-12)
    moment = moments_about(rng.normal(size=3), robot, angles, body, payload, gravity, found.forces)
    if found.balanced:
        np.testing.assert_allclose(moment, 0, rtol=0, atol=1e-9)
        base, _ = Reference(robot, payload=payload, gravity=gravity).residual(angles, body, found.forces)
        np.testing.assert_allclose(base, 0, rtol=0, atol=1e-9)
    # Without equilibrium, the residual is the tipping moment.
    np.testing.assert_allclose(np.linalg.norm(moment), found.tipping_moment, rtol=0, atol=1e-9)
    if not seed % 2 and not payload.mass:
        np.testing.assert_allclose(found.margin, stability_margin(robot, angles, body, contacts), rtol=0, atol=1e-12)


@pytest.mark.parametrize("feet", [ALL, TRIPOD, feet_of(1, 1, 0, 1, 1, 0)], ids=["six", "three", "four"])
def test_symmetric_stances_have_equal_forces(feet):
    found = contact_forces(hexapod(), standing(), Pose(), feet)
    want = np.where(feet, total_mass(hexapod()) * 9.80665 / feet.sum(), 0)
    np.testing.assert_allclose(found.forces, want[:, None] * [0, 0, 1], rtol=0, atol=1e-12)
    assert found.balanced
    assert found.tipping_moment == 0


def test_foot_that_would_have_to_pull_carries_nothing():
    # The load is over the triangle of the LF, LM and RF feet; the RR foot could only pull.
    feet = feet_of(1, 1, 0, 1, 0, 1)
    payload = Payload(40.0, (0.2, 0.15, 0.0))
    found = contact_forces(hexapod(), standing(), Pose(), feet, payload=payload)
    assert found.balanced
    assert found.forces[3, 2] == 0
    assert (found.forces[[0, 1, 5], 2] > 1).all()
    without = contact_forces(hexapod(), standing(), Pose(), feet_of(1, 1, 0, 0, 0, 1), payload=payload)
    np.testing.assert_allclose(found.forces, without.forces, rtol=0, atol=1e-10)


def test_margin_of_a_tipping_robot():
    robot, angles = hexapod(body_mass=1e6), standing()
    feet = forward_kinematics(robot, angles)[:, 3]
    front = (feet[0, 0] + feet[5, 0]) / 2
    beyond = contact_forces(robot.replace(body_com=[front + 0.02, 0.01, 0]), angles, Pose(), ALL)
    assert not beyond.balanced
    np.testing.assert_allclose(beyond.margin, -0.02, rtol=0, atol=1e-6)  # the legs weigh a millionth
    np.testing.assert_allclose(beyond.tipping_moment, 0.02 * beyond.weight, rtol=1e-4)
    # The forces are those at the nearest point of the polygon: on the two front feet, by the lever rule.
    np.testing.assert_array_equal(beyond.forces[1:5], 0)
    ratio = (0.01 - feet[5, 1]) / (feet[0, 1] - feet[5, 1])
    np.testing.assert_allclose(beyond.forces[0, 2] / beyond.weight, ratio, rtol=1e-4)


def test_load_on_the_edge_is_balanced():
    robot = hexapod(link_mass=np.zeros((6, 3)))
    feet = forward_kinematics(robot, standing())[:, 3]
    for share in np.linspace(0, 1, 50):
        edge = share * feet[0] + (1 - share) * feet[2]
        found = contact_forces(robot.replace(body_com=edge), standing(), Pose(), TRIPOD)
        assert found.balanced
        np.testing.assert_allclose(found.forces[[0, 2, 4], 2] / found.weight, [share, 1 - share, 0], rtol=0, atol=1e-12)


def test_collinear_feet():
    robot = hexapod(
        link_mass=np.zeros((6, 3)), body_com=[0.02, 0, 0], mount_yaw=np.deg2rad([0.0, 90, 180, 180, 270, 0])
    )
    robot = robot.replace(
        mount_position=[[0.1, 0, 0], [0, 0.1, 0], [-0.1, 0, 0], [-0.2, 0, 0], [0, -0.1, 0], [0.2, 0, 0]]
    )
    along = feet_of(1, 0, 1, 1, 0, 1)
    found = contact_forces(robot, standing(), Pose(), along)
    assert found.balanced
    x = forward_kinematics(robot, standing())[along, 3, 0]
    pushes = found.forces[along, 2] / found.weight
    np.testing.assert_allclose([pushes.sum(), pushes @ x], [1, 0.02], rtol=0, atol=1e-13)
    # Least squares: linear in x.
    np.testing.assert_allclose(np.polyval(np.polyfit(x, pushes, 1), x), pushes, rtol=0, atol=1e-13)
    aside = contact_forces(robot.replace(body_com=[0.02, 0.003, 0]), standing(), Pose(), along)
    np.testing.assert_allclose(aside.margin, -0.003, rtol=0, atol=1e-15)


def test_slope_equals_tilted_gravity():
    """Tilting gravity is equivalent to tilting robot and ground."""
    rng = np.random.default_rng(0)
    robot, angles, body, contacts, payload = random_case(rng)
    slope = Pose.from_rpy(0.2, -0.15, 0.4)
    tilted = contact_forces(robot, angles, slope @ body, contacts, payload=payload)
    gravity = slope.rotation.T @ GRAVITY
    found = contact_forces(robot, angles, body, contacts, payload=payload, gravity=gravity)
    np.testing.assert_allclose(found.forces @ slope.rotation.T, tilted.forces, rtol=0, atol=1e-11)
    np.testing.assert_allclose(found.margin, tilted.margin, rtol=0, atol=1e-14)


def test_batch_equals_loop():
    rng = np.random.default_rng(1)
    robot, angles, body, contacts, payload = random_case(rng, (40, 60))  # more than a block
    together = contact_forces(robot, angles, body, contacts, payload=payload)
    for at in map(tuple, rng.integers([40, 60], size=(30, 2))):
        single = contact_forces(robot, angles[at], body[at], contacts[at], payload=payload)
        np.testing.assert_allclose(together.forces[at], single.forces, rtol=0, atol=1e-13)
        np.testing.assert_allclose(together.margin[at], single.margin, rtol=0, atol=1e-14)


def test_batched_designs():
    rng = np.random.default_rng(2)
    robots = [random_hexapod(rng) for _ in range(3)]
    angles = standing() + rng.uniform(-0.3, 0.3, (5, 1, 6, 3))
    together = contact_forces(stack_robots(robots), angles, Pose(), ALL)
    assert together.forces.shape == (5, 3, 6, 3)
    for i, robot in enumerate(robots):
        np.testing.assert_allclose(
            together.forces[:, i], contact_forces(robot, angles[:, 0], Pose(), ALL).forces, rtol=0, atol=1e-13
        )


@pytest.mark.no_cover
@pytest.mark.parametrize("xp", [jnp, array_api_strict], ids=["jax", "strict"])
def test_other_libraries_agree(xp):
    robot, angles, body, contacts, payload = random_case(np.random.default_rng(3), (20,))
    want = contact_forces(robot, angles, body, contacts, payload=payload, gravity=(1, 2, -9))
    got = contact_forces(robot, xp.asarray(angles), body, xp.asarray(contacts), payload=payload, gravity=(1, 2, -9))
    for name in ("forces", "margin", "weight", "balanced", "tipping_moment"):
        np.testing.assert_allclose(np.asarray(getattr(got, name)), getattr(want, name), rtol=0, atol=1e-11)


def test_jit_without_a_foot_down():
    def solve(contacts):
        found = contact_forces(hexapod(), standing(), Pose(), contacts)
        return found.forces, found.margin

    forces, margin = jax.jit(solve)(~ALL)
    np.testing.assert_array_equal(forces, 0)
    assert margin == -np.inf


def test_errors():
    robot, angles = hexapod(), standing()
    with pytest.raises(MissingDataError, match=r"\[body\] mass_kg and \[leg\] mass_kg missing"):
        contact_forces(robot.replace(body_mass=None, link_mass=None), angles, Pose(), ALL)
    with pytest.raises(InputError, match=r"no foot is on the ground; at least one"):
        contact_forces(robot, angles, Pose(), ~ALL)
    some = np.array([[ALL, ALL], [~ALL, ALL], [ALL, ~ALL]])
    with pytest.raises(InputError, match=r"no foot is on the ground in sample 1, 0 \(and 1 more\)"):
        contact_forces(robot, angles, Pose(), some)
    with pytest.raises(InputError, match=r"contacts holds float64 values"):
        contact_forces(robot, angles, Pose(), np.ones(6))
    with pytest.raises(InputError, match=r"contacts has shape \(5,\); expected \(..., 6\)"):
        contact_forces(robot, angles, Pose(), np.ones(5, bool))
    with pytest.raises(InputError, match="batch axes"):
        contact_forces(robot, np.tile(angles, (2, 1, 1)), Pose(), np.ones((3, 6), bool))
    with pytest.raises(InputError, match=r"angles\[0, 0\] is nan"):
        contact_forces(robot, angles * np.nan, Pose(), ALL)
    for gravity in ((0, 0, 0), (1, 2)):
        with pytest.raises(InputError, match="three finite numbers, not all 0"):
            contact_forces(robot, angles, Pose(), ALL, gravity=gravity)
    with pytest.raises(InputError, match=r"gravity\[2\] is inf"):
        contact_forces(robot, angles, Pose(), ALL, gravity=(0, 0, np.inf))


def test_payloads():
    assert as_payload(2) == Payload(2.0, (0.0, 0.0, 0.0))
    given_ = Payload(np.float64(1), np.array([1, 2, 3]))
    assert as_payload(given_) is given_
    assert given_ == Payload(1.0, (1.0, 2.0, 3.0))
    for mass in (-1, np.nan, np.inf, "much", None, [1, 2]):
        with pytest.raises(InputError, match="it must be a finite number, at least 0"):
            as_payload(mass)
    for place in ((1, 2), (0, 0, np.nan), "here", None, 3):
        with pytest.raises(InputError, match="it must be three finite numbers"):
            Payload(1.0, place)
