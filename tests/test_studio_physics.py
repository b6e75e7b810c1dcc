"""Physics in the studio: the walk and the driven robot are those of the simulation, and what goes wrong is said."""

import math
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import tarsus
from sample_studio import Asked, table
from tarsus import simulation
from tarsus.control.command import Command
from tarsus.control.robot_controller import RobotController
from tarsus.errors import SimulationError, TarsusError
from tarsus.robot.file import robot_to_dict
from tarsus.simulation.terrain import Blocks, Ramp
from tarsus.simulation.terrain.kinds import TERRAINS, terrain_parameters
from tarsus.studio.messages.client import SetPhysics
from tarsus.studio.messages.physics import PhysicsOptions, TerrainChoice
from tarsus.studio.messages.state import StudioState
from tarsus.studio.physics.terrains import chosen_terrain, terrain_message
from tarsus.studio.session import Session
from tarsus.studio.state_text import text_of

DT = 1 / 60
SHORT = {"path": {"kind": "straight", "distance_mm": 60}}


def options(kind="flat", servos="catalogue", sensors="ideal", **values):
    return {"on": True, "terrain": {"kind": kind, "values": values}, "servos": servos, "sensors": sensors}


def in_physics(view="walk", **more):
    asked = Asked()
    asked.all("view", view=view)
    asked.all("physics", physics=options(**more))
    return asked


def test_the_walk_in_physics_is_the_simulated_plan():
    asked = in_physics(kind="blocks", rise=20, clear=150)
    walk = asked("walk", "walk", walk={**SHORT, "rate_hz": 25})
    found = asked("simulate", "simulated")
    motion = tarsus.plan_walk(tarsus.load_robot("strider"), tarsus.Gait.named("tripod"), tarsus.straight_path(0.06))
    truth = simulation.compare(motion, terrain=Blocks(rise=0.02, clear=0.15))
    count, trace = len(motion.time), truth.trace
    assert (found["count"], walk["count"]) == (count, math.ceil(count / 4))
    assert table(found["position_mm"], 3) == pytest.approx(1000 * trace.body.position[:count], abs=0.006)
    assert table(found["angles_deg"], 6, 3) == pytest.approx(np.degrees(trace.angles[:count]), abs=6e-4)
    assert table(found["forces_n"], 6, 3) == pytest.approx(trace.foot_forces[:count], abs=6e-5)
    assert table(found["slip_mm_s"], 6) == pytest.approx(1000 * trace.slip_speeds[:count], abs=0.006)
    assert max(found["tilt_deg"]) == pytest.approx(math.degrees(truth.outcome.tilt), abs=0.1)
    assert [joint["peak_nm"] for joint in found["joints"]] == pytest.approx(truth.outcome.peak_torque.tolist())
    assert (found["ok"], found["problems"]) == (True, [])
    assert found["verdict"] == "completed: the robot neither fell nor stalled"
    again = asked("simulate", "simulated")
    assert again == {**found, "id": again["id"]}


def test_what_goes_wrong_is_said():
    asked = in_physics(kind="ramp", slope=59, start=-20)
    asked.all("walk", walk=SHORT)
    found = asked("simulate", "simulated")
    assert not found["ok"]
    assert found["fell_at_s"] is not None
    assert found["problems"][0] == f"fell at {found['fell_at_s']:.2f} s"
    weak = robot_to_dict(tarsus.load_robot("strider"))
    weak["leg"]["servo"] = "SG90"
    asked.all("document", document=weak)
    asked.all("physics", physics=options())
    found = asked("simulate", "simulated")
    assert any("at its maximum torque for" in problem for problem in found["problems"])
    assert any("servos at their maximum torque for up to" in problem for problem in found["problems"])
    assert "1" in "".join(found["saturated"])


