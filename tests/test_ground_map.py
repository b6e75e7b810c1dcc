"""Memory of the ground: known heights stay where they are as the robot moves, feet keep to ground that bears them."""

import cmath
import math
from types import SimpleNamespace

import numpy as np
import pytest

import tarsus
from gait_robots import preset
from tarsus.control.contact.footing import Footing
from tarsus.control.felt.ground_search import not_sunk, supporting
from tarsus.control.readings import SensorReadings, ValidReadings
from tarsus.control.sensing.validation import ReadingsValidator
from tarsus.control.terrain.foothold_choice import FootholdChoice
from tarsus.control.terrain.ground_map import GroundMap
from tarsus.control.walk.state import GaitState
from tarsus.errors import InputError
from tarsus.gait.ground_heights import GroundHeights
from tarsus.simulation import Sensor, SensorSuite, SimulatedPlant, terrain

STRIDER = preset("strider")
REST = [0.2 * cmath.exp(1j * math.radians(angle)) for angle in (30, 90, 150, 210, 270, 330)]
GRID = 0.02 * (np.arange(61) - 30)
X, Y = np.meshgrid(GRID, GRID, indexing="ij")


def at(x=0.0, yaw=0.0):
    """The state of a robot that stands at a place."""
    posture = np.array([0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.03, *[0.0] * 6])
    return GaitState.standing(np.array(REST), posture)._replace(origin=complex(x), yaw=yaw)


def standing(height, legs=range(6)):
    """Feet at rest on ground of a height, which is a function of the place."""
    return [(REST[leg], height(REST[leg])) for leg in legs]


@pytest.mark.parametrize("yaw", [0.0, 0.7])
@pytest.mark.parametrize("tilt", [None, (0.05, -0.08)])
def test_given_heights_are_those_of_the_ground_wherever_the_feet_stand(yaw, tilt):
    def ground(place):
        return 0.05 * math.sin(8 * place.real) + 0.1 * place.imag

    seen = GroundHeights(heights=3.0 + 0.05 * np.sin(8 * X) + 0.1 * Y)
    inclined = complex(-tilt[1], tilt[0]) if tilt else 0j

    def height(place):
        # A level ground is inclined against a body that is tilted.
        return ground(place) - (place * inclined.conjugate()).real

    known = GroundMap()
    known.step(standing(height), tilt, at(yaw=yaw), 0.03, drift=0j)
    known.see(ValidReadings(ground=seen), at(yaw=yaw))
    known.step(standing(height), tilt, at(yaw=yaw), 0.03, drift=0j)
    known.see(ValidReadings(ground=seen), at(x=5.0))  # the same reading again
    known.see(ValidReadings(), at())
    assert known.given
    places = np.array([0.11 + 0.03j, -0.31 + 0.2j, 0.25 - 0.4j])
    expected = [height(place) for place in places]
    np.testing.assert_allclose(known.expected(places), expected, atol=0.006)
    assert known.at(complex(places[0])) == pytest.approx(expected[0], abs=0.006)
    # As the robot walks on, heights stay on the ground.
    on = 0.1 * cmath.exp(-1j * yaw)

    def height_now(place):
        return ground(place + on) - (place * inclined.conjugate()).real

    known.step(standing(height_now), tilt, at(x=0.1, yaw=yaw), 0.03, drift=0j)
    np.testing.assert_allclose(known.expected(places - on), [height_now(place - on) for place in places], atol=0.006)
    for place in (0.11 + 0.03j, -0.11 - 0.13j):
        lowest = min(height_now(place + d) for d in (0.03, -0.03, 0.03j, -0.03j))
        # Ground above the plane of the feet may not be there.
        assert known.lowest_near(place) == pytest.approx(min(lowest, known.plane.at(place)), abs=0.02)
    # What the sensor does not see is the plane of the feet.
    assert known.at(2.0 + 0j) == known.plane.at(2.0 + 0j)


def test_a_reading_is_that_of_the_place_where_it_was_measured():
    moving = at(x=1.0)
    moving = moving._replace(twist=moving.twist._replace(value=np.array([0.2, 0.0, 0.0])))
    known = GroundMap()
    known.step(standing(lambda place: 0.0), None, moving, 0.03, drift=0j)
    known.see(ValidReadings(ground=GroundHeights(heights=np.where(X > 0.1 - 1e-9, 0.05, 0.0)), ground_age=0.1), moving)
    assert known.at(0.07 + 0j) == pytest.approx(0.0)
    assert known.at(0.09 + 0j) == pytest.approx(0.05)


