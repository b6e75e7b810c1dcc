"""Which readings are believed: garbage of every kind never raises, never gets through, and is named."""

import math

import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sample_robots import hexapod
from tarsus import load_robot
from tarsus.control.readings import SensorReadings, ValidReadings
from tarsus.control.sensing.channel_validation import items, number, vector
from tarsus.control.sensing.validation import ReadingsValidator
from tarsus.errors import InputError
from tarsus.robot.robot import stack_robots

STRIDER = load_robot("strider")
LEGS = STRIDER.leg_codes
WEIGHT = 9.80665 * float(np.asarray(STRIDER.body_mass) + STRIDER.link_mass.sum())
GOOD = {
    "contacts": [True, False] * 3,
    "attitude": (0.1, -0.2),
    "forces": [float(i) for i in range(6)],
    "torques": [[0.1, -0.5, 0.2]] * 6,
}


class Evil(list):
    """A list which is not what it says."""

    def __len__(self):
        return 6

    def __getitem__(self, at):
        raise RuntimeError("no")


class EvilFloat(float):
    def __float__(self):
        raise RuntimeError("no")


class EvilArray:
    shape = (6, 3)

    def __array__(self, dtype=None, copy=None):
        raise RuntimeError("no")


class Liar:
    """An array which is not what it says."""

    shape = (6, 3)

    def __array__(self, dtype=None, copy=None):
        return np.zeros(5)


class EvilShape:
    @property
    def shape(self):
        raise RuntimeError("no")


def admitted(sieve=None, dt=0.01, **readings):
    return (sieve or ReadingsValidator(STRIDER)).admit(SensorReadings(**readings), dt)


def test_good_readings_come_through_as_plain_numbers():
    found = admitted(**GOOD)
    assert found == ValidReadings(
        contacts=(True, False) * 3,
        attitude=(0.1, -0.2),
        forces=tuple((0.0, 0.0, float(i)) for i in range(6)),
        torques=((0.1, -0.5, 0.2),) * 6,
    )
    assert found.rejected == ()


@pytest.mark.parametrize("make", [tuple, list, np.array, jnp.array])
def test_lists_and_arrays_of_any_kind_say_the_same(make):
    forces = [[0.5, -0.25, 2.0]] * 6
    contacts = [1, 0, 1, 0, 1, 0]
    found = admitted(contacts=make(contacts), attitude=make([0.5, 0.25]), forces=make(forces), torques=make(forces))
    assert found == ValidReadings(
        contacts=(True, False) * 3, attitude=(0.5, 0.25), forces=((0.5, -0.25, 2.0),) * 6, torques=found.forces
    )
    for value in (*found.contacts, *found.attitude, *found.forces[0]):
        assert type(value) in {bool, float}
    mixed = admitted(contacts=[np.True_, np.float32(0), np.int8(1), True, 0.0, False], forces=np.arange(6))
    assert mixed.contacts == (True, False, True, True, False, False)
    assert mixed.forces[5] == (0.0, 0.0, 5.0)


def test_without_senses_there_is_nothing_and_nothing_is_refused():
    sieve = ReadingsValidator(STRIDER)
    assert sieve.admit(None, 0.01) == sieve.admit(SensorReadings(), 0.01) == ValidReadings()
    assert sieve.counts == {}


