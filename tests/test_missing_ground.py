"""Holes and obstacles: feet step back or try again, and the robot stops and walks away."""

import dataclasses
from types import SimpleNamespace

import mujoco
import numpy as np
import pytest

import edges
import sensor_faults
import tarsus
from sample_contacts import find_open, take_in
from sample_gait_states import begun, rest_of, setup_of
from sample_robots import halved
from tarsus.control.contact.foot_contacts import FootContacts
from tarsus.control.contact.footing import Footing
from tarsus.control.felt.landing import met_ground
from tarsus.control.limitation import LimitationKind
from tarsus.control.limiter.protocol import TwistGrant, TwistRequest
from tarsus.control.readings import ValidReadings
from tarsus.control.search.missing_ground import MissingGround
from tarsus.control.search.search import Search, hole_depth, is_level
from tarsus.control.sensing.leg_odometry import LegOdometry
from tarsus.control.terrain.roughness import Roughness
from tarsus.control.walk.felt_feet import FeltFoot
from tarsus.control.walk.step_timing import StepTiming
from tarsus.gait.swing_trajectory import quintic
from tarsus.simulation import SensorSuite, SimulatedPlant, terrain

NAMES = ("LF", "LM", "LR", "RR", "RM", "RF")
REST = [0.2 + 0.2j, 0.25j, -0.2 + 0.2j, -0.2 - 0.2j, -0.25j, 0.2 - 0.2j]
AHEAD = [REST[0] + 0.05, *REST[1:]]
STANDING = Footing(REST, [True] * 6, 0j, 0.1)


def stepped(
    missing,
    searches,
    feet=AHEAD,
    *,
    stands=(False, *[True] * 5),
    centre=0j,
    deeper=0.0,
    sunk=(0.0,) * 6,
    raised=0.0,
    dt=0.01,
    twist=(0.0, 0.0, 0.0),
    leans=0.0,
    lost=None,
    age=0.0,
):
    missing.twist, missing.lost = twist, lost
    searches = [Search(*search, sunk=sunk[search[0]], raised=raised, leans=leans, age=age) for search in searches]
    footholds = SimpleNamespace(rest=np.array(REST), placement_radii=[0.05] * 6)
    missing.step(searches, Footing(feet, stands, centre, 0.1), dt, footholds=footholds, deeper=deeper)
    return missing


def touching_in_swing(phase, height, foot):
    """State, body and timing of a walk whose first foot swings, and touches the ground again since a moment."""
    setup, lifted = setup_of("strider"), np.arange(6) == 0
    state = begun(setup, rest_of("strider"))._replace(
        down=~lifted,
        swing_phase=np.where(lifted, phase, 0.0),
        ground_height=np.where(lifted, height, 0.0),
        felt=[foot, *[FeltFoot()] * 5],
    )
    body = tarsus.WalkController(setup.robot)._walk.ground.body
    for touches in (False, True):
        for _ in range(10):
            take_in(body.contacts, [touches, *[True] * 5], state.down.tolist(), 0.01)
    return state, body, StepTiming(setup.gait, 1.0)


def seen(missing, holes, edge=1.0, dt=0.01):
    missing.sees(SimpleNamespace(is_hole=lambda place: place.real > edge), holes, REST, dt)


def limited(missing, *twist):
    request = TwistRequest(twist, 0.01, None, np.zeros(3))
    return missing.limit(request, TwistGrant())


def test_a_hole_that_was_seen_is_refused_while_it_is_seen():
    missing, place = MissingGround([str(leg) for leg in range(6)]), REST[0] + 0.05
    seen(missing, {0: place})
    assert limited(missing, 0.1, 0.0, 0.0).fraction == 0.0
    for _ in range(50):
        seen(missing, {}, place.real - 0.01, dt=0.04)
        assert limited(missing, 0.1, 0.0, 0.0).fraction == 0.0
    # A single picture with a hole, or without, changes nothing.
    for edge in (1.0, place.real - 0.01, *[1.0] * 24):
        seen(missing, {}, edge, dt=0.04)
        assert limited(missing, 0.1, 0.0, 0.0).fraction == 0.0
    for _ in range(3):
        seen(missing, {}, dt=0.04)
    assert limited(missing, 0.1, 0.0, 0.0).fraction == 1.0


def test_the_walk_slows_down_the_deeper_a_foot_searches_and_less_on_rough_ground():
    def pace(depth, *, falls=True, deeper=0.0):
        return stepped(MissingGround(NAMES), [(0, depth, falls, True)], deeper=deeper).pace

    depths = [pace(depth) for depth in (0.0, 0.01, 0.015, 0.03)]
    assert depths == sorted(depths, reverse=True)
    assert (depths[0], depths[-1]) == (1.0, 0.0)
    assert 0 < pace(0.03, falls=False) < 1
    assert pace(0.03, deeper=0.03) == 1.0
    assert not stepped(MissingGround(NAMES), [(0, 0.05, True, True)]).places
    assert stepped(MissingGround(NAMES), [(0, 0.05, False, False)]).places


def test_holes_and_edges_are_smaller_for_short_legs():
    def found(scale):
        missing = stepped(MissingGround(NAMES, scale=scale), [(0, 0.015 * scale, True, True)])
        pace = missing.pace
        stepped(missing, [(0, 0.08, True, True)], centre=0.1 + 0j)
        return pace, missing.back

    (pace, back), (short_pace, short_back) = found(1.0), found(0.5)
    assert pace == pytest.approx(short_pace)
    assert short_back == pytest.approx(0.5 * back)
    assert back.real < 0 < pace < 1


def test_a_foot_that_has_stepped_back_searches_anew_and_less_deep():
    # After a long search at the end of its reach, the foot comes down at its next place.
    missing = stepped(MissingGround(NAMES), [(0, 0.03, False, False)])
    assert missing._tries[0] == 1
    place = missing.places[0]
    feet = [place, *REST[1:]]
    for depth in (-0.05, 0.0, 0.03):
        assert stepped(missing, [(0, depth, True, True)], feet=feet)._tries[0] == 1
    assert stepped(missing, [(0, 0.05, True, True)], feet=feet)._tries[0] == 2


def test_the_time_of_a_search_begins_anew_where_a_foot_has_stepped_back():
    """A ditch ahead of the front left foot only; before it, ground is 15 mm lower than elsewhere."""
    controller = tarsus.WalkController(tarsus.load_robot("phantomx"))
    speed, start = 0.5 * controller.top_speed((1, 0, 0)), controller.feet[0, 0]

    def height(x, y):
        return (-1.0 if x > start + 0.16 else -0.015 if x > start - 0.03 else 0.0) if y > 0.02 else 0.0

    missing, tries = controller._walk.ground.missing, 0
    for _ in range(700):
        contacts = [bool(z <= height(x, y) + 3e-4) for x, y, z in controller.feet]
        readings = tarsus.SensorReadings(contacts=contacts, attitude=(0.0, 0.0), joint_angles=controller.angles)
        controller.step((speed, 0.0, 0.0), 0.01, readings)
        tries = max(tries, missing._tries[0])
    assert tries == 1
    assert controller.contacts[0]
    assert missing.refuses


@pytest.mark.no_cover
def test_a_robot_with_short_legs_stops_at_an_edge_and_walks_away_from_it():
    robot = halved(tarsus.load_robot("strider"))
    walk = Walk(terrain.Gaps(start=0.255, width=0.3, depth=0.3, count=1), robot=robot)
    stopped = walk.go(0.064, 7.0)
    assert 0.05 < stopped < 0.15
    assert walk.tilt < np.radians(10)
    assert walk.named
    assert walk.go(-0.064, 3.0) < stopped - 0.12


def test_a_walk_that_slows_down_says_for_which_foot_and_why():
    def named(missing):
        return [(each.leg, each.cause) for each in missing.limitations]

    assert named(stepped(MissingGround(NAMES), [(0, 0.006, True, True)])) == []
    both = [(0, 0.01, True, True), (3, 0.012, True, True)]
    assert named(stepped(MissingGround(NAMES), both)) == [("RR", "the foot looks for the ground")]
    missing = stepped(MissingGround(NAMES), [(0, 0.08, True, True)])
    assert named(missing) == [("LF", "no ground within 80 mm below the other feet")]
    # The command that is refused for it is named where it is refused.
    limited(missing, 0.1, 0.0, 0.0)
    assert missing.refuses
    assert named(missing) == []
    missing = MissingGround(NAMES)
    missing.stopped(1, REST[1], REST[1] + 0.05, 0j)
    assert named(stepped(missing, [(1, 0.0, False, True)])) == [("LM", "an obstacle stops the foot")]


