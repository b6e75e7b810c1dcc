"""The parts of a walk that feels the ground: contacts, posture, reach, support, odometry."""

import dataclasses
import math
from collections import deque

import numpy as np
import pytest

import tarsus
from sample_contacts import FEET, STANDING, find_open, take_in
from tarsus.control.contact.foot_contacts import FootContacts
from tarsus.control.contact.footing import Footing, along_gravity, holds
from tarsus.control.contact.support import Support
from tarsus.control.contact.tipping import Tipping
from tarsus.control.limiter.protocol import TwistGrant, TwistRequest
from tarsus.control.pose.admittance import Admittance
from tarsus.control.pose.posture_feedback import BodyMove, PostureFeedback, PostureRates
from tarsus.control.readings import SensorReadings, ValidReadings
from tarsus.control.search.missing_ground import MissingGround
from tarsus.control.sensing.contact_estimator import ContactEstimator
from tarsus.control.sensing.foot_loads import FootLoads
from tarsus.control.sensing.leg_odometry import CommandedMotion, LegOdometry
from tarsus.control.sensing.validation import ReadingsValidator
from tarsus.control.terrain.reach import Reach
from tarsus.control.terrain.roughness import Roughness
from tarsus.control.walk.felt_feet import FeltFoot, FeltInputs, GroundUnder, travel_share
from tarsus.control.walk.vertical_motion import _searching, _swinging
from tarsus.control.walk_controller import WalkController
from tarsus.control.walk_state import TickState
from tarsus.gait.foot_plane import FootPlane, fitted_plane
from tarsus.gait.stance.reachable_heights import reachable_heights
from tarsus.simulation import SensorSuite, SimulatedPlant, terrain
from tarsus.simulation.sensors.suite import FootSwitch, Sensor

STRIDER = tarsus.load_robot("strider")


