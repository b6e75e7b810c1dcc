"""docs/other-simulators.md: its loop walks in MuJoCo without `tarsus.simulation`, whatever the model's conventions."""

import contextlib
import dataclasses
import io
import re
from pathlib import Path

import mujoco
import numpy as np
import pytest

import tarsus
from tarsus.export import to_mjcf

PAGE = (Path(__file__).parents[1] / "docs" / "other-simulators.md").read_text(encoding="utf-8")
(EXAMPLE,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
STRIDER = tarsus.load_robot("strider")
MJCF = to_mjcf(STRIDER)
FORWARD = tarsus.Command(twist=(0.1, 0.0, 0.0))


def example(code=EXAMPLE):
    """What the example defines, and what it prints."""
    names, printed = {}, io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code, "docs/other-simulators.md", "exec"), names)
    return names, printed.getvalue()


NAMES, PRINTED = example()
PLANT = NAMES["MujocoRobot"]


def test_the_example_walks_and_prints_what_the_page_shows():
    (shown,) = re.findall(r"```text\n(.*?)```", PAGE, re.DOTALL)
    number = r"[\d.]+"
    assert re.sub(number, "", shown) == re.sub(number, "", PRINTED)
    # To some millimetres: where feet land is a matter of the engine and of small changes of the walk.
    ways = [[float(each) for each in re.findall(number, text)] for text in (shown, PRINTED)]
    assert ways[0] == pytest.approx(ways[1], abs=8)
    assert NAMES["way"] == pytest.approx(NAMES["planned"], rel=0.1)
    assert NAMES["plant"].data.time == pytest.approx(2.0)
    assert abs(NAMES["plant"].data.qpos[1]) < 0.01
    assert "tarsus.simulation" not in EXAMPLE


def walked(plant, *, readings=lambda _, found: found, ticks=150):
    """The way of a walk over the planned one, its end, and what was told but for what a foot does on the ground."""
    controller, told = tarsus.RobotController(plant.robot), set()
    plant.start(controller.output)
    for tick in range(ticks):
        output = controller.step(FORWARD, 0.01, readings(tick, plant.step(controller.output, 0.01)))
        told |= {limitation.text() for limitation in output.limitations if limitation.kind != "ground"}
    return plant.data.qpos[0] / output.body.position[0], output, "\n".join(told)


def with_other_axes(sign, zero):
    """The model with hinges that turn the other way, and another pose at zero angles."""
    spec = mujoco.MjSpec.from_string(MJCF)
    for leg in STRIDER.leg_names:
        for number, kind in enumerate(("coxa", "femur", "tibia")):
            joint, actuator = spec.joint(f"{leg} {kind}"), spec.actuator(f"{leg} {kind}")
            turn, axis = np.zeros(4), np.array(joint.axis)
            mujoco.mju_axisAngle2Quat(turn, axis, zero[number])
            body, before = spec.body(f"{leg} {kind}"), np.array(spec.body(f"{leg} {kind}").quat)
            mujoco.mju_mulQuat(turn, before, turn.copy())
            body.quat, joint.axis = turn, sign[number] * axis
            joint.range = np.sort(sign[number] * (np.array(joint.range) - zero[number]))
            actuator.ctrlrange = np.sort(sign[number] * (np.array(actuator.ctrlrange) - zero[number]))
    return spec.to_xml()


@pytest.mark.parametrize(("sign", "zero"), [([1, -1, -1], [0, 0, -90]), ([-1, 1, -1], [10, 30, -60])])
def test_a_model_with_other_signs_and_zeros_walks_as_the_page_says(sign, zero):
    text = f"SIGN, ZERO = np.array({sign}), np.radians({zero})"
    code, count = re.subn(r"^SIGN, ZERO = .*$", text, EXAMPLE.partition("\nrobot = ")[0], flags=re.MULTILINE)
    assert count == 1
    names, _ = example(code)
    plant = names["MujocoRobot"](STRIDER, with_other_axes(sign, np.radians(zero)))
    # The one pose that the page compares: feet in the frame of the body.
    angles = np.random.default_rng(0).uniform(-0.3, 0.3, (6, 3))
    plant.data.qpos[plant.joints] = names["SIGN"] * (angles - names["ZERO"])
    mujoco.mj_forward(plant.model, plant.data)
    feet = plant.data.geom_xpos[plant.feet]
    np.testing.assert_allclose(feet, tarsus.forward_kinematics(STRIDER, angles)[:, 3], atol=1e-6)
    way, output, told = walked(plant)
    assert way == pytest.approx(1.0, abs=0.1)
    assert output.state == "walking"
    assert not told
    # As the model with the conventions of the page, but for rounding: its angles are written with six digits.
    assert way == pytest.approx(walked(PLANT(STRIDER, MJCF))[0], abs=0.02)