def test_a_foot_of_a_robot_that_waits_at_a_hole_goes_no_further_down_where_that_is_raised():
    missing = stepped(MissingGround(NAMES), [(0, 0.08, True, True)])
    # That foot has to step back first.
    limited(missing, 0.1, 0.0, 0.0)
    assert not missing.is_raised(0.02)
    stepped(missing, [], stands=[True] * 6)
    assert missing.refuses
    assert missing.is_raised(0.006)
    assert not missing.is_raised(0.004)
    missing.tips = 1.0 + 0j
    assert not missing.is_raised(0.006)
    missing.tips = 0j
    limited(missing, -0.1, 0.0, 0.0)
    assert not missing.is_raised(0.006)


def test_a_robot_that_waits_at_an_edge_does_not_push_itself_up():
    # It rocked on feet that lost contact and were lowered in turn, up to 9 degrees, and fell backwards by 42 degrees.
    robot = tarsus.load_robot("phantomx")
    walk = Walk(terrain.Step(rise=-0.3, start=0.540909), robot=robot)
    walk.go(0.25 * tarsus.WalkController(robot).top_speed((1.0, 0.0, 0.0)), 23.0)
    assert walk.tilt < np.radians(15)


def test_a_foot_without_ground_steps_back_then_the_body_backs_off_and_then_the_foot_gives_up():
    missing = stepped(MissingGround(NAMES), [(0, 0.08, True, True)])
    first = missing.places[0]
    assert missing.steps_back(0, AHEAD[0])
    assert missing.pace == 0.0
    # Behind its rest foothold; on its way it is not asked again.
    assert first.real < REST[0].real
    assert stepped(missing, [(0, 0.08, True, True)]).places == {0: first}
    second = stepped(missing, [(0, 0.08, True, True)], [first, *REST[1:]]).places[0]
    assert second.real < first.real
    assert not missing.gives_up(0)
    stepped(missing, [(0, 0.01, False, True)], [second, *REST[1:]], centre=-0.1 + 0j)
    assert not missing.gives_up(0)
    # Though the others hold it, the body backs off, by which the foot gets back to where it has stood.
    assert missing.back == 0
    stepped(missing, [(0, 0.08, True, False)], [second, *REST[1:]], centre=-0.1 + 0j)
    assert missing.back.real < 0
    assert not missing.gives_up(0)
    stepped(missing, [(0, 0.08, True, False)], [second, *REST[1:]])
    assert missing.gives_up(0)
    # Once it stands, it may again.
    assert not stepped(missing, [], stands=[True] * 6).places
    assert not missing.gives_up(0)


def test_a_foot_that_hangs_at_the_end_of_its_reach_at_another_place_steps_on():
    missing = stepped(MissingGround(NAMES), [(0, 0.06, False, False)])
    first = missing.places[0]
    # On its way down it looks further.
    assert stepped(missing, [(0, 0.03, True, False)], [first, *REST[1:]]).places[0] == first
    second = stepped(missing, [(0, 0.03, False, False)], [first, *REST[1:]]).places[0]
    assert second.real < first.real
    # Seen ground below it that the leg does not reach keeps it there for no longer than a search.
    assert stepped(missing, [(0, -0.03, False, True)], [second, *REST[1:]]).places[0] == second
    assert not missing.gives_up(0)
    stepped(missing, [(0, -0.03, False, False)], [second, *REST[1:]])
    stepped(missing, [(0, -0.03, False, False)], [missing.places[0], *REST[1:]])
    assert missing.gives_up(0)


def test_a_foot_at_its_rest_foothold_steps_inwards():
    missing = stepped(MissingGround(NAMES), [(1, 0.08, True, True)], REST)
    assert abs(missing.places[1]) < abs(REST[1])


def test_the_body_backs_off_until_feet_away_from_the_edge_hold_it():
    missing = stepped(MissingGround(NAMES), [(0, 0.08, True, True)], centre=0.02 + 0j)
    assert missing.back.real < 0
    # Feet further back hold it at once, and it does not back off for ever.
    assert stepped(MissingGround(NAMES), [(0, 0.08, True, True)], centre=-0.1 + 0j).back == 0
    for _ in range(100):
        stepped(missing, [(0, 0.08, True, True)], centre=0.02 + 0j)
    assert missing.back == 0


def test_a_robot_that_turns_backs_off_though_feet_away_from_the_edge_hold_it():
    for twist in ((0.1, 0.0, 0.0), (0.0, 0.0, 0.3)):
        missing = MissingGround(NAMES)
        stepped(missing, [], stands=[True] * 6, twist=twist)
        back = stepped(missing, [(0, 0.08, True, True)], centre=-0.1 + 0j).back
        assert (back != 0) is (twist[2] != 0.0)
        # Away from where the foot is.
        assert (back / REST[0]).real <= 0


def test_the_body_does_not_back_off_where_a_leg_only_does_not_reach_the_ground():
    for depth, backs_off in ((0.08, True), (0.015, False)):
        missing = stepped(MissingGround(NAMES), [(0, depth, False, False)], centre=0.02 + 0j)
        assert missing.places.keys() == {0}
        assert bool(missing.back) is backs_off


def test_the_body_does_not_back_off_over_a_foot_that_finds_no_ground_behind_it():
    ahead, behind = (stepped(MissingGround(NAMES), [(leg, 0.08, True, True)], twist=(0.1, 0.0, 0.0)) for leg in (0, 2))
    assert ahead.back.real < 0
    assert behind.places.keys() == {2}
    assert behind.back == 0


def test_a_twist_over_the_edge_is_refused_and_any_other_is_granted():
    missing = MissingGround(NAMES)
    assert limited(missing, 0.1, 0.0, 0.0).fraction == 1.0
    stepped(missing, [(0, 0.08, True, True)])
    grant = limited(missing, 0.1, 0.0, 0.0)
    assert grant.fraction == 0.0
    assert grant.limitations[0].text() == "ground: LF: no ground within 80 mm below the other feet"
    # As long as the foot steps back, and without a command, the edge is remembered.
    for twist in ((-0.1, 0.0, 0.0), (0.0, 0.0, 0.0)):
        assert limited(missing, *twist).fraction == 1.0
        assert limited(missing, 0.1, 0.0, 0.0).fraction == 0.0
    stepped(missing, [], stands=[True] * 6)
    for away in ((-0.1, 0.0, 0.0), (0.1, 0.0, 0.0)):
        assert limited(missing, *away).fraction == 1.0


@pytest.mark.parametrize(("depth", "tries"), [(-0.04, 2), (0.08, 0)])
def test_an_edge_to_known_ground_that_the_leg_does_not_reach_is_tried_with_other_footholds(depth, tries):
    missing, went_on = MissingGround(NAMES), 0
    for _ in range(4):
        stepped(missing, [(0, depth, False, False)])
        cause = limited(missing, 0.1, 0.0, 0.0).limitations[0].cause
        assert (cause == "the ground is lower than the leg reaches") == (depth < 0)
        for _ in range(150):
            stepped(missing, [])
            waits = limited(missing, 0.1, 0.0, 0.0).fraction == 0.0
        went_on += not waits
    assert went_on == tries
    # On ground without holes that is forgotten.
    limited(missing, -0.1, 0.0, 0.0)
    for _ in range(700):
        stepped(missing, [])
    stepped(missing, [(0, depth, False, False)])
    limited(missing, 0.1, 0.0, 0.0)
    for _ in range(150):
        stepped(missing, [])
    assert (limited(missing, 0.1, 0.0, 0.0).fraction == 1.0) == (depth < 0)


def test_where_rough_ground_is_not_found_the_walk_goes_on_with_other_footholds():
    def refused(deeper):
        missing = stepped(MissingGround(NAMES), [(0, 0.05, False, False)], deeper=deeper)
        limited(missing, 0.1, 0.0, 0.0)
        for _ in range(110):
            stepped(missing, [], stands=[True] * 6)
        limited(missing, 0.1, 0.0, 0.0)
        return missing.refuses

    assert refused(0.0)
    assert not refused(0.03)


def test_a_walk_that_goes_on_at_an_edge_makes_up_for_no_lost_time_at_first():
    missing, fast = stepped(MissingGround(NAMES), [(0, 0.05, False, False)], deeper=0.03), []
    request = TwistRequest((0.1, 0.0, 0.0), 0.01, None, np.zeros(3))
    assert MissingGround(NAMES).limit(request, TwistGrant(fraction=1.5)).fraction == 1.5
    for _ in range(300):
        missing.limit(request, TwistGrant(fraction=1.5))
        stepped(missing, [], stands=[True] * 6)
        fast.append(missing.limit(request, TwistGrant(fraction=1.5)).fraction)
    # It stands for a second, goes on at the commanded speed, and is faster then.
    assert sorted(fast) == fast
    assert 140 <= fast.count(1.0) <= 155
    assert fast[-1] == 1.5


