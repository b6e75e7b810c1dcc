"""The live walker on hills and rough ground, which it knows by its feet alone."""

import numpy as np
import pytest

from gait_robots import PRESETS, preset
from tarsus.control.command import Command
from tarsus.control.limitation import Limitation
from tarsus.control.pose.admittance import Admittance
from tarsus.control.readings import SensorReadings
from tarsus.control.walk_controller import WalkController
from tarsus.gait.gait import Gait
from walk_trace import GAITS, Trace, beyond

GIVING = Admittance(mass=1.0, damping=60.0, stiffness=400.0, travel=0.01)
TOUCH = 1e-4


def touching(controller, ground):
    return tuple(controller.feet[:, 2] <= ground + TOUCH)


def leaning(controller):
    rotation = controller.body.rotation
    return float(np.arctan2(rotation[2, 1], rotation[2, 2])), float(np.arcsin(-rotation[2, 0]))


def climb(controller, slope, seconds, *, along=0, dt=0.02):
    """Walk onto a slope that begins in front of the feet, at half the speed that there is on level ground."""
    trace, way = Trace(controller), np.eye(3)[along]
    twist = 0.5 * controller.top_speed(way) * way

    def hill(x):
        return slope * np.maximum(x - 0.35, 0.0)

    for _ in range(round(seconds / dt)):
        readings = SensorReadings(
            contacts=touching(controller, hill(controller.feet[:, along])), attitude=leaning(controller)
        )
        trace.step(tuple(twist), dt, readings=readings)
    trace.assert_sound(flat=False)
    return trace, hill


@pytest.mark.lengthy
@pytest.mark.parametrize("along", [0, 1])
@pytest.mark.parametrize("levelling", [None, "level", "follow"])
@pytest.mark.parametrize("slope", [0.1, -0.1])
def test_it_walks_up_and_down_hills_as_high_over_the_ground_as_before(slope, levelling, along):
    controller = WalkController(preset("strider"), Gait.named("tripod"), levelling=levelling)
    body_height = controller.body.position[2]
    trace, hill = climb(controller, slope, 25, along=along)
    excluded = controller.body.position[along]
    assert excluded > 2.5
    assert controller.body.position[2] - hill(excluded) == pytest.approx(body_height, abs=0.012)
    down = trace.contacts[-1]
    np.testing.assert_allclose(trace.feet[-1][down, 2], hill(trace.feet[-1][down, along]), atol=0.003)
    tilt = leaning(controller)
    lean = {0: -np.arctan(slope), 1: np.arctan(slope)}[along] if levelling == "follow" else 0.0
    assert tilt[1 - along] == pytest.approx(lean, abs=0.02)
    assert tilt[along] == pytest.approx(0.0, abs=0.02)


@pytest.mark.lengthy
@pytest.mark.parametrize("name", PRESETS[::2])
def test_robots_climb_where_it_follows_the_slope(name):
    controller = WalkController(preset(name), Gait.named("tripod"), levelling="follow")
    body_height = controller.body.position[2]
    climb(controller, 0.08, 25)
    assert controller.place[0] > 0.35
    assert controller.body.position[2] > body_height


def rough(name, seed, *, seconds=20.0):
    """Ground under each foot 4 mm higher or lower anew every half second, random attitudes and forces, and commands."""
    rng = np.random.default_rng(seed)
    giving = GIVING if rng.random() < 0.5 else None
    levelling = (None, "level", "follow")[seed % 3]
    controller = WalkController(preset(name), Gait.named(GAITS[seed % 4]), levelling=levelling, admittance=giving)
    trace, dt, out = Trace(controller), float(rng.choice([0.01, 0.02, 0.05])), -np.inf
    for tick in range(round(seconds / dt)):
        if tick % max(1, round(0.5 / dt)) == 0:
            way = rng.normal(size=3) * (1, 1, 3)
            twist = tuple(controller.top_speed(way) * way * rng.choice([0, 0.5, 1, 1, 2]))
            ground, attitude = rng.normal(size=6) * 0.004, tuple(rng.normal(size=2) * 0.03)
            forces = [(0.0, 0.0, force) for force in 10 + rng.normal(size=6) * 3]
            command = Command(twist=twist, gait=str(rng.choice(GAITS)) if rng.random() < 0.1 else None)
        readings = SensorReadings(contacts=touching(controller, ground), attitude=attitude, forces=forces)
        trace.step(command, dt, readings=readings)
        command = twist
        out = max(out, beyond(controller))
    broken = [what for what in trace.broken(flat=False) if giving is None or "slip" not in what]
    assert not broken, f"{name}: " + "; ".join(broken)
    return out


