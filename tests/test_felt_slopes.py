"""Walks that feel slopes: clearance of swings, attitude where legs do not reach, and what physics makes of it."""

import dataclasses
import math

import numpy as np
import pytest

import put_down
from cross_slopes import Turned
from gait_robots import preset
from tarsus.control.limitation import LimitationKind
from tarsus.control.limiter.protocol import TwistGrant, TwistRequest
from tarsus.control.limiter.slope_limit import SlopeLimit
from tarsus.control.pose import slope_stance
from tarsus.control.pose.posture_feedback import BodyMove, PostureFeedback
from tarsus.control.pose.slope_stance import SlopeStance
from tarsus.control.readings import SensorReadings
from tarsus.control.robot_controller import RobotController
from tarsus.control.sensing.body_condition import BodyCondition
from tarsus.control.terrain.body_motion import BodyMotion
from tarsus.control.terrain.reach import Reach
from tarsus.control.terrain.roughness import GroundAdaptation
from tarsus.control.walk_controller import WalkController
from tarsus.control.walk_state import TickState, WalkState
from tarsus.errors import InputError
from tarsus.gait.foot_plane import FootPlane
from tarsus.gait.stance.reachable_heights import reachable_share
from tarsus.kinematics.stance import default_stance
from tarsus.simulation import Sensor, SensorSuite, SimulatedPlant, terrain


def test_a_swing_clears_the_ground_ahead_by_the_swing_height_on_a_slope():
    controller, slope, dt = WalkController(preset("strider"), swing_height=0.03), 0.15, 0.01

    def ground(x):
        return slope * x

    clear = []
    for tick in range(1500):
        feet = controller.feet
        contacts = tuple(feet[:, 2] <= ground(feet[:, 0]) + 1e-4)
        before = controller.contacts
        controller.step((0.1, 0.0, 0.0), dt, SensorReadings(contacts=contacts, attitude=(0.0, 0.0)))
        if tick > 1000:
            over = controller.feet[:, 2] - ground(controller.feet[:, 0])
            clear += [(leg, over[leg]) for leg in np.flatnonzero(~before)]
    highest = [max(height for leg, height in clear if leg == each) for each in range(6)]
    assert min(highest) > 0.024


def test_legs_reach_as_much_of_a_slope_as_their_heights_allow():
    rises = [0.1, 0.0, -0.1]
    assert reachable_share(rises, [-0.2] * 3, [0.2] * 3) == 1.0
    assert reachable_share(rises, [-0.05] * 3, [0.05] * 3) == pytest.approx(0.5)
    assert reachable_share(rises, [-0.02] * 3, [0.1] * 3) == pytest.approx(0.6)
    assert reachable_share(rises, [-0.01] * 3, [-0.02] * 3) == 0.0
    # A slope that rises by 50 mm under the body and may by 20 mm, and by -100 mm at a foot that reaches 55 mm down.
    assert reachable_share([*rises, 0.05], [-0.055] * 3 + [-math.inf], [0.2] * 3 + [0.02]) == pytest.approx(0.5)


def test_a_plane_is_levelled_by_the_attitude_of_the_body():
    plane = FootPlane(0.02, math.tan(0.2), math.tan(0.1))
    levelled = plane.levelled((0.05, -0.1))
    assert levelled.height == 0.0
    assert math.atan(levelled.slope_x) == pytest.approx(0.3)
    assert math.atan(levelled.slope_y) == pytest.approx(0.15)
    assert plane.levelled(None)[1:] == pytest.approx(plane[1:])


def test_the_body_follows_the_share_of_a_slope_that_the_legs_do_not_reach():
    posture, slope = PostureFeedback("level"), 0.5
    posture.fit_to_reach(
        [([0.0] * 6, [0.0] * 6)], (0.0, 0.0), 0.02, reach=([-0.1] * 6, [0.1] * 6), height=0.1, share=0.7
    )
    pitch = 0.0
    for _ in range(2000):
        plane = FootPlane(0.0, math.tan(slope + pitch), 0.0)
        rates = posture.rates(plane, (0.0, pitch), BodyMove(0j, [(0.2 + 0j, 0.1), (-0.2 + 0j, 0.1)]))
        pitch -= rates.turn[1] * 0.01
    assert pitch == pytest.approx(-0.3 * slope, abs=0.005)