@pytest.mark.parametrize(("raised", "goes_on"), [(0.0, False), (0.005, False), (0.03, True)])
def test_where_a_leg_may_rest_on_the_edge_of_a_step_the_walk_goes_on_with_other_footholds(raised, goes_on):
    missing = stepped(MissingGround(NAMES), [(0, 0.077, False, False)], raised=raised)
    # The ground counts as rough from then on.
    assert missing.edge == 0.077 * goes_on
    limited(missing, 0.1, 0.0, 0.0)
    assert missing.refuses
    for _ in range(110):
        stepped(missing, [], stands=[True] * 6)
    limited(missing, 0.1, 0.0, 0.0)
    assert missing.refuses != goes_on
    assert missing.edge == 0.0


def test_a_foot_that_its_leg_holds_up_at_the_end_of_its_reach_does_not_search_for_long():
    def ticks(*, raised, falls=False, age=0.0):
        missing, search = MissingGround(NAMES), [(0, 0.04, falls, True)]
        return next((n for n in range(60) if stepped(missing, search, raised=raised, age=age).places), None)

    assert 28 <= ticks(raised=0.02) <= 31
    # Late contacts of other feet tell later that this one stands, and its switch is open.
    assert 53 <= ticks(raised=0.02, age=0.05) <= 56
    # A servo that lags behind a foot on its way down holds up nothing.
    assert ticks(raised=0.02, falls=True) is None
    assert ticks(raised=0.005) is None


def test_a_foot_that_finds_ground_is_held_up_anew_when_it_searches_again():
    missing = MissingGround(NAMES)
    for searches in (20 * [[(0, 0.04, False, True)]] + [[]]) * 2:
        assert not stepped(missing, searches, raised=0.02).places


def test_a_foot_that_is_measured_deep_is_over_a_hole_whatever_holds_its_leg_up():
    missing = stepped(MissingGround(NAMES), [(0, 0.1, False, False)], raised=0.02)
    assert missing.places
    assert missing.edge == 0.0


@pytest.mark.parametrize(
    ("depth", "leans", "deeper", "hole"),
    [(0.076, 0.0, 0.0, True), (0.074, 0.0, 0.0, False), (0.076, 0.021, 0.0, False), (0.076, -0.021, 0.0, False),
     (0.076, 0.0, 0.01, False), (0.092, 0.0, 0.01, True), (0.124, 0.029, 0.03, True)],
)  # fmt: skip
def test_a_foot_with_contact_is_in_a_hole_at_its_depth_unless_the_body_leans(depth, leans, deeper, hole):
    assert (depth > hole_depth(0.1, deeper) and is_level(leans, deeper, 1.0)) == hole


def test_a_foot_that_is_commanded_deep_and_held_up_by_its_leg_is_over_no_hole():
    assert not stepped(MissingGround(NAMES), [(0, 0.08, True, True)], raised=0.02).places
    # One that lags below its command is where it was commanded to be.
    assert stepped(MissingGround(NAMES), [(0, 0.08, True, True)], raised=-0.02).places


def test_feet_over_their_commands_are_known_where_angles_are_measured():
    robot = tarsus.load_robot("strider")
    odometry, g, commanded = LegOdometry(robot), robot.geometry, [(0.0, 0.0, 0.0)] * 6
    # The legs are straight out; measured, they are turned up at their femur joints.
    higher = ValidReadings(joint_angles=((0.0, 0.1, 0.0),) * 6)
    length = g.femur[0] + g.tibia[0]
    back, rise = length * (np.cos(0.1) - 1), length * np.sin(0.1)
    off = {leg: (back * np.cos(yaw), back * np.sin(yaw), rise) for leg, yaw in enumerate(robot.mount_yaw)}
    found = odometry.feet_off_commanded([0, 3], higher, commanded)
    assert found.keys() == {0, 3}
    for leg in found:
        np.testing.assert_allclose(found[leg], off[leg], atol=1e-12)
    unknown = ValidReadings(joint_angles=(None, *higher.joint_angles[1:]))
    assert odometry.feet_off_commanded([0, 3], unknown, commanded).keys() == {3}
    assert odometry.feet_off_commanded([0, 3], ValidReadings(), commanded) == {}


@pytest.mark.no_cover
@pytest.mark.parametrize(
    ("name", "pace", "rise", "start"),
    [("phantomx", 0.6, -0.04, 0.5), ("ch3r", 0.5, -0.025, 0.5), ("makeyourpet", 0.5, -0.05, 0.54)],
)
def test_a_robot_with_a_low_body_gets_down_a_step_on_whose_edge_its_legs_rest(name, pace, rise, start):
    robot, dt = tarsus.load_robot(name), 0.01
    speed = pace * tarsus.WalkController(robot).top_speed((1, 0, 0))
    plant = SimulatedPlant(robot, terrain=terrain.Step(rise=rise, start=start), sensors="ideal", servos="catalogue")
    controller = tarsus.RobotController(robot)
    output = controller.output
    plant.start(output)
    for _ in range(round(0.85 / speed / dt)):
        output = controller.step((speed, 0.0, 0.0), dt, plant.step(output, dt))
    # Refused, it would stay at 0.2 m.
    assert plant.state.body.position[0] > 0.3


def test_a_foot_that_is_stopped_tries_again_then_beside_it_and_then_stays_before_it():
    missing, foot, goal = MissingGround(NAMES), REST[0] - 0.05, REST[0] + 0.05
    searches = [(0, -0.05, False, True)]
    assert not missing.tries(0, foot)
    for _ in range(2):
        # Drawn back from where it was stopped first, wherever it is stopped next.
        assert missing.stopped(0, foot, goal, 0j) == pytest.approx(-0.04)
        assert stepped(missing, searches, [foot, *REST[1:]]).places == {0: goal}
        assert missing.pace == 0.0
        assert missing.back == 0.0
    for side in (-1, 1):
        # Towards the body, then away from it: first beside the place, then on from there.
        missing.stopped(0, foot, goal, 0j)
        waypoint = missing.places[0]
        assert waypoint == pytest.approx(foot - 0.04 + side * 0.06j)
        assert missing.tries(0, foot)
        feet = [waypoint, *REST[1:]]
        # Contact at the place beside it is none of the ground.
        assert stepped(missing, [], feet).places[0] == pytest.approx(goal + side * 0.06j)
    missing.stopped(0, foot, goal, 0j)
    assert missing.places[0] == pytest.approx(foot - 0.04)
    assert not missing.tries(0, foot)
    refused = limited(missing, 0.1, 0.0, 0.0)
    assert refused.fraction == 0.0
    assert refused.limitations[0].leg == "LF"
    # Of feet that go back, the body would go on.
    assert missing.held(-0.02 + 0.01j) == pytest.approx(-0.02)
    assert missing.held(0.02 + 0.01j) == 0.0
    for free in ((0.0, 0.1, 0.0), (0.0, 0.0, 0.5), (-0.1, 0.0, 0.0)):
        assert limited(missing, *free).fraction == 1.0
        assert missing.held(-0.02 + 0.01j) == 0.0
        # Feet that touch the obstacle meanwhile are not stopped by it.
        assert missing.obstacles.leaves(-0.05 + 0.0j)
        assert not missing.obstacles.leaves(0.05 + 0.0j)
    limited(missing, 0.1, 0.0, 0.0)
    granted = 0
    for _ in range(9):
        for _ in range(100):
            assert not stepped(missing, [], REST, stands=[True] * 6).obstacles.stops
        # It is tried with other footholds once.
        if limited(missing, 0.1, 0.0, 0.0).fraction == 1.0:
            granted += 1
            for _ in range(5):
                missing.stopped(0, foot, goal, 0j)
            limited(missing, 0.1, 0.0, 0.0)
    assert granted == 1
    assert limited(missing, 0.1, 0.0, 0.0).fraction == 0.0
    limited(missing, -0.1, 0.0, 0.0)
    for _ in range(700):
        stepped(missing, [], REST, stands=[True] * 6)
    assert not missing.obstacles.leaves(-0.05 + 0.0j)


