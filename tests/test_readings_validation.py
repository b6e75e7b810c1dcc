"""Validation of sensor readings: invalid values of any kind never raise, never pass, and are named."""

import math

import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import tarsus
from sample_robots import hexapod
from tarsus import load_robot
from tarsus.control.readings import CHANNELS, SensorReadings, ValidReadings
from tarsus.control.sensing.plain_values import as_bool, as_items, as_number, as_vector
from tarsus.control.sensing.validation import ReadingsValidator
from tarsus.robot.joint_limits import joint_limits

STRIDER = load_robot("strider")
LEGS = STRIDER.leg_codes
WEIGHT = 9.80665 * float(np.asarray(STRIDER.body_mass) + STRIDER.link_mass.sum())
PLAUSIBLE = {
    "contacts": [True, False] * 3,
    "attitude": (0.1, -0.2),
    "forces": [float(i) for i in range(6)],
    "torques": [[0.1, -0.5, 0.2]] * 6,
}

UNUSED = ["joint_speeds", "currents", "temperatures", "voltages"]


class Hostile(list):
    """A list whose items cannot be read."""

    def __len__(self):
        return 6

    def __getitem__(self, at):
        raise RuntimeError("no")


class HostileFloat(float):
    def __float__(self):
        raise RuntimeError("no")


class HostileArray:
    shape = (6, 3)

    def __array__(self, dtype=None, copy=None):
        raise RuntimeError("no")


class WrongShape:
    """An array whose shape attribute is wrong."""

    shape = (6, 3)

    def __array__(self, dtype=None, copy=None):
        return np.zeros(5)


class HostileShape:
    @property
    def shape(self):
        raise RuntimeError("no")


def validated(validator=None, dt=0.01, **readings):
    return (validator or ReadingsValidator(STRIDER)).validate(SensorReadings(**readings), dt)


def test_plausible_readings_pass_as_plain_numbers():
    found = validated(**PLAUSIBLE)
    assert found == ValidReadings(
        contacts=(True, False) * 3,
        attitude=(0.1, -0.2),
        forces=tuple((0.0, 0.0, float(i)) for i in range(6)),
        torques=((0.1, -0.5, 0.2),) * 6,
        tilt=pytest.approx(math.acos(math.cos(0.1) * math.cos(0.2))),
    )
    assert found.rejected == ()


@pytest.mark.parametrize("make", [tuple, list, np.array, jnp.array])
def test_lists_and_arrays_of_any_library_are_equivalent(make):
    forces = [[0.5, -0.25, 2.0]] * 6
    contacts = [1, 0, 1, 0, 1, 0]
    found = validated(contacts=make(contacts), attitude=make([0.5, 0.25]), forces=make(forces), torques=make(forces))
    vectors = ((0.5, -0.25, 2.0),) * 6
    assert found == ValidReadings(
        contacts=(True, False) * 3, attitude=(0.5, 0.25), forces=vectors, torques=vectors, tilt=found.tilt
    )
    for value in (*found.contacts, *found.attitude, *found.forces[0]):
        assert type(value) in {bool, float}
    mixed = validated(contacts=[np.True_, np.float32(0), np.int8(1), True, 0.0, False], forces=np.arange(6))
    assert mixed.contacts == (True, False, True, True, False, False)
    assert mixed.forces[5] == (0.0, 0.0, 5.0)


def test_missing_readings_are_not_rejected():
    validator = ReadingsValidator(STRIDER)
    assert validator.validate(None, 0.01) == validator.validate(SensorReadings(), 0.01) == ValidReadings()