@pytest.mark.parametrize(
    ("levelling", "share", "said"),
    [
        *(("level", 1.0, False), ("level", 0.99, True), ("between", 0.51, False), ("between", 0.49, True)),
        *(("follow", 0.0, False), (None, 0.0, False)),
    ],
)
def test_an_end_of_the_reach_is_said_only_where_the_legs_reach_less_than_is_to_be_levelled(levelling, share, said):
    body = BodyMotion(preset("strider"), levelling=levelling, adaptation=GroundAdaptation())
    level, reach = ([0.0] * 6, [0.0] * 6), ([-0.1] * 6, [0.1] * 6)
    body._posture.fit_to_reach([level], (0.0, 0.0), 0.02, reach=reach, height=0.1, share=share)
    assert [each.kind for each in body.limitations] == [LimitationKind.ATTITUDE] * said


def test_a_standing_body_rests_until_it_is_far_from_where_it_should_be():
    posture, feet = PostureFeedback("level"), [(0.2 + 0j, 0.1), (-0.2 + 0j, 0.1)]

    def moves(height, pitch, *, stands=True):
        rates = posture.rates(FootPlane(height, 0.0, 0.0), (0.0, pitch), BodyMove(0j, feet, stands))
        return rates.climb != 0.0 or rates.turn != (0.0, 0.0)

    assert moves(0.003, 0.009, stands=False)
    assert moves(0.003, 0.02)
    assert not moves(0.003, 0.009)
    assert not moves(0.015, 0.025)
    assert moves(0.015, 0.035)
    assert moves(0.015, 0.025)
    assert not moves(0.0, 0.0)
    assert moves(0.025, 0.0)


@pytest.mark.parametrize("name", ["strider", "phantomx", "makeyourpet", "ch3r"])
@pytest.mark.parametrize("direction", [0.0, 0.8, math.pi / 2, 2.0, math.pi])
def test_feet_come_closer_to_the_height_of_the_middle_of_the_body_on_slopes(name, direction):
    robot = preset(name)
    stance, feet = SlopeStance(robot), default_stance(robot)
    rest = feet[:, 0] + 1j * feet[:, 1]
    uphill = np.exp(1j * direction)
    before = (rest * uphill.conjugate()).real
    stance.step(FootPlane(0.0, 0.09 * uphill.real, 0.09 * uphill.imag), rest, 0.0, 0.04, walks=True)
    assert not stance.shift.any()
    assert stance.not_downhill(-0.1 * uphill) == -0.1 * uphill
    stance.step(FootPlane(0.0, 0.3 * uphill.real, 0.3 * uphill.imag), rest, 0.0, 0.04, walks=True)
    after = ((rest + stance.shift) * uphill.conjugate()).real
    assert (np.abs(after) < np.abs(before) + 0.01).all()
    assert np.ptp(after) < (0.8 if direction in (0.0, math.pi) else 0.97) * np.ptp(before)
    # No leg turns by more than 30 degrees, none on a slope across the body, and none is stretched.
    mounts = robot.mount_position[:, 0] + 1j * robot.mount_position[:, 1]
    turned = (rest + stance.shift - mounts) / (rest - mounts)
    assert np.abs(np.angle(turned)).max() <= math.radians(30) * uphill.real**2 + 1e-9
    assert np.abs(turned).max() <= 1 + 1e-9
    assert stance.not_downhill(0.1j * uphill - 0.1 * uphill) == pytest.approx(0.1j * uphill)
    assert stance.not_downhill(0.1 * uphill) == 0.1 * uphill
    # A robot that stands does not step for little.
    here = stance.shift
    stance.step(FootPlane(0.0, 0.28 * uphill.real, 0.28 * uphill.imag), rest, 0.0, 0.04, walks=False)
    assert stance.shift is here
    stance.step(FootPlane(), rest, 0.0, 0.04, walks=False)
    assert not stance.shift.any()