def test_a_foot_that_may_swing_out_tries_again_there_before_it_tries_other_sides():
    missing, foot, goal = MissingGround(NAMES), REST[0] - 0.05, REST[0] + 0.05
    for _ in range(2):
        missing.stopped(0, foot, goal, 0.03j)
        waypoint = missing.places[0]
        assert waypoint == pytest.approx(foot - 0.04 + 0.03j)
        assert stepped(missing, [], [waypoint, *REST[1:]]).places[0] == pytest.approx(goal + 0.03j)
    missing.stopped(0, foot, goal, 0.03j)
    assert missing.places[0] == pytest.approx(foot - 0.04 - 0.06j)


def test_a_foot_that_is_stopped_at_its_goal_goes_straight_back_to_it():
    missing = MissingGround(NAMES)
    assert missing.stopped(0, REST[0], REST[0], 0j) == 0j
    assert missing.places[0] == REST[0]


def test_a_foot_that_has_got_past_an_obstacle_looks_for_the_ground_like_any_other():
    missing, goal = MissingGround(NAMES), AHEAD[0] + 0.05
    missing.stopped(0, AHEAD[0], goal, 0j)
    hangs = [(0, 0.03, False, True)]
    assert stepped(missing, hangs, AHEAD).pace == 0.0
    past = stepped(missing, hangs, [goal, *REST[1:]])
    assert not past.places
    assert 0.0 < past.pace < 1.0


def test_a_twist_into_a_hole_that_is_seen_is_refused_before_a_foot_is_over_it():
    missing = MissingGround(NAMES)
    seen(missing, {0: AHEAD[0], 5: REST[5]})
    seen(missing, {0: AHEAD[0]})
    refused = limited(missing, 0.1, 0.0, 0.0)
    assert refused.fraction == 0.0
    assert refused.limitations[0].text() == "ground: LF: no ground within reach at its next foothold"
    assert not missing.places
    for _ in range(300):
        stepped(missing, [], REST, stands=[True] * 6)
        assert limited(missing, 0.1, 0.0, 0.0).fraction == 0.0
    for away in ((-0.1, 0.0, 0.0), (0.1, 0.0, 0.0)):
        assert limited(missing, *away).fraction == 1.0


def test_a_body_that_stops_with_rest_footholds_over_a_hole_backs_off_until_they_are_not():
    missing = MissingGround(NAMES)
    seen(missing, {0: AHEAD[0]})
    for twist, edge, refused, backs in ((0.1, 0.1, True, False), (0.0, 0.1, True, True), (0.0, 0.3, False, False)):
        seen(missing, {}, edge=edge)
        assert (limited(missing, twist, 0.0, 0.0).fraction == 0.0) == refused
        assert (stepped(missing, [], REST, stands=[True] * 6).back.real < 0) == backs
    # No farther than it may, and away from there at once.
    seen(missing, {}, edge=0.1)
    ticks = [stepped(missing, [], REST, stands=[True] * 6).back.real for _ in range(200)]
    assert 0.05 < -0.01 * sum(ticks) < 0.1
    assert ticks[-1] == 0
    assert limited(missing, 0.0, 0.0, 0.0).fraction == 0.0
    assert limited(missing, -0.1, 0.0, 0.0).fraction == 1.0


def test_a_robot_that_tips_goes_back_until_its_feet_hold_it_well():
    def back(centre):
        stands, search = [False, *[True] * 4, False], [(0, 0.03, True, True)]
        missing = stepped(MissingGround(NAMES), search, stands=stands, centre=0.1 + 0j)
        assert missing.back.real < 0
        return stepped(missing, search, stands=stands, centre=centre).back.real

    assert back(-0.01 + 0j) < 0
    assert back(-0.05 + 0j) == 0


def test_a_foot_behind_the_body_that_loses_its_ground_has_met_an_edge_that_the_robot_leaves():
    for twist, leg, way in (((0.1, 0.0, 0.0), 0, 1), ((0.1, 0.0, 0.0), 2, -1), ((0.1, 0.0, 0.0), 1, 1)):
        missing = stepped(MissingGround(NAMES), [], REST, stands=[True] * 6, twist=twist)
        stands = [other != leg for other in range(6)]
        place = stepped(missing, [(leg, 0.08, True, True)], REST, stands=stands).places[leg]
        assert (place - REST[leg]).real * way < 0
        assert (limited(missing, *twist).fraction == 0.0) == (way == 1)


class Walk:
    """A robot in physics, a strider if no other one is given."""

    def __init__(self, ground, sensors="ideal", robot=None, servos="catalogue"):
        robot = robot or tarsus.load_robot("strider")
        self.plant = SimulatedPlant(robot, terrain=ground, sensors=sensors, servos=servos)
        self.controller = tarsus.RobotController(robot)
        self.output = self.controller.output
        self.plant.start(self.output)
        self.tilt = self.yaw = 0.0

    def go(self, speed, time, turning=0.0):
        """Return where the body is after a walk."""
        for _ in range(round(100 * time)):
            self.output = self.controller.step((speed, 0.0, turning), 0.01, self.plant.step(self.output, 0.01))
            assert not self.plant.state.body_touches
            *tilt, yaw = np.asarray(self.plant.state.body.rpy).tolist()
            self.tilt, self.yaw = max(self.tilt, *map(abs, tilt)), np.unwrap([self.yaw, yaw])[1]
        return self.plant.state.body.position[0]

    @property
    def named(self):
        """The legs that the ground stops."""
        return {limit.leg for limit in self.output.limitations if limit.kind is LimitationKind.GROUND and limit.leg}


@pytest.mark.no_cover
@pytest.mark.parametrize("name", ["strider", "makeyourpet"])
def test_a_robot_turns_on_the_spot_at_an_edge(name):
    robot = tarsus.load_robot(name)
    speed, rate = (0.5 * tarsus.WalkController(robot).top_speed(way) for way in ((1, 0, 0), (0, 0, 1)))
    walk = Walk(terrain.Step(rise=-0.4, start=0.49), robot=robot)
    walk.go(speed, 6.0)
    before = walk.yaw
    walk.go(0.0, 6.0, turning=rate)
    assert walk.yaw - before > 0.4 * rate * 6.0
    assert walk.tilt < np.radians(15)


@pytest.mark.no_cover
def test_a_robot_stops_at_an_edge_in_ticks_of_20_ms_too():
    found = edges.walk(edges.Job("phantomx", 0.0, "20 ms ticks", 0.5, 0.25))
    assert (found.kind, found.touched) == ("back", 0.0)
    assert found.tilt < 18


@pytest.mark.no_cover
@pytest.mark.parametrize("edge", [0.515, 0.53])
def test_a_robot_whose_leg_has_rested_on_an_edge_walks_back_from_it_calmly(edge):
    # The ground there is not rough: feet that went down faster, and pressed on it, tilted the body by 12 to 15 degrees.
    robot, sensors = tarsus.load_robot("phantomx"), edges.SENSORS["switches, joint angles"]
    speed = 0.25 * tarsus.WalkController(robot).top_speed((1.0, 0.0, 0.0))
    commands = (((speed, 0.0, 0.0), 0.9 / speed), ((-speed, 0.0, 0.0), 0.2 / speed))
    found, way = edges.drive(robot, terrain.Step(rise=-0.3, start=edge), sensors, commands, 0.02)
    assert way[-1] < max(way) - 0.05
    assert found.tilt < 10


@pytest.mark.no_cover
@pytest.mark.parametrize("edge", [0.5, 0.515])
def test_a_robot_stops_calmly_at_an_edge_whatever_the_zero_offsets_of_its_load_cells(edge):
    # Feet over the edge touched by 1 N of offset, and it tipped by 11 to 12 degrees.
    robot, sensors = tarsus.load_robot("makeyourpet"), sensor_faults.SUITES[sensor_faults.LOAD_CELLS]
    speed = 0.5 * tarsus.WalkController(robot).top_speed((1.0, 0.0, 0.0))
    found, _ = edges.drive(robot, terrain.Step(rise=-0.3, start=edge), sensors, [((speed, 0.0, 0.0), 8.0)], 0.01)
    assert (found.kind, found.touched) == ("", 0.0)
    assert found.tilt < 6


@pytest.mark.no_cover
def test_legs_with_stiff_servos_that_collide_do_not_throw_the_robot_over():
    # A foot that went on at its speed, and then rose along the face of a block, pulled the body down by 36 degrees.
    robot, ground = tarsus.load_robot("makeyourpet"), terrain.Blocks(rise=0.06, size=0.15, clear=0.35, seed=5)
    speed = 0.5 * tarsus.WalkController(robot).top_speed((1.0, 0.0, 0.0))
    walk = Walk(ground, robot=robot, servos="ideal")
    assert walk.go(speed, 1.2 / speed) > 1.0
    assert walk.tilt < np.radians(18)


