"""Robots of half the size walk over ground of half the height, in physics."""

import dataclasses
import math

import numpy as np
import pytest

import tarsus
from sample_robots import halved
from tarsus.simulation import SensorSuite, SimulatedPlant, terrain
from tarsus.simulation.sensors.suite import FootSwitch

# Feet of a strider of a quarter of the size bear 60 mN.
LIGHT = dataclasses.replace(SensorSuite.named("ideal"), contacts=FootSwitch(threshold=0.01))
GROUNDS = {
    "smooth": terrain.Smooth(amplitude=0.03, wavelength=0.2, clear=0.175),
    "blocks": terrain.Blocks(rise=0.02, size=0.075, clear=0.175),
    "step up": terrain.Step(rise=0.02, start=0.15),
    "ramp": terrain.Ramp(slope=math.radians(-20)),
}
QUARTER = terrain.Blocks(rise=0.01, size=0.0375, clear=0.0875, extent=0.8)


def test_switches_that_no_foot_would_close_are_refused():
    robot = halved(halved(tarsus.load_robot("strider")))
    with pytest.raises(tarsus.InputError, match=r"close at 0.5 N, and .* bears 0.0\d+ N: none would close; lighter"):
        SimulatedPlant(robot)


@pytest.mark.no_cover
def test_a_robot_of_a_quarter_of_the_size_notices_blocks_of_a_quarter_of_the_height():
    robot = halved(halved(tarsus.load_robot("strider")))
    assert_makes_its_way(SimulatedPlant(robot, terrain=QUARTER, sensors=LIGHT), 0.3, least=0.8, steepest=8)


@pytest.mark.parametrize("ground", GROUNDS)
def test_a_robot_of_half_the_size_makes_its_way_over_ground_of_half_the_height(ground):
    plant = SimulatedPlant(halved(tarsus.load_robot("strider")), terrain=GROUNDS[ground])
    assert_makes_its_way(plant, 0.4, least=0.9, steepest=10)


def assert_makes_its_way(plant, way, *, least, steepest):
    robot, controller = plant.robot, tarsus.RobotController(plant.robot)
    speed, output = 0.5 * tarsus.WalkController(robot).top_speed((1, 0, 0)), controller.output
    plant.start(output)
    start, tilts, ticks = plant.state.body.position[0], [], round(way / speed / 0.01)
    for _ in range(ticks):
        output = controller.step((speed, 0.0, 0.0), 0.01, plant.step(output, 0.01))
        tilts.append(np.hypot(*plant.state.body.rpy[:2]))
        assert not plant.state.body_touches
    assert plant.state.body.position[0] - start > least * speed * 0.01 * ticks
    assert np.max(tilts) < math.radians(steepest)