def test_the_ground_moves_back_under_feet_that_make_up_for_lost_way():
    known = GroundMap()
    known.see(ValidReadings(ground=GroundHeights(heights=np.where(X > 0.1 + 1e-9, 0.05, 0.0))), at())
    for _ in range(10):
        known.step(standing(lambda place: 0.0, [2, 3]), None, at(), 0.05, drift=0.1 + 0j)
    assert known.at(0.09 + 0j) == pytest.approx(0.05)


def stepping(leg=0, phase=0.1):
    """State, reach and footholds of a walking robot with a foot in the air."""
    controller = tarsus.WalkController(STRIDER)
    for _ in range(5):
        controller.step((0.05, 0.0, 0.0), 0.01, SensorReadings(contacts=[True] * 6, attitude=(0.0, 0.0)))
    walk, state = controller._walk, controller._tick.gait
    down, phases = state.down.copy(), state.swing_phase.copy()
    down[:], down[leg], phases[leg] = True, False, phase
    state = state._replace(down=down, swing_phase=phases, foot=state.foothold)
    return state, walk.ground.body.reach, walk.transitions.footholds


def moved(state, leg, way):
    """The state with a foothold moved."""
    foothold = state.foothold.copy()
    foothold[leg] += way
    return state._replace(foothold=foothold)


def chosen_for(heights, leg=0, phase=0.1):
    """How far beside its foothold a foot of a walking robot is put down on ground of some heights."""
    (state, reach, footholds), known = stepping(leg, phase), GroundMap()
    choice = FootholdChoice(known)
    foothold = complex(state.foothold[leg]) - state.origin
    known.see(ValidReadings(ground=GroundHeights(heights=heights(X + 1j * Y - foothold))), state)
    feet = [(complex(state.foot[other]) - state.origin, 0.0) for other in range(6) if other != leg]
    known.step(feet, None, state, 0.03, drift=0j)
    choice.step(state, reach, footholds)
    chosen = dict(choice.beside)
    # The step leads there now.
    choice.step(moved(state, leg, chosen.get(leg, 0j)), reach, footholds)
    assert choice.beside == chosen
    choice.step(state._replace(down=np.ones(6, dtype=bool)), reach, footholds)
    assert choice.beside == {}
    return chosen


def test_feet_keep_to_their_footholds_on_even_ground_and_away_from_edges_and_holes_elsewhere():
    assert chosen_for(lambda place: 0.0 * place.real) == {0: 0j}
    assert chosen_for(lambda place: 0.1 * place.real)[0] == 0j
    assert chosen_for(lambda place: 0.0 * place.real, phase=0.5) == {}
    edge = chosen_for(lambda place: np.where(place.real > 0.005, 0.06, 0.0))[0]
    assert abs(edge.real) >= 0.02
    hole = chosen_for(lambda place: np.where(np.abs(place) < 0.035, -0.3, 0.0))[0]
    assert abs(hole) > 0.035
    # Away from an edge that is 30 mm off, if there is no ground beyond it.
    assert chosen_for(lambda place: np.where(place.real > 0.03, -0.3, 0.0))[0].real < 0.0


def test_a_foot_over_a_hole_gets_another_foothold_as_soon_as_there_is_one():
    (state, reach, footholds), known = stepping(), GroundMap()
    choice = FootholdChoice(known)
    # Its legs reach 0.13 m below the ground, with the body as low as it goes.
    for depth, hole in ((0.3, True), (0.14, True), (0.11, False), (0.0, False)):
        known.see(ValidReadings(ground=GroundHeights(heights=np.where(X > 0.1, -depth, 0.0))), state)
        known.step([(complex(foot), 0.0) for foot in REST[1:5]], None, state, 0.03, drift=0j)
        choice.step(state, reach, footholds)
        assert bool(choice.holes) == hole
    assert choice.beside == {0: 0j}


def known_over(heights):
    """A ground map of heights that were given, once a foot in the air has been given its foothold on them."""
    (state, reach, footholds), known = stepping(), GroundMap()
    choice = FootholdChoice(known)
    known.see(ValidReadings(ground=GroundHeights(heights=heights)), state)
    on = [complex(foot) for foot in REST[1:5]]
    feet = [(foot, float(heights[round(foot.real / 0.02) + 30, round(foot.imag / 0.02) + 30])) for foot in on]
    for _ in range(100):
        known.step(feet, None, state, 0.03, drift=0j)
    choice.step(state, reach, footholds)
    return known


