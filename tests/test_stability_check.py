"""Shift of the centre of mass by the legs, and the safe fraction of the foot polygons."""

import numpy as np
import pytest

from gait_robots import HEXAPOD_GAITS, PRESETS, ring
from sample_stances import POSTURES, polygons, setup_of, standing
from tarsus.gait.foot_polygons import NORMALS, polygon_ends
from tarsus.gait.stance.stability import StabilityCheck, safe_fraction, support_sets
from tarsus.kinematics.mass import centre_of_mass


@pytest.mark.parametrize("body", POSTURES)
@pytest.mark.parametrize("name", PRESETS)
def test_shifts_of_single_legs_add_up_to_that_of_the_robot(name, body):
    setup, stand, sides = setup_of(name), standing(setup_of(name), body), polygons(name, body)
    centre, shift = StabilityCheck(setup.robot, support_sets(setup.gait)).centre_of_mass(stand, sides)
    corners = polygon_ends(sides, stand.rest)[1]
    picked = np.random.default_rng(4).integers(0, 16, (50, 6))
    feet = stand.rest + corners[np.arange(6), picked]
    angles = np.stack(stand.solve(setup.robot.geometry, feet.real, feet.imag, np.zeros(feet.shape))[:3], axis=-1)
    whole = centre_of_mass(setup.robot, angles) @ stand.rotation.T + stand.position
    found = centre + shift[np.arange(6), picked].sum(axis=-1)
    np.testing.assert_allclose(found, whole[:, 0] + 1j * whole[:, 1], atol=1e-12)


def test_without_masses_the_centre_of_mass_does_not_shift():
    setup = setup_of(ring(6, link_mass=None, body_mass=None))
    stand = standing(setup, POSTURES[1])
    bounds = 0.05 + (NORMALS.conj() * stand.rest[:, None]).real
    centre, shift = StabilityCheck(setup.robot, support_sets(setup.gait)).centre_of_mass(stand, bounds)
    body = stand.rotation @ setup.robot.body_com + stand.position
    assert centre == pytest.approx(complex(body[0], body[1]))
    assert not shift.any()


def test_excluded_legs_widen_the_margin():
    setup, stand, sides = setup_of("strider"), standing(setup_of("strider")), polygons("strider")
    sets = support_sets(setup_of("strider", "wave").gait, (1, 4))
    usual, wider = StabilityCheck(setup.robot, sets), StabilityCheck(setup.robot, sets, (1, 4))
    assert wider.least_margin > usual.least_margin + 0.01
    shift = wider.centre_of_mass(stand, sides)[1]
    assert not shift[[1, 4]].any()
    assert shift[[0, 2, 3, 5]].any(axis=-1).all()


@pytest.mark.parametrize("gait", HEXAPOD_GAITS)
def test_bisection_finds_the_first_safe_fraction(gait):
    rest = 0.2 * np.exp(1j * np.pi / 6 * np.array([1, 3, 5, 7, 9, 11]))
    sets = support_sets(setup_of("strider", gait).gait)
    found = {safe_fraction(sets, size + (NORMALS.conj() * rest[:, None]).real, rest, 0j, margin=0.0) for size in _SIZES}
    # Smaller polygons never need to shrink more, and every share comes up.
    shares = [
        safe_fraction(sets, size + (NORMALS.conj() * rest[:, None]).real, rest, 0j, margin=0.0) for size in _SIZES
    ]
    assert shares == sorted(shares, reverse=True)
    assert len(found) > 8
    for size, share in zip(_SIZES, shares, strict=True):
        if share:
            bounds = share * size + (NORMALS.conj() * rest[:, None]).real
            assert safe_fraction(sets, bounds, rest, 0j, margin=0.0) == 1.0


_SIZES = np.geomspace(0.01, 4.0, 60)


def test_with_fewer_than_three_feet_there_is_no_margin():
    setup = setup_of("strider")
    check = StabilityCheck(setup.robot, np.array([[True, False, False, True, False, False]]))
    assert check.margin_at_rest(standing(setup)) == -np.inf
