"""Servo models: torque law, timing of commands, and what is assumed."""

import math
import re

import mujoco
import numpy as np
import pytest

from sample_robots import scaled
from tarsus.control.robot_controller import RobotController
from tarsus.errors import InputError, MissingDataError, UnknownNameError
from tarsus.load.servo_limits import utilisation
from tarsus.robot.catalogue import list_servos, load_servo
from tarsus.robot.file import list_robots, load_robot
from tarsus.robot.known_servos import KNOWN_SERVOS
from tarsus.robot.servo import Servo
from tarsus.simulation import ServoModel, SimulatedPlant, model
from tarsus.simulation.servos.command_timing import CommandTiming
from tarsus.simulation.servos.servo_table import ServoTable

STRIDER = load_robot("strider")
DS3225 = ServoModel.of(load_servo("DS3225"))


@pytest.mark.parametrize("name", list_servos())
def test_every_servo_of_the_catalogue_has_a_model_that_lists_what_it_assumes(name):
    servo = load_servo(name)
    found = ServoModel.of(servo)
    assert found.name == name
    assert found.stall_torque == servo.stall_torque
    assert found.no_load_speed == (servo.no_load_speed or 5.0)
    assert 1 < found.stiffness < 80
    text = "\n".join(found.assumed)
    for word in (
        "control stiffness",
        "gear stiffness",
        "rotor inertia",
        "backlash",
        "dead band",
        "delay",
        "update rate",
    ):
        assert f"{name}: {word}" in text
    assert ("no-load speed" in text) == (servo.no_load_speed is None)


def test_small_servos_have_less_inertia_than_large_ones():
    inertia = {name: ServoModel.of(load_servo(name)).rotor_inertia for name in ("DS3225", "SG90")}
    assert inertia == {"DS3225": 0.005, "SG90": pytest.approx(0.035 * 0.147 / 8.73, rel=0.01)}


@pytest.mark.parametrize("supply", [4.0, 12.0])
def test_the_assumed_inertia_does_not_depend_on_the_supply(supply):
    servo = Servo(name="mine", stall_torque=0.12, torque_at=7.4, no_load_speed=7.0, speed_at=7.4)
    found = ServoModel.of(servo, supply=supply)
    assert found.rotor_inertia == pytest.approx(0.035 * 0.12 / 7.0)


@pytest.mark.parametrize("name", KNOWN_SERVOS)
def test_figures_that_are_known_are_used_and_name_their_source(name):
    known, found = KNOWN_SERVOS[name], ServoModel.of(load_servo(name))
    figures = {k: v for k, v in known._asdict().items() if k != "source" and v is not None}
    assert {k: getattr(found, k) for k in figures} == figures
    assert sum(known.source in line for line in found.assumed) == len(figures)


@pytest.mark.parametrize("name", list_servos())
def test_a_servo_never_exceeds_its_torque_speed_line(name):
    servo = ServoModel.of(load_servo(name))
    error, speed = np.meshgrid(np.linspace(-1, 1, 41), np.linspace(-1, 1, 41) * servo.no_load_speed)
    torque = servo.torque(error, speed)
    used = utilisation(torque, speed, np.array(servo.stall_torque), np.array(servo.no_load_speed))
    assert used.max() == pytest.approx(1.0)
    assert np.abs(torque).max() == pytest.approx(servo.stall_torque)


def test_beyond_its_no_load_speed_a_servo_brakes():
    torque = DS3225.torque(np.array([1.0, 1.0]), np.array([1.0, 1.5]) * DS3225.no_load_speed)
    assert torque == pytest.approx([0.0, -0.5 * DS3225.stall_torque])


def test_stiffness_is_that_of_control_and_gears_in_series_beyond_the_backlash():
    servo = ServoModel(
        name="soft", control_stiffness=30.0, gear_stiffness=60.0, backlash=0.02, damping=0.5, stall_torque=3.0
    )
    assert servo.stiffness == pytest.approx(20.0)
    assert servo.torque(np.array([-0.01, 0.005, 0.01, 0.06]), np.zeros(4)) == pytest.approx([0, 0, 0, 1.0])
    assert servo.torque(np.array([0.06, 1.0]), np.full(2, 2.0)) == pytest.approx([0.0, 2.0])
    assert servo.torque_speed_slope == 0


def test_an_ideal_servo_is_a_spring_and_a_damper():
    servo = ServoModel.ideal(stiffness=60.0, damping=2.0)
    assert servo.torque(np.array([0.5, -3.0]), np.array([1.0, 2.0])) == pytest.approx([28.0, -184.0])
    assert "60 N m/rad" in servo.assumed[0]