@pytest.mark.no_cover
def test_a_robot_stops_at_a_wall_says_so_and_walks_away_from_it():
    walk = Walk(terrain.Step(rise=0.3, start=0.41))
    stopped = walk.go(0.13, 6.0)
    assert stopped < 0.3
    assert walk.named & {"front left", "front right"}
    # It neither pushes nor climbs, and tries other footholds once.
    assert walk.go(0.13, 3.0) == pytest.approx(stopped, abs=0.05)
    assert walk.go(0.13, 2.0) == pytest.approx(walk.go(0.13, 1.0), abs=0.001)
    assert walk.tilt < np.radians(8)
    assert walk.go(-0.13, 2.0) < stopped - 0.1


class Post:
    """A post in the way of the middle left leg."""

    friction = 0.8

    def height(self, x, y):
        return np.where(np.maximum(np.abs(np.asarray(x) - 0.24), np.abs(np.asarray(y) - 0.308)) < 0.02, 0.09, 0.0)

    def add_to(self, spec):
        terrain.Flat().add_to(spec)
        attributes = {"contype": 1, "conaffinity": 0, "friction": (0.8, 0.005, 1e-4), "priority": 1}
        kind = mujoco.mjtGeom.mjGEOM_BOX
        spec.worldbody.add_geom(type=kind, size=(0.02, 0.02, 0.045), pos=(0.24, 0.308, 0.045), **attributes)


def test_a_leg_gets_past_a_post_in_its_way():
    walk = Walk(Post())
    assert walk.go(0.13, 6.0) > 0.45
    assert not walk.named
    assert walk.tilt < np.radians(15)


def test_a_robot_stops_at_a_hole_says_so_and_walks_away_from_it():
    walk = Walk(terrain.Gaps(start=0.35, width=0.2, depth=0.15, count=1))
    stopped = walk.go(0.13, 3.5)
    assert stopped < 0.35
    assert walk.named
    assert walk.go(0.13, 0.5) == pytest.approx(stopped, abs=0.02)
    assert walk.go(-0.13, 1.5) < stopped - 0.08


@pytest.mark.parametrize("start", [0.46, 0.47])
def test_a_foot_that_touches_the_wall_of_a_trench_does_not_stand(start):
    # It closed its switch 0.8 body heights below the others; the robot walked on, and lay on the edge.
    robot, trench = tarsus.load_robot("strider"), terrain.Gaps(start=start, width=0.06, depth=0.25, count=1)
    speed = 0.5 * tarsus.WalkController(robot).top_speed((1.0, 0.0, 0.0))
    commands = [((speed, 0.0, 0.0), 1.9), ((0.0, 0.0, 0.0), 1.4)] * 3
    found, _ = edges.drive(robot, trench, edges.SENSORS["switches, joint angles"], commands)
    assert (found.kind, found.touched) == ("", 0.0)
    assert found.tilt < 10


class ObliqueEdge:
    """Level ground that ends at an edge 30 degrees off the y axis, 0.44 m ahead of the middle."""

    friction = 0.8

    def height(self, x, y):
        return np.where(np.asarray(x) + np.asarray(y) * np.tan(np.pi / 6) < 0.44, 0.0, -0.5)

    def add_to(self, spec):
        attributes = {"contype": 1, "conaffinity": 0, "friction": (0.8, 0.005, 1e-4), "priority": 1}
        turn, place = (np.cos(np.pi / 12), 0, 0, np.sin(np.pi / 12)), (0.44 - 2 * np.cos(np.pi / 6), -1.0, -0.25)
        kind = mujoco.mjtGeom.mjGEOM_BOX
        spec.worldbody.add_geom(type=kind, size=(2.0, 4.0, 0.25), pos=place, quat=turn, **attributes)


@pytest.mark.no_cover
@pytest.mark.parametrize(("name", "start"), [("strider", 0.5), ("makeyourpet", 0.5), ("phantomx", 0.56)])
def test_a_robot_without_sensors_in_its_feet_stops_at_an_edge(name, start):
    robot, sensors = tarsus.load_robot(name), SensorSuite.named("smart")
    sensors = dataclasses.replace(sensors, attitude=SensorSuite.named("hobby").attitude)
    speed = 0.5 * tarsus.WalkController(robot).top_speed((1, 0, 0))
    walk = Walk(terrain.Step(rise=-0.3, start=start), sensors=sensors, robot=robot)
    stopped = walk.go(speed, 0.7 / speed)
    assert walk.go(-speed, 0.4 / speed) < stopped - 0.1
    assert walk.tilt < np.radians(10)


@pytest.mark.no_cover
def test_a_robot_that_stands_at_an_edge_follows_a_body_pose():
    walk = Walk(terrain.Step(rise=-0.3, start=0.6))
    walk.go(0.15, 6.0)
    assert walk.named
    before, twist = walk.controller._activity.controller._tick.gait.posture.value, (0.15, 0.0, 0.0)
    for _ in range(300):
        command = tarsus.Command(twist=twist, body=(0.0, 0.0, 0.01, 0.0, 0.05, 0.0))
        walk.output = walk.controller.step(command, 0.01, walk.plant.step(walk.output, 0.01))
    after = walk.controller._activity.controller._tick.gait.posture.value
    assert (after - before)[[2, 4]] == pytest.approx((0.01, 0.05), abs=1e-3)


def test_a_robot_comes_back_whose_foot_has_found_no_ground_at_any_place_behind_an_oblique_edge():
    walk = Walk(ObliqueEdge())
    stopped = walk.go(0.26, 5.5)
    assert walk.named == {"front left"}
    assert walk.tilt < np.radians(3)
    # Its middle comes 0.1 m back while the foot still looks for ground behind the edge; then it walks away.
    assert walk.go(-0.26, 6.0) < stopped - 0.3


@pytest.mark.no_cover
def test_a_robot_that_sees_a_hole_stops_before_it_and_walks_away():
    walk = Walk(terrain.Gaps(start=0.4, width=0.2, depth=0.15, count=1), sensors="camera")
    stopped = walk.go(0.13, 3.5)
    assert stopped < 0.3
    assert walk.named
    assert walk.output.limitations[0].cause == "no ground within reach at its next foothold"
    assert walk.go(0.13, 1.0) == pytest.approx(stopped, abs=0.02)
    assert walk.tilt < np.radians(3)
    assert walk.go(-0.13, 2.0) < stopped - 0.1


@pytest.mark.parametrize(("start", "pace"), [(0.31, 0.13), (0.41, 0.065), (0.49, 0.065)])
def test_a_robot_that_stops_at_a_hole_that_it_sees_rests_and_comes_back(start, pace):
    walk = Walk(terrain.Gaps(start=start, width=0.2, depth=0.15, count=1), sensors="camera")
    walk.go(pace, 8.0)
    walk.go(0.0, 3.0)
    rested = walk.go(0.0, 1.0)
    assert walk.go(0.0, 1.0) == pytest.approx(rested, abs=0.002)
    assert walk.go(-pace, 4.0) < rested - 0.1
    assert walk.tilt < np.radians(6)


@pytest.mark.no_cover
def test_a_robot_crosses_a_trench_that_it_sees():
    walk = Walk(terrain.Gaps(start=0.35, width=0.08, depth=0.15, count=1), sensors="camera")
    assert walk.go(0.19, 4.5) > 0.35 + 0.08


@pytest.mark.parametrize(("twist", "way"), [((0.1, 0.0, 0.0), 1), ((0.0, 0.0, 0.3), REST[0]), ((0.0,) * 3, -1)])
def test_a_foot_that_loses_its_ground_while_it_is_moved_has_met_the_edge_on_its_way(twist, way):
    # It has passed its rest foothold already.
    missing, feet = MissingGround(NAMES), [REST[0] - 0.02, *REST[1:]]
    stepped(missing, [], feet, stands=[True] * 6, twist=twist)
    # The robot is stopped, or sent back, while it looks for the ground.
    stepped(missing, [(0, 0.08, True, True)], feet, twist=(-0.1, 0.0, 0.0))
    assert ((missing.places[0] - REST[0]) / way).real < 0
    assert missing.held(-0.01 * way) == pytest.approx(0.0)
    limited(missing, *(0.1 * np.array([complex(way).real, complex(way).imag, 0.0])))
    assert missing.held(-0.01 * way) == pytest.approx(-0.01 * way)
    two = [False, True, False, False, True, False]
    missing = stepped(MissingGround(NAMES), [], feet, twist=twist)
    assert (stepped(missing, [(0, 0.03, True, True)], feet, stands=two).back / way).real < 0