@pytest.mark.parametrize("kind", TERRAINS)
def test_the_terrain_is_sent_with_the_views_that_show_it(kind):
    asked = Asked()
    sent = asked("physics", "terrain", physics=options(kind))
    choice = TerrainChoice(kind=kind)
    assert sent == terrain_message(chosen_terrain(choice), choice, id=1).model_dump()
    assert "terrain" not in asked.types("view", view="body")
    assert asked.types("view", view="drive") == ["terrain", "pose", "done"]
    assert asked.types("physics", physics={"on": False}) == ["done"]
    assert asked.types("view", view="walk") == ["walk", "done"]


def test_the_offered_terrains_have_their_parameters():
    offer = Asked()("hello", "welcome")["physics"]
    assert offer["missing"] is None
    assert [each["kind"] for each in offer["terrains"]] == list(TERRAINS)
    for each in offer["terrains"]:
        values = {parameter["name"]: parameter["default"] for parameter in each["parameters"]}
        assert chosen_terrain(TerrainChoice(kind=each["kind"], values=values)) == chosen_terrain(
            TerrainChoice(kind=each["kind"])
        )
        for parameter in each["parameters"]:
            assert parameter["least"] <= parameter["default"] <= parameter["most"]


@pytest.mark.parametrize(
    ("kind", "values", "text"),
    [
        ("stairs", {"steps": 1e5}, "steps is 100000; the studio simulates at most 100"),
        ("blocks", {"size": 80}, "the terrain has 2500 of at most 1600 blocks: use a size of at least 100 mm"),
        ("smooth", {"wavelength": 100}, "points: use longer waves or a smaller extent"),
        ("step", {"rise": 0.01}, "rise is 0.01 mm; the studio simulates 0.5 to 20000 mm"),
        ("gaps", {"count": 1.5}, "count is 1.5; it must be a whole number"),
        ("ramp", {"rise": 1}, "terrain 'ramp' has no parameter 'rise'"),
    ],
)
def test_a_terrain_that_is_refused_leaves_the_state(kind, values, text):
    asked = Asked()
    assert text in asked.error("physics", physics=options(kind, **values))["text"]


numbers = st.floats(-1e6, 1e6) | st.sampled_from([0.0, 0.5, 1.0, 100.0, 1e-300])


@given(st.sampled_from(list(TERRAINS)), st.data())
@settings(max_examples=60, deadline=None)
def test_any_terrain_is_sent_or_refused(kind, data):
    names = [parameter.name for parameter in terrain_parameters(kind)]
    values = data.draw(st.dictionaries(st.sampled_from(names), numbers))
    physics = PhysicsOptions(on=True, terrain=TerrainChoice(kind=kind, values=values))
    first, *_ = Session().handle(SetPhysics(type="physics", id=1, physics=physics))
    assert first.type == "terrain" or first.kind == "input"


def test_a_driven_robot_is_the_controller_with_the_simulated_plant():
    asked = in_physics(view="drive", kind="ramp", slope=5, start=0, sensors="hobby")
    asked.all("drive", on=True)
    asked.all("command", velocity_mm_s=[40, 0], turn_deg_s=0)
    robot = tarsus.load_robot("strider")
    controller = RobotController(robot)
    plant = simulation.SimulatedPlant(robot, terrain=Ramp(slope=math.radians(5), start=0.0), sensors="hobby")
    plant.start(controller.output)
    output = controller.output
    for _ in range(40):
        frame = asked.session.frame(DT)
        output = controller.step(Command(twist=(0.04, 0, 0)), DT, plant.step(output, DT))
        shown, state = frame.physics, plant.state
        assert table(frame.angles_deg, 3) == pytest.approx(np.degrees(output.angles), abs=6e-4)
        assert table(shown.angles_deg, 3) == pytest.approx(np.degrees(state.joint_angles), abs=6e-4)
        assert shown.position_mm == pytest.approx(1000 * state.body.position, abs=0.006)
        assert table(shown.forces_n, 3) == pytest.approx(state.foot_forces, abs=6e-5)
        contacts = state.foot_forces[:, 2] > 0.05
        assert shown.contacts == "".join(str(int(down)) for down in contacts)
        margin = tarsus.stability_margin(robot, state.joint_angles, state.body, contacts)
        assert frame.margin_mm == pytest.approx(1000 * float(margin), abs=0.006)
    assert not shown.fallen
    assert asked.session.driving


