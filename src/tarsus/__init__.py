"""Tarsus: a toolkit for six-legged robots, from a robot file to joint angles, walks, torques and servos.

All public names are here::

    import tarsus

    robot = tarsus.load_robot("strider")
    walk = tarsus.plan_walk(robot, tarsus.Gait.named("tripod"), tarsus.straight_path(1.0))

Units in Python are SI: metres, radians, seconds, kilograms. Files and the command line use millimetres and degrees.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tarsus import export as export
    from tarsus import hardware as hardware
    from tarsus import simulation as simulation
    from tarsus import urdf as urdf
    from tarsus.control.command import Command
    from tarsus.control.compensated_plant import CompensatedPlant
    from tarsus.control.control_output import ControlOutput
    from tarsus.control.limitation import Limitation, LimitationKind
    from tarsus.control.loop.recording import Recording
    from tarsus.control.loop.run import run
    from tarsus.control.plant import IdealPlant, Plant
    from tarsus.control.pose.admittance import Admittance
    from tarsus.control.readings import SensorReadings
    from tarsus.control.robot_controller import RobotController
    from tarsus.control.robot_state import RobotState
    from tarsus.control.safety import Guard, GuardBounds, GuardOutput, GuardState, Intervention, InterventionKind
    from tarsus.control.sequence import MotionSequence, SequencePlayer
    from tarsus.control.startup import fold, power_off_order, sit_down, stand_up
    from tarsus.control.terrain.roughness import GroundAdaptation
    from tarsus.control.walk_controller import WalkController
    from tarsus.errors import (
        BusError,
        CalibrationError,
        CollisionError,
        CorruptAnswerError,
        InputError,
        MissingDataError,
        NoAnswerError,
        PortError,
        RobotFileError,
        ServoFaultError,
        ServoStatusError,
        SimulationError,
        StrokeError,
        TarsusError,
        UnknownNameError,
        UnreachableError,
    )
    from tarsus.gait.cycle import cycle_feet
    from tarsus.gait.gait import GAITS, Gait
    from tarsus.gait.ground_heights import GroundHeights
    from tarsus.gait.motion import Motion
    from tarsus.gait.path import BodyPath, curved_path, straight_path, twist_path
    from tarsus.gait.plan import plan_walk
    from tarsus.gait.storage import load_motion, motion_to_csv, motion_to_dataset, save_motion
    from tarsus.gait.stroke import max_stroke
    from tarsus.kinematics.body import coxa_frames, reachable_fraction
    from tarsus.kinematics.folded_pose import folded_pose
    from tarsus.kinematics.inverse import inverse_kinematics
    from tarsus.kinematics.leg import forward_kinematics, leg_jacobian
    from tarsus.kinematics.mass import centre_of_mass, total_mass
    from tarsus.kinematics.polygon import support_polygon
    from tarsus.kinematics.pose import Pose
    from tarsus.kinematics.reach import Reach
    from tarsus.kinematics.rest import RestingPose, resting_pose
    from tarsus.kinematics.solution import IKSolution
    from tarsus.kinematics.stability import stability_margin
    from tarsus.kinematics.stance import (
        default_body_height,
        default_stance,
        default_swing_height,
        reachable_band,
    )
    from tarsus.load.compliant.compliant_loads import compliant_loads
    from tarsus.load.compliant.foot_contact import FootContact
    from tarsus.load.compliant.joint_springs import JointSprings
    from tarsus.load.compliant.result import CompliantLoads
    from tarsus.load.contact import ContactForces, contact_forces
    from tarsus.load.cycle_torques import CycleTorques, cycle_torques
    from tarsus.load.deflection import compensate_deflection, joint_deflections
    from tarsus.load.friction import contact_forces_with_friction
    from tarsus.load.handbook.method import handbook
    from tarsus.load.handbook.statics import compare_with_statics
    from tarsus.load.inverse_dynamics import MotionTorques, motion_torques
    from tarsus.load.loads import JointLoads, joint_loads
    from tarsus.load.payload import Payload
    from tarsus.load.sizing import ServoSizing, size_servos
    from tarsus.load.supply import SupplyLoad, supply_load
    from tarsus.load.torque import joint_torques
    from tarsus.load.verdict import JointVerdict, joint_verdicts
    from tarsus.load.walk_changes import WalkChange, walk_changes
    from tarsus.plausibility.checks import plausibility_warnings
    from tarsus.plausibility.gait_trials import GaitTrial, try_gaits
    from tarsus.plausibility.warning import PlausibilityWarning
    from tarsus.report.angles import plot_angles
    from tarsus.report.animation import animate
    from tarsus.report.footpaths import plot_footpaths
    from tarsus.report.gait_diagram import plot_gait
    from tarsus.report.skeleton import plot_robot
    from tarsus.report.timeline import plot_timeline
    from tarsus.robot.catalogue import list_servos, load_servo
    from tarsus.robot.file import list_robots, load_robot, robot_from_dict, robot_to_dict, save_robot
    from tarsus.robot.firmware import FIRMWARE, Firmware, convert_limits
    from tarsus.robot.robot import JOINTS, GaitDefaults, Robot, Source, stack_robots
    from tarsus.robot.schema import robot_schema
    from tarsus.robot.servo import Servo
    from tarsus.scenario.file import (
        load_scenario,
        save_scenario,
        scenario_from_dict,
        scenario_from_text,
        scenario_to_dict,
    )
    from tarsus.scenario.runner import run_scenario
    from tarsus.scenario.scenario import Scenario

__version__ = "0.1.0"

# Where each public name lives. It is imported when first asked for: `import tarsus` and `tarsus --help` do not wait
# for NumPy. A test holds this table, the imports above and `__all__` against each other.
_HOMES = {
    "tarsus.control.loop.recording": ("Recording",),
    "tarsus.scenario.runner": ("run_scenario",),
    "tarsus.scenario.scenario": ("Scenario",),
    "tarsus.errors": (
        *("BusError", "CalibrationError", "CollisionError", "CorruptAnswerError", "InputError", "MissingDataError"),
        *("NoAnswerError", "PortError", "RobotFileError", "ServoFaultError", "ServoStatusError", "SimulationError"),
        *("StrokeError", "TarsusError", "UnknownNameError", "UnreachableError"),
    ),
    "tarsus.gait.ground_heights": ("GroundHeights",),
    "tarsus.gait.cycle": ("cycle_feet",),
    "tarsus.gait.gait": ("GAITS", "Gait"),
    "tarsus.control.pose.admittance": ("Admittance",),
    "tarsus.control.terrain.roughness": ("GroundAdaptation",),
    "tarsus.control.safety": ("Guard", "GuardBounds", "GuardOutput", "GuardState", "Intervention", "InterventionKind"),
    "tarsus.control.startup": ("fold", "power_off_order", "sit_down", "stand_up"),
    "tarsus.control.control_output": ("ControlOutput",),
    "tarsus.control.limitation": (
        "Limitation",
        "LimitationKind",
    ),
    "tarsus.control.plant": (
        "IdealPlant",
        "Plant",
    ),
    "tarsus.control.robot_controller": ("RobotController",),
    "tarsus.control.robot_state": ("RobotState",),
    "tarsus.control.loop.run": ("run",),
    "tarsus.control.readings": ("SensorReadings",),
    "tarsus.control.sequence": ("MotionSequence", "SequencePlayer"),
    "tarsus.control.walk_controller": ("WalkController",),
    "tarsus.control.command": ("Command",),
    "tarsus.control.compensated_plant": ("CompensatedPlant",),
    "tarsus.gait.motion": ("Motion",),
    "tarsus.gait.path": ("BodyPath", "curved_path", "straight_path", "twist_path"),
    "tarsus.gait.plan": ("plan_walk",),
    "tarsus.gait.storage": ("load_motion", "motion_to_csv", "motion_to_dataset", "save_motion"),
    "tarsus.gait.stroke": ("max_stroke",),
    "tarsus.kinematics.body": ("coxa_frames", "reachable_fraction"),
    "tarsus.kinematics.folded_pose": ("folded_pose",),
    "tarsus.kinematics.inverse": ("inverse_kinematics",),
    "tarsus.kinematics.leg": ("forward_kinematics", "leg_jacobian"),
    "tarsus.kinematics.mass": ("centre_of_mass", "total_mass"),
    "tarsus.kinematics.polygon": ("support_polygon",),
    "tarsus.kinematics.pose": ("Pose",),
    "tarsus.kinematics.reach": ("Reach",),
    "tarsus.kinematics.solution": ("IKSolution",),
    "tarsus.kinematics.rest": ("RestingPose", "resting_pose"),
    "tarsus.kinematics.stability": ("stability_margin",),
    "tarsus.kinematics.stance": ("default_body_height", "default_stance", "default_swing_height", "reachable_band"),
    "tarsus.load.compliant.compliant_loads": ("compliant_loads",),
    "tarsus.load.compliant.foot_contact": ("FootContact",),
    "tarsus.load.compliant.joint_springs": ("JointSprings",),
    "tarsus.load.compliant.result": ("CompliantLoads",),
    "tarsus.load.contact": ("ContactForces", "contact_forces"),
    "tarsus.load.cycle_torques": ("CycleTorques", "cycle_torques"),
    "tarsus.load.deflection": ("compensate_deflection", "joint_deflections"),
    "tarsus.load.friction": ("contact_forces_with_friction",),
    "tarsus.load.handbook.method": ("handbook",),
    "tarsus.load.handbook.statics": ("compare_with_statics",),
    "tarsus.load.inverse_dynamics": ("MotionTorques", "motion_torques"),
    "tarsus.load.loads": ("JointLoads", "joint_loads"),
    "tarsus.load.payload": ("Payload",),
    "tarsus.load.sizing": ("ServoSizing", "size_servos"),
    "tarsus.load.supply": ("SupplyLoad", "supply_load"),
    "tarsus.load.torque": ("joint_torques",),
    "tarsus.load.verdict": ("JointVerdict", "joint_verdicts"),
    "tarsus.load.walk_changes": ("WalkChange", "walk_changes"),
    "tarsus.plausibility.checks": ("plausibility_warnings",),
    "tarsus.plausibility.gait_trials": ("GaitTrial", "try_gaits"),
    "tarsus.plausibility.warning": ("PlausibilityWarning",),
    "tarsus.report.angles": ("plot_angles",),
    "tarsus.report.animation": ("animate",),
    "tarsus.report.footpaths": ("plot_footpaths",),
    "tarsus.report.gait_diagram": ("plot_gait",),
    "tarsus.report.skeleton": ("plot_robot",),
    "tarsus.report.timeline": ("plot_timeline",),
    "tarsus.robot.catalogue": ("list_servos", "load_servo"),
    "tarsus.robot.file": ("list_robots", "load_robot", "robot_from_dict", "robot_to_dict", "save_robot"),
    "tarsus.robot.firmware": ("FIRMWARE", "Firmware", "convert_limits"),
    "tarsus.robot.robot": ("JOINTS", "GaitDefaults", "Robot", "Source", "stack_robots"),
    "tarsus.robot.schema": ("robot_schema",),
    "tarsus.robot.servo": ("Servo",),
    "tarsus.scenario.file": (
        *("load_scenario", "save_scenario", "scenario_from_dict", "scenario_from_text", "scenario_to_dict"),
    ),
}
# Packages of heavier parts, each with public names of its own.
_PACKAGES = ("export", "hardware", "simulation", "urdf")
_HOME_OF = {name: module for module, names in _HOMES.items() for name in names}

__all__ = [
    "FIRMWARE",
    "GAITS",
    "JOINTS",
    "Admittance",
    "BodyPath",
    "BusError",
    "CalibrationError",
    "CollisionError",
    "Command",
    "CompensatedPlant",
    "CompliantLoads",
    "ContactForces",
    "ControlOutput",
    "CorruptAnswerError",
    "CycleTorques",
    "Firmware",
    "FootContact",
    "Gait",
    "GaitDefaults",
    "GaitTrial",
    "GroundAdaptation",
    "GroundHeights",
    "Guard",
    "GuardBounds",
    "GuardOutput",
    "GuardState",
    "IKSolution",
    "IdealPlant",
    "InputError",
    "Intervention",
    "InterventionKind",
    "JointLoads",
    "JointSprings",
    "JointVerdict",
    "Limitation",
    "LimitationKind",
    "MissingDataError",
    "Motion",
    "MotionSequence",
    "MotionTorques",
    "NoAnswerError",
    "Payload",
    "Plant",
    "PlausibilityWarning",
    "PortError",
    "Pose",
    "Reach",
    "Recording",
    "RestingPose",
    "Robot",
    "RobotController",
    "RobotFileError",
    "RobotState",
    "Scenario",
    "SensorReadings",
    "SequencePlayer",
    "Servo",
    "ServoFaultError",
    "ServoSizing",
    "ServoStatusError",
    "SimulationError",
    "Source",
    "StrokeError",
    "SupplyLoad",
    "TarsusError",
    "UnknownNameError",
    "UnreachableError",
    "WalkChange",
    "WalkController",
    "__version__",
    "animate",
    "centre_of_mass",
    "compare_with_statics",
    "compensate_deflection",
    "compliant_loads",
    "contact_forces",
    "contact_forces_with_friction",
    "convert_limits",
    "coxa_frames",
    "curved_path",
    "cycle_feet",
    "cycle_torques",
    "default_body_height",
    "default_stance",
    "default_swing_height",
    "fold",
    "folded_pose",
    "forward_kinematics",
    "handbook",
    "inverse_kinematics",
    "joint_deflections",
    "joint_loads",
    "joint_torques",
    "joint_verdicts",
    "leg_jacobian",
    "list_robots",
    "list_servos",
    "load_motion",
    "load_robot",
    "load_scenario",
    "load_servo",
    "max_stroke",
    "motion_to_csv",
    "motion_to_dataset",
    "motion_torques",
    "plan_walk",
    "plausibility_warnings",
    "plot_angles",
    "plot_footpaths",
    "plot_gait",
    "plot_robot",
    "plot_timeline",
    "power_off_order",
    "reachable_band",
    "reachable_fraction",
    "resting_pose",
    "robot_from_dict",
    "robot_schema",
    "robot_to_dict",
    "run",
    "run_scenario",
    "save_motion",
    "save_robot",
    "save_scenario",
    "scenario_from_dict",
    "scenario_from_text",
    "scenario_to_dict",
    "sit_down",
    "size_servos",
    "stability_margin",
    "stack_robots",
    "stand_up",
    "straight_path",
    "supply_load",
    "support_polygon",
    "total_mass",
    "try_gaits",
    "twist_path",
    "walk_changes",
]


def __getattr__(name: str) -> Any:
    """Import a public name from where it lives."""
    if name in _PACKAGES:
        return import_module(f"tarsus.{name}")
    if name not in _HOME_OF:
        raise AttributeError(f"module 'tarsus' has no attribute {name!r}")
    value = getattr(import_module(_HOME_OF[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*__all__, *_PACKAGES])
