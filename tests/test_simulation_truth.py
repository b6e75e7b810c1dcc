"""Plans beside physics: traces are complete, slip is that of the engine's Jacobians, falls and stalls are named."""

import dataclasses
import functools
import importlib.util
import math
import re
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray

from tarsus.control.command import Command
from tarsus.control.loop.run import run
from tarsus.control.robot_controller import RobotController
from tarsus.errors import InputError
from tarsus.gait.gait import Gait
from tarsus.gait.path import curved_path, straight_path
from tarsus.gait.plan import plan_walk
from tarsus.kinematics.mass import total_mass
from tarsus.kinematics.pose import Pose
from tarsus.load.loads import joint_loads
from tarsus.robot.file import load_robot
from tarsus.simulation import ServoModel, SimulatedPlant
from tarsus.simulation.robot_model import foot_geom_name
from tarsus.simulation.terrain import Blocks, Flat, Ramp
from tarsus.simulation.truth.as_motion import trace_motion
from tarsus.simulation.truth.comparison import compare
from tarsus.simulation.truth.outcome import Outcome
from tarsus.simulation.truth.trace import Trace, trace_to_csv, trace_to_dataset
from tarsus.simulation.truth.traced_plant import TracedPlant, play

STRIDER = load_robot("strider")
DOCS = Path(__file__).parents[1] / "docs"


@functools.cache
def walked(robot="strider", gait="tripod", servos="ideal"):
    plan = plan_walk(load_robot(robot), Gait.named(gait), straight_path(0.15), rate=100.0)
    return compare(plan, servos=servos)


def standing_still(samples=101, *, duration=1.0, **changes):
    """A made-up trace of a strider that does nothing, but for what is given."""
    level = Pose(np.broadcast_to(np.eye(3), (samples, 3, 3)), np.zeros((samples, 3)))
    joints = np.zeros((samples, 6, 3))
    values = {
        "robot": STRIDER,
        "time": np.linspace(0, duration, samples),
        "commanded_body": level,
        "commanded_angles": joints,
        "commanded_belly": np.zeros(samples, dtype=bool),
        "body": level,
        "angles": joints,
        "speeds": joints,
        "torques": joints,
        "saturated": np.zeros((samples, 6, 3), dtype=bool),
        "foot_forces": joints,
        "slip_speeds": np.zeros((samples, 6)),
        "body_touches": np.zeros(samples, dtype=bool),
    }
    return Trace(**{**values, **changes})


@pytest.mark.parametrize("robot", ["strider", "phantomx"])
def test_with_ideal_servos_a_plan_is_true(robot):
    found = walked(robot).outcome
    assert found.ok
    assert found.problems == ()
    assert found.way_ratio == pytest.approx(1.0, abs=0.02)
    assert math.isnan(found.turn_ratio)
    assert abs(found.end[2]) < math.radians(0.5)
    assert found.tilt < math.radians(1)
    assert 0 < found.sag < 0.005
    assert (found.saturated == 0).all()


def test_statics_is_shown_beside_physics():
    truth = walked()
    loads = joint_loads(truth.motion.robot, truth.motion)
    np.testing.assert_allclose(truth.planned_peak, loads.peak.max(0))
    np.testing.assert_allclose(truth.planned_rms, loads.rms.max(0))
    # Position-controlled legs press against each other sideways, which vertical forces leave out.
    assert truth.outcome.peak_torque[0] > 3 * truth.planned_peak[0]
    assert re.fullmatch(r"Truth\('strider', tripod, way 0\.99\d, no fall, no stall\)", repr(truth))
    assert any("inertia" in line for line in truth.assumed)


def test_a_turn_is_followed():
    plan = plan_walk(STRIDER, Gait.named("tripod"), curved_path(math.radians(40)), rate=100.0)
    found = compare(plan, servos="ideal").outcome
    assert found.turn_ratio == pytest.approx(1.0, abs=0.03)
    assert math.isnan(found.way_ratio)


def test_slip_is_the_speed_of_the_contact_points():
    """Against the Jacobian of each contact point, which the engine computes in another way."""
    plant = SimulatedPlant(STRIDER, terrain=Ramp(slope=0.1, start=-1.0, friction=0.05), servos="ideal", sensors="blind")
    controller = RobotController(STRIDER)
    plant.start(controller.output)
    for _ in range(30):
        plant.step(controller.output, 0.01)
    import mujoco

    mujoco.mj_forward(plant.mj_model, plant.mj_data)  # a step leaves positions and speeds of different times
    model, data, jacobian = plant.mj_model, plant.mj_data, np.empty((3, plant.mj_model.nv))
    expected = np.zeros(6)
    for leg in range(6):
        geom = model.geom(foot_geom_name(STRIDER, leg)).id
        for contact in data.contact:
            if geom in contact.geom:
                mujoco.mj_jac(model, data, jacobian, None, contact.pos, int(model.geom_bodyid[geom]))
                velocity, normal = jacobian @ data.qvel, contact.frame[:3]
                expected[leg] = np.linalg.norm(velocity - (velocity @ normal) * normal)
    assert expected.max() > 0.05
    np.testing.assert_allclose(plant.state.slip_speeds, expected, atol=1e-12)


