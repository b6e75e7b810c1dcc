"""Robots of half the size walk over ground of half the height, in physics."""

import math

import numpy as np
import pytest

import tarsus
from sample_robots import halved
from tarsus.simulation import SimulatedPlant, terrain

GROUNDS = {
    "smooth": terrain.Smooth(amplitude=0.03, wavelength=0.2, clear=0.175),
    "blocks": terrain.Blocks(rise=0.02, size=0.075, clear=0.175),
    "step up": terrain.Step(rise=0.02, start=0.15),
    "ramp": terrain.Ramp(slope=math.radians(-20)),
}


@pytest.mark.parametrize("ground", GROUNDS)
def test_a_robot_of_half_the_size_makes_its_way_over_ground_of_half_the_height(ground):
    robot = halved(tarsus.load_robot("strider"))
    plant, controller = SimulatedPlant(robot, terrain=GROUNDS[ground]), tarsus.RobotController(robot)
    speed, output = 0.5 * tarsus.WalkController(robot).top_speed((1, 0, 0)), controller.output
    plant.start(output)
    start, tilts, ticks = plant.state.body.position[0], [], round(0.4 / speed / 0.01)
    for _ in range(ticks):
        output = controller.step((speed, 0.0, 0.0), 0.01, plant.step(output, 0.01))
        tilts.append(np.hypot(*plant.state.body.rpy[:2]))
        assert not plant.state.body_touches
    assert plant.state.body.position[0] - start > 0.9 * speed * 0.01 * ticks
    assert np.max(tilts) < math.radians(8)
