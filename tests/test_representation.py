"""How values print: every public value fits a terminal, tells what matters, and has HTML for notebooks."""

import inspect
from collections import deque
from dataclasses import dataclass
from enum import Enum
from functools import cache
from xml.etree import ElementTree as ET

import jax
import numpy as np
import pytest

import tarsus
from sample_loads import sample_loads, sample_motion
from sample_robots import hexapod
from tarsus import hardware, simulation, urdf
from tarsus.export import to_urdf
from tarsus.representation import represented
from tarsus.simulation import environment, terrain

PUBLIC = (tarsus, simulation, terrain, environment, hardware, urdf)
LINES, WIDTH = 10, 100


def public_classes():
    for package in PUBLIC:
        for name in package.__all__:
            value = getattr(package, name)
            if inspect.isclass(value) and not issubclass(value, BaseException | Enum):
                yield value


# Protocols have no values of their own.
CLASSES = sorted({c for c in public_classes() if not getattr(c, "_is_protocol", False)}, key=lambda c: c.__name__)


@cache
def values():
    """One value of each public class, or several: as large as users have them."""
    return [
        *static_values(),
        *load_values(),
        *control_values(),
        *simulation_values(),
        *environment_values(),
        *hardware_values(),
        *calibration_values(),
    ]


@cache
def designs(count=100):
    robot = tarsus.load_robot("strider")
    return tarsus.stack_robots([robot.replace(femur=robot.femur * scale) for scale in np.linspace(0.6, 1.4, count)])


def static_values():
    robot, motion = tarsus.load_robot("strider"), sample_motion()
    stance = tarsus.default_stance(robot)
    yield from (robot, designs(), *robot.sources, robot.gait, tarsus.load_servo("DS3225"))
    yield from (tarsus.Pose(), motion.body, tarsus.straight_path(1.0), tarsus.Gait.named("tripod"), motion)
    yield from (tarsus.inverse_kinematics(robot, stance), tarsus.inverse_kinematics(designs(), stance * 9))
    heavy = tarsus.plausibility_warnings(robot.replace(body_mass=np.array(1386.0)))
    yield from (*tarsus.FIRMWARE.values(), *tarsus.try_gaits(robot), *heavy)
    yield from (tarsus.resting_pose(robot, motion.angles[0]), tarsus.power_off_order(robot, tarsus.folded_pose(robot)))


def load_values():
    robot, motion, loads = tarsus.load_robot("strider"), sample_motion(), sample_loads()
    yield from (loads, tarsus.supply_load(loads), tarsus.Payload(0.5))
    compliant = tarsus.compliant_loads(robot, motion)
    yield from (compliant, compliant.springs, compliant.contact)
    sizing = tarsus.size_servos(robot, loads)
    yield from (sizing, sizing.verdicts[0])
    yield tarsus.WalkChange(text="wave gait", options={"gait": motion.gait}, factor=2.0, thermal_ratio=1.5)
    yield tarsus.contact_forces(robot, motion.angles, motion.body, motion.contacts)
    yield from (tarsus.motion_torques(robot, motion), tarsus.handbook(robot), tarsus.compare_with_statics(robot))
    yield tarsus.cycle_torques(designs(), tarsus.Gait.named("tripod"), stroke=0.03, phases=8)


def calibration_values():
    robot = tarsus.load_robot("strider")
    yield from (hardware.BUS_COMMANDS["feetech-sts"], hardware.new_calibration(robot, "strider"))
    yield from (calibration := hardware.nominal_calibration(robot, "strider"), *calibration.buses)
    yield from (calibration.joints[0][0], hardware.SupplySettings(voltage=7.4, least_voltage=6.0))
    bus, _ = hardware.emulated_bus("servo2040", range(18))
    recorded = []
    plant = hardware.ServoPlant(
        robot, calibration, buses={"main": bus}, clock=hardware.ManualClock(), observer=recorded.append
    )
    plant.start(tarsus.RobotController(robot).output)
    line = hardware.MemoryTransport(hardware.emulate("servo2040", range(18)))
    yield hardware.AttitudeLine(hardware.Mounting(port="COM3"), line)
    yield from (plant, plant.timing, plant.settings, recorded[0])
    yield hardware.ServoFault(kind=hardware.FaultKind.STUCK, text="it stands still", joint="front left femur")
    yield from (hardware.FootSwitches(bus="main", inputs=(0, 1, 2, 3, 4, None)), hardware.Mounting(port="COM3"))