def test_a_robot_whose_servos_are_too_weak_falls():
    weak = dataclasses.replace(ServoModel.ideal(), stall_torque=0.25)
    plan = plan_walk(STRIDER, Gait.named("tripod"), straight_path(0.1), rate=100.0)
    found = compare(plan, servos=weak).outcome
    assert not found.ok
    assert found.fell_at is not None
    assert found.problems[0] == f"fell at {found.fell_at:.2f} s"
    assert found.saturated.max() > 0.5
    assert any(
        re.search(r"(front|middle|rear) \w+ (femur|tibia): at its maximum torque for", line) for line in found.stalls
    )


def test_a_body_that_is_to_lie_has_not_fallen():
    robot = load_robot("phantomx")
    traced = TracedPlant(SimulatedPlant(robot, servos="ideal", sensors="blind"))
    commands = [(0.0, Command(state="lying")), (5.0, Command(state="standing"))]
    run(RobotController(robot), traced, commands, duration=10.0)
    trace = traced.trace
    assert trace.body_touches.any()
    assert not trace.body_touches[-1]
    assert Outcome.of(trace).ok, Outcome.of(trace).problems


def test_numbers_of_a_made_up_trace():
    speed, torque = np.zeros((101, 6, 3)), np.zeros((101, 6, 3))
    torque[:, 2, 1], speed[:, 2, 1] = 2.0, 0.5
    torque[:, 3, 1], speed[:, 3, 1] = -1.0, 0.5
    position = np.zeros((101, 3))
    position[:, 0], position[:, 1], position[:, 2] = np.linspace(0, 0.2, 101), 0.01, 0.0
    commanded = position * [2.0, 0.0, 0.0]
    slip = np.zeros((101, 6))
    slip[:, 0] = 0.06
    rotation = np.broadcast_to(np.eye(3), (101, 3, 3)).copy()
    rotation[50] = np.asarray(Pose.from_rpy(0.1).rotation)
    found = Outcome.of(
        standing_still(
            torques=torque,
            speeds=speed,
            slip_speeds=slip,
            body=Pose(rotation, position),
            commanded_body=Pose(np.broadcast_to(np.eye(3), (101, 3, 3)), commanded),
        )
    )
    assert found.energy == pytest.approx(1.0)
    weight = float(total_mass(STRIDER)) * 9.80665
    assert found.cost_of_transport == pytest.approx(1.0 / (weight * 0.2))
    assert found.peak_torque == pytest.approx([0, 2, 0])
    assert found.rms_torque == pytest.approx([0, 2, 0])
    assert found.slip == pytest.approx(0.01)
    assert found.tilt == pytest.approx(0.1)
    assert found.way_ratio == pytest.approx(0.5)
    assert found.deviation == pytest.approx(0.2)
    assert found.end == pytest.approx((0.2, 0.0, 0.0))
    assert found.ok


def test_less_than_half_of_the_way_is_a_stall():
    path = np.zeros((101, 3))
    path[:, 0] = np.linspace(0, 0.4, 101)
    level = np.broadcast_to(np.eye(3), (101, 3, 3))
    found = Outcome.of(standing_still(commanded_body=Pose(level, path), body=Pose(level, 0.25 * path)))
    assert found.stalls == ("covered 100 mm of 400 mm",)
    assert found.fell_at is None


def test_a_robot_on_its_side_has_fallen():
    rotation = np.broadcast_to(np.eye(3), (101, 3, 3)).copy()
    rotation[60:] = np.asarray(Pose.from_rpy(1.0).rotation)
    found = Outcome.of(standing_still(body=Pose(rotation, np.zeros((101, 3)))))
    assert found.fell_at == pytest.approx(0.6)
    assert found.cost_of_transport == math.inf


def test_the_table_has_everything(tmp_path):
    trace = walked().trace
    trace_to_csv(trace, tmp_path / "trace.csv")
    table = np.genfromtxt(tmp_path / "trace.csv", delimiter=",", names=True)
    assert len(table) == len(trace.time)
    np.testing.assert_allclose(table["LF_femur_torque_nm"], trace.torques[:, 0, 1], atol=1e-5, rtol=1e-5)
    np.testing.assert_allclose(table["body_x_mm"], 1000 * trace.body.position[:, 0], atol=1e-5, rtol=1e-5)
    np.testing.assert_allclose(np.radians(table["RR_tibia_commanded_deg"]), trace.commanded_angles[:, 5 - 2, 2], atol=9)
    with pytest.raises(InputError, match="can't be written: No such file"):
        trace_to_csv(trace, tmp_path / "missing" / "trace.csv")