def test_feet_are_drawn_in_by_a_part_of_their_distance_at_most():
    robot = preset("strider")
    stance, feet = SlopeStance(robot), default_stance(robot)
    rest, mounts = (at[:, 0] + 1j * at[:, 1] for at in (feet, robot.mount_position))
    stance.step(FootPlane(), rest, 0.5, 0.04, walks=True)
    np.testing.assert_allclose(rest + stance.shift - mounts, 0.6 * (rest - mounts))


@pytest.mark.parametrize(
    ("slope", "period", "least", "most"), [(0.3, math.inf, 1.0, 1.0), (0.17, math.inf, 0.0, 0.0), (0.3, 1.0, 0.0, 0.0)]
)
def test_feet_come_down_slowly_on_steep_slopes_that_last(slope, period, least, most):
    stance, dt = SlopeStance(preset("strider")), 0.04
    rest, seen = np.zeros(6, dtype=complex), []
    for tick in range(200):
        # Over rough ground the slope goes up and down.
        stance.step(FootPlane(0.0, slope * math.cos(math.tau * tick * dt / period), 0.0), rest, 0.0, dt, walks=True)
        seen.append(stance.lasting)
    assert seen[0] == 0.0
    assert least <= min(seen[100:])
    assert max(seen[100:]) <= most


@pytest.mark.parametrize(("slope", "most", "longer"), [(0.0, 1.25, 1.0), (0.2, 1.25, 1.125), (0.2, 1.0, 1.0)])
def test_steps_are_longer_and_fewer_on_slopes(slope, most, longer):
    controller = WalkController(preset("strider"), adaptation=GroundAdaptation(cycle_time=most))
    controller._walk.ground.body.stance.uphill = complex(slope, 0.0)
    controller.step((0.05, 0.0, 0.0), 0.01)
    assert controller._walk.transitions.lengthened == pytest.approx(longer)


def test_the_body_is_raised_where_it_would_touch_a_slope():
    stance, plane = SlopeStance(preset("strider")), FootPlane(0.0, 0.4, 0.0)
    assert stance.underside(FootPlane(), 0.02) == (0.0, 0.0)
    # Half a length of 120 mm, half a height of 25 mm.
    assert stance.underside(plane, 0.08) == pytest.approx((0.4 * 0.12, 0.08 - 0.025 - 0.04))
    assert stance.underside(plane, 0.02) == pytest.approx((0.4 * 0.12, 0.0))
    posture = PostureFeedback("level")
    for _ in range(100):
        posture.fit_to_reach(
            [([0.0] * 6, [0.0] * 6)], (0.03, 0.0), 0.02, reach=([-0.1] * 6, [0.1] * 6), height=0.1, share=1.0
        )
    assert posture.raised == pytest.approx(0.03)


def test_reach_is_computed_anew_only_where_stroke_or_posture_change():
    controller = WalkController(preset("strider"))
    state = controller._tick.gait
    reach, rest = Reach(preset("strider")), state.foot
    reach.update(TickState(state, np.array([0.1, 0.0, 0.0])), rest, 0.5)
    lowest = reach.lowest
    reach.update(TickState(state, np.array([0.1005, 0.0, 0.0])), rest, 0.5)
    assert reach.lowest is lowest
    reach.update(TickState(state, np.array([0.2, 0.0, 0.0])), rest, 0.5)
    assert reach.lowest is not lowest
    # For a foot that hangs, the body goes lower than swings would like.
    usual, hanging = reach.highest_stand(0.15), reach.highest_stand(0.15, hangs=True)
    assert all(a < b <= c for a, b, c in zip(usual, hanging, reach.highest, strict=True))
    # Feet that swing out need less room above them than the rise of their swing, and stand no higher for it.
    assert all(high - 1.5 * 0.15 < stand for stand, high in zip(usual, reach.highest, strict=True))
    assert reach.highest_stand(0.0) == reach.highest