def control_values():
    robot, motion = tarsus.load_robot("strider"), sample_motion()
    controller, guard, sequence = tarsus.RobotController(robot), tarsus.Guard(robot), tarsus.sit_down(robot)
    guard.check(motion.angles[0], 0.02)
    jump = guard.check(motion.angles[0] + 1, 0.02)
    walk = tarsus.Command(twist=(9, 0, 0), foot_targets={0: tarsus.default_stance(robot)[0]})
    too_fast = controller.step(walk, 0.02)
    timeline = "; ".join(f"at {i / 100} s: walk 0.06 m/s" for i in range(40))
    scenario = tarsus.scenario_from_text(timeline, robot="strider")
    yield from (controller, guard, guard.bounds, jump, *jump.interventions, too_fast, *too_fast.limitations, walk)
    yield from (sequence, tarsus.SequencePlayer(sequence), tarsus.WalkController(robot), tarsus.IdealPlant(robot))
    yield tarsus.CompensatedPlant(tarsus.IdealPlant(robot))
    yield from (tarsus.SensorReadings(contacts=[True] * 6), tarsus.Admittance(mass=1.0, damping=40.0, stiffness=400.0))
    yield from (tarsus.GroundAdaptation(swing_height=0.03), tarsus.GroundHeights(heights=np.zeros((3, 3))))
    yield from (scenario, tarsus.run_scenario(scenario))


def hardware_values():
    bus, line = hardware.emulated_bus("feetech-sts", range(1, 19))
    yield from (line, line.servos[1], line.servos[1].traits, line.supply, line.faults, hardware.BUSES["feetech-sts"])
    yield from (bus.capabilities, bus.ping(1), bus.timing(range(1, 19)), bus.read_positions(range(1, 19)))
    yield from (bus.read_telemetry((1,)).values[1], hardware.ManualClock(), hardware.SystemClock())
    yield from (hardware.MemoryTransport(line), hardware.EmulatedLine({}, baud=9600))
    yield hardware.MemoryI2c(hardware.emulate("pca9685", range(18)))
    with hardware.PtyServer(line) as server:
        yield server
        yield hardware.SerialTransport(server.port, 1_000_000)


def simulation_values():
    robot = tarsus.load_robot("strider")
    plant = simulation.SimulatedPlant(robot, servos="ideal")
    traced = simulation.TracedPlant(plant)
    traced.start(tarsus.RobotController(robot).output)
    yield from (traced, plant, plant.state, plant.servos[0][0], urdf.urdf_robot(to_urdf(robot)))
    short = tarsus.plan_walk(robot, tarsus.Gait.named("tripod"), tarsus.straight_path(0.02), stroke=0.02, rate=50)
    truth = simulation.compare(short, servos="ideal")
    yield from (truth, truth.trace, truth.outcome)
    yield from (simulation.SensorSuite(), simulation.Sensor(), simulation.FootSwitch())
    yield from (terrain.Blocks(), terrain.Flat(), terrain.Gaps(), terrain.Ramp(slope=0.1), terrain.Smooth())
    yield from (terrain.Box(), terrain.Stairs(rise=0.02), terrain.Step(rise=0.02))
    yield terrain.HeightField(heights=np.eye(50), size=(1.0, 1.0))


def environment_values():
    env = environment.WalkEnv("strider", actions="joint", sensors="blind")
    policy = environment.ScriptedPolicy(env)
    yield from (env, env.motion, env.curriculum, policy, environment.WalkVectorEnv(1, threads=1))
    yield from (environment.CommandSampler(), environment.DomainRandomisation(), environment.RewardWeights())
    yield environment.Evaluation(episodes=1, reward=1.0, error=0.1, falls=0.0, reward_terms={"velocity": 1.0})


def reachable(start):
    """The values, and the values of the project that they and their parts hold, one of each class and size."""
    waiting, seen = deque(start), set()
    while waiting:
        value = waiting.popleft()
        text = repr(value)
        if (type(value), text) in seen:
            continue
        seen.add((type(value), text))
        yield value
        names = getattr(value, "__dataclass_fields__", None) or getattr(type(value), "_fields", ())
        for name in [*names, *(n for n, p in inspect.getmembers(type(value)) if isinstance(p, property))]:
            part = getattr(value, name)
            parts = [*part.values()] if isinstance(part, dict) else [*part] if isinstance(part, tuple) else [part]
            waiting.extend(p for p in parts if type(p).__module__.startswith("tarsus.") and not isinstance(p, Enum))


def test_there_is_a_value_of_every_public_class():
    assert {type(value) for value in values()} >= set(CLASSES)


def test_every_public_value_and_its_parts_fit_a_terminal():
    too_large = {}
    for value in reachable(values()):
        lines = repr(value).splitlines()
        if len(lines) > LINES or max(map(len, lines)) > WIDTH:
            too_large[type(value).__name__] = (len(lines), max(map(len, lines)))
        if " object at 0x" in repr(value):
            too_large[type(value).__name__] = repr(value)
    assert too_large == {}