def test_the_data_set_has_everything(tmp_path):
    trace = walked().trace
    data = trace_to_dataset(trace)
    assert data.torques.sel(leg="LF", joint="femur").values == pytest.approx(trace.torques[:, 0, 1])
    assert data.torques.attrs["units"] == "N m"
    assert data.body_position.shape == (len(trace.time), 3)
    assert data.attrs["robot"] == "strider"
    data.to_zarr(tmp_path / "trace", zarr_format=3, consolidated=False)
    xarray.testing.assert_identical(xarray.open_zarr(tmp_path / "trace", chunks=None, consolidated=False).load(), data)


def test_without_xarray_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(InputError, match=r"tarsus\[data\]"):
        trace_to_dataset(walked().trace)


def test_a_trace_is_drawn_as_a_motion():
    truth = walked()
    motion = trace_motion(truth.trace, truth.motion)
    assert motion.feet[..., 2].min() == pytest.approx(0.008, abs=0.002)
    assert (motion.contacts.sum(1) >= 3).mean() > 0.95
    assert repr(truth.trace) == f"Trace('strider', {len(truth.trace.time)} samples, {truth.trace.time[-1]:.2f} s)"


def test_a_plant_keeps_its_trace_from_its_start_on():
    plant = TracedPlant(SimulatedPlant(STRIDER, terrain=Blocks(rise=0.01, seed=2), sensors="hobby", seed=3))
    with pytest.raises(InputError, match="not been started"):
        _ = plant.trace
    controller = RobotController(STRIDER)
    plant.start(controller.output)
    readings = plant.step(controller.output, 0.01)
    assert readings.contacts is not None
    assert len(plant.trace.time) == 2
    plant.stop()
    plant.start(controller.output)
    assert len(plant.trace.time) == 1


def test_a_motion_of_another_robot_is_refused():
    plan = plan_walk(STRIDER, Gait.named("tripod"), straight_path(0.1))
    with pytest.raises(InputError, match=r"the plant is 'phantomx', the motion is for 'strider'; .*but links or mount"):
        play(plan, SimulatedPlant(load_robot("phantomx")))


def test_terrain_and_seed_reach_the_plant():
    plan = plan_walk(STRIDER, Gait.named("tripod"), straight_path(0.1), rate=100.0)
    rough = compare(plan, terrain=Blocks(rise=0.02, clear=0.2, seed=1), servos="ideal")
    flat = compare(plan, terrain=Flat(friction=0.8), servos="ideal")
    assert rough.outcome.tilt > 2 * flat.outcome.tilt


def docs_module(name):
    spec = importlib.util.spec_from_file_location(name, DOCS / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def table_on_the_page(name):
    text = (DOCS / "how-true.md").read_text(encoding="utf-8")
    return text.partition(f"<!-- table: {name} -->\n")[2].partition("<!-- end -->")[0]


def assert_reproduced(row, table):
    """Contacts amplify the rounding of the machine: numbers may differ by 3 %, or by one in their last digit."""
    (line,) = (line for line in table.splitlines() if line.split("|")[1:3] == row.split("|")[1:3])
    number = re.compile(r"-?\d+(?:\.(\d+))?")
    assert number.sub("#", row.rstrip()) == number.sub("#", line)
    for found, printed in zip(number.finditer(row), number.finditer(line), strict=True):
        last_digit = 10.0 ** -len(printed[1] or "")
        tolerance = max(0.03 * abs(float(printed[0])), 1.01 * last_digit)
        assert float(found[0]) == pytest.approx(float(printed[0]), abs=tolerance), (row, line)


@pytest.mark.parametrize(("servos", "gait"), [("ideal", "tripod"), ("catalogue", "ripple")])
def test_the_pages_rows_are_reproduced(servos, gait):
    assert_reproduced(docs_module("how_true").row(STRIDER, gait, servos), table_on_the_page(servos))


@pytest.mark.no_cover
def test_the_pages_live_walk_is_reproduced():
    assert_reproduced(docs_module("how_true").live_row(STRIDER, "tripod"), table_on_the_page("live"))


@pytest.mark.no_cover
def test_the_pages_live_walk_on_soft_servos_is_reproduced():
    assert_reproduced(docs_module("how_true").soft_row(STRIDER, "tripod"), table_on_the_page("soft"))


@pytest.mark.no_cover
@pytest.mark.parametrize(
    ("robot", "fault"),
    [("strider", "one servo dead (middle left femur)"), ("phantomx", "push of half the weight for 0.2 s")],
)
def test_the_pages_faults_are_reproduced(robot, fault):
    assert_reproduced(docs_module("faults").fault_row(robot, fault), table_on_the_page("faults"))


@pytest.mark.no_cover
def test_the_pages_changes_of_state_are_reproduced():
    assert_reproduced(docs_module("faults").state_row("strider", "catalogue"), table_on_the_page("states"))


def test_the_pages_example_runs(capsys):
    examples = re.findall(r"```python\n(.*?)```", (DOCS / "simulation.md").read_text(), flags=re.DOTALL)
    (example,) = (text for text in examples if "compare" in text)
    exec(compile(example, "example", "exec"), {})
    assert "xarray.DataArray" in capsys.readouterr().out
