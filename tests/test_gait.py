import itertools

import array_api_strict
import jax
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from gait_robots import HEXAPOD_GAITS, ring
from tarsus.errors import InputError, UnknownNameError
from tarsus.gait.gait import GAITS, Gait
from tarsus.kinematics.stance import default_stance

LF, LM, LR, RR, RM, RF = range(6)


def feet_down(gait, clock):
    """How many feet are down, counted leg by leg."""
    return np.array([sum(((c - o) % 1.0) < gait.duty_factor for o in gait.offsets) for c in clock])


def air_pairs(gait, moments=6000):
    """Pairs of legs that are ever in the air together, at moments that are no event."""
    clock = (np.arange(moments) + 0.37) / moments
    down = gait.phase(clock)[2]
    return {(a, b) for a in range(gait.legs) for b in range(a + 1, gait.legs) if (~down[:, a] & ~down[:, b]).any()}


def touchdown_order(gait):
    return sorted(range(gait.legs), key=lambda leg: gait.offsets[leg])


def test_tripod_alternates_even_and_odd_legs():
    gait = Gait.named("tripod")
    assert gait.duty_factor == 0.5
    assert len({gait.offsets[leg] for leg in (LF, LR, RM)}) == 1
    assert (gait.offsets[LF] - gait.offsets[LM]) % 1 == 0.5
    assert air_pairs(gait) == {(LF, LR), (LF, RM), (LR, RM), (LM, RR), (LM, RF), (RR, RF)}


def test_tetrapod_is_three_diagonal_pairs_from_back_to_front():
    gait = Gait.named("tetrapod")
    assert gait.duty_factor == pytest.approx(2 / 3)
    assert air_pairs(gait) == {(LF, RM), (LM, RR), (LR, RF)}
    for side in ((LR, LM, LF), (RR, RM, RF)):
        steps = [(gait.offsets[b] - gait.offsets[a]) % 1 for a, b in itertools.pairwise(side)]
        assert steps == pytest.approx([1 / 3, 1 / 3])


def test_ripple_has_two_legs_in_the_air_overlapping_and_alternates_the_sides():
    gait = Gait.named("ripple")
    assert gait.duty_factor == pytest.approx(2 / 3)
    assert sorted(gait.offsets) == pytest.approx(np.arange(6) / 6)
    down = gait.phase((np.arange(600) + 0.5) / 600)[2]
    np.testing.assert_array_equal((~down).sum(-1), 2)
    left = [leg <= LR for leg in touchdown_order(gait)]
    assert all(a != b for a, b in itertools.pairwise(left))
    for side in ((LR, LM, LF), (RR, RM, RF)):
        assert [(gait.offsets[b] - gait.offsets[a]) % 1 for a, b in itertools.pairwise(side)] == pytest.approx(
            [1 / 3, 1 / 3]
        )


def test_wave_lifts_one_leg_at_a_time_one_side_after_the_other_from_the_back():
    gait = Gait.named("wave")
    assert gait.duty_factor == pytest.approx(5 / 6)
    assert touchdown_order(gait) == [LR, LM, LF, RR, RM, RF]
    assert air_pairs(gait) == set()


@pytest.mark.parametrize("name", HEXAPOD_GAITS)
def test_no_two_neighbours_of_the_ring_are_ever_in_the_air_together(name):
    gait = Gait.named(name)
    neighbours = {(i, i + 1) for i in range(5)} | {(0, 5)}
    assert not air_pairs(gait) & neighbours


@pytest.mark.parametrize(("name", "fewest"), [("tripod", 3), ("tetrapod", 4), ("ripple", 4), ("wave", 5)])
def test_fewest_feet_down(name, fewest):
    assert Gait.named(name).fewest_feet_down == fewest


def test_names_are_case_insensitive_and_have_aliases():
    assert Gait.named("Amble") == Gait.named("tetrapod")
    assert Gait.named("TRIPOD").name == "tripod"
    assert (*HEXAPOD_GAITS, "creep") == GAITS