def test_the_class_is_a_plant():
    plant = PLANT(STRIDER, MJCF)
    recording = tarsus.run(tarsus.RobotController(STRIDER), plant, [(0.0, FORWARD)], duration=1.0)
    assert recording.states[-1] == "walking"
    assert plant.data.qpos[0] > 0.05


def test_a_robot_without_masses_feels_contacts_and_attitude():
    without = STRIDER.replace(body_mass=None, link_mass=None)
    way, output, told = walked(PLANT(without, MJCF))
    assert way == pytest.approx(1.0, abs=0.1)
    assert output.state == "walking"
    assert not told


LOST = 80
MISSING = {
    "from the start": lambda _, found: None,
    "all, later": lambda tick, found: None if tick > LOST else found,
    "contacts and joint angles, later": lambda tick, found: dataclasses.replace(
        found, **({"contacts": None, "joint_angles": None} if tick > LOST else {})
    ),
    "attitude, later": lambda tick, found: dataclasses.replace(found, attitude=None) if tick > LOST else found,
    "every other": lambda tick, found: found if tick % 2 else None,
}


@pytest.mark.parametrize("missing", MISSING.values(), ids=MISSING)
def test_on_a_floor_the_walk_goes_on_with_what_is_left(missing):
    way, output, told = walked(PLANT(STRIDER, MJCF), readings=missing)
    assert way == pytest.approx(1.0, abs=0.1)
    assert output.state == "walking"
    assert not told


@pytest.mark.no_cover
@pytest.mark.parametrize(("name", "speed"), [("phantomx", 0.05), ("phoenix", 0.1), ("strider", 0.15)])
def test_joint_angles_without_contacts_tell_of_a_floor_what_the_commands_do(name, speed):
    robot = tarsus.load_robot(name)
    plant, controller = PLANT(robot, to_mjcf(robot)), tarsus.RobotController(robot)
    plant.start(controller.output)
    for _ in range(600):
        found = dataclasses.replace(plant.step(controller.output, 0.01), contacts=None)
        output = controller.step((speed, 0.0, 0.0), 0.01, found)
        assert np.hypot(*found.attitude) < np.radians(3)
        assert not any("air" in limitation.cause for limitation in output.limitations)
    assert plant.data.qpos[0] > 0.9 * output.body.position[0]
    assert plant.data.qpos[0] > 0.9 * 6.0 * speed


def test_old_and_impossible_readings_are_named():
    def spoilt(_, found):
        angles = np.where(np.arange(6)[:, None] == 2, np.nan, found.joint_angles)
        return dataclasses.replace(found, joint_angles=angles, age={"contacts": 0.2})

    way, _, told = walked(PLANT(STRIDER, MJCF), readings=spoilt)
    assert set(told.splitlines()) == {
        "readings: contacts: older than 100 ms",
        "readings: joint_angles of LR: not finite numbers",
    }
    assert way == pytest.approx(1.0, abs=0.1)


def test_old_joint_angles_without_age_look_like_failed_servos_and_with_it_do_not():
    kept = []

    def frozen(tick, found):
        kept[:] = kept if tick > LOST else [found]
        return kept[0]

    def aged(tick, found):
        return dataclasses.replace(frozen(tick, found), age=max(0.0, 0.01 * (tick - LOST)))

    assert "the joint has failed" in walked(PLANT(STRIDER, MJCF), readings=frozen, ticks=200)[2]
    way, _, told = walked(PLANT(STRIDER, MJCF), readings=aged, ticks=200)
    assert set(told.splitlines()) == {"readings: all channels: older than 100 ms"}
    assert way == pytest.approx(1.0, abs=0.1)