@pytest.mark.parametrize(
    ("channel", "value", "reason"),
    [
        ("contacts", "abcdef", "contacts: expected one reading per leg"),
        ("contacts", [True] * 5, "contacts: expected one reading per leg"),
        ("contacts", 1, "contacts: expected one reading per leg"),
        ("contacts", np.ones((6, 2)), "contacts: expected one reading per leg"),
        ("contacts", {0, 1, 2, 3, 4, 5}, "contacts: expected one reading per leg"),
        ("contacts", Hostile(), "contacts: expected one reading per leg"),
        ("attitude", 0.1, "attitude: expected roll and pitch"),
        ("attitude", (0.1, 0.2, 0.3), "attitude: expected roll and pitch"),
        ("attitude", HostileShape(), "attitude: expected roll and pitch"),
        ("attitude", (math.nan, 0.1), "attitude: not finite numbers"),
        ("attitude", (0.1, -math.inf), "attitude: not finite numbers"),
        ("attitude", ("0.1", 0.1), "attitude: not finite numbers"),
        ("attitude", (None, None), "attitude: not finite numbers"),
        ("attitude", (True, False), "attitude: not finite numbers"),
        ("attitude", (10**400, 0.0), "attitude: not finite numbers"),
        ("attitude", (HostileFloat(0.1), 0.0), "attitude: not finite numbers"),
        ("attitude", (0.0, -1.05), "attitude: roll or pitch beyond 60 deg"),
        ("attitude", (3, 0), "attitude: roll or pitch beyond 60 deg"),
        ("forces", np.zeros((6, 2)), "forces: expected one reading per leg"),
        ("forces", np.zeros((3, 6)), "forces: expected one reading per leg"),
        ("forces", np.broadcast_to(0.0, (6, 10**9)), "forces: expected one reading per leg"),
        ("torques", np.zeros(6), "torques: expected one reading per leg"),
        ("torques", HostileArray(), "torques: expected one reading per leg"),
        ("torques", WrongShape(), "torques: expected one reading per leg"),
        ("torques", np.zeros(10**6), "torques: expected one reading per leg"),
    ],
)
def test_a_malformed_channel_is_rejected_and_named(channel, value, reason):
    validator = ReadingsValidator(STRIDER)
    found = validated(validator, **(PLAUSIBLE | {channel: value}))
    assert getattr(found, channel) is None
    assert found.rejected == (reason,)
    for other in PLAUSIBLE.keys() - {channel}:
        assert getattr(found, other) is not None
    # Its next plausible reading is not accepted yet.
    assert getattr(validated(validator, **PLAUSIBLE), channel) is None


@pytest.mark.parametrize(
    ("channel", "value", "reason"),
    [
        ("contacts", 0.5, "neither a boolean nor 0 or 1"),
        ("contacts", 2, "neither a boolean nor 0 or 1"),
        ("contacts", "yes", "neither a boolean nor 0 or 1"),
        ("contacts", None, "neither a boolean nor 0 or 1"),
        ("contacts", math.nan, "neither a boolean nor 0 or 1"),
        ("contacts", np.array([True, False]), "neither a boolean nor 0 or 1"),
        ("forces", math.nan, "not finite numbers"),
        ("forces", None, "not finite numbers"),
        ("forces", [1.0, 2.0], "not finite numbers"),
        ("forces", [1.0, 2.0, "3"], "not finite numbers"),
        ("forces", 4.01 * WEIGHT, "beyond 4 times the robot's weight, or downward beyond 0.25 times"),
        ("forces", (0.0, 4.01 * WEIGHT, 0.0), "beyond 4 times the robot's weight, or downward beyond 0.25 times"),
        ("forces", (-4.01 * WEIGHT, 0.0, 0.0), "beyond 4 times the robot's weight, or downward beyond 0.25 times"),
        ("forces", -0.3 * WEIGHT, "beyond 4 times the robot's weight, or downward beyond 0.25 times"),
        ("torques", 1.0, "not finite numbers"),
        ("torques", (0.0, math.inf, 0.0), "not finite numbers"),
        ("torques", (0.0, 0.0, STRIDER.servos[2][2].stall_torque * 1.51), "beyond 1.5 times the stall torque"),
        ("torques", (-STRIDER.servos[2][0].stall_torque * 1.51, 0.0, 0.0), "beyond 1.5 times the stall torque"),
    ],
)
def test_a_malformed_reading_of_one_leg_is_rejected_for_that_leg_only(channel, value, reason):
    validator = ReadingsValidator(STRIDER)
    readings = [*PLAUSIBLE[channel][:2], value, *PLAUSIBLE[channel][3:]]
    found = validated(validator, **(PLAUSIBLE | {channel: readings}))
    assert found.rejected == (f"{channel} of {LEGS[2]}: {reason}",)
    good = getattr(validated(**PLAUSIBLE), channel)
    assert getattr(found, channel) == (*good[:2], None, *good[3:])