def test_an_unknown_name_lists_the_known_ones_and_suggests_the_nearest():
    with pytest.raises(UnknownNameError, match=r"no gait is called 'tripd'. Did you mean 'tripod'\? There are: tripod"):
        Gait.named("tripd")
    with pytest.raises(UnknownNameError, match="amble"):
        Gait.named(3)


@pytest.mark.parametrize("legs", [5, 8, 9])
def test_wave_for_any_number_of_legs_from_five(legs):
    gait = Gait.named("wave", legs=legs)
    assert gait.legs == legs
    assert gait.duty_factor == (legs - 1) / legs
    assert gait.fewest_feet_down == legs - 1
    assert air_pairs(gait) == set()


def test_tripod_of_eight_legs_alternates_four_and_four():
    gait = Gait.named("tripod", legs=8)
    assert gait.fewest_feet_down == 4
    assert not air_pairs(gait) & ({(i, i + 1) for i in range(7)} | {(0, 7)})


@pytest.mark.parametrize("legs", [6, 7, 8])
def test_tetrapod_keeps_four_feet_down_and_no_neighbours_in_the_air(legs):
    gait = Gait.named("tetrapod", legs=legs)
    assert gait.fewest_feet_down == 4
    assert not air_pairs(gait) & {tuple(sorted((leg, (leg + 1) % legs))) for leg in range(legs)}


@pytest.mark.parametrize("legs", [5, 6, 7, 8, 9, 12])
def test_ripple_always_has_two_legs_in_the_air_that_are_no_neighbours(legs):
    gait = Gait.named("ripple", legs=legs)
    assert sorted(gait.offsets) == pytest.approx(np.arange(legs) / legs)
    down = gait.phase((np.arange(100 * legs) + 0.5) / (100 * legs))[2]
    np.testing.assert_array_equal((~down).sum(-1), 2)
    assert not air_pairs(gait) & {tuple(sorted((leg, (leg + 1) % legs))) for leg in range(legs)}


@pytest.mark.parametrize(
    ("name", "legs"),
    [(name, legs) for legs in range(5, 13) for name in HEXAPOD_GAITS if legs in (6, 8) or name in ("ripple", "wave")],
)
def test_at_rest_the_centre_is_within_every_support_polygon(name, legs):
    """Of a ring of like legs, by the hull of the feet that Qhull finds."""
    gait, rest = Gait.named(name, legs=legs), default_stance(ring(legs))[:, :2]
    for down in np.unique(gait.phase((np.arange(997) + 0.5) / 997)[2], axis=0):
        hull = ConvexHull(rest[down])
        assert (hull.equations[:, 2] < -0.01).all()


def test_creep_lifts_one_leg_at_a_time_around_the_body_and_stands_between():
    gait = Gait.named("creep", legs=4)
    assert gait.body_shift
    assert gait.duty_factor == pytest.approx(5 / 6)
    assert touchdown_order(gait) == [0, 1, 2, 3]
    assert air_pairs(gait) == set()
    assert gait.phase(np.arange(4) / 4 - 1 / 24)[2].sum(-1).tolist() == [3] * 4
    assert gait.phase(np.arange(4) / 4 + 1 / 24)[2].all()
    clockwise = Gait.named("creep", legs=4, turning=-0.1)
    assert touchdown_order(clockwise) == [3, 2, 1, 0]


@pytest.mark.parametrize(
    ("name", "legs", "others"),
    [
        ("tripod", 4, "4 legs have: creep"),
        ("wave", 4, "4 legs have: creep"),
        ("tripod", 5, "5 legs have: ripple, wave"),
        ("tetrapod", 9, "9 legs have: ripple, wave"),
        ("creep", 6, "6 legs have: tripod, tetrapod, ripple, wave"),
        ("wave", 3, "gaits need four legs or more"),
    ],
)
def test_gaits_refuse_unsupported_numbers_of_legs(name, legs, others):
    with pytest.raises(InputError, match=f"the {name} gait does not exist for {legs} legs; {others}"):
        Gait.named(name, legs=legs)


