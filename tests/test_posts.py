"""Posts in the way of legs: the feet are stopped, step back, and no servo is taken to have failed for it."""

import mujoco
import numpy as np
import pytest

import tarsus
from tarsus.simulation import SensorSuite, SimulatedPlant, terrain
from tarsus.simulation.sensors.suite import FootSwitch, Sensor

ANGLES = SensorSuite(contacts=FootSwitch(), attitude=Sensor(), angular_rates=Sensor(), joint_angles=Sensor())


class Post:
    """Level ground with a post that legs do not step over, 0.5 m ahead and so far to the left [m]."""

    friction = 0.9

    def __init__(self, aside):
        self._aside = aside

    def height(self, x, _y):
        return np.zeros(np.shape(x))

    def add_to(self, spec):
        terrain.Flat(friction=self.friction).add_to(spec)
        box = {"type": mujoco.mjtGeom.mjGEOM_BOX, "size": (0.03, 0.03, 0.15), "pos": (0.53, self._aside, 0.15)}
        spec.worldbody.add_geom(name="ground 1", **box, friction=(self.friction, 0.005, 0.0001))


@pytest.mark.parametrize(("name", "aside"), [("strider", 0.25), ("phantomx", 0.17)])
def test_a_leg_that_a_post_stops_has_not_failed(name, aside):
    robot = tarsus.load_robot(name)
    plant = SimulatedPlant(robot, terrain=Post(aside), sensors=ANGLES)
    controller, causes = tarsus.RobotController(robot), set()
    output, speed = controller.output, 0.5 * tarsus.WalkController(robot).top_speed((1.0, 0.0, 0.0))
    plant.start(output)
    for _ in range(round(1.0 / speed / 0.01)):
        output = controller.step((speed, 0.0, 0.0), 0.01, plant.step(output, 0.01))
        causes |= {limit.cause for limit in output.limitations}
    assert dict(controller.leg_failures.failed) == {}
    assert "an obstacle stops the foot" in causes
