"""Stance transitions of live walks: a robot that stands comes to stand as it is told."""

import dataclasses

import numpy as np
import pytest

from sample_stances import setup_of
from tarsus import load_robot
from tarsus.control.command import Command
from tarsus.control.readings import SensorReadings
from tarsus.control.transition.foothold_transfer import FootholdTransfer
from tarsus.control.transition.planner import TransitionPlanner
from tarsus.control.walk.state import POSITION_TOLERANCE
from tarsus.control.walk_controller import WalkController
from tarsus.control.walk_state import WalkState
from tarsus.robot.joint_limits import joint_limits

DT = 0.04
LEVEL = (0.0,) * 6


def hold(controller, command, seconds, *, felt=False):
    """Command something once, and stand."""
    for tick in range(round(seconds / DT)):
        readings = SensorReadings(contacts=controller.contacts, attitude=(0.0, 0.0)) if felt else None
        controller.step(command if tick == 0 else (0, 0, 0), DT, readings)


def spread(controller):
    """How far the feet are from the coxa axes [m]."""
    mount = controller.robot.mount_position
    return np.abs((controller.feet - controller.body.position - mount) @ (1, 1j, 0))


@pytest.mark.parametrize("name", ["strider", "freenove"])
@pytest.mark.parametrize(("share", "width"), [(1.1, 0.0), (1.0, 0.01), (1.0, 0.005)])
def test_a_robot_that_feels_the_ground_stands_as_it_is_told(name, share, width):
    """Its feet step to footholds so near that it would stay standing otherwise."""
    controller = WalkController(load_robot(name))
    height, before = controller.body.position[2], spread(controller)
    hold(controller, (0, 0, 0), 0.5, felt=True)
    hold(controller, Command(body_height=share * height, stance_width=width), 10, felt=True)
    assert controller.feels_ground
    assert controller.walk_state is WalkState.STANDING
    assert controller.limitations == ()
    assert controller.body.position[2] == pytest.approx(share * height, abs=1e-4)
    if width:
        np.testing.assert_allclose(spread(controller), before + width, atol=1e-3)


def test_a_body_waits_for_no_feet_that_are_where_they_should_be_but_for_rounding():
    controller = WalkController(load_robot("freenove"))
    height = float(controller.body.position[2])
    # The rest footholds of the last transition are some 200 nm from those before.
    hold(controller, Command(body=(0.107, 0.05, -0.063, 0, -0.151, 0.017)), 8)
    hold(controller, Command(body_height=0.043, stance_width=0.003), 8)
    hold(controller, Command(body=LEVEL, body_height=height, stance_width=0.0), 8)
    assert controller.body.position[2] == pytest.approx(height, abs=1e-6)


@pytest.mark.parametrize(
    ("name", "command"),
    [
        ("strider", Command(body_height=0.4)),
        ("makeyourpet", Command(body=(-0.044, 0.081, 0, 0, 0, 0), body_height=0.088)),
        ("ch3r", Command(body=(0.03, -0.034, 0, 0.064, 0.133, 0), body_height=0.059)),
        ("phantomx", Command(body=(-0.014, -0.093, -0.008, -0.191, 0.179, 0), body_height=0.075)),
    ],
)
def test_a_robot_comes_back_from_the_end_of_its_reach(name, command):
    """Feet that can't step there can once the body is over them."""
    controller = WalkController(load_robot(name))
    height, before = float(controller.body.position[2]), spread(controller)
    hold(controller, command, 25)
    assert controller.limitations
    hold(controller, Command(body=LEVEL, body_height=height), 40)
    assert controller.limitations == ()
    np.testing.assert_allclose(controller.body.position, (0, 0, height), atol=1e-6)
    np.testing.assert_allclose(spread(controller), before, atol=1e-5)
    hold(controller, (0.02, 0, 0), DT)
    assert controller.walk_state is WalkState.WALKING


@pytest.mark.parametrize(("off", "stays"), [(0.9 * POSITION_TOLERANCE, True), (1.1 * POSITION_TOLERANCE, False)])
def test_a_foot_steps_to_a_rest_foothold_unless_it_is_at_it(off, stays):
    setup = setup_of("strider")
    planner = TransitionPlanner(setup.robot, joint_limits(setup.robot), foot_distance=setup.foot_distance)
    first = planner.initial_stance(setup, stance_width=0.0, cycle_time=None)
    transfer = FootholdTransfer(first)
    transfer.begin(dataclasses.replace(first, rest=first.rest + off), np.ones(6, dtype=bool))
    assert (transfer.transferred == stays).all()
