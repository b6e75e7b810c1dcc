"""What is given in place of a robot or a number is refused by its name."""

import numpy as np
import pytest

import tarsus
from tarsus.control.pose.admittance import Admittance
from tarsus.control.sequence import SequencePlayer
from tarsus.control.startup import sit_down
from tarsus.errors import InputError
from tarsus.hardware import nominal_calibration
from tarsus.robot.file import load_robot
from tarsus.simulation import SimulatedPlant

STRIDER = load_robot("strider")


@pytest.mark.parametrize(
    "made",
    [
        tarsus.RobotController,
        tarsus.WalkController,
        tarsus.IdealPlant,
        tarsus.Guard,
        tarsus.GuardBounds.of,
        SimulatedPlant,
        tarsus.default_stance,
        tarsus.folded_pose,
        tarsus.handbook,
        tarsus.sit_down,
        lambda robot: tarsus.stand_up(robot, np.zeros((6, 3))),
        lambda robot: tarsus.joint_loads(robot, None),
        lambda robot: tarsus.compliant_loads(robot, None),
        lambda robot: tarsus.size_servos(robot, None),
        lambda robot: tarsus.cycle_torques(robot, tarsus.Gait.named("tripod"), stroke=0.06),
        lambda robot: nominal_calibration(robot, "strider"),
        lambda robot: tarsus.plan_walk(robot, None, tarsus.straight_path(0.1)),
        lambda robot: tarsus.inverse_kinematics(robot, np.zeros((6, 3))),
        lambda robot: tarsus.forward_kinematics(robot, np.zeros((6, 3))),
    ],
)
def test_a_name_is_no_robot(made):
    with pytest.raises(InputError, match=r"robot is 'strider'; it must be a Robot; load_robot\('strider'\) loads one"):
        made("strider")
    with pytest.raises(InputError, match=r"robot is 3; it must be a Robot$"):
        made(3)


@pytest.mark.parametrize("path", [1.0, "straight", None])
def test_a_distance_is_no_path(path):
    with pytest.raises(InputError, match=r"^path is .*; it must be a BodyPath, like straight_path\(1.0\)$"):
        tarsus.plan_walk(STRIDER, tarsus.Gait.named("tripod"), path)


def _player():
    return SequencePlayer(sit_down(STRIDER, tarsus.WalkController(STRIDER).angles))


@pytest.mark.parametrize(
    ("name", "made"),
    [
        ("ground adaptation: cycle_time", lambda: tarsus.GroundAdaptation(cycle_time="x")),
        ("admittance: mass", lambda: Admittance(mass="x", damping=1.0, stiffness=1.0)),
        ("stance_width", lambda: tarsus.WalkController(STRIDER, stance_width="x")),
        ("body_height", lambda: tarsus.WalkController(STRIDER, body_height="x")),
        ("dt", lambda: _player().step("x")),
        (
            "jitter",
            lambda: tarsus.run(tarsus.RobotController(STRIDER), tarsus.IdealPlant(STRIDER), [], jitter="x"),
        ),
    ],
)
def test_a_text_is_no_number(name, made):
    with pytest.raises(InputError, match=f"^{name} is 'x'; it must be a number$"):
        made()


def test_a_number_that_is_written_as_text_is_that_number():
    found = Admittance(mass="1", damping="400", stiffness="400", travel="0.01")
    assert found == Admittance(mass=1, damping=400, stiffness=400, travel=0.01)
    assert tarsus.GroundAdaptation(cycle_time="1.2", speed="0.5") == tarsus.GroundAdaptation(cycle_time=1.2, speed=0.5)
    walks = [tarsus.WalkController(STRIDER, stance_width=width, cycle_time=1.2) for width in ("0.01", 0.01)]
    assert (walks[0].angles == walks[1].angles).all()
    assert tarsus.WalkController(STRIDER, cycle_time="1.2").cycle_time == walks[0].cycle_time
    commands = {"duration": 0.05, "jitter": "0.001"}
    assert len(tarsus.run(tarsus.RobotController(STRIDER), tarsus.IdealPlant(STRIDER), [], **commands).states) == 6


def test_a_plant_takes_angles_of_all_its_legs():
    plant = SimulatedPlant(STRIDER, servos="ideal")
    plant.start(tarsus.RobotController(STRIDER).output)
    with pytest.raises(InputError, match=r"the commanded angles have shape \(4, 3\); expected \(6, 3\)"):
        plant.execute(np.zeros((4, 3)), 0.01)