@pytest.mark.parametrize("name", [name for name in list_robots() if load_robot(name).has_masses])
def test_ideal_servos_are_those_of_the_robots_weight_and_size(name):
    robot = load_robot(name)
    assert ServoModel.ideal(robot) == ServoModel.ideal()
    small, large = (ServoModel.ideal(scaled(robot, by)) for by in (0.3, 3.0))
    assert small.stiffness < 10 < 100 < 1000 < large.stiffness
    for servo in (small, large):
        assert servo.damping == pytest.approx(servo.stiffness / 100)
    # The square of the time constant is in proportion to the length, as that of a body that tips.
    for servo, by in ((small, 0.3), (large, 3.0)):
        assert 0.5 * by < servo.rotor_inertia / servo.stiffness / (0.005 / 100) < 2 * by
    assert ServoModel.ideal(robot.replace(body_mass=None)) == ServoModel.ideal()


@pytest.mark.no_cover
@pytest.mark.parametrize("by", [0.4, 2.5])
def test_in_physics_ideal_servos_carry_robots_of_any_size(by):
    robot = scaled(STRIDER, by)
    plant, controller = SimulatedPlant(robot, servos="ideal", sensors="blind"), RobotController(robot)
    plant.start(controller.output)
    for _ in range(200):
        controller.step((0.2 * by, 0.0, 0.0), 0.01, plant.step(controller.output, 0.01))
    body, commanded = plant.state.body.position, controller.output.body.position
    assert body[2] == pytest.approx(commanded[2] + by * STRIDER.foot_radius[0], abs=0.003 * by)
    assert body[0] == pytest.approx(commanded[0], rel=0.06)


def test_the_supply_scales_torque_and_speed():
    found = ServoModel.of(load_servo("DS3225"), supply=6.0)
    assert found.stall_torque == pytest.approx(2.452 * 6.0 / 6.8)
    assert found.no_load_speed == pytest.approx(8.06 * 6.0 / 6.8)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"stall_torque": 0.0}, "stall_torque is 0 N m; it must be greater than 0"),
        ({"no_load_speed": math.nan}, "no_load_speed is nan rad/s"),
        ({"control_stiffness": math.inf}, "control_stiffness is inf N m/rad; it must be a finite number"),
        ({"gear_stiffness": -1.0}, "gear_stiffness is -1 N m/rad"),
        ({"update_rate": 0.0}, "update_rate is 0 1/s"),
        ({"damping": -1.0}, "damping is -1 N m s/rad; it must be a finite number, not negative"),
        ({"delay": math.inf}, "delay is inf s"),
        ({"backlash": math.nan}, "backlash is nan rad"),
    ],
)
def test_a_servo_that_cannot_be_is_refused(change, message):
    with pytest.raises(InputError, match=re.escape(f"test: {message}")):
        ServoModel(name="test", **change)


def test_servos_are_given_by_name_as_one_or_for_each_joint():
    assert ServoTable.of(STRIDER, "catalogue").servos == ((DS3225,) * 3,) * 6
    assert ServoTable.of(STRIDER, "ideal").servos == ((ServoModel.ideal(),) * 3,) * 6
    assert ServoTable.of(STRIDER, DS3225).servos == ((DS3225,) * 3,) * 6
    mixed = [[DS3225, ServoModel.ideal(), DS3225]] * 6
    table = ServoTable.of(STRIDER, mixed)
    assert table.servos == tuple(tuple(row) for row in mixed)
    assert table.assumed == (*DS3225.assumed, *ServoModel.ideal().assumed)


@pytest.mark.parametrize(
    "servo", [DS3225, ServoModel.ideal(), ServoModel(name="damped", stall_torque=2.0, backlash=0.05)]
)
def test_the_engine_computes_the_torque_of_the_model(servo):
    robot, built = STRIDER, model(STRIDER, servos=servo).compile()
    state, random = mujoco.MjData(built), np.random.default_rng(1)
    # Small and large errors and speeds, so that all limits are reached: driving, braking, beyond the no-load speed.
    for scale in (0.005, 0.1, 1.0):
        error, speed = random.normal(0, scale, (40, 18)), random.normal(0, 10 * scale, (40, 18))
        for wrong, fast in zip(error, speed, strict=True):
            state.qpos[2], state.qpos[7:], state.qvel[6:] = 1.0, random.normal(0, 0.3, 18), fast
            state.ctrl[:] = np.repeat(state.qpos[7:] + wrong, 3)
            mujoco.mj_forward(built, state)
            torque = state.qfrc_actuator[6:] + state.qfrc_damper[6:]
            expected = servo.torque(wrong, fast)
            # The damping beyond the line is no torque of the motor, and not limited with it.
            assert torque == pytest.approx(expected, abs=1e-9 * (1 + np.abs(expected).max()))
    assert [built.joint(i + 1).name for i in range(18)] == [
        built.actuator(3 * i).name.removesuffix(" forward") for i in range(3 * robot.legs)
    ]