def test_an_edge_stays_where_it_is_as_the_robot_turns():
    missing, turned = stepped(MissingGround(NAMES), [(0, 0.08, True, True)], twist=(0.1, 0.0, 0.0)), np.pi / 2
    assert limited(missing, 0.1, 0.0, 0.0).fraction == 0.0
    missing.turn_to(turned)
    # Ahead is to the right by then.
    assert limited(missing, 0.0, -0.1, 0.0).fraction == 0.0
    assert limited(missing, 0.1, 0.0, 0.0).fraction == 1.0


@pytest.mark.parametrize(("waits", "speed", "way"), [(10, -0.1, 1), (10, 0.0, 1), (10, 0.1, 1), (610, -0.1, 1)])
def test_a_foot_that_loses_its_ground_on_the_way_back_from_an_edge_has_met_that_edge(waits, speed, way):
    missing, behind = stepped(MissingGround(NAMES), [(0, 0.08, True, True)]), [REST[0] - 0.04, *REST[1:]]
    stepped(missing, [], stands=[True] * 6)
    for _ in range(waits):
        limited(missing, -0.1, 0.0, 0.0)
        stepped(missing, [], behind, stands=[True] * 6, twist=(speed, 0.0, 0.0))
    place = stepped(missing, [(0, 0.08, True, True)], behind).places[0]
    assert (place - REST[0]).real * way < 0
    # Another place knows nothing of it, and an obstacle is no edge.
    missing.forget()
    for _ in range(5):
        missing.stopped(0, REST[0], REST[0] + 0.05, 0j)
    stepped(missing, [], stands=[True] * 6)
    limited(missing, -0.1, 0.0, 0.0)
    stepped(missing, [], behind, stands=[True] * 6)
    assert (stepped(missing, [(0, 0.08, True, True)], behind).places[0] - REST[0]).real > 0


def test_a_foot_that_loses_its_ground_on_the_way_back_after_another_attempt_has_met_that_edge():
    missing = stepped(MissingGround(NAMES), [(0, 0.05, False, False)], deeper=0.03, twist=(0.1, 0.0, 0.0))
    for _ in range(110):
        limited(missing, 0.1, 0.0, 0.0)
        stepped(missing, [], stands=[True] * 6, deeper=0.03)
    assert limited(missing, 0.1, 0.0, 0.0).fraction == 1.0
    limited(missing, -0.1, 0.0, 0.0)
    behind = [REST[0] - 0.04, *REST[1:]]
    stepped(missing, [], behind, stands=[True] * 6, twist=(-0.1, 0.0, 0.0))
    assert (stepped(missing, [(0, 0.1, True, True)], behind).places[0] - REST[0]).real < 0


def test_a_foot_that_has_found_no_ground_at_any_place_steps_first_on_the_way_back():
    missing = MissingGround(NAMES)
    for _ in range(4):
        stepped(missing, [(0, 0.08, False, False)], [missing.places.get(0, AHEAD[0]), *REST[1:]])
        limited(missing, 0.1, 0.0, 0.0)
    assert missing.gives_up(0)
    for twist, again in (((0.1, 0.0, 0.0), []), ((0.0, 0.0, 0.0), []), ((-0.1, 0.0, 0.0), [0])):
        limited(missing, *twist)
        assert missing.stranded == again
        stepped(missing, [(0, 0.08, False, False)], [missing.places[0], *REST[1:]])
        assert (missing.pace > 0.0) is bool(again)
    stepped(missing, [], stands=[True] * 6)
    limited(missing, -0.1, 0.0, 0.0)
    assert missing.stranded == []


@pytest.mark.parametrize("speed", [0.05, 0.3])
def test_the_body_moves_back_over_its_feet_where_these_do_not_hold_a_robot_that_steps(speed):
    missing = MissingGround(NAMES)
    for _ in range(4):
        stepped(missing, [(0, 0.08, False, False)], [missing.places.get(0, AHEAD[0]), *REST[1:]])
        limited(missing, 0.1, 0.0, 0.0)

    def way(*twist):
        speeds = []
        for _ in range(400):
            limited(missing, *twist)
            stepped(missing, [(0, 0.08, False, False)], [missing.places[0], *REST[1:]])
            speeds.append(missing.back)
        assert not speeds[-1]
        return 0.01 * sum(speeds), max(map(abs, speeds))

    # As far as the body backs off an edge by itself, then no way by turning, and as far again.
    assert way(0.1, 0.0, 0.0)[0] == pytest.approx(-0.08, abs=0.01)
    assert way(0.0, 0.0, 0.5) == way(0.0, 0.0, 0.0) == (0.0, 0.0)
    assert way(-speed, 0.0, 0.0) == (pytest.approx(-0.08, abs=0.002), min(speed, 0.15))


def test_a_robot_that_tips_towards_a_foot_goes_back_at_once_but_not_far():
    two = [False, True, False, False, True, False]
    missing, deep = MissingGround(NAMES), [(0, 0.03, True, True)]
    assert stepped(missing, deep, stands=two).tips.real > 0
    assert missing.back.real < 0
    assert not missing.places
    # Not where the other feet hold it, where the foot may still find ground, and on rough ground not so soon.
    assert stepped(MissingGround(NAMES), deep).back == 0
    assert stepped(MissingGround(NAMES), [(0, 0.015, True, True)], stands=two).back == 0
    assert stepped(MissingGround(NAMES), deep, stands=two, deeper=0.03).back == 0
    assert stepped(MissingGround(NAMES), [(0, 0.005, True, True)], stands=two, sunk=[0.02] * 6).back.real < 0
    # A body that sinks far tips, whatever the others seem to hold.
    assert stepped(MissingGround(NAMES), deep, sunk=[0.025] * 6).back.real < 0
    # Not where the foot lifts the body: it stands on ground that its switch does not tell of.
    assert stepped(MissingGround(NAMES), deep, stands=two, sunk=[-0.01] * 6).back == 0
    for _ in range(100):
        stepped(missing, deep, stands=two)
    assert missing.back == 0


def test_a_robot_that_its_feet_do_not_hold_tips_where_a_foot_has_lost_its_ground():
    def tips(deeper=0.0, *, touching=(1, 4), time=0.06, tilt=(0.0, 0.1)):
        contacts = FootContacts(6)
        take_in(contacts, [True] * 6, [True] * 6, 0.02)
        find_open(contacts, STANDING, (0.0, 0.0), 0.02)
        for _ in range(round(time / 0.02)):
            take_in(contacts, [leg in touching for leg in range(6)], [True] * 6, 0.02)
            find_open(contacts, STANDING, tilt, 0.02)
        return contacts.tips(STANDING, deeper)

    assert tips() in (0, 5)
    assert tips(tilt=(0.0, -0.1)) in (2, 3)
    # Not where the other feet hold it, where it sinks by less, at once, and where it is lifted.
    assert tips(touching=(1, 2, 3, 4, 5)) is None
    assert tips(0.02) is None
    assert tips(time=0.02) is None
    assert tips(touching=()) is None


@pytest.mark.parametrize("before", [(), ((0.0, 0.1), None), (None, None)])
def test_an_attitude_that_is_missing_for_a_tick_tips_no_robot_that_leans(before):
    contacts = FootContacts(6)
    take_in(contacts, [True] * 6, [True] * 6, 0.02)
    if before:
        find_open(contacts, STANDING, before[0], 0.02)
    take_in(contacts, [False, *[True] * 5], [True] * 6, 0.02)
    for tilt in (*before[1:], (0.0, 0.1), (0.0, 0.11)):
        find_open(contacts, STANDING, tilt, 0.02)
    assert contacts.sunk[0] == pytest.approx(0.01 * REST[0].real)


def test_a_walk_that_tips_stops_backs_off_and_says_so():
    missing = stepped(MissingGround(NAMES), [], stands=[True] * 6, lost=5)
    assert missing.pace == 0.0
    assert missing.back.real < 0 < missing.back.imag
    assert [limit.leg for limit in missing.limitations] == ["RF"]
    assert stepped(missing, [], stands=[True] * 6).pace == 1.0