def test_on_rough_ground_the_body_is_raised_only_so_far_that_legs_reach_lower_footholds():
    controller = WalkController(preset("phantomx"))
    ground, roughness = controller._walk.ground, 0.055
    for _ in range(200):
        ground.body.roughness.value = roughness
        readings = SensorReadings(contacts=controller.contacts, attitude=(0.0, 0.0))
        controller.step((0.05, 0.0, 0.0), 0.01, readings)
    assert 0.0 < ground.body._posture.raised <= -max(ground.body.reach.lowest) - roughness / 2 + 0.002


def test_a_foot_that_seeks_ground_at_its_least_height_expects_it_below():
    state, reach, plane = WalkController(preset("strider"))._tick.gait, Reach(preset("strider")), FootPlane(0.01)
    reach.update(TickState(state, np.array([0.1, 0.0, 0.0])), state.foot, 0.5)
    over, seeking = [0.02, *reach.lowest[1:]], [0, 1]
    hanging = [leg for leg in seeking if reach.hangs(leg, over[leg])]
    assert hanging == [1]
    rises = reach.rises(plane, over, bears=[0, 2, 3, 4, 5], hanging=hanging)
    assert rises[0] == pytest.approx(0.01)
    assert rises[1] < reach.lowest[1] - plane.height
    assert rises[2:] == pytest.approx([height - plane.height for height in reach.lowest[2:]])


def climbed(degrees, *, seconds=9.0, speed=0.146, start=0.35):
    """Return way over the commanded one, tilt in the end [rad], slip [m/m] and the controller of a walk up a ramp."""
    robot = preset("strider")
    plant = SimulatedPlant(robot, terrain=terrain.Ramp(slope=math.radians(degrees), start=start, length=5.0))
    controller, dt = RobotController(robot), 0.01
    output, slip = controller.output, 0.0
    plant.start(output)
    for _ in range(round(seconds / dt)):
        output = controller.step((speed, 0.0, 0.0), dt, plant.step(output, dt))
        slip += float(plant.state.slip_speeds.mean()) * dt
        assert not plant.body_touches
    way = plant.state.body.position[0]
    for _ in range(250):
        output = controller.step((0.0, 0.0, 0.0), dt, plant.step(output, dt))
    return way / (speed * seconds), math.hypot(*plant.state.body.rpy[:2]), slip / way, controller


@pytest.mark.no_cover
def test_a_slope_of_ten_degrees_costs_next_to_nothing():
    way, tilt, slip, _ = climbed(10.0)
    assert way > 0.94
    assert slip < 0.03
    assert tilt < math.radians(2.0)


@pytest.mark.no_cover
def test_a_robot_walks_up_a_slope_of_twenty_degrees_level_and_stands_on_it():
    way, tilt, slip, controller = climbed(20.0)
    assert way > 0.85
    assert slip < 0.05
    assert tilt < math.radians(3.0)
    walk = controller._activity.controller
    assert walk.walk_state is WalkState.STANDING
    assert np.abs(walk._walk.ground.body.stance.shift).max() > 0.05


def walked_down(monkeypatch, *, slowly):
    """Return RMS tilt [rad] and slip [m/m] of phantomx down a ramp of 20 degrees, means of some places of its edge."""
    return np.mean([walked_down_from(start, monkeypatch, slowly=slowly) for start in (0.35, 0.4, 0.45)], axis=0)


def walked_down_from(start, monkeypatch, *, slowly):
    robot, dt = preset("phantomx"), 0.01
    if not slowly:
        monkeypatch.setattr(slope_stance, "_LASTS", math.inf)
    plant = SimulatedPlant(robot, terrain=terrain.Ramp(slope=math.radians(-20), start=start), servos="catalogue")
    controller, tilts, slip = RobotController(robot), [], 0.0
    plant.start(controller.output)
    speed = 0.5 * WalkController(robot).top_speed((1.0, 0.0, 0.0))
    for _ in range(round(1.2 / speed / dt)):
        controller.step((speed, 0.0, 0.0), dt, plant.step(controller.output, dt))
        tilts.append(math.hypot(*plant.state.body.rpy[:2]))
        slip += float(plant.state.slip_speeds.mean()) * dt
    return math.sqrt(np.mean(np.square(tilts))), slip / plant.state.body.position[0]