@pytest.mark.parametrize(
    ("sense", "value", "reason"),
    [
        ("contacts", "abcdef", "contacts: not one for each leg"),
        ("contacts", [True] * 5, "contacts: not one for each leg"),
        ("contacts", 1, "contacts: not one for each leg"),
        ("contacts", np.ones((6, 2)), "contacts: not one for each leg"),
        ("contacts", {0, 1, 2, 3, 4, 5}, "contacts: not one for each leg"),
        ("contacts", Evil(), "contacts: not one for each leg"),
        ("attitude", 0.1, "attitude: not roll and pitch"),
        ("attitude", (0.1, 0.2, 0.3), "attitude: not roll and pitch"),
        ("attitude", EvilShape(), "attitude: not roll and pitch"),
        ("attitude", (math.nan, 0.1), "attitude: not finite numbers"),
        ("attitude", (0.1, -math.inf), "attitude: not finite numbers"),
        ("attitude", ("0.1", 0.1), "attitude: not finite numbers"),
        ("attitude", (None, None), "attitude: not finite numbers"),
        ("attitude", (True, False), "attitude: not finite numbers"),
        ("attitude", (10**400, 0.0), "attitude: not finite numbers"),
        ("attitude", (EvilFloat(0.1), 0.0), "attitude: not finite numbers"),
        ("attitude", (0.0, -1.05), "attitude: beyond 60 deg"),
        ("attitude", (3, 0), "attitude: beyond 60 deg"),
        ("forces", np.zeros((6, 2)), "forces: not one for each leg"),
        ("forces", np.zeros((3, 6)), "forces: not one for each leg"),
        ("forces", np.broadcast_to(0.0, (6, 10**9)), "forces: not one for each leg"),
        ("torques", np.zeros(6), "torques: not one for each leg"),
        ("torques", EvilArray(), "torques: not one for each leg"),
        ("torques", Liar(), "torques: not one for each leg"),
        ("torques", np.zeros(10**6), "torques: not one for each leg"),
    ],
)
def test_what_is_no_reading_is_refused_and_named(sense, value, reason):
    sieve = ReadingsValidator(STRIDER)
    found = admitted(sieve, **(GOOD | {sense: value}))
    assert getattr(found, sense) is None
    assert found.rejected == (reason,)
    assert sieve.counts == {reason: 1}
    for other in GOOD.keys() - {sense}:
        assert getattr(found, other) is not None
    # Good again, it is on trial.
    assert getattr(admitted(sieve, **GOOD), sense) is None


@pytest.mark.parametrize(
    ("sense", "value", "reason"),
    [
        ("contacts", 0.5, "neither true nor false"),
        ("contacts", 2, "neither true nor false"),
        ("contacts", "yes", "neither true nor false"),
        ("contacts", None, "neither true nor false"),
        ("contacts", math.nan, "neither true nor false"),
        ("contacts", np.array([True, False]), "neither true nor false"),
        ("forces", math.nan, "not finite numbers"),
        ("forces", None, "not finite numbers"),
        ("forces", [1.0, 2.0], "not finite numbers"),
        ("forces", [1.0, 2.0, "3"], "not finite numbers"),
        ("forces", 4.01 * WEIGHT, "beyond 4 times the weight, or pulling down"),
        ("forces", (0.0, 4.01 * WEIGHT, 0.0), "beyond 4 times the weight, or pulling down"),
        ("forces", (-4.01 * WEIGHT, 0.0, 0.0), "beyond 4 times the weight, or pulling down"),
        ("forces", -0.3 * WEIGHT, "beyond 4 times the weight, or pulling down"),
        ("torques", 1.0, "not finite numbers"),
        ("torques", (0.0, math.inf, 0.0), "not finite numbers"),
        ("torques", (0.0, 0.0, STRIDER.servos[2][2].stall_torque * 1.51), "beyond 1.5 times the stall torque"),
        ("torques", (-STRIDER.servos[2][0].stall_torque * 1.51, 0.0, 0.0), "beyond 1.5 times the stall torque"),
    ],
)
def test_what_is_wrong_on_one_leg_is_refused_there_alone(sense, value, reason):
    sieve = ReadingsValidator(STRIDER)
    readings = [*GOOD[sense][:2], value, *GOOD[sense][3:]]
    found = admitted(sieve, **(GOOD | {sense: readings}))
    assert found.rejected == (f"{sense} of {LEGS[2]}: {reason}",)
    good = getattr(admitted(**GOOD), sense)
    assert getattr(found, sense) == (*good[:2], None, *good[3:])


def test_where_no_leg_is_believed_the_sense_is_none():
    sieve = ReadingsValidator(STRIDER)
    found = admitted(sieve, contacts=[None] * 6, torques=np.full((6, 3), np.nan))
    assert found.contacts is found.torques is None
    assert len(found.rejected) == 12


@pytest.mark.parametrize("age", [math.nan, -0.01, "old", None, True, -math.inf])
def test_an_age_that_is_none_refuses_everything(age):
    found = admitted(**GOOD, age=age)
    assert found == ValidReadings(rejected=("senses: of no possible age",))