def test_feet_of_a_body_that_is_far_off_its_attitude_do_not_step_back():
    # One in front hangs over the edge, or holds the body on it; one behind is in the air.
    for depth, leans, steps, tips in ((0.08, 0.0, True, False), (0.08, 0.03, False, True), (0.08, -0.03, False, False)):
        missing = stepped(MissingGround(NAMES), [(0, depth, False, True)], leans=leans)
        assert bool(missing.places) is steps
        assert bool(missing.tips) is tips
    # On rough ground the body is off its attitude more often.
    assert stepped(MissingGround(NAMES), [(0, 0.13, False, True)], leans=0.022, deeper=0.03).places
    # After a long search it does, where the others hold the robot.
    assert stepped(MissingGround(NAMES), [(0, 0.08, False, False)], leans=0.03).places
    assert not stepped(MissingGround(NAMES), [(0, 0.08, False, False)], leans=0.03, centre=0.1 + 0.1j).places


def test_a_robot_whose_foot_slides_off_an_edge_as_others_lift_off_puts_them_down():
    robot = tarsus.load_robot("makeyourpet")
    walk = Walk(terrain.Gaps(start=0.3055, width=0.2, depth=0.15, count=1), robot=robot)
    walk.go(0.0546, 2.6)
    assert walk.tilt < np.radians(15)


def test_a_robot_none_of_whose_feet_stands_is_lifted_and_does_not_tip():
    deep = [(leg, 0.03, True, True) for leg in range(6)]
    assert stepped(MissingGround(NAMES), deep, stands=(False,) * 6).tips == 0
    assert stepped(MissingGround(NAMES), deep, stands=(False, True, *[False] * 4)).tips != 0


def landed(before, after):
    """The legs whose feet are on the ground, and were not before."""
    return np.flatnonzero(after.down & ~before.down).tolist()


@pytest.mark.parametrize(("tips", "in_air"), [(True, False), (False, True)])
@pytest.mark.parametrize(("phase", "due"), [(0.2, True), (0.8, False)])
def test_feet_put_down_early_because_the_robot_tips_or_is_lifted_are_still_due(phase, due, tips, in_air):
    setup, rest = setup_of("strider"), rest_of("strider")
    timing, lifted = StepTiming(setup.gait, 1.0), np.array([True, False] * 3)
    state = begun(setup, rest)
    state = state._replace(
        clock=state.clock + phase * timing.swing_time,
        down=~lifted,
        swing_phase=np.where(lifted, phase, 0.0),
        felt=[FeltFoot()] * 6,
    )
    controller = tarsus.WalkController(setup.robot)
    ground, touching = controller._walk.ground, tarsus.SensorReadings(contacts=[not in_air] * 6)
    ground.missing.tips, ground.condition.airborne = complex(tips), float(in_air)
    after = ground.sense(touching, 0.01, state, timing=timing, angles=controller.angles.tolist())
    assert ground.condition.in_air == in_air
    assert landed(state, after) == [0, 2, 4]
    assert after.down.all()
    assert timing.due(after, 0.0) == [on and due for on in lifted]


def test_the_edge_is_where_the_step_leads_wherever_its_foothold_was_chosen():
    missing = MissingGround(NAMES)
    stepped(missing, [], twist=(0.1, 0.0, 0.0))
    stepped(missing, [(0, 0.08, True, True)], [AHEAD[0] - 0.06 + 0.02j, *REST[1:]])
    assert missing.places[0].real < REST[0].real
    assert limited(missing, 0.1, 0.0, 0.0).fraction == 0.0


@pytest.mark.parametrize(
    ("pace", "phase", "speed", "height", "lands"),
    [
        (0.0, 0.5, -0.1, -0.02, True),
        (1.0, 0.5, -0.1, -0.02, False),
        (0.0, 0.4, -0.1, -0.02, False),
        (0.0, 0.5, 0.1, -0.02, False),
        # An obstacle.
        (0.0, 0.5, -0.1, 0.02, False),
    ],
)
def test_while_the_walk_waits_a_foot_on_its_way_down_stands_on_lower_ground_that_it_meets(
    pace, phase, speed, height, lands
):
    state, body, timing = touching_in_swing(phase, height, FeltFoot(speed=speed, top=0.03, top_phase=0.42))
    after = met_ground(state, body, MissingGround(NAMES), stopped=[], timing=timing, pace=pace)
    assert landed(state, after) == [0] * lands


@pytest.mark.parametrize(("phase", "tries"), [(0.5, 0), (0.6, 0), (0.7, 1)])
def test_a_foot_that_rises_along_an_obstacle_does_not_stand_on_it(phase, tries):
    state, body, timing = touching_in_swing(phase, 0.02, FeltFoot())
    rising = FeltFoot(top=0.03, top_phase=0.65, drawn_back=complex(state.foot[0]) - 0.008)
    state = state._replace(foothold=state.foothold + 0.05, felt=[rising, *state.felt[1:]])
    missing = MissingGround(NAMES)
    after = met_ground(state, body, missing, stopped=[], timing=timing, pace=1.0)
    assert landed(state, after) == [0] * tries
    assert list(missing.places) == [0] * tries
    assert after.down[0] == bool(tries)


@pytest.mark.parametrize(
    ("speed", "on", "tries"), [(0.0, 0.045, 1), (-0.1, 0.045, 0), (0.0, 0.005, 1), (-0.1, 0.005, 0), (0.0, -0.045, 0)]
)
def test_a_foot_that_is_high_over_an_obstacle_and_does_not_go_down_touches_its_side(speed, on, tries):
    # Contact at the end of its way, or far past its collision, is the ground only of a foot that goes down.
    state, body, timing = touching_in_swing(0.8, 0.05, FeltFoot())
    high = FeltFoot(speed=speed, top=0.05, top_phase=0.6, drawn_back=complex(state.foot[0]) - 0.05)
    state = state._replace(foothold=state.foothold + on, felt=[high, *state.felt[1:]])
    missing = MissingGround(NAMES)
    met_ground(state, body, missing, stopped=[], timing=timing, pace=1.0)
    assert list(missing.places) == [0] * tries


def test_a_foot_that_is_stopped_while_it_tries_again_is_drawn_back_once_more():
    state, body, timing = touching_in_swing(0.0, 0.0, FeltFoot())
    state, missing = state._replace(down=np.full(6, fill_value=True)), MissingGround(NAMES)
    foot, rising = state.in_heading(complex(state.foot[0])), FeltFoot(top=0.05)
    missing.stopped(0, foot, foot + 0.1, 0j)
    for under_way in (True, False):
        feet = [rising if under_way else FeltFoot(), *state.felt[1:]]
        after = met_ground(state._replace(felt=feet), body, missing, stopped=[0], timing=timing, pace=0.0)
        assert not landed(state, after)
        # Slides back, and rises; one that rises already goes on.
        assert (after.felt[0].slide != 0j) == (not under_way)
        assert after.felt[0].top == 0.05 if under_way else after.felt[0].top >= 0.0


def test_a_foot_that_collides_is_drawn_back_from_where_it_is_measured():
    state, body, timing = touching_in_swing(0.3, 0.02, FeltFoot(top=0.03, top_phase=0.42))
    state = state._replace(foothold=state.foothold + 0.05)
    for lag in (0.0, 0.03):
        body.tracking_error = lambda *_, lag=lag: -lag
        after = met_ground(state, body, MissingGround(NAMES), stopped=[], timing=timing, pace=1.0)
        assert after.felt[0].drawn_back == pytest.approx(state.foot[0] - lag - 0.008)
        # At once, so that a stiff leg does not drag on the obstacle: most of the way in a third of the time.
        back, left = after.felt[0].drawn_back - state.foot[0], after.felt[0].top_phase - 0.3
        at = complex(state.foot[0]), complex(after.swing_velocity[0]), complex(after.swing_acceleration[0])
        reached, *_ = quintic(at, after.felt[0].drawn_back, left, 1 / 3)
        assert 0.75 < (reached - state.foot[0]) / back < 1.0
    # The next time it is drawn back by 40 mm from where it is.
    again = state._replace(swing_phase=state.swing_phase + 0.6, felt=after.felt)
    missing = MissingGround(NAMES)
    met_ground(again, body, missing, stopped=[0], timing=timing, pace=1.0)
    start, _ = missing.obstacles.stopped(0, 0j, 0j, 0j)
    assert start == pytest.approx(state.in_heading(complex(state.foot[0]) - 0.03 - 0.04))


@pytest.mark.parametrize(("sunk", "collides"), [(0.0, True), (0.01, True), (0.025, False)])
def test_a_swinging_foot_that_a_sinking_body_sets_down_has_met_no_obstacle(sunk, collides):
    state, body, timing = touching_in_swing(0.3, 0.03, FeltFoot(speed=0.0, top=0.05, top_phase=0.42))
    body.contacts.sunk[0] = sunk
    after = met_ground(state, body, MissingGround(NAMES), stopped=[], timing=timing, pace=1.0)
    assert (after.felt[0].drawn_back is not None) == (body.roughness.value > 0.0) == collides