@pytest.mark.no_cover
def test_feet_that_come_down_slowly_on_a_slope_slip_and_tilt_the_body_less(monkeypatch):
    tilt, slip = walked_down(monkeypatch, slowly=True)
    fast_tilt, fast_slip = walked_down(monkeypatch, slowly=False)
    assert slip < 0.035
    assert slip < 0.9 * fast_slip
    assert tilt < 0.9 * fast_tilt


@pytest.mark.no_cover
@pytest.mark.parametrize(("name", "rises"), [("phantomx", 20.0), ("phantomx", -20.0), ("makeyourpet", 20.0)])
def test_robots_that_stop_on_a_slope_stay_there(name, rises):
    robot, dt = preset(name), 0.01
    slope = math.radians(rises)
    plant = SimulatedPlant(robot, terrain=terrain.Ramp(slope=slope, start=0.35, length=5.0), servos="catalogue")
    controller = RobotController(robot)
    speed, output, ways, steps = 0.5 * WalkController(robot).top_speed((1.0, 0.0, 0.0)), controller.output, [], 0
    plant.start(output)
    for tick in range(round(0.9 / speed / dt) + 500):
        output = controller.step((speed if tick * speed * dt < 0.9 else 0.0, 0.0, 0.0), dt, plant.step(output, dt))
        ways.append(plant.state.body.position[0])
        steps = 0 if bool(controller._activity.controller.contacts.all()) else tick
    # It slid downhill by 0.25 m in 8 s while it stepped on and on.
    assert steps == 0
    assert abs(ways[-1] - ways[-300]) < 0.03


@pytest.mark.no_cover
def test_a_robot_walks_sideways_up_a_slope_of_twenty_degrees():
    robot = preset("strider")
    ground = Turned(terrain.Ramp(slope=np.radians(20), start=0.4), np.pi / 2)
    plant, controller = SimulatedPlant(robot, terrain=ground, servos="catalogue"), RobotController(robot)
    plant.start(controller.output)
    tilts, speed = [], 0.6 * WalkController(robot).top_speed((0, 1, 0))
    for _ in range(round(1.0 / speed / 0.01)):
        controller.step((0.0, speed, 0.0), 0.01, plant.step(controller.output, 0.01))
        tilts.append(np.abs(plant.state.body.rpy[:2]).max())
    assert plant.state.body.position[1] > 0.75
    assert max(tilts) < np.radians(10)


def test_a_slippery_slope_is_refused_with_its_angle_and_the_way_back_stays_open():
    limit = SlopeLimit(0.8)
    steep, gentle = (FootPlane(0.0, math.tan(math.radians(angle)), 0.0) for angle in (27.0, 15.0))
    limit.step(gentle, 0.1 + 0j, 0.04)
    assert not limit.refuses
    limit.step(steep, 0.1 + 0j, 0.04)
    assert limit.refuses
    assert "27 deg" in limit.reason
    limit.step(FootPlane(0.0, math.tan(limit.steepest - 0.01), 0.0), 0.1 + 0.02j, 0.04)
    assert limit.refuses
    assert "27 deg" in limit.reason
    limit.step(steep, -0.1 + 0j, 0.04)
    assert not limit.refuses
    limit.step(steep, 0.1 + 0j, 0.04)
    assert limit.refuses
    limit.step(gentle, 0.1 + 0j, 0.04)
    assert not limit.refuses
    # Down a slope that is too steep, down is refused, and up again is not.
    limit.step(FootPlane(0.0, -0.6, 0.0), 0.1 + 0j, 0.04)
    assert limit.refuses
    limit.step(FootPlane(0.0, -0.6, 0.0), -0.1 + 0j, 0.04)
    assert not limit.refuses