# Before feet stopped as gently as their joints can, stood on slopes and waited within their polygons, every other of
# these broke something: 2.2 times the acceleration of a joint, feet 6 mm beyond their polygons.
@pytest.mark.lengthy
@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("name", PRESETS)
def test_ground_that_changes_all_the_time_keeps_the_invariants(name, seed):
    # A foot that is stopped by the ground stands where it is stopped.
    assert rough(name, 100 * PRESETS.index(name) + seed) < 0.005


def test_feet_that_wait_for_others_to_find_ground_stay_within_their_polygons():
    controller = WalkController(preset("strider"), Gait.named("tripod"))
    for _ in range(100):
        controller.step((0.0, 0.0, 0.0), 0.02, readings=SensorReadings(contacts=(True,) * 6))
    twist = (controller.top_speed((1, 0, 0)), 0.0, 0.0)
    trace, modes = Trace(controller), set()
    for tick in range(1000):
        # All ground is a centimetre lower every other second.
        ground = -0.01 * (tick // 100 % 2)
        trace.step(twist, 0.02, readings=SensorReadings(contacts=touching(controller, ground)))
        modes.add(controller.walk_state)
        assert beyond(controller) < 1e-6
    trace.assert_sound(flat=False)
    assert "searching" in modes


def test_ground_out_of_reach_is_not_looked_for():
    """Without room below, the robot says so; a foot that finds no ground goes no lower than its leg reaches."""
    controller = WalkController(preset("strider"), Gait.named("tripod"))
    for _ in range(600):
        controller.step(Command(body_height=0.2), 0.02)
    trace = Trace(controller)
    for _ in range(300):
        trace.step((0.05, 0.0, 0.0), 0.02, readings=SensorReadings(contacts=touching(controller, np.full(6, -0.1))))
    trace.assert_sound(flat=False)
    assert controller.walk_state == "searching"
    assert any("no ground under" in reason for reason in map(Limitation.text, controller.limitations))


def at_an_edge(name, gait):
    """Walk until a foot hangs over a drop."""
    controller = WalkController(preset(name), Gait.named(gait))
    trace, speed = Trace(controller), 0.5 * controller.top_speed((1, 0, 0))
    tick_over_the_drop(trace, (speed, 0.0, 0.0), 900)
    assert controller.walk_state == "searching"
    assert any("no ground under" in reason for reason in map(Limitation.text, controller.limitations))
    return trace, speed


def tick_over_the_drop(trace, command, ticks):
    for _ in range(ticks):
        ground = np.where(trace.controller.feet[:, 0] > 0.35, -0.5, 0.0)
        trace.step(command, 0.02, readings=SensorReadings(contacts=touching(trace.controller, ground)))


@pytest.mark.lengthy
@pytest.mark.parametrize(("name", "gait"), list(zip(["strider", "phantomx"] * 2, GAITS, strict=True)))
def test_a_foot_over_a_drop_is_drawn_back_when_a_return_is_commanded(name, gait):
    trace, speed = at_an_edge(name, gait)
    controller, x = trace.controller, trace.controller.place[0]
    hung = controller.angles
    tick_over_the_drop(trace, (speed, 0.0, 0.0), 200)
    np.testing.assert_allclose(controller.angles, hung, atol=1e-6)
    tick_over_the_drop(trace, (-speed, 0.0, 0.0), 900)
    assert controller.place[0] < x - 0.1
    tick_over_the_drop(trace, (0.0, 0.0, 0.0), 900)
    assert controller.walk_state == "standing"
    assert controller.contacts.all()
    trace.assert_sound(flat=False)
    assert trace.margins().min() > 0


def test_the_same_stop_draws_a_foot_back_only_once():
    trace, _ = at_an_edge("strider", "tripod")
    tick_over_the_drop(trace, (0.0, 0.0, 0.0), 300)
    # Under its rest foothold there is no ground either.
    assert trace.controller.walk_state == "searching"
    hung = trace.controller.angles
    tick_over_the_drop(trace, (0.0, 0.0, 0.0), 300)
    np.testing.assert_allclose(trace.controller.angles, hung, atol=1e-6)
    trace.assert_sound(flat=False)


@pytest.mark.parametrize("levelling", [None, "level"])
@pytest.mark.parametrize("feeling", [False, True])
def test_a_leg_that_returns_to_the_gait_is_put_down_on_the_ground(levelling, feeling):
    controller = WalkController(preset("strider"), Gait.named("wave"), levelling=levelling)
    trace, twist = Trace(controller), (0.006, 0.0, 0.01)
    point = tuple(controller.feet[0] + [0.03, 0.02, 0.06])
    for tick in range(1000):
        command = {
            100: Command(twist=twist, foot_targets={0: point}),
            500: Command(twist=twist, foot_targets={0: None}),
        }.get(tick, twist)
        trace.step(command, 0.025, readings=SensorReadings(contacts=touching(controller, 0.0)) if feeling else None)
        assert tick != 499 or controller.feet[0, 2] == pytest.approx(0.06, abs=1e-3)
    assert not controller._walk.foot_targets
    trace.assert_sound(flat=False)
    assert np.abs(trace.feet[-1, :, 2][trace.contacts[-1]]).max() < 1e-4


def test_where_it_gets_too_steep_the_robot_stops_says_so_and_can_turn_back():
    controller = WalkController(preset("makeyourpet"), Gait.named("tripod"))
    speed = 0.7 * controller.top_speed((1, 0, 0))
    trace = Trace(controller)

    def hill(x):
        return 0.4 * np.maximum(x - 0.3, 0.0)

    said = set()
    for tick in range(1600):
        twist = (speed if tick < 1000 else -speed, 0.0, 0.0)
        trace.step(twist, 0.02, readings=SensorReadings(contacts=touching(controller, hill(controller.feet[:, 0]))))
        said |= (
            {reason for reason in map(Limitation.text, controller.limitations) if "too steep" in reason}
            if tick < 1000
            else set()
        )
        if tick == 999:
            x = controller.place[0]
    assert said
    assert controller.place[0] < x - 0.1
    trace.assert_sound(flat=False)


@pytest.mark.lengthy
@pytest.mark.parametrize("height", [0.015, 0.03])
@pytest.mark.parametrize("name", PRESETS)
def test_stairs(name, height):
    controller = WalkController(preset(name), Gait.named("tripod"))
    trace, speed = Trace(controller), 0.7 * controller.top_speed((1, 0, 0))
    for tick in range(700):
        stairs = height * np.floor(np.maximum(controller.feet[:, 0] - 0.1, 0) / 0.25)
        turning = 0.1 * np.sin(tick / 100)
        trace.step((speed, 0.0, turning), 0.02, readings=SensorReadings(contacts=touching(controller, stairs)))
    trace.assert_sound(flat=False)


@pytest.mark.lengthy
@pytest.mark.parametrize("name", ["strider", "mithi", "phantomx"])
@pytest.mark.parametrize("acceleration", [5.0, 20.0])
def test_slow_joints_look_for_ground_as_slowly_as_they_can(name, acceleration):
    controller = WalkController(preset(name), Gait.named("tripod"), joint_acceleration=acceleration, joint_speed=3.0)
    trace, speed, modes = Trace(controller), controller.top_speed((1, 0, 0)), set()
    for _ in range(1200):
        ground = np.where((controller.feet[:, 0] * 7).astype(int) % 2 == 1, -0.01, 0.0)
        trace.step((speed, 0.0, 0.0), 0.02, readings=SensorReadings(contacts=touching(controller, ground)))
        modes.add(controller.walk_state)
    assert "searching" in modes
    trace.assert_sound(flat=False)


def test_readings_that_are_lost_for_a_moment_put_no_foot_down_over_a_drop():
    trace, speed = at_an_edge("strider", "tripod")
    hangs = int(np.flatnonzero(~trace.controller.contacts)[0])
    for lost in (SensorReadings(contacts=None), None, SensorReadings(contacts=(None,) * 6)):
        for _ in range(20):
            trace.step((speed, 0.0, 0.0), 0.02, readings=lost)
            assert not trace.controller.contacts[hangs]
        tick_over_the_drop(trace, (speed, 0.0, 0.0), 20)
        assert not trace.controller.contacts[hangs]


def test_ground_where_it_was_expected_is_not_early():
    """Without a lift, feet touch the ground all the way: they still go all of it."""
    controller, blind = (
        WalkController(preset("strider"), Gait.named("tripod"), swing_height=0.0, cycle_time=1.5) for _ in range(2)
    )
    for _ in range(400):
        controller.step((0.05, 0.0, 0.1), 0.02, readings=SensorReadings(contacts=touching(controller, 0.0)))
        blind.step((0.05, 0.0, 0.1), 0.02)
    np.testing.assert_allclose(controller.place, blind.place, atol=5e-3)