@pytest.mark.parametrize("servos", [3, [DS3225] * 6, [[DS3225] * 3] * 5, [[DS3225, DS3225, "ideal"]] * 6])
def test_servos_that_are_something_else_are_refused(servos):
    with pytest.raises((InputError, TypeError)):
        ServoTable.of(STRIDER, servos)


def test_unknown_servos_are_refused():
    with pytest.raises(UnknownNameError, match="Did you mean 'ideal'"):
        ServoTable.of(STRIDER, "ideel")
    unknown = STRIDER.replace(servos=((load_servo("DS3225"),) * 3,) * 5 + ((load_servo("DS3225"), None, None),))
    with pytest.raises(MissingDataError, match=r"leg front right: the servo of the femur is unknown"):
        ServoTable.of(unknown, "catalogue")
    with pytest.raises(MissingDataError, match=r"DS3225 is rated for 4.8 to 6.8 V; .* at the supply of 12 V"):
        ServoModel.of(load_servo("DS3225"), supply=12.0)
    with pytest.raises(MissingDataError, match="a joint has no servo"):
        ServoModel.of(None)


def targets(servo, commands, steps):
    """Targets of one joint for commands at some steps."""
    table = ServoTable.of(STRIDER, servo)
    timing, found = CommandTiming(table, 0.002, np.zeros(18)), []
    for step in range(steps):
        if step in commands:
            timing.command(step, np.full(18, commands[step]))
        found.append(timing.advance(step)[7])
    return np.array(found)


def test_a_command_acts_at_once_without_delay():
    assert targets(ServoModel.ideal(), {0: 0.1, 3: 0.3}, 6) == pytest.approx([0.1, 0.1, 0.1, 0.3, 0.3, 0.3])


def test_a_command_is_taken_over_at_the_update_and_acts_after_the_delay():
    # Updates every 5 steps, delay of 2: the command of step 1 is replaced before it is taken over at step 5.
    servo = ServoModel(name="slow", update_rate=100.0, delay=0.004)
    found = targets(servo, {0: 0.1, 1: 0.2, 4: 0.3, 6: 0.5}, 14)
    assert found == pytest.approx([0, 0, *[0.1] * 5, *[0.3] * 5, 0.5, 0.5])


def test_the_dead_band_holds_the_target_until_the_command_leaves_it():
    servo = ServoModel(name="lazy", dead_band=0.02)
    assert targets(servo, {0: 0.005, 1: 0.02, 2: 0.015, 3: -0.1}, 4) == pytest.approx([0, 0.01, 0.01, -0.09])


def test_servos_with_different_timing_in_one_robot():
    slow = ServoModel(name="slow", delay=0.004)
    timing = CommandTiming(ServoTable.of(STRIDER, [[slow, DS3225, ServoModel.ideal()]] * 6), 0.002, np.zeros(18))
    timing.command(0, np.full(18, 0.5))
    rows = np.array([timing.advance(step).copy()[:3] for step in range(3)])
    assert rows[:, 0] == pytest.approx([0, 0, 0.5])
    assert rows[:, 1] == pytest.approx([0, 0, 0.5 - DS3225.dead_band / 2])
    assert rows[:, 2] == pytest.approx([0.5, 0.5, 0.5])


def test_the_next_change_of_a_target_is_known():
    slow = ServoModel(name="slow", delay=0.004, update_rate=100.0)
    timing = CommandTiming(ServoTable.of(STRIDER, [[slow, DS3225, ServoModel.ideal()]] * 6), 0.002, np.zeros(18))
    timing.command(1, np.full(18, 0.5))
    found, steps = [], 0
    while steps < 20:
        timing.advance(steps)
        steps = timing.next_change(steps, 20)
        found.append(steps)
    assert found == [1, 7, 12, 20]


def test_a_servo_of_ones_own_has_a_model():
    found = ServoModel.of(Servo(name="mine", stall_torque=1.0, control="bus"))
    assert found.update_rate == 100.0
    assert "mine: no-load speed 5 rad/s" in found.assumed


def test_a_small_robot_walks_with_small_servos():
    robot = load_robot("mithi").replace(body_mass=0.45, link_mass=np.tile((0.02, 0.02, 0.01), (6, 1)))
    plant = SimulatedPlant(robot, servos=ServoModel.of(load_servo("MG90S")))
    controller = RobotController(robot)
    output, tilts = controller.output, []
    plant.start(output)
    for _ in range(200):
        output = controller.step((0.04, 0, 0), 0.01, plant.step(output, 0.01))
        tilts.append(np.hypot(*plant.state.body.rpy[:2]))
    assert np.degrees(np.max(tilts)) < 2.0