def test_a_slope_that_is_found_too_steep_on_the_way_back_refuses_the_way_on():
    limit = SlopeLimit(0.8)
    edge, steep = (FootPlane(0.0, math.tan(limit.steepest + off), 0.0) for off in (-0.01, 0.01))
    limit.step(edge, 0.1 + 0j, 0.5)
    for _ in range(3):
        limit.step(steep, -0.05 + 0j, 0.04)
        assert not limit.refuses
    limit.step(steep, 0.05 + 0j, 0.04)
    assert limit.refuses
    # Turning on the spot with what is left of the velocity, and walking along the slope, are not refused.
    for velocity in (0.001 + 0j, 0.01 + 0.1j):
        limit.step(steep, velocity, 0.04)
        assert not limit.refuses
    # Back where it began, the way further down is the one on which the slope was met.
    limit.step(FootPlane(0.0, 0.0, 0.0), 0j, 0.04)
    limit.step(edge, -0.1 + 0j, 1.5)
    limit.step(steep, 0.05 + 0j, 0.04)
    assert not limit.refuses
    limit.step(steep, -0.05 + 0j, 0.04)
    assert limit.refuses


@pytest.mark.parametrize("friction", [0.3, 0.35, 0.4])
def test_low_friction_does_not_refuse_level_ground(friction):
    limit, steep = SlopeLimit(friction), FootPlane(0.0, 0.3, 0.0)
    limit.step(steep, 0.1 + 0j, 0.04)
    assert limit.refuses
    # The slope that is felt on level ground is not exactly 0.
    limit.step(FootPlane(0.0, 0.03, 0.0), 0.1 + 0j, 0.04)
    assert not limit.refuses
    assert not limit.holds


def test_a_body_that_legs_do_not_keep_level_stops_on_a_slope_until_it_is_level_again():
    limit, up, dt, state = SlopeLimit(0.8), FootPlane(0.0, 0.3, 0.0), 0.04, WalkController(preset("strider"))._tick.gait

    def granted(off, speed=0.1, plane=up):
        limit.step(plane, complex(speed), dt, off=math.radians(off))
        grant = limit.limit(TwistRequest((speed, 0.0, 0.0), dt, state, np.zeros(3)), TwistGrant())
        return grant.fraction, [found.cause for found in grant.limitations]

    assert granted(11.0) == (1.0, [])
    assert not limit.refused
    assert not limit.holds
    # The walk waits while the body tips further; then feet step on the spot.
    assert granted(13.0) == (1.0, [])
    assert limit.refused
    assert limit.refuses
    assert limit.holds
    for _ in range(60):
        fraction, causes = granted(13.0)
    assert fraction == 0.0
    assert "off by 13 deg, at most 12 deg" in causes[0]
    assert not limit.refuses
    assert not limit.holds
    assert granted(14.0)[0] == 0.0
    assert limit.holds
    # It stays so while it levels, and the way back is open.
    assert granted(9.0)[0] == 0.0
    assert not limit.holds
    assert granted(9.0, -0.1) == (1.0, [])
    assert not limit.refuses
    assert granted(9.0)[0] == 0.0
    assert granted(7.0) == (1.0, [])
    # On level ground it is an obstacle that tilts the body.
    assert granted(20.0, plane=FootPlane(0.0, 0.1, 0.0)) == (1.0, [])
    # Where feet slip, none lifts off but on the way back.
    for _ in range(60):
        granted(13.0, plane=FootPlane(0.0, 0.6, 0.0))
    assert limit.refuses
    assert limit.holds
    granted(13.0, -0.1, plane=FootPlane(0.0, 0.6, 0.0))
    assert not limit.refuses
    assert not limit.holds


def test_a_robot_that_its_legs_do_not_keep_level_does_not_tip_over_backwards():
    """Joint angles that are off by 0.3 deg make up half of this robot's room on the slope: it fell after 12 s."""
    suite = dataclasses.replace(
        SensorSuite.named("smart"), name=None, contacts=SensorSuite.named("ideal").contacts, attitude=Sensor()
    )
    robot = preset("makeyourpet")
    plant = SimulatedPlant(robot, terrain=terrain.Ramp(slope=math.radians(20.0)), sensors=suite)
    speed = 0.5 * WalkController(robot).top_speed((1.0, 0.0, 0.0))
    controller, tilts, ways = RobotController(robot), [], []
    plant.start(controller.output)
    for _ in range(1300):
        controller.step((speed, 0.0, 0.0), 0.01, plant.step(controller.output, 0.01))
        tilts.append(abs(plant.state.body.rpy[1]))
        ways.append(plant.state.body.position[0])
    assert max(tilts) < math.radians(25.0)
    assert ways[-1] > 0.75


