"""Contact forces in friction cones: equilibrium, optimality, infeasible samples."""

import sys

import numpy as np
import pytest
from scipy import optimize

from pinocchio_model import Reference
from sample_robots import hexapod, random_hexapod, standing
from tarsus.errors import InputError, MissingDataError, TarsusError, UnknownNameError
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.mass import centre_of_mass
from tarsus.kinematics.pose import Pose
from tarsus.load import cone_program
from tarsus.load.contact import contact_forces
from tarsus.load.friction import contact_forces_with_friction
from tarsus.load.torque import joint_torques
from tarsus.robot.robot import stack_robots
from test_contact import ALL, TRIPOD, feet_of, random_case

SLOPE = (2.0, 0.5, -9.0)


def squares(minimise, robot, angles, body, contacts, forces, gravity):
    """Objective in the units of the program, without the constant of the legs in the air."""
    com = centre_of_mass(robot, angles)
    size = np.abs(((forward_kinematics(robot, angles)[:, 3] - com) @ body.rotation.T)[contacts]).max()
    weight = float(contact_forces(robot, angles, body, contacts, gravity=gravity).weight)
    force_term = ((forces / weight) ** 2).sum()
    if minimise == "force":
        return force_term
    torques, _ = joint_torques(robot, angles, body, contacts, gravity=gravity, forces=forces)
    return ((torques / weight / size) ** 2)[contacts].sum() + 1e-6 * force_term


@pytest.mark.parametrize("minimise", ["force", "torque"])
def test_matches_a_general_optimizer(minimise):
    robot, angles, body, contacts = hexapod(), standing(), Pose.from_rpy(0.05, -0.1, 0.3), feet_of(1, 0, 1, 1, 1, 0)
    found = contact_forces_with_friction(robot, angles, body, contacts, friction=0.26, gravity=SLOPE, minimise=minimise)
    assert found.balanced
    reference = Reference(robot, gravity=SLOPE)

    def scatter(values):
        forces = np.zeros((6, 3))
        forces[contacts] = values.reshape(-1, 3)
        return forces

    def residual(values):
        return reference.residual(angles, body, scatter(values))[0]

    def cone_margin(values):
        f = values.reshape(-1, 3)
        return np.concatenate([(0.26 * f[:, 2]) ** 2 - (f[:, :2] ** 2).sum(-1), f[:, 2]])

    best = optimize.minimize(
        lambda values: 100 * squares(minimise, robot, angles, body, contacts, scatter(values), SLOPE),
        np.tile([0.0, 0, 5.0], contacts.sum()),
        method="SLSQP",
        constraints=[{"type": "eq", "fun": residual}, {"type": "ineq", "fun": cone_margin}],
        options={"ftol": 1e-12, "maxiter": 500},
    )
    assert best.success
    mine = squares(minimise, robot, angles, body, contacts, found.forces, SLOPE)
    np.testing.assert_allclose(mine, best.fun / 100, rtol=1e-4)
    assert mine <= best.fun / 100 * (1 + 1e-7)
    np.testing.assert_allclose(residual(found.forces[contacts]), 0, rtol=0, atol=1e-9)
    assert cone_margin(found.forces[contacts]).min() > -1e-7
    assert (found.forces[~contacts] == 0).all()
    assert found.friction_used.max() == pytest.approx(0.26, abs=1e-6)  # the cones matter here
    assert found.require() is found


def test_equilibrium_of_many_samples():
    rng = np.random.default_rng(0)
    robot, angles, body, contacts, payload = random_case(rng, (8, 5))
    found = contact_forces_with_friction(robot, angles, body, contacts, friction=0.7, payload=payload, gravity=SLOPE)
    reference = Reference(robot, payload=payload, gravity=SLOPE)
    assert 10 < found.balanced.sum() < 40
    for at in np.ndindex(8, 5):
        base, _ = reference.residual(angles[at], body[at], found.forces[at])
        force = body.rotation[at] @ base[:3]
        np.testing.assert_allclose(force, found.residual_force[at], rtol=0, atol=1e-8)
        if found.balanced[at]:
            np.testing.assert_allclose(base, 0, rtol=0, atol=1e-9)
    assert found.friction_used.max() < 0.7 + 1e-6
    assert (found.forces[..., 2] > -1e-9).all()
    assert (found.forces[~contacts] == 0).all()


def test_minimal_forces_on_level_ground_are_vertical():
    robot = hexapod(body_com=[0.02, 0.03, 0.0])
    found = contact_forces_with_friction(robot, standing(), Pose(), ALL, friction=0.5)
    np.testing.assert_allclose(found.forces, contact_forces(robot, standing(), Pose(), ALL).forces, rtol=0, atol=1e-7)
    assert found.friction_used.max() < 1e-7


def test_minimal_torques_are_smaller_than_with_vertical_forces():
    robot, angles = hexapod(), standing()
    loose, _ = joint_torques(robot, angles, Pose(), TRIPOD)
    sums = []
    for friction in (1e-3, 0.3, 0.6):
        found = contact_forces_with_friction(robot, angles, Pose(), TRIPOD, friction=friction, minimise="torque")
        assert found.balanced
        sums.append((joint_torques(robot, angles, Pose(), TRIPOD, forces=found.forces)[0] ** 2).sum())
    assert (loose**2).sum() > sums[0] > sums[1] > sums[2]