@pytest.mark.parametrize("duty_factor", [0.0, 1.0, -0.2, 1.3, float("nan"), float("inf")])
def test_duty_factor_must_be_between_0_and_1(duty_factor):
    with pytest.raises(InputError, match="duty_factor is"):
        Gait(duty_factor, (0.0, 0.5))


@pytest.mark.parametrize("offset", [1.0, -1e-9, float("nan"), float("inf")])
def test_offsets_must_be_in_0_to_1(offset):
    with pytest.raises(InputError, match=r"offsets\[1\] is"):
        Gait(0.5, (0.0, offset))


@pytest.mark.parametrize(("duty_factor", "offsets"), [("x", (0.0,)), (0.5, ("a",)), (0.5, 3), (None, (0.0,))])
def test_duty_factor_and_offsets_must_be_numbers(duty_factor, offsets):
    with pytest.raises(InputError, match="must be numbers"):
        Gait(duty_factor, offsets)


def test_a_gait_without_offsets_is_refused():
    with pytest.raises(InputError, match="offsets is empty"):
        Gait(0.5, ())


def test_a_custom_gait_is_a_value_of_plain_numbers():
    gait = Gait(np.float32(0.5), np.array([0.0, 0.25]))
    assert gait == Gait(0.5, (0.0, 0.25))
    assert hash(gait) == hash(Gait(0.5, (0.0, 0.25)))
    assert type(gait.duty_factor) is float
    assert [type(offset) for offset in gait.offsets] == [float, float]
    assert gait.name == "custom"


def test_another_number_of_legs_is_refused():
    Gait.named("wave", legs=8).require_legs(8)
    with pytest.raises(InputError, match="gait 'wave' is for 8 legs, the robot has 6"):
        Gait.named("wave", legs=8).require_legs(6)


gaits = st.builds(
    Gait,
    st.floats(0.05, 0.95),
    st.lists(st.floats(0, 0.999), min_size=1, max_size=9).map(tuple),
)


@given(gaits, st.floats(-50, 50))
def test_phase_counts_steps_from_the_touchdown(gait, clock):
    step, phase, stance = gait.phase(np.array(clock))
    np.testing.assert_allclose(step + phase + gait.offsets, clock, atol=2e-9)
    assert (step == np.floor(step)).all()
    assert ((phase >= 0) & (phase < 1)).all()
    sure = np.abs(phase - gait.duty_factor) > 2e-9
    np.testing.assert_array_equal(stance[sure], (phase < gait.duty_factor)[sure])


@given(gaits)
def test_fewest_feet_down_equals_a_count_over_the_cycle(gait):
    events = np.sort(np.concatenate([gait.offsets, np.array(gait.offsets) + gait.duty_factor]) % 1)
    between = np.diff(events, append=events[0] + 1)
    middles = (events + between / 2)[between > 1e-6]
    counts = feet_down(gait, middles)
    # Events nearer to each other than a millionth of a cycle are left out of the count.
    assert gait.fewest_feet_down <= counts.min()
    if between[between > 0].min(initial=1.0) > 1e-6:
        assert gait.fewest_feet_down == counts.min()


@pytest.mark.parametrize("name", HEXAPOD_GAITS)
def test_at_simultaneous_touchdown_and_lift_off_both_feet_count_as_down(name):
    gait = Gait.named(name)
    events = np.concatenate([gait.offsets, np.array(gait.offsets) + gait.duty_factor])
    for cycle in (0, 1, 7, 1000, 100_000):
        for slip in (-2e-10, 0.0, 2e-10):
            down = gait.phase(cycle + events + slip)[2].sum(-1)
            assert down.min() >= gait.fewest_feet_down + 1


@pytest.mark.parametrize("library", ["jax", "strict"])
def test_phase_is_the_same_in_every_array_library(library):
    xp = {"jax": jax.numpy, "strict": array_api_strict}[library]
    gait = Gait.named("ripple")
    clock = (np.arange(50) + 0.3) / 17
    for mine, theirs in zip(gait.phase(clock), gait.phase(xp.asarray(clock)), strict=True):
        np.testing.assert_allclose(np.asarray(theirs), mine, atol=1e-14)
