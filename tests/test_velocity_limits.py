"""Velocity limits: support polygons hold, and steady walks at the feasible fraction of a twist are feasible."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from gait_robots import HEXAPOD_GAITS, PRESETS, ring
from sample_stances import POSTURES, feet_at, pose_of, setup_of, standing, velocity_limits_of
from sample_walks import WAVE_OF_FOUR
from tarsus.control.workspace.stance_limits import velocity_limits
from tarsus.gait.cycle import cycle_feet
from tarsus.gait.foot_polygons import NORMALS, polygon_ends, polygon_margin
from tarsus.gait.gait import Gait
from tarsus.gait.stance.stability import safe_fraction, support_sets
from tarsus.gait.stance.velocity_limits import (
    VelocityLimits,
    stance_overhang,
    with_stroke_limits,
)
from tarsus.gait.stroke import max_stroke
from tarsus.incremental import complete
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.stability import stability_margin

TWISTS = [(1, 0, 0), (0, -1, 0), (0.7, 0.7, 0), (0, 0, 1), (0, 0, -1), (0.5, 0, 2), (0.3, -0.3, -3), (0.1, 0, 3)]


def steady(name, gait, twist):
    """Feet of a steady cycle at the feasible fraction of a twist ``(241, legs, 3)``, contacts and stroke."""
    setup, limits = setup_of(name, gait), velocity_limits_of(name, gait)
    share, _ = limits.feasible_fraction(
        np.array(twist, dtype=float), stance_time=1.0, duty_factor=setup.gait.duty_factor
    )
    done = share * np.array(twist)
    feet, down = cycle_feet(
        setup.gait, setup.rest, done, swing_height=np.asarray(setup.swing_height), phases=np.linspace(0, 1, 241)
    )
    return feet, down, float(np.abs(done[0] + 1j * done[1] + 1j * done[2] * limits.rest).max())


# Supports.


@pytest.mark.parametrize("name", HEXAPOD_GAITS)
def test_support_sets_are_the_minimal_sets_of_a_cycle(name):
    gait = Gait.named(name)
    seen = {tuple(row) for row in gait.phase((np.arange(3600) + 0.5) / 3600)[2].tolist()}
    sets = {tuple(row) for row in support_sets(gait).tolist()}
    assert sets <= seen
    for row in seen:
        assert any(all(a or not b for a, b in zip(row, least, strict=True)) for least in sets)
    for one, other in itertools.permutations(sets, 2):
        assert any(b and not a for a, b in zip(one, other, strict=True))


def test_excluded_legs_bear_no_load():
    sets = support_sets(Gait.named("wave"), (1,))
    assert not sets[:, 1].any()
    assert {row.sum() for row in sets} == {4}


@pytest.mark.parametrize(("name", "body"), list(itertools.product(PRESETS, POSTURES)))
def test_the_robot_is_stable_for_all_foot_positions_in_the_polygons(name, body):
    for gait in ("tripod", "wave"):
        setup, limits = setup_of(name, gait), velocity_limits_of(name, gait, body)
        stand, rng = standing(setup, body), np.random.default_rng(2)
        corners = stand.rest[:, None] + polygon_ends(limits.bounds, stand.rest)[1]
        points = np.take_along_axis(corners[None], rng.integers(0, 16, (400, 6, 1)), axis=-1)[..., 0]
        angles = np.stack(
            stand.solve(setup.robot.geometry, points.real, points.imag, np.zeros(points.shape))[:3], axis=-1
        )
        for down in support_sets(setup.gait):
            margin = stability_margin(setup.robot, angles, pose_of(stand), np.broadcast_to(down, (400, 6)))
            assert margin.min() >= 0.002


def test_the_safe_fraction_is_the_largest_feasible_one():
    rest = 0.2 * np.exp(1j * np.pi / 6 * np.array([1, 3, 5, 7, 9, 11]))
    bounds = 0.12 + (NORMALS.conj() * rest[:, None]).real
    sets = support_sets(Gait.named("tripod"))
    share = safe_fraction(sets, bounds, rest, 0j, margin=0.0)
    corners = polygon_ends(bounds, rest)[1]

    def least(part):
        """The least distance of the origin inside any triangle of corners, by brute force."""
        found = math.inf
        for row in sets:
            legs = np.flatnonzero(row)
            for i, j in zip(legs, np.roll(legs, -1), strict=True):
                one = rest[i] + part * corners[i][:, None]
                way = rest[j] + part * corners[j] - one
                found = min(found, float(((1j * way).conj() * -one).real.min()))
        return found

    assert 0.1 < share < 1
    assert least(share) >= 0
    assert least(share + 0.1) < 0


def test_shifts_of_the_centre_of_mass_reduce_the_safe_fraction():
    rest = 0.2 * np.exp(1j * np.pi / 6 * np.array([1, 3, 5, 7, 9, 11]))
    bounds = 0.05 + (NORMALS.conj() * rest[:, None]).real
    sets = support_sets(Gait.named("tripod"))
    shift = 0.6 * polygon_ends(bounds, rest)[1]
    assert safe_fraction(sets, bounds, rest, 0j, margin=0.0) == 1.0
    assert 0 < safe_fraction(sets, bounds, rest, 0j, margin=0.0, shift=shift) < 1.0


def test_the_safe_fraction_is_zero_if_unstable_at_rest():
    rest = 0.2 * np.exp(1j * np.pi / 6 * np.array([1, 3, 5, 7, 9, 11]))
    bounds = 0.05 + (NORMALS.conj() * rest[:, None]).real
    assert safe_fraction(support_sets(Gait.named("tripod")), bounds, rest, 0.15 + 0j, margin=0.0) == 0.0


@pytest.mark.parametrize("size", [0.05, 0.0])
def test_two_feet_have_no_support_polygon(size):
    rest = 0.2 * np.exp(1j * np.pi / 6 * np.array([1, 3, 5, 7, 9, 11]))
    bounds = size + (NORMALS.conj() * rest[:, None]).real
    sets = np.array([[True, False, False, True, False, False]])
    assert safe_fraction(sets, bounds, rest, 0j, margin=0.0) == 0.0


# The largest share.


@pytest.mark.parametrize(("name", "gait"), list(itertools.product(PRESETS, HEXAPOD_GAITS)))
def test_steady_walks_at_the_feasible_fraction_are_reachable_and_stable(name, gait):
    setup, limits = setup_of(name, gait), velocity_limits_of(name, gait)
    stand = standing(setup)
    for twist in TWISTS:
        feet, down, _ = steady(name, gait, twist)
        found = inverse_kinematics(setup.robot, feet, pose_of(stand))
        assert found.ok.all(), found.explain()
        margin = stability_margin(setup.robot, found.angles, pose_of(stand), down)
        assert margin.min() >= 0
        on_ground = (feet[..., 0] + 1j * feet[..., 1])[..., None] * NORMALS.conj()
        assert (on_ground.real - limits.bounds)[down].max() <= 0


def test_the_feasible_fraction_is_most_of_the_longest_stroke():
    # Measured on strider: 0.75 to 0.83 of it straight on, sideways and turning; 0.58 in the worst curve.
    setup = setup_of("strider")
    for twist in TWISTS:
        _, _, stroke = steady("strider", "tripod", twist)
        longest = max_stroke(setup.robot, setup.gait, twist)
        pure = twist[2] == 0 or not any(twist[:2])
        assert (0.7 if pure else 0.55) * longest <= stroke <= longest


@given(st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(-5, 5)), st.floats(0.1, 10))
def test_the_feasible_fraction_is_inverse_to_the_size_of_the_twist(twist, factor):
    limits = velocity_limits_of("phantomx")
    if max(map(abs, twist)) < 1e-3:
        twist = (0.1, 0.0, 0.0)
    share, _ = limits.feasible_fraction(np.array(twist), stance_time=0.5, duty_factor=0.5)
    other, _ = limits.feasible_fraction(factor * np.array(twist), stance_time=0.5, duty_factor=0.5)
    assert other * factor == pytest.approx(share, rel=1e-9)


def test_extremely_large_twists_are_limited():
    limits = velocity_limits_of("strider")
    share, _ = limits.feasible_fraction(np.array([1e300, -1e300, 1e308]), stance_time=0.5, duty_factor=0.5)
    small, _ = limits.feasible_fraction(np.array([1e-8, -1e-8, 1.0]), stance_time=0.5, duty_factor=0.5)
    assert share * 1e308 == pytest.approx(small, rel=1e-9)


def test_a_zero_twist_is_feasible():
    assert velocity_limits_of("strider").feasible_fraction(np.zeros(3), stance_time=1.0, duty_factor=0.5)[0] > 1e6


def test_the_leg_with_the_smallest_margin_limits_the_twist():
    limits = velocity_limits_of("strider")
    narrow = limits.margins.copy()
    narrow[4] *= 0.3
    found = VelocityLimits(limits.bounds, narrow, limits.rest)
    share, leg = found.feasible_fraction(np.array([0.1, 0.02, 0.0]), stance_time=1.0, duty_factor=0.5)
    assert leg == 4
    assert found.limiting_leg == 4
    assert share < limits.feasible_fraction(np.array([0.1, 0.02, 0.0]), stance_time=1.0, duty_factor=0.5)[0]


def test_stroke_limits_bound_the_sum_of_straight_and_turning():
    limits = with_stroke_limits(velocity_limits_of("strider"), 0.02, 0.01, duty_factor=0.5)
    outermost = np.abs(limits.rest).max()
    for forward, turn in ((0.1, 0.0), (0.0, 0.4), (0.06, 0.3)):
        share, _ = limits.feasible_fraction(np.array([forward, 0.0, turn]), stance_time=0.5, duty_factor=0.5)
        assert share * 0.5 * (forward / 0.02 + turn * outermost / 0.01) == pytest.approx(1)


# Overhang, capping, meeting.


@pytest.mark.parametrize("duty_factor", [0.3, 0.5, 2 / 3, 5 / 6])
def test_the_overhang_is_the_greatest_lag_of_a_foot_in_a_steady_cycle(duty_factor):
    gait = Gait(duty_factor, (0.0,))
    feet, _ = cycle_feet(gait, np.zeros((1, 3)), (1.0, 0.0, 0.0), swing_height=0.02, phases=np.linspace(0, 1, 20001))
    farthest = np.abs(feet[..., 0]).max()
    assert 0 <= farthest - stance_overhang(duty_factor) < 2e-4
    assert stance_overhang(duty_factor) > 0.5


def test_stroke_limits_bound_the_distance_from_the_rest_foothold():
    limits = velocity_limits_of("strider")
    less = with_stroke_limits(limits, 0.02, 0.03, duty_factor=0.5)
    room = polygon_margin(less.bounds, less.rest)
    np.testing.assert_allclose(
        room, np.minimum(polygon_margin(limits.bounds, limits.rest), stance_overhang(0.5) * 0.03)
    )
    assert (less.stroke, less.turning) == (0.02, 0.03)
    np.testing.assert_array_equal(less.margins, limits.margins)


def test_stroke_limits_leave_excluded_legs_unbounded():
    setup = setup_of("strider", "wave")
    found = complete(
        velocity_limits(setup.robot, setup.gait, [standing(setup)], foot_distance=setup.foot_distance, excluded=(2,))
    )
    less = with_stroke_limits(found, 0.02, 0.02, duty_factor=setup.gait.duty_factor)
    assert np.isinf(less.bounds[2]).all()
    assert np.isfinite(np.delete(less.bounds, 2, axis=0)).all()


def test_the_intersection_is_feasible_in_both():
    one, other = (
        velocity_limits_of("strider"),
        with_stroke_limits(velocity_limits_of("strider", body=POSTURES[1]), 0.05, 0.04, duty_factor=0.5),
    )
    both = one.intersection(other)
    for limits in (one, other):
        assert (both.bounds <= limits.bounds).all()
        assert (both.margins <= limits.margins).all()
    assert (both.stroke, both.turning) == (0.05, 0.04)
    stands = [standing(setup_of("strider"), POSTURES[i]) for i in (0, 1)]
    setup = setup_of("strider")
    at_once = complete(velocity_limits(setup.robot, setup.gait, stands, foot_distance=setup.foot_distance))
    np.testing.assert_array_equal(
        at_once.bounds, one.intersection(velocity_limits_of("strider", body=POSTURES[1])).bounds
    )


def test_a_centre_of_mass_outside_its_support_polygon_is_infeasible():
    # Four legs in a wave: on three feet the middle of the body is on an edge.
    setup = setup_of(ring(4), WAVE_OF_FOUR)
    found = complete(velocity_limits(setup.robot, setup.gait, [standing(setup)], foot_distance=setup.foot_distance))
    assert not found.feasible
    assert (found.margins < 0).all()
    assert found.feasible_fraction(np.array([0.1, 0, 0]), stance_time=1.0, duty_factor=0.75)[0] == 0


def test_polygons_reduced_for_stability_stay_convex_around_their_rest_footholds():
    limits = velocity_limits_of("freenove")
    for leg, ends in enumerate(polygon_ends(limits.bounds, limits.rest)[1]):
        corners = ends[ends != 0]
        hull = ConvexHull(np.stack([corners.real, corners.imag], axis=-1))
        assert len(hull.vertices) == len(corners)
        assert (hull.equations[:, 2] < 0).all(), leg
    assert limits.feasible
    assert feet_at(limits.rest).shape == (6, 3)


def test_without_any_stroke_the_feasible_fraction_is_zero():
    """A polygon without margin leaves no stroke for the joints either."""
    stuck = with_stroke_limits(velocity_limits_of("strider"), 0.0, 0.0, duty_factor=0.5)
    for twist in ((0.1, 0.0, 0.0), (0.0, 0.0, 0.3)):
        share, _ = stuck.feasible_fraction(np.array(twist), stance_time=0.5, duty_factor=0.5)
        assert share == pytest.approx(0.0, abs=1e-9)
    assert stuck.feasible_fraction(np.zeros(3), stance_time=0.5, duty_factor=0.5)[0] > 1