@pytest.mark.parametrize(
    ("force", "passes"),
    [((-0.9, 0.2, -1.1), True), ((0.0, 0.5, -0.7), True), ((0.0, 0.5, -0.8), False), ((0.1, 0.0, -0.4), False)],
)
def test_friction_may_pull_a_foot_down_on_the_side_of_an_obstacle(force, passes):
    forces = np.zeros((6, 3))
    forces[2] = WEIGHT * np.array(force)
    assert (not validated(forces=forces).rejected) is passes


@pytest.mark.parametrize(
    ("attitude", "tilt"),
    [
        ((0.3, 0.4), math.acos(math.cos(0.3) * math.cos(0.4))),
        *(((math.radians(179.0), 0.0), math.radians(179.0)), ((-1.6, 0.0), 1.6), ((math.pi, -2.0), math.pi - 2.0)),
        *(((3.2, 0.0), None), ((0.0, -9.0), None), ((math.nan, 0.0), None), ((0.0, math.inf), None)),
        *(("?", None), ((1.0, 2.0, 3.0), None), (Hostile(), None), (None, None)),
    ],
)
def test_attitudes_that_are_rejected_tell_the_tilt_as_well(attitude, tilt):
    found = validated(attitude=attitude).tilt
    assert found == (None if tilt is None else pytest.approx(tilt))
    assert validated(attitude=attitude, age=0.2).tilt is None


def test_a_channel_with_every_leg_rejected_is_none():
    validator = ReadingsValidator(STRIDER)
    found = validated(validator, contacts=[None] * 6, torques=np.full((6, 3), np.nan))
    assert found.contacts is found.torques is None
    assert len(found.rejected) == 12


@pytest.mark.parametrize("age", [math.nan, -0.01, "old", None, True, -math.inf])
def test_an_invalid_age_rejects_all_channels(age):
    found = validated(**PLAUSIBLE, age=age)
    assert found == ValidReadings(rejected=("all channels: age is not a number >= 0 s",))


def test_old_readings_are_rejected_and_must_settle():
    validator = ReadingsValidator(STRIDER)
    assert validated(validator, **PLAUSIBLE, age=0.1).rejected == ()
    for age in (0.1001, math.inf):
        found = validated(validator, **PLAUSIBLE, age=age)
        assert found == ValidReadings(rejected=("all channels: older than 100 ms",))
    for _ in range(3):
        found = validated(validator, **PLAUSIBLE)
        assert (found.contacts, found.attitude, found.forces, found.torques) == (None,) * 4
        assert all(reason.endswith("settling after a rejected reading") for reason in found.rejected)
        settling = {"attitude: settling after a rejected reading", "torques of RF: settling after a rejected reading"}
        assert settling < set(found.rejected)
    assert validated(validator, **PLAUSIBLE) == validated(**PLAUSIBLE)


def test_readings_of_a_slow_wire_may_be_four_ticks_old():
    assert validated(dt=0.048, **PLAUSIBLE, age=0.19).rejected == ()
    assert validated(dt=0.048, **PLAUSIBLE, age=0.2).rejected == ("all channels: older than 192 ms",)


@pytest.mark.parametrize("channel", UNUSED)
def test_channels_that_nothing_uses_are_not_looked_at(channel):
    for value in (np.zeros((6, 3)), np.full((5, 3), math.nan), "hot", HostileShape()):
        assert validated(**{channel: value}, age={channel: 9.0}) == ValidReadings()


STANDING = np.tile([0.0, 0.4, -1.4], (6, 1))


