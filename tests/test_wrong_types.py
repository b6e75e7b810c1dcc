"""What is given in place of a robot or a number is refused by its name."""

import numpy as np
import pytest

import tarsus
from tarsus.control.pose.admittance import Admittance
from tarsus.control.sequence import SequencePlayer
from tarsus.control.startup import sit_down
from tarsus.errors import InputError
from tarsus.export.urdf import to_urdf
from tarsus.hardware import nominal_calibration
from tarsus.load.deflection import checked_share
from tarsus.robot.file import load_robot, robot_text
from tarsus.simulation import SimulatedPlant
from tarsus.simulation.robot_model import model_assumptions

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
        lambda robot: tarsus.leg_jacobian(robot, np.zeros((6, 3))),
        tarsus.coxa_frames,
        lambda robot: tarsus.reachable_fraction(robot, np.zeros((6, 3)), tarsus.Pose(), tarsus.Pose()),
        lambda robot: tarsus.reachable_band(robot, np.zeros(3)),
        tarsus.default_body_height,
        tarsus.default_swing_height,
        tarsus.total_mass,
        lambda robot: tarsus.joint_torques(robot, np.zeros((6, 3)), tarsus.Pose(), np.ones(6, dtype=bool)),
        lambda robot: tarsus.contact_forces(robot, np.zeros((6, 3)), tarsus.Pose(), np.ones(6, dtype=bool)),
        lambda robot: tarsus.contact_forces_with_friction(
            robot, np.zeros((6, 3)), tarsus.Pose(), np.ones(6, dtype=bool), friction=1.0
        ),
        tarsus.compare_with_statics,
        lambda robot: tarsus.fold(robot, np.zeros((6, 3))),
        lambda robot: tarsus.power_off_order(robot, np.zeros((6, 3))),
        tarsus.plausibility_warnings,
        tarsus.try_gaits,
        tarsus.robot_to_dict,
        lambda robot: tarsus.save_robot(robot, "robot.toml"),
        robot_text,
        model_assumptions,
        to_urdf,
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
        ("distance", lambda: tarsus.straight_path("x")),
        ("centre", lambda: tarsus.curved_path(1.0, (0.0, "x"))),
        ("twist", lambda: tarsus.twist_path(0.1, 0.0, "x", 1.0)),
        ("duration", lambda: tarsus.twist_path(0.1, 0.0, 0.0, "x")),
        ("a path's duration", lambda: tarsus.BodyPath((0.1, 0.0, 0.0), duration="x")),
        ("share", lambda: checked_share("x")),
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


@pytest.mark.parametrize(("name", "kind"), [("adaptation", "GroundAdaptation"), ("admittance", "Admittance")])
def test_a_text_is_no_option_of_a_walk(name, kind):
    with pytest.raises(InputError, match=f"^{name} is 'x'; it must be of class {kind}$"):
        tarsus.WalkController(STRIDER, **{name: "x"})


@pytest.mark.parametrize("name", [None, 3, b"strider", ""])
def test_what_is_no_name_is_no_robot(name):
    with pytest.raises(InputError, match=r"is no robot's name or path; the presets are .*strider"):
        load_robot(name)


def test_loads_name_joints_that_a_robot_lacks():
    motion = tarsus.plan_walk(STRIDER, tarsus.Gait.named("tripod"), tarsus.straight_path(0.1))
    loads = tarsus.joint_loads(STRIDER, motion)
    assert loads.cause(0, 1)
    with pytest.raises(InputError, match=r"^cause: the robot has no leg 'RF'; its legs are 0 to 5$"):
        loads.cause("RF", 1)
    for name, made in (("cause", lambda: loads.cause(0, 3)), ("worst", lambda: loads.worst(3))):
        with pytest.raises(InputError, match=f"^{name}: a leg has no joint 3; its joints are 0 coxa"):
            made()
