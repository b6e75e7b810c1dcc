"""Time that the ground costs, and how the walk makes up for it."""

from types import SimpleNamespace

import numpy as np
import pytest

import tarsus
from tarsus.control.limiter.lost_time import LostTime
from tarsus.control.limiter.protocol import TwistGrant
from tarsus.control.tick.limit import twist_limiters
from tarsus.simulation import SimulatedPlant, terrain

DT = 0.02
AHEAD = (0.1, 0.0, 0.0)


class Ground:
    """Lets the walk advance at a rate, and follows at once what is granted."""

    def __init__(self, most=1.5, *, felt=True):
        self.rate, self.fraction, self.felt = 1.0, 1.0, felt
        self.limiter = LostTime(most, lambda _: self.rate)

    def walk(self, seconds, *, rate=1.0, twist=AHEAD):
        self.rate, way = rate, 0.0
        for _ in range(round(seconds / DT)):
            state = SimpleNamespace(felt=self.felt, twist=SimpleNamespace(value=self.fraction * np.array(twist)))
            request = SimpleNamespace(twist=tuple(twist), dt=DT, state=state)
            self.fraction = self.limiter.limit(request, TwistGrant()).fraction
            way += (rate or 0.0) * self.fraction * DT
        return way


@pytest.mark.parametrize("most", [1.25, 1.5])
def test_the_mean_speed_is_the_commanded_one_after_the_walk_has_waited(most):
    ground = Ground(most)
    assert ground.walk(1.0) == pytest.approx(1.0)
    way = ground.walk(1.0, rate=0.0)
    assert ground.fraction == most
    way += ground.walk(1.0)
    assert 1 + 0.7 * (most - 1) < way <= most
    assert way + ground.walk(10.0) == pytest.approx(12.0, abs=0.2)
    assert ground.fraction == 1.0


def test_a_walk_that_the_ground_slows_down_asks_for_more():
    ground = Ground()
    assert ground.walk(20.0, rate=0.8) == pytest.approx(20.0, abs=0.6)
    assert Ground(1.0).walk(20.0, rate=0.8) == pytest.approx(16.0)


def test_what_is_made_up_for_is_bounded():
    ground = Ground()
    ground.walk(60.0, rate=0.0)
    assert ground.walk(20.0) == pytest.approx(23.0, abs=0.2)


def test_the_way_that_the_body_backs_off_is_lost_as_well():
    walk = tarsus.WalkController(tarsus.load_robot("strider"))._walk
    rate, missing = twist_limiters(walk)[0]._rate, walk.ground.missing
    assert rate(AHEAD) == 1.0
    missing.back = -0.15 + 0j
    assert rate(AHEAD) == pytest.approx(-0.5)
    missing.refuses = True
    assert rate(AHEAD) == pytest.approx(-1.5)
    # The way back is not, nor is turning.
    for twist in ((-0.1, 0.0, 0.0), (0.0, 0.1, 0.0), (0.0, 0.0, 0.5)):
        assert rate(twist) == 0.0


@pytest.mark.parametrize("twist", [(0.0, 0.0, 0.0), (0.0, 0.1, 0.0), (-0.1, 0.0, 0.0), (0.0, 0.0, 0.5)])
def test_a_command_that_leads_elsewhere_begins_anew(twist):
    ground = Ground()
    ground.walk(2.0, rate=0.0)
    ground.walk(DT, twist=twist)
    assert ground.fraction == 1.0
    other = Ground()
    other.walk(2.0, rate=0.0)
    other.walk(DT, twist=(0.12, 0.02, 0.0))
    assert other.fraction == 1.5


def test_a_command_that_turns_elsewhere_little_by_little_begins_anew():
    ground = Ground()
    ground.walk(2.0, rate=0.0)
    for angle in np.linspace(0.0, np.pi / 2, 50):
        ground.walk(DT, twist=(0.1 * np.cos(angle), 0.1 * np.sin(angle), 0.0))
    assert ground.fraction == 1.0


def test_a_command_that_is_steered_a_little_leads_the_same_way():
    ground = Ground()
    ground.walk(2.0, rate=0.0)
    ground.walk(DT, twist=(0.1, 0.0, 0.1))
    assert ground.fraction == 1.5


def test_a_robot_that_is_carried_has_lost_nothing():
    ground = Ground()
    ground.walk(2.0, rate=0.0)
    assert ground.fraction == 1.5
    ground.walk(DT, rate=None)
    assert ground.fraction == 1.0


def test_a_walk_that_feels_nothing_has_lost_nothing():
    ground = Ground(felt=False)
    ground.walk(2.0, rate=0.0)
    assert ground.fraction == 1.0


def walked(ground, *, seconds=10.0, **adaptation):
    """Return way over the commanded one, and the greatest speed over it."""
    robot = tarsus.load_robot("strider")
    controller = tarsus.RobotController(robot, adaptation=tarsus.GroundAdaptation(**adaptation))
    plant = SimulatedPlant(robot, terrain=ground, sensors="ideal", servos="ideal")
    output, fastest = controller.output, 0.0
    plant.start(output)
    for _ in range(round(seconds / DT)):
        output = controller.step((0.08, 0.0, 0.0), DT, plant.step(output, DT))
        fastest = max(fastest, float(controller._activity.controller.twist[0]))
    return plant.state.body.position[0] / (0.08 * seconds), fastest / 0.08


@pytest.mark.no_cover
def test_over_blocks_more_of_the_way_is_made_and_on_flat_ground_nothing_changes():
    more = 0.0
    for seed in (3, 4):
        blocks = terrain.Blocks(rise=0.1, size=0.15, clear=0.25, seed=seed)
        (slower, steady), (way, fastest) = walked(blocks, catch_up=1.0), walked(blocks)
        assert steady <= 1 + 1e-6 < fastest <= 1.5 + 1e-6
        more += way - slower
    assert more > 0.06
    assert walked(terrain.Flat(), seconds=4.0)[1] <= 1 + 1e-6