@pytest.mark.parametrize("make", [np.array, np.ndarray.tolist])
@pytest.mark.parametrize(("leg", "glitch"), [(2, 1e9), (2, -2.5), (slice(0, 6), 100.0), (slice(0, 6), 0.0)])
def test_joint_angles_that_no_joint_can_have_are_rejected_until_they_settle(make, leg, glitch):
    validator, wrong = ReadingsValidator(STRIDER), STANDING.copy()
    wrong[leg] = glitch
    assert validated(validator, joint_angles=make(STANDING)).joint_angles == tuple(map(tuple, STANDING.tolist()))
    found = validated(validator, joint_angles=make(wrong))
    legs = range(6) if leg != 2 else [2]
    reason = (
        "change faster than the servos turn" if glitch == 0.0 else "beyond the joint's limits by more than 28.6 deg"
    )
    assert found.rejected == tuple(f"joint_angles of {LEGS[each]}: {reason}" for each in legs)
    assert found.joint_angles is None or [each is None for each in found.joint_angles] == [at == 2 for at in range(6)]
    settled = [validated(validator, joint_angles=make(STANDING)).rejected == () for _ in range(4)]
    assert settled == [False, False, False, True]


@pytest.mark.parametrize("make", [np.array, np.ndarray.tolist])
def test_joint_angles_that_leave_their_limits_little_by_little_are_rejected_too(make):
    validator, angles = ReadingsValidator(STRIDER), STANDING.copy()
    most = float(np.asarray(STRIDER.limits)[2, 1, 1]) + 0.5
    for angle in np.arange(STANDING[2, 1], most + 0.2, 0.02):
        angles[2, 1] = angle
        found = validated(validator, joint_angles=make(angles)).rejected
        assert bool(found) is bool(angle > most)
    assert found == (f"joint_angles of {LEGS[2]}: beyond the joint's limits by more than 28.6 deg",)


@pytest.mark.parametrize("make", [np.array, np.ndarray.tolist])
def test_joints_may_move_as_fast_as_a_leg_is_turned_and_as_far_as_time_has_passed(make):
    validator, fastest = ReadingsValidator(STRIDER), 2.0 * joint_limits(STRIDER).speed.max()
    validated(validator, joint_angles=make(STANDING))
    for dt, change, passes in ((0.01, 0.04, True), (0.01, 0.5 + 0.009 * fastest, True), (0.01, -0.9, False)):
        found = validated(validator, dt, joint_angles=make(STANDING + np.array([change, 0.0, 0.0])))
        assert (found.rejected == ()) is passes
    # What is read on and on is true: the joint has moved since.
    for _ in range(10):
        found = validated(validator, joint_angles=make(STANDING + np.array([-0.9, 0.0, 0.0])))
    assert found.rejected == ()


def test_angular_rates_pass_where_they_are_finite():
    validator = ReadingsValidator(STRIDER)
    assert validated(validator, angular_rates=np.array([1, -2, 3])) == ValidReadings(angular_rates=(1.0, -2.0, 3.0))
    for value, reason in (
        ((1.0, 2.0), "angular_rates: expected three numbers"),
        (3.0, "angular_rates: expected three numbers"),
        ((1.0, math.nan, 2.0), "angular_rates: not finite numbers"),
        ((1.0, 2.0, math.inf), "angular_rates: not finite numbers"),
        ((1.0, "2", 3.0), "angular_rates: not finite numbers"),
    ):
        assert validated(validator, angular_rates=value) == ValidReadings(rejected=(reason,))
    for _ in range(3):
        found = validated(validator, angular_rates=(0.0, 0.0, 0.1))
        assert found == ValidReadings(rejected=("angular_rates: settling after a rejected reading",))
    assert validated(validator, angular_rates=(0.0, 0.0, 0.1)).angular_rates == (0.0, 0.0, 0.1)