def test_less_friction_refuses_gentler_slopes():
    steepest = [SlopeLimit(friction).steepest for friction in (0.3, 0.6, 0.8, 1.0)]
    assert math.tan(steepest[0]) == pytest.approx(0.1)
    assert steepest == sorted(steepest)
    for friction in (-1.0, 0.0):
        with pytest.raises(InputError, match=f"friction is {friction:g}"):
            GroundAdaptation(friction=friction)


@pytest.mark.no_cover
def test_a_robot_stops_on_a_slope_that_is_too_steep_says_so_and_walks_back():
    robot, dt = preset("strider"), 0.01
    plant = SimulatedPlant(robot, terrain=terrain.Ramp(slope=math.radians(15), start=0.3, length=5.0))
    controller = RobotController(robot, adaptation=GroundAdaptation(friction=0.55))
    output, places = controller.output, []
    plant.start(output)
    for twist, seconds in ((0.146, 7.0), (0.146, 2.0), (-0.146, 3.0)):
        for _ in range(round(seconds / dt)):
            output = controller.step((twist, 0.0, 0.0), dt, plant.step(output, dt))
        places.append(plant.state.body.position[0])
        if twist > 0:
            causes = [found.cause for found in output.limitations if found.kind is LimitationKind.GROUND]
            assert ["slope" in cause for cause in causes] == [True]
    assert places[1] == pytest.approx(places[0], abs=0.01)
    assert places[2] < places[1] - 0.15


@pytest.mark.no_cover
@pytest.mark.parametrize(("servos", "sensors"), [("catalogue", "ideal"), ("ideal", "hobby")])
def test_a_robot_that_stands_on_flat_ground_does_not_move(servos, sensors):
    robot, dt, moved = preset("phantomx"), 0.01, []
    plant = SimulatedPlant(robot, servos=servos, sensors=sensors, seed=1)
    controller = RobotController(robot)
    output = controller.output
    plant.start(output)
    for tick in range(700):
        before = output.angles
        output = controller.step((0.04 if tick < 200 else 0.0, 0.0, 0.0), dt, plant.step(output, dt))
        moved.append(np.abs(np.asarray(output.angles) - np.asarray(before)).max())
    # Feet that lost contact were pushed down, took others off the ground, and so on: 200 degrees a second.
    assert max(moved[600:]) < math.radians(1.0) * dt
    assert output.at_rest


def test_a_robot_is_carried_until_its_feet_have_held_it_for_a_while():
    condition, dt, seen = BodyCondition(), 0.04, []
    for tick in range(70):
        touches, holds = tick < 10 or tick >= 30, tick < 10 or tick in {32, 33} or tick >= 40
        condition.step(touches, 0.0, dt, held=holds)
        seen.append(condition.carried)
    assert seen.index(True) == 22
    assert [tick for tick, carried in enumerate(seen) if carried] == list(range(22, 52))


def test_a_robot_whose_legs_cease_to_bear_it_is_carried_until_they_do_again():
    condition, seen = BodyCondition(), []
    for tick in range(30):
        condition.step(True, 0.0, 0.04, held=True, lifted=tick == 10)
        seen.append(condition.carried)
    assert [tick for tick, carried in enumerate(seen) if carried] == list(range(10, 23))
    assert not condition.limitations


@pytest.mark.no_cover
@pytest.mark.parametrize(("name", "ground", "seed"), [("strider", "ramp+20", 8), ("phantomx", "ramp+17", 3)])
def test_a_robot_that_is_put_down_on_a_slope_becomes_level_and_walks_on(name, ground, seed):
    # The one overturned, the other waited until it was level, for good.
    way, tilt, touched = put_down.walk((name, ground, seed))
    assert way > 0.5
    assert tilt < 25.0
    assert not touched
