"""The heading: what is measured of the body's turning, and how it turns back."""

import dataclasses
import math

import numpy as np
import pytest

import tarsus
from tarsus.control.pose.heading_feedback import HeadingFeedback
from tarsus.control.readings import ValidReadings
from tarsus.simulation import SensorSuite, SimulatedPlant

DT = 0.04


def rates(*about, attitude=(0.0, 0.0)):
    return ValidReadings(angular_rates=about, attitude=attitude)


def turned(seconds, *, slips, commanded=0.0, offset=0.0, heading=None):
    """Return how far a body has turned that follows at once and turns by its slip as well."""
    heading, yaw = heading or HeadingFeedback(), 0.0
    for _ in range(round(seconds / DT)):
        rate = commanded + slips + heading.rate
        yaw += rate * DT
        heading.step(rates(0.0, 0.0, rate + offset), commanded, DT, rests=False, still=False)
    return yaw


@pytest.mark.parametrize("commanded", [0.0, 0.3, -0.5])
def test_a_body_that_has_slipped_turns_back(commanded):
    heading = HeadingFeedback()
    slipped = turned(2.0, slips=0.1, commanded=commanded, heading=heading) - 2.0 * commanded
    assert 0.02 < slipped < 0.1
    assert abs(slipped + turned(6.0, slips=0.0, commanded=commanded, heading=heading) - 6.0 * commanded) < 0.02


@pytest.mark.parametrize(("at_rest", "least", "most"), [(5.0, 0.0, 0.01), (0.0, 0.1, 0.21)])
def test_the_offset_of_the_rates_is_learnt_at_rest_and_turns_the_body_otherwise(at_rest, least, most):
    heading, offset = HeadingFeedback(), math.radians(0.2)
    for _ in range(round(at_rest / DT)):
        heading.step(rates(0.0, 0.0, offset), 0.0, DT, rests=True, still=True)
    assert least <= -turned(60.0, slips=0.0, offset=offset, heading=heading) <= most


def test_nothing_is_learnt_while_a_robot_comes_to_rest():
    heading = HeadingFeedback()
    for _ in range(100):
        heading.step(rates(0.0, 0.0, 0.01), 0.0, DT, rests=True, still=False)
    assert turned(20.0, slips=0.0, heading=heading) == pytest.approx(0.0, abs=1e-9)


def test_the_rate_and_what_is_made_up_for_are_bounded():
    heading = HeadingFeedback()
    turned(60.0, slips=2.0, heading=heading)
    assert (heading.behind, heading.rate) == (-0.5, -0.15)


def test_a_body_pose_that_turns_slowly_at_rest_is_no_offset_of_the_rates():
    heading = HeadingFeedback()
    for _ in range(100):
        heading.step(rates(0.0, 0.0, 0.015), 0.015, DT, rests=True, still=True)
    assert turned(20.0, slips=0.0, heading=heading) == pytest.approx(0.0, abs=5e-3)


def test_rates_of_a_tilted_body_are_those_about_the_vertical():
    roll, pitch, heading = 0.3, -0.2, HeadingFeedback()
    along_body = tarsus.Pose.from_rpy(roll, pitch, 0.4).rotation.T @ np.array([0.0, 0.0, 0.25])
    heading.step(rates(*along_body, attitude=(roll, pitch)), 0.25, DT, rests=False, still=False)
    assert heading.behind == pytest.approx(0.0, abs=1e-12)


def test_a_robot_at_rest_does_not_turn_and_goes_on_later():
    heading = HeadingFeedback()
    turned(1.0, slips=0.1, heading=heading)
    behind = heading.behind
    heading.step(rates(0.0, 0.0, 0.3), 0.0, DT, rests=True, still=True)
    assert (heading.behind, heading.rate) == (pytest.approx(behind, rel=0.01), 0.0)
    for _ in range(round(40.0 / DT)):
        heading.step(rates(0.0, 0.0, 0.0), 0.0, DT, rests=True, still=True)
    assert abs(heading.behind) < 0.05 * abs(behind)
    turned(1.0, slips=0.1, heading=heading)
    heading.step(rates(0.0, 0.0, 0.0), 0.0, DT, rests=True, still=True)
    heading.step(rates(0.0, 0.0, 0.0), 0.0, DT, rests=False, still=False)
    assert heading.rate < 0.0


def test_rates_that_are_missing_for_a_moment_leave_what_is_made_up_for():
    heading = HeadingFeedback()
    turned(1.0, slips=0.1, heading=heading)
    before = heading.behind, heading.rate
    for _ in range(7):
        heading.step(ValidReadings(), 0.0, DT, rests=False, still=False)
        assert (heading.behind, heading.rate) == before
    for _ in range(2):
        heading.step(ValidReadings(), 0.0, DT, rests=False, still=False)
    assert (heading.behind, heading.rate) == (0.0, 0.0)
    turned(1.0, slips=0.1, heading=heading)
    heading.step(ValidReadings(), 0.0, DT, rests=True, still=True)
    assert (heading.behind, heading.rate) == (0.0, 0.0)


def heading_after_a_twist_of_the_body(sensors):
    """Return the greatest and the last angle of a body off its heading that a torque turns at 2 s [deg]."""
    robot, found = tarsus.load_robot("strider"), []
    plant, controller = SimulatedPlant(robot, sensors=sensors, servos="ideal"), tarsus.RobotController(robot)
    output = controller.output
    plant.start(output)
    for tick in range(400):
        plant.mj_data.xfrc_applied[1, 5] = 6.5 if 100 <= tick < 125 else 0.0
        output = controller.step((0.08, 0.0, 0.0), 0.02, plant.step(output, 0.02))
        found.append(math.degrees(float(np.asarray(plant.state.body.rpy)[2])))
    return max(found), found[-1]


@pytest.mark.no_cover
@pytest.mark.parametrize("dt", [0.01, 0.02])
def test_in_physics_a_robot_with_stiff_servos_turns_as_commanded(dt):
    # Their steps turn the body in jerks: at the end of a tick it turns more slowly than on the average.
    robot = tarsus.load_robot("phantomx")
    plant, controller = SimulatedPlant(robot, servos="ideal"), tarsus.RobotController(robot)
    plant.start(controller.output)
    for _ in range(round(4.0 / dt)):
        controller.step((0.0, 0.0, 0.2), dt, plant.step(controller.output, dt))
    assert plant.state.body.rpy[2] == pytest.approx(controller.output.body.rpy[2], rel=0.02)


@pytest.mark.no_cover
def test_in_physics_a_body_that_is_turned_goes_back_to_its_heading():
    ideal = SensorSuite.named("ideal")
    most, last = heading_after_a_twist_of_the_body(ideal)
    assert most > 4.0
    assert abs(last) < 0.5 * most
    _, stays = heading_after_a_twist_of_the_body(dataclasses.replace(ideal, angular_rates=None))
    assert stays > 2 * abs(last)