@pytest.mark.parametrize(("height", "sunk", "off"), [(0.03, 0.0, 0.03), (0.03, 0.02, 0.01), (-0.03, 0.02, 0.03)])
def test_ground_that_a_foot_meets_sooner_as_the_body_tips_towards_it_is_not_rough(height, sunk, off):
    state, body, timing = touching_in_swing(0.8, height, FeltFoot(speed=-0.1, top=0.03, top_phase=0.42))
    body.contacts.sunk[0], expected = sunk, Roughness(tarsus.GroundAdaptation())
    expected.landed(off)
    met_ground(state, body, MissingGround(NAMES), stopped=[], timing=timing, pace=1.0)
    assert body.roughness.value == pytest.approx(expected.value)


def test_a_robot_that_is_carried_away_forgets_an_obstacle():
    missing = MissingGround(NAMES)
    for _ in range(5):
        missing.stopped(0, REST[0] - 0.05, REST[0] + 0.05, 0j)
    assert missing.obstacles.leaves(-0.05 + 0.0j)
    missing.forget()
    assert not missing.obstacles.leaves(-0.05 + 0.0j)
    assert limited(missing, 0.1, 0.0, 0.0).fraction == 1.0


def test_a_foot_that_an_obstacle_has_stopped_looks_for_the_ground_like_any_other_once_the_robot_tips():
    missing, two = MissingGround(NAMES), [False, True, False, False, True, False]
    missing.stopped(0, REST[0], REST[0] + 0.05, 0j)
    stepped(missing, [(0, 0.03, True, True)], REST, stands=two)
    assert not missing.places
    # A walk that waits says for which foot and why.
    assert [(each.leg, each.cause) for each in missing.limitations] == [("LF", "the foot looks for the ground")]


def test_a_walk_that_the_ground_slows_down_or_stops_always_says_why():
    drawn, rest = np.random.default_rng(0), np.array(REST)
    for _ in range(60):
        missing = MissingGround(NAMES)
        for _ in range(40):
            feet = (rest + drawn.uniform(-0.05, 0.05, 6)).tolist()
            down, leg = (drawn.random(6) < 0.7).tolist(), int(drawn.integers(6))
            searches = [
                (leg, drawn.uniform(-0.02, 0.1), *(drawn.random(2) < 0.5)) for leg, on in enumerate(down) if not on
            ]
            if drawn.random() < 0.2:
                missing.stopped(leg, feet[leg], REST[leg] + drawn.uniform(0.06, 0.1), 0j)
            stepped(missing, searches, feet, stands=down)
            grant = limited(missing, drawn.uniform(-0.1, 0.1), 0.0, 0.0)
            assert all(each.leg and each.cause for each in (*missing.limitations, *grant.limitations))


@pytest.mark.parametrize(("deeper", "deepest"), [(0.0, 0.075), (0.03, 0.123), (0.05, 0.155)])
def test_holes_are_deeper_by_what_rough_ground_allows(deeper, deepest):
    assert not stepped(MissingGround(NAMES), [(0, deepest - 0.002, True, True)], deeper=deeper).places
    assert stepped(MissingGround(NAMES), [(0, deepest + 0.002, True, True)], deeper=deeper).places


def test_another_foot_without_ground_does_not_change_the_side_of_a_known_edge():
    missing = stepped(MissingGround(NAMES), [(0, 0.08, True, True)])
    assert limited(missing, 0.1, 0.0, 0.0).fraction == 0.0
    behind = [*AHEAD[:5], REST[5] - 0.05]
    stepped(missing, [(0, 0.08, True, True), (5, 0.08, True, True)], behind)
    assert missing.places[5].real < REST[5].real
    assert limited(missing, 0.1, 0.0, 0.0).fraction == 0.0


@pytest.mark.no_cover
def test_a_robot_whose_foot_slides_off_a_platform_does_not_fall():
    robot = tarsus.load_robot("strider")
    speed = 0.25 * tarsus.WalkController(robot).top_speed((1, 0, 0))
    plant = SimulatedPlant(robot, terrain=terrain.Step(rise=-0.4, start=0.49), sensors="ideal", servos="catalogue")
    controller = tarsus.RobotController(robot)
    output = controller.output
    plant.start(output)
    for _ in range(900):
        readings = plant.step(output, 0.01)
        assert abs(plant.state.body.rpy).max() < 0.3
        output = controller.step((speed, 0.0, 0.0), 0.01, readings)


def test_a_foot_that_does_not_reach_the_ground_beside_the_others_is_over_no_hole():
    missing = stepped(MissingGround(NAMES), [(0, 0.015, False, False)])
    assert limited(missing, 0.1, 0.0, 0.0).limitations[0].cause == "the ground is lower than the leg reaches"
    stepped(missing, [], stands=[True] * 6, dt=1.5)
    stepped(missing, [], stands=[True] * 6, dt=1.5)
    assert not limited(missing, 0.1, 0.0, 0.0).limitations


@pytest.mark.parametrize(("depth", "tips", "tries"), [(0.015, False, 2), (0.05, False, 0), (0.015, True, 0)])
def test_the_walk_goes_on_from_a_foot_that_has_found_no_ground_at_any_place_where_that_is_no_hole(depth, tips, tries):
    missing, went_on = MissingGround(NAMES), 0
    for _ in range(4):
        for _ in range(4):
            feet = [missing.places.get(0, AHEAD[0]), *REST[1:]]
            stepped(missing, [(0, depth, False, False)], feet, deeper=0.02)
            limited(missing, 0.1, 0.0, 0.0)
        assert missing.gives_up(0)
        assert missing.refuses
        # From then on it is hardly lowered, and does not land.
        for _ in range(110):
            stepped(missing, [(0, 0.005, False, False)], feet, deeper=0.02, lost=0 if tips else None)
            limited(missing, 0.1, 0.0, 0.0)
        went_on += not missing.refuses
        assert missing.stranded == ([] if missing.refuses else [0])
        # It steps first.
        stepped(missing, [], stands=[True] * 6)
    assert went_on == tries


def test_a_foot_of_a_robot_that_is_put_down_has_not_looked_for_the_ground_yet():
    controller, hanging = tarsus.WalkController(tarsus.load_robot("phantomx")), 2
    contacts = controller._walk.ground.contacts
    for lasts, touching in ((0.5, [True] * 6), (3.0, [False] * 6), (0.1, [leg != hanging for leg in range(6)])):
        for _ in range(round(100 * lasts)):
            readings = tarsus.SensorReadings(contacts=touching, attitude=(0.0, 0.0))
            controller.step((0.05, 0.0, 0.0), 0.01, readings=readings)
    assert contacts.seeks(hanging)
    # From when the others hold it, it looks for as long as any other foot.
    ticks = 0
    while contacts.seeks(hanging) and ticks < 200:
        take_in(contacts, touching, [True] * 6, 0.01)
        ticks += 1
    assert 145 <= ticks <= 151


def test_a_command_that_leads_back_ends_the_tries_at_an_obstacle():
    missing = MissingGround(NAMES)
    missing.stopped(1, REST[1], REST[1] + 0.05, 0j)
    limited(missing, 0.1, 0.0, 0.0)
    assert missing.tries(1, REST[1])
    limited(missing, -0.1, 0.0, 0.0)
    assert not missing.tries(1, REST[1])
    assert stepped(missing, [(1, 0.0, False, True)]).pace == 1.0


def test_a_foot_that_loses_contact_at_an_edge_goes_down_gently_while_the_others_hold_the_robot():
    walk = tarsus.WalkController(tarsus.load_robot("strider"))

    def go(ticks, *lost):
        for _ in range(ticks):
            contacts = walk.contacts.copy()
            contacts[list(lost)] = False
            walk.step((0.13, 0.0, 0.0), 0.01, readings=tarsus.SensorReadings(contacts=contacts, attitude=(0.0, 0.0)))
        return walk.feet[3, 2]

    go(50)
    # The front left foot is over a hole, and finds ground behind it.
    go(230, 0)
    before = go(100)
    assert any("no ground within" in each.cause for each in walk.limitations)
    assert 0.0 < before - go(25, 3) < 0.004


def test_a_foot_that_its_leg_holds_up_at_another_place_does_not_press_on():
    search = Search(leg=0, depth=0.015, falls=False, lasts=True, raised=0.01)
    held_up = [search.is_missing(0.1, 0.0, 1.0, held=True, held_up=up, again=True) for up in (False, True)]
    assert held_up == [False, True]