def test_late_readings_are_refused_and_must_settle():
    sieve = ReadingsValidator(STRIDER, max_age=0.05)
    assert admitted(sieve, **GOOD, age=0.05).rejected == ()
    for age in (0.0501, math.inf):
        assert admitted(sieve, **GOOD, age=age) == ValidReadings(rejected=("senses: older than 50 ms",))
    for _ in range(3):
        found = admitted(sieve, **GOOD)
        assert (found.contacts, found.attitude, found.forces, found.torques) == (None,) * 4
        assert all(reason.endswith("on trial") for reason in found.rejected)
    assert admitted(sieve, **GOOD) == admitted(**GOOD)
    assert sieve.counts["senses: older than 50 ms"] == 2
    assert sieve.counts["attitude: on trial"] == sieve.counts["torques of RF: on trial"] == 3


@pytest.mark.parametrize("thing", ["readings", 3, {"contacts": [True] * 6}, EvilShape(), ValidReadings()])
def test_what_is_no_senses_at_all_is_refused(thing):
    assert ReadingsValidator(STRIDER).admit(thing, 0.01) == ValidReadings(
        rejected=("senses: not of the class SensorReadings",)
    )


@pytest.mark.parametrize("sense", ["contacts", "forces", "torques"])
@pytest.mark.parametrize("settle", [1, 4])
def test_a_leg_that_comes_back_is_on_trial_first(sense, settle):
    sieve = ReadingsValidator(STRIDER, settle=settle)
    bad = [None, *GOOD[sense][1:]]
    assert getattr(admitted(sieve, **{sense: bad}), sense)[0] is None
    for _ in range(settle):
        found = admitted(sieve, **{sense: GOOD[sense]})
        assert getattr(found, sense)[0] is None
        assert getattr(found, sense)[1] is not None
        assert found.rejected == (f"{sense} of LF: on trial",)
        sieve.admit(SensorReadings(), 0.01)  # a reading that is absent counts neither way
    found = admitted(sieve, **{sense: GOOD[sense]})
    assert getattr(found, sense)[0] is not None
    assert found.rejected == ()


def test_an_attitude_that_jumps_is_refused_until_readings_agree():
    sieve = ReadingsValidator(STRIDER)
    assert admitted(sieve, attitude=(0.0, 0.0)).attitude == (0.0, 0.0)
    assert admitted(sieve, attitude=(0.05, 0.0)).attitude == (0.05, 0.0)
    spike = admitted(sieve, attitude=(0.05, 0.5))
    assert spike == ValidReadings(rejected=("attitude: turned by more than 343.8 deg/s",))
    assert admitted(sieve, attitude=(0.05, 0.0)).rejected == spike.rejected
    # What it agrees on need not be where it was: the robot may have been tipped meanwhile.
    assert admitted(sieve, attitude=(0.4, 0.4)).rejected == spike.rejected
    for _ in range(3):
        assert admitted(sieve, attitude=(0.4, 0.4)).rejected == ("attitude: on trial",)
    assert admitted(sieve, attitude=(0.41, 0.4)).attitude == (0.41, 0.4)


def test_an_attitude_may_turn_further_the_longer_it_was_absent():
    sieve = ReadingsValidator(STRIDER, max_turn=1.0)
    admitted(sieve, attitude=(0.0, 0.0))
    for _ in range(30):
        assert sieve.admit(None, 0.01) == ValidReadings()
    assert admitted(sieve, attitude=(0.3, 0.0)).attitude == (0.3, 0.0)
    assert admitted(sieve, attitude=(0.3, 0.1)).attitude is None


def test_a_nan_on_the_way_leaves_the_last_attitude_to_compare_with():
    sieve = ReadingsValidator(STRIDER)
    admitted(sieve, attitude=(0.0, 0.0))
    admitted(sieve, attitude=(math.nan, 0.0))
    assert admitted(sieve, attitude=(0.9, 0.0)).rejected == ("attitude: turned by more than 343.8 deg/s",)


