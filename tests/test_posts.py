"""Posts in the way of legs: the feet are stopped, step back, and no servo is taken to have failed for it."""

import pytest

import tarsus
from tarsus.simulation import SensorSuite, SimulatedPlant, terrain
from tarsus.simulation.sensors.suite import FootSwitch, Sensor

ANGLES = SensorSuite(contacts=FootSwitch(), attitude=Sensor(), angular_rates=Sensor(), joint_angles=Sensor())


@pytest.mark.parametrize(("name", "aside"), [("strider", 0.25), ("phantomx", 0.17)])
def test_a_leg_that_a_post_stops_has_not_failed(name, aside):
    robot = tarsus.load_robot(name)
    plant = SimulatedPlant(robot, terrain=terrain.Box(start=0.5, aside=aside, rise=0.3, friction=0.9), sensors=ANGLES)
    controller, causes = tarsus.RobotController(robot), set()
    output, speed = controller.output, 0.5 * tarsus.WalkController(robot).top_speed((1.0, 0.0, 0.0))
    plant.start(output)
    for _ in range(round(1.0 / speed / 0.01)):
        output = controller.step((speed, 0.0, 0.0), 0.01, plant.step(output, 0.01))
        causes |= {limit.cause for limit in output.limitations}
    assert dict(controller.leg_failures.failed) == {}
    assert "an obstacle stops the foot" in causes