def test_a_fall_and_servos_at_their_limit_are_said_while_driving():
    asked = in_physics(view="drive", sensors="blind")
    weak = robot_to_dict(tarsus.load_robot("strider"))
    weak["leg"]["servo"] = "SG90"
    asked.all("document", document=weak)
    asked.all("drive", on=True)
    frames = [asked.session.frame(DT) for _ in range(60)]
    fell, servos = frames[-1].physics.problems
    assert frames[-1].physics.fallen
    assert fell.startswith("fell at ")
    assert fell.endswith("its body touched the ground")
    assert servos.startswith("servos at their maximum torque: front left femur, ")


def test_an_inclined_robot_has_fallen():
    asked = in_physics(view="drive", sensors="blind")
    asked.all("drive", on=True)
    asked.session.frame(DT)
    data = asked.session._live._driver._physics.plant.mj_data
    data.qpos[2:7] = (1.0, math.cos(0.5), math.sin(0.5), 0, 0)
    assert asked.session.frame(DT).physics.problems == ["fell at 0.0 s: inclined by 57 deg"]


def test_an_unstable_simulation_ends_driving_with_its_reason(monkeypatch):
    asked = in_physics(view="drive")
    asked.all("drive", on=True)

    def unstable(*_):
        raise SimulationError("the simulation became unstable")

    monkeypatch.setattr(simulation.SimulatedPlant, "step", unstable)
    assert "unstable" in asked.session.frame(DT).text
    assert not asked.session.driving


def test_other_physics_ends_driving():
    asked = in_physics(view="drive")
    asked.all("drive", on=True)
    asked.all("physics", physics=options())
    assert asked.session.driving
    asked.all("physics", physics={"on": False})
    assert not asked.session.driving
    asked.all("drive", on=True)
    assert asked.session.frame(DT).physics is None
    # Options of physics that is off are none of the driven robot's.
    asked.all("physics", physics={"on": False, "terrain": {"kind": "blocks"}})
    assert asked.session.driving


def test_a_robot_without_masses_is_not_simulated():
    asked = in_physics()
    document = robot_to_dict(tarsus.load_robot("strider"))
    del document["body"]["mass_kg"]
    asked.all("document", document=document)
    assert asked.error("simulate")["kind"] == "missing_data"
    assert asked.error("drive", on=True)["kind"] == "missing_data"


def test_without_the_engine_it_is_said_what_to_install(monkeypatch):
    missing = "the simulation needs MuJoCo; install it with: pip install 'tarsus[sim]'"

    def no_module():
        raise TarsusError(missing)

    for place in ("engine", "terrain.solids"):
        monkeypatch.setattr(f"tarsus.simulation.{place}.mujoco_module", no_module)
    asked = Asked()
    assert asked("hello", "welcome")["physics"]["missing"] == missing
    assert asked.error("physics", physics=options())["text"] == missing
    # A link from a server with physics shows the walk all the same.
    link = text_of(StudioState(physics=PhysicsOptions(on=True)))
    answers = {answer["type"]: answer for answer in asked.all("hello", state=link)}
    assert answers["error"]["text"] == missing
    assert answers["walk"]["possible"]


def test_a_walk_too_long_to_be_simulated_is_refused():
    asked = in_physics()
    asked.all("walk", walk={"path": {"kind": "straight", "distance_mm": 5000}, "rate_hz": 20})
    text = asked.error("simulate")["text"]
    assert re.fullmatch(r"the walk takes 3\d.\d s; the studio simulates at most 30 s for 6 legs: .*", text)