@pytest.mark.parametrize(("fall", "hole"), [(10.0, True), (1.5, True), (1.0, False)])
def test_ground_out_of_reach_is_a_hole_beyond_an_edge_and_none_on_a_slope(fall, hole):
    """A slope is walked on: the legs reach the ground once the robot is farther down."""
    place = REST[0] + 0.05
    heights = -np.clip(fall * (X - place.real) + 0.2, 0.0, 0.2)
    assert known_over(heights).is_hole(place) == hole


def test_ground_is_no_deeper_for_a_leg_as_the_plane_of_the_feet_rises():
    """A plane of 22 degrees is 69 mm up at the foothold, from where 80 mm below the body are out of reach."""
    known = known_over(np.where(X > 0.1, -0.08, 0.4 * X))
    assert known.plane.at(REST[0]) > 0.06
    assert not known.is_hole(REST[0])


def test_a_foothold_that_moves_into_a_hole_is_left_for_another_one_until_the_foot_goes_down():
    (state, reach, footholds), known = stepping(), GroundMap()
    choice = FootholdChoice(known)
    hole = np.abs(X + 1j * Y - (complex(state.foothold[0]) - state.origin) + 0.1) < 0.05
    known.see(ValidReadings(ground=GroundHeights(heights=np.where(hole, -0.3, 0.0))), state)
    known.step([(complex(foot), 0.0) for foot in REST[1:5]], None, state, 0.03, drift=0j)
    choice.step(state, reach, footholds)
    assert choice.beside == {0: 0j}
    back = moved(state, 0, -0.06 + 0j)
    for phase, chooses in ((0.5, False), (0.4, True)):
        choice.step(back._replace(swing_phase=np.full(6, phase)), reach, footholds)
        assert (choice.beside[0].real > 0.015) == chooses
        # It is not held up: it goes down soon.
        assert choice.holes == {}


def test_another_foothold_is_chosen_beside_that_of_the_step():
    (state, reach, footholds), known = stepping(), GroundMap()
    choice = FootholdChoice(known)
    known.see(ValidReadings(ground=GroundHeights(heights=np.where(X > 0.1, -0.3, 0.0))), state)
    known.step([(complex(foot), 0.0) for foot in REST[1:5]], None, state, 0.03, drift=0j)
    choice.step(state, reach, footholds)
    (chosen,), _ = choice.beside.values(), choice.holes[0]
    choice.step(moved(state, 0, chosen), reach, footholds)
    assert choice.beside == {0: chosen}


def test_a_foot_that_crosses_a_hole_is_known_until_it_is_down():
    (state, reach, footholds), known = stepping(), GroundMap()
    choice = FootholdChoice(known)
    state = state._replace(foot=state.foothold - 0.15)
    foothold = complex(state.foothold[0]) - state.origin
    for ahead, crosses in ((-0.08, True), (0.25, False)):
        hole = np.where(np.abs(X - foothold.real - ahead) < 0.03, -0.3, 0.0)
        known.see(ValidReadings(ground=GroundHeights(heights=hole)), state)
        known.step([(complex(foot), 0.0) for foot in REST[1:5]], None, state, 0.03, drift=0j)
        choice.step(state, reach, footholds)
        assert choice.crossing == ({0} if crosses else set())
        choice.step(state._replace(down=np.ones(6, dtype=bool)), reach, footholds)
        assert choice.crossing == set()


def body(known, reach, standing, off=(0.0, 0.0)):
    """What is known of the ground, of the reach, of which feet stand, and by how much the body is off its attitude."""
    contacts, even = SimpleNamespace(standing=standing), SimpleNamespace(deeper=0.0)
    return SimpleNamespace(ground=known, contacts=contacts, reach=reach, roughness=even, off=off)


def footing(state, places):
    """All feet on the ground."""
    return Footing(places, [True] * 6, 0j, float(state.posture.value[2]))


@pytest.mark.parametrize("depth", [0.0, 0.3])
def test_no_foot_over_a_hole_that_is_seen_stands_on_ground_that_its_switch_does_not_tell_of(depth):
    (state, reach, footholds), known = stepping(), GroundMap()
    choice = FootholdChoice(known)
    places = [complex(foot) - state.origin for foot in state.foot]
    hole = np.abs(X + 1j * Y - places[0]) < 0.05
    known.see(ValidReadings(ground=GroundHeights(heights=np.where(hole, -depth, 0.0))), state)
    known.step([(place, 0.0) for place in places[1:]], None, state, 0.03, drift=0j)
    choice.step(state, reach, footholds)
    found = not_sunk(state, body(known, reach, [True] * 6), footing(state, places), tips=False)
    assert found == [depth == 0.0] * 6


