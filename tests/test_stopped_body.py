"""Obstacles that stop the body: found by the torques of the coxa joints, named, and not pushed against any longer."""

from types import SimpleNamespace

import numpy as np
import pytest

import tarsus
from tarsus.control.limiter.protocol import TwistGrant
from tarsus.control.limiter.stopped_body import StoppedBody
from tarsus.control.readings import ValidReadings
from tarsus.kinematics.mass import STANDARD_GRAVITY, total_mass
from tarsus.load.foot_force import FootForceEstimator
from tarsus.simulation import SimulatedPlant, terrain

STRIDER = tarsus.load_robot("strider")
ANGLES = tarsus.WalkController(STRIDER).angles
WEIGHT = float(total_mass(STRIDER)) * STANDARD_GRAVITY
DT = 0.04


def pushed(force, tilt=(0.0, 0.0), velocity=0.1 + 0j, seconds=5.0, torques=True, yaw=0.0):
    """Return what is found while three feet push across their legs; the torques of a fourth one are unknown."""
    body, joints = StoppedBody(STRIDER), np.full((6, 3), np.nan)
    for leg in (0, 2, 4):
        # The coxa torque that gives this force ahead, by its lever.
        low, high = (forward(leg, torque) for torque in (0.0, 1.0))
        joints[leg] = (force / 3 - low) / (high - low), 0.0, 0.0
    given = [None if np.isnan(row).any() else tuple(row) for row in joints] if torques else None
    for _ in range(round(seconds / DT)):
        measured = ValidReadings(joint_angles=ANGLES.tolist(), torques=given, attitude=tilt)
        body.step(measured, [0, 2, 4, 5], velocity, DT, yaw=yaw)
    return body


def forward(leg, torque):
    """Return the force ahead of the ground across a leg, by its coxa torque [N]."""
    massless = STRIDER.replace(link_mass=None, link_com=None, body_mass=None)
    found = FootForceEstimator(massless).forces(ANGLES.tolist(), [(torque, 0.0, 0.0)] * 6)[leg]
    return found[0]


def asked(body, *twist):
    return body.limit(SimpleNamespace(twist=twist), TwistGrant())


def test_what_the_body_pushes_against_refuses_the_way_there_until_another_is_taken():
    body = pushed(-0.3 * WEIGHT)
    assert asked(body, 0.1, 0.0, 0.0).fraction == 1.0
    body = pushed(0.3 * WEIGHT, seconds=1.6)
    assert asked(body, 0.1, 0.0, 0.0).fraction == 1.0
    body = pushed(0.3 * WEIGHT)
    grant = asked(body, 0.1, 0.05, 0.0)
    assert grant.fraction == 0.0
    assert "an obstacle stops the body, which pushes with" in grant.limitations[0].text()
    assert asked(body, 0.0, 0.0, 0.0).fraction == 1.0
    assert asked(body, 0.1, 0.0, 0.0).fraction == 0.0
    assert asked(body, 0.0, 0.1, 0.0).fraction == 1.0
    assert asked(body, 0.1, 0.0, 0.0).fraction == 1.0


def test_the_way_of_a_body_that_is_turned_against_its_heading_is_the_commanded_one():
    # Its own x axis is along y of the heading frame.
    body = pushed(0.3 * WEIGHT, velocity=0.1j, yaw=np.pi / 2)
    assert asked(body, 0.0, 0.1, 0.0).fraction == 0.0
    assert asked(body, 0.1, 0.0, 0.0).fraction == 1.0


def test_what_gravity_pulls_a_tilted_body_with_is_no_obstacle():
    # Nose up, the ground pushes it ahead along its own axes.
    tilt = (0.0, -0.3)
    assert asked(pushed(0.3 * WEIGHT), 0.1, 0.0, 0.0).fraction == 0.0
    assert asked(pushed(0.3 * WEIGHT, tilt), 0.1, 0.0, 0.0).fraction == 1.0
    assert pushed(0.3 * WEIGHT, tilt).push == pytest.approx(0.3 - np.sin(0.3), abs=0.02)
    # Nose down, the legs hold it back along themselves, which coxae do not tell.
    assert pushed(0.0, (0.0, 0.3)).push <= 0.01
    assert pushed(0.3 * WEIGHT, (0.0, 0.3)).push == pytest.approx(pushed(0.3 * WEIGHT).push)


@pytest.mark.no_cover
def test_a_robot_that_walks_with_its_nose_down_meets_no_obstacle():
    plant = SimulatedPlant(STRIDER)
    controller, dt = tarsus.RobotController(STRIDER), 0.01
    plant.start(controller.output)
    command = tarsus.Command(twist=(0.1, 0.0, 0.0), body=(0.0, 0.0, 0.0, 0.0, 0.25, 0.0))
    for _ in range(round(9.0 / dt)):
        controller.step(command, dt, plant.step(controller.output, dt))
    assert plant.state.body.rpy[1] > 0.2
    assert plant.state.body.position[0] > 0.85 * 0.9


def test_without_torques_or_masses_and_without_a_way_nothing_is_found():
    assert pushed(WEIGHT, torques=False).push == 0.0
    assert pushed(WEIGHT, velocity=0j).push == 0.0
    massless = StoppedBody(STRIDER.replace(link_mass=None, link_com=None, body_mass=None))
    measured = ValidReadings(joint_angles=ANGLES.tolist(), torques=[(9.0, 0.0, 0.0)] * 6)
    massless.step(measured, [0, 1, 2, 3], 0.1j, DT, yaw=0.0)
    assert massless.push == 0.0


@pytest.mark.no_cover
def test_a_robot_whose_body_meets_a_pole_says_so_stops_and_walks_back():
    plant = SimulatedPlant(STRIDER, terrain=terrain.Box(start=0.16, length=0.04, width=0.04, rise=0.3))
    controller, dt, said, way = tarsus.RobotController(STRIDER), 0.01, set(), []
    plant.start(controller.output)
    for twist, seconds in ((0.15, 7.0), (-0.15, 1.5)):
        for _ in range(round(seconds / dt)):
            output = controller.step((twist, 0.0, 0.0), dt, plant.step(controller.output, dt))
            said.update(each.text()[:41] for each in output.limitations)
        way.append((plant.state.body.position[0], output.twist[0]))
    assert "ground: an obstacle stops the body, which" in said
    assert abs(way[0][1]) < 1e-3
    assert way[1][0] < way[0][0] - 0.1