def test_without_masses_and_servos_only_the_impossible_is_refused():
    robot = hexapod(link_mass=None, body_mass=None)
    readings = {"forces": [9e3] * 6, "torques": [[-1e3] * 3] * 6}
    assert ReadingsValidator(robot).admit(SensorReadings(**readings), 0.01).rejected == ()
    assert (
        len(
            ReadingsValidator(robot).admit(SensorReadings(forces=[1e300] * 6, torques=[[1e300] * 3] * 6), 0.01).rejected
        )
        == 12
    )


def test_a_sieve_that_makes_no_sense_is_refused():
    for bound in ("max_age", "max_tilt", "max_turn", "max_weights", "max_stalls", "settle"):
        for value in (0, -1.0, math.nan, math.inf):
            with pytest.raises(InputError, match=f"{bound} is {value}; it must be a positive number"):
                ReadingsValidator(STRIDER, **{bound: value})
    with pytest.raises(InputError, match="batch of designs"):
        ReadingsValidator(stack_robots([STRIDER, STRIDER]))


GARBAGE = st.recursive(
    st.one_of(
        st.none(),
        st.booleans(),
        st.floats(),
        st.integers(),
        st.text(max_size=7),
        st.complex_numbers(),
        st.just(10**400),
        st.just(np.float32(np.nan)),
        st.just(EvilFloat(1)),
        st.just(EvilArray()),
        st.just(Liar()),
        st.just(Evil()),
        st.sampled_from(
            [np.zeros((6, 3)), np.full(6, np.inf), np.array(["x"] * 6), np.array([None] * 6), np.float64(3)]
        ),
        st.sampled_from([GOOD["contacts"], GOOD["torques"], (0.0, 0.1), 1.0]),
    ),
    lambda inner: st.one_of(
        st.lists(inner, max_size=7),
        st.lists(inner, min_size=6, max_size=6),
        st.tuples(inner, inner),
        st.tuples(inner, inner, inner),
        st.dictionaries(st.text(max_size=2), inner, max_size=3),
    ),
    max_leaves=20,
)


@given(st.lists(st.tuples(GARBAGE, GARBAGE, GARBAGE, GARBAGE, st.sampled_from([0.0, 0.0, 0.01, 5.0, "x"])), max_size=4))
def test_nothing_raises_nothing_absurd_gets_through_and_counts_stay_few(stream):
    sieve, named = ReadingsValidator(STRIDER), 0
    for contacts, attitude, forces, torques, age in stream:
        found = admitted(sieve, contacts=contacts, attitude=attitude, forces=forces, torques=torques, age=age)
        assert isinstance(found, ValidReadings)
        assert found.contacts is None or all(type(c) in {bool, type(None)} for c in found.contacts)
        assert found.attitude is None or all(abs(a) <= math.pi / 3 for a in found.attitude)
        for vectors, most in ((found.forces, 4 * WEIGHT), (found.torques, 100.0)):
            assert vectors is None or len(vectors) == 6
            for part in vectors or ():
                assert part is None or all(type(x) is float and abs(x) <= most for x in part)
        named += len(found.rejected)
    assert sum(sieve.counts.values()) == named
    assert len(sieve.counts) <= 70


def test_memory_is_bounded_however_long_garbage_comes_in():
    sieve = ReadingsValidator(STRIDER)
    rng = np.random.default_rng(0)
    for _ in range(2000):
        noise = rng.normal(size=(6, 3)) * 10.0 ** rng.integers(-3, 300)
        admitted(sieve, contacts=noise[:, 0], attitude=noise[0, :2], forces=noise, torques=noise, age=abs(noise[1, 1]))
    assert 0 < len(sieve.counts) <= 70


@given(st.one_of(st.floats(), st.integers(), st.text()))
def test_numbers(value):
    found = number(value)
    if isinstance(value, str):
        assert math.isnan(found)
    else:
        assert found == float(value) or (math.isnan(found) and math.isnan(value))


def test_items_and_vectors():
    assert items((1, 2), (2,)) == [1, 2]
    assert items([1, 2, 3], (2,)) is None
    assert items(np.arange(3), (2,), (3,)) == [0, 1, 2]
    assert items("ab", (2,)) is None
    assert vector([1, 2, 3]) == vector((1, 2, 3)) == vector(np.arange(1, 4)) == (1.0, 2.0, 3.0)
    assert vector([1, 2]) is vector("abc") is None