def test_each_channel_may_have_its_own_age():
    validator = ReadingsValidator(STRIDER)
    ages = {"forces": 0.2, "torques": 0.05, "currents": 9.0}
    found = validated(validator, **PLAUSIBLE, age=ages)
    assert found.forces is None
    assert None not in (found.contacts, found.attitude, found.torques)
    assert found.rejected == ("forces: older than 100 ms",)  # no currents, so their age does not matter
    for _ in range(3):
        assert validated(validator, **PLAUSIBLE, age={"forces": 0.05}).forces is None
    assert validated(validator, **PLAUSIBLE, age={}) == validated(**PLAUSIBLE)
    found = validated(validator, **PLAUSIBLE, age={"attitude": -1.0, "contacts": "old"})
    assert set(found.rejected) == {
        f"{name}: age is not a number >= 0 s, nor one for each joint" for name in ("attitude", "contacts")
    }


def test_each_joint_may_have_its_own_age():
    angles, ages = tarsus.WalkController(STRIDER).angles, np.full((6, 3), 0.02)
    known = tuple(map(tuple, angles.tolist()))
    ages[3, 1] = 0.07
    found = validated(joint_angles=angles, age={"joint_angles": ages})
    assert (found.joint_angles, found.rejected) == (known, ())
    assert (found.joint_ages, found.joint_age, found.contact_age) == (tuple(map(tuple, ages.tolist())), 0.07, 0.07)
    # A leg with a joint that is too old, or of no age, is unknown, and known again at once.
    validator = ReadingsValidator(STRIDER)
    for age, reason in ((0.11, "older than 100 ms"), (math.nan, "age is not"), (-1.0, "age is not"), ("old", "age is")):
        ages = [[0.05] * 3, [0.0, age, 0.0], *[[0.0] * 3] * 4]
        found = validated(validator, joint_angles=angles, contacts=[True] * 6, age={"joint_angles": ages})
        assert found.joint_angles == (known[0], None, *known[2:])
        assert found.rejected[0].startswith(f"joint_angles of {LEGS[1]}: {reason}")
        assert (len(found.rejected), found.joint_age, found.contact_age) == (1, 0.05, 0.0)
    found = validated(validator, joint_angles=angles, age={"joint_angles": np.zeros((6, 3))})
    assert (found.joint_angles, found.rejected) == (known, ())
    found = validated(validator, joint_angles=angles, age={"joint_angles": np.full((6, 3), 9.0)})
    assert found.joint_angles is None
    assert len(found.rejected) == 6


def test_of_other_channels_the_oldest_joint_counts():
    ages = np.zeros((6, 3))
    ages[2, 2] = 0.2
    found = validated(**PLAUSIBLE, age={"torques": ages, "forces": np.full((6, 3), 0.05)})
    assert found.rejected == ("torques: older than 100 ms",)
    assert found.forces is not None
    assert validated(torques=PLAUSIBLE["torques"], age={"torques": ages[:5]}).rejected == (
        "torques: age is not a number >= 0 s, nor one for each joint",
    )


class HostileMapping(dict):
    def __getitem__(self, key):
        raise RuntimeError("no")


@pytest.mark.parametrize(
    ("age", "reason"),
    [
        ({"force": 0.0}, "age of one that does not exist"),
        ({"age": 0.0}, "age of one that does not exist"),
        ({3: 0.0, "forces": 0.0}, "age of one that does not exist"),
        (HostileMapping(forces=0.0), "age is not a number >= 0 s"),
    ],
)
def test_invalid_ages_of_channels_reject_all_channels(age, reason):
    assert validated(**PLAUSIBLE, age=age) == ValidReadings(rejected=(f"all channels: {reason}",))


def test_channels_are_the_fields_of_the_readings():
    assert set(CHANNELS) == set(UNUSED) | set(PLAUSIBLE) | {"joint_angles", "angular_rates", "ground"}
    assert [name for name in CHANNELS if not hasattr(ValidReadings(), name)] == UNUSED


@pytest.mark.parametrize("value", ["readings", 3, {"contacts": [True] * 6}, HostileShape(), ValidReadings()])
def test_an_object_of_another_class_is_rejected(value):
    assert ReadingsValidator(STRIDER).validate(value, 0.01) == ValidReadings(
        rejected=("all channels: not of class SensorReadings",)
    )


