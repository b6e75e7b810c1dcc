"""Holes: feet that find no ground step back, and the robot stops at the edge and walks away from it."""

import numpy as np
import pytest

import tarsus
from tarsus.control.limitation import LimitationKind
from tarsus.control.limiter.protocol import TwistGrant, TwistRequest
from tarsus.control.terrain.missing_ground import MissingGround
from tarsus.simulation import SimulatedPlant, terrain

NAMES = ("LF", "LM", "LR", "RR", "RM", "RF")
REST = [0.2 + 0.2j, 0.25j, -0.2 + 0.2j, -0.2 - 0.2j, -0.25j, 0.2 - 0.2j]
AHEAD = [REST[0] + 0.05, *REST[1:]]


def stepped(missing, searches, feet=AHEAD, *, stands=(False, *[True] * 5), centre=0j, roughness=0.0, dt=0.01):
    missing.step(
        searches, feet, stands, dt, centre=centre, rest=REST, radii=[0.05] * 6, height=0.1, roughness=roughness
    )
    return missing


def limited(missing, *twist):
    request = TwistRequest(twist, 0.01, None, np.zeros(3))
    return missing.limit(request, TwistGrant())


def test_the_walk_slows_down_the_deeper_a_foot_searches_and_less_on_rough_ground():
    def pace(depth, *, falls=True, roughness=0.0):
        return stepped(MissingGround(NAMES), [(0, depth, falls, True)], roughness=roughness).pace

    depths = [pace(depth) for depth in (0.0, 0.01, 0.015, 0.03)]
    assert depths == sorted(depths, reverse=True)
    assert (depths[0], depths[-1]) == (1.0, 0.0)
    assert 0 < pace(0.03, falls=False) < 1
    assert pace(0.03, roughness=0.02) == 1.0
    assert not stepped(MissingGround(NAMES), [(0, 0.05, True, True)]).places
    assert stepped(MissingGround(NAMES), [(0, 0.05, False, False)]).places


def test_a_foot_without_ground_steps_back_twice_and_then_gives_up():
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
    stepped(missing, [(0, 0.01, False, False)], [second, *REST[1:]])
    assert not missing.gives_up(0)
    stepped(missing, [(0, 0.08, True, False)], [second, *REST[1:]])
    assert missing.gives_up(0)
    # Once it stands, it may again.
    assert not stepped(missing, [], stands=[True] * 6).places
    assert not missing.gives_up(0)


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


def test_a_robot_stops_at_a_hole_says_so_and_walks_away_from_it():
    robot = tarsus.load_robot("strider")
    plant = SimulatedPlant(robot, terrain=terrain.Gaps(start=0.35, width=0.2, depth=0.15, count=1))
    controller = tarsus.RobotController(robot)
    output = controller.output
    plant.start(output)

    def walked(speed, time):
        nonlocal output
        for _ in range(round(100 * time)):
            output = controller.step((speed, 0.0, 0.0), 0.01, plant.step(output, 0.01))
            assert not plant.state.body_touches
        return plant.state.body.position[0]

    stopped = walked(0.13, 3.5)
    assert stopped < 0.35
    assert [limit.leg for limit in output.limitations if limit.kind is LimitationKind.GROUND and limit.leg]
    assert walked(0.13, 0.5) == pytest.approx(stopped, abs=0.02)
    assert walked(-0.13, 1.5) < stopped - 0.08
