"""Foot switches that get stuck, open or closed, while the robot walks."""

import pytest

import sensor_faults
import tarsus
from sample_contacts import STANDING, find_open, take_in
from tarsus.control.contact.foot_contacts import FootContacts
from tarsus.control.readings import SensorReadings
from tarsus.control.walk_controller import WalkController

STRIDER = tarsus.load_robot("strider")
ALL, WITHOUT_FIRST = [True] * 6, [False] + [True] * 5


def stepped(contacts, readings):
    """Let the first foot swing, with these readings, and land."""
    take_in(contacts, readings, WITHOUT_FIRST, 0.1)
    take_in(contacts, ALL if readings[0] else WITHOUT_FIRST, ALL, 0.1)


@pytest.mark.no_cover
@pytest.mark.parametrize(
    ("name", "fault", "seed"),
    [
        ("phantomx", "switch of the middle left foot closed after 3 s", 1),
        ("strider", "switch of the middle left foot closed after 3 s", 1),
        ("makeyourpet", "switch of the front left foot open after 3 s", 1),
    ],
)
def test_a_robot_walks_on_whose_switch_gets_stuck_under_way(name, fault, seed):
    # They made 0.21, 0.57 and 0.44.
    way, tilt = sensor_faults.walk(name, "blocks40", fault, seed)
    assert way > 0.8
    assert tilt < 2.5


def test_contact_that_does_not_cease_in_three_swings_tells_nothing():
    contacts = FootContacts(6)
    # Until it has opened once, nothing is known of a switch.
    assert contacts.is_closed(0)
    stepped(contacts, WITHOUT_FIRST)
    assert contacts.has_opened(0)
    assert not contacts.is_closed(0)
    for _ in range(2):
        stepped(contacts, ALL)
        assert not contacts.has_opened(0)
        assert not contacts.is_closed(0)
    stepped(contacts, ALL)
    assert contacts.is_closed(0)
    assert not contacts.is_known(0)
    # It opens again.
    take_in(contacts, WITHOUT_FIRST, ALL, 0.1)
    assert contacts.has_opened(0)
    assert contacts.is_known(0)


def test_contact_that_does_not_cease_while_a_foot_draws_back_tells_nothing():
    contacts = FootContacts(6)
    stepped(contacts, WITHOUT_FIRST)
    take_in(contacts, ALL, ALL, 0.1)
    contacts.draws_back(0)
    assert not contacts.is_closed(0)
    take_in(contacts, WITHOUT_FIRST, ALL, 0.1)
    for _ in range(3):
        assert not contacts.is_closed(0)
        contacts.draws_back(0)
    assert contacts.is_closed(0)


@pytest.mark.parametrize(("landings", "stays"), [(1, False), (2, True)])
def test_a_switch_that_is_open_through_two_landings_stays_open_where_the_robot_sinks(landings, stays):
    contacts = FootContacts(6)
    take_in(contacts, ALL, ALL, 0.02)
    find_open(contacts, STANDING, (0.0, 0.0), 0.02)
    for tick in range(60):
        take_in(contacts, [False, tick % 4 > 1, *[True] * 4], ALL, 0.02)
        find_open(contacts, STANDING, (0.0, -0.05), 0.02)
    for _ in range(landings):
        assert contacts.is_open(0)
        take_in(contacts, WITHOUT_FIRST, WITHOUT_FIRST, 0.02)
        take_in(contacts, WITHOUT_FIRST, ALL, 0.02)
    find_open(contacts, STANDING, (0.0, 0.1), 0.02)
    contacts.tips(STANDING, 0.0)
    assert contacts.is_open(0) is stays


def test_a_switch_that_gets_stuck_closed_in_mid_swing_is_no_obstacle_for_long():
    controller, stuck, hovers = WalkController(STRIDER), False, list[float]()
    for tick in range(600):
        contacts, gait = controller.feet[:, 2] <= 1e-4, controller._tick.gait
        stuck |= bool(tick > 100 and not gait.down[1] and 0.2 < gait.swing_phase[1] < 0.4)
        contacts[1] |= stuck
        controller.step((0.1, 0.0, 0.0), 0.02, SensorReadings(contacts=contacts, attitude=(0.0, 0.0)))
        ground = controller._walk.ground
        if 1 in ground.contacts.hovering:
            # A foot above the ground is no support, whatever its switch says, and goes down.
            hovers.append(float(controller.feet[1, 2]))
            assert not ground.contacts.supports(1)
            assert not ground.contacts.stands(1)
    assert max(hovers) > 0.1
    assert min(hovers) < 0.001
    assert not controller.limitations
    assert controller.place[0] > 0.8


def test_a_switch_that_has_never_closed_is_open_where_the_leg_holds_up_its_foot():
    contacts = FootContacts(2)
    for _ in range(3):
        take_in(contacts, [True, False], [True, True], 0.04)
    for _ in range(6):
        take_in(contacts, [False, False], [True, True], 0.04)
        for leg in range(2):
            contacts.held_up(leg, 0.04)
    # The first foot has touched the ground: its leg may rest on an edge.
    assert [contacts.is_open(leg) for leg in range(2)] == [False, True]
    take_in(contacts, [False, True], [True, True], 0.04)
    assert not contacts.is_open(1)


@pytest.mark.no_cover
def test_a_switch_that_is_open_from_the_start_is_found_before_the_foot_steps_back():
    """It took 4.4 s, in which the foot tried all of its places: 0.79 of the way on flat ground."""
    assert sensor_faults.walk("makeyourpet", "flat", "switch of the middle left foot open", 0)[0] > 0.93