@pytest.mark.parametrize("channel", ["contacts", "forces", "torques"])
def test_a_rejected_leg_settles_before_it_is_accepted(channel):
    validator = ReadingsValidator(STRIDER)
    bad = [None, *PLAUSIBLE[channel][1:]]
    assert getattr(validated(validator, **{channel: bad}), channel)[0] is None
    for _ in range(3):
        found = validated(validator, **{channel: PLAUSIBLE[channel]})
        assert getattr(found, channel)[0] is None
        assert getattr(found, channel)[1] is not None
        assert found.rejected == (f"{channel} of LF: settling after a rejected reading",)
        validator.validate(SensorReadings(), 0.01)  # a missing reading does not count
    found = validated(validator, **{channel: PLAUSIBLE[channel]})
    assert getattr(found, channel)[0] is not None
    assert found.rejected == ()


def test_an_attitude_that_jumps_is_rejected_until_readings_agree():
    validator = ReadingsValidator(STRIDER)
    assert validated(validator, attitude=(0.0, 0.0)).attitude == (0.0, 0.0)
    assert validated(validator, attitude=(0.05, 0.0)).attitude == (0.05, 0.0)
    spike = validated(validator, attitude=(0.05, 0.5))
    assert spike == ValidReadings(tilt=spike.tilt, rejected=("attitude: changes faster than 343.8 deg/s",))
    assert validated(validator, attitude=(0.05, 0.0)).rejected == spike.rejected
    # The readings may agree on another attitude than before the jump.
    assert validated(validator, attitude=(0.4, 0.4)).rejected == spike.rejected
    for _ in range(3):
        assert validated(validator, attitude=(0.4, 0.4)).rejected == ("attitude: settling after a rejected reading",)
    assert validated(validator, attitude=(0.41, 0.4)).attitude == (0.41, 0.4)


def test_the_allowed_attitude_change_grows_with_the_time_without_readings():
    validator = ReadingsValidator(STRIDER)
    validated(validator, attitude=(0.0, 0.0))
    for _ in range(10):
        assert validator.validate(None, 0.01) == ValidReadings()
    assert validated(validator, attitude=(0.65, 0.0)).attitude == (0.65, 0.0)
    assert validated(validator, attitude=(0.65, 0.1)).attitude is None


def test_attitude_after_a_nan_is_compared_with_the_reading_before_it():
    validator = ReadingsValidator(STRIDER)
    validated(validator, attitude=(0.0, 0.0))
    validated(validator, attitude=(math.nan, 0.0))
    assert validated(validator, attitude=(0.9, 0.0)).rejected == ("attitude: changes faster than 343.8 deg/s",)


def test_without_masses_and_servos_only_extreme_values_are_rejected():
    robot = hexapod(link_mass=None, body_mass=None)
    readings = {"forces": [9e3] * 6, "torques": [[-1e3] * 3] * 6}
    assert ReadingsValidator(robot).validate(SensorReadings(**readings), 0.01).rejected == ()
    assert (
        len(
            ReadingsValidator(robot)
            .validate(SensorReadings(forces=[1e300] * 6, torques=[[1e300] * 3] * 6), 0.01)
            .rejected
        )
        == 12
    )