@pytest.mark.parametrize(
    ("number", "expected"),
    [
        (0, ("strider", "0.068 m", "1.386 kg", "(6, 3, 2)")),
        (1, ("batch_shape=(100,)", "0.0588 to 0.1372 m, shape (100, 6)")),
    ],
)
def test_a_robot_tells_its_size_and_its_mass(number, expected):
    text = repr([value for value in values() if isinstance(value, tarsus.Robot)][number])
    assert [part for part in expected if part not in text] == []


def test_a_motion_tells_whether_it_is_possible_and_how_stable_it_is():
    motion, text = sample_motion(), repr(sample_motion())
    assert text.startswith("Motion(robot=<Robot 'strider'>, gait=<Gait 'tripod'>, ok=True, steps=")
    assert f"margin={motion.margin.min():.4g} to {motion.margin.max():.4g} m, shape ({motion.time.size},)" in text


def test_a_value_that_knows_nothing_is_its_name():
    assert repr(tarsus.SensorReadings(age=float("nan"))) == "SensorReadings()"


def test_units_are_those_of_the_docstring():
    @represented()
    class Sample(tuple):
        """A sample.

        Attributes
        ----------
        time : float
            Time in [0, 1) of the start [s].
        length, mass : float
            Length [m], mass [kg].
        pose : tuple
            x, y [m] and yaw [rad].
        count : int
            A number.
        """

        __slots__ = ()
        _fields = ("time", "length", "mass", "pose", "count", "missing", "bound")
        time, length, mass, pose, count, missing, bound = 1.5, 2.0, 3.0, (1, 2, 3), 7, None, np.nan

    assert repr(Sample()) == "Sample(time=1.5 s, length=2 m, mass=3 kg, pose=(1, 2, 3), count=7)"


@pytest.mark.parametrize(
    ("array", "text"),
    [
        (np.full(9, np.nan), "nan, shape (9,)"),
        (np.array([*range(9), np.inf]), "0 to 8 N m, 1 not finite, shape (10,)"),
        (np.array([1.0, -2.5]), "[ 1. , -2.5] N m"),
        (np.full(4, 0.1), "0.1 N m, shape (4,)"),
        (np.arange(9) > 3, "5 of 9 True, shape (9,)"),
        (np.array([True, False]), "[ True, False] N m"),
        (np.zeros((0, 3)), "[] N m"),
    ],
)
def test_arrays_appear_as_numbers_or_as_their_range_and_shape(array, text):
    @represented()
    @dataclass
    class Sample:
        """A sample.

        Attributes
        ----------
        torques : array
            Torques [N m].
        """

        torques: np.ndarray

    assert repr(Sample(array)) == f"Sample(torques={text})"


def test_traced_arrays_appear_as_their_type_and_shape():
    seen = []

    def angles(feet):
        solution = tarsus.inverse_kinematics(hexapod(), feet)
        seen.extend([repr(solution), solution._repr_html_(), repr(hexapod().replace(femur=feet[..., 0]))])
        return solution.angles

    jax.jit(angles)(np.asarray(tarsus.default_stance(hexapod())))
    assert "angles=float64 shape (6, 3)" in seen[0]
    assert "float64 shape (6, 3)" in seen[1]
    assert "femur=float64 shape (6,)" in seen[2]


def html_tables(value):
    """The tables of a value's HTML, as rows of texts."""
    root = ET.fromstring(f"<div>{value._repr_html_()}</div>")
    assert root.findtext("b") == type(value).__name__
    return [[["".join(cell.itertext()) for cell in row] for row in table.iter("tr")] for table in root.iter("table")]


def test_every_public_value_with_its_own_text_has_html_tables_for_notebooks():
    shown = [value for value in values() if hasattr(value, "_repr_html_")]
    assert {type(value).__name__ for value in shown} >= {"Robot", "Motion", "IKSolution", "JointLoads", "CycleTorques"}
    for value in shown:
        for table in html_tables(value):
            assert len({len(row) for row in table}) == 1
            assert len(table) > 1


@pytest.mark.parametrize("kind", [tarsus.Robot, tarsus.Motion, tarsus.IKSolution, tarsus.JointLoads])
def test_the_important_values_have_a_row_for_each_leg(kind):
    value = next(value for value in values() if isinstance(value, kind))
    rows = html_tables(value)[1]
    assert [row[0] for row in rows[1:]] == list(tarsus.load_robot("strider").leg_names)


def test_the_numbers_of_a_batch_are_summed_up():
    torques = next(value for value in values() if isinstance(value, tarsus.CycleTorques))
    rows = html_tables(torques)[1]
    np.testing.assert_allclose([float(row[1]) for row in rows[1:]], np.asarray(torques.peak).min(0), atol=6e-4)
    batch = [value for value in values() if isinstance(value, tarsus.Robot | tarsus.IKSolution)]
    assert sorted(len(html_tables(value)) for value in batch) == [1, 1, 2, 2]


def test_texts_are_escaped():
    assert "&lt;b&gt;" in hexapod(name="<b>")._repr_html_()