@pytest.mark.parametrize(
    ("rise", "stands", "scale", "lowest", "near"),
    [
        (0.0, False, 1.0, -0.1, True),
        (0.04, False, 1.0, -0.1, False),
        (0.04, True, 1.0, -0.1, True),
        (-0.04, False, 1.0, -0.1, True),
        (-0.04, False, 1.0, -0.04, False),
        (-0.04, True, 1.0, -0.04, True),
        (-0.04, False, 0.7, -0.1, False),
        (0.025, False, 0.7, -0.1, False),
    ],
)
def test_no_foot_that_is_far_off_the_ground_stands_on_ground_that_its_switch_does_not_tell_of(
    rise, stands, scale, lowest, near
):
    (state, reach, _), known = stepping(), GroundMap()
    reach.scale, reach.lowest[0] = scale, lowest
    state = state._replace(ground_height=np.where(np.arange(6) == 0, rise, 0.0))
    places, feet = [complex(foot) - state.origin for foot in state.foot], [stands, *[True] * 5]
    known.step([(place, 0.0) for place in places[1:]], None, state, 0.03, drift=0j)
    found = not_sunk(state, body(known, reach, feet), footing(state, places), tips=False)
    # Where another foot lifts the body, one that is high tells nothing of the others.
    assert found == ([near, *[True] * 5] if rise > 0.0 else [near] * 6)
    assert not_sunk(state, body(known, reach, feet), footing(state, places), tips=True) == [False] * 6


def test_a_foot_that_is_deep_and_has_lifted_the_body_stands_on_ground_as_high_as_expected():
    (state, reach, _), known = stepping(), GroundMap()
    reach.lowest[0] = -0.1
    state = state._replace(ground_height=np.where(np.arange(6) == 0, -0.06, 0.0))
    places, feet = [complex(foot) - state.origin for foot in state.foot], [False, *[True] * 5]
    known.step([(place, 0.0) for place in places[1:]], None, state, 0.03, drift=0j)
    for lifted, near in ((0.0, False), (0.02, True), (-0.02, False)):
        off = 0.0, -lifted / places[0].real
        assert not_sunk(state, body(known, reach, feet, off), footing(state, places), tips=False) == [near] * 6


def test_a_foot_passes_over_what_is_on_its_way_and_rises_first_where_that_is_near():
    known = GroundMap()
    known.step(standing(lambda place: 0.0), None, at(), 0.03, drift=0j)
    known.see(ValidReadings(ground=GroundHeights(heights=np.where(np.abs(X - 0.1) < 0.025, 0.06, 0.0))), at())
    known.step(standing(lambda place: 0.0), None, at(), 0.03, drift=0j)
    assert known.on_way(0j, 0.2 + 0j) == (pytest.approx(0.06, abs=1e-9), False)
    assert known.on_way(0.05 + 0j, 0.2 + 0j)[1]
    assert not known.on_way(0.15 + 0j, 0.15 + 0j)[1]
    assert GroundMap().on_way(0j, 0.2 + 0j) == (-math.inf, False)
    # A body 50 mm high whose middle is 60 mm over the ground has to rise by 60 - (60 - 25) + 15 mm.
    assert known.body_rise((0.12, 0.08, 0.025), 0.06) == pytest.approx(0.04)
    assert GroundMap().body_rise((0.12, 0.08, 0.025), 0.06) == -math.inf


def test_the_body_knows_of_steps_before_its_feet_are_on_them():
    known, reach = GroundMap(), SimpleNamespace(rest=np.array(REST), strokes=np.full(6, 0.1 + 0j))
    known.step(standing(lambda place: 0.0), None, at(), 0.03, drift=0j)
    known.see(
        ValidReadings(ground=GroundHeights(heights=np.where(X > 0.21, 0.08, np.where(np.abs(Y) > 0.21, -0.05, 0.0)))),
        at(),
    )
    least, most = known.rises_ahead(reach)
    assert least == most == pytest.approx([0.08, 0.0, 0.0, 0.0, 0.0, 0.08])


def crossed(sensors):
    """Way made over commanded way, and collisions, of a walk over blocks of 60 mm."""
    ground = terrain.Blocks(rise=0.06, clear=0.35, seed=1)
    plant = SimulatedPlant(STRIDER, terrain=ground, sensors=sensors, servos="catalogue", seed=1)
    controller, speed = tarsus.RobotController(STRIDER), 0.15
    output, off = controller.output, 0.0
    plant.start(output)
    start = plant.state.body.position[0]
    for _ in range(500):
        output = controller.step((speed, 0.0, 0.0), 0.01, plant.step(output, 0.01))
        assert not plant.body_touches
        off += math.hypot(*plant.state.body.rpy[:2]) ** 2
    return (plant.state.body.position[0] - start) / (5.0 * speed), math.sqrt(off / 500)