ARBITRARY = st.recursive(
    st.one_of(
        st.none(),
        st.booleans(),
        st.floats(),
        st.integers(),
        st.text(max_size=7),
        st.complex_numbers(),
        st.just(10**400),
        st.just(np.float32(np.nan)),
        st.just(HostileFloat(1)),
        st.just(HostileArray()),
        st.just(WrongShape()),
        st.just(Hostile()),
        st.sampled_from(
            [np.zeros((6, 3)), np.full(6, np.inf), np.array(["x"] * 6), np.array([None] * 6), np.float64(3)]
        ),
        st.sampled_from([PLAUSIBLE["contacts"], PLAUSIBLE["torques"], (0.0, 0.1), 1.0]),
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


AGES = st.one_of(
    st.sampled_from([0.0, 0.0, 0.01, 5.0, "x"]),
    st.dictionaries(st.sampled_from([*CHANNELS, 3]), st.sampled_from([0.0, 0.5, -1.0, "x"]), max_size=3),
)


@pytest.mark.no_cover
@given(st.lists(st.tuples(st.tuples(*[ARBITRARY] * 6), AGES), max_size=4))
def test_arbitrary_objects_never_raise_and_never_pass(stream):
    validator, reasons = ReadingsValidator(STRIDER), set()
    for values, age in stream:
        channels = dict(zip([*PLAUSIBLE, "joint_angles", "angular_rates"], values, strict=True))
        found = validated(validator, **channels, age=age)
        assert isinstance(found, ValidReadings)
        assert found.contacts is None or all(type(c) in {bool, type(None)} for c in found.contacts)
        assert found.attitude is None or all(abs(a) <= math.pi / 3 for a in found.attitude)
        assert found.angular_rates is None or all(map(math.isfinite, found.angular_rates))
        for vectors, most in ((found.forces, 4 * WEIGHT), (found.torques, 100.0), (found.joint_angles, 4.0)):
            assert vectors is None or len(vectors) == 6
            for part in vectors or ():
                assert part is None or all(type(x) is float and math.isfinite(x) and abs(x) <= most for x in part)
        reasons.update(found.rejected)
    assert len(reasons) <= 110


def test_reasons_are_few_for_a_long_stream_of_invalid_readings():
    validator, reasons = ReadingsValidator(STRIDER), set()
    rng = np.random.default_rng(0)
    for _ in range(2000):
        noise = rng.normal(size=(6, 3)) * 10.0 ** rng.integers(-3, 300)
        wrong = {"contacts": noise[:, 0], "attitude": noise[0, :2], "forces": noise, "torques": noise}
        reasons.update(validated(validator, **wrong, age=abs(noise[1, 1])).rejected)
    assert 0 < len(reasons) <= 70


@given(st.one_of(st.floats(), st.integers(), st.text()))
def test_as_number(value):
    found = as_number(value)
    if isinstance(value, str):
        assert math.isnan(found)
    else:
        assert found == float(value) or (math.isnan(found) and math.isnan(value))


def test_as_items_as_vector_and_as_bool():
    assert as_items((1, 2), (2,)) == [1, 2]
    assert as_items([1, 2, 3], (2,)) is None
    assert as_items(np.arange(3), (2,), (3,)) == [0, 1, 2]
    assert as_items("ab", (2,)) is None
    assert as_vector([1, 2, 3]) == as_vector((1, 2, 3)) == as_vector(np.arange(1, 4)) == (1.0, 2.0, 3.0)
    assert np.isnan([as_vector([1, 2]), as_vector("abc"), as_vector([])]).all()
    assert as_bool(True) is as_bool(np.True_) is as_bool(1.0) is True
    assert as_bool(False) is as_bool(np.int8(0)) is False
    assert as_bool(0.5) is as_bool("yes") is as_bool(None) is None


@given(st.lists(st.floats(), min_size=18, max_size=18))
def test_an_array_is_accepted_as_lists_of_its_numbers_are(numbers):
    values = np.array(numbers).reshape(6, 3)
    as_array, as_lists = ReadingsValidator(STRIDER), ReadingsValidator(STRIDER)
    for _ in range(2):
        given = [{"joint_angles": each, "torques": each} for each in (values, values.tolist())]
        found = as_array.validate(SensorReadings(**given[0]), 0.01)
        assert found == as_lists.validate(SensorReadings(**given[1]), 0.01)


@pytest.mark.parametrize("dtype", [int, np.float32])
def test_an_array_of_other_numbers_is_accepted_as_one_of_floats(dtype):
    numbers = np.arange(18).reshape(6, 3) % 2
    valid = validated(torques=numbers.astype(dtype))
    assert valid == validated(torques=numbers.astype(float))
    assert all(type(number) is float for vector in valid.torques for number in vector)