def test_a_good_switch_is_believed_at_once_and_a_noisy_one_takes_longer():
    rng = np.random.default_rng(1)
    for wrong, most in ((0.0, 1), (0.01, 2), (0.05, 3)):
        estimator = ContactEstimator(6)
        for tick in range(4000):
            truth = np.full(6, tick // 50 % 2 == 0)
            estimator.step((truth ^ (rng.random(6) < wrong)).tolist(), 0.01)
        assert estimator.error == pytest.approx(wrong, abs=0.02)
        estimator.step([True] * 6, 0.01)
        for _ in range(20):
            estimator.step([True] * 6, 0.01)
        assert all(estimator.touching)
        assert all(estimator.certain)
        needed = 0
        while any(estimator.touching):
            estimator.step([False] * 6, 0.01)
            needed += 1
        assert needed <= most


def test_an_error_estimate_is_bounded_and_a_contact_that_is_not_measured_becomes_unknown():
    estimator = ContactEstimator(2)
    for tick in range(5000):
        estimator.step([tick % 2 == 0, True], 0.01)
    assert estimator.error == 0.2
    assert estimator.known == [True, True]
    for _ in range(60):
        estimator.step([None, True], 0.01)
    assert estimator.known == [False, True]
    estimator.step(None, 0.01)
    assert estimator.known == [False, True]


def test_contacts_are_followed_over_time():
    contacts = FootContacts(2)
    for _ in range(5):
        take_in(contacts, [True, False], [True, False], 0.01)
    assert contacts.touches(0)
    assert not contacts.touches(1)
    assert contacts.lifted == [False, True]
    assert not contacts.standing[1]
    assert not contacts.supports(1)
    for _ in range(400):
        take_in(contacts, [True, False], [True, True], 0.01)
    assert not contacts.supports(1)
    assert contacts.lifted == [False, False]


def test_a_plane_is_the_least_squares_fit_and_stays_where_feet_define_none():
    heights = [0.02 + 0.1 * foot.real - 0.2 * foot.imag for foot in FEET]
    plane = fitted_plane(FEET, heights, FootPlane(), 1.0)
    np.testing.assert_allclose(plane, (0.02, 0.1, -0.2), atol=1e-12)
    assert plane.at(1 + 1j) == pytest.approx(-0.08)
    assert fitted_plane([], [], plane, 1.0) is plane
    on_a_line = fitted_plane([0j, 0.1 + 0j, 0.2 + 0j], [0.0, 0.1, 0.5], plane, 1.0)
    assert on_a_line[1:] == plane[1:]
    followed = fitted_plane(FEET, [0.0] * 6, plane, 0.25)
    np.testing.assert_allclose(followed[1:], (0.075, -0.15), atol=1e-12)


@pytest.mark.parametrize("levelling", ["level", "between", "follow", None])
def test_the_tilt_to_keep_is_where_the_turn_ends(levelling):
    slope, share = 0.2, {"level": 0.0, "between": 0.5, "follow": 1.0, None: 1.0}[levelling]
    posture = PostureFeedback(levelling)
    tilted = (0.0, -math.atan(slope) * share)
    along = math.tan(math.atan(slope) * (1 - share))
    feet = [(foot, 0.1) for foot in FEET]
    rates = posture.rates(FootPlane(0.0, along, 0.0), tilted, BodyMove(0j, feet))
    np.testing.assert_allclose(rates.turn, 0.0, atol=1e-12)


def test_feet_at_the_end_of_their_reach_are_not_pushed_beyond_it():
    posture = PostureFeedback("level")
    free = posture.rates(FootPlane(0.05), (0.1, 0.1), BodyMove(0j, [(foot, 0.2) for foot in FEET]))
    assert free.climb == pytest.approx(0.1)
    assert free.turn == pytest.approx((0.3, 0.3))
    ended = posture.rates(FootPlane(0.05), (0.1, 0.1), BodyMove(0j, [(foot, 0.0) for foot in FEET]))
    assert ended.climb == 0.0
    assert ended.turn == (0.0, 0.0)


def test_the_body_fits_itself_to_the_reach_and_gives_way_where_it_cannot():
    posture = PostureFeedback("level")
    rises = [0.3 * foot.real for foot in FEET]
    for _ in range(300):
        posture.fit_to_reach([(rises, rises)], (-1.0, 0.0), 0.02, reach=([-0.06] * 6, [0.2] * 6), height=0.2, share=1.0)
    assert posture.raised == pytest.approx(-0.021, abs=1e-6)
    assert posture.given_way == 0.0
    for _ in range(300):
        posture.fit_to_reach(
            [(rises, rises)], (-1.0, 0.0), 0.02, reach=([-0.06] * 6, [0.06] * 6), height=0.2, share=0.7
        )
    assert posture.raised == pytest.approx(0.0, abs=1e-6)
    assert posture.given_way == pytest.approx(0.3)


def test_the_body_fits_itself_to_the_next_footholds_as_far_as_its_feet_keep_the_ground():
    level, reach = ([0.0] * 6, [0.0] * 6), ([-0.06] * 6, [0.04] * 6)
    for ahead, raised in ((0.05, 0.01), (-0.07, -0.01), (0.12, 0.06), (-0.14, -0.04)):
        posture, next_ones = PostureFeedback("level"), ([ahead] * 6, [ahead] * 6)
        for _ in range(300):
            posture.fit_to_reach([next_ones, level], (-1.0, 0.0), 0.02, reach=reach, height=0.2, share=1.0)
        # At 120 mm and -140 mm the next footholds would need 80 mm.
        assert posture.raised == pytest.approx(raised, abs=1e-6)


def test_what_a_leg_reaches_is_what_kinematics_says():
    controller = WalkController(STRIDER)
    posture, rest = controller._tick.gait.posture.value, controller._tick.gait.foot
    heights = reachable_heights(STRIDER, posture, rest, np.full(6, 0.05 + 0j))
    lowest, highest = heights[0].max(axis=0), heights[1].min(axis=0)
    for leg in range(6):
        for height, works in ((lowest[leg], True), (highest[leg], True), (lowest[leg] - 0.03, False)):
            ahead = np.stack([rest.real + 0.025, rest.imag, np.full(6, height)], axis=-1)
            found = (
                tarsus.inverse_kinematics(STRIDER, points, tarsus.Pose.from_rpy(position=posture[:3]))
                for points in (ahead, ahead - [0.05, 0.0, 0.0])
            )
            assert all(np.asarray(solution.reach)[leg] == 0 for solution in found) == works
    nowhere, _ = reachable_heights(STRIDER, posture, rest + 0.5, np.zeros(6, dtype=complex))
    assert not nowhere.any()


def test_front_legs_reach_higher_ahead_and_rear_legs_behind():
    controller, stroke = WalkController(STRIDER), 0.06
    state, reach = controller._tick.gait, Reach(STRIDER)
    rest = state.foot
    assert reach.highest_on_way(0, rest[0], rest[0])[0] == 0.0
    reach.update(TickState(state, np.array([2 * stroke, 0.0, 0.0])), rest, 0.5)
    tops = [[reach.highest_on_way(leg, rest[leg] + x, rest[leg] + x)[0] for x in (-0.03, 0.0, 0.03)] for leg in (0, 2)]
    assert tops[0] == sorted(tops[0])
    assert tops[1] == sorted(tops[1], reverse=True)
    assert (tops[0][0], tops[1][2]) == (reach.highest[0], reach.highest[2])
    # A way is as high as the lower of its ends.
    assert reach.highest_on_way(0, rest[0] + 0.03, rest[0])[0] == tops[0][1]


def test_legs_reach_higher_beside_their_strokes_away_from_the_body():
    controller = WalkController(STRIDER)
    state, reach = controller._tick.gait, Reach(STRIDER)
    rest = state.foot
    reach.update(TickState(state, np.array([0.12, 0.0, 0.0])), rest, 0.5)
    for leg, place in enumerate(rest.tolist()):
        bow = complex(reach.bows[leg])
        assert bow == pytest.approx(0.03j * np.sign(place.imag))
        straight, half, out = (reach.highest_on_way(leg, at, at)[0] for at in (place, place + bow / 2, place + bow))
        assert straight < half < out == reach.highest_on_way(leg, place, place)[1]
        # Towards the body it is no lower than known along the stroke.
        assert reach.highest_on_way(leg, place - bow, place - bow)[0] == straight
    # A robot that stops keeps them, and with them the height of its body.
    stands = reach.highest_stand(0.05)
    reach.update(TickState(state, np.zeros(3)), rest, 0.5)
    assert complex(reach.bows[0]) == pytest.approx(0.03j)
    assert all(now >= before - 0.01 for before, now in zip(stands, reach.highest_stand(0.05), strict=True))
    # In a narrow arc, the bows of the inner legs lead away from their coxae, too.
    reach.update(TickState(state, np.array([0.05, 0.0, 0.2])), rest, 0.5)
    out = rest - (STRIDER.mount_position[:, 0] + 1j * STRIDER.mount_position[:, 1])
    assert np.all((out * reach.bows.conj()).real > 0)
    # Sideways, the strokes of the middle legs lead through their coxae, and those legs swing straight.
    reach.update(TickState(state, np.array([0.0, 0.12, 0.0])), rest, 0.5)
    assert reach.bows[[1, 4]].tolist() == [0j, 0j]
    straight, bowed = reach.highest_on_way(1, rest[1], rest[1])
    assert straight == bowed


@pytest.mark.parametrize(("swing_height", "share"), [(0.02, 0.0), (0.075, 0.5), (0.2, 1.0)])
def test_a_foot_swings_out_as_far_as_its_leg_needs_for_its_top(swing_height, share):
    under = GroundUnder(0.0, lowest=-0.2, highest=0.05, bow=0.03j, bowed=0.1)
    felt = FeltInputs([], [], [], 0.0, PostureRates(), 0j, 0.0, 0j, 0.8, 1.0, swing_height, 10.0, 0.0, {})
    _, foot = _swinging(0.0, FeltFoot(), under, felt, 0.01, (0.0, 0.5, 0.0, 0j))
    assert foot.top == pytest.approx(min(swing_height, 0.1))
    assert foot.bow == pytest.approx(0.03j * share)


def test_places_out_of_reach_on_level_ground_do_not_tell_how_low_a_leg_reaches():
    controller = WalkController(STRIDER)
    state, reach = controller._tick.gait, Reach(STRIDER)
    rest, still = state.foot, TickState(state, np.zeros(3))
    reach.update(still, rest, 0.5)
    lowest, highest = reach.lowest, reach.highest
    # Ends of a stroke of half a metre are in reach at no height, its middle is.
    reach.update(TickState(state, np.array([1.0, 0.0, 0.0])), rest, 0.5)
    assert (reach.lowest, reach.highest) == (lowest, highest)
    assert reach.highest_on_way(0, rest[0], rest[0] + 0.25)[0] == highest[0] > 0.0
    # A leg whose foothold is out of reach keeps what is known of it, as 0 would command the body down at once.
    reach.update(still, np.array([rest[0] + 0.5, *rest[1:]]), 0.5)
    assert (reach.lowest, reach.highest) == (lowest, highest)
    assert max(reach.lowest) < 0 < min(reach.highest)


@pytest.mark.parametrize(("roll", "pitch"), [(0.0, 0.0), (0.0, -0.3), (0.2, 0.0), (-0.15, 0.25)])
def test_the_centre_of_mass_is_over_the_feet_along_gravity(roll, pitch):
    down = np.asarray(tarsus.Pose.from_rpy(roll, pitch).inverse() @ np.array([0.0, 0.0, -1.0]))
    x, y, _ = down * 0.1 / -down[2]
    found = along_gravity(0.02 + 0.01j, (0.01, -0.02, 0.1, 0.0, 0.0, 0.0, 0.03), (roll, pitch))
    assert found == pytest.approx(complex(0.03 + x, -0.01 + y), rel=0.02)


def test_support_slows_the_walk_down_only_where_feet_wait_for_long():
    assert holds(FEET, 0j)
    assert not holds(FEET[:2], 0j)
    assert not holds(FEET[:3], 0.5 + 0j)
    support = Support()
    support.step(stays=False, lifts=True, dt=0.02, swing_time=0.5)
    assert support.waits
    assert support.pace == 1.0
    for _ in range(40):
        support.step(stays=False, lifts=True, dt=0.02, swing_time=0.5)
    assert support.pace == 0.0
    for _ in range(40):
        support.step(stays=True, lifts=False, dt=0.02, swing_time=0.5)
    assert support.pace == 1.0
    for _ in range(40):
        support.step(stays=False, lifts=False, dt=0.02, swing_time=0.5)
    assert not support.waits
    assert support.pace == 0.0


@pytest.mark.parametrize("lifts", [True, False])
def test_feet_in_the_air_are_put_down_once_the_robot_has_waited_for_long(lifts):
    support, waited = Support(), 0.0
    while not support.puts_down(refuses=False) and waited < 4.0:
        support.step(stays=False, lifts=lifts, dt=0.02, swing_time=0.5)
        waited += 0.02
    assert 0.9 < waited < 1.1
    assert support.puts_down(refuses=True)
    support.step(stays=True, lifts=lifts, dt=0.02, swing_time=0.5)
    assert not support.puts_down(refuses=False)


@pytest.mark.no_cover
def test_a_robot_without_a_leg_does_not_stand_for_good_on_a_slope():
    """A foot that hung 17 mm over the ground kept the others from holding the robot, and never came down."""
    plant, dt = SimulatedPlant(tarsus.load_robot("makeyourpet"), terrain=terrain.Ramp(slope=np.radians(12.0))), 0.01
    controller = tarsus.RobotController(plant.robot)
    plant.start(controller.output)
    controller.leg_failures.failed[3] = 0
    ways = []
    for _ in range(3000):
        controller.step((0.05, 0.0, 0.0), dt, plant.step(controller.output, dt))
        ways.append(plant.state.body.position[0])
    assert ways[-1] - ways[1500] > 0.05


@pytest.mark.parametrize("ahead", [(1, 3, 5), range(6)])
def test_the_body_shifts_over_feet_that_would_not_hold_it_as_others_lift_off(ahead):
    controller = WalkController(tarsus.load_robot("makeyourpet"))

    def walk(ticks, twist):
        for _ in range(ticks):
            roll, pitch, _ = np.asarray(controller.body.rpy).tolist()
            felt = {"contacts": controller.contacts, "attitude": (roll, pitch), "joint_angles": controller.angles}
            controller.step(twist, 0.01, readings=SensorReadings(**felt))

    walk(10, (0.0, 0.0, 0.0))
    state = controller._tick.gait
    foot = state.foot + 0.13 * np.isin(np.arange(6), ahead)
    controller._tick = controller._tick._replace(gait=state._replace(foot=foot, foothold=foot))
    walk(40, (0.05, 0.0, 0.0))
    assert "the feet on the ground do not hold the robot" in [each.cause for each in controller.limitations]
    walk(160, (0.05, 0.0, 0.0))
    before = float(controller.body.position[0])
    walk(200, (0.05, 0.0, 0.0))
    assert float(controller.body.position[0]) - before > 0.09


@pytest.mark.parametrize("ahead", [(0, 2, 4), (1, 3, 5)])
def test_a_robot_that_was_carried_goes_on_where_those_feet_hold_it_that_are_to_lift_off(ahead):
    controller = WalkController(tarsus.load_robot("makeyourpet"))
    seen = list[bool]()
    for tick in range(400):
        readings = SensorReadings(contacts=controller.contacts * (not 30 <= tick < 130), attitude=(0.0, 0.0))
        controller.step((0.1, 0.0, 0.0), 0.01, readings)
        if tick == 120:
            # Without those that are due, the feet do not hold the robot.
            state = controller._tick.gait
            foot = state.foot + 0.13 * np.isin(np.arange(6), ahead)
            controller._tick = controller._tick._replace(gait=state._replace(foot=foot, foothold=foot))
        seen.append(controller._walk.ground.condition.carried)
    assert all(seen[100:130])
    assert not any(seen[330:])


def test_after_a_long_wait_fewer_feet_lift_off():
    feet = [1 + 1j, 1j, -1 + 1j, -1 - 1j, -1j, 1 - 1j]
    support, footing = Support(), Footing(feet, [True] * 6, 0.9 + 0j, 0.1)
    for _ in range(10):
        support.step(stays=False, lifts=True, dt=0.2, swing_time=0.5)
        support.lift_fewer([*range(6)], [1, 3, 5], footing)
        assert support.waits
        assert support.stay == []
    for _ in range(3):
        support.step(stays=False, lifts=True, dt=0.2, swing_time=0.5)
    # Without the front right foot, the others would not hold the robot.
    support.lift_fewer([*range(6)], [1, 3, 5], footing)
    assert support.stay == [5]
    assert not support.waits
    support.step(stays=False, lifts=True, dt=0.2, swing_time=0.5)
    support.lift_fewer([0, 3, 5], [3], footing)
    assert support.stay == [3]
    assert support.waits
    support.lift_fewer([*range(6)], [], footing)
    assert support.stay == []


@pytest.mark.parametrize(("feet", "shifts"), [([2.0, 2.0 + 1j, 3.0], 1.0), ([-2.0, -2.0 + 1j, -3.0], -1.0)])
def test_a_body_shifts_towards_feet_and_not_far(feet, shifts):
    support, footing, moved = Support(), Footing([complex(foot) for foot in feet], [True] * 3, 0j, 0.1), 0j
    for _ in range(50):
        support.step(stays=False, lifts=True, dt=0.01, swing_time=0.3)
    for _ in range(300):
        support.shift_over([0, 1, 2], footing, 0.01, scale=0.5)
        moved += support.shift * 0.01
    assert abs(moved) == pytest.approx(0.04, abs=1e-3)
    assert moved.real * shifts > 0.03
    support.shift_over([], footing, 0.01, scale=0.5)
    support.shift_over([0], footing, 0.01, scale=0.5)
    assert support.shift


def test_ground_may_be_deeper_at_once_and_more_so_where_roughness_lasts():
    roughness, allowed = Roughness(tarsus.GroundAdaptation()), []
    for _ in range(8):
        roughness.landed(0.048)
        allowed.append(roughness.deeper)
        roughness.decay(0.5)
    assert sorted(allowed) == allowed
    # A first foothold off the expected ground allows for 30 mm, a cycle later too, four cycles of them for 50 mm.
    assert allowed[0] == allowed[2] == 0.03
    assert allowed[-1] == 0.05
    roughness.decay(20.0)
    assert roughness.deeper < 0.001
    half = Roughness(tarsus.GroundAdaptation(), scale=0.5)
    half.landed(0.2)
    half.decay(4.0)
    assert half.deeper == 0.025


def test_an_edge_raises_swings_and_the_body_and_draws_feet_in_but_is_no_rough_or_deeper_ground():
    roughness = Roughness(tarsus.GroundAdaptation())
    roughness.at_edge(0.048)
    assert roughness.swing_rise == roughness.body_rise == pytest.approx(0.04)
    assert roughness.drawn_in == pytest.approx(0.02)
    assert roughness.value == roughness.deeper == 0.0
    assert roughness.speed == roughness.cycle_time() == 1.0
    roughness.decay(4.0)
    assert roughness.swing_rise == roughness.body_rise == pytest.approx(0.04 / math.e)
    # What feet have met before still counts.
    roughness.landed(0.018)
    roughness.at_edge(0.1)
    assert roughness.deeper == pytest.approx(0.025)


def test_roughness_rises_at_once_falls_slowly_and_is_bounded():
    roughness = Roughness(tarsus.GroundAdaptation(swing_height=0.03, body_height=0.01))
    roughness.landed(0.005)
    assert roughness.value == 0.0
    roughness.collided()
    assert roughness.swing_rise == 0.03
    assert roughness.value == pytest.approx(0.04)
    assert roughness.body_rise == 0.01
    roughness.landed(-0.1)
    assert roughness.swing_rise == 0.03
    roughness.decay(4.0)
    assert roughness.value == pytest.approx(0.092 / math.e)
    assert (roughness.drawn_in, roughness.cycle_time(), roughness.speed) == pytest.approx((0.02, 1.1875, 0.775))
    for value, cycle_time in ((0.04, 1.25), (0.045, 1.125), (0.05, 1.0), (0.1, 1.0)):
        roughness.value = value
        assert (roughness.cycle_time(), roughness.speed) == pytest.approx((cycle_time, 0.7))
        assert roughness.cycle_time(on_slope=1.125) == pytest.approx(cycle_time)
    roughness.decay(20.0)
    assert (roughness.drawn_in, roughness.cycle_time(), roughness.speed) == (0.0, 1.0, 1.0)
    for name, value in (("cycle_time", 0.9), ("catch_up", 0.5), ("speed", 0), ("speed", 1.2), ("drawn_in", math.nan)):
        with pytest.raises(tarsus.TarsusError, match=f"{name} is {value}"):
            tarsus.GroundAdaptation(**{name: value})
    with pytest.raises(tarsus.TarsusError, match="swing_height is -1"):
        tarsus.GroundAdaptation(swing_height=-1.0)


@pytest.mark.parametrize(
    ("speed", "adaptation", "cycle", "granted"),
    [
        (0.5, {}, 1.25, 1.0),
        (1.0, {}, 1.25, 0.7),
        (1.0, {"speed": 0.9}, 0.95 / 0.9, 0.9),
        (1.0, {"speed": 1.0}, 1.0, 1.0),
        (1.0, {"speed": 1.0, "cycle_time": 1.0, "drawn_in": 0.0}, 1.0, 1.0),
    ],
)
def test_on_rough_ground_cycles_get_longer_feet_closer_and_fast_walks_slower(speed, adaptation, cycle, granted):
    controller = WalkController(
        STRIDER, adaptation=tarsus.GroundAdaptation(swing_height=0.0, body_height=0.0, **adaptation)
    )
    before, top = controller.cycle_time, controller.top_speed((1, 0, 0))
    walk, found = controller._walk, []
    rest = abs(walk.transitions.footholds.rest)
    twist = (speed * top, 0.0, 0.0)
    for tick in range(450):
        if tick < 150:
            walk.ground.body.roughness.landed(0.048)
        readings = SensorReadings(contacts=controller.contacts, attitude=(0.0, 0.0))
        controller.step(twist, 0.02, readings)
        if tick == 149:
            assert controller.cycle_time == pytest.approx(cycle * before)
            assert speed == 1.0 or controller.twist[0] == pytest.approx(twist[0], rel=0.01)
            found = [each.text() for each in controller.limitations if each.cause == "the ground is rough"]
            nearer = rest - abs(walk.transitions.footholds.rest)
            walk.ground.body.roughness.decay(8.0)
            assert nearer.min() == pytest.approx(adaptation.get("drawn_in", 0.02), abs=0.003)
    assert found == ([f"twist: {100 * granted:.0f} % of the command; the ground is rough"] if granted < 1 else [])
    # Once that is forgotten, all of it is as before.
    assert controller.cycle_time == pytest.approx(before)
    assert not [each for each in controller.limitations if each.cause == "the ground is rough"]
    assert walk.transitions.footholds.rest == pytest.approx(
        rest * np.exp(1j * np.angle(walk.transitions.footholds.rest))
    )


def test_a_robot_that_is_to_stand_is_not_said_to_be_slowed_down_by_rough_ground():
    controller, found = WalkController(STRIDER), []
    for _ in range(150):
        controller._walk.ground.body.roughness.landed(0.048)
        controller.step((0.0, 0.0, 0.0), 0.02, SensorReadings(contacts=controller.contacts, attitude=(0.0, 0.0)))
        found += controller.limitations
    assert controller._walk.ground.body.roughness.speed < 0.9
    assert found == []


# A walk with 0.1 m/s, looked at each 10 ms.
FORWARD = CommandedMotion(velocity=0.1 + 0j, moved=0.001 + 0j, turned=0.0, yaw=0.0)


def test_odometry_makes_up_for_what_the_legs_lose():
    odometry = LegOdometry(STRIDER)
    angles = WalkController(STRIDER).angles
    still = ValidReadings(joint_angles=angles.tolist())
    for _ in range(50):
        correction = odometry.step(still, range(6), FORWARD, 0.01)
    # Legs that stand still: all of the way is lost, and the correction is at its bound.
    assert correction == pytest.approx(0.025)
    assert odometry.step(ValidReadings(), range(6), FORWARD, 0.01) == 0j
    assert odometry.behind == 0j


def test_a_robot_that_is_carried_has_lost_no_way_and_slips_no_more():
    odometry, walk = LegOdometry(STRIDER), WalkController(STRIDER)
    for forward in (0.0, 0.01):
        feet = np.array(walk.feet)
        feet[0, 0] += forward
        angles = np.asarray(tarsus.inverse_kinematics(STRIDER, feet, walk.body).angles).tolist()
        odometry.step(ValidReadings(joint_angles=angles), range(6), FORWARD, 0.01)
    assert odometry.limitations
    odometry.forget()
    assert not odometry.limitations
    assert odometry.step(ValidReadings(joint_angles=angles), range(6), FORWARD, 0.01) == 0j


def test_the_odometry_of_a_tilted_body_is_over_the_ground():
    odometry, walk = LegOdometry(STRIDER), WalkController(STRIDER)
    for tick in range(30):
        body = tarsus.Pose.from_rpy(0.1, -0.2, 0.0, (0.001 * tick, 0.0, float(walk.body.position[2])))
        angles = np.asarray(tarsus.inverse_kinematics(STRIDER, walk.feet, body).angles)
        valid = ValidReadings(joint_angles=angles.tolist(), attitude=(0.1, -0.2))
        odometry.step(valid, range(6), FORWARD, 0.01)
    # Balls that do not roll as the legs turn are 2 % of the way; in the frame of the body it would go aside by as much.
    assert abs(odometry.behind) < 6e-4
    assert abs(odometry.behind.imag) < 2e-5


def test_a_foot_that_slides_is_told_by_the_others():
    odometry, walk = LegOdometry(STRIDER), WalkController(STRIDER)
    feet, body = np.array(walk.feet), walk.body
    for tick in range(60):
        # The body turns and moves over its feet, and one of them slides forward with 50 mm/s.
        moved = tarsus.Pose.from_rpy(yaw=0.002 * tick, position=(0.001 * tick, 0.0, 0.0)) @ body
        feet[0, 0] += 0.0005
        angles = tarsus.inverse_kinematics(STRIDER, feet, moved).angles
        valid = ValidReadings(joint_angles=np.asarray(angles).tolist())
        odometry.step(valid, range(6), FORWARD._replace(yaw=0.002 * tick), 0.01)
    assert odometry.slip[0] == max(odometry.slip)
    # A sixth of a foot's slip is taken for motion of the body, and some for its turn.
    assert 0.025 < odometry.slip[0] < 0.05
    assert max(odometry.slip[1:]) < 0.02
    walk.step((0.0, 0.0, 0.0), 0.01, SensorReadings(contacts=(True,) * 6, attitude=(0.0, 0.0)))
    walk._walk.ground.body.odometry.slip = odometry.slip
    (found,) = walk.limitations
    assert found.leg == "front left"
    assert found.text().startswith("ground: 3")
    assert found.text().endswith("mm/s, bound 30 mm/s; front left: the foot slips")
    odometry.step(valid, [0, 1], FORWARD, 0.2)
    assert max(odometry.slip) == 0.0


def test_noise_of_joint_angles_is_no_slip():
    odometry, random, slips = LegOdometry(STRIDER), np.random.default_rng(0), []
    angles = WalkController(STRIDER).angles
    for _ in range(500):
        measured = (angles + math.radians(0.5) * random.standard_normal((6, 3))).tolist()
        odometry.step(ValidReadings(joint_angles=measured), range(6), FORWARD._replace(moved=0j), 0.04)
        slips.append(max(odometry.slip))
    # The feet are 60 mm/s fast, to and fro.
    assert np.quantile(slips[10:], 0.9) < 0.03


def test_contacts_come_from_switches_or_else_from_load_cells():
    loads = FootLoads(STRIDER, None)
    controller = WalkController(STRIDER)
    angles, state = controller.angles, controller._tick.gait
    pressed = ValidReadings(forces=((0.0, 0.0, 5.0), None, *((0.0, 0.0, 0.1),) * 4))
    assert loads.contacts(pressed, angles, state, 0.01) == [True, None, *[False] * 4]
    switched = pressed._replace(contacts=(False,) * 6)
    assert loads.contacts(switched, angles, state, 0.01) == (False,) * 6
    driven = ValidReadings(torques=tuple((0.0, 1.0, 0.5) for _ in range(6)))
    # Joint torques do not tell contacts: legs press against each other, and a swinging leg is accelerated.
    assert loads.contacts(driven, angles, state, 0.01) is None
    assert loads.contacts(ValidReadings(), angles, state, 0.01) is None


def test_the_zero_offset_of_a_load_cell_is_learnt_while_its_foot_swings():
    loads, controller = FootLoads(STRIDER, None), WalkController(STRIDER)
    angles, state = controller.angles, controller._tick.gait
    offsets, weight = [2.0, -1.0, 9.0, 0.0, 2.0, 2.0], tarsus.total_mass(STRIDER) * 9.81
    unloaded = ValidReadings(forces=tuple((0.0, 0.0, offset) for offset in offsets))
    down, phases = np.array([False, False, False, True, False, False]), np.array([0.3, 0.4, 0.3, 0.0, 0.1, 0.6])
    swings = state._replace(down=down, swing_phase=phases)

    def touch(valid):
        return loads.contacts(valid, angles, state, 0.04)

    assert touch(unloaded) == [True, False, True, False, True, True]
    for _ in range(40):
        assert loads.offsets(unloaded, angles, swings, 0.04, out=[], centre=0j) is None
    # Learnt of feet in the middle of their swings, and no more than 0.15 of the weight.
    assert touch(unloaded) == [False, False, True, False, True, True]
    pressed = unloaded._replace(forces=((0.0, 0.0, 4.0), (0.0, 0.0, 1.0), (0.0, 0.0, 0.15 * weight + 1.0), *[None] * 3))
    assert touch(pressed) == [True, True, False, None, None, None]
    # A foot that meets an obstacle presses on it for a moment.
    loads, hit = FootLoads(STRIDER, None), ValidReadings(forces=((0.0, 0.0, weight), *[None] * 5))
    loads.offsets(hit, angles, swings, 0.04, out=[], centre=0j)
    assert loads.contacts(hit._replace(forces=((0.0, 0.0, 0.07 * weight), *[None] * 5)), angles, state, 0.04)[0]


def test_compliant_feet_do_not_yield_to_the_zero_offsets_of_load_cells():
    controller, found = WalkController(STRIDER), []
    angles, state = controller.angles, controller._tick.gait
    swings = state._replace(down=np.zeros(6, dtype=bool), swing_phase=np.full(6, 0.4))
    for zeros in ([0.0] * 6, [2.0, -1.0, 1.5, 0.5, -2.0, 1.0]):
        soft = FootLoads(STRIDER, Admittance(mass=1.0, damping=40.0, stiffness=400.0))
        for forces, gait in (([0.0] * 6, swings), ([3.0, 5.0, 4.0, 2.0, 6.0, 1.0], state)):
            cells = ValidReadings(forces=tuple((0.0, 0.0, sum(both)) for both in zip(forces, zeros, strict=True)))
            for _ in range(100):
                offsets = soft.offsets(cells, angles, gait, 0.04, out=[], centre=0j)
        found.append(offsets)
    assert np.abs(found[0]).max() > 0.001
    assert found[1] == pytest.approx(found[0], abs=1e-5)


def test_joint_angles_tell_of_contacts_once_switches_have_told_nothing_for_some_time(monkeypatch):
    loads, controller, told = FootLoads(STRIDER, None), WalkController(STRIDER), []
    angles, state = controller.angles, controller._tick.gait
    monkeypatch.setattr(loads._joints, "contacts", lambda *_: [False] * 6)
    switched = ValidReadings(joint_angles=tuple(map(tuple, angles.tolist())), contacts=(True,) * 6)
    for tick in range(40):
        told.append(loads.contacts(switched if tick < 5 else switched._replace(contacts=None), angles, state, 0.01))
        assert loads.estimated == (told[-1] == [False] * 6)
    assert told == [(True,) * 6] * 5 + [None] * 15 + [[False] * 6] * 20
    # Without any switches they do at once.
    assert FootLoads(STRIDER, None)._untold == math.inf


def test_compliant_feet_yield_to_measured_forces_or_else_to_joint_torques():
    controller = WalkController(STRIDER)
    angles, state = controller.angles, controller._tick.gait
    pressed = ValidReadings(forces=((0.0, 0.0, 50.0), *((0.0, 0.0, 0.1),) * 5))
    driven = ValidReadings(torques=tuple((0.0, 1.0, 0.5) for _ in range(6)))
    assert FootLoads(STRIDER, None).offsets(pressed, angles, state, 0.01, out=[], centre=0j) is None

    def offsets(readings):
        soft = FootLoads(STRIDER, Admittance(mass=1.0, damping=400.0, stiffness=400.0))
        return soft.offsets(readings, angles, state, 0.01, out=[], centre=0j)

    np.testing.assert_array_equal(offsets(ValidReadings()), np.zeros(6))
    assert offsets(pressed)[0] > 0 > offsets(pressed)[1:].max()
    assert np.abs(offsets(driven)).min() > 0


def tipped(tilts, *, depth=0.02, scale=1.0):
    """The leg at which a robot tips whose pitch is this in one tick of 40 ms after the other; None in none."""
    tipping = Tipping(scale)
    for pitch in tilts:
        tipping.step(STANDING, [depth] * 6, None if pitch is None else (0.0, pitch), 0.04)
    return tipping.leg


def test_a_robot_tips_that_sinks_fast_at_a_foot_that_is_low():
    fast, slow = [0.0, 0.05, 0.1, 0.12], np.linspace(0.0, 0.12, 100).tolist()
    assert tipped(fast) in (0, 5)
    assert tipped([-pitch for pitch in fast]) in (2, 3)
    # Not where it follows a slope, where no foot is low, and where nothing is estimated in between.
    assert tipped(slow) is None
    assert tipped(fast, depth=0.005) is None
    assert tipped([*fast[:2], None, *fast[2:]]) is None
    assert tipped([0.3 * pitch for pitch in fast]) is None
    assert tipped([0.3 * pitch for pitch in fast], scale=0.3) in (0, 5)
    # It is over once the body has come back.
    assert tipped([*fast, 0.11]) in (0, 5)
    assert tipped([*fast, 0.03]) is None
    # A body that has come to rest does not tip any more, else the walk would wait for ever.
    assert tipped([*fast, *[0.12] * 20]) in (0, 5)
    assert tipped([*fast, *[0.12] * 100]) is None


def test_a_robot_that_tips_for_long_has_met_an_edge():
    tipping, missing, tips = Tipping(1.0), MissingGround(STRIDER.leg_names), []
    for pitch in [0.0, 0.05, 0.1, *[0.12] * 12]:
        tipping.step(STANDING, [0.02] * 6, (0.0, pitch), 0.04)
        tips += [] if tipping.leg is None else [tipping.at_edge]
    assert not any(tips[:5])
    assert all(tips[7:10])
    missing.tipped(tipping.leg, 0.2 + 0.1j)
    request = TwistRequest((0.1, 0.0, 0.0), 0.01, None, np.zeros(3))
    assert missing.limit(request, TwistGrant()).limitations[0].cause == "the robot tips at the foot"
    # Another foot at the same edge does not turn it.
    missing.tipped(1, -0.2 + 0.1j)
    assert missing.refuses
    assert not missing.limit(request._replace(twist=(-0.1, 0.0, 0.0)), TwistGrant()).limitations


def test_a_walk_by_estimated_contacts_does_not_go_on_over_an_edge_at_which_it_has_tipped(monkeypatch):
    controller = WalkController(STRIDER)
    readings = SensorReadings(contacts=[True] * 6, attitude=(0.0, 0.0))
    controller.step((0.1, 0.0, 0.0), 0.01, readings=readings)
    ground = controller._walk.ground

    def estimated(*_):
        ground._loads.estimated = True
        return [True] * 6

    monkeypatch.setattr(ground._loads, "contacts", estimated)
    tipping = Tipping(1.0)
    tipping.leg, tipping._since, tipping.step = 0, 1.0, lambda *_: None
    ground._search._tipping = tipping
    for _ in range(20):
        controller.step((0.1, 0.0, 0.0), 0.01, readings=readings)
    assert ground.missing.refuses
    assert {limit.cause for limit in controller.limitations} == {"the robot tips at the foot"}
    for _ in range(3):
        controller.step((-0.1, 0.0, 0.0), 0.01, readings=readings)
    assert not ground.missing.refuses


def test_a_foot_on_its_way_past_an_obstacle_does_not_look_for_the_ground_yet():
    contacts = FootContacts(2)
    for lands, seeks in ((False, True), (True, False)):
        for _ in range(200):
            take_in(contacts, [False, True], [True, True], 0.01, lands=[lands, True])
        assert contacts.seeks(0) == seeks


def test_a_switch_that_stays_open_is_told_by_the_feet_that_its_foot_lifts_off():
    contacts = FootContacts(6)
    for tick in range(60):
        take_in(contacts, [False, tick % 4 > 1, *[True] * 4], [True] * 6, 0.02)
        find_open(contacts, STANDING, None, 0.02)
    assert contacts.is_open(0)
    assert contacts.standing[0]
    assert contacts.touches(0)
    assert contacts.supports(0)
    assert not contacts.is_known(0)
    assert contacts.is_known(1)
    take_in(contacts, [True] * 6, [True] * 6, 0.02)
    assert contacts.is_known(0)
    over_a_hole = FootContacts(6)
    for _ in range(60):
        take_in(over_a_hole, [False, *[True] * 5], [True] * 6, 0.02)
        find_open(over_a_hole, STANDING, (0.0, 0.0), 0.02)
    assert not over_a_hole.is_open(0)


def test_a_robot_that_sinks_at_a_foot_does_not_stand_on_it_whatever_was_lifted_before():
    contacts = FootContacts(6)
    take_in(contacts, [True] * 6, [True] * 6, 0.02)
    find_open(contacts, STANDING, (0.0, 0.0), 0.02)
    for tick in range(60):
        take_in(contacts, [False, tick % 4 > 1, *[True] * 4], [True] * 6, 0.02)
        find_open(contacts, STANDING, (0.0, -0.05), 0.02)
    assert contacts.is_open(0)
    # In the air, and as it is put down on lower ground, it bears nothing: the tilt is no sign of a foot that gives way.
    take_in(contacts, [False] + [True] * 5, [False] + [True] * 5, 0.02)
    take_in(contacts, [False, False, *[True] * 4], [True] * 6, 0.02)
    find_open(contacts, STANDING, (0.0, -0.05), 0.02)
    assert contacts.tips(STANDING, 0.0) is None
    assert contacts.is_open(0)
    find_open(contacts, STANDING, (0.0, 0.1), 0.02)
    assert contacts.tips(STANDING._replace(down=[True, False, False, True, True, True], centre=0.1 + 0.05j), 0.0) == 0
    assert not contacts.is_open(0)


def test_a_contact_that_is_missing_once_after_some_ticks_as_planned_is_not_lost():
    contacts = FootContacts(6)
    take_in(contacts, [True] * 6, [True] * 6, 0.04, count=4)
    take_in(contacts, [False, *[True] * 5], [True] * 6, 0.04, count=4)
    assert contacts.standing[0]
    take_in(contacts, [False, *[True] * 5], [True] * 6, 0.03)
    assert not contacts.standing[0]
    # A foot in the air has lost it before.
    take_in(contacts, [False, *[True] * 5], [False, *[True] * 5], 0.04, count=4)
    assert contacts.lifted[0]


def open_after(pitch, *, ticks):
    """The tick in which a switch is found open whose foot tilts the body while another one loses contact; or None."""
    contacts = FootContacts(6)
    take_in(contacts, [True] * 6, [True] * 6, 0.02)
    find_open(contacts, STANDING, (0.0, 0.0), 0.02)
    for tick in range(ticks):
        take_in(contacts, [False, tick % 4 > 1, *[True] * 4], [True] * 6, 0.02)
        find_open(contacts, STANDING, (0.0, pitch), 0.02)
        if contacts.is_open(0):
            return tick
    return None


@pytest.mark.parametrize(("pitch", "opens"), [(-0.05, True), (0.0, False), (0.05, False)])
def test_a_foot_whose_switch_is_open_lifts_the_body_and_one_over_a_hole_does_not(pitch, opens):
    assert (open_after(pitch, ticks=60) is not None) is opens


def test_a_foot_that_lifts_the_body_far_is_found_sooner_to_have_an_open_switch():
    slow = open_after(-1.05 * 0.003 / FEET[0].real, ticks=100)
    assert open_after(-0.3, ticks=100) < 0.5 * slow < 50


def test_a_foot_that_lifts_the_body_off_all_others_that_would_hold_it_has_an_open_switch():
    def found(tilt, readings=(True, True, True, False, False, False), depths=(0.0, 0.0, 0.0, 0.01, 0.03, 0.02)):
        contacts = FootContacts(6)
        take_in(contacts, [True] * 6, [True] * 6, 0.01)
        find_open(contacts, STANDING, (0.0, 0.0), 0.01, depths=depths)
        ticks = 0
        while not any(map(contacts.is_open, range(6))) and ticks < 60:
            ticks += 1
            take_in(contacts, readings, [True] * 6, 0.01)
            # Hanging feet are high over the ground, and may bear no load by other rules.
            behind = STANDING._replace(centre=-0.05 + 0j)
            find_open(contacts, behind, tilt, 0.01, low=[*[True] * 5, False], depths=depths)
        return [leg for leg in range(6) if contacts.is_open(leg)], ticks

    legs, ticks = found((-0.1, 0.0))
    assert legs == [4]
    assert 0.25 <= 0.01 * ticks <= 0.3
    # The deepest foot has lifted the body, and the others with it.
    assert found((-0.1, 0.0), depths=(0.0, 0.0, 0.0, 0.03, 0.01, 0.02))[0] == [3]
    # It is not by much, or the robot sinks at another foot, or the others hold it.
    assert found((-0.02, 0.0))[0] == []
    assert found((-0.1, 0.1), (False, True, True, False, False, True))[0] == []
    assert found((-0.1, 0.0), (True, True, True, True, False, True))[0] == []


def test_a_foot_that_lifts_off_soon_is_not_lowered_where_others_take_its_load():
    def stands(leaving, ticks, without=5, *, rests=False):
        contacts = FootContacts(2)
        take_in(contacts, [True, False], [True, False], 0.01)
        for _ in range(ticks):
            take_in(contacts, [True, True], [True, True], 0.01, leaving=leaving)
        for _ in range(without):
            take_in(contacts, [True, False], [True, True], 0.01, leaving=leaving, rests=rests)
        return contacts.standing[1], contacts.supports(1)

    assert stands([False, False], 20) == (False, True)
    assert stands([False, True], 20) == (True, True)
    # One that has not stood yet goes on looking for the ground.
    assert stands([False, True], 2) == (False, False)
    # Where the walk waits, it does not lift off soon.
    assert stands([False, True], 20, 20) == (False, False)
    # While the robot rests on the others, a foot that has stood stays.
    assert stands([False, False], 20, 200, rests=True) == (True, False)
    assert stands([False, False], 2, 200, rests=True) == (False, False)


def test_a_foot_that_steps_down_a_slope_rises_over_the_middle_of_its_way():
    felt = FeltInputs([], [], [], 0.0, PostureRates(), 0j, 0.0, 0j, 0.8, 1.0, 0.03, 1.0, 0.0, {})
    for lifted, expected, top in ((0.0, 0.0, 0.03), (0.04, 0.0, 0.05), (0.0, 0.04, 0.07)):
        under = GroundUnder(expected, lowest=-0.2, highest=0.2)
        _, foot = _swinging(lifted, FeltFoot(), under, felt, 0.01, (0.0, 0.5, lifted, 0j))
        assert foot.top == pytest.approx(top)


def test_a_foot_clears_the_ground_that_it_leaves_where_lower_one_is_too_far_to_be_reached_in_its_swing():
    felt = FeltInputs([], [], [], 0.0, PostureRates(), 0j, 0.0, 0j, 0.8, 1.0, 0.03, 0.2, 0.0, {})
    for expected, top in ((-0.02, 0.015), (-0.04, 0.01)):
        under = GroundUnder(expected, lowest=-0.2, highest=0.2)
        _, foot = _swinging(0.0, FeltFoot(), under, felt, 0.01, (0.0, 0.3, 0.0, 0j))
        assert foot.top == pytest.approx(top)


@pytest.mark.parametrize("swing_height", [0.004, 0.012, 0.03, 0.05])
@pytest.mark.parametrize("swing_time", [0.3, 0.6, 1.2])
def test_a_foot_comes_down_once_it_has_travelled_and_by_the_end_of_its_swing(swing_height, swing_time):
    felt = FeltInputs([], [], [], 0.0, PostureRates(), 0j, 0.0, 0j, 0.75, 1.0, swing_height, 0.4, 0.0, {})
    under, height, foot, phase, dt = GroundUnder(0.0, lowest=-0.2, highest=0.2), 0.0, FeltFoot(), 0.0, 0.002
    while height > 0.0 or phase < 0.4:
        height, foot = _swinging(height, foot, under, felt, dt, (phase, swing_time, 0.0, 0j))
        phase += dt / swing_time
    assert 0.75 <= phase < 1.03


@pytest.mark.no_cover
def test_in_physics_feet_that_are_lifted_little_do_not_slide():
    robot = tarsus.load_robot("phantomx")
    robot = robot.replace(gait=dataclasses.replace(robot.gait, swing_height=0.0125))
    plant, controller, slip = SimulatedPlant(robot, servos="ideal"), tarsus.RobotController(robot), 0.0
    speed = 0.5 * WalkController(robot).top_speed((1.0, 0.0, 0.0))
    plant.start(controller.output)
    for _ in range(500):
        controller.step((speed, 0.0, 0.0), 0.01, plant.step(controller.output, 0.01))
        slip += 0.01 * float(plant.state.slip_speeds.mean())
    assert slip < 0.015 * plant.state.body.position[0]


@pytest.mark.parametrize("raised_at", [0.0, 0.2, 0.3, 0.4, 0.415])
def test_a_foot_is_not_thrown_up_by_a_swing_that_becomes_higher(raised_at):
    felt = FeltInputs([], [], [], 0.0, PostureRates(), 0j, 0.0, 0j, 0.8, 1.0, 0.03, 1.0, 0.0, {})
    under, height, foot, heights = GroundUnder(0.0, lowest=0.0, highest=0.2), 0.0, FeltFoot(), []
    for tick in range(50):
        phase = tick / 50
        higher = felt._replace(swing_height=0.03 if phase < raised_at else 0.06)
        height, foot = _swinging(height, foot, under, higher, 0.01, (phase, 0.5, 0.0, 0j))
        heights.append(height)
    assert max(heights) < 0.065
    assert heights[-1] < 0.025


@pytest.mark.parametrize("ticks", [130, 150, 170])
def test_feet_step_as_high_when_the_robot_stops_as_while_it_walks(ticks):
    controller, tops = WalkController(STRIDER), []
    for tick in range(260):
        if tick == ticks:
            tops.clear()
        readings = SensorReadings(contacts=controller.contacts, attitude=(0.0, 0.0))
        controller.step((0.15 * (tick < ticks), 0.0, 0.0), 0.01, readings=readings)
        tops.append((controller.feet[:, 2] - controller.feet[:, 2].min()).max())
    assert max(tops) > 0.025


def test_a_foot_that_has_stood_looks_for_the_ground_slowly_while_three_others_stand():
    felt = FeltInputs([], [], [], 0.0, PostureRates(), 0j, 0.0, 0j, 0.8, 1.0, 0.03, 0.4, 0.0, {})
    under = GroundUnder(0.0, lowest=-0.2, highest=0.2)
    # So not on rough ground, where it may be far below, and not close to where it is expected; where more than three
    # feet always stand, always but where the walk waits for it.
    cases = (
        (-0.01, math.nan, 3, {}, -0.04),
        (-0.01, math.nan, 2, {}, -0.15),
        (-0.01, 0.03, 3, {}, -0.15),
        (-0.01, math.nan, 3, {"rough": 1.0}, -0.15),
        (-0.003, math.nan, 3, {}, -0.15),
        (-0.003, math.nan, 4, {"redundant": True}, -0.02),
        (-0.01, math.nan, 3, {"redundant": True, "rough": 1.0}, -0.02),
        (-0.01, math.nan, 2, {"redundant": True}, -0.15),
        (-0.01, 0.03, 3, {"redundant": True}, -0.15),
        (-0.003, math.nan, 3, {"redundant": True, "pace": 0.3}, -0.15),
    )
    for start, top, others, changes, speed in cases:
        foot, given = FeltFoot(speed, top=top), felt._replace(stands=[True] * others, **changes)
        height, _, after = _searching(start, foot, 0j, 0.0, under, given, 0.1)
        assert after == pytest.approx(speed)
        assert height == pytest.approx(start + 0.1 * speed)


def test_a_foot_that_has_stepped_back_goes_down_at_its_place_while_the_body_backs_off():
    felt = FeltInputs([], [], [], 0.0, PostureRates(), 0j, 0.0, -0.15 + 0j, 0.8, 1.0, 0.03, 0.4, 0.0, {})
    for way, goes_down in ((-0.0015, True), (-0.02, False)):
        under = GroundUnder(0.0, lowest=-0.2, highest=0.2, place=way + 0j)
        height, place, _ = _searching(0.01, FeltFoot(), 0j, 0.0, under, felt, 0.01)
        assert (height < 0.01) == goes_down
        assert place == (way if goes_down else 0j)


def test_a_foot_that_has_met_an_obstacle_goes_down_once_it_is_past_it():
    felt = FeltInputs([], [], [], 0.0, PostureRates(), 0j, 0.0, 0j, 0.8, 1.0, 0.03, 1.0, 0.0, {})
    risen = FeltFoot(top=0.05, top_phase=0.4, drawn_back=0j)
    for place, clears, goes_down in (
        (0j, True, False),
        (0.04 + 0j, True, False),
        (0.06 + 0j, True, True),
        (0j, False, True),
    ):
        under = GroundUnder(0.0, lowest=-0.2, highest=0.2, clears=clears)
        height, _ = _swinging(0.05, risen, under, felt, 0.01, (0.6, 0.5, 0.0, place))
        assert (height < 0.05) == goes_down


def test_feet_go_down_sooner_where_contacts_are_known_late():
    felt = FeltInputs([], [], [], 0.0, PostureRates(), 0j, 0.0, 0j, 0.8, 1.0, 0.03, 1.0, 0.0, {})
    under, high = GroundUnder(0.0, lowest=-0.2, highest=0.2), FeltFoot(top=0.06, top_phase=0.42, speed=-0.3)
    speeds = [
        _swinging(0.06, high, under, felt._replace(late=late), 0.1, (0.5, 0.5, 0.0, 0j))[1].speed
        for late in (0.0, 0.05, 1.0)
    ]
    assert speeds == pytest.approx([-0.06 / 0.25, -0.06 / 0.2, -0.06 / 0.1])


@pytest.mark.parametrize(
    ("late", "depth", "over", "fastest"),
    [
        (0.0, 0.0, 0.0, 0.4),
        (0.05, 0.0, 0.02, 0.4),
        (0.05, 0.0, 0.0, 0.08),
        (0.05, 0.01, 0.0, 0.16),
        (0.02, 0.0, 0.0, 0.2),
    ],
)
def test_near_the_ground_feet_go_down_more_slowly_the_later_contacts_are_known(late, depth, over, fastest):
    felt = FeltInputs([], [], [True] * 2, depth, PostureRates(), 0j, 0.0, 0j, 0.8, 1.0, 0.03, 0.4, late, {})
    under, high = GroundUnder(0.0, lowest=-0.2, highest=0.2), FeltFoot(top=0.2, top_phase=0.42)
    _, swings = _swinging(over, high, under, felt, 0.1, (0.9, 0.5, 0.0, 0j))
    assert swings.speed == pytest.approx(-fastest)
    _, _, searches = _searching(over, FeltFoot(), 0j, 0.0, under, felt, 0.1)
    assert searches == pytest.approx(-min(fastest, max(0.15, over / 0.1)))


@pytest.mark.parametrize(
    ("slow", "over", "speed"), [(0.0, 0.006, 0.24), (1.0, 0.006, 0.09), (0.5, 0.006, 0.16), (1.0, 0.008, 0.23)]
)
def test_feet_that_slow_down_do_so_just_over_the_expected_ground(slow, over, speed):
    felt = FeltInputs([], [], [True] * 2, 0.0, PostureRates(), 0j, 0.0, 0j, 0.8, 1.0, 0.03, 1.0, 0.0, {})
    under, foot = GroundUnder(0.0, lowest=-0.2, highest=0.2), FeltFoot(top=0.06, top_phase=0.42)
    _, swings = _swinging(over, foot, under, felt._replace(slow_contact=slow), 0.1, (0.9, 0.5, 0.0, 0j))
    # A little sooner at its top, the foot has 0.52 of the swing for the way down instead of 0.5.
    assert swings.speed == pytest.approx(-speed, abs=0.004)


def test_feet_whose_contacts_are_known_late_have_travelled_sooner():
    shares = [travel_share(far, late) for far, late in ((0.3, 0.0), (1.0, 0.0), (1.0, 0.1), (1.0, 0.9))]
    assert shares == pytest.approx([0.75, 0.92, 0.82, 0.5])


@pytest.mark.parametrize("name", ["strider", "makeyourpet"])
def test_contacts_that_come_late_make_even_ground_no_rough_one(name):
    late = SensorSuite(contacts=FootSwitch(delay=0.05), attitude=Sensor(delay=0.05))
    robot = tarsus.load_robot(name)
    plant, controller = SimulatedPlant(robot, sensors=late), tarsus.RobotController(robot)
    output, worst, speed = controller.output, 0.0, 0.5 * WalkController(robot).top_speed((1, 0, 0))
    plant.start(output)
    for tick in range(800):
        output = controller.step((speed, 0.0, 0.0), 0.01, plant.step(output, 0.01))
        worst = max(worst, controller._activity.controller._walk.ground.body.roughness.value) if tick > 400 else 0.0
    assert worst < 0.003


@pytest.mark.parametrize(
    ("pace", "slope", "turn"),
    [(1.0, 0.0, 0.12), (0.5, 0.0, 0.08), (0.0, 0.0, 0.04), (1.0, 0.19, 0.08), (0.5, 0.4, 0.04)],
)
def test_a_body_turns_back_more_slowly_where_the_walk_waits_and_on_slopes(pace, slope, turn):
    feet = [(foot, 0.2) for foot in FEET]
    move = BodyMove(0j, feet, pace=pace)
    rates = PostureFeedback("level").rates(FootPlane(0.0, slope, 0.0), (0.02, 0.0), move)
    assert rates.turn == pytest.approx((turn, 0.0))


@pytest.mark.parametrize("ticks", range(90, 94))
def test_the_body_turns_by_an_attitude_within_20_ms(ticks):
    controller = WalkController(STRIDER)
    for tick in range(ticks + 1):
        readings = SensorReadings(contacts=controller.contacts, attitude=(0.04 * (tick >= ticks - 1), 0.0))
        controller.step((0.1, 0.0, 0.0), 0.01, readings=readings)
    state = controller._tick.gait
    aside = [(float(state.foot[leg].imag), state.felt[leg].speed) for leg in np.flatnonzero(state.down)]
    assert len(aside) >= 3
    for left, speed in aside:
        assert speed == pytest.approx(0.24 * left, rel=0.01)


@pytest.mark.parametrize("ticks", [1, 8])
def test_joints_that_lag_make_contacts_late(ticks):
    controller, angles = WalkController(STRIDER), deque[np.ndarray](maxlen=ticks + 1)
    for _ in range(250):
        angles.append(controller.angles)
        readings = SensorReadings(contacts=controller.contacts, joint_angles=angles[0], age={"contacts": 0.01})
        controller.step((0.1, 0.0, 0.0), 0.01, readings=readings)
    assert controller._walk.ground.contacts.age == pytest.approx(max(0.01 * ticks - 0.03, 0.01), abs=0.01)


def test_a_foot_that_has_barely_touched_is_no_support():
    contacts = FootContacts(2)
    for _ in range(10):
        take_in(contacts, [False, True], [False, True], 0.01)
    take_in(contacts, [True, True], [True, True], 0.01)
    assert contacts.supports(0)
    for _ in range(3):
        take_in(contacts, [False, False], [True, True], 0.01)
    assert not contacts.supports(0)
    assert contacts.supports(1)


def test_a_foot_that_hangs_while_the_robot_rests_looks_for_the_ground_once_it_walks():
    contacts, readings = FootContacts(6), [False, True, True, True, True, True]

    def seeks_after(ticks, *, rests):
        for _ in range(ticks):
            take_in(contacts, readings, [True] * 6, 0.02, leaving=[False] * 6, rests=rests)
        return not contacts.standing[0] and contacts.seeks(0)

    assert seeks_after(200, rests=True)
    assert seeks_after(50, rests=False)
    assert not seeks_after(50, rests=False)


def test_a_switch_that_stays_open_is_told_by_a_robot_that_does_not_tip():
    def suspected(tilts, readings, down=(False, True) * 3, *, shaking=False):
        contacts = FootContacts(6)
        for tick, tilt in enumerate(tilts):
            shaken = shaking and tick % 8 > 3
            take_in(contacts, [on and not (shaken and leg == 5) for leg, on in enumerate(readings)], down, 0.01)
            contacts._balance(STANDING._replace(down=down), tilt, 0.01)
        return [leg for leg in range(6) if contacts.is_open(leg)]

    standing, noise = [(0.0, 0.0)] * 60, np.random.default_rng(2).normal(0.0, 0.003, (60, 2)).tolist()
    for still in (standing, noise):
        assert suspected(still, [False, False, False, True, False, True]) == [1]
        assert suspected(still, [False, True, False, True, False, True]) == []
        # A foot of the others that loses contact for a moment tells nothing, and makes it start anew no more.
        assert suspected(still, [False, False, False, True, False, True], shaking=True) == [1]
        # A robot in the air has no contact at all, and one that stands on its other feet tells nothing of this one.
        assert suspected(still, [False] * 6) == []
        assert suspected(still, [True, False, True, True, True, True], [True] * 6) == []
        # The switch of a foot that has just lost its contact works.
        assert suspected(still[:28], [False, False, False, True, False, True]) == []
    # Without a foot on its left, the robot tips to the left; one that tips to the right does not stand there either.
    for way in (-1.0, 1.0):
        tips = [(way * 3.0 * (0.01 * tick) ** 2, 0.0) for tick in range(60)]
        assert suspected(tips, [False, False, False, True, False, True]) == []


def test_contacts_that_come_late_cost_no_way_and_are_no_obstacles():
    controller = WalkController(STRIDER, swing_height=0.06)
    waiting = [np.ones(6, dtype=bool)] * 2
    for _ in range(400):
        waiting.append(controller.feet[:, 2] <= 1e-4)
        readings = SensorReadings(contacts=waiting.pop(0), attitude=(0.0, 0.0), age=0.04)
        controller.step((0.06, 0.0, 0.0), 0.02, readings)
    assert controller._walk.ground.body.roughness.value < 0.005
    assert controller.place[0] > 0.97 * 0.06 * 7.8


def test_the_age_of_contacts_is_known():
    validator = ReadingsValidator(STRIDER)
    touching, forces = (True,) * 6, np.ones(6)
    for readings, age in (
        (SensorReadings(contacts=touching), 0.0),
        (SensorReadings(contacts=touching, age=0.03), 0.03),
        (SensorReadings(contacts=touching, forces=forces, age={"contacts": 0.02, "forces": 0.01}), 0.02),
        (SensorReadings(forces=forces, age={"contacts": 0.02, "forces": 0.01}), 0.01),
    ):
        assert validator.validate(readings, 0.01).contact_age == age


def test_a_switch_that_is_stuck_does_not_stop_the_robot():
    controller = WalkController(STRIDER)
    for _ in range(500):
        contacts = controller.feet[:, 2] <= 1e-4
        contacts[1] = True
        controller.step((0.1, 0.0, 0.0), 0.02, SensorReadings(contacts=contacts, attitude=(0.0, 0.0)))
        # It tells of no obstacle.
        assert controller._walk.ground.body.roughness.value < 0.001
    assert controller.place[0] > 0.8


def test_contact_that_does_not_cease_tells_of_an_obstacle_once_where_the_switch_has_opened_before():
    controller, since, stuck = WalkController(STRIDER), list[int](), False
    roughness = controller._walk.ground.body.roughness
    for tick in range(300):
        contacts = controller.feet[:, 2] <= 1e-4
        # From a stance on that follows a swing in which the switch opened.
        stuck |= tick > 80 and contacts[1]
        contacts[1] |= stuck
        controller.step((0.1, 0.0, 0.0), 0.02, SensorReadings(contacts=contacts, attitude=(0.0, 0.0)))
        gait = controller._tick.gait
        if gait.felt[1].drawn_back is not None and not gait.down[1]:
            since.append(tick)
    # A foot that presses on an obstacle from lift-off rises over it; from its next swing on, the switch is stuck.
    assert since
    assert max(since) - min(since) < 20
    assert 0.0 < roughness.value < 0.02


def test_a_foot_that_meets_an_obstacle_rises_over_it():
    controller = WalkController(STRIDER)
    tops = []
    for tick in range(200):
        contacts = controller.feet[:, 2] <= 1e-4
        gait = controller._tick.gait
        if 20 < tick < 60 and not gait.down[0] and 0.25 < gait.swing_phase[0] < 0.4:
            contacts[0] = True
        controller.step((0.1, 0.0, 0.0), 0.02, SensorReadings(contacts=contacts, attitude=(0.0, 0.0)))
        tops.append(controller.feet[0, 2])
    assert max(tops) > 0.045
    assert controller.limitations == ()


def test_a_foot_that_rises_waits_where_it_is_while_the_walk_stands_still():
    controller = WalkController(STRIDER)
    for _ in range(30):
        contacts = controller.feet[:, 2] <= 1e-4
        controller.step((0.1, 0.0, 0.0), 0.02, SensorReadings(contacts=contacts, attitude=(0.0, 0.0)))
    while not 0.1 < controller._tick.gait.swing_phase.max() < 0.3:
        contacts = controller.feet[:, 2] <= 1e-4
        controller.step((0.1, 0.0, 0.0), 0.02, SensorReadings(contacts=contacts, attitude=(0.0, 0.0)))
    controller._walk.ground.support.pace = 0.0
    rising = ~controller._tick.gait.down
    # No foot bears load any more: the steps wait, and so do feet that rise, until the robot sinks.
    for _ in range(8):
        controller.step((0.1, 0.0, 0.0), 0.02, SensorReadings(contacts=(False,) * 6, attitude=(0.0, 0.0)))
    assert controller._walk.ground.support.pace < 0.5
    assert (~controller._tick.gait.down == rising).all()
    assert controller.walk_state == "searching"


def test_a_robot_that_is_put_down_on_one_foot_finds_no_holes():
    controller = WalkController(STRIDER)

    def walked(seconds, touching=(True,) * 6):
        before = controller.place[0]
        for _ in range(round(seconds / 0.02)):
            contacts = (controller.feet[:, 2] <= 1e-4) & touching
            controller.step((0.1, 0.0, 0.0), 0.02, SensorReadings(contacts=contacts, attitude=(0.0, 0.0)))
        return controller.place[0] - before, [each.text() for each in controller.limitations]

    walked(2.0)
    walked(1.0, (False,) * 6)
    assert "no ground within" not in str(walked(2.0, (True, *[False] * 5))[1])
    walked(1.0)
    way, why = walked(3.0)
    assert way > 0.25
    assert why == []


def test_feet_that_are_due_stay_on_the_ground_while_the_robot_stands():
    controller = WalkController(STRIDER)
    readings = SensorReadings(contacts=(True,) * 6, attitude=(0.0, 0.0))
    controller.step((0.0, 0.0, 0.0), 0.02, readings)
    state = controller._tick.gait
    late = state._replace(step_number=state.step_number - 1, foot=state.foot + 0.02)
    controller._tick = controller._tick._replace(gait=late)
    controller.step((0.0, 0.0, 0.0), 0.02, readings)
    assert controller.contacts.all()


def test_a_robot_that_is_picked_up_or_has_fallen_stops_and_goes_on_once_it_stands_again():
    controller = WalkController(STRIDER)

    def walked(seconds, attitude=(0.0, 0.0), *, held=False):
        before = controller.place[0]
        for _ in range(round(seconds / 0.02)):
            contacts = (controller.feet[:, 2] <= 1e-4) & (not held)
            controller.step((0.1, 0.0, 0.0), 0.02, SensorReadings(contacts=contacts, attitude=attitude))
        return controller.place[0] - before, [each.text() for each in controller.limitations]

    assert walked(2.0)[1] == []
    walked(1.5, held=True)
    lowest = controller.feet[:, 2].min()
    # All feet are down and at one height, to be put on the ground together.
    assert controller._tick.gait.down.all()
    assert np.ptp(controller.feet[:, 2]) < 1e-3
    assert abs(lowest) < 0.01
    way, why = walked(3.0, held=True)
    assert way == pytest.approx(0.0, abs=1e-6)
    assert why == ["ground: no foot touches it: the robot is in the air"]
    # The feet do not search any more.
    assert controller.feet[:, 2].min() == pytest.approx(lowest, abs=1e-5)
    walked(1.0)
    way, why = walked(3.0)
    assert way > 0.25
    assert why == []
    walked(1.0, (0.0, 0.9))
    way, why = walked(2.0, (0.0, 0.9))
    assert way == pytest.approx(0.0, abs=1e-6)
    assert "attitude: 51.57 deg instead of 0 deg, bound 45 deg; the robot has fallen" in why
    # Beyond 60 degrees an attitude is rejected, and the robot has fallen still.
    assert walked(1.0, (2.0, 0.0))[0] == pytest.approx(0.0, abs=1e-6)
    walked(2.0)
    assert walked(3.0)[0] > 0.25
    assert controller._walk.ground.condition.tilt == 0.0


@pytest.mark.parametrize(
    ("attitude", "degrees"), [((math.radians(179.0), 0.0), 179.0), ((1.6, 0.0), 91.67), ((2.0, math.pi), 65.41)]
)
@pytest.mark.parametrize("sensed", [True, False])
def test_a_fall_that_is_too_fast_for_the_attitude_to_be_accepted_is_found(attitude, degrees, sensed):
    controller = WalkController(STRIDER)

    def walked(seconds, attitude=(0.0, 0.0)):
        before, found = controller.place[0], []
        for _ in range(round(seconds / 0.02)):
            contacts = controller.feet[:, 2] <= 1e-4 if sensed else None
            controller.step((0.1, 0.0, 0.0), 0.02, SensorReadings(contacts=contacts, attitude=attitude))
            found.append([each.text() for each in controller.limitations])
        return controller.place[0] - before, found

    way, upright = walked(3.0)
    assert way > 0.25
    assert upright[-1] == []
    _, falls = walked(1.0, attitude)
    fallen = f"attitude: {degrees} deg instead of 0 deg, bound 45 deg; the robot has fallen".replace(".0 ", " ")
    assert [fallen in why for why in falls].index(True) == pytest.approx(11, abs=2)
    way, lies = walked(3.0, attitude)
    assert way == pytest.approx(0.0, abs=1e-6)
    assert {each for why in lies for each in why if "fallen" in each} == {fallen}
    # Set upright, it goes on as before, and does not make up for the time that it lay.
    walked(1.5)
    way, upright = walked(3.0)
    assert way == pytest.approx(0.3, rel=0.05)
    assert upright[-1] == []


@pytest.mark.parametrize("contacts", [None, (True,) * 6])
def test_a_robot_that_lies_on_its_side_from_the_first_reading_on_does_not_walk(contacts):
    controller, way = WalkController(STRIDER), []
    for _ in range(100):
        controller.step((0.1, 0.0, 0.0), 0.02, SensorReadings(contacts=contacts, attitude=(-1.57, 0.1)))
        way.append(controller.place[0])
    why = [each.text() for each in controller.limitations]
    assert "attitude: 89.95 deg instead of 0 deg, bound 45 deg; the robot has fallen" in why
    assert way[50] == way[-1] < 0.03


@pytest.mark.parametrize("lasts", [1, 4])
def test_attitudes_beyond_what_is_accepted_that_do_not_last_are_no_fall(lasts):
    controller = WalkController(STRIDER)
    for tick in range(200):
        attitude = (3.1, 0.0) if tick % 10 < lasts else (0.0, 0.0)
        controller.step((0.1, 0.0, 0.0), 0.02, SensorReadings(contacts=controller.contacts, attitude=attitude))
        assert not [each for each in controller.limitations if "fallen" in each.cause]
    assert controller.place[0] > 0.3


def test_a_foot_whose_swing_has_waited_looks_for_the_ground_as_long_as_any_other():
    contacts = FootContacts(2)
    for _ in range(300):
        take_in(contacts, [True, False], [True, False], 0.01)
    for _ in range(100):
        take_in(contacts, [True, False], [True, True], 0.01)
        assert contacts.seeks(1)
    for _ in range(100):
        take_in(contacts, [True, False], [True, True], 0.01)
    assert not contacts.seeks(1)


def test_the_body_is_lowered_only_for_a_while_for_a_foot_without_ground():
    contacts = FootContacts(6)
    sought = []
    for _ in range(300):
        take_in(contacts, [True] * 5 + [False], [True] * 6, 0.01)
        sought.append(contacts.seeks(5))
    assert not sought[0]
    assert 1.3 < 0.01 * sum(sought) < 1.5
    assert not sought[-1]
    assert not contacts.seeks(0)


def test_while_contacts_are_as_planned_they_are_looked_at_now_and_then_and_a_change_at_once(monkeypatch):
    controller, looks, dt = WalkController(STRIDER), [], 0.01
    look = FootContacts.step

    def noted(contacts, readings, down, elapsed, **more):
        looks.append((round(elapsed / dt), more["count"]))
        look(contacts, readings, down, elapsed, **more)

    monkeypatch.setattr(FootContacts, "step", noted)
    for tick in range(200):
        contacts = controller.contacts
        standing = int(contacts.argmax())
        if tick == 150:
            contacts[standing] = False
        before = len(looks)
        controller.step((0.05, 0.0, 0.0), dt, SensorReadings(contacts=contacts.tolist(), attitude=(0.0, 0.0)))
        if tick == 150:
            assert len(looks) == before + 1
            assert not controller._walk.ground.contacts.touches(standing)
    # No time and no reading is lost.
    assert all(ticks == count for ticks, count in looks)
    assert sum(ticks for ticks, _ in looks) > 190
    assert len(looks) < 120


def test_a_foot_that_has_just_lifted_off_may_touch_the_ground_still_and_not_again():
    contacts, down = FootContacts(6), [False] + [True] * 5
    phases, touching = np.zeros(6), [True] * 6

    def as_planned(readings, standing, at):
        state = WalkController(STRIDER)._tick.gait._replace(down=np.array(standing), swing_phase=at)
        return contacts.estimator.as_planned(readings, state, contacts.lifted)

    for _ in range(3):
        take_in(contacts, touching, [True] * 6, 0.04)
    assert as_planned(touching, [True] * 6, phases)
    phases[0] = 0.1
    assert as_planned(touching, down, phases)
    assert as_planned(down, down, phases)
    # Another foot has lost its contact, and the contact has not ceased by the time at which it has to.
    assert not as_planned([False, False, *touching[2:]], down, phases)
    assert not as_planned(touching, down, phases + 0.3)
    take_in(contacts, down, down, 0.04)
    assert contacts.lifted[0]
    assert as_planned(down, down, phases)
    # A foot that has left the ground meets an obstacle.
    assert not as_planned(touching, down, phases)
    assert not as_planned(None, down, phases)


@pytest.mark.parametrize("last", [4, 5, 6, 7])
def test_a_contact_that_ceases_twice_as_a_foot_lifts_off_is_no_collision(last):
    controller, since = WalkController(tarsus.load_robot("makeyourpet")), np.zeros(6, int)
    for _ in range(200):
        since = np.where(controller.contacts, 0, since + 1)
        contacts = controller.contacts | ((since <= last) | (since == last + 2))
        controller.step((0.1, 0.0, 0.0), 0.01, SensorReadings(contacts=contacts, attitude=(0.0, 0.0)))
        assert all(foot.drawn_back is None for foot in controller._tick.gait.felt)
    assert since.max() > last + 2