def test_a_robot_that_sees_the_ground_crosses_blocks_as_far_and_calmer_than_one_that_only_feels_it():
    (felt, tilt), (seen, calmer) = crossed("ideal"), crossed("camera")
    assert seen > max(0.9, felt - 0.01)
    assert calmer < tilt


def test_heights_are_checked_where_they_are_made_and_where_they_come_in():
    with pytest.raises(InputError, match=r"shape \(3,\)"):
        GroundHeights(heights=np.zeros(3))
    with pytest.raises(InputError, match=r"shape \(0, 3\) must have two axes, some points"):
        GroundHeights(heights=np.zeros((0, 3)))
    for wrong in ("high", [[0.0, 0.1], [0.0]], None):
        with pytest.raises(InputError, match=r"^ground heights"):
            GroundHeights(heights=wrong)
    with pytest.raises(InputError, match="infinite"):
        GroundHeights(heights=np.full((2, 2), math.inf))
    with pytest.raises(InputError, match="cell is 0 m"):
        GroundHeights(heights=np.zeros((2, 2)), cell=0.0)
    with pytest.raises(InputError, match="cell is 'x'; it must be a number"):
        GroundHeights(heights=np.zeros((2, 2)), cell="x")
    heights, validator = GroundHeights(heights=[[0.0, math.nan]]), ReadingsValidator(STRIDER)
    assert not heights.heights.flags.writeable
    valid = validator.validate(SensorReadings(ground=heights, age={"ground": 0.04}), 0.01)
    assert (valid.ground, valid.ground_age, valid.rejected) == (heights, 0.04, ())
    assert validator.validate(SensorReadings(ground=heights, age=0.02), 0.01).ground_age == 0.02
    wrong = validator.validate(SensorReadings(ground=np.zeros((2, 2))), 0.01)
    assert (wrong.ground, wrong.rejected) == (None, ("ground: not of class GroundHeights",))
    old = validator.validate(SensorReadings(ground=heights, age={"ground": 0.2}), 0.01)
    assert (old.ground, old.rejected) == (None, ("ground: older than 100 ms",))


def test_a_simulated_camera_sees_the_terrain_around_the_body():
    ground = terrain.Step(rise=0.05, start=0.33)
    suite = SensorSuite(ground=Sensor(rate=20.0))
    plant, controller = SimulatedPlant(STRIDER, terrain=ground, sensors=suite), tarsus.RobotController(STRIDER)
    plant.start(controller.output)
    found = [plant.step(controller.output, 0.01).ground for _ in range(6)]
    assert found[0] is found[1]
    assert found[1] is not found[-1]
    np.testing.assert_allclose(found[-1].heights, np.where(X > 0.33, 0.05, 0.0), atol=1e-9)


@pytest.mark.parametrize(
    ("leg", "deeper", "depth", "sinks", "walks", "supports"),
    [
        ("rear left", 0.03, 0.02, 0.0, True, True),
        ("middle left", 0.03, 0.02, 0.0, True, True),
        ("front left", 0.03, 0.02, 0.0, True, False),
        ("rear left", 0.03, -0.02, 0.0, True, True),
        ("rear left", 0.03, 0.04, 0.0, True, False),
        ("rear left", 0.03, 0.02, 0.02, True, False),
        ("rear left", 0.03, 0.02, -0.02, True, True),
        ("rear left", 0.03, 0.02, 0.0, False, False),
        ("rear left", 0.0, 0.02, 0.0, True, False),
        ("rear left", 0.0, -0.02, 0.0, True, False),
    ],
)
def test_on_rough_ground_feet_that_follow_others_are_support_unless_they_are_deep_or_the_body_sinks_there(
    leg, deeper, depth, sinks, walks, supports
):
    (state, reach, _), known, leg = stepping(), GroundMap(), STRIDER.leg_names.index(leg)
    state = state._replace(ground_height=np.where(np.arange(6) == leg, -depth, 0.0))
    places = [complex(foot) - state.origin for foot in state.foot]
    standing = [on != leg for on in range(6)]
    known.step([(place, 0.0) for on, place in zip(standing, places, strict=True) if on], None, state, 0.03, drift=0j)
    rough = body(known, reach, [True] * 6, (-sinks / places[leg].imag, 0.0))
    rough.contacts.supports, rough.roughness.deeper = standing.__getitem__, deeper
    down = [True] * 5 + [False]
    expected = [on and (supports if each == leg else True) for each, on in enumerate(down)]
    assert supporting(state, rough, footing(state, places)._replace(down=down), walks=walks) == expected