def test_batch_equals_loop_and_designs_batch():
    rng = np.random.default_rng(1)
    robots = [random_hexapod(rng) for _ in range(2)]
    angles = standing() + rng.uniform(-0.1, 0.1, (3, 1, 6, 3))
    for minimise in ("force", "torque"):
        kind = {"friction": 0.6, "minimise": minimise}
        together = contact_forces_with_friction(stack_robots(robots), angles, Pose(), ALL, **kind)
        assert together.forces.shape == (3, 2, 6, 3)
        for i, robot in enumerate(robots):
            single = contact_forces_with_friction(robot, angles[1, 0], Pose(), ALL, **kind)
            np.testing.assert_allclose(together.forces[1, i], single.forces, rtol=0, atol=1e-4)


def test_slope_too_steep_for_the_friction():
    steep = np.array([[np.sin(a), 0, -np.cos(a)] for a in np.arctan([0.45, 0.55])]) * 9.80665
    holds, slides = (
        contact_forces_with_friction(hexapod(), standing(), Pose(), ALL, friction=0.5, gravity=g) for g in steep
    )
    assert holds.balanced
    assert not slides.balanced
    assert np.linalg.norm(slides.residual_force) > 0.1
    with pytest.raises(
        InputError,
        match=r"no contact forces within the friction cones balance the weight: the residual is [\d.e-]+ N m and",
    ):
        slides.require()


def test_infeasible_samples_are_named_and_do_not_affect_others():
    contacts = np.array([ALL, feet_of(1, 1, 0, 0, 0, 0), TRIPOD, *[feet_of(1, 1, 0, 0, 0, 1)] * 9])
    found = contact_forces_with_friction(hexapod(), standing(), Pose(), contacts, friction=0.5)
    np.testing.assert_array_equal(found.balanced, [True, False, True, *[False] * 9])
    alone = contact_forces_with_friction(hexapod(), standing(), Pose(), TRIPOD, friction=0.5)
    np.testing.assert_allclose(found.forces[2], alone.forces, rtol=0, atol=1e-5)
    with pytest.raises(
        InputError, match=r"in 10 of 12 samples \(1; 3; 4; 5; 6; 7; 8; 9; \.\.\.\): .* in sample 1, the w"
    ):
        found.require()
    some = contact_forces_with_friction(hexapod(), standing(), Pose(), contacts[:3, None], friction=0.5)
    with pytest.raises(InputError, match=r"in 1 of 3 samples \(1, 0\): .* in sample 1, 0, the worst"):
        some.require()


def test_single_foot_below_the_load():
    """A foot under the load balances it alone."""
    robot = hexapod(link_mass=np.zeros((6, 3)))
    foot = forward_kinematics(robot, standing())[1, 3]
    found = contact_forces_with_friction(
        robot.replace(body_com=foot), standing(), Pose(), feet_of(0, 1, 0, 0, 0, 0), friction=0.5
    )
    assert found.balanced
    np.testing.assert_allclose(found.forces[1], [0, 0, 1.386 * 9.80665], rtol=0, atol=1e-9)


def test_errors(monkeypatch):
    robot, angles = hexapod(), standing()
    for friction in (0, -1, [0.5, 0.5]):
        with pytest.raises(InputError, match="it must be a number greater than 0"):
            contact_forces_with_friction(robot, angles, Pose(), ALL, friction=friction)
    with pytest.raises(InputError, match="friction is nan"):
        contact_forces_with_friction(robot, angles, Pose(), ALL, friction=np.nan)
    with pytest.raises(UnknownNameError, match="Did you mean 'torque'"):
        contact_forces_with_friction(robot, angles, Pose(), ALL, friction=0.5, minimise="torques")
    with pytest.raises(MissingDataError, match=r"\[leg\] mass_kg"):
        contact_forces_with_friction(robot.replace(link_mass=None), angles, Pose(), ALL, friction=0.5)
    with pytest.raises(InputError, match="no foot is on the ground"):
        contact_forces_with_friction(robot, angles, Pose(), ~ALL, friction=0.5)
    monkeypatch.setattr(cone_program, "_MAX_ITERATIONS", 1)
    with pytest.raises(TarsusError, match=r"did not converge \(status MaxIterations"):
        contact_forces_with_friction(robot, angles, Pose(), ALL, friction=0.5)
    monkeypatch.setitem(sys.modules, "clarabel", None)
    with pytest.raises(MissingDataError, match=r"pip install 'tarsus\[qp\]'"):
        contact_forces_with_friction(robot, angles, Pose(), ALL, friction=0.5)


@pytest.mark.parametrize("minimise", ["force", "torque"])
@pytest.mark.parametrize("batch", [(0,), (2, 0)])
def test_an_empty_batch_has_no_forces(minimise, batch):
    angles = np.zeros((*batch, 6, 3))
    found = contact_forces_with_friction(hexapod(), angles, Pose(), ALL, friction=0.5, minimise=minimise)
    assert found.forces.shape == (*batch, 6, 3)
    assert found.residual_force.shape == found.residual_moment.shape == (*batch, 3)
    assert found.balanced.shape == batch
    assert found.require() is found
